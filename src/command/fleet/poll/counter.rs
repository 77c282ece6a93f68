//! End of a run after a number of polls of each robot.

use std::collections::BTreeMap;

use super::{Event, RobotId, Subscription};

/// Events of the poller, up to a number of polls per robot.
#[derive(Debug)]
pub struct PollCounter {
    left: BTreeMap<RobotId, u64>,
    is_bounded: bool,
}

impl PollCounter {
    /// Events for these robots, up to `count` polls of each robot. Without a count, events do not end.
    pub fn new(robots: &[RobotId], count: Option<u64>) -> Self {
        let left = count.map(|count| robots.iter().map(|id| (id.clone(), count)).collect()).unwrap_or_default();
        Self { left, is_bounded: count.is_some() }
    }

    /// Next event; `None` after the last one.
    pub async fn next(&mut self, events: &mut Subscription) -> Option<Event> {
        if self.is_bounded && self.left.is_empty() {
            return None;
        }
        let event = events.next().await?;
        let polled_robots = match &event {
            Event::Polled(look) => Some((RobotId::for_robot(&look.robot), 1)),
            Event::Failed { robot, .. } => Some((RobotId::for_robot(robot), 1)),
            Event::Gone(robot) => Some((RobotId::for_robot(robot), u64::MAX)),
            Event::Appeared(_) | Event::Inventory(_) => None,
        };
        if let Some((id, looks)) = polled_robots
            && let Some(left) = self.left.get_mut(&id)
        {
            *left = left.saturating_sub(looks);
            if *left == 0 {
                self.left.remove(&id);
            }
        }
        Some(event)
    }
}
