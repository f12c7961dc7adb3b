//! The fuzzer's binary of the target `trajectory`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::trajectory::run(bytes));
