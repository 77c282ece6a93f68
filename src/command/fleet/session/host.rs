//! Session hosts in this process: for `session open`, or for the prompt and command files.

use std::cell::RefCell;
use std::rc::Rc;
use std::thread::JoinHandle;

use tokio::sync::{mpsc, oneshot, watch};
use tokio::task::{JoinSet, LocalSet};

use super::watched_entry::WatchedEntry;
use crate::command::families;
use armctl_frame::face::HeldLink;
use armctl_frame::guardian::{self, SessionGuardian};
use armctl_frame::prelude::*;
use armctl_frame::session_client::{folder_failure, in_use, info, own_key, session_key};
use armctl_frame::session_manager::{HeldBy, ManagerRequest, OwnSession, SessionManager};
use armctl_transport::session::direct::HostHandle;
use armctl_transport::session::host::{EndReason, Host};
use armctl_transport::session::location::{LockResult, SessionFolder};

/// A link that this process holds, with clients.
pub struct SessionHost {
    host: Host,
    /// Stops the motions of clients when this process ends.
    guardian: Rc<SessionGuardian>,
    /// Action after the link is closed.
    finish: Option<Box<dyn FnOnce() -> Result<()>>>,
    label: String,
}

/// Result of an attempt to hold a link.
pub enum OpenResult {
    /// The link is held.
    SharedLink(Box<SessionHost>),
    /// Another process has the link.
    InUse,
    /// No sessions are possible, with the reason.
    NoPlace(Failure),
}

impl SessionHost {
    /// Opens the link to a robot, and accepts clients. `say` receives log messages, also from other threads.
    pub async fn open(
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        log: impl Fn(&str) + Clone + Send + 'static,
    ) -> Result<OpenResult> {
        let place = match SessionFolder::create() {
            Ok(place) => place,
            Err(error) => return Ok(OpenResult::NoPlace(folder_failure(&error))),
        };
        let key = session_key(robot);
        let location = place.location(&key);
        let claim = match location.lock_or_attach(&info(robot, access)).await {
            Ok(LockResult::Locked(claim)) => claim,
            Ok(LockResult::Session) => return Ok(OpenResult::InUse),
            Ok(LockResult::Busy) => return Err(in_use(robot, &location)),
            Err(error) => return Ok(OpenResult::NoPlace(folder_failure(&error))),
        };
        let info = info(robot, access);
        let face = families::of(robot.family);
        let HeldLink { held, finish } = (face.open_session_link)(robot, access, screen).await?;
        let host =
            Host::new(claim, key, info, held, log.clone()).with_context(|| location.socket().display().to_string())?;
        let orphaned_robot = robot.clone();
        let guardian = Rc::new(SessionGuardian::new(robot, face.driver.stop));
        let guardian_result = Rc::clone(&guardian);
        let is_simulated = robot.target.value.is_simulated();
        let host = host.with_guard(move |moves| if is_simulated { Ok(()) } else { guardian_result.set_moving(moves) });
        let host = host.with_stop(move |why| {
            log(&format!("{why}: armctl stops the robot"));
            guardian::stop_orphan(&orphaned_robot, face.driver.stop, log.clone());
        });
        let mut entry = WatchedEntry::new(robot);
        let host = host.with_read_only_check(face.guard, move || entry.is_read_only());
        Ok(OpenResult::SharedLink(Box::new(Self { host, guardian, finish, label: robot.label() })))
    }

    /// Sets the idle time after which the session ends.
    #[must_use]
    pub fn with_idle_limit(self, idle: Option<Duration>) -> Self {
        Self { host: self.host.with_idle_limit(idle), ..self }
    }

    /// Serves clients until one of them closes the session, or until the idle time is over. Cancel safe:
    /// [`SessionHost::end`] continues from there.
    pub async fn serve(&mut self) -> EndReason {
        self.guardian.guard(Box::pin(self.host.serve())).await
    }

    /// Access to the session for the other threads of this process.
    fn handle(&mut self) -> HostHandle {
        self.host.handle()
    }

    /// Whether the robot moves.
    pub fn is_moving(&mut self) -> bool {
        self.host.is_moving()
    }

    /// Ends the session: informs clients, closes the link, completes the recording.
    pub async fn end(self, why: &str, screen: &Screen) -> Result<()> {
        if let Err(trouble) = self.host.end(why).await {
            screen.note(&format!("{}: the connection was not closed correctly: {trouble}", self.label));
        }
        self.finish.map_or(Ok(()), |finish| finish())
    }
}

/// Receiver of log messages.
type Say = Arc<dyn Fn(&str) + Send + Sync>;

/// Starts the thread without a link. Log messages go to `say`.
pub fn start(say: impl Fn(&str) + Send + Sync + 'static) -> Result<(SessionManager, ManagerThread)> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.context("start")?;
    let (orders, ordered) = mpsc::unbounded_channel();
    let say: Say = Arc::new(say);
    let work = move || LocalSet::new().block_on(&runtime, work(ordered, say));
    let thread = std::thread::Builder::new().name("links".to_owned()).spawn(work);
    let thread = thread.context("start")?;
    let manager = SessionManager::new(orders);
    Ok((manager.clone(), ManagerThread { manager, thread }))
}

/// Thread behind a [`SessionManager`].
#[derive(Debug)]
pub struct ManagerThread {
    manager: SessionManager,
    thread: JoinHandle<()>,
}

impl ManagerThread {
    /// Closes all links, and waits until the thread has ended.
    pub async fn end(self) {
        let (done, is_done) = oneshot::channel();
        // A thread that has ended holds no link.
        if self.manager.end(done) && is_done.await.is_ok() {
            let _ = self.thread.join();
        }
    }
}

/// Body of the thread.
async fn work(mut orders: mpsc::UnboundedReceiver<ManagerRequest>, say: Say) {
    let by_robot = Rc::new(RefCell::new(BTreeMap::new()));
    let (end, ended) = watch::channel(false);
    let mut holdings = JoinSet::new();
    while let Some(order) = orders.recv().await {
        match order {
            ManagerRequest::Hold { robot, access, screen, done } => {
                let (held, say, ended) = (Rc::clone(&by_robot), Arc::clone(&say), ended.clone());
                holdings.spawn_local(open_session_link(*robot, access, screen, done, held, say, ended));
            }
            ManagerRequest::End(done) => {
                end.send_replace(true);
                while holdings.join_next().await.is_some() {}
                // The caller may have ended already.
                let _ = done.send(());
                return;
            }
        }
    }
}

async fn open_session_link(
    robot: Robot,
    access: Access,
    screen: Screen,
    mut done: oneshot::Sender<Result<HeldBy>>,
    held: Rc<RefCell<BTreeMap<String, HostHandle>>>,
    say: Say,
    mut ended: watch::Receiver<bool>,
) {
    let key = session_key(&robot);
    let label = robot.label();
    let reply = {
        let (say, label) = (Arc::clone(&say), label.clone());
        move |text: &str| say(&format!("{label}: {text}"))
    };
    let records = families::of(robot.family).session_records;
    let own = |host| HeldBy::ThisProcess(OwnSession { key: own_key(&robot), host, records });
    // Robots with several addresses: another line has opened the link with another address.
    if let Some(host) = held.borrow().get(&key) {
        let _ = done.send(Ok(own(host.clone())));
        return;
    }
    let access = Access { trace: access.trace.filter(|_| records), ..access };
    let attempt = tokio::select! {
        attempt = SessionHost::open(&robot, &access, &screen, reply) => attempt,
        () = done.closed() => return,
    };
    let mut holding = match attempt {
        Ok(OpenResult::SharedLink(holding)) => holding,
        other => {
            // The caller may already be interrupted.
            let _ = done.send(match other {
                Ok(OpenResult::NoPlace(why)) => Ok(HeldBy::None(why)),
                Ok(_) => Ok(HeldBy::OtherProcess),
                Err(failure) => Err(failure),
            });
            return;
        }
    };
    let host = holding.handle();
    held.borrow_mut().insert(key.clone(), host.clone());
    // The caller may already be interrupted. The link stays open for the next line.
    let _ = done.send(Ok(own(host)));
    let why = tokio::select! {
        _ = holding.serve() => {
            say(&format!("{label}: another process closed the session"));
            "the session was closed"
        }
        _ = ended.wait_for(|ended| *ended) => {
            if holding.is_moving() {
                say(&format!("{label}: the connection ends during a motion; the controller stops the motion"));
            }
            "the process of the session has ended"
        }
    };
    held.borrow_mut().remove(&key);
    if let Err(failure) = holding.end(why, &screen).await {
        say(&format!("{label}: {failure}"));
    }
}
