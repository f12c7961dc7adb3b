//! Mistakes of a source, reported to its author.
//!
//! An [`Error`] says in one sentence what is wrong, in the author's own words, points at the place
//! and at the other places that matter, and ends with what to do. The command line, the macros and
//! the tests show the same text. All mistakes of a source are collected and reported together, in
//! source order: a stage never stops at the first.
//!
//! Errors are opaque: a kind, a span and a message with private fields, built by chained methods,
//! so that a new part (such as `related`) changes no caller. The compiler itself never
//! warns. The tools do, with errors of a lower [`Severity`], so that they look the same.
//!
//! ```
//! use tltl_compiler::error::{Error, Kind, Style};
//! use tltl_compiler::source::{Source, Span};
//!
//! let source = Source::new("room.tltl", "task home = F hme\n");
//! let error = Error::new(Kind::UnknownName, "`hme` is not declared", Span::new(14, 17))
//!     .help("did you mean `home`?");
//! assert_eq!(error.render(&source, Style::Plain), "\
//! error[unknown-name]: `hme` is not declared
//!  --> room.tltl:1:15
//!   |
//! 1 | task home = F hme
//!   |               ^^^
//!   = help: did you mean `home`?
//! ");
//! ```

mod render;

use std::fmt;

pub use render::Style;

use crate::intern::order;
use crate::source::{Source, Span};

/// The kind of a mistake. Its [`name`](Kind::name) is part of the output for machines and stays the
/// same across versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Kind {
    /// The text is not of the language.
    Syntax,
    /// Brackets nest too deep.
    Nesting,
    /// A number is too large to be exact.
    Number,
    /// An operator of another temporal logic, which is not co-safe or looks back.
    UnsupportedOperator,
    /// A negation before a temporal operator, whose negation is not co-safe.
    NegatedTemporal,
    /// A name is not declared.
    UnknownName,
    /// A name is declared twice.
    DuplicateName,
    /// A keyword stands where a name is declared.
    Keyword,
    /// Items are defined by each other in a circle.
    Cycle,
    /// A number where a formula is needed, or the like.
    Type,
    /// Numbers of different units, or a unit that does not exist.
    Unit,
    /// A bound of a temporal operator that is empty, lies in the past or cannot stand there.
    Bound,
    /// A comparison chain that points both ways.
    Chain,
    /// A declaration that nothing uses.
    Unused,
    /// A predicate or task that never holds.
    Unsatisfiable,
    /// A predicate or task that always holds.
    Valid,
    /// A formula that probably means something else than it says.
    Intent,
    /// A part of a formula that does not matter.
    Vacuous,
    /// The automaton grows beyond its budget.
    Budget,
    /// An automaton that no formula could have.
    Automaton,
}

impl Kind {
    /// Its name, as in `error[unknown-name]`.
    ///
    /// ```
    /// assert_eq!(tltl_compiler::error::Kind::NegatedTemporal.name(), "negated-temporal");
    /// ```
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Syntax => "syntax",
            Self::Nesting => "nesting",
            Self::Number => "number",
            Self::UnsupportedOperator => "unsupported-operator",
            Self::NegatedTemporal => "negated-temporal",
            Self::UnknownName => "unknown-name",
            Self::DuplicateName => "duplicate-name",
            Self::Keyword => "keyword",
            Self::Cycle => "cycle",
            Self::Type => "type",
            Self::Unit => "unit",
            Self::Bound => "bound",
            Self::Chain => "chain",
            Self::Unused => "unused",
            Self::Unsatisfiable => "unsatisfiable",
            Self::Valid => "valid",
            Self::Intent => "intent",
            Self::Vacuous => "vacuous",
            Self::Budget => "budget",
            Self::Automaton => "automaton",
        }
    }
}

/// Whether compilation can go on.
///
/// ```
/// use tltl_compiler::error::{Error, Kind, Severity};
/// use tltl_compiler::source::Span;
///
/// let error = Error::new(Kind::Unused, "the predicate `far` is not used", Span::new(0, 3));
/// let warning = error.clone().warning();
/// assert_eq!((error.severity(), warning.severity()), (Severity::Error, Severity::Warning));
/// assert_eq!((warning.is_warning(), warning.message()), (true, error.message()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Severity {
    /// It cannot.
    Error,
    /// It can, but the author should look.
    Warning,
}

/// One mistake: a sentence, the place, further places, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    kind: Kind,
    severity: Severity,
    message: String,
    span: Span,
    label: String,
    related: Vec<(Span, String)>,
    help: Vec<String>,
}

impl Error {
    /// The mistake that `message` reports, one sentence without a full stop, at `span`.
    #[must_use]
    pub fn new(kind: Kind, message: impl Into<String>, span: Span) -> Self {
        Self {
            kind,
            severity: Severity::Error,
            message: bounded(message.into()),
            span,
            label: String::new(),
            related: Vec::new(),
            help: Vec::new(),
        }
    }

    /// The same as a warning.
    #[must_use]
    pub fn warning(mut self) -> Self {
        self.severity = Severity::Warning;
        self
    }

    /// Writes `label` beside the place of the mistake.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = bounded(label.into());
        self
    }

    /// Points at another place that matters.
    ///
    /// ```
    /// use tltl_compiler::error::{Error, Kind};
    /// use tltl_compiler::source::Span;
    ///
    /// let error = Error::new(Kind::DuplicateName, "`a` is declared twice", Span::new(20, 21))
    ///     .label("declared again here")
    ///     .related(Span::new(5, 6), "first declared here");
    /// assert_eq!(error.places(), [(Span::new(5, 6), "first declared here".to_owned())]);
    /// ```
    #[must_use]
    pub fn related(mut self, span: Span, label: impl Into<String>) -> Self {
        self.related.push((span, bounded(label.into())));
        self
    }

    /// Adds a line that says what to do.
    ///
    /// ```
    /// use tltl_compiler::error::{Error, Kind};
    /// use tltl_compiler::source::Span;
    ///
    /// let error = Error::new(Kind::UnknownName, "nothing here is called `hme`", Span::new(14, 17))
    ///     .help("did you mean `home`?");
    /// assert_eq!(error.helps(), ["did you mean `home`?"]);
    /// assert_eq!(error.to_string(), "nothing here is called `hme`\nhelp: did you mean `home`?");
    /// ```
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(bounded(help.into()));
        self
    }

    /// The same mistake in a text that has `by` bytes more before.
    ///
    /// ```
    /// use tltl_compiler::error::{Error, Kind};
    /// use tltl_compiler::source::Span;
    ///
    /// let error = Error::new(Kind::Syntax, "`*` cannot stand here", Span::new(0, 1));
    /// assert_eq!(error.moved(40).span(), Span::new(40, 41));
    /// ```
    #[must_use]
    pub fn moved(mut self, by: usize) -> Self {
        self.span = self.span.shifted(by);
        self.related.iter_mut().for_each(|(span, _)| *span = span.shifted(by));
        self
    }

    /// Leaves out the advice that `keep` refuses.
    pub(crate) fn keep_helps(&mut self, keep: &dyn Fn(&str) -> bool) {
        self.help.retain(|help| keep(help));
    }

    /// The kind of the mistake.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Whether it is an error or a warning.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// Whether it is a warning.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        self.severity == Severity::Warning
    }

    /// The sentence that says what is wrong.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The place of the mistake.
    #[must_use]
    pub fn span(&self) -> Span {
        self.span
    }

    /// The text beside the place of the mistake; empty if there is none.
    #[must_use]
    pub fn place_label(&self) -> &str {
        &self.label
    }

    /// The other places that matter, each with its text.
    #[must_use]
    pub fn places(&self) -> &[(Span, String)] {
        &self.related
    }

    /// The advice, a string a line.
    #[must_use]
    pub fn helps(&self) -> &[String] {
        &self.help
    }

    /// The whole report, with the lines of `source` that it points at.
    #[must_use]
    pub fn render(&self, source: &Source, style: Style) -> String {
        render::report(self, source, style)
    }
}

/// The longest sentence, in characters. Names and formulas in a message may have any length, and
/// nobody reads more.
const LONGEST: usize = 400;

/// The text, cut to the longest sentence.
fn bounded(mut text: String) -> String {
    if let Some((end, _)) = text.char_indices().nth(LONGEST) {
        text.truncate(end);
        text.push('…');
    }
    text
}

impl fmt::Display for Error {
    /// The message and the help lines, for where the place is shown by other means.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        self.help.iter().try_for_each(|help| write!(f, "\nhelp: {help}"))
    }
}

impl std::error::Error for Error {}

/// The most mistakes that are reported at once; the last of them says how many more there are. A source
/// with more is most likely not of this language.
const MOST: usize = 100;

/// All mistakes of a source: at least one error, in source order; warnings may stand among them.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let text = "state Cell { x: i32 }\ntask a = F (x < up)\ntask b = F (y > 0)\n";
/// let errors = compile::file(&Source::new("cell.tltl", text), Budget::EMITTED).unwrap_err();
/// // Both mistakes, not only the first.
/// let names: Vec<&str> = errors.iter().map(|error| error.kind().name()).collect();
/// assert_eq!(names, ["unknown-name", "unknown-name"]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Errors(Vec<Error>);

impl Errors {
    /// `Err` of the mistakes if there are any. Sorts them by place and drops repetitions: the body
    /// of a quantifier is checked once for each element, and reports the same mistake each time.
    ///
    /// ```
    /// use tltl_compiler::error::{Error, Errors, Kind};
    /// use tltl_compiler::source::Span;
    ///
    /// assert!(Errors::check(Vec::new()).is_ok());
    /// let later = Error::new(Kind::UnknownName, "nothing here is called `b`", Span::new(6, 7));
    /// let error = Error::new(Kind::Type, "`far` is a number", Span::new(0, 3));
    /// let errors = Errors::check(vec![later.clone(), error, later]).unwrap_err();
    /// assert_eq!(errors.iter().map(|error| error.span().start).collect::<Vec<_>>(), [0, 6]);
    /// ```
    ///
    /// # Errors
    /// If there is one among them.
    pub fn check(mistakes: Vec<Error>) -> Result<(), Self> {
        let mut distinct: Vec<Error> = Vec::new();
        for mistake in sorted(&mistakes) {
            let mut here = distinct.iter().rev().take_while(|known| known.span == mistake.span);
            if !here.any(|known| known == mistake) {
                distinct.push(mistake.clone());
            }
        }
        let hidden = distinct.len().saturating_sub(MOST);
        distinct.truncate(MOST);
        if let (Some(last), 1..) = (distinct.last_mut(), hidden) {
            last.help.push(format!("{hidden} more mistakes are not shown"));
        }
        if distinct.is_empty() { Ok(()) } else { Err(Self(distinct)) }
    }

    /// The mistakes in source order.
    pub fn iter(&self) -> std::slice::Iter<'_, Error> {
        self.0.iter()
    }

    /// The same with `warnings` among them, in source order.
    #[must_use]
    pub fn with(mut self, warnings: Vec<Error>) -> Self {
        self.0.extend(warnings);
        Self(sorted(&self.0).cloned().collect())
    }

    /// The first error; warnings are passed over.
    #[must_use]
    pub fn first(&self) -> &Error {
        self.0.iter().find(|error| !error.is_warning()).unwrap_or(&self.0[0])
    }

    /// All reports, an empty line between them.
    #[must_use]
    pub fn render(&self, source: &Source, style: Style) -> String {
        let reports: Vec<_> = self.0.iter().map(|error| error.render(source, style)).collect();
        reports.join("\n")
    }
}

/// Mistakes by their place; those at one place stay in the order in which they were found.
fn sorted(mistakes: &[Error]) -> impl Iterator<Item = &Error> {
    let spans = mistakes.iter().map(|mistake| (mistake.span.start, mistake.span.end));
    order(spans).into_iter().map(|place| &mistakes[place])
}

impl From<Error> for Errors {
    fn from(error: Error) -> Self {
        Self(vec![error])
    }
}

impl IntoIterator for Errors {
    type Item = Error;
    type IntoIter = std::vec::IntoIter<Error>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a Errors {
    type Item = &'a Error;
    type IntoIter = std::slice::Iter<'a, Error>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.0.iter().enumerate() {
            write!(f, "{}{error}", if i == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl std::error::Error for Errors {}
