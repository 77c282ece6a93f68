//! `toyo program show`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::steps;
use crate::client::toyo::Refusal;
use crate::command::frame::dry_run::unknown;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::refusal;
use crate::command::{Command, Context, Report};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::output::view::View;

/// Asks for the step at which the program of the current task stands.
#[derive(Debug, Args)]
pub struct Show {}

impl Command for Show {
    type Family = Toyo;
    type Report = Current;
    const ID: &'static str = "toyo.program.show";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Current, Failure> {
        let link = context.link;
        let (which, request) = (Request::bare(table::Command::Mtsk), steps::read_request(0));
        if link.is_dry() {
            link.plan(&which, "which task is the current one");
            link.plan(&request, "its current step");
            return Err(unknown());
        }
        let which = link.ask(&which).await?;
        let answer = steps::numbered(link, 0).await?.map_err(|Refusal(request)| refusal::of_question(&request))?;
        Ok(Current {
            task: which.number("task").unwrap_or_default(),
            step: answer.number("step").unwrap_or_default(),
            instruction: answer.text("text").unwrap_or_default().to_owned(),
        })
    }
}

/// Where a program stands.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Current {
    task: i32,
    step: i32,
    /// What stands there.
    instruction: String,
}

impl Report for Current {
    fn view(&self) -> View {
        View::fields([
            ("task", self.task.into()),
            ("step", self.step.into()),
            ("instruction", self.instruction.as_str().into()),
        ])
    }
}
