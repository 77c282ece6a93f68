//! `yrcx info arm` (4.7.9, 4.7.10).

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::yrcx::Family;
use crate::command::yrcx::single::shown;
use crate::command::{Command, Context, Report};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;
use crate::output::view::{Cell, View};

/// Reads which hand system is selected, and which the arm has.
#[derive(Debug, Args)]
#[command(after_help = "A robot without axes tells `right` for both. `yrcx arm select` selects.")]
pub struct Arm {}

impl Command for Arm {
    type Family = Family;
    type Report = Arms;
    const ID: &'static str = "yrcx.info.arm";

    async fn run(&self, context: Context<'_, Family>) -> Result<Arms, Failure> {
        let link = context.link;
        let selected = link.draft(table::Command::ArmDesignation)?.build()?;
        let current = link.draft(table::Command::ArmStatus)?.build()?;
        link.rehearse(&[selected.clone(), current.clone()])?;
        let selected = shown(table::Command::ArmDesignation, &link.run(&selected).await?.values, Key::Arm);
        let current = shown(table::Command::ArmStatus, &link.run(&current).await?.values, Key::Arm);
        Ok(Arms { selected, current })
    }
}

/// Hand systems.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Arms {
    /// `right` or `left`: what motions shall use.
    selected: Option<String>,
    /// `right` or `left`: what the arm has.
    current: Option<String>,
}

impl Report for Arms {
    fn view(&self) -> View {
        View::fields([
            ("selected", Cell::maybe(self.selected.as_deref())),
            ("current", Cell::maybe(self.current.as_deref())),
        ])
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_in_turn, words};

    #[test]
    fn the_examples_of_the_manual() {
        let ids = ["4.7.9-reference", "4.7.10-reference"];
        assert_eq!(words(&["info", "arm"]).unwrap(), ids.map(example));
        assert_eq!(read_in_turn(&ids, &["info", "arm"]), json!({"selected": "left", "current": "left"}));
    }
}
