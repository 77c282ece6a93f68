//! The one poller: looks at robots of any family again and again, and tells whoever wants to know.
//!
//! [`Poll`] is told by its consumers what they want ([`Wish`]) and hands out a stream of [`Event`]s to each. A robot is
//! asked once per interval, however many consumers there are, with all that any of them wants. Robots are followed side
//! by side, each at its own pace: one that is slow or gone holds up no other.
//!
//! | file | holds |
//! |---|---|
//! | `follow` | looks at one robot: its moments, its pauses while it fails, its session |
//! | `roster` | which robots there are, as the inventory changes |
//! | `wish` | what consumers want, and what all of them want together |
//! | `extra` | command lines that only read, asked along with a look |
//!
//! Only reads leave, through connections that look ([`ConnectMode::Monitor`](crate::command::ConnectMode)): to a YRCX no
//! connection is opened that commands, and where a session holds the link the looks go through it.

mod extra;
mod follow;
mod roster;
#[cfg(test)]
mod tests;
mod wish;

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

pub use self::extra::Extra;
use self::follow::{Follower, follow};
use self::roster::Roster;
use self::wish::Wants;
pub use self::wish::Wish;
use crate::command::face::sample::{Sample, Traffic};
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::target::Family;
use crate::settings::{Robot, Sources};

/// What tells a robot from all others that are polled: the simulators of several families share a name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RobotId {
    /// Its name in the inventory, or a short form of its target.
    pub name: String,
    /// Its family.
    pub family: Family,
}

impl RobotId {
    /// That of a robot.
    pub fn of(robot: &Robot) -> Self {
        Self { name: robot.name.clone(), family: robot.family }
    }
}

/// What a consumer is told.
#[derive(Debug, Clone)]
pub enum Event {
    /// A robot is looked at from now on. Comes before all else about it; again, after [`Event::Gone`], when its entry has
    /// changed.
    Appeared(Arc<Robot>),
    /// It was looked at.
    Looked(Arc<Look>),
    /// It did not answer, or not as it should.
    Failed {
        /// Which.
        robot: Arc<Robot>,
        /// Why.
        failure: Failure,
        /// How long it is left alone now.
        pause: Duration,
        /// What was counted on its link since it was told of last.
        traffic: Traffic,
    },
    /// It is looked at no more: the inventory has it no more, or has it changed. Nothing follows about it.
    Gone(Arc<Robot>),
    /// The inventory has changed, and counts; or it cannot be read, and what it said before goes on to count. Each change
    /// is told once.
    Inventory(Result<(), Failure>),
}

/// What a look came to.
#[derive(Debug)]
pub struct Look {
    /// At which robot.
    pub robot: Arc<Robot>,
    /// What was found.
    pub sample: Sample,
    /// How long it took, from the first question to the last answer.
    pub took: Duration,
    /// Looks that were left out since the last one, because that took longer than an interval.
    pub missed: u64,
    /// Whether it went through a session.
    pub through_session: bool,
    /// What was counted on its link since it was told of last.
    pub traffic: Traffic,
    /// What the command lines that were wished for this family told, with each its text as it was wished.
    pub extras: Vec<(Arc<str>, Result<Value, Failure>)>,
    /// Why the fault could not be explained with `alarms.toml`, where that is so.
    pub unexplained: Option<Failure>,
}

impl Look {
    /// One that found this, and nothing besides.
    pub fn new(robot: Arc<Robot>, sample: Sample) -> Self {
        Self {
            robot,
            sample,
            took: Duration::ZERO,
            missed: 0,
            through_session: false,
            traffic: Traffic::default(),
            extras: Vec::new(),
            unexplained: None,
        }
    }
}

/// What a consumer holds of a [`Poll`]. When all of them are dropped, the poll ends.
#[derive(Debug)]
pub struct Subscription {
    events: mpsc::Receiver<Event>,
    wish: watch::Sender<Wish>,
}

impl Subscription {
    /// The next event; `None` when the poll is no longer run. May be dropped while it waits.
    pub async fn next(&mut self) -> Option<Event> {
        self.events.recv().await
    }

    /// Wants something else from now on.
    pub fn wish(&self, wish: Wish) {
        self.wish.send_if_modified(|last| {
            let is_new = *last != wish;
            *last = wish;
            is_new
        });
    }
}

/// Events that wait to be taken by one consumer; further ones wait with their robots.
const EVENTS: usize = 64;
/// How long links may take to close.
const LEAVE_WITHIN: Duration = Duration::from_secs(1);

/// Robots that are looked at again and again while [`Poll::run`] is awaited.
#[derive(Debug)]
pub struct Poll {
    roster: Roster,
    /// What links have to say while they are opened, where anybody wants to hear that.
    screen: Screen,
    consumers: Vec<(watch::Receiver<Wish>, mpsc::Sender<Event>)>,
}

impl Poll {
    /// The robots that flags, environment and inventory name, at least one; those of the inventory as it changes.
    pub fn new(sources: &Sources, screen: Screen) -> Result<Self, Failure> {
        Ok(Self { roster: Roster::new(sources.clone())?, screen, consumers: Vec::new() })
    }

    /// This robot alone, as it is.
    pub fn of(robot: Robot, screen: Screen) -> Self {
        Self { roster: Roster::fixed(vec![robot]), screen, consumers: Vec::new() }
    }

    /// The robots that it begins with.
    pub fn robots(&self) -> &[Robot] {
        self.roster.robots()
    }

    /// One more who wants to know.
    pub fn subscribe(&mut self, wish: Wish) -> Subscription {
        let (wish, wishes) = watch::channel(wish);
        let (tell, events) = mpsc::channel(EVENTS);
        self.consumers.push((wishes, tell));
        Subscription { events, wish }
    }

    /// Looks, until every [`Subscription`] is dropped; then leaves the links properly, for which nobody waits long.
    pub async fn run(self) {
        let Self { roster, screen, consumers } = self;
        let (mut wishes, tellers): (Vec<_>, Vec<_>) = consumers.into_iter().unzip();
        let tell = Teller(tellers.into());
        let (wants, _) = watch::channel(Wants::of(&wishes));
        let mut fleet =
            Fleet { roster, screen, tell, wants, active: BTreeMap::new(), followers: FuturesUnordered::new() };
        fleet.settle(true).await;
        loop {
            tokio::select! {
                () = changed(&mut wishes) => {
                    if wishes.is_empty() {
                        break;
                    }
                    fleet.wants.send_if_modified(|last| {
                        let now = Wants::of(&wishes);
                        let is_new = *last != now;
                        *last = now;
                        is_new
                    });
                }
                Some(id) = fleet.followers.next() => fleet.ended(&id).await,
                read = fleet.roster.changed() => {
                    fleet.tell.tell(Event::Inventory(read)).await;
                    fleet.settle(false).await;
                }
            }
        }
        fleet.end().await;
    }
}

/// Tells all consumers.
#[derive(Debug, Clone)]
struct Teller(Rc<[mpsc::Sender<Event>]>);

impl Teller {
    async fn tell(&self, event: Event) {
        for consumer in &*self.0 {
            // One that is gone wants to know no more; when all are, the poll ends.
            let _gone = consumer.send(event.clone()).await;
        }
    }
}

/// Waits until a wish has changed; those of consumers that are gone go, too.
async fn changed(wishes: &mut Vec<watch::Receiver<Wish>>) {
    if wishes.is_empty() {
        return;
    }
    let (changed, at, _) = select_all(wishes.iter_mut().map(|wish| wish.changed().boxed_local())).await;
    if changed.is_err() {
        wishes.swap_remove(at);
    }
}

/// The robots that are looked at, and who looks.
struct Fleet {
    roster: Roster,
    screen: Screen,
    tell: Teller,
    wants: watch::Sender<Wants>,
    active: BTreeMap<RobotId, Active>,
    followers: FuturesUnordered<LocalBoxFuture<'static, RobotId>>,
}

/// A robot that is looked at.
struct Active {
    /// As the inventory has it.
    given: Robot,
    robot: Arc<Robot>,
    /// Says when it is over; nothing once that was said.
    stop: Option<watch::Sender<bool>>,
}

impl Fleet {
    /// Has those looked at that are on the roster, and no others. A robot that is new waits until those that go have let
    /// go of their links: it may be the same controller under another name.
    async fn settle(&mut self, is_start: bool) {
        let wanted: BTreeMap<RobotId, &Robot> =
            self.roster.robots().iter().map(|robot| (RobotId::of(robot), robot)).collect();
        for (id, active) in &mut self.active {
            if wanted.get(id).is_none_or(|robot| **robot != active.given)
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
            .filter(|robot| !self.active.contains_key(&RobotId::of(robot)))
            .cloned()
            .collect();
        // Not all at the same moment; as each keeps to its own moments from then on, it stays so.
        let share = self.wants.borrow().every / u32::try_from(new.len().max(1)).unwrap_or(u32::MAX);
        for (at, given) in (0_u32..).zip(new) {
            let id = RobotId::of(&given);
            let robot = Arc::new(self.roster.identified(&given));
            let (stop, stopped) = watch::channel(false);
            let follower = Follower {
                robot: Arc::clone(&robot),
                screen: self.screen,
                delay: if is_start { share * at } else { Duration::ZERO },
                wants: self.wants.subscribe(),
                stopped,
                tell: self.tell.clone(),
                asked: HashMap::new(),
            };
            self.active.insert(id.clone(), Active { given, robot: Arc::clone(&robot), stop: Some(stop) });
            self.tell.tell(Event::Appeared(robot)).await;
            self.followers.push(
                async move {
                    follow(follower).await;
                    id
                }
                .boxed_local(),
            );
        }
    }

    /// One is looked at no more.
    async fn ended(&mut self, id: &RobotId) {
        if let Some(active) = self.active.remove(id) {
            self.tell.tell(Event::Gone(active.robot)).await;
        }
        self.settle(false).await;
    }

    async fn end(mut self) {
        for active in self.active.values_mut() {
            if let Some(stop) = active.stop.take() {
                stop.send_replace(true);
            }
        }
        let followers = async { while self.followers.next().await.is_some() {} };
        let _left = timeout(LEAVE_WITHIN, followers).await;
    }
}

/// Ends when somebody says that it is over, or nobody can say so any more.
async fn over(stopped: &mut watch::Receiver<bool>) {
    if stopped.wait_for(|is_over| *is_over).await.is_err() {
        // Whoever waits here is dropped with who could have said so.
        pending::<()>().await;
    }
}
