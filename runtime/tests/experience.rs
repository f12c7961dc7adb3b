//! What is remembered of a world, against maps of counts, and what is learned of worlds that end.

use std::collections::BTreeMap;

use tltl::env::Step;
use tltl::learn::{Checkpoint, Experience};
use tltl::prelude::*;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::Mode;

/// Five cells in a row: action 0 goes left, action 1 right. The environment ends at the right end.
struct Walk(usize);

impl Env for Walk {
    type State = usize;

    fn actions(&self) -> usize {
        2
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> usize {
        self.0 = rng.next_u32() as usize % 4;
        self.0
    }

    fn step<R: Rng + ?Sized>(&mut self, action: usize, _: &mut R) -> Step<usize> {
        self.0 = [self.0.saturating_sub(1), self.0 + 1][action];
        Step { terminated: self.0 == 4, ..Step::to(self.0) }
    }
}

impl FiniteEnv for Walk {
    fn states(&self) -> usize {
        5
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn state_index(&self) -> usize {
        self.0
    }
}

/// Nothing follows the goal: it is never seen twice in a row, though nobody ever left it.
#[test]
fn the_last_state_is_read_once() {
    let once = tltl! { |s: &usize| F ({ *s } == 4) };
    let twice = tltl! { |s: &usize| F ({ *s } == 4 && X ({ *s } == 4)) };
    for mode in [Mode::Acceptance, Mode::Shaped, Mode::Progress] {
        let settings = Settings::default().with_rewards(Rewards::of(mode));
        let trained = |task: &Labelled| {
            let mut learner = Learner::new(task, settings, 1);
            learner.train(&mut Walk(0), 2_000).unwrap();
            learner
        };
        let seen = |learner: &Learner| {
            let seen = Dynamics::new(learner.experience()).unwrap();
            Problem::new(&seen, learner.task()).unwrap()
        };
        let worth =
            |learner: &Learner| seen(learner).evaluate(&learner.policy()).unwrap().mean_satisfied();
        let task = Labelled::of_env(&Walk(0), &once).unwrap();
        assert!((worth(&trained(&task)) - 1.0).abs() < 1e-12, "{mode:?}");
        let task = Labelled::of_env(&Walk(0), &twice).unwrap();
        let learner = trained(&task);
        assert_eq!(worth(&learner), 0.0, "{mode:?}");
        // The goal is entered in two ways, and both have the same value there: none, but for what
        // `Shaped` takes back of its potential, and what `Progress` pays for the goal itself.
        let start = seen(&learner).optimal_q(&learner.rewards()).max(0, 0);
        match mode {
            Mode::Acceptance => assert_eq!(start, 0.0),
            Mode::Shaped => assert!((start + 1.0 / 3.0).abs() < 1e-9, "{start}"),
            _ => assert!((start - 0.95f64.powi(3)).abs() < 1e-9, "{start}"),
        }
    }
}

/// Counts by (s, a, s', whether the episode ended).
type Counts = BTreeMap<(usize, usize, usize, bool), u32>;

/// Random steps in a world of 30 states and 3 actions; action a has 10 a + 1 outcomes.
fn random(seed: u64, steps: usize) -> (Experience, Counts) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut draw = |n: usize| rng.next_u32() as usize % n;
    let (mut seen, mut counts) = (Experience::new(30, 3), Counts::new());
    for _ in 0..steps {
        let (s, a) = (draw(30), draw(3));
        let (to, ended) = ((s + draw(10 * a + 1)) % 30, draw(4) == 0);
        match ended {
            true => seen.push_ending(s, a, to),
            false => seen.push(s, a, to),
        }
        *counts.entry((s, a, to, ended)).or_default() += 1;
    }
    (seen, counts)
}

fn assert_counts(seen: &Experience, counts: &Counts) {
    let mut found = BTreeMap::new();
    for (s, a) in (0..30).flat_map(|s| (0..3).map(move |a| (s, a))) {
        let all = counts.iter().filter(|(key, _)| (key.0, key.1) == (s, a));
        let tried: u32 = all.map(|(_, times)| times).sum();
        assert_eq!(seen.tried(s, a), u64::from(tried));
        let mut find = |to, ended, p: f64| {
            let times = p * f64::from(tried);
            assert!((times - times.round()).abs() < 1e-6);
            assert!(found.insert((s, a, to, ended), times.round() as u32).is_none(), "told twice");
        };
        if tried > 0 {
            seen.transitions(s, a, |to, p| find(to, false, p));
        }
        seen.endings(s, a, |to, p| find(to, true, p));
    }
    assert_eq!(&found, counts);
}

#[test]
fn experience_counts() {
    let ((mut one, mut counts), (other, more)) = (random(1, 20_000), random(2, 500));
    assert_counts(&one, &counts);
    assert_counts(&other, &more);
    one.extend(&other).unwrap();
    more.into_iter().for_each(|(key, times)| *counts.entry(key).or_default() += times);
    assert_counts(&one, &counts);
    let text = serde_json::to_string(&one).unwrap();
    assert_eq!(serde_json::from_str::<Experience>(&text).unwrap(), one);
    assert_ne!(one, other);
}

/// Experience that was saved before ends were counted apart.
const EARLIER: &str = r#"{"actions":2,"outcomes":[[[1,3],[0,1]],[],[],[[0,2]]],"starts":[4,0]}"#;

#[test]
fn earlier_experience_is_read() {
    let read: Experience = serde_json::from_str(EARLIER).unwrap();
    let mut seen = Experience::new(2, 2);
    (0..4).for_each(|_| seen.push_start(0));
    [1, 0, 1, 1].into_iter().for_each(|to| seen.push(0, 0, to));
    (0..2).for_each(|_| seen.push(1, 1, 0));
    assert_eq!(read, seen);
}

/// A learner that was saved before: all that its file lacks is how often episodes ended.
#[test]
fn earlier_learners_are_resumed() {
    let task = Labelled::of_env(&Walk(0), &tltl! { |s: &usize| F ({ *s } == 4) }).unwrap();
    let mut learner = Learner::new(&task, Settings::default(), 1);
    learner.train(&mut Walk(0), 500).unwrap();
    let mut saved = serde_json::to_value(learner.checkpoint()).unwrap();
    let ended = saved["experience"].as_object_mut().unwrap().remove("ended").unwrap();
    assert_eq!(ended, serde_json::json!([[7, 0]]));
    let saved: Checkpoint = serde_json::from_value(saved).unwrap();
    let resumed = Learner::resume(&task, saved).unwrap();
    assert_eq!((resumed.q(), resumed.steps()), (learner.q(), learner.steps()));
    assert_eq!(resumed.experience().tried(3, 1), learner.experience().tried(3, 1));
}

#[test]
fn broken_experience_is_refused() {
    let refused = |from: &str, to: &str| {
        assert!(EARLIER.contains(from));
        let read = serde_json::from_str::<Experience>(&EARLIER.replace(from, to));
        read.unwrap_err().to_string()
    };
    let world = "the outcomes of an experience are not those of its world";
    for (from, to) in [("[1,3]", "[2,3]"), ("[],[],", "[],"), ("\"actions\":2", "\"actions\":3")] {
        assert!(refused(from, to).starts_with(world));
    }
    let ends = "\"starts\":[4,0],\"ended\":[[0,2]]";
    let error = refused("\"starts\":[4,0]", ends);
    assert!(error.starts_with("an episode of an experience ends where there is no outcome"));
}
