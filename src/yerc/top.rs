//! Live view of a robot: status and position in one line, and axes, torque, alarms and signals in the detail view.

use super::alarm::{SLOTS, present};
use super::overview::report;
use super::position::{CARTESIAN_AXES, ROBOT_AXES, decimal};
use crate::prelude::*;
use armctl_controller::units;
use armctl_controller::yerc::payload::{Axes, ControllerStatus, CycleMode, StatusBit};
use armctl_controller::yerc::query::{
    Coordinates, Query, QueryError, ReadIoGroups, ReadJob, ReadPosition, ReadPositionError, ReadStatus, ReadTorque,
};
use armctl_frame::Family as _;
use armctl_frame::face::registration;
use armctl_frame::face::sample::{Axis, Bank, Detail, Indicator, Sample, SignalByte, Whole, clocked};
use armctl_frame::robot::state::Fault;

/// Poller for one controller.
#[derive(Debug)]
pub struct Poller {
    link: Link,
    /// Whether the controller supports alarm texts. This is assumed until the controller refuses them.
    texts: bool,
}

/// Task that runs the master job.
const MASTER_TASK: u8 = 0;

/// Signals in the view: name, and first group of the general-purpose signals of this kind. `GROUPS` is the number of
/// groups of each kind.
const BANKS: [(&str, u16); 2] = [("inputs", 1), ("outputs", 1001)];
const GROUPS: u16 = 4;

impl registration::Poller for Poller {
    type Family = Yerc;

    async fn open(robot: &Robot, access: Access, screen: &Screen) -> Result<Self> {
        Ok(Self { link: Yerc::connect(robot, access, screen).await?, texts: true })
    }

    async fn look(&mut self, detail: Detail) -> Result<Sample> {
        let (status, answered_in) = clocked(self.link.ask(&ReadStatus)).await;
        let status = status?;
        // A controller without a first robot has no position. This is not a failure.
        let base = self.position(Coordinates::Base).await?;
        let slots = if detail == Detail::Full { SLOTS } else { 1 };
        let alarms = if status.alarm() { present(&mut self.link, &mut self.texts, slots).await? } else { Vec::new() };
        let whole = match detail {
            Detail::Summary => None,
            Detail::Axes | Detail::Full => Some(self.whole(detail, status, base.as_ref()).await?),
        };
        let fault = Fault::new(status.faulted(), alarms.first());
        let mut line = report(status, fault, base.as_ref());
        if whole.is_some()
            && let Some(job) = self.ask(ReadJob::new(self.link.model_for_display(), MASTER_TASK)).await?
        {
            let name = self.link.encoding.name(job.name.as_bytes()).text;
            line.state.program = Some(name).filter(|name| !name.is_empty());
            line.state.speed_override_percent = Some(f64::from(job.speed_override) / 100.0);
        }
        Ok(Sample { line, answered_in, alarms, full: whole })
    }

    fn link(&mut self) -> &mut Link {
        &mut self.link
    }

    async fn close(self, screen: &Screen) -> Result<()> {
        Yerc::close(self.link, screen).await
    }
}

impl Poller {
    async fn whole(&mut self, detail: Detail, status: ControllerStatus, base: Option<&Position>) -> Result<Whole> {
        let model = self.link.model_for_display();
        let pulses = self.position(Coordinates::Pulse).await?;
        let torque = self.ask(ReadTorque::new(model, Group::R1)).await?;
        let is_full = detail == Detail::Full;
        let error = if is_full { self.ask(ReadPositionError::new(model, Group::R1)).await? } else { None };
        let mut axes = pulses.map_or_else(Vec::new, |pulses| joints(pulses.axes, torque, error));
        axes.extend(base.into_iter().flat_map(coordinates));
        let mut banks = Vec::new();
        for (name, first) in BANKS.into_iter().filter(|_| is_full) {
            if let Some(bytes) = self.ask(ReadIoGroups::new(model, first, GROUPS)).await? {
                let groups = (first..).zip(bytes).map(|(group, byte)| SignalByte::rising(format!("#{group}0"), byte));
                banks.push(Bank { name, groups: groups.collect() });
            }
        }
        let torque_unit = torque.map(|_| "raw");
        Ok(Whole { indicators: indicators(status), axes, torque_unit, banks, not_asked: None })
    }

    async fn position(&mut self, coordinates: Coordinates) -> Result<Option<Position>> {
        let position = self.ask(ReadPosition::new(self.link.model_for_display(), Group::R1, coordinates)).await?;
        let Some(position) = position else { return Ok(None) };
        let (axes, _) = self.link.existing_axes(Group::R1, coordinates, position.axes).await;
        Ok(Some(Position { axes, ..position }))
    }

    /// Reads an optional value. A refusal gives `None`.
    async fn ask<Q: Query>(&mut self, query: Result<Q, QueryError>) -> Result<Option<Q::Answer>> {
        let query = query.map_err(|error| Failure::local(error.to_string()))?;
        Ok(self.link.ask_optional(&query).await?.ok())
    }
}

fn indicators(status: ControllerStatus) -> Vec<Indicator> {
    let has = |bit| status.has(bit);
    let cycle = |cycle| status.cycle() == Some(cycle);
    vec![
        Indicator::new("teach", has(StatusBit::Teach), Tone::Warning),
        Indicator::new("play", has(StatusBit::Play), Tone::Good),
        Indicator::expected("remote", has(StatusBit::CommandRemote), Tone::Plain),
        Indicator::new("servo", status.servo_on(), Tone::Good),
        Indicator::new("running", status.running(), Tone::Good),
        Indicator::new("hold", status.held(), Tone::Warning),
        Indicator::new("alarm", status.alarm(), Tone::Bad),
        Indicator::new("error", status.error(), Tone::Bad),
        Indicator::new("step", cycle(CycleMode::Step), Tone::Plain),
        Indicator::new("one cycle", cycle(CycleMode::Once), Tone::Plain),
        Indicator::new("continuous", cycle(CycleMode::Continuous), Tone::Plain),
        Indicator::new("safe speed", has(StatusBit::Guarded), Tone::Warning),
    ]
}

fn joints(pulses: Axes, torque: Option<Axes>, error: Option<Axes>) -> Vec<Axis> {
    let of = |axes: Option<Axes>, axis: usize| axes.and_then(|axes| axes.as_slice().get(axis).copied()).map(f64::from);
    let axes = ROBOT_AXES.iter().zip(pulses.as_slice()).enumerate();
    let axes = axes.map(|(axis, (name, pulses))| Axis {
        name: (*name).to_owned(),
        position: f64::from(*pulses),
        unit: units::PULSE.symbol,
        decimals: units::PULSE.decimals,
        limits: None,
        torque: of(torque, axis),
        error: of(error, axis),
    });
    axes.collect()
}

fn coordinates(base: &Position) -> Vec<Axis> {
    let axes = CARTESIAN_AXES.iter().zip(base.axes.as_slice()).enumerate();
    let axes = axes.map(|(axis, (name, value))| {
        let unit = PositionKind::Base.unit(axis);
        Axis {
            name: (*name).to_owned(),
            position: decimal(*value, unit),
            unit: unit.symbol,
            decimals: unit.decimals,
            ..Axis::default()
        }
    });
    axes.collect()
}
