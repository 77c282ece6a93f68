//! `toyo program show --path`: the motion of a program, as the offline simulator runs it.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::folder::{check_file, points_of, program_of, programs_in};
use super::show::Show;
use crate::eeprom_tables::EepromRow as _;
use crate::files;
use crate::item_reads::read_each;
use crate::link::{Link, Toyo, wrong};
use crate::point::{Points, table};
use crate::prelude::*;
use crate::sim::{in_file, parameter_writes};
use crate::task_selection;
use armctl_controller::findings::Finding;
use armctl_controller::names::Names;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::program::{self, ControllerData, MAX_STEPS, Program, uses};
use armctl_controller::toyo::simulator::{Simulator, Start, What};
use armctl_controller::toyo::table::parameters::PARAMETERS;
use armctl_controller::toyo::table::{Instruction, Op};
use armctl_frame::path::{Drawing, Interpolation, Moment, Motion, NotDrawn, PathOptions, PathReport, Step, simplify};
use armctl_frame::programs::source::ProgramFile;
use armctl_frame::store::rows_of_file;

/// Interval of the positions.
const SAMPLE: Duration = Duration::from_millis(5);
/// Time in the program after which an endless program is no longer followed.
const LIMIT: Duration = Duration::from_secs(600);
/// Maximum number of steps of a run.
const MAX_RUN: usize = 200_000;
/// Maximum deviation of the drawn path in mm.
const DEVIATION: f64 = 0.05;
/// Motion that is too small to be drawn, in mm.
const STILL: f64 = 1e-6;

/// Draws the motion of a program.
#[derive(Debug)]
pub struct ProgramPath {
    show: Show,
    options: PathOptions,
}

impl From<(Show, PathOptions)> for ProgramPath {
    fn from((show, options): (Show, PathOptions)) -> Self {
        Self { show, options }
    }
}

/// A program with the data that it moves to.
struct Source {
    name: String,
    program: Program,
    /// Lines of the program.
    lines: Vec<String>,
    /// Protocol commands that write points and parameters.
    writes: Vec<String>,
    /// Whether the speeds are those of the robot.
    has_parameters: bool,
    /// Whether points that are not in `writes` are 0, as in a backup. Otherwise they are not known.
    has_all_points: bool,
}

/// Points and groups of the MVM table that are known.
struct Known {
    /// `None` if all points are known.
    points: Option<BTreeSet<i32>>,
    /// Points of each group.
    groups: BTreeMap<i32, Vec<i32>>,
}

impl Known {
    fn new(writes: &[String], has_all_points: bool) -> Self {
        let mut known = Self { points: (!has_all_points).then(BTreeSet::new), groups: BTreeMap::new() };
        let block = |text: &String| Request::parse(&format!("@{}", text.trim_start_matches('@'))).ok();
        for request in writes.iter().filter_map(block) {
            let numbers = request.content().ok().flatten().map(|record| numbers_of(&record)).unwrap_or_default();
            match (request.parameter().map(|parameter| parameter.id), &numbers[..]) {
                (Some("T1"), [point, ..]) => known.points.iter_mut().for_each(|points| points.extend([*point])),
                (Some("T4.S1"), [group, points @ ..]) => drop(known.groups.insert(*group, points.to_vec())),
                _ => {}
            }
        }
        known
    }

    /// Why the target of a step is not known; `None` if it is known. The counter of the step has this value.
    fn missing(&self, step: &Record, counter: i32) -> Option<String> {
        let is_known = |point: i32| self.points.as_ref().is_none_or(|points| points.contains(&point));
        if let Some(group) = step.number("group") {
            let Some(points) = self.groups.get(&group) else { return Some(format!("the group {group} is not known")) };
            let missing = points.iter().find(|point| **point > 0 && !is_known(**point))?;
            return Some(format!("the point {missing} of the group {group} is not known"));
        }
        let point = step.number("point")? + counter;
        (!is_known(point)).then(|| format!("the point {point} is not known"))
    }
}

/// The numbers of a record, in their order.
fn numbers_of(record: &Record) -> Vec<i32> {
    record
        .values()
        .iter()
        .filter_map(|value| if let Value::Number(number) = value { Some(*number) } else { None })
        .collect()
}

impl Command for ProgramPath {
    type Family = Toyo;
    type Report = PathReport;
    const ID: &'static str = "toyo.program.path";

    fn risk(&self) -> Risk {
        if self.takes_robot() && self.task().is_some() { Risk::Write } else { Risk::Read }
    }

    fn takes_robot(&self) -> bool {
        self.options.from().is_none() && (self.show.program.is_none() || self.task().is_some())
    }

    fn uses_files(&self) -> bool {
        true
    }

    fn run_alone(&self) -> Result<PathReport, Failure> {
        self.options.check(false)?;
        let source = match (self.options.from(), &self.show.program) {
            (Some(folder), _) => of_folder(folder, &format!("program-{}", self.task().unwrap_or(1)))?,
            (None, program) => {
                let path = PathBuf::from(program.as_deref().unwrap_or("-"));
                let name = files::display_path(&path);
                let file = ProgramFile { name: name.clone(), file: name, bytes: files::read(&path)? };
                of_file(file, self.show.points.as_deref(), self.show.params.as_deref())?
            }
        };
        self.report(&source)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<PathReport, Failure> {
        let Context { link, screen, several, .. } = context;
        self.options.check(several)?;
        let set = program_of(link, screen, self.task()).await?;
        let file = set.files.into_iter().next().ok_or_else(|| Failure::local("internal error: no program was read"))?;
        let program = parse(&file)?;
        let writes = read_data(link, screen, self.task(), &program).await?;
        self.report(&Source {
            lines: lines(&file),
            name: file.name,
            program,
            writes,
            has_parameters: true,
            has_all_points: false,
        })
    }
}

impl ProgramPath {
    /// Number of the task, if the user typed one.
    fn task(&self) -> Option<u8> {
        self.show.program.as_ref()?.parse().ok().filter(|task| (1..=4).contains(task))
    }

    fn report(&self, source: &Source) -> Result<PathReport, Failure> {
        let old = match self.options.compare() {
            Some(folder) => {
                let name = if source.name.starts_with("program-") { source.name.as_str() } else { "program-1" };
                Some(motion(&of_folder(folder, name)?)?)
            }
            None => None,
        };
        self.options.report(Drawing::new(motion(source)?, old))
    }
}

/// A program of a backup, with its points and parameters.
fn of_folder(folder: &Path, name: &str) -> Result<Source, Failure> {
    let set = programs_in(folder)?;
    let found = set.files.into_iter().find(|file| file.name == name);
    let file = found.ok_or_else(|| {
        Failure::usage(format!("{} contains no {name}", folder.display()))
            .hint("type the number of a task with a program")
    })?;
    let parameters = Some(folder.join("parameters.csv")).filter(|path| path.exists());
    let points = points_of(folder, name);
    let has_all_points = points.is_some();
    Ok(Source { has_all_points, ..of_file(file, points.as_deref(), parameters.as_deref())? })
}

fn of_file(file: ProgramFile, points: Option<&Path>, parameters: Option<&Path>) -> Result<Source, Failure> {
    let program = parse(&file)?;
    let mut writes = parameters.map(parameter_writes).transpose()?.unwrap_or_default();
    let table = Points::with_letters(1, Letters::USUAL);
    if let Some(path) = points {
        for (number, changes) in rows_of_file(&table, path)? {
            let values =
                changes.whole().ok_or_else(|| in_file(path, &format!("point {number}: values are missing")))?;
            writes.push(table.cell(number, values)?.write.text());
        }
    }
    Ok(Source {
        lines: lines(&file),
        name: file.name,
        program,
        writes,
        has_parameters: parameters.is_some(),
        has_all_points: false,
    })
}

fn lines(file: &ProgramFile) -> Vec<String> {
    String::from_utf8_lossy(&file.bytes).lines().map(|line| line.trim().to_owned()).collect()
}

fn parse(file: &ProgramFile) -> Result<Program, Failure> {
    let checked = check_file(file, MAX_STEPS, &Names::default(), &ControllerData::default());
    let errors: Vec<Finding> = checked.errors().cloned().collect();
    checked.program.ok_or_else(|| files::file_failure(&file.file, &errors))
}

/// Reads the parameters of the controller, and the table rows and points that a program uses. Returns the commands that
/// write them.
async fn read_data(
    link: &mut Link,
    screen: &Screen,
    task: Option<u8>,
    program: &Program,
) -> Result<Vec<String>, Failure> {
    let records: Vec<Record> = program.steps.iter().map(|step| step.record.clone()).collect();
    let rows = uses(&records);
    // The rows of a table begin with the same two characters as its sheets.
    let used = |id: &'static str| rows.iter().filter(move |(table, _)| table[..2] == id[..2]).map(|(_, row)| *row);
    let tables = PARAMETERS.iter().filter(|parameter| parameter.only_on.is_empty() && parameter.id != table().id);
    let wanted = tables.flat_map(|parameter| match parameter.row() {
        None => vec![(parameter, None)],
        Some(_) => used(parameter.id).map(|row| (parameter, Some(row))).collect(),
    });
    let mut writes = read_writes(link, screen, "reading parameters", wanted.collect()).await?;
    let is_computed = |record: &Record| record.number("counter").is_some_and(|counter| counter > 0);
    let points: BTreeSet<i32> = if records.iter().any(|record| record.number("point").is_some() && is_computed(record))
    {
        Points::all().into_iter().collect()
    } else {
        used(table().id)
            .chain(Known::new(&writes, false).groups.into_values().flatten())
            .filter(|row| *row > 0)
            .collect()
    };
    let wanted = points.into_iter().map(|point| (table(), Some(point))).collect();
    task_selection::select_task(link, task).await?;
    let read = read_writes(link, screen, "reading points", wanted).await;
    writes.extend(task_selection::restore_task(link, read).await?);
    Ok(writes)
}

/// Reads parameters and rows. Returns the commands that write those that were read.
async fn read_writes(
    link: &mut Link,
    screen: &Screen,
    what: &str,
    wanted: Vec<(&'static Parameter, Option<i32>)>,
) -> Result<Vec<String>, Failure> {
    let requests = wanted.iter().map(|(parameter, row)| Request::read_parameter(parameter, *row));
    let requests: Vec<Request> = requests.collect::<Result<_, _>>().map_err(|error| wrong(&error))?;
    let answers = read_each(link, screen, what, &requests).await?;
    let write = |((parameter, _), answer): ((&Parameter, _), Result<Record, Failure>)| {
        let record = answer.ok().filter(Record::is_listed)?;
        Request::write_parameter(parameter, record.values()).ok().map(|request| request.text())
    };
    Ok(wanted.into_iter().zip(answers).filter_map(write).collect())
}

/// Runs a program in the simulator and records its path.
fn motion(source: &Source) -> Result<Motion, Failure> {
    let Source { name, program, lines, writes, has_parameters, has_all_points } = source;
    let known = Known::new(writes, *has_all_points);
    let internal = |why: String| {
        Failure::usage(format!("{name} cannot be drawn: {why}")).hint("use `toyo sim run` to see how the program runs")
    };
    let start = Start::parse("origin = true\n").map_err(internal)?;
    let start =
        start.with_written(1, writes.iter().map(|command| command.trim_start_matches('@'))).map_err(internal)?;
    let mut motion = Motion {
        program: name.clone(),
        frame: "base".to_owned(),
        axes: vec!["X", "Y", "Z", "R"],
        unit: "mm",
        is_timed: true,
        ..Motion::default()
    };
    let mut steps: Vec<Record> = program.steps.iter().map(|step| step.record.clone()).collect();
    for (step, record) in program.steps.iter().zip(&mut steps) {
        if matches!(op(&step.text()), Some(Op::Tstr)) {
            motion.not_drawn.push(NotDrawn {
                line: step.line,
                text: step.text(),
                reason: "the program of another task".to_owned(),
            });
            *record = super::steps::nop();
        }
    }
    // Where a motion with PASS ends depends on its start. The start of the first motion is not known.
    if let Some(first) = steps.iter_mut().find(|record| record.word("arrival").is_some()) {
        *first = first.clone().with("arrival", Value::Word("POST"));
    }
    let mut simulator = Simulator::new(start.with_program(1, steps).map_err(internal)?);
    simulator.record_trace(true);
    simulator.console(Duration::ZERO, "start").map_err(internal)?;
    let mut run = Run {
        program,
        lines,
        known: &known,
        missing: None,
        number: 0,
        current: None,
        steps: Vec::new(),
        is_known: false,
        legs: HashSet::new(),
        useful: 0,
    };
    let end = run.follow(&mut simulator, &mut motion);
    motion.steps = run.steps;
    let began = motion.moments().next().map_or(0.0, |moment| moment.time);
    motion.steps.iter_mut().flat_map(|step| &mut step.track).for_each(|moment| moment.time -= began);
    if end == End::TimeUp {
        motion.steps.truncate(run.useful);
        let end = motion.end();
        motion.notes.push(format!("The program does not end: after {end:.2} s, it repeats what is drawn."));
    }
    if !motion.not_drawn.is_empty() {
        motion.notes.push("The times after a line that is not drawn can differ from those of the robot.".to_owned());
    }
    motion.notes.push(if *has_parameters {
        "Times, pallets and offsets are those of the offline simulator with the parameters of the robot.".to_owned()
    } else {
        "Times and offsets are those of the offline simulator, with the speeds and parameters of a new controller."
            .to_owned()
    });
    Ok(motion)
}

/// Why a run was followed no longer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Over,
    TimeUp,
}

/// A run of the simulator.
struct Run<'p> {
    program: &'p Program,
    lines: &'p [String],
    known: &'p Known,
    /// Why the target of the current step is not known.
    missing: Option<String>,
    /// Latest step of task 1.
    number: usize,
    /// Step of task 1 with its path so far.
    current: Option<(usize, Vec<Moment>)>,
    steps: Vec<Step>,
    /// Whether the position is known: after the first move to an absolute position.
    is_known: bool,
    /// Moves that were already drawn: step, start and target in 0.01 mm.
    legs: HashSet<String>,
    /// Number of steps up to the last one that is not a repetition.
    useful: usize,
}

impl Run<'_> {
    fn follow(&mut self, simulator: &mut Simulator, motion: &mut Motion) -> End {
        let mut now = Duration::ZERO;
        let mut inputs: BTreeMap<(i32, i32), u8> = BTreeMap::new();
        let mut assumed: Vec<usize> = Vec::new();
        let mut count = 0;
        let end = loop {
            let mut is_over = false;
            for event in simulator.take_trace() {
                match event.what {
                    What::Step { task: 1, step } => {
                        count += 1;
                        self.close(moment(event.at, event.position), motion);
                        self.number = step;
                        self.missing = self.step().and_then(|step| {
                            let counter = step.record.number("counter").and_then(|number| usize::try_from(number).ok());
                            let counter =
                                counter.filter(|number| *number > 0).and_then(|number| simulator.counter(number));
                            // An arc has two steps, and ends at the second one.
                            let next = self
                                .program
                                .steps
                                .get(self.number)
                                .filter(|_| self.interpolation(self.number) == Some(Interpolation::Arc));
                            let missing =
                                |step: &program::Step| self.known.missing(&step.record, counter.map_or(0, i32::from));
                            missing(step).or_else(|| missing(next?))
                        });
                        self.current = Some((step, vec![moment(event.at, event.position)]));
                    }
                    What::Error(code) => {
                        let place = moment(event.at, event.position);
                        if self.is_known {
                            self.close(place, motion);
                        }
                        self.stop(motion, format!("the run stops here: error {}", errors::explain(code).in_a_line()));
                        is_over = true;
                    }
                    What::Ended(1) | What::Stopped => {
                        self.close(moment(event.at, event.position), motion);
                        is_over = true;
                    }
                    _ => {}
                }
            }
            if is_over {
                break End::Over;
            }
            if now >= LIMIT || count > MAX_RUN {
                break End::TimeUp;
            }
            let Some(due) = simulator.wake() else {
                // Nothing happens by itself: the program waits for an input, which is then set.
                match self.awaited(&mut inputs) {
                    Some((line, console)) if simulator.console(now, &console).is_ok() && simulator.wake().is_some() => {
                        assumed.push(line);
                        continue;
                    }
                    _ => {
                        self.stop(motion, "the run waits here without end".to_owned());
                        break End::Over;
                    }
                }
            };
            let is_moving = self.current.as_ref().is_some_and(|(step, _)| self.interpolation(*step).is_some());
            now = if is_moving { due.min(now + SAMPLE) } else { due };
            simulator.advance(now);
            if let Some((_, track)) = &mut self.current {
                track.push(moment(now, simulator.state().position));
            }
        };
        assumed.sort_unstable();
        assumed.dedup();
        let lines: Vec<String> = assumed.iter().take(8).map(usize::to_string).collect();
        motion.notes.push(match &lines[..] {
            [] => "Inputs are off.".to_owned(),
            [line] => format!("Inputs are off, except where the program waits for them (line {line})."),
            lines => format!("Inputs are off, except where the program waits for them (lines {}).", lines.join(", ")),
        });
        end
    }

    /// Ends the current step.
    fn close(&mut self, end: Moment, motion: &mut Motion) {
        let Some((number, mut track)) = self.current.take() else { return };
        track.push(end);
        let Some(step) = self.program.steps.get(number - 1) else { return };
        let (Some(first), Some(last)) = (track.first(), track.last()) else { return };
        let Some(interpolation) = self.interpolation(number) else { return };
        let text = self.text(step.line);
        // MVB goes back to a position that an earlier move had.
        let is_relative = step.record.word("aim") == Some("i") || op(&step.text()) == Some(Op::Mvb);
        let missing = self.missing.take();
        if missing.is_some() || !self.is_known && is_relative {
            let reason = missing.unwrap_or_else(|| "a move from a position that is not known".to_owned());
            let omitted = NotDrawn { line: step.line, text, reason };
            if !motion.not_drawn.contains(&omitted) {
                motion.not_drawn.push(omitted);
            }
            self.is_known = false;
            return;
        }
        if self.is_known
            && track.iter().all(|moment| moment.at.iter().zip(&first.at).all(|(a, b)| (a - b).abs() < STILL))
        {
            return;
        }
        let point = step.record.number("point").filter(|point| *point > 0 && !is_relative);
        let point = point.filter(|_| step.record.number("counter").unwrap_or_default() == 0);
        let name = point.map_or_else(|| format!("step {number}"), |point| format!("PT{point}"));
        if self.legs.insert(format!("{number} {:.2?} {:.2?}", first.at, last.at)) {
            self.useful = self.steps.len() + 1;
        }
        let (interpolation, track) = if self.is_known {
            (interpolation, simplify(track, DEVIATION))
        } else {
            // The simulator starts at 0, but the robot can start anywhere.
            (Interpolation::Start, vec![last.clone()])
        };
        self.is_known = true;
        self.steps.push(Step { name, line: step.line, text, interpolation, track });
    }

    /// The current step.
    fn step(&self) -> Option<&program::Step> {
        self.program.steps.get(self.number.checked_sub(1)?)
    }

    fn text(&self, line: usize) -> String {
        self.lines.get(line - 1).cloned().unwrap_or_default()
    }

    /// How a step moves; `None` if it does not move.
    fn interpolation(&self, number: usize) -> Option<Interpolation> {
        let step = self.program.steps.get(number.checked_sub(1)?)?;
        match op(&step.text())? {
            Op::Mvc | Op::Mvcp => Some(Interpolation::Arc),
            Op::Home => Some(Interpolation::Joints),
            _ => match step.record.word("course")? {
                "T" => Some(Interpolation::Straight),
                _ => Some(Interpolation::Joints),
            },
        }
    }

    /// Line of the step that waits for an input, and the console line that sets the input.
    fn awaited(&self, inputs: &mut BTreeMap<(i32, i32), u8>) -> Option<(usize, String)> {
        let (number, _) = self.current.as_ref()?;
        let step = self.program.steps.get(number - 1)?;
        op(&step.text()).filter(|op| *op == Op::In)?;
        let (station, port) = (step.record.number("station")?, step.record.number("port")?);
        let mask = step.record.mask("data")?;
        let bits = inputs.entry((station, port)).or_default();
        *bits = *bits & !mask.care | mask.bits;
        Some((step.line, format!("input {station}/{port:02} {bits:08b}")))
    }

    /// Lists the current step as the end of the picture.
    fn stop(&self, motion: &mut Motion, reason: String) {
        let step = self.step();
        motion.not_drawn.extend(step.map(|step| NotDrawn { line: step.line, text: self.text(step.line), reason }));
    }
}

fn moment(at: Duration, position: [f64; 4]) -> Moment {
    Moment { time: at.as_secs_f64(), at: position.to_vec() }
}

fn op(text: &str) -> Option<Op> {
    Instruction::named(text.split(' ').next()?).map(|row| row.op)
}
