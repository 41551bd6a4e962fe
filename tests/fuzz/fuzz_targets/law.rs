#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| sistership_fuzz::fuzzed::law::run(data));
