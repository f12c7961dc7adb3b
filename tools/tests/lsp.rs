//! The language server as editors meet it: a client that talks to the process.
//!
//! `lsp/cases.txt` holds files, questions and the answers. A case is `== name`, the text of a file
//! in which `¦` marks the cursor, and questions `-- method` (`-- rename NAME`); behind each of them
//! stands the answer, written by this test with `UPDATE_LSP=1`.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

struct Client {
    server: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    asked: u64,
}

impl Client {
    fn start() -> Self {
        let mut server = Command::new(env!("CARGO_BIN_EXE_tltlc"))
            .args(["lsp", "--stdio"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (input, output) = (server.stdin.take(), BufReader::new(server.stdout.take().unwrap()));
        Self { server, input, output, asked: 0 }
    }

    fn ready() -> Self {
        let mut client = Self::start();
        let abilities = client.ask("initialize", json!({"capabilities": {}, "processId": null}));
        assert_eq!(abilities["result"]["capabilities"]["hoverProvider"], true);
        client.tell("initialized", json!({}));
        client
    }

    fn raw(&mut self, bytes: &[u8]) {
        self.input.as_mut().unwrap().write_all(bytes).unwrap();
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.raw(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// Asks, and passes over what comes before the answer.
    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        let id = self.asked;
        self.send(&json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}));
        loop {
            let message = self.next();
            if message["id"] == id {
                return message;
            }
        }
    }

    fn next(&mut self) -> Value {
        let mut header = String::new();
        self.output.read_line(&mut header).unwrap();
        let length = header.trim().strip_prefix("Content-Length: ").expect(&header);
        self.output.read_line(&mut String::new()).unwrap();
        let mut bytes = vec![0; length.parse().unwrap()];
        self.output.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    /// Opens a file, and gives its diagnostics.
    fn open(&mut self, uri: &str, text: &str) -> Value {
        let document = json!({"uri": uri, "languageId": "tltl", "version": 1, "text": text});
        self.tell("textDocument/didOpen", json!({"textDocument": document}));
        self.next()["params"]["diagnostics"].take()
    }

    fn end(mut self) -> Option<i32> {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        self.server.wait().unwrap().code()
    }
}

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp/cases.txt")
}

#[test]
fn every_question_has_its_answer() {
    let cases = std::fs::read_to_string(file()).unwrap();
    let mut client = Client::ready();
    let mut shown = String::new();
    for case in cases.strip_prefix("== ").unwrap().split("\n\n== ") {
        shown.push_str(&answered(&mut client, case));
    }
    assert_eq!(client.end(), Some(0));
    if std::env::var_os("UPDATE_LSP").is_some() {
        std::fs::write(file(), &shown).unwrap();
    }
    for (line, (expected, found)) in (1..).zip(cases.lines().zip(shown.lines())) {
        assert_eq!(found, expected, "cases.txt, line {line}");
    }
    assert!(shown == cases, "run this test with UPDATE_LSP=1 and read what changed");
}

/// Asks the questions of a case, and writes it anew.
fn answered(client: &mut Client, case: &str) -> String {
    let (name, rest) = case.split_once('\n').unwrap();
    let mut parts = rest.trim_end().split("\n-- ");
    let marked = parts.next().unwrap();
    let mark = marked.find('¦').unwrap_or(0);
    let text = marked.replace('¦', "");
    // As the protocol defines it, written another way than in the server.
    let before = &text[..mark];
    let line = before.matches('\n').count();
    let character = before.rsplit('\n').next().unwrap().encode_utf16().count();
    let uri = format!("file:///{}.tltl", name.replace(' ', "_"));
    let diagnostics = client.open(&uri, &text);
    let mut shown = format!("== {name}\n{marked}\n");
    for question in parts {
        let question = question.lines().next().unwrap();
        let (method, argument) = question.split_once(' ').unwrap_or((question, ""));
        let params = json!({
            "textDocument": {"uri": uri},
            "position": {"line": line, "character": character},
            "newName": argument,
            "context": {"includeDeclaration": true},
            "options": {"tabSize": 4, "insertSpaces": true},
        });
        let lines = match method {
            "diagnostics" => diagnostics.as_array().unwrap().iter().map(told).collect(),
            _ => {
                let answer = client.ask(&format!("textDocument/{method}"), params);
                lines(&answer)
            }
        };
        shown.push_str(&format!("-- {question}\n"));
        lines
            .iter()
            .for_each(|line| shown.push_str(&format!("{}\n", format!("  {line}").trim_end())));
    }
    client.tell("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
    assert_eq!(client.next()["params"]["diagnostics"], json!([]), "{name}");
    shown + "\n"
}

fn span(range: &Value) -> String {
    let place = |end: &str| format!("{}:{}", range[end]["line"], range[end]["character"]);
    format!("{}-{}", place("start"), place("end"))
}

fn told(diagnostic: &Value) -> String {
    let related = diagnostic["relatedInformation"].as_array().unwrap().iter();
    let related =
        related.map(|one| format!("; {} {}", span(&one["location"]["range"]), one["message"]));
    format!(
        "{} {} {} {}{}",
        span(&diagnostic["range"]),
        diagnostic["severity"],
        diagnostic["code"],
        diagnostic["message"],
        related.collect::<String>()
    )
}

/// An answer as a reader of the cases wants it.
fn lines(answer: &Value) -> Vec<String> {
    if let Some(error) = answer.get("error") {
        return vec![format!("error {}: {}", error["code"], error["message"])];
    }
    let result = &answer["result"];
    if let Some(text) = result["contents"]["value"].as_str() {
        let first = span(&result["range"]);
        return std::iter::once(first).chain(text.lines().map(str::to_owned)).collect();
    }
    if let Some(items) = result["items"].as_array() {
        let own = items.iter().filter(|item| item.get("detail").is_some());
        let own = own.map(|item| {
            assert!(item["sortText"].as_str().is_some_and(|text| text < "A"), "{item}");
            format!("{} {} {}", item["kind"], item["label"], item["detail"])
        });
        let words = items.iter().filter(|item| item.get("detail").is_none());
        let words: Vec<_> = words.map(|item| item["label"].as_str().unwrap()).collect();
        return own.chain([words.join(" ")]).filter(|line| !line.is_empty()).collect();
    }
    let edits = result["changes"].as_object().and_then(|changes| changes.values().next());
    match edits.unwrap_or(result) {
        Value::Array(all) => all
            .iter()
            .map(|one| match one.get("newText") {
                Some(text) => format!("{} {text}", span(&one["range"])),
                None => span(&one["range"]),
            })
            .collect(),
        Value::Null => vec!["null".to_owned()],
        range => vec![span(range)],
    }
}

#[test]
fn a_change_has_its_diagnostics() {
    let mut client = Client::ready();
    let uri = "file:///c.tltl";
    assert_eq!(client.open(uri, "task t = F"), client.open(uri, "task t = F"));
    // Of two changes the last one counts; a client may send both before it reads.
    for (version, text) in
        [(2, "state S { a: bool }\ntask t = F b"), (3, "state S { a: bool }\ntask t = F a")]
    {
        let document = json!({"uri": uri, "version": version});
        let changes = json!([{"text": "task"}, {"text": text}]);
        let params = json!({"textDocument": document, "contentChanges": changes});
        client.tell("textDocument/didChange", params);
    }
    let mut told = std::iter::repeat_with(|| client.next()["params"].take());
    let last = told.find(|params| params["version"] == 3).unwrap();
    assert_eq!(last["diagnostics"], json!([]));
    assert_eq!(client.end(), Some(0));
}

/// Messages that no decent client sends, and the code of the error that each gets; 0 for none.
const HOSTILE: [(&str, i32); 16] = [
    (r#"{"#, -32700),
    (r#"[]"#, -32600),
    (r#"null"#, -32600),
    (r#"{"id": 1}"#, -32600),
    (r#"{"id": {}, "method": 3}"#, -32600),
    (r#"{"id": 7, "method": "textDocument/hover"}"#, -32602),
    (r#"{"id": 7, "method": "textDocument/hover", "params": [1]}"#, -32602),
    (
        r#"{"id": 7, "method": "textDocument/hover", "params": {"textDocument": {"uri": "x"}, "position": {"line": -1, "character": 0}}}"#,
        -32602,
    ),
    (r#"{"id": 7, "method": "textDocument/formatting", "params": {"textDocument": 4}}"#, -32602),
    (r#"{"id": "a", "method": "workspace/executeCommand", "params": {}}"#, -32601),
    (r#"{"id": 8, "method": "initialize", "params": {}}"#, -32600),
    (r#"{"id": 8, "method": ""}"#, -32601),
    (r#"{"id": 9, "result": 4}"#, 0),
    (r#"{"method": "textDocument/didOpen", "params": {"textDocument": {"uri": 3}}}"#, 0),
    (
        r#"{"method": "textDocument/didChange", "params": {"textDocument": {"uri": "file:///none"}, "contentChanges": [{"text": ""}]}}"#,
        0,
    ),
    (r#"{"method": "$/cancelRequest", "params": {"id": 4}}"#, 0),
];

#[test]
fn a_hostile_client_kills_nothing() {
    let mut client = Client::start();
    assert_eq!(client.ask("textDocument/hover", json!({}))["error"]["code"], -32002);
    drop(client);
    let mut client = Client::ready();
    for (text, code) in HOSTILE {
        client.raw(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
        if code != 0 {
            assert_eq!(client.next()["error"]["code"], code, "{text}");
        }
    }
    client.raw(b"no header\r\nContent-Type: x\r\n\r\nContent-Length: many\r\n\r\n");
    client.raw("x".repeat(10_000).as_bytes());
    client.raw(b"\r\ncontent-length:4\r\nX: 1\r\n\r\n\xff\xff\xff\xff");
    assert_eq!(client.next()["error"]["code"], -32700);
    // Places outside of the text, and within a character.
    let text = "state S { ◇: bool }\r\n//𝄞\ntask t = F 𝄞\r";
    client.open("file:///odd.tltl", text);
    for line in [0, 1, 2, 3, u32::MAX] {
        for character in [0, 1, 2, 3, 10, 11, 12, 13, 99, u32::MAX] {
            for method in
                ["hover", "completion", "definition", "references", "prepareRename", "rename"]
            {
                let position = json!({"line": line, "character": character});
                let document = json!({"uri": "file:///odd.tltl"});
                let params =
                    json!({"textDocument": document, "position": position, "newName": "◇"});
                client.ask(&format!("textDocument/{method}"), params);
            }
        }
    }
    for text in [
        "(".repeat(100_000),
        "task t = ".to_owned() + &"for all a in {b, c}: ".repeat(20_000) + "F a",
        "task t = ".to_owned() + &"F a && ".repeat(100_000) + "b",
        "state S { a: bool }\ntask t = F[0,9999999] a\n".to_owned(),
        "state S { a: bool }\n".to_owned() + &"task t = F a\n".repeat(20_000),
        "a".repeat(3 << 20),
    ] {
        assert_ne!(client.open("file:///huge.tltl", &text), json!([]));
        let position = json!({"line": 0, "character": 40});
        let params = json!({"textDocument": {"uri": "file:///huge.tltl"}, "position": position});
        for method in ["hover", "completion", "references", "formatting"] {
            client.ask(&format!("textDocument/{method}"), params.clone());
        }
    }
    assert_eq!(client.ask("textDocument/nothing", Value::Null)["error"]["code"], -32601);
    assert_eq!(client.end(), Some(0));
    // A stream that ends without a word.
    let mut client = Client::ready();
    client.raw(b"Content-Length: 99\r\n\r\n{");
    drop(client.input.take());
    assert_eq!(client.server.wait().unwrap().code(), Some(1));
}

/// The session of `lsp/nvim.lua` in a real editor. Where there is no `nvim`, nothing is tested and
/// the test says so.
#[test]
fn an_editor_understands_the_server() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp");
    let ran = Command::new("nvim")
        .args(["--headless", "-u", "NONE", "-i", "NONE", "-n", "-R", "-c", "luafile nvim.lua"])
        .arg("dock.tltl")
        .env("TLTLC", env!("CARGO_BIN_EXE_tltlc"))
        .current_dir(&folder)
        .stdin(Stdio::null())
        .output();
    let Ok(output) = ran else {
        eprintln!("skipped: there is no nvim, so no editor talks to the server");
        return;
    };
    let shown = String::from_utf8(output.stdout).unwrap();
    let transcript = folder.join("nvim.txt");
    if std::env::var_os("UPDATE_LSP").is_some() {
        std::fs::write(&transcript, &shown).unwrap();
    }
    assert_eq!(shown, std::fs::read_to_string(transcript).unwrap());
}
