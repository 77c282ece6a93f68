//! `armctl session open`: holds the link to a robot, in the foreground or in the background.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use jiff::Timestamp;

use super::host::{OpenResult, SessionHost};
use crate::command::families;
use armctl_frame::background::{self, DETACHED, Opened, Start, report_start};
use armctl_frame::interrupt::{catch_interrupts, interruptible};
use armctl_frame::output::log::Level;
use armctl_frame::prelude::*;
use armctl_frame::repeat_limiter::{Line, RepeatLimiter};
use armctl_frame::session_client::{folder_failure, format_since, identify, session_key};
use armctl_transport::session::client::status;
use armctl_transport::session::host::EndReason;
use armctl_transport::session::leave_terminal;
use armctl_transport::session::location::{SessionFolder, SessionPath};

/// Arguments of `session open`.
#[derive(Debug, Args)]
pub struct Open {
    /// Run in the background; return once the connection is open
    #[arg(long)]
    background: bool,
    /// Close the session after this time without a command
    #[arg(long, value_name = "TIME", value_parser = duration::parse_some)]
    idle: Option<Duration>,
    /// Family of the robot, if armctl cannot infer it from the target
    #[arg(long, add = ValueKind::Family)]
    family: Option<Family>,
    /// Whether this is the process that `--background` has started.
    #[arg(long, hide = true, conflicts_with = "background")]
    detached: bool,
}

impl Open {
    /// Whether the session runs in the foreground.
    pub fn stays(&self) -> bool {
        !self.background
    }

    pub(super) async fn run(self, run: &Run) -> Result<(), RunError> {
        let mut robots = run.sources.robots(self.family)?;
        let [robot] = &mut robots[..] else {
            return Err(Failure::usage("a session is for one robot").hint("open a session for each robot").into());
        };
        if !run.gate.dry_run {
            identify(&run.sources, families::driver(robot), robot, true)?;
        }
        if robot.read_only.value && families::of(robot.family).session_commands && !robot.target.value.is_simulated() {
            let message = format!("{} is read-only, but a session takes control of the controller", robot.label());
            return Err(Failure::new(Kind::Rejected, message)
                .hint(
                    "read without a session, if the fieldbus allows more than one client: `yrcx status`, `yrcx io \
                     get`",
                )
                .into());
        }
        if run.gate.dry_run {
            return Err(Failure::usage("session open has no dry run: it sends no command")
                .hint("remove --dry-run")
                .into());
        }
        if run.trace.is_some() && !families::of(robot.family).session_records {
            return Err(Failure::usage(format!("a session of {} has no recording", robot.family))
                .hint("use --trace with the commands that use the session")
                .into());
        }
        catch_interrupts();
        if self.background {
            let words = std::env::args_os().skip(1);
            let words = words.map(|word| if word == "--background" { DETACHED.into() } else { word });
            return run.local("session.open", &background::start(robot, words).await?);
        }
        if !self.detached {
            let (host, opened) = Self::open(run, robot, false).await?;
            run.local("session.open", &opened)?;
            run.screen.note("Ctrl-C closes the session");
            return Ok(self.serve(run, host).await?);
        }
        leave_terminal().context("the terminal")?;
        match Self::open(run, robot, true).await {
            Ok((host, opened)) => {
                report_start(&run.screen, &Start::Opened(opened))?;
                Ok(self.serve(run, host).await?)
            }
            Err(failure) => {
                report_start(&run.screen, &Start::Failed(failure.clone()))?;
                Err(RunError { is_reported: true, ..failure.into() })
            }
        }
    }

    /// Opens the link, and accepts clients.
    async fn open(run: &Run, robot: &Robot, background: bool) -> Result<(Box<SessionHost>, Opened)> {
        let place = SessionFolder::create().map_err(|error| folder_failure(&error))?;
        let location = place.location(&session_key(robot));
        let log = background.then(|| location.log());
        let (label, repeats) = (robot.label(), RepeatLimiter::default());
        let log_file = SessionLog { screen: run.screen, label, file: log.clone(), repeats };
        let log_file = Arc::new(Mutex::new(log_file));
        let say = move |text: &str| log_file.lock().unwrap_or_else(PoisonError::into_inner).say(text);
        let access = Access { trace: run.trace.clone(), ..Access::reading(ConnectMode::Control) };
        let opening = SessionHost::open(robot, &access, &run.screen, say.clone());
        let holding = match interruptible(opening).await?? {
            OpenResult::SharedLink(holding) => holding,
            OpenResult::InUse => return Err(in_use_failure(robot, &location).await),
            OpenResult::NoPlace(failure) => return Err(failure),
        };
        say("the connection is open");
        let opened = Opened::here(robot, background, log.as_deref());
        Ok((holding, opened))
    }

    /// Serves until the session is closed or idle; both are normal.
    async fn serve(&self, run: &Run, holding: Box<SessionHost>) -> Result<()> {
        let mut holding = holding.with_idle_limit(self.idle);
        let why = match interruptible(holding.serve()).await {
            Ok(EndReason::Requested) => "the session was closed".to_owned(),
            Ok(EndReason::Idle) => "the session has ended: no command used it in the idle time".to_owned(),
            Err(asked) => format!("the session has ended: {}", asked.message),
        };
        holding.end(&why, &run.screen).await
    }
}

/// Failure: another process has the link.
async fn in_use_failure(robot: &Robot, location: &SessionPath) -> Failure {
    let who = match (status(location).await, location.owner()) {
        (Ok(Some(status)), _) => format!("process {}, since {}", status.info.pid, format_since(status.for_ms)),
        (_, Some(owner)) => format!("process {}, which does not answer", owner.pid),
        (_, None) => "a process that does not answer".to_owned(),
    };
    Failure::new(Kind::NoAnswer, format!("{}: a session is already open: {who}", robot.label())).hint(format!(
        "run commands as usual, because they use the session automatically; close the session with `armctl session \
         close {}`",
        robot.name
    ))
}

/// Log of a session: on the terminal, or in a file.
struct SessionLog {
    screen: Screen,
    label: String,
    file: Option<PathBuf>,
    repeats: RepeatLimiter,
}

/// Writes the counts of repeated lines at the end.
impl Drop for SessionLog {
    fn drop(&mut self) {
        for line in self.repeats.due(Instant::now(), true) {
            self.write(&line.text);
        }
    }
}

/// Size limit of the log file. Above it, a new file is started, and the old file is kept.
const MAX_LOG_SIZE: u64 = 1 << 18;

impl SessionLog {
    fn say(&mut self, text: &str) {
        let line = Line::new(Level::Notice, text, &[("robot", &self.label)]);
        for line in self.repeats.lines(line, Instant::now()) {
            self.write(&line.text);
        }
    }

    fn write(&self, text: &str) {
        let Some(path) = &self.file else {
            self.screen.note(&format!("{}: {text}", self.label));
            return;
        };
        // A full disk must not end the session, because a robot can be moving.
        let _ = (|| {
            if path.metadata().is_ok_and(|found| found.len() > MAX_LOG_SIZE) {
                std::fs::rename(path, path.with_extension("log.1"))?;
            }
            let mut options = OpenOptions::new();
            options.append(true).create(true);
            #[cfg(unix)]
            std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
            options.open(path)?.write_all(format!("{} {}: {text}\n", Timestamp::now(), self.label).as_bytes())
        })();
    }
}
