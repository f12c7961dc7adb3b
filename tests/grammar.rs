//! `compiler/src/grammar.rs` is what pest generates from `grammar.pest`.
//!
//! It is committed, so that users of the macro do not build the generator. After a change of the
//! grammar, `UPDATE_GRAMMAR=1 cargo test -p tltl-tests grammar` writes it anew.

use std::path::Path;

use quote::quote;

const HEADER: &str = "// Generated from grammar.pest by tests/grammar.rs; do not edit.\n\n";

#[test]
fn the_committed_parser_is_fresh() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../compiler/src");
    let grammar = std::fs::read_to_string(folder.join("grammar.pest")).unwrap();
    let generated = generate(&grammar);
    let file = folder.join("grammar.rs");
    if std::env::var_os("UPDATE_GRAMMAR").is_some() {
        std::fs::write(&file, &generated).unwrap();
    }
    let committed = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(committed == generated, "run this test with UPDATE_GRAMMAR=1");
}

fn generate(grammar: &str) -> String {
    let parser = quote! {
        #[grammar_inline = #grammar]
        pub(crate) struct Grammar;
    };
    let tokens = pest_generator::derive_parser(parser, false);
    let file = quote! {
        pub(crate) struct Grammar;
        #tokens
    };
    let text = prettyplease::unparse(&syn::parse2(file).unwrap());
    format!("{HEADER}{text}")
}
