//! The fuzzer's binary of the target `hoa`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::hoa::run(bytes));
