//! `toyo program show --path`: the motion of a program, as the offline simulator runs it.

use std::collections::HashSet;

use super::folder::{check_file, parameters_of, points_of, program_of, programs_in};
use super::robot_data::{RobotData, Wanted, read_data};
use super::show::Show;
use crate::files;
use crate::prelude::*;
use armctl_controller::findings::Finding;
use armctl_controller::names::Names;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::program::{self, ControllerData, MAX_STEPS, Program};
use armctl_controller::toyo::request::instruction;
use armctl_controller::toyo::simulator::{Simulator, Start, What};
use armctl_controller::toyo::table::{Instruction, Op};
use armctl_frame::path::{Drawing, Interpolation, Moment, Motion, NotDrawn, PathOptions, PathReport, Step, simplify};
use armctl_frame::programs::source::ProgramFile;

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
    /// Points, groups and parameters.
    data: RobotData,
    /// Task of the program.
    task: u8,
    /// Whether the speeds are those of the robot.
    has_parameters: bool,
    /// Whether points that are not in `data` are 0, as in a backup. Otherwise they are not known.
    has_all_points: bool,
}

impl Command for ProgramPath {
    type Family = Toyo;
    type Report = PathReport;
    const ID: &'static str = "toyo.program.path";
    const USES_FILES: bool = true;

    fn risk(&self) -> Risk {
        if self.takes_robot() && self.task().is_some() { Risk::Write } else { Risk::Read }
    }

    fn takes_robot(&self) -> bool {
        self.options.from.is_none() && (self.show.program.is_none() || self.task().is_some())
    }

    fn run_alone(&self) -> Result<PathReport> {
        self.options.check(false)?;
        let (folder, show) = (self.options.from.as_deref(), &self.show);
        let is_file = show.program.is_some() && self.task().is_none();
        let source = match folder {
            Some(folder) if !is_file => of_folder(folder, &format!("program-{}", self.task().unwrap_or(1)))?,
            folder => {
                let path = PathBuf::from(show.program.as_deref().unwrap_or("-"));
                let name = files::display_path(&path);
                let file = ProgramFile { name: name.clone(), file: name, bytes: files::read(&path)? };
                match folder {
                    Some(folder) => with_data_of(folder, "program-1", file)?,
                    None => of_file(file, show.points.as_deref(), show.params.as_deref())?,
                }
            }
        };
        self.report(&source)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<PathReport> {
        let Context { link, screen, several, .. } = context;
        self.options.check(several)?;
        let set = program_of(link, screen, self.task()).await?;
        let file = set.files.into_iter().next().ok_or_else(|| Failure::local("internal error: no program was read"))?;
        let program = parse(&file)?;
        let data = read_data(link, screen, self.task(), &program, Wanted::Everything).await?;
        self.report(&Source {
            lines: lines(&file),
            task: task_of(&file.name),
            name: file.name,
            program,
            data,
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

    fn report(&self, source: &Source) -> Result<PathReport> {
        let old = match self.options.compare.as_deref() {
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
fn of_folder(folder: &Path, name: &str) -> Result<Source> {
    let set = programs_in(folder)?;
    let found = set.files.into_iter().find(|file| file.name == name);
    let file = found.ok_or_else(|| {
        Failure::usage(format!("{} contains no {name}", folder.display()))
            .hint("type the number of a task with a program")
    })?;
    with_data_of(folder, name, file)
}

/// A program with the parameters of a backup, and with the points for the named program of the backup.
fn with_data_of(folder: &Path, name: &str, file: ProgramFile) -> Result<Source> {
    let parameters = parameters_of(folder);
    let points = points_of(folder, name);
    let has_all_points = points.is_some();
    Ok(Source { has_all_points, ..of_file(file, points.as_deref(), parameters.as_deref())? })
}

fn of_file(file: ProgramFile, points: Option<&Path>, parameters: Option<&Path>) -> Result<Source> {
    let program = parse(&file)?;
    Ok(Source {
        lines: lines(&file),
        task: task_of(&file.name),
        name: file.name,
        program,
        data: RobotData::of_files(points, parameters)?,
        has_parameters: parameters.is_some(),
        has_all_points: false,
    })
}

/// Task of a program of a backup or of the controller; 1 for other programs.
fn task_of(name: &str) -> u8 {
    name.strip_prefix("program-").and_then(|task| task.parse().ok()).filter(|task| (1..=4).contains(task)).unwrap_or(1)
}

fn lines(file: &ProgramFile) -> Vec<String> {
    String::from_utf8_lossy(&file.bytes).lines().map(|line| line.trim().to_owned()).collect()
}

fn parse(file: &ProgramFile) -> Result<Program> {
    let checked = check_file(file, MAX_STEPS, &Names::default(), &ControllerData::default());
    let errors: Vec<Finding> = checked.errors().cloned().collect();
    checked.program.ok_or_else(|| files::file_failure(&file.file, &errors))
}

/// Runs a program in the simulator and records its path.
fn motion(source: &Source) -> Result<Motion> {
    let Source { name, program, lines, data, has_parameters, .. } = source;
    // Without parameters, all axes belong to task 1.
    let task = if *has_parameters { source.task } else { 1 };
    let internal = |why: String| {
        Failure::usage(format!("{name} cannot be drawn: {why}")).hint("use `toyo sim run` to see how the program runs")
    };
    let start = Start::parse("origin = true\n").map_err(internal)?;
    let start = start
        .with_written(task, data.writes.iter().map(|command| command.trim_start_matches('@')))
        .map_err(internal)?;
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
            *record = steps::nop();
        }
    }
    // Where a motion with PASS ends depends on its start. The start of the first motion is not known.
    if let Some(first) = steps.iter_mut().find(|record| record.word("arrival").is_some()) {
        *first = first.clone().with("arrival", Value::Word("POST"));
    }
    let mut start = start.with_program(task.into(), steps).map_err(internal)?;
    if task > 1 {
        let first = [&format!("TSTR TASK={task:02}")[..], "END"].into_iter().map(instruction).collect::<Result<_, _>>();
        start = start.with_program(1, first.map_err(|error| internal(error.to_string()))?).map_err(internal)?;
    }
    let mut simulator = Simulator::new(start);
    simulator.record_trace(true);
    simulator.console(Duration::ZERO, "start").map_err(internal)?;
    let mut run = Run {
        program,
        lines,
        source,
        task: task.into(),
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
    source: &'p Source,
    /// Task of the program.
    task: usize,
    /// Why the target of the current step is not known.
    missing: Option<String>,
    /// Latest step of the task.
    number: usize,
    /// Step of the task with its path so far.
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
                    What::Step { task, step } if task == self.task => {
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
                            let missing = |step: &program::Step| {
                                let Source { data, has_all_points, .. } = self.source;
                                data.missing(&step.record, counter.map_or(0, i32::from), *has_all_points)
                            };
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
                    What::Ended(task) if task != self.task => {}
                    What::Ended(_) | What::Stopped => {
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
