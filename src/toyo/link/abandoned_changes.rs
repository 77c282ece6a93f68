//! Reports changes that another process left on the controller when it ended.

use super::Link;
use crate::change_journal::AbandonedEntry;
use armctl_client::toyo::{Error, status_page};
use armctl_controller::toyo::request::{Answer, Request};
use armctl_controller::toyo::status::{RunMode, Status};
use armctl_controller::toyo::table::commands::Command;

impl Link {
    /// Reads whether the changes are still present, and reports how to undo them. armctl does this before every command
    /// except a stop, and after a stop.
    pub(super) async fn report_abandoned_changes(&mut self) {
        if self.is_dry_run() || self.is_line_lost() {
            return;
        }
        for abandoned in std::mem::take(&mut self.abandoned) {
            // If a read fails, report nothing now. The journal entry stays, so the next command tries again.
            let Ok(notices) = self.remaining_changes(&abandoned).await else { return };
            if notices.is_empty() {
                abandoned.delete();
            }
            for notice in notices {
                self.screen.note(&format!("{}: a command of {} ended early: {notice}", self.label, abandoned.since()));
            }
        }
    }

    /// Changes that are still present. Each text names the command that undoes the change.
    async fn remaining_changes(&mut self, abandoned: &AbandonedEntry) -> Result<Vec<String>, Error> {
        let mut notices = Vec::new();
        let mut status = Status::default();
        for page in [0, 2] {
            if let Answer::Data(record) = self.client.raw(&status_page(page)).await? {
                status = status.with(page, record.byte("st1").unwrap_or_default());
            }
        }
        if abandoned.entry.moving.is_some() && (status.executing() || status.homing()) {
            notices.push("the robot still runs a program or a jog; use `toyo stop` to stop it".to_owned());
        }
        if abandoned.entry.host && status.host_on() {
            notices
                .push("the host is still ON, and was OFF before; use `toyo host off` to release the host".to_owned());
        }
        for block in &abandoned.entry.back {
            let Ok(back) = Request::parse(block) else { continue };
            notices.extend(match back.command() {
                Command::Ctsk => {
                    let answer = self.client.raw(&Request::bare(Command::Mtsk)).await?;
                    let Answer::Data(record) = answer else { continue };
                    let (current, earlier) = (record.number("task"), back.record().number("task"));
                    let (current, earlier) = (current.unwrap_or_default(), earlier.unwrap_or_default());
                    let notice = format!(
                        "the current task is {current}, and was {earlier} before; use `toyo task set {earlier}` to \
                         select the earlier task"
                    );
                    (current != earlier).then_some(notice)
                }
                Command::Maut if status.run_mode() == Some(RunMode::Program) => Some(
                    "the controller is in program mode, and was in automatic mode before; use `toyo mode auto` to \
                     select automatic mode"
                        .to_owned(),
                ),
                Command::Mstp if status.run_mode() == Some(RunMode::Program) => Some(
                    "the controller is in program mode, and was in step mode before; use `toyo mode step` to select \
                     step mode"
                        .to_owned(),
                ),
                _ => None,
            });
        }
        Ok(notices)
    }
}
