//! Settings are valid by construction: what is out of range is an error that names the field, made
//! by hand or read from a file.

use serde_json::{Value, json};
use tltl::OutOfRange;
use tltl::estimate::Trials;
use tltl::learn::{Exploration, Memory, Schedule, Updates};
use tltl::prelude::*;
use tltl::reward::{Arrival, Arrivals, End, Ends, Mode};

const NAN: f64 = f64::NAN;

fn refused<T: std::fmt::Debug>(result: Result<T, OutOfRange>) -> (&'static str, String) {
    let error = result.unwrap_err();
    (error.field(), error.to_string())
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let (rewards, settings, trials) = (Rewards::default(), Settings::default(), Trials::default());
    let constant = |value| Schedule::constant(value).unwrap();
    let fall = |from, to| Schedule::linear(from, to, 10).unwrap();
    for (found, field, text) in [
        (refused(rewards.with_gamma(1.0)), "gamma", "`gamma` is 1, not in [0, 1)"),
        (refused(rewards.with_gamma(NAN)), "gamma", "`gamma` is NaN, not in [0, 1)"),
        (refused(rewards.with_gamma(-0.1)), "gamma", "`gamma` is -0.1, not in [0, 1)"),
        (refused(rewards.with_bound(0.0)), "bound", "`bound` is 0, not a positive number"),
        (
            refused(rewards.with_bound(f64::INFINITY)),
            "bound",
            "`bound` is inf, not a positive number",
        ),
        (refused(rewards.with_trap_penalty(-1.0)), "trap_penalty", "not a number from 0 on"),
        (refused(rewards.with_step_penalty(NAN)), "step_penalty", "not a number from 0 on"),
        (refused(rewards.with_environment(NAN)), "environment", "not a finite number"),
        (refused(settings.with_alpha(constant(0.0))), "alpha", "`alpha` is 0, not in (0, 1]"),
        (refused(settings.with_alpha(fall(0.5, 1.5))), "alpha", "`alpha` is 1.5, not in (0, 1]"),
        (
            refused(settings.with_epsilon(fall(-0.5, 1.0))),
            "epsilon",
            "`epsilon` is -0.5, not in [0, 1]",
        ),
        (refused(settings.with_horizon(0)), "horizon", "`horizon` is 0, not at least 1"),
        (refused(settings.with_initial(NAN)), "initial", "not a finite number"),
        (refused(Schedule::constant(NAN)), "value", "not a finite number"),
        (refused(Schedule::linear(1.0, NAN, 5)), "to", "not a finite number"),
        (refused(Schedule::harmonic(1.0, 0.0)), "half", "`half` is 0, not a positive number"),
        (refused(trials.with_episodes(0)), "episodes", "`episodes` is 0, not at least 1"),
        (refused(trials.with_confidence(1.0)), "confidence", "`confidence` is 1, not in (0, 1)"),
    ] {
        assert_eq!(found.0, field);
        assert!(found.1.ends_with(text), "{}", found.1);
    }
}

/// Settings of every kind, as they are saved.
fn saved() -> Vec<Value> {
    let rewards = Rewards::of(Mode::Robustness).with_bound(2.0).unwrap();
    let rewards = rewards.with_trap_penalty(0.5).unwrap().with_environment(-1.0).unwrap();
    let some = Settings::paper()
        .with_rewards(rewards)
        .with_updates(Updates::Counterfactual)
        .with_memory(Memory::Experience);
    let all = [Settings::default(), Settings::paper(), some];
    all.into_iter().map(|settings| serde_json::to_value(settings).unwrap()).collect()
}

#[test]
fn files_go_through_the_same_checks() {
    for settings in saved() {
        let read: Settings = serde_json::from_value(settings.clone()).unwrap();
        assert_eq!(serde_json::to_value(read).unwrap(), settings);
        for (field, value, text) in [
            ("/gamma", json!(1), "`gamma` is 1, not in [0, 1)"),
            ("/alpha", json!({"constant": 2}), "`alpha` is 2, not in (0, 1]"),
            ("/epsilon", json!({"linear": {"from": 1, "to": -1, "steps": 5}}), "`epsilon` is -1"),
            ("/epsilon", json!({"harmonic": {"start": 1, "half": 0}}), "`half` is 0"),
            ("/horizon", json!(0), "`horizon` is 0"),
            ("/rewards/mode", json!({"robustness": {"bound": -1}}), "`bound` is -1"),
            ("/rewards/step_penalty", json!(-1), "`step_penalty` is -1"),
            ("/rewards/mode", json!("everything"), "unknown variant"),
        ] {
            let mut bad = settings.clone();
            *bad.pointer_mut(field).unwrap() = value;
            let error = serde_json::from_value::<Settings>(bad).unwrap_err().to_string();
            assert!(error.contains(text), "{error}");
        }
    }
}

/// Files name all that they mean: settings that were the default of an earlier version stay what they
/// were.
#[test]
fn earlier_defaults_keep_their_meaning() {
    let earlier = json!({
        "gamma": 0.95,
        "alpha": {"harmonic": {"start": 1.0, "half": 8.0}},
        "epsilon": {"constant": 1.0},
        "horizon": 200,
        "counterfactual": true,
        "initial": 0.0,
        "rewards": {"mode": "progress", "trap_penalty": 0.0, "step_penalty": 0.0, "environment": 0.0},
        "remember": true,
    });
    let read: Settings = serde_json::from_value(earlier).unwrap();
    let then = Settings::default().with_rewards(Rewards::progress());
    assert_eq!(read, then.with_exploration(Exploration::Random));
}

/// A row of moves pays what each of them pays, under every mode.
#[test]
fn slices_pay_what_single_moves_pay() {
    // `!c U (a T b)` or the like: 0 → 1 → 2 accepts, 3 is the trap.
    let of = vec![None, None, Some(End::Accepted), Some(End::Lost)];
    let ends = Ends::new(of, vec![Some(2), Some(1), Some(0), None]);
    let moves = [(0, 0), (0, 1), (0, 3), (1, 2), (1, 3), (2, 2), (3, 3), (1, 1)];
    let (q, to): (Vec<u32>, Vec<u32>) = moves.into_iter().unzip();
    let (robustness, reward) = ([-2.0, 0.5, 1.5, 0.25, 0.0, -0.5, 3.0, 9.0], [0.5; 8]);
    let terminated = [false, true, false, true, false, true, false, true];
    for mode in [Mode::Progress, Mode::Literal, Mode::Acceptance, Mode::Robustness, Mode::Shaped] {
        let rewards = Rewards::of(mode).with_trap_penalty(0.25).unwrap();
        let rewards = rewards.with_step_penalty(0.125).unwrap().with_environment(2.0).unwrap();
        let arrivals = Arrivals {
            q: &q,
            to: &to,
            robustness: &robustness,
            reward: &reward,
            terminated: &terminated,
        };
        let mut paid = [0.0; 8];
        rewards.pay_all(&ends, &arrivals, &mut paid);
        // Each kind of move is paid once where there are many.
        let mut often = [0.0; 80];
        let [robustness_often, reward_often] = [&robustness, &reward].map(|one| one.repeat(10));
        let many = Arrivals {
            q: &q.repeat(10),
            to: &to.repeat(10),
            robustness: &robustness_often,
            reward: &reward_often,
            terminated: &terminated.repeat(10),
        };
        rewards.pay_all(&ends, &many, &mut often);
        assert!(often.chunks(8).all(|chunk| *chunk == paid), "{mode:?}");
        for (i, paid) in paid.into_iter().enumerate() {
            let (robustness, terminated) = (robustness[i], terminated[i]);
            let arrival =
                Arrival { robustness, terminated, reward: 0.5, ..Arrival::at(q[i], to[i]) };
            assert_eq!(paid, rewards.pay(&ends, &arrival), "{mode:?}, {arrival:?}");
            let lost = if q[i] != 3 && to[i] == 3 { 0.25 } else { 0.0 };
            // Φ is 1/3 at 0, 2/3 at 1, and 0 where the episode ends.
            let phi = |q: u32, left: bool| {
                if left { [1.0, 2.0, 0.0, 0.0][q as usize] / 3.0 } else { 0.0 }
            };
            let accepted = f64::from(u8::from(q[i] != 2 && to[i] == 2));
            let expected = match mode {
                Mode::Progress => f64::from(u8::from(q[i] != to[i] && to[i] != 3)),
                Mode::Literal => f64::from(u8::from(q[i] != to[i])),
                Mode::Acceptance => accepted,
                Mode::Robustness => robustness.clamp(-1.0, 1.0),
                Mode::Shaped => accepted + 0.95 * phi(to[i], !terminated) - phi(q[i], true),
            };
            assert!(
                (paid - (expected - 0.125 - lost + 1.0)).abs() < 1e-12,
                "{mode:?}, {arrival:?}"
            );
        }
    }
}
