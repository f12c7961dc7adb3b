//! Exploring behind a guard.

mod world;

use tltl::augmented::{End, Labelled};
use tltl::env::{Env, FiniteEnv, ModelEnv, Step};
use tltl::learn::{Guard, Learner, Settings};
use tltl::rand::Rng;
use tltl::shield::Shield;
use tltl::solve::Problem;
use world::{A, C, Cell, Grid, PAPER, avoid, dynamics, on_paper};

const STEPS: u64 = 1_000_000;

/// The paper's grid, which counts the episodes that enter the trap: all, and those that do so by an
/// action that is riskier than another.
struct Counting<'a> {
    env: ModelEnv<Grid>,
    task: &'a Labelled,
    shield: &'a Shield,
    q: u32,
    lost: u64,
    avoidably: u64,
}

impl<'a> Counting<'a> {
    fn new(task: &'a Labelled, shield: &'a Shield) -> Self {
        let env = ModelEnv::new(PAPER).unwrap();
        Self { env, task, shield, q: 0, lost: 0, avoidably: 0 }
    }

    fn read(&mut self, avoidable: bool) {
        self.q = self.task.next(self.q, self.env.state_index());
        if self.task.end(self.q) == Some(End::Lost) {
            self.lost += 1;
            self.avoidably += u64::from(avoidable);
        }
    }
}

impl Env for Counting<'_> {
    type State = Cell;

    fn actions(&self) -> usize {
        5
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Cell {
        let cell = self.env.reset(rng);
        self.q = 0;
        self.read(false);
        cell
    }

    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<Cell> {
        let barred = !self.shield.allows(self.q, self.env.state_index(), action);
        let step = self.env.step(action, rng);
        self.read(barred);
        step
    }
}

impl FiniteEnv for Counting<'_> {
    fn states(&self) -> usize {
        80
    }

    fn state(&self, s: usize) -> Cell {
        self.env.state(s)
    }

    fn state_index(&self) -> usize {
        self.env.state_index()
    }
}

/// No avoidable trap is entered behind a shield of the model; one step ahead far fewer than without.
/// What is learned behind it is as safe as can be, and as fast as that allows: it costs nothing.
#[test]
fn avoidable_traps_are_not_entered() {
    let (task, dynamics) = (on_paper(&avoid(C, A)), dynamics());
    let problem = Problem::new(&dynamics, &task);
    let (best, shield) = (problem.best(), Shield::of_model(&problem));
    let train = |guard: Option<Guard<'_>>| {
        let mut env = Counting::new(&task, &shield);
        let mut learner = Learner::new(&task, 5, Settings::safe(), 1);
        match guard {
            Some(guard) => learner.train_guarded(&mut env, &task, guard, STEPS),
            None => learner.train(&mut env, &task, STEPS),
        }
        (learner, env.lost, env.avoidably)
    };
    let (_, lost, avoidably) = train(None);
    let (learner, guarded, never) = train(Some(Guard::Shield(&shield)));
    let (_, ahead, seldom) = train(Some(Guard::OneStep));
    assert!(never == 0 && avoidably > 5_000, "{never}, {avoidably}");
    assert!(40 * guarded < lost && 3 * ahead < lost, "{guarded}, {ahead}, {lost}");
    assert!(0 < seldom && 4 * seldom < avoidably, "it must see a trap to know it: {seldom}");

    let policy = shield.policy(learner.q());
    let certificate = problem.certify_against(&policy, learner.q(), &best);
    assert!(certificate.worst_regret_satisfied < 1e-6, "{certificate:?}");
    assert!(certificate.regret_steps.unwrap() < 1e-6, "{certificate:?}");
}

/// Slices do not matter behind a guard either.
#[test]
fn slices_change_nothing() {
    let (task, dynamics) = (on_paper(&avoid(C, A)), dynamics());
    let shield = Shield::of_model(&Problem::new(&dynamics, &task));
    let train = |slices: &[u64]| {
        let mut learner = Learner::new(&task, 5, Settings::default(), 2);
        for &total in slices {
            let mut env = ModelEnv::new(PAPER).unwrap();
            learner.train_guarded(&mut env, &task, Guard::Shield(&shield), total);
        }
        learner
    };
    assert!(train(&[700, 5_000, 9_000]) == train(&[9_000]));
}
