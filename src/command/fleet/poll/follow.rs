//! Polling loop of one robot.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

use serde_json::Value;
use tokio::sync::watch;
use tokio::time::{Instant, sleep_until, timeout};

use super::extra::Read;
use super::wish::Wants;
use super::{Event, Extra, LEAVE_WITHIN, Look, RobotId, Teller, over};
use crate::command::face::Watch;
use crate::command::face::sample::Traffic;
use crate::command::families;
use crate::command::frame::attach::is_held;
use crate::command::frame::share::shared;
use crate::command::{Access, ConnectMode, Entry};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;

/// Polling task of one robot.
pub(super) struct Follower {
    pub robot: Arc<Robot>,
    pub screen: Screen,
    /// Start delay, to spread the robots over the interval.
    pub delay: Duration,
    pub wants: watch::Receiver<Wants>,
    pub stopped: watch::Receiver<bool>,
    pub tell: Teller,
    /// Extra commands of this robot by their text.
    pub asked: HashMap<Arc<str>, Option<Read>>,
}

/// First backoff after a failure, unless the interval is longer.
const AGAIN: Duration = Duration::from_secs(1);
/// Interval of the check for a new session.
const SESSIONS: Duration = Duration::from_secs(5);

/// Reason for the end of polling through a link.
enum Ended {
    /// The task is stopped.
    Over,
    /// A session has opened and must be used, or a used session has closed.
    Session,
    /// The robot does not answer, or its answer is not valid.
    Failed(Failure, Traffic),
}

/// Polls a robot until it is stopped.
pub(super) async fn follow(mut follower: Follower) {
    let mut start = Instant::now() + follower.delay;
    let mut pauses = Pauses::default();
    loop {
        let Follower { robot, screen, .. } = &follower;
        let mut stopped = follower.stopped.clone();
        let opened = tokio::select! {
            biased;
            () = over(&mut stopped) => return,
            opened = async {
                sleep_until(start).await;
                let family = families::of(robot.family);
                let robot = &shared(family.driver(), robot).await?;
                let is_shared = is_held(robot);
                let access = Access::reading(ConnectMode::Monitor);
                let watch = family.watch(robot, access, screen).await?;
                Ok(Link { watch, is_shared, counted: Traffic::default() })
            } => opened,
        };
        let ended = match opened {
            Err(failure) => Ended::Failed(failure, Traffic::default()),
            Ok(mut link) => {
                let ended = follower.look_on(&mut link, &mut pauses).await;
                // Polling changes nothing, so an error of the close does not matter.
                let _closed = timeout(LEAVE_WITHIN, link.watch.close(&follower.screen)).await;
                ended
            }
        };
        match ended {
            Ended::Over => return,
            Ended::Session => start = Instant::now(),
            Ended::Failed(failure, traffic) => {
                let (every, longest) = {
                    let wants = follower.wants.borrow();
                    (wants.every, wants.longest_pause)
                };
                let pause = pauses.next(every, longest);
                start = Instant::now() + pause;
                let robot = Arc::clone(&follower.robot);
                follower.tell.tell(Event::Failed { robot, failure, pause, traffic }).await;
            }
        }
    }
}

/// A link to a robot, directly or through a session.
struct Link {
    watch: Box<dyn Watch>,
    is_shared: bool,
    /// Counters that were already reported.
    counted: Traffic,
}

impl Link {
    /// Traffic since the last call.
    fn traffic(&mut self) -> Traffic {
        let now = self.watch.traffic();
        now.since(std::mem::replace(&mut self.counted, now))
    }
}

impl Follower {
    /// Polls until a failure or until it is stopped.
    async fn look_on(&mut self, link: &mut Link, pauses: &mut Pauses) -> Ended {
        let id = RobotId::of(&self.robot);
        let mut stopped = self.stopped.clone();
        let mut ticks = Ticks::new(Instant::now(), self.wants.borrow().every);
        let mut sessions = Instant::now() + SESSIONS;
        let mut missed = 0;
        loop {
            let wants = self.wants.borrow_and_update().clone();
            let began = Instant::now();
            let looked = tokio::select! {
                biased;
                () = over(&mut stopped) => return Ended::Over,
                looked = self.look(link, &id, &wants) => looked,
            };
            match looked {
                Ok(look) => {
                    pauses.begin_anew();
                    let look = Look { took: began.elapsed(), missed, traffic: link.traffic(), ..look };
                    self.tell.tell(Event::Looked(Arc::new(look))).await;
                }
                // The session has closed, which is not a failure of the robot.
                Err(_) if link.is_shared && !is_held(&self.robot) => return Ended::Session,
                Err(failure) => return Ended::Failed(failure, link.traffic()),
            }
            let now = Instant::now();
            if !link.is_shared && now >= sessions {
                sessions = now + SESSIONS;
                if is_held(&self.robot) {
                    return Ended::Session;
                }
            }
            let mut next = ticks.next(now);
            // The poll took longer than the interval: count the missed ticks.
            missed = ticks.between(began, next);
            // Waits for the next tick. A new wish for more detail is served at once.
            loop {
                tokio::select! {
                    biased;
                    () = over(&mut stopped) => return Ended::Over,
                    () = sleep_until(next) => break,
                    changed = self.wants.changed() => {
                        if changed.is_err() {
                            return Ended::Over;
                        }
                        let now = self.wants.borrow_and_update().clone();
                        if now.detail(&id) > wants.detail(&id) {
                            missed = 0;
                            break;
                        }
                        if now.every != ticks.every {
                            ticks = Ticks::new(Instant::now(), now.every);
                            next = ticks.next(Instant::now());
                            missed = 0;
                        }
                    }
                }
            }
        }
    }

    /// Polls once, and runs the extra commands.
    async fn look(&mut self, link: &mut Link, id: &RobotId, wants: &Wants) -> Result<Look, Failure> {
        let robot = Arc::clone(&self.robot);
        let mut sample = link.watch.look(wants.detail(id)).await?;
        let unexplained = sample.line.state.fault.explain(&robot).err();
        let mut extras = Vec::new();
        for extra in wants.extras(id) {
            match self.ask(link, extra).await {
                // The link has failed, not the command.
                Err(failure) if failure.kind == Kind::NoAnswer => return Err(failure),
                told => extras.push((Arc::clone(extra.text()), told)),
            }
        }
        let through_session = link.is_shared;
        Ok(Look { through_session, extras, unexplained, ..Look::new(robot, sample) })
    }

    /// Runs an extra command, unless it needs a connection whose end would affect the controller.
    async fn ask(&mut self, link: &mut Link, extra: &Extra) -> Result<Value, Failure> {
        let own = self.asked.entry(Arc::clone(extra.text())).or_insert_with(|| extra.of(&self.robot));
        let command = match own {
            None => extra.command(),
            Some(Ok(command)) => &**command,
            Some(Err(failure)) => return Err(failure.clone()),
        };
        if matches!(command.entry(&self.robot), Entry::Stops(_)) {
            let message = format!("'{}' needs a command connection, and its end would stop the robot", extra.text());
            return Err(Failure::new(Kind::Rejected, message)
                .hint(format!("open a session: `armctl session open -r {}`; later polls use it", self.robot.name)));
        }
        let report = link.watch.ask(command, &self.robot, &self.screen).await?;
        report.data()
    }
}

/// Backoff of a robot that fails; doubles each time up to a limit.
#[derive(Debug, Default)]
struct Pauses {
    last: Option<Duration>,
}

impl Pauses {
    fn next(&mut self, every: Duration, longest: Duration) -> Duration {
        let first = AGAIN.max(every);
        let next = self.last.map_or(first, |last| last.saturating_mul(2)).clamp(first, longest.max(first));
        *self.last.insert(next)
    }

    fn begin_anew(&mut self) {
        self.last = None;
    }
}

/// Ticks at a fixed interval without drift.
#[derive(Debug)]
struct Ticks {
    first: Instant,
    every: Duration,
}

impl Ticks {
    fn new(first: Instant, every: Duration) -> Self {
        Self { first, every }
    }

    /// Next tick after `now`; missed ticks are omitted.
    fn next(&mut self, now: Instant) -> Instant {
        let since = now.saturating_duration_since(self.first);
        let every = self.every.as_nanos().max(1);
        let rest = every - since.as_nanos() % every;
        now + Duration::from_nanos(u64::try_from(rest).unwrap_or(u64::MAX))
    }

    /// Number of ticks between two times, both excluded.
    fn between(&self, from: Instant, to: Instant) -> u64 {
        let every = self.every.as_nanos().max(1);
        let whole = |moment: Instant| moment.saturating_duration_since(self.first).as_nanos() / every;
        u64::try_from(whole(to).saturating_sub(whole(from)).saturating_sub(1)).unwrap_or(u64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVERY: Duration = Duration::from_millis(100);

    #[tokio::test(start_paused = true)]
    async fn ticks_do_not_drift_and_do_not_pile_up() {
        let start = Instant::now();
        let mut ticks = Ticks::new(start, EVERY);
        assert_eq!(ticks.next(start + Duration::from_millis(30)), start + EVERY);
        assert_eq!(ticks.next(start + EVERY), start + 2 * EVERY, "a moment that is now has been");
        assert_eq!(ticks.next(start + Duration::from_millis(730)), start + 8 * EVERY);
        assert_eq!(ticks.between(start, start + EVERY), 0);
        assert_eq!(ticks.between(start + EVERY, start + 8 * EVERY), 6);
    }

    #[test]
    fn pauses_double_up_to_a_bound_and_begin_anew() {
        let [second, most] = [1, 10].map(Duration::from_secs);
        let mut pauses = Pauses::default();
        let seconds: Vec<u64> = (0..6).map(|_| pauses.next(EVERY, most).as_secs()).collect();
        assert_eq!(seconds, [1, 2, 4, 8, 10, 10]);
        pauses.begin_anew();
        assert_eq!(pauses.next(EVERY, most), second);
        assert_eq!(Pauses::default().next(30 * second, most), 30 * second, "never more often than when it answers");
    }
}
