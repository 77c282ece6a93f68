//! `yrcx info tasks` (4.7.5) and `yrcx info line` (4.7.6): eight tasks per command.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::yrcx::complete;
use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::program;
use crate::command::yrcx::several::{Answers, Rows, Several, ask_each};
use crate::command::yrcx::single::shown;
use crate::command::{Command, Context, Report};
use crate::controller::typed;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::output::view::{Cell, Tone, View};

/// Tasks of one command.
const HALF: [Key; 8] = [Key::Task1, Key::Task2, Key::Task3, Key::Task4, Key::Task5, Key::Task6, Key::Task7, Key::Task8];

/// Selection of tasks.
#[derive(Debug, Args)]
struct Chosen {
    /// Tasks, 1 to 16: 3, 1..8 or 1,9; default: all existing tasks
    #[arg(value_name = "TASK", value_delimiter = ',', value_parser = tasks, add = complete::TASK)]
    tasks: Vec<Span>,
}

/// First and last task of a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Span(usize, usize);

fn tasks(text: &str) -> Result<Span, String> {
    let number = |text: &str| match text.parse() {
        Ok(number @ 1..=16) => Ok(number),
        _ => Err(format!("'{text}' is not a valid task (1 to 16)")),
    };
    let tasks = typed::range(text, number)?;
    Ok(Span(*tasks.start(), *tasks.end()))
}

impl Chosen {
    fn has(&self, task: usize) -> bool {
        self.tasks.is_empty() || self.tasks.iter().any(|Span(first, last)| (*first..=*last).contains(&task))
    }

    /// Reads the halves with a selected task, and returns the tasks with their values.
    async fn read<V>(
        &self,
        context: Context<'_, Yrcx>,
        command: table::Command,
        of: impl Fn(&Values, Key) -> V,
    ) -> Result<Rows<Which, V>, Failure> {
        let Context { link, screen, .. } = context;
        let halves: Vec<usize> =
            (0..2).filter(|half| (1..=HALF.len()).any(|place| self.has(half * HALF.len() + place))).collect();
        let order = |half: &usize| Ok(link.draft(command)?.with(Key::TaskRange, *half == 1).build()?);
        let orders = halves.iter().map(order).collect::<Result<Vec<Order>, Failure>>()?;
        let answers = ask_each(link, screen, "reading tasks", &orders).await?;
        let task = |half: usize, place: usize| half * HALF.len() + place + 1;
        let told = |half: &usize| format!("tasks {} to {}", task(*half, 0), task(*half, HALF.len() - 1));
        if let ([half], [Err(failure)]) = (&halves[..], &answers.outcomes[..]) {
            return Err(Failure { message: format!("{}: {}", told(half), failure.message), ..failure.clone() });
        }
        // The outcome of a half applies to each of its tasks.
        let asked = &halves[..answers.asked];
        let places: Vec<(usize, usize)> =
            halves.iter().flat_map(|half| (0..HALF.len()).map(|at| (*half, at))).collect();
        let places: Vec<(usize, usize)> = places.into_iter().filter(|(half, at)| self.has(task(*half, *at))).collect();
        let outcome = |half: usize| {
            let at = halves.iter().position(|other| *other == half).unwrap_or_default();
            answers.outcomes[at].clone()
        };
        let outcomes = places.iter().map(|(half, _)| outcome(*half)).collect();
        let count = places.iter().filter(|(half, _)| asked.contains(half)).count();
        let names = places.iter().map(|(half, at)| format!("task {}", task(*half, *at)));
        let of_task = |place: usize, values: &Values| of(values, HALF[places[place].1]);
        let several = Several::of(names, Answers { outcomes, asked: count }, of_task)?;
        Ok(several.rows(places.iter().map(|(half, at)| Which { task: task(*half, *at) })))
    }
}

/// Reads the task states.
#[derive(Debug, Args)]
pub struct Tasks {
    #[command(flatten)]
    chosen: Chosen,
}

impl Command for Tasks {
    type Family = Yrcx;
    type Report = States;
    const ID: &'static str = "yrcx.info.tasks";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<States, Failure> {
        let command = table::Command::TaskStatus;
        let of = |values: &Values, key| State { state: shown(command, values, key).unwrap_or_default() };
        let mut tasks = self.chosen.read(context, command, of).await?;
        tasks.retain(|_, state| !self.chosen.tasks.is_empty() || state.state != NO_TASK);
        Ok(States { tasks })
    }
}

const NO_TASK: &str = "no task";

/// States of tasks.
#[derive(Debug, Serialize, JsonSchema)]
pub struct States {
    tasks: Rows<Which, State>,
}

/// Task number.
#[derive(Debug, Serialize, JsonSchema)]
struct Which {
    /// 1 to 16.
    task: usize,
}

/// State of a task.
#[derive(Debug, Serialize, JsonSchema)]
struct State {
    /// `execution`, `stop`, `suspend`, `standby`, or `no task`.
    state: String,
}

impl Report for States {
    fn view(&self) -> View {
        let cells = |State { state }: &State| {
            let tone = if state == "execution" { Tone::Good } else { Tone::Plain };
            [Cell::from(state.as_str()).tone(tone)]
        };
        View::table(self.tasks.table(["task"], ["state"], "no tasks", |which| [which.task.into()], cells))
    }

    fn failure(&self) -> Option<Failure> {
        self.tasks.failure()
    }
}

/// Reads the current line of each task.
#[derive(Debug, Args)]
pub struct Line {
    #[command(flatten)]
    chosen: Chosen,
}

impl Command for Line {
    type Family = Yrcx;
    type Report = Lines;
    const ID: &'static str = "yrcx.info.line";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Lines, Failure> {
        let of = |values: &Values, key| {
            let line = values.int(key).filter(|line| *line != 0).map(program::ProgramLine::of);
            TaskLine { line: line.map(|line| line.line), in_common: line.is_some_and(|line| line.in_common) }
        };
        let mut tasks = self.chosen.read(context, table::Command::TaskLines, of).await?;
        tasks.retain(|_, line| !self.chosen.tasks.is_empty() || line.line.is_some());
        Ok(Lines { tasks })
    }
}

/// Current lines of tasks.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Lines {
    tasks: Rows<Which, TaskLine>,
}

/// Current line of a task.
#[derive(Debug, Serialize, JsonSchema)]
struct TaskLine {
    /// From 1; null if there is no such task.
    line: Option<i32>,
    /// Whether it is a line of the COMMON program.
    in_common: bool,
}

impl Report for Lines {
    fn view(&self) -> View {
        let cells = |TaskLine { line, in_common }: &TaskLine| {
            let told = line.map(|line| program::ProgramLine { line, in_common: *in_common }.describe());
            [Cell::number(told.unwrap_or_else(|| "-".to_owned()))]
        };
        View::table(self.tasks.table(["task"], ["line"], "no tasks", |which| [which.task.into()], cells))
    }

    fn failure(&self) -> Option<Failure> {
        self.tasks.failure()
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
        let task = |task, line: Option<i32>| json!({"task": task, "ok": true, "line": line, "in_common": false});
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
