//! `toyo program search`.

use super::steps;
use crate::link::Link;
use crate::link::Toyo;
use crate::prelude::*;
use crate::refusal;
use crate::task_selection;
use crate::wait::status_page;
use armctl_client::toyo::Refusal;
use armctl_controller::toyo::table::Op;
use armctl_frame::dry_run::unknown;

/// Find the step of a tag. The search changes the current step of the program.
#[derive(Debug, Args)]
#[command(after_help = "The controller reports only whether the tag exists. armctl then reads the current step. If \
                        the current step is the tag, armctl reports the number of the step. `program get` lists all \
                        tags and changes nothing.")]
pub struct Search {
    /// Number of the tag
    #[arg(value_name = "TAG", value_parser = clap::value_parser!(u16).range(1..=999))]
    number: u16,
    /// Task, 1 to 4 [default: the current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

impl Command for Search {
    type Family = Toyo;
    type Report = TagReport;
    const ID: &'static str = "toyo.program.search";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<TagReport, Failure> {
        let link = context.link;
        if link.is_dry_run() {
            task_selection::select_task(link, self.task).await?;
            link.plan(&status_page(0), "whether a program runs");
            link.ask(&self.order()).await?;
            link.plan(&steps::read_request(0), "the current step");
            link.put_back().await?;
            return Err(unknown());
        }
        let outcome = self.search(link).await;
        task_selection::restore_task(link, outcome).await
    }
}

impl Search {
    fn order(&self) -> Request {
        Request::of(table::Command::Sstg, [Value::Number(self.number.into())])
    }

    async fn search(&self, link: &mut Link) -> Result<TagReport, Failure> {
        let task = task_selection::select_task(link, self.task).await?;
        let status = link.status_of(&[0]).await?;
        if status.executing() || status.paused() {
            return Err(Failure::new(
                Kind::Rejected,
                "a program runs or is paused, and a search would move its current step",
            )
            .hint("use `toyo program get`, which lists all tags"));
        }
        if link.try_ask(&self.order()).await?.is_err() {
            let (tag, task) = (self.number, task);
            return Err(Failure::new(Kind::Refused, format!("task {task} has no tag {tag:03} (@NG)"))
                .hint("use `toyo program get` to list all tags, or `toyo status` to see other reasons for a refusal")
                .code("NG"));
        }
        let answer = steps::numbered(link, 0).await?.map_err(|Refusal(request)| refusal::of_question(&request))?;
        let content = steps::read_request(0).answered(&answer);
        let content = content.map_err(|error| link.malformed(&answer.written(), &error.to_string()))?;
        let is_tag = content.is_some_and(|content| {
            content.layout() == Op::Tag.row().layout && content.number("tag") == Some(self.number.into())
        });
        let step = answer.number("step").filter(|_| is_tag);
        Ok(TagReport { task, tag: self.number, step })
    }
}

/// Result of a search.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TagReport {
    task: u8,
    tag: u16,
    /// Step of the tag; null if the controller did not go to the tag (ambiguity C21).
    step: Option<i32>,
}

impl Report for TagReport {
    fn view(&self) -> View {
        let Self { task, tag, step } = self;
        View::text(match step {
            Some(step) => format!("tag {tag:03} is step {step} of task {task}"),
            None => format!("task {task} has tag {tag:03}; the controller did not report its step"),
        })
    }
}
