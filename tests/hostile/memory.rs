//! How much memory a call takes.

use peak_alloc::PeakAlloc;

use super::targets::Target;

/// Counts what is allocated, by all threads.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// The most bytes that `call` holds at once, beyond what is held before.
pub fn peak(call: impl FnOnce()) -> usize {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    call();
    ALLOCATOR.peak_usage().saturating_sub(before)
}

/// Reads an input; how much memory that took, or the complaint that it was more than the length of the input allows.
pub fn run(target: &Target, bytes: &[u8]) -> Result<usize, String> {
    let taken = peak(|| (target.run)(bytes));
    if taken <= target.base + target.factor * bytes.len() {
        Ok(taken)
    } else {
        Err(format!("{}: {taken} bytes for an input of {}", target.name, bytes.len()))
    }
}
