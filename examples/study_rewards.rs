//! Study of rewards: what the optimum of each reward mode is worth for the task itself, on the two
//! counterexamples and on random layouts.
//!
//! `cargo run --release --example study_rewards` writes `docs/studies/rewards.{svg,md,jsonl}`.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::json;
use tltl::prelude::*;
use tltl::reward::{End, Mode};
use tltl_examples::grid::Cell;
use tltl_examples::spread::{Panel, Spread};
use tltl_examples::study::{self, FAMILIES, GRID, PAPER, Study, at, layout, mean, quantile};

const LAYOUTS: u64 = 100;
/// Steps that are learned from, and from how many where the certificate then says that more than 0.1 %
/// of P(satisfied) is given away.
const LEARNED: [u64; 2] = [6_000_000, 100_000_000];
const TOLERATED: f64 = 1e-3;

/// The settings that are compared.
fn modes() -> [(&'static str, Rewards); 9] {
    let progress = Rewards::progress();
    let trap = |penalty| progress.with_trap_penalty(penalty).expect("a penalty");
    let slow = progress.with_step_penalty(0.05).expect("a penalty");
    [
        ("Progress", progress),
        ("Progress, trap penalty 1", trap(1.0)),
        ("Progress, trap penalty 10", trap(10.0)),
        ("Progress, step penalty 0.05", slow),
        ("Literal", Rewards::of(Mode::Literal)),
        ("Acceptance, γ 0.95", Rewards::of(Mode::Acceptance)),
        ("Robustness, bound 1", Rewards::of(Mode::Robustness)),
        ("Shaped", Rewards::of(Mode::Shaped)),
        ("default", Rewards::default()),
    ]
}

/// Regret in P(satisfied), and excess steps; none if it never succeeds.
type Regret = (f64, Option<f64>);

/// All settings on one task and layout.
#[derive(Serialize, Deserialize)]
struct Case {
    /// Whether the task can be lost.
    trap: bool,
    regrets: [Regret; 10],
    /// Whether the learned policy needed the longer training.
    longer: bool,
}

/// The regrets of all modes' optima on one task.
fn judge(task: &dyn Monitor<Cell>) -> Case {
    let states = || (0..GRID.states()).map(|s| GRID.state(s));
    let labelled = Labelled::of_model(&GRID, task).expect("numbers");
    let labelled = labelled.with_robustness(states(), task).expect("numbers");
    let dynamics = Dynamics::new(&GRID).expect("a model");
    let problem = Problem::new(&dynamics, &labelled).expect("the same grid");
    let optimum = problem.optimum(&Rewards::default());
    let regret = |policy: &Policy| {
        let own = optimum.certify(policy).expect("the same task");
        (own.regret_satisfied, own.regret_steps)
    };
    let mut regrets = [(0.0, None); 10];
    for (own, (_, rewards)) in regrets.iter_mut().zip(modes()) {
        *own = regret(&problem.optimal_q(&rewards).policy());
    }
    regrets[9] = regret(&learned(&labelled, LEARNED[0]));
    let longer = regrets[9].0 > TOLERATED;
    if longer {
        regrets[9] = regret(&learned(&labelled, LEARNED[1]));
    }
    let lost = |q| labelled.end(q) == Some(End::Lost);
    Case { trap: (0..labelled.automaton_states()).any(lost), regrets, longer }
}

/// What the default settings learn.
fn learned(task: &Labelled, steps: u64) -> Policy {
    let mut env = ModelEnv::new(GRID).expect("a model");
    let mut learner = Learner::new(task, Settings::default(), 100);
    learner.train(&mut env, steps).expect("the same grid");
    learner.policy()
}

/// The names of the settings, the learned one last.
fn names() -> Vec<&'static str> {
    modes().iter().map(|&(name, _)| name).chain(["default, learned"]).collect()
}

/// The number of tasks: two counterexamples, and the compositions.
const TASKS: usize = 2 + FAMILIES.len();

/// What task `i` is called.
fn name(i: usize) -> String {
    match i {
        0 => "`!c U a`".to_owned(),
        1 => "`F c || (a T (b || c))`".to_owned(),
        _ => FAMILIES[i - 2].formulas.map(|formula| format!("`{formula}`")).join(" ∧ "),
    }
}

/// Task `i` on given cells, judged.
fn case(i: usize, cells: [Cell; 3]) -> Case {
    let [a, b, c] = cells.map(at);
    match i {
        0 => judge(&tltl! { !c U a }),
        1 => judge(&tltl! { F c || (a T (b || c)) }),
        _ => {
            let [one, two] = (FAMILIES[i - 2].skills)(cells);
            judge(&Product::conjunction(&[&*one, &*two]))
        }
    }
}

fn percent(value: f64) -> String {
    study::percent(value, 3, "never")
}

/// The regrets in P(satisfied) and the excess steps of setting `i`.
fn of<'a>(i: usize, cases: impl Iterator<Item = &'a Case>) -> (Vec<f64>, Vec<f64>) {
    let regret = |case: &Case| {
        let (p, steps) = case.regrets[i];
        (p, steps.unwrap_or(f64::INFINITY))
    };
    cases.map(regret).unzip()
}

fn section(text: &mut String, title: &str, cases: &[&Case]) {
    let _ = writeln!(
        text,
        "\n## {title}\n\n| setting | P regret, mean % | P regret, worst % | excess steps, median % | \
         excess steps, worst % |\n| --- | --- | --- | --- | --- |"
    );
    for (i, name) in names().iter().enumerate() {
        let (p, steps) = of(i, cases.iter().copied());
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

/// Regret in P(satisfied) where a task can be lost, in steps where it cannot.
fn figure(cases: &[Case]) -> Spread {
    let percents = |values: Vec<f64>| values.iter().map(|value| 100.0 * value).collect();
    let count = |trap| cases.iter().filter(|case| case.trap == trap).count();
    let safety = (0..10).map(|i| percents(of(i, cases.iter().filter(|case| case.trap)).0));
    let steps = (0..10).map(|i| percents(of(i, cases.iter().filter(|case| !case.trap)).1));
    let panel = |title: &str, trap, axis: &str, range, bound, groups| Panel {
        title: [title.to_owned(), format!("{} tasks and layouts", count(trap))],
        axis: axis.to_owned(),
        range,
        bound,
        groups,
    };
    let lost = panel(
        "Tasks that can be lost",
        true,
        "P(satisfied) given away, %",
        (1e-3, 100.0),
        Some((0.1, "tolerated: 0.1 %".to_owned())),
        safety.collect(),
    );
    let slow = panel(
        "Tasks that cannot be lost",
        false,
        "steps more than necessary, %",
        (1e-2, 1e4),
        None,
        steps.collect(),
    );
    Spread { names: names().into_iter().map(str::to_owned).collect(), panels: vec![lost, slow] }
}

fn head() -> String {
    let (gamma, default) = (Rewards::progress().gamma(), Rewards::default().gamma());
    format!(
        "# Rewards\n\n![Regret by setting](rewards.svg)\n\nThe tables show what the optimal \
         policy of each reward is worth for the task itself, computed exactly on the paper's grid: \
         its regret in P(satisfied) against the largest possible, and its E[steps given success] \
         over the fewest possible (negative where a policy gives up safety). γ is {gamma}, and \
         {default} for the default, which pays for acceptance alone. The last row is the policy \
         that the default settings learn from {} million steps, or from {} million if the \
         certificate after the first shows a regret of more than 0.1 %: they solve the world as \
         it was seen, and count a little of P(satisfied) for fewer steps. The figure shows the percentages of all tasks and layouts; \
         the dashed line is at 0.1 %. Written by `cargo run --release --example study_rewards`.\n",
        LEARNED[0] / 1_000_000,
        LEARNED[1] / 1_000_000
    )
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let study = Study::new("rewards", &(names(), modes(), LAYOUTS, LEARNED));
    let cases = study.run((LAYOUTS + 1) * TASKS as u64, |number| {
        let (layout_of, i) = (number / TASKS as u64, number as usize % TASKS);
        case(i, if layout_of == 0 { PAPER } else { layout(layout_of) })
    })?;
    let mut text = head();
    for i in 0..TASKS {
        let of_task: Vec<&Case> = cases[i..].iter().step_by(TASKS).collect();
        section(&mut text, &format!("{}, the paper's layout", name(i)), &of_task[..1]);
        section(&mut text, &format!("{}, 100 random layouts", name(i)), &of_task[1..]);
    }
    let [worst, worst_learned] = [8, 9].map(|i| quantile(&of(i, cases.iter()).0, 1.0));
    let longer = cases.iter().filter(|case| case.longer).count();
    let _ = writeln!(
        text,
        "\nLargest P regret of the default: {} % as an optimum, {} % as learned; {longer} of {} cases \
         needed {} steps for it.",
        percent(worst),
        percent(worst_learned),
        cases.len(),
        LEARNED[1]
    );
    let lines = cases.iter().enumerate().flat_map(|(number, case)| {
        let (layout, task) = (number / TASKS, name(number % TASKS));
        names().into_iter().zip(case.regrets).map(move |(setting, (p, steps))| {
            json!({"task": task, "layout": layout, "setting": setting,
                   "regret_satisfied": p, "regret_steps": steps})
        })
    });
    study.publish(".svg", &figure(&cases).svg("Regret by setting"))?;
    study.publish(".md", &text)?;
    study.publish_lines(lines)?;
    let all = [worst, worst_learned];
    assert!(all.iter().all(|&worst| worst < TOLERATED), "the default is not safe: {all:?}");
    Ok(study.finish()?)
}
