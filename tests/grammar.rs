//! `compiler/src/grammar.rs` is what pest generates from `grammar.pest`, cheaper to compile.
//!
//! It is committed, so that users of the macro do not build the generator. After a change of the
//! grammar, `UPDATE_GRAMMAR=1 cargo test -p tltl-tests grammar` writes it anew.

use std::path::Path;

use quote::{ToTokens, format_ident, quote};
use syn::visit_mut::{self, VisitMut};
use syn::{Expr, ExprMethodCall, Ident, ItemMod, Stmt, parse_quote};

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
    let mut file = parse_quote! {
        pub(crate) struct Grammar;
        type State<'i> = Box<::pest::ParserState<'i, Rule>>;
        type Step = for<'i> fn(State<'i>) -> ::pest::ParseResult<State<'i>>;
        #tokens
    };
    Steps::default().visit_file_mut(&mut file);
    let text = prettyplease::unparse(&file);
    format!("{HEADER}{text}")
}

/// Makes functions of the closures that pest's methods are given, equal ones one function, and gives
/// pointers to them instead. The methods are generic, and a copy of them for each of hundreds of
/// closures was a seventh of the code that rustc made of the crate.
#[derive(Default)]
struct Steps {
    /// The bodies of the functions of this module, each named after its place here.
    bodies: Vec<String>,
}

impl VisitMut for Steps {
    fn visit_item_mod_mut(&mut self, module: &mut ItemMod) {
        let outer = std::mem::take(&mut self.bodies);
        visit_mut::visit_item_mod_mut(self, module);
        let bodies = std::mem::replace(&mut self.bodies, outer);
        let Some((_, items)) = &mut module.content else { return };
        items.extend(bodies.iter().enumerate().map(|(index, body)| {
            let name = name(index);
            let body: Expr = syn::parse_str(body).unwrap();
            let state = quote!(crate::grammar::State<'_>);
            parse_quote!(fn #name(state: #state) -> ::pest::ParseResult<#state> { #body })
        }));
    }

    fn visit_expr_method_call_mut(&mut self, call: &mut ExprMethodCall) {
        visit_mut::visit_expr_method_call_mut(self, call);
        let Some(last) = call.args.last_mut() else { return };
        let Expr::Closure(closure) = &*last else { return };
        let function = self.function(&closure.body);
        *last = parse_quote!(#function as crate::grammar::Step);
    }
}

impl Steps {
    /// The function that does what a closure with this body does.
    fn function(&mut self, body: &Expr) -> Expr {
        match body {
            Expr::Block(block) => {
                if let [Stmt::Expr(only, None)] = &block.block.stmts[..] {
                    return self.function(only);
                }
            }
            // Another rule, with the same state.
            Expr::Call(call) => return (*call.func).clone(),
            _ => {}
        }
        let text = body.to_token_stream().to_string();
        let index = self.bodies.iter().position(|known| *known == text).unwrap_or_else(|| {
            self.bodies.push(text);
            self.bodies.len() - 1
        });
        let name = name(index);
        parse_quote!(#name)
    }
}

fn name(index: usize) -> Ident {
    format_ident!("step_{index}")
}
