//! `yrcx info arm` (4.7.9, 4.7.10).

use crate::prelude::*;
use crate::read_requests::ask_each;
use crate::single_command::format_field;
use armctl_frame::items;
use armctl_frame::items::ItemError;

/// Reads the selected and the current hand system.
#[derive(Debug, Args)]
#[command(after_help = "A robot without axes reports `right` for both hand systems. `yrcx arm select` changes the \
                        selection.")]
pub struct Arm {}

impl Command for Arm {
    type Family = Yrcx;
    type Report = Arms;
    const ID: &'static str = "yrcx.info.arm";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Arms> {
        let link = context.link;
        let selected = link.draft(table::Command::ArmDesignation)?.valid_order()?;
        let current = link.draft(table::Command::ArmStatus)?.valid_order()?;
        let answers = ask_each(link, context.screen, "reading hand systems", &[selected, current]).await?;
        let commands = [table::Command::ArmDesignation, table::Command::ArmStatus];
        let mut arms = [None, None];
        let mut errors = Vec::new();
        for (((arm, command), name), outcome) in
            arms.iter_mut().zip(commands).zip(["selected", "current"]).zip(answers.outcomes)
        {
            match outcome {
                Ok(values) => *arm = format_field(command, &values, Key::Arm),
                Err(failure) => errors.push(ItemError::new(format!("{name} hand system"), failure)),
            }
        }
        items::all_failed(commands.len(), &errors)?;
        let [selected, current] = arms;
        Ok(Arms { selected, current, errors })
    }
}

/// Hand systems.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Arms {
    /// Hand system selected for motions: `right` or `left`.
    selected: Option<String>,
    /// Hand system that the arm has now: `right` or `left`.
    current: Option<String>,
    /// Values that could not be read, and the reason.
    errors: Vec<ItemError>,
}

impl Report for Arms {
    fn view(&self) -> View {
        View::fields([
            ("selected", Cell::optional(self.selected.as_deref())),
            ("current", Cell::optional(self.current.as_deref())),
        ])
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(2, &self.errors)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{Reply, Scripted, answer, report_on};

    #[test]
    fn refused_arm_does_not_hide_the_other() {
        let mut no = [0; 16];
        no[..3].copy_from_slice(&[0x4000, 5, 1]);
        let script = [Reply::AddressPair(1, no), Reply::AddressPair(1, answer("4.7.10-reference"))];
        let (read, failure, _) = report_on(Scripted::new(script), &["info", "arm"]);
        assert_eq!((&read["selected"], &read["current"]), (&json!(null), &json!("left")));
        assert_eq!(read["errors"][0]["asked"], "selected hand system");
        assert_eq!(failure.unwrap().kind.exit(), 9);
    }
}
