//! The work of the macros, on `proc_macro2` tokens, so that it can be tested without a compiler
//! around it.
//!
//! Tokens become text ([`Flat`]), the compiler compiles the text, and its result becomes tokens.
//! Errors become `compile_error!` at the tokens that the author wrote.
//!
//! Nothing here knows what a formula means, and no error is worded here that is about a formula: those
//! are the compiler's. What is decided here is only where code and messages go, and which names the code
//! may see.

use std::path::{Path, PathBuf};

use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::{quote, quote_spanned};
use tltl_compiler::compile::{self, Compiled};
#[cfg(feature = "hoa")]
use tltl_compiler::emit::foreign;
use tltl_compiler::emit::rust::{self, Options, Place};
use tltl_compiler::error::{Error, Errors, Kind, Style};
use tltl_compiler::parse;
use tltl_compiler::predicate::{Condition, Function, Term};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use crate::tokens::{Flat, visible};

/// Expands `tltl!{ … }`.
///
/// On a mistake it expands to the errors, and for a formula to a value of the right type beside
/// them: without one, rustc would add a mistake of its own at each use.
pub(crate) fn inline(input: TokenStream) -> TokenStream {
    let (runtime, input) = runtime_path(input);
    let mut flat = Flat::new(input.clone());
    let (mut source, mut compiled) = fragment(&flat);
    let names = compiled.as_ref().ok().filter(|compiled| rust::is_bare(compiled)).map(variables);
    if let Some(apart) = names.and_then(|names| flat.told_apart(input, &names)) {
        flat = apart;
        (source, compiled) = fragment(&flat);
    }
    let host = |span| flat.tokens(span);
    match compiled {
        Ok(compiled) => {
            let options = Options { runtime, state: None, host: &host, place: Place::Scope };
            rust::code(&compiled, &options)
        }
        Err(errors) => {
            let messages = errors.iter().map(|error| message(error, &source, &flat));
            // Items stand where no value can; a formula stands where one must.
            if is_items(&source) {
                quote! { #(#messages)* }
            } else {
                quote! { { #(#messages)* #runtime::private::invalid() } }
            }
        }
    }
}

/// Compiles the text of a macro. The name of the source appears only in reports on string literals;
/// elsewhere rustc shows the place.
fn fragment(flat: &Flat) -> (Source, Result<Compiled, Errors>) {
    let source = Source::new("tltl!", flat.text.clone());
    let compiled = compile::fragment(&source, Budget::default());
    (source, compiled)
}

/// The words in the Rust of a formula, some of which are variables; those of the language are not.
fn variables(compiled: &Compiled) -> Vec<String> {
    let arena = &compiled.module.arena;
    let conditions = arena.conditions().iter().filter_map(|condition| match condition {
        Condition::Value { text, .. } => Some(text),
        _ => None,
    });
    let terms = arena.terms().iter().filter_map(|term| match term {
        Term::Host { text, .. } => Some(text),
        _ => None,
    });
    let words = conditions.chain(terms).flat_map(|text| text.split(|c| !is_of_a_word(c)));
    let is_known = |word: &str| parse::is_keyword(word) || Function::named(word).is_some();
    words.filter(|word| !is_known(word)).map(str::to_owned).collect()
}

/// Whether a character can be a part of a name of Rust.
fn is_of_a_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Expands `include_tltl!("path")` of a task file or of an automaton in HOA, with `state = Type`,
/// `mod = name` and `crate = path` after the path.
pub(crate) fn include(input: TokenStream) -> TokenStream {
    let arguments = match Arguments::parse(input) {
        Ok(arguments) => arguments,
        Err((message, span)) => return refusal(&message, span),
    };
    let file = arguments.file();
    let text = match std::fs::read_to_string(&file) {
        Ok(text) => text,
        Err(error) => {
            let message = format!("cannot read the task file `{}`: {error}", arguments.path);
            return refusal(&message, arguments.span);
        }
    };
    let source = Source::new(arguments.path.as_str(), text);
    let code = if arguments.path.ends_with(".hoa") {
        automaton(&source, &arguments)
    } else {
        tasks(&source, &arguments)
    };
    arguments.module(&file, &code)
}

/// Expands a task file.
///
/// A name of the arguments that the file declares too would silently mean the file's, for the module
/// sees its own items first; so that is refused.
fn tasks(source: &Source, arguments: &Arguments) -> TokenStream {
    let compiled = match compile::file(source, Budget::default()) {
        Ok(compiled) => compiled,
        Err(errors) => return failure(&errors, source, arguments.span),
    };
    if let Some((name, span)) = arguments.hidden(&compiled) {
        let message = format!(
            "`{name}` is declared in `{}` too, and hides this: give it another name here, as in `use {name} as Other`",
            source.name()
        );
        return refusal(&message, span);
    }
    let options = Options {
        runtime: arguments.runtime(),
        state: arguments.state.clone(),
        host: &|_| TokenStream::new(),
        place: arguments.place(),
    };
    rust::code(&compiled, &options)
}

/// Expands an automaton in HOA to a task.
#[cfg(feature = "hoa")]
fn automaton(source: &Source, arguments: &Arguments) -> TokenStream {
    match tltl_compiler::hoa::read(source) {
        Ok(read) => {
            let name = read.name.unwrap_or_else(|| arguments.stem());
            foreign::automaton(&name, &read.dfa, &arguments.runtime(), arguments.place())
        }
        Err(error) => failure(&Errors::from(error), source, arguments.span),
    }
}

/// Reports that the feature is off. It is not a default: most users have no automata of other
/// tools, and all would build the reader.
#[cfg(not(feature = "hoa"))]
fn automaton(source: &Source, arguments: &Arguments) -> TokenStream {
    let message = format!(
        "`{}` is an automaton: to read it, turn on the feature `hoa` of the crate `tltl`",
        source.name()
    );
    refusal(&message, arguments.span)
}

/// The mistakes of a file, with its own lines and carets, at the path that names it: rustc can
/// underline nothing in a file that it does not read.
fn failure(errors: &Errors, source: &Source, span: Span) -> TokenStream {
    refusal(&format!("\n{}", errors.render(source, Style::Plain)), span)
}

/// A message at one place.
fn refusal(message: &str, span: Span) -> TokenStream {
    quote_spanned! { span => ::core::compile_error! { #message } }
}

/// Whether a source that does not compile was meant as declarations. There may be no syntax tree to
/// ask, so it looks at the first word after attributes.
fn is_items(source: &Source) -> bool {
    let mut text = source.text().trim_start();
    while let (true, Some((_, rest))) = (text.starts_with("#["), text.split_once(']')) {
        text = rest.trim_start();
    }
    let words = ["///", "state ", "struct ", "enum ", "const ", "predicate ", "task "];
    words.iter().any(|word| text.starts_with(word))
}

/// An error at the tokens that it is about, with its other places and its help as notes.
///
/// `compile_error!` has the span of the first token and its braces that of the last; rustc
/// underlines from one to the other. In a string literal the tokens have no spans of their own, so
/// the report has lines and carets instead.
fn message(error: &Error, source: &Source, flat: &Flat) -> TokenStream {
    let (first, last) = flat.spans(error.span());
    let mut text = error.message().to_owned();
    if flat.is_literal() {
        text = format!("\n{}", Errors::from(error.clone()).render(source, Style::Plain));
    } else {
        // rustc underlines one place. Of a predicate that can never hold, several places together
        // are the reason; they are listed in one note.
        let never = error.kind() == Kind::Unsatisfiable;
        if never {
            text.push_str(&format!("\n= note: {}", error.place_label()));
        }
        // The message of a unit names both sides already.
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

/// The path of the runtime, and the rest of the input: `::tltl`, or the path that `#![crate =
/// path]` gives at the start.
fn runtime_path(input: TokenStream) -> (TokenStream, TokenStream) {
    let trees = visible(input.clone());
    if let [TokenTree::Punct(hash), TokenTree::Punct(bang), TokenTree::Group(group), rest @ ..] =
        trees.as_slice()
    {
        let inner = visible(group.stream());
        if let (('#', '!'), [TokenTree::Ident(name), TokenTree::Punct(_), path @ ..]) =
            ((hash.as_char(), bang.as_char()), inner.as_slice())
            && name == "crate"
        {
            return (path.iter().cloned().collect(), rest.iter().cloned().collect());
        }
    }
    (quote! { ::tltl }, input)
}

/// The arguments of `include_tltl!`; `span` is that of the path.
struct Arguments {
    path: String,
    span: Span,
    state: Option<TokenStream>,
    name: Option<TokenStream>,
    runtime: Option<TokenStream>,
}

impl Arguments {
    /// Reads the arguments; the error is a message and its place.
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
        let mut arguments = Self { path: path.text, span, state: None, name: None, runtime: None };
        for part in parts.filter(|part| !part.is_empty()) {
            arguments.option(&part)?;
        }
        Ok(arguments)
    }

    /// Reads one `name = value`.
    ///
    /// Of two of the same name the last one counts, as a later line would.
    fn option(&mut self, part: &[TokenTree]) -> Result<(), (String, Span)> {
        let (name, equals, value) = match part {
            [TokenTree::Ident(name), TokenTree::Punct(equals), value @ ..] => {
                (name.to_string(), equals.as_char(), value.iter().cloned().collect::<TokenStream>())
            }
            _ => (String::new(), ' ', TokenStream::new()),
        };
        match (name.as_str(), equals) {
            ("state", '=') => self.state = Some(outward(value)),
            ("mod", '=') => self.name = Some(value),
            ("crate", '=') => self.runtime = Some(outward(value)),
            _ => {
                let span = part.first().map_or_else(Span::call_site, TokenTree::span);
                let message = "after the path come `state = Type`, `mod = name` or `crate = path`";
                return Err((message.into(), span));
            }
        }
        Ok(())
    }

    /// The absolute path of the file, which the module includes.
    ///
    /// The author's path is relative to the package, and `include_bytes!` would take it as relative to the
    /// source file.
    fn file(&self) -> PathBuf {
        let root = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
        let file = root.join(&self.path);
        std::path::absolute(&file).unwrap_or(file)
    }

    /// The path of the runtime as the module sees it.
    fn runtime(&self) -> TokenStream {
        self.runtime.clone().unwrap_or_else(|| quote! { ::tltl })
    }

    /// Whether the module sees the names around it. It does only if a path in the arguments has to
    /// be found there, so that no name of the author can change the meaning of the code.
    fn place(&self) -> Place {
        let sees = self.state.is_some() || self.runtime.is_some();
        if sees { Place::Scope } else { Place::Module }
    }

    /// The first word of a path in the arguments that would mean an item of the module inside it,
    /// and its place.
    ///
    /// `state = Cell` beside a file that declares a struct `Cell` is such a word.
    fn hidden(&self, compiled: &Compiled) -> Option<(String, Span)> {
        let module = &compiled.module;
        let factored = compiled.factored.iter().map(|factored| &factored.task);
        let tasks = module.tasks.iter().chain(factored).filter_map(|task| task.name.as_ref());
        let predicates = module.predicates.iter().filter(|known| known.declared);
        let types = module.enums.iter().map(|known| &known.name);
        let types = types.chain(module.structs.iter().map(|known| &known.name));
        let names: Vec<_> = types.chain(predicates.map(|known| &known.name)).chain(tasks).collect();
        let paths = [&self.state, &self.runtime].into_iter().flatten();
        let words = paths.flat_map(|path| first_words(path.clone()));
        let named = |word: &Ident| names.iter().any(|name| *word == name);
        words.into_iter().find(named).map(|word| (word.to_string(), word.span()))
    }

    /// The module around the code. `include_bytes!` makes cargo rebuild when the file changes; a
    /// macro on stable Rust has no other way to say so. The bytes are dropped, since the constant
    /// has no name.
    fn module(&self, file: &Path, code: &TokenStream) -> TokenStream {
        let stem = rust::module_name(&self.stem());
        let name = self.name.clone().unwrap_or_else(|| quote! { #stem });
        let about = format!("The tasks of `{}`.", self.path);
        let file = file.to_string_lossy();
        let around = (self.place() == Place::Scope).then(|| quote! { use super::*; });
        quote! {
            #[doc = #about]
            pub mod #name {
                #around
                const _: &[::core::primitive::u8] = ::core::include_bytes!(#file);
                #code
            }
        }
    }

    /// The name of the file without its extension.
    fn stem(&self) -> String {
        let stem = Path::new(&self.path).file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }
}

/// A path of the arguments as it is written inside the module: `super` and `self` are one level
/// further out there.
///
/// `crate::…` and `::…` mean the same everywhere, and a plain name is found through `use super::*`.
fn outward(path: TokenStream) -> TokenStream {
    let mut trees = path.clone().into_iter();
    match trees.next() {
        Some(TokenTree::Ident(first)) if first == "super" => quote! { super::#path },
        Some(TokenTree::Ident(first)) if first == "self" => {
            let rest: TokenStream = trees.collect();
            quote_spanned! { first.span() => super #rest }
        }
        _ => path,
    }
}

/// The words of a type or a path that are looked up by scope: all that do not follow a `:`.
fn first_words(stream: TokenStream) -> Vec<Ident> {
    let mut words = Vec::new();
    let mut within = false;
    for tree in stream {
        match &tree {
            TokenTree::Ident(word) if !within => words.push(word.clone()),
            TokenTree::Group(group) => words.extend(first_words(group.stream())),
            _ => {}
        }
        within = matches!(&tree, TokenTree::Punct(punct) if punct.as_char() == ':');
    }
    words
}

/// The parts between commas at the top level; commas within brackets belong to one token tree.
fn split(input: TokenStream) -> Vec<Vec<TokenTree>> {
    let mut parts = vec![Vec::new()];
    for tree in visible(input) {
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
