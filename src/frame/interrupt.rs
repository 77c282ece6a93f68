//! Ctrl-C and other termination requests as events. They do not kill the process.
//!
//! A separate thread receives the requests, whatever the rest of the process does. The first request is passed to the
//! running work, which stops the robot. A second request ends the process at once. The first request also ends the
//! process if the work is busy with a computation and does not react.

use std::cell::RefCell;
use std::future::{Future, poll_fn};
use std::pin::{Pin, pin};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock, mpsc};
use std::task::{self, Poll};
use std::thread;
use std::time::{Duration, Instant};

use futures_util::FutureExt;
use futures_util::future::{Either, select};
use tokio::sync::watch;
use tokio::task::coop::unconstrained;
use tokio::time::timeout;

use crate::failure::{Failure, Kind};
use crate::output::{busy_work, immediate_exit};

/// Reason for the termination request, after one was received. It stays set until [`clear_interrupt`], so that no new
/// work starts.
type TerminationRequest = watch::Sender<Option<&'static str>>;

const KEYS: &str = "Ctrl-C";
/// A program requests the end.
#[cfg(unix)]
const TERMINATE: &str = "termination request (SIGTERM)";
#[cfg(windows)]
const TERMINATE: &str = "Ctrl-Break";
/// The terminal was closed.
#[cfg(unix)]
const HANGUP: &str = "the terminal was closed (SIGHUP)";
#[cfg(windows)]
const HANGUP: &str = "the console window was closed";
#[cfg(windows)]
const LOGOFF: &str = "the user logs off";
#[cfg(windows)]
const SHUTDOWN: &str = "Windows shuts down";
/// Requests that come automatically, and can come more than once.
#[cfg(unix)]
const AUTOMATIC: &[&str] = &[HANGUP];
#[cfg(windows)]
const AUTOMATIC: &[&str] = &[HANGUP, LOGOFF, SHUTDOWN];
#[cfg(unix)]
const QUIT: &str = "Ctrl-\\ (SIGQUIT)";
#[cfg(unix)]
const SUSPEND: &str = "Ctrl-Z (SIGTSTP)";

/// Two requests within this time count as one request. `timeout`, for example, sends each request twice.
const ECHO_WINDOW: Duration = Duration::from_millis(100);
/// Time in which work that was busy at the request must react to it.
const BUSY_TIMEOUT: Duration = Duration::from_millis(500);
/// Time for busy work that started after the request. It is the report of what was done until then, which must not be
/// lost on a slow computer.
const REPORT_TIMEOUT: Duration = Duration::from_secs(5);

/// There is one listener for the whole process, so that no signal is lost between two waits.
static REQUEST: OnceLock<Result<TerminationRequest, String>> = OnceLock::new();

/// Runs `work` until it ends or a termination request arrives. If calls are nested, the innermost call handles the
/// request. The outer calls then leave the work 5 seconds to report what was done.
pub async fn interruptible<T>(work: impl Future<Output = T>) -> Result<T, Failure> {
    let asked = requests()?.subscribe();
    let before = *asked.borrow();
    if let Some(how) = before {
        Wait::begin().own.has_handled.store(true, Ordering::Relaxed);
        return Err(Failure::new(Kind::Interrupted, how));
    }
    // The wait is `unconstrained`, because work that exhausts the task budget must not delay the wait. Work exhausts
    // the budget if a peer answers each request at once.
    let how = unconstrained(wait(asked, |_| true));
    run_until_request(work, how).await.map_err(|how| Failure::new(Kind::Interrupted, how))
}

/// Returns the result of `work`, or the request that ended `work`.
async fn run_until_request<T, R>(work: impl Future<Output = T>, request: impl Future<Output = R>) -> Result<T, R> {
    let wait = Wait::begin();
    let mut work = pin!(work);
    // This is not a `select!` of tokio, which does not look at the request while the work has used up the task budget.
    let how = match select(poll_fn(|context| wait.poll(work.as_mut(), context)), pin!(request)).await {
        Either::Left((done, _)) => return Ok(done),
        Either::Right((how, _)) => how,
    };
    let report = poll_fn(|context| match wait.poll(work.as_mut(), context) {
        Poll::Pending if !wait.own.handles_request() => Poll::Ready(None),
        polled => polled.map(Some),
    });
    let report = timeout(REPORT_TIMEOUT, report).await.ok().flatten();
    wait.own.has_handled.store(true, Ordering::Relaxed);
    report.ok_or(how)
}

thread_local! {
    /// The innermost wait whose work this thread polls.
    static CURRENT: RefCell<Option<Arc<WaitState>>> = const { RefCell::new(None) };
}

/// What a wait knows of the waits within its work.
#[derive(Debug, Default)]
struct WaitState {
    /// Number of waits within the work.
    inner: AtomicUsize,
    /// Whether a wait within the work has handled the request. The work then reports.
    has_handled: AtomicBool,
}

impl WaitState {
    fn handles_request(&self) -> bool {
        self.inner.load(Ordering::Relaxed) > 0 || self.has_handled.load(Ordering::Relaxed)
    }
}

/// A running wait. It is known to the wait whose work it is a part of.
struct Wait {
    own: Arc<WaitState>,
    outer: Option<Arc<WaitState>>,
}

impl Wait {
    fn begin() -> Self {
        let outer = CURRENT.with_borrow(Clone::clone);
        if let Some(outer) = &outer {
            outer.inner.fetch_add(1, Ordering::Relaxed);
        }
        Self { own: Arc::default(), outer }
    }

    fn poll<F: Future>(&self, work: Pin<&mut F>, context: &mut task::Context<'_>) -> Poll<F::Output> {
        let before = CURRENT.replace(Some(Arc::clone(&self.own)));
        let polled = work.poll(context);
        CURRENT.set(before);
        polled
    }
}

impl Drop for Wait {
    fn drop(&mut self) {
        if let Some(outer) = &self.outer {
            outer.inner.fetch_sub(1, Ordering::Relaxed);
            outer.has_handled.fetch_or(self.own.has_handled.load(Ordering::Relaxed), Ordering::Relaxed);
        }
    }
}

/// From now on, a termination request is kept for the next call of [`interruptible`], and does not kill the process.
pub fn catch_interrupts() {
    // If signals cannot be caught, the next call reports the error.
    let _ = requests();
}

/// Clears a Ctrl-C that ended one line of a script, so that the next line can start. Returns any other termination
/// request.
pub fn clear_interrupt() -> Option<&'static str> {
    let asked = requests().ok()?;
    asked.send_if_modified(|how| how.take_if(|how| *how == KEYS).is_some());
    *asked.borrow()
}

/// Waits for a termination request other than Ctrl-C.
pub async fn termination_request() -> &'static str {
    match requests() {
        Ok(asked) => wait(asked.subscribe(), |how| how != KEYS).await,
        Err(_) => std::future::pending().await,
    }
}

fn requests() -> Result<&'static TerminationRequest, Failure> {
    let asked = REQUEST.get_or_init(|| start().map_err(|error| crate::failure::plain(&error)));
    asked.as_ref().map_err(|why| Failure::local(format!("cannot receive signals: {why}")))
}

/// Starts the thread. When this function returns, the thread already receives signals, so that a signal at the first
/// poll of the work is not lost.
fn start() -> std::io::Result<TerminationRequest> {
    let requests = TerminationRequest::default();
    let (ready, is_ready) = mpsc::channel();
    let sender = requests.clone();
    thread::Builder::new().name("signals".to_owned()).spawn(
        move || match tokio::runtime::Builder::new_current_thread().enable_all().build() {
            Ok(runtime) => runtime.block_on(async move {
                let signals = Signals::new();
                let _ = ready.send(Ok(()));
                forward_signals(signals, sender).await;
            }),
            Err(error) => _ = ready.send(Err(error)),
        },
    )?;
    is_ready.recv().unwrap_or_else(|_| Err(std::io::Error::other("the thread for signals has ended")))?;
    Ok(requests)
}

/// Waits for a termination request for which `counts` is true. Each poll looks at the request itself, because the
/// channel wakes its receivers one after the other: if an outer wait is woken first, the inner wait, which handles the
/// request, must see it, too.
async fn wait(mut asked: watch::Receiver<Option<&'static str>>, counts: impl Fn(&str) -> bool) -> &'static str {
    let request = asked.clone();
    let mut wakes = pin!(async { while asked.changed().await.is_ok() {} }.fuse());
    poll_fn(|context| {
        // First the registration, then the look, so that no request is missed between them.
        let _ = wakes.as_mut().poll(context);
        request.borrow().filter(|how| counts(how)).map_or(Poll::Pending, Poll::Ready)
    })
    .await
}

/// Passes each termination request to the work.
async fn forward_signals(mut signals: Signals, requests: TerminationRequest) {
    let mut presses = Presses::default();
    // While a request is pending, busy work is checked after each `BUSY_TIMEOUT`.
    let mut busy = BusyCheck::default();
    loop {
        let is_waiting = requests.borrow().is_some();
        let how = tokio::select! {
            how = signals.next() => how,
            () = tokio::time::sleep(BUSY_TIMEOUT), if is_waiting => {
                if busy.is_stuck(busy_work::current(), Instant::now()) {
                    let how = *requests.borrow();
                    immediate_exit::exit_now(how.unwrap_or(KEYS));
                }
                continue;
            }
        };
        #[cfg(unix)]
        if how == SUSPEND && MOTIONS.load(Ordering::SeqCst) == 0 {
            immediate_exit::suspend();
            continue;
        }
        if presses.press(how, requests.borrow().is_some(), Instant::now()) {
            immediate_exit::exit_now(&format!("{how} again: armctl ended at once; a motion or command may continue"));
        }
        busy = BusyCheck::new(busy_work::current(), Instant::now());
        // The first request stays set. A Ctrl-C can be cleared for the next line, so a later request replaces it.
        requests.send_if_modified(|asked| {
            let is_first = asked.is_none_or(|asked| asked == KEYS);
            if is_first {
                *asked = Some(how);
            }
            is_first
        });
    }
}

/// Busy work since a request, by its number.
#[derive(Debug, Default)]
struct BusyCheck {
    at_request: Option<u64>,
    /// The work at the last check, and when it was first seen.
    seen: Option<(u64, Instant)>,
}

impl BusyCheck {
    fn new(work: Option<u64>, now: Instant) -> Self {
        Self { at_request: work, seen: work.map(|work| (work, now)) }
    }

    /// Whether the work has been the same for too long.
    fn is_stuck(&mut self, work: Option<u64>, now: Instant) -> bool {
        self.seen = work.map(|work| self.seen.filter(|(seen, _)| *seen == work).unwrap_or((work, now)));
        let limit = if work == self.at_request { BUSY_TIMEOUT } else { REPORT_TIMEOUT };
        self.seen.is_some_and(|(_, since)| now.duration_since(since) >= limit)
    }
}

/// Termination requests since the work last reacted to a request.
#[derive(Debug, Default)]
struct Presses {
    count: u32,
    last: Option<Instant>,
}

impl Presses {
    /// Records a request, and returns whether it ends the process. `is_waiting` is whether the previous request is
    /// still pending. Requests that come automatically do not count, for example from a closing terminal.
    fn press(&mut self, how: &str, is_waiting: bool, now: Instant) -> bool {
        if !is_waiting {
            *self = Self::default();
        }
        if AUTOMATIC.contains(&how) {
            return false;
        }
        if self.last.is_none_or(|last| now.duration_since(last) >= ECHO_WINDOW) {
            self.count += 1;
            self.last = Some(now);
        }
        self.count > 1
    }
}

/// Number of motions in progress.
static MOTIONS: AtomicUsize = AtomicUsize::new(0);

/// A motion that this process supervises. During a motion, Ctrl-Z does not suspend the process. It ends the work, like
/// Ctrl-C.
#[derive(Debug)]
pub struct MotionInProgress;

impl MotionInProgress {
    /// Starts the supervision. It lasts until the value is dropped.
    pub fn begin() -> Self {
        catch_interrupts();
        MOTIONS.fetch_add(1, Ordering::SeqCst);
        Self
    }
}

impl Drop for MotionInProgress {
    fn drop(&mut self) {
        MOTIONS.fetch_sub(1, Ordering::SeqCst);
    }
}

#[cfg(unix)]
async fn receive(signal: &mut Option<tokio::signal::unix::Signal>) {
    match signal {
        Some(signal) => _ = signal.recv().await,
        None => std::future::pending().await,
    }
}

/// Termination signals. All signals after the creation of this value count, even before the value is polled.
#[cfg(unix)]
struct Signals {
    keys: Option<tokio::signal::unix::Signal>,
    terminate: Option<tokio::signal::unix::Signal>,
    hangup: Option<tokio::signal::unix::Signal>,
    quit: Option<tokio::signal::unix::Signal>,
    suspend: Option<tokio::signal::unix::Signal>,
}

#[cfg(unix)]
impl Signals {
    fn new() -> Self {
        use tokio::signal::unix::{SignalKind, signal};

        /// Signal number of SIGTSTP.
        const SIGTSTP: i32 = if cfg!(target_os = "linux") { 20 } else { 18 };

        Self {
            keys: signal(SignalKind::interrupt()).ok(),
            terminate: signal(SignalKind::terminate()).ok(),
            hangup: if hangup_is_ignored() { None } else { signal(SignalKind::hangup()).ok() },
            quit: signal(SignalKind::quit()).ok(),
            suspend: signal(SignalKind::from_raw(SIGTSTP)).ok(),
        }
    }

    async fn next(&mut self) -> &'static str {
        tokio::select! {
            () = receive(&mut self.keys) => KEYS,
            () = receive(&mut self.terminate) => TERMINATE,
            () = receive(&mut self.hangup) => HANGUP,
            () = receive(&mut self.quit) => QUIT,
            () = receive(&mut self.suspend) => SUSPEND,
        }
    }
}

/// Whether the process must continue after its terminal closes, as under `nohup`. If this is unknown, hangups are not
/// caught.
#[cfg(unix)]
fn hangup_is_ignored() -> bool {
    let status = armctl_files::text(std::path::Path::new("/proc/self/status"), armctl_files::SETTINGS);
    let status = status.unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_none_or(|mask| mask & 1 != 0)
}

/// Events of the console. All events after the creation of this value count, even before the value is polled.
///
/// After its window was closed, Windows waits about 5 s for the end of the process. During this time, the work stops the
/// robot. If the time is too short, the guardian stops the robot: it has its own console.
#[cfg(windows)]
struct Signals {
    keys: Option<tokio::signal::windows::CtrlC>,
    terminate: Option<tokio::signal::windows::CtrlBreak>,
    hangup: Option<tokio::signal::windows::CtrlClose>,
    logoff: Option<tokio::signal::windows::CtrlLogoff>,
    shutdown: Option<tokio::signal::windows::CtrlShutdown>,
}

/// Waits for an event of the console.
#[cfg(windows)]
macro_rules! receive {
    ($event:expr) => {
        async {
            match &mut $event {
                Some(event) => _ = event.recv().await,
                None => std::future::pending().await,
            }
        }
    };
}

#[cfg(windows)]
impl Signals {
    fn new() -> Self {
        use tokio::signal::windows::{ctrl_break, ctrl_c, ctrl_close, ctrl_logoff, ctrl_shutdown};

        Self {
            keys: ctrl_c().ok(),
            terminate: ctrl_break().ok(),
            hangup: ctrl_close().ok(),
            logoff: ctrl_logoff().ok(),
            shutdown: ctrl_shutdown().ok(),
        }
    }

    async fn next(&mut self) -> &'static str {
        tokio::select! {
            () = receive!(self.keys) => KEYS,
            () = receive!(self.terminate) => TERMINATE,
            () = receive!(self.hangup) => HANGUP,
            () = receive!(self.logoff) => LOGOFF,
            () = receive!(self.shutdown) => SHUTDOWN,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::future::pending;

    use tokio::task::coop::consume_budget;

    use super::*;

    #[tokio::test(start_paused = true)]
    async fn inner_wait_handles_the_request() {
        let (ask, asked) = watch::channel(None);
        // A peer that answers each request at once lets the work exhaust the task budget.
        let busy = poll_fn(|context| {
            for _ in 0..1000 {
                let _ = pin!(consume_budget()).poll(context);
            }
            Poll::<()>::Pending
        });
        // The report after the request waits, too.
        let inner = async {
            let ended = run_until_request(busy, unconstrained(wait(asked.clone(), |_| true))).await;
            tokio::time::sleep(Duration::from_secs(1)).await;
            ended
        };
        // The request arrives after the work was polled. The channel has not woken the inner wait yet.
        let outer = unconstrained(poll_fn(|_| {
            ask.send_if_modified(|how| {
                *how = Some(KEYS);
                false
            });
            Poll::Ready("outer")
        }));
        assert_eq!(run_until_request(inner, outer).await, Ok(Err(KEYS)));
    }

    #[tokio::test(start_paused = true)]
    async fn work_that_never_reports_ends() {
        let work = async {
            let _ended = run_until_request(pending::<()>(), async { KEYS }).await;
            pending::<()>().await;
        };
        assert_eq!(run_until_request(work, async { "outer" }).await, Err("outer"));
    }

    #[tokio::test]
    async fn request_ends_work_whose_peer_answers_at_once() {
        let busy = async {
            for _ in 0..1_000_000 {
                consume_budget().await;
            }
        };
        assert_eq!(run_until_request(busy, async { KEYS }).await, Err(KEYS));
    }

    #[tokio::test]
    async fn request_ends_work_that_does_not_handle_it() {
        assert_eq!(run_until_request(pending::<()>(), async { KEYS }).await, Err(KEYS));
        assert_eq!(run_until_request(async { 1 }, async { KEYS }).await, Ok(1));
    }

    #[test]
    fn report_after_a_request_has_more_time_than_busy_work() {
        let start = Instant::now();
        let at = |millis| start + Duration::from_millis(millis);
        assert!(BusyCheck::new(Some(7), start).is_stuck(Some(7), at(500)));
        let mut busy = BusyCheck::new(Some(7), start);
        assert!(!busy.is_stuck(Some(8), at(500)), "other work");
        assert!(!busy.is_stuck(Some(8), at(5499)));
        assert!(busy.is_stuck(Some(8), at(5500)));
        assert!(!busy.is_stuck(None, at(6000)));
        assert!(!busy.is_stuck(Some(9), at(6500)), "a new report");
    }

    #[test]
    fn second_request_ends_the_process_but_an_echo_does_not() {
        let start = Instant::now();
        let at = |millis| start + Duration::from_millis(millis);
        let mut presses = Presses::default();
        assert!(!presses.press(KEYS, false, at(0)));
        assert!(!presses.press(KEYS, true, at(50)), "sent twice");
        assert!(!presses.press(KEYS, true, at(99)), "a key that is held down");
        assert!(presses.press(TERMINATE, true, at(120)));
        // The first line has ended, and another line is running.
        assert!(!presses.press(KEYS, false, at(400)));
        assert!(presses.press(KEYS, true, at(600)));
    }

    #[test]
    fn repeated_hangups_do_not_end_the_process() {
        let start = Instant::now();
        let at = |millis| start + Duration::from_millis(millis);
        let mut presses = Presses::default();
        assert!(!presses.press(HANGUP, false, at(0)));
        assert!(!presses.press(HANGUP, true, at(200)));
        assert!(!presses.press(TERMINATE, true, at(400)));
        assert!(presses.press(TERMINATE, true, at(600)));
    }
}
