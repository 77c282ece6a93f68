//! `yrcx io map`: layout of the image on each fieldbus (chapter 1, section 1).

use crate::prelude::*;
use armctl_controller::yrcx::bus::{self, Bus, MapRow};
use armctl_frame::OfflineCommand;

/// Prints the address table.
#[derive(Debug, Args)]
#[command(
    after_help = "Without start addresses, the addresses count from m (read by the master) and n (written by the \
                  master), as in the manual. Use -o csv or --json to save the table."
)]
pub struct Map {
    /// Fieldbus: devicenet, devicenet-compact, ethernet-ip, profibus, profinet
    #[arg(long, value_name = "BUS")]
    bus: Bus,
    /// Start of the master's input area (outputs of the controller)
    #[arg(long, value_name = "M")]
    input_start: Option<u32>,
    /// Start of the master's output area (inputs of the controller)
    #[arg(long, value_name = "N")]
    output_start: Option<u32>,
}

impl OfflineCommand for Map {
    type Report = Addresses;
    const ID: &'static str = "yrcx.io.map";

    fn run(&self, _screen: &Screen) -> Result<Addresses> {
        let start = |side| if side == Side::Output { self.input_start } else { self.output_start };
        let rows = bus::map(self.bus).iter().map(|place| Row::of(place, start(place.side))).collect();
        Ok(Addresses { bus: self.bus.name(), rows })
    }
}

/// Addresses on a fieldbus.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Addresses {
    bus: &'static str,
    rows: Vec<Row>,
}

/// A row of the table: a word, a byte or a bit.
#[derive(Debug, Serialize, JsonSchema)]
struct Row {
    /// Direction: `from_controller` or `to_controller`.
    direction: &'static str,
    /// Address in the counting of the master.
    address: String,
    /// Bits of the address, for example `3` or `0 - 7`.
    bits: String,
    /// Signals, for example `SI(20) to SI(27)`; empty if reserved.
    signal: String,
    meaning: String,
    /// Whether the manual forbids the use of this address.
    reserved: bool,
}

impl Row {
    fn of(place: &MapRow, start: Option<u32>) -> Self {
        Self {
            direction: if place.side == Side::Output { "from_controller" } else { "to_controller" },
            address: place.address(start),
            bits: place.bits(),
            signal: place.signal.clone(),
            meaning: place.meaning.clone(),
            reserved: place.reserved,
        }
    }
}

impl Report for Addresses {
    fn view(&self) -> View {
        let mut table = Table::new(&["direction", "address", "bits", "signal", "meaning"], "");
        for row in &self.rows {
            let Row { direction, address, bits, signal, meaning, .. } = row;
            let signal = if signal.is_empty() { "-" } else { signal };
            table.row([
                (*direction).replace('_', " ").into(),
                Cell::from(address.as_str()).whole(),
                Cell::from(bits.as_str()).whole(),
                signal.into(),
                meaning.as_str().into(),
            ]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use crate::testing::{objection, workspace};

    fn find(rows: &Value, signal: &str) -> Value {
        rows["rows"].as_array().unwrap().iter().find(|row| row["signal"] == signal).unwrap().clone()
    }

    #[test]
    fn addresses_count_from_where_the_areas_start() {
        let rows = workspace(&["io", "map", "--bus", "ethernet-ip", "--input-start", "100", "--output-start", "200"]);
        let (input, output) = (find(&rows, "SI(01)"), find(&rows, "SO(02)"));
        assert_eq!((&input["address"], &input["bits"]), (&"216".into(), &"1".into()));
        assert_eq!((&output["address"], &output["direction"]), (&"116".into(), &"from_controller".into()));
        let rows = workspace(&["io", "map", "--bus", "profinet"]);
        assert_eq!(find(&rows, "SI(01)")["address"], "Qn + 32");
        assert!(objection(&["io", "map", "--bus", "can"]).contains("devicenet-compact"));
    }
}
