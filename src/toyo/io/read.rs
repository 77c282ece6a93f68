//! Reads of ports. One request reads one screen.

use std::collections::{BTreeMap, BTreeSet};

use super::super::link::Link;
use super::port::{PortBank, Signal, name, ports_of};
use armctl_controller::names::Names;
use armctl_frame::failure::{Failure, Kind};
use armctl_frame::robot::io::IoRow;

/// Bytes of ports, or the reason why a byte is missing.
pub type Bytes = BTreeMap<(PortBank, u8), Result<u8, Failure>>;

/// Reads the ports of signals. After a lost connection, the remaining ports are not read.
///
/// # Errors
/// If the station does not have a port, or the connection is lost. A dry run ends here.
pub async fn read(link: &mut Link, station: u8, signals: &[Signal]) -> Result<Bytes, Failure> {
    let ports: BTreeSet<(PortBank, u8)> = signals.iter().map(|signal| (signal.bank, signal.port)).collect();
    for (bank, port) in &ports {
        exists(*bank, station, *port)?;
    }
    let screen = |(bank, port): &(PortBank, u8)| (*bank, bank.screen(station, *port));
    let screens: BTreeSet<(PortBank, u8)> = ports.iter().map(screen).collect();
    let request = |(bank, screen): &(PortBank, u8)| bank.request(station, *screen);
    link.plan_all(&screens.iter().map(request).collect::<Vec<_>>())?;
    let (mut bytes, mut silence) = (Bytes::new(), None);
    for at in &screens {
        let answer = match &silence {
            Some(failure) => Err(Failure::clone(failure)),
            None => link.ask(&request(at)).await,
        };
        match &answer {
            Err(failure) if failure.kind == Kind::NoAnswer => silence = Some(failure.clone()),
            Err(failure) if !matches!(failure.kind, Kind::Refused | Kind::Malformed) => return Err(failure.clone()),
            _ => {}
        }
        for port in ports.iter().filter(|port| screen(port) == *at) {
            let byte = answer.as_ref().map_err(Failure::clone).and_then(|record| {
                let own = ports_of(record).into_iter().find(|other| other.number == port.1).map(|port| port.byte);
                let missing = || format!("{} is not in '{}'", name(port.1), record.written());
                own.ok_or_else(|| Failure::new(Kind::Malformed, missing()))
            });
            bytes.insert(*port, byte);
        }
    }
    Ok(bytes)
}

/// Builds the report row of a signal.
pub fn row(signal: Signal, station: u8, bytes: &Bytes, names: &Names) -> Option<IoRow> {
    let byte = bytes.get(&(signal.bank, signal.port))?.clone();
    Some(IoRow::state(signal.item(station, names), byte.map(|byte| signal.is_on(byte))))
}

/// Returns an error if the station does not have this port.
fn exists(bank: PortBank, station: u8, port: u8) -> Result<(), Failure> {
    let (first, last) = (bank.first(station), bank.last(station));
    if (first..=last).contains(&port) {
        return Ok(());
    }
    Err(if last == 0 {
        Failure::usage("only station 0, the controller itself, has internal ports").hint("remove --station")
    } else {
        let message = format!("station {station} has {} ports {first} to {last}, not {port}", bank.word());
        Failure::usage(message).hint("use `armctl toyo io list` to list the signals of a station")
    })
}
