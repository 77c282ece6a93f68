//! Two threads that run a scanner or a server: one thread for sockets and one thread for timing.
//!
//! The exchange of images does not depend on the rest of the program. For example, a prompt that waits for input must
//! not stop a robot. The timing has its own thread, because tokio timers have a resolution of 1 ms. A parked thread
//! wakes within 0.1 ms.

use std::future::Future;
use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle, Thread};
use std::time::{Duration, Instant};

use tokio::runtime::{Builder, Handle, Runtime};
use tokio::sync::oneshot;

use super::Now;

/// Handle that wakes the timing thread earlier than planned.
#[derive(Debug, Default)]
pub(super) struct Alarm {
    /// Planned wake-up time in nanoseconds. While the thread runs, this is the maximum value, so that every alarm wakes
    /// the thread.
    planned: AtomicU64,
    thread: OnceLock<Thread>,
    is_over: AtomicBool,
}

impl Alarm {
    /// Wakes the thread if it would otherwise wake later than `at`.
    pub(super) fn set(&self, at: Option<Now>) {
        let Some(at) = at else { return };
        if nanos(at) < self.planned.load(Ordering::SeqCst)
            && let Some(thread) = self.thread.get()
        {
            thread.unpark();
        }
    }

    /// Calls `turn` in a loop. The next call is at the time that the last call returned, or after an alarm.
    fn run(&self, start: Instant, mut turn: impl FnMut() -> Option<Now>) {
        // This cannot fail, because the thread is set only here.
        let _ = self.thread.set(thread::current());
        while !self.is_over.load(Ordering::SeqCst) {
            self.planned.store(u64::MAX, Ordering::SeqCst);
            let next = turn();
            self.planned.store(next.map_or(u64::MAX, nanos), Ordering::SeqCst);
            match next.map(|next| next.saturating_sub(start.elapsed())) {
                Some(Duration::ZERO) => {}
                Some(wait) => thread::park_timeout(wait),
                None => thread::park(),
            }
        }
    }

    fn stop(&self) {
        self.is_over.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.get() {
            thread.unpark();
        }
    }
}

fn nanos(at: Now) -> u64 {
    u64::try_from(at.as_nanos()).unwrap_or(u64::MAX)
}

/// The running threads. They stop when the engine is dropped.
#[derive(Debug)]
pub(super) struct Engine {
    alarm: Arc<Alarm>,
    quit: Option<oneshot::Sender<()>>,
    threads: Vec<JoinHandle<()>>,
}

/// The runtime of the socket thread, before the thread starts. Sockets can already be opened on this runtime.
#[derive(Debug)]
pub(super) struct Prepared {
    /// The runtime; `None` after the thread has started.
    runtime: Option<Runtime>,
    handle: Handle,
}

/// If the thread was never started, this drop may run inside another runtime, and must not block there.
impl Drop for Prepared {
    fn drop(&mut self) {
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

impl Prepared {
    pub(super) fn new() -> io::Result<Self> {
        let runtime = Builder::new_current_thread().enable_all().build()?;
        Ok(Self { handle: runtime.handle().clone(), runtime: Some(runtime) })
    }

    pub(super) fn handle(&self) -> &Handle {
        &self.handle
    }

    /// Starts both threads. `turn` executes the work that is due, and returns the time at which it must be called
    /// again.
    pub(super) fn start(
        mut self,
        name: &str,
        start: Instant,
        alarm: Arc<Alarm>,
        turn: impl FnMut() -> Option<Now> + Send + 'static,
    ) -> io::Result<Engine> {
        let (quit, quits) = oneshot::channel::<()>();
        let mut engine = Engine { alarm: Arc::clone(&alarm), quit: Some(quit), threads: Vec::new() };
        let runtime = self.runtime.take();
        let sockets = thread::Builder::new().name(format!("{name}-io"));
        engine.threads.push(sockets.spawn(move || {
            // An error means that the engine was dropped. The thread must then end too.
            let _ = runtime.map(|runtime| runtime.block_on(quits));
        })?);
        let clock = thread::Builder::new().name(format!("{name}-clock"));
        engine.threads.push(clock.spawn(move || alarm.run(start, turn))?);
        Ok(engine)
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.alarm.stop();
        self.quit = None;
        for thread in self.threads.drain(..) {
            // An error means that the thread panicked. The panic was already printed.
            let _ = thread.join();
        }
    }
}

/// Starts a task on the socket thread.
pub(super) fn spawn(handle: &Handle, task: impl Future<Output = ()> + Send + 'static) {
    // The task needs no handle: it ends with the runtime.
    drop(handle.spawn(task));
}
