//! End of a run after a number of polls of each robot.

use std::collections::BTreeMap;

use super::{Event, RobotId, Subscription};

/// Events of the poller, up to a number of polls per robot.
#[derive(Debug)]
pub struct PollCounter {
    /// Polls that are left for each robot; `None` without a limit.
    left: Option<BTreeMap<RobotId, u64>>,
}

impl PollCounter {
    /// Events for these robots, up to `count` polls of each robot. Without a count, events do not end.
    pub fn new(robots: &[RobotId], count: Option<u64>) -> Self {
        Self { left: count.map(|count| robots.iter().map(|id| (id.clone(), count)).collect()) }
    }

    /// Next event; `None` after the last one. Omits the polls of a robot beyond the count: other robots can need longer.
    pub async fn next(&mut self, events: &mut Subscription) -> Option<Event> {
        let Some(left) = &mut self.left else { return events.next().await };
        while left.values().any(|polls| *polls > 0) {
            let event = events.next().await?;
            let (robot, is_gone) = match &event {
                Event::Polled(poll) => (&poll.robot, false),
                Event::Failed { robot, .. } => (robot, false),
                Event::Gone(robot) => (robot, true),
                Event::Appeared(_) | Event::Inventory(_) => return Some(event),
            };
            match left.get_mut(&RobotId::for_robot(robot)) {
                Some(polls) if is_gone => *polls = 0,
                Some(0) => continue,
                Some(polls) => *polls -= 1,
                None => {}
            }
            return Some(event);
        }
        None
    }
}
