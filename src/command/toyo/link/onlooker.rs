//! Looks on what a client does: keeps the record of the traffic, writes down what is changed, and says what others have
//! left on a controller, as far as a command comes by it: the host ON, with it what is executed, another current task.
//! Nothing is asked for that alone.

use std::sync::{Arc, Mutex};

use crate::client::toyo::Event;
use crate::client::{Ends, Watcher};
use crate::command::frame::trace::locked;
use crate::command::toyo::chosen::Chosen;
use crate::command::toyo::debts::{Debts, Left};
use crate::command::toyo::failure::not_put_back;
use crate::command::toyo::trace::Trace;
use crate::controller::toyo::status::Status;
use crate::controller::toyo::table::commands::Command;
use crate::output::Screen;
use crate::transport::tap::Direction;

/// What a link shares with its client.
#[derive(Debug)]
pub(super) struct Onlooker {
    pub(super) trace: Trace,
    /// What is changed for a while, for others to find if this process is killed.
    pub(super) debts: Debts,
    /// What is meant to stay as it is; and what is not, and was told.
    pub(super) chosen: Chosen,
    pub(super) told: Told,
    pub(super) screen: Screen,
    pub(super) label: String,
}

/// What was told, or need not be: each is told once over a link.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    host: bool,
    task: bool,
}

impl Told {
    pub(super) const ALL: Self = Self { host: true, task: true };

    /// What a note of this user tells anyway.
    pub(super) fn by(left: &[Left]) -> Self {
        let chooses = |block: &String| block.trim_start_matches('@').starts_with(Command::Ctsk.row().word);
        Self {
            host: left.iter().any(|left| left.owed.host),
            task: left.iter().any(|left| left.owed.back.iter().any(chooses)),
        }
    }
}

/// The client's hold of it.
#[derive(Debug)]
pub(super) struct Watching(pub(super) Arc<Mutex<Onlooker>>);

impl Watcher<Event> for Watching {
    fn frame(&mut self, direction: Direction, _: Ends, bytes: &[u8]) {
        locked(&self.0).trace.record(direction, bytes);
    }

    fn event(&mut self, event: Event) {
        let mut onlooker = locked(&self.0);
        match event {
            Event::Moves(moving) => onlooker.debts.moving(moving),
            Event::TakesHost(is_taken) => onlooker.debts.host(is_taken),
            Event::Borrows(back) => onlooker.debts.push(&back.text()),
            Event::PutBack(back) => onlooker.debts.pop(&back.text()),
            Event::NotPutBack(back) => {
                onlooker.screen.note(&format!("{}: the line is gone", not_put_back(&back.text())));
            }
            Event::Host { status, is_taken } => onlooker.tell_foreign_host(status, is_taken),
            Event::Task(task) => onlooker.tell_foreign_task(task),
            Event::Reopened => onlooker.screen.detail(1, "the line is there again"),
            _ => {}
        }
    }
}

impl Onlooker {
    /// Says that the host is ON if nobody here wants that. What is executed while it is ON, a host has started.
    fn tell_foreign_host(&mut self, status: Status, is_taken: bool) {
        let Some(choice) = self.chosen.get() else { return };
        if !status.host_on() {
            if choice.host {
                self.chosen.change(|choice| choice.host = false);
            }
            return;
        }
        if choice.host || self.told.host || is_taken || self.is_no_time() {
            return;
        }
        self.told.host = true;
        let what = if status.executing() || status.homing() {
            "the host is ON and something is executed, and no armctl of this user does that: if nobody else is at work, \
             `toyo stop` stops it and `toyo host off` gives the start input back"
        } else {
            "the host is ON, and no armctl of this user keeps it so: as long as it is, the start input does nothing; \
             `toyo host off` gives it back"
        };
        self.screen.note(&format!("{}: {what}", self.label));
    }

    /// Says that a task is the current one if nobody here chose it. Task 1 is the first, and no news.
    fn tell_foreign_task(&mut self, task: Option<i32>) {
        let Some(task) = task.and_then(|task| u8::try_from(task).ok()) else { return };
        let Some(choice) = self.chosen.get() else { return };
        if choice.task == Some(task) || self.is_no_time() {
            return;
        }
        if choice.task.is_some() {
            self.chosen.change(|choice| choice.task = None);
        }
        if task == 1 || self.told.task {
            return;
        }
        self.told.task = true;
        self.screen.note(&format!(
            "{}: task {task} is the current one, and no armctl of this user chose it: commands without --task are about \
             it; `toyo task set 1` chooses the first",
            self.label
        ));
    }

    /// Somebody wants the host as it is now.
    pub(super) fn choose_host(&mut self, is_on: bool) {
        self.told.host = true;
        self.chosen.change(|choice| choice.host = is_on);
    }

    /// Somebody wants this task to be the current one.
    pub(super) fn choose_task(&mut self, task: u8) {
        self.told.task = true;
        self.chosen.change(|choice| choice.task = Some(task));
    }

    /// Whether this is no time to say so: something moves, which a terminal that is held must not hold up, or another
    /// process of this user has changed it for a while.
    fn is_no_time(&self) -> bool {
        self.debts.owed().moving.is_some() || self.debts.others_owe()
    }
}
