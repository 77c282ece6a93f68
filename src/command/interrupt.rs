//! Ctrl-C, and other requests to end, as events instead of a killed process.

use std::cell::OnceCell;
use std::future::Future;

use tokio::sync::watch;

use crate::failure::{Failure, Kind};

/// What asked the process to end, once something has. It stays asked: nothing new begins after that.
type Asked = watch::Receiver<Option<&'static str>>;

thread_local! {
    /// One listener for the process, so that a signal between two waits is not lost. Everything runs on one thread.
    static ASKED: OnceCell<Asked> = const { OnceCell::new() };
}

/// Waits for `work`, or for Ctrl-C or another request to end. Of two that nest, the inner one hears it first.
pub async fn interruptible<T>(work: impl Future<Output = T>) -> Result<T, Failure> {
    let mut asked = asked();
    let before = *asked.borrow();
    if let Some(how) = before {
        return Err(Failure::new(Kind::Interrupted, how));
    }
    tokio::select! {
        biased;
        done = work => Ok(done),
        how = wait(&mut asked) => Err(Failure::new(Kind::Interrupted, how)),
    }
}

/// From here on a request to end waits for the next [`interruptible`] instead of killing the process.
pub fn catch_interrupts() {
    drop(asked());
}

fn asked() -> Asked {
    ASKED.with(|asked| {
        let listen = || {
            let (ask, asked) = watch::channel(None);
            // Listens at once: work may send an order the first time it is polled.
            let interrupt = interrupt();
            tokio::spawn(async move {
                // If nobody listens any more, nobody needs to know.
                ask.send(Some(interrupt.await)).unwrap_or_default();
            });
            asked
        };
        asked.get_or_init(listen).clone()
    })
}

async fn wait(asked: &mut Asked) -> &'static str {
    let how = asked.wait_for(Option::is_some).await.ok().and_then(|how| *how);
    match how {
        Some(how) => how,
        None => std::future::pending().await,
    }
}

/// Ends at the keys that suspend a process or kill it outright, Ctrl-Z and Ctrl-\, which do neither any more from this
/// call on: for what must not be left alone.
#[cfg(unix)]
pub fn abandoned() -> impl Future<Output = &'static str> {
    use tokio::signal::unix::{SignalKind, signal};

    /// SIGTSTP.
    const SUSPEND: i32 = if cfg!(target_os = "linux") { 20 } else { 18 };

    let suspend = signal(SignalKind::from_raw(SUSPEND)).ok();
    let quit = signal(SignalKind::quit()).ok();
    async {
        tokio::select! {
            () = heard(suspend) => "Ctrl-Z",
            () = heard(quit) => "Ctrl-\\",
        }
    }
}

/// There are no such keys.
#[cfg(not(unix))]
pub fn abandoned() -> impl Future<Output = &'static str> {
    std::future::pending()
}

#[cfg(unix)]
async fn heard(signal: Option<tokio::signal::unix::Signal>) {
    match signal {
        Some(mut signal) => _ = signal.recv().await,
        None => std::future::pending().await,
    }
}

/// Ends at the first request to end; those that come from this call on count, also before it is polled.
#[cfg(unix)]
fn interrupt() -> impl Future<Output = &'static str> {
    use tokio::signal::unix::{SignalKind, signal};

    let keys = signal(SignalKind::interrupt()).ok();
    let terminate = signal(SignalKind::terminate()).ok();
    let hangup = if hangup_is_ignored() { None } else { signal(SignalKind::hangup()).ok() };
    async {
        tokio::select! {
            () = heard(keys) => "Ctrl-C",
            () = heard(terminate) => "asked to end (SIGTERM)",
            () = heard(hangup) => "the terminal was closed (SIGHUP)",
        }
    }
}

/// Whether the process shall outlive its terminal, as under `nohup`. Where that cannot be told, it is left alone.
#[cfg(unix)]
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_none_or(|mask| mask & 1 != 0)
}

#[cfg(not(unix))]
async fn interrupt() -> &'static str {
    match tokio::signal::ctrl_c().await {
        Ok(()) => "Ctrl-C",
        Err(_) => std::future::pending().await,
    }
}
