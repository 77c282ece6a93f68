//! Live view of a controller: status and position in one line, or axes with soft limits, the alarm and the first ports
//! in the detail view. The protocol has no torque.

use super::explain::alarm_from_code;
use super::io::port::{INPUTS, OUTPUTS, PortBank, ports_of};
use super::link::{Link, Toyo};
use super::overview::report;
use super::position::Coordinates;
use crate::prelude::basics::*;
use armctl_controller::toyo::table::Command;
use armctl_frame::Family as _;
use armctl_frame::face::registration;
use armctl_frame::face::sample::{Axis, Bank, Detail, Indicator, Sample, SignalByte, Whole, clocked};
use armctl_frame::robot::alarm::Alarm;

/// Poller of one controller.
#[derive(Debug)]
pub struct Poller {
    link: Link,
    /// Soft limits; `None` before the first read.
    limits: Option<Limits>,
}

/// Soft limits of axes 1 to 4, smallest and largest; `None` if the controller does not report them.
type Limits = [Option<(f64, f64)>; 4];

impl registration::Poller for Poller {
    type Family = Toyo;

    async fn open(robot: &Robot, access: Access, screen: &Screen) -> Result<Self> {
        Ok(Self { link: Toyo::connect(robot, access, screen).await?, limits: None })
    }

    async fn look(&mut self, detail: Detail) -> Result<Sample> {
        let (first, answered_in) = clocked(self.link.status_of(&[0])).await;
        let first = first?;
        let rest: &[u8] = match (detail, first.has_error()) {
            (Detail::Full, _) => &[1, 2, 3, 4],
            (_, true) => &[1, 2, 3],
            (_, false) => &[2, 3],
        };
        let status = self.link.status_of(rest).await?.with(0, first.state);
        let letters = self.link.letters().await?;
        let coordinates = self.link.try_ask(&Request::bare(Command::Mpst)).await?.ok();
        let coordinates = coordinates.map(|record| Coordinates::of(&record, letters));
        let whole = match detail {
            Detail::Summary => None,
            Detail::Axes | Detail::Full => Some(self.whole(detail, status, coordinates).await?),
        };
        Ok(Sample { line: report(status, coordinates), answered_in, alarms: alarms(status), full: whole })
    }

    fn link(&mut self) -> &mut Link {
        &mut self.link
    }

    async fn close(self, screen: &Screen) -> Result<()> {
        Toyo::close(self.link, screen).await
    }
}

impl Poller {
    async fn whole(&mut self, detail: Detail, status: Status, coordinates: Option<Coordinates>) -> Result<Whole> {
        let is_full = detail == Detail::Full;
        let limits = match self.limits {
            Some(limits) => limits,
            None if is_full => *self.limits.insert(limits(&mut self.link).await?),
            None => Limits::default(),
        };
        let mut banks = Vec::new();
        for (name, ports) in [("inputs", INPUTS), ("outputs", OUTPUTS)].into_iter().filter(|_| is_full) {
            banks.push(self.bank(name, ports).await?);
        }
        let letters = self.link.letters().await?.all();
        let axes = coordinates.map_or_else(Vec::new, |coordinates| axes(coordinates, letters, limits));
        Ok(Whole { indicators: indicators(status), axes, torque_unit: None, banks, not_asked: None })
    }

    /// Reads the first screen of ports of the controller.
    async fn bank(&mut self, name: &'static str, ports: PortBank) -> Result<Bank> {
        let groups = match self.link.try_ask(&ports.request(0, 1)).await? {
            Ok(record) => {
                ports_of(&record).iter().map(|port| SignalByte::falling(port.name.clone(), port.byte)).collect()
            }
            Err(_) => Vec::new(),
        };
        Ok(Bank { name, groups })
    }
}

/// Reads the soft limits.
async fn limits(link: &mut Link) -> Result<Limits> {
    let (least, most) = (parameter(link, "P02").await?, parameter(link, "P01").await?);
    let (Some(least), Some(most)) = (least, most) else { return Ok(Limits::default()) };
    let limit =
        |record: &Record, axis: usize| record.number(&format!("ax{axis}")).map(|steps| f64::from(steps) / 100.0);
    Ok([1, 2, 3, 4].map(|axis| Some((limit(&least, axis)?, limit(&most, axis)?)).filter(|(least, most)| least < most)))
}

async fn parameter(link: &mut Link, id: &str) -> Result<Option<Record>> {
    let request = Parameter::named(id).and_then(|parameter| Request::read_parameter(parameter, None).ok());
    let request = request.ok_or_else(|| Failure::local(format!("unknown parameter {id}")))?;
    Ok(link.try_ask(&request).await?.ok())
}

/// Returns the present alarm as a list.
pub(super) fn alarms(status: Status) -> Vec<Alarm> {
    status.has_error().then(|| alarm_from_code(status.error)).into_iter().collect()
}

fn indicators(status: Status) -> Vec<Indicator> {
    vec![
        Indicator::new("host", status.host_on(), Tone::Good),
        Indicator::new("pendant", status.pendant_on(), Tone::Warning),
        Indicator::new("servo", status.servo_on(), Tone::Good),
        Indicator::expected("origin", status.homed(), Tone::Warning),
        Indicator::new("homing", status.homing(), Tone::Warning),
        Indicator::new("running", status.executing(), Tone::Good),
        Indicator::new("paused", status.paused(), Tone::Warning),
        Indicator::new("in position", status.in_position(), Tone::Good),
        Indicator::new("error", status.has_error(), Tone::Bad),
        Indicator::expected("ready", status.ready_output(), Tone::Plain),
        Indicator::new("waits", status.waits_for_input(), Tone::Warning),
        Indicator::new("one move", status.single_movement(), Tone::Plain),
        Indicator::new("slave lost", status.slave_not_ready(), Tone::Bad),
        Indicator::new("power cycle", status.needs_power_cycle(), Tone::Bad),
    ]
}

fn axes(coordinates: Coordinates, letters: [String; 4], limits: Limits) -> Vec<Axis> {
    let names = letters.into_iter().enumerate();
    let names = names.map(|(axis, letter)| if letter.is_empty() { (axis + 1).to_string() } else { letter });
    let axes = names.zip(coordinates.mm()).zip(limits);
    let axes = axes.map(|((name, position), limits)| Axis {
        name,
        position,
        unit: "mm",
        decimals: 2,
        limits,
        ..Axis::default()
    });
    axes.collect()
}
