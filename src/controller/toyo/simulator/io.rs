//! Input, output and internal ports.

use super::memory::index;
use crate::toyo::field::Mask;
use crate::toyo::layout::Record;

/// Number of stations: the controller itself and four more.
pub(super) const STATIONS: usize = 5;
/// Number of input ports and of output ports of the controller itself (TO 2-8).
const OWN_PORT_COUNTS: (usize, usize) = (23, 18);
/// Number of input ports and of output ports of each other station.
const STATION_PORT_COUNTS: (usize, usize) = (3, 2);
/// Number of internal ports. An instruction has one digit for the port. MNIN reports only the first four ports.
const INTERNAL: usize = 9;

/// Address of a port. The port may not exist.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Port {
    pub(super) station: usize,
    /// Port number, from 1.
    pub(super) port: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PortBit {
    pub(super) port: Port,
    /// Bit number, from 1.
    pub(super) bit: u8,
}

/// An output that is switched when an axis reaches a position (OUTS).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OutputAt {
    pub(super) task: usize,
    pub(super) axis: usize,
    pub(super) at_least: bool,
    pub(super) place: f64,
    pub(super) port: Port,
    pub(super) mask: Mask,
}

#[derive(Debug, Clone)]
pub(super) struct Ports {
    inputs: [Vec<u8>; STATIONS],
    outputs: [Vec<u8>; STATIONS],
    pub(super) internal: [u8; INTERNAL],
    /// System port SY01 of the inputs.
    pub(super) system: u8,
}

impl Default for Ports {
    fn default() -> Self {
        let ports = |own, other| std::array::from_fn(|station| vec![0; if station == 0 { own } else { other }]);
        Self {
            inputs: ports(OWN_PORT_COUNTS.0, STATION_PORT_COUNTS.0),
            outputs: ports(OWN_PORT_COUNTS.1, STATION_PORT_COUNTS.1),
            internal: [0; INTERNAL],
            system: 0,
        }
    }
}

impl PortBit {
    /// Reads a bit address from a parameter. The names of its fields end in `suffix`. Returns `None` if no bit is
    /// assigned.
    pub(super) fn from_record(record: &Record, suffix: &str) -> Option<Self> {
        let field = |name: &str| record.number(&format!("{name}{suffix}")).map(index);
        let bit = u8::try_from(field("bit")?).ok().filter(|bit| *bit > 0)?;
        Some(Self { port: Port { station: field("station")?, port: field("port")? }, bit })
    }

    pub(super) const fn mask(self) -> u8 {
        1 << (self.bit - 1)
    }
}

impl Ports {
    pub(super) fn input(&self, port: Port) -> Option<u8> {
        at(&self.inputs, port)
    }

    pub(super) fn output(&self, port: Port) -> Option<u8> {
        at(&self.outputs, port)
    }

    /// Sets bits of an input port. Returns `false` if the port does not exist.
    pub(super) fn set_input(&mut self, port: Port, mask: Mask) -> bool {
        set(&mut self.inputs, port, mask)
    }

    /// Sets bits of an output port. Returns `false` if the port does not exist.
    pub(super) fn set_output(&mut self, port: Port, mask: Mask) -> bool {
        set(&mut self.outputs, port, mask)
    }

    /// Whether an input is on; `false` if the input does not exist.
    pub(super) fn is_on(&self, bit: Option<PortBit>) -> bool {
        bit.is_some_and(|bit| self.input(bit.port).is_some_and(|port| port & bit.mask() != 0))
    }

    /// The number that the bits of a port represent. `bit` is the least significant bit.
    pub(super) fn number(&self, bit: PortBit) -> u8 {
        self.input(bit.port).unwrap_or_default() >> (bit.bit - 1)
    }

    /// Switches an output. Has no effect if the output does not exist.
    pub(super) fn switch(&mut self, bit: PortBit, on: bool) {
        let care = bit.mask();
        self.set_output(bit.port, Mask { care, bits: if on { care } else { 0 } });
    }

    pub(super) fn clear_outputs(&mut self) {
        self.outputs.iter_mut().for_each(|ports| ports.fill(0));
    }

    pub(super) fn outputs(&self) -> impl Iterator<Item = (Port, u8)> {
        self.outputs.iter().enumerate().flat_map(|(station, ports)| {
            ports.iter().enumerate().map(move |(port, bits)| (Port { station, port: port + 1 }, *bits))
        })
    }
}

fn at(ports: &[Vec<u8>; STATIONS], port: Port) -> Option<u8> {
    ports.get(port.station)?.get(port.port.checked_sub(1)?).copied()
}

fn set(ports: &mut [Vec<u8>; STATIONS], port: Port, mask: Mask) -> bool {
    let place = port.port.checked_sub(1).and_then(|index| ports.get_mut(port.station)?.get_mut(index));
    place.map(|bits| *bits = mask.applied(*bits)).is_some()
}
