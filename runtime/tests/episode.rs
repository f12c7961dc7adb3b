//! The loop of episodes, with an agent whose states are not numbered.

mod world;

use std::collections::BTreeMap;

use tltl::augmented::{Augmented, Rewards};
use tltl::env::ModelEnv;
use tltl::learn::episode::{self, Agent, Done, Seen, World};
use tltl::learn::{Learner, Settings};
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use world::{A, B, C, Cell, PAPER, avoid, both, on_paper};

/// The paper's recipe over cells as they are.
#[derive(Default)]
struct Explorer {
    values: BTreeMap<(u32, i32, i32), [f64; 5]>,
    starts: u64,
}

impl Explorer {
    fn row(&self, q: u32, s: &Cell) -> [f64; 5] {
        self.values.get(&(q, s.x, s.y)).copied().unwrap_or_default()
    }
}

impl Agent for Explorer {
    type State = Cell;
    type Error = tltl::task::Error;

    fn start(&mut self, _: &Cell) {
        self.starts += 1;
    }

    fn act<R: Rng + ?Sized>(&mut self, _: &Cell, _: u32, _: u64, rng: &mut R) -> usize {
        ((u64::from(rng.next_u32()) * 5) >> 32) as usize
    }

    fn learn<W: World<State = Cell, Error: Into<Self::Error>>, R: Rng + ?Sized>(
        &mut self,
        world: &W,
        seen: &Seen<'_, Cell>,
        _: &mut R,
    ) -> Result<(), Self::Error> {
        assert_eq!(
            world.read(seen.q, seen.to).map_err(Into::into)?,
            seen.read,
            "what was read can be read again"
        );
        let rest = if seen.read.over || seen.terminated {
            0.0
        } else {
            self.row(seen.read.to, seen.to).into_iter().fold(f64::NEG_INFINITY, f64::max)
        };
        let target = seen.read.paid + seen.paid + 0.95 * rest;
        let row = self.values.entry((seen.q, seen.s.x, seen.s.y)).or_default();
        row[seen.action] += 0.1 * (target - row[seen.action]);
        Ok(())
    }
}

/// States by value or by number: same seed, same values.
#[test]
fn cells_and_numbers_learn_alike() {
    for (formula, steps) in [(both(A, B), 20_000), (avoid(C, A), 20_000)] {
        let env = || ModelEnv::new(PAPER).unwrap();
        let task = on_paper(&formula);
        let mut learner = Learner::new(&task, 5, Settings::paper(), 3);
        learner.train(&mut env(), &task, steps);

        let mut world = Augmented::new(env(), formula, Rewards::default(), 0.95);
        let (mut agent, mut done) = (Explorer::default(), Done::default());
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for total in [steps / 3, steps] {
            episode::run(&mut world, &mut agent, &mut done, 200, total, &mut rng).unwrap();
        }
        assert_eq!((done.steps, done.episodes), (learner.steps(), learner.episodes()));
        assert_eq!(done.episodes, agent.starts);
        for q in task.live() {
            for s in 0..task.states() {
                let cell = tltl::model::FiniteModel::state(&PAPER, s);
                assert_eq!(agent.row(q, &cell), learner.q().row(q, s), "q {q}, cell {cell:?}");
            }
        }
    }
}
