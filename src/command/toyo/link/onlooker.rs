//! Observer of the client: it records the trace, keeps the journal of temporary changes, and reports a host that is ON
//! or a current task that this user did not choose. It sends no requests of its own; it uses the answers that commands
//! read.

use std::sync::{Arc, Mutex};

use crate::client::toyo::Event;
use crate::client::{Ends, Watcher};
use crate::command::frame::trace::lock_writer;
use crate::command::toyo::chosen::Chosen;
use crate::command::toyo::debts::{Debts, Left};
use crate::command::toyo::failure::not_put_back;
use crate::command::toyo::trace::Trace;
use crate::controller::toyo::status::Status;
use crate::controller::toyo::table::commands::Command;
use crate::output::Screen;
use crate::transport::tap::Direction;

/// State that a link shares with its client.
#[derive(Debug)]
pub(super) struct Onlooker {
    pub(super) trace: Trace,
    /// Temporary changes, for other processes to find if this process is killed.
    pub(super) debts: Debts,
    /// Settings that the user chose to keep.
    pub(super) chosen: Chosen,
    pub(super) told: Told,
    pub(super) screen: Screen,
    pub(super) label: String,
}

/// Notices that were printed or are not needed. A link prints each one once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    host: bool,
    task: bool,
}

impl Told {
    pub(super) const ALL: Self = Self { host: true, task: true };

    /// Notices that the journal entries of this user already contain.
    pub(super) fn by(left: &[Left]) -> Self {
        let chooses = |block: &String| block.trim_start_matches('@').starts_with(Command::Ctsk.row().word);
        Self {
            host: left.iter().any(|left| left.owed.host),
            task: left.iter().any(|left| left.owed.back.iter().any(chooses)),
        }
    }
}

/// Client's reference to the observer.
#[derive(Debug)]
pub(super) struct Watching(pub(super) Arc<Mutex<Onlooker>>);

impl Watcher<Event> for Watching {
    fn frame(&mut self, direction: Direction, _: Ends, bytes: &[u8]) {
        lock_writer(&self.0).trace.record(direction, bytes);
    }

    fn event(&mut self, event: Event) {
        let mut onlooker = lock_writer(&self.0);
        match event {
            Event::Moves(moving) => onlooker.debts.moving(moving),
            Event::TakesHost(is_taken) => onlooker.debts.host(is_taken),
            Event::Borrows(back) => onlooker.debts.push(&back.text()),
            Event::PutBack(back) => onlooker.debts.pop(&back.text()),
            Event::NotPutBack(back) => {
                onlooker.screen.note(&format!("{}: the connection is lost", not_put_back(&back.text())));
            }
            Event::Host { status, is_taken } => onlooker.tell_foreign_host(status, is_taken),
            Event::Task(task) => onlooker.tell_foreign_task(task),
            Event::Reopened => onlooker.screen.detail(1, "the connection is open again"),
            _ => {}
        }
    }
}

impl Onlooker {
    /// Prints a notice if the host is ON and this user did not switch it ON. Execution while the host is ON was started
    /// by a host.
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
            "another client switched the host ON and started a program: if no other person uses the robot, \
             `toyo stop` stops it and `toyo host off` releases the host"
        } else {
            "another client switched the host ON, which disables the start input; \
             `toyo host off` releases the host"
        };
        self.screen.note(&format!("{}: {what}", self.label));
    }

    /// Prints a notice if another client selected the current task. Task 1 is the default and needs no notice.
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
            "{}: another client selected task {task}, and commands without --task use \
             it; `toyo task set 1` selects task 1",
            self.label
        ));
    }

    /// Records that the user chose the present state of the host.
    pub(super) fn choose_host(&mut self, is_on: bool) {
        self.told.host = true;
        self.chosen.change(|choice| choice.host = is_on);
    }

    /// Records that the user chose this task as the current one.
    pub(super) fn choose_task(&mut self, task: u8) {
        self.told.task = true;
        self.chosen.change(|choice| choice.task = Some(task));
    }

    /// Whether a notice must wait: during motion, because a blocked terminal must not delay a stop, and while another
    /// process of this user has changed the setting temporarily.
    fn is_no_time(&self) -> bool {
        self.debts.owed().moving.is_some() || self.debts.others_owe()
    }
}
