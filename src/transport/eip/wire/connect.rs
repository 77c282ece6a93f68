//! Codec for the connection manager: ForwardOpen and ForwardClose (volume 1, 3-5.5).

use super::{Path, Reader, Request, WireError, service, words8};

/// Class and instance of the connection manager.
const MANAGER: (u32, u32) = (6, 1);
/// Time limit for routers on the path: 249 ticks of 128 ms. This is the second largest value that the field can have.
const UNCONNECTED_SEND_TIMEOUT: [u8; 2] = [7, 249];
/// Maximum connection size in the short ForwardOpen.
const MAX_SHORT_SIZE: u16 = 511;

/// Connection triad. It identifies a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Triad {
    /// Connection serial number, unique for the originator.
    pub serial: u16,
    /// Vendor id of the originator.
    pub vendor: u16,
    /// Serial number of the originator.
    pub originator: u32,
}

impl Triad {
    fn read(reader: &mut Reader<'_>) -> Result<Self, WireError> {
        let serial = reader.u16("connection serial number")?;
        let vendor = reader.u16("originator vendor")?;
        let originator = reader.u32("originator serial number")?;
        Ok(Self { serial, vendor, originator })
    }

    fn bytes(self) -> [u8; 8] {
        let mut out = [0; 8];
        out[0..2].copy_from_slice(&self.serial.to_le_bytes());
        out[2..4].copy_from_slice(&self.vendor.to_le_bytes());
        out[4..8].copy_from_slice(&self.originator.to_le_bytes());
        out
    }
}

/// Connection type of one direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Net {
    /// No connection.
    Null,
    /// Multicast.
    Multicast,
    /// Point to point.
    PointToPoint,
    /// Reserved value.
    Reserved,
}

const NETS: [Net; 4] = [Net::Null, Net::Multicast, Net::PointToPoint, Net::Reserved];

/// Network connection parameters of one direction (volume 1, 3-5.5.1.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Flow {
    /// Requested packet interval in microseconds.
    pub rpi_us: u32,
    /// Connection type.
    pub net: Net,
    /// Packet size in bytes: sequence count, header and data. At most 511 in the short form.
    pub size: u16,
    /// Whether smaller packets are also valid.
    pub variable: bool,
    /// Priority: 0 low, 1 high, 2 scheduled, 3 urgent.
    pub priority: u8,
    /// Whether more than one originator can own the connection.
    pub redundant: bool,
}

impl Flow {
    fn read(reader: &mut Reader<'_>, large: bool) -> Result<Self, WireError> {
        let rpi_us = reader.u32("requested packet interval")?;
        let (bits, size) = if large {
            let size = reader.u16("connection size")?;
            (reader.u16("connection parameters")?, size)
        } else {
            let bits = reader.u16("connection parameters")?;
            (bits, bits & MAX_SHORT_SIZE)
        };
        Ok(Self {
            rpi_us,
            net: NETS[usize::from(bits >> 13 & 3)],
            size,
            variable: bits >> 9 & 1 == 1,
            priority: [0, 1, 2, 3][usize::from(bits >> 10 & 3)],
            redundant: bits >> 15 == 1,
        })
    }

    fn emit(&self, large: bool, out: &mut Vec<u8>) {
        let net = NETS.iter().zip(0u16..).find_map(|(net, code)| (*net == self.net).then_some(code)).unwrap_or(0);
        let bits = u16::from(self.redundant) << 15
            | net << 13
            | u16::from(self.priority & 3) << 10
            | u16::from(self.variable) << 9;
        out.extend(self.rpi_us.to_le_bytes());
        if large {
            out.extend(self.size.to_le_bytes());
            out.extend(bits.to_le_bytes());
        } else {
            out.extend((bits | self.size).to_le_bytes());
        }
    }
}

/// ForwardOpen request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Open {
    /// O->T connection id. The target ignores this id and selects its own.
    pub o_t_id: u32,
    /// T->O connection id, selected by the originator. For multicast, the target ignores it.
    pub t_o_id: u32,
    /// Connection triad.
    pub triad: Triad,
    /// Code 0 to 7 of the timeout multiplier, for 4, 8, … 512 intervals.
    pub multiplier: u8,
    /// Parameters from originator to target.
    pub o_t: Flow,
    /// Parameters from target to originator.
    pub t_o: Flow,
    /// Transport: class in bits 3 to 0, trigger in bits 6 to 4. The value 1 means class 1, cyclic.
    pub transport: u8,
    /// Path: key, class, configuration, connection points, configuration data.
    pub path: Path,
}

impl Open {
    /// Encodes the request. Uses LargeForwardOpen if a size requires this.
    pub fn emit(&self) -> Vec<u8> {
        let large = self.is_large();
        let mut data = UNCONNECTED_SEND_TIMEOUT.to_vec();
        data.extend(self.o_t_id.to_le_bytes());
        data.extend(self.t_o_id.to_le_bytes());
        data.extend(self.triad.bytes());
        data.extend([self.multiplier, 0, 0, 0]);
        self.o_t.emit(large, &mut data);
        self.t_o.emit(large, &mut data);
        let path = self.path.emit();
        data.extend([self.transport, words8(path.len())]);
        data.extend(path);
        manager(if large { service::LARGE_FORWARD_OPEN } else { service::FORWARD_OPEN }, &data)
    }

    /// Whether a size is too large for the short ForwardOpen.
    pub fn is_large(&self) -> bool {
        self.o_t.size.max(self.t_o.size) > MAX_SHORT_SIZE
    }

    /// Decodes the request data.
    pub fn parse(data: &[u8], large: bool) -> Result<Self, WireError> {
        let mut reader = Reader::little(data);
        reader.take(UNCONNECTED_SEND_TIMEOUT.len(), "time-out of the request")?;
        let o_t_id = reader.u32("O->T connection id")?;
        let t_o_id = reader.u32("T->O connection id")?;
        let triad = Triad::read(&mut reader)?;
        let multiplier = reader.u8("time-out multiplier")?;
        reader.take(3, "reserved")?;
        let o_t = Flow::read(&mut reader, large)?;
        let t_o = Flow::read(&mut reader, large)?;
        let transport = reader.u8("transport class and trigger")?;
        let words = reader.u8("words of the connection path")?;
        let start = reader.at;
        let path = Path::parse(reader.take(usize::from(words) * 2, "connection path")?)
            .map_err(|error| WireError { offset: error.offset + start, ..error })?;
        reader.end("end of the request")?;
        Ok(Self { o_t_id, t_o_id, triad, multiplier, o_t, t_o, transport, path })
    }
}

/// Data of a successful ForwardOpen reply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Opened {
    /// O->T connection id.
    pub o_t_id: u32,
    /// T->O connection id.
    pub t_o_id: u32,
    /// Connection triad.
    pub triad: Triad,
    /// Actual packet interval to the target, in microseconds.
    pub o_t_api_us: u32,
    /// Actual packet interval from the target, in microseconds.
    pub t_o_api_us: u32,
    /// Application reply data.
    pub application: Vec<u8>,
}

impl Opened {
    /// Decodes the reply data.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(data);
        let o_t_id = reader.u32("O->T connection id")?;
        let t_o_id = reader.u32("T->O connection id")?;
        let triad = Triad::read(&mut reader)?;
        let o_t_api_us = reader.u32("O->T actual packet interval")?;
        let t_o_api_us = reader.u32("T->O actual packet interval")?;
        let words = reader.u8("words of the application reply")?;
        reader.u8("reserved")?;
        let application = reader.take(usize::from(words) * 2, "application reply")?.to_vec();
        Ok(Self { o_t_id, t_o_id, triad, o_t_api_us, t_o_api_us, application })
    }

    /// Encodes the reply data.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(26 + self.application.len());
        out.extend(self.o_t_id.to_le_bytes());
        out.extend(self.t_o_id.to_le_bytes());
        out.extend(self.triad.bytes());
        out.extend(self.o_t_api_us.to_le_bytes());
        out.extend(self.t_o_api_us.to_le_bytes());
        out.extend([words8(self.application.len()), 0]);
        out.extend(&self.application);
        out
    }
}

/// Data of an unsuccessful ForwardOpen or ForwardClose reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Refused {
    /// Connection triad.
    pub triad: Triad,
    /// Number of path words that the target has not processed. Some devices omit it.
    pub remaining: Option<u8>,
}

impl Refused {
    /// Decodes the reply data.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(data);
        Ok(Self { triad: Triad::read(&mut reader)?, remaining: reader.u8("remaining path").ok() })
    }

    /// Encodes the reply data.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = self.triad.bytes().to_vec();
        if let Some(remaining) = self.remaining {
            out.extend([remaining, 0]);
        }
        out
    }
}

/// ForwardClose request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Close {
    /// Connection triad.
    pub triad: Triad,
    /// Path of the ForwardOpen that opened the connection.
    pub path: Path,
}

impl Close {
    /// Encodes the request.
    pub fn emit(&self) -> Vec<u8> {
        let mut data = UNCONNECTED_SEND_TIMEOUT.to_vec();
        data.extend(self.triad.bytes());
        let path = self.path.emit();
        data.extend([words8(path.len()), 0]);
        data.extend(path);
        manager(service::FORWARD_CLOSE, &data)
    }

    /// Decodes the request data.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(data);
        reader.take(UNCONNECTED_SEND_TIMEOUT.len(), "time-out of the request")?;
        let triad = Triad::read(&mut reader)?;
        let words = reader.u8("words of the connection path")?;
        reader.u8("reserved")?;
        let start = reader.at;
        let path = Path::parse(reader.take(usize::from(words) * 2, "connection path")?)
            .map_err(|error| WireError { offset: error.offset + start, ..error })?;
        reader.end("end of the request")?;
        Ok(Self { triad, path })
    }
}

/// Data of a successful ForwardClose reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Closed {
    /// Connection triad.
    pub triad: Triad,
}

impl Closed {
    /// Decodes the reply data.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        Ok(Self { triad: Triad::read(&mut Reader::little(data))? })
    }

    /// Encodes the reply data, without application data.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = self.triad.bytes().to_vec();
        out.extend([0, 0]);
        out
    }
}

fn manager(service: u8, data: &[u8]) -> Vec<u8> {
    Request { service, path: Path::object(MANAGER.0, MANAGER.1), data }.emit()
}

#[cfg(test)]
mod tests {
    use super::super::{Frame, Key, Reply, RrData, Segment, Status};
    use super::*;
    use crate::testing::hex;

    fn cyclic(size: u16) -> Flow {
        Flow { rpi_us: 20_000, net: Net::PointToPoint, size, variable: false, priority: 2, redundant: false }
    }

    fn open(o_t: u16, t_o: u16) -> Open {
        Open {
            o_t_id: 0,
            t_o_id: 0x1234_5678,
            triad: Triad { serial: 0x0102, vendor: 0x0304, originator: 0x0506_0708 },
            multiplier: 2,
            o_t: cyclic(o_t),
            t_o: cyclic(t_o),
            transport: 1,
            path: Path(vec![Segment::Class(4), Segment::Instance(151), Segment::Point(150), Segment::Point(100)]),
        }
    }

    /// The expected bytes were built field by field from volume 1, table 3-5.17. The parameters 4836 and 4832 mean
    /// point to point, scheduled, fixed size, and 54 and 50 bytes. tshark decodes these bytes to the same values
    /// (tests/eip).
    #[test]
    fn an_open_has_the_printed_layout() {
        let bytes = hex(
            "54 02 20 06 24 01 07 F9 00000000 78563412 0201 0403 08070605 02 000000 204E0000 3648 204E0000 3248 01 04 \
             20 04 24 97 2C 96 2C 64",
        );
        assert_eq!(open(54, 50).emit(), bytes);
        assert_eq!(Open::parse(&bytes[6..], false), Ok(open(54, 50)));
    }

    #[test]
    fn large_sizes_take_the_large_form() {
        let large = open(54, 512);
        let bytes = large.emit();
        assert_eq!(bytes[0], 0x5B);
        assert_eq!(bytes[28..36], hex("204E0000 3600 0048"));
        assert_eq!(bytes[36..44], hex("204E0000 0002 0048"));
        assert_eq!(Open::parse(&bytes[6..], true), Ok(large));
        assert!(!open(511, 511).is_large());
    }

    /// A class 1 request of a servo drive tool. It has a key and configuration data, 10 bytes out, 6 bytes in,
    /// multiplier 12 and an interval of 10 ms.
    #[test]
    fn an_open_with_a_key_and_configuration_data() {
        let bytes = hex("05 9B 00000000 08401100 0100 0100 9964D200 02 000000 10270000 0A48 10270000 0648 01 0E \
             34 04 0000 0000 0000 00 00 20 04 24 7A 2C 66 2C 65 80 04 0000000000000000");
        let open = Open::parse(&bytes, false).unwrap();
        assert_eq!((open.o_t.size, open.t_o.size, open.o_t.rpi_us, open.multiplier), (10, 6, 10_000, 2));
        assert_eq!(open.o_t.net, Net::PointToPoint);
        let path = [
            Segment::Key(Key::default()),
            Segment::Class(4),
            Segment::Instance(122),
            Segment::Point(102),
            Segment::Point(101),
            Segment::Data(vec![0; 8]),
        ];
        assert_eq!(open.path.0, path);
        // The encoded request equals the decoded one, except for the time limit for routers.
        assert_eq!(open.emit()[8..], bytes[2..]);
    }

    /// A complete exchange from cpppo's tests (enip_test.py, `fwd_o01_request`, `fwd_o01_reply`).
    #[test]
    fn a_recorded_open_and_its_reply() {
        let request =
            hex("6F00 4000 05000D00 00000000 D0920000 5080FF07 00000000 00000000 2000 0200 0000 0000 B200 3000 \
             54 02 20 06 24 01 07 F9 11000080 1000FE80 1100 4D00 0F7F3D1E 00 000000 00127A00 F443 00127A00 F443 A3 03 \
             0100 2002 2401");
        let frame = Frame::parse(&request).unwrap();
        let data = RrData::parse(frame.data).unwrap();
        let message = Request::parse(data.message).unwrap();
        let open = Open::parse(message.data, false).unwrap();
        assert_eq!(open.triad, Triad { serial: 0x11, vendor: 0x4D, originator: 0x1E3D_7F0F });
        assert_eq!((open.o_t.size, open.o_t.variable, open.o_t.rpi_us), (500, true, 8_000_000));
        assert_eq!(open.emit(), data.message);
        let frame = Frame { data: &RrData { timeout: 32, ..RrData::new(&open.emit()) }.emit(), ..frame };
        assert_eq!(frame.emit(), request);

        let reply =
            hex("6F00 2E00 05000D00 00000000 D0920000 5080FF07 00000000 00000000 0000 0200 0000 0000 B200 1E00 \
             D4 00 00 00 2640A3FF 1000FE80 1100 4D00 0F7F3D1E 00127A00 00127A00 00 00");
        let data = RrData::parse(Frame::parse(&reply).unwrap().data).unwrap();
        let reply = Reply::parse(data.message).unwrap();
        let opened = Opened::parse(reply.data).unwrap();
        assert_eq!((opened.o_t_id, opened.t_o_id, opened.triad), (0xFFA3_4026, 0x80FE_0010, open.triad));
        assert_eq!((opened.o_t_api_us, opened.t_o_api_us), (8_000_000, 8_000_000));
        assert_eq!(opened.emit(), reply.data);
    }

    /// The bytes are from the same tests of cpppo (`fwd_f01_reply`, and without the remaining path
    /// `fwd_f01_reply_no_remain`).
    #[test]
    fn recorded_refusals() {
        let triad = Triad { serial: 0, vendor: 0xFFFF, originator: 0x1234_5678 };
        for (text, remaining) in [("0000 FFFF 78563412 01 00", Some(1)), ("0000 FFFF 78563412", None)] {
            let bytes = [hex("D4 00 01 01 1103"), hex(text)].concat();
            let reply = Reply::parse(&bytes).unwrap();
            assert_eq!(reply.status, Status::connection(0x0311, &[]));
            let refused = Refused::parse(reply.data).unwrap();
            assert_eq!(refused, Refused { triad, remaining });
            assert_eq!(refused.emit(), reply.data);
        }
    }

    /// The bytes are from the same tests of cpppo (`fwd_c01_request`).
    #[test]
    fn a_recorded_close() {
        let bytes = hex("4E 02 20 06 24 01 07 F9 0100 4D00 0F7F3D1E 03 00 0100 2002 2401");
        let close = Close::parse(&bytes[6..]).unwrap();
        assert_eq!(close.triad, Triad { serial: 1, vendor: 0x4D, originator: 0x1E3D_7F0F });
        let path = [Segment::Port { port: 1, link: vec![0] }, Segment::Class(2), Segment::Instance(1)];
        assert_eq!(close.path.0, path);
        assert_eq!(close.emit(), bytes);
        let closed = Closed { triad: close.triad };
        assert_eq!(Closed::parse(&closed.emit()), Ok(closed));
    }
}
