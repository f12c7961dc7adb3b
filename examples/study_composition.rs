//! Study (c): composing skills, on the paper's layout and on 100 random ones, for five families of
//! specifications, three of them with traps.
//!
//! `cargo run --release --example study_composition` writes `docs/studies/composition.{md,jsonl}`.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::json;
use tltl::prelude::*;
use tltl_examples::chart::{self, Axis, Chart, Curve, Point, Row};
use tltl_examples::grid::Cell;
use tltl_examples::study::{FAMILIES, Family, GRID, PAPER, Study, layout, mean, quantile};

const GAMMA: f64 = 0.95;
const LAYOUTS: u64 = 100;
const SCRATCH: u64 = 680_000;
const METHODS: [&str; 6] =
    ["sum", "normalised sum", "max", "compensated", "refined", "from scratch"];

/// What stands below each figure.
const REMARKS: [&str; 3] = [
    "Sum, normalised sum, max: of the two skills' values. Compensated: the values, in the product, \
     of the sum's policy.",
    "Refined: the optimum of the product for the reward. From scratch: learned without skills.",
    "Each curve has its own order of the layouts: it says how many lose no more than so much.",
];

/// What one method is worth on one layout.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Worth {
    satisfied: f64,
    largest: f64,
    /// Relative to the fewest; none if it never succeeds.
    excess: Option<f64>,
    /// The largest difference of an action value from the optimum of the product.
    error: f64,
}

/// All methods on one layout; panics only where the library is wrong.
fn compare(family: &Family, cells: [Cell; 3], seed: u64) -> [Worth; 6] {
    let [one, two] = (family.skills)(cells);
    let whole = Product::conjunction(&[&*one, &*two]);
    let (dynamics, rewards) = (Dynamics::new(&GRID).expect("a model"), Rewards::progress());
    let problem = |task: &dyn Monitor<Cell>| {
        let task = Labelled::of_model(&GRID, task).expect("numbers");
        Problem::new(&dynamics, &task).expect("the same grid")
    };
    let [q1, q2] = [&*one, &*two].map(|task| problem(task).optimal_q(&rewards));
    let optimum = problem(&whole).optimum(&rewards);
    let task = optimum.problem().task();
    let composition = Composition::new(&whole, task, &[&q1, &q2], rewards).expect("its own skills");
    let compensated = composition.compensated(&dynamics).expect("the same grid");
    let tables = [
        composition.initial(Combine::Sum),
        composition.initial(Combine::NormalisedSum),
        composition.initial(Combine::Max),
        compensated.clone(),
        composition.refined(&dynamics, &compensated).expect("the same grid"),
        scratch(task, seed),
    ];
    tables.map(|table| {
        let own = optimum.certify(&table.policy()).expect("the same task");
        let exact = optimum.q().values();
        let differences = table.values().iter().zip(exact).map(|(a, b)| (a - b).abs());
        Worth {
            satisfied: own.satisfied,
            largest: own.optimal_satisfied,
            excess: own.regret_steps,
            error: differences.fold(0.0, f64::max),
        }
    })
}

impl Worth {
    /// Excess steps in percent; infinite if it never succeeds.
    fn percent(&self) -> f64 {
        100.0 * self.excess.unwrap_or(f64::INFINITY)
    }
}

fn scratch(task: &Labelled, seed: u64) -> QTable {
    let mut env = ModelEnv::new(GRID).expect("a model");
    let settings = Settings::default().with_rewards(Rewards::progress());
    let mut learner = Learner::new(task, settings, seed);
    learner.train(&mut env, SCRATCH).expect("the same grid");
    learner.q()
}

/// One line of the table.
fn line(table: &mut String, formulas: [&str; 2], method: &str, worths: &[Worth]) {
    let regrets: Vec<f64> = worths.iter().map(|w| 100.0 * (w.largest - w.satisfied)).collect();
    let excess: Vec<f64> = worths.iter().map(Worth::percent).collect();
    let never = excess.iter().filter(|e| e.is_infinite()).count();
    let error = worths.iter().map(|w| w.error).fold(0.0, f64::max);
    let _ = writeln!(
        table,
        "| `{}` ∧ `{}` | {method} | {:.3} | {:.3} | {:.2} | {:.2} | {never} | {error:.1e} |",
        formulas[0],
        formulas[1],
        mean(&regrets),
        quantile(&regrets, 1.0),
        quantile(&excess, 0.5),
        quantile(&excess, 0.95),
    );
}

/// The methods' losses over the random layouts, each sorted by size: excess steps where nothing can
/// be lost, regret in P(satisfied) where it can.
fn chart(family: &Family, all: &[[Worth; 6]]) -> String {
    let trapped = all.iter().flatten().any(|worth| worth.largest < 1.0 - 1e-9);
    let loss = |w: &Worth| if trapped { 100.0 * (w.largest - w.satisfied) } else { w.percent() };
    let curve = |i: usize| {
        let mut losses: Vec<f64> = all.iter().map(|worths| loss(&worths[i])).collect();
        losses.sort_by(f64::total_cmp);
        let point = |(rank, &y): (usize, &f64)| Point { x: rank as f64 + 1.0, y, low: y, high: y };
        Curve {
            name: METHODS[i].to_owned(),
            points: losses.iter().enumerate().map(point).collect(),
        }
    };
    let measure = if trapped { "P(satisfied) given away, %" } else { "excess steps, %" };
    let title = format!("({}) ∧ ({}), 100 random layouts", family.formulas[0], family.formulas[1]);
    let chart = Chart {
        title: format!("{measure}; 0.01 and less as 0.01"),
        axis: Axis::Logarithmic(0.01, 100.0),
        curves: (0..METHODS.len()).map(curve).collect(),
        levels: Vec::new(),
    };
    let x = "layouts, the easiest for each method first".to_owned();
    chart::svg(
        &title,
        &[Row { title: title.clone(), x, charts: vec![chart] }],
        &REMARKS.map(str::to_owned),
    )
}

const HEAD: &str = "| skills | method | P regret, mean % | P regret, worst % | excess steps, median % \
                    | excess steps, 95th percentile % | never succeed | largest error of a value |\n\
                    | --- | --- | --- | --- | --- | --- | --- | --- |\n";

/// The family and the layout of a case; layout 0 is the paper's.
fn case(number: u64) -> (&'static Family, u64) {
    (&FAMILIES[(number / (LAYOUTS + 1)) as usize], number % (LAYOUTS + 1))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let formulas = FAMILIES.each_ref().map(|family| family.formulas);
    let study = Study::new("composition", &(formulas, METHODS, GAMMA, LAYOUTS, SCRATCH));
    let all = study.run(FAMILIES.len() as u64 * (LAYOUTS + 1), |number| {
        let (family, seed) = case(number);
        compare(family, if seed == 0 { PAPER } else { layout(seed) }, seed)
    })?;
    let (mut paper, mut random) = (HEAD.to_owned(), HEAD.to_owned());
    let mut charts = Vec::new();
    for (family, of) in FAMILIES.iter().zip(all.chunks(LAYOUTS as usize + 1)) {
        charts.push(chart(family, &of[1..]));
        for (i, method) in METHODS.iter().enumerate() {
            let of: Vec<Worth> = of.iter().map(|worths| worths[i]).collect();
            line(&mut paper, family.formulas, method, &of[..1]);
            line(&mut random, family.formulas, method, &of[1..]);
        }
    }
    let lines = all.iter().enumerate().flat_map(|(number, worths)| {
        let (family, layout) = case(number as u64);
        METHODS.iter().zip(worths).map(move |(method, worth)| {
            json!({"skills": family.formulas, "layout": layout, "method": method, "worth": worth})
        })
    });
    let text = format!(
        "# Composition of two skills\n\n![Excess steps without traps](composition_steps.svg)\n\n\
         ![Lost safety with traps](composition_traps.svg)\n\nTwo skills that are exact optima for \
         `Progress` (γ 0.95) are composed on the paper's 8 × 10 grid. Learning from scratch takes \
         {SCRATCH} environment steps with the default settings, paid by `Progress`. P regret is the largest possible \
         P(satisfied) minus that of the greedy policy, in percent. Excess steps are E[steps given \
         success] over the fewest possible; they are negative where a policy gives up P for \
         speed. `Progress` pays for each edge, so its optimum may have neither the largest P nor \
         the fewest steps: `refined` *is* the optimum of the product for `Progress` (last \
         column). Written by `cargo run --release \
         --example study_composition`.\n\n## The paper's layout\n\n{paper}\n## 100 random layouts\n\n\
         {random}"
    );
    study.publish("_steps.svg", &charts[0])?;
    study.publish("_traps.svg", &charts[4])?;
    study.publish(".md", &text)?;
    study.publish_lines(lines)?;
    Ok(study.finish()?)
}
