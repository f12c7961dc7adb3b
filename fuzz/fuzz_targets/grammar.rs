//! The fuzzer's binary of the target `grammar`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::grammar::run(bytes));
