//! Robustness while a trajectory grows: the monitor of generated code against the definition on every
//! prefix, the interval against the best that any extension can bring, and the monitor of run time.

use tltl::robustness::Predicates;
use tltl::robustness::typed::Typed;
use tltl::robustness::typed::forward::{Forward, Once};
use tltl::{Acceptor, Task, tltl};
use tltl_compiler::check;
use tltl_compiler::source::Source;
use tltl_compiler::spec::{Formula, Spec};
use tltl_compiler::translate::Budget;
use tltlc::online::Online;
use tltlc::semantics;

use crate::random::Seeded;
use crate::straight::{Row, a, b, c, trace};

/// A formula, its propositions, and the traces to try.
struct Case<'a> {
    text: &'a str,
    spec: Spec,
    places: Vec<usize>,
    traces: &'a [Vec<Row>],
}

impl<'a> Case<'a> {
    fn new(text: &'a str, traces: &'a [Vec<Row>]) -> Self {
        let module = check::formula(&Source::new("formula", text)).unwrap();
        let spec = module.tasks[0].spec.clone();
        let place = |name: &str| ["a", "b", "c"].iter().position(|known| *known == name).unwrap();
        let places = spec.propositions().iter().map(|p| place(&p.name)).collect();
        Self { text, spec, places, traces }
    }

    fn rho(&self, row: &Row, p: u32) -> f64 {
        row[self.places[p as usize]]
    }

    /// For each proposition the value that makes its literals true: in these formulas all of one
    /// proposition have one sign.
    fn best(&self) -> Vec<f64> {
        let mut best = vec![f64::INFINITY; self.spec.propositions().len()];
        for (_, formula) in self.spec.formulas() {
            if let Formula::Literal { proposition, negated: true } = formula {
                best[proposition as usize] = f64::NEG_INFINITY;
            }
        }
        best
    }

    /// The robustness of a trajectory after which every literal holds by any amount, for longer than
    /// any bound asks.
    fn greatest(&self, prefix: &[Row]) -> f64 {
        let best = self.best();
        let rho = |p: u32, t: usize| match prefix.get(t) {
            Some(row) => self.rho(row, p),
            None => best[p as usize],
        };
        semantics::robustness(&self.spec, prefix.len() + 40, rho)
    }

    fn check<P>(&self, task: &Task<P>)
    where
        P: Predicates<Row> + Typed,
        P::Formula: Forward<Once>,
    {
        for trace in self.traces {
            let mut online = task.online();
            let mut general = Online::new(&self.spec, Budget::default());
            let mut q = 0;
            assert_eq!(online.interval().lower, f64::NEG_INFINITY);
            for (t, row) in trace.iter().enumerate() {
                let about = || format!("{} on {:?}", self.text, &trace[..=t]);
                let interval = online.step(row).unwrap();
                let rho = |p: u32, t: usize| self.rho(&trace[t], p);
                let lower = semantics::robustness(&self.spec, t + 1, rho);
                assert_eq!(interval.lower, lower, "{}", about());
                assert_eq!(interval.upper, self.greatest(&trace[..=t]), "{}", about());
                assert_eq!(task.robustness(&trace[..=t]), Ok(lower), "{}", about());

                let numbers: Vec<f64> = self.places.iter().map(|&place| row[place]).collect();
                general.step(&numbers);
                assert_eq!(general.robustness(), lower, "{}", about());
                assert_eq!(general.greatest(), Some(interval.upper), "{}", about());

                q = task.next(q, row).unwrap();
                assert_eq!(online.state(), q);
                let decided = task.is_terminal(q).then(|| task.is_accepting(q));
                assert_eq!(online.verdict(), decided, "{}", about());
            }
        }
    }
}

fn traces(seed: u64, lengths: impl Iterator<Item = usize>) -> Vec<Vec<Row>> {
    let mut choices = Seeded(seed);
    lengths.map(|length| trace(&mut choices, length)).collect()
}

macro_rules! each_formula {
    ($traces:expr, $($text:literal)*) => {
        $(Case::new($text, $traces).check(&tltl! { $text });)*
    };
}

#[test]
fn monitors_have_the_robustness_of_every_prefix_and_the_best_of_every_extension() {
    let traces = traces(1, (1..60).map(|length| 1 + length / 4));
    each_formula! { &traces,
        "a" "!a" "a && !b || c" "F a" "F (a && b)" "a U b" "!a U (b && c)" "a T b" "X a" "X X a"
        "F (a && F b)" "F (a && X F (b && X F c))" "F a && F b" "F a || X b" "a U (b U c)"
        "a T b T c" "X (a U X b)" "F (F a || X b)" "F a && X (b U c)" "a && X b" "a U (b && X c)"
        "X true" "a || X true" "F X true" "F (F b && a)" "F (a || b U c)" "!c U a && !c U b"
        "F[0,2] a" "F[0,9] a" "F[3,7] a" "G[0,2] a" "G[0,9] a" "G[3,7] a" "X[5] a" "X[5] F a"
        "a U[0,2] b" "a U[0,9] b" "a U[3,7] b" "a T[2,4] b" "F (a && F[0,5] b)" "F (a && G[0,5] b)"
        "F (a && X[5] b)" "F (a U[0,5] b)" "F (a U[2,5] b)" "F (a U[5,5] b)" "F[0,6] (a && F[0,6] b)"
        "F[0,4] a && G[0,6] b" "X F[0,6] a" "a U[0,4] (b && F[0,3] c)" "F (b && X[3] G[0,2] a)"
        "F a && F b ensuring !c" "F[<=10] a ensuring !b" "(a T[1,2] b) ensuring !c"
        "a U (b U[0,3] c)" "F[0,5] (a U[0,5] b)" "F[0,5] G[0,2] a" "F G[0,3] a"
    }
}

/// Queues whose cells are used many times over, and windows that are longer than the trajectory.
#[test]
fn long_bounds_are_followed() {
    let traces = traces(2, [150, 151].into_iter());
    for trace in &traces {
        let far = tltl! { "F (a && F[0,50] b)" };
        let held = tltl! { "F (a U[0,50] b)" };
        let kept = tltl! { "F (a && G[0,20] b)" };
        let mut online = (far.online(), held.online(), kept.online());
        for t in 0..trace.len() {
            let (row, prefix) = (&trace[t], &trace[..=t]);
            assert_eq!(Ok(online.0.step(row).unwrap().lower), far.robustness(prefix), "{t}");
            assert_eq!(Ok(online.1.step(row).unwrap().lower), held.robustness(prefix), "{t}");
            assert_eq!(Ok(online.2.step(row).unwrap().lower), kept.robustness(prefix), "{t}");
        }
    }
}

/// A NaN is an error that names predicate and instant, and the monitor stays as it was.
#[test]
fn a_state_that_is_not_a_number_is_refused_and_not_read() {
    let task = tltl! { "F (a && F[0,2] b)" };
    let rows = [[1.0, -1.0, 0.0], [-2.0, 3.0, 0.0], [-2.0, 1.0, 0.0]];
    let (mut online, mut expected) = (task.online(), task.online());
    for (t, row) in rows.iter().enumerate() {
        for p in 0..2 {
            let mut broken = *row;
            broken[p] = f64::NAN;
            let error = online.step(&broken).unwrap_err();
            assert_eq!((&*error.predicate, error.instant), (["a", "b"][p], Some(t)));
        }
        assert_eq!(online.step(row), expected.step(row));
    }
    assert_eq!(online.interval().lower, 1.0);
}

/// Where the automaton is a diagram, which asks for some predicates only, all are asked for.
#[test]
fn a_nan_that_the_automaton_does_not_read_is_refused() {
    type Wide = [f64; 12];
    tltl! {
        state s: Wide;
        task twelve = s[0] > 0 T s[1] > 0 T s[2] > 0 T s[3] > 0 T s[4] > 0 T s[5] > 0 T s[6] > 0
            T s[7] > 0 T s[8] > 0 T s[9] > 0 T s[10] > 0 T s[11] > 0;
    }
    let task = twelve();
    let mut online = task.online();
    let mut row = [-1.0; 12];
    online.step(&row).unwrap();
    row[7] = f64::NAN;
    let error = online.step(&row).unwrap_err();
    assert_eq!((&*error.predicate, error.instant), ("s[7] > 0", Some(1)));
    row[7] = 2.0;
    assert_eq!(online.step(&row).unwrap().upper, f64::INFINITY);
}

#[test]
fn the_verdict_is_given_as_soon_as_it_is_decided() {
    let task = tltl! { "!a U b" };
    let mut online = task.online();
    assert_eq!(online.verdict(), None);
    online.step(&[-1.0, -1.0, 0.0]).unwrap();
    assert_eq!(online.verdict(), None);
    let lost = online.step(&[2.0, -1.0, 0.0]).unwrap();
    assert_eq!((online.verdict(), lost.upper), (Some(false), -1.0));
}
