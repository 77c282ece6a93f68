//! Codec for the slave diagnosis (part 8, section 8.3.1).

use std::fmt;

use super::WireError;

/// Number of bytes before the blocks.
const FIXED: usize = 6;
/// Value of the master address in a slave that no master has locked.
const NO_MASTER: u8 = 255;

/// Diagnosis of a slave, the answer to Slave_Diag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnosis {
    /// The three status bytes.
    pub flags: [u8; 3],
    /// Address of the master that has locked the slave; `None` if no master has locked it.
    pub master: Option<u8>,
    /// Ident number.
    pub ident: u16,
    /// Blocks of the extended diagnosis.
    pub blocks: Vec<Block>,
}

/// A flag of the three status bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Flag {
    /// The slave does not answer. A master sets this flag.
    NotExistent,
    /// The slave is not ready for data.
    NotReady,
    /// The configuration is wrong.
    ConfigurationFault,
    /// An extended diagnosis follows.
    Extended,
    /// A requested function is not supported.
    NotSupported,
    /// An answer was invalid. A master sets this flag.
    InvalidAnswer,
    /// The parameters are wrong.
    ParameterFault,
    /// Another master has locked the slave.
    Locked,
    /// The slave needs parameters.
    ParametersWanted,
    /// The slave has no valid data; the master must read the diagnosis again.
    Static,
    /// The watchdog is active.
    Watchdog,
    /// Freeze: the inputs keep their values.
    Freeze,
    /// Sync: the outputs keep their values.
    Sync,
    /// The slave is deactivated. A master sets this flag.
    Deactivated,
    /// The slave has more diagnosis data than fits into the answer.
    Overflow,
}

/// Flags, each with its byte, bit and text.
const FLAGS: [(Flag, usize, u8, &str); 15] = [
    (Flag::NotExistent, 0, 0x01, "does not exist"),
    (Flag::NotReady, 0, 0x02, "not ready for data"),
    (Flag::ConfigurationFault, 0, 0x04, "wrong configuration"),
    (Flag::Extended, 0, 0x08, "more diagnosis follows"),
    (Flag::NotSupported, 0, 0x10, "function not supported"),
    (Flag::InvalidAnswer, 0, 0x20, "invalid answer"),
    (Flag::ParameterFault, 0, 0x40, "wrong parameters"),
    (Flag::Locked, 0, 0x80, "locked by another master"),
    (Flag::ParametersWanted, 1, 0x01, "needs parameters"),
    (Flag::Static, 1, 0x02, "no valid data"),
    (Flag::Watchdog, 1, 0x08, "watchdog on"),
    (Flag::Freeze, 1, 0x10, "inputs frozen"),
    (Flag::Sync, 1, 0x20, "outputs held by sync"),
    (Flag::Deactivated, 1, 0x80, "deactivated"),
    (Flag::Overflow, 2, 0x80, "diagnosis overflow"),
];

/// Bit of the second status byte that is always set.
pub(super) const ALWAYS_SET: u8 = 0x04;

impl Flag {
    /// Text of the flag.
    pub fn text(self) -> &'static str {
        FLAGS.iter().find(|row| row.0 == self).map_or("", |row| row.3)
    }
}

/// A block of the extended diagnosis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Block {
    /// Device-related diagnosis: bytes defined by the manufacturer.
    Device(Vec<u8>),
    /// Identifier-related diagnosis: numbers of the modules with a diagnosis.
    Modules(Vec<u16>),
    /// Channel-related diagnosis.
    Channel {
        /// Module number.
        module: u8,
        /// Channel number in the module.
        channel: u8,
        /// Direction: 1 input, 2 output, 3 both.
        io_direction: u8,
        /// Channel type (bit, byte, word), as a number of the standard.
        size: u8,
        /// Error code.
        error: u8,
    },
    /// Revision of a slave with acyclic services.
    Revision(u8),
}

/// Error codes of channels, with the texts of the standard.
const CHANNEL_ERRORS: [(u8, &str); 9] = [
    (1, "short circuit"),
    (2, "undervoltage"),
    (3, "overvoltage"),
    (4, "overload"),
    (5, "overtemperature"),
    (6, "line break"),
    (7, "upper limit exceeded"),
    (8, "lower limit exceeded"),
    (9, "error"),
];

impl Diagnosis {
    /// Decodes a diagnosis.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        let Some((&[first, second, third, master, high, low], rest)) = data.split_first_chunk::<FIXED>() else {
            return Err(WireError::short("diagnosis", 0, FIXED, data.len()));
        };
        let mut blocks = Vec::new();
        let mut at = 0;
        while let Some(&head) = rest.get(at) {
            let len = match head >> 6 {
                0 | 1 => usize::from(head & 0x3F).max(1),
                2 => 3,
                _ => 1,
            };
            let block = rest.get(at..at + len).ok_or(WireError::short(
                "block of the diagnosis",
                FIXED + at,
                len,
                rest.len() - at,
            ))?;
            blocks.push(Block::new(block));
            at += len;
        }
        let master = (master != NO_MASTER).then_some(master);
        Ok(Self { flags: [first, second, third], master, ident: u16::from_be_bytes([high, low]), blocks })
    }

    /// Encodes the diagnosis.
    pub fn emit(&self) -> Vec<u8> {
        let [high, low] = self.ident.to_be_bytes();
        let [first, second, third] = self.flags;
        let mut data = vec![first, second, third, self.master.unwrap_or(NO_MASTER), high, low];
        for block in &self.blocks {
            block.emit(&mut data);
        }
        data
    }

    /// Whether a flag is set.
    pub fn has(&self, flag: Flag) -> bool {
        FLAGS.iter().any(|row| row.0 == flag && self.flags[row.1] & row.2 != 0)
    }

    /// Texts of the flags that are set, except the flag for extended diagnosis.
    pub fn flag_texts(&self) -> impl Iterator<Item = &'static str> {
        let told = FLAGS.iter().filter(|row| row.0 != Flag::Extended && self.has(row.0));
        told.map(|row| row.3)
    }

    /// Returns the status bytes with these flags set, and with the bit that is always set.
    pub fn flags(flags: &[Flag]) -> [u8; 3] {
        let mut bytes = [0, ALWAYS_SET, 0];
        for row in FLAGS.iter().filter(|row| flags.contains(&row.0)) {
            bytes[row.1] |= row.2;
        }
        bytes
    }
}

impl fmt::Display for Diagnosis {
    /// Formats the diagnosis, for example `not ready for data, needs parameters, no master, ident 0x1234`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for text in self.flag_texts() {
            write!(f, "{text}, ")?;
        }
        match self.master {
            Some(master) => write!(f, "master {master}, ")?,
            None => f.write_str("no master, ")?,
        }
        write!(f, "ident {:#06x}", self.ident)?;
        for block in &self.blocks {
            write!(f, ", {block}")?;
        }
        Ok(())
    }
}

impl Block {
    /// Decodes a block. The block must have at least one byte.
    fn new(block: &[u8]) -> Self {
        match (block[0] >> 6, block) {
            (0, _) => Self::Device(block[1..].to_vec()),
            (1, _) => {
                let bits = block[1..].iter().flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1 == 1));
                Self::Modules((0..).zip(bits).filter(|(_, is_set)| *is_set).map(|(number, _)| number).collect())
            }
            (2, &[head, channel, error]) => Self::Channel {
                module: head & 0x3F,
                channel: channel & 0x3F,
                io_direction: channel >> 6,
                size: error >> 5,
                error: error & 0x1F,
            },
            _ => Self::Revision(block[0] & 0x3F),
        }
    }

    fn emit(&self, data: &mut Vec<u8>) {
        match self {
            Self::Device(bytes) => {
                let bytes = &bytes[..bytes.len().min(62)];
                data.push(u8::try_from(bytes.len() + 1).unwrap_or_default());
                data.extend(bytes);
            }
            Self::Modules(modules) => {
                let last = modules.iter().copied().max().map_or(0, |last| usize::from(last).min(62 * 8 - 1) / 8 + 1);
                let mut bits = vec![0_u8; last];
                for module in modules {
                    if let Some(byte) = bits.get_mut(usize::from(module / 8)) {
                        *byte |= 1 << (module % 8);
                    }
                }
                data.push(0x40 | u8::try_from(bits.len() + 1).unwrap_or_default());
                data.extend(bits);
            }
            Self::Channel { module, channel, io_direction, size, error } => {
                data.extend([0x80 | module & 0x3F, io_direction << 6 | channel & 0x3F, size << 5 | error & 0x1F]);
            }
            Self::Revision(revision) => data.push(0xC0 | revision & 0x3F),
        }
    }
}

impl fmt::Display for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Device(bytes) => {
                f.write_str("device ")?;
                bytes.iter().try_for_each(|byte| write!(f, "{byte:02X}"))
            }
            Self::Modules(modules) => {
                let modules: Vec<String> = modules.iter().map(ToString::to_string).collect();
                write!(f, "modules {}", modules.join(" "))
            }
            Self::Channel { module, channel, io_direction, error, .. } => {
                let io_direction = ["", "input ", "output ", "input and output "][usize::from(io_direction & 3)];
                write!(f, "module {module} {io_direction}channel {channel}: ")?;
                match CHANNEL_ERRORS.iter().find(|row| row.0 == *error) {
                    Some((_, text)) => f.write_str(text),
                    None => write!(f, "error {error}"),
                }
            }
            Self::Revision(revision) => write!(f, "revision {revision}"),
        }
    }
}
