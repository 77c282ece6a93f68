//! `yrcx info tasks` (4.7.5) and `yrcx info line` (4.7.6): eight tasks a command.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::ValueKind;
use crate::command::yrcx::Family;
use crate::command::yrcx::program;
use crate::command::yrcx::several::ask_all;
use crate::command::yrcx::single::shown;
use crate::command::{Command, Context, Report};
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::output::view::{Cell, Table, Tone, View};

/// Tasks of one command.
const HALF: [Key; 8] = [Key::Task1, Key::Task2, Key::Task3, Key::Task4, Key::Task5, Key::Task6, Key::Task7, Key::Task8];

/// Which tasks.
#[derive(Debug, Args)]
struct Chosen {
    /// Tasks, 1 to 16: 3, 1..8 or 1,9; those that there are, unless given
    #[arg(value_name = "TASK", value_delimiter = ',', value_parser = tasks, add = ValueKind::YrcxTask)]
    tasks: Vec<Span>,
}

/// The first and the last of some tasks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Span(usize, usize);

fn tasks(text: &str) -> Result<Span, String> {
    let number = |text: &str| match text.parse() {
        Ok(number @ 1..=16) => Ok(number),
        _ => Err(format!("'{text}' is no task; there are 1 to 16")),
    };
    match text.split_once("..").or_else(|| text.split_once('-')) {
        None => number(text).map(|task| Span(task, task)),
        Some((first, last)) => match (number(first)?, number(last)?) {
            (first, last) if first <= last => Ok(Span(first, last)),
            _ => Err("the range ends before it begins".to_owned()),
        },
    }
}

impl Chosen {
    fn has(&self, task: usize) -> bool {
        self.tasks.is_empty() || self.tasks.iter().any(|Span(first, last)| (*first..=*last).contains(&task))
    }

    /// Asks for the halves that have one of them, and returns the tasks with the half they are in.
    async fn read(
        &self,
        context: Context<'_, Family>,
        command: table::Command,
    ) -> Result<Vec<(usize, Key, Values)>, Failure> {
        let Context { link, screen, .. } = context;
        let halves: Vec<usize> =
            (0..2).filter(|half| (1..=HALF.len()).any(|place| self.has(half * HALF.len() + place))).collect();
        let order = |half: &usize| Ok(link.draft(command)?.with(Key::TaskRange, *half == 1).build()?);
        let orders = halves.iter().map(order).collect::<Result<Vec<Order>, Failure>>()?;
        let answers = ask_all(link, screen, "reading tasks", &orders).await?;
        let of_half = |(half, values): (&usize, &Values)| {
            let tasks = (half * HALF.len() + 1..).zip(HALF);
            tasks.map(|(task, key)| (task, key, values.clone())).collect::<Vec<_>>()
        };
        let tasks = halves.iter().zip(&answers).flat_map(of_half);
        Ok(tasks.filter(|(task, ..)| self.has(*task)).collect())
    }
}

/// Reads what tasks do.
#[derive(Debug, Args)]
pub struct Tasks {
    #[command(flatten)]
    chosen: Chosen,
}

impl Command for Tasks {
    type Family = Family;
    type Report = States;
    const ID: &'static str = "yrcx.info.tasks";

    async fn run(&self, context: Context<'_, Family>) -> Result<States, Failure> {
        let tasks = self.chosen.read(context, table::Command::TaskStatus).await?;
        let states = tasks.iter().filter_map(|(task, key, values)| {
            Some(State { task: *task, state: shown(table::Command::TaskStatus, values, *key)? })
        });
        let is_wanted = |state: &State| !self.chosen.tasks.is_empty() || state.state != NO_TASK;
        Ok(States { tasks: states.filter(is_wanted).collect() })
    }
}

const NO_TASK: &str = "no task";

/// Tasks.
#[derive(Debug, Serialize, JsonSchema)]
pub struct States {
    tasks: Vec<State>,
}

/// What a task does.
#[derive(Debug, Serialize, JsonSchema)]
struct State {
    /// 1 to 16.
    task: usize,
    /// `execution`, `stop`, `suspend`, `standby`, or `no task`.
    state: String,
}

impl Report for States {
    fn view(&self) -> View {
        let mut table = Table::new(&["task", "state"], "no tasks");
        for State { task, state } in &self.tasks {
            let tone = if state == "execution" { Tone::Good } else { Tone::Plain };
            table.row([(*task).into(), Cell::from(state.as_str()).tone(tone)]);
        }
        View::table(table)
    }
}

/// Reads which line each task stands at.
#[derive(Debug, Args)]
pub struct Line {
    #[command(flatten)]
    chosen: Chosen,
}

impl Command for Line {
    type Family = Family;
    type Report = Lines;
    const ID: &'static str = "yrcx.info.line";

    async fn run(&self, context: Context<'_, Family>) -> Result<Lines, Failure> {
        let tasks = self.chosen.read(context, table::Command::TaskLines).await?;
        let lines = tasks.iter().map(|(task, key, values)| {
            let line = values.int(*key).filter(|line| *line != 0).map(program::Line::of);
            TaskLine {
                task: *task,
                line: line.map(|line| line.line),
                in_common: line.is_some_and(|line| line.in_common),
            }
        });
        let is_wanted = |line: &TaskLine| !self.chosen.tasks.is_empty() || line.line.is_some();
        Ok(Lines { tasks: lines.filter(is_wanted).collect() })
    }
}

/// Lines of tasks.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Lines {
    tasks: Vec<TaskLine>,
}

/// Where a task stands.
#[derive(Debug, Serialize, JsonSchema)]
struct TaskLine {
    /// 1 to 16.
    task: usize,
    /// From 1; null if there is no such task.
    line: Option<i32>,
    /// Whether it is a line of the COMMON program.
    in_common: bool,
}

impl Report for Lines {
    fn view(&self) -> View {
        let mut table = Table::new(&["task", "line"], "no tasks");
        for TaskLine { task, line, in_common } in &self.tasks {
            let told = line.map(|line| program::Line { line, in_common: *in_common }.told());
            table.row([(*task).into(), Cell::number(told.unwrap_or_else(|| "-".to_owned()))]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, objection, read_example, words};

    #[test]
    fn the_examples_of_the_manual() {
        assert_eq!(words(&["info", "tasks", "1..8"]).unwrap(), [example("4.7.5-reference")]);
        let read = read_example("4.7.5-reference", &["info", "tasks", "1..8"]);
        let states: Vec<&str> =
            read["tasks"].as_array().unwrap().iter().map(|task| task["state"].as_str().unwrap()).collect();
        let none = "no task";
        assert_eq!(states, ["execution", "execution", none, none, "suspend", none, none, none]);
        assert_eq!(words(&["info", "line", "1..8"]).unwrap(), [example("4.7.6-reference")]);
        let read = read_example("4.7.6-reference", &["info", "line", "2-3,5"]);
        let task = |task, line: Option<i32>| json!({"task": task, "line": line, "in_common": false});
        assert_eq!(read["tasks"], json!([task(2, Some(19)), task(3, None), task(5, Some(99))]));
    }

    #[test]
    fn only_the_halves_that_are_wanted_are_read() {
        let halves = |line: &[&str]| words(line).unwrap().iter().map(|words| words[2].clone()).collect::<Vec<_>>();
        assert_eq!(halves(&["info", "tasks"]), ["0x0000", "0x0001"]);
        assert_eq!(halves(&["info", "tasks", "9"]), ["0x0001"]);
        assert_eq!(halves(&["info", "line", "8..9"]), ["0x0000", "0x0001"]);
        for wrong in ["0", "17", "3..2", "x"] {
            assert!(objection(&["info", "line", wrong]).contains("[TASK]"), "{wrong}");
        }
    }
}
