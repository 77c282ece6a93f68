//! `yerc job show --path`: the motion of a job.

use super::order::{Executed, RunOrder};
use super::programs::jobs_in;
use super::{Show, without_suffix};
use crate::file::{exact, fetch, plan_all};
use crate::item_requests::ReadError;
use crate::prelude::*;
use armctl_controller::references::{ProgrammedSpeed, Reference, Role};
use armctl_controller::yerc::job::{JobText, scan};
use armctl_controller::yerc::query::{ReadJob, ReadVariable};
use armctl_controller::yerc::variables::{Value, VariableKind};
use armctl_frame::local_names::folder_of;
use armctl_frame::path::{
    Drawing, Interpolation, Motion, NotDrawn, PathOptions, PathReport, Recorder, Step, arc, length,
};
use armctl_frame::programs::source::check_names;
use armctl_frame::text_files;

/// Maximum number of called jobs that are read from a controller.
const MAX_CALLED: usize = 50;
/// Frame of positions in pulses.
const JOINT: &str = "joint";
const SPACE: [&str; 7] = ["X", "Y", "Z", "Rx", "Ry", "Rz", "Re"];
const JOINTS: [&str; 8] = ["S", "L", "U", "R", "B", "T", "E", "8"];

/// Draws the motion of a job.
#[derive(Debug)]
pub struct JobPath {
    job: Option<String>,
    options: PathOptions,
}

impl From<(Show, PathOptions)> for JobPath {
    fn from((show, options): (Show, PathOptions)) -> Self {
        Self { job: show.job, options }
    }
}

/// Coordinates in a frame.
#[derive(Debug, Clone, PartialEq)]
struct Place {
    /// Frame with its tool, such as `base, tool 1`.
    frame: String,
    at: Vec<f64>,
}

/// What the motion of a job depends on.
#[derive(Debug, Default)]
struct Jobs {
    /// Texts of jobs by name.
    texts: BTreeMap<String, String>,
    /// Values of P variables; `None` if they are not known.
    variables: Option<BTreeMap<u16, Place>>,
}

impl Command for JobPath {
    type Family = Yerc;
    type Report = PathReport;
    const ID: &'static str = "yerc.job.path";
    const USES_FILES: bool = true;

    fn takes_robot(&self) -> bool {
        self.options.from.is_none() && self.file().is_none()
    }

    fn run_alone(&self) -> Result<PathReport> {
        self.options.check(false)?;
        if let (None, Some(path)) = (self.options.from.as_deref(), self.file()) {
            let bytes = text_files::read(&path)?;
            let text = String::from_utf8(bytes).unwrap_or_else(|error| Encoding::default().decode(error.as_bytes()));
            let name = JobText::new(&text).name.map(ToOwned::to_owned);
            let name = name.unwrap_or_else(|| without_suffix(&text_files::display_path(&path)).to_owned());
            // Jobs that the job calls are often next to it.
            let mut jobs = jobs_of_folder(&folder_of(&path)).unwrap_or_default();
            jobs.texts.insert(name.clone(), text);
            return self.report(&name, &jobs);
        }
        let jobs = jobs_of_folder(self.options.from.as_deref().unwrap_or(Path::new(".")))?;
        let job = self.job.as_deref().ok_or_else(|| {
            Failure::usage("the name of the job is missing")
                .hint("type a job, such as `yerc job show WELD --path --from FOLDER`")
        })?;
        let name = without_suffix(job).to_owned();
        check_names(std::slice::from_ref(&name), jobs.texts.keys().map(String::as_str))?;
        self.report(&name, &jobs)
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<PathReport> {
        let Context { link, several, .. } = context;
        self.options.check(several)?;
        let name = if let Some(job) = &self.job {
            without_suffix(job).to_owned()
        } else {
            let question = link.by_model(|model| ReadJob::new(model, 0)).await?;
            let info = link.ask(&question).await?;
            if info.name.is_empty() {
                return Err(Failure::new(Kind::ConditionNotMet, "no job is selected").hint("type the name of a job"));
            }
            link.encoding.decode(info.name.as_bytes())
        };
        if link.is_dry_run() {
            let file = job_file(link, &name)?;
            plan_all(link, "the text of the job", [file.save()])?;
            link.then("download of the jobs that the job calls, and reads of the P variables in its moves");
            return Err(unknown());
        }
        let jobs = read(link, &name).await?;
        self.report(&name, &jobs)
    }
}

impl JobPath {
    /// The file that the user named, if the word is the path of a file.
    fn file(&self) -> Option<PathBuf> {
        self.job.as_ref().map(PathBuf::from).filter(|path| path.is_file())
    }

    fn report(&self, name: &str, jobs: &Jobs) -> Result<PathReport> {
        let motion = motion(name, jobs, None);
        let old = match self.options.compare.as_deref() {
            Some(folder) => {
                let old = jobs_of_folder(folder)?;
                check_names(&[name.to_owned()], old.texts.keys().map(String::as_str)).map_err(|failure| Failure {
                    message: format!("{}: {}", folder.display(), failure.message),
                    ..failure
                })?;
                Some(self::motion(name, &old, Some(&motion.frame)))
            }
            None => None,
        };
        self.options.report(Drawing::new(motion, old))
    }
}

fn jobs_of_folder(folder: &Path) -> Result<Jobs> {
    let (set, encoding) = jobs_in(folder)?;
    let text = |file: &armctl_frame::programs::source::ProgramFile| {
        (without_suffix(&file.name).to_owned(), encoding.decode(&file.bytes))
    };
    Ok(Jobs { texts: set.files.iter().map(text).collect(), variables: None })
}

/// File of a job on the controller.
fn job_file(link: &Link, name: &str) -> Result<FileName> {
    let bytes = link.encoding.encode_name(&format!("{name}.JBI"));
    exact(bytes.map_err(|error| {
        Failure::usage(format!("the job name: {error}"))
            .hint("set the encoding with --encoding or in the robot's entry in robots.toml")
    })?)
}

/// Reads a job from the controller, the jobs that it calls, and the P variables of its moves.
async fn read(link: &mut Link, name: &str) -> Result<Jobs> {
    let mut jobs = Jobs::default();
    let mut open = vec![name.to_owned()];
    while let Some(next) = open.pop().filter(|_| jobs.texts.len() <= MAX_CALLED) {
        let (file, mut content) = (job_file(link, &next)?, Vec::new());
        let read = fetch(link, &file, |block| {
            content.extend_from_slice(block);
            Ok(())
        });
        match read.await {
            // A job that is called may be missing. The picture then says so.
            Err(failure) if failure.kind == Kind::Refused && next != name => continue,
            read => read?,
        };
        let text = link.encoding.decode(&content);
        let called = calls(&text);
        jobs.texts.insert(next, text);
        open.extend(called.into_iter().filter(|name| !jobs.texts.contains_key(name)));
    }
    let lines = jobs.texts.values().flat_map(|text| JobText::new(text).instructions);
    let moves = lines.filter(|(_, line)| interpolation(line).is_some());
    let numbers: BTreeSet<u16> = moves.filter_map(|(_, line)| variable(&scan(line).0)).collect();
    let numbers: Vec<u16> = numbers.into_iter().collect();
    let questions: Vec<ReadVariable> =
        numbers.iter().map(|number| ReadVariable::new(VariableKind::P, *number)).collect();
    let answers = link.ask_each(&questions).await?;
    let mut variables = BTreeMap::new();
    for (number, answer) in numbers.into_iter().zip(answers) {
        match answer {
            Ok(Value::Position(position)) => drop(variables.insert(number, place(&position))),
            Err(ReadError::Failed(failure)) => return Err(failure),
            _ => {}
        }
    }
    jobs.variables = Some(variables);
    Ok(jobs)
}

/// Jobs that a job calls.
fn calls(text: &str) -> Vec<String> {
    let lines = JobText::new(text).instructions.into_iter();
    let references = lines.flat_map(|(_, line)| scan(line).0);
    references.filter(|one| matches!(one.role, Role::Call | Role::Start)).map(|one| one.name).collect()
}

/// Coordinates of a variable.
fn place(position: &Position) -> Place {
    let tool = format!(", tool {}", position.tool);
    let (frame, scale) = match position.kind {
        PositionKind::Pulse => (JOINT.to_owned(), [1.0, 1.0]),
        PositionKind::User => (format!("user {}{tool}", position.user), [1e3, 1e4]),
        PositionKind::Base => (format!("base{tool}"), [1e3, 1e4]),
        PositionKind::Robot => (format!("robot{tool}"), [1e3, 1e4]),
        PositionKind::Tool | PositionKind::Other(_) => (format!("tool{tool}"), [1e3, 1e4]),
    };
    let axis = |(index, value): (usize, &i32)| f64::from(*value) / scale[usize::from(index >= 3)];
    Place { frame, at: position.axes.as_slice().iter().enumerate().take(6).map(axis).collect() }
}

/// Positions of the job, by their names.
fn positions(text: &str) -> BTreeMap<&str, Place> {
    let mut found = BTreeMap::new();
    let (mut kind, mut user, mut tool) = ("PULSE", "0", "0");
    for line in text.lines().map(str::trim).take_while(|line| *line != "NOP") {
        if let Some(rest) = line.strip_prefix("///") {
            match rest.split_once(' ') {
                Some(("POSTYPE", value)) => kind = value.trim(),
                Some(("USER", value)) => user = value.trim(),
                Some(("TOOL", value)) => tool = value.split(',').next().unwrap_or_default().trim(),
                _ => {}
            }
            continue;
        }
        let Some((key, values)) = line.split_once('=') else { continue };
        let Ok(at) = values.split(',').map(|value| value.trim().parse()).collect::<Result<Vec<f64>, _>>() else {
            continue;
        };
        let frame = match kind {
            "PULSE" => JOINT.to_owned(),
            "USER" => format!("user {user}, tool {tool}"),
            other => format!("{}, tool {tool}", other.to_lowercase()),
        };
        found.insert(key, Place { frame, at });
    }
    found
}

/// How an instruction moves; `None` if it is no motion of the robot.
fn interpolation(line: &str) -> Option<Interpolation> {
    Some(match line.split_whitespace().next()? {
        "MOVJ" | "SMOVJ" => Interpolation::Joints,
        "MOVL" | "SMOVL" => Interpolation::Straight,
        "MOVC" | "SMOVC" => Interpolation::Arc,
        "MOVS" | "SMOVS" => Interpolation::Curve,
        _ => return None,
    })
}

/// Number of the P variable that is the target of a motion.
fn variable(references: &[Reference]) -> Option<u16> {
    let target = references.iter().find(|one| !matches!(one.role, Role::Word))?;
    target.name.strip_prefix('P')?.parse().ok()
}

/// A line that moves the robot to a place.
struct Move {
    line: usize,
    text: String,
    name: String,
    /// Whether the place is the value of a P variable.
    is_variable: bool,
    interpolation: Interpolation,
    place: Place,
    speeds: Vec<ProgrammedSpeed>,
}

/// What a line means for the path.
enum Event {
    Move(Move),
    Wait(f64),
    /// The position is not known after this line. The line may be reported.
    Lost(Option<NotDrawn>),
}

/// The motion of a job. Without a preferred frame, the frame of most positions is drawn.
fn motion(name: &str, jobs: &Jobs, preferred: Option<&str>) -> Motion {
    let order = RunOrder::new(name, &jobs.texts);
    let places = jobs.texts.iter().map(|(name, text)| (name.as_str(), positions(text))).collect();
    let mut events: Vec<Event> = order.lines.iter().flat_map(|line| events_of(line, &places, jobs)).collect();
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for event in &events {
        let Event::Move(Move { place, .. }) = event else { continue };
        match counts.iter_mut().find(|(frame, _)| *frame == place.frame) {
            Some((_, count)) => *count += 1,
            None => counts.push((&place.frame, 1)),
        }
    }
    let most = counts.iter().map(|(_, count)| *count).max();
    let frame = counts.iter().find(|(frame, count)| preferred.map_or(Some(*count) == most, |one| one == *frame));
    let frame = frame.or(counts.first()).map_or(preferred.unwrap_or(JOINT), |(frame, _)| *frame).to_owned();
    for event in &mut events {
        if let Event::Move(Move { place, line, text, .. }) = event
            && place.frame != frame
        {
            let reason = format!("the position is in another frame: {}", place.frame);
            *event = Event::Lost(Some(NotDrawn { line: *line, text: text.clone(), reason }));
        }
    }
    let moves = events.iter().filter_map(|event| if let Event::Move(one) = event { Some(&one.place) } else { None });
    let count = moves.map(|place| place.at.len()).max().unwrap_or(6).min(7);
    let is_space = frame != JOINT;
    let mut motion = Motion {
        program: name.to_owned(),
        axes: if is_space { SPACE[..count].to_vec() } else { JOINTS[..count].to_vec() },
        unit: if is_space { "mm" } else { "pulses" },
        frame,
        ..Motion::default()
    };
    let mut recorder = Recorder::default();
    for index in 0..events.len() {
        match &events[index] {
            Event::Wait(seconds) => recorder.wait(*seconds),
            Event::Lost(omitted) => {
                recorder.lose_position();
                motion.not_drawn.extend(omitted.clone().filter(|one| !motion.not_drawn.contains(one)));
            }
            Event::Move(one) => {
                let (interpolation, via) =
                    if is_space { shape(&events, index) } else { (one.interpolation, Vec::new()) };
                let mut target = one.place.at.clone();
                target.resize(count, 0.0);
                let step = Step {
                    name: one.name.clone(),
                    line: one.line,
                    text: one.text.clone(),
                    interpolation,
                    track: Vec::new(),
                };
                recorder.go(step, &via, target, |points| if is_space { seconds(one, points) } else { None });
            }
        }
    }
    let has_speeds = events
        .iter()
        .any(|event| matches!(event, Event::Move(one) if one.speeds.iter().any(|speed| speed.unit == "mm/s")));
    (motion.steps, motion.is_timed) = recorder.finish();
    if motion.is_timed && has_speeds {
        motion.notes.push("V= is read as mm/s; ramps and the speed override are not included in the times.".to_owned());
    }
    let has_branches = order.lines.iter().any(|line| line.begins_branch);
    let notes = [
        (order.has_conditions, "Conditions are not evaluated: lines that depend on one are drawn in their order."),
        (has_branches, "Lines that only a jump with a condition reaches are drawn last, from their first position."),
        (order.repeats, "A loop is drawn once."),
        (order.is_cut(), "The job executes more lines; they are not drawn."),
    ];
    motion.notes.extend(notes.iter().filter(|(holds, _)| *holds).map(|(_, note)| (*note).to_owned()));
    let executed: BTreeSet<&str> = order.lines.iter().map(|line| line.job).collect();
    let stations = jobs.texts.iter().filter(|(name, _)| executed.contains(name.as_str()));
    if stations.flat_map(|(_, text)| JobText::new(text).positions).any(|one| one.key.starts_with(['B', 'E'])) {
        motion.notes.push("Positions of base axes and stations (BC, EC) are not drawn.".to_owned());
    }
    if events.iter().any(|event| matches!(event, Event::Move(one) if one.is_variable)) {
        motion.notes.push("P variables are drawn with their present values.".to_owned());
    }
    motion
}

/// What a line does, in its order.
fn events_of(executed: &Executed<'_>, places: &BTreeMap<&str, BTreeMap<&str, Place>>, jobs: &Jobs) -> Vec<Event> {
    let branch = executed.begins_branch.then_some(Event::Lost(None));
    branch.into_iter().chain(event(executed, places, jobs)).collect()
}

/// What a line does; `None` if it does not matter for the path.
fn event(executed: &Executed<'_>, places: &BTreeMap<&str, BTreeMap<&str, Place>>, jobs: &Jobs) -> Option<Event> {
    let Executed { line, text, .. } = *executed;
    let (references, speeds) = scan(text);
    let lost = |reason: String| Some(Event::Lost(Some(NotDrawn { line, text: executed.named(text), reason })));
    let first = text.split_whitespace().next()?;
    match (first, interpolation(text)) {
        ("TIMER", _) => {
            return text.split_once("T=").and_then(|(_, seconds)| seconds.trim().parse().ok()).map(Event::Wait);
        }
        ("IMOV" | "EIMOVL" | "EIMOVC", _) => {
            return lost("a move by a distance, whose frame is not followed".to_owned());
        }
        (word, None) if word.starts_with("+MOV") => return lost("a motion of another group".to_owned()),
        (_, None) => {
            let called = references.iter().find(|one| matches!(one.role, Role::Call | Role::Start))?;
            let is_missing = !jobs.texts.contains_key(&called.name);
            return match first {
                _ if is_missing => lost(format!("the job {} is not there", called.name)),
                "PSTART" => lost(format!("the job {} runs at the same time", called.name)),
                _ if executed.is_open_call => lost(format!("this call of {} leads back to it", called.name)),
                _ => None,
            };
        }
        _ => {}
    }
    let operand = text.split_whitespace().nth(1).unwrap_or_default();
    let number = variable(&references);
    let place = match (places.get(executed.job).and_then(|places| places.get(operand)), number) {
        (Some(place), _) => place.clone(),
        (None, Some(number)) => match jobs.variables.as_ref().map(|known| known.get(&number)) {
            Some(Some(place)) => place.clone(),
            Some(None) => return lost(format!("the variable P{number} is not defined")),
            None => return lost(format!("the value of the variable P{number} is not in the source")),
        },
        (None, None) => return lost(format!("the position {operand} is not known")),
    };
    Some(Event::Move(Move {
        line,
        text: executed.named(text),
        name: executed.named(operand),
        is_variable: number.is_some(),
        interpolation: interpolation(text)?,
        place,
        speeds,
    }))
}

/// Interpolation of a move, with the points between its start and its target. An arc has three positions of MOVC: the
/// robot moves to the first one on a straight line.
fn shape(events: &[Event], index: usize) -> (Interpolation, Vec<Vec<f64>>) {
    let at = |index: Option<usize>| match index.and_then(|index| events.get(index)) {
        Some(Event::Move(one)) => Some(one),
        _ => None,
    };
    let place = |index: Option<usize>| {
        at(index).filter(|one| one.interpolation == Interpolation::Arc).map(|one| one.place.at.as_slice())
    };
    match at(Some(index)) {
        Some(one) if one.interpolation != Interpolation::Arc => return (one.interpolation, Vec::new()),
        _ => {}
    }
    let [before, earlier, next] = [index.checked_sub(1), index.checked_sub(2), Some(index + 1)].map(place);
    match (earlier, before, place(Some(index)), next) {
        (_, None, _, _) => (Interpolation::Straight, Vec::new()),
        (Some(from), Some(via), Some(to), _) => (Interpolation::Arc, arc(from, via, to, false)),
        (None, Some(from), Some(via), Some(to)) => (Interpolation::Arc, arc(from, via, to, true)),
        _ => (Interpolation::Curve, Vec::new()),
    }
}

/// Duration of a move with these points.
fn seconds(one: &Move, points: &[Vec<f64>]) -> Option<f64> {
    let speed = |unit: &str| one.speeds.iter().find(|speed| speed.unit == unit && speed.value > 0.0);
    let [first, .., last] = points else { return None };
    if let Some(speed) = speed("mm/s") {
        return Some(length(points) / speed.value);
    }
    // A rotation about several axes has no simple length.
    let turns: Vec<f64> =
        first.iter().zip(last).skip(3).map(|(from, to)| (to - from).abs()).filter(|turn| *turn > 0.0).collect();
    match (speed("deg/s"), &turns[..]) {
        (Some(speed), [turn]) => Some(turn / speed.value),
        _ => None,
    }
}
