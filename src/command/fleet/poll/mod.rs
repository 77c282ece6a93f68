//! The poller: polls robots of any family, and sends events to its consumers.
//!
//! Consumers declare what they need with a [`PollRequest`], and receive a stream of [`Event`]s. A robot is polled once per
//! interval for all consumers together. Each robot has its own task, so a slow robot does not delay the others.
//!
//! | file | contents |
//! |---|---|
//! | `robot_loop` | polling loop of one robot: ticks, backoff, session |
//! | `roster` | list of robots, updated from the inventory |
//! | `counter` | end after a number of polls |
//! | `poll_request` | needs of the consumers, and their sum |
//! | `extra_command` | extra read commands with each poll |
//!
//! The poller only reads, through links in [`ConnectMode::Monitor`](armctl_frame::ConnectMode). It opens no control
//! connection to a YRCX. If a session has the link, it polls through the session.

mod counter;
mod extra_command;
mod poll_request;
mod robot_loop;
mod roster;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, HashMap};
use std::future::pending;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::StreamExt as _;
use futures_util::future::{LocalBoxFuture, select_all};
use futures_util::stream::FuturesUnordered;
use serde_json::Value;
use tokio::sync::{mpsc, watch};
use tokio::time::timeout;

pub use self::counter::PollCounter;
pub use self::extra_command::Extra;
use self::poll_request::MergedRequests;
pub use self::poll_request::PollRequest;
use self::robot_loop::{RobotTask, follow};
use self::roster::Roster;
use armctl_controller::simulator::recording::{AnswerLog, Answers};
use armctl_frame::face::sample::{Sample, Traffic};
use armctl_frame::prelude::*;
use armctl_frame::settings::Sources;
use armctl_frame::settings::target::Family;

/// Unique id of a polled robot. The name is not enough: simulators of several families have the same name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RobotId {
    /// Name in the inventory, or a short form of the target.
    pub name: String,
    /// Family.
    pub family: Family,
}

impl RobotId {
    /// Id of a robot.
    pub fn for_robot(robot: &Robot) -> Self {
        Self { name: robot.name.clone(), family: robot.family }
    }
}

/// Event for consumers.
#[derive(Debug, Clone)]
pub enum Event {
    /// Polling of a robot starts. This is the first event of the robot. After a change of the inventory entry, it
    /// follows [`Event::Gone`].
    Appeared(Arc<Robot>),
    /// A poll succeeded.
    Polled(Arc<PollResult>),
    /// A poll failed: the answer was missing or not valid.
    Failed {
        /// The robot.
        robot: Arc<Robot>,
        /// The failure.
        failure: Failure,
        /// Backoff until the next poll.
        pause: Duration,
        /// Traffic on the link since the last event.
        traffic: Traffic,
    },
    /// Polling of a robot has ended, because its inventory entry was removed or changed. This is the last event of the
    /// robot.
    Gone(Arc<Robot>),
    /// The inventory has changed and is in use, or it cannot be read and the previous inventory stays in use. Each
    /// change is reported once.
    Inventory(Result<(), Failure>),
}

/// Result of a successful poll.
#[derive(Debug)]
pub struct PollResult {
    /// The robot.
    pub robot: Arc<Robot>,
    /// The data.
    pub sample: Sample,
    /// Duration from the first request to the last answer.
    pub took: Duration,
    /// Polls omitted before this one, because the previous poll took longer than the interval.
    pub missed: u64,
    /// Whether the poll went through a session.
    pub through_session: bool,
    /// Traffic on the link since the last event.
    pub traffic: Traffic,
    /// Results of the extra commands, each with its text.
    pub extras: Vec<(Arc<str>, Result<Value, Failure>)>,
    /// Answers of the controller since the last successful poll, if a consumer requested them.
    pub answers: Answers,
    /// Error of `alarms.toml`, if it prevented an explanation of the fault.
    pub unexplained: Option<Failure>,
}

impl PollResult {
    /// A result with this data only.
    pub fn new(robot: Arc<Robot>, sample: Sample) -> Self {
        Self {
            robot,
            sample,
            took: Duration::ZERO,
            missed: 0,
            through_session: false,
            traffic: Traffic::default(),
            extras: Vec::new(),
            answers: Answers::new(),
            unexplained: None,
        }
    }
}

/// Subscription of a consumer. The poller stops when all subscriptions are dropped.
#[derive(Debug)]
pub struct Subscription {
    events: mpsc::Receiver<Event>,
    request: watch::Sender<PollRequest>,
}

impl Subscription {
    /// Waits for the next event; `None` after the poller has stopped. Cancel safe.
    pub async fn next(&mut self) -> Option<Event> {
        self.events.recv().await
    }

    /// Replaces the request.
    pub fn update_request(&self, request: PollRequest) {
        self.request.send_if_modified(|last| {
            let is_new = *last != request;
            *last = request;
            is_new
        });
    }
}

/// Queue size per consumer. When it is full, the polling tasks wait.
const EVENTS: usize = 64;
/// Time limit for closing links.
const CLOSE_TIMEOUT: Duration = Duration::from_secs(1);

/// The poller. It runs while [`Poll::run`] is awaited.
#[derive(Debug)]
pub struct Poll {
    roster: Roster,
    /// Screen for messages of links while they open.
    screen: Screen,
    consumers: Vec<(watch::Receiver<PollRequest>, mpsc::Sender<Event>)>,
}

impl Poll {
    /// Creates a poller for the robots that flags, environment and inventory select; at least one. The poller follows
    /// changes of the inventory.
    pub fn new(sources: &Sources, screen: Screen) -> Result<Self, Failure> {
        Ok(Self { roster: Roster::new(sources.clone())?, screen, consumers: Vec::new() })
    }

    /// Creates a poller for one fixed robot.
    pub fn of(robot: Robot, screen: Screen) -> Self {
        Self { roster: Roster::from_robots(vec![robot]), screen, consumers: Vec::new() }
    }

    /// The robots at the start.
    pub fn robots(&self) -> &[Robot] {
        self.roster.robots()
    }

    /// Adds a consumer.
    pub fn subscribe(&mut self, request: PollRequest) -> Subscription {
        let (request, requests) = watch::channel(request);
        let (tell, events) = mpsc::channel(EVENTS);
        self.consumers.push((requests, tell));
        Subscription { events, request }
    }

    /// Polls until every [`Subscription`] is dropped; then closes the links, within a time limit.
    pub async fn run(self) {
        let Self { roster, screen, consumers } = self;
        let (mut requests, tellers): (Vec<_>, Vec<_>) = consumers.into_iter().unzip();
        let event_sender = EventSender(tellers.into());
        let (requests_sender, _) = watch::channel(MergedRequests::merge_all(&requests));
        let mut fleet = Fleet {
            roster,
            screen,
            events: event_sender,
            requests: requests_sender,
            active: BTreeMap::new(),
            followers: FuturesUnordered::new(),
        };
        fleet.match_roster(true).await;
        loop {
            tokio::select! {
                () = changed(&mut requests) => {
                    if requests.is_empty() {
                        break;
                    }
                    fleet.requests.send_if_modified(|last| {
                        let now = MergedRequests::merge_all(&requests);
                        let is_new = *last != now;
                        *last = now;
                        is_new
                    });
                }
                Some(id) = fleet.followers.next() => fleet.remove_robot(&id).await,
                read = fleet.roster.changed() => {
                    fleet.events.send(Event::Inventory(read)).await;
                    fleet.match_roster(false).await;
                }
            }
        }
        fleet.stop_all().await;
    }
}

/// Sends events to all consumers.
#[derive(Debug, Clone)]
struct EventSender(Rc<[mpsc::Sender<Event>]>);

impl EventSender {
    async fn send(&self, event: Event) {
        for consumer in &*self.0 {
            // A consumer may have ended. When all consumers have ended, the poller stops.
            let _gone = consumer.send(event.clone()).await;
        }
    }
}

/// Waits for a changed request. Removes the requests of consumers that have ended.
async fn changed(requests: &mut Vec<watch::Receiver<PollRequest>>) {
    if requests.is_empty() {
        return;
    }
    let (changed, at, _) = select_all(requests.iter_mut().map(|request| request.changed().boxed_local())).await;
    if changed.is_err() {
        requests.swap_remove(at);
    }
}

/// The polled robots with their tasks.
struct Fleet {
    roster: Roster,
    screen: Screen,
    events: EventSender,
    requests: watch::Sender<MergedRequests>,
    active: BTreeMap<RobotId, Active>,
    followers: FuturesUnordered<LocalBoxFuture<'static, RobotId>>,
}

struct Active {
    /// The robot of the inventory.
    entry: Robot,
    robot: Arc<Robot>,
    /// Stops the task; `None` after the stop.
    stop: Option<watch::Sender<bool>>,
}

impl Fleet {
    /// Starts and stops tasks to match the roster. A new robot waits until the removed robots have closed their links,
    /// because the new robot can be the same controller with another name.
    async fn match_roster(&mut self, is_start: bool) {
        let expected: BTreeMap<RobotId, &Robot> =
            self.roster.robots().iter().map(|robot| (RobotId::for_robot(robot), robot)).collect();
        for (id, active) in &mut self.active {
            if expected.get(id).is_none_or(|robot| **robot != active.entry)
                && let Some(stop) = active.stop.take()
            {
                stop.send_replace(true);
            }
        }
        if self.active.values().any(|active| active.stop.is_none()) {
            return;
        }
        let new: Vec<Robot> = self
            .roster
            .robots()
            .iter()
            .filter(|robot| !self.active.contains_key(&RobotId::for_robot(robot)))
            .cloned()
            .collect();
        // Spread the robots over the interval. Ticks have no drift, so the robots stay spread.
        let share = self.requests.borrow().every / u32::try_from(new.len().max(1)).unwrap_or(u32::MAX);
        for (at, given) in (0_u32..).zip(new) {
            let id = RobotId::for_robot(&given);
            let robot = Arc::new(self.roster.identify(&given));
            let (stop, stopped) = watch::channel(false);
            let follower = RobotTask {
                robot: Arc::clone(&robot),
                screen: self.screen,
                delay: if is_start { share * at } else { Duration::ZERO },
                requests: self.requests.subscribe(),
                stop: stopped,
                events: self.events.clone(),
                extra_commands: HashMap::new(),
                answers: AnswerLog::default(),
            };
            self.active.insert(id.clone(), Active { entry: given, robot: Arc::clone(&robot), stop: Some(stop) });
            self.events.send(Event::Appeared(robot)).await;
            self.followers.push(
                async move {
                    follow(follower).await;
                    id
                }
                .boxed_local(),
            );
        }
    }

    async fn remove_robot(&mut self, id: &RobotId) {
        if let Some(active) = self.active.remove(id) {
            self.events.send(Event::Gone(active.robot)).await;
        }
        self.match_roster(false).await;
    }

    async fn stop_all(mut self) {
        for active in self.active.values_mut() {
            if let Some(stop) = active.stop.take() {
                stop.send_replace(true);
            }
        }
        let followers = async { while self.followers.next().await.is_some() {} };
        let _left = timeout(CLOSE_TIMEOUT, followers).await;
    }
}

/// Waits until the task is stopped.
async fn wait_for_stop(stopped: &mut watch::Receiver<bool>) {
    if stopped.wait_for(|is_over| *is_over).await.is_err() {
        // The sender was dropped, so this task is dropped as well.
        pending::<()>().await;
    }
}
