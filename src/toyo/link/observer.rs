//! Observer of the client. It records the trace, and keeps the journal of temporary changes. It also reports a host
//! that is ON, or a current task, if this user did not select it. It sends no requests; it uses the answers that
//! commands read.

use std::sync::Mutex;

use crate::change_journal::{AbandonedEntry, ChangeJournal};
use crate::failure::restore_failed_message;
use crate::prelude::basics::*;
use crate::trace::Trace;
use crate::user_choices::UserChoices;
use armctl_client::toyo::Event;
use armctl_client::{AddressPair, Watcher};
use armctl_controller::toyo::table::commands::Command;
use armctl_frame::trace::lock_writer;
use armctl_transport::tap::Direction;

/// State that a link and its client share.
#[derive(Debug)]
pub(super) struct Observer {
    pub(super) trace: Trace,
    /// Temporary changes. If this process is killed, other processes find them in the journal.
    pub(super) journal: ChangeJournal,
    /// Settings that the user chose to keep.
    pub(super) choices: UserChoices,
    pub(super) printed: PrintedNotices,
    pub(super) screen: Screen,
    pub(super) label: String,
}

/// Notices that were already printed, or that are not needed. A link prints each notice only once.
#[derive(Debug, Clone, Copy)]
pub(super) struct PrintedNotices {
    host: bool,
    task: bool,
}

impl PrintedNotices {
    pub(super) const ALL: Self = Self { host: true, task: true };

    /// Notices that are not needed because the journal entries of this user already explain them.
    pub(super) fn from_journal(abandoned: &[AbandonedEntry]) -> Self {
        let selects_task = |block: &String| block.trim_start_matches('@').starts_with(Command::Ctsk.row().word);
        Self {
            host: abandoned.iter().any(|abandoned| abandoned.entry.host),
            task: abandoned.iter().any(|abandoned| abandoned.entry.back.iter().any(selects_task)),
        }
    }
}

/// Reference to the observer, for the client.
#[derive(Debug)]
pub(super) struct SharedObserver(pub(super) Arc<Mutex<Observer>>);

impl Watcher<Event> for SharedObserver {
    fn frame(&mut self, direction: Direction, _: AddressPair, bytes: &[u8]) {
        lock_writer(&self.0).trace.record(direction, bytes);
    }

    fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        lock_writer(&self.0).trace.answered(exchange);
    }

    fn event(&mut self, event: Event) {
        let mut observer = lock_writer(&self.0);
        match event {
            Event::Motion(moving) => observer.journal.moving(moving),
            Event::HostSwitch(is_taken) => observer.journal.host(is_taken),
            Event::TemporaryChange(back) => observer.journal.push(&back.text()),
            Event::Undone(back) => observer.journal.pop(&back.text()),
            Event::NotUndone(back) => {
                observer.screen.note(&format!("{}: the connection is lost", restore_failed_message(&back.text())));
            }
            Event::Host { status, is_taken } => observer.report_foreign_host(status, is_taken),
            Event::Task(task) => observer.report_foreign_task(task),
            Event::Reopened => observer.screen.detail(1, "the connection is open again"),
            _ => {}
        }
    }
}

impl Observer {
    /// Prints a notice if the host is ON and this user did not switch it ON. If the controller executes something while
    /// the host is ON, a host has started the execution.
    fn report_foreign_host(&mut self, status: Status, is_taken: bool) {
        let Some(choice) = self.choices.get() else { return };
        if !status.host_on() {
            if choice.host {
                self.choices.change(|choice| choice.host = false);
            }
            return;
        }
        if choice.host || self.printed.host || is_taken || self.must_wait() {
            return;
        }
        self.printed.host = true;
        let what = if status.executing() || status.homing() {
            "another client switched the host ON and started a program; if no other person uses the robot, use `toyo \
             stop` to stop the program and `toyo host off` to release the host"
        } else {
            "another client switched the host ON, which disables the start input; use `toyo host off` to release the \
             host"
        };
        self.screen.note(&format!("{}: {what}", self.label));
    }

    /// Prints a notice if another client selected the current task. Task 1 is the default, so it needs no notice.
    fn report_foreign_task(&mut self, task: Option<i32>) {
        let Some(task) = task.and_then(|task| u8::try_from(task).ok()) else { return };
        let Some(choice) = self.choices.get() else { return };
        if choice.task == Some(task) || self.must_wait() {
            return;
        }
        if choice.task.is_some() {
            self.choices.change(|choice| choice.task = None);
        }
        if task == 1 || self.printed.task {
            return;
        }
        self.printed.task = true;
        self.screen.note(&format!(
            "{}: another client selected task {task}, and commands without --task use that task; use `toyo task set \
             1` to select task 1",
            self.label
        ));
    }

    /// Records that the user chose the present state of the host.
    pub(super) fn choose_host(&mut self, is_on: bool) {
        self.printed.host = true;
        self.choices.change(|choice| choice.host = is_on);
    }

    /// Records that the user chose this task as the current task.
    pub(super) fn choose_task(&mut self, task: u8) {
        self.printed.task = true;
        self.choices.change(|choice| choice.task = Some(task));
    }

    /// Whether a notice must wait. During a motion, a blocked terminal must not delay a stop. The setting can also be a
    /// temporary change by another process of this user.
    fn must_wait(&self) -> bool {
        self.journal.entry().moving.is_some() || self.journal.has_entry_of_running_process()
    }
}
