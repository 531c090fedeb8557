//! What the fuzzers share with the regression test.

#[path = "../../tests/hostile/memory.rs"]
pub mod memory;
#[path = "../../tests/hostile/targets.rs"]
pub mod targets;

/// A fuzzer of one of the [`targets`], within its bound of memory.
#[macro_export]
macro_rules! fuzzer {
    ($name:literal) => {
        libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
            $crate::memory::run($crate::targets::target($name), bytes).expect("it keeps within its memory");
        });
    };
}
