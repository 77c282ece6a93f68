//! Checks of a ForwardOpen, and the decision whether to accept it.

use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::Duration;

use super::super::settings::{Multiplier, Role};
use super::super::wire::{Flow, Key, Net, Open, Opened, Problem, Refused, Segment, Status};
use super::super::{ASSEMBLY, IO_PORT, Now};
use super::{
    Adapter, AdapterFault, Application, Consumer, Event, IoConnection, NOT_ENOUGH_DATA, Peer, Producer, Purpose, Setup,
};
use crate::refuse_if;

/// Extended status codes (volume 1, table 3-5.29).
const DUPLICATE: u16 = 0x0100;
const TRANSPORT: u16 = 0x0103;
const OWNED: u16 = 0x0106;
const CONNECTION_TYPE: u16 = 0x0108;
const SIZE: u16 = 0x0109;
const RPI: u16 = 0x0111;
const OUT_OF_CONNECTIONS: u16 = 0x0113;
const VENDOR_OR_PRODUCT: u16 = 0x0114;
const DEVICE_TYPE: u16 = 0x0115;
const REVISION: u16 = 0x0116;
const POINT: u16 = 0x0117;
const CONFIGURATION: u16 = 0x0118;
const NO_CONNECTION_TO_LISTEN: u16 = 0x0119;
const CONFIGURATION_SIZE: u16 = 0x0126;
const SEGMENT: u16 = 0x0315;
/// General status for an invalid timeout multiplier.
const INVALID_PARAMETER: u8 = 0x20;

/// Transport class 1, cyclic, with the originator as client. The adapter supports no other transport.
const CYCLIC: u8 = 0x01;
/// Valid heartbeat sizes: empty, a sequence count, or a sequence count with a run/idle header.
const HEARTBEATS: [u16; 3] = [0, COUNT, COUNT + HEADER];
const COUNT: u16 = 2;
const HEADER: u16 = 4;

/// An accepted connection.
pub(super) struct AcceptedConnection {
    /// Data of the reply.
    pub(super) data: Vec<u8>,
    /// Addresses of the images to the adapter and to the originator.
    pub(super) addresses: (Option<SocketAddrV4>, Option<SocketAddrV4>),
}

/// Decoded connection path.
#[derive(Debug)]
struct ConnectionPoints<'a> {
    key: Option<Key>,
    configuration: Option<u32>,
    output: u32,
    input: u32,
    data: &'a [u8],
}

impl<A: Application> Adapter<A> {
    pub(super) fn open(
        &mut self,
        now: Now,
        from: Ipv4Addr,
        to: Option<SocketAddrV4>,
        data: &[u8],
        large: bool,
    ) -> Result<AcceptedConnection, (Status, Vec<u8>)> {
        let open = Open::parse(data, large).map_err(|error| {
            let in_path = matches!(error.problem, Problem::Value(_));
            let status = if in_path { Status::connection(SEGMENT, &[]) } else { Status::general(NOT_ENOUGH_DATA) };
            (status, Vec::new())
        })?;
        self.accepted_connection(now, from, to, &open)
            .map_err(|status| (status, Refused { triad: open.triad, remaining: Some(0) }.emit()))
    }

    fn accepted_connection(
        &mut self,
        now: Now,
        from: Ipv4Addr,
        to: Option<SocketAddrV4>,
        open: &Open,
    ) -> Result<AcceptedConnection, Status> {
        let connection_points = connection_points(open)?;
        // Some boards check whether the outputs have an owner before they check the sizes.
        let is_owned =
            self.connections.iter().any(|connections| connections.peer.output == Some(connection_points.output));
        refuse_if(self.fault == Some(AdapterFault::Unowned) && is_owned, Status::connection(OWNED, &[]))?;
        let role = self.setup.allows(open, &connection_points)?;
        let intervals = Multiplier::from_code(open.multiplier).ok_or(Status::general(INVALID_PARAMETER))?.intervals();
        refuse_if(
            self.connections.iter().any(|connections| connections.triad == open.triad),
            Status::connection(DUPLICATE, &[]),
        )?;
        let output = (role == Role::ExclusiveOwner).then_some(connection_points.output);
        if output.is_some() && self.connections.iter().any(|connections| connections.peer.output == output) {
            return Err(Status::connection(OWNED, &[]));
        }
        refuse_if(self.connections.len() >= self.setup.most_connections, Status::connection(OUT_OF_CONNECTIONS, &[]))?;
        let o_t = self.setup.interval(&open.o_t);
        let mut t_o = self.setup.interval(&open.t_o);
        let is_multicast = open.t_o.net == Net::Multicast;
        // In a multicast group, one producer sends for all connections with the same interval. A listen-only connection
        // accepts any interval.
        let shared = self.connections.iter().find(|connections| {
            let fits = connections.peer.t_o == t_o || role == Role::ListenOnly;
            connections.is_multicast && is_multicast && connections.peer.input == connection_points.input && fits
        });
        let shared = shared.map(|connections| (connections.t_o_id, connections.peer.t_o));
        refuse_if(role == Role::ListenOnly && shared.is_none(), Status::connection(NO_CONNECTION_TO_LISTEN, &[]))?;
        let o_t_id = self.next_id();
        let (t_o_id, producer) = if let Some((id, interval)) = shared {
            t_o = interval;
            (id, None)
        } else {
            let id = if is_multicast { self.next_id() } else { open.t_o_id };
            (id, Some(Producer::new(id, t_o, now)))
        };
        let group = is_multicast.then(|| SocketAddrV4::new(self.setup.group, IO_PORT));
        // The request contains only the port of the originator. The address is that of the sender of the request.
        let port = to.map(|address| address.port()).filter(|port| *port != 0);
        let own = SocketAddrV4::new(from, port.unwrap_or(IO_PORT));
        let header = open.o_t.size >= COUNT + HEADER;
        let size = output.and_then(|output| self.setup.assembly(output, Purpose::Output)).map_or(0, |found| found.size);
        let peer = Peer { address: from, role, input: connection_points.input, output, o_t, t_o };
        self.connections.push(IoConnection {
            peer,
            triad: open.triad,
            consumer: Consumer::new(o_t_id, size.into(), header, o_t, intervals, now),
            producer,
            t_o_id,
            destination: group.unwrap_or(own),
            is_multicast,
            run: false,
        });
        self.application.event(now, &Event::Opened(peer));
        let micros = |interval: Duration| u32::try_from(interval.as_micros()).unwrap_or(u32::MAX);
        let opened = Opened {
            o_t_id,
            t_o_id,
            triad: open.triad,
            o_t_api_us: micros(o_t),
            t_o_api_us: micros(t_o),
            application: Vec::new(),
        };
        let local_address = SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, self.setup.io_port);
        Ok(AcceptedConnection { data: opened.emit(), addresses: (Some(local_address), group) })
    }

    fn next_id(&mut self) -> u32 {
        self.last_id = self.last_id.wrapping_add(1).max(1);
        self.last_id
    }
}

impl Setup {
    /// Checks the conditions that do not depend on other connections.
    fn allows(&self, open: &Open, connection_points: &ConnectionPoints<'_>) -> Result<Role, Status> {
        let refuse = |code| Err(Status::connection(code, &[]));
        if open.transport != CYCLIC {
            return refuse(TRANSPORT);
        }
        if let Some(key) = &connection_points.key {
            self.fits(key)?;
        }
        let output = self.assembly(connection_points.output, Purpose::Output);
        let role = match connection_points.output {
            _ if output.is_some() => Role::ExclusiveOwner,
            instance if instance == self.input_only => Role::InputOnly,
            instance if instance == self.listen_only => Role::ListenOnly,
            _ => return refuse(POINT),
        };
        let Some(input) = self.assembly(connection_points.input, Purpose::Input) else { return refuse(POINT) };
        if let Some(instance) = connection_points.configuration {
            let Some(found) = self.assembly(instance, Purpose::Configuration) else { return refuse(CONFIGURATION) };
            if !connection_points.data.is_empty() && connection_points.data.len() != usize::from(found.size) {
                return Err(Status::connection(CONFIGURATION_SIZE, &[found.size.div_ceil(2)]));
            }
        } else if !connection_points.data.is_empty() {
            return refuse(CONFIGURATION);
        }
        if open.o_t.net != Net::PointToPoint || !matches!(open.t_o.net, Net::PointToPoint | Net::Multicast) {
            return refuse(CONNECTION_TYPE);
        }
        if ![open.o_t, open.t_o].iter().all(|flow| self.rpi.contains(&Duration::from_micros(flow.rpi_us.into()))) {
            return refuse(RPI);
        }
        match output {
            Some(output) => check_size(&open.o_t, output.size.saturating_add(COUNT + HEADER))?,
            None if HEARTBEATS.contains(&open.o_t.size) => {}
            None => return Err(Status::connection(SIZE, &[COUNT])),
        }
        check_size(&open.t_o, input.size.saturating_add(COUNT))?;
        Ok(role)
    }

    fn fits(&self, key: &Key) -> Result<(), Status> {
        let own = &self.identity;
        let differs = |wanted: u16, is: u16| wanted != 0 && wanted != is;
        if differs(key.vendor, own.vendor) || differs(key.product, own.product) {
            return Err(Status::connection(VENDOR_OR_PRODUCT, &[]));
        }
        refuse_if(differs(key.device_type, own.device_type), Status::connection(DEVICE_TYPE, &[]))?;
        let revision = own.revision;
        let minor_fits = key.minor == 0 || key.minor == revision.minor || key.compatible && key.minor < revision.minor;
        refuse_if(key.major != 0 && !(key.major == revision.major && minor_fits), Status::connection(REVISION, &[]))
    }

    /// Returns the requested interval, rounded up to a multiple of the tick.
    fn interval(&self, flow: &Flow) -> Duration {
        let tick = self.tick.as_micros().max(1);
        let handle_discovery = u128::from(flow.rpi_us).next_multiple_of(tick);
        Duration::from_micros(u64::try_from(handle_discovery).unwrap_or(u64::MAX))
    }
}

/// Decodes the path: key, assembly class, optional configuration, output, input, configuration data.
fn connection_points(open: &Open) -> Result<ConnectionPoints<'_>, Status> {
    let (key, rest) = match &open.path.0[..] {
        [Segment::Key(key), rest @ ..] => (Some(*key), rest),
        rest => (None, rest),
    };
    let (rest, data) = match rest {
        [rest @ .., Segment::Data(data)] => (rest, &data[..]),
        rest => (rest, &[][..]),
    };
    let strange = |segment: &Segment| !matches!(segment, Segment::Class(_) | Segment::Instance(_) | Segment::Point(_));
    refuse_if(rest.iter().any(strange), Status::connection(SEGMENT, &[]))?;
    let (configuration, output, input) = match *rest {
        [Segment::Class(ASSEMBLY), Segment::Instance(configuration), Segment::Point(output), Segment::Point(input)] => {
            (Some(configuration), output, input)
        }
        [Segment::Class(ASSEMBLY), Segment::Point(output), Segment::Point(input)] => (None, output, input),
        _ => return Err(Status::connection(POINT, &[])),
    };
    Ok(ConnectionPoints { key, configuration, output, input, data })
}

/// Checks a size. The size must match exactly, even if the request declares it as variable. A refusal contains the
/// correct size.
fn check_size(flow: &Flow, right: u16) -> Result<(), Status> {
    if flow.size == right { Ok(()) } else { Err(Status::connection(SIZE, &[right])) }
}
