//! The fuzzer's binary of the target `layout`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::layout::run(bytes));
