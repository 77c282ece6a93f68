//! Observer of the client: records the traffic and prints notices.

use std::sync::Mutex;

use crate::failure::failure;
use crate::prelude::basics::*;
use crate::refusal::refused;
use crate::trace::Trace;
use armctl_client::Watcher;
use armctl_client::yrcx::Event;
use armctl_controller::yrcx::describe::{answer_summary, command_summary};
use armctl_frame::trace::lock_writer;
use armctl_transport::image::LinkError;

/// Observer that records the traffic and prints notices.
#[derive(Debug)]
pub(super) struct TrafficObserver {
    pub(super) trace: Arc<Mutex<Trace>>,
    pub(super) screen: Screen,
    pub(super) label: String,
}

impl Watcher<Event> for TrafficObserver {
    fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        lock_writer(&self.trace).answered(exchange);
    }

    fn event(&mut self, event: Event) {
        let Self { trace, screen, label } = self;
        match event {
            Event::ImageSent(image) => lock_writer(trace).sent(&image),
            Event::ImageReceived(image) => lock_writer(trace).received(&image),
            Event::CpuNotOk => screen.note(
                "warning: CPU OK (SO(01)) is off: the controller is not ready, or the URL selects the wrong input data \
                 (`armctl robots check`)",
            ),
            Event::Lost { why, is_reopening } => {
                let again = if is_reopening { "; armctl opens the link again" } else { "" };
                screen.note(&format!("{label}: the link was lost: {why}{again}"));
                if let LinkError::Lost { outputs, .. } = why {
                    screen.detail(1, &format!("{label}: the controller: {outputs}"));
                }
            }
            Event::Reopened { stop } => {
                let state = |on| if on { "on" } else { "off" };
                let stop = stop.map(|on| format!("; the stop input SI(06) is {}", state(on))).unwrap_or_default();
                screen.note(&format!("{label}: the link is open again{stop}"));
            }
            Event::StatusReset(command, status) => {
                screen.detail(
                    1,
                    &format!("the status was '{status}' before {}; armctl reset the status", command.row().id),
                );
            }
            Event::NotReleased(command) => {
                let id = command.row().id;
                screen.note(&format!("warning: {id} has ended, but the controller is not yet ready"));
            }
            Event::Aborted(command, alarm) => screen.note(&format!("warning: {}", refused(command.row(), alarm))),
            Event::Unanswered(error) => screen.note(&format!("warning: {}", failure(label, error))),
            Event::OtherCommandEnded { words, answer } => {
                let (what, end) = (command_summary(&words), answer_summary(&answer));
                screen.note(&format!("{label}: another client left {what} running; that command ended: {end}"));
            }
            Event::Stopping => {
                // This thread prints the notice, because a blocked terminal must not delay the stop.
                let screen = *screen;
                std::thread::spawn(move || screen.note("stopping the robot: stop input SI(06) off"));
            }
            _ => {}
        }
    }
}
