//! How much memory there is, and how much a run needs: what would not fit is refused before it is begun.

use crate::cli::case::SolverName;
use crate::cli::failure::Failure;
use crate::text::grouped;

const GIB: f64 = (1u64 << 30) as f64;

/// What a process has that does nothing but draw a picture, bytes; 60 MB on two cores, and each core has stacks of its own.
const BASE: f64 = 120e6;

/// Bytes for each vertex of a mesh: the mesh, the discrete problem, a solution, its bound, its files. The program has 890 at its
/// peak on a million vertices and `auto` (multigrid).
const BYTES_PER_VERTEX: f64 = 900.0;

/// What a factorisation adds for each vertex and doubling of their number, for the active set method; the others have all
/// unknowns of the quadratic program in one matrix.
const ACTIVE_SET: f64 = 15.0;
const QP_SOLVER: f64 = 200.0;

/// Bytes that a run may take.
#[derive(Clone, Copy)]
pub(crate) struct Memory(f64);

impl Memory {
    /// As many GiB as are asked for, else what is there.
    pub(crate) fn new(gibibytes: Option<f64>) -> Self {
        Self(gibibytes.map(|limit| limit * GIB).or_else(available).unwrap_or(f64::INFINITY))
    }

    /// Whether a run on so many vertices has enough.
    pub(crate) fn suffices(self, solver: SolverName, vertices: f64) -> bool {
        needed(solver, vertices) <= self.0
    }

    /// Whether there are so many bytes; if not, the GiB that are needed and that there are.
    pub(super) fn check_bytes(self, needed: f64) -> Result<(), [f64; 2]> {
        if needed <= self.0 { Ok(()) } else { Err([needed, self.0].map(|bytes| bytes / GIB)) }
    }

    /// Refuses a run on so many vertices that has not enough.
    pub(crate) fn check(self, name: &str, solver: SolverName, vertices: f64) -> Result<(), Failure> {
        self.check_stack(name, solver, vertices, 1)
    }

    /// Likewise of a run on a stack: each membrane needs at most what a pair does.
    pub(crate) fn check_stack(
        self,
        name: &str,
        solver: SolverName,
        vertices: f64,
        membranes: usize,
    ) -> Result<(), Failure> {
        let all = vertices * membranes as f64;
        if self.suffices(solver, all) {
            return Ok(());
        }
        let of = if membranes == 1 { String::new() } else { format!(" of {} membranes", grouped(membranes)) };
        let [needed, available] = [needed(solver, all), self.0].map(|bytes| bytes / GIB);
        let other = match solver {
            SolverName::Auto | SolverName::Multigrid => "",
            _ => " or the solver multigrid",
        };
        Err(Failure::Input(format!(
            "{name}: about {} vertices{of} need about {needed:.2} GiB of memory, and {available:.2} are available: take a coarser mesh{other}, or allow more with --memory-limit",
            grouped(vertices.round() as usize)
        )))
    }
}

/// Bytes that a run needs at its peak.
fn needed(solver: SolverName, vertices: f64) -> f64 {
    let doublings = vertices.max(1.0).log2();
    let factorisation = match solver {
        SolverName::Auto | SolverName::Multigrid => 0.0,
        SolverName::ActiveSet => ACTIVE_SET * doublings,
        SolverName::Clarabel | SolverName::Osqp => QP_SOLVER * doublings,
    };
    BASE + (BYTES_PER_VERTEX + factorisation) * vertices
}

/// Bytes that can still be had without swapping, within the limits of this process, where the system tells (Linux).
fn available() -> Option<f64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let group = |name: &str| read(&format!("/sys/fs/cgroup/memory.{name}")).and_then(|text| bytes(&text));
    let system = read("/proc/meminfo").and_then(|text| kibibytes(&text, "MemAvailable:"));
    // What the group has read from files and not used since is given back when it is needed.
    let cache = read("/sys/fs/cgroup/memory.stat").and_then(|text| number_after(&text, "inactive_file "));
    let of_group = group("max").zip(group("current")).map(|(most, used)| most - used + cache.unwrap_or(0.0));
    let of_process = read("/proc/self/limits").and_then(|text| address_space(&text));
    [system, of_group, of_process].into_iter().flatten().reduce(f64::min)
}

/// A line `NAME 24 kB` of Linux' `/proc/meminfo`, in bytes.
fn kibibytes(meminfo: &str, name: &str) -> Option<f64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix(name))?;
    Some(1024.0 * bytes(line.trim().strip_suffix("kB")?)?)
}

/// A line `NAME 24` of the statistics of a control group.
fn number_after(statistics: &str, name: &str) -> Option<f64> {
    statistics.lines().find_map(|line| line.strip_prefix(name)).and_then(bytes)
}

/// A number; `max` is none.
fn bytes(text: &str) -> Option<f64> {
    text.trim().parse().ok()
}

/// The soft limit of the address space (`ulimit -v`) of Linux' `/proc/self/limits`; `unlimited` is none.
fn address_space(limits: &str) -> Option<f64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    bytes(line.split_whitespace().next()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_are_found_and_nothing_else_is_taken_for_them() {
        let text = "MemTotal:       100 kB\nMemAvailable:    24 kB\nBuffers: 1 kB\n";
        assert_eq!(kibibytes(text, "MemAvailable:"), Some(24.0 * 1024.0));
        assert_eq!(kibibytes("MemTotal: 100 kB\n", "MemAvailable:"), None);
        assert_eq!(kibibytes("MemAvailable: many kB\n", "MemAvailable:"), None);
        assert_eq!((bytes("4096\n"), bytes("max\n")), (Some(4096.0), None));
        let statistics = "file 9\ninactive_file 7\n";
        assert_eq!(number_after(statistics, "inactive_file "), Some(7.0));
        assert_eq!(number_after(statistics, "active_file "), None);
        let limits = "Limit   Soft Limit  Hard Limit  Units\nMax cpu time  unlimited  unlimited  seconds\nMax address space  4194304  unlimited  bytes\n";
        assert_eq!(address_space(limits), Some(4_194_304.0));
        assert_eq!(address_space(&limits.replace("4194304", "unlimited")), None);
    }

    #[test]
    fn factorisations_need_more_and_the_more_the_finer_the_mesh() {
        let per_vertex = |solver, vertices: f64| (needed(solver, vertices) - BASE) / vertices;
        assert_eq!(per_vertex(SolverName::Multigrid, 1e4), per_vertex(SolverName::Multigrid, 1e6));
        for [less, more] in
            [[SolverName::Multigrid, SolverName::ActiveSet], [SolverName::ActiveSet, SolverName::Clarabel]]
        {
            assert!(per_vertex(less, 1e6) < per_vertex(more, 1e6));
            assert!(per_vertex(more, 1e5) < per_vertex(more, 1e6));
        }
    }
}
