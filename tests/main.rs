//! The tests of the whole line, from source text to verdicts and learned policies.

mod corpus;
mod forms;
mod front;
mod grammar;
mod hoa;
mod language;
mod semantics;
#[rustfmt::skip]
mod static_corpus;
mod static_corpus_source;
