//! The messages of the protocol: JSON-RPC 2.0, each after a header with its length.

use std::io::{self, BufRead, Read as _, Write};

use serde_json::{Value, json};

use crate::emit::json::line;

/// The longest message that is read. A longer one is skipped, and refused.
const MOST_BYTES: u64 = 1 << 26;

/// The longest line of a header. What is longer is no header.
const MOST_HEADER: u64 = 1 << 12;

/// A message of the client.
pub(super) enum Message {
    /// One that wants an answer.
    Request { id: Value, method: String, params: Value },
    /// One that wants none.
    Notification { method: String, params: Value },
    /// An answer to a question; the server asks none.
    Answer,
    /// Something else.
    Fault(Fault),
}

/// Why a message cannot be answered as it asks.
pub(super) struct Fault {
    code: Code,
    message: String,
}

/// The codes of JSON-RPC and of the protocol.
#[derive(Clone, Copy)]
pub(super) enum Code {
    Parse = -32700,
    InvalidRequest = -32600,
    MethodNotFound = -32601,
    InvalidParams = -32602,
    NotInitialized = -32002,
    RequestFailed = -32803,
}

impl Fault {
    pub(super) fn new(code: Code, message: &str) -> Self {
        Self { code, message: message.to_owned() }
    }
}

/// The next message; `None` at the end of the stream.
pub(super) fn read(input: &mut impl BufRead) -> io::Result<Option<Message>> {
    let Some(length) = length(input)? else { return Ok(None) };
    let mut bytes = Vec::new();
    let read = input.by_ref().take(length.min(MOST_BYTES)).read_to_end(&mut bytes)? as u64;
    if length > MOST_BYTES {
        io::copy(&mut input.take(length - read), &mut io::sink())?;
        let message = format!("a message has at most {MOST_BYTES} bytes");
        return Ok(Some(Message::Fault(Fault::new(Code::InvalidRequest, &message))));
    }
    if read < length {
        return Ok(None);
    }
    Ok(Some(match serde_json::from_slice(&bytes) {
        Ok(value) => message(value),
        Err(error) => Message::Fault(Fault::new(Code::Parse, &error.to_string())),
    }))
}

/// The length that the next header gives; `None` at the end of the stream. Lines that are no header
/// are passed over.
fn length(input: &mut impl BufRead) -> io::Result<Option<u64>> {
    let mut length = None;
    loop {
        let mut bytes = Vec::new();
        if input.by_ref().take(MOST_HEADER).read_until(b'\n', &mut bytes)? == 0 {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&bytes);
        let text = text.trim();
        match text.split_once(':') {
            Some((name, value)) if name.trim().eq_ignore_ascii_case("content-length") => {
                length = value.trim().parse().ok();
            }
            _ if text.is_empty() && length.is_some() => return Ok(length),
            _ => {}
        }
    }
}

/// The message that a value is.
fn message(mut value: Value) -> Message {
    let params = value.get_mut("params").map(Value::take).unwrap_or_default();
    let method = value.get("method").and_then(Value::as_str).map(str::to_owned);
    let id = value.get("id").filter(|id| id.is_string() || id.is_number()).cloned();
    match (method, id) {
        (Some(method), Some(id)) => Message::Request { id, method, params },
        (Some(method), None) => Message::Notification { method, params },
        (None, Some(_)) if value.get("result").or(value.get("error")).is_some() => Message::Answer,
        _ => Message::Fault(Fault::new(Code::InvalidRequest, "not a message of JSON-RPC 2.0")),
    }
}

/// Answers a request.
pub(super) fn answer(
    output: &mut dyn Write,
    id: &Value,
    answer: Result<Value, Fault>,
) -> io::Result<()> {
    send(
        output,
        &match answer {
            Ok(result) => json!({"jsonrpc": "2.0", "id": id, "result": result}),
            Err(Fault { code, message }) => {
                let error = json!({"code": code as i32, "message": message});
                json!({"jsonrpc": "2.0", "id": id, "error": error})
            }
        },
    )
}

/// Tells the client something.
pub(super) fn notify(output: &mut dyn Write, method: &str, params: &Value) -> io::Result<()> {
    send(output, &json!({"jsonrpc": "2.0", "method": method, "params": params}))
}

fn send(output: &mut dyn Write, message: &Value) -> io::Result<()> {
    let text = line(message);
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}
