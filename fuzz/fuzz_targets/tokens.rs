//! The fuzzer's binary of the target `tokens`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::tokens::run(bytes));
