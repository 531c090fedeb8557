//! What ends a run from outside: Ctrl-C, and a time limit that a solver does not keep by itself.
//!
//! A run is computed on a thread of its own. The main thread waits for its end, or does not wait any longer: files are whole at
//! any moment, so a run can be left where it is.

use std::io::{self, IsTerminal, Write};
use std::panic;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::Instant;

use crate::cli::failure::Failure;
use crate::discretization::{Discretization, PairDiscretization, StackDiscretization};
use crate::output::discard_unfinished;
use crate::qp::TimeLimit;
use crate::solver::{Candidate, ContactSolver, PreparedSolver, SolverError, SolverOptions};

/// A solver looks at the clock between its steps. What goes on longer than this fraction of the limit
/// is not waited for.
const GRACE: f64 = 0.02;

/// As large as the stack of a main thread usually is.
const STACK: usize = 8 << 20;

/// What has a limit of time: the whole run, and a solve in it.
#[derive(Clone, Copy)]
enum Span {
    Run,
    Solve,
}

/// What the waiting thread hears.
enum Event {
    Folder(PathBuf, &'static str),
    Alarm(Span, Option<Alarm>),
    Interrupt,
    Panic(String),
    End(Result<(), Failure>),
}

/// When not to wait any longer, and what to do then.
struct Alarm {
    at: Instant,
    give_up: GiveUp,
}

type GiveUp = Arc<dyn Fn() -> Failure + Send + Sync>;

impl Alarm {
    /// None when the moment is beyond what the clock can say.
    fn after(limit: TimeLimit, give_up: GiveUp) -> Option<Self> {
        let at = limit.deadline(Instant::now())?.checked_add(limit.duration().mul_f64(GRACE))?;
        Some(Self { at, give_up })
    }
}

/// Tells the waiting thread what to do when the run is ended from outside.
#[derive(Clone)]
pub(crate) struct Watch {
    events: Sender<Event>,
}

impl Watch {
    /// Where the run writes, and what an interrupted one has to say of that.
    pub(crate) fn folder(&self, folder: &Path, says: &'static str) {
        self.tell(Event::Folder(folder.into(), says));
    }

    /// Ends the run by `give_up` when this much time has passed, and a little more, unless the limit is lifted before, or another
    /// one takes its place.
    pub(crate) fn limit(&self, limit: TimeLimit, give_up: impl Fn() -> Failure + Send + Sync + 'static) {
        self.tell(Event::Alarm(Span::Run, Alarm::after(limit, Arc::new(give_up))));
    }

    /// What follows is waited for.
    pub(crate) fn lift(&self) {
        self.tell(Event::Alarm(Span::Run, None));
    }

    /// The solver, whose time limit now holds whatever it does: a run whose solver does not come back ends by `give_up`.
    pub(crate) fn over(
        &self,
        solver: Box<dyn ContactSolver>,
        give_up: impl Fn() -> Failure + Send + Sync + 'static,
    ) -> Box<dyn ContactSolver> {
        Box::new(Watched { solver, watch: self.clone(), give_up: Arc::new(give_up) })
    }

    /// What `solve` returns, if it comes back in time.
    fn in_time<T>(&self, limit: Option<TimeLimit>, give_up: &GiveUp, solve: impl FnOnce() -> T) -> T {
        let alarm = limit.and_then(|limit| Alarm::after(limit, Arc::clone(give_up)));
        self.tell(Event::Alarm(Span::Solve, alarm));
        let result = solve();
        self.tell(Event::Alarm(Span::Solve, None));
        result
    }

    fn tell(&self, event: Event) {
        // Nobody listens any more when the program ends.
        let _ = self.events.send(event);
    }
}

/// A solver with somebody beside it who looks at the clock.
struct Watched {
    solver: Box<dyn ContactSolver>,
    watch: Watch,
    give_up: GiveUp,
}

impl ContactSolver for Watched {
    fn name(&self) -> &str {
        self.solver.name()
    }

    fn solve_pair(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        let Self { solver, watch, give_up } = self;
        watch.in_time(options.time_limit, give_up, || solver.solve_pair(d, options))
    }

    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        let Self { solver, watch, give_up } = self;
        watch.in_time(options.time_limit, give_up, || solver.solve_stack(d, options))
    }

    fn prepare<'s>(&'s mut self, d: &'s Discretization) -> Box<dyn PreparedSolver + 's> {
        let Self { solver, watch, give_up } = self;
        Box::new(WatchedPrepared { solver: solver.prepare(d), watch, give_up })
    }
}

/// Likewise, for one discretization.
struct WatchedPrepared<'s> {
    solver: Box<dyn PreparedSolver + 's>,
    watch: &'s Watch,
    give_up: &'s GiveUp,
}

impl PreparedSolver for WatchedPrepared<'_> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        self.watch.in_time(options.time_limit, self.give_up, || self.solver.solve(options))
    }
}

/// Runs `work` until it ends, is interrupted, or its solver exceeds a limit.
pub(crate) fn watched(
    work: impl FnOnce(&Watch) -> Result<(), Failure> + Send + 'static,
) -> Result<(), Failure> {
    let (events, inbox) = mpsc::channel();
    report_panics(events.clone());
    let interrupts = events.clone();
    // Where no handler can be set, Ctrl-C ends the program as it ends any other.
    let _ = ctrlc::set_handler(move || {
        let _ = interrupts.send(Event::Interrupt);
    });
    let result = follow(work, events, &inbox);
    if result.is_err() {
        clear_progress();
    }
    result
}

/// Starts `work` and follows its events.
fn follow(
    work: impl FnOnce(&Watch) -> Result<(), Failure> + Send + 'static,
    events: Sender<Event>,
    inbox: &Receiver<Event>,
) -> Result<(), Failure> {
    let watch = Watch { events };
    let worker = thread::Builder::new().stack_size(STACK).spawn(move || {
        let result = work(&watch);
        watch.tell(Event::End(result));
    });
    let worker = worker.map_err(|error| Failure::Input(format!("cannot start a thread: {error}")))?;

    let mut folder = None;
    let mut alarms = [None, None];
    let failure = loop {
        let alarm = alarms.iter().flatten().min_by_key(|alarm: &&Alarm| alarm.at);
        match next(inbox, alarm) {
            Some(Event::End(result)) => return result,
            Some(Event::Folder(path, says)) => folder = Some((path, says)),
            Some(Event::Alarm(span, new)) => alarms[span as usize] = new,
            Some(Event::Interrupt) => break interrupted(folder.as_ref()),
            Some(Event::Panic(message)) => {
                // On its way out, the computing thread removes what it was writing.
                let _ = worker.join();
                return Err(Failure::Internal(message));
            }
            None => {
                if let Some(alarm) = alarm {
                    break (alarm.give_up)();
                }
            }
        }
    };
    if let Some((folder, _)) = folder {
        discard_unfinished(&folder);
    }
    Err(failure)
}

/// The next event; `None` when it is time for the alarm.
fn next(inbox: &Receiver<Event>, alarm: Option<&Alarm>) -> Option<Event> {
    let gone = || Event::Panic("the computing thread is gone".into());
    let Some(alarm) = alarm else { return Some(inbox.recv().unwrap_or_else(|_| gone())) };
    match inbox.recv_timeout(alarm.at.saturating_duration_since(Instant::now())) {
        Ok(event) => Some(event),
        Err(RecvTimeoutError::Timeout) => None,
        Err(RecvTimeoutError::Disconnected) => Some(gone()),
    }
}

fn interrupted(folder: Option<&(PathBuf, &str)>) -> Failure {
    Failure::Interrupted(match folder {
        Some((folder, says)) => format!("interrupted: {}: {says}", folder.display()),
        None => "interrupted: nothing was written".into(),
    })
}

/// A panic is an internal error: one line says where, in place of a trace.
fn report_panics(events: Sender<Event>) {
    panic::set_hook(Box::new(move |info| {
        let payload = info.payload();
        let message = payload.downcast_ref().map(String::as_str).or(payload.downcast_ref().copied());
        let message = message.unwrap_or("unknown");
        let place = info.location().map_or_else(String::new, |place| format!(" ({place})"));
        let _ = events.send(Event::Panic(format!("{message}{place}")));
    }));
}

/// The line on the terminal that says what is going on has nobody any more to clear it.
fn clear_progress() {
    let mut out = io::stderr();
    if out.is_terminal() {
        let _ = write!(out, "\r\x1b[2K");
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    use super::*;
    use crate::mesh::{Pattern, rectangle};
    use crate::problem::ContactProblem;
    use crate::solver::ActiveSet;

    /// Follows `work`, to which an interrupt may come.
    fn follow_to(
        work: impl FnOnce(&Watch) -> Result<(), Failure> + Send + 'static,
        interrupt: bool,
    ) -> Result<(), Failure> {
        let (events, inbox) = mpsc::channel();
        if interrupt {
            events.send(Event::Interrupt).expect("somebody listens");
        }
        follow(work, events, &inbox)
    }

    fn limit(seconds: f64) -> TimeLimit {
        TimeLimit::from_seconds(seconds).expect("a limit")
    }

    fn late() -> Failure {
        Failure::NotCertified("late".into())
    }

    fn for_ever() -> Result<(), Failure> {
        thread::sleep(Duration::from_secs(3600));
        Ok(())
    }

    #[test]
    fn what_ends_by_itself_ends_as_it_says() {
        assert_eq!(follow_to(|_| Ok(()), false), Ok(()));
        let failure = Failure::Input("bad".into());
        let same = failure.clone();
        assert_eq!(follow_to(move |_| Err(same), false), Err(failure));
    }

    #[test]
    fn an_interrupted_run_is_not_waited_for() {
        let interrupted = follow_to(|_| for_ever(), true);
        assert_eq!(interrupted, Err(Failure::Interrupted("interrupted: nothing was written".into())));
    }

    #[test]
    fn a_solver_that_does_not_come_back_is_not_waited_for_and_one_that_does_is() {
        let not_back = follow_to(
            |watch| {
                watch.limit(limit(1e-3), late);
                watch.folder(Path::new("somewhere"), "is as it was");
                for_ever()
            },
            false,
        );
        assert_eq!(not_back, Err(late()));
        let lifted = follow_to(
            |watch| {
                watch.limit(limit(3600.0), late);
                watch.limit(limit(1e19), late);
                watch.lift();
                Ok(())
            },
            false,
        );
        assert_eq!(lifted, Ok(()));
    }

    /// Counts how often it is prepared; what it has prepared is the active set method.
    struct Counted(Arc<AtomicUsize>);

    impl ContactSolver for Counted {
        fn name(&self) -> &str {
            "counted"
        }

        fn solve_pair(
            &mut self,
            d: &PairDiscretization,
            options: &SolverOptions,
        ) -> Result<Candidate, SolverError> {
            ActiveSet.solve_pair(d, options)
        }

        fn solve_stack(
            &mut self,
            d: &StackDiscretization,
            options: &SolverOptions,
        ) -> Result<Candidate, SolverError> {
            ActiveSet.solve_stack(d, options)
        }

        fn prepare<'s>(&'s mut self, d: &'s Discretization) -> Box<dyn PreparedSolver + 's> {
            self.0.fetch_add(1, Ordering::Relaxed);
            Box::new(Prepared(d))
        }
    }

    struct Prepared<'d>(&'d Discretization);

    impl PreparedSolver for Prepared<'_> {
        fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
            ActiveSet.solve(self.0, options)
        }
    }

    #[test]
    fn a_solver_with_somebody_beside_it_is_prepared_once_for_all_solves() {
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [4; 2], Pattern::Right).expect("a mesh");
        let problem = ContactProblem::builder().load(-15.0, 10.0).build().expect("a problem");
        let d = Discretization::new(&problem, mesh).expect("a discretization");
        let count = Arc::new(AtomicUsize::new(0));
        let watch = Watch { events: mpsc::channel().0 };
        let mut solver = watch.over(Box::new(Counted(Arc::clone(&count))), late);
        let mut prepared = solver.prepare(&d);
        for _ in 0..3 {
            prepared.solve(&SolverOptions::default()).expect("it runs");
        }
        assert_eq!(count.load(Ordering::Relaxed), 1);
        drop(prepared);
        drop(solver.prepare(&d));
        assert_eq!(count.load(Ordering::Relaxed), 2, "and again each time that it is asked for");
    }

    #[test]
    fn a_thread_that_is_gone_is_noticed() {
        // Without a hook of ours, which tells what has happened.
        let gone = follow_to(|_| panic!("this panic is part of a test"), false);
        assert_eq!(gone, Err(Failure::Internal("the computing thread is gone".into())));
    }
}
