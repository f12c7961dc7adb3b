//! Continuous control: learn a task with an actor, judge it against a controller written by hand, draw
//! it, emit it.
//!
//! `cargo run --release -p tltl-control --example control [-- TASK [SEED [STEPS]]]` does that for one task,
//! `fetch` if left out, and writes into `target/control`. With `--features rapier` there are the tasks of the
//! rover, too. Instead of a task:
//!
//! - `--study` learns the tasks of two and three steps with ten seeds, by SAC and by TD3, and writes
//!   `docs/studies/control_*`;
//! - `--falsify [TASK [SEED [STEPS]]]` searches for the starts and disturbances from which a learned controller does
//!   worst, trains it on from there, and searches again;
//! - `--compose [PAIR [SEED [SEEDS]]]` composes pairs of skills (0 is all three) without a step in the world, with
//!   one seed or with so many from there on, and prints what each step of it is worth;
//! - `--seeds [TASK [SEED [SEEDS [STEPS]]]]` learns a task with one seed or with so many from there on, and prints
//!   what each comes to and how long it took.
//!
//! Before all of these, `--by METHOD` says how actors learn: `sac`, `td3` or `ddpg`. Left out, it is SAC, and of a study
//! both.

mod case;
mod compose;
mod falsify;
mod one;
mod seeds;
mod study;
mod worlds;

use std::error::Error;
use std::process::ExitCode;
use std::str::FromStr;

use case::{Method, STEPS};

type Failure = Box<dyn Error>;

fn main() -> ExitCode {
    match run(std::env::args().skip(1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(mut arguments: impl Iterator<Item = String>) -> Result<(), Failure> {
    let (mut what, mut method) = (arguments.next(), None);
    if what.as_deref() == Some("--by") {
        let name = arguments.next().unwrap_or_default();
        (what, method) = (arguments.next(), Some(name.parse::<Method>()?));
    }
    let by = method.unwrap_or(Method::Sac);
    match what.as_deref().unwrap_or("fetch") {
        "--study" => {
            no_more(arguments)?;
            study::run(method)
        }
        "--compose" => {
            let pair = given(arguments.next())?.filter(|pair| *pair > 0);
            let seed = given(arguments.next())?.unwrap_or(1);
            let seeds = given(arguments.next())?.unwrap_or(1);
            no_more(arguments)?;
            compose::run(by, pair, seed, seeds)
        }
        "--falsify" => {
            let task = arguments.next().unwrap_or_else(|| "fetch".into());
            let seed = given(arguments.next())?.unwrap_or(1);
            let steps = given(arguments.next())?.unwrap_or(STEPS);
            no_more(arguments)?;
            falsify::run(by, &task, seed, steps)
        }
        "--seeds" => {
            let task = arguments.next().unwrap_or_else(|| "fetch".into());
            let seed = given(arguments.next())?.unwrap_or(1);
            let seeds = seed..u64::saturating_add(seed, given(arguments.next())?.unwrap_or(1));
            let steps = given(arguments.next())?.unwrap_or(STEPS);
            no_more(arguments)?;
            seeds::run(by, &task, seeds, steps)
        }
        option if option.starts_with('-') => {
            Err(format!("there is no option `{option}`, or none here"))?
        }
        task => {
            let seed = given(arguments.next())?.unwrap_or(1);
            let steps = given(arguments.next())?.unwrap_or(STEPS);
            no_more(arguments)?;
            one::run(by, task, seed, steps)
        }
    }
}

/// Nothing is left out of what was asked.
fn no_more(mut arguments: impl Iterator<Item = String>) -> Result<(), Failure> {
    let more = |text| format!("`{text}` is one argument too many");
    Ok(arguments.next().map_or(Ok(()), |text| Err(more(text)))?)
}

/// An argument that is a number from 0 on.
fn given<T: FromStr>(argument: Option<String>) -> Result<Option<T>, Failure> {
    let number =
        |text: String| text.parse().map_err(|_| format!("`{text}` is no number from 0 on"));
    Ok(argument.map(number).transpose()?)
}
