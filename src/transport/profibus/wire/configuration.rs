//! Codec for the identifier bytes of a configuration (part 8, section 8.3.5.2). They describe the modules, and their
//! numbers of bytes in each direction.

use super::{MAX_DATA, WireError};

/// Identifier bytes with the modules that they describe.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Configuration {
    bytes: Vec<u8>,
    modules: Vec<Module>,
}

/// The module that one identifier describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Module {
    /// Number of bytes from the slave.
    pub input: usize,
    /// Number of bytes to the slave.
    pub output: usize,
}

impl Configuration {
    /// Decodes identifiers in the general and the special format.
    ///
    /// # Errors
    /// An identifier is incomplete, or the data of all modules does not fit into a telegram.
    pub fn parse(bytes: &[u8]) -> Result<Self, WireError> {
        let mut modules = Vec::new();
        let (mut at, mut input, mut output) = (0, 0, 0);
        while let Some(&identifier) = bytes.get(at) {
            let (module, len) = if identifier & 0x30 == 0 { special(bytes, at)? } else { (general(identifier), 1) };
            input += module.input;
            output += module.output;
            if input > MAX_DATA || output > MAX_DATA {
                return Err(WireError::value("identifier of too many bytes", at, identifier));
            }
            modules.push(module);
            at += len;
        }
        Ok(Self { bytes: bytes.to_vec(), modules })
    }

    /// Identifier bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Modules in their order. An empty slot is a module with 0 bytes.
    pub fn modules(&self) -> &[Module] {
        &self.modules
    }

    /// Total number of bytes from the slave.
    pub fn input(&self) -> usize {
        self.modules.iter().map(|module| module.input).sum()
    }

    /// Total number of bytes to the slave.
    pub fn output(&self) -> usize {
        self.modules.iter().map(|module| module.output).sum()
    }
}

/// Returns the size in bytes that a length byte describes. The length counts units of one or two bytes.
const fn units(byte: u8, mask: u8) -> usize {
    let count = (byte & mask) as usize + 1;
    if byte & 0x40 != 0 { count * 2 } else { count }
}

fn general(identifier: u8) -> Module {
    let bytes = units(identifier, 0x0F);
    let ways = identifier & 0x30;
    Module { input: if ways & 0x10 == 0 { 0 } else { bytes }, output: if ways & 0x20 == 0 { 0 } else { bytes } }
}

/// Decodes the special format: a length byte for each direction, output first, and then the bytes of the manufacturer.
fn special(bytes: &[u8], at: usize) -> Result<(Module, usize), WireError> {
    let identifier = bytes[at];
    let mut len = 1;
    let mut io_direction = |there: bool| -> Result<usize, WireError> {
        if !there {
            return Ok(0);
        }
        let byte = bytes.get(at + len).ok_or(WireError::short("length of an identifier", at + len, 1, 0))?;
        len += 1;
        Ok(units(*byte, 0x3F))
    };
    let output = io_direction(identifier & 0x80 != 0)?;
    let input = io_direction(identifier & 0x40 != 0)?;
    // The value 15 means that there are no manufacturer bytes.
    let makers = match identifier & 0x0F {
        15 => 0,
        count => usize::from(count),
    };
    let present = bytes.len().saturating_sub(at + len);
    if present < makers {
        return Err(WireError::short("manufacturer data of an identifier", at + len, makers, present));
    }
    Ok((Module { input, output }, len + makers))
}
