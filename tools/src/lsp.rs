//! The language server: `tltlc lsp`, which editors start.
//!
//! It speaks the [Language Server Protocol](https://microsoft.github.io/language-server-protocol/)
//! 3.17 over two streams: diagnostics as one types, hover, completion, definition, references,
//! rename, formatting. One thread reads a message, answers it, and reads the next; diagnostics are
//! made when no message waits, so that whoever types fast waits for none of them.
//!
//! All that it says comes from the modules that the command line uses, under the limits of `tltlc
//! check`: whatever the task, there is an answer, or the error that it is too large.
//! Whatever a client sends, it gets an answer that the protocol has; only the end of the input, or
//! `exit`, ends the server.
//!
//! The protocol is written out here, in the module `protocol`, and not taken from a library, of which
//! `lsp-server` and `lsp-types` are the usual ones: they are eight packages, 5.8 CPU seconds in a
//! development build and 8.9 optimized, which everybody who builds the tool or the Python wheel
//! would pay for two hundred lines.

mod document;
mod known;
mod place;
mod protocol;

use std::collections::BTreeMap;
use std::io::{self, BufReader, Read, Write};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use document::Document;
use protocol::{Code, Fault, Message};

/// Answers the messages of a client until it says `exit` or its stream ends. Gives whether it asked
/// for the end as the protocol wants it.
///
/// # Errors
/// If a stream fails.
///
/// ```
/// let asked = [
///     r#"{"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {}}"#,
///     r#"{"jsonrpc": "2.0", "id": 2, "method": "shutdown"}"#,
///     r#"{"jsonrpc": "2.0", "method": "exit"}"#,
/// ];
/// let asked = asked.map(|text| format!("Content-Length: {}\r\n\r\n{text}", text.len())).concat();
/// let mut answers = Vec::new();
/// assert!(tltlc::lsp::serve(&mut asked.as_bytes(), &mut answers)?);
/// assert!(String::from_utf8_lossy(&answers).contains("hoverProvider"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn serve(input: &mut dyn Read, output: &mut dyn Write) -> io::Result<bool> {
    let mut input = BufReader::new(input);
    let mut server = Server { output, documents: BTreeMap::new(), phase: Phase::New };
    while let Some(message) = protocol::read(&mut input)? {
        match message {
            Message::Request { id, method, params } => {
                let answer = server.request(&method, params);
                protocol::answer(server.output, &id, answer)?;
            }
            Message::Notification { method, .. } if method == "exit" => break,
            Message::Notification { method, params } => server.notification(&method, params)?,
            Message::Answer => {}
            Message::Fault(fault) => protocol::answer(server.output, &Value::Null, Err(fault))?,
        }
        if input.buffer().is_empty() {
            server.publish()?;
        }
    }
    Ok(server.phase == Phase::Ended)
}

/// How far a session is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Phase {
    New,
    Running,
    Ended,
}

struct Server<'a> {
    output: &'a mut dyn Write,
    /// The open documents by their addresses.
    documents: BTreeMap<String, Document>,
    phase: Phase,
}

/// The parameters of a request about a place.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct At {
    text_document: Identifier,
    position: place::Position,
    /// Of `rename` alone.
    #[serde(default)]
    new_name: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Of {
    text_document: Identifier,
}

#[derive(Deserialize)]
struct Identifier {
    uri: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Opened {
    text_document: Item,
}

#[derive(Deserialize)]
struct Item {
    uri: String,
    text: String,
    #[serde(default)]
    version: Value,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Changed {
    text_document: Versioned,
    content_changes: Vec<Change>,
}

#[derive(Deserialize)]
struct Versioned {
    uri: String,
    #[serde(default)]
    version: Value,
}

#[derive(Deserialize)]
struct Change {
    text: String,
}

impl Server<'_> {
    fn request(&mut self, method: &str, params: Value) -> Result<Value, Fault> {
        match (self.phase, method) {
            (Phase::New, "initialize") => {
                self.phase = Phase::Running;
                return Ok(abilities());
            }
            (Phase::New, _) => return Err(Fault::new(Code::NotInitialized, "not initialized")),
            (Phase::Ended, _) => return Err(Fault::new(Code::InvalidRequest, "shut down")),
            (Phase::Running, "initialize") => {
                return Err(Fault::new(Code::InvalidRequest, "initialized already"));
            }
            (Phase::Running, _) => {}
        }
        match method {
            "shutdown" => {
                self.phase = Phase::Ended;
                Ok(Value::Null)
            }
            "textDocument/hover" => self.at(params, |document, at, _| document.hover(at)),
            "textDocument/completion" => self.at(params, |document, at, _| document.completion(at)),
            "textDocument/definition" => {
                self.at(params, |document, at, uri| document.definition(at, uri))
            }
            "textDocument/references" => {
                self.at(params, |document, at, uri| document.references(at, uri))
            }
            "textDocument/prepareRename" => self.at(params, |document, at, _| document.name(at)),
            "textDocument/rename" => {
                let At { text_document: Identifier { uri }, position, new_name } = read(params)?;
                let Some(document) = self.documents.get_mut(&uri) else { return Ok(Value::Null) };
                let at = document.byte(position);
                let renamed = document.rename(at, &new_name, &uri);
                renamed.map_err(|refused| Fault::new(Code::RequestFailed, &refused))
            }
            "textDocument/formatting" => {
                let Of { text_document: Identifier { uri } } = read(params)?;
                Ok(self.documents.get(&uri).map_or(Value::Null, Document::laid_out))
            }
            _ => {
                let message = format!("`{method}` is not supported");
                Err(Fault::new(Code::MethodNotFound, &message))
            }
        }
    }

    /// Answers a request about a place of a document; nothing of one that is not open.
    fn at(
        &mut self,
        params: Value,
        answer: impl FnOnce(&mut Document, usize, &str) -> Value,
    ) -> Result<Value, Fault> {
        let At { text_document: Identifier { uri }, position, .. } = read(params)?;
        let Some(document) = self.documents.get_mut(&uri) else { return Ok(Value::Null) };
        let at = document.byte(position);
        Ok(answer(document, at, &uri))
    }

    /// Takes a notification in. One that cannot be read, or that nobody knows, has no answer.
    fn notification(&mut self, method: &str, params: Value) -> io::Result<()> {
        if self.phase != Phase::Running {
            return Ok(());
        }
        match method {
            "textDocument/didOpen" => {
                if let Ok(Opened { text_document: Item { uri, text, version } }) = read(params) {
                    let document = Document::new(&uri, text, version);
                    self.documents.insert(uri, document);
                }
            }
            "textDocument/didChange" => {
                if let Ok(Changed { text_document, content_changes }) = read::<Changed>(params)
                    && let Versioned { uri, version } = text_document
                    && self.documents.contains_key(&uri)
                    && let Some(Change { text }) = content_changes.into_iter().next_back()
                {
                    let document = Document::new(&uri, text, version);
                    self.documents.insert(uri, document);
                }
            }
            "textDocument/didClose" => {
                if let Ok(Of { text_document: Identifier { uri } }) = read(params)
                    && self.documents.remove(&uri).is_some()
                {
                    let nothing = json!({"uri": uri, "diagnostics": []});
                    protocol::notify(self.output, "textDocument/publishDiagnostics", &nothing)?;
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Sends the diagnostics of the documents that have changed.
    fn publish(&mut self) -> io::Result<()> {
        for (uri, document) in &mut self.documents {
            if let Some(diagnostics) = document.news(uri) {
                protocol::notify(self.output, "textDocument/publishDiagnostics", &diagnostics)?;
            }
        }
        Ok(())
    }
}

/// What the server can do. Positions count UTF-16 units, as every client knows them.
fn abilities() -> Value {
    json!({
        "capabilities": {
            "positionEncoding": "utf-16",
            "textDocumentSync": {"openClose": true, "change": 1},
            "hoverProvider": true,
            "completionProvider": {"triggerCharacters": [".", ":"]},
            "definitionProvider": true,
            "referencesProvider": true,
            "renameProvider": {"prepareProvider": true},
            "documentFormattingProvider": true,
        },
        "serverInfo": {"name": "tltlc", "version": env!("CARGO_PKG_VERSION")},
    })
}

/// Parameters as they must be.
fn read<T: DeserializeOwned>(params: Value) -> Result<T, Fault> {
    serde_json::from_value(params)
        .map_err(|error| Fault::new(Code::InvalidParams, &error.to_string()))
}
