//! Tokens to text and back, so that files, the command line and the macros share one grammar and
//! one set of messages.
//!
//! A [`Flat`] is the text of a token stream with the place of every token in it. The compiler reads
//! the text. The bytes of an error lead back to the tokens that the author wrote, so rustc
//! underlines those, and a Rust expression inside a formula is put into the output as the very
//! tokens that it was, with their hygiene and spans.
//!
//! `TokenStream::to_string` would give a text too, but its blanks are unspecified and it says
//! nothing of places.

use std::collections::BTreeMap;

use proc_macro2::{Delimiter, Group, Ident, Spacing, Span, TokenStream, TokenTree};
use tltl_compiler::source;

/// The text of a token stream, and the place of each token in it.
///
/// Places are in the order of the text, and are ranges of its bytes.
pub(crate) struct Flat {
    pub(crate) text: String,
    /// Every token tree with its range of bytes; a group stands before its content.
    places: Vec<(usize, usize, TokenTree)>,
    /// Whether the text is the content of a string literal, whose parts have no spans of their own.
    literal: bool,
    /// What words are called in the text that others of the same letters stand before.
    renamed: BTreeMap<(String, String), String>,
}

impl Flat {
    /// Flattens the input of a macro: a formula, or one string literal that holds it.
    pub(crate) fn new(input: TokenStream) -> Self {
        Self::renaming(input, BTreeMap::new())
    }

    /// The text in which names of the same letters that are different variables have different
    /// letters; `None` if none of `names` is one of these.
    ///
    /// A `macro_rules!` macro and its caller may each have a variable `near`. Rust knows them apart
    /// by their hygiene, which a text has not; the compiler would take them for one proposition.
    pub(crate) fn told_apart(&self, input: TokenStream, names: &[String]) -> Option<Self> {
        let mut origins: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for (.., tree) in &self.places {
            let TokenTree::Ident(word) = tree else { continue };
            let known = origins.entry(word.to_string()).or_default();
            let origin = origin(word);
            if !known.contains(&origin) {
                known.push(origin);
            }
        }
        let mut renamed = BTreeMap::new();
        for (word, origins) in origins.into_iter().filter(|(word, _)| names.contains(word)) {
            let mut free = (2..).map(|i| format!("{word}_{i}"));
            for origin in origins.into_iter().skip(1) {
                let other = free.find(|other| !self.text.contains(other.as_str()))?;
                renamed.insert((word.clone(), origin), other);
            }
        }
        (!renamed.is_empty()).then(|| Self::renaming(input, renamed))
    }

    /// The text with the words of `renamed` in place of those that were written; places stay those of
    /// the author's tokens, so errors and code still have the names that the author wrote.
    fn renaming(input: TokenStream, renamed: BTreeMap<(String, String), String>) -> Self {
        let mut trees = visible(input.clone());
        if let [TokenTree::Literal(literal)] = trees.as_slice()
            && let Some(text) = unquote(&literal.to_string())
        {
            let whole = (0, text.len().max(1), trees.remove(0));
            return Self { text, places: vec![whole], literal: true, renamed };
        }
        let mut flat = Self { text: String::new(), places: Vec::new(), literal: false, renamed };
        flat.stream(input);
        flat
    }

    /// Appends the text of a stream, with a blank where two tokens must not touch.
    fn stream(&mut self, stream: TokenStream) {
        let mut before: Option<TokenTree> = None;
        let mut trees = visible(stream).into_iter().peekable();
        while let Some(tree) = trees.next() {
            if let (true, Some(line)) = (is_hash(&tree), trees.peek().and_then(doc_line)) {
                // rustc has turned the comment into an attribute; here it is a comment again.
                self.text.push_str(&format!("\n///{line}\n"));
                trees.next();
                before = None;
                continue;
            }
            if before.as_ref().is_some_and(|before| apart(before, &tree, trees.peek())) {
                self.text.push(' ');
            }
            self.tree(&tree);
            before = Some(tree);
        }
    }

    /// Appends the text of a token, and its place.
    fn tree(&mut self, tree: &TokenTree) {
        let (start, place) = (self.text.len(), self.places.len());
        self.places.push((start, start, tree.clone()));
        match tree {
            TokenTree::Group(group) => {
                let (open, close) = delimiters(group);
                self.text.push_str(open);
                self.stream(group.stream());
                self.text.push_str(close);
            }
            TokenTree::Ident(word) if !self.renamed.is_empty() => {
                let word = (word.to_string(), origin(word));
                self.text.push_str(self.renamed.get(&word).unwrap_or(&word.0));
            }
            other => self.text.push_str(&other.to_string()),
        }
        self.places[place].1 = self.text.len();
    }

    /// The first and the last token of a part of the text, for rustc to underline; past the end,
    /// the last token there is.
    pub(crate) fn spans(&self, span: source::Span) -> (Span, Span) {
        let end = span.end.max(span.start + 1);
        let mut touched: Vec<_> = self.places.iter().flat_map(marks).collect();
        touched.retain(|(at, mark)| at.0 < end && at.1 > span.start && mark.is_some());
        touched.sort_by_key(|(at, _)| *at);
        let last_of_all = || self.places.last().map(|(.., tree)| tree.span());
        let first = touched.first().and_then(|(_, mark)| *mark).or_else(last_of_all);
        let first = first.unwrap_or_else(Span::call_site);
        (first, touched.last().and_then(|(_, mark)| *mark).unwrap_or(first))
    }

    /// The tokens of a part of the text. Groups that lie in it are taken whole.
    pub(crate) fn tokens(&self, span: source::Span) -> TokenStream {
        if self.literal {
            let text = self.text.get(span.start..span.end).unwrap_or_default();
            let literal =
                self.places.first().map_or_else(Span::call_site, |(.., tree)| tree.span());
            return placed(text.parse().unwrap_or_default(), literal);
        }
        let mut at = span.start;
        let within = self.places.iter().filter(|(start, end, _)| {
            let taken = *start >= at && *end <= span.end;
            if taken {
                at = *end;
            }
            taken
        });
        within.map(|(.., tree)| tree.clone()).collect()
    }

    /// Whether the text came from a string literal.
    pub(crate) fn is_literal(&self) -> bool {
        self.literal
    }
}

/// The ranges and spans of a token that an error can point at; for a group, those of its two
/// brackets.
fn marks((start, end, tree): &(usize, usize, TokenTree)) -> [((usize, usize), Option<Span>); 2] {
    match tree {
        TokenTree::Group(group) if group.delimiter() != Delimiter::None => [
            ((*start, start + 1), Some(group.span_open())),
            ((end - 1, *end), Some(group.span_close())),
        ],
        TokenTree::Group(_) => [((*start, *start), None); 2],
        leaf => [((*start, *end), Some(leaf.span())), ((*end, *end), None)],
    }
}

/// Which macro a word comes from, by what rustc shows of its span. Stable Rust compares no spans,
/// but prints `#7 bytes(10..14)`, and words of the same letters are one variable only if their
/// numbers are the same. Where spans are shown otherwise, all words are of one origin.
fn origin(word: &Ident) -> String {
    let shown = format!("{:?}", word.span());
    shown.split_once(" bytes").map(|(origin, _)| origin.to_owned()).unwrap_or_default()
}

/// Whether a token is a `#`.
fn is_hash(tree: &TokenTree) -> bool {
    matches!(tree, TokenTree::Punct(punct) if punct.as_char() == '#')
}

/// The text of `[doc = "…"]`, the form that rustc gives to a doc comment.
fn doc_line(tree: &TokenTree) -> Option<String> {
    let TokenTree::Group(group) = tree else { return None };
    let inner: Vec<TokenTree> = group.stream().into_iter().collect();
    match inner.as_slice() {
        [TokenTree::Ident(doc), TokenTree::Punct(_), TokenTree::Literal(line)] if doc == "doc" => {
            unquote(&line.to_string()).map(|line| line.replace('\n', " "))
        }
        _ => None,
    }
}

/// The tokens without the invisible brackets around an argument of a `macro_rules!` macro, if these
/// hold one token or a path: text has no such brackets, and needs none there.
pub(crate) fn visible(stream: TokenStream) -> Vec<TokenTree> {
    let mut trees = Vec::new();
    for tree in stream {
        match &tree {
            TokenTree::Group(group) if group.delimiter() == Delimiter::None => {
                let within = visible(group.stream());
                let whole = within.len() < 2 || within.iter().all(is_of_a_path);
                if whole { trees.extend(within) } else { trees.push(tree) }
            }
            _ => trees.push(tree),
        }
    }
    trees
}

/// Whether a token can be a part of a path.
///
/// `$` stands in `$crate::…`.
fn is_of_a_path(tree: &TokenTree) -> bool {
    match tree {
        TokenTree::Ident(_) => true,
        TokenTree::Punct(punct) => matches!(punct.as_char(), ':' | '$'),
        _ => false,
    }
}

/// The tokens with the span of another place.
///
/// Rust inside of a string literal is parsed into tokens without a place of their own; this gives them
/// that of the literal, so that rustc underlines it and finds the names that are visible there.
fn placed(stream: TokenStream, span: Span) -> TokenStream {
    let placed = stream.into_iter().map(|mut tree| {
        if let TokenTree::Group(group) = &tree {
            let within = placed(group.stream(), span);
            tree = TokenTree::Group(Group::new(group.delimiter(), within));
        }
        tree.set_span(span);
        tree
    });
    placed.collect()
}

/// The brackets of a group. The invisible ones around an argument of a `macro_rules!` macro become
/// round, so that the text keeps its structure; or braces if the content begins as Rust and not as
/// a formula: a closure, a reference.
fn delimiters(group: &Group) -> (&'static str, &'static str) {
    match group.delimiter() {
        Delimiter::Parenthesis => ("(", ")"),
        Delimiter::Brace => ("{", "}"),
        Delimiter::Bracket => ("[", "]"),
        Delimiter::None => match group.stream().into_iter().next() {
            Some(TokenTree::Punct(first)) if matches!(first.as_char(), '|' | '&') => ("{", "}"),
            Some(TokenTree::Ident(first)) if first == "move" => ("{", "}"),
            _ => ("(", ")"),
        },
    }
}

/// Whether a blank belongs between two tokens: always where they would run together, else where a
/// reader wants one, since messages quote the text. `next` is the token after the second, for
/// ranges such as `1..5`.
fn apart(before: &TokenTree, after: &TokenTree, next: Option<&TokenTree>) -> bool {
    let is_dot =
        |tree: &TokenTree| matches!(tree, TokenTree::Punct(punct) if punct.as_char() == '.');
    match (before, after) {
        (TokenTree::Punct(punct), _) if punct.spacing() == Spacing::Joint => false,
        // What the author kept apart must not become one symbol, as `: :` would.
        (TokenTree::Punct(_), TokenTree::Punct(_)) => true,
        // A number must not take the dot of what follows, as in `1 .5`; two dots are a range.
        (TokenTree::Literal(number), TokenTree::Punct(punct)) if punct.as_char() == '.' => {
            let range = punct.spacing() == Spacing::Joint && next.is_some_and(is_dot);
            !range || number.to_string().ends_with('.')
        }
        (TokenTree::Punct(punct), _) => !matches!(punct.as_char(), '.' | ':' | '!' | '#'),
        (_, TokenTree::Punct(punct)) => !matches!(punct.as_char(), '.' | ':' | ',' | ';'),
        (TokenTree::Ident(_), TokenTree::Group(group)) => group.delimiter() == Delimiter::Brace,
        _ => true,
    }
}

/// The content of a string literal, plain or raw, with its escapes resolved; `None` if it is
/// another literal. `proc_macro` offers no way to read one on stable Rust, and `syn` would have to
/// be built for this alone.
fn unquote(literal: &str) -> Option<String> {
    if let Some(raw) = literal.strip_prefix('r') {
        let body = raw.trim_matches('#');
        return Some(body.strip_prefix('"')?.strip_suffix('"')?.to_owned());
    }
    let body = literal.strip_prefix('"')?.strip_suffix('"')?;
    let mut text = String::with_capacity(body.len());
    let mut rest = body.chars();
    while let Some(c) = rest.next() {
        match (c, c == '\\') {
            (c, false) => text.push(c),
            // A line that goes on: the line break and the blanks after it are nothing.
            (_, true) if rest.as_str().starts_with('\n') => {
                rest = rest.as_str().trim_start().chars();
            }
            (_, true) => text.push(escaped(&mut rest)?),
        }
    }
    Some(text)
}

/// The character that an escape stands for, after its backslash.
///
/// Those of Rust: `\n`, `\x41`, `\u{25c7}` and the rest. rustc has refused all others by then.
fn escaped(rest: &mut std::str::Chars<'_>) -> Option<char> {
    Some(match rest.next()? {
        'n' => '\n',
        't' => '\t',
        'r' => '\r',
        '0' => '\0',
        'x' => {
            let code: String = rest.by_ref().take(2).collect();
            char::from(u8::from_str_radix(&code, 16).ok()?)
        }
        'u' => {
            let code: String = rest.by_ref().skip(1).take_while(|&c| c != '}').collect();
            char::from_u32(u32::from_str_radix(&code.replace('_', ""), 16).ok()?)?
        }
        other => other,
    })
}

#[cfg(test)]
#[path = "tokens/tests.rs"]
mod tests;
