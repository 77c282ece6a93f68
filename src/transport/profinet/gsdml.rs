//! Parser for GSDML files. A GSDML file is the manufacturer's description of a device: access points, modules, data,
//! parameters.
//!
//! The content is untrusted, so its size is limited and its entities are not expanded. An error contains the line and
//! the element.

use std::borrow::Cow;

use roxmltree::{Document, Error, Node, ParsingOptions};
use thiserror::Error;

use super::layout::{Direction, Layout, Submodule};
use super::wire::record::Parameter;

/// Maximum size of a file in bytes.
pub const MAX_FILE_SIZE: u64 = 16 * 1024 * 1024;
/// Maximum number of elements and attributes.
const MAX_XML_NODES: u32 = 2_000_000;
/// Maximum number of modules per access point, and of submodules per module.
const MAX_MODULES: usize = 512;
/// Maximum number of access points.
const MAX_ACCESS_POINTS: usize = 64;
/// Maximum number of slots in a list.
const MAX_SLOTS: usize = 4096;
/// Maximum size of a parameter record in bytes.
const MAX_RECORD_LEN: usize = 4096;

/// Error in a GSDML file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}, {element}: {problem}")]
pub struct GsdmlError {
    /// Line number in the file.
    pub line: u32,
    /// Name of the element.
    pub element: String,
    /// What is wrong with the element.
    pub problem: String,
}

/// Description of a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Gsdml {
    /// Vendor id.
    pub vendor: u16,
    /// Device id.
    pub device: u16,
    /// Device access points in the file. A device uses one of them.
    pub heads: Vec<Head>,
}

/// Device access point (DAP): the module in slot 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Head {
    /// Id of the access point in the file.
    pub id: String,
    /// Display name.
    pub name: String,
    /// Station name of a new device.
    pub dns_name: String,
    /// Ident number of the access point module.
    pub ident: u32,
    /// Instance number in the object UUID.
    pub instance: u16,
    /// Shortest cycle that the device supports, in units of 31.25 us.
    pub shortest: u16,
    /// Whether the device supports the advanced startup mode, and whether it supports the legacy startup mode.
    pub startup: (bool, bool),
    /// Submodules of the access point.
    pub submodules: Vec<Item>,
    /// Modules that can be used with this access point.
    pub modules: Vec<SlottedModule>,
}

/// A module with its valid slots.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SlottedModule {
    /// Slots in which the module can be used.
    pub slots: Vec<u16>,
    /// Slots in which the device always has the module.
    pub fixed: Vec<u16>,
    /// The module.
    pub module: Module,
}

/// A module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Module {
    /// Id of the module in the file.
    pub id: String,
    /// Display name.
    pub name: String,
    /// Ident number of the module.
    pub ident: u32,
    /// Submodules of the module.
    pub submodules: Vec<Item>,
}

/// A submodule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// Subslot in which the submodule is plugged.
    pub subslot: u16,
    /// Ident number of the submodule.
    pub ident: u32,
    /// Bytes of input data.
    pub input: u16,
    /// Bytes of output data.
    pub output: u16,
    /// Parameter records that the controller writes when the connection opens: index and data.
    pub parameters: Vec<(u16, Vec<u8>)>,
}

impl Gsdml {
    /// Parses a file in UTF-8 or ISO 8859-1.
    pub fn parse(bytes: &[u8]) -> Result<Self, GsdmlError> {
        let whole = |problem: String| GsdmlError { line: 1, element: "file".to_owned(), problem };
        if u64::try_from(bytes.len()).is_ok_and(|length| length > MAX_FILE_SIZE) {
            return Err(whole(format!("it has {} bytes; at most {MAX_FILE_SIZE} are possible", bytes.len())));
        }
        let text = match std::str::from_utf8(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)) {
            Ok(text) => Cow::Borrowed(text),
            // In ISO 8859-1, each byte is the character with the same number.
            Err(_) => Cow::Owned(bytes.iter().copied().map(char::from).collect()),
        };
        let options = ParsingOptions { nodes_limit: MAX_XML_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(&text, options).map_err(|error| {
            // The error of a truncated file has no position, so the last line is used.
            let end = u32::try_from(text.lines().count()).unwrap_or(u32::MAX);
            let line = if matches!(error, Error::UnexpectedEndOfStream) { end } else { error.pos().row };
            GsdmlError { line, element: "file".to_owned(), problem: format!("it is not XML: {error}") }
        })?;
        Reader { document: &document }.device()
    }
}

impl Head {
    /// Returns the layout with these modules in these slots. Modules that the device always has are added
    /// automatically.
    ///
    /// # Errors
    /// A module does not fit into its slot, or the data does not fit into a frame.
    pub fn layout(&self, chosen: &[(u16, &SlottedModule)]) -> Result<Layout, String> {
        Layout::new(self.assign_slots(chosen)?.into_iter().map(|(submodule, _)| submodule).collect())
    }

    /// Returns the parameter records for the layout of these modules.
    pub fn parameters(&self, chosen: &[(u16, &SlottedModule)]) -> Result<Vec<Parameter>, String> {
        let assign_slots = self.assign_slots(chosen)?;
        let parameters = assign_slots.iter().flat_map(|(submodule, item)| {
            let record = |(index, data): &(u16, Vec<u8>)| Parameter {
                slot: submodule.slot,
                subslot: submodule.subslot,
                index: *index,
                data: data.clone(),
            };
            item.parameters.iter().map(record)
        });
        Ok(parameters.collect())
    }

    fn assign_slots<'a>(&'a self, chosen: &[(u16, &'a SlottedModule)]) -> Result<Vec<(Submodule, &'a Item)>, String> {
        let fixed = self.modules.iter().flat_map(|fitting| fitting.fixed.iter().map(move |slot| (*slot, fitting)));
        let mut all: Vec<(u16, &SlottedModule)> = fixed.collect();
        for (slot, fitting) in chosen {
            if !fitting.slots.contains(slot) {
                return Err(format!("module {} is not possible in slot {slot}", fitting.module.id));
            }
            if !all.contains(&(*slot, fitting)) {
                all.push((*slot, fitting));
            }
        }
        let place = |slot: u16, module: u32, item: &Item| Submodule {
            slot,
            subslot: item.subslot,
            module,
            ident: item.ident,
            input: item.input,
            output: item.output,
        };
        let head = self.submodules.iter().map(|item| (place(0, self.ident, item), item));
        let modules = all.iter().flat_map(|(slot, fitting)| {
            let module = &fitting.module;
            module.submodules.iter().map(move |item| (place(*slot, module.ident, item), item))
        });
        Ok(head.chain(modules).collect())
    }

    /// Selects modules for these image sizes. The selection consists of only the fixed modules, of one more module, or
    /// of one more module per direction. Returns `None` if no selection fits, or more than one.
    pub fn choose(&self, input: usize, output: usize) -> Option<Vec<(u16, &SlottedModule)>> {
        let fits = |chosen: &[(u16, &SlottedModule)]| {
            self.layout(chosen)
                .is_ok_and(|layout| (layout.size(Direction::Input), layout.size(Direction::Output)) == (input, output))
        };
        if fits(&[]) {
            return Some(Vec::new());
        }
        // A slot with a fixed module is not free.
        let is_taken = |slot: &u16| *slot == 0 || self.modules.iter().any(|module| module.fixed.contains(slot));
        let first = |fitting: &SlottedModule, other: Option<u16>| {
            fitting.slots.iter().copied().find(|slot| !is_taken(slot) && Some(*slot) != other)
        };
        let mut choices = Vec::new();
        for fitting in &self.modules {
            let Some(slot) = first(fitting, None) else { continue };
            if fits(&[(slot, fitting)]) {
                choices.push(vec![(slot, fitting)]);
            }
            if fitting.module.sizes() != (input, 0) {
                continue;
            }
            for second in self.modules.iter().filter(|second| second.module.sizes() == (0, output)) {
                let pair = first(second, Some(slot)).map(|other| vec![(slot, fitting), (other, second)]);
                choices.extend(pair.filter(|pair| fits(pair)));
            }
        }
        if choices.len() == 1 { choices.pop() } else { None }
    }
}

impl Module {
    /// Number of data bytes in a direction.
    pub fn size(&self, direction: Direction) -> usize {
        let length = |item: &Item| if direction == Direction::Input { item.input } else { item.output };
        self.submodules.iter().map(|item| usize::from(length(item))).sum()
    }

    fn sizes(&self) -> (usize, usize) {
        (self.size(Direction::Input), self.size(Direction::Output))
    }
}

struct Reader<'a, 'input> {
    document: &'a Document<'input>,
}

type GsdmlResult<T> = Result<T, GsdmlError>;

impl<'a, 'input> Reader<'a, 'input> {
    fn wrong(&self, node: Node<'_, '_>, problem: impl Into<String>) -> GsdmlError {
        let line = self.document.text_pos_at(node.range().start).row;
        GsdmlError { line, element: node.tag_name().name().to_owned(), problem: problem.into() }
    }

    fn all(&self, name: &'static str) -> impl Iterator<Item = Node<'a, 'input>> {
        self.document.descendants().filter(move |node| node.has_tag_name_local(name))
    }

    fn device(&self) -> GsdmlResult<Gsdml> {
        let root = self.document.root_element();
        let identity = self.all("DeviceIdentity").next();
        let identity = identity.ok_or_else(|| self.wrong(root, "DeviceIdentity is missing"))?;
        let (vendor, device) = (self.number(identity, "VendorID")?, self.number(identity, "DeviceID")?);
        let heads: Vec<_> = self.all("DeviceAccessPointItem").take(MAX_ACCESS_POINTS + 1).collect();
        if let Some(node) = heads.get(MAX_ACCESS_POINTS) {
            return Err(self.wrong(*node, format!("at most {MAX_ACCESS_POINTS} access points are possible")));
        }
        let heads = heads.into_iter().map(|node| self.head(node)).collect::<Result<Vec<_>, _>>()?;
        if heads.is_empty() {
            return Err(self.wrong(root, "DeviceAccessPointItem is missing"));
        }
        Ok(Gsdml { vendor, device, heads })
    }

    fn head(&self, node: Node<'a, 'input>) -> GsdmlResult<Head> {
        let mut submodules = self.items(node)?;
        for name in ["InterfaceSubmoduleItem", "PortSubmoduleItem"] {
            for item in node.descendants().filter(|item| item.has_tag_name_local(name)) {
                let subslot = self.number(item, "SubslotNumber")?;
                let ident = self.number32(item, "SubmoduleIdentNumber")?;
                submodules.push(Item { subslot, ident, input: 0, output: 0, parameters: Vec::new() });
            }
        }
        let relations = node.descendants().find(|item| item.has_tag_name_local("ApplicationRelations"));
        let modes = relations.and_then(|relations| relations.attribute("StartupMode")).unwrap_or("Legacy");
        let has_mode = |wanted: &str| modes.split(';').any(|mode| mode.trim() == wanted);
        let slots = self.slots(node, "PhysicalSlots")?;
        let references: Vec<_> = node.descendants().filter(|item| item.has_tag_name_local("ModuleItemRef")).collect();
        if references.len() > MAX_MODULES {
            return Err(self
                .wrong(node, format!("it can use {} modules; at most {MAX_MODULES} are possible", references.len())));
        }
        let modules =
            references.into_iter().map(|reference| self.fitting(reference, &slots)).collect::<Result<_, _>>()?;
        Ok(Head {
            id: self.text(node, "ID")?.to_owned(),
            name: self.name(node),
            dns_name: node.attribute("DNS_CompatibleName").unwrap_or_default().to_owned(),
            ident: self.number32(node, "ModuleIdentNumber")?,
            instance: self.optional(node, "ObjectUUID_LocalIndex")?.unwrap_or(1),
            shortest: self.optional(node, "MinDeviceInterval")?.unwrap_or(32),
            startup: (has_mode("Advanced"), has_mode("Legacy")),
            submodules,
            modules,
        })
    }

    fn fitting(&self, node: Node<'a, 'input>, slots: &[u16]) -> GsdmlResult<SlottedModule> {
        let target = self.text(node, "ModuleItemTarget")?;
        let module = self.all("ModuleItem").find(|module| module.attribute("ID") == Some(target));
        let module = module.ok_or_else(|| self.wrong(node, format!("ModuleItem '{target}' is missing")))?;
        let fixed = self.slots(node, "FixedInSlots")?;
        let mut allowed = self.slots(node, "AllowedInSlots")?;
        allowed.extend(&fixed);
        if allowed.is_empty() {
            allowed.extend(slots.iter().filter(|slot| **slot != 0));
        }
        let module = Module {
            id: target.to_owned(),
            name: self.name(module),
            ident: self.number32(module, "ModuleIdentNumber")?,
            submodules: self.items(module)?,
        };
        Ok(SlottedModule { slots: allowed, fixed, module })
    }

    /// Returns the submodules of a module or access point. A referenced submodule is included only if it is always in
    /// the same subslot.
    fn items(&self, node: Node<'a, 'input>) -> GsdmlResult<Vec<Item>> {
        let mut items = Vec::new();
        let add = |items: &mut Vec<Item>, node, subslot| {
            if items.len() == MAX_MODULES {
                return Err(self.wrong(node, format!("at most {MAX_MODULES} submodules are possible")));
            }
            items.push(self.item(node, subslot)?);
            Ok(())
        };
        for item in node.descendants().filter(|item| item.has_tag_name_local("VirtualSubmoduleItem")) {
            let fixed = self.slots(item, "FixedInSubslots")?;
            for subslot in if fixed.is_empty() { vec![1] } else { fixed } {
                add(&mut items, item, subslot)?;
            }
        }
        for reference in node.descendants().filter(|item| item.has_tag_name_local("SubmoduleItemRef")) {
            let target = self.text(reference, "SubmoduleItemTarget")?;
            let found = self.all("SubmoduleItem").find(|item| item.attribute("ID") == Some(target));
            let found = found.ok_or_else(|| self.wrong(reference, format!("SubmoduleItem '{target}' is missing")))?;
            for subslot in self.slots(reference, "FixedInSubslots")? {
                add(&mut items, found, subslot)?;
            }
        }
        Ok(items)
    }

    fn item(&self, node: Node<'a, 'input>, subslot: u16) -> GsdmlResult<Item> {
        let records = node.descendants().filter(|item| item.has_tag_name_local("ParameterRecordDataItem"));
        Ok(Item {
            subslot,
            ident: self.number32(node, "SubmoduleIdentNumber")?,
            input: self.length(node, "Input")?,
            output: self.length(node, "Output")?,
            parameters: records.map(|record| self.record(record)).collect::<Result<_, _>>()?,
        })
    }

    /// Number of data bytes of a submodule in a direction.
    fn length(&self, node: Node<'a, 'input>, direction: &str) -> GsdmlResult<u16> {
        let Some(data) = node.descendants().find(|item| item.has_tag_name_local(direction)) else { return Ok(0) };
        let mut bytes = 0u16;
        for item in data.children().filter(|item| item.has_tag_name_local("DataItem")) {
            let length = self.size(item)?;
            bytes = bytes.checked_add(length).ok_or_else(|| self.wrong(item, "the data is too long"))?;
        }
        Ok(bytes)
    }

    /// Number of bytes of a value, according to its data type.
    fn size(&self, node: Node<'a, 'input>) -> GsdmlResult<u16> {
        let kind = self.text(node, "DataType")?;
        Ok(match kind {
            "Boolean" | "Unsigned8" | "Integer8" => 1,
            "Unsigned16" | "Integer16" | "N2" | "V2" | "Unsigned8+Unsigned8" => 2,
            "Unsigned32" | "Integer32" | "Float32" | "N4" | "TimeOfDay" => 4,
            "Float32+Unsigned8" | "Float32+Status8" => 5,
            "Unsigned64" | "Integer64" | "Float64" => 8,
            "OctetString" | "VisibleString" | "UnicodeString8" => self.number(node, "Length")?,
            other => return Err(self.wrong(node, format!("the length of DataType '{other}' is unknown"))),
        })
    }

    /// Returns a parameter record that contains the default values.
    fn record(&self, node: Node<'a, 'input>) -> GsdmlResult<(u16, Vec<u8>)> {
        let index = self.number(node, "Index")?;
        let length = usize::from(self.number(node, "Length")?);
        if length > MAX_RECORD_LEN {
            return Err(self.wrong(node, format!("a record can have at most {MAX_RECORD_LEN} bytes")));
        }
        let mut data = vec![0; length];
        for part in node.children().filter(Node::is_element) {
            let at = usize::from(self.optional(part, "ByteOffset")?.unwrap_or(0));
            let bytes = match part.tag_name().name() {
                "Const" => self.constant(part)?,
                "Ref" => match self.value(part, data.get(at).copied().unwrap_or_default())? {
                    Some(bytes) => bytes,
                    None => continue,
                },
                _ => continue,
            };
            let place = data.get_mut(at..at + bytes.len());
            place.ok_or_else(|| self.wrong(part, "the value does not fit in the record"))?.copy_from_slice(&bytes);
        }
        Ok((index, data))
    }

    fn constant(&self, node: Node<'a, 'input>) -> GsdmlResult<Vec<u8>> {
        let text = self.text(node, "Data")?;
        let byte = |part: &str| parse(part).and_then(|number| u8::try_from(number).ok());
        let bytes: Option<Vec<u8>> = text.split(',').map(byte).collect();
        bytes.ok_or_else(|| self.wrong(node, format!("'{text}' is not a list of bytes")))
    }

    /// Returns the default value of a parameter. A value of single bits is combined with `byte`, which already contains
    /// the other bits.
    fn value(&self, node: Node<'a, 'input>, byte: u8) -> GsdmlResult<Option<Vec<u8>>> {
        let Some(text) = node.attribute("DefaultValue") else { return Ok(None) };
        let kind = self.text(node, "DataType")?;
        let wrong = || self.wrong(node, format!("'{text}' is not a valid {kind}"));
        let bits = match kind {
            "Bit" => 1,
            "BitArea" => self.number(node, "BitLength")?,
            _ => 0,
        };
        if bits > 0 {
            let shift = u32::from(self.optional(node, "BitOffset")?.unwrap_or(0));
            let value = parse(text).ok_or_else(wrong)?;
            let shifted = value.checked_shl(shift).and_then(|value| u8::try_from(value).ok());
            let fits = shift < 8 && u32::from(bits) <= 8 - shift && value >> bits == 0;
            return shifted.filter(|_| fits).map(|value| Some(vec![byte | value])).ok_or_else(wrong);
        }
        if kind == "VisibleString" || kind == "OctetString" {
            return Ok(None);
        }
        if kind == "Float32" {
            let value: f32 = text.parse().map_err(|_| wrong())?;
            return Ok(Some(value.to_be_bytes().to_vec()));
        }
        let size = usize::from(self.size(node)?);
        let value = text.parse::<i64>().ok().or_else(|| parse(text).map(i64::from)).ok_or_else(wrong)?;
        let bytes = value.to_be_bytes();
        let (upper, lower) = bytes.split_at(bytes.len().saturating_sub(size));
        // The value fits if the upper bytes contain only the sign.
        let fits = upper.iter().all(|byte| *byte == 0) || upper.iter().all(|byte| *byte == 0xFF);
        if fits { Ok(Some(lower.to_vec())) } else { Err(wrong()) }
    }

    /// Returns the display name. The name is in the text list of the file.
    fn name(&self, node: Node<'a, 'input>) -> String {
        let name = node.children().find(|item| item.has_tag_name_local("ModuleInfo"));
        let name = name.and_then(|info| info.children().find(|item| item.has_tag_name_local("Name")));
        let id = name.and_then(|name| name.attribute("TextId"));
        let text = id.and_then(|id| {
            let primary = self.all("PrimaryLanguage").next()?;
            let mut texts = primary.descendants().filter(|text| text.has_tag_name_local("Text"));
            texts.find(|text| text.attribute("TextId") == Some(id))?.attribute("Value")
        });
        text.unwrap_or_default().chars().filter(|c| !c.is_control()).collect()
    }

    fn text(&self, node: Node<'a, 'input>, name: &str) -> GsdmlResult<&'a str> {
        node.attribute(name).ok_or_else(|| self.wrong(node, format!("{name} is missing")))
    }

    fn number32(&self, node: Node<'a, 'input>, name: &str) -> GsdmlResult<u32> {
        let text = self.text(node, name)?;
        parse(text).ok_or_else(|| self.wrong(node, format!("{name} is not a number: '{text}'")))
    }

    fn number(&self, node: Node<'a, 'input>, name: &str) -> GsdmlResult<u16> {
        let number = self.number32(node, name)?;
        u16::try_from(number).map_err(|_| self.wrong(node, format!("{name} is above 65535: {number}")))
    }

    fn optional(&self, node: Node<'a, 'input>, name: &str) -> GsdmlResult<Option<u16>> {
        node.attribute(name).map(|_| self.number(node, name)).transpose()
    }

    /// Parses a list of numbers and ranges, for example `0..4 7`.
    fn slots(&self, node: Node<'a, 'input>, name: &str) -> GsdmlResult<Vec<u16>> {
        let mut slots = Vec::new();
        for part in node.attribute(name).unwrap_or_default().split_whitespace() {
            let number = |text: &str| parse(text).and_then(|number| u16::try_from(number).ok());
            let (first, last) = part.split_once("..").unwrap_or((part, part));
            let wrong = || self.wrong(node, format!("{name} is not a valid list of numbers: '{part}'"));
            let (first, last) = (number(first).ok_or_else(wrong)?, number(last).ok_or_else(wrong)?);
            slots.extend(first..=last);
            if slots.len() > MAX_SLOTS {
                return Err(self.wrong(node, format!("{name} has more than {MAX_SLOTS} numbers")));
            }
        }
        Ok(slots)
    }
}

/// Access to elements by their local name, because the namespace depends on the version of the file.
trait LocalName {
    fn has_tag_name_local(&self, name: &str) -> bool;
}

impl LocalName for Node<'_, '_> {
    fn has_tag_name_local(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

/// Parses a decimal number, or a hexadecimal number with `0x`.
fn parse(text: &str) -> Option<u32> {
    let text = text.trim();
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) if digits.starts_with(|c: char| c.is_ascii_hexdigit()) => u32::from_str_radix(digits, 16).ok(),
        None if text.starts_with(|c: char| c.is_ascii_digit()) => text.parse().ok(),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
