//! Saved policies through both doors: what the library loads, the tool turns into Rust that compiles;
//! what the library refuses, the tool refuses for the same reason.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::de::DeserializeOwned;
use serde_json::Value;
use tltl::network::policy::NetworkPolicy;
use tltl::policy::Policy;
use tltlc::emit::policy::rust;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/policies")
}

/// Whether rustc takes `source` for a library, and what it says if not.
fn compiled(name: &str, source: &str) -> Result<(), String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("policies");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(name), source).unwrap();
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let arguments = ["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", name];
    let run = Command::new(rustc).args(arguments).current_dir(folder).output().unwrap();
    if run.status.success() { Ok(()) } else { Err(String::from_utf8(run.stderr).unwrap()) }
}

/// Each row names a file, says why it is there and, if it is no policy, words of the reason.
#[test]
fn the_tool_and_the_library_have_one_schema() {
    let rows = std::fs::read_to_string(folder().join("cases.jsonl")).unwrap();
    for line in rows.lines() {
        let row: Value = serde_json::from_str(line).unwrap();
        let file = row["file"].as_str().unwrap();
        let text = std::fs::read_to_string(folder().join(file)).unwrap();
        let (loaded, emitted) = (serde_json::from_str::<Policy>(&text), rust(&text));
        match row["reason"].as_array() {
            None => {
                loaded.unwrap_or_else(|error| panic!("{file}: {error}"));
                let source = emitted.unwrap_or_else(|error| panic!("{file}: {error}"));
                let name = Path::new(file).with_extension("rs");
                compiled(name.to_str().unwrap(), &source).unwrap_or_else(|error| panic!("{error}"));
            }
            Some(words) => {
                let reason = loaded.unwrap_err().to_string();
                assert_eq!(emitted.unwrap_err(), reason, "{file}");
                for word in words {
                    assert!(reason.contains(word.as_str().unwrap()), "{file}: {reason}");
                }
            }
        }
    }
}

/// `value` as text in every way in which one of its objects, at any depth, has one field more.
fn widened(value: &Value, more: &dyn Fn(&str, &Value) -> String) -> Vec<String> {
    let mut all = Vec::new();
    match value {
        Value::Object(fields) => {
            for (name, inner) in fields {
                let others = fields.iter().filter(|(other, _)| *other != name);
                let others: String =
                    others.map(|(name, value)| format!("{name:?}: {value}, ")).collect();
                all.push(format!("{{{others}{name:?}: {inner}, {}}}", more(name, inner)));
                let inner = widened(inner, more).into_iter();
                all.extend(inner.map(|inner| format!("{{{others}{name:?}: {inner}}}")));
            }
        }
        Value::Array(elements) => {
            for (at, element) in elements.iter().enumerate() {
                let mut texts: Vec<String> = elements.iter().map(Value::to_string).collect();
                for wide in widened(element, more) {
                    texts[at] = wide;
                    all.push(format!("[{}]", texts.join(", ")));
                }
            }
        }
        _ => {}
    }
    all
}

/// Neither door takes `text` with a field more, at any depth.
fn closed<P: DeserializeOwned>(text: &str) {
    let refused = |text: &str| serde_json::from_str::<P>(text).err();
    assert!(refused(text).is_none() && rust(text).is_ok());
    let value: Value = serde_json::from_str(text).unwrap();
    let twice = widened(&value, &|name, inner| format!("{name:?}: {inner}"));
    let unknown = widened(&value, &|_, _| "\"colour\": 0".to_owned());
    assert!(twice.len() == unknown.len() && twice.len() > 30);
    for broken in twice.iter().chain(&unknown) {
        let reason = refused(broken).unwrap_or_else(|| panic!("{broken}")).to_string();
        assert!(rust(broken).unwrap_err().ends_with(&reason), "{broken}");
    }
}

#[test]
fn no_field_stands_twice_or_unknown_at_any_depth() {
    closed::<Policy>(&std::fs::read_to_string(folder().join("full.json")).unwrap());
    closed::<NetworkPolicy>(include_str!("data/network_policy.json"));
}
