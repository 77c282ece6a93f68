//! Report of changes that an ended process left on the controller.

use super::Link;
use crate::client::toyo::{Error, status_page};
use crate::command::toyo::debts::Left;
use crate::controller::toyo::request::{Answer, Request};
use crate::controller::toyo::status::{RunMode, Status};
use crate::controller::toyo::table::commands::Command;

impl Link {
    /// Reads whether the changes are still present, and reports how to undo them. This happens before every command
    /// except a stop, and after a stop.
    pub(super) async fn tell_what_is_left(&mut self) {
        if self.is_dry() || self.is_gone() {
            return;
        }
        for left in std::mem::take(&mut self.left) {
            // If the request fails, the next command tries again.
            let Ok(told) = self.still_so(&left).await else { return };
            if told.is_empty() {
                left.settled();
            }
            for what in told {
                self.screen.note(&format!("{}: a command of {} ended early: {what}", self.label, left.since()));
            }
        }
    }

    /// Changes that are still present, each with the command that undoes it.
    async fn still_so(&mut self, left: &Left) -> Result<Vec<String>, Error> {
        let mut told = Vec::new();
        let mut status = Status::default();
        for page in [0, 2] {
            if let Answer::Data(record) = self.client.raw(&status_page(page)).await? {
                status = status.with(page, record.byte("st1").unwrap_or_default());
            }
        }
        if left.owed.moving.is_some() && (status.executing() || status.homing()) {
            told.push("the robot still runs a program or a jog; `toyo stop` stops it".to_owned());
        }
        if left.owed.host && status.host_on() {
            told.push("the host is still ON and was OFF before; `toyo host off` releases it".to_owned());
        }
        for block in &left.owed.back {
            let Ok(back) = Request::parse(block) else { continue };
            told.extend(match back.command() {
                Command::Ctsk => {
                    let asked = self.client.raw(&Request::bare(Command::Mtsk)).await?;
                    let Answer::Data(found) = asked else { continue };
                    let (found, before) = (found.number("task"), back.record().number("task"));
                    let (now, before) = (found.unwrap_or_default(), before.unwrap_or_default());
                    let how = format!(
                        "the current task is {now} and was {before} before; `toyo task set {before}` selects it"
                    );
                    (now != before).then_some(how)
                }
                Command::Maut if status.run_mode() == Some(RunMode::Program) => Some(
                    "the controller is in program mode and was in automatic mode before; `toyo mode auto` selects it"
                        .to_owned(),
                ),
                Command::Mstp if status.run_mode() == Some(RunMode::Program) => Some(
                    "the controller is in program mode and was in step mode before; `toyo mode step` selects it"
                        .to_owned(),
                ),
                _ => None,
            });
        }
        Ok(told)
    }
}
