//! The fuzzer's binary of the target `policy`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| tltl_fuzz::targets::policy::run(bytes));
