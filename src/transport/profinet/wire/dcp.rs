//! Codec for DCP: discovery, station names, IP addresses.
//!
//! DCP frames have no VLAN tag. Identify requests are multicast; all other frames are unicast.

use std::net::Ipv4Addr;

use super::{Reader, WireError, Writer, count16, text};

/// Maximum length of the blocks in a frame, in bytes.
const MAX_BLOCKS_LEN: usize = 1416;

/// DCP service.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Service {
    /// Reads settings of one station.
    Get,
    /// Changes settings of one station.
    Set,
    /// Finds stations.
    Identify,
    /// A station announces that it has started.
    Hello,
}

/// Type of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A request.
    Request,
    /// An answer.
    Response,
    /// The station does not support the service.
    Unsupported,
}

/// Option and suboption of a setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Setting(
    /// Option.
    pub u8,
    /// Suboption.
    pub u8,
);

impl Setting {
    /// MAC address.
    pub const MAC: Self = Self(1, 1);
    /// IP address, mask, gateway.
    pub const IP: Self = Self(1, 2);
    /// Type of the station, as text.
    pub const STATION_TYPE: Self = Self(2, 1);
    /// Name of the station.
    pub const NAME: Self = Self(2, 2);
    /// Vendor id and device id.
    pub const DEVICE_ID: Self = Self(2, 3);
    /// Role: device, controller, supervisor.
    pub const ROLE: Self = Self(2, 4);
    /// Supported options.
    pub const OPTIONS: Self = Self(2, 5);
    /// Alias: port name and name of the neighbor.
    pub const ALIAS: Self = Self(2, 6);
    /// Instance in the object UUID.
    pub const INSTANCE: Self = Self(2, 7);
    /// Makes the station blink.
    pub const SIGNAL: Self = Self(5, 3);
    /// Result of a Set request, in its answer.
    pub const RESPONSE: Self = Self(5, 4);
    /// Reset to factory settings.
    pub const RESET: Self = Self(5, 6);
    /// Filter that matches all stations.
    pub const ALL: Self = Self(255, 255);
}

/// A block: a setting and its data. The first two bytes of the data are the qualifier (in a request) or the block info
/// (in an answer).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// The setting.
    pub setting: Setting,
    /// Data; empty in a Get request.
    pub data: Vec<u8>,
}

impl Block {
    fn new(setting: Setting, parts: &[&[u8]]) -> Self {
        Self { setting, data: parts.concat() }
    }

    /// Returns a filter by station name.
    pub fn name_filter(name: &str) -> Self {
        Self::new(Setting::NAME, &[name.as_bytes()])
    }

    /// Returns a block that sets the station name, permanently or until power-off.
    pub fn set_name(name: &str, permanent: bool) -> Self {
        Self::new(Setting::NAME, &[&[0, u8::from(permanent)], name.as_bytes()])
    }

    /// Returns a block that sets the IP address, permanently or until power-off.
    pub fn set_ip(suite: &IpSuite, permanent: bool) -> Self {
        Self::new(Setting::IP, &[&[0, u8::from(permanent)], &suite.bytes()])
    }

    /// Returns a block that makes the station blink for about three seconds.
    pub fn signal() -> Self {
        Self::new(Setting::SIGNAL, &[&[0, 0, 1, 0]])
    }

    /// Returns a block that resets name and IP address. It uses mode 2, which all stations support.
    pub fn reset() -> Self {
        Self::new(Setting::RESET, &[&[0, 4]])
    }

    /// Returns a block with a value and its block info, for an answer.
    pub fn value(setting: Setting, info: u16, value: &[u8]) -> Self {
        Self::new(setting, &[&info.to_be_bytes(), value])
    }

    /// Returns a block with the result of a Set; error 0 means success.
    pub fn response(setting: Setting, error: u8) -> Self {
        Self::new(Setting::RESPONSE, &[&[setting.0, setting.1, error]])
    }
}

/// A DCP frame without its frame id.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dcp {
    /// Service.
    pub service: Service,
    /// Type of the frame.
    pub kind: Kind,
    /// Transaction id. The answer has the same transaction id as the request.
    pub xid: u32,
    /// Time within which stations answer an Identify request, in steps of 10 ms. Each station waits for its own delay.
    /// 0 for other services.
    pub delay: u16,
    /// Blocks.
    pub blocks: Vec<Block>,
}

impl Dcp {
    /// Creates a request that finds the station with this name. The station answers at once.
    pub fn identify(xid: u32, name: &str) -> Self {
        let blocks = vec![Block::name_filter(name)];
        Self { service: Service::Identify, kind: Kind::Request, xid, delay: 1, blocks }
    }

    /// Creates a request that finds all stations. They answer within `delay` steps of 10 ms, and each station waits for
    /// its own delay.
    pub fn identify_all(xid: u32, delay: u16) -> Self {
        let blocks = vec![Block { setting: Setting::ALL, data: Vec::new() }];
        Self { service: Service::Identify, kind: Kind::Request, xid, delay, blocks }
    }

    /// Creates a request that reads settings of a station.
    pub fn read(xid: u32, settings: &[Setting]) -> Self {
        let blocks = settings.iter().map(|setting| Block { setting: *setting, data: Vec::new() }).collect();
        Self { service: Service::Get, kind: Kind::Request, xid, delay: 0, blocks }
    }

    /// Creates a request that changes settings of a station.
    pub fn change(xid: u32, blocks: Vec<Block>) -> Self {
        Self { service: Service::Set, kind: Kind::Request, xid, delay: 0, blocks }
    }

    /// Creates an answer to this request.
    #[must_use]
    pub fn answer(&self, blocks: Vec<Block>) -> Self {
        Self { service: self.service, kind: Kind::Response, xid: self.xid, delay: 0, blocks }
    }

    /// Decodes the payload of a frame.
    pub fn parse(payload: &[u8]) -> Result<Self, WireError> {
        let mut reader = Reader::big(payload);
        let service = match reader.u8("ServiceID")? {
            3 => Service::Get,
            4 => Service::Set,
            5 => Service::Identify,
            6 => Service::Hello,
            other => return Err(reader.wrong("ServiceID", 1, other)),
        };
        let kind = match reader.u8("ServiceType")? {
            0 => Kind::Request,
            1 => Kind::Response,
            5 => Kind::Unsupported,
            other => return Err(reader.wrong("ServiceType", 1, other)),
        };
        let xid = reader.u32("Xid")?;
        let delay = reader.u16("ResponseDelay")?;
        let length = reader.u16("DCPDataLength")?;
        let start = reader.at;
        let mut inner = Reader::big(reader.take(usize::from(length), "blocks")?);
        let is_list = service == Service::Get && kind == Kind::Request;
        let blocks =
            read_blocks(&mut inner, is_list).map_err(|error| WireError { offset: error.offset + start, ..error })?;
        Ok(Self { service, kind, xid, delay, blocks })
    }

    /// Encodes the payload.
    pub fn emit(&self) -> Vec<u8> {
        let is_list = self.service == Service::Get && self.kind == Kind::Request;
        let mut blocks = Writer::default();
        for block in &self.blocks {
            blocks.u8(block.setting.0);
            blocks.u8(block.setting.1);
            if !is_list {
                blocks.u16(count16(block.data.len()));
                blocks.put(&block.data);
                blocks.zeros(block.data.len() % 2);
            }
        }
        let mut out = Writer::default();
        out.u8(match self.service {
            Service::Get => 3,
            Service::Set => 4,
            Service::Identify => 5,
            Service::Hello => 6,
        });
        out.u8(match self.kind {
            Kind::Request => 0,
            Kind::Response => 1,
            Kind::Unsupported => 5,
        });
        out.u32(self.xid);
        out.u16(self.delay);
        out.u16(count16(blocks.bytes.len()));
        out.put(&blocks.bytes);
        out.bytes
    }

    /// Decodes the station data of an Identify answer, a Get answer or a Hello.
    pub fn station(&self) -> Result<Station, WireError> {
        let mut station = Station::default();
        for block in &self.blocks {
            if block.setting == Setting::RESPONSE {
                continue;
            }
            let mut reader = Reader::big(&block.data);
            let info = reader.u16("BlockInfo")?;
            match block.setting {
                Setting::IP => station.ip = Some((IpSuite::read(&mut reader)?, IpOrigin(info))),
                Setting::STATION_TYPE => station.kind = text(reader.rest()),
                Setting::NAME => station.name = text(reader.rest()),
                Setting::DEVICE_ID => {
                    station.id = Some((reader.u16("vendor")?, reader.u16("device")?));
                }
                Setting::ROLE => station.role = reader.u8("role")?,
                Setting::ALIAS => station.alias = text(reader.rest()),
                Setting::INSTANCE => station.instance = Some(reader.u16("instance")?),
                Setting::OPTIONS => {
                    station.options = reader.rest().chunks_exact(2).map(|pair| Setting(pair[0], pair[1])).collect();
                }
                _ => {}
            }
        }
        Ok(station)
    }

    /// Decodes the results of a Set, and of settings that could not be read. Error 0 means success.
    pub fn outcomes(&self) -> Vec<(Setting, u8)> {
        let responses = self.blocks.iter().filter(|block| block.setting == Setting::RESPONSE);
        responses
            .filter_map(|block| Some((Setting(*block.data.first()?, *block.data.get(1)?), *block.data.get(2)?)))
            .collect()
    }
}

fn read_blocks(reader: &mut Reader<'_>, is_list: bool) -> Result<Vec<Block>, WireError> {
    let mut blocks = Vec::new();
    if reader.left() > MAX_BLOCKS_LEN {
        return Err(WireError::value("DCPDataLength", 0, u32::try_from(reader.left()).unwrap_or(u32::MAX)));
    }
    while reader.left() > 0 {
        let setting = Setting(reader.u8("option")?, reader.u8("suboption")?);
        let mut data = Vec::new();
        if !is_list {
            let length = usize::from(reader.u16("block length")?);
            data = reader.take(length, "block")?.to_vec();
            // Some stations do not send the padding of the last block.
            if length % 2 == 1 && reader.left() > 0 {
                reader.u8("padding")?;
            }
        }
        blocks.push(Block { setting, data });
    }
    Ok(blocks)
}

/// IP address, mask and gateway.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct IpSuite {
    /// IP address; 0.0.0.0 means that the station has none.
    pub address: Ipv4Addr,
    /// Subnet mask.
    pub mask: Ipv4Addr,
    /// Gateway. 0.0.0.0, or the address of the station itself, means that there is none.
    pub gateway: Ipv4Addr,
}

impl IpSuite {
    /// Encodes the three addresses.
    pub fn bytes(&self) -> [u8; 12] {
        let mut bytes = [0; 12];
        let parts = [self.address, self.mask, self.gateway];
        for (place, part) in bytes.chunks_exact_mut(4).zip(parts) {
            place.copy_from_slice(&part.octets());
        }
        bytes
    }

    /// Decodes the three addresses.
    pub fn parse(bytes: &[u8]) -> Result<Self, WireError> {
        Self::read(&mut Reader::big(bytes))
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, WireError> {
        let mut part = |field| reader.array::<4>(field).map(Ipv4Addr::from);
        Ok(Self { address: part("IP address")?, mask: part("mask")?, gateway: part("gateway")? })
    }

    /// Whether both addresses are in the same network.
    pub fn is_same_network(&self, other: Ipv4Addr) -> bool {
        let mask = u32::from(self.mask);
        u32::from(self.address) & mask == u32::from(other) & mask
    }
}

/// Origin of an IP address, as the block info codes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct IpOrigin(pub u16);

impl IpOrigin {
    /// Whether another station has the same address.
    pub const fn is_in_conflict(self) -> bool {
        self.0 & 0x80 != 0
    }

    /// Whether DHCP assigned the address.
    pub const fn is_by_dhcp(self) -> bool {
        self.0 & 3 == 2
    }
}

/// Data that a station reports about itself.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Station {
    /// Station name. It may be empty.
    pub name: String,
    /// Station type.
    pub kind: String,
    /// Vendor id and device id.
    pub id: Option<(u16, u16)>,
    /// Role bits: bit 0 device, bit 1 controller, bit 2 multi-device, bit 3 supervisor.
    pub role: u8,
    /// Alias: port name and name of the neighbor.
    pub alias: String,
    /// Instance in the object UUID.
    pub instance: Option<u16>,
    /// IP address and its origin.
    pub ip: Option<(IpSuite, IpOrigin)>,
    /// Supported options.
    pub options: Vec<Setting>,
}

impl Station {
    /// IP address; `None` if the station has none.
    pub fn address(&self) -> Option<Ipv4Addr> {
        self.ip.map(|(suite, _)| suite.address).filter(|address| !address.is_unspecified())
    }
}

/// Text of a DCP error code.
pub fn describe_error(error: u8) -> &'static str {
    match error {
        0 => "done",
        1 => "the station does not have this option",
        2 => "the station does not have this setting, or no value for it",
        3 => "the station did not accept the value",
        4 => "the station is out of resources",
        5 => "not possible at the moment, for a reason in the station",
        6 => "not possible while a controller is connected to the station",
        _ => "an unknown error",
    }
}

/// Checks a station name. The rules are those for host name labels in lower case.
pub fn check_name(name: &str) -> Result<(), String> {
    if name.is_empty() || name.len() > 240 {
        return Err(format!("it has {} characters; 1 to 240 are allowed", name.len()));
    }
    if let Some(wrong) = name.chars().find(|c| !matches!(c, 'a'..='z' | '0'..='9' | '-' | '.')) {
        let hint = if wrong.is_ascii_uppercase() { "; upper case is not allowed" } else { "" };
        return Err(format!("'{wrong}' is not allowed: only a-z, 0-9, '-' and '.' are{hint}"));
    }
    for label in name.split('.') {
        if label.is_empty() || label.len() > 63 {
            return Err(format!("the part '{label}' has {} characters; 1 to 63 are allowed between dots", label.len()));
        }
        if label.starts_with('-') || label.ends_with('-') {
            return Err(format!("the part '{label}' begins or ends with '-'"));
        }
    }
    let first = name.split('.').next().unwrap_or_default();
    if is_port(first) {
        return Err(format!("'{first}' is reserved for port names"));
    }
    if name.split('.').count() == 4 && name.split('.').all(|label| label.parse::<u16>().is_ok()) {
        return Err("it has the form of an IP address".to_owned());
    }
    Ok(())
}

/// Whether a label has the form `port-NNN` or `port-NNN-NNNNN`.
fn is_port(label: &str) -> bool {
    let digits = |text: &str, count| text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit());
    let Some(rest) = label.strip_prefix("port-") else { return false };
    match rest.split_once('-') {
        None => digits(rest, 3),
        Some((port, slot)) => digits(port, 3) && digits(slot, 5),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Mac;
    use super::super::frame::{Frame, id};
    use super::*;
    use crate::testing::hex;

    const OUR_ADDRESS: Mac = Mac([2, 0, 0, 0, 0, 1]);
    const DEVICE_ADDRESS: Mac = Mac([2, 0, 0, 0, 0, 2]);

    fn suite() -> IpSuite {
        let address = Ipv4Addr::new(192, 168, 78, 2);
        IpSuite { address, mask: Ipv4Addr::new(255, 255, 255, 0), gateway: address }
    }

    /// The first frame of a connection is from the worked example in the notes.
    #[test]
    fn encodes_a_search_by_name() {
        let dcp = Dcp::identify(0x0100_0001, "yrcx-sim");
        let payload = dcp.emit();
        let frame = Frame {
            destination: Mac::DCP_IDENTIFY,
            source: OUR_ADDRESS,
            tag: None,
            id: id::DCP_IDENTIFY,
            payload: &payload,
        };
        let mut bytes = hex("010ECF000000 020000000001 8892 FEFE 05 00 01000001 0001 000C 02 02 0008");
        bytes.extend(b"yrcx-sim");
        bytes.resize(60, 0);
        assert_eq!(frame.emit(), bytes);
        assert_eq!(Dcp::parse(Frame::parse(&bytes).unwrap().payload), Ok(dcp));
    }

    /// The answer of the station is from the worked example in the notes.
    #[test]
    fn parses_an_identify_answer() {
        let bytes = hex(concat!(
            "020000000001 020000000002 8892 FEFF 05 01 01000001 0000 0056 0202 000A 0000 797263782D73696D",
            "02 05 0008 0000 0102 0202 0203  02 01 000B 0000 59524358206C696B65 00  02 03 0006 0000 FFFF 0001",
            "02 04 0004 0000 01 00  02 07 0004 0000 0001  01 02 000E 0001 C0A84E02 FFFFFF00 C0A84E02",
        ));
        let frame = Frame::parse(&bytes).unwrap();
        assert_eq!((frame.source, frame.id), (DEVICE_ADDRESS, id::DCP_IDENTIFIED));
        let dcp = Dcp::parse(frame.payload).unwrap();
        let station = dcp.station().unwrap();
        assert_eq!((station.name.as_str(), station.kind.as_str()), ("yrcx-sim", "YRCX like"));
        assert_eq!((station.id, station.role, station.instance), (Some((0xFFFF, 1)), 1, Some(1)));
        assert_eq!(station.ip, Some((suite(), IpOrigin(1))));
        assert_eq!(station.options, [Setting::IP, Setting::NAME, Setting::DEVICE_ID]);
        assert_eq!(Frame { payload: &dcp.emit(), ..frame }.emit(), bytes);
    }

    /// Set and Get are from the worked example in the notes.
    #[test]
    fn set_and_get_frames_match_the_example() {
        let cases = [
            (
                Dcp::change(9, vec![Block::set_name("robot-7", false)]),
                "04 00 00000009 0000 000E 0202 0009 0000 726F626F742D37 00",
            ),
            (
                Dcp::change(9, vec![Block::set_ip(&suite(), false)]),
                "04 00 00000009 0000 0012 0102 000E 0000 C0A84E02 FFFFFF00 C0A84E02",
            ),
            (Dcp::change(9, vec![Block::signal()]), "04 00 00000009 0000 0008 0503 0004 0000 0100"),
            (Dcp::change(9, vec![Block::reset()]), "04 00 00000009 0000 0006 0506 0002 0004"),
            (Dcp::read(9, &[Setting::NAME]), "03 00 00000009 0000 0002 0202"),
            (Dcp::identify_all(9, 128), "05 00 00000009 0080 0004 FFFF 0000"),
        ];
        for (dcp, text) in cases {
            assert_eq!(dcp.emit(), hex(text), "{dcp:?}");
            assert_eq!(Dcp::parse(&hex(text)), Ok(dcp));
        }
        let answer = Dcp::parse(&hex("04 01 00000009 0000 0008 0504 0003 02 02 06 00")).unwrap();
        assert_eq!(answer.outcomes(), [(Setting::NAME, 6)]);
        let request = Dcp::change(9, vec![Block::set_name("x", true)]);
        assert_eq!(request.answer(vec![Block::response(Setting::NAME, 6)]), answer);
    }

    #[test]
    fn rejects_invalid_station_names_with_a_reason() {
        for name in ["yrcx-sim", "a", "robot-7.cell-3", "1.2.3.x", "port-01", "port-0011", "1.2.3", &"a".repeat(63)] {
            assert_eq!(check_name(name), Ok(()), "{name}");
        }
        let long = format!("{0}.{0}.{0}.{0}", "a".repeat(60));
        let cases = [
            ("", "0 characters"),
            (long.as_str(), "243 characters"),
            ("Robot", "upper case"),
            ("plc_bench", "'_' is not allowed"),
            ("cell 3", "' ' is not allowed"),
            ("a..b", "the part ''"),
            ("-a.b", "begins or ends"),
            ("a.b-", "begins or ends"),
            ("port-001", "port names"),
            ("port-001-00002.cell", "port names"),
            ("192.168.0.1", "IP address"),
        ];
        for (name, reason) in cases {
            let said = check_name(name).unwrap_err();
            assert!(said.contains(reason), "{name}: {said}");
        }
        assert!(check_name(&"a".repeat(64)).is_err());
    }
}
