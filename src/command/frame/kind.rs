//! What values arguments have.

use crate::settings::target::Family;

/// A kind of value that has candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueKind {
    /// A robot of the inventory.
    Robot,
    /// A robot of the inventory, or a target URL.
    RobotOrUrl,
    /// A robot whose link a session holds.
    Session,
    /// A tag of the inventory.
    Tag,
    /// A target URL.
    Url,
    /// A family.
    Family,
    /// A topic of `help`, or the words of a command.
    HelpWord,
    /// The name of a report.
    Schema,
    /// A code that `explain` explains.
    Code(Family),
    /// A job of a yerc controller.
    YercJob,
    /// A file of a yerc controller.
    YercFile,
    /// The beginning of a reference to variables of a yerc controller: `B`.
    YercVariable,
    /// A parameter of a Toyo controller, by name or id.
    ToyoParameter,
    /// The instruction of a step of a Toyo program.
    ToyoInstruction,
    /// A record of a palletizing program.
    ToyoRecord,
    /// A dedicated signal that a YRCX is shown.
    YrcxInput,
    /// The same with the state to set.
    YrcxInputState,
    /// A dedicated signal that a YRCX shows.
    YrcxOutput,
    /// A port of a YRCX.
    YrcxPort,
    /// A port of a YRCX that can be switched.
    YrcxOutputPort,
    /// A parameter of a YRCX.
    YrcxParameter,
    /// A task of a YRCX.
    YrcxTask,
    /// A program of a YRCX by its number.
    YrcxProgram,
    /// A program of a YRCX by its name.
    YrcxProgramName,
    /// A static variable of a YRCX.
    YrcxVariable,
}
