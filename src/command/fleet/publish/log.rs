//! Log of broker events, and status for the service manager.

use std::cell::Cell;

use super::pump::Listener;
use crate::command::fleet::service::Service;
use crate::output::log::Level;

/// Logs broker events with a journal field, and keeps the connection state.
pub struct BrokerLog<'a> {
    service: &'a Service,
    url: String,
    is_there: Cell<bool>,
}

impl<'a> BrokerLog<'a> {
    /// Creates a log; the broker is not connected yet.
    pub fn new(service: &'a Service, url: String) -> Self {
        Self { service, url, is_there: Cell::new(false) }
    }

    /// Status line: `3 robots, 2 answer; connected to mqtt://broker:1883`.
    pub fn status(&self) -> String {
        let verb = if self.is_there.get() { "connected" } else { "not connected" };
        format!("{}; {verb} to {}", self.service.robots(), self.url)
    }
}

impl Listener for BrokerLog<'_> {
    fn say(&self, level: Level, text: &str) {
        self.service.say(level, text, &[("broker", &self.url)]);
    }

    fn reached(&self, is_there: bool) {
        self.is_there.set(is_there);
    }
}
