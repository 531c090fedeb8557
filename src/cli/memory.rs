//! How much memory there is.

/// Bytes that can still be had without swapping, where the system tells (Linux).
pub(super) fn available() -> Option<f64> {
    std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| available_in(&text))
}

/// `MemAvailable` of Linux' `/proc/meminfo`, in bytes.
fn available_in(meminfo: &str) -> Option<f64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kibibytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_is_found_and_nothing_else_is_taken_for_it() {
        let text = "MemTotal:       100 kB\nMemAvailable:    24 kB\nBuffers: 1 kB\n";
        assert_eq!(available_in(text), Some(24.0 * 1024.0));
        assert_eq!(available_in("MemTotal: 100 kB\n"), None);
        assert_eq!(available_in("MemAvailable: many kB\n"), None);
    }
}
