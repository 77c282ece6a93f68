//! What is said of the broker, and how both ends are.

use std::cell::Cell;

use super::pump::Listener;
use crate::command::fleet::service::Service;
use crate::output::log::Level;

/// Says what happens with a broker, with a field for the journal, and remembers whether it is reached.
pub struct BrokerLog<'a> {
    service: &'a Service,
    url: String,
    is_there: Cell<bool>,
}

impl<'a> BrokerLog<'a> {
    /// Of a broker that is not reached yet.
    pub fn new(service: &'a Service, url: String) -> Self {
        Self { service, url, is_there: Cell::new(false) }
    }

    /// In a line: `3 robots, 2 answer; connected to mqtt://broker:1883`.
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
