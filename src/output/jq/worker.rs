//! A process of its own for filters: a filter that calls itself for ever, or fills all memory, ends there and harms
//! nothing else. It is this program again, which reads requests on stdin, a line each, and answers in lines. It ends with
//! whoever started it, whatever it is doing.

use std::collections::HashMap;
use std::ffi::OsString;
use std::io::{self, BufRead as _, BufReader, BufWriter, ErrorKind, Read as _, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::program::{Program, Stop};
use crate::failure::{Kind, end};
use crate::files::this_program;

/// The only argument of such a process.
const WORD: &str = "--filter-worker";
/// Memory that it may have, where the system can see to it.
#[cfg(unix)]
const MEMORY: u64 = 1 << 30;
/// Room for filters that call themselves.
const STACK: usize = 64 << 20;
/// Longest value in bytes.
const LONGEST: u64 = 256 << 20;
/// Filters that are kept compiled.
const KEPT: usize = 64;

/// What a filter is for.
#[derive(Debug, Serialize)]
struct Asked<'a> {
    filter: &'a str,
    /// What it is run on; nothing if it is only compiled.
    input: Option<[&'a Value; 1]>,
}

/// The same, as the process reads it.
#[derive(Deserialize)]
struct Heard {
    filter: String,
    input: Option<[jaq_json::Val; 1]>,
}

/// An answer.
#[derive(Debug, Serialize, Deserialize)]
enum Answer {
    /// A value that the filter makes.
    Value(Value),
    /// The last answer: there are no more.
    Done,
    /// The last answer: the filter does not compile.
    Mistake(String),
    /// The last answer: it has failed.
    Failed(String),
    /// The last answer: it has ended itself.
    Halted(u8, String),
}

/// Why there is no answer, or not all.
#[derive(Debug)]
pub enum FilterError {
    /// The filter does not compile.
    Mistake(String),
    /// It has failed.
    Failed(String),
    /// It has ended itself, with this exit code, and has this to say.
    Halted {
        /// 5 unless it says another.
        exit: u8,
        /// A text as it is; anything else as JSON, in a line.
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

/// The process of this one.
struct Worker {
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

static WORKER: Mutex<Option<Worker>> = Mutex::new(None);

/// Compiles a filter, and hands over every value that it makes of the input, if there is one, as it comes. `take` says
/// whether more is wanted.
pub fn ask(filter: &str, input: Option<&Value>, mut take: impl FnMut(Value) -> bool) -> Result<(), FilterError> {
    let asked = Asked { filter, input: input.map(|input| [input]) };
    let failed = |error: &io::Error| FilterError::Failed(format!("it cannot be run: {}", crate::failure::plain(error)));
    let mut worker = WORKER.lock().unwrap_or_else(PoisonError::into_inner);
    let mut living = match worker.take().and_then(Worker::living) {
        Some(living) => living,
        None => Worker::start().map_err(|error| failed(&error))?,
    };
    living.request(&asked).map_err(|error| failed(&error))?;
    loop {
        match living.answer() {
            Ok(Some(Answer::Value(value))) => {
                if !take(value) {
                    // What it goes on to say is nobody's: this one ends.
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
                return Err(FilterError::Failed("it needs too much memory, or calls itself too deep".to_owned()));
            }
            Err(error) => return Err(failed(&error)),
        }
    }
}

impl Worker {
    fn start() -> io::Result<Self> {
        let mut command = Command::new(this_program()?);
        command.arg(WORD).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        // The keys of the terminal are not for it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let none = || io::Error::other("there is no pipe");
        let requests = child.stdin.take().ok_or_else(none)?;
        let answers = BufReader::new(child.stdout.take().ok_or_else(none)?);
        Ok(Self { child, requests, answers })
    }

    /// The same, unless it has ended.
    fn living(mut self) -> Option<Self> {
        matches!(self.child.try_wait(), Ok(None)).then_some(self)
    }

    fn request(&mut self, asked: &Asked<'_>) -> io::Result<()> {
        let mut line = serde_json::to_vec(asked)?;
        line.push(b'\n');
        match self.requests.write_all(&line).and_then(|()| self.requests.flush()) {
            // It ended on the way; its answer says so.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            written => written,
        }
    }

    /// The next answer; nothing if the process has ended.
    fn answer(&mut self) -> io::Result<Option<Answer>> {
        let mut line = Vec::new();
        (&mut self.answers).take(LONGEST).read_until(b'\n', &mut line)?;
        match line.last() {
            Some(b'\n') => Ok(Some(serde_json::from_slice(&line)?)),
            Some(_) if u64::try_from(line.len()).unwrap_or(u64::MAX) >= LONGEST => {
                Ok(Some(Answer::Failed("it makes a value that is too long".to_owned())))
            }
            _ => Ok(None),
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // It has ended, or nobody wants what it computes.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Whether a command line means this process, the program's name included.
pub fn is_meant(args: &[OsString]) -> bool {
    matches!(args, [_, word] if word == WORD)
}

/// Answers requests until stdin ends.
pub fn serve() -> Result<(), Kind> {
    limit();
    let (asked, requests) = mpsc::sync_channel(1);
    let computing = thread::Builder::new().stack_size(STACK).spawn(move || compute(&requests));
    let failed = |_| Kind::Local;
    computing.map_err(failed)?;

    // Read here, so that the end is noticed while a filter runs.
    for line in BufReader::new(io::stdin()).split(b'\n') {
        if asked.send(line.map_err(failed)?).is_err() {
            break;
        }
    }
    end(Kind::PipeClosed)
}

/// Takes from this process what it must not have.
#[cfg(unix)]
fn limit() {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

    for (resource, most) in [(Resource::As, MEMORY), (Resource::Core, 0)] {
        let most = getrlimit(resource).maximum.map_or(most, |maximum| maximum.min(most));
        // Where the system knows no such limit, there is none.
        let _ = setrlimit(resource, Rlimit { current: Some(most), maximum: Some(most) });
    }
}

#[cfg(not(unix))]
fn limit() {}

fn compute(requests: &mpsc::Receiver<Vec<u8>>) {
    let mut programs: HashMap<String, Program> = HashMap::new();
    let mut stdout = BufWriter::new(super::answers());
    let mut say = |answer: &Answer, is_last: bool| {
        let mut line = serde_json::to_vec(answer).unwrap_or_default();
        line.push(b'\n');
        let written = stdout.write_all(&line);
        written.and_then(|()| if is_last { stdout.flush() } else { Ok(()) }).is_ok()
    };
    for request in requests {
        let Ok(Heard { filter, input }) = serde_json::from_slice(&request) else { return };
        drop(request);
        if programs.len() >= KEPT {
            programs.clear();
        }
        let done = match programs.get(&filter) {
            Some(program) => Ok(program),
            None => Program::new(&filter).map(|program| &*programs.entry(filter).or_insert(program)),
        };
        let last = match (done, input) {
            (Err(why), _) => Answer::Mistake(why),
            (Ok(_), None) => Answer::Done,
            (Ok(program), Some([input])) => match program.run(input, |value| say(&Answer::Value(value), false)) {
                Ok(()) => Answer::Done,
                Err(Stop::Failed(why)) => Answer::Failed(why),
                Err(Stop::Halted { exit, text }) => Answer::Halted(exit, text),
            },
        };
        if !say(&last, true) {
            return;
        }
    }
}
