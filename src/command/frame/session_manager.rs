//! Links that stay open from one line of this process to the next. Whoever opens them sits on a thread of its own
//! (`fleet/session/host.rs`); this is how lines ask it.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::sync::{mpsc, oneshot};

use super::connection::Access;
use super::interrupt::interruptible;
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;

/// Holds the links that the lines of this process use, on a thread of its own: a line that computes for long must not
/// let a link drop.
#[derive(Debug, Clone)]
pub struct SessionManager {
    orders: mpsc::UnboundedSender<ManagerRequest>,
    /// Whether it has been told that links cannot be held here.
    told: Arc<AtomicBool>,
}

/// What the thread is told.
pub enum ManagerRequest {
    /// To hold the link to a robot, and to say by whom it is held.
    Hold {
        /// The robot.
        robot: Box<Robot>,
        /// How the link may be used.
        access: Access,
        /// For what is to be noted.
        screen: Screen,
        /// Who is told.
        done: oneshot::Sender<Result<By, Failure>>,
    },
    /// To let all links go, and to say when they are gone.
    End(oneshot::Sender<()>),
}

impl fmt::Debug for ManagerRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Order")
    }
}

/// Who holds a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum By {
    /// This process.
    This {
        /// Whether what passes is recorded there.
        records: bool,
    },
    /// A session of another process.
    Another,
    /// Nobody: there is no place for sessions, and why.
    Nobody(Failure),
}

impl SessionManager {
    /// For a thread that takes these orders.
    pub fn new(orders: mpsc::UnboundedSender<ManagerRequest>) -> Self {
        Self { orders, told: Arc::default() }
    }

    /// Has all links let go; `false` if the thread has ended already.
    pub fn end(&self, done: oneshot::Sender<()>) -> bool {
        self.orders.send(ManagerRequest::End(done)).is_ok()
    }

    /// Makes sure that the link to a robot is held from now on, and says by whom.
    pub async fn hold(&self, robot: &Robot, access: &Access, screen: &Screen) -> Result<By, Failure> {
        let (done, is_done) = oneshot::channel();
        let order =
            ManagerRequest::Hold { robot: Box::new(robot.clone()), access: access.clone(), screen: *screen, done };
        let broken = || Failure::local("the thread that holds links has ended");
        self.orders.send(order).map_err(|_| broken())?;
        let by = interruptible(is_done).await?.map_err(|_| broken())??;
        if let By::Nobody(why) = &by
            && !self.told.swap(true, Ordering::Relaxed)
        {
            screen.note(&format!("links are not held from one line to the next: {why}"));
        }
        Ok(by)
    }
}
