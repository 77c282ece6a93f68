//! `toyo io list`.

use super::port::{PortBank, Signal};
use super::read::{read, row};
use super::{BITS, Station};
use crate::prelude::*;
use armctl_frame::robot::io::{Filter, IoRow, Signals};

/// List all ports of a station, without ports that the controller refuses.
#[derive(Debug, Args)]
#[command(after_help = BITS)]
pub struct List {
    #[command(flatten)]
    filter: Filter,
    #[command(flatten)]
    station: Station,
}

impl Command for List {
    type Family = Toyo;
    type Report = Signals;
    const ID: &'static str = "toyo.io.list";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Signals> {
        let banks = PortBank::ALL.into_iter().filter(|bank| self.filter.has(bank.kind()));
        let rows = rows(banks, self.station, context).await?;
        Signals::new(rows.into_iter().filter(|row| self.filter.lists(row)).collect())
    }
}

/// All inputs and outputs of a station.
pub async fn all(station: Station, context: Context<'_, Toyo>) -> Result<Signals> {
    Signals::new(rows([PortBank::Input, PortBank::Output], station, context).await?)
}

async fn rows(
    banks: impl IntoIterator<Item = PortBank>,
    Station { station }: Station,
    context: Context<'_, Toyo>,
) -> Result<Vec<IoRow>> {
    let ports =
        banks.into_iter().flat_map(|bank| (bank.first(station)..=bank.last(station)).map(move |port| (bank, port)));
    let signals: Vec<Signal> =
        ports.flat_map(|(bank, port)| (1..=8).map(move |bit| Signal { bank, port, bit })).collect();
    let names = names::of_robot(context.robot, context.screen);
    let mut bytes = read(context.link, station, &signals).await?;
    let refused = |byte: &Result<u8>| byte.as_ref().is_err_and(|failure| failure.kind == Kind::Refused);
    // A controller may have fewer ports. If it refuses all ports, this is an error.
    if !bytes.values().all(refused) {
        bytes.retain(|_, byte| !refused(byte));
    }
    Ok(signals.into_iter().filter_map(|signal| row(signal, station, &bytes, names)).collect())
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault, all_blocks};

    #[test]
    fn io_list_reads_all_screens_of_a_station() {
        let screens = |command: &str, count: i32| -> Vec<String> {
            (1..=count).map(|screen| format!("@{command} SNO=0 GN={screen}")).collect()
        };
        let all = [screens("MINP", 6), screens("MOUT", 5), screens("MNIN", 1)].concat();
        assert_eq!(all_blocks(&["io", "list"]).unwrap(), all);
        assert_eq!(all_blocks(&["io", "list", "--in"]).unwrap(), screens("MINP", 6));
    }

    #[test]
    fn fewer_ports_on_the_controller_are_not_an_error() {
        let fate = |block: &str, _| if block.contains("GN=6") { Fault::Answered("@NG") } else { Fault::None };
        let listed = Bench::with_faults("", fate).0.data(&["io", "list", "--in", "--off"]);
        let items = listed["items"].as_array().unwrap();
        assert_eq!((items.len(), &items.last().unwrap()["name"]), (20 * 8, &"IN19.8".into()));
    }
}
