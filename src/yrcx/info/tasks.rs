//! Commands `yrcx info tasks` (4.7.5) and `yrcx info line` (4.7.6). One remote command reads eight tasks.

use crate::prelude::*;
use crate::program;
use crate::read_requests::ask_each;
use crate::single_command::format_field;
use armctl_frame::robot::item::{Columns, Item, Items};

/// Tasks in the answer of one remote command: half of the 16 tasks.
const TASK_KEYS: [Key; 8] =
    [Key::Task1, Key::Task2, Key::Task3, Key::Task4, Key::Task5, Key::Task6, Key::Task7, Key::Task8];

/// Argument that selects tasks.
#[derive(Debug, Args)]
struct TaskSelection {
    /// Tasks (1 to 16), for example 3, `1..8` or `1,9` [default: all existing tasks]
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
    let tasks = user_input::range(text, number)?;
    Ok(Span(*tasks.start(), *tasks.end()))
}

impl TaskSelection {
    fn has(&self, task: usize) -> bool {
        self.tasks.is_empty() || self.tasks.iter().any(|Span(first, last)| (*first..=*last).contains(&task))
    }

    /// Reads the halves that contain a selected task, and returns the tasks with their values.
    async fn read<V: Clone>(
        &self,
        context: Context<'_, Yrcx>,
        command: table::Command,
        of: impl Fn(&Values, Key) -> Option<(V, Cell)>,
        heading: &'static str,
    ) -> Result<Items<V>> {
        let Context { link, screen, .. } = context;
        let halves: Vec<usize> =
            (0..2).filter(|half| (1..=TASK_KEYS.len()).any(|place| self.has(half * TASK_KEYS.len() + place))).collect();
        let order = |half: &usize| link.draft(command)?.with(Key::TaskRange, *half == 1).valid_order();
        let orders = halves.iter().map(order).collect::<Result<Vec<Order>>>()?;
        let answers = ask_each(link, screen, "reading tasks", &orders).await?;
        let task = |half: usize, place: usize| half * TASK_KEYS.len() + place + 1;
        let told = |half: &usize| format!("tasks {} to {}", task(*half, 0), task(*half, TASK_KEYS.len() - 1));
        if let ([half], [Err(failure)]) = (&halves[..], &answers.outcomes[..]) {
            return Err(Failure { message: format!("{}: {}", told(half), failure.message), ..failure.clone() });
        }
        // The failure or answer of a half applies to each task in it.
        let (mut items, mut asked) = (Vec::new(), 0);
        for (at, (half, outcome)) in halves.iter().zip(&answers.outcomes).enumerate() {
            for (place, key) in TASK_KEYS.into_iter().enumerate().filter(|(place, _)| self.has(task(*half, *place))) {
                let read = outcome.clone().map(|values| of(&values, key));
                // If the user selected no tasks, armctl reports only the tasks that exist.
                if self.tasks.is_empty() && matches!(read, Ok(None)) {
                    continue;
                }
                let cell = read.as_ref().ok().cloned().flatten().map(|(_, cell)| cell);
                let value = read.map(|read| read.map(|(value, _)| value));
                let item = Item::new("task", task(*half, place).to_string(), value);
                items.push(Item { cells: cell.into_iter().collect(), ..item });
                asked += usize::from(at < answers.asked);
            }
        }
        let columns = Columns { name: "task", values: vec![heading], empty: "no tasks" };
        Items::new(columns, items).asked(asked).single_failure()
    }
}

/// Reads the task states.
#[derive(Debug, Args)]
pub struct Tasks {
    #[command(flatten)]
    chosen: TaskSelection,
}

impl Command for Tasks {
    type Family = Yrcx;
    type Report = Items<String>;
    const ID: &'static str = "yrcx.info.tasks";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Items<String>> {
        let command = table::Command::TaskStatus;
        let of = |values: &Values, key| {
            let state = format_field(command, values, key).filter(|state| state != NO_TASK)?;
            let tone = if state == "execution" { Tone::Good } else { Tone::Plain };
            Some((state.clone(), Cell::from(state).tone(tone)))
        };
        self.chosen.read(context, command, of, "state").await
    }
}

const NO_TASK: &str = "no task";

/// Reads the current line of each task.
#[derive(Debug, Args)]
pub struct Line {
    #[command(flatten)]
    chosen: TaskSelection,
}

impl Command for Line {
    type Family = Yrcx;
    type Report = Items<TaskLine>;
    const ID: &'static str = "yrcx.info.line";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Items<TaskLine>> {
        let of = |values: &Values, key| {
            let line = values.int(key).filter(|line| *line != 0).map(program::ProgramLine::of)?;
            let cell = Cell::number(line.describe());
            Some((TaskLine { line: line.line, in_common: line.in_common }, cell))
        };
        self.chosen.read(context, table::Command::TaskLines, of, "line").await
    }
}

/// Current line of a task.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TaskLine {
    /// Line number, starting with 1.
    line: i32,
    /// Whether the line is in the COMMON program.
    in_common: bool,
}
