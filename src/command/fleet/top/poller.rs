//! Looks at one robot again and again, at its own pace: one that is slow or gone holds up no other.

use std::future::pending;
use std::time::Duration;

use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep_until};

use crate::command::face::Watch;
use crate::command::face::sample::{Detail, Sample};
use crate::command::families;
use crate::command::{Access, ConnectMode};
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;

/// What a look came to, and which robot it was.
pub type Update = (usize, Result<Sample, Failure>);

/// How all robots are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pace {
    /// Time from look to look.
    pub every: Duration,
    /// The robot that is looked at in full.
    pub open: Option<usize>,
    /// Whether it is over.
    pub is_over: bool,
}

/// Least time before a robot that failed is asked again.
const AGAIN: Duration = Duration::from_secs(1);

/// Looks at robot number `index` until the pace says that it is over, and tells each time. What it begins with is
/// `delay` later than for the first robot, so that not all are asked at the same moment.
pub async fn follow(
    index: usize,
    robot: Robot,
    screen: Screen,
    delay: Duration,
    mut pace: watch::Receiver<Pace>,
    updates: mpsc::Sender<Update>,
) {
    let mut start = Instant::now() + delay;
    loop {
        let opened = tokio::select! {
            biased;
            () = over(pace.clone()) => return,
            opened = async {
                sleep_until(start).await;
                families::of(robot.family).watch(&robot, Access::reading(ConnectMode::Monitor), &screen).await
            } => opened,
        };
        let failure = match opened {
            Err(failure) => Some(failure),
            Ok(mut poller) => {
                let failure = look_on((index, &robot), &mut *poller, &mut pace, &updates).await;
                // Nothing was changed: how the end of it went is nobody's concern.
                let _closed = poller.close(&screen).await;
                failure
            }
        };
        let Some(failure) = failure else { return };
        if updates.send((index, Err(failure))).await.is_err() {
            return;
        }
        start = Instant::now() + AGAIN.max(pace.borrow().every);
    }
}

/// Looks until something fails, or it is over.
async fn look_on(
    (index, robot): (usize, &Robot),
    poller: &mut dyn Watch,
    pace: &mut watch::Receiver<Pace>,
    updates: &mpsc::Sender<Update>,
) -> Option<Failure> {
    let mut ticks = Ticks::new(Instant::now(), pace.borrow().every);
    loop {
        let Pace { open, .. } = *pace.borrow_and_update();
        let detail = if open == Some(index) { Detail::Full } else { Detail::Summary };
        let looked = tokio::select! {
            biased;
            () = over(pace.clone()) => return None,
            looked = poller.look(detail) => looked,
        };
        let told = match looked {
            Ok(mut sample) => match sample.line.fault.explain(robot) {
                Ok(()) => updates.send((index, Ok(sample))).await,
                Err(failure) => return Some(failure),
            },
            Err(failure) => return Some(failure),
        };
        if told.is_err() {
            return None;
        }
        let mut next = ticks.next(Instant::now());
        // Waits for the next look; a robot that is opened is looked at once.
        loop {
            tokio::select! {
                () = sleep_until(next) => break,
                changed = pace.changed() => {
                    let Pace { every, open, is_over } = *pace.borrow_and_update();
                    if changed.is_err() || is_over {
                        return None;
                    }
                    if open == Some(index) && detail == Detail::Summary {
                        break;
                    }
                    if every != ticks.every {
                        ticks = Ticks::new(Instant::now(), every);
                        next = ticks.next(Instant::now());
                    }
                }
            }
        }
    }
}

/// Ends when it is over.
async fn over(mut pace: watch::Receiver<Pace>) {
    if pace.wait_for(|pace| pace.is_over).await.is_err() {
        // Who says so is gone without saying so; whoever waits here is dropped with it.
        pending::<()>().await;
    }
}

/// Moments at equal distances from the first one, whatever happens between them.
#[derive(Debug)]
struct Ticks {
    first: Instant,
    every: Duration,
}

impl Ticks {
    fn new(first: Instant, every: Duration) -> Self {
        Self { first, every }
    }

    /// The next one after `now`; those that were missed are left out.
    fn next(&mut self, now: Instant) -> Instant {
        let since = now.saturating_duration_since(self.first);
        let every = self.every.as_nanos().max(1);
        let rest = every - since.as_nanos() % every;
        now + Duration::from_nanos(u64::try_from(rest).unwrap_or(u64::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::fleet;
    use super::*;
    use crate::output::{ColorChoice, Format};
    use crate::settings::Setting;

    const EVERY: Duration = Duration::from_millis(100);

    #[tokio::test(start_paused = true)]
    async fn ticks_do_not_drift_and_do_not_pile_up() {
        let start = Instant::now();
        let mut ticks = Ticks::new(start, EVERY);
        assert_eq!(ticks.next(start + Duration::from_millis(30)), start + EVERY);
        assert_eq!(ticks.next(start + EVERY), start + 2 * EVERY, "a moment that is now has been");
        assert_eq!(ticks.next(start + Duration::from_millis(730)), start + 8 * EVERY);
    }

    /// Simulators in this process, one of each family, and whatever `more` is.
    fn robots(more: &[&str]) -> Vec<Robot> {
        let mut robots = fleet(3 + more.len());
        for (robot, target) in robots.iter_mut().zip(["sim:"; 3].iter().chain(more)) {
            robot.target = Setting { value: target.parse().unwrap(), ..robot.target.clone() };
        }
        robots
    }

    fn started(
        robots: &[Robot],
        pace: &watch::Sender<Pace>,
    ) -> (mpsc::Receiver<Update>, Vec<impl Future<Output = ()> + use<>>) {
        let screen = Screen::new(Format::Table, ColorChoice::Never, true, 0);
        let (tell, updates) = mpsc::channel(8);
        let follow = |(index, robot): (usize, &Robot)| {
            follow(index, robot.clone(), screen, Duration::ZERO, pace.subscribe(), tell.clone())
        };
        (updates, robots.iter().enumerate().map(follow).collect())
    }

    #[tokio::test(start_paused = true)]
    async fn every_family_is_looked_at_in_a_line_and_in_full() {
        for open in [None, Some(0), Some(1), Some(2)] {
            let (pace, _) = watch::channel(Pace { every: EVERY, open, is_over: false });
            let robots = robots(&[]);
            let (mut updates, followers) = started(&robots, &pace);
            let mut samples = vec![Vec::new(); 3];
            let watched = async {
                while samples.iter().any(|samples: &Vec<Sample>| samples.len() < 3) {
                    let (index, looked) = updates.recv().await.expect("they go on");
                    samples[index].push(looked.expect("a simulator answers"));
                }
                pace.send_modify(|pace| pace.is_over = true);
            };
            futures_util::future::join(watched, futures_util::future::join_all(followers)).await;
            for (index, samples) in samples.iter().enumerate() {
                let sample = samples.last().unwrap();
                assert!(sample.line.reachable && sample.line.mode.is_some() && sample.line.position.is_some());
                assert_eq!(sample.whole.is_some(), open == Some(index));
                if let Some(whole) = &sample.whole {
                    assert!(whole.indicators.len() > 8 && whole.axes.len() >= 4, "{whole:?}");
                    assert!(whole.banks.iter().all(|bank| !bank.groups.is_empty()), "{whole:?}");
                }
            }
        }
    }

    #[tokio::test(start_paused = true)]
    async fn a_robot_that_is_gone_holds_up_no_other() {
        let (pace, _) = watch::channel(Pace { every: EVERY, open: None, is_over: false });
        // All that is sent to it is lost.
        let mut robots = robots(&["sim:?fault=drop%3D100%25"]);
        robots[3].retries.value = 0;
        let (mut updates, followers) = started(&robots, &pace);
        let begun = Instant::now();
        let watched = async {
            let mut counts = [0; 4];
            loop {
                let (index, looked) = updates.recv().await.expect("they go on");
                counts[index] += 1;
                assert_eq!(looked.is_err(), index == 3, "{looked:?}");
                if looked.is_err() {
                    break;
                }
            }
            pace.send_modify(|pace| pace.is_over = true);
            counts
        };
        let (counts, _) = futures_util::future::join(watched, futures_util::future::join_all(followers)).await;
        let looks = begun.elapsed().as_millis() / EVERY.as_millis();
        assert!(looks >= 10, "it takes a timeout until one knows");
        assert!(counts[..3].iter().all(|count| u128::try_from(*count).unwrap() + 2 >= looks), "{counts:?} of {looks}");
    }
}
