//! Fuzz targets: each a function of bytes that panics if the line from text to verdict breaks its
//! word on them.
//!
//! The functions stand in a library, so that the fuzzer's binaries (feature `libfuzzer`) and the
//! test that replays the committed corpora run the same code. A target is one of two kinds: it takes
//! the bytes as text, where the question is whether any text gets an answer; or it takes them as
//! choices ([`random`], [`written`]), where text would mostly be refused and the question is whether
//! the answer is right.
//!
//! Nothing depends on this package but the tests. Two files of the macro's crate are taken in, since
//! a crate of procedural macros exports nothing else.
//!
//! ```
//! // Any text gets an answer as a formula, as a file and inside the macro.
//! tltl_fuzz::targets::grammar::run(b"F a && !b U");
//! ```

#[allow(dead_code, reason = "files are included by the macro only")]
#[path = "../../macros/src/expand.rs"]
mod expand;
#[path = "../../macros/src/tokens.rs"]
mod tokens;

pub mod random;
pub mod targets;
pub mod written;
