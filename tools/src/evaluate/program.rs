//! Straight-line programs over blocks of rows.
//!
//! A [`Program`] performs each step for a whole block before the next one. The choice of the
//! operation is paid once a block and not once a row, and each step is a plain loop, which the
//! compiler vectorises. Registers are arrays of one block and are reused, so that the working set
//! stays in the first-level cache.
//!
//! # Truth values are numbers
//!
//! A truth value is a number that is positive if true, negative if false, and never 0. So `min`,
//! `max` and negation are conjunction, disjunction and negation of truth values as they are of
//! robustness, one set of operations serves both readings, and NaN passes through all of them in
//! the same way.
//!
//! # Time
//!
//! Blocks run from the last row to the first, and within a block the temporal operators do too:
//! each needs only its own value in the next row, or a [`Window`] of them if it has a bound, which
//! are carried from block to block.

use tltl::robustness::Window;
use tltl_compiler::predicate::Function;

use super::column::Columns;

/// The rows of a block. Five comparisons take 7.2, 5.7 and 5.1 ns a row in blocks of 64, 256 and
/// 1,024 rows (`cargo bench -p tltl-tests --bench columns`): beyond 256 there is little to gain,
/// and with registers of 2 KiB even a much larger task stays in the first-level cache.
pub(super) const BLOCK: usize = 256;

/// An operand of a step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operand {
    /// The result of an earlier step; once registers are [allocated](Program::new), a register.
    Register(u32),
    /// The same number in all rows.
    Constant(f64),
}

/// The operation of a step on its operands a and b. An operation with one operand reads a.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operation {
    /// Reads an input; a truth value becomes 1 or `low`.
    Input { input: u32, low: f64 },
    /// a
    Copy,
    /// a + b
    Add,
    /// a - b
    Subtract,
    /// a · b
    Multiply,
    /// a / b
    Divide,
    /// -a
    Negate,
    /// |a|
    Absolute,
    /// min(a, b); NaN if one of them is.
    Least,
    /// max(a, b); NaN if one of them is.
    Greatest,
    /// f(a), or f(a, b).
    Call(Function),
    /// Whether a = b: 1 or -1, never NaN.
    Same,
    /// Whether a > 0, as a truth value; NaN if a is.
    Positive,
    /// Whether a ≥ 0, as a truth value; NaN if a is.
    NotNegative,
    /// a in the next row.
    Next,
    /// The greatest a from this row on.
    Eventually,
    /// The greatest, over the rows from this one on, of b there and a in all rows before it.
    Until,
    /// An operator with a bound.
    Window(Window),
    /// Hands a to the caller, as the output of this number.
    Emit(u32),
}

impl Operation {
    /// The numbers that it leaves in a block for the block before it, on so many rows. All are -∞ at
    /// the end of the trajectory, where no later row exists.
    fn carries(self, rows: usize) -> usize {
        match self {
            Self::Next | Self::Eventually | Self::Until => 1,
            Self::Window(window) => window.cells(rows),
            _ => 0,
        }
    }
}

/// One step of a program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) operation: Operation,
    pub(super) operands: [Operand; 2],
    /// The register of the result.
    to: u32,
}

impl Step {
    /// A step whose result has no register yet.
    ///
    /// Operations that relate rows, or emit, take no constants as operands: they are
    /// [copied](Operation::Copy) into a register first.
    pub(super) fn new(operation: Operation, a: Operand, b: Operand) -> Self {
        Self { operation, operands: [a, b], to: 0 }
    }
}

/// A straight-line program whose registers are allocated.
///
/// Invariant: no step writes a register that it reads.
#[derive(Clone, Debug)]
pub(super) struct Program {
    steps: Vec<Step>,
    registers: usize,
}

/// Memory for evaluators to work in, of whatever task: one for each thread.
///
/// It grows to the largest task that has used it, at most 2 KiB for each register and 8 bytes for
/// each step of a bound, and is reused after that.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    registers: Vec<f64>,
    carries: Vec<f64>,
}

impl Program {
    /// A program of these steps, whose operands are the numbers of earlier steps.
    pub(super) fn new(mut steps: Vec<Step>) -> Self {
        let registers = allocate(&mut steps);
        Self { steps, registers }
    }

    /// Runs over all rows, the last block first. `emit` is called with the first row of a block,
    /// the number of an output, and the numbers of that output in the block.
    pub(super) fn run(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
        emit: &mut dyn FnMut(usize, u32, &[f64]),
    ) {
        let rows = columns.rows();
        let needed = self.registers * BLOCK.min(rows);
        if scratch.registers.len() < needed {
            scratch.registers.resize(needed, 0.0);
        }
        let carries = self.steps.iter().map(|step| step.operation.carries(rows)).sum();
        scratch.carries.clear();
        scratch.carries.resize(carries, f64::NEG_INFINITY);
        let Scratch { registers, carries } = scratch;
        for first in (0..rows).step_by(BLOCK).rev() {
            let length = BLOCK.min(rows - first);
            self.block(columns, first, length, registers, carries, emit);
        }
    }

    /// The only output of the program, in one row. Up to 32 registers lie on the stack: nothing is
    /// allocated when the runtime asks for one predicate in one state.
    pub(super) fn of_row(&self, row: &[f64]) -> f64 {
        const SMALL: usize = 32;
        let columns = Columns::of_row(row);
        let mut found = f64::NAN;
        let mut emit = |_: usize, _: u32, numbers: &[f64]| found = numbers[0];
        if self.registers <= SMALL {
            self.block(&columns, 0, 1, &mut [0.0; SMALL], &mut [], &mut emit);
        } else {
            self.block(&columns, 0, 1, &mut vec![0.0; self.registers], &mut [], &mut emit);
        }
        found
    }

    /// Runs all steps over one block of `length` rows. Each step has its part of the carries, in the
    /// order of the steps.
    fn block(
        &self,
        columns: &Columns<'_>,
        first: usize,
        length: usize,
        registers: &mut [f64],
        mut carries: &mut [f64],
        emit: &mut dyn FnMut(usize, u32, &[f64]),
    ) {
        for step in &self.steps {
            let to = step.to as usize;
            let (before, rest) = registers.split_at_mut(to * length);
            let (out, after) = rest.split_at_mut(length);
            let [a, b] = step.operands.map(|operand| match operand {
                Operand::Constant(number) => Lanes::Same(number),
                Operand::Register(register) => match (register as usize).checked_sub(to + 1) {
                    Some(place) => Lanes::Each(&after[place * length..][..length]),
                    None => Lanes::Each(&before[register as usize * length..][..length]),
                },
            });
            let number = step.operation.carries(columns.rows());
            let (carry, others) = std::mem::take(&mut carries).split_at_mut(number);
            carries = others;
            match step.operation {
                Operation::Input { input, low } => columns.read(input as usize, first, low, out),
                Operation::Emit(output) => emit(first, output, a.each()),
                Operation::Next => next(a.each(), &mut carry[0], out),
                Operation::Eventually => eventually(a.each(), &mut carry[0], out),
                Operation::Until => until(a.each(), b.each(), &mut carry[0], out),
                Operation::Window(window) => {
                    let pushed = columns.rows() - first - length;
                    slide(window, a.each(), carry, pushed, out);
                }
                operation => row_by_row(operation, a, b, out),
            }
        }
    }
}

/// Gives each result a register that is free again after its last use, in one pass over the steps;
/// returns the number of registers.
///
/// The steps are straight-line code, so the live ranges are intervals in order of their starts, and
/// taking any free register is optimal (Poletto and Sarkar, "Linear Scan Register Allocation",
/// 1999).
fn allocate(steps: &mut [Step]) -> usize {
    let last = last_uses(steps);
    let (mut free, mut count) = (Vec::new(), 0);
    for at in 0..steps.len() {
        // The register is taken before those of the operands are freed: no step writes where it
        // reads.
        let to = free.pop().unwrap_or_else(|| {
            count += 1;
            count - 1
        });
        let mut freed = Vec::new();
        for operand in 0..2 {
            if let Operand::Register(result) = steps[at].operands[operand] {
                let register = steps[result as usize].to;
                steps[at].operands[operand] = Operand::Register(register);
                freed.extend((last[result as usize] == at).then_some(register));
            }
        }
        steps[at].to = to;
        freed.extend((last[at] <= at).then_some(to));
        freed.dedup();
        free.append(&mut freed);
    }
    count as usize
}

/// For each step the last step that reads its result; 0 if none does, which is before any use.
fn last_uses(steps: &[Step]) -> Vec<usize> {
    let mut last = vec![0; steps.len()];
    for (at, step) in steps.iter().enumerate() {
        for operand in step.operands {
            if let Operand::Register(result) = operand {
                last[result as usize] = at;
            }
        }
    }
    last
}

/// The numbers of an operand in a block: one a row, or the same in all.
#[derive(Clone, Copy)]
enum Lanes<'a> {
    Each(&'a [f64]),
    Same(f64),
}

impl<'a> Lanes<'a> {
    fn each(self) -> &'a [f64] {
        let Self::Each(lanes) = self else { unreachable!("a constant is copied before that") };
        lanes
    }
}

/// The operations that look at one row only.
fn row_by_row(operation: Operation, a: Lanes<'_>, b: Lanes<'_>, out: &mut [f64]) {
    // Adding the least positive number where the difference is 0 takes three instructions for two
    // rows; choosing between 1, -1 and NaN takes eight.
    let decided = |a: f64, at_0: f64| a + if a == 0.0 { at_0 } else { 0.0 };
    match operation {
        Operation::Add => zip(a, b, out, |a, b| a + b),
        Operation::Subtract => zip(a, b, out, |a, b| a - b),
        Operation::Multiply => zip(a, b, out, |a, b| a * b),
        Operation::Divide => zip(a, b, out, |a, b| a / b),
        Operation::Negate => map(a, out, |a| -a),
        Operation::Absolute => map(a, out, f64::abs),
        Operation::Least => zip(a, b, out, least),
        Operation::Greatest => zip(a, b, out, greatest),
        Operation::Same => zip(a, b, out, |a, b| if a == b { 1.0 } else { -1.0 }),
        Operation::Positive => map(a, out, |a| decided(a, -f64::MIN_POSITIVE)),
        Operation::NotNegative => map(a, out, |a| decided(a, f64::MIN_POSITIVE)),
        // The other functions are calls, and cost more than the choice among them.
        Operation::Call(Function::Sqrt) => map(a, out, f64::sqrt),
        Operation::Call(function) => zip(a, b, out, |a, b| function.value(a, b)),
        _ => map(a, out, |a| a),
    }
}

/// Applies a function of one operand to each row.
fn map(a: Lanes<'_>, out: &mut [f64], f: impl Fn(f64) -> f64) {
    match a {
        Lanes::Each(a) => out.iter_mut().zip(a).for_each(|(out, &a)| *out = f(a)),
        Lanes::Same(a) => out.fill(f(a)),
    }
}

/// Applies a function of two operands to each row; constants are kept out of the inner loop.
fn zip(a: Lanes<'_>, b: Lanes<'_>, out: &mut [f64], f: impl Fn(f64, f64) -> f64) {
    match (a, b) {
        (Lanes::Each(a), Lanes::Each(b)) => {
            let operands = a.iter().zip(b);
            out.iter_mut().zip(operands).for_each(|(out, (&a, &b))| *out = f(a, b));
        }
        (a, Lanes::Same(b)) => map(a, out, |a| f(a, b)),
        (Lanes::Same(a), b) => map(b, out, |b| f(a, b)),
    }
}

/// `X a`: the value in the next row.
fn next(a: &[f64], carry: &mut f64, out: &mut [f64]) {
    if let ([first, later @ ..], Some((last, before))) = (a, out.split_last_mut()) {
        before.copy_from_slice(later);
        *last = *carry;
        *carry = *first;
    }
}

/// `F a` by its recursion: a now, or `F a` in the next row.
fn eventually(a: &[f64], carry: &mut f64, out: &mut [f64]) {
    for (out, &a) in out.iter_mut().zip(a).rev() {
        *carry = greatest(a, *carry);
        *out = *carry;
    }
}

/// `a U b` by its recursion: b now, or a now and `a U b` in the next row.
fn until(a: &[f64], b: &[f64], carry: &mut f64, out: &mut [f64]) {
    for (out, (&a, &b)) in out.iter_mut().zip(a.iter().zip(b)).rev() {
        *carry = greatest(b, least(a, *carry));
        *out = *carry;
    }
}

/// An operator with a bound, after `pushed` later rows.
fn slide(window: Window, a: &[f64], cells: &mut [f64], pushed: usize, out: &mut [f64]) {
    for ((out, &a), pushed) in out.iter_mut().zip(a).rev().zip(pushed..) {
        *out = window.push(cells, pushed, a);
    }
}

/// min(a, b), NaN if one of them is. `f64::min` would drop a NaN, and takes over twice as long.
fn least(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// max(a, b), NaN if one of them is.
fn greatest(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
