//! `toyo init`: clears memory.

use super::task;
use super::wait::status_page;
use crate::prelude::*;

/// Clear memory. Only a backup can restore the cleared memory.
#[derive(Debug, Args)]
#[command(
    after_help = "The command clears sequential programs and coordinate tables of the current task only (`toyo task \
                  get`). On a real controller, type the word again to confirm, or add --yes. Save the memory first \
                  with `toyo backup`."
)]
pub struct Init {
    /// Memory to clear
    what: MemoryArea,
}

/// Memory that can be cleared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MemoryArea {
    /// The whole memory
    #[value(alias = "all")]
    Everything,
    /// The sequential program of the current task
    Sequential,
    /// All palletizing programs
    Palletizing,
    /// The sequential program of the current task, and all palletizing programs
    Programs,
    /// All easy programs, and the coordinate table
    Easy,
    /// The coordinate table of the current task
    Points,
}

impl MemoryArea {
    /// Word on the command line, word in the protocol (TO 2-3, MINT), and text.
    const fn row(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Everything => {
                ("everything", "0", "the whole memory: every program and table, and probably every parameter")
            }
            Self::Sequential => ("sequential", "1", "the sequential program of the current task"),
            Self::Palletizing => ("palletizing", "2", "all palletizing programs"),
            Self::Programs => {
                ("programs", "3", "the sequential program of the current task and all palletizing programs")
            }
            Self::Easy => ("easy", "4", "all easy programs and the coordinate table"),
            Self::Points => ("points", "6", "the coordinate table of the current task"),
        }
    }
}

impl Command for Init {
    type Family = Toyo;
    type Report = ClearReport;
    const ID: &'static str = "toyo.init";
    const RISK: Risk = Risk::Destroy;

    fn intent(&self) -> String {
        let (_, _, words) = self.what.row();
        format!("clear {words} permanently")
    }

    fn confirmation(&self) -> Confirmation {
        Confirmation::Word(self.what.row().0)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<ClearReport> {
        let Context { link, screen, .. } = context;
        let (name, number, words) = self.what.row();
        let clear = Request::of(table::Command::Mint, [Value::Word(number)]);
        let task = task::current(link).await.known()?;
        link.ask(&clear).await?;
        let status = wait_until_cleared(link, screen).await.map_err(unknown_result)?;
        Ok(ClearReport { cleared: name, about: words, task, needs_power_cycle: status.needs_power_cycle() })
    }
}

/// Interval between two reads of the status.
const POLL_INTERVAL: Duration = Duration::from_millis(200);

/// Waits until the controller has completed the work that it accepted (ambiguity A3).
async fn wait_until_cleared(link: &mut Link, screen: &Screen) -> Result<Status> {
    if link.is_dry_run() {
        link.plan(&status_page(0), "every 200 ms until the memory is cleared");
        return Err(unknown());
    }
    let _progress = screen.spinner("clearing");
    loop {
        let status = link.status_of(&[0]).await?;
        if !status.executing() {
            return Ok(status);
        }
        tokio::time::sleep(POLL_INTERVAL).await;
    }
}

/// Failure of the wait. The outcome of the command is then unknown.
fn unknown_result(failure: Failure) -> Failure {
    if failure.kind == Kind::DryRun {
        return failure;
    }
    let message = format!("the controller accepted the command, but its result is unknown: {}", failure.message);
    Failure { kind: Kind::OutcomeUnknown, message, ..failure }
}

/// Result of a clear.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ClearReport {
    /// Memory area as typed, such as `points`.
    cleared: &'static str,
    /// Description of the memory area.
    about: &'static str,
    /// The current task.
    task: Option<u8>,
    /// Whether the controller needs a restart before it executes anything.
    needs_power_cycle: bool,
}

impl Report for ClearReport {
    fn view(&self) -> View {
        let task = self.task.map(|task| format!(" (task {task})")).unwrap_or_default();
        let restart_hint = if self.needs_power_cycle { "; switch the controller's power off and on" } else { "" };
        View::text(format!("cleared: {}{task}{restart_hint}", self.about))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::blocks;
    use armctl_controller::toyo::table::commands::CLEARS;

    #[test]
    fn each_word_clears_the_data_of_the_manual() {
        let typed: Vec<(&str, &str)> =
            MemoryArea::value_variants().iter().map(|what| (what.row().0, what.row().1)).collect();
        assert_eq!(
            typed.iter().map(|(_, number)| *number).collect::<Vec<_>>(),
            CLEARS.iter().map(|word| word.text).collect::<Vec<_>>()
        );
        for (word, number) in typed {
            assert_eq!(
                blocks(&["init", word]).unwrap(),
                ["@MTSK".to_owned(), format!("@MINT PR={number}"), "@STAS SNO=0".to_owned()],
                "{word}"
            );
        }
    }

    #[test]
    fn the_block_has_the_word_of_the_command_line() {
        for what in MemoryArea::value_variants() {
            let value = what.to_possible_value().unwrap();
            assert_eq!(Command::confirmation(&Init { what: *what }), Confirmation::Word(what.row().0));
            assert_eq!(value.get_name(), what.row().0);
        }
    }
}
