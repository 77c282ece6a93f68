//! Two threads behind a scanner or a server: one for sockets, one for the clock.
//!
//! Images go out on time whatever the rest of the program does, so they have threads of their own: a prompt that waits
//! for a person must not make a robot stop. The clock has one for itself because tokio's timers tell whole milliseconds
//! only, and a parked thread wakes within a tenth of one.

use std::future::Future;
use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle, Thread};
use std::time::{Duration, Instant};

use tokio::runtime::{Builder, Handle, Runtime};
use tokio::sync::oneshot;

use super::Now;

/// Wakes the thread of the clock when something is due before it meant to wake.
#[derive(Debug, Default)]
pub(super) struct Alarm {
    /// When it means to wake, in nanoseconds; the highest while it is awake, so that nothing is missed.
    planned: AtomicU64,
    thread: OnceLock<Thread>,
    is_over: AtomicBool,
}

impl Alarm {
    /// Something is due at this moment.
    pub(super) fn set(&self, at: Option<Now>) {
        let Some(at) = at else { return };
        if nanos(at) < self.planned.load(Ordering::SeqCst)
            && let Some(thread) = self.thread.get()
        {
            thread.unpark();
        }
    }

    /// Calls `turn` whenever what it returned the last time is due, or an alarm was set.
    fn run(&self, start: Instant, mut turn: impl FnMut() -> Option<Now>) {
        // The thread is only ever set here.
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

/// The threads; they end when it is dropped.
#[derive(Debug)]
pub(super) struct Engine {
    alarm: Arc<Alarm>,
    quit: Option<oneshot::Sender<()>>,
    threads: Vec<JoinHandle<()>>,
}

/// The thread for sockets before it runs, so that sockets can be opened on it.
#[derive(Debug)]
pub(super) struct Prepared {
    /// `None` once it runs on its thread.
    runtime: Option<Runtime>,
    handle: Handle,
}

/// Where sockets could not be opened it goes unused, maybe on a thread that must not wait for it.
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

    /// Where tasks run.
    pub(super) fn handle(&self) -> &Handle {
        &self.handle
    }

    /// Starts both threads. `turn` does what is due by the clock and says when to do so again.
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
            // An error says that the engine is gone, which is what is waited for.
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
            // A thread that panicked has said so already.
            let _ = thread.join();
        }
    }
}

/// Runs something on the thread for sockets.
pub(super) fn spawn(handle: &Handle, task: impl Future<Output = ()> + Send + 'static) {
    // Tasks end with the runtime; nobody waits for one.
    drop(handle.spawn(task));
}
