//! `tltlc`: the tools on the command line.

use std::io::{stderr, stdin, stdout};
use std::process::ExitCode;

use tltlc::cli::{self, Output, Streams};

fn main() -> ExitCode {
    let (mut out, mut err) = (stdout().lock(), stderr().lock());
    let mut streams = Streams {
        input: &mut stdin().lock(),
        out: Output { style: cli::style(&out), stream: &mut out },
        err: Output { style: cli::style(&err), stream: &mut err },
    };
    cli::main(std::env::args_os(), &mut streams).into()
}
