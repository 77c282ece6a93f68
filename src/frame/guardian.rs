//! Guardian process: stops the robot if the process that moves it crashes, is killed or hangs.
//!
//! The guardian is another instance of this program in its own process group. Its arguments are the stop command of the
//! family. The guardian reads a pipe from the guarded process. The guarded process writes a byte before it sends a
//! motion, then heartbeats, and a last byte at its normal end. The pipe closes whenever the process ends. If the
//! heartbeats stop, the guardian kills the process. This frees the serial port, the TCP connection and the place in a
//! session for the stop.
//!
//! A session process also has a guardian for the motions of its clients, because the session and a client can end at
//! the same time.

use std::cell::RefCell;
use std::ffi::OsString;
use std::io::{self, Read as _, Write as _};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Context as _;
use tokio::time::{MissedTickBehavior, interval};

use crate::failure::{Failure, Kind};
use crate::output::{ColorChoice, Format, Screen};
use crate::settings::Robot;
use armctl_files::own_command;
#[cfg(windows)]
use armctl_transport::session::terminate;

/// Interval between heartbeats.
const HEARTBEAT_INTERVAL: Duration = Duration::from_millis(500);
/// Time without a heartbeat after which the guarded process counts as hanging.
const DEAD_AFTER: Duration = Duration::from_secs(2);

/// Time limit for all attempts to stop the robot. `RETRY_PAUSE` is the pause between two attempts.
const STOP_TIMEOUT: Duration = Duration::from_secs(30);
const RETRY_PAUSE: Duration = Duration::from_millis(200);

/// First argument of a guardian that stops the robot.
const STOP_ARGUMENT: &str = "--guardian=stop";
/// First argument of a guardian that only kills a process that hangs. After that, the session or the fieldbus adapter
/// stops the robot.
const KILL_ARGUMENT: &str = "--guardian=end";

/// Bytes that the guarded process writes.
const MOTION: u8 = b'm';
const MOTION_END: u8 = b'r';
const HEARTBEAT: u8 = b'.';
const DONE: u8 = b'q';

/// Returns this program with the arguments of the command that stops a robot. `words` follow the family name.
fn stop_command(robot: &Robot, words: &[&str], first: Option<&str>) -> io::Result<Command> {
    let mut command = own_command()?;
    command.args(first).args(["--quiet", "-t", robot.target.value.url(), robot.family.name()]);
    command.args(words).env_remove("ARMCTL_ROBOT").env_remove("ARMCTL_TARGET");
    command.stdout(Stdio::null());
    Ok(command)
}

/// Stops a robot in a separate process, through the session that owns its link. Passes the result to `say`.
pub fn stop_orphan(robot: &Robot, words: &[&str], say: impl Fn(&str) + Send + 'static) {
    let command = stop_command(robot, words, None);
    thread::spawn(move || {
        match command.map_err(|error| error.to_string()).and_then(|mut stop| run_until_stopped(&mut stop)) {
            Ok(()) => say("the robot was stopped"),
            Err(why) => say(&stop_failure(&why)),
        }
    });
}

/// Runs the command that stops a robot until the command succeeds. A repeated stop is harmless. Repeating is necessary,
/// because another program may use the link for a moment.
///
/// # Errors
/// The error of the last attempt.
fn run_until_stopped(stop: &mut Command) -> Result<(), String> {
    let deadline = Instant::now() + STOP_TIMEOUT;
    loop {
        let why = match stop.stdin(Stdio::null()).output() {
            Ok(output) if output.status.success() => return Ok(()),
            Ok(output) => String::from_utf8_lossy(&output.stderr).trim().to_owned(),
            Err(error) => error.to_string(),
        };
        if Instant::now() >= deadline {
            return Err(why);
        }
        thread::sleep(RETRY_PAUSE);
    }
}

fn stop_failure(why: &str) -> String {
    format!("the robot may still move: use the pendant or the emergency stop. Cause: {why}")
}

/// Starts a guardian. Returns the pipe to the guardian and its process.
fn spawn(robot: &Robot, words: &[&str], first: &str) -> io::Result<(Pipe, Child)> {
    let mut command = stop_command(robot, words, Some(first))?;
    #[cfg(windows)]
    command.env(GUARDED, std::process::id().to_string());
    let mut child = command.stdin(Stdio::piped()).spawn()?;
    let pipe = Arc::new(Mutex::new(child.stdin.take()));
    Ok((pipe, child))
}

type Pipe = Arc<Mutex<Option<ChildStdin>>>;

/// Guardian of the motion of a command.
#[derive(Debug)]
pub struct Guardian {
    pipe: Pipe,
    child: Option<Child>,
}

impl Guardian {
    /// Starts a guardian. With `stops`, the guardian itself stops the robot, because no session or adapter does this.
    pub fn start(robot: &Robot, words: &[&str], stops: bool) -> Result<Self, Failure> {
        let spawned = spawn(robot, words, if stops { STOP_ARGUMENT } else { KILL_ARGUMENT });
        let (pipe, child) =
            spawned.context("the process that guards the motion could not be started; nothing was sent")?;
        Ok(Self { pipe, child: Some(child) })
    }

    /// Returns the function that the caller must call before a motion is sent.
    pub fn before_motion(&self) -> impl Fn() + Send + Sync + 'static {
        let pipe = Arc::clone(&self.pipe);
        move || write(&pipe, MOTION)
    }

    /// Runs the work, and sends heartbeats to the guardian until the work ends.
    pub async fn guard<T>(&self, work: impl Future<Output = T>) -> T {
        with_heartbeats(work, || write(&self.pipe, HEARTBEAT)).await
    }
}

/// Runs the work, and calls `beat` at intervals until the work ends.
async fn with_heartbeats<T>(work: impl Future<Output = T>, beat: impl Fn()) -> T {
    let heartbeats = async {
        let mut beats = interval(HEARTBEAT_INTERVAL);
        beats.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            beats.tick().await;
            beat();
        }
    };
    tokio::select! {
        done = work => done,
        () = heartbeats => unreachable!("the heartbeats never end"),
    }
}

/// Reports the normal end of the work to the guardian.
impl Drop for Guardian {
    fn drop(&mut self) {
        write(&self.pipe, DONE);
        self.pipe.lock().unwrap_or_else(PoisonError::into_inner).take();
        // The exit status is collected, so that no zombie process remains.
        if let Some(mut child) = self.child.take() {
            thread::spawn(move || child.wait());
        }
    }
}

/// Guardian of the motions of session clients. It stops the robot if the session process ends while a client in another
/// process moves the robot.
#[derive(Debug)]
pub struct SessionGuardian {
    robot: Robot,
    words: &'static [&'static str],
    /// Pipe and process of the guardian; `None` before the first motion.
    started: RefCell<Option<(Pipe, Child)>>,
}

impl SessionGuardian {
    /// Creates the guardian of a session.
    pub fn new(robot: &Robot, words: &'static [&'static str]) -> Self {
        Self { robot: robot.clone(), words, started: RefCell::default() }
    }

    /// Reports to the guardian whether a client moves the robot. Starts the guardian at the first motion.
    ///
    /// # Errors
    /// A text for the user, if the guardian cannot be started.
    pub fn set_moving(&self, is_moving: bool) -> Result<(), String> {
        let mut started = self.started.borrow_mut();
        if started.is_none() && is_moving {
            let spawned = spawn(&self.robot, self.words, STOP_ARGUMENT);
            *started = Some(spawned.map_err(|error| {
                format!(
                    "the process that guards the motion could not be started, so the robot does not stop if armctl \
                     dies: {error}"
                )
            })?);
        }
        if let Some((pipe, _)) = &*started {
            write(pipe, if is_moving { MOTION } else { MOTION_END });
        }
        Ok(())
    }

    /// Runs the work, and sends heartbeats to the guardian until the work ends.
    pub async fn guard<T>(&self, work: impl Future<Output = T>) -> T {
        let heartbeat = || {
            if let Some((pipe, _)) = &*self.started.borrow() {
                write(pipe, HEARTBEAT);
            }
        };
        with_heartbeats(work, heartbeat).await
    }
}

fn write(pipe: &Mutex<Option<ChildStdin>>, byte: u8) {
    // An error is ignored: the guardian may have been killed.
    if let Some(pipe) = &mut *pipe.lock().unwrap_or_else(PoisonError::into_inner) {
        let _ = pipe.write_all(&[byte]);
    }
}

/// Runs as a guardian if the first argument requests this. Waits for the end of the guarded process, and then runs the
/// stop command from the other arguments. Returns an error if the robot may still move.
pub fn serve(args: &[OsString]) -> Option<Result<(), Kind>> {
    let stops = match args.get(1)?.to_str()? {
        STOP_ARGUMENT => true,
        KILL_ARGUMENT => false,
        _ => return None,
    };
    if !was_moving_at_end() || !stops {
        return Some(Ok(()));
    }
    let stopped = own_command().map_err(|error| error.to_string());
    let stopped = stopped.and_then(|mut program| run_until_stopped(program.args(&args[2..])));
    Some(stopped.map_err(|why| {
        print(&stop_failure(&why));
        Kind::OutcomeUnknown
    }))
}

fn print(text: &str) {
    Screen::new(Format::Table, ColorChoice::Never, false, 0).note(text);
}

/// Waits for the end of the guarded process. Returns whether a motion was in progress at that time.
fn was_moving_at_end() -> bool {
    let guarded = guarded_process();
    let (sender, bytes) = channel();
    thread::spawn(move || {
        let mut byte = [0];
        while io::stdin().read_exact(&mut byte).is_ok() && sender.send(byte[0]).is_ok() {}
    });
    let mut is_moving = false;
    let mut is_killed = false;
    loop {
        let byte = if is_moving && !is_killed {
            bytes.recv_timeout(DEAD_AFTER)
        } else {
            bytes.recv().map_err(|_| RecvTimeoutError::Disconnected)
        };
        match byte {
            Ok(DONE) => return false,
            Ok(MOTION_END) => is_moving = false,
            Ok(byte) => is_moving |= byte == MOTION,
            Err(RecvTimeoutError::Disconnected) => return is_moving,
            Err(RecvTimeoutError::Timeout) => {
                is_killed = kill(guarded);
                print(&format!(
                    "armctl (process {}) did not respond for {} s while the robot moved: the process was ended to \
                     stop the robot",
                    guarded.map_or_else(|| "unknown".to_owned(), |guarded| guarded.to_string()),
                    DEAD_AFTER.as_secs()
                ));
                if !is_killed {
                    return true;
                }
            }
        }
    }
}

#[cfg(unix)]
fn guarded_process() -> Option<rustix::process::Pid> {
    rustix::process::getppid()
}

/// Kills the guarded process. If the process has already ended, nothing is killed, because another process may have the
/// same id now.
#[cfg(unix)]
fn kill(guarded: Option<rustix::process::Pid>) -> bool {
    use rustix::process::{Signal, getppid, kill_process};

    guarded.filter(|_| getppid() == guarded).is_some_and(|guarded| kill_process(guarded, Signal::KILL).is_ok())
}

/// Environment variable with the id of the guarded process, on systems without parent process ids.
#[cfg(windows)]
const GUARDED: &str = "ARMCTL_GUARDED";

#[cfg(windows)]
fn guarded_process() -> Option<u32> {
    std::env::var(GUARDED).ok()?.parse().ok()
}

/// Kills the guarded process. The pipe of the process is still open, so its id is still valid.
#[cfg(windows)]
fn kill(guarded: Option<u32>) -> bool {
    guarded.is_some_and(terminate)
}
