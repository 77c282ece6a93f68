//! Log of broker events, and status for the service manager.

use std::cell::Cell;

use super::delivery::Listener;
use crate::command::fleet::service::Service;
use armctl_frame::output::log::Level;

/// Logs broker events with a journal field, and keeps the connection state.
pub struct BrokerLog<'a> {
    service: &'a Service,
    url: String,
    is_connected: Cell<bool>,
}

impl<'a> BrokerLog<'a> {
    /// Creates a log; the broker is not connected yet.
    pub fn new(service: &'a Service, url: String) -> Self {
        Self { service, url, is_connected: Cell::new(false) }
    }

    /// Status line: `3 robots, 2 answer; connected to mqtt://broker:1883`.
    pub fn status(&self) -> String {
        let verb = if self.is_connected.get() { "connected" } else { "not connected" };
        format!("{}; {verb} to {}", self.service.robots(), self.url)
    }
}

impl Listener for BrokerLog<'_> {
    fn log(&self, level: Level, text: &str) {
        self.service.log_line(level, text, &[("broker", &self.url)]);
    }

    fn set_connected(&self, is_there: bool) {
        self.is_connected.set(is_there);
    }
}
