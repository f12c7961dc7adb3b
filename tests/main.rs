//! The tests of the whole line, from source text to verdicts and learned policies.

mod batch;
mod bounded;
mod c;
mod columns;
mod corpus;
mod differences;
mod embedded;
mod emitted;
mod evaluate;
mod factored;
mod following;
mod foreign;
mod forms;
mod front;
mod fuzzed;
mod grammar;
mod hoa;
mod hostile;
mod house;
mod language;
mod network;
mod policies;
mod possible;
mod properties;
mod rowwise;
mod semantics;
#[rustfmt::skip]
mod static_corpus;
mod stages;
mod static_corpus_source;
mod straight;
mod surface;
mod tables;
mod tasks;
mod ui;
mod units;

use tltl_fuzz::random;
