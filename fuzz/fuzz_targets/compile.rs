//! The fuzzer's binary of the target `compile`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::compile::run(bytes));
