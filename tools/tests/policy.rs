//! Saved policies as Rust: what is told, and what is refused.

use serde_json::{Value, json};
use tltl::learn::Settings;
use tltlc::emit::policy::rust;

/// A policy composed of two skills in a world of two states.
fn policy() -> Value {
    let settings = serde_json::to_value(Settings::default()).unwrap();
    let training = |task: &str, seed: u64| json!({"task": task, "settings": settings, "steps": 1000, "episodes": 10, "seed": seed});
    let certificate = json!({
        "kind": "exact", "satisfied": 1.0, "steps": 2.5,
        "optimal_satisfied": 1.0, "optimal_steps": 2.5,
        "regret_satisfied": 0.0, "regret_steps": 0.0,
        "worst_regret_satisfied": 0.0, "fraction_optimal": 1.0,
    });
    json!({
        "format": "tltl-policy", "version": 2, "task": "both", "formula": "F a && F b",
        "states": 2, "actions": ["go", "stay"],
        "automaton": {"states": 2, "initial": 0, "accepting": 1, "trap": null},
        "classes": 2, "class": [0, 1], "next": [0, 1, 1, 1], "action": [0, 1, 0, 0],
        "training": [training("first", 7), training("second", 8)],
        "certificate": certificate,
        "shield": {
            "before": certificate, "after": certificate,
            "lost_before": 0.5, "lost_after": 0.25, "smallest_lost": 0.25, "overruled": 0.125,
            "allowed": {"epsilon": 0.01, "fraction": 0.5, "lost": 0.26, "satisfied": 0.75, "steps": 3.5},
        },
        "starts": {"state": [1], "satisfied": [1.0], "steps": [0.0]},
    })
}

/// Without the breaks of lines.
fn emitted(policy: &Value) -> String {
    let text = rust(&policy.to_string()).unwrap();
    text.split_whitespace().filter(|word| *word != "//!").collect::<Vec<_>>().join(" ")
}

#[test]
fn all_skills_are_named_with_their_seeds() {
    let text = emitted(&policy());
    assert!(text.contains("on `first` for 1000 steps in 10 episodes with seed 7, and on `second`"));
    assert!(text.contains("with seed 8; settings alpha"), "{text}");
    assert_eq!(text.matches("gamma 0.99999").count(), 1, "shared settings once: {text}");
    let mut other = policy();
    other["training"][1]["settings"]["gamma"] = 0.9.into();
    let text = emitted(&other);
    assert!(text.contains("seed 7, settings alpha") && text.contains("seed 8, settings alpha"));
    assert!(text.contains("gamma 0.99999,") && text.contains("gamma 0.9,"), "{text}");
}

#[test]
fn certificates_are_told() {
    let text = emitted(&policy());
    assert!(text.contains("overrules 12.50 % of the actions"), "{text}");
    assert!(text.contains("probability 0.250000 (smallest possible 0.250000)"), "{text}");
    assert!(text.contains("enter the trap with probability 0.260000 at most"), "{text}");
    let mut earlier = policy();
    earlier["shield"].as_object_mut().unwrap().remove("allowed");
    assert!(!emitted(&earlier).contains("at most"), "documents of earlier versions do not say it");
    assert!(text.contains("STARTS: [(f64, f64); 2] = [ (f64::NAN, f64::NAN), (1.0, 0.0), ]"));
    let mut bare = policy();
    for field in ["shield", "starts", "certificate"] {
        bare[field] = Value::Null;
    }
    let text = emitted(&bare);
    assert!(!text.contains("STARTS") && text.contains("Not judged"), "{text}");
}

#[test]
fn formulas_do_not_become_lists() {
    for length in 0..40 {
        let mut policy = policy();
        policy["formula"] = format!("{} > 3 - 4 + 5 * 6", "x".repeat(length + 30)).into();
        let text = rust(&policy.to_string()).unwrap();
        for line in text.lines().filter_map(|line| line.strip_prefix("//! ")) {
            assert!(!line.starts_with(['>', '-', '+', '*']) && line.len() < 96, "{line}");
        }
    }
}

#[test]
fn what_is_not_a_policy_is_refused() {
    let refused = |field: &str, value: Value| {
        let mut bad = policy();
        bad[field] = value;
        rust(&bad.to_string()).unwrap_err()
    };
    assert!(
        refused("version", json!(1))
            .starts_with("policy version 1; this library reads 2 at line 1")
    );
    assert!(
        refused("starts", json!({"state": [2], "satisfied": [1.0], "steps": [0.0]}))
            .contains("2 is not less than 2")
    );
    assert!(
        refused("starts", json!({"state": [1], "satisfied": [], "steps": [0.0]}))
            .contains("`starts.satisfied` has 0 entries, not 1")
    );
    assert!(refused("training", json!(null)).contains("invalid type"));
    let text = policy().to_string();
    assert!(rust(&text[..text.len() / 2]).unwrap_err().contains("not JSON"));
}

/// The JSON of `value`, in which the entry of number `twice` stands twice, counted down to 0.
fn with_one_twice(value: &Value, twice: &mut usize) -> String {
    match value {
        Value::Object(fields) => {
            let mut entries = Vec::new();
            for (key, value) in fields {
                let is_it = std::mem::replace(twice, twice.wrapping_sub(1)) == 0;
                let entry = format!("{}:{}", json!(key), with_one_twice(value, twice));
                entries.extend(is_it.then(|| entry.clone()));
                entries.push(entry);
            }
            format!("{{{}}}", entries.join(","))
        }
        Value::Array(values) => {
            let values: Vec<_> = values.iter().map(|value| with_one_twice(value, twice)).collect();
            format!("[{}]", values.join(","))
        }
        other => other.to_string(),
    }
}

#[test]
fn no_field_stands_twice() {
    let network = include_str!("cli/network.json");
    for whole in [policy(), serde_json::from_str(network).unwrap()] {
        assert!(rust(&whole.to_string()).is_ok());
        for number in 0.. {
            let mut left = number;
            let text = with_one_twice(&whole, &mut left);
            if left < usize::MAX / 2 {
                assert!(number > 20, "the policy has fields");
                break;
            }
            let error = rust(&text).expect_err(&text);
            // A schedule is an object of one field; there a comma is no JSON.
            let named = error.contains("duplicate field") || error.contains("expected value");
            assert!(named, "{error}: {text}");
        }
    }
}
