//! The language server: any bytes as its input get answers of the protocol, and of any text whatever
//! is renamed still means the same.

use std::io::{BufRead as _, Read as _};

use serde_json::{Value, json};
use tltl_compiler::check;
use tltl_compiler::parse;
use tltl_compiler::source::Source;
use tltlc::cli::Exit;
use tltlc::names::Names;

use super::tool;

/// Questions about a place.
const QUESTIONS: [&str; 6] =
    ["hover", "completion", "definition", "references", "prepareRename", "formatting"];

/// Runs the target: the first byte chooses whether the others are messages, or a place and a text.
pub fn run(bytes: &[u8]) {
    match bytes {
        [kind, rest @ ..] if kind % 2 == 0 => messages(rest),
        [_, line, character, text @ ..] => {
            if let Ok(text) = std::str::from_utf8(text) {
                file(text, *line, *character);
            }
        }
        _ => {}
    }
}

/// A message of the client, as it is sent.
fn message(message: &Value) -> Vec<u8> {
    let text = json!({"jsonrpc": "2.0"}).as_object().map(|head| {
        let mut whole = head.clone();
        whole.extend(message.as_object().cloned().unwrap_or_default());
        Value::from(whole).to_string()
    });
    let text = text.unwrap_or_default();
    format!("Content-Length: {}\r\n\r\n{text}", text.len()).into_bytes()
}

fn ask(id: usize, method: &str, params: Value) -> Vec<u8> {
    message(&json!({"id": id, "method": method, "params": params}))
}

/// What the server says to these messages.
fn served(input: &[u8]) -> (Exit, Vec<Value>) {
    let (exit, [out, err]) = tool(&["lsp"], input);
    assert!(err.is_empty(), "{err}");
    let (mut rest, mut answers) = (out.as_bytes(), Vec::new());
    while !rest.is_empty() {
        let mut header = String::new();
        rest.read_line(&mut header).expect("it is text");
        let length = header.trim().strip_prefix("Content-Length: ").expect("a header");
        rest.read_line(&mut String::new()).expect("an empty line");
        let mut text = vec![0; length.parse().expect("a length")];
        rest.read_exact(&mut text).expect("as long as it says");
        answers.push(serde_json::from_slice(&text).expect("JSON"));
    }
    (exit, answers)
}

/// Any bytes, behind a beginning as it should be.
fn messages(bytes: &[u8]) {
    let beginning = ask(0, "initialize", json!({}));
    let (_, answers) = served(&[&beginning, bytes].concat());
    assert!(answers[0]["result"].is_object());
    for answer in &answers[1..] {
        let is_answer = answer.get("result").is_some() != answer.get("error").is_some();
        assert!(is_answer != answer["method"].is_string(), "{answer}");
    }
}

/// A text, and all questions about a place in it.
fn file(text: &str, line: u8, character: u8) {
    let uri = "file:///f.tltl";
    let document = json!({"uri": uri, "languageId": "tltl", "version": 1, "text": text});
    let opened = json!({"method": "textDocument/didOpen", "params": {"textDocument": document}});
    let position = json!({"line": line, "character": character});
    let params =
        json!({"textDocument": {"uri": uri}, "position": position, "newName": "renamed_0"});
    let mut input = [ask(0, "initialize", json!({})), message(&opened)].concat();
    for (id, method) in (1..).zip(QUESTIONS) {
        input.extend(ask(id, &format!("textDocument/{method}"), params.clone()));
    }
    input.extend(ask(QUESTIONS.len() + 1, "shutdown", Value::Null));
    input.extend(message(&json!({"method": "exit"})));
    let (exit, answers) = served(&input);
    assert_eq!(exit, Exit::Success);
    for id in 0..QUESTIONS.len() + 2 {
        let answer = answers.iter().find(|answer| answer["id"] == id);
        assert!(answer.is_some_and(|answer| answer.get("result").is_some()), "{id} of {text:?}");
    }
    renamed(text);
}

/// Whatever is renamed in a source without mistakes leaves one without mistakes, of the same tasks.
fn renamed(text: &str) {
    let source = Source::new("file", text);
    let Ok(module) = check::file(&source) else { return };
    let Ok(ast) = parse::file(&source) else { return };
    let names = Names::new(&ast);
    for (id, _) in names.symbols().take(20) {
        let Ok((renamed, _)) = names.renamed(id, "renamed_0") else { continue };
        let again = check::file(&Source::new("file", renamed.as_str()));
        let again = again.unwrap_or_else(|errors| panic!("{text:?} as {renamed:?}: {errors}"));
        let size = |module: &tltl_compiler::predicate::Module| {
            module.tasks.iter().map(|task| task.spec.formulas().count()).collect::<Vec<_>>()
        };
        assert_eq!(size(&again), size(&module), "{text:?} as {renamed:?}");
    }
}
