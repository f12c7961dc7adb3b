//! Robustness in a straight line: what generated code computes, against the definitions and the pass
//! over the operators, at every instant and for numbers of every kind.

use std::convert::Infallible;

use tltl::robustness::typed::{Backward, Every, Start, Typed};
use tltl::robustness::{self, Predicates};
use tltl::{Acceptor, Boolean, Task, tltl};
use tltl_compiler::check;
use tltl_compiler::source::Source;
use tltl_compiler::spec::Spec;
use tltlc::semantics;

use crate::random::{Choices, Seeded};

pub(crate) type Row = [f64; 3];
type Wide = [f64; 12];

pub(crate) fn a(s: &Row) -> f64 {
    s[0]
}

pub(crate) fn b(s: &Row) -> f64 {
    s[1]
}

pub(crate) fn c(s: &Row) -> f64 {
    s[2]
}

/// Formulas that have a type, one for each operator in each place.
macro_rules! each_formula {
    ($check:expr, $($text:literal)*) => {
        $($check.check($text, &tltl! { $text });)*
    };
}

/// What is asked of each formula.
trait Check {
    fn check<P: Predicates<Row>>(&mut self, text: &str, task: &Task<P>);
}

/// What is asked of each, and needs its type.
trait CheckTyped {
    fn check<P>(&mut self, text: &str, task: &Task<P>)
    where
        P: Predicates<Row> + Typed + Sync,
        P::Formula: Backward<Start> + Backward<Every>;
}

macro_rules! all_formulas {
    ($check:expr) => {
        each_formula! { $check,
            "a" "!a" "a && !b || c" "F a" "F (a && b)" "a U b" "!a U (b && c)" "a T b" "X a" "X X a"
            "F (a && F b)" "F (a && X F (b && X F c))" "F a && F b" "F a || X b" "(F a) U b"
            "(a U b) U c" "a U (b U c)" "(F a) T b" "a T b T c" "F (F a && X b)" "X (a U X b)"
            "X true" "a || X true" "F X true" "(X a) U (X b)"
            "F[0,2] a" "F[0,9] a" "F[3,7] a" "G[0,2] a" "G[0,9] a" "G[3,7] a" "X[5] a" "X[5] F a"
            "a U[0,2] b" "a U[0,9] b" "a U[3,7] b" "a T[2,4] b" "F (a && F[0,5] b)" "F (a && G[0,5] b)"
            "F (a && X[5] b)" "F (a U[0,5] b)" "F[0,2] G[0,2] a" "G[0,2] F[0,3] a" "G[0,4] (a U b)"
            "(G[0,3] a) U[0,5] b" "F[0,6] (a && F[0,6] b)" "F[0,4] a && G[0,6] b" "X F[0,6] a"
            "F a && F b ensuring !c" "F[<=10] a ensuring !b" "(a T[1,2] b) ensuring !c"
            "F[0,1000] a" "F (a && F[0,1000] b)" "a U[0,1000] b"
        }
    };
}

fn on_all(mut check: impl Check) {
    all_formulas! { check }
}

fn on_all_typed(mut check: impl CheckTyped) {
    all_formulas! { check }
}

fn spec(text: &str) -> Spec {
    let module = check::formula(&Source::new("formula", text)).unwrap();
    module.tasks[0].spec.clone()
}

/// The place in a row of each proposition.
fn places(spec: &Spec) -> Vec<usize> {
    let place = |name: &str| ["a", "b", "c"].iter().position(|known| *known == name).unwrap();
    spec.propositions().iter().map(|proposition| place(&proposition.name)).collect()
}

/// Numbers that repeat, with both zeros and both infinities among them.
pub(crate) fn trace(choices: &mut Seeded, length: usize) -> Vec<Row> {
    let numbers = [f64::NEG_INFINITY, -3.0, -1.5, -0.0, 0.0, 0.5, 1.0, 2.25, f64::INFINITY];
    let mut number = || numbers[choices.choose(numbers.len() as u32) as usize];
    (0..length).map(|_| [(); 3].map(|()| number())).collect()
}

/// By the definitions, from each instant on.
fn by_definition(spec: &Spec, trace: &[Row]) -> Vec<f64> {
    let places = places(spec);
    let from = |first: usize| {
        let rho = |p: u32, t: usize| trace[first + t][places[p as usize]];
        semantics::robustness(spec, trace.len() - first, rho)
    };
    (0..trace.len()).map(from).collect()
}

struct OnTraces(Vec<Vec<Row>>);

impl Check for OnTraces {
    fn check<P: Predicates<Row>>(&mut self, text: &str, task: &Task<P>) {
        let (spec, operators) = (spec(text), task.formula().operators());
        let places = places(&spec);
        for trace in &self.0 {
            let expected = by_definition(&spec, trace);
            let whole = expected.first().copied().unwrap_or(f64::NEG_INFINITY);
            let about = || format!("{text} on {trace:?}");
            assert_eq!(task.robustness(trace), Ok(whole), "{}", about());
            let mut signal = vec![0.0; trace.len()];
            assert_eq!(task.robustness_signal(trace, &mut signal), Ok(()));
            assert_eq!(signal, expected, "{}", about());

            let holds = |p: u32, t: usize| trace[t][places[p as usize]] > 0.0;
            let satisfied = semantics::satisfied(&spec, trace.len(), holds);
            assert_eq!(task.satisfied(trace), Ok(satisfied), "{}", about());

            let cells = robustness::cells(operators, trace.len());
            let (mut now, mut next) = (vec![0.0; cells], vec![0.0; operators.len()]);
            let rho = |p: usize, t: usize| Ok::<f64, Infallible>(trace[t][places[p]]);
            let found = robustness::trajectory(operators, trace.len(), &mut now, &mut next, rho);
            assert_eq!(found, Ok(whole), "{}", about());
        }
    }
}

#[test]
fn straight_lines_have_the_robustness_of_the_definitions() {
    let mut choices = Seeded(5);
    let short = (0..40).map(|length| trace(&mut choices, length / 2)).collect();
    on_all(OnTraces(short));
}

/// Windows that are longer than many blocks, and trajectories that are longer than these.
#[test]
fn long_windows_have_the_robustness_of_the_definitions() {
    let mut choices = Seeded(6);
    let trace = trace(&mut choices, 303);
    let mut check = OnTraces(vec![trace]);
    check.check("F (a && F[0,100] b)", &tltl! { "F (a && F[0,100] b)" });
    check.check("F[0,200] a", &tltl! { "F[0,200] a" });
    check.check("b U[7,100] a", &tltl! { "b U[7,100] a" });
    check.check("F G[0,30] b", &tltl! { "F G[0,30] b" });
}

/// One NaN in a trajectory, in each place.
struct OnNan(Vec<Row>);

impl Check for OnNan {
    fn check<P: Predicates<Row>>(&mut self, text: &str, task: &Task<P>) {
        let spec = spec(text);
        for (p, &place) in places(&spec).iter().enumerate() {
            let used = task.formula().operators().iter().any(
                |op| matches!(*op, robustness::Op::Is(i) | robustness::Op::Not(i) if i as usize == p),
            );
            for t in 0..self.0.len() {
                let mut trace = self.0.clone();
                trace[t][place] = f64::NAN;
                let mut signal = vec![0.0; trace.len()];
                let of_signal = task.robustness_signal(&trace, &mut signal);
                for found in [task.robustness(&trace).map(|_| ()), of_signal] {
                    let found = found.map_err(|error| (error.instant, error.predicate));
                    let name = spec.propositions()[p].name.as_str().to_owned().into();
                    let expected = if used { Err((Some(t), name)) } else { Ok(()) };
                    assert_eq!(found, expected, "{text} with NaN at {t}");
                }
            }
        }
    }
}

#[test]
fn not_a_number_is_an_error_that_names_predicate_and_instant() {
    on_all(OnNan(trace(&mut Seeded(7), 11)));
}

/// Of several, the earliest instant, and in it the predicate with the lowest number.
#[test]
fn the_first_of_several_nans_is_named() {
    let mut trace = [[1.0; 3]; 13];
    (trace[7][0], trace[7][1], trace[2][1], trace[12][0]) =
        (f64::NAN, f64::NAN, f64::NAN, f64::NAN);
    let found = tltl! { a U b }.robustness(&trace).unwrap_err();
    assert_eq!((&*found.predicate, found.instant), ("b", Some(2)));
    trace[2][1] = 0.0;
    let found = tltl! { F (b && F a) }.robustness(&trace).unwrap_err();
    assert_eq!((&*found.predicate, found.instant), ("b", Some(7)));
}

/// A formula of more operators than a type may have is interpreted, with the same result.
#[test]
fn long_formulas_have_the_robustness_of_the_definitions() {
    let mut choices = Seeded(8);
    let mut check = OnTraces((0..20).map(|length| trace(&mut choices, length)).collect());
    check.check(
        "a T b T c T a T b T c T a T b T c T a T b T c",
        &tltl! { "a T b T c T a T b T c T a T b T c T a T b T c" },
    );
    check.check("F a || F[0,5000] b", &tltl! { "F a || F[0,5000] b" });
}

/// Predicates of other kinds: scaled Booleans, and a state that is larger than its predicates.
#[test]
fn boolean_predicates_are_read_in_a_straight_line() {
    let wet = Boolean::new(|s: &Row| s[0] > 0.0).scaled(0.25);
    let home = |s: &Row| s[1];
    let task = tltl! { !wet U home };
    assert_eq!(task.robustness(&[[0.0, -1.0, 0.0], [0.0, 2.0, 0.0]]), Ok(0.25));
    assert_eq!(task.robustness(&[[1.0, -1.0, 0.0], [0.0, 2.0, 0.0]]), Ok(-0.25));
}

/// The same predicates under a formula that they were not generated with.
#[test]
fn another_formula_is_not_that_of_the_predicates() {
    tltl! {
        state s: Row;
        task first = F s[0] > 0 && X true;
        task other = F s[0] > 0;
    }
    let (formula, automaton) = (other().formula().clone(), other().automaton().clone());
    let task = Task::new("other", formula, automaton, first {}).unwrap();
    assert_eq!(
        (task.robustness(&[[3.0; 3]]), first().robustness(&[[3.0; 3]])),
        (Ok(3.0), Ok(f64::NEG_INFINITY))
    );
}

/// Steps by shifts, by look-ups and by a diagram, one by one and many at once, against the walk
/// through the automaton that asks for one proposition after the other.
struct OnBatches(Vec<Row>);

impl Check for OnBatches {
    fn check<P: Predicates<Row>>(&mut self, text: &str, task: &Task<P>) {
        let (automaton, places) = (task.automaton(), places(&spec(text)));
        let expected = |q: u32, s: &Row| {
            automaton.next(q, |i| Ok::<_, Infallible>(s[places[i]] > 0.0)).unwrap()
        };
        let states = automaton.states();
        let before: Vec<u32> = (0..states).cycle().take(self.0.len()).collect();
        let after: Vec<u32> = before.iter().zip(&self.0).map(|(&q, s)| expected(q, s)).collect();
        let one_by_one: Vec<u32> =
            before.iter().zip(&self.0).map(|(&q, s)| task.next(q, s).unwrap()).collect();
        assert_eq!(one_by_one, after, "{text}");
        let (mut run, mut at) = (task.run(), 0);
        for s in &self.0 {
            let verdict = run.step(s).unwrap();
            at = expected(at, s);
            let decided = task.is_terminal(at).then(|| task.is_accepting(at));
            assert_eq!((run.state(), verdict), (at, decided), "{text}");
        }
        let mut q = before.clone();
        task.step_batch(&mut q, &self.0).unwrap();
        assert_eq!(q, after, "{text}");
        let mut q = before.clone();
        task.step_batch_of(&mut q, |i| self.0[i]).unwrap();
        assert_eq!(q, after, "{text}");

        // A NaN stops the batch at its place.
        let Some(&place) = places.first() else { return };
        let mut broken = self.0.clone();
        (broken[70][place], broken[90][place]) = (f64::NAN, f64::NAN);
        let mut q = before.clone();
        let error = task.step_batch(&mut q, &broken).unwrap_err();
        assert_eq!((error.instant, &error.predicate), (Some(70), &automaton.propositions()[0]));
        assert!(q[..70] == after[..70] && q[70..] == before[70..], "{text}");
    }
}

#[test]
fn steps_of_all_forms_and_in_batches_are_those_of_the_automaton() {
    on_all(OnBatches(trace(&mut Seeded(9), 200)));
}

/// Nineteen trajectories of one length, one after the other and side by side.
struct OnMany(Vec<Vec<Row>>);

impl CheckTyped for OnMany {
    fn check<P>(&mut self, text: &str, task: &Task<P>)
    where
        P: Predicates<Row> + Typed + Sync,
        P::Formula: Backward<Start> + Backward<Every>,
    {
        let (count, length) = (self.0.len(), self.0[0].len());
        let spec = spec(text);
        let expected: Vec<f64> =
            self.0.iter().map(|trace| by_definition(&spec, trace)[0]).collect();
        let mut one_by_one: Vec<Row> = self.0.concat();
        let side_by_side = |rows: &[Row]| -> Vec<Row> {
            (0..count * length).map(|at| rows[at % count * length + at / count]).collect()
        };
        let mut found = vec![0.0; count];
        task.robustness_batch(&one_by_one, &mut found).unwrap();
        assert_eq!(found, expected, "{text}");
        for threads in [1, 3, 40] {
            found.fill(0.0);
            task.robustness_batch_on(threads, &one_by_one, &mut found).unwrap();
            assert_eq!(found, expected, "{text}");
        }
        found.fill(0.0);
        task.robustness_batch_by_time(&side_by_side(&one_by_one), &mut found).unwrap();
        assert_eq!(found, expected, "{text}");

        // A NaN of trajectory 7, and a later one.
        let places = places(&spec);
        let Some(&place) = places.first() else { return };
        let (first, later) = (7 * length + 5, 11 * length + 2);
        (one_by_one[first][place], one_by_one[later][place]) = (f64::NAN, f64::NAN);
        let error = task.robustness_batch(&one_by_one, &mut found).unwrap_err();
        assert_eq!(error.instant, Some(first), "{text}");
        let error = task.robustness_batch_on(2, &one_by_one, &mut found).unwrap_err();
        assert_eq!(error.instant, Some(first), "{text}");
        let by_time = side_by_side(&one_by_one);
        let error = task.robustness_batch_by_time(&by_time, &mut found).unwrap_err();
        assert_eq!(error.instant, Some(2 * count + 11), "the earliest instant: {text}");
    }
}

#[test]
fn many_trajectories_at_once_have_the_robustness_of_each() {
    let mut choices = Seeded(21);
    on_all_typed(OnMany((0..19).map(|_| trace(&mut choices, 23)).collect()));
}

/// A long trajectory, with few numbers that are large: what comes late counts.
struct OnLong(Vec<Row>);

impl CheckTyped for OnLong {
    fn check<P>(&mut self, text: &str, task: &Task<P>)
    where
        P: Predicates<Row> + Typed + Sync,
        P::Formula: Backward<Start> + Backward<Every>,
    {
        let expected = task.robustness(&self.0);
        for threads in [1, 3, 16] {
            assert_eq!(task.robustness_on(threads, &self.0), expected, "{text}");
        }
        let before: Vec<u32> = (0..task.states()).cycle().take(self.0.len()).collect();
        let mut after = before.clone();
        task.step_batch(&mut after, &self.0).unwrap();
        for threads in [1, 3, 16] {
            let mut q = before.clone();
            task.step_batch_on(threads, &mut q, &self.0).unwrap();
            assert!(q == after, "{text}");
        }
        let Some(&place) = places(&spec(text)).first() else { return };
        let mut broken = self.0.clone();
        (broken[40_000][place], broken[90_000][place]) = (f64::NAN, f64::NAN);
        let error = task.robustness_on(3, &broken).unwrap_err();
        assert_eq!(error.instant, Some(40_000), "{text}");
        let mut q = before;
        let error = task.step_batch_on(3, &mut q, &broken).unwrap_err();
        assert_eq!(error.instant, Some(40_000), "{text}");
        assert!(q[..40_000] == after[..40_000], "{text}");
    }
}

#[test]
fn long_trajectories_and_batches_are_read_in_parts() {
    let mut choices = Seeded(22);
    let mut number = |most: u32, t: u32| match choices.choose(20_000) {
        0 => f64::from(choices.choose(90)) / 10.0,
        _ => f64::from(choices.choose(most)) / 10.0 - f64::from(t % 7) / 4.0,
    };
    on_all_typed(OnLong(
        (0..100_001).map(|t| [number(9, t), number(6, t), number(3, t)]).collect(),
    ));
}

/// Automata of five and of twelve propositions: a table of valuations, and a diagram.
#[test]
fn automata_of_many_propositions_step_alike() {
    tltl! {
        state s: Wide;
        task five = F (s[0] > 0) && F (s[1] > 0) && F (s[2] > 0) && F (s[3] > 0 && s[4] > 0);
        task twelve = s[0] > 0 T s[1] > 0 T s[2] > 0 T s[3] > 0 T s[4] > 0 T s[5] > 0 T s[6] > 0
            T s[7] > 0 T s[8] > 0 T s[9] > 0 T s[10] > 0 T s[11] > 0;
    }
    let mut choices = Seeded(10);
    let rows: Vec<Wide> =
        (0..150).map(|_| [(); 12].map(|()| f64::from(choices.choose(4)) - 2.0)).collect();
    fn check<P: Predicates<Wide>>(task: &Task<P>, rows: &[Wide]) {
        let automaton = task.automaton();
        let before: Vec<u32> = (0..automaton.states()).cycle().take(rows.len()).collect();
        let next = |(&q, s): (&u32, &Wide)| {
            automaton.next(q, |i| Ok::<_, Infallible>(s[i] > 0.0)).unwrap()
        };
        let after: Vec<u32> = before.iter().zip(rows).map(next).collect();
        let mut q = before.clone();
        task.step_batch(&mut q, rows).unwrap();
        assert_eq!(q, after);
        let one_by_one = before.iter().zip(rows).map(|(&q, s)| task.next(q, s).unwrap());
        assert!(one_by_one.eq(after));
        let (mut run, mut q) = (task.run(), 0);
        for s in rows {
            q = next((&q, s));
            run.step(s).unwrap();
            assert_eq!(run.state(), q);
        }
    }
    check(&five(), &rows);
    check(&twelve(), &rows);
}

/// Comparisons with numbers and between fields, where a difference is tiny, infinite or rounded.
#[test]
fn a_comparison_holds_as_its_robustness_says() {
    type Pair = [f64; 2];
    tltl! {
        state s: Pair;
        task compared = F (s[0] < 0.1) || F (s[0] <= 0.1) || F (s[0] > 0.1) || F (s[0] >= 0.1)
            || F (s[0] == 0.1) || F (s[0] < s[1]) || F (s[0] <= s[1]) || F (0 < s[0]) || F (s[0] <= 0);
    }
    let task = compared();
    let names: Vec<&str> = task.automaton().propositions().iter().map(|name| &**name).collect();
    let least = f64::MIN_POSITIVE * f64::EPSILON;
    let near = [0.1_f64, f64::MIN_POSITIVE, f64::MAX].map(|x| [x.next_down(), x, x.next_up()]);
    let numbers = near.into_iter().flatten().chain([0.0, least, f64::NAN]);
    let numbers: Vec<f64> = numbers.flat_map(|x| [x, -x]).collect();
    for s in numbers.iter().flat_map(|&x| numbers.iter().map(move |&y| [x, y])) {
        for (i, name) in names.iter().enumerate() {
            let holds = compared {}.holds(i, &s).ok();
            let expected = task.predicate_robustness(i, &s).ok().map(|rho| match rho {
                0.0 => name.contains('='),
                _ => rho > 0.0,
            });
            assert_eq!(holds, expected, "{name} at {s:?}");
        }
    }
}

#[test]
#[should_panic = "there is no state 3"]
fn a_state_that_the_automaton_does_not_have_is_refused() {
    let _ = tltl! { a T b }.next(3, &[0.0; 3]);
}
