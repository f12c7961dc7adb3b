//! Exploring behind a mask.

mod world;

use tltl::learn::Mask;
use tltl::prelude::*;
use tltl::rand::Rng;
use tltl::reward::End;
use tltl::shield::Shield;
use world::{A, C, Cell, Grid, PAPER, avoid, on_paper, problem};

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
    let task = on_paper(&avoid(C, A));
    let problem = problem(&task);
    let shield = Shield::of_model(&problem);
    let train = |mask: Option<Mask<'_>>| {
        let mut env = Counting::new(&task, &shield);
        let mut learner = Learner::new(&task, Settings::safe(), 1);
        match mask {
            Some(mask) => learner.train_masked(&mut env, mask, STEPS).unwrap(),
            None => learner.train(&mut env, STEPS).unwrap(),
        }
        (learner, env.lost, env.avoidably)
    };
    let (_, lost, avoidably) = train(None);
    let (learner, guarded, never) = train(Some(Mask::Shield(&shield)));
    let (_, ahead, seldom) = train(Some(Mask::OneStep));
    assert!(never == 0 && avoidably > 5_000, "{never}, {avoidably}");
    assert!(40 * guarded < lost && 3 * ahead < lost, "{guarded}, {ahead}, {lost}");
    assert!(0 < seldom && 4 * seldom < avoidably, "it must see a trap to know it: {seldom}");

    let policy = shield.policy(learner.q()).unwrap();
    let certificate = problem.optimum(&learner.rewards()).certify(&policy).unwrap();
    assert!(certificate.worst_regret_satisfied < 1e-6, "{certificate:?}");
    assert!(certificate.regret_steps.unwrap() < 1e-6, "{certificate:?}");
}

/// Slices do not matter behind a mask either.
#[test]
fn slices_change_nothing() {
    let task = on_paper(&avoid(C, A));
    let shield = Shield::of_model(&problem(&task));
    let train = |slices: &[u64]| {
        let mut learner = Learner::new(&task, Settings::default(), 2);
        for &total in slices {
            let mut env = ModelEnv::new(PAPER).unwrap();
            learner.train_masked(&mut env, Mask::Shield(&shield), total).unwrap();
        }
        learner
    };
    assert!(train(&[700, 5_000, 9_000]) == train(&[9_000]));
}
