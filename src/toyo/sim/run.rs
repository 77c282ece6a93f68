//! `toyo sim run`.

use super::trace::{End, Recorder, Source, Stop, Trace};
use crate::eeprom_tables::EepromRow;
use crate::field_values::Changes;
use crate::files;
use crate::param::{Parameters, key_text};
use crate::point::Points;
use crate::prelude::*;
use crate::program::text;
use armctl_controller::names::{Name, Names};
use armctl_controller::toyo::program::{MAX_STEPS, Program, check_named};
use armctl_controller::toyo::simulator::{Simulator, Start, What};
use armctl_frame::OfflineCommand;
use armctl_frame::store::rows_of_file;

/// Run a program in the simulator in virtual time, and print steps, outputs and positions.
#[derive(Debug, Args)]
#[command(after_help = "The simulated controller is new: the origin is known, the position is 0 and servo power is \
                        on. --state, --params and --points change its content. Task 1 runs the program.\n\nThe run \
                        ends at END or a STOP of task 1 (exit code 0). The exit code is 8 after an error, if all \
                        tasks wait without end, or if the program still runs after --for. A faulty file is a usage \
                        error (exit code 2).\n\n  armctl toyo sim run pick.txt --points points.csv --input 'at 2s \
                        0/01/3 on'")]
pub struct Run {
    /// Program of task 1; - means stdin
    file: PathBuf,
    /// Program file of another task, which a TSTR step starts, for example 2=gate.txt (repeatable)
    #[arg(long, value_name = "TASK=FILE", value_parser = other_task)]
    task: Vec<(usize, PathBuf)>,
    /// CSV file of points from `point dump`. For a task other than 1, type the task number before the file, for example
    /// 2=gate.csv (repeatable)
    #[arg(long, value_name = "[TASK=]FILE", value_parser = points_of)]
    points: Vec<(usize, PathBuf)>,
    /// Parameters and tables (CSV) from `param dump`
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// Start state of the simulator (TOML), as for `armctl sim toyo`
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Input event: "at 2s 0/01/3 on" sets one bit of an input port, "at 2s 0/01 00000100" sets all eight bits
    /// (repeatable)
    #[arg(long, value_name = "EVENT", value_parser = input)]
    input: Vec<Input>,
    /// Name of a point, a counter or a timer, in the form of robots.toml, for example pick=PT1 (repeatable)
    #[arg(long, value_name = "NAME=ADDRESS", value_parser = text::name)]
    name: Vec<Name>,
    /// Step to start with
    #[arg(long, value_name = "STEP", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=5000))]
    from: u16,
    /// Time limit of the program [default: 10 minutes]
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse)]
    within: Option<Duration>,
    /// Also print the position at this interval
    #[arg(long = "trace-every", value_name = "TIME", value_parser = every)]
    every: Option<Duration>,
    /// Maximum number of rows; if there are more, only the last rows are printed
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    rows: usize,
}

/// A change of inputs during the run.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Input {
    at: Duration,
    /// Text for the console of the simulator, such as `0/01/3 on`.
    what: String,
}

/// Default time limit of a run.
const DEFAULT_TIME_LIMIT: Duration = Duration::from_secs(600);
/// Time limit of the run that `program check` makes.
const REHEARSAL: Duration = Duration::from_secs(30);
/// Minimum interval of printed positions.
const FINEST: Duration = Duration::from_millis(1);

fn every(text: &str) -> Result<Duration, String> {
    let every = duration::parse(text)?;
    if every < FINEST { Err("the minimum is 1ms".to_owned()) } else { Ok(every) }
}

fn other_task(text: &str) -> Result<(usize, PathBuf), String> {
    let parts = text.split_once('=').and_then(|(task, file)| Some((task.parse().ok()?, file)));
    match parts {
        Some((task, file)) if (2..=4).contains(&task) && !file.is_empty() => Ok((task, file.into())),
        _ => Err("type a task from 2 to 4 and a file, such as 2=gate.txt".to_owned()),
    }
}

#[expect(clippy::unnecessary_wraps, reason = "internal error: the command line has no file")]
fn points_of(text: &str) -> Result<(usize, PathBuf), String> {
    let task = text.split_once('=').and_then(|(task, file)| Some((task.parse().ok()?, file)));
    Ok(match task {
        Some((task, file)) if (1..=4).contains(&task) => (task, file.into()),
        _ => (1, text.into()),
    })
}

fn input(text: &str) -> Result<Input, String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let (at, rest) = match words.as_slice() {
        ["at", at, rest @ ..] => (duration::parse(at)?, rest),
        rest => (Duration::ZERO, rest),
    };
    let input = Input { at, what: rest.join(" ") };
    // The text is checked on a controller that has all ports.
    let tried = Simulator::new(Start::default()).console(Duration::ZERO, &input.line());
    tried.map(|_| input).map_err(|why| format!("{why}; type an event such as \"at 2s 0/01/3 on\""))
}

impl Input {
    fn line(&self) -> String {
        format!("input {}", self.what)
    }
}

impl OfflineCommand for Run {
    type Report = Trace;
    const ID: &'static str = "toyo.sim.run";

    fn run(&self, screen: &Screen) -> Result<Trace> {
        let names = Names::new(self.name.clone());
        let mut sources = vec![source(screen, &names, 1, &self.file)?];
        for (task, file) in &self.task {
            if sources.iter().any(|source| source.task == *task) {
                return Err(Failure::usage(format!("--task {task}= appears twice"))
                    .hint("use one file for each task; task 1 has no --task"));
            }
            sources.push(source(screen, &names, *task, file)?);
        }
        let trace = self.trace(sources)?;
        screen.note(&trace.summary());
        Ok(trace)
    }
}

/// Location at which a controller with these points stops the program with an error. The program runs for up to some
/// seconds.
pub fn rehearse(file: &str, program: &Program, points: Option<&Path>) -> Result<Option<Stop>> {
    let run = Run {
        file: PathBuf::new(),
        task: Vec::new(),
        points: points.map(|path| (1, path.to_owned())).into_iter().collect(),
        params: None,
        state: None,
        input: Vec::new(),
        name: Vec::new(),
        from: 1,
        within: Some(REHEARSAL),
        every: None,
        rows: 0,
    };
    let sources = vec![Source { task: 1, file: file.to_owned(), program: program.clone() }];
    run.trace(sources).map(|trace| trace.stop)
}

impl Run {
    /// Runs the programs and returns the trace.
    fn trace(&self, sources: Vec<Source>) -> Result<Trace> {
        let start = self.start(&sources)?;
        let mut simulator = Simulator::new(start);
        simulator.record_trace(true);
        simulator.console(Duration::ZERO, &format!("start {}", self.from)).map_err(|why| {
            Failure::usage(format!("the program cannot be started: {why}"))
                .hint("check the step of --from, and the file of --state")
        })?;
        Ok(self.watch(&mut simulator, Recorder::new(sources, self.rows)))
    }

    /// Start state with the programs.
    fn start(&self, sources: &[Source]) -> Result<Start> {
        let state = match &self.state {
            Some(path) => {
                let bytes = files::read(path)?;
                let text = String::from_utf8(bytes).map_err(|_| {
                    Failure::usage(format!("{}: the file is not UTF-8 text", path.display()))
                        .hint("see `armctl help simulator` for the form of the file")
                })?;
                Start::parse(&text).map_err(|error| {
                    Failure::usage(format!("{}: {error}", path.display()))
                        .hint("see `armctl help simulator` for the form of the file")
                })?;
                text
            }
            None => "origin = true\n".to_owned(),
        };
        let mut written = Vec::new();
        if let Some(path) = &self.params {
            written.extend(parameter_writes(path)?);
        }
        // These writes come before power on, so that parameter 2 is active.
        let mut document: toml::Table = state.parse().map_err(|error| {
            Failure::usage(format!("{error}")).hint("see `armctl help simulator` for the form of the file")
        })?;
        if let toml::Value::Array(list) = document.entry("write").or_insert_with(|| toml::Value::Array(Vec::new())) {
            list.extend(written.into_iter().map(toml::Value::String));
        }
        for (task, path) in &self.points {
            let points = Points::with_letters(1, Letters::USUAL);
            for (point, changes) in rows_of_file(&points, path)? {
                let values = whole(path, &format!("point {point}"), &changes)?;
                place(&mut document, *task, point, &values);
            }
        }
        if let toml::Value::Table(steps) = document.entry("steps").or_insert_with(|| toml::Table::new().into()) {
            for Source { task, program, .. } in sources {
                let texts = program.steps.iter().map(|step| toml::Value::String(step.text()));
                steps.insert(task.to_string(), toml::Value::Array(texts.collect()));
            }
        }
        Start::parse(&document.to_string()).map_err(Failure::usage)
    }

    /// Runs the program and records the events.
    fn watch(&self, simulator: &mut Simulator, mut recorder: Recorder) -> Trace {
        let mut inputs: Vec<&Input> = self.input.iter().collect();
        inputs.sort_by_key(|input| input.at);
        let mut inputs = inputs.into_iter().peekable();
        let mut sample = self.every.map(|_| Duration::ZERO);
        let limit = self.within.unwrap_or(DEFAULT_TIME_LIMIT);
        let mut now = Duration::ZERO;
        loop {
            let mut end = None;
            for event in simulator.take_trace() {
                recorder.event(&event);
                end = match event.what {
                    What::Error(code) => Some(End::Error(code)),
                    What::Stopped => Some(End::Stopped),
                    What::Ended(_) if !simulator.state().executing => Some(End::Ended),
                    _ => end,
                };
            }
            let due = [simulator.wake(), inputs.peek().map(|input| input.at)].into_iter().flatten().min();
            let outcome = match (end, due) {
                (Some(end), _) => Some(end),
                (None, None) => Some(End::Waits),
                (None, Some(due)) if due > limit => Some(End::TimeUp),
                _ => None,
            };
            if let Some(outcome) = outcome {
                if outcome == End::TimeUp {
                    now = limit;
                    simulator.advance(now);
                }
                return recorder.ended(outcome, now, &simulator.state());
            }
            let due = due.unwrap_or(limit);
            now = sample.map_or(due, |sample| sample.min(due));
            simulator.advance(now);
            if let Some((at, every)) = sample.zip(self.every).filter(|(at, _)| *at == now) {
                recorder.position(now, simulator.state().position);
                sample = Some(at + every);
            }
            while let Some(input) = inputs.next_if(|input| input.at <= now) {
                let line = input.line();
                recorder.input(now, simulator.state().position, &line);
                // The port was already checked.
                if let Err(why) = simulator.console(now, &line) {
                    recorder.input(now, simulator.state().position, &why);
                }
            }
        }
    }
}

/// Returns the protocol commands that write the parameters of a file.
pub fn parameter_writes(path: &Path) -> Result<Vec<String>> {
    let mut start = Start::default();
    let mut commands = Vec::new();
    let mut rows = rows_of_file(&Parameters, path)?;
    rows.sort_by_key(|(key, _)| Parameters::rank(*key));
    for (key, changes) in rows {
        let values = whole(path, &key_text(key), &changes)?;
        let cell = Parameters.cell(key, values).map_err(|failure| in_file(path, &failure.message))?;
        let command = cell.write.text().trim_start_matches('@').to_owned();
        start = start.with_written(1, [&command[..]]).map_err(|why| in_file(path, &why))?;
        commands.push(command);
    }
    Ok(commands)
}

/// All values for a row of a file.
fn whole(path: &Path, row: &str, changes: &Changes) -> Result<Vec<Value>> {
    changes.whole().ok_or_else(|| in_file(path, &format!("{row}: values are missing")))
}

/// Failure: a row of a file cannot be used.
pub fn in_file(path: &Path, why: &str) -> Failure {
    Failure::usage(format!("{}: {why}", files::display_path(path))).hint("use `dump` to write a valid file")
}

/// Adds a point to a start state.
fn place(state: &mut toml::Table, task: usize, point: i32, values: &[Value]) {
    fn table(within: &mut toml::Table, key: String) -> Option<&mut toml::Table> {
        within.entry(key).or_insert_with(|| toml::Table::new().into()).as_table_mut()
    }
    let millimetres = |value: &Value| {
        let hundredths = if let Value::Number(hundredths) = value { *hundredths } else { 0 };
        toml::Value::Float(f64::from(hundredths) / 100.0)
    };
    let coordinates = values.iter().map(millimetres).collect();
    let rows = table(state, "points".to_owned()).and_then(|points| table(points, task.to_string()));
    if let Some(rows) = rows {
        rows.insert(point.to_string(), toml::Value::Array(coordinates));
    }
}

/// Reads the program in a file.
fn source(screen: &Screen, names: &Names, task: usize, file: &Path) -> Result<Source> {
    let name = files::display_path(file);
    let bytes = files::read(file)?;
    Ok(Source { task, program: text::program(&name, check_named(&bytes, MAX_STEPS, None, names), screen)?, file: name })
}
