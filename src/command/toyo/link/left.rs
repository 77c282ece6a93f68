//! What a command that was killed has left behind, told by the next one.

use super::Link;
use crate::client::toyo::{Error, status_page};
use crate::command::toyo::debts::Left;
use crate::controller::toyo::request::{Answer, Request};
use crate::controller::toyo::status::{RunMode, Status};
use crate::controller::toyo::table::commands::Command;

impl Link {
    /// Looks whether what others left behind is still so, and says how to undo it: before anything but a stop, and after
    /// that.
    pub(super) async fn tell_what_is_left(&mut self) {
        if self.is_dry() || self.is_gone() {
            return;
        }
        for left in std::mem::take(&mut self.left) {
            // What cannot be asked now is asked by the next command.
            let Ok(told) = self.still_so(&left).await else { return };
            if told.is_empty() {
                left.settled();
            }
            for what in told {
                self.screen.note(&format!(
                    "{}: a command that ended before its time (since {}) left something: {what}",
                    self.label,
                    left.since()
                ));
            }
        }
    }

    /// What of it is still so, each with how to undo it.
    async fn still_so(&mut self, left: &Left) -> Result<Vec<String>, Error> {
        let mut told = Vec::new();
        let mut status = Status::default();
        for page in [0, 2] {
            if let Answer::Data(record) = self.client.raw(&status_page(page)).await? {
                status = status.with(page, record.byte("st1").unwrap_or_default());
            }
        }
        if left.owed.moving.is_some() && (status.executing() || status.homing()) {
            told.push("something is still executed; `toyo stop` stops it, a jog too".to_owned());
        }
        if left.owed.host && status.host_on() {
            told.push("the host is still ON, which was OFF; `toyo host off` gives the start input back".to_owned());
        }
        for block in &left.owed.back {
            let Ok(back) = Request::parse(block) else { continue };
            told.extend(match back.command() {
                Command::Ctsk => {
                    let asked = self.client.raw(&Request::bare(Command::Mtsk)).await?;
                    let Answer::Data(found) = asked else { continue };
                    let (found, before) = (found.number("task"), back.record().number("task"));
                    let (now, before) = (found.unwrap_or_default(), before.unwrap_or_default());
                    let how = format!("task {now} is the current one, task {before} was; `toyo task set {before}`");
                    (now != before).then_some(how)
                }
                Command::Maut if status.run_mode() == Some(RunMode::Program) => {
                    Some("the controller is in program mode, it was in automatic mode; `toyo mode auto`".to_owned())
                }
                Command::Mstp if status.run_mode() == Some(RunMode::Program) => {
                    Some("the controller is in program mode, it was in step mode; `toyo mode step`".to_owned())
                }
                _ => None,
            });
        }
        Ok(told)
    }
}
