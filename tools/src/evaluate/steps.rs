//! The steps of a program while it is compiled, and those of the operators of a formula.

use tltl::robustness::Window;
use tltl_compiler::spec::{Formula, FormulaId, Spec};

use super::program::{Operand, Operation, Program, Step};

/// The steps so far. The register of a result is the number of its step; [`Program::new`] allocates
/// real registers.
#[derive(Default)]
pub(super) struct Steps(Vec<Step>);

impl Steps {
    pub(super) fn step(&mut self, operation: Operation, a: Operand, b: Operand) -> Operand {
        self.0.push(Step::new(operation, a, b));
        Operand::Register(self.0.len() as u32 - 1)
    }

    pub(super) fn unary(&mut self, operation: Operation, a: Operand) -> Operand {
        self.step(operation, a, Operand::Constant(0.0))
    }

    /// An operand as the result of a step: operations that relate rows take no constants.
    pub(super) fn result(&mut self, operand: Operand) -> Operand {
        match operand {
            Operand::Register(_) => operand,
            Operand::Constant(_) => self.unary(Operation::Copy, operand),
        }
    }

    /// The steps for the operators of a formula over its predicates, and `output`, which is the
    /// robustness of the whole.
    pub(super) fn formula(&mut self, spec: &Spec, predicates: &[Operand], output: u32) {
        let reachable = spec.reachable();
        let mut known = vec![Operand::Constant(f64::NEG_INFINITY); reachable.len()];
        for (id, formula) in spec.formulas().filter(|(id, _)| reachable[id.0 as usize]) {
            known[id.0 as usize] = self.operator(formula, &known, predicates);
        }
        let whole = self.result(known[spec.root().0 as usize]);
        self.unary(Operation::Emit(output), whole);
    }

    /// The step for one temporal or Boolean operator whose operands are known.
    fn operator(&mut self, formula: Formula, known: &[Operand], predicates: &[Operand]) -> Operand {
        let of = |id: FormulaId| known[id.0 as usize];
        match formula {
            Formula::True | Formula::False => Operand::Constant(if formula == Formula::True {
                f64::INFINITY
            } else {
                f64::NEG_INFINITY
            }),
            Formula::Literal { proposition, negated } => {
                let rho = predicates[proposition as usize];
                if negated { self.unary(Operation::Negate, rho) } else { rho }
            }
            Formula::And(a, b) => self.step(Operation::Least, of(a), of(b)),
            Formula::Or(a, b) => self.step(Operation::Greatest, of(a), of(b)),
            Formula::Next(a) => self.along(Operation::Next, of(a)),
            Formula::Delay(n, a) => self.along(Operation::Window(Window::Later(n)), of(a)),
            Formula::Eventually(a) => self.along(Operation::Eventually, of(a)),
            Formula::Within(n, a) => self.along(Operation::Window(Window::Greatest(n)), of(a)),
            Formula::Throughout(n, a) => self.along(Operation::Window(Window::Least(n)), of(a)),
            Formula::Until(a, b) => self.until(of(a), of(b)),
            // As the operators of the compiler's tables have it.
            Formula::UntilWithin(n, a, b) => {
                let until = self.until(of(a), of(b));
                let soon = self.along(Operation::Window(Window::Greatest(n)), of(b));
                self.step(Operation::Least, until, soon)
            }
            // `a T b` is `F (a && X b)`, since the arena has `F` around the `b` of a `T`: once `b`
            // can come later, it can come at any later row.
            Formula::Then(a, b) => {
                let later = self.along(Operation::Next, of(b));
                let both = self.step(Operation::Least, of(a), later);
                self.along(Operation::Eventually, both)
            }
        }
    }

    /// A step that relates rows.
    fn along(&mut self, operation: Operation, a: Operand) -> Operand {
        let a = self.result(a);
        self.unary(operation, a)
    }

    fn until(&mut self, a: Operand, b: Operand) -> Operand {
        let (a, b) = (self.result(a), self.result(b));
        self.step(Operation::Until, a, b)
    }

    /// The program that these steps are.
    pub(super) fn program(self) -> Program {
        Program::new(self.0)
    }
}

/// The program of a formula over the robustness of its propositions: input i is that of proposition
/// i, and output 0 that of the formula.
pub(super) fn over_propositions(spec: &Spec) -> Program {
    let mut steps = Steps::default();
    let input = |input| Operation::Input { input, low: -1.0 };
    let propositions = (0..spec.propositions().len() as u32)
        .map(|place| steps.unary(input(place), Operand::Constant(0.0)))
        .collect::<Vec<_>>();
    steps.formula(spec, &propositions, 0);
    steps.program()
}
