//! Predicates column by column against the same predicates row by row, and the automaton's moves
//! many at a time against one by one.
//!
//! `cargo bench -p tltl-tests --bench columns`: nanoseconds a row, the least of some repetitions,
//! and how many times faster the columns are. All results are compared with the row-wise ones, bit
//! for bit, before any time is printed.

#[path = "../rowwise.rs"]
mod rowwise;

use std::hint::black_box;
use std::time::Instant;

use rowwise::Rowwise;
use tltl::Acceptor;
use tltl::automaton::{Automaton, Transitions};
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Column, Columns, Evaluator, Scratch};
use tltlc::{semantics, task};

/// Five comparisons of two columns.
const PLAIN: &str = "state Plane { x: f64, y: f64 }
    predicate east = x > 0.5
    predicate band = -0.25 <= y <= 0.25
    predicate apart = abs(x - y) > 0.3
    predicate low = 2 * x + y < 0.7 || y < -0.5
    predicate on = x - y != 0
    task t = F east && ((apart || low || on) U band)";

/// Five predicates that call functions.
const CALLS: &str = "state Plane { x: f64, y: f64 }
    predicate near = hypot(x - 1, y) < 0.5
    predicate circle = sqrt(x * x + y * y) <= 0.8
    predicate wave = sin(3 * x) > y
    predicate ahead = atan2(y, x) < 0.7
    predicate both = near && !wave
    task t = F near && ((wave || ahead || both) U circle)";

fn main() {
    println!(
        "{:<8}{:>9}{:>11}{:>22}{:>22}{:>24}{:>22}",
        "file", "rows", "row by row", "labels", "rho", "labels, f32 strided", "robustness"
    );
    for (name, text) in [("plain", PLAIN), ("calls", CALLS)] {
        let source = Source::new(name, text);
        let compiled = compile::file(&source, Budget::default()).expect("it is a file");
        for rows in [1_000, 100_000, 1_000_000] {
            Case::new(&compiled, rows).measure(name);
        }
    }
    println!(
        "\n{:<28}{:>9}{:>12}{:>22}{:>22}{:>12}{:>22}",
        "automaton", "rows", "one by one", "letters", "labels", "run by one", "run"
    );
    let chain: Vec<_> = (0..16).map(|i| format!("p{i}")).collect();
    let pairs: Vec<_> = chain.chunks(2).map(|pair| format!("F ({})", pair.join(" && "))).collect();
    for formula in ["F a && F b && F c", &chain.join(" T "), &pairs.join(" && ")] {
        let task = task::compile(formula, Budget::default()).expect("it is a formula");
        for rows in [1_000, 100_000] {
            moves(task.automaton(), rows);
        }
    }
}

/// Moves of many states, and along one trajectory.
fn moves(automaton: &Automaton, rows: usize) {
    let count = automaton.propositions().len();
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        seed >> 32
    };
    let letters: Vec<u64> = (0..rows).map(|_| random() & random()).collect();
    let label = |bits: u64| (0..count).map(move |i| bits >> i & 1 == 1);
    let labels: Vec<bool> = letters.iter().flat_map(|&bits| label(bits)).collect();
    let states = u64::from(automaton.states());
    let before: Vec<u32> = (0..rows).map(|_| (random() % states) as u32).collect();
    let next = |q: u32, bits: u64| automaton.next(q, |i| Ok::<_, ()>(bits >> i & 1 == 1)).unwrap();

    let mut q = before.clone();
    let by_one = nanoseconds(rows, || {
        q.copy_from_slice(&before);
        q.iter_mut().zip(&letters).for_each(|(q, &bits)| *q = next(*q, bits));
    });
    let expected = q.clone();
    let by_letters = nanoseconds(rows, || {
        q.copy_from_slice(&before);
        automaton.step_batch(&mut q, &letters[..]);
    });
    assert_eq!(q, expected, "letters");
    let by_labels = nanoseconds(rows, || {
        q.copy_from_slice(&before);
        automaton.step_batch(&mut q, &labels[..]);
    });
    assert_eq!(q, expected, "labels");

    let run_by_one = nanoseconds(rows, || {
        let mut at = 0;
        for (q, &bits) in q.iter_mut().zip(&letters) {
            at = next(at, bits);
            *q = at;
        }
    });
    let expected = q.clone();
    let run = nanoseconds(rows, || automaton.run(0, &letters[..], &mut q));
    assert_eq!(q, expected, "run");
    let form = match &automaton.tables().transitions {
        Transitions::Table { .. } => "table".to_owned(),
        Transitions::Diagram { nodes, .. } => format!("{} nodes", nodes.len()),
    };
    let name = format!("{states} states of {count}, {form}");
    println!(
        "{name:<28}{rows:>9}{by_one:>12.2}{:>22}{:>22}{run_by_one:>12.2}{:>22}",
        times(by_letters, by_one),
        times(by_labels, by_one),
        times(run, run_by_one)
    );
}

fn times(time: f64, before: f64) -> String {
    format!("{time:.2}: {:.1} x", before / time)
}

/// The least nanoseconds a row of some repetitions.
fn nanoseconds<T>(rows: usize, mut run: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    let mut least = f64::INFINITY;
    while start.elapsed().as_secs_f64() < 0.3 || least == f64::INFINITY {
        let start = Instant::now();
        black_box(run());
        least = least.min(start.elapsed().as_secs_f64());
    }
    least * 1e9 / rows as f64
}

struct Case<'a> {
    compiled: &'a Compiled,
    evaluator: Evaluator,
    rows: usize,
    /// The state of each row, all representable as `f32`.
    states: Vec<[f32; 2]>,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl<'a> Case<'a> {
    fn new(compiled: &'a Compiled, rows: usize) -> Self {
        let task = &compiled.module.tasks[0];
        let evaluator = Evaluator::new(&compiled.module, task).expect("it can be read");
        let at = |t: usize, speed: f64| ((t as f64 * speed).sin() * 1.5) as f32;
        let states: Vec<_> = (0..rows).map(|t| [at(t, 0.7), at(t, 1.1)]).collect();
        let column = |i: usize| states.iter().map(|state| f64::from(state[i])).collect();
        Self { compiled, evaluator, rows, x: column(0), y: column(1), states }
    }

    fn measure(&self, name: &str) {
        let (labels, rho) = self.by_rows();
        let columns = [Column::from(&self.x[..]), Column::from(&self.y[..])];
        let columns = Columns::new(self.rows, &columns).expect("equal columns");
        let flat = self.states.as_flattened();
        let strided = [0, 1].map(|i| Column::strided(flat, i, 2, self.rows).expect("inside"));
        let strided = Columns::new(self.rows, &strided).expect("equal columns");
        let mut scratch = Scratch::default();

        let by_rows = nanoseconds(self.rows, || self.by_rows());
        let mut found = vec![false; labels.len()];
        let [by_labels, by_strided] = [columns, strided].map(|columns| {
            let time = nanoseconds(self.rows, || {
                self.evaluator.labels(&columns, &mut scratch, &mut found).expect("numbers");
            });
            assert_eq!(found, labels, "labels");
            time
        });
        let mut found = vec![0.0; rho.len()];
        let by_rho = nanoseconds(self.rows, || {
            self.evaluator.rho(&columns, &mut scratch, &mut found).expect("numbers");
        });
        let bits = |numbers: &[f64]| numbers.iter().map(|rho| rho.to_bits()).collect::<Vec<_>>();
        assert!(bits(&found) == bits(&rho), "rho");

        let width = self.evaluator.propositions();
        let spec = &self.compiled.module.tasks[0].spec;
        let semantics = || {
            let (_, rho) = self.by_rows();
            semantics::robustness(spec, self.rows, |p, t| rho[t * width + p as usize])
        };
        let mut whole = 0.0;
        let robustness = nanoseconds(self.rows, || {
            whole = self.evaluator.robustness(&columns, &mut scratch).expect("numbers");
        });
        assert_eq!(whole, semantics(), "robustness");
        let by_semantics = nanoseconds(self.rows, semantics);

        println!(
            "{name:<8}{:>9}{by_rows:>11.1}{:>22}{:>22}{:>24}{:>22}",
            self.rows,
            times(by_labels, by_rows),
            times(by_rho, by_rows),
            times(by_strided, by_rows),
            times(robustness, by_semantics)
        );
    }

    /// Labels and robustness of all rows, row by row.
    fn by_rows(&self) -> (Vec<bool>, Vec<f64>) {
        let task = &self.compiled.module.tasks[0];
        let mut rowwise = Rowwise::new(&self.compiled.module, task, self.evaluator.inputs());
        let (mut labels, mut rho) = (Vec::new(), Vec::new());
        for (&x, &y) in self.x.iter().zip(&self.y) {
            let reading = rowwise.read(&[x, y]).expect("numbers");
            labels.extend(reading.holds);
            rho.extend(reading.robustness);
        }
        (labels, rho)
    }
}
