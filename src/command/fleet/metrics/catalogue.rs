//! Catalogue of the metrics: name, type, unit, help text, source of the value. `docs/monitoring/README.md` explains
//! each metric, and a test compares the page with this list.

use std::collections::BTreeSet;

use super::board::{Board, RobotMetrics};
use super::page::{Form, Kind, Page, Samples, labels};
use crate::command::fleet::report_values::values_of_report;
use armctl_controller::units::{DEGREE, MILLIMETRE, PULSE};

/// A metric.
pub struct Metric {
    /// Name without `_total` or `_info`.
    pub name: &'static str,
    /// Metric type.
    pub kind: Kind,
    /// Unit suffix of the name; empty without a unit.
    pub unit: &'static str,
    /// Help text.
    pub help: &'static str,
    /// Writes the samples.
    read: fn(&Board, &mut Samples<'_>),
}

const fn metric(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    help: &'static str,
    read: fn(&Board, &mut Samples<'_>),
) -> Metric {
    Metric { name, kind, unit, help, read }
}

use Kind::{Counter, Gauge, Histogram, Info};

/// All metrics in the order of the page.
#[rustfmt::skip]
pub const METRICS: &[Metric] = &[
    metric("armctl_build", Info, "", "Version of the armctl that serves these metrics.", |_, samples| {
        let build = [("version", env!("CARGO_PKG_VERSION")), ("revision", env!("BUILT_COMMIT"))];
        samples.write_sample(&labels("", &build), 1);
    }),
    metric("armctl_robots", Gauge, "", "Number of polled robots.", |board, samples| {
        samples.write_sample("", board.robots.len());
    }),
    metric("armctl_inventory_last_reload_successful", Gauge, "",
        "Whether armctl could read robots.toml after its last change.",
        |board, samples| samples.write_sample("", u8::from(!board.is_inventory_broken))),
    metric("armctl_robot", Info, "", "Target of the robot, and its place (site, area, line, cell) from robots.toml.",
        |board, samples| board.robots.values().for_each(|seen| samples.write_sample(&seen.info, 1))),
    metric("armctl_robot_up", Gauge, "", "Whether the robot answered the latest poll.",
        |board, samples| each(board, samples, |seen| seen.is_known.then(|| u8::from(seen.last_poll.is_some())))),
    metric("armctl_robot_servo_on", Gauge, "", "Whether the servo power is on.",
        |board, samples| each(board, samples, |seen| flag(seen.line()?.state.servo_on))),
    metric("armctl_robot_running", Gauge, "", "Whether a job or program runs, or an axis moves.",
        |board, samples| each(board, samples, |seen| flag(seen.line()?.state.running))),
    metric("armctl_robot_held", Gauge, "", "Whether the robot is held or paused.",
        |board, samples| each(board, samples, |seen| flag(seen.line()?.state.held))),
    metric("armctl_robot_homed", Gauge, "", "Whether the origin is known.",
        |board, samples| each(board, samples, |seen| flag(seen.line()?.state.homed))),
    metric("armctl_robot_emergency_stop", Gauge, "", "Whether the emergency stop is active.",
        |board, samples| each(board, samples, |seen| flag(seen.line()?.state.emergency_stop))),
    metric("armctl_robot_speed_override_ratio", Gauge, "ratio", "Override of all speeds.",
        |board, samples| each(board, samples, |seen| Some(seen.line()?.state.speed_override_percent? / 100.0))),
    metric("armctl_robot_alarms", Gauge, "", "Number of active alarms and errors that the robot reports.",
        |board, samples| each(board, samples, |seen| Some(seen.last_poll.as_ref()?.sample.alarms.len()))),
    metric("armctl_robot_faulted", Gauge, "", "Whether an alarm or error is present.",
        |board, samples| each(board, samples, |seen| flag(seen.line()?.state.fault.faulted))),
    metric("armctl_robot_fault", Info, "", "The first active alarm or error, with its code and text.",
        faults),
    metric("armctl_robot_mode", Info, "", "Operating mode: manual or automatic.", modes),
    metric("armctl_robot_program", Info, "", "Program or job that is selected or runs.", programs),
    metric("armctl_axis_position_meters", Gauge, "meters", "Position of a linear axis or coordinate.",
        // Divide instead of multiplying by 0.001, so that 0.1025 is not rounded.
        |board, samples| axes(board, samples, MILLIMETRE.symbol, 1000.0)),
    metric("armctl_axis_position_degrees", Gauge, "degrees", "Position of a rotary axis or coordinate.",
        |board, samples| axes(board, samples, DEGREE.symbol, 1.0)),
    metric("armctl_axis_position_pulses", Gauge, "pulses", "Position of a joint in pulses of its encoder.",
        |board, samples| axes(board, samples, PULSE.symbol, 1.0)),
    metric("armctl_axis_torque_ratio", Gauge, "ratio", "Torque of an axis, as a ratio of its maximum.",
        |board, samples| torques(board, samples, "% of max", 100.0)),
    metric("armctl_axis_torque_raw", Gauge, "raw", "Torque of an axis in the unit of the controller, which is not \
                                                    known.",
        |board, samples| torques(board, samples, "raw", 1.0)),
    metric("armctl_command_value", Gauge, "",
        "A number in the answer to a command of --also, with the name of the command and the path of the value.", values),
    metric("armctl_session_open", Gauge, "", "Whether the polls use a session.",
        |board, samples| each(board, samples, |seen| flag(Some(seen.last_poll.as_ref()?.through_session)))),
    metric("armctl_robot_last_answer_timestamp_seconds", Gauge, "seconds", "Time of the last answer of the robot.",
        |board, samples| each(board, samples, |seen| seen.answered)),
    metric("armctl_poll_duration_seconds", Histogram, "seconds", "Duration of answered polls.", times),
    metric("armctl_polls", Counter, "", "Polls that were started.", |board, samples| {
        each(board, samples, |seen| Some(seen.polls));
    }),
    metric("armctl_poll_failures", Counter, "", "Failed polls, by error kind.", failures),
    metric("armctl_polls_missed", Counter, "", "Polls that were skipped because the previous poll took too long.",
        |board, samples| each(board, samples, |seen| Some(seen.missed_polls))),
    metric("armctl_poll_backoffs", Counter, "", "How often armctl increased the pause before the next try.",
        |board, samples| each(board, samples, |seen| Some(seen.backoffs))),
    metric("armctl_poll_pause_seconds", Gauge, "seconds", "The pause before the next try; 0 while the robot answers.",
        |board, samples| each(board, samples, |seen| Some(seen.pause.unwrap_or_default().as_secs_f64()))),
    metric("armctl_link_sent", Counter, "", "Frames, blocks or images that were sent to the robot.",
        |board, samples| each(board, samples, |seen| Some(seen.traffic.sent))),
    metric("armctl_link_received", Counter, "", "Frames, blocks or images that were received from the robot.",
        |board, samples| each(board, samples, |seen| Some(seen.traffic.received))),
    metric("armctl_link_disturbances", Counter, "",
        "Late, duplicate, damaged, lost or repeated frames, in both directions.",
        |board, samples| each(board, samples, |seen| Some(seen.traffic.disturbances))),
];

/// Page with all metrics.
pub fn page(board: &Board, form: Form) -> String {
    let mut page = Page::new(form);
    for Metric { name, kind, unit, help, read } in METRICS {
        page.metric(name, *kind, unit, help, |samples| read(board, samples));
    }
    page.end()
}

fn flag(is_so: Option<bool>) -> Option<u8> {
    is_so.map(u8::from)
}

/// Writes a sample for each robot with a known value.
fn each<V: std::fmt::Display>(board: &Board, samples: &mut Samples<'_>, value: impl Fn(&RobotMetrics) -> Option<V>) {
    for seen in board.robots.values() {
        if let Some(value) = value(seen) {
            samples.write_sample(&seen.labels, value);
        }
    }
}

fn faults(board: &Board, samples: &mut Samples<'_>) {
    for seen in board.robots.values() {
        let fault = seen.line().map(|line| &line.state.fault).filter(|fault| fault.faulted == Some(true));
        if let Some(fault) = fault {
            let [code, text] = [&fault.fault_code, &fault.fault_text].map(|told| told.as_deref().unwrap_or_default());
            samples.write_sample(&labels(&seen.labels, &[("code", code), ("text", text)]), 1);
        }
    }
}

fn modes(board: &Board, samples: &mut Samples<'_>) {
    for seen in board.robots.values() {
        if let Some(mode) = seen.line().and_then(|line| line.state.mode) {
            samples.write_sample(&labels(&seen.labels, &[("mode", mode.name())]), 1);
        }
    }
}

fn programs(board: &Board, samples: &mut Samples<'_>) {
    for seen in board.robots.values() {
        if let Some(program) = seen.line().and_then(|line| line.state.program.as_deref()) {
            samples.write_sample(&labels(&seen.labels, &[("program", program)]), 1);
        }
    }
}

fn values(board: &Board, samples: &mut Samples<'_>) {
    for seen in board.robots.values() {
        // Names of items can come from the controller. A duplicate label would make the whole page invalid.
        let mut written = BTreeSet::new();
        let extras = seen.last_poll.iter().flat_map(|polled| &polled.extras);
        for (text, answer) in extras {
            let also = board.also.iter().find(|also| also.text() == &**text);
            let (Some(also), Ok(data)) = (also, answer) else { continue };
            let command = also.name();
            for value in values_of_report("", data) {
                let number =
                    value.value.as_f64().or_else(|| value.value.as_bool().map(|flag| f64::from(u8::from(flag))));
                let Some(number) = number else { continue };
                let path = value.path.trim_start_matches('/');
                let labels = labels(&seen.labels, &[("command", command), ("value", path)]);
                if !written.contains(&labels) {
                    samples.write_sample(&labels, number);
                    written.insert(labels);
                }
            }
        }
    }
}

fn axes(board: &Board, samples: &mut Samples<'_>, unit: &str, divisor: f64) {
    for seen in board.robots.values() {
        for (labels, axis) in seen.axes(unit) {
            samples.write_sample(&labels, axis.position / divisor);
        }
    }
}

fn torques(board: &Board, samples: &mut Samples<'_>, torque_unit: &str, divisor: f64) {
    for seen in board.robots.values() {
        let whole = seen.last_poll.as_ref().and_then(|look| look.sample.full.as_ref());
        if whole.is_none_or(|whole| whole.torque_unit != Some(torque_unit)) {
            continue;
        }
        for unit in [PULSE.symbol, MILLIMETRE.symbol, DEGREE.symbol] {
            for (labels, axis) in seen.axes(unit) {
                if let Some(torque) = axis.torque {
                    samples.write_sample(&labels, torque / divisor);
                }
            }
        }
    }
}

fn times(board: &Board, samples: &mut Samples<'_>) {
    for seen in board.robots.values() {
        samples.histogram(&seen.labels, &seen.times.buckets(), seen.times.sum, seen.times.count);
    }
}

fn failures(board: &Board, samples: &mut Samples<'_>) {
    for seen in board.robots.values() {
        for (kind, count) in &seen.failures {
            samples.write_sample(&labels(&seen.labels, &[("kind", kind)]), count);
        }
    }
}
