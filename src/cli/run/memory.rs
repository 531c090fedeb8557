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

/// What the norms of the error of a pair add for each vertex: that of `H^-1` lifts to a mesh with twelve times as many vertices.
/// Measured: 11,100 to 11,300 bytes in all, on 200,000 to 260,000 vertices. Those of a stack have no such lift.
const PAIR_NORMS: f64 = 10_600.0;

/// What a run needs memory for, on a mesh.
#[derive(Clone, Copy)]
pub(crate) struct Work {
    pub(crate) solver: SolverName,
    /// Each needs at most what a pair does; 1 for that.
    pub(crate) membranes: usize,
    /// Whether the error of a pair is measured in all norms.
    pub(crate) pair_norms: bool,
}

impl Work {
    /// A solution of a pair, its bound and its files.
    pub(crate) fn solving(solver: SolverName) -> Self {
        Self { solver, membranes: 1, pair_norms: false }
    }

    /// Bytes at the peak of the run.
    fn needed(self, vertices: f64) -> f64 {
        let doublings = vertices.max(1.0).log2();
        let factorisation = match self.solver {
            SolverName::Auto | SolverName::Multigrid => 0.0,
            SolverName::ActiveSet => ACTIVE_SET * doublings,
            SolverName::Clarabel | SolverName::Osqp => QP_SOLVER * doublings,
        };
        let norms = if self.pair_norms { PAIR_NORMS } else { 0.0 };
        BASE + (BYTES_PER_VERTEX + factorisation + norms) * self.membranes as f64 * vertices
    }
}

/// Bytes that a run may take.
#[derive(Clone, Copy)]
pub(crate) struct Memory(f64);

impl Memory {
    /// As many GiB as are asked for, else what is there.
    pub(crate) fn new(gibibytes: Option<f64>) -> Self {
        Self(gibibytes.map(|limit| limit * GIB).or_else(available).unwrap_or(f64::INFINITY))
    }

    /// Whether that is enough for a run on so many vertices.
    pub(crate) fn suffices(self, work: Work, vertices: f64) -> bool {
        work.needed(vertices) <= self.0
    }

    /// Whether there are so many bytes; if not, the GiB that are needed and that there are.
    pub(super) fn check_bytes(self, needed: f64) -> Result<(), [f64; 2]> {
        if needed <= self.0 { Ok(()) } else { Err([needed, self.0].map(|bytes| bytes / GIB)) }
    }

    /// Refuses a run on so many vertices that has not enough.
    pub(crate) fn check(self, name: &str, work: Work, vertices: f64) -> Result<(), Failure> {
        if self.suffices(work, vertices) {
            return Ok(());
        }
        let of = match work.membranes {
            1 => String::new(),
            membranes => format!(" of {} membranes", grouped(membranes)),
        };
        let [needed, available] = [work.needed(vertices), self.0].map(|bytes| bytes / GIB);
        let other = match work.solver {
            SolverName::Auto | SolverName::Multigrid => "",
            _ => " or the solver multigrid",
        };
        let vertices = grouped(vertices.round() as usize);
        Err(Failure::Input(format!(
            "{name}: about {vertices} vertices{of} need about {needed:.2} GiB of memory, and {available:.2} are available: take a coarser mesh{other}, or allow more with --memory-limit"
        )))
    }
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
        let per_vertex = |solver, vertices: f64| (Work::solving(solver).needed(vertices) - BASE) / vertices;
        assert_eq!(per_vertex(SolverName::Multigrid, 1e4), per_vertex(SolverName::Multigrid, 1e6));
        for [less, more] in
            [[SolverName::Multigrid, SolverName::ActiveSet], [SolverName::ActiveSet, SolverName::Clarabel]]
        {
            assert!(per_vertex(less, 1e6) < per_vertex(more, 1e6));
            assert!(per_vertex(more, 1e5) < per_vertex(more, 1e6));
        }
    }

    #[test]
    fn each_membrane_needs_as_much_and_norms_more() {
        let one = Work::solving(SolverName::Multigrid);
        let per_vertex = |work: Work| (work.needed(1e6) - BASE) / 1e6;
        assert_eq!(per_vertex(Work { membranes: 3, ..one }), 3.0 * BYTES_PER_VERTEX);
        assert_eq!(per_vertex(Work { pair_norms: true, ..one }), BYTES_PER_VERTEX + PAIR_NORMS);
        let memory = Memory(BASE + 1.5e6 * BYTES_PER_VERTEX);
        assert!(memory.suffices(one, 1e6) && !memory.suffices(Work { pair_norms: true, ..one }, 1e6));
    }
}
