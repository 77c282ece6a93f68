//! `toyo task`: the current task. Programs, tables and positions belong to a task.

use super::number_arguments::{number, read_back, read_back_mismatch, saturated_byte};
use crate::prelude::*;
use armctl_controller::toyo::field::Field;

commands! {
    /// Commands for the current task.
    pub enum Task {
        /// Show the current task
        Get(Get),
        /// Select the task whose program and points are read and written
        Set(Set),
    }
}

/// Show the current task.
#[derive(Debug, Args)]
pub struct Get {}

/// Select the current task for all clients, until a client selects a different task.
#[derive(Debug, Args)]
pub struct Set {
    /// Task, 1 to 4
    #[arg(value_name = "TASK", value_parser = |text: &str| number(field(), text))]
    task: i32,
}

/// Returns the field of CTSK TASK=01. The manual also prints task 00, which armctl never sends (ambiguity C2).
fn field() -> &'static Field {
    &table::Command::Ctsk.row().requests[0].fields[0]
}

/// The current task.
pub async fn current(link: &mut Link) -> Result<u8> {
    let answer = link.ask(&Request::bare(table::Command::Mtsk)).await?;
    Ok(saturated_byte(&answer, field().name))
}

impl Command for Get {
    type Family = Toyo;
    type Report = Current;
    const ID: &'static str = "toyo.task.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Current> {
        Ok(Current { task: current(context.link).await? })
    }
}

impl Command for Set {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = "toyo.task.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        let (link, order) = (context.link, Request::of(table::Command::Ctsk, [Value::Number(self.task)]));
        let read = Request::bare(table::Command::Mtsk);
        let task = |record: &Record| record.number(field().name);
        let old = Old::read(link.before(&read).await?.as_ref().and_then(task));
        link.ask(&order).await?;
        let task_number = u8::try_from(self.task).unwrap_or(u8::MAX);
        link.choose_task(task_number);
        let selected = task(&read_back(link, &order, &read).await?);
        if selected != Some(self.task) {
            let selected = selected.unwrap_or_default();
            return Err(read_back_mismatch(&order, &format!("the current task is {selected}"))
                .hint("check for a second client that selects tasks; `toyo task get` shows the current task"));
        }
        let words = current_in_words(task_number);
        Ok(NewValue::of("task", task_number, words).with("task", task_number).replaces(old))
    }
}

fn current_in_words(task: u8) -> String {
    format!("the current task is {task}")
}

/// The current task.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Current {
    /// Number of the task, 1 to 4.
    task: u8,
}

impl Report for Current {
    fn view(&self) -> View {
        View::text(current_in_words(self.task))
    }
}
