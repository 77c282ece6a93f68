//! Ctrl-C, and other requests to end, as events instead of a killed process.

use std::cell::OnceCell;
use std::future::Future;

use tokio::sync::watch;
use tokio::task::coop::unconstrained;

use crate::failure::{Failure, Kind};

/// What asked the process to end, once something has. It stays asked: nothing new begins after that, until [`again`].
type Asked = watch::Sender<Option<&'static str>>;

const KEYS: &str = "Ctrl-C";

thread_local! {
    /// One listener for the process, so that a signal between two waits is not lost. Everything runs on one thread.
    static ASKED: OnceCell<Asked> = const { OnceCell::new() };
}

/// Waits for `work`, or for Ctrl-C or another request to end. Of two that nest, the inner one hears it first.
pub async fn interruptible<T>(work: impl Future<Output = T>) -> Result<T, Failure> {
    let asked = asked().subscribe();
    let before = *asked.borrow();
    if let Some(how) = before {
        return Err(Failure::new(Kind::Interrupted, how));
    }
    tokio::select! {
        biased;
        done = work => Ok(done),
        // Work that has used up its turn, because its peer answers at once, must not use up this one's as well.
        how = unconstrained(wait(asked, |_| true)) => Err(Failure::new(Kind::Interrupted, how)),
    }
}

/// From here on a request to end waits for the next [`interruptible`] instead of killing the process.
pub fn catch_interrupts() {
    drop(asked());
}

/// Ctrl-C has ended one line of several, and the next one may begin. Says what else asked the process to end.
pub fn again() -> Option<&'static str> {
    let asked = asked();
    asked.send_if_modified(|how| how.take_if(|how| *how == KEYS).is_some());
    *asked.borrow()
}

/// Waits for a request to end that is no Ctrl-C.
pub async fn asked_to_end() -> &'static str {
    wait(asked().subscribe(), |how| how != KEYS).await
}

fn asked() -> Asked {
    ASKED.with(|asked| {
        let listen = || {
            let ask = Asked::default();
            // Listens at once: work may send an order the first time it is polled.
            tokio::spawn(listen(ask.clone()));
            ask
        };
        asked.get_or_init(listen).clone()
    })
}

/// Waits for a request to end that counts.
async fn wait(mut asked: watch::Receiver<Option<&'static str>>, counts: impl Fn(&str) -> bool) -> &'static str {
    let how = asked.wait_for(|how| how.is_some_and(&counts)).await.ok().and_then(|how| *how);
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

    let mut suspend = signal(SignalKind::from_raw(SUSPEND)).ok();
    let mut quit = signal(SignalKind::quit()).ok();
    async move {
        tokio::select! {
            () = heard(&mut suspend) => "Ctrl-Z",
            () = heard(&mut quit) => "Ctrl-\\",
        }
    }
}

/// There are no such keys.
#[cfg(not(unix))]
pub fn abandoned() -> impl Future<Output = &'static str> {
    std::future::pending()
}

#[cfg(unix)]
async fn heard(signal: &mut Option<tokio::signal::unix::Signal>) {
    match signal {
        Some(signal) => _ = signal.recv().await,
        None => std::future::pending().await,
    }
}

/// Passes on every request to end; those that come from this call on count, also before it is polled.
#[cfg(unix)]
fn listen(ask: Asked) -> impl Future<Output = ()> {
    use tokio::signal::unix::{SignalKind, signal};

    let mut keys = signal(SignalKind::interrupt()).ok();
    let mut terminate = signal(SignalKind::terminate()).ok();
    let mut hangup = if hangup_is_ignored() { None } else { signal(SignalKind::hangup()).ok() };
    async move {
        loop {
            let how = tokio::select! {
                () = heard(&mut keys) => KEYS,
                () = heard(&mut terminate) => "asked to end (SIGTERM)",
                () = heard(&mut hangup) => "the terminal was closed (SIGHUP)",
            };
            // The first one counts, unless it was for one line only.
            ask.send_if_modified(|asked| {
                let is_first = asked.is_none_or(|asked| asked == KEYS);
                if is_first {
                    *asked = Some(how);
                }
                is_first
            });
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
async fn listen(ask: Asked) {
    while tokio::signal::ctrl_c().await.is_ok() {
        ask.send_replace(Some(KEYS));
    }
}
