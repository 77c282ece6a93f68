//! Polling loop of one robot.

use std::collections::HashMap;

use tokio::sync::watch;
use tokio::time::{Instant, sleep_until, timeout};

use super::extra_command::Read;
use super::poll_request::MergedRequests;
use super::{CLOSE_TIMEOUT, Event, EventSender, Extra, PollResult, RobotId, wait_for_stop};
use crate::command::families;
use armctl_controller::simulator::recording::AnswerLog;
use armctl_frame::ConnectionEffect;
use armctl_frame::face::{Traffic, Watch};
use armctl_frame::prelude::*;
use armctl_frame::session_client::is_held;
use armctl_frame::shared_session::open_shared_session;

/// Polling task of one robot.
pub(super) struct RobotTask {
    pub robot: Arc<Robot>,
    pub screen: Screen,
    /// Start delay, to spread the robots over the interval.
    pub delay: Duration,
    pub requests: watch::Receiver<MergedRequests>,
    pub stop: watch::Receiver<bool>,
    pub events: EventSender,
    /// Extra commands of this robot by their text.
    pub extra_commands: HashMap<Arc<str>, Option<Read>>,
    /// Answers since the last successful poll.
    pub answers: AnswerLog,
}

/// First backoff after a failure, unless the interval is longer.
const FIRST_BACKOFF: Duration = Duration::from_secs(1);
/// Interval of the check for a new session.
const SESSION_CHECK_INTERVAL: Duration = Duration::from_secs(5);

/// Reason for the end of polling through a link.
enum LoopEnd {
    /// The task is stopped.
    Stopped,
    /// A session has opened and must be used, or a used session has closed.
    Session,
    /// The robot does not answer, or its answer is not valid.
    Failed(Failure, Traffic),
}

/// Polls a robot until it is stopped.
pub(super) async fn follow(mut follower: RobotTask) {
    let mut start = Instant::now() + follower.delay;
    let mut pauses = Backoff::default();
    loop {
        let RobotTask { robot, screen, .. } = &follower;
        let mut stopped = follower.stop.clone();
        let opened = tokio::select! {
            biased;
            () = wait_for_stop(&mut stopped) => return,
            opened = async {
                sleep_until(start).await;
                let family = families::of(robot.family);
                let robot = &open_shared_session(family.driver, robot).await?;
                let is_shared = is_held(robot);
                let answers = follower.requests.borrow().answers.then(|| follower.answers.clone());
                let access = Access { answers, ..Access::reading(ConnectMode::Monitor) };
                let watch = (family.watch)(robot, access, screen).await?;
                Ok(Link { watch, is_shared, reported: Traffic::default() })
            } => opened,
        };
        let ended = match opened {
            Err(failure) => LoopEnd::Failed(failure, Traffic::default()),
            Ok(mut link) => {
                let ended = follower.poll_link(&mut link, &mut pauses).await;
                // Polling changes nothing, so an error of the close does not matter.
                let _closed = timeout(CLOSE_TIMEOUT, link.watch.close(&follower.screen)).await;
                ended
            }
        };
        match ended {
            LoopEnd::Stopped => return,
            LoopEnd::Session => start = Instant::now(),
            LoopEnd::Failed(failure, traffic) => {
                let (every, longest) = {
                    let wants = follower.requests.borrow();
                    (wants.every, wants.longest_pause)
                };
                let pause = pauses.next(every, longest);
                start = Instant::now() + pause;
                let robot = Arc::clone(&follower.robot);
                follower.events.send(Event::Failed { robot, failure, pause, traffic }).await;
            }
        }
    }
}

/// A link to a robot, directly or through a session.
struct Link {
    watch: Box<dyn Watch>,
    is_shared: bool,
    /// Counters that were already reported.
    reported: Traffic,
}

impl Link {
    /// Traffic since the last call.
    fn traffic(&mut self) -> Traffic {
        let now = self.watch.traffic();
        now.since(std::mem::replace(&mut self.reported, now))
    }
}

impl RobotTask {
    /// Polls until a failure or until it is stopped.
    async fn poll_link(&mut self, link: &mut Link, pauses: &mut Backoff) -> LoopEnd {
        let id = RobotId::for_robot(&self.robot);
        let mut stopped = self.stop.clone();
        let mut ticks = Ticks::new(Instant::now(), self.requests.borrow().every);
        let mut sessions = Instant::now() + SESSION_CHECK_INTERVAL;
        let mut missed = 0;
        loop {
            let wants = self.requests.borrow_and_update().clone();
            let start = Instant::now();
            let result = tokio::select! {
                biased;
                () = wait_for_stop(&mut stopped) => return LoopEnd::Stopped,
                looked = self.poll(link, &id, &wants) => looked,
            };
            match result {
                Ok(look) => {
                    pauses.reset();
                    let look = PollResult { took: start.elapsed(), missed, traffic: link.traffic(), ..look };
                    self.events.send(Event::Polled(Arc::new(look))).await;
                }
                // The session has closed, which is not a failure of the robot.
                Err(_) if link.is_shared && !is_held(&self.robot) => return LoopEnd::Session,
                Err(failure) => return LoopEnd::Failed(failure, link.traffic()),
            }
            let now = Instant::now();
            if !link.is_shared && now >= sessions {
                sessions = now + SESSION_CHECK_INTERVAL;
                if is_held(&self.robot) {
                    return LoopEnd::Session;
                }
            }
            let mut next = ticks.next(now);
            // The poll took longer than the interval: count the missed ticks.
            missed = ticks.between(start, next);
            // Waits for the next tick. A new request for more detail is served at once.
            loop {
                tokio::select! {
                    biased;
                    () = wait_for_stop(&mut stopped) => return LoopEnd::Stopped,
                    () = sleep_until(next) => break,
                    changed = self.requests.changed() => {
                        if changed.is_err() {
                            return LoopEnd::Stopped;
                        }
                        let now = self.requests.borrow_and_update().clone();
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
    async fn poll(&mut self, link: &mut Link, id: &RobotId, wants: &MergedRequests) -> Result<PollResult> {
        let robot = Arc::clone(&self.robot);
        let mut sample = link.watch.look(wants.detail(id)).await?;
        let unexplained = sample.line.state.fault.explain(&robot).err();
        let mut extras = Vec::new();
        for extra in wants.extras(id) {
            match self.ask(link, extra).await {
                // The link has failed, not the command.
                Err(failure) if failure.kind == Kind::NoAnswer => return Err(failure),
                result => extras.push((Arc::clone(extra.text()), result)),
            }
        }
        let through_session = link.is_shared;
        let answers = self.answers.take();
        Ok(PollResult { through_session, extras, answers, unexplained, ..PollResult::new(robot, sample) })
    }

    /// Runs an extra command, unless it needs a connection whose end would affect the controller.
    async fn ask(&mut self, link: &mut Link, extra: &Extra) -> Result<Value> {
        let command = self.extra_commands.entry(Arc::clone(extra.text())).or_insert_with(|| extra.of(&self.robot));
        let command = match command {
            None => extra.command(),
            Some(Ok(command)) => &**command,
            Some(Err(failure)) => return Err(failure.clone()),
        };
        if matches!(command.connection_effect(&self.robot), ConnectionEffect::Stops(_)) {
            let message = format!(
                "'{}' needs a command connection, and the end of that connection would stop the robot",
                extra.text()
            );
            return Err(Failure::new(Kind::Rejected, message).hint(format!(
                "open a session with `armctl session open -r {}`; later polls use the session",
                self.robot.name
            )));
        }
        let report = link.watch.ask(command, &self.robot, &self.screen).await?;
        report.data()
    }
}

/// Backoff of a robot that fails; doubles each time up to a limit.
#[derive(Debug, Default)]
struct Backoff {
    last: Option<Duration>,
}

impl Backoff {
    fn next(&mut self, every: Duration, longest: Duration) -> Duration {
        let first = FIRST_BACKOFF.max(every);
        let next = self.last.map_or(first, |last| last.saturating_mul(2)).clamp(first, longest.max(first));
        *self.last.insert(next)
    }

    fn reset(&mut self) {
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

    const POLL_INTERVAL: Duration = Duration::from_millis(100);

    #[tokio::test(start_paused = true)]
    async fn ticks_do_not_drift_or_accumulate() {
        let start = Instant::now();
        let mut ticks = Ticks::new(start, POLL_INTERVAL);
        assert_eq!(ticks.next(start + Duration::from_millis(30)), start + POLL_INTERVAL);
        assert_eq!(ticks.next(start + POLL_INTERVAL), start + 2 * POLL_INTERVAL, "a moment that is now has been");
        assert_eq!(ticks.next(start + Duration::from_millis(730)), start + 8 * POLL_INTERVAL);
        assert_eq!(ticks.between(start, start + POLL_INTERVAL), 0);
        assert_eq!(ticks.between(start + POLL_INTERVAL, start + 8 * POLL_INTERVAL), 6);
    }

    #[test]
    fn backoff_doubles_up_to_a_limit_and_resets() {
        let [second, most] = [1, 10].map(Duration::from_secs);
        let mut pauses = Backoff::default();
        let seconds: Vec<u64> = (0..6).map(|_| pauses.next(POLL_INTERVAL, most).as_secs()).collect();
        assert_eq!(seconds, [1, 2, 4, 8, 10, 10]);
        pauses.reset();
        assert_eq!(pauses.next(POLL_INTERVAL, most), second);
        assert_eq!(Backoff::default().next(30 * second, most), 30 * second, "never more often than when it answers");
    }
}
