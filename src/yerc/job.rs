//! `yerc job`: jobs of the controller, and of folders.

mod calls;
mod check;
mod list;
mod order;
mod path;
#[cfg(test)]
mod program_tests;
mod programs;
mod search;
mod source;
mod start;
mod stop;

use std::str::FromStr;

use self::source::Source;
pub use self::stop::Stop;
use super::control_commands::refuse_controls;
use super::file::Edit;
use super::item_requests::{Outcome, ReadError};
use super::link::{Link, Yerc};
use super::number_arguments::parse_in_range;
use crate::complete;
use crate::item_requests::read_failure;
use crate::prelude::*;
use armctl_controller::text::Name;
use armctl_controller::units;
use armctl_controller::user_input;
use armctl_controller::yerc::payload::JobInfo;
use armctl_controller::yerc::query::{ReadJob, SelectJob, Selection};
use armctl_controller::yerc::status::{self, is_absent};
use armctl_frame::items;
use armctl_frame::items::{ItemError, ItemOutcome};
use armctl_frame::path::Drawable;

commands! {
    /// Jobs.
    pub enum Job {
        /// List the jobs of the controller
        List(list::List),
        /// Show the running job: name, line, step, speed override; with --path, the motion of a job
        Show(Drawable<Show, path::JobPath>),
        /// Select the job to start
        Select(Select),
        /// Start the selected job, or a job by name
        Start(start::Start),
        /// Stop the running job: HOLD on
        Stop(Stop<true>),
        /// Edit a job in your editor and write it back
        Edit(Edit),
        /// Find a text, a variable, a signal or a call in jobs
        Search(search::Search),
        /// Show which job calls which
        Calls(calls::Calls),
        /// Check jobs of a folder or of the controller
        Check(check::Check),
    }
}

/// Shows the job that a task executes (FS and DX 3.3.4).
#[derive(Debug, Args)]
pub struct Show {
    /// Job to draw: its name, or a job file on this computer [default: the running job]
    #[arg(value_name = "JOB", requires = "path", add = complete::JOB)]
    job: Option<String>,
    /// Task number (0 is the master task), or all
    #[arg(long, value_name = "N|all", default_value = "0", conflicts_with = "path")]
    task: Tasks,
    /// Also show the text of the current line. armctl downloads the job file each time
    #[arg(long, conflicts_with = "path")]
    source: bool,
}

/// Number of one task, or all tasks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tasks {
    One(u8),
    All,
}

impl FromStr for Tasks {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("all") {
            return Ok(Self::All);
        }
        let task = user_input::unsigned(text);
        task.map(Self::One).ok_or_else(|| "a task is a number, starting with 0 (master), or all".to_owned())
    }
}

impl Command for Show {
    type Family = Yerc;
    type Report = Jobs;
    const ID: &'static str = "yerc.job.show";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Jobs, Failure> {
        let link = context.link;
        let encoding = link.encoding;
        let jobs: Vec<(u8, Outcome<JobInfo>)> = match self.task {
            Tasks::One(task) => {
                if link.is_dry_run() && self.source {
                    link.then("download of the job file, if the file exists");
                }
                let job = {
                    let question = link.by_model(|model| ReadJob::new(model, task)).await?;
                    link.ask(&question).await?
                };
                vec![(task, Ok(job))]
            }
            Tasks::All => {
                let model = link.model().await?;
                let questions: Vec<ReadJob> = (0..=u8::MAX).map_while(|task| ReadJob::new(model, task).ok()).collect();
                let outcomes = link.ask_each(&questions).await?;
                if let Some(Err(denied)) = outcomes.first().filter(|_| outcomes.iter().all(Result::is_err)) {
                    // Every controller has a master task, so this refusal does not mean that the task is missing.
                    return Err(read_failure(denied.clone()));
                }
                (0..).zip(outcomes).collect()
            }
        };
        let mut tasks = Vec::with_capacity(jobs.len());
        for (number, outcome) in jobs {
            let source = self.source(link, &outcome).await;
            tasks.push(Task { source, ..Task::new(number, outcome, encoding) });
        }
        Ok(Jobs { tasks })
    }
}

impl Show {
    /// Text of the current line of a task, if the user requested it and it is available.
    async fn source(&self, link: &mut Link, outcome: &Outcome<JobInfo>) -> Option<ItemOutcome<Source>> {
        let job = outcome.as_ref().ok().filter(|job| self.source && !job.name.is_empty())?;
        let what = format!("{}.JBI", link.encoding.decode(job.name.as_bytes()));
        Some(ItemOutcome::new(what, Source::read(link, job).await))
    }
}

/// Jobs that the tasks execute.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Jobs {
    tasks: Vec<Task>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Task {
    /// Task number; 0 is the master task.
    #[serde(rename = "task")]
    number: u8,
    /// Whether the task exists; null if unknown. If the task does not exist, all following fields except `refusal` are
    /// null.
    exists: Option<bool>,
    /// Job name without `.JBI`; null if the task has no job.
    program: Option<String>,
    /// Bytes of the name, if the text cannot be converted back to these bytes.
    #[serde(skip_serializing_if = "Option::is_none")]
    program_hex: Option<String>,
    line: Option<u32>,
    /// Step number; 0 if no step is being executed.
    step: Option<u32>,
    speed_override_percent: Option<f64>,
    /// Text of the line; absent unless the user requests it.
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<ItemOutcome<Source>>,
    /// Error code that the controller reported, if the task does not exist.
    #[serde(skip_serializing_if = "Option::is_none")]
    refusal: Option<String>,
    /// Reason why the task could not be read.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    error: Option<ItemError>,
    /// Speed override in the full resolution of the protocol.
    #[serde(skip)]
    shown_override: Option<String>,
}

impl Task {
    fn new(number: u8, outcome: Outcome<JobInfo>, encoding: Encoding) -> Self {
        let (info, refusal, error) = match outcome {
            Ok(info) => (Some(info), None, None),
            Err(ReadError::Refused(refusal)) if is_absent(refusal.status) => {
                (None, Some(status::explain(refusal.status).code_text), None)
            }
            Err(denied) => (None, None, Some(ItemError::new(task_name(number), read_failure(denied)))),
        };
        let info = info.as_ref();
        let name = info.filter(|info| !info.name.is_empty()).map(|info| encoding.name(info.name.as_bytes()));
        let (program, program_hex) = name.map_or((None, None), |Name { text, hex }| (Some(text), hex));
        Self {
            number,
            exists: error.is_none().then_some(info.is_some()),
            program,
            program_hex,
            line: info.map(|info| info.line),
            step: info.map(|info| info.step),
            speed_override_percent: info.map(|info| f64::from(info.speed_override) / 100.0),
            source: None,
            refusal,
            error,
            shown_override: info.map(|info| units::PERCENT.show_unsigned(info.speed_override).to_string()),
        }
    }
}

/// Name of a task.
fn task_name(number: u8) -> String {
    if number == 0 { "master".to_owned() } else { format!("sub {number}") }
}

impl Report for Jobs {
    fn view(&self) -> View {
        let mut table = Table::new(&["task", "job", "line", "step", "override (%)"], "no task");
        // If all tasks are requested, only the existing tasks are shown. A single task also shows why there is no job.
        let is_one = self.tasks.len() == 1;
        for task in self.tasks.iter().filter(|task| is_one || task.refusal.is_none()) {
            let name = task_name(task.number);
            let job = match (&task.refusal, &task.error) {
                (Some(code), _) => format!("(task does not exist: {code})").into(),
                (None, Some(error)) => error.cell(),
                (None, None) => Cell::optional(task.program.as_deref()),
            };
            let percent = task.shown_override.as_deref().map(Cell::number);
            table.row([
                name.into(),
                job,
                Cell::optional(task.line),
                Cell::optional(task.step),
                Cell::optional(percent),
            ]);
        }
        let sources = self.tasks.iter().filter_map(|task| task.source.as_ref());
        let texts: Vec<Cell> = sources
            .map(|source| match (source.data(), source.error()) {
                (_, Some(error)) => error.cell(),
                (Some(source), None) => source.text.as_deref().unwrap_or("(line not in the job file)").into(),
                (None, None) => "".into(),
            })
            .collect();
        let lines = (!texts.is_empty()).then_some(Section::Lines(texts));
        View { sections: std::iter::once(Section::Table(table)).chain(lines).collect() }
    }

    fn failure(&self) -> Option<Failure> {
        let sources = self.tasks.iter().filter_map(|task| task.source.as_ref()?.error());
        let errors = self.tasks.iter().filter_map(|task| task.error.as_ref()).chain(sources);
        items::verdict(self.tasks.len(), errors)
    }
}

/// Selects a job (FS and DX 3.3.24).
#[derive(Debug, Args)]
pub struct Select {
    /// Job name without .JBI
    #[arg(add = complete::JOB)]
    name: String,
    /// Start line
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_in_range::<u32>(0, 9999))]
    line: u32,
    /// Set the master job of this task instead of the job to start
    #[arg(long, value_name = "N", conflicts_with = "line", value_parser = parse_in_range::<u8>(0, u8::MAX))]
    task: Option<u8>,
}

/// Maximum number of bytes of a job name.
const MAX_NAME: usize = 32;

impl Select {
    async fn query(&self, name: &str, link: &mut Link) -> Result<SelectJob, Failure> {
        let encoding = link.encoding;
        refuse_controls("the job name", name)?;
        let bytes = encoding.encode_name(name).map_err(|error| {
            Failure::usage(format!("the job name: {error}"))
                .hint("set the encoding with --encoding or in the robot's entry in robots.toml")
        })?;
        if bytes.len() > MAX_NAME {
            let message = format!("the job name has {} bytes in {encoding}; the maximum is {MAX_NAME}", bytes.len());
            return Err(Failure::usage(message).hint("use `yerc file list` to see the names on the controller"));
        }
        let execute = Selection::Execute { line: self.line };
        let selection = self.task.map_or(execute, |task| Selection::Master { task });
        link.by_model(|model| SelectJob::new(model, &bytes, selection)).await
    }
}

/// Job name from its file name.
fn stem(file: &[u8]) -> &[u8] {
    let at = file.len().saturating_sub(b".JBI".len());
    if file[at..].eq_ignore_ascii_case(b".JBI") { &file[..at] } else { file }
}

/// Job name without the file suffix, as the controller uses it.
fn without_suffix(name: &str) -> &str {
    let at = name.len().saturating_sub(".JBI".len());
    match name.split_at_checked(at) {
        Some((stem, suffix)) if suffix.eq_ignore_ascii_case(".JBI") => stem,
        _ => name,
    }
}

impl Command for Select {
    type Family = Yerc;
    type Report = Selected;
    const ID: &'static str = "yerc.job.select";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Selected, Failure> {
        let link = context.link;
        let name = without_suffix(&self.name);
        if name != self.name {
            context.screen.note(&format!("job name without .JBI: '{name}'"));
        }
        // The protocol has no read for the master job of a task, so its old value is unknown.
        let old_selection = match self.task {
            None => {
                let question = link.by_model(|model| ReadJob::new(model, 0)).await?;
                link.before(&question).await?
            }
            Some(_) => None,
        };
        let was =
            old_selection.filter(|job| !job.name.is_empty()).map(|job| link.encoding.name(job.name.as_bytes()).text);
        let query = self.query(name, link).await?;
        link.ask(&query).await.map_err(|failure| about(name, failure))?;
        let words = match (self.task, self.line) {
            (Some(task), _) => format!("{name} is now the master job of task {task}"),
            (None, 0) => format!("{name} is selected"),
            (None, first) => format!("{name} is selected, start line {first}"),
        };
        let new = NewValue::of("program", name, words).with("program", name);
        Ok(Selected {
            done: new.replaces(Old::read(was)),
            line: self.task.is_none().then_some(self.line),
            task: self.task,
        })
    }
}

/// Failure whose message begins with the job name.
fn about(name: &str, failure: Failure) -> Failure {
    Failure { message: format!("job {name}: {}", failure.message), ..failure }
}

/// Result of a selection.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Selected {
    #[serde(flatten)]
    done: SetReport,
    /// Start line; null if a master job was selected.
    line: Option<u32>,
    /// Task whose master job was set; null if the job to start was selected.
    task: Option<u8>,
}

impl Report for Selected {
    fn view(&self) -> View {
        self.done.view()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::{Refusal, RefusedRequest};
    use crate::testing::{error_text, frames, frames_on, golden, intent, reports};
    use std::time::Duration;

    use super::start::{JobProgress, Watch};
    use crate::motion::{START_TIMEOUT, StandstillCause};
    use armctl_controller::Risk;
    use armctl_controller::yerc::payload::{ControllerStatus, StatusBit, Text};
    use armctl_controller::yerc::query::{Query as _, StartJob};
    use armctl_controller::yerc::wire;
    use armctl_frame::failure::Kind;
    use armctl_frame::output::render;

    #[test]
    fn selects_tasks_by_model() {
        // Golden frame R09 reads a field of instance 6, which is sub task 5.
        assert_eq!(frames("job show").unwrap(), ["7300010000010000"]);
        assert_eq!(frames("job show --task 5").unwrap(), ["7300060000010000"]);
        assert_eq!(frames("job show --task all").unwrap().len(), 16);
        assert_eq!(frames_on("udp://h?model=fs100", "job show --task all").unwrap().len(), 6);
        let failure = frames_on("udp://h?model=fs100", "job show --task 6").unwrap_err();
        assert_eq!((failure.kind, failure.message.contains("0 (master) to 5")), (Kind::Usage, true), "{failure}");
        assert!(error_text("job show --task x").contains("or all"));
    }

    #[test]
    fn selects_with_the_frame_of_the_manual() {
        let r51 = golden("R51");
        assert_eq!(frames("job select TESTJOB --line 10").unwrap(), std::slice::from_ref(&r51));
        assert_eq!(frames("job select TESTJOB.jbi --line 10").unwrap(), [r51]);
        assert!(frames("job select TESTJOB --task 15").unwrap()[0].starts_with("87001900"));
        assert!(error_text("job select A --task 1 --line 2").contains("cannot be used with"));
        assert!(error_text("job select A --line 10000").contains("0..=9999"));
    }

    #[test]
    fn measures_names_in_bytes_of_the_encoding() {
        let select = |name: &str| frames(&format!("job select {name}"));
        assert_eq!(select(&"A".repeat(32)).unwrap().len(), 1);
        let failure = select(&"A".repeat(33)).unwrap_err();
        assert_eq!(failure.kind, Kind::Usage);
        assert_eq!(failure.message, "the job name has 33 bytes in shift_jis; the maximum is 32");
        assert!(select(&"て".repeat(16)).is_ok());
        assert!(select(&"て".repeat(17)).unwrap_err().message.contains("34 bytes"));
        assert_eq!(select("한").unwrap_err().kind, Kind::Usage);
        assert_eq!(select(".JBI").unwrap_err().kind, Kind::Usage);
    }

    #[test]
    fn start_is_one_frame_and_a_motion() {
        let start = ["7300010000010000".to_owned(), "860001000110000001000000".to_owned()];
        assert_eq!(frames("job start").unwrap(), start);
        let waiting = frames("job start --wait 2m").unwrap();
        assert_eq!(waiting[..2], start);
        assert_eq!(
            waiting[2..],
            ["7200010000010000", "7300010000010000", "7000010000010000"],
            "the status until it has ended"
        );
        assert_eq!(intent("job start"), "start the selected job");
        assert_eq!(StartJob.risk(), Risk::Motion);
    }

    #[test]
    fn absent_task_is_data() {
        let info = JobInfo { name: Text::cut(b"\x85\x41"), line: 3, step: 0, speed_override: 3333 };
        let to = RefusedRequest::Robot { command: 0x73, instance: 2 };
        let refused = |code| Err(ReadError::Refused(Refusal { status: wire::Status::refused(code), to }));
        let tasks = Jobs {
            tasks: vec![
                Task::new(0, Ok(info), Encoding::ShiftJis),
                Task::new(1, refused(0xA001), Encoding::ShiftJis),
                Task::new(2, Ok(JobInfo::default()), Encoding::ShiftJis),
            ],
        };
        let json = serde_json::to_string(&tasks).unwrap();
        assert!(
            json.contains(
                r#""program":"\\x85A","program_hex":"8541","line":3,"step":0,"speed_override_percent":33.33}"#
            ),
            "{json}"
        );
        assert!(json.contains(r#""task":1,"exists":false,"program":null,"line":null"#), "{json}");
        assert!(json.contains(r#""refusal":"0xA001""#), "{json}");
        assert_eq!(
            render::csv(&tasks.view()),
            "task,job,line,step,override\nmaster,\\x85A,3,0,33.33\nsub 2,-,0,0,0.00\n"
        );
    }

    fn status(bits: &[StatusBit]) -> ControllerStatus {
        bits.iter().fold(ControllerStatus::default(), |status, bit| status.with(*bit, true))
    }

    #[test]
    fn watches_a_job_from_start_to_end() {
        let (idle, runs) = (status(&[StatusBit::ServoOn]), status(&[StatusBit::ServoOn, StatusBit::Running]));
        let mut watch = Watch::new(None);
        assert_eq!(watch.look(Duration::ZERO, idle), JobProgress::Running, "the bit may come a moment later");
        assert_eq!(watch.look(Duration::from_millis(100), runs), JobProgress::Running);
        assert_eq!(watch.look(Duration::from_secs(3600), runs), JobProgress::Running);
        assert_eq!(watch.look(Duration::from_secs(3601), idle), JobProgress::Ended);
        assert_eq!(Watch::new(None).look(START_TIMEOUT, idle), JobProgress::NeverStarted);
        let limit = Duration::from_secs(1);
        assert_eq!(Watch::new(Some(limit)).look(limit, runs), JobProgress::Timeout(limit));
    }

    #[test]
    fn reports_what_stopped_a_job() {
        let base = [StatusBit::ServoOn, StatusBit::Running];
        let look = |more: StatusBit| Watch::new(None).look(Duration::ZERO, status(&base).with(more, true));
        assert_eq!(look(StatusBit::Alarm), JobProgress::Stopped(StandstillCause::Alarm));
        assert!(matches!(look(StatusBit::HoldExternal), JobProgress::Stopped(StandstillCause::Hold(_))));
        assert_eq!(look(StatusBit::Error), JobProgress::Running);
    }

    #[tokio::test(start_paused = true)]
    async fn start_can_wait_for_the_end() {
        let lines = ["job select テスト", "job start --wait", "job select TESTJOB", "job start --wait 2s", "job show"];
        let [selected, ended, _, late, shown] = reports("", &lines).await.try_into().unwrap();
        assert_eq!(selected.unwrap()["program"], "テスト");
        let elapsed = ended.unwrap()["elapsed_ms"].as_u64().unwrap();
        assert!((1000..1200).contains(&elapsed), "the job's timer runs for a second, not {elapsed} ms");
        let failure = late.unwrap_err();
        assert_eq!(
            (failure.kind, failure.message.as_str()),
            (Kind::ConditionNotMet, "the job is still running after 2s")
        );
        assert_eq!(shown.unwrap()["tasks"][0]["program"], "TESTJOB");
    }

    #[tokio::test(start_paused = true)]
    async fn alarm_or_hold_ends_the_wait() {
        let state = "job = \"TESTJOB\"\n[[event]]\nat_ms = 500\ndo = \"hold pendant on\"\n";
        let [started] = reports(state, &["job start --wait"]).await.try_into().unwrap();
        let failure = started.unwrap_err();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert_eq!(failure.message, "the job was started, but hold by pendant was switched on");
    }

    #[tokio::test(start_paused = true)]
    async fn lists_absent_tasks_separately() {
        let [all, one] = reports("", &["job show --task all", "job show --task 9"]).await.try_into().unwrap();
        let all = all.unwrap();
        assert_eq!(all["tasks"].as_array().map(Vec::len), Some(16));
        assert_eq!(all["tasks"][9]["refusal"], "0xA001");
        assert_eq!(one.unwrap_err().code.as_deref(), Some("0xA001"));
    }
}
