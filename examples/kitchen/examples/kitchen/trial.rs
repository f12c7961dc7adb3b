//! One trial: learn, and measure along the way.

use std::error::Error;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use tltl::OutOfRange;
use tltl::compose::Compose;
use tltl::deep::{Composition, Device, Learner, Settings, Skill};
use tltl::learn::Schedule;
use tltl::prelude::{Combine, Env, Monitor, Product};
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::features::{FeasibleGoals, View, exploration};
use tltl_kitchen::show::{self, Episode};
use tltl_kitchen::tasks::{phi1_1, phi1_2, phi1_3, told};
use tltl_kitchen::{Action, Goal, Goals, Kitchen, Known, Layout};

/// Episodes of an evaluation during training, as in the paper.
const EPISODES: u64 = 50;
/// Episodes of the last one, from starts that were never seen.
const LAST_EPISODES: u64 = 500;
/// What a failed action costs in the starred specifications; the paper does not say.
const PENALTY: f64 = 0.1;
/// Steps after which an episode of each problem is cut.
pub(crate) const HORIZONS: [u32; 3] = [100, 200, 200];

/// How long everything takes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    /// Environment steps of each task.
    pub(crate) steps: [u64; 2],
    /// Updates of the compensation and of the refinement.
    pub(crate) updates: [u64; 2],
    /// Evaluations of each curve.
    pub(crate) points: u64,
}

/// What a greedy policy does.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Worth {
    /// Environment steps, or updates in the composition, that it took.
    pub(crate) x: u64,
    /// The share of episodes that satisfy the task.
    pub(crate) success: f64,
    /// The share of actions that do not fail.
    pub(crate) actions: f64,
    /// The mean length of all episodes, those cut at the horizon included.
    pub(crate) length: f64,
}

/// A learning curve.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Curve {
    /// What was learned.
    pub(crate) name: String,
    /// From left to right.
    pub(crate) points: Vec<Worth>,
    /// The last policy, on many unseen starts.
    pub(crate) last: Worth,
}

/// What a trial leaves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Outcome {
    /// Its curves.
    pub(crate) curves: Vec<Curve>,
    /// Files that show what was learned: what is added to the study's name, and their content.
    pub(crate) shown: Vec<(String, String)>,
}

/// What the trials share.
pub(crate) struct Experiment {
    pub(crate) layout: Arc<Layout>,
    pub(crate) apple: Goal,
    pub(crate) budget: Budget,
}

type Task<'a> = &'a (dyn Monitor<Known> + Sync);
type DeepLearner<'a> = Learner<Known, Task<'a>, View, FeasibleGoals>;
pub(crate) type Failure = Box<dyn Error + Send + Sync>;

impl Experiment {
    pub(crate) fn new(budget: Budget) -> Result<Self, Failure> {
        let layout = Arc::new(Layout::floorplan24());
        let id = |name| layout.id(name).ok_or("the kitchen has an apple and a fridge");
        let apple = Goal { object: id("apple")?, receptacle: id("fridge")? };
        Ok(Self { layout, apple, budget })
    }

    /// The kitchen of a problem: 0 task 1, 1 task 2, 2 both.
    pub(crate) fn kitchen(&self, problem: usize) -> Result<Kitchen, Failure> {
        let Goal { object, receptacle } = self.apple;
        let goals = match problem {
            0 => Goals::Fixed { object, receptacle },
            1 => Goals::Random { except: None },
            _ => Goals::Beside { object, receptacle },
        };
        Ok(Kitchen::new(self.layout.clone(), goals, HORIZONS[problem])?)
    }

    fn settings(&self, steps: u64, horizon: u32, starred: bool) -> Result<Settings, OutOfRange> {
        let defaults = Settings::default();
        let updates = steps / defaults.steps_per_update();
        let rewards = defaults.rewards().with_environment(if starred { PENALTY } else { 0.0 })?;
        defaults
            .with_horizon(horizon.into())?
            .with_rewards(rewards)
            .with_learning_rate(Schedule::linear(5e-4, 1e-5, updates)?)?
            .with_importance(Schedule::linear(0.4, 1.0, updates)?)?
            .with_epsilon(Schedule::linear(1.0, 0.05, (steps / 3).min(30_000))?)
    }

    /// What `act` does in `episodes` episodes of `kitchen`.
    fn worth(
        &self,
        mut kitchen: Kitchen,
        task: &dyn Monitor<Known>,
        (x, episodes, seed): (u64, u64, u64),
        mut act: impl FnMut(u32, &Known) -> Result<usize, tltl::deep::Error>,
    ) -> Result<Worth, Failure> {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let (mut satisfied, mut steps, mut failures) = (0, 0, 0);
        for _ in 0..episodes {
            let mut s = kitchen.reset(&mut rng);
            let mut q = task.next(0, &s)?;
            let mut over = task.is_terminal(q);
            while !over {
                let step = kitchen.step(act(q, &s)?, &mut rng);
                s = step.state;
                q = task.next(q, &s)?;
                over = step.truncated || task.is_terminal(q);
            }
            satisfied += u64::from(task.is_accepting(q));
            steps += u64::from(kitchen.steps());
            failures += u64::from(kitchen.failures());
        }
        let share = |n: u64, of: u64| n as f64 / of.max(1) as f64;
        let actions = 1.0 - share(failures, steps);
        Ok(Worth {
            x,
            success: share(satisfied, episodes),
            actions,
            length: share(steps, episodes),
        })
    }

    /// Learns φ`task`.`j`, with a penalty for failed actions if `starred`; shows how far it is.
    pub(crate) fn learn(
        &self,
        (task, j, starred): (usize, usize, bool),
        seed: u64,
    ) -> Result<Outcome, Failure> {
        let monitor = specification(task, j);
        let skill = self.skill(task, &*monitor);
        let (_, curve) = self.train(skill, &*monitor, (task, j, starred), seed)?;
        Ok(Outcome { curves: vec![curve], shown: Vec::new() })
    }

    fn skill<'m>(&self, task: usize, monitor: Task<'m>) -> Skill<Task<'m>, View, FeasibleGoals> {
        let view = match task {
            0 => View::of(self.layout.clone(), self.apple),
            _ => View::new(self.layout.clone()),
        };
        Skill::with_goals(monitor, view, FeasibleGoals::new(&self.layout, None))
    }

    fn train<'m>(
        &self,
        skill: Skill<Task<'m>, View, FeasibleGoals>,
        monitor: &dyn Monitor<Known>,
        (task, j, starred): (usize, usize, bool),
        seed: u64,
    ) -> Result<(DeepLearner<'m>, Curve), Failure> {
        let total = self.budget.steps[task];
        let mut settings = self.settings(total, HORIZONS[task], starred)?;
        if task == 0 {
            settings = settings.with_relabelled(0.0)?;
        }
        let mut kitchen = self.kitchen(task)?;
        let mut learner = Learner::new(skill, &kitchen, settings, &Device::flex(), seed)
            .exploring(exploration(&self.layout));
        let mut points = Vec::new();
        for i in 1..=self.budget.points {
            learner.train(&mut kitchen, total * i / self.budget.points)?;
            let how = (learner.steps(), EPISODES, seed + 1_000);
            points.push(self.worth(self.kitchen(task)?, monitor, how, |q, s| learner.act(q, s))?);
        }
        let how = (learner.steps(), LAST_EPISODES, seed + 2_000);
        let last = self.worth(self.kitchen(task)?, monitor, how, |q, s| learner.act(q, s))?;
        let star = if starred { "*" } else { "" };
        let name = format!("φ{}.{}{star}", task + 1, j + 1);
        Ok((learner, Curve { name, points, last }))
    }

    /// Learns both skills, φ1.3* and φ2.3*, composes them, and learns their conjunction from scratch:
    /// the curves of the skills, c1, c2, c3, `max` and from scratch.
    pub(crate) fn compose(&self, seed: u64) -> Result<Outcome, Failure> {
        let monitors = [specification(0, 2), specification(1, 2)];
        let mut trained = Vec::new();
        let mut curves = Vec::new();
        for (task, monitor) in monitors.iter().enumerate() {
            let skill = self.skill(task, &**monitor);
            let (learner, curve) = self.train(skill, &**monitor, (task, 2, true), seed)?;
            trained.push(learner);
            curves.push(curve);
        }
        let product = Product::conjunction(&[&*monitors[0], &*monitors[1]]);
        let skills = trained.iter().map(Learner::learned).collect::<Result<Vec<_>, _>>()?;
        let updates = self.budget.updates;
        let composed = |combine| -> Result<_, Failure> {
            let rate = Schedule::linear(5e-4, 5e-6, updates[0] + updates[1])?;
            let settings = self.settings(0, HORIZONS[2], true)?.with_relabelled(1.0)?;
            let settings = settings.with_batch(64)?.with_learning_rate(rate)?;
            let goals = FeasibleGoals::new(&self.layout, Some(self.apple.object));
            let device = Device::flex();
            Ok(Composition::new(&product, &skills, goals, combine, settings, &device, seed)?)
        };
        for (name, combine) in [("c1", Combine::NormalisedSum), ("max", Combine::Max)] {
            let composition = composed(combine)?;
            curves.push(self.composed(&product, name, seed, 0, |q, s| composition.act(q, s))?);
        }
        let mut composition = composed(Combine::Sum)?;
        let mut sum = self.composed(&product, "c2", seed, 0, |q, s| composition.act(q, s))?;
        let points = self.budget.points / 2;
        for _ in 0..points {
            composition.compensate(updates[0] / points)?;
            let now = self.composed(&product, "c2", seed, composition.updates(), |q, s| {
                composition.act(q, s)
            })?;
            sum.points.extend(now.points);
            sum.last = now.last;
        }
        let mut refined = Curve { name: "c3".into(), points: vec![sum.last], last: sum.last };
        refined.points = sum.points.last().copied().into_iter().collect();
        for _ in 0..self.budget.points {
            composition.refine(updates[1] / self.budget.points)?;
            let now = self.composed(&product, "c3", seed, composition.updates(), |q, s| {
                composition.act(q, s)
            })?;
            refined.points.extend(now.points);
            refined.last = now.last;
        }
        let shown = vec![
            ("_episode.txt".into(), self.episode(|q, s| composition.act(q, s))?),
            ("_policy.json".into(), serde_json::to_string(&trained[1].policy()?)?),
        ];
        curves.extend([sum, refined, self.learned_whole(&product, seed)?]);
        Ok(Outcome { curves, shown })
    }

    /// An episode of a policy of the composition, as a table.
    fn episode(
        &self,
        mut act: impl FnMut(u32, &Known) -> Result<usize, tltl::deep::Error>,
    ) -> Result<String, Failure> {
        let episode = self.record(|q, known| Ok(Action::from_index(act(q, known)?)))?;
        Ok(episode.text(&self.layout))
    }

    /// The episode of a table.
    pub(crate) fn replay(&self, table: &str) -> Result<Episode, Failure> {
        const OTHER: &str = "the recorded episode is of another kitchen or task";
        let mut actions = show::actions(table, &self.layout).into_iter();
        let episode = self.record(|_, _| actions.next().ok_or(Failure::from(OTHER)))?;
        if episode.text(&self.layout) == table { Ok(episode) } else { Err(OTHER.into()) }
    }

    fn record(
        &self,
        act: impl FnMut(u32, &Known) -> Result<Action, Failure>,
    ) -> Result<Episode, Failure> {
        let monitors = [specification(0, 2), specification(1, 2)];
        let product = Product::conjunction(&[&*monitors[0], &*monitors[1]]);
        let mut kitchen = self.kitchen(2)?;
        let told = kitchen.reset(&mut Xoshiro256PlusPlus::seed_from_u64(4_000)).goal();
        Episode::record(&mut kitchen, &product, &[self.apple, told], act)
    }

    /// A curve of one point.
    fn composed(
        &self,
        product: &Product<'_, Known>,
        name: &str,
        seed: u64,
        x: u64,
        mut act: impl FnMut(u32, &Known) -> Result<usize, tltl::deep::Error>,
    ) -> Result<Curve, Failure> {
        let how = (x, EPISODES, seed + 1_000);
        let point = self.worth(self.kitchen(2)?, product, how, &mut act)?;
        let last =
            self.worth(self.kitchen(2)?, product, (x, LAST_EPISODES / 2, seed + 2_000), &mut act)?;
        Ok(Curve { name: name.into(), points: vec![point], last })
    }

    /// The conjunction, learned in the kitchen: as many updates as the composition has in all, at one
    /// environment step each.
    fn learned_whole(&self, product: &Product<'_, Known>, seed: u64) -> Result<Curve, Failure> {
        let total = self.budget.updates[0] + self.budget.updates[1];
        let settings = self.settings(total, HORIZONS[2], true)?;
        let settings = settings.with_steps_per_update(1)?.with_relabelled(0.8)?;
        let views = [View::of(self.layout.clone(), self.apple), View::new(self.layout.clone())];
        let joint = tltl::deep::Joint(vec![&views[0], &views[1]]);
        let goals = FeasibleGoals::new(&self.layout, Some(self.apple.object));
        let skill = Skill::with_goals(product, joint, goals);
        let device = Device::flex();
        let mut kitchen = self.kitchen(2)?;
        let mut learner = Learner::new(skill, &kitchen, settings, &device, seed)
            .exploring(exploration(&self.layout));
        let mut curve = Curve {
            name: "from scratch".into(),
            points: Vec::new(),
            last: Worth { x: 0, success: 0.0, actions: 0.0, length: 0.0 },
        };
        for i in 1..=self.budget.points {
            learner.train(&mut kitchen, total * i / self.budget.points)?;
            let now =
                self.composed(product, "", seed, learner.updates(), |q, s| learner.act(q, s))?;
            curve.points.extend(now.points);
            curve.last = now.last;
        }
        Ok(curve)
    }
}

/// φ`task`.`j`, both counted from 0.
pub(crate) fn specification(task: usize, j: usize) -> Box<dyn Monitor<Known> + Sync> {
    match (task, j) {
        (0, 0) => Box::new(phi1_1()),
        (0, 1) => Box::new(phi1_2()),
        (0, _) => Box::new(phi1_3()),
        (_, 0) => Box::new(told::phi_1()),
        (_, 1) => Box::new(told::phi_2()),
        _ => Box::new(told::phi_3()),
    }
}
