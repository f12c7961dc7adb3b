//! The edges of an automaton with their guards as text, written while they are made.
//!
//! An automaton of n unordered goals has 3^n edges, and their text is hundreds of times larger than
//! its diagram. Nothing of that size is kept: the text goes out piece by piece.
//!
//! Most edges of most automata are one path through the diagram. Such a path is a product, and the
//! only one of its guard, so its text is put together while the diagram is walked. Edges that are
//! several paths, or that letters which cannot occur make shorter, have their guards from
//! [`Guards`]. To write the 531,441 edges of 12 goals takes a sixth of what it took to make all
//! guards first.

use std::fmt::{self, Write};
use std::ops::Range;

use tltl_compiler::bdd::{Bdd, Cover, Node};
use tltl_compiler::dfa::{Dfa, Guards, Size, State};

use super::sum::{Notation, Sum};

/// The most products that the guards of one automaton may have where they are written out. Twelve
/// unordered goals have half as many, which are 50 MB of JSON.
pub const MOST_PRODUCTS: usize = 1 << 20;

/// The most edges that are counted to say how many there are at least: some hundredths of a second.
const MOST_COUNTED: usize = 1 << 22;

/// The bytes that are put together before they are written.
const PIECE: usize = 1 << 15;

/// The guards of an automaton have more than [`MOST_PRODUCTS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// How many they have at least; `usize::MAX` if nobody counted.
    pub products: usize,
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (least, products) = match self.products {
            usize::MAX => ("more than", MOST_PRODUCTS),
            products => ("at least", products),
        };
        write!(
            f,
            "the guards of this automaton have {least} {products} products, and at most \
             {MOST_PRODUCTS} are written out"
        )
    }
}

impl std::error::Error for TooLarge {}

/// Text that is made while it is written: `to_string` has it at once, and a stream gets it piece by
/// piece.
pub struct Text<'a>(Box<Writes<'a>>);

type Writes<'a> = dyn Fn(&mut dyn Write) -> fmt::Result + 'a;

impl<'a> Text<'a> {
    /// The text that a function writes.
    pub(super) fn new(write: impl Fn(&mut dyn Write) -> fmt::Result + 'a) -> Self {
        Self(Box::new(write))
    }
}

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (self.0)(f)
    }
}

/// An edge with its guard as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Labelled<'a> {
    /// The state that it leaves.
    pub from: State,
    /// The state that it enters.
    pub to: State,
    /// The numbers of the two, as text.
    pub ends: [&'a str; 2],
    /// The guard.
    pub guard: &'a str,
    /// Whether it is the first that leaves its state.
    pub is_first: bool,
}

/// The edges of an automaton with their guards as text.
pub struct Labels<'a> {
    dfa: &'a Dfa,
    /// The number of states and edges.
    pub size: Size,
    /// For each state whether the guards of the edges into it are made of more than one path.
    has_guard: Vec<bool>,
    /// For each node whether a path leads to a state whose guards are not.
    has_path: Vec<bool>,
    guards: Guards<'a>,
    /// For each state the edges that have a guard.
    edges: Vec<Vec<(State, Cover)>>,
    texts: Texts,
}

/// The texts that guards are made of.
struct Texts {
    /// For each proposition its negation and itself, behind ∧.
    literals: Vec<[String; 2]>,
    and: String,
    or: String,
    truth: String,
    falsity: String,
    /// The numbers of the states.
    numbers: Vec<String>,
}

/// The edges of one state: the text of their guards, and where each of them stands in it.
#[derive(Default)]
struct Fan {
    text: String,
    edges: Vec<(State, Range<usize>)>,
}

impl<'a> Labels<'a> {
    /// The labels of `dfa`. `escape` makes of a literal, an operator or a constant what the format
    /// around it wants.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::emit::{labels::Labels, sum::Notation};
    ///
    /// let task = tltlc::task::compile("!wet U home", Budget::default())?;
    /// let labels = Labels::new(task.dfa(), Notation::Ascii, &str::to_owned)?;
    /// let mut text = String::new();
    /// labels.write(&mut text, &|text, edge| {
    ///     let [from, to] = edge.ends;
    ///     text.push_str(&format!("{from} -> {to}: {}\n", edge.guard));
    /// })?;
    /// assert_eq!(text.lines().nth(2), Some("0 -> 2: wet && !home"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the guards have more than [`MOST_PRODUCTS`].
    pub fn new(
        dfa: &'a Dfa,
        notation: Notation,
        escape: &dyn Fn(&str) -> String,
    ) -> Result<Self, TooLarge> {
        Self::where_possible(dfa, dfa.possible, notation, escape)
    }

    /// The labels of `dfa` with all letters, also those that cannot occur.
    ///
    /// # Errors
    /// If the guards have more than [`MOST_PRODUCTS`].
    pub fn of_all_letters(
        dfa: &'a Dfa,
        notation: Notation,
        escape: &dyn Fn(&str) -> String,
    ) -> Result<Self, TooLarge> {
        Self::where_possible(dfa, None, notation, escape)
    }

    /// The labels where only some letters can occur.
    fn where_possible(
        dfa: &'a Dfa,
        possible: Option<Bdd>,
        notation: Notation,
        escape: &dyn Fn(&str) -> String,
    ) -> Result<Self, TooLarge> {
        let (size, has_guard, has_path) = paths(dfa, possible.is_some());
        let fits = |products| match products {
            ..=MOST_PRODUCTS => Ok(()),
            products => Err(TooLarge { products }),
        };
        // Every edge has a product at least, and to count edges takes no guards.
        let all = size.edges + size.self_loops;
        fits(all)?;
        let mut guards = Guards::into_some(dfa, possible, &|q| has_guard[q as usize]);
        let edges: Vec<_> = dfa.states().map(|q| guards.edges(q)).collect();
        let of_guards = edges.iter().flatten().map(|&(_, guard)| guards.products(guard));
        let paths = if possible.is_some() { 0 } else { all - edges.iter().flatten().count() };
        fits(of_guards.fold(paths, usize::saturating_add))?;
        let texts = Texts::new(dfa, notation, escape);
        Ok(Self { dfa, size, has_guard, has_path, guards, edges, texts })
    }

    /// Writes all edges, self-loops included, by rising states: `line` appends what an edge is in
    /// the format.
    ///
    /// # Errors
    /// If `out` has one.
    pub fn write(
        &self,
        out: &mut dyn Write,
        line: &dyn Fn(&mut String, Labelled<'_>),
    ) -> fmt::Result {
        let (mut piece, mut fan) = (String::new(), Fan::default());
        for from in self.dfa.states() {
            self.fan(from, &mut fan);
            let mut is_first = true;
            for (to, guard) in fan.edges.drain(..) {
                let ends = [from, to].map(|q| &*self.texts.numbers[q as usize]);
                let guard = &fan.text[guard];
                line(&mut piece, Labelled { from, to, ends, guard, is_first });
                is_first = false;
                if piece.len() > PIECE {
                    out.write_str(&piece)?;
                    piece.clear();
                }
            }
        }
        out.write_str(&piece)
    }

    /// Collects the edges that leave a state, by rising states.
    fn fan(&self, from: State, fan: &mut Fan) {
        fan.text.clear();
        self.walk(self.dfa.transitions[from as usize], fan);
        for &(to, guard) in &self.edges[from as usize] {
            let start = fan.text.len();
            self.guard(guard, &mut fan.text);
            fan.edges.push((to, start..fan.text.len()));
        }
        // Numbered breadth-first, the states at the ends of the paths rise in long runs, of which
        // a stable sort makes use.
        fan.edges.sort_by_key(|&(to, _)| to);
    }

    /// Adds the edges that are one path below `root`.
    fn walk(&self, root: Bdd, fan: &mut Fan) {
        let Texts { literals, and, truth, .. } = &self.texts;
        let mut path = String::new();
        // A function, how much of the path leads to the node above it, and the literal in between.
        let mut stack = vec![(root, 0, "")];
        while let Some((f, above, literal)) = stack.pop() {
            path.truncate(above);
            path.push_str(literal);
            match (f.value(), f.index()) {
                (Some(to), _) if !self.has_guard[to as usize] => {
                    let start = fan.text.len();
                    fan.text.push_str(path.get(and.len()..).unwrap_or(truth));
                    fan.edges.push((to, start..fan.text.len()));
                }
                (_, Some(node)) if self.has_path[node as usize] => {
                    let Node { level, low, high } = self.dfa.diagram.nodes()[node as usize];
                    let [negative, positive] = &literals[level as usize];
                    stack.extend([(high, path.len(), &**positive), (low, path.len(), negative)]);
                }
                _ => {}
            }
        }
    }

    /// Appends a guard.
    fn guard(&self, guard: Cover, text: &mut String) {
        let Texts { literals, and, or, truth, falsity, .. } = &self.texts;
        if guard == Cover::FALSE {
            text.push_str(falsity);
        }
        let mut separator = "";
        self.guards.visit(guard, &mut |cube| {
            text.push_str(separator);
            text.push_str(if cube.is_empty() { truth } else { "" });
            for (place, &(proposition, value)) in cube.iter().enumerate() {
                let literal = &literals[proposition as usize][usize::from(value)];
                text.push_str(if place == 0 { &literal[and.len()..] } else { literal });
            }
            separator = or;
        });
    }
}

impl Texts {
    fn new(dfa: &Dfa, notation: Notation, escape: &dyn Fn(&str) -> String) -> Self {
        let sum = Sum::new(&dfa.propositions, &[]).notation(notation);
        let and = escape(notation.and());
        let literal =
            |proposition, value| and.clone() + &escape(&sum.literal((proposition, value)));
        let literals = (0..dfa.propositions.len() as u32)
            .map(|proposition| [false, true].map(|value| literal(proposition, value)))
            .collect();
        let [or, truth, falsity] =
            [notation.or(), notation.truth(true), notation.truth(false)].map(escape);
        let numbers = dfa.states().map(|q| q.to_string()).collect();
        Self { literals, and, or, truth, falsity, numbers }
    }
}

/// The size of the automaton; for each state whether an edge into it is more than one path, or may
/// be made shorter by letters that cannot occur; and for each node whether it leads to a state of
/// which neither is so.
fn paths(dfa: &Dfa, is_restricted: bool) -> (Size, Vec<bool>, Vec<bool>) {
    let nodes = dfa.diagram.nodes();
    let mut several = vec![is_restricted; dfa.len()];
    let mut shared = vec![false; nodes.len()];
    let mut mark = |f: Bdd, shared: &mut Vec<bool>| match f.value() {
        Some(to) => several[to as usize] = true,
        None => shared[f.code() as usize] = true,
    };
    let size = dfa.survey(MOST_COUNTED, &mut |f| mark(f, &mut shared));
    // What is below a node that is reached in several ways is so too.
    // Nodes stand before their parents.
    for (place, Node { low, high, .. }) in nodes.iter().enumerate().rev() {
        if shared[place] {
            [low, high].into_iter().for_each(|&f| mark(f, &mut shared));
        }
    }
    let mut open = Vec::with_capacity(nodes.len());
    for Node { low, high, .. } in nodes {
        let leads = |f: &Bdd| match f.value() {
            Some(to) => !several[to as usize],
            None => open[f.code() as usize],
        };
        open.push([low, high].into_iter().any(leads));
    }
    (size, several, open)
}
