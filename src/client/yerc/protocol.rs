//! Requests, answers and values of the protocol, so that an application needs no other crate.

pub use armctl_controller::yerc::Model;
pub use armctl_controller::yerc::files::{FileName, FileNameError, FileType, list, split_list};
pub use armctl_controller::yerc::group::Group;
pub use armctl_controller::yerc::payload::{
    Alarm, AlarmTexts, Axes, AxisNames, BasePosition, CartesianMove, ControllerStatus, CycleMode, ExtendedForm,
    ExternalPosition, Form, JobInfo, ManagementTime, MoveLayout, PayloadError, Pose, Position, PositionKind, PulseMove,
    Speed, SpeedClass, StatusBit, SystemInfo, Text, TextError,
};
pub use armctl_controller::yerc::query::{
    AlarmClass, CancelError, Coordinates, Hlock, Hold, MoveCartesian, MoveKind, MovePulse, Query, QueryError,
    ReadAlarm, ReadAlarmHistory, ReadAxes, ReadField, ReadIo, ReadIoGroups, ReadJob, ReadManagementTime, ReadPosition,
    ReadPositionError, ReadRegister, ReadRegisters, ReadStatus, ReadSystemInfo, ReadTorque, ReadVariable,
    ReadVariables, ResetAlarm, Say, SelectJob, Selection, Servo, SetCycle, StartJob, SystemPart, TimeCounter,
    WriteField, WriteIo, WriteIoGroups, WriteQuery, WriteRegister, WriteRegisters, WriteVariable, WriteVariables,
};
pub use armctl_controller::yerc::request::{Request, RequestError};
pub use armctl_controller::yerc::session::{Counters, DownloadEnd, Reply, UploadEnd, Violation};
pub use armctl_controller::yerc::simulator::Start;
pub use armctl_controller::yerc::status::{Explanation, explain};
pub use armctl_controller::yerc::variables::{Value, VariableKind};
pub use armctl_controller::yerc::wire::Status;
