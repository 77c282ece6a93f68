//! Table of commands: numbers, ranges, sizes and permissions of the manuals (FS and DX table 3-1, sections 3.3 and
//! 3.4).
//!
//! The table is the single source for validation, descriptions and the simulator. The manuals misprint some ranges and
//! sizes; the table has the corrected values. The golden frames are the evidence.

mod bits;
mod fields;
mod rows;
mod spans;

pub use bits::Bit;
pub(super) use bits::{DATA_1_BITS, DATA_2_BITS, EXTENDED_FORM_BITS, FORM_BITS};
pub use fields::{ALARM_KINDS, Field, Kind};
pub use rows::ROWS;
pub use spans::{Instances, Span};

use super::Model;
use super::wire::Division;
use crate::Risk;

/// Service numbers (FS and DX 3.3, 3.4).
pub mod service {
    /// Read every field.
    pub const GET_ALL: u8 = 0x01;
    /// Write every field.
    pub const SET_ALL: u8 = 0x02;
    /// Delete a file.
    pub const DELETE: u8 = 0x09;
    /// Read one field.
    pub const GET_SINGLE: u8 = 0x0E;
    /// Write one field.
    pub const SET_SINGLE: u8 = 0x10;
    /// Send a file to the controller.
    pub const LOAD: u8 = 0x15;
    /// Fetch a file from the controller. With the path of the batch backup, create the backup.
    pub const SAVE: u8 = 0x16;
    /// List files.
    pub const LIST: u8 = 0x32;
    /// Read several elements.
    pub const READ_PLURAL: u8 = 0x33;
    /// Write several elements.
    pub const WRITE_PLURAL: u8 = 0x34;
}

/// Path that makes a controller write its batch backup (FS and DX 3.4.5).
pub const BATCH_BACKUP_PATH: &[u8] = b"/SPDRV/CMOSBK.BIN";

/// Availability of a command by controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Availability {
    /// DX200, and FS100 with system software FS1.14 or later.
    Both,
    /// DX200, and FS100 from system software FS1.14.
    Fs114,
    /// DX200 and newer models.
    Dx200,
}

impl Availability {
    /// Whether a controller of this model can have the command.
    pub const fn on(self, model: Model) -> bool {
        !matches!((self, model), (Self::Dx200, Model::Fs100 | Model::Dx100))
    }

    /// Hint for the user if a controller refuses the command.
    pub const fn note(self) -> Option<&'static str> {
        match self {
            Self::Both => None,
            Self::Fs114 => Some("an FS100 needs system software FS1.14 or later"),
            Self::Dx200 => Some("DX200 and later only"),
        }
    }
}

/// Valid attribute numbers of a service.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Attribute {
    /// The attribute is 0.
    Zero,
    /// The attribute is 1.
    One,
    /// The attribute is 1, as in the manuals. Controllers are known to accept 0 too.
    OneOrZero,
    /// The attribute is the number of a field, from 1.
    Field,
}

/// Rule for the risk of a service.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RiskRule {
    /// The risk does not depend on the data.
    Always(Risk),
    /// The risk depends on the switched object. Servo power on or off is a motion, because an axis may sink. HOLD and
    /// HLOCK are writes (3.3.20).
    Switches,
}

/// Direction of the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Action {
    /// The answer contains the data.
    Read,
    /// The request contains the data.
    Write,
}

/// A service of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Service {
    /// Number of the service in the protocol.
    pub number: u8,
    /// Readable name.
    pub meaning: &'static str,
    /// Direction of the data.
    pub action: Action,
    /// Valid attribute numbers.
    pub attribute: Attribute,
    /// Rule for the risk of the service.
    pub risk: RiskRule,
}

/// Limits of a plural command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plural {
    /// Maximum number of elements per request.
    pub max: u16,
    /// Whether only even counts are valid.
    pub even: bool,
}

/// A robot command or a file service.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// Command number; 0 for files.
    pub number: u16,
    /// Server that executes the row: robot or file.
    pub division: Division,
    /// Readable name.
    pub name: &'static str,
    /// Section of the manuals.
    pub section: &'static str,
    /// Availability by controller.
    pub availability: Availability,
    /// Services.
    pub services: &'static [Service],
    /// Valid instances.
    pub instances: Instances,
    /// Fields of the data. For a plural command, the fields of one element. Attribute numbers count these fields from
    /// 1.
    pub fields: &'static [Field],
    /// Alternative fields: the 25-word layout of the cartesian move in the FS100 manual. Valid only for an FS100.
    pub alternative: Option<&'static [Field]>,
    /// Limits of a plural command; `None` for other commands.
    pub plural: Option<Plural>,
}

impl Row {
    /// The row of a robot command.
    pub fn from_number(command: u16) -> Option<&'static Self> {
        ROWS.iter().find(|row| row.division == Division::Robot && row.number == command)
    }

    /// The row of a file service. A save and the batch backup have the same service number; `data` distinguishes them.
    pub fn of_file(service: u8, data: &[u8]) -> Option<&'static Self> {
        let backup = service == service::SAVE && data == BATCH_BACKUP_PATH;
        ROWS.iter().find(|row| {
            row.division == Division::File
                && row.services.iter().any(|known| known.number == service)
                && row.is_batch_backup() == backup
        })
    }

    /// Manual and section, for example `DX 3.3.41`.
    pub fn citation(&self) -> String {
        match self.availability {
            Availability::Dx200 => format!("DX {}", self.section),
            _ => format!("FS and DX {}", self.section),
        }
    }

    /// The service with this number.
    pub fn service(&self, number: u8) -> Option<&'static Service> {
        self.services.iter().find(|service| service.number == number)
    }

    /// Size of all fields in bytes. For a plural command, the size of one element.
    pub fn size(&self) -> usize {
        total(self.fields)
    }

    /// The fields of a single (not plural) read or write of `attribute`; empty if the attribute is unknown.
    pub fn fields_of(&self, service: &Service, attribute: u8) -> &'static [Field] {
        match service.attribute {
            Attribute::Field => match usize::from(attribute).checked_sub(1) {
                Some(index) => self.fields.get(index..=index).unwrap_or_default(),
                None => &[],
            },
            _ => self.fields,
        }
    }

    /// Whether the row is the batch backup. Its service number is the same as that of a save.
    pub fn is_batch_backup(&self) -> bool {
        self.section == rows::BATCH_BACKUP_SECTION
    }
}

impl Service {
    /// Whether an attribute number is valid for a command with this number of fields.
    pub fn takes(&self, attribute: u8, fields: usize) -> bool {
        match self.attribute {
            Attribute::Zero => attribute == 0,
            Attribute::One => attribute == 1,
            Attribute::OneOrZero => attribute <= 1,
            Attribute::Field => (1..=fields).contains(&usize::from(attribute)),
        }
    }

    /// Readable list of valid attribute numbers.
    pub fn attributes(&self, fields: usize) -> String {
        match self.attribute {
            Attribute::Zero => "0".to_owned(),
            Attribute::One => "1".to_owned(),
            Attribute::OneOrZero => "1 (or 0)".to_owned(),
            Attribute::Field => format!("1 to {fields}"),
        }
    }

    /// Whether the row reads or writes several elements.
    pub const fn is_plural(&self) -> bool {
        matches!(self.number, service::READ_PLURAL | service::WRITE_PLURAL)
    }
}

/// Size of these fields in bytes.
pub fn total(fields: &[Field]) -> usize {
    fields.iter().map(Field::size).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_one_row() {
        let commands: Vec<u16> =
            ROWS.iter().filter(|row| row.division == Division::Robot).map(|row| row.number).collect();
        let expected: Vec<u16> = (0x70..=0x8C).chain(0x300..=0x30C).collect();
        assert_eq!(commands, expected);
        assert_eq!(ROWS.len(), 47);
    }

    #[test]
    fn plural_maxima_fill_a_frame() {
        for row in ROWS {
            let Some(Plural { max, even }) = row.plural else { continue };
            let step = if even { 2 } else { 1 };
            let size = |count: u16| 4 + usize::from(count) * row.size();
            assert!(size(max) <= super::super::wire::MAX_DATA, "{}", row.name);
            assert!(size(max + step) > super::super::wire::MAX_DATA, "{}", row.name);
        }
    }

    #[test]
    fn sections_are_unique_and_the_backup_is_found_by_its_path() {
        for (i, row) in ROWS.iter().enumerate() {
            assert!(ROWS[..i].iter().all(|other| other.section != row.section), "{}", row.section);
        }
        assert_eq!(Row::of_file(service::SAVE, b"A.JBI").unwrap().section, "3.4.3");
        assert_eq!(Row::of_file(service::SAVE, BATCH_BACKUP_PATH).unwrap().section, "3.4.5");
        assert!(Row::of_file(0x33, b"").is_none());
    }

    #[test]
    fn spans_of_a_model_do_not_overlap() {
        for row in ROWS {
            for model in Model::ALL {
                let spans = row.instances.for_model(model);
                assert!(spans.windows(2).all(|pair| pair[0].last < pair[1].first), "{} {model}", row.name);
            }
        }
    }
}
