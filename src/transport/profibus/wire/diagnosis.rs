//! What a slave says of itself (part 8, section 8.3.1).

use std::fmt;

use super::WireError;

/// Bytes before the blocks.
const FIXED: usize = 6;
/// The master of a slave that has none.
const NOBODY: u8 = 255;

/// The answer to Slave_Diag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnosis {
    /// The flags of the first three bytes.
    pub flags: [u8; 3],
    /// Whom the slave belongs to.
    pub master: Option<u8>,
    /// Which kind of slave it is.
    pub ident: u16,
    /// What it says beyond that.
    pub blocks: Vec<Block>,
}

/// A flag of the first three bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Flag {
    /// Set by a master: the slave does not answer.
    NotExistent,
    /// Not ready for data.
    NotReady,
    /// It wants another configuration.
    ConfigurationFault,
    /// Blocks follow.
    Extended,
    /// It was asked for what it cannot do.
    NotSupported,
    /// Set by a master: an answer made no sense.
    InvalidAnswer,
    /// It wants other parameters.
    ParameterFault,
    /// It belongs to another master.
    Locked,
    /// It has no parameters.
    ParametersWanted,
    /// It has no valid data; the diagnosis is to be asked for again.
    Static,
    /// Its watchdog runs.
    Watchdog,
    /// Its inputs are held.
    Freeze,
    /// Its outputs are held.
    Sync,
    /// Set by a master: the slave is switched off.
    Deactivated,
    /// It has more to say than fits.
    Overflow,
}

/// The flags with byte, bit and text.
const FLAGS: [(Flag, usize, u8, &str); 15] = [
    (Flag::NotExistent, 0, 0x01, "does not exist"),
    (Flag::NotReady, 0, 0x02, "not ready for data"),
    (Flag::ConfigurationFault, 0, 0x04, "wrong configuration"),
    (Flag::Extended, 0, 0x08, "more diagnosis follows"),
    (Flag::NotSupported, 0, 0x10, "function not supported"),
    (Flag::InvalidAnswer, 0, 0x20, "invalid answer"),
    (Flag::ParameterFault, 0, 0x40, "wrong parameters"),
    (Flag::Locked, 0, 0x80, "locked by another master"),
    (Flag::ParametersWanted, 1, 0x01, "wants parameters"),
    (Flag::Static, 1, 0x02, "no valid data"),
    (Flag::Watchdog, 1, 0x08, "watchdog on"),
    (Flag::Freeze, 1, 0x10, "inputs frozen"),
    (Flag::Sync, 1, 0x20, "outputs held by sync"),
    (Flag::Deactivated, 1, 0x80, "deactivated"),
    (Flag::Overflow, 2, 0x80, "more diagnosis than fits"),
];

/// The bit that is always set.
pub(super) const ALWAYS: u8 = 0x04;

impl Flag {
    /// In words.
    pub fn text(self) -> &'static str {
        FLAGS.iter().find(|row| row.0 == self).map_or("", |row| row.3)
    }
}

/// What a slave says beyond the first bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Block {
    /// Bytes of the maker.
    Device(Vec<u8>),
    /// Numbers of the modules that have something to say.
    Modules(Vec<u16>),
    /// Something about a channel.
    Channel {
        /// Module.
        module: u8,
        /// Channel of the module.
        channel: u8,
        /// Input, output, or both: 1, 2, 3.
        way: u8,
        /// Bits, bytes, words, as the standard numbers them.
        size: u8,
        /// What is wrong.
        error: u8,
    },
    /// The revision of a slave with acyclic services.
    Revision(u8),
}

/// Errors of channels that the standard names.
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
    /// Reads one.
    ///
    /// # Errors
    /// When it is too short, or a block is.
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
        let master = (master != NOBODY).then_some(master);
        Ok(Self { flags: [first, second, third], master, ident: u16::from_be_bytes([high, low]), blocks })
    }

    /// Its bytes.
    pub fn emit(&self) -> Vec<u8> {
        let [high, low] = self.ident.to_be_bytes();
        let [first, second, third] = self.flags;
        let mut data = vec![first, second, third, self.master.unwrap_or(NOBODY), high, low];
        for block in &self.blocks {
            block.emit(&mut data);
        }
        data
    }

    /// Whether a flag is set.
    pub fn has(&self, flag: Flag) -> bool {
        FLAGS.iter().any(|row| row.0 == flag && self.flags[row.1] & row.2 != 0)
    }

    /// The flags that are set, in words, but for the one that only tells of blocks.
    pub fn words(&self) -> impl Iterator<Item = &'static str> {
        let told = FLAGS.iter().filter(|row| row.0 != Flag::Extended && self.has(row.0));
        told.map(|row| row.3)
    }

    /// With these flags, and the bit that is always set.
    pub fn flags(flags: &[Flag]) -> [u8; 3] {
        let mut bytes = [0, ALWAYS, 0];
        for row in FLAGS.iter().filter(|row| flags.contains(&row.0)) {
            bytes[row.1] |= row.2;
        }
        bytes
    }
}

impl fmt::Display for Diagnosis {
    /// In words: `not ready for data, wants parameters, no master, ident 0x1234`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for text in self.words() {
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
    /// From its bytes, of which there is one at least.
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
                way: channel >> 6,
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
            Self::Channel { module, channel, way, size, error } => {
                data.extend([0x80 | module & 0x3F, way << 6 | channel & 0x3F, size << 5 | error & 0x1F]);
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
            Self::Channel { module, channel, way, error, .. } => {
                let way = ["", "input ", "output ", "input and output "][usize::from(way & 3)];
                write!(f, "module {module} {way}channel {channel}: ")?;
                match CHANNEL_ERRORS.iter().find(|row| row.0 == *error) {
                    Some((_, text)) => f.write_str(text),
                    None => write!(f, "error {error}"),
                }
            }
            Self::Revision(revision) => write!(f, "revision {revision}"),
        }
    }
}
