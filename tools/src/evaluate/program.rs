//! Straight-line programs over blocks of rows.
//!
//! A [`Program`] does each of its steps for a whole block before it does the next one: what to do is
//! decided once a block and not once a row, and each step is a plain loop, which is vectorised. The
//! steps write numbers only. A truth value is a number as well, positive if true, negative if false
//! and never 0: so `min`, `max` and negation are conjunction, disjunction and negation of truth
//! values as they are of robustness, and NaN goes through all of them in the same way.

use tltl_compiler::predicate::Function;

use super::column::Columns;

/// The rows of a block. Five comparisons take 7.2, 5.7 and 5.1 ns a row in blocks of 64, 256 and 1,024
/// rows (`cargo bench -p tltl-tests --bench columns`): what is left to gain is little, and the
/// registers of 2 KiB of a much larger task are still in the first-level cache.
pub(super) const BLOCK: usize = 256;

/// What a step reads.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operand {
    /// The result of an earlier step; once registers are [allocated](Program::new), a register.
    Register(u32),
    /// The same number in all rows.
    Constant(f64),
}

/// What a step does with its operands a and b; what takes one only reads a.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operation {
    /// An input; a truth value is 1 or `low`.
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
    /// The lesser; NaN if one of them is.
    Least,
    /// The greater; NaN if one of them is.
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
    Next(Carry),
    /// The greatest a from this row on.
    Eventually(Carry),
    /// The greatest, over the rows from this one on, of b there and a in all rows before it.
    Until(Carry),
    /// Gives a away as this output.
    Emit(u32),
}

/// A number that a block leaves for the one that precedes it in time: blocks run backwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carry(pub(super) u32);

impl Carry {
    fn of(self, carries: &mut [f64]) -> &mut f64 {
        &mut carries[self.0 as usize]
    }
}

/// One step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) operation: Operation,
    pub(super) operands: [Operand; 2],
    /// The register of the result.
    to: u32,
}

impl Step {
    /// A step whose result has no register yet. What relates rows or gives numbers away does not
    /// take constants: they are [copied](Operation::Copy) first.
    pub(super) fn new(operation: Operation, a: Operand, b: Operand) -> Self {
        Self { operation, operands: [a, b], to: 0 }
    }
}

/// A straight-line program; its registers are reused.
#[derive(Clone, Debug)]
pub(super) struct Program {
    steps: Vec<Step>,
    registers: usize,
    carries: usize,
}

/// Space for programs to work in, of whichever task: one for each thread.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    registers: Vec<f64>,
    carries: Vec<f64>,
}

impl Program {
    /// A program of these steps, whose operands are numbers of earlier steps, with as many carries.
    pub(super) fn new(mut steps: Vec<Step>, carries: u32) -> Self {
        let registers = allocate(&mut steps);
        Self { steps, registers, carries: carries as usize }
    }

    /// Runs over all rows, the last block first, and calls `emit` with the first row of a block, an
    /// output, and its numbers in the block.
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
        scratch.carries.clear();
        scratch.carries.resize(self.carries, f64::NEG_INFINITY);
        let Scratch { registers, carries } = scratch;
        for first in (0..rows).step_by(BLOCK).rev() {
            let length = BLOCK.min(rows - first);
            self.block(columns, first, length, registers, carries, emit);
        }
    }

    /// The only output, of one row. What a program this small needs is on the stack.
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

    fn block(
        &self,
        columns: &Columns<'_>,
        first: usize,
        length: usize,
        registers: &mut [f64],
        carries: &mut [f64],
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
            match step.operation {
                Operation::Input { input, low } => columns.read(input as usize, first, low, out),
                Operation::Emit(output) => emit(first, output, a.each()),
                Operation::Next(carry) => next(a.each(), carry.of(carries), out),
                Operation::Eventually(carry) => eventually(a.each(), carry.of(carries), out),
                Operation::Until(carry) => until(a.each(), b.each(), carry.of(carries), out),
                operation => row_by_row(operation, a, b, out),
            }
        }
    }
}

/// Gives each result a register that is free again after its last use; the number of registers.
fn allocate(steps: &mut [Step]) -> usize {
    let last = last_uses(steps);
    let (mut free, mut count) = (Vec::new(), 0);
    for at in 0..steps.len() {
        // Taken before the operands are freed: no step writes where it reads.
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

/// The last step that reads the result of each step; 0 if none does.
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

/// The numbers of an operand in a block.
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

fn row_by_row(operation: Operation, a: Lanes<'_>, b: Lanes<'_>, out: &mut [f64]) {
    // Three instructions for two rows, where a choice between 1, -1 and NaN takes eight.
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
        // The others are calls, which cost more than the choice among them.
        Operation::Call(Function::Sqrt) => map(a, out, f64::sqrt),
        Operation::Call(function) => zip(a, b, out, |a, b| function.value(a, b)),
        _ => map(a, out, |a| a),
    }
}

fn map(a: Lanes<'_>, out: &mut [f64], f: impl Fn(f64) -> f64) {
    match a {
        Lanes::Each(a) => out.iter_mut().zip(a).for_each(|(out, &a)| *out = f(a)),
        Lanes::Same(a) => out.fill(f(a)),
    }
}

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

fn next(a: &[f64], carry: &mut f64, out: &mut [f64]) {
    if let ([first, later @ ..], Some((last, before))) = (a, out.split_last_mut()) {
        before.copy_from_slice(later);
        *last = *carry;
        *carry = *first;
    }
}

fn eventually(a: &[f64], carry: &mut f64, out: &mut [f64]) {
    for (out, &a) in out.iter_mut().zip(a).rev() {
        *carry = greatest(a, *carry);
        *out = *carry;
    }
}

fn until(a: &[f64], b: &[f64], carry: &mut f64, out: &mut [f64]) {
    for (out, (&a, &b)) in out.iter_mut().zip(a.iter().zip(b)).rev() {
        *carry = greatest(b, least(a, *carry));
        *out = *carry;
    }
}

/// The lesser of two numbers; NaN if one of them is.
fn least(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The greater of two numbers; NaN if one of them is.
fn greatest(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
