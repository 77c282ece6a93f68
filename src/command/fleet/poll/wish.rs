//! What consumers want to know, and what has to be asked for all of them.

use std::rc::Rc;
use std::time::Duration;

use tokio::sync::watch;

use super::{Extra, RobotId};
use crate::command::face::sample::Detail;

/// What a consumer wants to know, of all robots.
#[derive(Debug, Clone, PartialEq)]
pub struct Wish {
    /// Time from look to look.
    pub every: Duration,
    /// How much of each robot.
    pub detail: Detail,
    /// The robot of which all is wanted, whatever `detail` says.
    pub whole: Option<RobotId>,
    /// Command lines that are asked along with each look.
    pub extras: Rc<[Rc<Extra>]>,
    /// The longest that a robot is left alone that does not answer. It begins with a second, or with `every` where that
    /// is longer, and doubles.
    pub longest_pause: Duration,
}

impl Wish {
    /// A line of each robot, so often.
    pub fn every(every: Duration) -> Self {
        Self {
            every,
            detail: Detail::Summary,
            whole: None,
            extras: Rc::from([]),
            longest_pause: Duration::from_secs(60),
        }
    }
}

/// What has to be asked, so that all wishes are met.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wants {
    /// Time from look to look.
    pub every: Duration,
    /// See [`Wish::longest_pause`].
    pub longest_pause: Duration,
    detail: Detail,
    whole: Vec<RobotId>,
    extras: Vec<Rc<Extra>>,
}

/// Time from look to look where nobody wants to know anything: a moment later all is over.
const IDLE: Duration = Duration::from_secs(1);

impl Wants {
    /// What all of these want together.
    pub fn of(wishes: &[watch::Receiver<Wish>]) -> Self {
        let idle =
            Self { every: IDLE, longest_pause: IDLE, detail: Detail::Summary, whole: Vec::new(), extras: Vec::new() };
        let wishes = wishes.iter().map(|wish| wish.borrow().clone());
        wishes.map(Self::from).reduce(Self::and).unwrap_or(idle)
    }

    fn and(mut self, other: Self) -> Self {
        self.every = self.every.min(other.every);
        self.longest_pause = self.longest_pause.min(other.longest_pause);
        self.detail = self.detail.max(other.detail);
        self.whole.extend(other.whole);
        let new = other.extras.into_iter().filter(|extra| !self.extras.contains(extra)).collect::<Vec<_>>();
        self.extras.extend(new);
        self
    }

    /// How much is wanted of a robot.
    pub fn detail(&self, robot: &RobotId) -> Detail {
        if self.whole.contains(robot) { Detail::Full } else { self.detail }
    }

    /// What is asked of it along with a look.
    pub fn extras<'a>(&'a self, robot: &'a RobotId) -> impl Iterator<Item = &'a Rc<Extra>> {
        self.extras.iter().filter(|extra| extra.family() == robot.family)
    }
}

impl From<Wish> for Wants {
    fn from(wish: Wish) -> Self {
        let Wish { every, detail, whole, extras, longest_pause } = wish;
        Self { every, longest_pause, detail, whole: whole.into_iter().collect(), extras: extras.to_vec() }
    }
}
