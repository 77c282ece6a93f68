//! Rows of the command table, in the order of the codes.

use super::{DurationClass, Row, Rule, layouts};
use crate::Risk;

/// Declares the commands and their rows.
macro_rules! commands {
    ($($command:ident $code:literal $id:literal $section:literal $name:literal $kind:ident
        [$($request:ident)*] [$($answer:ident)*] $([$($rule:ident)*])?;)*) => {
        /// A remote command. "Set", "select" and arithmetic commands change data; see [`Row::risk`].
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Command {
            $(#[doc = concat!($section, ": ", $name, ".")] $command,)*
        }

        /// All commands, in ascending order of their codes.
        pub const ROWS: &[Row] = &[$(Row {
            command: Command::$command,
            code: $code,
            id: $id,
            name: $name,
            section: $section,
            risk: $kind.0,
            pace: $kind.1,
            request: &[$(layouts::$request),*],
            answer: &[$(layouts::$answer),*],
            rules: &[$($(Rule::$rule),*)?],
        },)*];
    };
}

const READ: (Risk, DurationClass) = (Risk::Read, DurationClass::Quick);
const WRITE: (Risk, DurationClass) = (Risk::Write, DurationClass::Quick);
/// Risk and pace of a command that overwrites data made by a person.
const DESTROY: (Risk, DurationClass) = (Risk::Destroy, DurationClass::Quick);
/// Risk and pace of power on, power off and brake release: an axis may drop.
const POWER: (Risk, DurationClass) = (Risk::Motion, DurationClass::Power);
const MOTION: (Risk, DurationClass) = (Risk::Motion, DurationClass::Motion);
const JOG: (Risk, DurationClass) = (Risk::Motion, DurationClass::Jog);
/// Risk and pace of a program start. The command ends when the controller accepts the start.
const START: (Risk, DurationClass) = (Risk::Motion, DurationClass::Quick);

commands! {
    StatusReset 0x000 "status-reset" "4.1" "reset the status" READ [] [];

    MovePtp 0x001 "move-ptp" "4.2.1" "move to a point, point to point" MOTION
        [ROBOT AXES SPEED ACCEL REPORT TO_POINT] [POSITIONS];
    MoveArch 0x002 "move-arch" "4.2.1" "move to a point in an arch" MOTION
        [ROBOT AXES SPEED REPORT TO_POINT ARCH] [POSITIONS];
    MoveLinear 0x003 "move-linear" "4.2.1" "move to a point on a straight line" MOTION
        [ROBOT AXES LINEAR_SPEED ACCEL REPORT TO_POINT] [POSITIONS];
    MoveCircular 0x004 "move-circular" "4.2.1" "move on an arc through two points" MOTION
        [ROBOT LINEAR_SPEED ACCEL REPORT TO_ARC] [POSITIONS];
    MoveMm 0x006 "move-mm" "4.2.1" "move to coordinates in mm, point to point" MOTION
        [ROBOT AXES SPEED HAND_SYSTEM REPORT TARGETS_MM] [POSITIONS];
    MovePulse 0x007 "move-pulse" "4.2.1" "move to coordinates in pulses, point to point" MOTION
        [ROBOT AXES SPEED REPORT TARGETS_PULSE] [POSITIONS];
    MoveiPtp 0x009 "movei-ptp" "4.2.2" "move by a point's distances, point to point" MOTION
        [ROBOT AXES SPEED ACCEL REPORT TO_POINT] [POSITIONS];
    MoveiLinear 0x00A "movei-linear" "4.2.2" "move by a point's distances on a straight line" MOTION
        [ROBOT AXES LINEAR_SPEED ACCEL REPORT TO_POINT] [POSITIONS];
    MoveiMm 0x00E "movei-mm" "4.2.2" "move by distances in mm, point to point" MOTION
        [ROBOT AXES SPEED HAND_SYSTEM REPORT TARGETS_MM] [POSITIONS];
    MoveiPulse 0x00F "movei-pulse" "4.2.2" "move by distances in pulses, point to point" MOTION
        [ROBOT AXES SPEED REPORT TARGETS_PULSE] [POSITIONS];
    DrivePoint 0x010 "drive-point" "4.2.3" "move an axis to a point" MOTION
        [ROBOT ONE_AXIS SPEED REPORT TO_POINT] [POSITIONS];
    DriveMm 0x012 "drive-mm" "4.2.3" "move an axis to a position in mm" MOTION
        [ROBOT ONE_AXIS SPEED REPORT TARGET_MM] [POSITIONS];
    DrivePulse 0x013 "drive-pulse" "4.2.3" "move an axis to a position in pulses" MOTION
        [ROBOT ONE_AXIS SPEED REPORT TARGET_PULSE] [POSITIONS];
    DriveiPoint 0x014 "drivei-point" "4.2.4" "move an axis by a point's distance" MOTION
        [ROBOT ONE_AXIS SPEED REPORT TO_POINT] [POSITIONS];
    DriveiMm 0x016 "drivei-mm" "4.2.4" "move an axis by a distance in mm" MOTION
        [ROBOT ONE_AXIS SPEED REPORT DISTANCE_MM] [POSITIONS];
    DriveiPulse 0x017 "drivei-pulse" "4.2.4" "move an axis by a distance in pulses" MOTION
        [ROBOT ONE_AXIS SPEED REPORT DISTANCE_PULSE] [POSITIONS];
    PalletPtp 0x018 "pallet-ptp" "4.2.5" "move to a pallet position, point to point" MOTION
        [ROBOT SPEED ACCEL REPORT TO_PALLET] [POSITIONS];
    PalletArch 0x019 "pallet-arch" "4.2.5" "move to a pallet position in an arch" MOTION
        [ROBOT SPEED REPORT TO_PALLET ARCH] [POSITIONS];
    JogPulse 0x020 "jog-pulse" "4.2.6" "jog an axis" JOG [ROBOT AXIS DIRECTION REPORT] [POSITIONS];
    JogCartesian 0x021 "jog-cartesian" "4.2.6" "jog along a Cartesian axis" JOG
        [ROBOT AXIS DIRECTION REPORT] [POSITIONS];
    JogTool 0x022 "jog-tool" "4.2.6" "jog along an axis of the tool" JOG [ROBOT AXIS DIRECTION REPORT] [POSITIONS];
    InchPulse 0x024 "inch-pulse" "4.2.7" "inch an axis" MOTION [ROBOT AXIS DIRECTION REPORT] [POSITIONS];
    InchCartesian 0x025 "inch-cartesian" "4.2.7" "inch along a Cartesian axis" MOTION
        [ROBOT AXIS DIRECTION REPORT] [POSITIONS];
    InchTool 0x026 "inch-tool" "4.2.7" "inch along an axis of the tool" MOTION
        [ROBOT AXIS DIRECTION REPORT] [POSITIONS];
    InchAmountSet 0x027 "inch-amount-set" "4.2.8" "set the inching amount" WRITE [ROBOT INCHING_AMOUNT] [];
    Teach 0x028 "teach" "4.2.9" "store the position in a point" DESTROY [ROBOT TEACH] [];
    AbsoluteResetMove 0x030 "absolute-reset-move" "4.2.10" "move an axis to a position where absolute reset is \
                                                            possible" MOTION
        [ROBOT AXIS DIRECTION] [];
    AbsoluteReset 0x031 "absolute-reset" "4.2.11" "reset the absolute position of an axis" DESTROY [ROBOT AXIS] [];
    OriginRobot 0x032 "origin-robot" "4.2.12" "return to origin, by robot" MOTION [ROBOT_OR_ALL ORIGIN_AXES] [];
    OriginAxis 0x033 "origin-axis" "4.2.12" "return to origin, one axis" MOTION [ROBOT AXIS] [];
    ServoOn 0x034 "servo-on" "4.2.13" "switch servos on" POWER [ROBOT AXIS_OR_ALL] [];
    ServoOff 0x035 "servo-off" "4.2.13" "switch servos off" POWER [ROBOT AXIS_OR_ALL] [];
    ServoFree 0x036 "servo-free" "4.2.13" "switch servos off and release brakes" POWER [ROBOT AXIS_OR_ALL] [];
    SpeedManual 0x038 "speed-manual" "4.2.14" "set the manual speed" WRITE [ROBOT SPEED_SETTING] [];
    SpeedAuto 0x039 "speed-auto" "4.2.15" "set the automatic speed" WRITE [ROBOT SPEED_SETTING] [];
    SpeedProgram 0x03A "speed-program" "4.2.16" "set the program speed" WRITE [ROBOT SPEED_SETTING] [];
    ShiftSelect 0x03B "shift-select" "4.2.17" "select a shift" WRITE [ROBOT SHIFT] [];
    HandSelect 0x03C "hand-select" "4.2.18" "select a hand" WRITE [ROBOT HAND] [];
    ArmSelect 0x03D "arm-select" "4.2.19" "select the hand system of the arm" WRITE [ROBOT ARM] [];
    MotorOff 0x041 "motor-off" "4.2.20" "switch motor power and servos off" POWER [] [];
    MotorOn 0x042 "motor-on" "4.2.20" "switch motor power and servos on" POWER [] [];
    MotorPower 0x043 "motor-pwr" "4.2.20" "switch motor power on" POWER [] [];
    MovetPtp 0x044 "movet-ptp" "4.2.21" "move to a point in tool coordinates, point to point" MOTION
        [ROBOT AXES SPEED ACCEL REPORT TO_POINT] [POSITIONS];
    MovetLinear 0x045 "movet-linear" "4.2.21" "move to a point in tool coordinates on a straight line" MOTION
        [ROBOT AXES LINEAR_SPEED ACCEL REPORT TO_POINT] [POSITIONS];
    TorqueLimit 0x048 "torque-limit" "4.2.22" "limit the torque of an axis" WRITE [ROBOT TORQUE_LIMIT] [];
    PushPoint 0x04B "push-point" "4.2.23" "push an axis towards a point" MOTION
        [ROBOT ONE_AXIS SPEED PUSH REPORT TO_POINT] [PUSH_RESULT POSITIONS];
    PushMm 0x04C "push-mm" "4.2.23" "push an axis towards a position in mm" MOTION
        [ROBOT ONE_AXIS SPEED PUSH REPORT TARGET_MM] [PUSH_RESULT POSITIONS];
    PushPulse 0x04D "push-pulse" "4.2.23" "push an axis towards a position in pulses" MOTION
        [ROBOT ONE_AXIS SPEED PUSH REPORT TARGET_PULSE] [PUSH_RESULT POSITIONS];

    PointSet 0x100 "point-set" "4.3.1" "define a point" DESTROY [POINT_DATA POINT COORDINATES] [];
    PointGet 0x101 "point-get" "4.3.1" "read a point" READ [POINT] [POINT POINT_DATA_ANSWER COORDINATES];
    CommentSet 0x104 "comment-set" "4.3.2" "define a point's comment" DESTROY [POINT COMMENT] [];
    CommentGet 0x105 "comment-get" "4.3.2" "read a point's comment" READ [POINT] [POINT COMMENT];
    PalletSet 0x108 "pallet-set" "4.3.3" "define a pallet" DESTROY [PALLET PALLET_DATA] [] [PalletSize];
    PalletGet 0x109 "pallet-get" "4.3.3" "read a pallet" READ [PALLET] [PALLET PALLET_DATA];
    ShiftSet 0x10C "shift-set" "4.3.4" "define a shift" DESTROY [SHIFT SHIFT_DATA] [];
    ShiftGet 0x10D "shift-get" "4.3.4" "read a shift" READ [SHIFT] [SHIFT SHIFT_DATA];
    HandSet 0x110 "hand-set" "4.3.5" "define a hand" DESTROY [ROBOT HAND HAND_DATA] [];
    HandGet 0x111 "hand-get" "4.3.5" "read a hand" READ [HAND] [HAND HAND_OWNER HAND_DATA];

    VarSet 0x200 "var-set" "4.4.1" "set a variable to a number" WRITE [VARIABLE VARIABLE_VALUE] [];
    VarSetVar 0x201 "var-set-var" "4.4.1" "set a variable to the value of a variable" WRITE [VARIABLE VARIABLE_2] [];
    VarAdd 0x204 "var-add" "4.4.1" "add a number to a variable" WRITE [VARIABLE VARIABLE_VALUE] [];
    VarAddVar 0x205 "var-add-var" "4.4.1" "add a variable to a variable" WRITE [VARIABLE VARIABLE_2] [];
    VarSub 0x208 "var-sub" "4.4.1" "subtract a number from a variable" WRITE [VARIABLE VARIABLE_VALUE] [];
    VarSubVar 0x209 "var-sub-var" "4.4.1" "subtract a variable from a variable" WRITE [VARIABLE VARIABLE_2] [];
    VarMul 0x20C "var-mul" "4.4.1" "multiply a variable by a number" WRITE [VARIABLE VARIABLE_VALUE] [];
    VarMulVar 0x20D "var-mul-var" "4.4.1" "multiply a variable by a variable" WRITE [VARIABLE VARIABLE_2] [];
    VarDiv 0x210 "var-div" "4.4.1" "divide a variable by a number" WRITE [VARIABLE VARIABLE_VALUE] [];
    VarDivVar 0x211 "var-div-var" "4.4.1" "divide a variable by a variable" WRITE [VARIABLE VARIABLE_2] [];
    VarGet 0x214 "var-get" "4.4.1" "read a variable" READ [VARIABLE] [VARIABLE VARIABLE_VALUE];
    ParamSet 0x220 "param-set" "4.4.2" "set a parameter" DESTROY [ROBOT PARAMETER PARAMETER_VALUE] []
        [ParameterAxis ParameterValue];
    ParamGet 0x224 "param-get" "4.4.2" "read a parameter" READ [ROBOT PARAMETER] [PARAMETER PARAMETER_VALUE]
        [ParameterAxis];
    PointCopy 0x230 "point-copy" "4.4.3" "copy a point to another point" DESTROY [TWO_POINTS] [];
    PointAdd 0x234 "point-add" "4.4.3" "add a point to a point" DESTROY [TWO_POINTS] [];
    PointSub 0x235 "point-sub" "4.4.3" "subtract a point from a point" DESTROY [TWO_POINTS] [];
    PointPallet 0x238 "point-pallet" "4.4.3" "set a point to a pallet position" DESTROY [POINT PALLET_PLACE] [];
    PointElementPulse 0x240 "point-element-pulse" "4.4.4" "set an element of a point in pulses" DESTROY
        [POINT POINT_ELEMENT VALUE_PULSE] [];
    PointElementMm 0x241 "point-element-mm" "4.4.4" "set an element of a point in mm" DESTROY
        [POINT POINT_ELEMENT VALUE_MM] [];
    ShiftElement 0x245 "shift-element" "4.4.4" "set an element of a shift in mm" DESTROY
        [SHIFT SHIFT_ELEMENT VALUE_MM] [];

    PortSet 0x300 "port-set" "4.5.1" "set the eight signals of a port" WRITE [OUTPUT_PORT PORT_VALUE] [];
    PortSetBit 0x301 "port-set-bit" "4.5.1" "set a signal of a port" WRITE [OUTPUT_PORT PORT_BIT BIT_VALUE] [];
    PortGet 0x304 "port-get" "4.5.1" "read a port" READ [PORT] [PORT PORT_VALUE];

    ProgramSelect 0x401 "program-select" "4.6.1" "register a program in a task" WRITE [DESIGNATION] [];
    ProgramRun 0x402 "program-run" "4.6.2" "run programs" START [PROGRAM_OR_ALL] [];
    ProgramStep 0x403 "program-step" "4.6.2" "run a line of a program" START [PROGRAM] [];
    ProgramSkip 0x404 "program-skip" "4.6.2" "skip a line of a program" START [PROGRAM] [];
    ProgramNext 0x405 "program-next" "4.6.2" "run a line of a program, with complete subroutines" START [PROGRAM] [];
    ProgramReset 0x406 "program-reset" "4.6.3" "reset programs" WRITE [PROGRAM_OR_ALL] [];
    ProgramShow 0x408 "program-show" "4.6.4" "read the state of a program" READ [PROGRAM] [PROGRAM_STATE];

    Versions 0x501 "versions" "4.7.1" "read the software versions" READ [] [VERSIONS];
    System 0x502 "system" "4.7.2" "read the configuration of a robot" READ [ROBOT] [ROBOT_TYPE AXIS_TYPES];
    ServoStatus 0x503 "servo-status" "4.7.3" "read the state of the servos" READ [ROBOT]
        [SERVO_STATUS RESERVED_SERVO_STATUS];
    PositionPulse 0x505 "position-pulse" "4.7.4" "read the position in pulses" READ [ROBOT CONTINUOUS]
        [POSITION_PULSE];
    PositionMm 0x506 "position-mm" "4.7.4" "read the position in mm" READ [ROBOT CONTINUOUS]
        [POSITION_HAND_SYSTEM POSITION_MM];
    TaskStatus 0x507 "task-status" "4.7.5" "read the states of the tasks" READ [TASK_RANGE] [TASK_STATUS];
    TaskLines 0x508 "task-lines" "4.7.6" "read the lines of the tasks" READ [TASK_RANGE] [TASK_LINES];
    AlarmHistory 0x509 "alarm-history" "4.7.7" "read an alarm of the history" READ [HISTORY] [ALARM];
    SpeedStatus 0x50A "speed-status" "4.7.8" "read the speed settings" READ [ROBOT] [SPEED_STATUS];
    ArmDesignation 0x50B "arm-designation" "4.7.9" "read the selected hand system" READ [ROBOT] [ARM];
    ArmStatus 0x50C "arm-status" "4.7.10" "read the hand system of the arm" READ [ROBOT] [ARM];
    OriginStatus 0x50F "origin-status" "4.7.11" "read whether the origin is known" READ [ROBOT_OR_ALL MOTOR_TYPE]
        [ORIGIN_STATUS];
    TorqueOfMax 0x510 "torque-of-max" "4.7.12" "read the torque in % of the maximum" READ [ROBOT SOME_AXES] [TORQUES];
    DateGet 0x511 "date-get" "4.7.13" "read the date" READ [] [DATE];
    TimeGet 0x512 "time-get" "4.7.14" "read the time" READ [] [TIME];
    Slots 0x513 "slots" "4.7.15" "read the contents of the option slots" READ [CONTROLLER] [SLOTS];
    InchAmountGet 0x514 "inch-amount-get" "4.7.16" "read the inching amount" READ [ROBOT] [INCHING_AMOUNT];
    LatestAlarm 0x515 "latest-alarm" "4.7.17" "read the latest alarm of a remote command" READ [] [ALARM];
    TorqueOfRated 0x516 "torque-of-rated" "4.7.18" "read the torque in % of the rated torque" READ [ROBOT SOME_AXES]
        [TORQUES];

    DateSet 0x602 "date-set" "4.8.1" "set the date" WRITE [DATE] [];
    TimeSet 0x603 "time-set" "4.8.2" "set the time" WRITE [TIME] [];
    AlarmReset 0x604 "alarm-reset" "4.8.3" "reset the alarm" WRITE [] [];
}

impl Command {
    /// Row of the table.
    pub const fn row(self) -> &'static Row {
        // The macro creates rows and variants in the same order.
        &ROWS[self as usize]
    }
}
