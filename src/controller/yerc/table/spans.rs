//! Valid instances of each command, by model.

use crate::yerc::Model;

/// A range of instance numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// First number.
    pub first: u16,
    /// Last number, inclusive.
    pub last: u16,
    /// Description of the instances.
    pub meaning: &'static str,
    /// Prefix of the instance names, and the number of the first instance, for example `R` and 1.
    pub numbered: Option<(&'static str, u16)>,
    /// Whether write services are valid.
    pub writable: bool,
    /// Whether the instances exist only with certain controller parameters.
    pub extended: bool,
}

impl Span {
    /// Whether the range contains the instance.
    pub const fn contains(&self, instance: u16) -> bool {
        self.first <= instance && instance <= self.last
    }

    /// Name of an instance, for example `R1, robot (pulse)`.
    pub fn label(&self, instance: u16) -> String {
        match self.numbered {
            Some((prefix, from)) => {
                let number = u32::from(from) + u32::from(instance.saturating_sub(self.first));
                if self.meaning.is_empty() {
                    format!("{prefix}{number}")
                } else {
                    format!("{prefix}{number}, {}", self.meaning)
                }
            }
            None => self.meaning.to_owned(),
        }
    }
}

/// Ranges of each model, in ascending order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instances {
    /// Ranges of an FS100; empty if the command does not exist.
    pub fs100: &'static [Span],
    /// Ranges of a DX100.
    pub dx100: &'static [Span],
    /// Ranges of a DX200 and a YRC1000.
    pub dx200: &'static [Span],
}

impl Instances {
    /// Ranges of a model.
    pub const fn for_model(&self, model: Model) -> &'static [Span] {
        match model {
            Model::Fs100 => self.fs100,
            Model::Dx100 => self.dx100,
            Model::Dx200 | Model::Yrc1000 => self.dx200,
        }
    }

    /// The range of an instance.
    pub fn find(&self, model: Model, instance: u16) -> Option<&'static Span> {
        self.for_model(model).iter().find(|span| span.contains(instance))
    }

    /// Last instance that can be reached from `instance` through contiguous ranges.
    pub fn reach(&self, model: Model, instance: u16, only_writable: bool) -> Option<u16> {
        let mut spans = self.for_model(model).iter().filter(|span| span.writable || !only_writable);
        let mut last = spans.find(|span| span.contains(instance))?.last;
        for span in spans {
            if last.checked_add(1) != Some(span.first) {
                break;
            }
            last = span.last;
        }
        Some(last)
    }

    /// Readable list of ranges, for example `1-2, 11-12`.
    pub fn ranges(&self, model: Model, only_writable: bool) -> String {
        let mut ranges: Vec<(u16, u16)> = Vec::new();
        for span in self.for_model(model).iter().filter(|span| span.writable || !only_writable) {
            match ranges.last_mut() {
                Some((_, last)) if last.checked_add(1) == Some(span.first) => *last = span.last,
                _ => ranges.push((span.first, span.last)),
            }
        }
        let words = ranges
            .into_iter()
            .map(|(first, last)| if first == last { first.to_string() } else { format!("{first}-{last}") });
        words.collect::<Vec<_>>().join(", ")
    }
}

/// A read-only range.
const fn ro(first: u16, last: u16, meaning: &'static str) -> Span {
    Span { first, last, meaning, numbered: None, writable: false, extended: false }
}

/// A range that can also be written.
const fn rw(first: u16, last: u16, meaning: &'static str) -> Span {
    Span { writable: true, ..ro(first, last, meaning) }
}

/// A read-only range whose instances have names: `prefix` with numbers from `from` on.
const fn no(first: u16, last: u16, meaning: &'static str, prefix: &'static str, from: u16) -> Span {
    Span { numbered: Some((prefix, from)), ..ro(first, last, meaning) }
}

const fn both(spans: &'static [Span]) -> Instances {
    Instances { fs100: spans, dx100: spans, dx200: spans }
}

/// Ranges that are the same on the DX100 and the DX200.
const fn each(fs100: &'static [Span], dx200: &'static [Span]) -> Instances {
    Instances { fs100, dx100: dx200, dx200 }
}

pub(super) const ALARMS: Instances =
    both(&[ro(1, 1, "latest alarm"), ro(2, 2, "second latest"), ro(3, 3, "third latest"), ro(4, 4, "fourth latest")]);
pub(super) const HISTORY: Instances = both(&[
    no(1, 100, "", "major failure ", 1),
    no(1001, 1100, "", "monitor alarm ", 1),
    no(2001, 2100, "", "user alarm (system) ", 1),
    no(3001, 3100, "", "user alarm (user) ", 1),
    no(4001, 4100, "", "off-line alarm ", 1),
]);
pub(super) const STATUS: Instances = both(&[ro(1, 1, "controller")]);
pub(super) const TASKS: Instances = each(
    &[ro(1, 1, "master task"), no(2, 6, "", "sub task ", 1)],
    &[ro(1, 1, "master task"), no(2, 16, "", "sub task ", 1)],
);
pub(super) const AXES: Instances = each(&axes(2, 3), &axes(8, 24));
pub(super) const POSITIONS: Instances = each(&positions(2, 3), &positions(8, 24));
pub(super) const GROUPS: Instances = each(&groups(2, 3), &groups(8, 24));

/// A model has as many bases as robots.
const fn axes(robots: u16, stations: u16) -> [Span; 5] {
    [
        no(1, robots, "robot (pulse)", "R", 1),
        no(11, 10 + robots, "base (pulse)", "B", 1),
        no(21, 20 + stations, "station (pulse)", "S", 1),
        no(101, 100 + robots, "robot (cartesian)", "R", 1),
        no(111, 110 + robots, "base (cartesian)", "B", 1),
    ]
}

const fn positions(robots: u16, stations: u16) -> [Span; 4] {
    let [robot, base, station, ..] = axes(robots, stations);
    [robot, base, station, no(101, 100 + robots, "robot (base coordinates)", "R", 1)]
}

const fn groups(robots: u16, stations: u16) -> [Span; 3] {
    [no(1, robots, "robot", "R", 1), no(11, 10 + robots, "base", "B", 1), no(21, 20 + stations, "station", "S", 1)]
}

/// Number of signal groups in each class in which models differ. For network signals, also the number of the first
/// group.
struct Signals {
    user: u16,
    external: u16,
    network_from: u16,
    network: u16,
    system_output: u16,
    control_status: u16,
}

const fn signals(last: &Signals) -> [Span; 12] {
    let Signals { user, external, network_from, network, system_output, control_status } = *last;
    let outputs_from = 1000 + network_from;
    [
        ro(1, user, "robot user input"),
        ro(1001, 1000 + user, "robot user output"),
        ro(2001, 2000 + external, "external input"),
        rw(network_from, network_from + network - 1, "network input"),
        ro(3001, 3000 + external, "external output"),
        ro(outputs_from, outputs_from + network - 1, "network output"),
        ro(4001, 4160, "robot system input"),
        ro(5001, 5000 + system_output, "robot system output"),
        ro(6001, 6064, "interface panel input"),
        ro(7001, 7999, "auxiliary relay"),
        ro(8001, 8000 + control_status, "robot control status"),
        ro(8201, 8220, "pseudo input"),
    ]
}

const FS100_SIGNALS: Signals =
    Signals { user: 128, external: 128, network_from: 2501, network: 128, system_output: 200, control_status: 64 };
const DX100_SIGNALS: Signals =
    Signals { user: 512, external: 500, system_output: 300, control_status: 128, ..FS100_SIGNALS };
const DX200_SIGNALS: Signals = Signals { external: 512, network_from: 2701, network: 256, ..DX100_SIGNALS };

/// On an FS100, each class has 128 groups, and the last number of a class follows from this; the manual has different
/// numbers for two classes. A DX100 has its network signals at the same numbers as an FS100 (`WriteSingleIO.srv` of
/// `motoman_msgs`: inputs from 25010 on). Its writable range is the range of an FS100. Its readable range is the
/// largest possible range.
pub(super) const IO: Instances =
    Instances { fs100: &signals(&FS100_SIGNALS), dx100: &signals(&DX100_SIGNALS), dx200: &signals(&DX200_SIGNALS) };
pub(super) const REGISTERS: Instances = both(&[rw(0, 559, "register"), ro(560, 999, "register (read only)")]);

const fn variables(last: u16) -> [Span; 2] {
    let extended = Span { extended: true, ..rw(last + 1, u16::MAX, "extended variable") };
    [rw(0, last, "variable"), extended]
}

pub(super) const VARIABLES: Instances = both(&variables(99));
pub(super) const POSITION_VARIABLES: Instances = both(&variables(127));
pub(super) const LONG_STRINGS: Instances = Instances { fs100: &[], dx100: &[], dx200: &variables(99) };
pub(super) const RESETS: Instances = both(&[rw(1, 1, "reset alarm"), rw(2, 2, "cancel error")]);
pub(super) const SWITCHES: Instances = both(&[rw(1, 1, "hold"), rw(2, 2, "servo power"), rw(3, 3, "hlock")]);
pub(super) const CYCLE: Instances = both(&[rw(2, 2, "cycle")]);
pub(super) const ONE: Instances = both(&[rw(1, 1, "controller")]);
pub(super) const SELECTIONS: Instances = each(
    &[rw(1, 1, "job to execute"), Span { writable: true, ..no(10, 15, "", "master job of task ", 0) }],
    &[rw(1, 1, "job to execute"), Span { writable: true, ..no(10, 25, "", "master job of task ", 0) }],
);
pub(super) const TIMES: Instances = each(&times(2, 3), &times(8, 24));

const fn times(robots: u16, stations: u16) -> [Span; 11] {
    [
        ro(1, 1, "control power on time"),
        ro(10, 10, "servo power on time, total"),
        no(11, 10 + robots, "servo power on time", "R", 1),
        no(21, 20 + stations, "servo power on time", "S", 1),
        ro(110, 110, "playback time, total"),
        no(111, 110 + robots, "playback time", "R", 1),
        no(121, 120 + stations, "playback time", "S", 1),
        ro(210, 210, "motion time, total"),
        no(211, 210 + robots, "motion time", "R", 1),
        no(221, 220 + stations, "motion time", "S", 1),
        no(301, 308, "operation time", "application ", 1),
    ]
}

pub(super) const SYSTEMS: Instances = each(
    &[no(11, 12, "", "R", 1), no(21, 23, "", "S", 1), no(101, 101, "", "application ", 1)],
    &[no(11, 18, "", "R", 1), no(21, 44, "", "S", 1), no(101, 108, "", "application ", 1)],
);
pub(super) const MOVES: Instances =
    both(&[rw(1, 1, "link, absolute"), rw(2, 2, "straight, absolute"), rw(3, 3, "straight, incremental")]);
pub(super) const PULSE_MOVES: Instances = both(&[rw(1, 1, "link, absolute"), rw(2, 2, "straight, absolute")]);
pub(super) const FILES: Instances = both(&[rw(0, 0, "file")]);
