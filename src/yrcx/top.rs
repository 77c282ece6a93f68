//! Live view of a robot. It shows the signals. If the connection of this view already commands the controller, the view
//! also shows position, torque and alarm from remote commands. A connection in a session or to a simulator in this
//! process commands the controller.
//!
//! All clients of a session share the remote commands of the controller, and only one command can run at a time. So in
//! a session, a view sends one remote command per interval and keeps the results.

use tokio::time::Instant;

use super::info::servos;
use super::overview::{alarm, latest, not_asked, report};
use super::position::mm;
use crate::prelude::*;
use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::table::Command;
use armctl_frame::Family as _;
use armctl_frame::face::registration;
use armctl_frame::face::sample::{Axis, Bank, Detail, Indicator, Sample, SignalByte, Whole};
use armctl_frame::robot::alarm::Alarm;
use armctl_frame::robot::state::PositionMm;
use armctl_frame::settings::target::Place;

/// Poller for one controller.
#[derive(Debug)]
pub struct Poller {
    link: Link,
    told: CommandResults,
    /// Index of the next remote command in a session, and the time of the last remote command.
    next: usize,
    asked: Option<Instant>,
}

/// Results of remote commands.
#[derive(Debug, Default)]
struct CommandResults {
    /// Numbers of the existing axes, starting with 1.
    axes: Option<Vec<usize>>,
    position_mm: Option<[f64; 4]>,
    torque_percent: Option<[Option<i32>; 4]>,
    alarm: Option<Alarm>,
}

/// Minimum interval of reads by explicit messages: network boards answer such messages with low priority.
const MIN_MESSAGE_INTERVAL: Duration = Duration::from_millis(100);
/// Minimum interval of remote commands in a session.
const MIN_COMMAND_INTERVAL: Duration = Duration::from_millis(500);

/// Number of the first general-purpose signals, SI(20) and SO(20). `GROUPS` is the number of groups of eight signals.
const FIRST: u16 = 20;
const GROUPS: u16 = 4;

impl registration::Poller for Poller {
    type Family = Yrcx;

    /// Opens the poller. The poller only reads. Its connection does not affect the controller when it closes.
    async fn open(robot: &Robot, access: Access, screen: &Screen) -> Result<Self> {
        let mut robot = robot.clone();
        if let Place::Bus(bus) = &mut robot.target.value.place {
            bus.listen_before = MIN_MESSAGE_INTERVAL;
        }
        let link = Yrcx::connect(&robot, access, screen).await?;
        Ok(Self { link, told: CommandResults::default(), next: 0, asked: None })
    }

    async fn look(&mut self, detail: Detail) -> Result<Sample> {
        let image = self.link.look().await?;
        let not_asked = not_asked(&self.link, &image);
        if not_asked.is_none() {
            self.ask(detail, &image).await?;
        }
        if !output::ALARM.is_on(&image) {
            self.told.alarm = None;
        }
        let position = self.told.position_mm.map(PositionMm::of_axes);
        let line = report(&self.link, &image, self.told.alarm.as_ref(), position, not_asked);
        let whole = (detail >= Detail::Axes).then(|| self.whole(detail, &image, not_asked));
        Ok(Sample { line, answered_in: None, alarms: self.told.alarm.iter().cloned().collect(), full: whole })
    }

    fn link(&mut self) -> &mut Link {
        &mut self.link
    }

    async fn close(self, screen: &Screen) -> Result<()> {
        Yrcx::close(self.link, screen).await
    }
}

impl Poller {
    /// Sends the remote commands that are due.
    async fn ask(&mut self, detail: Detail, image: &Image) -> Result<()> {
        let questions = self.questions(detail, output::ALARM.is_on(image));
        if !self.link.is_shared() {
            for question in questions {
                self.put(question).await?;
            }
            return Ok(());
        }
        let now = Instant::now();
        if questions.is_empty() || self.asked.is_some_and(|asked| now < asked + MIN_COMMAND_INTERVAL) {
            return Ok(());
        }
        self.asked = Some(now);
        self.next = self.next.wrapping_add(1);
        self.put(questions[self.next % questions.len()]).await
    }

    fn questions(&self, detail: Detail, has_alarm: bool) -> Vec<Command> {
        let is_whole = detail >= Detail::Axes;
        let wanted = [
            (Command::PositionMm, true),
            (Command::AlarmHistory, has_alarm && self.told.alarm.is_none()),
            (Command::ServoStatus, is_whole && self.told.axes.is_none()),
            (Command::TorqueOfMax, is_whole),
        ];
        wanted.into_iter().filter(|(_, is_wanted)| *is_wanted).map(|(command, _)| command).collect()
    }

    /// Sends a read command and stores the result.
    async fn put(&mut self, command: Command) -> Result<()> {
        let order: Order = match command {
            Command::AlarmHistory => latest()?,
            // 0 selects all axes.
            Command::TorqueOfMax => self.link.draft(command)?.with(Key::Axes, 0).valid_order()?,
            _ => self.link.draft(command)?.valid_order()?,
        };
        // A refusal is not an error here: a robot whose origin is unknown refuses to report its position.
        let done = self.link.try_ask(&order).await?.ok();
        let values = done.as_ref().map(|done| &done.values);
        match command {
            Command::PositionMm => {
                let position = values.and_then(mm);
                self.told.position_mm = position;
            }
            Command::TorqueOfMax => {
                self.told.torque_percent = values.map(|values| Key::AXES.map(|key| values.int(key)));
            }
            Command::ServoStatus => {
                self.told.axes = values.map(|values| servos(values).iter().map(|servo| servo.axis).collect());
            }
            _ => self.told.alarm = values.and_then(alarm),
        }
        Ok(())
    }

    fn whole(&self, detail: Detail, image: &Image, not_asked: Option<&'static str>) -> Whole {
        let shown = self.link.output_image().copied();
        let mut banks = Vec::new();
        if detail == Detail::Full {
            banks.extend(shown.map(|shown| bank("inputs", Side::Input, &shown)));
            banks.push(bank("outputs", Side::Output, image));
        }
        let torque_unit = self.told.torque_percent.map(|_| "% of max");
        Whole { indicators: indicators(image), axes: self.axes(), torque_unit, banks, not_asked }
    }

    fn axes(&self) -> Vec<Axis> {
        let Some(position) = self.told.position_mm else { return Vec::new() };
        let torque = self.told.torque_percent.unwrap_or_default();
        let is_there = |axis: &usize| self.told.axes.as_ref().is_none_or(|axes| axes.contains(axis));
        let axes = (1..).zip(position).zip(torque).filter(|((axis, _), _)| is_there(axis));
        let axes = axes.map(|((axis, position), torque)| Axis {
            name: axis.to_string(),
            position,
            unit: "mm",
            decimals: 3,
            torque: torque.map(f64::from),
            ..Axis::default()
        });
        axes.collect()
    }
}

fn indicators(image: &Image) -> Vec<Indicator> {
    let is_on = |signal: Signal| signal.is_on(image);
    vec![
        Indicator::new("auto", is_on(output::AUTO_MODE), Tone::Good),
        Indicator::new("servo", is_on(output::SERVO_ON), Tone::Good),
        Indicator::new("program", is_on(output::PROGRAM_RUNNING), Tone::Good),
        Indicator::new("sequence", is_on(output::SEQUENCE_RUNNING), Tone::Good),
        Indicator::expected("origin", is_on(output::ORIGIN_COMPLETE), Tone::Warning),
        Indicator::new("emergency", is_on(output::EMERGENCY_STOP), Tone::Bad),
        Indicator::new("alarm", is_on(output::ALARM), Tone::Bad),
        Indicator::new("warning", is_on(output::WARNING), Tone::Warning),
        Indicator::expected("CPU OK", is_on(output::CPU_OK), Tone::Bad),
        Indicator::expected("MP ready", is_on(output::MP_READY), Tone::Warning),
        Indicator::new("at start", is_on(output::PROGRAM_RESET), Tone::Plain),
        Indicator::new("command", Status::from_word(image.0[0]) == Status::Running, Tone::Good),
    ]
}

fn bank(name: &'static str, side: Side, image: &Image) -> Bank {
    // Signal numbers are octal. The groups start at 20, 30, 40 and 50, and have 8 signals each.
    let starts = (0..GROUPS).map(|group| FIRST + 10 * group);
    let groups = starts.map(|start| SignalByte {
        label: format!("{}{start}", side.name()),
        signals: std::array::from_fn(|bit| {
            let bit = u16::try_from(bit).unwrap_or_default();
            Signal::new(side, start + bit).is_ok_and(|signal| signal.is_on(image))
        }),
    });
    Bank { name, groups: groups.collect() }
}
