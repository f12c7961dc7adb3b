//! Retells a formula in plain English.
//!
//! Small formulas become one clause, larger ones a list in which each operand has a line of its
//! own. The text follows the formula after negation was pushed inward, so a reader sees the
//! literals that the automaton tests. It is not parsed again by anything.

use tltl_compiler::spec::{Formula, FormulaId, Spec};

/// The most operators of a formula that is retold, counted where they are used: a longer text hides
/// more than it says, and a shared arena can unfold to exponential size.
const MOST_OPERATORS: usize = 120;

/// The formula as indented lines; none if it is too large.
pub(super) fn retell(spec: &Spec) -> Vec<String> {
    let sizes = sizes(spec);
    let mut lines = Vec::new();
    if sizes[spec.root().0 as usize] <= MOST_OPERATORS {
        Words { spec, state: states(spec) }.tell(spec.root(), "", 0, &mut lines);
    }
    lines
}

/// The size of each formula as a tree, where shared parts count at every use.
fn sizes(spec: &Spec) -> Vec<usize> {
    let mut sizes = vec![0_usize; spec.formulas().len()];
    for (id, formula) in spec.formulas() {
        let operands = formula.operands().map(|operand| sizes[operand.0 as usize]);
        sizes[id.0 as usize] = operands.fold(1, usize::saturating_add);
    }
    sizes
}

/// For each formula whether it is a condition on one state, without temporal operators.
fn states(spec: &Spec) -> Vec<bool> {
    let mut state = vec![false; spec.formulas().len()];
    for (id, formula) in spec.formulas() {
        state[id.0 as usize] =
            !formula.is_temporal() && formula.operands().all(|part| state[part.0 as usize]);
    }
    state
}

/// A formula that is being retold.
struct Words<'a> {
    spec: &'a Spec,
    state: Vec<bool>,
}

impl Words<'_> {
    /// Writes a formula on lines at `depth`, the first of them after the mark `before`.
    fn tell(&self, id: FormulaId, before: &str, depth: usize, lines: &mut Vec<String>) {
        if let Some(sentence) = self.sentence(id) {
            return lines.push(format!("{}{before}{sentence}", "  ".repeat(depth)));
        }
        let mut head = |text: &str| lines.push(format!("{}{before}{text}", "  ".repeat(depth)));
        let parts: Vec<(FormulaId, &str)> = match self.spec.formula(id) {
            Formula::And(..) => {
                head("all of these:");
                self.chain(id).into_iter().map(|part| (part, "- ")).collect()
            }
            Formula::Or(..) => {
                head("one of these:");
                self.chain(id).into_iter().map(|part| (part, "- ")).collect()
            }
            Formula::Next(a) => {
                head("at the next instant:");
                vec![(a, "- ")]
            }
            Formula::Delay(n, a) => {
                head(&format!("{n} instants later:"));
                vec![(a, "- ")]
            }
            Formula::Within(n, a) => {
                head(&format!("at one of the first {} instants, from then on:", u64::from(n) + 1));
                vec![(a, "- ")]
            }
            Formula::Throughout(n, a) => {
                head(&format!("at each of the first {} instants:", u64::from(n) + 1));
                vec![(a, "- ")]
            }
            Formula::UntilWithin(n, a, b) => {
                head(&format!("these two, within {} instants:", u64::from(n) + 1));
                vec![(b, "- at some instant: "), (a, "- at every instant before that: ")]
            }
            Formula::Eventually(a) => {
                head("at some instant, from then on:");
                vec![(a, "- ")]
            }
            Formula::Until(a, b) => {
                head("these two:");
                vec![(b, "- at some instant: "), (a, "- at every instant before that: ")]
            }
            Formula::Then(a, b) => {
                head("in this order:");
                vec![(a, "- first: "), (self.goal(b), "- strictly later: ")]
            }
            Formula::True | Formula::False | Formula::Literal { .. } => Vec::new(),
        };
        for (part, mark) in parts {
            self.tell(part, mark, depth + 1, lines);
        }
    }

    /// The formula as one clause; `None` if it is not simple enough.
    fn sentence(&self, id: FormulaId) -> Option<String> {
        if self.is_state(id) {
            return Some(self.condition(id));
        }
        let simple = |a: FormulaId| self.is_state(a).then(|| self.condition(a));
        match self.spec.formula(id) {
            Formula::Next(a) => self.next(a, 1),
            Formula::Delay(n, a) => self.next(a, n as usize),
            Formula::Eventually(a) => simple(a).map(|a| format!("at some instant {a}")),
            Formula::Within(n, a) => {
                Some(format!("at one of the first {} instants {}", u64::from(n) + 1, simple(a)?))
            }
            Formula::Throughout(n, a) => {
                Some(format!("at each of the first {} instants {}", u64::from(n) + 1, simple(a)?))
            }
            Formula::UntilWithin(n, a, b) => {
                let (a, b) = (simple(a)?, simple(b)?);
                let n = u64::from(n) + 1;
                Some(format!(
                    "{a}, at every instant until {b}, which must come within {n} instants"
                ))
            }
            Formula::Until(a, b) => {
                let (a, b) = (simple(a)?, simple(b)?);
                Some(format!("{a}, at every instant until {b}, which must come"))
            }
            Formula::Then(..) => self.order(id),
            _ => None,
        }
    }

    /// Nested `X` as one number of instants: `X X a` is "2 instants later a".
    fn next(&self, a: FormulaId, instants: usize) -> Option<String> {
        match self.spec.formula(a) {
            Formula::Next(b) => self.next(b, instants + 1),
            Formula::Delay(n, b) => self.next(b, instants + n as usize),
            _ if !self.is_state(a) => None,
            _ if instants == 1 => Some(format!("at the next instant {}", self.condition(a))),
            _ => Some(format!("{instants} instants later {}", self.condition(a))),
        }
    }

    /// `a T b T c` as one clause.
    fn order(&self, id: FormulaId) -> Option<String> {
        let mut text = String::from("first ");
        let mut at = id;
        while let Formula::Then(a, b) = self.spec.formula(at) {
            if !self.is_state(a) {
                return None;
            }
            text.push_str(&format!("{}, strictly later ", self.condition(a)));
            at = self.goal(b);
        }
        self.is_state(at).then(|| text + &self.condition(at))
    }

    /// The operand ψ of ◇ψ. The normal form wraps the right side of `T` in `F`, which "later" says
    /// already.
    fn goal(&self, id: FormulaId) -> FormulaId {
        match self.spec.formula(id) {
            Formula::Eventually(a) => a,
            _ => id,
        }
    }

    fn is_state(&self, id: FormulaId) -> bool {
        self.state[id.0 as usize]
    }

    /// A condition on one state, as words.
    fn condition(&self, id: FormulaId) -> String {
        match self.spec.formula(id) {
            Formula::True => "anything".to_owned(),
            Formula::False => "what can never be".to_owned(),
            Formula::Literal { proposition, negated } => {
                let name = &self.spec.propositions()[proposition as usize];
                format!("{}{name}", if negated { "not " } else { "" })
            }
            Formula::And(..) => self.joined(id, " and "),
            _ => self.joined(id, " or "),
        }
    }

    /// The operands of a chain, joined by a word; operands that are compound stand in brackets.
    fn joined(&self, id: FormulaId, word: &str) -> String {
        let compound = |part| matches!(self.spec.formula(part), Formula::And(..) | Formula::Or(..));
        let parts = self.chain(id).into_iter().map(|part| match compound(part) {
            true => format!("({})", self.condition(part)),
            false => self.condition(part),
        });
        parts.collect::<Vec<_>>().join(word)
    }

    /// The operands of a chain of one operator, from left to right.
    fn chain(&self, id: FormulaId) -> Vec<FormulaId> {
        let and = matches!(self.spec.formula(id), Formula::And(..));
        match self.spec.formula(id) {
            Formula::And(a, b) | Formula::Or(a, b) => {
                let same = |part| match self.spec.formula(part) {
                    Formula::And(..) => and,
                    Formula::Or(..) => !and,
                    _ => false,
                };
                let open = |part| if same(part) { self.chain(part) } else { vec![part] };
                [open(a), open(b)].concat()
            }
            _ => vec![id],
        }
    }
}
