//! Log of broker events, and status for the service manager.

use std::cell::RefCell;

use super::broker::Url;
use super::delivery::Listener;
use crate::command::fleet::service::Service;
use armctl_frame::output::log::Level;

/// Logs broker events with a journal field, and keeps the connection state.
pub struct BrokerLog<'a> {
    service: &'a Service,
    /// Broker in use, and whether it is connected.
    broker: RefCell<(String, bool)>,
}

impl<'a> BrokerLog<'a> {
    /// Creates a log; this broker is the first one, and not connected yet.
    pub fn new(service: &'a Service, url: &Url) -> Self {
        Self { service, broker: RefCell::new((url.to_string(), false)) }
    }

    /// Status line: `3 robots, 2 answer; connected to mqtt://broker:1883`.
    pub fn status(&self) -> String {
        let (url, is_connected) = &*self.broker.borrow();
        let verb = if *is_connected { "connected" } else { "not connected" };
        format!("{}; {verb} to {url}", self.service.robots())
    }

    /// URL of the broker in use.
    pub fn url(&self) -> String {
        self.broker.borrow().0.clone()
    }
}

impl Listener for BrokerLog<'_> {
    fn log(&self, level: Level, text: &str) {
        self.service.log_line(level, text, &[("broker", &self.broker.borrow().0)]);
    }

    fn set_broker(&self, url: &Url, is_connected: bool) {
        self.broker.replace((url.to_string(), is_connected));
    }
}
