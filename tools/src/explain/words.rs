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

/// So many steps.
fn steps(n: u32) -> String {
    format!("{n} step{}", if n == 1 { "" } else { "s" })
}

/// The instants of `F[first, first + length]`.
fn some(first: u64, length: u32) -> String {
    match first {
        0 => format!("at some instant within {}", steps(length)),
        _ => format!("at some instant {first} to {} steps later", first + u64::from(length)),
    }
}

/// The instants of `G[first, first + length]`.
fn every(first: u64, length: u32) -> String {
    match first {
        0 => format!("at every instant from now to {} later", steps(length)),
        _ => format!("at every instant {first} to {} steps later", first + u64::from(length)),
    }
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
        if let Some((when, part)) = self.window(id) {
            head(&format!("{when}:"));
            return self.tell(part, "- ", depth + 1, lines);
        }
        let parts: Vec<(FormulaId, &str)> = match self.spec.formula(id) {
            Formula::And(..) => {
                head("all of these:");
                self.chain(id).into_iter().map(|part| (part, "- ")).collect()
            }
            Formula::Or(..) => {
                head("one of these:");
                self.chain(id).into_iter().map(|part| (part, "- ")).collect()
            }
            Formula::UntilWithin(n, a, b) => {
                head(&format!("these two, within {}:", steps(n)));
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
            // Windows are told above, conditions as a sentence.
            _ => Vec::new(),
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
            Formula::Eventually(a) => simple(a).map(|a| format!("at some instant {a}")),
            Formula::UntilWithin(n, a, b) => {
                let (a, b) = (simple(a)?, simple(b)?);
                let within = steps(n);
                Some(format!("{a}, at every instant until {b}, which must come within {within}"))
            }
            Formula::Until(a, b) => {
                let (a, b) = (simple(a)?, simple(b)?);
                Some(format!("{a}, at every instant until {b}, which must come"))
            }
            Formula::Then(..) => self.order(id),
            _ => {
                let (when, a) = self.window(id)?;
                simple(a).map(|a| format!("{when} {a}"))
            }
        }
    }

    /// The instants that an operator with a bound is about, and its operand: `X X a` is "2 instants
    /// later a", `X F[0,2] a` "at some instant 1 to 3 steps later a".
    fn window(&self, id: FormulaId) -> Option<(String, FormulaId)> {
        let (mut first, mut at) = (0_u64, id);
        loop {
            (first, at) = match self.spec.formula(at) {
                Formula::Next(a) => (first + 1, a),
                Formula::Delay(n, a) => (first + u64::from(n), a),
                Formula::Within(n, a) => return Some((some(first, n), a)),
                Formula::Throughout(n, a) => return Some((every(first, n), a)),
                _ => break,
            };
        }
        match first {
            0 => None,
            1 => Some(("at the next instant".to_owned(), at)),
            _ => Some((format!("{first} instants later"), at)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use tltl_compiler::check;
    use tltl_compiler::source::Source;

    #[test]
    fn bounds_are_told_in_steps() {
        for (formula, words) in [
            ("X X a", &["2 instants later a"][..]),
            ("F[0,1] a", &["at some instant within 1 step a"]),
            ("F[2,5] a", &["at some instant 2 to 5 steps later a"]),
            ("G[0,2] a", &["at every instant from now to 2 steps later a"]),
            ("X G[0,2] F a", &["at every instant 1 to 3 steps later:", "  - at some instant a"]),
            (
                "X[3] (a U b)",
                &["3 instants later:", "  - a, at every instant until b, which must come"],
            ),
            ("a U[0,4] b", &["a, at every instant until b, which must come within 4 steps"]),
            (
                "(F a) U[<=1] b",
                &[
                    "these two, within 1 step:",
                    "  - at some instant: b",
                    "  - at every instant before that: at some instant a",
                ],
            ),
            ("F a ensuring !b", &["not b, at every instant until a and not b, which must come"]),
            ("F (p <=> q)", &["at some instant (p and q) or (not p and not q)"]),
        ] {
            let module = check::formula(&Source::new("formula", formula)).unwrap();
            assert_eq!(retell(&module.tasks[0].spec), words, "{formula}");
        }
    }
}
