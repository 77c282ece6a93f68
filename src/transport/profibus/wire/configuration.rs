//! Identifier bytes of a configuration (part 8, section 8.3.5.2): how many bytes go each way, in which modules.

use super::{MAX_DATA, WireError};

/// The bytes as they are sent, with the modules that they stand for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Configuration {
    bytes: Vec<u8>,
    modules: Vec<Module>,
}

/// What one identifier stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Module {
    /// Bytes that the slave sends.
    pub input: usize,
    /// Bytes that the slave takes.
    pub output: usize,
}

impl Configuration {
    /// Takes identifiers apart, in the general and the special form.
    ///
    /// # Errors
    /// When an identifier is not complete, or adds up to more than a telegram carries.
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

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// What the identifiers stand for, in order; an empty slot has no bytes.
    pub fn modules(&self) -> &[Module] {
        &self.modules
    }

    /// Bytes that the slave sends.
    pub fn input(&self) -> usize {
        self.modules.iter().map(|module| module.input).sum()
    }

    /// Bytes that the slave takes.
    pub fn output(&self) -> usize {
        self.modules.iter().map(|module| module.output).sum()
    }
}

/// Bytes of units of one or two bytes, from a length byte.
const fn units(byte: u8, mask: u8) -> usize {
    let count = (byte & mask) as usize + 1;
    if byte & 0x40 != 0 { count * 2 } else { count }
}

fn general(identifier: u8) -> Module {
    let bytes = units(identifier, 0x0F);
    let ways = identifier & 0x30;
    Module { input: if ways & 0x10 == 0 { 0 } else { bytes }, output: if ways & 0x20 == 0 { 0 } else { bytes } }
}

/// The special form: a length byte for each way, output first, then bytes of the maker.
fn special(bytes: &[u8], at: usize) -> Result<(Module, usize), WireError> {
    let identifier = bytes[at];
    let mut len = 1;
    let mut way = |there: bool| -> Result<usize, WireError> {
        if !there {
            return Ok(0);
        }
        let byte = bytes.get(at + len).ok_or(WireError::short("length of an identifier", at + len, 1, 0))?;
        len += 1;
        Ok(units(*byte, 0x3F))
    };
    let output = way(identifier & 0x80 != 0)?;
    let input = way(identifier & 0x40 != 0)?;
    // 15: there are no bytes of the maker, not even an empty lot.
    let makers = match identifier & 0x0F {
        15 => 0,
        count => usize::from(count),
    };
    let present = bytes.len().saturating_sub(at + len);
    if present < makers {
        return Err(WireError::short("maker's bytes of an identifier", at + len, makers, present));
    }
    Ok((Module { input, output }, len + makers))
}
