//! Factored tasks: the parts side by side say what the whole says.

use tltl::augmented::LabelError;
use tltl::factored::{Factored, JointDeadEnds, Part};
use tltl::prelude::*;
use tltl::product::Operand;
use tltl::robustness::{NotANumber, Predicates};

/// Which of 40 propositions hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Letter(u64);

mod tasks {
    use super::Letter;

    tltl! {
        state s: Letter;
        predicate h = { s.0 >> 39 & 1 == 1 };
        /// All three at once, as one automaton.
        task whole = F { s.0 & 1 == 1 } && F { s.0 & 2 == 2 } && (!h U { s.0 & 4 == 4 });
        #[factored]
        task apart = F { s.0 & 1 == 1 } && F { s.0 & 2 == 2 } && (!h U { s.0 & 4 == 4 });
    }

    use tltl::tltl;
}

fn letters() -> impl Iterator<Item = Vec<Letter>> {
    let mut random: u64 = 7;
    (0..500).map(move |i| {
        (0..i % 9)
            .map(|_| {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(99);
                let bits = random >> 40;
                Letter(bits & 7 & (bits >> 3) | (bits >> 6 & bits >> 7 & 1) << 39)
            })
            .collect()
    })
}

#[test]
fn parts_side_by_side_agree_with_the_whole() {
    let (whole, apart) = (tasks::whole(), tasks::apart());
    assert_eq!((apart.len(), apart.joint_dead_ends()), (3, JointDeadEnds::None));
    for trace in letters() {
        assert_eq!(whole.satisfied(&trace), apart.satisfied(&trace), "{trace:?}");
        assert_eq!(whole.robustness(&trace), apart.robustness(&trace), "{trace:?}");
        let (mut q, mut parts) = (0, vec![0; apart.len()]);
        for letter in &trace {
            q = whole.next(q, letter).unwrap();
            apart.next(&mut parts, letter).unwrap();
            assert_eq!(whole.is_accepting(q), apart.is_accepting(&parts), "{trace:?}");
            assert_eq!(whole.is_trap(q), apart.is_lost(&parts), "{trace:?}");
        }
    }
}

#[test]
fn parts_multiply_to_the_whole() {
    let apart = tasks::apart();
    let parts: Vec<_> = (0..apart.len()).map(|i| apart.part(i)).collect();
    let operands: Vec<Operand<'_, Letter>> = parts.iter().map(|part| part as _).collect();
    let product = Product::conjunction(&operands);
    assert_eq!((product.states(), product.size().trap), (tasks::whole().states(), true));
}

/// The numbers of the tuples are another name for the states of the product: what holds of one holds
/// of the other.
#[test]
fn numbered_tuples_are_the_product() {
    let apart = tasks::apart();
    let parts: Vec<_> = (0..apart.len()).map(|i| apart.part(i)).collect();
    let operands: Vec<Operand<'_, Letter>> = parts.iter().map(|part| part as _).collect();
    let product = Product::conjunction(&operands);
    let numbered = tasks::apart().numbered().unwrap();
    assert_eq!((numbered.states(), numbered.name()), (2 * 2 * 3, "apart"));
    // The last part is `!h U …`, whose trap is its state 2; the least tuple with it is (0, 0, 2).
    let number = |q: u32| match product.is_trap(q) {
        true => 2 * 2 * 2,
        false => {
            product.components(q).iter().rev().zip([3, 2, 2]).fold(0, |n, (q, size)| n * size + q)
        }
    };
    for q in 0..product.states() {
        let n = number(q);
        assert!(product.is_trap(q) || numbered.parts(n).eq(product.components(q).iter().copied()));
        assert_eq!(numbered.is_accepting(n), product.is_accepting(q));
        assert_eq!(numbered.is_trap(n), product.is_trap(q));
        assert_eq!(numbered.distance(n), product.distance(q));
        let mut successors = Vec::new();
        numbered.successors(n, &mut |to| successors.push(to));
        let mut expected: Vec<u32> = product.edges(q).iter().map(|&to| number(to)).collect();
        expected.sort_unstable();
        assert_eq!(successors, expected, "from {q}");
    }
    for trace in letters() {
        let (mut q, mut n) = (0, 0);
        for letter in &trace {
            let rho = |task: &dyn Monitor<Letter>, q| {
                (task.progress_robustness(q, letter), task.trap_robustness(q, letter))
            };
            assert_eq!(rho(&numbered, n), rho(&product, q), "{letter:?} at {q}");
            (q, n) = (product.next(q, letter).unwrap(), numbered.next(n, letter).unwrap());
            assert_eq!(n, number(q), "{trace:?}");
        }
        assert_eq!(numbered.trajectory_robustness(&trace), apart.robustness(&trace));
    }
}

#[test]
fn tuples_without_numbers_are_an_error_that_names_the_sizes() {
    let goal = tltl! { |s: &Letter| F { s.0 & 1 == 1 } };
    let part = Part {
        formula: goal.formula().clone(),
        automaton: goal.automaton().clone(),
        predicates: vec![0].into(),
    };
    let tour = |goals: usize| {
        let parts = vec![part.clone(); goals];
        Factored::new("tour", "F a && …", parts, JointDeadEnds::None, Goal).unwrap()
    };
    assert_eq!(tour(31).numbered().map(|tour| tour.states()), Ok(1 << 31));
    let error = tour(32).numbered().unwrap_err().to_string();
    let sizes = ["2"; 32].join(" × ");
    let expected =
        format!("the parts of `tour` have {sizes} states together, which is more than 2^32 - 1");
    assert_eq!(error, expected);

    let other = Part { predicates: vec![0, 1].into(), ..part };
    let error = Factored::new("tour", "F a", vec![other], JointDeadEnds::None, Goal).unwrap_err();
    assert_eq!(error.to_string(), "`predicates` has 2 entries, not 1");
}

/// The one predicate of a tour whose goals are all the same.
#[derive(Debug)]
struct Goal;

impl Predicates<Letter> for Goal {
    fn robustness(&self, _: usize, letter: &Letter) -> f64 {
        if letter.0 & 1 == 1 { 1.0 } else { -1.0 }
    }

    fn holds(&self, i: usize, letter: &Letter) -> Result<bool, NotANumber> {
        Ok(self.robustness(i, letter) > 0.0)
    }
}

#[test]
fn thirty_goals_are_sixty_states() {
    macro_rules! bit {
        ($($name:ident $bit:literal)*) => {$(
            let $name = |s: &Letter| if s.0 >> $bit & 1 == 1 { 1.0 } else { -1.0 };
        )*};
    }
    bit! {
        a0 0 a1 1 a2 2 a3 3 a4 4 a5 5 a6 6 a7 7 a8 8 a9 9 b0 10 b1 11 b2 12 b3 13 b4 14 b5 15 b6 16
        b7 17 b8 18 b9 19 c0 20 c1 21 c2 22 c3 23 c4 24 c5 25 c6 26 c7 27 c8 28 c9 29
    }
    let tour = tltl! {
        #[factored]
        F a0 && F a1 && F a2 && F a3 && F a4 && F a5 && F a6 && F a7 && F a8 && F a9
            && F b0 && F b1 && F b2 && F b3 && F b4 && F b5 && F b6 && F b7 && F b8 && F b9
            && F c0 && F c1 && F c2 && F c3 && F c4 && F c5 && F c6 && F c7 && F c8 && F c9
    };
    let states: u32 = (0..tour.len()).map(|i| tour.part(i).states()).sum();
    assert_eq!((tour.len(), states), (30, 60));
    let one_by_one: Vec<Letter> = (0..30).map(|bit| Letter(1 << bit)).collect();
    assert_eq!(tour.satisfied(&one_by_one), Ok(true));
    assert_eq!(tour.satisfied(&one_by_one[1..]), Ok(false));
}

/// Twelve cells in a ring, each with a bit of its own; a step slips back one time in five.
#[derive(Clone, Copy)]
struct Ring;

impl FiniteModel for Ring {
    type State = Letter;

    fn states(&self) -> usize {
        12
    }

    fn actions(&self) -> usize {
        2
    }

    fn state(&self, s: usize) -> Letter {
        Letter(1 << s)
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        let p = [0.8, 0.2][a];
        outcome((s + 1) % 12, p);
        outcome((s + 11) % 12, 1.0 - p);
    }
}

macro_rules! bits {
    ($($name:ident $bit:literal)*) => {$(
        let $name = |s: &Letter| if s.0 >> $bit & 1 == 1 { 1.0 } else { -1.0 };
    )*};
}

/// Six goals and one that is not to be touched before another: learned as it is, worth what the
/// product of its parts is worth.
#[test]
fn factored_tasks_are_learned_directly() {
    bits! { a0 0 a1 2 a2 4 a3 6 a4 8 a5 10 h 11 g 1 }
    let tour = tltl! {
        #[factored]
        F a0 && F a1 && F a2 && F a3 && F a4 && F a5 && (!h U g)
    };
    let states: Vec<Letter> = (0..12).map(|s| Ring.state(s)).collect();
    let actions = ["right", "left"];
    let task = Labelled::of_factored(states.clone(), actions, &tour, 1_000).unwrap();
    assert_eq!(task.automaton_states(), 129, "2^7 and the trap");
    let small = Labelled::of_factored(states.clone(), actions, &tour, 100).unwrap_err();
    assert_eq!(small, LabelError::TooLarge { parts: tour.len(), budget: 100 });
    assert!(small.to_string().contains("reach more than 100 states"), "{small}");

    let parts: Vec<_> = (0..tour.len()).map(|i| tour.part(i)).collect();
    let operands: Vec<Operand<'_, Letter>> = parts.iter().map(|part| part as _).collect();
    let product = Labelled::new(states, actions, &Product::conjunction(&operands)).unwrap();
    assert_eq!(product.automaton_states(), task.automaton_states());
    let mut env = ModelEnv::new(Ring).unwrap();
    let problem = Problem::new(env.dynamics(), &task).unwrap();
    let (own, whole) = (problem.best(), Problem::new(env.dynamics(), &product).unwrap().best());
    let (p, p_whole) = (own.mean_satisfied(), whole.mean_satisfied());
    let (steps, steps_whole) = (own.mean_steps().unwrap(), whole.mean_steps().unwrap());
    assert!((p - p_whole).abs() < 1e-9 && (steps - steps_whole).abs() < 1e-6, "{p}, {steps}");

    let mut learner = Learner::new(&task, Settings::default(), 1);
    learner.train(&mut env, 200_000).unwrap();
    let optimum = problem.optimum(&learner.rewards());
    let certificate = optimum.certify(&learner.policy()).unwrap();
    let best = optimum.certify(&optimum.q().policy()).unwrap();
    assert!(certificate.satisfied > best.satisfied - 0.01, "{certificate:?}, {best:?}");
}

/// Of a number that is none the predicate is named, and no part moves.
#[test]
fn a_step_that_fails_moves_no_part() {
    let task =
        tltl::tltl! { #[factored] |s: &[f64; 3]| F (s[0] > 0) && F (s[1] > 0) && F (s[2] > 0) };
    let mut q = vec![0; task.len()];
    let error = task.next(&mut q, &[1.0, f64::NAN, 1.0]).unwrap_err();
    assert_eq!((&*error.predicate, &q[..]), ("s[1] > 0", &[0, 0, 0][..]));
    task.next(&mut q, &[1.0, -1.0, 1.0]).unwrap();
    assert_eq!(q, [1, 0, 1]);
}
