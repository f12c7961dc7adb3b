//! The paper's grid world (Section 5.1): specify, compile, learn, compose, judge, draw, emit.
//!
//! `cargo run --release --example gridworld [FOLDER]` writes into FOLDER (`target/gridworld` if
//! left out) the figure, the composed policy as JSON, and the same policy as Rust.

use std::error::Error;

use tltl::prelude::*;
use tltl_examples::figure::Figure;
use tltl_examples::grid::Grid;
use tltl_examples::show::{self, Folder};

include_tltl!("tasks/gridworld.tltl", state = tltl_examples::grid::Cell);

fn main() -> Result<(), Box<dyn Error>> {
    // The world, and two tasks in it: visit a and b, in any order; visit c.
    let mut env = ModelEnv::new(Grid::PAPER)?;
    let (phi_1, phi_2) = (gridworld::visit_a_b(), gridworld::visit_c());
    let visit_a_b = Labelled::of_env(&env, &phi_1)?;
    let visit_c = Labelled::of_env(&env, &phi_2)?;

    // Learn each of them as a skill.
    let mut first = Learner::new(&visit_a_b, Settings::default(), 1);
    let mut second = Learner::new(&visit_c, Settings::default(), 2);
    show::train(&mut first, &mut env, STEPS)?;
    show::train(&mut second, &mut env, STEPS)?;

    // Compose them from what they have seen: visit all three, without a further step in the world.
    let product = Product::conjunction(&[&phi_1, &phi_2]);
    let visit_all = Labelled::of_env(&env, &product)?.named("visit_all", "visit_a_b && visit_c");
    let (q_1, q_2) = (first.q(), second.q());
    let composition = Composition::new(&product, &visit_all, &[&q_1, &q_2], first.rewards())?;
    let sum = composition.initial(Combine::NormalisedSum);
    let mut seen = first.experience().clone();
    seen.extend(second.experience())?;
    let composed = composition.refined(&Dynamics::new(&seen)?, &sum)?.policy();

    // What is that worth, against the exact optimum?
    let all = Problem::new(env.dynamics(), &visit_all)?.optimum(&first.rewards());
    let report = all.report_within(&composed, 30)?;
    println!("{report}\n");

    // Compare with the skills themselves, with their sum, and with learning from scratch.
    let one = Problem::new(env.dynamics(), &visit_a_b)?.optimum(&first.rewards());
    let two = Problem::new(env.dynamics(), &visit_c)?.optimum(&second.rewards());
    let mut scratch = Learner::new(&visit_all, Settings::default(), 3);
    show::train(&mut scratch, &mut env, STEPS)?;
    let automata = show::automata("gridworld.tltl", include_str!("tasks/gridworld.tltl"))?;
    show::verdicts(&[
        ("φ₁ = ◇a ∧ ◇b, learned", &automata[0], first.certify(one.problem())?),
        ("φ₂ = ◇c, learned", &automata[1], second.certify(two.problem())?),
        ("φ₁ ∧ φ₂, sum of skills (step 2)", &automata[2], all.certify(&sum.policy())?),
        ("φ₁ ∧ φ₂, refined (step 6)", &automata[2], report.certificate.clone()),
        ("φ₁ ∧ φ₂, learned from scratch", &automata[2], scratch.certify(all.problem())?),
    ]);
    println!("\nThe composition took no step in the world.");

    // Draw the paper's Figure 2.
    let folder = Folder::of_arguments("target/gridworld")?;
    let minimal = Labelled::of_env(&env, &gridworld::visit_all())?;
    let mut figure = Figure::of(Grid::PAPER);
    figure.regions(&[("a", gridworld::a), ("b", gridworld::b), ("c", gridworld::c)]);
    let titles = [
        "(a)  φ₁ = ◇a ∧ ◇b, learned",
        "(b)  φ₂ = ◇c, learned",
        "(c)  φ₁ ∧ φ₂, composed from what was seen for (a) and (b)",
    ];
    figure.row(titles[0], &automata[0].dfa, &visit_a_b, &one, &first.policy())?;
    figure.row(titles[1], &automata[1].dfa, &visit_c, &two, &second.policy())?;
    figure.row(titles[2], &automata[2].dfa, &minimal, &all, &composed)?;
    folder.write("figure2.svg", &figure.svg())?;

    // Save the policy with all that is known of it, and emit it as Rust that stands alone.
    let policy = composed.composed(&product)?.trained(first.training()).trained(second.training());
    let policy = policy.certified(report.certificate).from_starts(&report.starts);
    folder.write("visit_all.json", &serde_json::to_string_pretty(&policy)?)?;
    folder.write("visit_all.rs", &tltlc::emit::policy::source(&policy))
}

/// Environment steps of each training.
const STEPS: u64 = 8_000_000;
