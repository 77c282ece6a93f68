//! Simulated YRCX with its fieldbus image: images in and out, scans of 5 ms, without link and without clock.
//!
//! A fieldbus adapter passes the images of the master and the time, and sends the images of the controller. The
//! simulator shares the command table with the client, but decodes and checks words independently, and refuses
//! everything that must not be sent. `why` on the console shows the reason for the last refusal.
//!
//! | module | content |
//! |---|---|
//! | `start`, `defaults` | start state from TOML; content of a new controller |
//! | `world` | switches, power, permissions, time |
//! | `alarms` | active alarms, history, numbers |
//! | `signals`, `remote`, `request` | dedicated signals, command handshake, command words |
//! | `commands`, `motions`, `operate`, `records`, `reads` | effects of commands |
//! | `memory` | points, pallets, shifts, hands, variables, ports |
//! | `robot`, `geometry`, `moves`, `motion` | axes, kinematics, targets and paths, ramps |
//! | `program`, `task` | programs in a subset of the language, and their tasks |
//! | `console` | operator actions |
//! | `journal` | images of masters |
//! | `replay` | signals and state of a recorded controller |
//!
//! The manual specifies the protocol, but less of the behavior of a controller. The simulator makes these assumptions:
//!
//! - Words that the manual does not allow cause alarm 4.202 (input format error), whatever the error is. If no source
//!   has the number of an alarm, the group is right and the category is 900 or above.
//! - A quick command sends its end status in the scan that accepts it. With `run_scans`, it first sends the running
//!   status for some scans. If the master removes a command, the controller carries it out to its end with the running
//!   status, and is ready when WI0 is 0. A command that follows another command without a status reset is ignored.
//! - While the link is lost, all inputs are off, the alarm is the alarm of the fieldbus (12.551 on EtherNet/IP), and
//!   everything has stopped without power. A running command ends abnormally, and the next master receives this status.
//!   Before the first image, the inputs have their resting state.
//! - An edge of a dedicated input is ignored if it comes less than 100 ms after another edge. The falling edges of
//!   SI(00) (emergency stop) and SI(06) (stop) are never ignored.
//! - If SI(06) goes off, the controller decelerates commands and programs and ends them with alarm 12.400. While SI(06)
//!   is off, no motion can start.
//! - An emergency stop and serious alarms switch power off at once. SI(01) (servo on) and motor power work again after
//!   the alarm reset.
//! - While the programming box has control, the controller accepts only commands that read data. If dedicated inputs
//!   are disabled (a safety setting), it accepts no command at all. SI(00) and SI(06) still work.
//! - A speed in percent is multiplied by the automatic speed. Speeds in 0.01 % and mm/s are not multiplied. Jogs have
//!   the manual speed. In manual mode, the manual speed also replaces the automatic speed. The maximum tool speed is
//!   1000 mm/s.
//! - An arch moves up, across and down in sequence; its start and end positions do not round the path. A path that
//!   leaves the soft limits is refused before it begins. A jog ends at the soft limits with alarm 2.334. Only push
//!   commands can meet an obstacle.
//! - A push without force or time uses the parameters PSHFRC and PSHTIME. PSHSPD reduces its speed. The other
//!   parameters are only stored.
//! - After a stop, MOVEI and DRIVEI continue to their target if the same words follow (`movei_start`).
//! - A Cartesian robot has no hand system. The R value of a shift rotates the coordinates. Hand data has the format of
//!   section 4.3.5. Initially, no hand is selected.
//! - A program is registered in one task. It runs one line per scan. SI(06) stops it at its line, and a start continues
//!   it there. An error stops all programs. A program that has ended is at its first line.
//! - An undefined point causes an alarm. The answer for a missing comment or alarm is empty, and the answer for a
//!   missing robot has no axes. A variable that would overflow keeps its value.

mod alarms;
mod commands;
mod console;
mod data_commands;
mod defaults;
mod geometry;
mod journal;
mod memory;
mod motion;
mod motion_commands;
mod moves;
mod operation_commands;
mod program;
mod read_commands;
mod remote;
mod replay;
mod request;
mod robot;
mod signals;
mod start;
mod task;
mod world;

#[cfg(test)]
mod tests;

pub use start::{EXAMPLE, Start};

use self::journal::Journal;
use self::remote::Remote;
use self::signals::Dedicated;
use self::world::{Link, SCAN, World};
use super::alarm::Alarm;
use super::image::Image;
use crate::Now;
use crate::simulator::recording::Replay;
use crate::simulator::run_options::Speed;

/// Maximum number of scans per call. After these scans, the rest of the time is one scan.
const MAX_SCANS: u32 = 1_000_000;

/// What the master did: it sent an image, or the link was lost.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Master {
    Shows(Image),
    Gone,
}

/// A simulated controller.
#[derive(Debug, Clone)]
pub struct Simulator {
    world: World,
    remote: Remote,
    dedicated: Dedicated,
    journal: Journal,
    /// Output image of the last scan.
    shown: Image,
    /// Master event for the next scan.
    incoming: Option<Master>,
    /// Time of the first change that no scan has handled yet.
    touched: Option<Now>,
    /// Time of the last scan.
    scanned: Option<Now>,
    replay: Replay,
    speed: Speed,
}

impl Simulator {
    /// A controller in its start state, to which no master has connected yet.
    pub fn new(mut start: Start) -> Self {
        for (number, robot) in start.world.robots.iter_mut().enumerate() {
            robot.log = start.options.motions.clone().map(|log| (number, log));
        }
        let mut simulator = Self {
            world: start.world,
            remote: Remote::new(start.run_scans, start.seed),
            dedicated: Dedicated::new(),
            journal: Journal::default(),
            shown: Image::default(),
            incoming: None,
            touched: None,
            scanned: None,
            replay: Replay::new(start.recording),
            speed: start.options.speed,
        };
        simulator.scan(Now::ZERO);
        simulator
    }

    /// Sets the alarm for a lost link, for another fieldbus than EtherNet/IP. The default is the alarm of EtherNet/IP.
    #[must_use]
    pub fn with_link_alarm(mut self, alarm: Alarm) -> Self {
        self.world.link_alarm = alarm;
        self
    }

    /// Handles the image of the master from `now` on. `None` means that the link is lost, which is an alarm.
    pub fn input(&mut self, now: Now, image: Option<&Image>) {
        let now = self.speed.simulated(now);
        self.run_scans(now);
        let known = match self.world.link {
            Link::Waiting => None,
            Link::Up => Some(Master::Shows(self.world.inputs)),
            Link::Down => Some(Master::Gone),
        };
        let incoming = image.map_or(Master::Gone, |image| Master::Shows(*image));
        if self.incoming.or(known) != Some(incoming) {
            self.journal.note(image);
            self.incoming = Some(incoming);
            self.touched.get_or_insert(now);
        }
    }

    /// Output image of the last scan.
    pub fn output(&self) -> &Image {
        &self.shown
    }

    /// Whether the recorded controller did not answer at this time. The fieldbus device must then be silent too.
    pub fn is_silent(&self) -> bool {
        self.replay.is_silent
    }

    /// Time of the next scan that may change something, without an input from outside.
    pub fn wake(&self) -> Option<Now> {
        self.next_scan().map(|due| self.speed.real(due))
    }

    /// Simulated time of the next scan that may change something.
    fn next_scan(&self) -> Option<Now> {
        let due = [self.touched, self.world.due(), self.remote.due(&self.world), self.replay.due()];
        let due = due.into_iter().flatten().min()?;
        let next = next_scan(due);
        let earliest = self.scanned.map_or(Now::ZERO, |last| last.saturating_add(SCAN));
        Some(next.max(earliest))
    }

    /// Runs all scans up to `now`. The time never runs backwards.
    pub fn advance(&mut self, now: Now) {
        self.run_scans(self.speed.simulated(now));
    }

    fn run_scans(&mut self, now: Now) {
        for _ in 0..MAX_SCANS {
            let Some(at) = self.next_scan().filter(|at| *at <= now) else { return };
            self.scan(at);
        }
        self.scan(now.max(self.world.now));
    }

    /// Executes a console line, for example `estop on`, `box on` or `state`. Returns its output, or an error.
    pub fn console(&mut self, now: Now, line: &str) -> Result<String, String> {
        let now = self.speed.simulated(now);
        self.run_scans(now);
        if line.trim() == "journal" {
            return Ok(self.journal.take());
        }
        self.touched.get_or_insert(now);
        // Between scans, only the robot positions are updated, so that they are exact at any time.
        self.world.move_on(now.max(self.world.now));
        console::execute(&mut self.world, line)
    }

    fn scan(&mut self, at: Now) {
        self.scanned = Some(at);
        self.touched = None;
        self.world.move_on(at);
        match self.incoming.take() {
            Some(Master::Shows(image)) => self.world.master_shows(image),
            Some(Master::Gone) => self.world.on_master_lost(),
            None => {}
        }
        self.dedicated.scan(&mut self.world);
        self.world.scan();
        while self.replay.take(at).is_some() {
            replay::follow(&mut self.world, &self.replay);
        }
        self.remote.scan(&mut self.world, &self.replay);
        let words = self.remote.words();
        self.shown.set_command(&words);
        signals::show(&mut self.world, &mut self.shown);
        replay::show(&self.replay, &mut self.shown);
    }
}

/// Time of the first scan at or after `at`.
fn next_scan(at: Now) -> Now {
    let (at, scan) = (at.as_nanos(), SCAN.as_nanos());
    let nanos = at.div_ceil(scan).saturating_mul(scan);
    u64::try_from(nanos).map_or(Now::MAX, Now::from_nanos)
}
