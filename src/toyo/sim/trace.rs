//! Trace of the events in a simulated run.

use std::collections::VecDeque;

use crate::explain::alarm_from_code;
use crate::position::Coordinates;
use crate::prelude::*;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::program::Program;
use armctl_controller::toyo::request::instruction;
use armctl_controller::toyo::simulator::{Event, State, What};
use armctl_controller::toyo::table::{Instruction, Op};
use armctl_frame::robot::alarm::Alarm;

/// The program of a task, with its file.
#[derive(Debug)]
pub struct Source {
    /// Number of the task, 1 to 4.
    pub task: usize,
    /// Name of the file.
    pub file: String,
    /// Program.
    pub program: Program,
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Every started task reached its END.
    Ended,
    /// The program stopped at a STOP.
    Stopped,
    /// An error of the controller stopped the program.
    Error(u8),
    /// Every task waits without an end.
    Waits,
    /// The time limit was reached.
    TimeUp,
}

/// Records the events of a run.
#[derive(Debug)]
pub struct Recorder {
    sources: Vec<Source>,
    rows: VecDeque<Row>,
    most: usize,
    left_out: usize,
    /// Current step of each running task.
    at: BTreeMap<usize, usize>,
    ports: BTreeMap<(usize, usize), u8>,
}

/// Report of a run: its events and its end.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Trace {
    /// Why the run ended: `ended`, `stopped`, `error`, `waits` or `time_up`.
    end: &'static str,
    /// Alarm at the end; null without an alarm.
    alarm: Option<Alarm>,
    /// Time in the program at the end.
    elapsed_s: f64,
    /// Position at the end.
    position: Coordinates,
    /// Output ports in which a bit is on at the end.
    outputs: Vec<Port>,
    /// Current steps of the tasks that have not ended.
    steps: Vec<TraceStep>,
    /// Events in order.
    trace: VecDeque<Row>,
    /// Number of earlier rows that were omitted.
    rows_left_out: usize,
    #[serde(skip)]
    failure: Option<Failure>,
    /// Location in task 1 at which the controller stopped with an error, or at which every task waited.
    #[serde(skip)]
    pub stop: Option<Stop>,
}

/// Location of an error or of an endless wait.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    /// Error code; `None` for an endless wait.
    pub code: Option<u8>,
    /// Time in the program.
    pub after_s: f64,
    /// Line number in the file, starting with 1.
    pub line: usize,
}

/// An output port.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
struct Port {
    /// Station, 0 to 4.
    station: usize,
    port: usize,
    /// Bits 8 to 1 of the port.
    bits: String,
}

/// A step of a task, with its location in the file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
struct TraceStep {
    task: usize,
    step: usize,
    file: String,
    /// Line number in the file, starting with 1.
    line: usize,
    /// Label that this step defines or uses.
    label: Option<String>,
    instruction: String,
}

/// A row of the trace: one event.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
struct Row {
    time_s: f64,
    /// Type of the event: `step`, `output`, `input`, `position`, `origin`, `stopped`, `error` or `ended`.
    event: &'static str,
    /// Text of the event.
    what: String,
    /// Step that begins or ends; null for other events.
    at: Option<TraceStep>,
    /// Output port that changed; null for other events.
    port: Option<Port>,
    #[serde(flatten)]
    place: Coordinates,
}

impl Recorder {
    /// Creates a recorder for these programs, with a maximum number of rows.
    pub fn new(sources: Vec<Source>, most: usize) -> Self {
        let (rows, at, ports) = (VecDeque::new(), BTreeMap::new(), BTreeMap::new());
        Self { sources, rows, most, left_out: 0, at, ports }
    }

    /// Records an event of the simulator.
    pub fn event(&mut self, event: &Event) {
        let mut row = Row::new(event.at, event.position, "step", String::new());
        match &event.what {
            What::Step { task, step } => {
                self.at.insert(*task, *step);
                row.at = self.find(*task, *step);
                row.what = row.at.as_ref().map_or_else(|| format!("step {step} of task {task}"), TraceStep::in_words);
            }
            What::Output { station, port, bits } => {
                self.ports.insert((*station, *port), *bits);
                let port = Port::new(*station, *port, *bits);
                (row.event, row.what, row.port) = ("output", port.in_words(), Some(port));
            }
            What::Error(code) => {
                (row.event, row.what) = ("error", format!("error {}", errors::explain(*code).in_a_line()));
            }
            What::Stopped => (row.event, row.what) = ("stopped", "stopped".to_owned()),
            What::Ended(task) => {
                row.at = self.at.remove(task).and_then(|step| self.find(*task, step));
                (row.event, row.what) = ("ended", format!("task {task} has ended"));
            }
            What::Origin => (row.event, row.what) = ("origin", "the origin is known".to_owned()),
            What::Console(text) => (row.event, row.what) = ("input", text.clone()),
        }
        self.add(row);
    }

    /// Records an input event.
    pub fn input(&mut self, at: Duration, position: [f64; 4], what: &str) {
        self.add(Row::new(at, position, "input", what.to_owned()));
    }

    /// Records a position.
    pub fn position(&mut self, at: Duration, position: [f64; 4]) {
        self.add(Row::new(at, position, "position", "position".to_owned()));
    }

    /// Completes the trace.
    pub fn ended(self, end: End, at: Duration, state: &State) -> Trace {
        let steps: Vec<TraceStep> = self.at.iter().filter_map(|(task, step)| self.find(*task, *step)).collect();
        let ports = self.ports.iter().filter(|(_, bits)| **bits != 0);
        let after_s = at.as_secs_f64();
        let line = steps.iter().find(|at| at.task == 1).map(|at| at.line);
        let code = if let End::Error(code) = end { Some(code) } else { None };
        let stop = line.filter(|_| code.is_some() || end == End::Waits).map(|line| Stop { code, after_s, line });
        Trace {
            stop,
            end: end.name(),
            alarm: if let End::Error(code) = end { Some(alarm_from_code(code)) } else { None },
            elapsed_s: after_s,
            position: Coordinates::at(state.position),
            outputs: ports.map(|((station, port), bits)| Port::new(*station, *port, *bits)).collect(),
            failure: end.failure(at, &steps),
            steps,
            trace: self.rows,
            rows_left_out: self.left_out,
        }
    }

    fn add(&mut self, row: Row) {
        self.rows.push_back(row);
        if self.rows.len() > self.most {
            self.rows.pop_front();
            self.left_out += 1;
        }
    }

    fn find(&self, task: usize, step: usize) -> Option<TraceStep> {
        let Source { file, program, .. } = self.sources.iter().find(|source| source.task == task)?;
        let program_step = program.steps.get(step.checked_sub(1)?)?;
        let tag = ["tag", "then"].into_iter().find_map(|name| program_step.record.number(name));
        let label = program.labels.iter().find(|label| Some(label.tag) == tag);
        Some(TraceStep {
            task,
            step,
            file: file.clone(),
            line: program_step.line,
            label: label.map(|label| label.name.clone()),
            instruction: program_step.text(),
        })
    }
}

impl End {
    const fn name(self) -> &'static str {
        match self {
            Self::Ended => "ended",
            Self::Stopped => "stopped",
            Self::Error(_) => "error",
            Self::Waits => "waits",
            Self::TimeUp => "time_up",
        }
    }

    /// Failure that the end of a run means.
    fn failure(self, at: Duration, steps: &[TraceStep]) -> Option<Failure> {
        let places: Vec<String> = steps.iter().map(TraceStep::in_a_line).collect();
        let places = places.join("; ");
        let failed = |what: String| Failure::new(Kind::ConditionNotMet, what);
        let after = at.as_secs_f64();
        Some(match self {
            Self::Ended | Self::Stopped => return None,
            Self::Error(code) => {
                let error = errors::explain(code);
                failed(format!("after {after:.3} s, error {}: {places}", error.in_a_line()))
                    .hint(error.remedy)
                    .code(format!("{code:02X}"))
            }
            Self::Waits => {
                let what = steps.iter().find_map(TraceStep::awaited_condition).unwrap_or("something");
                let hint = steps
                    .iter()
                    .find_map(TraceStep::help)
                    .unwrap_or_else(|| "check what the tasks wait for; no other task runs".into());
                failed(format!("after {after:.3} s, all tasks wait for {what} without end: {places}")).hint(hint)
            }
            Self::TimeUp => {
                failed(format!("after {after:.3} s, the program still runs: {places}")).hint("use --for to run longer")
            }
        })
    }
}

impl TraceStep {
    /// Formats the step with its label, for example `next: TAG TAG=001` or `JMP TAG=001 (next)`.
    fn in_words(&self) -> String {
        match &self.label {
            Some(label) if self.instruction.starts_with("TAG ") => format!("{label}: {}", self.instruction),
            Some(label) => format!("{} ({label})", self.instruction),
            None => self.instruction.clone(),
        }
    }

    /// Formats the step with its location, for example `pick.txt:7, task 1, step 5: IN STN=0 PN01=.......1 AND`.
    fn in_a_line(&self) -> String {
        let Self { task, step, file, line, .. } = self;
        format!("{file}:{line}, task {task}, step {step}: {}", self.in_words())
    }

    fn op(&self) -> Option<Op> {
        Instruction::named(self.instruction.split(' ').next()?).map(|row| row.op)
    }

    /// Condition that a step waits for.
    fn awaited_condition(&self) -> Option<&'static str> {
        Some(match self.op()? {
            Op::In => "an input",
            Op::Insp => "an internal port",
            Op::Cwit => "a count",
            Op::Rsmv => "coordinates of the host",
            _ => return None,
        })
    }

    /// Hint how to meet the condition.
    fn help(&self) -> Option<String> {
        let record = instruction(&self.instruction).ok().filter(|_| self.op() == Some(Op::In))?;
        let (station, port, mask) = (record.number("station")?, record.number("port")?, record.mask("data")?);
        let bit = (0..8).find(|bit| mask.care >> bit & 1 == 1)?;
        let state = if mask.bits >> bit & 1 == 1 { "on" } else { "off" };
        Some(format!("set the input with --input \"at 2s {station}/{port:02}/{} {state}\"", bit + 1))
    }
}

impl Port {
    fn new(station: usize, port: usize, bits: u8) -> Self {
        Self { station, port, bits: format!("{bits:08b}") }
    }

    fn in_words(&self) -> String {
        let Self { station, port, bits } = self;
        format!("output {station}/{port:02} = {bits}")
    }
}

impl Row {
    fn new(at: Duration, position: [f64; 4], event: &'static str, what: String) -> Self {
        Self { time_s: at.as_secs_f64(), event, what, at: None, port: None, place: Coordinates::at(position) }
    }
}

impl Trace {
    /// The end of the run in one line.
    pub fn summary(&self) -> String {
        let outputs: Vec<String> = self.outputs.iter().map(Port::in_words).collect();
        let outputs = if outputs.is_empty() { "no output is on".to_owned() } else { outputs.join(", ") };
        let more = match self.rows_left_out {
            0 => String::new(),
            rows => format!("; {rows} earlier rows were omitted, use --rows to print more"),
        };
        let end = match self.end {
            "ended" | "stopped" => format!("{} after {:.3} s: ", self.end, self.elapsed_s),
            _ => String::new(),
        };
        format!("{end}{}; {outputs}{more}", self.position.in_a_line())
    }
}

/// A column and its axis.
type Axis = (&'static str, usize);

impl Report for Trace {
    const ROWS: RowsOf = RowsOf::List("trace");

    /// Columns for axes that stay at 0 are omitted. With only one task, the column for the task is omitted.
    fn view(&self) -> View {
        let axes: [Axis; 4] = [("x (mm)", 0), ("y (mm)", 1), ("z (mm)", 2), ("r (mm)", 3)];
        let has_tasks = self.trace.iter().any(|row| row.at.as_ref().is_some_and(|at| at.task > 1));
        let moves = |axis: usize| self.trace.iter().any(|row| row.place.mm()[axis] != 0.0);
        let axes: Vec<_> = axes.into_iter().filter(|(name, axis)| *name == "x (mm)" || moves(*axis)).collect();
        let mut columns = vec!["time (s)"];
        columns.extend(has_tasks.then_some("task"));
        columns.extend(["step", "line", "what"]);
        columns.extend(axes.iter().map(|(name, _)| *name));
        let mut table = Table::new(&columns, "nothing happened");
        for row in &self.trace {
            let number =
                |of: fn(&TraceStep) -> usize| row.at.as_ref().map_or_else(|| Cell::number(""), |at| of(at).into());
            let tone = match row.event {
                "error" => Tone::Bad,
                "output" | "ended" => Tone::Good,
                "input" | "stopped" => Tone::Warning,
                _ => Tone::Plain,
            };
            let mut cells = vec![Cell::number(format!("{:.3}", row.time_s))];
            cells.extend(has_tasks.then(|| number(|at| at.task)));
            cells.extend([number(|at| at.step), number(|at| at.line), Cell::from(row.what.as_str()).tone(tone)]);
            cells.extend(axes.iter().map(|(_, axis)| Cell::number(format!("{:.2}", row.place.mm()[*axis]))));
            table.rows.push(cells);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
