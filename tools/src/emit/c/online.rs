//! Robustness while a trajectory grows, as straight-line C.
//!
//! The recursion is that of the runtime (`robustness::typed::forward`, which says why it is right):
//! every operator turns the weights with which it may start into those of its operand, and gives the
//! robustness so far and the greatest that it can still become. Here each operator becomes some lines
//! of C, and what it keeps a member of the monitor. A test compares the two.

use std::fmt::Write as _;

use tltl_compiler::spec::{Formula, FormulaId, Spec};

use super::Unfollowed;

/// A longer formula is not followed: with what is shared written out, its code would have no end.
const OPERATORS: usize = 256;
/// The cells of all windows together; the monitor has 10 to 26 bytes for each.
const CELLS: usize = 4096;

/// The parts of a monitor that depend on the formula.
pub(super) struct Monitor {
    /// The members, a line each.
    pub(super) members: String,
    /// What they are before the first state.
    pub(super) start: String,
    /// The step, from `r0`, `r1`, … (the robustness of the predicates), `now` and `m->t` on.
    pub(super) step: String,
    /// The robustness so far, and what it can still become.
    pub(super) interval: [String; 2],
}

/// How often a formula may start: once, as the whole one and its operands below `&&`, `||` and `X`; or
/// at every instant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Starts {
    Once,
    Often,
}

use Starts::{Often, Once};

/// The weight of what never starts.
const NONE: &str = "-INFINITY";

/// The monitor of a formula.
///
/// # Errors
/// If the formula is not one that can be followed: the part that is in the way.
pub(super) fn monitor(spec: &Spec, prefix: &str) -> Result<Monitor, Unfollowed> {
    let mut is_state = Vec::new();
    let mut size: Vec<(usize, usize)> = Vec::new();
    for (_, formula) in spec.formulas() {
        let all = formula.operands().all(|operand| is_state[operand.0 as usize]);
        is_state.push(all && !formula.is_temporal());
        let window = match formula {
            Formula::Delay(n, _) | Formula::Within(n, _) => n as usize + 2,
            Formula::Throughout(n, _) | Formula::UntilWithin(n, ..) => n as usize + 2,
            _ => 0,
        };
        let of = |operand: FormulaId| size[operand.0 as usize];
        let sum = formula
            .operands()
            .map(of)
            .fold((1_usize, window), |(a, b), (c, d)| (a.saturating_add(c), b.saturating_add(d)));
        size.push(sum);
    }
    let FormulaId(root) = spec.root();
    let (operators, cells) = size[root as usize];
    if operators > OPERATORS {
        return Err(Unfollowed::Operators(operators, OPERATORS));
    }
    if cells > CELLS {
        return Err(Unfollowed::Cells(cells, CELLS));
    }
    let mut writer = Writer {
        spec,
        prefix,
        is_state,
        kept: 0,
        value: 0,
        members: String::new(),
        start: String::new(),
        step: String::new(),
    };
    let interval = writer.formula(spec.root(), Once, "now".to_owned(), NONE.to_owned())?;
    let Writer { members, start, step, .. } = writer;
    Ok(Monitor { members, start, step, interval })
}

struct Writer<'a> {
    spec: &'a Spec,
    prefix: &'a str,
    is_state: Vec<bool>,
    /// The members and locals so far.
    kept: usize,
    value: usize,
    members: String,
    start: String,
    step: String,
}

impl Writer<'_> {
    fn is_state(&self, id: FormulaId) -> bool {
        self.is_state[id.0 as usize]
    }

    fn line(&mut self, line: &str) {
        let _ = writeln!(self.step, "    {line}");
    }

    /// A new local.
    fn local(&mut self, code: &str) -> String {
        let name = format!("v{}", self.value);
        self.value += 1;
        self.line(&format!("const double {name} = {code};"));
        name
    }

    /// A new member that is a number, none at first.
    fn member(&mut self) -> String {
        let name = format!("k{}", self.kept);
        self.kept += 1;
        let _ = writeln!(self.members, "    double {name};");
        let _ = writeln!(self.start, "    m->{name} = {NONE};");
        format!("m->{name}")
    }

    fn max(&self, a: &str, b: &str) -> String {
        if b == NONE { a.to_owned() } else { format!("{}_greater({a}, {b})", self.prefix) }
    }

    /// The greater of two as a local, since both operands of `||` name it.
    fn greatest(&mut self, a: &str, b: &str) -> String {
        let greatest = self.max(a, b);
        self.local(&greatest)
    }

    fn min(&self, a: &str, b: &str) -> String {
        format!("{}_less({a}, {b})", self.prefix)
    }

    /// A state formula as an expression.
    fn state(&self, id: FormulaId) -> String {
        match self.spec.formula(id) {
            Formula::True => "INFINITY".to_owned(),
            Formula::False => "(-INFINITY)".to_owned(),
            Formula::Literal { proposition, negated } => {
                format!("{}r{proposition}", if negated { "-" } else { "" })
            }
            Formula::And(a, b) => self.min(&self.state(a), &self.state(b)),
            Formula::Or(a, b) => self.max(&self.state(a), &self.state(b)),
            _ => unreachable!("a state formula relates no instants"),
        }
    }

    /// A state formula as a local.
    fn held(&mut self, id: FormulaId, operator: &'static str) -> Result<String, Unfollowed> {
        if !self.is_state(id) {
            return Err(self.refused(id, operator));
        }
        let code = self.state(id);
        Ok(self.local(&code))
    }

    fn refused(&self, id: FormulaId, operator: &'static str) -> Unfollowed {
        Unfollowed::Form { operator, operand: self.spec.display(id).to_string() }
    }

    /// The lines for a formula that starts with weight `now`, and can start later with at most
    /// `later`.
    fn formula(
        &mut self,
        id: FormulaId,
        starts: Starts,
        now: String,
        later: String,
    ) -> Result<[String; 2], Unfollowed> {
        if self.is_state(id) {
            let best = self.member();
            let rho = self.state(id);
            let new = self.max(&self.min(&rho, &now), &best);
            self.line(&format!("{best} = {new};"));
            let greatest = self.max(&best, &later);
            return Ok([best, greatest]);
        }
        match self.spec.formula(id) {
            Formula::And(a, b) => self.and([a, b], starts, now, later),
            Formula::Or(a, b) => {
                let [a, b] = self.either([a, b]);
                let one = self.formula(a, starts, now.clone(), later.clone())?;
                let other = self.formula(b, starts, now, later)?;
                Ok([0, 1].map(|i| self.max(&one[i], &other[i])))
            }
            Formula::Next(a) => {
                let member = self.member();
                let before = self.local(&member);
                self.line(&format!("{member} = {now};"));
                let later = self.greatest(&now, &later);
                self.formula(a, starts, before, later)
            }
            Formula::Eventually(a) => {
                let member = self.member();
                let new = self.max(&now, &member);
                self.line(&format!("{member} = {new};"));
                let weight = self.local(&member);
                let later = self.greatest(&weight, &later);
                self.formula(a, Often, weight, later)
            }
            Formula::Until(a, b) => {
                let rho = self.held(a, "U")?;
                let member = self.member();
                let weight = self.local(&self.max(&now, &member));
                let left = self.min(&rho, &weight);
                self.line(&format!("{member} = {left};"));
                let later = self.greatest(&member, &later);
                self.formula(b, Often, weight, later)
            }
            Formula::Then(a, b) => {
                let rho = self.held(a, "T")?;
                let (best, left) = (self.member(), self.member());
                let new = self.max(&now, &best);
                self.line(&format!("{best} = {new};"));
                let before = self.local(&left);
                let new = self.min(&rho, &best);
                self.line(&format!("{left} = {new};"));
                let later = self.greatest(&best, &later);
                self.formula(b, Often, before, later)
            }
            Formula::Delay(n, a) => self.delay(n, a, starts, now, later),
            Formula::Within(n, a) => self.within(n, None, a, starts, now, later),
            Formula::UntilWithin(n, a, b) => {
                let rho = self.held(a, "U")?;
                self.within(n, Some(rho), b, starts, now, later)
            }
            Formula::Throughout(n, a) => {
                let rho = self.held(a, "G")?;
                self.throughout(n, &rho, starts, now, later)
            }
            Formula::True | Formula::False | Formula::Literal { .. } => unreachable!("states"),
        }
    }

    /// The operands of `&&` and `||`, a state formula first, as the runtime has them.
    fn either(&self, mut operands: [FormulaId; 2]) -> [FormulaId; 2] {
        operands.sort_by_key(|operand| !self.is_state(*operand));
        operands
    }

    fn and(
        &mut self,
        operands: [FormulaId; 2],
        starts: Starts,
        now: String,
        later: String,
    ) -> Result<[String; 2], Unfollowed> {
        let [a, b] = self.either(operands);
        if starts == Once {
            let one = self.formula(a, Once, now.clone(), later.clone())?;
            let other = self.formula(b, Once, now, later)?;
            return Ok([0, 1].map(|i| self.min(&one[i], &other[i])));
        }
        if self.is_state(a) {
            let weight = self.local(&self.min(&self.state(a), &now));
            return self.formula(b, Often, weight, later);
        }
        // What `U` becomes if its bound does not begin at 0.
        match [a, b].map(|id| self.spec.formula(id)) {
            [Formula::Throughout(n, p), Formula::Delay(m, goal)] if n < m && self.is_state(p) => {
                let rho = self.held(p, "G")?;
                let (held, open) = self.holding(n, &rho, &now);
                let arrived = self.later(m - n, &held);
                let coming = self.slide("max", m - n, &held);
                let later = self.greatest(&self.max(&coming, &open), &later);
                self.formula(goal, Often, arrived, later)
            }
            _ => Err(self.refused(b, "&&")),
        }
    }

    fn delay(
        &mut self,
        n: u32,
        a: FormulaId,
        starts: Starts,
        now: String,
        later: String,
    ) -> Result<[String; 2], Unfollowed> {
        if starts == Often {
            let arrived = self.later(n, &now);
            let coming = self.slide("max", n, &now);
            let later = self.greatest(&coming, &later);
            return self.formula(a, Often, arrived, later);
        }
        let start = self.start_once(&now);
        let arrived =
            self.local(&format!("(uint16_t)(m->t - {start}.at) == {n}u ? {start}.weight : {NONE}"));
        self.forget_once(&start, n);
        let later = self.greatest(&format!("{start}.weight"), &later);
        self.formula(a, Once, arrived, later)
    }

    /// `F[0,n] φ`, or `p U[0,n] φ` where `rho` is that of p.
    fn within(
        &mut self,
        n: u32,
        rho: Option<String>,
        a: FormulaId,
        starts: Starts,
        now: String,
        later: String,
    ) -> Result<[String; 2], Unfollowed> {
        let (weight, open) = if starts == Once {
            let start = self.start_once(&now);
            let weight = self.local(&format!("{start}.weight"));
            if let Some(rho) = rho {
                let left = self.min(&rho, &weight);
                self.line(&format!("{start}.weight = {left};"));
            }
            self.forget_once(&start, n);
            (weight, format!("{start}.weight"))
        } else {
            let queue = self.queue(n, &now);
            let weight = self.local(&self.best(&queue));
            if let Some(rho) = rho {
                self.lower(&queue, &rho);
            }
            self.forget(&queue, n);
            let open = self.local(&self.best(&queue));
            (weight, open)
        };
        let later = self.greatest(&open, &later);
        self.formula(a, Often, weight, later)
    }

    fn throughout(
        &mut self,
        n: u32,
        rho: &str,
        starts: Starts,
        now: String,
        later: String,
    ) -> Result<[String; 2], Unfollowed> {
        let best = self.member();
        let open = if starts == Once {
            let start = self.start_once(&now);
            let left = self.min(rho, &format!("{start}.weight"));
            self.line(&format!("{start}.weight = {left};"));
            let new = self.max(&format!("{start}.weight"), &best);
            self.line(&format!("if ((uint16_t)(m->t - {start}.at) == {n}u) {best} = {new};"));
            self.forget_once(&start, n);
            format!("{start}.weight")
        } else {
            let (done, open) = self.holding(n, rho, &now);
            let new = self.max(&done, &best);
            self.line(&format!("{best} = {new};"));
            open
        };
        let greatest = self.max(&best, &self.max(&open, &later));
        let greatest = self.local(&greatest);
        Ok([best, greatest])
    }

    /// `G[0,n] p` from many starts: what p leaves of the one whose window ends now, and the greatest
    /// weight of those whose windows are open.
    fn holding(&mut self, n: u32, rho: &str, now: &str) -> (String, String) {
        let weight = self.later(n, now);
        let least = self.slide("min", n + 1, rho);
        let queue = self.queue(n, now);
        self.lower(&queue, rho);
        self.forget(&queue, n);
        let done = self.local(&self.min(&weight, &least));
        let open = self.local(&self.best(&queue));
        (done, open)
    }

    /// A start that is pushed once.
    fn start_once(&mut self, now: &str) -> String {
        let name = format!("k{}", self.kept);
        self.kept += 1;
        let _ = writeln!(self.members, "    struct {{ double weight; uint16_t at; }} {name};");
        let _ = writeln!(self.start, "    m->{name}.weight = {NONE};\n    m->{name}.at = 0;");
        let start = format!("m->{name}");
        self.line(&format!("if ({now} > {NONE}) {{ {start}.weight = {now}; {start}.at = m->t; }}"));
        start
    }

    fn forget_once(&mut self, start: &str, n: u32) {
        self.line(&format!("if ((uint16_t)(m->t - {start}.at) >= {n}u) {start}.weight = {NONE};"));
    }

    /// The weight of n instants ago.
    fn later(&mut self, n: u32, now: &str) -> String {
        let cells = self.cells(n);
        self.local(&format!(
            "{}_delay(m->{cells}.cells, {n}u, &m->{cells}.place, {now})",
            self.prefix
        ))
    }

    /// The best of the last n numbers.
    fn slide(&mut self, best: &str, n: u32, now: &str) -> String {
        let cells = self.cells(n + 1);
        self.local(&format!(
            "{}_slide_{best}(m->{cells}.cells, {n}u, &m->{cells}.place, {now})",
            self.prefix
        ))
    }

    fn cells(&mut self, cells: u32) -> String {
        let name = format!("k{}", self.kept);
        self.kept += 1;
        let _ = writeln!(
            self.members,
            "    struct {{ double cells[{cells}]; uint16_t place; }} {name};"
        );
        let _ = writeln!(
            self.start,
            "    {}_fill(m->{name}.cells, {cells}u);\n    m->{name}.place = 0;",
            self.prefix
        );
        name
    }

    /// A monotone queue of starts, with a new one in it.
    fn queue(&mut self, n: u32, now: &str) -> String {
        let (name, cells) = (format!("k{}", self.kept), n + 2);
        self.kept += 1;
        let _ = writeln!(
            self.members,
            "    struct {{ double weight[{cells}]; uint16_t at[{cells}], first, length; }} {name};"
        );
        let _ = writeln!(self.start, "    m->{name}.first = 0;\n    m->{name}.length = 0;");
        let queue = format!(
            "m->{name}.weight, m->{name}.at, {cells}u, &m->{name}.first, &m->{name}.length"
        );
        self.line(&format!("{}_push({queue}, {now}, m->t);", self.prefix));
        queue
    }

    fn lower(&mut self, queue: &str, rho: &str) {
        self.line(&format!("{}_lower({queue}, {rho});", self.prefix));
    }

    fn forget(&mut self, queue: &str, n: u32) {
        self.line(&format!("{}_forget({queue}, {n}u, m->t);", self.prefix));
    }

    fn best(&self, queue: &str) -> String {
        let of = queue.split(',').next().unwrap_or_default().trim_end_matches(".weight");
        format!("({of}.length > 0 ? {of}.weight[{of}.first] : {NONE})")
    }
}
