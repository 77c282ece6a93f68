//! Parameters converted to typed settings.

use super::io::PortBit;
use super::memory::{Content, TASKS};
use super::motion::{AXES, Coordinates};
use crate::toyo::field::Value;
use crate::toyo::layout::Record;

/// An output that the controller drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Signal {
    Paused,
    InputWait,
    Ready,
    Battery,
    Positioned(usize),
    Origin(usize),
    Load(usize),
    Limit(usize),
    Locked(usize),
    /// On while the axis is inside its area.
    Area(usize),
}

/// Program type that parameter M10 selects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Special {
    None,
    Easy,
    Point,
}

/// Settings from the parameters that take effect at once (groups M and P).
#[derive(Debug, Clone)]
pub(super) struct Settings {
    pub(super) single: Option<PortBit>,
    pub(super) continuous: Option<PortBit>,
    pub(super) escape: Option<PortBit>,
    pub(super) pause: Option<PortBit>,
    pub(super) selection: Option<PortBit>,
    pub(super) palletizing: Option<PortBit>,
    pub(super) servo_on: Option<PortBit>,
    pub(super) signals: Vec<(PortBit, Signal)>,
    pub(super) direct: [Option<PortBit>; 4],
    pub(super) special: Special,
    pub(super) clear_on_reset: bool,
    pub(super) japanese: bool,
    pub(super) plus: Coordinates,
    pub(super) minus: Coordinates,
    pub(super) origin: Coordinates,
    pub(super) sequence: [i32; AXES],
    /// Low and high JOG speed of each axis, in mm/s.
    pub(super) jog: [[f64; 2]; AXES],
    pub(super) inch: Coordinates,
    /// Area of each axis: whether the area lies above its limit, and the position of the limit.
    pub(super) areas: [(bool, f64); AXES],
}

/// Settings from the parameters that take effect after power on (group E).
#[derive(Debug, Clone)]
pub(super) struct Machine {
    pub(super) tasks: [Axes; TASKS],
    pub(super) top: Coordinates,
    /// Low, middle and high origin speed of each axis, in mm/s.
    pub(super) origin: [[f64; 3]; AXES],
    /// Position to which an axis moves at high speed, before it searches its origin (E13).
    pub(super) fast: Coordinates,
    /// Whether the origin lies in the plus direction of each axis.
    pub(super) upwards: [bool; AXES],
    /// Position error in mm that counts as overflow.
    pub(super) overflow: Coordinates,
    pub(super) absolute: bool,
    /// Execution order of tasks that act at the same time (E20).
    pub(super) order: [usize; TASKS],
    /// For each driven axis: its drive axis. `None` for all other axes.
    pub(super) driver: [Option<usize>; AXES],
    /// Whether the roles of synchronized axes are invalid.
    pub(super) bad_roles: bool,
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Axes {
    pub(super) axes: Vec<usize>,
    /// Number of axes, counted from the first, that form a plane or a space.
    pub(super) space: usize,
}

impl Settings {
    pub(super) fn from_content(content: &Content) -> Self {
        let bit = |id| PortBit::from_record(content.single(id), "");
        let mut signals = Vec::new();
        for (id, signal) in
            [("M07", Signal::Paused), ("M08", Signal::InputWait), ("M13", Signal::Ready), ("M19", Signal::Battery)]
        {
            signals.extend(bit(id).map(|bit| (bit, signal)));
        }
        for task in 0..TASKS {
            for (id, signal) in [
                ("M14", Signal::Positioned(task)),
                ("M15", Signal::Origin(task)),
                ("M24", Signal::Load(task)),
                ("M25", Signal::Limit(task)),
                ("M26", Signal::Locked(task)),
            ] {
                let bit = PortBit::from_record(content.single(id), &(task + 1).to_string());
                signals.extend(bit.map(|bit| (bit, signal)));
            }
        }
        let areas = ["P13", "P14", "P15", "P16"];
        for (axis, id) in areas.into_iter().enumerate() {
            signals.extend(bit(id).map(|bit| (bit, Signal::Area(axis))));
        }
        Self {
            single: bit("M01"),
            continuous: bit("M02"),
            escape: bit("M03"),
            pause: bit("M04"),
            selection: bit("M05"),
            palletizing: bit("M06"),
            servo_on: bit("M21"),
            signals,
            direct: std::array::from_fn(|place| PortBit::from_record(content.single("M12"), &(place + 1).to_string())),
            special: match content.single("M10").word("mode") {
                Some("E") => Special::Easy,
                Some("P") => Special::Point,
                _ => Special::None,
            },
            clear_on_reset: content.single("M11").word("use") == Some("E"),
            japanese: content.single("M09").word("language") == Some("J"),
            plus: decimals(content, "P01", 100.0),
            minus: decimals(content, "P02", 100.0),
            origin: decimals(content, "P06", 100.0),
            sequence: numbers(content.single("P07")),
            jog: ["P08", "P09", "P10", "P11"]
                .map(|id| numbers(content.single(id)).map(|speed| f64::from(speed) / 10.0)),
            inch: decimals(content, "P12", 100.0),
            areas: areas.map(|id| {
                let area = content.single(id);
                (area.word("compare") == Some(">="), f64::from(area.number("place").unwrap_or_default()) / 100.0)
            }),
        }
    }
}

impl Machine {
    pub(super) fn from_content(content: &Content) -> Self {
        let lead = decimals(content, "E14", 1000.0);
        let division = decimals(content, "E15", 1.0);
        let multiplier = decimals(content, "E16", 1.0);
        let pulses = decimals(content, "E03", 1.0);
        let words = |id| words(content.single(id));
        let roles = words("E26");
        let driver = std::array::from_fn(|axis| {
            let before = axis.checked_sub(1)?;
            (roles[axis] == "S" && roles[before] == "M").then_some(before)
        });
        Self {
            tasks: tasks(words("E19")[0]),
            top: decimals(content, "E06", 1.0),
            origin: ["E07", "E08", "E09", "E10"]
                .map(|id| numbers(content.single(id)).map(|speed| f64::from(speed) / 10.0)),
            fast: decimals(content, "E13", 100.0),
            upwards: words("E24").map(|word| word == "1"),
            overflow: std::array::from_fn(|axis| pulses[axis] * lead[axis] / (division[axis] * multiplier[axis])),
            absolute: words("E17")[0] == "a",
            order: order(numbers(content.single("E20"))),
            bad_roles: (0..AXES).any(|axis| match roles[axis] {
                "S" => driver[axis].is_none(),
                "M" => axis + 1 >= AXES || roles[axis + 1] != "S",
                _ => false,
            }),
            driver,
        }
    }
}

/// Tasks in the order of their priority, lowest number first.
fn order(priority: [i32; TASKS]) -> [usize; TASKS] {
    let mut order = std::array::from_fn(|task| task);
    order.sort_by_key(|&task| priority[task]);
    order
}

/// Axes of each task. Each digit is for one task; the tasks divide the axes in order (TO 2-4, E19).
fn tasks(digits: &str) -> [Axes; TASKS] {
    let mut next = 0;
    let mut digits = digits.bytes();
    std::array::from_fn(|_| {
        let (count, space) = match digits.next() {
            Some(b'1') => (1, 1),
            Some(b'2') => (2, 2),
            Some(b'3') => (3, 2),
            Some(b'4') => (3, 3),
            Some(b'5') => (4, 3),
            _ => (0, 0),
        };
        next += count;
        Axes { axes: (next - count..next).collect(), space }
    })
}

fn numbers<const N: usize>(record: &Record) -> [i32; N] {
    std::array::from_fn(|place| if let Some(Value::Number(number)) = record.values().get(place) { *number } else { 0 })
}

fn words(record: &Record) -> [&'static str; AXES] {
    std::array::from_fn(|place| if let Some(Value::Word(word)) = record.values().get(place) { word } else { "" })
}

fn decimals(content: &Content, id: &str, scale: f64) -> Coordinates {
    numbers(content.single(id)).map(|number: i32| f64::from(number) / scale)
}

/// Number of axes in a combination of tasks.
pub(super) fn axes_of(machine: &Machine) -> usize {
    machine.tasks.iter().map(|task| task.axes.len()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_assigned_to_tasks_in_order() {
        let axes = tasks("1210").map(|task| task.axes);
        assert_eq!(axes, [vec![0], vec![1, 2], vec![3], vec![]]);
        assert_eq!(tasks("5000")[0], Axes { axes: vec![0, 1, 2, 3], space: 3 });
        assert_eq!(tasks("1300")[1], Axes { axes: vec![1, 2, 3], space: 2 });
    }

    #[test]
    fn tasks_run_in_order_of_priority() {
        assert_eq!(order([1, 1, 1, 1]), [0, 1, 2, 3]);
        assert_eq!(order([3, 1, 0, 1]), [2, 1, 3, 0]);
    }

    #[test]
    fn default_settings_are_valid() {
        let content = Content::new(4, 0);
        let (settings, machine) = (Settings::from_content(&content), Machine::from_content(&content));
        assert!(settings.signals.is_empty());
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(near(settings.plus[3], 1000.0) && near(settings.jog[2][1], 50.0));
        // E03 is 20,000 pulses. 8,000 pulses are 20 mm, so the overflow is at 50 mm.
        assert!(near(machine.overflow[0], 50.0) && near(machine.origin[0][1], 20.0));
    }
}
