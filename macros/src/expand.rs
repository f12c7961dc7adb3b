//! What the macros do, testable without a compiler around it.

use std::path::PathBuf;

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::{quote, quote_spanned};
use tltl_compiler::compile::{self, Compiled};
#[cfg(feature = "hoa")]
use tltl_compiler::emit::foreign;
use tltl_compiler::emit::rust::{self, Options};
use tltl_compiler::error::{Error, Errors, Kind, Style};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use crate::tokens::Flat;

/// `tltl!{ … }`
pub(crate) fn inline(input: TokenStream) -> TokenStream {
    let (runtime, input) = runtime_path(input);
    let flat = Flat::new(input);
    let source = Source::new("tltl!", flat.text.clone());
    let host = |span| flat.tokens(span);
    match compile::fragment(&source, Budget::default()) {
        Ok(compiled) => emit(&compiled, &Options { runtime, state: None, host: &host }),
        Err(errors) => {
            // rustc would show a warning as one more error.
            let errors = errors.iter().filter(|error| !error.is_warning());
            let messages = errors.map(|error| message(error, &source, &flat));
            // Items stand where no value can; a formula stands where one must.
            if is_items(&source) {
                quote! { #(#messages)* }
            } else {
                quote! { { #(#messages)* #runtime::private::invalid() } }
            }
        }
    }
}

/// `include_tltl!("path")` of a task file or of an automaton in HOA, with `state = Type`, `mod = name` and `crate = path` after it.
pub(crate) fn include(input: TokenStream) -> TokenStream {
    let arguments = match Arguments::parse(input) {
        Ok(arguments) => arguments,
        Err((message, span)) => {
            return quote_spanned! { span => ::core::compile_error! { #message } };
        }
    };
    let span = arguments.span;
    let root = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let text = match std::fs::read_to_string(root.join(&arguments.path)) {
        Ok(text) => text,
        Err(error) => {
            let message = format!("cannot read the task file `{}`: {error}", arguments.path);
            return quote_spanned! { span => ::core::compile_error! { #message } };
        }
    };
    let source = Source::new(arguments.path.as_str(), text);
    let options =
        |host| Options { runtime: arguments.runtime.clone(), state: arguments.state.clone(), host };
    if arguments.path.ends_with(".hoa") {
        return arguments.module(&automaton(&source, &arguments));
    }
    let code = match compile::file(&source, Budget::default()) {
        Ok(compiled) => emit(&compiled, &options(&|_| TokenStream::new())),
        Err(errors) => failure(&errors, &source, span),
    };
    arguments.module(&code)
}

/// An automaton in HOA as a task.
#[cfg(feature = "hoa")]
fn automaton(source: &Source, arguments: &Arguments) -> TokenStream {
    match tltl_compiler::hoa::read(source) {
        Ok(read) => {
            let name = read.name.unwrap_or_else(|| arguments.stem());
            foreign::automaton(&name, &read.dfa, &arguments.runtime)
        }
        Err(error) => failure(&Errors::from(error), source, arguments.span),
    }
}

/// Most users of the macros have no automata of other tools: reading them is not built for all.
#[cfg(not(feature = "hoa"))]
fn automaton(source: &Source, arguments: &Arguments) -> TokenStream {
    let message = format!(
        "`{}` is an automaton: to read it, turn on the feature `hoa` of the crate `tltl`",
        source.name()
    );
    quote_spanned! { arguments.span => ::core::compile_error! { #message } }
}

/// The mistakes of a file, with its own lines and carets, at the path that names it.
fn failure(errors: &Errors, source: &Source, span: Span) -> TokenStream {
    let message = format!("\n{}", errors.render(source, Style::Plain));
    quote_spanned! { span => ::core::compile_error! { #message } }
}

/// A bare formula is an expression, declarations are items.
fn emit(compiled: &Compiled, options: &Options<'_>) -> TokenStream {
    let module = &compiled.module;
    let mut tasks = module.tasks.iter().chain(compiled.factored.iter().map(|part| &part.task));
    let bare = tasks.next().is_some_and(|task| task.name.is_none());
    if bare { rust::expression(compiled, options) } else { rust::items(compiled, options) }
}

/// Whether a source that does not compile was meant as declarations.
fn is_items(source: &Source) -> bool {
    let mut text = source.text().trim_start();
    while let (true, Some((_, rest))) = (text.starts_with("#["), text.split_once(']')) {
        text = rest.trim_start();
    }
    let words = ["///", "state ", "struct ", "enum ", "const ", "predicate ", "task "];
    words.iter().any(|word| text.starts_with(word))
}

/// An error at the tokens that it is about.
fn message(error: &Error, source: &Source, flat: &Flat) -> TokenStream {
    let (first, last) = flat.spans(error.span());
    let mut text = error.message().to_owned();
    if flat.is_literal() {
        text = format!("\n{}", Errors::from(error.clone()).render(source, Style::Plain));
    } else {
        // rustc underlines one place; why something can never hold stands beside several.
        let never = error.kind() == Kind::Unsatisfiable;
        if never {
            text.push_str(&format!("\n= note: {}", error.place_label()));
        }
        // The message of a unit has both sides in it.
        let whole = never || error.kind() == Kind::Unit;
        for (span, label) in error.places().iter().skip(1).filter(|_| !whole) {
            let quoted = source.text().get(span.start..span.end).unwrap_or_default();
            text.push_str(&format!("\n= note: `{quoted}`: {label}"));
        }
        error.helps().iter().for_each(|help| text.push_str(&format!("\n= help: {help}")));
    }
    let path = quote_spanned! { first => ::core::compile_error! };
    let body = quote_spanned! { last => { #text } };
    quote! { #path #body }
}

/// The path of the runtime: `::tltl`, or what `#![crate = path]` at the start of the input says.
fn runtime_path(input: TokenStream) -> (TokenStream, TokenStream) {
    let trees: Vec<TokenTree> = input.clone().into_iter().collect();
    if let [TokenTree::Punct(hash), TokenTree::Punct(bang), TokenTree::Group(group), rest @ ..] =
        trees.as_slice()
    {
        let inner: Vec<TokenTree> = group.stream().into_iter().collect();
        if let (('#', '!'), [TokenTree::Ident(name), TokenTree::Punct(_), path @ ..]) =
            ((hash.as_char(), bang.as_char()), inner.as_slice())
            && name == "crate"
        {
            return (path.iter().cloned().collect(), rest.iter().cloned().collect());
        }
    }
    (quote! { ::tltl }, input)
}

/// The arguments of `include_tltl!`.
struct Arguments {
    path: String,
    span: Span,
    state: Option<TokenStream>,
    name: Option<TokenStream>,
    runtime: TokenStream,
}

impl Arguments {
    fn parse(input: TokenStream) -> Result<Self, (String, Span)> {
        let mut parts = split(input).into_iter();
        let first = parts.next().unwrap_or_default();
        let path = match first.as_slice() {
            [tree @ TokenTree::Literal(_)] => Some((Flat::new(tree.clone().into()), tree.span())),
            _ => None,
        };
        let Some((path, span)) = path.filter(|(path, _)| path.is_literal()) else {
            let span = first.first().map_or_else(Span::call_site, TokenTree::span);
            return Err(("include_tltl! takes the path of a task file, as a string".into(), span));
        };
        let path = path.text;
        let mut arguments =
            Self { path, span, state: None, name: None, runtime: quote! { ::tltl } };
        for part in parts.filter(|part| !part.is_empty()) {
            arguments.option(&part)?;
        }
        Ok(arguments)
    }

    fn option(&mut self, part: &[TokenTree]) -> Result<(), (String, Span)> {
        let (name, equals, value) = match part {
            [TokenTree::Ident(name), TokenTree::Punct(equals), value @ ..] => {
                (name.to_string(), equals.as_char(), value.iter().cloned().collect::<TokenStream>())
            }
            _ => (String::new(), ' ', TokenStream::new()),
        };
        match (name.as_str(), equals) {
            ("state", '=') => self.state = Some(value),
            ("mod", '=') => self.name = Some(value),
            ("crate", '=') => self.runtime = value,
            _ => {
                let span = part.first().map_or_else(Span::call_site, TokenTree::span);
                let message = "after the path come `state = Type`, `mod = name` or `crate = path`";
                return Err((message.into(), span));
            }
        }
        Ok(())
    }

    /// The module around the code, which cargo rebuilds when the file changes.
    fn module(&self, code: &TokenStream) -> TokenStream {
        let name = self.name.clone().unwrap_or_else(|| {
            let name = rust::identifier(&self.stem());
            quote! { #name }
        });
        let (path, about) = (&self.path, format!("The tasks of `{}`.", self.path));
        let tracked = format!("/{path}");
        quote! {
            #[doc = #about]
            #[allow(unused_imports)]
            pub mod #name {
                use super::*;
                const _: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), #tracked));
                #code
            }
        }
    }

    /// The file's name without its extension, as far as it can be a name in Rust.
    fn stem(&self) -> String {
        let stem = std::path::Path::new(&self.path).file_stem().unwrap_or_default();
        let stem = stem.to_string_lossy().replace(|c: char| !c.is_alphanumeric(), "_");
        if stem.starts_with(|c: char| c.is_alphabetic()) { stem } else { format!("_{stem}") }
    }
}

/// The parts between commas.
fn split(input: TokenStream) -> Vec<Vec<TokenTree>> {
    let mut parts = vec![Vec::new()];
    for tree in input {
        match (&tree, parts.last_mut()) {
            (TokenTree::Punct(punct), _) if punct.as_char() == ',' => parts.push(Vec::new()),
            (_, Some(part)) => part.push(tree),
            (_, None) => {}
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use quote::quote;

    use super::include;

    #[test]
    fn an_automaton_needs_the_feature() {
        let code = include(quote! { "../tests/data/avoid.hoa" }).to_string();
        let told = code.contains("turn on the feature `hoa` of the crate `tltl`");
        assert_eq!(told, !cfg!(feature = "hoa"), "{code}");
        assert_eq!(code.contains("pub fn task"), cfg!(feature = "hoa"), "{code}");
    }
}
