//! `yrcx program` (4.6): programs and their tasks.

mod run;

use super::link;
use super::single_command::{SingleCommand, one_row, single_command};
use crate::prelude::*;
use armctl_controller::yrcx::table::{COMMON_LINES, Command};
use armctl_frame::robot::program as robot;
use armctl_frame::settings_report::number;

commands! {
    /// Commands for programs.
    pub enum Program {
        /// Register a program in a task
        Select(Select),
        /// Run a program, or all programs
        #[command(alias = "start")]
        Run(run::Run),
        /// Step into: run one line and enter subroutines
        Step(Step),
        /// Skip one line
        Skip(Skip),
        /// Step over: run one line, with a subroutine as one step
        Next(Next),
        /// Reset a program, or all programs, to the first line
        Reset(Reset),
        /// Show program states
        Show(Show),
    }
}

/// Arguments that select a program.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct ProgramSelection {
    /// Program by number, 1 to 100
    #[arg(long, value_name = "N", add = complete::PROGRAM)]
    program: Option<String>,
    /// Program by name: up to 16 characters of A-Z, 0-9 and _
    #[arg(long, value_name = "NAME", add = complete::PROGRAM_NAME)]
    name: Option<String>,
    /// Program by its task, 1 to 16
    #[arg(long, value_name = "N", add = complete::TASK)]
    task: Option<String>,
}

/// Arguments that select a program or all programs.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct WhichOrAll {
    /// Program by name or number
    #[arg(value_name = "NAME|NUMBER", add = complete::PROGRAM_NAME)]
    what: Option<String>,
    /// Program by number, 1 to 100
    #[arg(long, value_name = "N", add = complete::PROGRAM)]
    program: Option<String>,
    /// Program by name: up to 16 characters of A-Z, 0-9 and _
    #[arg(long, value_name = "NAME", add = complete::PROGRAM_NAME)]
    name: Option<String>,
    /// Program by its task, 1 to 16
    #[arg(long, value_name = "N", add = complete::TASK)]
    task: Option<String>,
    /// All registered programs
    #[arg(long)]
    all_programs: bool,
}

/// Sets the fields that select the program.
fn apply_to(draft: Draft, program: Option<&String>, name: Option<&String>, task: Option<&String>) -> Draft {
    draft
        .with_some(Key::Program, program.cloned())
        .with_some(Key::ProgramName, name.cloned())
        .with_some(Key::Task, task.cloned())
}

fn describe(program: Option<&String>, name: Option<&String>, task: Option<&String>) -> String {
    match (program, name, task) {
        (Some(number), ..) => format!("program {number}"),
        (_, Some(name), _) => format!("program {name}"),
        (_, _, Some(task)) => format!("the program of task {task}"),
        _ => "all programs".to_owned(),
    }
}

/// Adds the selected program to a report.
fn named(new: NewValue, program: Option<&String>, name: Option<&String>, task: Option<&String>) -> NewValue {
    let numeric = |text: Option<&String>| text.map_or(Value::Null, |text| number(text));
    new.with("program", numeric(program)).with("name", name.cloned()).with("task", numeric(task))
}

impl ProgramSelection {
    fn named(&self, new: NewValue) -> NewValue {
        named(new, self.program.as_ref(), self.name.as_ref(), self.task.as_ref())
    }

    fn apply_to(&self, draft: Draft) -> Draft {
        apply_to(draft, self.program.as_ref(), self.name.as_ref(), self.task.as_ref())
    }

    fn describe(&self) -> String {
        describe(self.program.as_ref(), self.name.as_ref(), self.task.as_ref())
    }
}

impl WhichOrAll {
    fn program(&self) -> Option<&String> {
        self.program.as_ref().or_else(|| self.what.as_ref().filter(|what| is_number(what)))
    }

    fn name(&self) -> Option<&String> {
        self.name.as_ref().or_else(|| self.what.as_ref().filter(|what| !is_number(what)))
    }

    fn named(&self, new: NewValue) -> NewValue {
        let new = named(new, self.program(), self.name(), self.task.as_ref());
        if self.all_programs { new.with("all_programs", true) } else { new }
    }

    fn apply_to(&self, draft: Draft) -> Draft {
        let draft = draft.with_some(Key::Selection, self.all_programs.then_some(0));
        apply_to(draft, self.program(), self.name(), self.task.as_ref())
    }

    fn describe(&self) -> String {
        describe(self.program(), self.name(), self.task.as_ref())
    }
}

fn is_number(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Arguments that select a program without a task.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct Registered {
    /// Program by number, 1 to 100
    #[arg(long, value_name = "N", add = complete::PROGRAM)]
    program: Option<String>,
    /// Program by name: up to 16 characters of A-Z, 0-9 and _
    #[arg(long, value_name = "NAME", add = complete::PROGRAM_NAME)]
    name: Option<String>,
}

one_row! {
    /// Registers a program in a task.
    Select(self) "yrcx.program.select" -> SetReport {
        #[command(flatten)]
        program: Registered,
        /// Task, 1 to 16 [default: the lowest vacant task]
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=16))]
        task: Option<u16>,
        /// Priority of the task, 1 to 64
        #[arg(long, value_name = "N")]
        priority: String,
    }
    gives Command::ProgramSelect,
    with draft => {
        let draft = apply_to(draft, self.program.program.as_ref(), self.program.name.as_ref(), None);
        draft.with_some(Key::Task, self.task).with(Key::Priority, self.priority.as_str())
    },
    done {
        let program = describe(self.program.program.as_ref(), self.program.name.as_ref(), None);
        let task = self.task.map_or_else(|| "the lowest vacant task".to_owned(), |task| format!("task {task}"));
        let words = format!("registered {program} in {task} with priority {}", self.priority);
        let new = NewValue::of("program_state", "registered", words);
        let new = named(new, self.program.program.as_ref(), self.program.name.as_ref(), None);
        new.with("task", self.task).with("priority", number(&self.priority))
    };
}

/// Declares the commands that step, skip or reset a program.
macro_rules! starts {
    ($($(#[$meta:meta])* $name:ident $id:literal $row:ident $which:ident $intent:literal $new:literal $done:literal;)*) => {
        $(
            #[derive(Debug, Args)]
            $(#[$meta])*
            pub struct $name {
                #[command(flatten)]
                which: $which,
            }

            impl SingleCommand for $name {
                type Report = SetReport;
                const ID: &'static str = $id;

                fn command(&self) -> Command {
                    Command::$row
                }

                fn fill(&self, draft: Draft) -> Draft {
                    self.which.apply_to(draft)
                }

                fn intent(&self) -> String {
                    format!($intent, self.which.describe())
                }

                fn report(&self, _done: &link::CommandResult) -> Result<SetReport> {
                    let new = NewValue::of("program_state", $new, format!($done, self.which.describe()));
                    Ok(self.which.named(new).replaces(Old::UNREAD))
                }
            }

            single_command!($name);
        )*
    };
}

starts! {
    /// Runs one line of a program and enters subroutines.
    Step "yrcx.program.step" ProgramStep ProgramSelection "run one line of {}" "step_started" "started one line of {}";
    /// Skips one line of a program.
    Skip "yrcx.program.skip" ProgramSkip ProgramSelection "skip one line of {}" "step_skipped" "skipped one line of {}";
    /// Runs one line of a program, with a subroutine as one step.
    Next "yrcx.program.next" ProgramNext ProgramSelection "run one line of {}, with a subroutine as one step" "step_started" "started one line of {}";
    /// Resets a program, or all registered programs, to the first line.
    #[command(after_help = "`yrcx io get program-reset` shows whether all programs are reset. `yrcx info line` shows \
                            the current line of each program.")]
    Reset "yrcx.program.reset" ProgramReset WhichOrAll "reset {}" "reset" "reset {}";
}

one_row! {
    /// Reads the state of a program that is not running.
    Show(self) "yrcx.program.show" -> Execution {
        #[command(flatten)]
        which: ProgramSelection,
    }
    gives Command::ProgramShow,
    with draft => self.which.apply_to(draft),
    done as answer => {
        let int = |key| answer.values.int(key).unwrap_or_default();
        let ProgramLine { line, in_common } = ProgramLine::of(int(Key::Line));
        let more = Registration {
            number: int(Key::Program),
            task: int(Key::Task),
            priority: int(Key::Priority),
            in_common,
        };
        let program = answer.values.text(Key::ProgramName).map(ToOwned::to_owned);
        Execution(robot::Program { program, line: Some(line.into()), more, ..robot::Program::default() })
    };
}

/// State of a program.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Execution(robot::Program<Registration>);

/// Registration of a program.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct Registration {
    /// Number of the program.
    number: i32,
    task: i32,
    /// Priority of the task, 1 to 64.
    priority: i32,
    /// Whether the current line is in the COMMON program.
    in_common: bool,
}

/// A line of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ProgramLine {
    /// Line number, starting with 1.
    pub line: i32,
    /// Whether the line is in the COMMON program.
    pub in_common: bool,
}

impl ProgramLine {
    /// Converts a line number of the controller: line numbers of COMMON start at 10000 (4.6.4).
    pub fn of(number: i32) -> Self {
        if number > COMMON_LINES {
            Self { line: number - COMMON_LINES, in_common: true }
        } else {
            Self { line: number, in_common: false }
        }
    }

    /// Describes the line, for example `19` or `5 of COMMON`.
    pub fn describe(self) -> String {
        format!("{}{}", self.line, if self.in_common { " of COMMON" } else { "" })
    }
}

impl Report for Execution {
    fn view(&self) -> View {
        let Self(program) = self;
        let Registration { number, task, priority, in_common } = program.more;
        let line = program.line.map(|line| format!("{line}{}", if in_common { " of COMMON" } else { "" }));
        let more = vec![
            ("number", number.into()),
            ("task", task.into()),
            ("priority", priority.into()),
            ("line", Cell::optional(line)),
        ];
        View { sections: vec![Section::Fields(program.fields(more))] }
    }
}

#[cfg(test)]
mod tests {
    use super::ProgramLine;

    #[test]
    fn marks_lines_of_common() {
        assert_eq!(
            (ProgramLine::of(10_005).describe(), ProgramLine::of(10_000).describe()),
            ("5 of COMMON".into(), "10000".into())
        );
    }
}
