//! Formulas as an author writes them: random trees of every operator, their text in any spelling,
//! and their meaning by the definitions of the operators.
//!
//! The meaning shares nothing with the compiler, which rewrites `ensuring`, implications and
//! negated "always" before it translates: here they are what they are defined as.
//!
//! ```
//! use tltl_fuzz::random::Bytes;
//! use tltl_fuzz::written::{Style, Tree};
//!
//! // Choices that are all 0 make the first of everything.
//! let tree = Tree::random(&mut Bytes(&[]), 1);
//! assert_eq!(Style::formula(&mut Bytes(&[])).text(&tree), "X a");
//! // `X` needs a second state.
//! assert!(!tree.holds(&[[true; 4]]) && tree.holds(&[[true; 4], [true; 4]]));
//! ```

use std::ops::RangeInclusive;

use crate::random::Choices;

/// The truth of each name at one instant.
pub type Row = [bool; 4];

/// The first and the last instant of a bound, or every instant from the first on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Window(u32, Option<u32>);

impl Window {
    fn from(self, i: usize, end: usize) -> RangeInclusive<usize> {
        i + self.0 as usize..=self.1.map_or(end, |last| i + last as usize)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Truth(bool),
    Name(usize),
    Not,
    And,
    Or,
    Implies,
    Iff,
    Next(Option<u32>),
    Eventually(Window),
    Throughout(Window),
    Until(Window),
    Then(Window),
    Ensuring,
    /// `!G p`, of a state formula.
    NotAlways,
    /// `!(p R q)`, of state formulas.
    NotRelease,
    /// `!(p W q)`, of state formulas.
    NotWeak,
}

use Operator::{
    And, Ensuring, Eventually, Iff, Implies, Name, Next, Not, NotAlways, NotRelease, NotWeak, Or,
    Then, Throughout, Truth, Until,
};

/// A formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tree(Operator, Vec<Tree>);

impl Tree {
    /// A co-safe formula with about so many operators.
    pub fn random(choices: &mut impl Choices, operators: u32) -> Self {
        if operators == 0 {
            return Self::leaf(choices);
        }
        let rest = operators - 1;
        let any = Window(0, None);
        let operator = match choices.choose(20) {
            0 => Next(None),
            1 => Next(Some(choices.choose(4))),
            2 => Eventually(any),
            3 | 4 => Eventually(window(choices, 0)),
            5 | 6 => Throughout(window(choices, 0)),
            7 => And,
            8 => Or,
            9 => Implies,
            10 => Until(any),
            11 | 12 => Until(window(choices, 0)),
            13 => Then(Window(1, None)),
            14 | 15 => Then(window(choices, 1)),
            16 => Ensuring,
            17 => NotAlways,
            18 => [NotRelease, NotWeak][choices.choose(2) as usize],
            _ => return Self::state(choices, operators),
        };
        if matches!(operator, Next(_) | Eventually(_) | Throughout(_)) {
            return Self(operator, vec![Self::random(choices, rest)]);
        }
        if operator == NotAlways {
            return Self(operator, vec![Self::state(choices, rest)]);
        }
        let left = choices.choose(rest + 1);
        let pair = match operator {
            Implies => [Self::state(choices, left), Self::random(choices, rest - left)],
            Ensuring => [Self::random(choices, left), Self::state(choices, rest - left)],
            NotRelease | NotWeak => [Self::state(choices, left), Self::state(choices, rest - left)],
            _ => [Self::random(choices, left), Self::random(choices, rest - left)],
        };
        Self(operator, pair.into())
    }

    /// A formula of one state.
    fn state(choices: &mut impl Choices, operators: u32) -> Self {
        if operators == 0 {
            return Self::leaf(choices);
        }
        let rest = operators - 1;
        let operator = [Not, And, Or, Implies, Iff][choices.choose(5) as usize];
        if operator == Not {
            return Self(Not, vec![Self::state(choices, rest)]);
        }
        let left = choices.choose(rest + 1);
        Self(operator, vec![Self::state(choices, left), Self::state(choices, rest - left)])
    }

    fn leaf(choices: &mut impl Choices) -> Self {
        let operator = match choices.choose(16) {
            14 => Truth(true),
            15 => Truth(false),
            other => Name(other as usize % 4),
        };
        Self(operator, Vec::new())
    }

    /// Whether a trajectory satisfies the formula. It has at least one state.
    #[must_use]
    pub fn holds(&self, trace: &[Row]) -> bool {
        self.column(trace)[0]
    }

    /// Whether the formula holds at each instant.
    fn column(&self, trace: &[Row]) -> Vec<bool> {
        let end = trace.len();
        let columns: Vec<_> = self.1.iter().map(|operand| operand.column(trace)).collect();
        // Past the end nothing holds.
        let p = |i: usize| columns[0].get(i).copied().unwrap_or(false);
        let q = |i: usize| columns[1].get(i).copied().unwrap_or(false);
        let holds = |i: usize| match self.0 {
            Truth(value) => value,
            Name(name) => trace[i][name],
            Not => !p(i),
            And => p(i) && q(i),
            Or => p(i) || q(i),
            Implies => !p(i) || q(i),
            Iff => p(i) == q(i),
            Next(steps) => p(i + steps.unwrap_or(1) as usize),
            Eventually(window) => window.from(i, end).any(p),
            Throughout(window) => window.from(i, end).all(p),
            Until(window) => window.from(i, end).any(|j| q(j) && (i..j).all(p)),
            Then(window) => (i..end).any(|k| p(k) && window.from(k, end).any(q)),
            Ensuring => {
                let done = (i..end).find(|&n| self.1[0].column(&trace[..=n])[i]);
                done.is_some_and(|n| (i..=n).all(q))
            }
            NotAlways => (i..end).any(|j| !p(j)),
            NotRelease => (i..end).any(|j| !q(j) && (i..j).all(|k| !p(k))),
            NotWeak => (i..end).any(|j| !p(j) && !q(j) && (i..j).all(|k| !q(k))),
        };
        (0..end).map(holds).collect()
    }
}

/// The place in a [`Row`] of the proposition of that name.
///
/// # Panics
/// If no formula here has such a name.
#[must_use]
pub fn place(name: &str) -> usize {
    let names = ["a", "b", "c", "d", "goal room"];
    let found = names.iter().position(|known| *known == name.trim_matches('"'));
    found.unwrap_or_else(|| panic!("there is no `{name}`")).min(3)
}

/// A trajectory of 1 to 7 states.
pub fn trace(choices: &mut impl Choices) -> Vec<Row> {
    let length = 1 + choices.choose(7);
    let row = |bits: u32| [0, 1, 2, 3].map(|place| bits >> place & 1 == 1);
    (0..length).map(|_| row(choices.choose(16))).collect()
}

/// A window of a few steps.
fn window(choices: &mut impl Choices, least: u32) -> Window {
    let first = least + choices.choose(3);
    Window(first, Some(first + choices.choose(4)))
}

/// A way to write: what the names are, and the choices among spellings.
pub struct Style<'a, C> {
    choices: &'a mut C,
    names: [&'static str; 4],
    /// Whether `==` between two names is one of truth values, as in a file.
    typed: bool,
    /// Whether bounds are times, a step being half a second.
    times: bool,
}

/// How tightly text binds, from 0: a name, `!`, `U`, `&&`, `||`, `=>`, `ensuring`.
type Level = u32;

impl<'a, C: Choices> Style<'a, C> {
    /// A bare formula; one of its names has a blank in it.
    pub fn formula(choices: &'a mut C) -> Self {
        Self { choices, names: ["a", "b", "c", "\"goal room\""], typed: false, times: false }
    }

    /// A task of a file.
    pub fn file(choices: &'a mut C, times: bool) -> Self {
        Self { choices, names: ["a", "b", "c", "d"], typed: true, times }
    }

    /// The text of a formula, with the brackets that it needs.
    pub fn text(&mut self, tree: &Tree) -> String {
        self.level(tree).0
    }

    fn level(&mut self, Tree(operator, operands): &Tree) -> (String, Level) {
        match (*operator, &operands[..]) {
            (Truth(true), _) => (self.one(&["true", "⊤"]), 0),
            (Truth(false), _) => (self.one(&["false", "⊥"]), 0),
            (Name(name), _) => (self.names[name].to_owned(), 0),
            (Not, [p]) => (self.one(&["!", "¬", "not "]) + &self.at_most(1, p), 1),
            (NotAlways, [p]) => (self.one(&["!G ", "![]", "¬□"]) + &self.at_most(1, p), 1),
            (Next(_) | Eventually(_) | Throughout(_), [p]) => self.unary(*operator, p),
            (NotRelease, [p, q]) => {
                (format!("!({} R {})", self.at_most(1, p), self.at_most(1, q)), 1)
            }
            (NotWeak, [p, q]) => (format!("!({} W {})", self.at_most(1, p), self.at_most(1, q)), 1),
            (_, [p, q]) => self.binary(*operator, p, q),
            _ => unreachable!("{operator:?} has another number of operands"),
        }
    }

    fn unary(&mut self, operator: Operator, p: &Tree) -> (String, Level) {
        let (sign, bound) = match operator {
            Next(steps) => {
                let bound = steps.map(|steps| format!("[{}]", self.steps(steps, 0)));
                (self.one(&["X", "○"]), bound.unwrap_or_default())
            }
            Eventually(window) => (self.one(&["F", "◇", "<>"]), self.bound(window, 0)),
            Throughout(window) => (self.one(&["G", "□", "[]"]), self.bound(window, 0)),
            _ => unreachable!("{operator:?} is not unary"),
        };
        (format!("{sign}{bound} {}", self.at_most(1, p)), 1)
    }

    fn binary(&mut self, operator: Operator, p: &Tree, q: &Tree) -> (String, Level) {
        let names = matches!((p, q), (Tree(Name(_), _), Tree(Name(_), _)));
        if operator == Iff && names && self.typed && self.choices.choose(2) == 1 {
            return (format!("{} == {}", self.text(p), self.text(q)), 0);
        }
        let chains = operator == Implies && q.0 == Implies;
        let (sign, left, right, level) = match operator {
            Until(window) => (format!("U{}", self.bound(window, 0)), 1, 2, 2),
            Then(window) => (format!("T{}", self.bound(window, 1)), 1, 2, 2),
            And => (self.one(&["&&", "∧", "&", "and"]), 3, 2, 3),
            Or => (self.one(&["||", "∨", "|", "or"]), 4, 3, 4),
            Implies => (self.one(&["=>", "⇒", "->"]), 4, if chains { 5 } else { 4 }, 5),
            Iff => (self.one(&["<=>", "⇔", "<->"]), 4, 4, 5),
            _ => ("ensuring".to_owned(), 5, 5, 6),
        };
        let p = self.at_most(left, p);
        (format!("{p} {sign} {}", self.at_most(right, q)), level)
    }

    /// An operand, in brackets if it binds less tightly.
    fn at_most(&mut self, most: Level, tree: &Tree) -> String {
        let (text, level) = self.level(tree);
        let extra = self.choices.choose(8) == 7;
        if level > most || extra { format!("({text})") } else { text }
    }

    /// A bound; `least` is the first instant that it may be left out for.
    fn bound(&mut self, Window(first, last): Window, least: u32) -> String {
        let Some(last) = last else { return String::new() };
        let short = if first == least { self.choices.choose(3) } else { 0 };
        let (before, after) = (self.steps(first, -1), self.steps(last, 1));
        match short {
            1 => format!("[<= {after}]"),
            2 if least == 0 => format!("[{after}]"),
            _ => format!("[{before}, {after}]"),
        }
    }

    /// A number of steps. A time may be off its step to the `side` on which that changes nothing.
    fn steps(&mut self, steps: u32, side: i64) -> String {
        if !self.times {
            return steps.to_string();
        }
        let off = i64::from(self.choices.choose(5)) * side;
        let tenths = (i64::from(steps) * 5 + off).max(0);
        format!("{}.{} s", tenths / 10, tenths % 10)
    }

    fn one(&mut self, spellings: &[&str]) -> String {
        spellings[self.choices.choose(spellings.len() as u32) as usize].to_owned()
    }
}
