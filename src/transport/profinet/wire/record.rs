//! Codec for records. A record is a numbered set of parameters or data of a submodule.

use super::block::{self, BlockType};
use super::{Reader, Uuid, WireError, Writer, count16, count32, text};

/// Record indexes.
pub mod index {
    /// I&M0: vendor, order number, serial number, versions.
    pub const IM0: u16 = 0xAFF0;
    /// Modules that are really plugged into the device.
    pub const REAL_IDENTIFICATION: u16 = 0xF000;
    /// Several records in one Write.
    pub const MULTIPLE_WRITE: u16 = 0xE040;
}

/// Number of bytes in a record block between its header and the data.
const FIXED: usize = 60;
const BLOCK_HEADER: usize = 4;

/// Record header of a Read or Write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record {
    /// Sequence number in the connection.
    pub sequence: u16,
    /// UUID of the connection. Nil if there is no connection.
    pub ar: Uuid,
    /// API (profile), always 0.
    pub api: u32,
    /// Slot.
    pub slot: u16,
    /// Subslot.
    pub subslot: u16,
    /// Record index.
    pub index: u16,
    /// Length in bytes of the record, or of the buffer for the record.
    pub length: u32,
}

impl Record {
    /// Decodes the first block of a call or answer. Returns it with the remaining bytes.
    pub fn parse(bytes: &[u8], kind: BlockType) -> Result<(Self, &[u8]), WireError> {
        let mut reader = Reader::big(bytes);
        let found = reader.u16("BlockType")?;
        if found != kind.0 {
            return Err(reader.wrong("BlockType", 2, found));
        }
        let length = reader.u16("BlockLength")?;
        let mut body = Reader::big(reader.take(usize::from(length), "block")?);
        body.u16("BlockVersion")?;
        let sequence = body.u16("SeqNumber")?;
        let ar = body.uuid("ARUUID")?;
        let api = body.u32("API")?;
        let slot = body.u16("SlotNumber")?;
        let subslot = body.u16("SubslotNumber")?;
        body.u16("padding")?;
        let index = body.u16("Index")?;
        let length = body.u32("RecordDataLength")?;
        Ok((Self { sequence, ar, api, slot, subslot, index, length }, reader.rest()))
    }

    /// Decodes a Read answer. Returns it with the record data.
    pub fn parse_answer(bytes: &[u8]) -> Result<(Self, &[u8]), WireError> {
        let (record, rest) = Self::parse(bytes, BlockType::READ.answer())?;
        let length = usize::try_from(record.length).unwrap_or(usize::MAX);
        let short = WireError::short("record", FIXED + BLOCK_HEADER, length, rest.len());
        Ok((record, rest.get(..length).ok_or(short)?))
    }

    /// Encodes the block and the data. `status` is the status in a Write answer; it is 0 in all other blocks.
    pub fn emit(&self, kind: BlockType, status: u32, data: &[u8]) -> Vec<u8> {
        let mut out = Writer::default();
        out.u16(self.sequence);
        out.uuid(self.ar);
        out.u32(self.api);
        out.u16(self.slot);
        out.u16(self.subslot);
        out.u16(0);
        out.u16(self.index);
        out.u32(self.length);
        // Two more values follow. In a Write answer, the second value is the status.
        out.u32(0);
        out.u32(status);
        out.zeros(FIXED - 2 - out.bytes.len());
        let mut bytes = block::emit(kind, &out.bytes);
        bytes.extend_from_slice(data);
        bytes
    }

    /// Decodes a Write answer. Returns it with its status and the remaining bytes.
    pub fn write_status(bytes: &[u8]) -> Result<(Self, u32, &[u8]), WireError> {
        let (record, rest) = Self::parse(bytes, BlockType::WRITE.answer())?;
        let mut reader = Reader { at: 44, ..Reader::big(bytes) };
        Ok((record, reader.u32("PNIOStatus")?, rest))
    }
}

/// A parameter record that the controller writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameter {
    /// Slot.
    pub slot: u16,
    /// Subslot.
    pub subslot: u16,
    /// Record index.
    pub index: u16,
    /// Record data.
    pub data: Vec<u8>,
}

/// Encodes a Write of one or several records.
pub fn write(ar: Uuid, sequence: u16, parameters: &[Parameter]) -> Vec<u8> {
    let record = |at: usize, parameter: &Parameter| Record {
        sequence: sequence.wrapping_add(count16(at)),
        ar,
        api: 0,
        slot: parameter.slot,
        subslot: parameter.subslot,
        index: parameter.index,
        length: count32(parameter.data.len()),
    };
    if let [parameter] = parameters {
        return record(0, parameter).emit(BlockType::WRITE, 0, &parameter.data);
    }
    let mut inner = Vec::new();
    for (at, parameter) in parameters.iter().enumerate() {
        inner.resize(inner.len().next_multiple_of(4), 0);
        inner.extend(record(at + 1, parameter).emit(BlockType::WRITE, 0, &parameter.data));
    }
    let length = count32(inner.len());
    let outer =
        Record { sequence, ar, api: u32::MAX, slot: u16::MAX, subslot: u16::MAX, index: index::MULTIPLE_WRITE, length };
    outer.emit(BlockType::WRITE, 0, &inner)
}

/// Decodes a Write of one or several records.
pub fn parse_write(bytes: &[u8]) -> Result<(Record, Vec<Parameter>), WireError> {
    let (outer, data) = Record::parse(bytes, BlockType::WRITE)?;
    if outer.index != index::MULTIPLE_WRITE {
        let (parameter, _) = parameter(&outer, data)?;
        return Ok((outer, vec![parameter]));
    }
    let mut parameters = Vec::new();
    let mut at = 0;
    while at < data.len() {
        let (record, rest) = Record::parse(&data[at..], BlockType::WRITE)?;
        let (parameter, rest) = parameter(&record, rest)?;
        parameters.push(parameter);
        at = (data.len() - rest.len()).next_multiple_of(4);
    }
    Ok((outer, parameters))
}

fn parameter<'a>(record: &Record, data: &'a [u8]) -> Result<(Parameter, &'a [u8]), WireError> {
    let length = usize::try_from(record.length).unwrap_or(usize::MAX);
    let short = WireError::short("record", FIXED + BLOCK_HEADER, length, data.len());
    let (data, rest) = data.split_at_checked(length).ok_or(short)?;
    let Record { slot, subslot, index, .. } = *record;
    Ok((Parameter { slot, subslot, index, data: data.to_vec() }, rest))
}

/// Encodes the Write answer with the status of each record.
pub fn write_answer(outer: &Record, statuses: &[(Record, u32)]) -> Vec<u8> {
    if outer.index != index::MULTIPLE_WRITE {
        let status = statuses.first().map_or(0, |(_, status)| *status);
        return outer.emit(BlockType::WRITE.answer(), status, &[]);
    }
    let inner: Vec<u8> =
        statuses.iter().flat_map(|(record, status)| record.emit(BlockType::WRITE.answer(), *status, &[])).collect();
    let outer = Record { length: count32(inner.len()), ..*outer };
    outer.emit(BlockType::WRITE.answer(), 0, &inner)
}

/// Decodes the status of each record from a Write answer.
pub fn parse_write_answer(bytes: &[u8]) -> Result<Vec<(Record, u32)>, WireError> {
    let (outer, status, mut rest) = Record::write_status(bytes)?;
    let mut all = vec![(outer, status)];
    if outer.index == index::MULTIPLE_WRITE {
        while !rest.is_empty() {
            let (record, status, behind) = Record::write_status(rest)?;
            all.push((record, status));
            rest = behind;
        }
    }
    Ok(all)
}

/// I&M0: identification of a device.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Im0 {
    /// Vendor id.
    pub vendor: u16,
    /// Order number.
    pub order_id: String,
    /// Serial number.
    pub serial: String,
    /// Hardware revision.
    pub hardware: u16,
    /// Software revision: prefix (`V` for a release) and three numbers.
    pub software: (char, u8, u8, u8),
    /// Revision counter.
    pub revision: u16,
}

impl Im0 {
    /// Decodes the record.
    pub fn parse(record: &[u8]) -> Result<Self, WireError> {
        let blocks = block::walk(record)?;
        let found = blocks.iter().find(|block| block.kind == BlockType::IM0);
        let mut reader = Reader::big(found.ok_or(Reader::big(record).missing("I&M0"))?.body);
        Ok(Self {
            vendor: reader.u16("vendor")?,
            order_id: text(reader.take(20, "order id")?),
            serial: text(reader.take(16, "serial number")?),
            hardware: reader.u16("hardware version")?,
            software: (
                char::from(reader.u8("software version")?),
                reader.u8("software version")?,
                reader.u8("software version")?,
                reader.u8("software version")?,
            ),
            revision: reader.u16("revision counter")?,
        })
    }

    /// Encodes the record.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.u16(self.vendor);
        for (value, width) in [(&self.order_id, 20), (&self.serial, 16)] {
            let mut bytes: Vec<u8> = value.bytes().take(width).collect();
            bytes.resize(width, b' ');
            out.put(&bytes);
        }
        out.u16(self.hardware);
        let (prefix, major, minor, patch) = self.software;
        out.put(&[u8::try_from(prefix).unwrap_or(b'V'), major, minor, patch]);
        out.u16(self.revision);
        // The last fields of the record: no profile, I&M version 1.1, no I&M1 to I&M4.
        out.put(&[0, 0, 0, 0, 1, 1, 0, 0]);
        block::emit(BlockType::IM0, &out.bytes)
    }
}

/// A module that is really plugged into the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RealModule {
    /// Slot.
    pub slot: u16,
    /// Ident number.
    pub ident: u32,
    /// Submodules: subslot and ident number.
    pub submodules: Vec<(u16, u32)>,
}

/// Decodes the record of real modules.
pub fn parse_identification(record: &[u8]) -> Result<Vec<RealModule>, WireError> {
    let blocks = block::walk(record)?;
    let found = blocks.iter().find(|block| block.kind == BlockType::REAL_IDENTIFICATION);
    let found = found.ok_or(Reader::big(record).missing("RealIdentificationData"))?;
    let mut reader = Reader::big(found.body);
    let mut modules = Vec::new();
    // Blocks of version 1.0 contain no API numbers.
    let apis = if found.version.1 == 0 { 1 } else { reader.u16("NumberOfAPIs")? };
    for _ in 0..apis {
        if found.version.1 != 0 {
            reader.u32("API")?;
        }
        for _ in 0..reader.u16("NumberOfSlots")? {
            let slot = reader.u16("SlotNumber")?;
            let ident = reader.u32("ModuleIdentNumber")?;
            let submodules = (0..reader.u16("NumberOfSubslots")?)
                .map(|_| Ok((reader.u16("SubslotNumber")?, reader.u32("SubmoduleIdentNumber")?)))
                .collect::<Result<_, WireError>>()?;
            modules.push(RealModule { slot, ident, submodules });
        }
    }
    Ok(modules)
}

/// Encodes the record of real modules.
pub fn emit_identification(modules: &[RealModule]) -> Vec<u8> {
    let mut out = Writer::default();
    out.u16(1);
    out.u32(0);
    out.u16(count16(modules.len()));
    for module in modules {
        out.u16(module.slot);
        out.u32(module.ident);
        out.u16(count16(module.submodules.len()));
        for (subslot, ident) in &module.submodules {
            out.u16(*subslot);
            out.u32(*ident);
        }
    }
    block::emit_version(BlockType::REAL_IDENTIFICATION, (1, 1), &out.bytes)
}
