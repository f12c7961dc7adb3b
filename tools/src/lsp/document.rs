//! An open document, and what an editor asks of it.

use std::fmt::Write as _;

use serde_json::{Value, json};
use tltl_compiler::ast::{Ast, Infix, Node, NodeId, Prefix};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::error::{Error, Kind as Mistake};
use tltl_compiler::parse;
use tltl_compiler::predicate::Function;
use tltl_compiler::source::{Source, Span};
use tltl_compiler::translate::Budget;

use super::known::{self, Word};
use super::place::{Lines, Position};
use crate::explain::retold;
use crate::format::format;
use crate::names::{Kind, Names, SymbolId};
use crate::task::{CompileError, Entry, TaskFile};
use crate::trace::shortest;

/// The largest text that is read. A larger one gets a diagnostic that says so, and no answers.
const MOST_BYTES: usize = 1 << 20;

/// A text with what is known of it. A change makes a new one.
pub(super) struct Document {
    source: Source,
    version: Value,
    lines: Lines,
    /// Made when it is first asked for.
    read: Option<Read>,
    /// Whether its diagnostics have been sent.
    is_told: bool,
}

/// A text as the compiler reads it.
struct Read {
    ast: Ast,
    names: Names,
    made: Result<TaskFile, CompileError>,
}

impl Document {
    pub(super) fn new(uri: &str, text: String, version: Value) -> Self {
        let lines = Lines::new(&text);
        let name = uri.rsplit('/').next().unwrap_or(uri);
        Self { source: Source::new(name, text), version, lines, read: None, is_told: false }
    }

    fn text(&self) -> &str {
        self.source.text()
    }

    fn is_too_large(&self) -> bool {
        self.text().len() > MOST_BYTES
    }

    /// The byte at a position.
    pub(super) fn byte(&self, at: Position) -> usize {
        self.lines.byte(self.text(), at)
    }

    fn range(&self, span: Span) -> Value {
        json!(self.lines.range(self.text(), span))
    }

    /// The text as the compiler reads it; nothing of one that is too large.
    fn read(&mut self) -> Option<&Read> {
        if self.is_too_large() {
            return None;
        }
        if self.read.is_none() {
            let (ast, _) = parse::recover_file(&self.source);
            let names = Names::new(&ast);
            let made = TaskFile::new(self.source.clone(), Budget::EMITTED);
            self.read = Some(Read { ast, names, made });
        }
        self.read.as_ref()
    }

    /// Its diagnostics, if they have not been sent.
    pub(super) fn news(&mut self, uri: &str) -> Option<Value> {
        if std::mem::replace(&mut self.is_told, true) {
            return None;
        }
        let errors: Vec<Error> = match self.read() {
            None => {
                let message = format!(
                    "this file has more than {MOST_BYTES} bytes, which is too much while one types; \
                     `tltlc check` reads it"
                );
                vec![Error::new(Mistake::Budget, message, Span::default()).warning()]
            }
            Some(Read { made: Ok(file), .. }) => file.warnings(),
            Some(Read { made: Err(error), .. }) => error.errors().iter().cloned().collect(),
        };
        let diagnostics: Vec<_> = errors.iter().map(|error| self.diagnostic(error, uri)).collect();
        Some(json!({"uri": uri, "version": self.version, "diagnostics": diagnostics}))
    }

    fn diagnostic(&self, error: &Error, uri: &str) -> Value {
        let mut message = error.message().to_owned();
        error.helps().iter().for_each(|help| message += &format!("\nhelp: {help}"));
        let related = error.places().iter().map(|(span, label)| {
            json!({"location": {"uri": uri, "range": self.range(*span)}, "message": label})
        });
        let mut diagnostic = json!({
            "range": self.range(error.span()),
            "severity": if error.is_warning() { 2 } else { 1 },
            "code": error.kind().name(),
            "source": "tltlc",
            "message": message,
            "relatedInformation": related.collect::<Vec<_>>(),
        });
        if error.kind() == Mistake::Unused {
            diagnostic["tags"] = json!([1]);
        }
        diagnostic
    }

    /// What stands at a byte, in Markdown.
    pub(super) fn hover(&mut self, at: usize) -> Value {
        let Some(read) = self.read() else { return Value::Null };
        let (text, span) = match (read.names.at(at), read.names.span_at(at)) {
            (ids @ [_, ..], Some(span)) => {
                let told: Vec<_> = ids.iter().map(|id| read.told(*id)).collect();
                (told.join("\n\n---\n\n"), span)
            }
            _ => match operator(&read.ast, at) {
                Some((word, span)) => (word.means.to_owned(), span),
                None => return Value::Null,
            },
        };
        json!({"contents": {"kind": "markdown", "value": text}, "range": self.range(span)})
    }

    /// Where the name at a byte is declared.
    pub(super) fn definition(&mut self, at: usize, uri: &str) -> Value {
        let Some(read) = self.read() else { return Value::Null };
        let spans: Vec<_> =
            read.names.at(at).iter().map(|id| read.names.symbol(*id).name).collect();
        self.locations(&spans, uri)
    }

    /// Where the name at a byte stands.
    pub(super) fn references(&mut self, at: usize, uri: &str) -> Value {
        let Some(read) = self.read() else { return Value::Null };
        let mut spans: Vec<_> =
            read.names.at(at).iter().flat_map(|id| read.names.places(*id)).collect();
        spans.sort_unstable();
        spans.dedup();
        self.locations(&spans, uri)
    }

    fn locations(&self, spans: &[Span], uri: &str) -> Value {
        let place = |span: &Span| json!({"uri": uri, "range": self.range(*span)});
        spans.iter().map(place).collect()
    }

    /// The place of the name at a byte.
    pub(super) fn name(&mut self, at: usize) -> Value {
        let span = self.read().and_then(|read| read.names.span_at(at));
        span.map_or(Value::Null, |span| self.range(span))
    }

    /// The edits that give the name at a byte another one; `Err` says why there are none.
    pub(super) fn rename(&mut self, at: usize, to: &str, uri: &str) -> Result<Value, String> {
        let Some(read) = self.read() else { return Ok(Value::Null) };
        let id = match read.names.at(at) {
            [] => return Err("there is no name here that this file declares".to_owned()),
            [id, ..] => *id,
        };
        let (_, spans) = read.names.renamed(id, to).map_err(|refused| refused.to_string())?;
        let edit = |span: &Span| json!({"range": self.range(*span), "newText": to});
        Ok(json!({"changes": {uri: spans.iter().map(edit).collect::<Vec<_>>()}}))
    }

    /// The edits that lay the text out; nothing while it has mistakes of form.
    pub(super) fn laid_out(&self) -> Value {
        if self.is_too_large() || parse::file(&self.source).is_err() {
            return Value::Null;
        }
        let Some(laid_out) = format(self.text()).filter(|laid_out| laid_out != self.text()) else {
            return json!([]);
        };
        let all = Span::new(0, self.text().len());
        json!([{"range": self.range(all), "newText": laid_out}])
    }

    /// What may be written at a byte.
    pub(super) fn completion(&mut self, at: usize) -> Value {
        let line = self.source.line(at);
        let before = self.text()[line.start.min(at)..at].trim_end_matches(is_of_name).to_owned();
        let Some(read) = self.read() else { return Value::Null };
        let items = read.completions(&before, at);
        json!({"isIncomplete": false, "items": items})
    }
}

impl Read {
    /// A declaration as a reader wants it, in Markdown.
    fn told(&self, id: SymbolId) -> String {
        let symbol = self.names.symbol(id);
        let source = self.ast.source();
        let mut shown = source.slice(symbol.shown).trim_end().to_owned();
        if let (Kind::Value, Some(owner)) = (symbol.kind, symbol.owner) {
            shown = format!("{}::{shown}", self.names.name(owner));
        }
        let mut told = format!("```tltl\n{shown}\n```");
        if !symbol.docs.is_empty() {
            let _ = write!(told, "\n\n{}", symbol.docs.join("\n").trim());
        }
        if symbol.kind == Kind::Task
            && let Ok(file) = &self.made
            && let Ok(entry) = file.find(Some(self.names.name(id)))
        {
            let _ = write!(told, "\n\n{}", explained(&entry));
        }
        told
    }

    /// What may be written behind `before` on its line.
    fn completions(&self, before: &str, at: usize) -> Vec<Value> {
        if let Some(path) = before.strip_suffix("::") {
            let owner = last_path(path);
            let owner = self.names.symbols().find(|(id, symbol)| {
                symbol.kind == Kind::Enumeration && self.names.name(*id) == owner
            });
            let values = owner.into_iter().flat_map(|(owner, _)| self.names.members(owner));
            return values.map(|id| self.completed(id)).collect();
        }
        if let Some(path) = before.strip_suffix('.') {
            return self.names.behind(last_path(path)).map(|id| self.completed(id)).collect();
        }
        if before.trim_end().ends_with(':') && !self.is_in_quantifier(before) {
            return self.types();
        }
        let item =
            self.ast.items().iter().position(|item| item.span.start <= at && at <= item.span.end);
        let line_start = before.trim().is_empty();
        let known = self.names.symbols().filter(|(_, symbol)| match symbol.kind {
            Kind::Parameter | Kind::Bound => {
                symbol.scope.is_some_and(|scope| scope.start <= at && at <= scope.end)
            }
            Kind::Field => {
                symbol.owner.is_some_and(|owner| self.names.symbol(owner).kind == Kind::State)
            }
            Kind::Constant | Kind::Predicate | Kind::Task => Some(symbol.item) != item,
            Kind::Value | Kind::Enumeration => true,
            Kind::State | Kind::Struct => false,
        });
        let mut items: Vec<_> = known.map(|(id, _)| self.completed(id)).collect();
        let mut words = |kind: u8, words: &[Word]| {
            items.extend(words.iter().map(|Word { word, means }| {
                let means = json!({"kind": "markdown", "value": means});
                json!({"label": word, "kind": kind, "documentation": means})
            }));
        };
        if line_start {
            words(14, &known::ITEMS);
        }
        words(24, &known::OPERATORS);
        words(14, &known::VALUES);
        items.extend(Function::ALL.map(|(name, ..)| json!({"label": name, "kind": 3})));
        items
    }

    /// Whether a colon ends the head of a quantifier, and no declaration.
    fn is_in_quantifier(&self, before: &str) -> bool {
        ["for all ", "for some "].iter().any(|words| before.contains(words))
    }

    fn types(&self) -> Vec<Value> {
        let own = self
            .names
            .symbols()
            .filter(|(_, symbol)| matches!(symbol.kind, Kind::Struct | Kind::Enumeration));
        let own = own.map(|(id, _)| self.completed(id));
        own.chain(known::TYPES.map(|name| json!({"label": name, "kind": 25}))).collect()
    }

    /// A declaration as an editor offers it.
    fn completed(&self, id: SymbolId) -> Value {
        let symbol = self.names.symbol(id);
        let kind = match symbol.kind {
            Kind::State | Kind::Struct => 22,
            Kind::Enumeration => 13,
            Kind::Constant => 21,
            Kind::Predicate | Kind::Task => 3,
            Kind::Field => 5,
            Kind::Value => 20,
            Kind::Parameter | Kind::Bound => 6,
        };
        let shown = self.ast.source().slice(symbol.shown);
        let mut item = json!({
            "label": self.names.name(id),
            "kind": kind,
            "detail": tltl_compiler::ast::quoted(shown),
            // Before the words of the language, among which an editor would sort it.
            "sortText": format!("0{}", self.names.name(id)),
        });
        if !symbol.docs.is_empty() {
            let docs = symbol.docs.join("\n");
            item["documentation"] = json!({"kind": "markdown", "value": docs.trim()});
        }
        item
    }
}

/// What a task means and how large its automaton is, in Markdown.
fn explained(entry: &Entry) -> String {
    let mut told = retold(&entry.task().spec).join("\n");
    if !told.is_empty() {
        told = format!("```text\n{told}\n```\n\n");
    }
    let Some(automata) = entry.automata() else {
        return told + "It is factored: its parts have automata of their own.";
    };
    let dfa = &automata.dfa;
    let size = dfa.size();
    let _ = write!(told, "{} states, {} edges", size.states, size.edges);
    let mut trace = |name: &str, dfa: &Dfa, to: Option<u32>| {
        if let Some(trace) = to.and_then(|to| shortest(dfa, 0, &|q| q == to)) {
            let _ =
                write!(told, "  \n{name}: `{}`", tltl_compiler::ast::quoted(&trace.to_string()));
        }
    };
    trace("a shortest trajectory that satisfies it", dfa, dfa.accepting);
    trace("a shortest that loses it for good", dfa, dfa.trap);
    told
}

/// The innermost operator of a formula at a byte that is written as a word or a sign of its own.
fn operator(ast: &Ast, at: usize) -> Option<(&'static Word, Span)> {
    let roots = ast.items().iter().filter_map(|item| match item.kind {
        tltl_compiler::ast::ItemKind::Predicate(_, root)
        | tltl_compiler::ast::ItemKind::Task(_, root) => Some(root),
        _ => None,
    });
    let nodes = roots.flat_map(|root| (ast.first(root).0..=root.0).map(NodeId));
    let found = nodes.filter_map(|id| {
        let span = ast.entry(id).operator;
        let word = match ast.node(id) {
            Node::Prefix(Prefix::Eventually, _) => "F",
            Node::Prefix(Prefix::Next, _) => "X",
            Node::Prefix(Prefix::Always, _) => "G",
            Node::Prefix(Prefix::Not, _) => "not",
            Node::Infix(Infix::Until, ..) => "U",
            Node::Infix(Infix::Then, ..) => "T",
            Node::Infix(Infix::And, ..) => "and",
            Node::Infix(Infix::Or, ..) => "or",
            Node::Infix(Infix::Ensuring, ..) => "ensuring",
            Node::Quantified(quantifier) if quantifier.all => "for all",
            Node::Quantified(_) => "for some",
            _ => return None,
        };
        (span.start <= at && at < span.end).then_some((word, span))
    });
    let (word, span) = found.min_by_key(|(_, span)| span.end - span.start)?;
    known::OPERATORS.iter().find(|known| known.word == word).map(|known| (known, span))
}

fn is_of_name(c: char) -> bool {
    c == '_' || unicode_ident::is_xid_continue(c)
}

/// The path that a text ends with: `arm.joints[2]` of `F arm.joints[2]`.
fn last_path(text: &str) -> &str {
    let is_of_path = |c: char| is_of_name(c) || matches!(c, '.' | '[' | ']');
    let start = text.rfind(|c: char| !is_of_path(c));
    start.map_or(text, |at| text[at..].trim_start_matches(|c: char| !is_of_path(c)))
}
