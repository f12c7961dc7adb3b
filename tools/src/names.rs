//! What each name of a task file stands for: where it is declared, and everywhere it is used.
//!
//! The compiler answers names while it writes quantifiers out, and keeps no list of them; a macro
//! user would pay for it. This is the same scoping over the syntax tree: names bound by `for`,
//! parameters, items, fields of the state, values of enumerations. It takes a tree with mistakes,
//! since an editor asks while its user types. Where types would have to decide, as between two
//! enumerations with a value of one name, a name has several meanings here.
//!
//! Renaming is checked, not argued: the new text is read again, and unless every name in it means
//! what it meant, it is refused. The cost of everything is linear in the source.
//!
//! ```
//! use tltl_compiler::{parse, source::Source};
//! use tltlc::names::{Kind, Names};
//!
//! let text = "state Robot { x: f64 }\npredicate near = x < 1\ntask go = F near";
//! let (ast, _) = parse::recover_file(&Source::new("go.tltl", text));
//! let names = Names::new(&ast);
//! let [near] = names.at(text.len())[..] else { panic!("one meaning") };
//! assert_eq!((names.symbol(near).kind, names.places(near).len()), (Kind::Predicate, 2));
//! ```

mod collect;

use tltl_compiler::ast::Ast;
use tltl_compiler::parse;
use tltl_compiler::source::{Source, Span};

/// The kind of a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "each is what it is called in the language")]
pub enum Kind {
    State,
    Struct,
    Enumeration,
    Constant,
    Predicate,
    Task,
    Field,
    Value,
    Parameter,
    /// A name that `for all` or `for some` binds.
    Bound,
}

/// A declaration.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// Its kind.
    pub kind: Kind,
    /// The place of its name.
    pub name: Span,
    /// The author's docs, a string a line.
    pub docs: Vec<String>,
    /// The declaration as it is written, or what of it a reader wants.
    pub shown: Span,
    /// The number of the item that it belongs to; for an item its own number.
    pub item: usize,
    /// For a field the struct or the state, for a value the enumeration.
    pub owner: Option<SymbolId>,
    /// The part of the source in which it is known; all of it if it is known everywhere.
    pub scope: Option<Span>,
    /// The type of a field.
    ty: Option<Type>,
}

/// A declaration of [`Names`], by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SymbolId(pub u32);

/// The type of a place, as far as the way goes on from it.
#[derive(Clone, Copy, Debug)]
struct Type {
    /// The name of the innermost type.
    name: Span,
    /// The number of brackets around it.
    depth: usize,
}

/// A name in the source, with all that it may mean.
#[derive(Clone, Debug)]
struct Use {
    span: Span,
    means: Vec<SymbolId>,
}

/// The declarations of a task file and their uses.
#[derive(Clone, Debug)]
pub struct Names {
    source: Source,
    symbols: Vec<Symbol>,
    /// In the order of the source.
    uses: Vec<Use>,
}

/// Why a declaration cannot be given another name. It prints as a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refused {
    /// The text is not a name.
    NoName(String),
    /// A use of the name may mean something else too.
    Shared(String),
    /// Something would mean something else.
    Taken(String),
}

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoName(text) => write!(f, "`{text}` cannot be a name"),
            Self::Shared(name) => write!(
                f,
                "`{name}` has several meanings in this file, and types decide which: write \
                 `Enumeration::{name}` first"
            ),
            Self::Taken(text) => {
                write!(f, "with the name `{text}` something in this file would mean something else")
            }
        }
    }
}

impl std::error::Error for Refused {}

impl Names {
    /// The names of a source, whatever mistakes it has.
    #[must_use]
    pub fn new(ast: &Ast) -> Self {
        let (symbols, mut uses) = collect::collect(ast);
        uses.sort_by_key(|name| name.span);
        Self { source: ast.source().clone(), symbols, uses }
    }

    /// What the name at a byte means; nothing if there is no name that is declared here.
    #[must_use]
    pub fn at(&self, byte: usize) -> &[SymbolId] {
        self.use_at(byte).map_or(&[], |name| &name.means)
    }

    /// The place of the name at a byte.
    #[must_use]
    pub fn span_at(&self, byte: usize) -> Option<Span> {
        self.use_at(byte).map(|name| name.span)
    }

    fn use_at(&self, byte: usize) -> Option<&Use> {
        let after = self.uses.partition_point(|name| name.span.start <= byte);
        // An editor's cursor stands behind the name that was just typed.
        self.uses[..after].last().filter(|name| byte <= name.span.end)
    }

    /// A declaration.
    #[must_use]
    pub fn symbol(&self, id: SymbolId) -> &Symbol {
        &self.symbols[id.0 as usize]
    }

    /// The name of a declaration.
    #[must_use]
    pub fn name(&self, id: SymbolId) -> &str {
        self.source.slice(self.symbol(id).name)
    }

    /// All declarations: those of items in the order of the source, then the names that are bound.
    pub fn symbols(&self) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        (0..).map(SymbolId).zip(&self.symbols)
    }

    /// The places of a name, its declaration among them, in the order of the source.
    #[must_use]
    pub fn places(&self, id: SymbolId) -> Vec<Span> {
        let mine = self.uses.iter().filter(|name| name.means.contains(&id));
        mine.map(|name| name.span).collect()
    }

    /// The text with another name for a declaration, and the places that change.
    ///
    /// # Errors
    /// If the new name is no name, if it would change what something means, or if only types could
    /// tell which uses are meant.
    ///
    /// ```
    /// use tltl_compiler::{parse, source::Source};
    /// use tltlc::names::{Names, Refused};
    ///
    /// let text = "state S { x: f64 }\npredicate near = x < 1\ntask go = F near";
    /// let (ast, _) = parse::recover_file(&Source::new("go.tltl", text));
    /// let names = Names::new(&ast);
    /// let near = names.at(text.len())[0];
    /// let (renamed, places) = names.renamed(near, "close").unwrap();
    /// assert!(renamed.ends_with("task go = F close") && places.len() == 2);
    /// assert_eq!(names.renamed(near, "x").unwrap_err(), Refused::Taken("x".into()));
    /// assert_eq!(names.renamed(near, "U").unwrap_err(), Refused::NoName("U".into()));
    /// ```
    pub fn renamed(&self, id: SymbolId, to: &str) -> Result<(String, Vec<Span>), Refused> {
        if !is_name(to) {
            return Err(Refused::NoName(to.to_owned()));
        }
        let mine = || self.uses.iter().filter(|name| name.means.contains(&id));
        if mine().any(|name| name.means.len() > 1) {
            return Err(Refused::Shared(self.name(id).to_owned()));
        }
        let places: Vec<Span> = mine().map(|name| name.span).collect();
        let (mut text, mut end) = (String::new(), 0);
        for place in &places {
            text.push_str(&self.source.text()[end..place.start]);
            text.push_str(to);
            end = place.end;
        }
        text.push_str(&self.source.text()[end..]);
        let source = Source::new(self.source.name(), text.as_str());
        let (ast, _) = parse::recover_file(&source);
        let again = Self::new(&ast);
        let alike = |a: &Use, b: &Use| a.means == b.means;
        let same = again.symbols.len() == self.symbols.len()
            && again.uses.len() == self.uses.len()
            && again.uses.iter().zip(&self.uses).all(|(a, b)| alike(a, b))
            && !self.is_declared_beside(id, to);
        if same { Ok((text, places)) } else { Err(Refused::Taken(to.to_owned())) }
    }

    /// Whether something that is known where `id` is has this name already.
    fn is_declared_beside(&self, id: SymbolId, name: &str) -> bool {
        let mine = self.symbol(id);
        let meets = |other: &Symbol| match (mine.kind, other.kind) {
            (Kind::Value, Kind::Value) => mine.owner == other.owner,
            // Fields of the state are names by themselves, those of structs follow a dot.
            (Kind::Field, Kind::Field) => mine.owner == other.owner,
            (Kind::Field, _) => self.is_of_state(mine),
            (_, Kind::Field) => self.is_of_state(other),
            (Kind::Bound | Kind::Parameter, Kind::Bound | Kind::Parameter) => {
                let scopes = mine.scope.zip(other.scope);
                scopes.is_some_and(|(a, b)| a.start < b.end && b.start < a.end)
            }
            _ => true,
        };
        self.symbols()
            .any(|(other, symbol)| other != id && self.name(other) == name && meets(symbol))
    }

    fn is_of_state(&self, field: &Symbol) -> bool {
        field.owner.is_some_and(|owner| self.symbol(owner).kind == Kind::State)
    }

    /// The fields behind `path.`, where `path` is a text such as `arm.joints[2]`.
    ///
    /// ```
    /// use tltl_compiler::{parse, source::Source};
    /// use tltlc::names::Names;
    ///
    /// let text = "struct P { x: f64, y: f64 }\nstate S { at: [P; 3] }\ntask t = F at[0].x > 1";
    /// let (ast, _) = parse::recover_file(&Source::new("t.tltl", text));
    /// let names = Names::new(&ast);
    /// let fields: Vec<_> = names.behind("at[0]").map(|id| names.name(id)).collect();
    /// assert_eq!(fields, ["x", "y"]);
    /// ```
    pub fn behind<'a>(&'a self, path: &str) -> impl Iterator<Item = SymbolId> + 'a {
        let mut parts = path.split('.').map(|part| part.split('[').next().unwrap_or(part).trim());
        let state = self.symbols().find(|(_, symbol)| symbol.kind == Kind::State);
        let mut owner = state.map(|(id, _)| id);
        for part in &mut parts {
            let field =
                owner.and_then(|owner| self.members(owner).find(|id| self.name(*id) == part));
            let ty = field.and_then(|field| self.symbol(field).ty);
            owner = ty.and_then(|ty| {
                let name = self.source.slice(ty.name);
                self.symbols().find_map(|(id, symbol)| {
                    (symbol.kind == Kind::Struct && self.name(id) == name).then_some(id)
                })
            });
        }
        owner.into_iter().flat_map(|owner| self.members(owner))
    }

    /// The fields of a struct or the state, or the values of an enumeration.
    pub fn members(&self, owner: SymbolId) -> impl Iterator<Item = SymbolId> + '_ {
        self.symbols().filter(move |(_, symbol)| symbol.owner == Some(owner)).map(|(id, _)| id)
    }
}

/// Whether a text is one name, which is no word of the language.
fn is_name(text: &str) -> bool {
    let mut letters = text.chars();
    let first = letters.next().is_some_and(|c| c == '_' || unicode_ident::is_xid_start(c));
    first && letters.all(unicode_ident::is_xid_continue) && !parse::is_keyword(text) && text != "_"
}
