//! `yrcx position` (4.7.4).

use crate::position::{Unit, group, position};
use crate::prelude::*;
use armctl_frame::face::shared_commands::CommonReport;
use armctl_frame::plot::SeriesHistory;
use armctl_frame::robot::position::{AllPositions, Joint, Positions};

/// Reads the position, once or continuously.
#[derive(Debug, Args)]
#[command(
    after_help = "With --continuous, the controller sends the position until the command ends and accepts no other \
                  remote command. A program can move the robot during this time. `-o csv` and `-o jsonl` write one \
                  line per position."
)]
pub struct PositionArguments {
    /// Unit of the position
    #[arg(long, value_name = "UNIT", default_value = "mm")]
    report: Unit,
    /// Print each new position until Ctrl-C, --count or --for
    #[arg(long)]
    continuous: bool,
    /// Time after which the output ends
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse)]
    within: Option<Duration>,
    #[arg(from_global)]
    until: Option<String>,
    /// Show a small chart of each axis over the rounds of --watch
    #[arg(long)]
    plot: bool,
    #[arg(skip)]
    past: SeriesHistory,
}

impl Command for PositionArguments {
    type Family = Yrcx;
    type Report = RobotPosition;
    const ID: &'static str = "yrcx.position";

    fn is_endless(&self) -> bool {
        self.continuous
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<RobotPosition> {
        if self.within.is_some() && !self.continuous && self.until.is_none() {
            return Err(Failure::usage("--for needs --continuous or --until").hint("add one of them, or remove --for"));
        }
        let link = context.link;
        let command = match self.report {
            Unit::Mm => table::Command::PositionMm,
            Unit::Pulse => table::Command::PositionPulse,
        };
        let order = link.draft(command)?.with(Key::Continuous, self.continuous).valid_order()?;
        let done = if self.continuous { link.next_output(&order).await? } else { link.ask(&order).await? };
        let place = position(&done.values, self.report).unwrap_or_default();
        let positions = Positions::one(&group(order.values().int(Key::Robot)), place).plotted(self.plot, &self.past);
        Ok(RobotPosition { positions, elapsed_ms: self.continuous.then(|| milliseconds(done.elapsed)) })
    }
}

fn milliseconds(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}

/// Position of a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RobotPosition {
    #[serde(flatten)]
    positions: Positions,
    /// Time in ms since the continuous output started; null for a single reading.
    elapsed_ms: Option<u64>,
}

impl CommonReport for RobotPosition {
    type Core = AllPositions;

    fn core(&self) -> AllPositions {
        self.positions.core()
    }
}

impl RobotPosition {
    /// Line of continuous output.
    fn line(&self, elapsed_ms: u64) -> Table {
        let mut table = Table::new(&["elapsed (ms)", "axis 1", "axis 2", "axis 3", "axis 4", "unit"], "");
        let joints: Vec<&Joint> = self.positions.read().flat_map(|position| &position.joints).collect();
        let axis = |at: usize| Cell::optional(joints.get(at).map(|joint| joint.cell()));
        let unit = if joints.iter().any(|joint| joint.mm.is_some()) { "mm" } else { "pulses" };
        table.row([elapsed_ms.into(), axis(0), axis(1), axis(2), axis(3), unit.into()]);
        table
    }
}

impl Report for RobotPosition {
    fn view(&self) -> View {
        self.elapsed_ms.map_or_else(|| self.positions.view(), |elapsed_ms| View::table(self.line(elapsed_ms)))
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use serde_json::{Value, json};

    use crate::testing::{Bench, Reply, Scripted, example, read_example, words};
    use armctl_frame::failure::Kind;

    #[test]
    fn the_examples_of_the_manual() {
        assert_eq!(words(&["position", "--report", "pulse"]).unwrap(), [example("4.7.4-pulse")]);
        assert_eq!(words(&["position"]).unwrap(), [example("4.7.4-mm")]);
        let pulses = read_example("4.7.4-pulse", &["position", "--report", "pulse"]);
        let (pulses, place) = (&pulses["positions"][0], |place: &Value| place["positions"][0].clone());
        assert_eq!((&pulses["frame"], &pulses["x_mm"]), (&json!("joint"), &json!(null)));
        assert!(pulses["joints"].as_array().unwrap().iter().all(|joint| joint["pulses"].is_i64()), "{pulses}");
        let place = place(&read_example("4.7.4-mm", &["position"]));
        assert_eq!(place["form"], json!(null), "bit 0, which the example has, is not used");
        assert!(place["x_mm"].is_f64() && place["joints"][0]["pulses"].is_null(), "{place}");
    }

    const CONTINUOUS: [&str; 2] = ["position", "--continuous"];

    /// Words of continuous output with this position of the first axis.
    fn output(position: u16) -> [u16; 16] {
        let mut words = [0; 16];
        (words[0], words[4]) = (0x0100, position);
        words
    }

    #[test]
    fn continuous_output_reports_each_change() {
        assert_eq!(words(&CONTINUOUS).unwrap()[0][..2], ["0x0506", "0x0001"]);
        let mut bench =
            Bench::new(Scripted::new([Reply::Shows(vec![output(0), output(1000), output(1000), output(2500)])]));
        let first = bench.run(&CONTINUOUS).unwrap();
        let second = bench.run(&CONTINUOUS).unwrap();
        assert_eq!((&first["positions"][0]["x_mm"], &second["positions"][0]["x_mm"]), (&json!(1.0), &json!(2.5)));
        assert!(first["elapsed_ms"].as_u64() < second["elapsed_ms"].as_u64(), "{first} {second}");
        bench.interrupt(&CONTINUOUS, Duration::from_secs(60));
        let peer = bench.into_peer();
        assert_eq!((peer.taken.len(), peer.image.0[0]), (1, 0), "the status reset ends it");
    }

    #[test]
    fn constant_zeros_are_a_position() {
        let mut bench = Bench::new(Scripted::new([Reply::Shows(vec![output(0)])]));
        assert_eq!(bench.run(&CONTINUOUS).unwrap()["positions"][0]["x_mm"], json!(0.0));
    }

    #[test]
    fn another_command_ends_continuous_output() {
        let mut done = output(7);
        done[0] = 0x0200;
        let script = [Reply::Shows(vec![output(1000)]), Reply::AddressPair(1, done)];
        let mut bench = Bench::new(Scripted::new(script));
        bench.run(&CONTINUOUS).unwrap();
        assert_eq!(bench.run(&["position"]).unwrap()["positions"][0]["x_mm"], json!(0.007));
        assert_eq!(bench.into_peer().taken.len(), 2);
    }

    #[test]
    fn restarts_continuous_output_after_a_lost_link() {
        let script = [Reply::Loses(2, Duration::from_millis(50)), Reply::Shows(vec![output(1000)])];
        let mut bench = Bench::new(Scripted::new(script));
        assert_eq!(bench.run(&CONTINUOUS).unwrap_err().kind, Kind::NoAnswer);
        assert_eq!(bench.run(&CONTINUOUS).unwrap()["positions"][0]["x_mm"], json!(1.0));
    }
}
