//! The fuzzer's binary of the target `editor`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::editor::run(bytes));
