//! Codec for the module blocks of Connect: expected modules, and differences from them.

use super::super::{Reader, WireError, Writer, count16};

/// An expected module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpectedModule {
    /// API (profile), always 0.
    pub api: u32,
    /// Slot.
    pub slot: u16,
    /// Ident number.
    pub ident: u32,
    /// Submodules.
    pub submodules: Vec<ExpectedSubmodule>,
}

/// An expected submodule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpectedSubmodule {
    /// Subslot.
    pub subslot: u16,
    /// Ident number.
    pub ident: u32,
    /// Properties. Bits 0 and 1 are the directions of the data: 0 no data, 1 input, 2 output, 3 both.
    pub properties: u16,
    /// Data descriptions.
    pub data: Vec<DataDescription>,
}

/// Data of a submodule in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DataDescription {
    /// Direction: 1 input, 2 output.
    pub direction: u16,
    /// Number of data bytes.
    pub length: u16,
    /// Number of bytes of the consumer status.
    pub consumer: u8,
    /// Number of bytes of the provider status.
    pub provider: u8,
}

pub(super) fn read_expected(reader: &mut Reader<'_>) -> Result<Vec<ExpectedModule>, WireError> {
    let count = reader.u16("NumberOfAPIs")?;
    (0..count)
        .map(|_| {
            let api = reader.u32("API")?;
            let slot = reader.u16("SlotNumber")?;
            let ident = reader.u32("ModuleIdentNumber")?;
            reader.u16("ModuleProperties")?;
            let count = reader.u16("NumberOfSubmodules")?;
            let submodules = (0..count).map(|_| read_submodule(reader)).collect::<Result<_, _>>()?;
            Ok(ExpectedModule { api, slot, ident, submodules })
        })
        .collect()
}

fn read_submodule(reader: &mut Reader<'_>) -> Result<ExpectedSubmodule, WireError> {
    let subslot = reader.u16("SubslotNumber")?;
    let ident = reader.u32("SubmoduleIdentNumber")?;
    let properties = reader.u16("SubmoduleProperties")?;
    let descriptions = if properties & 3 == 3 { 2 } else { 1 };
    let data = (0..descriptions)
        .map(|_| {
            Ok(DataDescription {
                direction: reader.u16("DataDescription")?,
                length: reader.u16("SubmoduleDataLength")?,
                consumer: reader.u8("LengthIOCS")?,
                provider: reader.u8("LengthIOPS")?,
            })
        })
        .collect::<Result<_, _>>()?;
    Ok(ExpectedSubmodule { subslot, ident, properties, data })
}

pub(super) fn write_expected(modules: &[ExpectedModule], out: &mut Writer) {
    out.u16(count16(modules.len()));
    for module in modules {
        out.u32(module.api);
        out.u16(module.slot);
        out.u32(module.ident);
        out.u16(0);
        out.u16(count16(module.submodules.len()));
        for submodule in &module.submodules {
            out.u16(submodule.subslot);
            out.u32(submodule.ident);
            out.u16(submodule.properties);
            for data in &submodule.data {
                out.u16(data.direction);
                out.u16(data.length);
                out.put(&[data.consumer, data.provider]);
            }
        }
    }
}

/// A module that differs from the expected module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ModuleDiff {
    /// Slot.
    pub slot: u16,
    /// Ident number of the real module.
    pub ident: u32,
    /// State of the module: 0 none, 1 wrong, 2 proper, 3 substitute.
    pub state: u16,
    /// Submodules that differ.
    pub submodules: Vec<SubmoduleDiff>,
}

/// A submodule that differs from the expected submodule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SubmoduleDiff {
    /// Subslot.
    pub subslot: u16,
    /// Ident number of the real submodule.
    pub ident: u32,
    /// State of the submodule. If bit 15 is set, bits 11 to 14 are: 0 proper, 1 substitute, 2 wrong, 3 none. If not,
    /// the whole number is: 0 none, 1 wrong, 2 proper, 3 substitute.
    pub state: u16,
}

impl SubmoduleDiff {
    /// Returns the state with the numbers of bits 11 to 14. If bit 15 is not set, the state has other numbers and is
    /// converted.
    const fn ident_info(&self) -> u16 {
        match (self.state & 0x8000 != 0, self.state) {
            (true, state) => (state >> 11) & 0xF,
            (false, 0) => 3,
            (false, 1) => 2,
            (false, 2 | 7) => 0,
            (false, _) => 1,
        }
    }

    /// Whether the submodule is the expected submodule or a substitute.
    pub const fn is_usable(&self) -> bool {
        self.ident_info() < 2
    }

    /// Whether the submodule is missing.
    pub const fn is_missing(&self) -> bool {
        self.ident_info() == 3
    }
}

pub(super) fn read_diff(reader: &mut Reader<'_>) -> Result<Vec<ModuleDiff>, WireError> {
    let mut modules = Vec::new();
    for _ in 0..reader.u16("NumberOfAPIs")? {
        reader.u32("API")?;
        for _ in 0..reader.u16("NumberOfModules")? {
            let slot = reader.u16("SlotNumber")?;
            let ident = reader.u32("ModuleIdentNumber")?;
            let state = reader.u16("ModuleState")?;
            let count = reader.u16("NumberOfSubmodules")?;
            let submodules = (0..count)
                .map(|_| {
                    let subslot = reader.u16("SubslotNumber")?;
                    let ident = reader.u32("SubmoduleIdentNumber")?;
                    Ok(SubmoduleDiff { subslot, ident, state: reader.u16("SubmoduleState")? })
                })
                .collect::<Result<_, WireError>>()?;
            modules.push(ModuleDiff { slot, ident, state, submodules });
        }
    }
    Ok(modules)
}

pub(super) fn write_diff(modules: &[ModuleDiff], out: &mut Writer) {
    out.u16(1);
    out.u32(0);
    out.u16(count16(modules.len()));
    for module in modules {
        out.u16(module.slot);
        out.u32(module.ident);
        out.u16(module.state);
        out.u16(count16(module.submodules.len()));
        for submodule in &module.submodules {
            out.u16(submodule.subslot);
            out.u32(submodule.ident);
            out.u16(submodule.state);
        }
    }
}
