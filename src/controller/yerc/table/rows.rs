//! Rows of the command table.

use super::fields::{self as data, Field};
use super::spans::{self as at, Instances};
use super::{Action, Attribute, Availability, Plural, RiskRule, Row, Service, service};
use crate::Risk;
use crate::yerc::wire::Division;

/// Section that identifies the row of the batch backup.
pub(super) const BATCH_BACKUP_SECTION: &str = "3.4.5";

const READ: RiskRule = RiskRule::Always(Risk::Read);
const WRITE: RiskRule = RiskRule::Always(Risk::Write);
const DESTROY: RiskRule = RiskRule::Always(Risk::Destroy);
const MOTION: RiskRule = RiskRule::Always(Risk::Motion);

const fn get_single(attribute: Attribute) -> Service {
    let (number, meaning) = (service::GET_SINGLE, "read one field (Get_Attribute_Single)");
    Service { number, meaning, action: Action::Read, attribute, risk: READ }
}

const fn get_all(attribute: Attribute) -> Service {
    let (number, meaning) = (service::GET_ALL, "read all fields (Get_Attribute_All)");
    Service { number, meaning, action: Action::Read, attribute, risk: READ }
}

const fn set_single(attribute: Attribute, risk: RiskRule) -> Service {
    let (number, meaning) = (service::SET_SINGLE, "write one field (Set_Attribute_Single)");
    Service { number, meaning, action: Action::Write, attribute, risk }
}

const fn set_all(attribute: Attribute, risk: RiskRule) -> Service {
    let (number, meaning) = (service::SET_ALL, "write all fields (Set_Attribute_All)");
    Service { number, meaning, action: Action::Write, attribute, risk }
}

const fn file(number: u8, meaning: &'static str, action: Action, risk: RiskRule) -> Service {
    Service { number, meaning, action, attribute: Attribute::Zero, risk }
}

const READ_FIELDS: &[Service] = &[get_single(Attribute::Field), get_all(Attribute::Zero)];
const IO: &[Service] = &[get_single(Attribute::One), set_single(Attribute::One, WRITE)];
/// Service 0x02 with attribute 0 is the form in section 3.2.2. The table of the command itself has service 0x10 with
/// attribute 1.
const REGISTER: &[Service] =
    &[get_single(Attribute::One), set_single(Attribute::One, WRITE), set_all(Attribute::Zero, WRITE)];
const VARIABLE: &[Service] = &[
    get_single(Attribute::One),
    get_all(Attribute::OneOrZero),
    set_single(Attribute::One, WRITE),
    set_all(Attribute::OneOrZero, WRITE),
];
/// Services of position variables. A write overwrites taught data.
const POSITION: &[Service] = &[
    get_single(Attribute::Field),
    get_all(Attribute::Zero),
    set_single(Attribute::Field, DESTROY),
    set_all(Attribute::Zero, DESTROY),
];
const SET_ONE: &[Service] = &[set_single(Attribute::One, WRITE)];
const SWITCH: &[Service] = &[set_single(Attribute::One, RiskRule::Switches)];
const START: &[Service] = &[set_single(Attribute::One, MOTION)];
const SELECT: &[Service] = &[set_all(Attribute::Zero, WRITE)];
const MOVE: &[Service] = &[set_all(Attribute::One, MOTION)];
const PLURAL: &[Service] = &[READ_PLURAL, write_plural(WRITE)];
const POSITIONS: &[Service] = &[READ_PLURAL, write_plural(DESTROY)];
const READ_PLURAL: Service = Service {
    number: service::READ_PLURAL,
    meaning: "read several elements",
    action: Action::Read,
    attribute: Attribute::Zero,
    risk: READ,
};

const fn write_plural(risk: RiskRule) -> Service {
    let (number, meaning) = (service::WRITE_PLURAL, "write several elements");
    Service { number, meaning, action: Action::Write, attribute: Attribute::Zero, risk }
}

type Text = &'static str;

const fn row(
    number: u16,
    section: Text,
    name: Text,
    services: &'static [Service],
    instances: Instances,
    fields: &'static [Field],
) -> Row {
    Row {
        number,
        division: Division::Robot,
        name,
        section,
        availability: Availability::Both,
        services,
        instances,
        fields,
        alternative: None,
        plural: None,
    }
}

const fn plural(
    number: u16,
    section: Text,
    name: Text,
    instances: Instances,
    fields: &'static [Field],
    max: u16,
) -> Row {
    Row { plural: Some(Plural { max, even: false }), ..row(number, section, name, PLURAL, instances, fields) }
}

/// Gives the write services of a row the risk "destroy", because they overwrite taught data.
const fn taught(row: Row) -> Row {
    Row { services: POSITIONS, ..row }
}

const fn even(row: Row) -> Row {
    match row.plural {
        Some(Plural { max, .. }) => Row { plural: Some(Plural { max, even: true }), ..row },
        None => row,
    }
}

const fn since_fs114(row: Row) -> Row {
    Row { availability: Availability::Fs114, ..row }
}

const fn dx200(row: Row) -> Row {
    Row { availability: Availability::Dx200, ..row }
}

const fn files(section: Text, name: Text, services: &'static [Service], fields: &'static [Field]) -> Row {
    Row { division: Division::File, ..row(0, section, name, services, at::FILES, fields) }
}

/// All robot commands by number, then the file services.
#[rustfmt::skip]
pub const ROWS: &[Row] = &[
    row(0x70, "3.3.1", "alarm read", READ_FIELDS, at::ALARMS, data::ALARM),
    row(0x71, "3.3.2", "alarm history read", READ_FIELDS, at::HISTORY, data::ALARM),
    row(0x72, "3.3.3", "status read", READ_FIELDS, at::STATUS, data::STATUS),
    row(0x73, "3.3.4", "executing job read", READ_FIELDS, at::TASKS, data::JOB),
    row(0x74, "3.3.5", "axis configuration read", READ_FIELDS, at::AXES, data::AXIS_NAMES),
    row(0x75, "3.3.6", "robot position read", READ_FIELDS, at::POSITIONS, data::POSITION),
    row(0x76, "3.3.7", "position error read", READ_FIELDS, at::GROUPS, data::POSITION_ERROR),
    row(0x77, "3.3.8", "torque read", READ_FIELDS, at::GROUPS, data::TORQUE),
    row(0x78, "3.3.9", "I/O read and write", IO, at::IO, data::IO),
    row(0x79, "3.3.10", "register read and write", REGISTER, at::REGISTERS, data::REGISTER),
    row(0x7A, "3.3.11", "byte variable (B) read and write", VARIABLE, at::VARIABLES, data::B),
    row(0x7B, "3.3.12", "integer variable (I) read and write", VARIABLE, at::VARIABLES, data::I),
    row(0x7C, "3.3.13", "double-precision variable (D) read and write", VARIABLE, at::VARIABLES, data::D),
    row(0x7D, "3.3.14", "real variable (R) read and write", VARIABLE, at::VARIABLES, data::R),
    row(0x7E, "3.3.15", "string variable (S, 16 bytes) read and write", VARIABLE, at::VARIABLES, data::S16),
    row(0x7F, "3.3.16", "position variable (P) read and write", POSITION, at::POSITION_VARIABLES, data::POSITION),
    row(0x80, "3.3.17", "base position variable (BP) read and write", POSITION, at::POSITION_VARIABLES, data::BASE_POSITION),
    row(0x81, "3.3.18", "external axis variable (EX) read and write", POSITION, at::POSITION_VARIABLES, data::EXTERNAL_POSITION),
    row(0x82, "3.3.19", "alarm reset and error cancel", SET_ONE, at::RESETS, data::RUN),
    row(0x83, "3.3.20", "hold, servo power and hlock", SWITCH, at::SWITCHES, data::ON_OFF),
    row(0x84, "3.3.21", "step, cycle and continuous", SET_ONE, at::CYCLE, data::CYCLE_MODE),
    row(0x85, "3.3.22", "message on the pendant", SET_ONE, at::ONE, data::MESSAGE),
    row(0x86, "3.3.23", "job start", START, at::ONE, data::RUN),
    row(0x87, "3.3.24", "job select", SELECT, at::SELECTIONS, data::SELECTION),
    row(0x88, "3.3.25", "management time read", READ_FIELDS, at::TIMES, data::TIMES),
    row(0x89, "3.3.26", "system information read", READ_FIELDS, at::SYSTEMS, data::SYSTEM),
    since_fs114(Row { alternative: Some(data::MOVE_25), ..row(0x8A, "3.3.39", "cartesian move", MOVE, at::MOVES, data::MOVE_26) }),
    since_fs114(row(0x8B, "3.3.40", "pulse move", MOVE, at::PULSE_MOVES, data::PULSE_MOVE)),
    dx200(row(0x8C, "3.3.41", "string variable (S, 32 bytes) read and write", VARIABLE, at::LONG_STRINGS, data::S32)),
    even(plural(0x300, "3.3.27", "plural I/O", at::IO, data::IO, 474)),
    plural(0x301, "3.3.28", "plural register", at::REGISTERS, data::REGISTER, 237),
    even(plural(0x302, "3.3.29", "plural byte variable (B)", at::VARIABLES, data::B, 474)),
    plural(0x303, "3.3.30", "plural integer variable (I)", at::VARIABLES, data::I, 237),
    plural(0x304, "3.3.31", "plural double-precision variable (D)", at::VARIABLES, data::D, 118),
    plural(0x305, "3.3.32", "plural real variable (R)", at::VARIABLES, data::R, 118),
    plural(0x306, "3.3.33", "plural string variable (S, 16 bytes)", at::VARIABLES, data::S16, 29),
    taught(plural(0x307, "3.3.34", "plural position variable (P)", at::POSITION_VARIABLES, data::POSITION, 9)),
    taught(plural(0x308, "3.3.35", "plural base position variable (BP)", at::POSITION_VARIABLES, data::BASE_POSITION, 13)),
    taught(plural(0x309, "3.3.36", "plural external axis variable (EX)", at::POSITION_VARIABLES, data::EXTERNAL_POSITION, 13)),
    since_fs114(row(0x30A, "3.3.37", "alarm read with sub-code strings", READ_FIELDS, at::ALARMS, data::ALARM_WITH_TEXTS)),
    since_fs114(row(0x30B, "3.3.38", "alarm history read with sub-code strings", READ_FIELDS, at::HISTORY, data::ALARM_WITH_TEXTS)),
    dx200(plural(0x30C, "3.3.42", "plural string variable (S, 32 bytes)", at::LONG_STRINGS, data::S32, 14)),
    files("3.4.1", "file delete", &[file(service::DELETE, "delete", Action::Write, DESTROY)], data::FILE_NAME),
    files("3.4.2", "file load", &[file(service::LOAD, "PC to controller", Action::Write, DESTROY)], data::FILE_NAME),
    files("3.4.3", "file save", &[file(service::SAVE, "controller to PC", Action::Read, READ)], data::FILE_NAME),
    files("3.4.4", "file list", &[file(service::LIST, "list", Action::Read, READ)], data::FILE_FILTER),
    // The controller writes the backup file for ten minutes, so the request must not be repeated freely.
    since_fs114(files(BATCH_BACKUP_SECTION, "batch data backup", &[file(service::SAVE, "make CMOSBK.BIN", Action::Write, WRITE)], data::FILE_NAME)),
];
