//! Worker process for filters. A filter that never ends, or that uses all memory, harms only the worker. The worker is
//! another instance of this program. It reads requests and writes answers line by line. It ends together with its
//! parent, even while a filter runs.

use std::collections::HashMap;
use std::ffi::OsString;
use std::io::{self, BufRead as _, BufReader, BufWriter, ErrorKind, Read as _, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::program::{Program, Stop};
use crate::failure::{Kind, exit_process};
use armctl_files::own_command;

/// The only argument of a worker process.
const WORKER_ARGUMENT: &str = "--filter-worker";
/// Memory limit of the worker, on systems that support such a limit.
#[cfg(unix)]
const MEMORY_LIMIT: u64 = 1 << 30;
/// Stack size, large enough for recursive filters.
const STACK: usize = 64 << 20;
/// Maximum size of a value in bytes.
const MAX_VALUE_SIZE: u64 = 256 << 20;
/// Number of compiled filters that are kept.
const MAX_PROGRAMS: usize = 64;

/// A request to the worker.
#[derive(Debug, Serialize)]
struct Request<'a> {
    filter: &'a str,
    /// Input of the filter. With `None`, the filter is only compiled.
    input: Option<[&'a Value; 1]>,
}

/// A request in the form that the worker reads.
#[derive(Deserialize)]
struct ReceivedRequest {
    filter: String,
    input: Option<[jaq_json::Val; 1]>,
}

#[derive(Debug, Serialize, Deserialize)]
enum Answer {
    /// An output of the filter.
    Value(Value),
    /// Last answer: there are no more outputs.
    Done,
    /// Last answer: the filter does not compile.
    Mistake(String),
    /// Last answer: the filter failed.
    Failed(String),
    /// Last answer: the filter halted.
    Halted(u8, String),
}

/// Reason why a result is missing or incomplete.
#[derive(Debug)]
pub enum FilterError {
    /// The filter does not compile.
    Mistake(String),
    /// The filter failed.
    Failed(String),
    /// The filter ended itself, with an exit code and a text.
    Halted {
        /// Exit code. The default is 5.
        exit: u8,
        /// Text to print. A value that is not text is one line of JSON.
        text: String,
    },
}

impl From<Stop> for FilterError {
    fn from(stop: Stop) -> Self {
        match stop {
            Stop::Failed(why) => Self::Failed(why),
            Stop::Halted { exit, text } => Self::Halted { exit, text },
        }
    }
}

struct Worker {
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

static WORKER: Mutex<Option<Worker>> = Mutex::new(None);

/// Compiles a filter. If there is an input, runs the filter and passes its outputs to `take`. `take` returns whether to
/// continue.
pub fn ask(filter: &str, input: Option<&Value>, mut take: impl FnMut(Value) -> bool) -> Result<(), FilterError> {
    let request = Request { filter, input: input.map(|input| [input]) };
    let failed = |error: &io::Error| FilterError::Failed(format!("it cannot be run: {}", crate::failure::plain(error)));
    let mut worker = WORKER.lock().unwrap_or_else(PoisonError::into_inner);
    let mut living = match worker.take().and_then(Worker::if_alive) {
        Some(living) => living,
        None => Worker::start().map_err(|error| failed(&error))?,
    };
    living.request(&request).map_err(|error| failed(&error))?;
    loop {
        match living.answer() {
            Ok(Some(Answer::Value(value))) => {
                if !take(value) {
                    // The worker is dropped here and ends, because its remaining outputs are not needed.
                    return Ok(());
                }
            }
            Ok(Some(last)) => {
                *worker = Some(living);
                return match last {
                    Answer::Mistake(why) => Err(FilterError::Mistake(why)),
                    Answer::Failed(why) => Err(FilterError::Failed(why)),
                    Answer::Halted(exit, text) => Err(FilterError::Halted { exit, text }),
                    Answer::Done | Answer::Value(_) => Ok(()),
                };
            }
            Ok(None) => {
                return Err(FilterError::Failed("it needs too much memory, or its recursion is too deep".to_owned()));
            }
            Err(error) => return Err(failed(&error)),
        }
    }
}

impl Worker {
    fn start() -> io::Result<Self> {
        let mut command = own_command()?;
        command.arg(WORKER_ARGUMENT).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn()?;
        let no_input = || io::Error::other("no pipe");
        let requests = child.stdin.take().ok_or_else(no_input)?;
        let answers = BufReader::new(child.stdout.take().ok_or_else(no_input)?);
        Ok(Self { child, requests, answers })
    }

    /// Returns the worker; `None` if its process has ended.
    fn if_alive(mut self) -> Option<Self> {
        matches!(self.child.try_wait(), Ok(None)).then_some(self)
    }

    fn request(&mut self, asked: &Request<'_>) -> io::Result<()> {
        let mut line = serde_json::to_vec(asked)?;
        line.push(b'\n');
        match self.requests.write_all(&line).and_then(|()| self.requests.flush()) {
            // The worker has ended. The next read reports this.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            written => written,
        }
    }

    /// Returns the next answer; `None` if the worker has ended.
    fn answer(&mut self) -> io::Result<Option<Answer>> {
        let mut line = Vec::new();
        (&mut self.answers).take(MAX_VALUE_SIZE).read_until(b'\n', &mut line)?;
        match line.last() {
            Some(b'\n') => Ok(Some(serde_json::from_slice(&line)?)),
            Some(_) if u64::try_from(line.len()).unwrap_or(u64::MAX) >= MAX_VALUE_SIZE => {
                Ok(Some(Answer::Failed("it makes a value that is too long".to_owned())))
            }
            _ => Ok(None),
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // An error is ignored: the worker may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Whether the command line is the command line of a worker.
pub fn is_worker(args: &[OsString]) -> bool {
    matches!(args, [_, word] if word == WORKER_ARGUMENT)
}

/// Answers requests until stdin is closed.
pub fn serve() -> Result<(), Kind> {
    limit();
    let (asked, requests) = mpsc::sync_channel(1);
    let computing = thread::Builder::new().stack_size(STACK).spawn(move || compute(&requests));
    let failed = |_| Kind::Local;
    computing.map_err(failed)?;

    // Stdin is read on this thread, so that its end is detected while a filter runs.
    for line in BufReader::new(io::stdin()).split(b'\n') {
        if asked.send(line.map_err(failed)?).is_err() {
            break;
        }
    }
    exit_process(Kind::PipeClosed)
}

#[cfg(unix)]
fn limit() {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

    for (resource, most) in [(Resource::As, MEMORY_LIMIT), (Resource::Core, 0)] {
        let most = getrlimit(resource).maximum.map_or(most, |maximum| maximum.min(most));
        // An error is ignored: systems without such a limit run without it.
        let _ = setrlimit(resource, Rlimit { current: Some(most), maximum: Some(most) });
    }
}

#[cfg(not(unix))]
fn limit() {}

fn compute(requests: &mpsc::Receiver<Vec<u8>>) {
    let mut programs: HashMap<String, Program> = HashMap::new();
    let mut stdout = BufWriter::new(super::answers());
    let mut send = |answer: &Answer, is_last: bool| {
        let mut line = serde_json::to_vec(answer).unwrap_or_default();
        line.push(b'\n');
        let written = stdout.write_all(&line);
        written.and_then(|()| if is_last { stdout.flush() } else { Ok(()) }).is_ok()
    };
    for request in requests {
        let Ok(ReceivedRequest { filter, input }) = serde_json::from_slice(&request) else { return };
        drop(request);
        if programs.len() >= MAX_PROGRAMS {
            programs.clear();
        }
        let done = match programs.get(&filter) {
            Some(program) => Ok(program),
            None => Program::new(&filter).map(|program| &*programs.entry(filter).or_insert(program)),
        };
        let last = match (done, input) {
            (Err(why), _) => Answer::Mistake(why),
            (Ok(_), None) => Answer::Done,
            (Ok(program), Some([input])) => match program.run(input, |value| send(&Answer::Value(value), false)) {
                Ok(()) => Answer::Done,
                Err(Stop::Failed(why)) => Answer::Failed(why),
                Err(Stop::Halted { exit, text }) => Answer::Halted(exit, text),
            },
        };
        if !send(&last, true) {
            return;
        }
    }
}
