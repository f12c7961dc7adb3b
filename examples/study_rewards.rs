//! Study of rewards: what the optimum of each reward mode is worth for the task itself, on the two
//! counterexamples and on random layouts.
//!
//! `cargo run --release --example study_rewards` writes `docs/studies/rewards.{md,jsonl}`.

use std::fmt::Write as _;

use indicatif::{ProgressBar, ProgressStyle};
use tltl::augmented::{Labelled, Reward, Rewards};
use tltl::env::ModelEnv;
use tltl::learn::{Learner, Settings, seeds};
use tltl::model::{Dynamics, FiniteModel};
use tltl::product::Product;
use tltl::q::QTable;
use tltl::solve::Problem;
use tltl::{Monitor, tltl};
use tltl_examples::grid::Cell;
use tltl_examples::study::{FAMILIES, GRID, GridTask, PAPER, at, layout, mean, publish, quantile};

const GAMMA: f64 = 0.95;
const LAYOUTS: u64 = 100;
const LEARNED: u64 = 6_000_000;

/// The settings that are compared.
fn modes() -> [(&'static str, Rewards, f64); 9] {
    let progress = Rewards::of(Reward::Progress);
    let safe = Settings::safe();
    [
        ("Progress", progress, GAMMA),
        ("Progress, trap penalty 1", Rewards { trap_penalty: 1.0, ..progress }, GAMMA),
        ("Progress, trap penalty 10", Rewards { trap_penalty: 10.0, ..progress }, GAMMA),
        ("Progress, step penalty 0.05", Rewards { step_penalty: 0.05, ..progress }, GAMMA),
        ("Literal", Rewards::of(Reward::Literal), GAMMA),
        ("Acceptance", Rewards::of(Reward::Acceptance), GAMMA),
        ("Robustness, bound 1", Rewards::of(Reward::ROBUSTNESS), GAMMA),
        ("Shaped", Rewards::of(Reward::Shaped), GAMMA),
        ("Settings::safe", safe.rewards, safe.gamma),
    ]
}

/// Regret in P(satisfied), and excess steps.
type Regret = (f64, f64);

/// The regrets of all modes' optima on one task.
fn regrets(task: &dyn Monitor<Cell>) -> [Regret; 10] {
    let states = || (0..GRID.states()).map(|s| GRID.state(s));
    let labelled = Labelled::of_model(&GRID, task).expect("numbers");
    let labelled = labelled.with_robustness(states(), task).expect("numbers");
    let dynamics = Dynamics::new(&GRID).expect("a model");
    let problem = Problem::new(&dynamics, &labelled);
    let best = problem.best();
    let judge = |policy: &[u32], q: &QTable| {
        let own = problem.certify_against(policy, q, &best);
        (own.regret_satisfied, own.regret_steps.unwrap_or(f64::INFINITY))
    };
    let mut regrets = [(0.0, 0.0); 10];
    for (regret, (_, rewards, gamma)) in regrets.iter_mut().zip(modes()) {
        let q = problem.optimal_q(&rewards, gamma);
        *regret = judge(&q.policy(), &q);
    }
    let learned = learned(&labelled);
    regrets[9] = judge(&learned.policy(), &learned);
    regrets
}

/// What `Settings::safe` learns from experience, replayed.
fn learned(task: &Labelled) -> QTable {
    let mut env = ModelEnv::new(GRID).expect("a model");
    let mut learner = Learner::new(task, 5, Settings::safe(), 100);
    learner.train(&mut env, task, LEARNED);
    learner.replay(task).expect("experience");
    learner.q().clone()
}

/// The names of the settings, the learned one last.
fn names() -> Vec<&'static str> {
    modes().iter().map(|&(name, ..)| name).chain(["Settings::safe, learned"]).collect()
}

/// The two counterexamples, on given cells.
fn counterexamples([a, b, c]: [Cell; 3]) -> [(&'static str, GridTask); 2] {
    let (a, b, c) = (at(a), at(b), at(c));
    let detour = tltl! { F c || (a T (b || c)) };
    [("!c U a", Box::new(tltl! { !c U a })), ("F c || (a T (b || c))", Box::new(detour))]
}

fn percent(value: f64) -> String {
    if value.is_finite() { format!("{:.3}", 100.0 * value) } else { "never".to_owned() }
}

fn section(text: &mut String, title: &str, all: &[[Regret; 10]]) {
    let _ = writeln!(
        text,
        "\n## {title}\n\n| setting | P regret, mean % | P regret, worst % | excess steps, median % | \
         excess steps, worst % |\n| --- | --- | --- | --- | --- |"
    );
    for (i, name) in names().iter().enumerate() {
        let p: Vec<f64> = all.iter().map(|regrets| regrets[i].0).collect();
        let steps: Vec<f64> = all.iter().map(|regrets| regrets[i].1).collect();
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} |",
            percent(mean(&p)),
            percent(quantile(&p, 1.0)),
            percent(quantile(&steps, 0.5)),
            percent(quantile(&steps, 1.0))
        );
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut text = "# Rewards\n\nWhat the optimal policy of each reward is worth for the task itself, on \
                    the paper's grid, exactly: regret in P(satisfied) against the largest possible, and \
                    E[steps given success] over the fewest possible (negative where safety is given \
                    away). γ is 0.95, and 0.9999 for `Settings::safe`, which pays acceptance alone: the \
                    setting to take where a task has a trap; its last row is what it learns from 6 million steps \
                    of experience, replayed. Written by `cargo run --release --example \
                    study_rewards`.\n"
        .to_owned();
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len}, {per_sec}, {eta} left")?;
    let bar = ProgressBar::new(LAYOUTS).with_style(style);
    let (mut lines, mut worst, mut worst_learned) = (String::new(), 0.0f64, 0.0f64);
    let all = seeds(0..LAYOUTS + 1, |seed| {
        let cells = if seed == 0 { PAPER } else { layout(seed) };
        bar.inc(1);
        let mut rows: Vec<(String, [Regret; 10])> = Vec::new();
        for (formula, task) in &counterexamples(cells) {
            rows.push((format!("`{formula}`"), regrets(&**task)));
        }
        for family in &FAMILIES {
            let [one, two] = (family.skills)(cells);
            let whole = Product::conjunction(&[&*one, &*two]);
            let name = format!("`{}` ∧ `{}`", family.formulas[0], family.formulas[1]);
            rows.push((name, regrets(&whole)));
        }
        rows
    });
    bar.finish_and_clear();
    for i in 0..all[0].len() {
        let name = &all[0][i].0;
        section(&mut text, &format!("{name}, the paper's layout"), &[all[0][i].1]);
        let random: Vec<[Regret; 10]> = all[1..].iter().map(|rows| rows[i].1).collect();
        section(&mut text, &format!("{name}, 100 random layouts"), &random);
        for (seed, rows) in all.iter().enumerate() {
            worst = worst.max(rows[i].1[8].0);
            worst_learned = worst_learned.max(rows[i].1[9].0);
            for (mode, (p, steps)) in names().iter().zip(rows[i].1) {
                let steps = steps.is_finite().then_some(steps);
                let line = serde_json::json!({
                    "task": name, "layout": seed, "setting": mode,
                    "regret_satisfied": p, "regret_steps": steps,
                });
                let _ = writeln!(lines, "{line}");
            }
        }
    }
    let _ = writeln!(
        text,
        "\nLargest P regret of `Settings::safe`: {} % as an optimum, {} % as learned from {LEARNED} steps.",
        percent(worst),
        percent(worst_learned)
    );
    publish("rewards.md", &text)?;
    publish("rewards.jsonl", &lines)?;
    assert!(worst < 1e-3, "the safe setting is not safe: {worst}");
    Ok(())
}
