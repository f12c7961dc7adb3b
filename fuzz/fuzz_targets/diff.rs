//! The fuzzer's binary of the target `diff`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::diff::run(bytes));
