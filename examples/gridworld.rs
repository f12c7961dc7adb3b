//! The paper's grid world (Section 5.1): specify, compile, learn, compose, judge, draw, emit.
//!
//! `cargo run --release --example gridworld [FOLDER]` writes into FOLDER (`target/gridworld` if
//! left out) the figure, the composed policy as JSON, and the same policy as Rust.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use tltl::augmented::{Labelled, Rewards};
use tltl::compose::{Combine, Composition, Skill};
use tltl::env::ModelEnv;
use tltl::learn::{Learner, Settings};
use tltl::model::{Dynamics, FiniteModel};
use tltl::policy::{Policy, Training};
use tltl::product::Product;
use tltl::q::QTable;
use tltl::solve::{Certificate, Problem};
use tltl::{Acceptor, Monitor, include_tltl};
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::dfa::{Automata, Dfa, State};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltl_examples::figure::{Panel, Region, Row, figure};
use tltl_examples::grid::{Cell, Grid};

include_tltl!("tasks/gridworld.tltl", state = tltl_examples::grid::Cell);

/// A predicate as the task file's module has it.
type Robustness = fn(&Cell) -> f64;

const GAMMA: f64 = 0.95;
const STEPS: u64 = 8_000_000;
const SEED: u64 = 1;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or("target/gridworld".into(), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let world = World::new()?;
    let (visit_a_b, visit_c) = (gridworld::visit_a_b(), gridworld::visit_c());
    let visit_all = Product::conjunction(&[&visit_a_b, &visit_c]);
    let tasks = [world.task(&visit_a_b)?, world.task(&visit_c)?, world.task(&visit_all)?];

    let first = learn(&world, "φ₁", &tasks[0], SEED)?;
    let second = learn(&world, "φ₂", &tasks[1], SEED + 1)?;
    let scratch = learn(&world, "φ₁ ∧ φ₂", &tasks[2], SEED + 2)?;

    let skills =
        [Skill { q: first.q(), task: &tasks[0] }, Skill { q: second.q(), task: &tasks[1] }];
    let composition = Composition::new(&visit_all, &tasks[2], &skills);
    let sum = composition.initial(Combine::NormalisedSum);
    let mut experience = first.experience().clone();
    experience.extend(second.experience());
    let seen = Dynamics::new(&experience)?;
    let refined = composition.refined(&seen, &Rewards::default(), GAMMA, &sum);

    let compiled = automata()?;
    let [one, two, all] = [0, 1, 2].map(|task| size(&compiled.automata[task]));
    heading();
    world.report("φ₁ = ◇a ∧ ◇b, learned", &one, &tasks[0], first.q());
    world.report("φ₂ = ◇c, learned", &two, &tasks[1], second.q());
    world.report("φ₁ ∧ φ₂, sum of skills (step 2)", &all, &tasks[2], &sum);
    let certificate =
        world.report("φ₁ ∧ φ₂, refined on replay (step 6)", &all, &tasks[2], &refined);
    world.report("φ₁ ∧ φ₂, learned from scratch", &all, &tasks[2], scratch.q());
    println!("\nThe composition took no step in the world. Steps are means over all start cells.");

    let picture = world.figure(&compiled, &tasks, [first.q(), second.q(), &sum])?;
    write(&folder, "figure2.svg", &picture)?;

    let policy = Policy::new(
        "visit_all",
        gridworld::visit_all().formula().text(),
        &tasks[2],
        refined.policy(),
        (0..world.grid.actions()).map(|a| world.grid.action_name(a)).collect(),
    )?;
    let components = (0..visit_all.states()).map(|q| visit_all.components(q).to_vec()).collect();
    let mut policy = policy.composed(components)?.certified(certificate);
    for (name, learner, seed) in [("visit_a_b", &first, SEED), ("visit_c", &second, SEED + 1)] {
        policy = policy.trained(Training::of(name, learner, seed));
    }
    let problem = Problem::new(&world.dynamics, &tasks[2]);
    let policy = policy.from_starts(&problem.starts(&refined.policy(), &problem.best()));
    let json = serde_json::to_string_pretty(&policy)?;
    write(&folder, "visit_all.json", &json)?;
    write(&folder, "visit_all.rs", &tltlc::emit::policy::rust(&json)?)
}

/// The grid, ready to be learned and solved.
struct World {
    grid: Grid,
    dynamics: Dynamics,
}

impl World {
    fn new() -> Result<Self, Box<dyn Error>> {
        let grid = Grid::PAPER;
        Ok(Self { grid, dynamics: Dynamics::new(&grid)? })
    }

    fn task(&self, monitor: &impl Monitor<Cell>) -> Result<Labelled, tltl::task::Error> {
        Labelled::of_model(&self.grid, monitor)
    }

    /// Judges a table of action values exactly, and prints the verdict.
    fn report(&self, what: &str, size: &str, task: &Labelled, q: &QTable) -> Certificate {
        let problem = Problem::new(&self.dynamics, task);
        let exact = problem.optimal_q(&Rewards::default(), GAMMA);
        let certificate = problem.certify(&q.policy(), &exact);
        let steps = |steps: Option<f64>| steps.map_or("-".into(), |steps| format!("{steps:.4}"));
        println!(
            "{what:<37}{size}{:>11.6}{:>11}{:>10}{:>9.2} %",
            certificate.satisfied,
            steps(certificate.steps),
            steps(certificate.optimal_steps),
            100.0 * certificate.fraction_optimal
        );
        certificate
    }

    /// Figure 2 of the paper: each automaton, and the policy at each of its live states.
    fn figure(
        &self,
        compiled: &Compiled,
        tasks: &[Labelled; 3],
        tables: [&QTable; 3],
    ) -> Result<String, Box<dyn Error>> {
        let minimal = self.task(&gridworld::visit_all())?;
        let numbers = [same(&tasks[0]), same(&tasks[1]), self.numbers(&tasks[2], &minimal)];
        let titles = [
            "(a)  φ₁ = ◇a ∧ ◇b, learned",
            "(b)  φ₂ = ◇c, learned",
            "(c)  φ₁ ∧ φ₂, composed: the normalised sum of (a) and (b)",
        ];
        let mut rows = Vec::new();
        for (i, title) in titles.into_iter().enumerate() {
            let mut states: Vec<u32> = tasks[i].live().collect();
            states.sort_by_key(|&q| numbers[i][q as usize]);
            let panel = |&q| self.panel(numbers[i][q as usize], q, &tasks[i], tables[i]);
            let panels = states.iter().map(panel).collect();
            rows.push(Row { title: title.to_owned(), dfa: &compiled.automata[i].dfa, panels });
        }
        Ok(figure(&self.grid, &self.regions(), &rows))
    }

    /// The minimal automaton's number for each state of the raw product: what the same cells lead
    /// to in both.
    fn numbers(&self, raw: &Labelled, minimal: &Labelled) -> Vec<State> {
        let mut numbers = vec![None; raw.automaton_states() as usize];
        let mut found = vec![(0, 0)];
        while let Some((q, number)) = found.pop() {
            if numbers[q as usize].replace(number).is_none() {
                let cells = 0..self.grid.states();
                found.extend(cells.map(|s| (raw.next(q, s), minimal.next(number, s))));
            }
        }
        numbers.into_iter().map(Option::unwrap_or_default).collect()
    }

    fn panel(&self, number: State, q: u32, task: &Labelled, table: &QTable) -> Panel {
        let problem = Problem::new(&self.dynamics, task);
        let exact = problem.optimal_q(&Rewards::default(), GAMMA);
        let states = 0..self.grid.states();
        let actions: Vec<u32> = states.clone().map(|s| table.greedy(q, s)).collect();
        let loss = |s| {
            let (best, own) = (exact.max(q, s), exact.row(q, s)[actions[s] as usize]);
            // A smaller difference is rounding.
            if best - own > 1e-6 { 1.0 - own / best } else { 0.0 }
        };
        let losses = states.map(loss).collect();
        Panel { title: format!("q = {number}"), actions, losses }
    }

    fn regions(&self) -> Vec<Region> {
        let predicates: [(&str, Robustness); 3] =
            [("a", gridworld::a), ("b", gridworld::b), ("c", gridworld::c)];
        let region = |(name, robustness): (&str, Robustness)| Region {
            name: name.to_owned(),
            cells: (0..self.grid.states())
                .filter(|&s| robustness(&self.grid.state(s)) > 0.0)
                .collect(),
        };
        predicates.map(region).into()
    }
}

/// The numbers of a task's own automaton.
fn same(task: &Labelled) -> Vec<State> {
    (0..task.automaton_states()).collect()
}

/// How big an automaton is: its states, and its edges with self-loops, first with the predicates
/// as free propositions, then those that some state of the world can take.
fn size(automata: &Automata) -> String {
    let edges = |dfa: &Dfa| dfa.size().edges + dfa.size().self_loops;
    format!(
        "{:>7}{:>5} ({})",
        automata.dfa.len(),
        edges(&automata.propositional),
        edges(&automata.dfa)
    )
}

/// Trains a skill with the default settings, showing how far it is.
fn learn(
    world: &World,
    name: &'static str,
    task: &Labelled,
    seed: u64,
) -> Result<Learner, Box<dyn Error>> {
    let mut env = ModelEnv::new(world.grid)?;
    let mut learner = Learner::new(task, world.grid.actions(), Settings::default(), seed);
    let bar = ProgressBar::new(STEPS).with_prefix(name);
    bar.set_style(ProgressStyle::with_template(
        "{prefix:>8} {wide_bar} {human_pos} steps, {per_sec}, {eta} left",
    )?);
    bar.enable_steady_tick(Duration::from_millis(100));
    while learner.steps() < STEPS {
        let until = (learner.steps() + STEPS / 50).min(STEPS);
        learner.train(&mut env, task, until);
        bar.set_position(learner.steps().min(STEPS));
    }
    bar.finish_and_clear();
    Ok(learner)
}

fn heading() {
    println!(
        "{:<37}{:>7}{:>10}{:>11}{:>11}{:>10}{:>11}",
        "task", "states", "edges", "P(sat)", "E[steps]", "optimum", "optimal at"
    );
}

/// The automata of the task file, for the picture; nothing else here reads the file at run time.
fn automata() -> Result<Compiled, String> {
    let source = Source::new("gridworld.tltl", include_str!("tasks/gridworld.tltl"));
    compile::file(&source, Budget::default()).map_err(|errors| errors.to_string())
}

fn write(folder: &Path, name: &str, content: &str) -> Result<(), Box<dyn Error>> {
    let path = folder.join(name);
    std::fs::write(&path, content)?;
    println!("wrote {}", path.display());
    Ok(())
}
