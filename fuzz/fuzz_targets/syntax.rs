//! The fuzzer's binary of the target `syntax`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::syntax::run(bytes));
