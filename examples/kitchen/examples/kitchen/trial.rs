//! One trial: learn, and measure along the way.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::thread;

use serde::{Deserialize, Serialize};
use tltl::OutOfRange;
use tltl::compose::Compose;
use tltl::deep::{Composition, Device, Learner, Settings, Skill};
use tltl::learn::Schedule;
use tltl::prelude::{Combine, Env, Monitor, Product, Rewards};
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_examples::study::Progress;
use tltl_kitchen::features::{FeasibleGoals, View, exploration};
use tltl_kitchen::show::{self, Episode};
use tltl_kitchen::tasks::{phi_1, phi_2, phi_3, told};
use tltl_kitchen::{Action, Goal, Goals, Kitchen, Known, Layout};

/// Episodes of an evaluation during training, as in the paper.
const EPISODES: u64 = 50;
/// Episodes of the last one, from starts that were never seen.
const LAST_EPISODES: u64 = 500;
/// What a failed action costs in the starred specifications; the paper does not say.
const PENALTY: f64 = 0.1;
/// Steps after which an episode of each problem is cut.
pub(crate) const HORIZONS: [u32; 3] = [100, 200, 200];
const PROBLEMS: [&str; 3] =
    ["task 1", "task 2", "the composition, whose second goal is of another object"];
/// What an update of the composition, or of the conjunction from scratch, costs beside one of a skill: six
/// times as much, measured, for the product has six times as many heads.
const HEAVY: u64 = 6;

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

impl Budget {
    /// What a case of [`Experiment::learn`] adds to its progress.
    pub(crate) const fn of_skill(&self, task: usize) -> u64 {
        self.steps[task]
    }

    /// What a case of [`Experiment::compose`] adds to its progress.
    pub(crate) const fn of_composition(&self) -> u64 {
        let updates = self.updates[0] + self.updates[1];
        // A skill takes two steps for an update. Once in the composition, once from scratch.
        self.steps[0] + self.steps[1] + 2 * (2 * HEAVY * updates)
    }
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
    /// What task 1 asks for: in the paper's kitchen, the apple in the fridge.
    pub(crate) first: Goal,
    pub(crate) budget: Budget,
}

type Task<'a> = &'a (dyn Monitor<Known> + Sync);
type DeepLearner<'a> = Learner<Known, Task<'a>, View, FeasibleGoals>;
pub(crate) type Failure = Box<dyn Error + Send + Sync>;

impl Experiment {
    /// The experiment in the paper's kitchen, or in the one that a file describes.
    ///
    /// Fails if the file is no kitchen, or if one of the three problems has no goal or no start there.
    pub(crate) fn new(budget: Budget, file: Option<&Path>) -> Result<Self, Failure> {
        let layout = Arc::new(file.map_or(Ok(Layout::floorplan24()), Layout::load)?);
        let trials = || -> Result<Self, Failure> {
            let first = first_goal(&layout).ok_or("no object can be wanted anywhere")?;
            let trials = Self { layout: layout.clone(), first, budget };
            for (problem, name) in PROBLEMS.into_iter().enumerate() {
                trials.kitchen(problem).map_err(|error| format!("{name}: {error}"))?;
            }
            Ok(trials)
        };
        let of_file = |error: Failure| match file {
            Some(file) => format!("{}: {error}", file.display()).into(),
            None => error,
        };
        trials().map_err(of_file)
    }

    /// `the apple into the fridge`: what task 1 asks for.
    pub(crate) fn first_words(&self) -> String {
        let Goal { object, receptacle } = self.first;
        let [object, receptacle] =
            [object, receptacle].map(|id| self.layout.name(id).replace('_', " "));
        format!("the {object} into the {receptacle}")
    }

    /// φ`task`.`j`, both counted from 0.
    pub(crate) fn specification(&self, task: usize, j: usize) -> Box<dyn Monitor<Known> + Sync> {
        let Goal { object, receptacle } = self.first;
        match (task, j) {
            (0, 0) => Box::new(phi_1(object, receptacle)),
            (0, 1) => Box::new(phi_2(object, receptacle)),
            (0, _) => Box::new(phi_3(object, receptacle)),
            (_, 0) => Box::new(told::phi_1()),
            (_, 1) => Box::new(told::phi_2()),
            _ => Box::new(told::phi_3()),
        }
    }

    /// The kitchen of a problem: 0 task 1, 1 task 2, 2 both.
    pub(crate) fn kitchen(&self, problem: usize) -> Result<Kitchen, Failure> {
        let Goal { object, receptacle } = self.first;
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
        // The paper's reward. These automata have no way back, so it pays for no detour.
        let rewards = Rewards::progress().with_gamma(0.97)?;
        let rewards = rewards.with_environment(if starred { PENALTY } else { 0.0 })?;
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
        progress: &Progress,
    ) -> Result<Outcome, Failure> {
        let monitor = self.specification(task, j);
        let (_, curve) = self.train(&*monitor, (task, j, starred), seed, progress)?;
        Ok(Outcome { curves: vec![curve], shown: Vec::new() })
    }

    fn skill<'m>(&self, task: usize, monitor: Task<'m>) -> Skill<Task<'m>, View, FeasibleGoals> {
        let view = match task {
            0 => View::of(self.layout.clone(), self.first),
            _ => View::new(self.layout.clone()),
        };
        Skill::with_goals(monitor, view, FeasibleGoals::new(&self.layout, None))
    }

    fn train<'m>(
        &self,
        monitor: Task<'m>,
        (task, j, starred): (usize, usize, bool),
        seed: u64,
        progress: &Progress,
    ) -> Result<(DeepLearner<'m>, Curve), Failure> {
        let skill = self.skill(task, monitor);
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
            progress.add(total * i / self.budget.points - total * (i - 1) / self.budget.points);
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
    ///
    /// What does not wait for each other runs side by side; each has its own random generator, so the
    /// numbers are the same on any number of cores.
    pub(crate) fn compose(&self, seed: u64, progress: &Progress) -> Result<Outcome, Failure> {
        let monitors = [self.specification(0, 2), self.specification(1, 2)];
        let [first, second] = [&*monitors[0], &*monitors[1]];
        let product = Product::conjunction(&[first, second]);
        thread::scope(|scope| {
            let whole = scope.spawn(|| self.learned_whole(&product, seed, progress));
            let one = scope.spawn(|| self.train(first, (0, 2, true), seed, progress));
            let (two, second_curve) = self.train(second, (1, 2, true), seed, progress)?;
            let (one, first_curve) = joined(one)?;
            let composing =
                Composing { trials: self, product: &product, skills: [&one, &two], seed };
            let (at_once, learned) = thread::scope(|scope| {
                let at_once = scope.spawn(|| composing.at_once());
                let learned = composing.learned(progress)?;
                Ok::<_, Failure>((joined(at_once)?, learned))
            })?;
            let (learned, episode) = learned;
            let mut curves = vec![first_curve, second_curve];
            curves.extend(at_once.into_iter().chain(learned));
            curves.push(joined(whole)?);
            let shown = vec![
                ("_episode.txt".into(), episode),
                ("_policy.json".into(), serde_json::to_string(&two.policy()?)?),
            ];
            Ok(Outcome { curves, shown })
        })
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
        let monitors = [self.specification(0, 2), self.specification(1, 2)];
        let product = Product::conjunction(&[&*monitors[0], &*monitors[1]]);
        let mut kitchen = self.kitchen(2)?;
        let told = kitchen.reset(&mut Xoshiro256PlusPlus::seed_from_u64(4_000)).goal();
        Episode::record(&mut kitchen, &product, &[self.first, told], act)
    }

    /// What a policy of the composition does in `episodes` episodes.
    fn composed(
        &self,
        product: &Product<'_, Known>,
        (x, episodes, seed): (u64, u64, u64),
        act: impl FnMut(u32, &Known) -> Result<usize, tltl::deep::Error>,
    ) -> Result<Worth, Failure> {
        // During training from other starts than at last.
        let seed = seed + if episodes == EPISODES { 1_000 } else { 2_000 };
        self.worth(self.kitchen(2)?, product, (x, episodes, seed), act)
    }

    /// The conjunction, learned in the kitchen: as many updates as the composition has in all, at one
    /// environment step each.
    fn learned_whole(
        &self,
        product: &Product<'_, Known>,
        seed: u64,
        progress: &Progress,
    ) -> Result<Curve, Failure> {
        let total = self.budget.updates[0] + self.budget.updates[1];
        let settings = self.settings(total, HORIZONS[2], true)?;
        let settings = settings.with_steps_per_update(1)?.with_relabelled(0.8)?;
        let views = [View::of(self.layout.clone(), self.first), View::new(self.layout.clone())];
        let joint = tltl::deep::Joint(vec![&views[0], &views[1]]);
        let goals = FeasibleGoals::new(&self.layout, Some(self.first.object));
        let skill = Skill::with_goals(product, joint, goals);
        let device = Device::flex();
        let mut kitchen = self.kitchen(2)?;
        let mut learner = Learner::new(skill, &kitchen, settings, &device, seed)
            .exploring(exploration(&self.layout));
        let mut points = Vec::new();
        for i in 1..=self.budget.points {
            learner.train(&mut kitchen, total * i / self.budget.points)?;
            progress.add(2 * HEAVY * (total / self.budget.points));
            let how = (learner.updates(), EPISODES, seed);
            points.push(self.composed(product, how, |q, s| learner.act(q, s))?);
        }
        let how = (learner.updates(), LAST_EPISODES / 2, seed);
        let last = self.composed(product, how, |q, s| learner.act(q, s))?;
        Ok(Curve { name: "from scratch".into(), points, last })
    }
}

/// Two skills that were learned, and how they are composed.
struct Composing<'a> {
    trials: &'a Experiment,
    product: &'a Product<'a, Known>,
    skills: [&'a DeepLearner<'a>; 2],
    seed: u64,
}

impl<'a> Composing<'a> {
    fn of(&self, combine: Combine) -> Result<Composition<'a, Known, FeasibleGoals>, Failure> {
        let Budget { updates, .. } = self.trials.budget;
        let rate = Schedule::linear(5e-4, 5e-6, updates[0] + updates[1])?;
        let settings = self.trials.settings(0, HORIZONS[2], true)?.with_relabelled(1.0)?;
        let settings = settings.with_batch(64)?.with_learning_rate(rate)?;
        let goals = FeasibleGoals::new(&self.trials.layout, Some(self.trials.first.object));
        let skills = [self.skills[0].learned()?, self.skills[1].learned()?];
        let (product, device) = (self.product, Device::flex());
        Ok(Composition::new(product, &skills, goals, combine, settings, &device, self.seed)?)
    }

    /// What `composition` does in `episodes` episodes.
    fn worth(
        &self,
        composition: &Composition<'_, Known, FeasibleGoals>,
        episodes: u64,
    ) -> Result<Worth, Failure> {
        let how = (composition.updates(), episodes, self.seed);
        self.trials.composed(self.product, how, |q, s| composition.act(q, s))
    }

    /// What is not learned: c1 and `max`.
    fn at_once(&self) -> Result<Vec<Curve>, Failure> {
        let of = |(name, combine): (&str, Combine)| {
            let composition = self.of(combine)?;
            let points = vec![self.worth(&composition, EPISODES)?];
            let last = self.worth(&composition, LAST_EPISODES / 2)?;
            Ok(Curve { name: name.into(), points, last })
        };
        [("c1", Combine::NormalisedSum), ("max", Combine::Max)].into_iter().map(of).collect()
    }

    /// What is learned: c2 and c3, and an episode of c3.
    fn learned(&self, progress: &Progress) -> Result<(Vec<Curve>, String), Failure> {
        let Budget { updates, points, .. } = self.trials.budget;
        let mut composition = self.of(Combine::Sum)?;
        let mut sum = vec![self.worth(&composition, EPISODES)?];
        for _ in 0..points / 2 {
            composition.compensate(updates[0] / (points / 2))?;
            progress.add(2 * HEAVY * (updates[0] / (points / 2)));
            sum.push(self.worth(&composition, EPISODES)?);
        }
        let c2 = self.worth(&composition, LAST_EPISODES / 2)?;
        let mut refined = vec![sum[sum.len() - 1]];
        for _ in 0..points {
            composition.refine(updates[1] / points)?;
            progress.add(2 * HEAVY * (updates[1] / points));
            refined.push(self.worth(&composition, EPISODES)?);
        }
        let c3 = self.worth(&composition, LAST_EPISODES / 2)?;
        let curves = vec![
            Curve { name: "c2".into(), points: sum, last: c2 },
            Curve { name: "c3".into(), points: refined, last: c3 },
        ];
        Ok((curves, self.trials.episode(|q, s| composition.act(q, s))?))
    }
}

/// What a thread found.
fn joined<T>(thread: thread::ScopedJoinHandle<'_, Result<T, Failure>>) -> Result<T, Failure> {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// The apple in the fridge; in a kitchen without, the first goal that has a start.
fn first_goal(layout: &Layout) -> Option<Goal> {
    let named = |name| layout.id(name);
    let apple = named("apple").zip(named("fridge"));
    let apple = apple.filter(|&(object, receptacle)| layout.feasible(object, receptacle));
    apple
        .map(|(object, receptacle)| Goal { object, receptacle })
        .or_else(|| layout.feasible_goals().next())
}
