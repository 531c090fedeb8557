//! Long work beside the interpreter: on threads of its own, which call back for all that is Python's, and which Ctrl-C leaves behind.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use membrane_contact::qp::Interrupt;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use thiserror::Error;

/// How often signals are looked at.
const LOOK: Duration = Duration::from_millis(50);

/// Stack of each thread, bytes: as that of the main thread of most systems.
const STACK: usize = 8 << 20;

/// What the work tells the thread that has called us.
enum Message {
    /// Python code to be run.
    Call(Box<dyn FnOnce(Python<'_>) + Send>),
    /// It has ended.
    End,
}

/// The thread that has called us, and waits for work.
pub(crate) struct Caller {
    pool: ThreadPool,
    inbox: Mutex<Receiver<Message>>,
    line: Line,
}

/// The way back to the caller. Clones lead to the same.
#[derive(Clone)]
pub(crate) struct Line {
    outbox: Sender<Message>,
    /// Whether the caller waits no longer.
    is_left: Arc<AtomicBool>,
    /// What the first call that has failed has raised.
    raised: Arc<OnceLock<PyErr>>,
}

/// Python code has raised an exception, or was not called after another had; the caller raises it again.
#[derive(Debug, Error)]
#[error("Python code has raised an exception")]
pub(crate) struct Raised;

impl Line {
    /// Has Python code run by the caller, so that it finds its own thread and is interrupted by signals; waits for the answer. Once an
    /// exception was raised, or nobody waits any longer, nothing is called any more.
    ///
    /// # Errors
    /// [`Raised`].
    pub(crate) fn call<T: Send + 'static>(
        &self,
        code: impl FnOnce(Python<'_>) -> PyResult<T> + Send + 'static,
    ) -> Result<T, Raised> {
        let (answer, answers) = channel();
        let raised = Arc::clone(&self.raised);
        let call = Message::Call(Box::new(move |py| {
            if raised.get().is_some() {
                return;
            }
            match code(py) {
                // Nobody may be waiting any more.
                Ok(value) => answer.send(value).unwrap_or_default(),
                Err(error) => raised.set(error).unwrap_or_default(),
            }
        }));
        self.outbox.send(call).map_err(|_| Raised)?;
        answers.recv().map_err(|_| Raised)
    }

    /// What a solver asks between its steps.
    pub(crate) fn interrupt(&self) -> Interrupt {
        let is_left = Arc::clone(&self.is_left);
        Interrupt::new(move || is_left.load(Ordering::Relaxed))
    }
}

impl Caller {
    /// With threads of its own: those that wait for Python code hold nobody else up, and a process that was forked from another misses none.
    ///
    /// # Errors
    /// `RuntimeError` when no thread can be started.
    pub(crate) fn new() -> PyResult<Self> {
        let pool = ThreadPoolBuilder::new().stack_size(STACK).build();
        let pool = pool.map_err(|error| PyRuntimeError::new_err(format!("cannot start threads: {error}")))?;
        let (outbox, inbox) = channel();
        Ok(Self {
            pool,
            inbox: Mutex::new(inbox),
            line: Line { outbox, is_left: Arc::default(), raised: Arc::default() },
        })
    }

    pub(crate) fn line(&self) -> &Line {
        &self.line
    }

    /// Runs `work` without holding the interpreter, and looks at signals meanwhile, which only the main thread of Python gets. When a
    /// handler raises, as that of Ctrl-C does, the exception is raised at once; the work, which is told, ends by itself.
    ///
    /// # Errors
    /// What Python code has raised meanwhile, whatever the work has made of it.
    pub(crate) fn wait_for<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> PyResult<T> {
        let (result, results) = channel();
        let outbox = self.line.outbox.clone();
        self.pool.spawn(move || {
            // Nobody may be waiting any more.
            let _ = result.send(catch_unwind(AssertUnwindSafe(work)));
            let _ = outbox.send(Message::End);
        });
        let look = || self.inbox.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK);
        loop {
            match py.detach(look) {
                Ok(Message::Call(code)) => code(py),
                Err(RecvTimeoutError::Timeout) => {
                    py.check_signals().inspect_err(|_| self.line.is_left.store(true, Ordering::Relaxed))?;
                }
                Ok(Message::End) | Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        let result = results.recv().expect("it has ended with a result");
        match self.line.raised.get() {
            Some(error) => Err(error.clone_ref(py)),
            None => Ok(result.unwrap_or_else(|panic| resume_unwind(panic))),
        }
    }
}

/// Runs `work` that calls no Python code.
pub(crate) fn wait_for<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    Caller::new()?.wait_for(py, work)
}
