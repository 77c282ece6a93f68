//! Stop procedure: sends the stop order, repeats it, and checks that the robot has stopped.

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::toyo::layout::Record;
use armctl_controller::toyo::request::{Answer, Request};
use armctl_controller::toyo::session::{ExchangeResult, Policy};
use armctl_controller::toyo::table::commands::Command;
use tokio::time::{Instant, timeout_at};

use super::temporary_changes::HostState;
use super::{Client, Error, jog, status_page};
use crate::{Grant, STOP_INTERVAL, STOP_TIMEOUT};

/// If a program still seems to run after this time, the motion is assumed to be a jog: STOP would have stopped a
/// program.
const JOG_ASSUMED_AFTER: Duration = Duration::from_secs(1);
/// Poll interval for the position during a stop.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Number of retries of each request during a stop.
const REPETITIONS: u32 = 3;

/// Kind of motion that a stop must end.
///
/// ```
/// use armctl_client::toyo::{Client, Endpoint, MotionKind, Options, jog};
/// use armctl_client::Risk;
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(), Options::default().with_risk(Risk::Motion)).await?;
/// robot.ask(&jog("RS", None)).await?;
/// robot.ask(&jog("+L", Some(0))).await?;
/// assert_eq!(robot.moving(), Some(MotionKind::Jog));
/// let place = robot.stop(MotionKind::Jog).await?;
/// println!("stopped at {:?}", place.millimetres("x"));
/// robot.close().await.1?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// A jog: runs until it is stopped.
    Jog,
    /// A program, an origin return, or a change of servo power.
    Program,
}

impl MotionKind {
    /// The order that stops this kind of motion (JGST or STOP, TO 2-7).
    pub fn stop(self) -> Request {
        match self {
            Self::Jog => jog("SP", None),
            Self::Program => Request::bare(Command::Stop),
        }
    }
}

struct Attempt {
    is_refused: bool,
    is_busy: bool,
    position: Record,
}

impl Client {
    /// Stops the motion and returns the final position in the format of [`Client::read_position`]. The client repeats
    /// the order until the robot has stopped, without a check of the grant and with its own time limits and retries. A
    /// repeated stop is harmless, but after a lost stop the robot would continue to move.
    ///
    /// # Errors
    /// [`Error::StopUnconfirmed`] if no answer confirms the stop, [`Error::StillMoving`] if the robot still moves.
    pub async fn stop(&mut self, moving: MotionKind) -> Result<Record, Error> {
        if self.is_dry_run() {
            self.plan(&moving.stop(), "repeated until the robot stands still");
            self.plan(&status_page(0), "whether a program runs; repeated until the robot stands still");
            if moving == MotionKind::Program {
                self.plan_if(&MotionKind::Jog.stop(), "whether something still runs: an axis may be jogging");
                self.plan_if(&status_page(0), "whether something still runs");
            }
            self.plan(&Request::bare(Command::Mpst), "position; repeated until the robot stands still");
            if self.host == HostState::Unknown {
                let on = "whether the controller refuses the stop of a jog, for example while the host is OFF";
                self.plan_to_take_host(Some(on));
                self.plan_if(&MotionKind::Jog.stop(), on);
            }
            return Err(Error::DryRun);
        }
        self.set_policy(Policy { timeout: STOP_INTERVAL, retries: REPETITIONS, ..self.configured_policy });
        let mut why = None;
        let until = Instant::now() + STOP_TIMEOUT;
        let stopped = timeout_at(until, self.stop_until_at_rest(moving, &mut why)).await;
        let stopped = stopped.unwrap_or_else(|_| {
            let silent = || self.unanswered(ExchangeResult::NoAnswer, Risk::Read, Some(&moving.stop()));
            Err(stop_error(why.unwrap_or_else(silent)))
        });
        self.set_policy(self.configured_policy);
        match &stopped {
            Ok(_) => self.end_motion(),
            // The host stays ON, because the next stop needs host control.
            Err(_) => self.keep_host(),
        }
        stopped
    }

    /// Sends a stop at once while an answer is pending. [`Client::stop`] would wait for that answer first.
    pub async fn send_urgent(&mut self, moving: MotionKind) {
        if let Some(bytes) = self.session.begin_urgent(self.started.elapsed(), &moving.stop()) {
            // If the line is broken, the stop that follows reports the error.
            self.send(&bytes).await.unwrap_or_default();
        }
    }

    /// Repeats the stop, and returns only when the robot has stopped or the line is lost. `why` contains the latest
    /// reason why the stop is not confirmed.
    async fn stop_until_at_rest(&mut self, moving: MotionKind, why: &mut Option<Error>) -> Result<Record, Error> {
        let began = Instant::now();
        let stop = moving.stop();
        // Position at the previous attempt; `None` if a program or a return to origin was still in progress at that
        // time.
        let mut previous = None;
        loop {
            let attempt = self.try_stop(moving, &stop).await;
            let is_slow = began.elapsed() >= JOG_ASSUMED_AFTER;
            previous = match attempt {
                Ok(Attempt { is_busy: false, position, .. }) if previous.as_ref() == Some(&position) => {
                    return Ok(position);
                }
                Err(error) if self.is_line_lost => return Err(stop_error(error)),
                Ok(Attempt { is_refused, is_busy, position }) => {
                    *why = Some(Error::StillMoving { is_refused });
                    // An error of the following requests can be ignored: the next attempt reports it.
                    if is_refused && moving == MotionKind::Jog {
                        // Stopping a jog requires host control.
                        self.take_host_to_stop().await.unwrap_or_default();
                        self.transact(&stop, true).await.map(|_| ()).unwrap_or_default();
                    } else if moving == MotionKind::Program && (is_slow || (!is_busy && previous.is_some())) {
                        // The robot still moves, perhaps although no program runs: an axis may be jogging.
                        self.stop_a_jog().await;
                    }
                    (!is_busy).then_some(position)
                }
                Err(error) => {
                    *why = Some(error);
                    None
                }
            };
            tokio::time::sleep(POLL_INTERVAL).await;
        }
    }

    /// Sends the stop, then reads status and position. An `@OK` alone does not prove that the robot has stopped.
    async fn try_stop(&mut self, moving: MotionKind, stop: &Request) -> Result<Attempt, Error> {
        self.send_urgent(moving).await;
        let answer = self.transact(stop, true).await?;
        let mut state = self.status_of(&[0]).await?;
        if moving == MotionKind::Program && (state.executing() || state.homing()) {
            // An axis may still be jogging, and STOP does not stop a jog.
            self.stop_a_jog().await;
            state = self.status_of(&[0]).await?;
        }
        let position = self.read_position().await?;
        Ok(Attempt { is_refused: answer == Answer::Refused, is_busy: state.executing() || state.homing(), position })
    }

    /// Takes host control without a check of the grant: a stop is always allowed.
    async fn take_host_to_stop(&mut self) -> Result<(), Error> {
        self.take_host_by(&Grant::up_to(Risk::Write)).await
    }

    /// Stops the jog of all axes. Takes host control first if the controller refuses the stop. Errors are ignored: the
    /// next attempt reports them.
    async fn stop_a_jog(&mut self) {
        let stop = MotionKind::Jog.stop();
        if matches!(self.transact(&stop, true).await, Ok(Answer::Refused)) && self.take_host_to_stop().await.is_ok() {
            self.transact(&stop, true).await.map(|_| ()).unwrap_or_default();
        }
    }

    /// Sends one stop after the controller refused a motion. The client does not wait for the robot to stop: if there
    /// is a motion on the controller, this client did not start it.
    pub async fn stop_refused_motion(&mut self, moving: MotionKind) {
        self.set_policy(self.configured_policy);
        self.transact(&moving.stop(), true).await.map(|_| ()).unwrap_or_default();
        self.end_motion();
    }
}

fn stop_error(why: Error) -> Error {
    if matches!(why, Error::StillMoving { .. }) { why } else { Error::StopUnconfirmed(Box::new(why)) }
}
