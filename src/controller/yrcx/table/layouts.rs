//! Layouts of commands (words WI) and answers (words WO).

use super::field::{Charset, Show};
use super::field::{FINE_PERCENT, Field, MM, MM_S, MS, PERCENT, PLAIN, PULSE};
use super::parameter;
use crate::units::Unit;
use crate::yrcx::value::Key;

type Layout = &'static [Field];

// Names of choices.

const ROBOTS: Show = Show::Choice(&[(0, "none (robot 1)"), (1, "1"), (2, "2"), (3, "3"), (4, "4")]);
const ROBOTS_OR_ALL: Show = Show::Choice(&[(0, "all"), (1, "1"), (2, "2"), (3, "3"), (4, "4")]);
const FLAG: Show = Show::Choice(&[(0, "not given"), (1, "given")]);
const ALL_OR_SOME: Show = Show::Choice(&[(0, "all axes"), (1, "some axes")]);
const REPORTS: Show = Show::Choice(&[(0, "none"), (1, "pulse"), (2, "mm")]);
const UNITS: Show = Show::Choice(&[(0, "pulse"), (1, "mm")]);
const HAND_SYSTEMS: Show = Show::Choice(&[(0, "none"), (1, "right"), (2, "left")]);
const ARMS: Show = Show::Choice(&[(0, "right"), (1, "left")]);
const DIRECTIONS: Show = Show::Choice(&[(0, "+"), (1, "-")]);
const SPEED_MODES: Show = Show::Choice(&[(0, "not given"), (1, "0.01 % of the maximum"), (2, "%")]);
const LINEAR_SPEED_MODES: Show = Show::Choice(&[(0, "not given"), (1, "0.01 % of the maximum"), (2, "%"), (3, "mm/s")]);
const ORIGIN_CHOICES: Show = Show::Choice(&[(0, "all"), (1, "incremental"), (2, "absolute"), (4, "incomplete")]);
const PUSH_RESULTS: Show = Show::Choice(&[(0, "ended without time-out"), (1, "completed by time-out")]);
const MOTOR_TYPES: Show = Show::Choice(&[(0, "all"), (1, "incremental"), (2, "absolute")]);
const SERVO_STATES: Show = Show::Choice(&[(0, "brake"), (1, "servo"), (2, "free"), (9, "no axis")]);
const ORIGIN_STATES: Show = Show::Choice(&[(0, "incomplete"), (1, "complete"), (9, "not applicable")]);
const TASK_STATES: Show =
    Show::Choice(&[(0, "stop"), (1, "execution"), (2, "suspend"), (3, "standby"), (9, "no task")]);
const TASK_RANGES: Show = Show::Choice(&[(0, "tasks 1-8"), (1, "tasks 9-16")]);
const PLACES_1: Show = Show::Choice(&[(0, "robot"), (1, "controller"), (2, "task")]);
const PLACES_2: Show = Show::Choice(&[
    (0, "all robots or controllers"),
    (1, "axis"),
    (2, "motor"),
    (3, "option slot"),
    (4, "program task"),
]);
const MODULES: Show = Show::Choice(&[
    (0x0000, "none"),
    (0x0100, "DIO NPN dedicated input"),
    (0x0101, "DIO NPN general-purpose input"),
    (0x0200, "DIO PNP dedicated input"),
    (0x0201, "DIO PNP general-purpose input"),
    (0x0301, "PROFIBUS"),
    (0x0400, "DeviceNet"),
    (0x0401, "EtherNet/IP"),
]);
const OUTPUT_PORTS: Show = Show::Choice(&[(1, "DO"), (2, "MO"), (3, "LO"), (4, "TO"), (6, "SO")]);
const PORTS: Show = Show::Choice(&[(0, "DI"), (1, "DO"), (2, "MO"), (3, "LO"), (4, "TO"), (5, "SI"), (6, "SO")]);
const SELECT: [(u16, &str); 4] = [(0, "all"), (1, "program number"), (2, "task number"), (4, "program name")];

const ONE: Show = Show::Set { least: 1, most: 1 };
const NUMBER: Show = Show::Number(PLAIN);
const PERCENTS: Show = Show::Number(PERCENT);

const POINTS: &[(i32, i32)] = &[(0, 29_999)];
const PALLETS: &[(i32, i32)] = &[(0, 39)];
const COUNTS: &[(i32, i32)] = &[(1, 32_767)];
const TO_100: &[(i32, i32)] = &[(1, 100)];
const VARIABLES: &[(i32, i32)] = &[(0, 31), (256, 287)];

// The robot.

/// Robot number; 0 means robot 1 (4.2.1).
pub const ROBOT: Layout = &[Field::bits(Key::Robot, "robot", 0, 12, 4, ROBOTS).optional()];
/// Robot number; 0 means all robots (4.2.12, 4.7.11).
pub const ROBOT_OR_ALL: Layout = &[Field::bits(Key::Robot, "robot", 0, 12, 4, ROBOTS_OR_ALL).optional()];

// Motion (4.2).

/// Axes of a motion: all axes, or some axes.
pub const AXES: Layout = &[
    Field::bits(Key::AxisFlag, "axes flag", 1, 0, 1, ALL_OR_SOME).optional(),
    Field::bits(Key::Axes, "axes", 2, 0, 4, Show::Set { least: 1, most: 4 }).sets(Key::AxisFlag, 1),
];
/// Exactly one axis. The axis flag is fixed to 1 (DRIVE, DRIVEI, PUSH).
pub const ONE_AXIS: Layout = &[
    Field::bits(Key::AxisFlag, "axes flag", 1, 0, 1, Show::Fixed(1)).optional(),
    Field::bits(Key::Axes, "axis", 2, 0, 4, ONE),
];
/// Exactly one axis.
pub const AXIS: Layout = &[Field::bits(Key::Axes, "axis", 2, 0, 4, ONE)];
/// One axis. An empty set means all axes.
pub const AXIS_OR_ALL: Layout = &[Field::bits(Key::Axes, "axis", 2, 0, 4, Show::Set { least: 0, most: 1 }).optional()];
/// Direction of a jog or an inching motion: plus or minus.
pub const DIRECTION: Layout = &[Field::bits(Key::Direction, "direction", 2, 7, 1, DIRECTIONS)];

const SPEED_OF_MAX: Field = Field::word(Key::SpeedOfMax, "speed, of the maximum", 3, Show::Number(FINE_PERCENT))
    .within(&[(1, 10_000)])
    .sets(Key::SpeedMode, 1);
const SPEED_PERCENT: Field =
    Field::word(Key::SpeedPercent, "speed", 3, PERCENTS).within(TO_100).sets(Key::SpeedMode, 2);
const SPEED_MM_S: Field =
    Field::word(Key::SpeedMmS, "speed", 3, Show::Number(MM_S)).within(&[(1, 1000)]).sets(Key::SpeedMode, 3);
/// Speed of a point-to-point motion.
pub const SPEED: Layout =
    &[Field::bits(Key::SpeedMode, "speed flag", 1, 1, 2, SPEED_MODES).optional(), SPEED_OF_MAX, SPEED_PERCENT];
/// Speed of an interpolated motion. It can also be given in mm/s.
pub const LINEAR_SPEED: Layout = &[
    Field::bits(Key::SpeedMode, "speed flag", 1, 1, 2, LINEAR_SPEED_MODES).optional(),
    SPEED_OF_MAX,
    SPEED_PERCENT,
    SPEED_MM_S,
];
/// Acceleration and deceleration.
pub const ACCEL: Layout = &[
    Field::bits(Key::AccelFlag, "acceleration flag", 1, 5, 1, FLAG).optional(),
    Field::bits(Key::DecelFlag, "deceleration flag", 1, 6, 1, FLAG).optional(),
    Field::word(Key::Accel, "acceleration", 10, PERCENTS).within(TO_100).sets(Key::AccelFlag, 1),
    Field::word(Key::Decel, "deceleration", 11, PERCENTS).within(TO_100).sets(Key::DecelFlag, 1),
];
/// Unit of the positions in the answer. Bit 14 means pulses, bit 15 means mm; only one of them may be set.
pub const REPORT: Layout = &[Field::bits(Key::Report, "position output", 1, 14, 2, REPORTS).optional()];
/// Target point, or a point that contains distances.
pub const TO_POINT: Layout = &[Field::number(Key::Point, "point", 4).within(POINTS)];
/// The points of an arc.
pub const TO_ARC: Layout = &[
    Field::number(Key::Point, "first point", 4).within(POINTS),
    Field::number(Key::Point2, "second point", 5).within(POINTS),
];
/// Position on a pallet.
pub const TO_PALLET: Layout = &[
    Field::number(Key::Pallet, "pallet", 4).within(PALLETS),
    Field::number(Key::WorkPosition, "work position", 5).within(COUNTS),
];

const fn per_axis(first: usize, unit: Unit) -> [Field; 4] {
    [
        Field::long(Key::Axis1, "axis 1", first, unit),
        Field::long(Key::Axis2, "axis 2", first + 2, unit),
        Field::long(Key::Axis3, "axis 3", first + 4, unit),
        Field::long(Key::Axis4, "axis 4", first + 6, unit),
    ]
}

const fn of_axes(fields: &[Field; 4]) -> [Field; 4] {
    let [first, second, third, fourth] = *fields;
    [first.of_axis(1), second.of_axis(2), third.of_axis(3), fourth.of_axis(4)]
}

const fn when(fields: &[Field; 4], key: Key, value: i32) -> [Field; 4] {
    let [first, second, third, fourth] = *fields;
    [
        first.when(key, value, value),
        second.when(key, value, value),
        third.when(key, value, value),
        fourth.when(key, value, value),
    ]
}

/// Targets or distances of the moving axes, in mm.
pub const TARGETS_MM: Layout = &of_axes(&per_axis(4, MM));
/// Targets or distances of the moving axes, in pulses.
pub const TARGETS_PULSE: Layout = &of_axes(&per_axis(4, PULSE));
/// Hand system for coordinates in mm. Its codes differ from the codes of [`ARM`].
pub const HAND_SYSTEM: Layout = &[Field::bits(Key::HandSystem, "hand system", 1, 3, 2, HAND_SYSTEMS).optional()];
/// Target of one axis, in mm.
pub const TARGET_MM: Layout = &[Field::long(Key::Target, "target position", 4, MM)];
/// Target of one axis, in pulses.
pub const TARGET_PULSE: Layout = &[Field::long(Key::Target, "target position", 4, PULSE)];
/// Distance of one axis, in mm.
pub const DISTANCE_MM: Layout = &[Field::long(Key::Distance, "distance", 4, MM)];
/// Distance of one axis, in pulses.
pub const DISTANCE_PULSE: Layout = &[Field::long(Key::Distance, "distance", 4, PULSE)];
/// Arch: its axis, height, start position and end position.
pub const ARCH: Layout = &[
    Field::bits(Key::ArchUnit, "arch unit", 1, 4, 1, UNITS),
    Field::bits(Key::ArchAxis, "arch axis", 2, 8, 4, ONE),
    Field::long(Key::ArchPosition, "arch position", 8, PULSE).when(Key::ArchUnit, 0, 0),
    Field::long(Key::ArchPosition, "arch position", 8, MM).when(Key::ArchUnit, 1, 1),
    Field::long(Key::ArchStart, "arch start", 10, PULSE).when(Key::ArchUnit, 0, 0).optional(),
    Field::long(Key::ArchStart, "arch start", 10, MM).when(Key::ArchUnit, 1, 1).optional(),
    Field::long(Key::ArchEnd, "arch end", 12, PULSE).when(Key::ArchUnit, 0, 0).optional(),
    Field::long(Key::ArchEnd, "arch end", 12, MM).when(Key::ArchUnit, 1, 1).optional(),
];
/// Force and time of a push.
pub const PUSH: Layout = &[
    Field::bits(Key::PushForceFlag, "push force flag", 1, 7, 1, FLAG).optional(),
    Field::bits(Key::PushTimeFlag, "push time flag", 1, 8, 1, FLAG).optional(),
    Field::short(Key::PushForce, "push force, of the rated torque", 8, PERCENT)
        .within(&[(-1000, 1000)])
        .sets(Key::PushForceFlag, 1),
    Field::word(Key::PushTime, "push time", 9, Show::Number(MS)).within(COUNTS).sets(Key::PushTimeFlag, 1),
];
/// Inching distance in pulses or 0.001 mm, depending on the command.
pub const INCHING_AMOUNT: Layout = &[Field::number(Key::InchingAmount, "inching amount", 2).within(&[(1, 10_000)])];
/// Point in which the current position is stored, and the unit.
pub const TEACH: Layout =
    &[Field::number(Key::Point, "point", 2).within(POINTS), Field::word(Key::Unit, "unit", 3, UNITS)];
/// Axes of the origin return. At most one of its three bits may be set.
pub const ORIGIN_AXES: Layout = &[Field::bits(Key::OriginAxes, "axes", 1, 1, 3, ORIGIN_CHOICES).optional()];
/// Speed to set, in percent.
pub const SPEED_SETTING: Layout = &[Field::word(Key::SpeedPercent, "speed", 2, PERCENTS).within(TO_100)];
/// A shift to select.
pub const SHIFT: Layout = &[Field::number(Key::Shift, "shift", 2).within(PALLETS)];
/// A hand to select.
pub const HAND: Layout = &[Field::number(Key::Hand, "hand", 2).within(&[(0, 31)])];
/// An arm to select.
pub const ARM: Layout = &[Field::word(Key::Arm, "arm", 2, ARMS)];
/// Torque limit of an axis.
pub const TORQUE_LIMIT: Layout =
    &[Field::bits(Key::Axes, "axis", 2, 0, 4, ONE), Field::word(Key::Torque, "torque", 3, PERCENTS).within(TO_100)];

/// Final positions of the axes, in the unit of the command.
pub const POSITIONS: Layout =
    &joined(&when(&per_axis(4, PULSE), Key::Report, 1), &when(&per_axis(4, MM), Key::Report, 2));
/// Result of a push.
pub const PUSH_RESULT: Layout = &[Field::bits(Key::PushResult, "push", 3, 0, 1, PUSH_RESULTS)];

const fn joined(first: &[Field; 4], second: &[Field; 4]) -> [Field; 8] {
    let mut all = [first[0]; 8];
    let mut at = 0;
    while at < first.len() {
        all[at] = first[at];
        all[at + first.len()] = second[at];
        at += 1;
    }
    all
}

// Definitions and references (4.3).

/// Point number.
pub const POINT: Layout = &[Field::number(Key::Point, "point", 2).within(POINTS)];
/// Point definition.
pub const POINT_DATA: Layout = &[
    Field::bits(Key::Unit, "unit", 1, 0, 1, UNITS),
    Field::bits(Key::HandSystem, "hand system", 1, 1, 2, HAND_SYSTEMS).when(Key::Unit, 1, 1).optional(),
];
/// Data of a point in an answer.
pub const POINT_DATA_ANSWER: Layout = &[
    Field::bits(Key::Unit, "unit", 3, 0, 1, UNITS),
    Field::bits(Key::HandSystem, "hand system", 3, 1, 2, HAND_SYSTEMS).when(Key::Unit, 1, 1).optional(),
];
/// Coordinates of a point, in the unit of the point.
pub const COORDINATES: Layout =
    &joined(&when(&per_axis(4, PULSE), Key::Unit, 0), &when(&per_axis(4, MM), Key::Unit, 1));
/// Comment of a point.
pub const COMMENT: Layout = &[Field::text(Key::Comment, "comment", 4, Charset::Comment)];
/// Pallet number.
pub const PALLET: Layout = &[Field::number(Key::Pallet, "pallet", 2).within(PALLETS)];
/// Numbers of rows, columns and layers, and the number of the first of the five points. In the manual, the ranges begin
/// at 0, but the product of the three numbers must be at least 1.
pub const PALLET_DATA: Layout = &[
    Field::number(Key::CountX, "places in X", 3).within(&[(0, 32_767)]),
    Field::number(Key::CountY, "places in Y", 4).within(&[(0, 32_767)]),
    Field::number(Key::CountZ, "places in Z", 5).within(&[(0, 32_767)]),
    Field::number(Key::FirstPoint, "first point", 6).within(&[(0, 29_995)]),
];
/// Coordinates of a shift.
pub const SHIFT_DATA: Layout = &per_axis(4, MM);
/// Robot of a hand.
pub const HAND_OWNER: Layout = &[Field::number(Key::Owner, "robot", 3)];
/// Data of a hand. The manual has two scales for data 1: no scale in the text, and 1000 in the examples (4.3.5). armctl
/// uses the raw value.
pub const HAND_DATA: Layout = &[
    Field::long(Key::Data1, "data 1", 4, PLAIN),
    Field::long(Key::Data2, "data 2", 6, MM),
    Field::long(Key::Data3, "data 3", 8, MM),
    Field::long(Key::Data4, "data 4 (1: on the R axis)", 10, PLAIN).within(&[(0, 1)]),
];

// Arithmetic (4.4).

/// A static variable.
pub const VARIABLE: Layout = &[Field::word(Key::Variable, "variable", 2, Show::Variable).within(VARIABLES)];
/// Static variable on the right side of the operation.
pub const VARIABLE_2: Layout = &[Field::word(Key::Variable2, "variable 2", 4, Show::Variable).within(VARIABLES)];
/// Value of a variable. Its format depends on the kind of the variable.
pub const VARIABLE_VALUE: Layout = &[
    Field::long(Key::Value, "value", 4, PLAIN).when(Key::Variable, 0, 31),
    Field::real(Key::Value, "value", 4).when(Key::Variable, 256, 287),
];
/// A parameter of an axis, or of the robot.
pub const PARAMETER: Layout = &[
    Field::word(Key::Parameter, "parameter", 2, Show::Choice(&parameter::NAMES)),
    Field::bits(Key::Axes, "axis", 3, 0, 4, Show::Set { least: 0, most: 1 }).optional(),
];
/// Value of a parameter.
pub const PARAMETER_VALUE: Layout = &[Field::long(Key::Value, "value", 4, PLAIN)];
/// Numbers of two points.
pub const TWO_POINTS: Layout =
    &[Field::number(Key::Point, "point 1", 2).within(POINTS), Field::number(Key::Point2, "point 2", 3).within(POINTS)];
/// Position on a pallet, as the source of a copy.
pub const PALLET_PLACE: Layout = &[
    Field::number(Key::Pallet, "pallet", 3).within(PALLETS),
    Field::number(Key::WorkPosition, "work position", 4).within(COUNTS),
];
/// One of the six elements of a point.
pub const POINT_ELEMENT: Layout = &[Field::bits(Key::Element, "element", 3, 0, 6, ONE)];
/// One of the four elements of a shift.
pub const SHIFT_ELEMENT: Layout = &[Field::bits(Key::Element, "element", 3, 0, 4, ONE)];
/// A number in pulses.
pub const VALUE_PULSE: Layout = &[Field::long(Key::Value, "value", 4, PULSE)];
/// A number in mm.
pub const VALUE_MM: Layout = &[Field::long(Key::Value, "value", 4, MM)];

// Ports (4.5). A port number is BCD: two decimal digits of four bits each. Its range depends on the port type.

const OUTPUTS: &[(i32, i32)] = &[(2, 7), (10, 17), (20, 27)];
const INPUTS_OR_OUTPUTS: &[(i32, i32)] = &[(0, 7), (10, 17), (20, 27)];

const fn port_number(least_type: i32, most_type: i32, spans: &'static [(i32, i32)]) -> Field {
    Field::bits(Key::Port, "port", 2, 4, 8, Show::Digits).within(spans).when(Key::PortType, least_type, most_type)
}

/// An output port to write.
pub const OUTPUT_PORT: Layout = &[
    Field::bits(Key::PortType, "port type", 2, 12, 4, OUTPUT_PORTS),
    port_number(1, 2, OUTPUTS),
    port_number(3, 3, &[(0, 1)]),
    port_number(4, 4, &[(0, 0)]),
    port_number(6, 6, OUTPUTS),
];
/// A port to read.
pub const PORT: Layout = &[
    Field::bits(Key::PortType, "port type", 2, 12, 4, PORTS),
    port_number(0, 2, INPUTS_OR_OUTPUTS),
    port_number(3, 3, &[(0, 1)]),
    port_number(4, 4, &[(0, 0)]),
    port_number(5, 6, INPUTS_OR_OUTPUTS),
];
/// A bit of a port.
pub const PORT_BIT: Layout = &[Field::bits(Key::PortBit, "bit", 2, 0, 4, NUMBER).within(&[(0, 7)])];
/// Eight signals of a port. Bit 0 is the signal with the lowest number.
pub const PORT_VALUE: Layout = &[Field::bits(Key::Value, "value", 3, 0, 8, NUMBER)];
/// State of one signal.
pub const BIT_VALUE: Layout = &[Field::bits(Key::Value, "value", 3, 0, 8, NUMBER).within(&[(0, 1)])];

// Programs (4.6).

const PROGRAMS: &[(i32, i32)] = &[(1, 100)];
const TASKS: &[(i32, i32)] = &[(1, 16)];

const fn selection(choices: &'static [(u16, &'static str)]) -> Field {
    Field::bits(Key::Selection, "chosen by", 1, 0, 3, Show::Choice(choices))
}

const BY_PROGRAM: Field = Field::number(Key::Program, "program", 2).within(PROGRAMS).sets(Key::Selection, 1);
const BY_TASK: Field = Field::number(Key::Task, "task", 3).within(TASKS).sets(Key::Selection, 2);
const BY_NAME: Field = Field::text(Key::ProgramName, "program name", 6, Charset::Program).sets(Key::Selection, 4);

/// Program to register in a task. Task 0 means the vacant task with the lowest number.
pub const DESIGNATION: Layout = &[
    selection(&[SELECT[1], SELECT[3]]),
    BY_PROGRAM,
    Field::number(Key::Task, "task", 3).within(&[(0, 16)]).optional(),
    Field::number(Key::Priority, "priority", 4).within(&[(1, 64)]),
    BY_NAME,
];
/// A program, or all programs.
pub const PROGRAM_OR_ALL: Layout = &[selection(&SELECT), BY_PROGRAM, BY_TASK, BY_NAME];
/// A program, which is selected by its number, its task or its name.
pub const PROGRAM: Layout = &[selection(&[SELECT[1], SELECT[2], SELECT[3]]), BY_PROGRAM, BY_TASK, BY_NAME];
/// State of a program.
pub const PROGRAM_STATE: Layout = &[
    Field::number(Key::Program, "program", 2),
    Field::number(Key::Task, "task", 3),
    Field::word(Key::Line, "line", 4, Show::Line),
    Field::number(Key::Priority, "priority", 5),
    Field::text(Key::ProgramName, "program name", 6, Charset::Program),
];

// Information (4.7).

/// Software versions.
pub const VERSIONS: Layout = &[
    Field::word(Key::HostVersion, "host version", 2, Show::Version),
    Field::word(Key::HostRevision, "host revision", 3, Show::Revision),
    Field::word(Key::FpgaVersion, "driver FPGA version", 4, Show::FpgaVersion),
    Field::word(Key::DriverVersion1, "axis 1 driver version", 5, Show::Version),
    Field::word(Key::DriverVersion2, "axis 2 driver version", 6, Show::Version),
    Field::word(Key::DriverVersion3, "axis 3 driver version", 7, Show::Version),
    Field::word(Key::DriverVersion4, "axis 4 driver version", 8, Show::Version),
];

const fn word_per_axis(first: usize, show: Show) -> [Field; 4] {
    [
        Field::word(Key::Axis1, "axis 1", first, show),
        Field::word(Key::Axis2, "axis 2", first + 1, show),
        Field::word(Key::Axis3, "axis 3", first + 2, show),
        Field::word(Key::Axis4, "axis 4", first + 3, show),
    ]
}

/// Model number of a robot.
pub const ROBOT_TYPE: Layout = &[Field::number(Key::RobotType, "robot type", 2)];
/// Model number of each axis.
pub const AXIS_TYPES: Layout = &word_per_axis(4, NUMBER);
/// Servo state of each axis.
pub const SERVO_STATUS: Layout = &word_per_axis(2, SERVO_STATES);
/// Servo state of the two reserved axes. Its value is always 9.
pub const RESERVED_SERVO_STATUS: Layout = &[
    Field::word(Key::Axis5, "axis 5 (reserved)", 6, SERVO_STATES).optional(),
    Field::word(Key::Axis6, "axis 6 (reserved)", 7, SERVO_STATES).optional(),
];
/// Whether the controller sends the answer continuously until the status reset.
pub const CONTINUOUS: Layout =
    &[Field::bits(Key::Continuous, "continuous output", 1, 0, 1, Show::Choice(&[(0, "off"), (1, "on")])).optional()];
/// Current position of each axis, in pulses.
pub const POSITION_PULSE: Layout = &per_axis(4, PULSE);
/// Current position of each axis, in mm.
pub const POSITION_MM: Layout = &per_axis(4, MM);
/// Hand system of the position. Bit 0 is not used, although the example in the manual has 1 in this bit.
pub const POSITION_HAND_SYSTEM: Layout =
    &[Field::bits(Key::HandSystem, "hand system", 3, 1, 2, HAND_SYSTEMS).optional()];
/// Half of the tasks: the first eight or the last eight.
pub const TASK_RANGE: Layout = &[Field::word(Key::TaskRange, "tasks", 2, TASK_RANGES)];

const fn per_task(show: Show) -> [Field; 8] {
    [
        Field::word(Key::Task1, "task 1 or 9", 2, show),
        Field::word(Key::Task2, "task 2 or 10", 3, show),
        Field::word(Key::Task3, "task 3 or 11", 4, show),
        Field::word(Key::Task4, "task 4 or 12", 5, show),
        Field::word(Key::Task5, "task 5 or 13", 6, show),
        Field::word(Key::Task6, "task 6 or 14", 7, show),
        Field::word(Key::Task7, "task 7 or 15", 8, show),
        Field::word(Key::Task8, "task 8 or 16", 9, show),
    ]
}

/// State of eight tasks.
pub const TASK_STATUS: Layout = &per_task(TASK_STATES);
/// Current lines of eight tasks; 0 means no task.
pub const TASK_LINES: Layout = &per_task(Show::Line);
/// Number of an entry in the alarm history.
pub const HISTORY: Layout = &[Field::number(Key::History, "history number", 2).within(&[(1, 500)])];
/// An alarm and its source.
pub const ALARM: Layout = &[
    Field::number(Key::AlarmGroup, "alarm group", 1),
    Field::number(Key::AlarmCategory, "alarm category", 2),
    Field::bits(Key::Place1, "place 1", 3, 8, 8, PLACES_1),
    Field::bits(Key::Place1Number, "place 1 number", 3, 0, 8, NUMBER),
    Field::bits(Key::Place2, "place 2", 4, 8, 8, PLACES_2),
    Field::bits(Key::Place2Number, "place 2 number", 4, 0, 8, NUMBER),
];
/// The three speed settings of a robot.
pub const SPEED_STATUS: Layout = &[
    Field::word(Key::AutoSpeed, "automatic speed", 2, PERCENTS),
    Field::word(Key::ManualSpeed, "manual speed", 3, PERCENTS),
    Field::word(Key::ProgramSpeed, "program speed", 4, PERCENTS),
];
/// Type of the motors whose origin status is requested. It is valid only with a robot.
pub const MOTOR_TYPE: Layout =
    &[Field::bits(Key::MotorType, "motor type", 2, 0, 3, MOTOR_TYPES).when(Key::Robot, 1, 4).optional()];

const fn origin(key: Key, name: &'static str, word: usize) -> Field {
    Field::word(key, name, word, ORIGIN_STATES).when(Key::Robot, 1, 4)
}

/// Origin status. For robot 0, it is the status of the whole system. For other robots, it is the status of each axis.
pub const ORIGIN_STATUS: Layout = &[
    Field::word(Key::System, "whole system", 2, ORIGIN_STATES).when(Key::Robot, 0, 0),
    origin(Key::Axis1, "axis 1", 2),
    origin(Key::Axis2, "axis 2", 3),
    origin(Key::Axis3, "axis 3", 4),
    origin(Key::Axis4, "axis 4", 5),
    origin(Key::Axis5, "axis 5 (reserved)", 6).optional(),
    origin(Key::Axis6, "axis 6 (reserved)", 7).optional(),
];
/// Selected axes. An empty set means all axes.
pub const SOME_AXES: Layout = &[Field::bits(Key::Axes, "axes", 2, 0, 4, Show::Set { least: 0, most: 4 }).optional()];
/// Torque of each axis. The sign is the direction of the torque. The manual does not specify the format, so two's
/// complement is an assumption.
pub const TORQUES: Layout = &[
    Field::short(Key::Axis1, "axis 1", 2, PERCENT),
    Field::short(Key::Axis2, "axis 2", 3, PERCENT),
    Field::short(Key::Axis3, "axis 3", 4, PERCENT),
    Field::short(Key::Axis4, "axis 4", 5, PERCENT),
];
/// Date with a two-digit year.
pub const DATE: Layout = &[
    Field::number(Key::Year, "year", 2).within(&[(0, 99)]),
    Field::number(Key::Month, "month", 3).within(&[(1, 12)]),
    Field::number(Key::Day, "day", 4).within(&[(1, 31)]),
];
/// A time of day.
pub const TIME: Layout = &[
    Field::number(Key::Hour, "hour", 2).within(&[(0, 23)]),
    Field::number(Key::Minute, "minute", 3).within(&[(0, 59)]),
    Field::number(Key::Second, "second", 4).within(&[(0, 59)]),
];
/// Number of a controller.
pub const CONTROLLER: Layout = &[Field::number(Key::Controller, "controller", 2).within(&[(1, 4)])];
/// Modules in the option slots. The manual has no code for PROFINET.
pub const SLOTS: Layout = &[
    Field::word(Key::Slot1, "option slot 1", 2, MODULES),
    Field::word(Key::Slot2, "option slot 2", 3, MODULES),
    Field::word(Key::Slot3, "option slot 3", 4, MODULES),
    Field::word(Key::Slot4, "option slot 4", 5, MODULES),
];
