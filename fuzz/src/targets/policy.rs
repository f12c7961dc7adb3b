//! Saved policies with mistakes: the tool takes what the library does, and refuses what it refuses
//! for the same reason; what it emits is Rust.

use serde_json::Value;
use tltl::network::policy::NetworkPolicy;
use tltl::policy::Policy;
use tltlc::emit::policy::rust;

use crate::random::{Bytes, Choices};

/// The documents that mistakes are made in.
const DOCUMENTS: [&str; 3] = [
    include_str!("../../../tests/data/policies/plain.json"),
    include_str!("../../../tests/data/policies/full.json"),
    include_str!("../../../tests/data/network_policy.json"),
];

/// Runs the target: on text as it is if it is an object, else on a document with random mistakes.
pub fn run(bytes: &[u8]) {
    match std::str::from_utf8(bytes) {
        Ok(text) if text.starts_with('{') => check(text),
        _ => {
            let mut choices = Bytes(bytes);
            let document = DOCUMENTS[choices.choose(3) as usize];
            let mut document = serde_json::from_str(document).expect("it is JSON");
            for _ in 0..1 + choices.choose(3) {
                let depth = 1 + choices.choose(6);
                change(&mut choices, &mut document, depth);
            }
            check(&document.to_string());
        }
    }
}

fn check(text: &str) {
    let Ok(value) = serde_json::from_str::<Value>(text) else {
        assert!(rust(text).is_err());
        return;
    };
    let loaded = match value.get("format").and_then(Value::as_str) {
        Some(Policy::FORMAT) => serde_json::from_str::<Policy>(text).map(drop),
        Some(NetworkPolicy::FORMAT) => serde_json::from_str::<NetworkPolicy>(text).map(drop),
        _ => {
            assert!(rust(text).is_err());
            return;
        }
    };
    match (loaded, rust(text)) {
        (Ok(()), Ok(source)) => {
            syn::parse_file(&source).unwrap_or_else(|error| panic!("{error}: {source}"));
        }
        // The tool looks for the format first: of several doubled fields it may name another one.
        (Err(loaded), Err(emitted)) => assert!(
            emitted.ends_with(&loaded.to_string()) || emitted.contains("duplicate field"),
            "{emitted}"
        ),
        (loaded, emitted) => panic!("{loaded:?}, but {emitted:?}: {text}"),
    }
}

/// Changes one value, at most so deep in a document.
fn change(choices: &mut impl Choices, value: &mut Value, depth: u32) {
    match value {
        Value::Object(fields) if depth > 0 && !fields.is_empty() => {
            let at = choices.choose(fields.len() as u32) as usize;
            let name = fields.keys().nth(at).expect("it is one of them").clone();
            match choices.choose(12) {
                10 => drop(fields.remove(&name)),
                11 => drop(fields.insert(format!("{name}_"), Value::from(0))),
                _ => change(choices, &mut fields[&name], depth - 1),
            }
        }
        Value::Array(elements) if depth > 0 && !elements.is_empty() => {
            let at = choices.choose(elements.len() as u32) as usize;
            match choices.choose(12) {
                9 => drop(elements.remove(at)),
                10 => elements.push(elements[at].clone()),
                11 => elements.clear(),
                _ => change(choices, &mut elements[at], depth - 1),
            }
        }
        value => *value = other(choices, value),
    }
}

/// Another value in the place of one.
fn other(choices: &mut impl Choices, value: &Value) -> Value {
    let number = value.as_f64().unwrap_or(1.0);
    match choices.choose(12) {
        0 => Value::from(number + 1.0),
        1 => value.as_i64().map_or(Value::Null, |number| Value::from(number + 1)),
        2 => value.as_i64().map_or(Value::Null, |number| Value::from(number - 1)),
        3 => Value::from(-number),
        4 => Value::from(0),
        5 => Value::from(u32::MAX),
        6 => Value::from(u64::MAX),
        7 => Value::from(1e300),
        8 => Value::from("*/ \u{202e}\"\\\n"),
        9 => Value::from(Vec::<u32>::new()),
        10 => Value::from(0.5),
        _ => Value::Null,
    }
}
