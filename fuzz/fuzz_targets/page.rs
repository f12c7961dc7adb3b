//! The fuzzer's binary of the target `page`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::page::run(bytes));
