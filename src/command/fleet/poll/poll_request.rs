//! Needs of the consumers, and their sum.

use std::rc::Rc;
use std::time::Duration;

use tokio::sync::watch;

use super::{Extra, RobotId};
use armctl_frame::face::sample::Detail;

/// Needs of one consumer, for all robots.
#[derive(Debug, Clone, PartialEq)]
pub struct PollRequest {
    /// Polling interval.
    pub every: Duration,
    /// Level of detail.
    pub detail: Detail,
    /// Robot that needs full detail, independent of `detail`.
    pub whole: Option<RobotId>,
    /// Extra commands with each poll.
    pub extras: Rc<[Rc<Extra>]>,
    /// Whether the results contain the answers of the controller, for a recording.
    pub answers: bool,
    /// Longest backoff of a robot that does not answer. The backoff starts with one second, or with `every` if that is
    /// longer, and doubles.
    pub longest_pause: Duration,
}

impl PollRequest {
    /// Summary of each robot at this interval.
    pub fn every(every: Duration) -> Self {
        Self {
            every,
            detail: Detail::Summary,
            whole: None,
            extras: Rc::from([]),
            answers: false,
            longest_pause: Duration::from_secs(60),
        }
    }
}

/// Sum of all requests.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MergedRequests {
    /// Polling interval.
    pub every: Duration,
    /// See [`PollRequest::longest_pause`].
    pub longest_pause: Duration,
    /// See [`PollRequest::answers`]. It applies to links that open later.
    pub answers: bool,
    detail: Detail,
    whole: Vec<RobotId>,
    extras: Vec<Rc<Extra>>,
}

/// Interval without a consumer; the poller is about to stop.
const IDLE_INTERVAL: Duration = Duration::from_secs(1);

impl MergedRequests {
    /// Combines all requests.
    pub fn merge_all(requests: &[watch::Receiver<PollRequest>]) -> Self {
        let idle = Self {
            every: IDLE_INTERVAL,
            longest_pause: IDLE_INTERVAL,
            answers: false,
            detail: Detail::Summary,
            whole: Vec::new(),
            extras: Vec::new(),
        };
        let requests = requests.iter().map(|request| request.borrow().clone());
        requests.map(Self::from).reduce(Self::merge).unwrap_or(idle)
    }

    fn merge(mut self, other: Self) -> Self {
        self.every = self.every.min(other.every);
        self.longest_pause = self.longest_pause.min(other.longest_pause);
        self.answers |= other.answers;
        self.detail = self.detail.max(other.detail);
        self.whole.extend(other.whole);
        let new = other.extras.into_iter().filter(|extra| !self.extras.contains(extra)).collect::<Vec<_>>();
        self.extras.extend(new);
        self
    }

    /// Level of detail for a robot.
    pub fn detail(&self, robot: &RobotId) -> Detail {
        if self.whole.contains(robot) { Detail::Full } else { self.detail }
    }

    /// Extra commands for a robot.
    pub fn extras<'a>(&'a self, robot: &'a RobotId) -> impl Iterator<Item = &'a Rc<Extra>> {
        self.extras.iter().filter(|extra| extra.family() == robot.family)
    }
}

impl From<PollRequest> for MergedRequests {
    fn from(request: PollRequest) -> Self {
        let PollRequest { every, detail, whole, extras, answers, longest_pause } = request;
        Self { every, longest_pause, answers, detail, whole: whole.into_iter().collect(), extras: extras.to_vec() }
    }
}
