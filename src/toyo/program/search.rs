//! `toyo program search`.

use super::folder::{check_file, program_of, programs_in, read_program};
use crate::prelude::*;
use crate::refusal;
use crate::wait::status_page;
use armctl_client::toyo::Refusal;
use armctl_controller::names::{Kind as NameKind, NameMatch, Names};
use armctl_controller::toyo::program::{ControllerData, MAX_STEPS, name_of};
use armctl_controller::toyo::table::Op;
use armctl_frame::programs::Program;
use armctl_frame::programs::search::{Matches, SearchArguments};
use armctl_frame::programs::source::ProgramSet;

/// Find lines of programs, or the step of a tag in the controller.
#[derive(Debug, Args)]
#[command(
    after_help = "A number alone, from 1 to 999, is a tag: the controller searches it, which changes the current step. \
                  The controller reports only whether the tag exists. armctl then reads the current step. If the \
                  current step is the tag, armctl reports the number of the step.\n\nAny other PATTERN has the \
                  notation of grep: . * [] ^ $ are special, \\ makes them plain text, and upper and lower case differ \
                  without -i. With several conditions, a line must meet all of them. If no line is found, the exit \
                  code is also 0.\n\n--uses accepts CN5, TN1, PT12, T2.5 (row 5 of the speed table), OUT1, OUT1.3, \
                  IN2.1, TAG=5, a label, and a name of the robot. --calls accepts a label, TAG=20, or program-2 (a \
                  task that a step starts).\n\nWithout --from, armctl reads all steps of the task first."
)]
pub struct Search {
    #[command(flatten)]
    search: SearchArguments,
    /// Search the programs in this folder, without a robot: a backup, or files program-N.txt and *.toyo
    #[arg(long, value_name = "FOLDER", add = ValueKind::Backup, conflicts_with = "task")]
    from: Option<PathBuf>,
    /// Task, 1 to 4 [default: the current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

impl Command for Search {
    type Family = Toyo;
    type Report = SearchReport;
    const ID: &'static str = "toyo.program.search";
    const RISK: Risk = Risk::Write;

    fn risk(&self) -> Risk {
        if self.tag().is_some() || self.task.is_some() { Risk::Write } else { Risk::Read }
    }

    fn takes_robot(&self) -> bool {
        self.from.is_none()
    }

    fn run_alone(&self) -> Result<SearchReport> {
        let folder = self.from.as_deref().ok_or_else(|| Failure::local("internal error: no folder to read"))?;
        let set = programs_in(folder)?;
        let names = Names::new(set.names.clone());
        self.lines(set, &names)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SearchReport> {
        let Context { link, screen, robot, .. } = context;
        let Some(tag) = self.tag() else {
            let set = program_of(link, screen, self.task).await?;
            return self.lines(set, names::of_robot(robot, screen));
        };
        if link.is_dry_run() {
            task_selection::select_task(link, self.task).await?;
            link.plan(&status_page(0), "whether a program runs");
            link.ask(&order(tag)).await?;
            link.plan(&steps::read_request(0), "the current step");
            link.put_back().await?;
            return Err(unknown());
        }
        let outcome = self.find_tag(link, tag).await;
        task_selection::restore_task(link, outcome).await.map(SearchReport::Tag)
    }
}

/// Request that searches a tag.
fn order(tag: u16) -> Request {
    Request::of(table::Command::Sstg, [Value::Number(tag.into())])
}

impl Search {
    /// Tag that the controller searches: a number without any other condition.
    fn tag(&self) -> Option<u16> {
        let number = self.search.only_pattern().filter(|_| self.from.is_none())?.parse().ok();
        number.filter(|number| (1..=999).contains(number))
    }

    fn lines(&self, set: ProgramSet, names: &Names) -> Result<SearchReport> {
        let parse = |file| read_program(file, &check_file(file, MAX_STEPS, names, &ControllerData::default()));
        let programs: Vec<Program> = set.files.iter().map(parse).collect();
        let kinds = [NameKind::Point, NameKind::Counter, NameKind::Timer, NameKind::Input, NameKind::Output];
        let objects = self.search.uses.as_deref().map(|text| match names.find(&kinds, text) {
            NameMatch::One(name) => name.address.clone(),
            _ => name_of(text),
        });
        self.search.search(&programs, objects.as_slice(), set.unread).map(SearchReport::Lines)
    }

    async fn find_tag(&self, link: &mut Link, tag: u16) -> Result<TagStep> {
        let task = task_selection::select_task(link, self.task).await?;
        let status = link.status_of(&[0]).await?;
        if status.executing() || status.paused() {
            return Err(Failure::new(
                Kind::Rejected,
                "a program runs or is paused, and a search would move its current step",
            )
            .hint("use `toyo program get`, which lists all tags"));
        }
        if link.try_ask(&order(tag)).await?.is_err() {
            return Err(Failure::new(Kind::Refused, format!("task {task} has no tag {tag:03} (@NG)"))
                .hint("use `toyo program get` to list all tags, or `toyo status` to see other reasons for a refusal")
                .code("NG"));
        }
        let answer = steps::numbered(link, 0).await?.map_err(|Refusal(request)| refusal::of_question(&request))?;
        let content = steps::read_request(0).answered(&answer);
        let content = content.map_err(|error| link.malformed(&answer.written(), &error.to_string()))?;
        let is_tag = content.is_some_and(|content| {
            content.layout() == Op::Tag.row().layout && content.number("tag") == Some(tag.into())
        });
        let step = answer.number("step").filter(|_| is_tag);
        Ok(TagStep { task, tag, step })
    }
}

/// Result of a search.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TagStep {
    task: u8,
    tag: u16,
    /// Step of the tag; null if the controller did not go to the tag (ambiguity C21).
    step: Option<i32>,
}

/// Result of a search: a tag, or lines.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "TagReport")]
pub enum SearchReport {
    /// Step of a tag in the controller.
    Tag(TagStep),
    /// Lines of programs.
    Lines(Matches),
}

impl Report for SearchReport {
    const ROWS: RowsOf = RowsOf::Report;

    fn view(&self) -> View {
        match self {
            Self::Tag(TagStep { task, tag, step: Some(step) }) => {
                View::text(format!("tag {tag:03} is step {step} of task {task}"))
            }
            Self::Tag(TagStep { task, tag, step: None }) => {
                View::text(format!("task {task} has tag {tag:03}; the controller did not report its step"))
            }
            Self::Lines(matches) => matches.view(),
        }
    }

    fn failure(&self) -> Option<Failure> {
        if let Self::Lines(matches) = self { matches.failure() } else { None }
    }

    fn rows(&self) -> RowsOf {
        if let Self::Lines(_) = self { Matches::ROWS } else { Self::ROWS }
    }
}
