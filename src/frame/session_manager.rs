//! Handle of the manager that keeps links open between the lines of this process. The manager runs in its own thread
//! (`fleet/session/host.rs`).

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use tokio::sync::{mpsc, oneshot};

use super::connection::Access;
use super::interrupt::interruptible;
use super::session_client::own_key;
use crate::prelude::basics::*;
use armctl_transport::session::direct::HostHandle;

/// Handle of the manager that keeps links open between the lines of this process. The manager has its own thread, so
/// that a busy line does not cause the loss of a link.
#[derive(Debug, Clone)]
pub struct SessionManager {
    requests: mpsc::UnboundedSender<ManagerRequest>,
    /// Links that this process has, by the own keys of the robots.
    held: Arc<Mutex<HashMap<String, OwnSession>>>,
    /// Whether a note that links cannot be kept open was already printed.
    reports: Arc<AtomicBool>,
}

/// Request to the manager thread.
pub enum ManagerRequest {
    /// Open the link to a robot, and report which process has it.
    Hold {
        /// Robot.
        robot: Box<Robot>,
        /// Permitted use of the link.
        access: Access,
        /// Screen for notes.
        screen: Screen,
        /// Channel for the result.
        done: oneshot::Sender<Result<HeldBy>>,
    },
    /// Close all links, and report when they are closed.
    End(oneshot::Sender<()>),
}

impl fmt::Debug for ManagerRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Order")
    }
}

/// Session of this process.
#[derive(Debug, Clone)]
pub struct OwnSession {
    /// Own key of the robot.
    pub key: String,
    /// Access to the session from any thread.
    pub host: HostHandle,
    /// Whether the session, and not each command, records the traffic of the link.
    pub records: bool,
}

/// Which process has a link.
#[derive(Debug, Clone)]
pub enum HeldBy {
    /// This process has the link.
    ThisProcess(OwnSession),
    /// A session of another process has the link.
    OtherProcess,
    /// No process has the link, because the session folder cannot be used. Contains the reason.
    None(Failure),
}

impl SessionManager {
    /// Creates the handle that sends requests to the thread that holds the links.
    pub fn new(requests: mpsc::UnboundedSender<ManagerRequest>) -> Self {
        Self { requests, held: Arc::default(), reports: Arc::default() }
    }

    /// Closes all links. Returns `false` if the thread has already ended.
    pub fn end(&self, done: oneshot::Sender<()>) -> bool {
        self.requests.send(ManagerRequest::End(done)).is_ok()
    }

    /// Keeps the link to a robot open, and returns which process has the link.
    pub async fn hold(&self, robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldBy> {
        if let Some(session) = self.held(&own_key(robot)) {
            return Ok(HeldBy::ThisProcess(session));
        }
        let (done, is_done) = oneshot::channel();
        let order =
            ManagerRequest::Hold { robot: Box::new(robot.clone()), access: access.clone(), screen: *screen, done };
        let broken = || Failure::local("internal error: the session thread has ended");
        self.requests.send(order).map_err(|_| broken())?;
        let by = interruptible(is_done).await?.map_err(|_| broken())??;
        if let HeldBy::ThisProcess(session) = &by {
            self.held.lock().unwrap_or_else(PoisonError::into_inner).insert(session.key.clone(), session.clone());
        }
        if let HeldBy::None(why) = &by
            && !self.reports.swap(true, Ordering::Relaxed)
        {
            screen.note(&format!("connections are not kept open between lines: {why}"));
        }
        Ok(by)
    }

    /// Session with this key, until another process closes it.
    fn held(&self, key: &str) -> Option<OwnSession> {
        let held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        held.get(key).filter(|session| !session.host.has_ended()).cloned()
    }
}
