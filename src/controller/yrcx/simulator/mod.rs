//! A simulated YRCX behind its fieldbus: images in, images out, in scans of 5 ms, without link and without clock.
//!
//! An adapter of any bus hands it what the master shows and the time, and sends what it shows. It shares the table of
//! commands with the client, but reads and checks words by itself, and refuses all that must not be sent. `why` on the
//! console tells what was wrong with the last thing that was refused.
//!
//! | module | holds |
//! |---|---|
//! | `start`, `defaults` | the start state, from TOML; what a fresh controller has in it |
//! | `world` | switches, power, what may be done when, the passing of time |
//! | `alarms` | active alarms, the history, the numbers |
//! | `signals`, `remote`, `request` | dedicated signals, the handshake, the words of a command |
//! | `commands`, `motions`, `operate`, `records`, `reads` | what commands do |
//! | `memory` | points, pallets, shifts, hands, variables, ports |
//! | `robot`, `geometry`, `moves`, `motion` | axes, where they put the tool, targets and ways, ramps |
//! | `program`, `task` | programs in a small part of the language, and the tasks that run them |
//! | `console` | what somebody at the machine does |
//! | `journal` | what masters showed |
//!
//! The manual tells what is sent, and less of what is done. Where it is silent, this was chosen:
//!
//! - Words that the manual does not allow are 4.202, whatever is wrong with them. Where no source names an alarm, the
//!   group is right and the category is 900 or above.
//! - A quick command shows its end in the scan that takes it; with `run_scans`, the run status for some scans before. A
//!   command that the master takes back is carried out to its end, with the run status; then the controller is ready, once
//!   WI0 is 0. A command without a status reset before it is not taken.
//! - While the link is gone all inputs are off, the alarm is that of the fieldbus (12.551 on EtherNet/IP), and everything
//!   has stopped without power. What ran has ended abnormally, and that is still shown to whoever comes next. Before the
//!   first image the inputs rest.
//! - An edge of a dedicated input less than 100 ms after another one is ignored, but for SI(00) and SI(06) going off.
//! - SI(06) off brings commands and programs to rest and ends them with 12.400; so does it keep any from moving.
//! - Emergency stop and serious alarms take the power away at once. SI(01) and motor power come on after the alarm reset.
//! - Under the programming box only references are taken; without dedicated inputs (a safety setting) no command at all.
//!   SI(00) and SI(06) act nonetheless.
//! - Speeds: with a percentage the automatic speed counts as well, 0.01 % and mm/s stand alone, jogs have the manual speed;
//!   in manual mode that takes the place of the automatic one. The tool's greatest speed is 1000 mm/s.
//! - An arch goes up, across and down, one after the other; its start and end positions do not round it. A way that
//!   leaves soft limits is refused before it begins; a jog ends at them with 2.334. Only pushes meet obstacles.
//! - A push without force or time takes the parameters PSHFRC and PSHTIME; PSHSPD reduces its speed, the others are stored.
//! - MOVEI and DRIVEI that were stopped go on to their target when the same words come next (`movei_start`).
//! - A Cartesian robot has no hand system. A shift turns about its R. A hand is as in 4.3.5; before one is selected, none.
//! - A program is registered in one task. It runs a line a scan, stops by SI(06) at its line and goes on there. An error
//!   stops all of them. Programs that ended are at their first line.
//! - A point that was never defined is an alarm; a comment or an alarm that is not there is empty, a robot that is not
//!   there has no axes. Variables that would overflow stay as they were.

mod alarms;
mod commands;
mod console;
mod defaults;
mod geometry;
mod journal;
mod memory;
mod motion;
mod motions;
mod moves;
mod operate;
mod program;
mod reads;
mod records;
mod remote;
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

/// Scans of one call; a longer gap passes at rest.
const MAX_SCANS: u32 = 1_000_000;

/// What the master does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Master {
    Shows(Image),
    Gone,
}

/// A controller.
#[derive(Debug, Clone)]
pub struct Simulator {
    world: World,
    remote: Remote,
    dedicated: Dedicated,
    journal: Journal,
    /// What the controller shows.
    shown: Image,
    /// What is new about the master, for the next scan.
    incoming: Option<Master>,
    /// Since when the next scan has something new to look at.
    touched: Option<Now>,
    /// The last scan.
    scanned: Option<Now>,
}

impl Simulator {
    /// A controller in its start state. No master has been there yet.
    pub fn new(start: Start) -> Self {
        let mut simulator = Self {
            world: start.world,
            remote: Remote::new(start.run_scans, start.seed),
            dedicated: Dedicated::new(),
            journal: Journal::default(),
            shown: Image::default(),
            incoming: None,
            touched: None,
            scanned: None,
        };
        simulator.scan(Now::ZERO);
        simulator
    }

    /// With the alarm that a lost link is on its fieldbus; else it is that of EtherNet/IP.
    #[must_use]
    pub fn with_link_alarm(mut self, alarm: Alarm) -> Self {
        self.world.link_alarm = alarm;
        self
    }

    /// Takes what the master shows from `now` on; `None`: the link is gone, which is an alarm.
    pub fn input(&mut self, now: Now, image: Option<&Image>) {
        self.advance(now);
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

    /// What the controller shows since its last scan.
    pub fn output(&self) -> &Image {
        &self.shown
    }

    /// The next scan in which something may change, if nothing comes from outside.
    pub fn wake(&self) -> Option<Now> {
        let due = [self.touched, self.world.due(), self.remote.due(&self.world)].into_iter().flatten().min()?;
        let next = next_scan(due);
        let earliest = self.scanned.map_or(Now::ZERO, |last| last.saturating_add(SCAN));
        Some(next.max(earliest))
    }

    /// Carries out every scan up to `now`, which never runs back.
    pub fn advance(&mut self, now: Now) {
        for _ in 0..MAX_SCANS {
            let Some(at) = self.wake().filter(|at| *at <= now) else { return };
            self.scan(at);
        }
        self.scan(now.max(self.world.now));
    }

    /// Carries out one line of the console: `estop on`, `box on`, `state`. What to print, or what is wrong.
    pub fn console(&mut self, now: Now, line: &str) -> Result<String, String> {
        self.advance(now);
        if line.trim() == "journal" {
            return Ok(self.journal.take());
        }
        self.touched.get_or_insert(now);
        // Between scans as well, robots are where they are.
        self.world.move_on(now.max(self.world.now));
        console::execute(&mut self.world, line)
    }

    fn scan(&mut self, at: Now) {
        self.scanned = Some(at);
        self.touched = None;
        self.world.move_on(at);
        match self.incoming.take() {
            Some(Master::Shows(image)) => self.world.master_shows(image),
            Some(Master::Gone) => self.world.master_gone(),
            None => {}
        }
        self.dedicated.scan(&mut self.world);
        self.world.scan();
        self.remote.scan(&mut self.world);
        let words = self.remote.words();
        self.shown.set_command(&words);
        signals::show(&mut self.world, &mut self.shown);
    }
}

/// The scan that sees what happens at this moment.
fn next_scan(at: Now) -> Now {
    let (at, scan) = (at.as_nanos(), SCAN.as_nanos());
    let nanos = at.div_ceil(scan).saturating_mul(scan);
    u64::try_from(nanos).map_or(Now::MAX, Now::from_nanos)
}
