//! `toyo coordinate set`: coordinates for a program that waits for them.

use clap::Args;

use super::link::Toyo;
use super::link::wrong;
use super::values::json;
use crate::command::frame::orders::{Done, New, Old};
use crate::command::{Command, Context, commands};
use crate::controller::Risk;
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;

commands! {
    /// Coordinates that the host supplies.
    pub enum Coordinate {
        /// Send coordinates to a waiting RSMV step, which moves there
        Set(Set),
    }
}

/// Supplies coordinates to a task: the RSMV that waits for them, or comes next, moves there (TO 2-8, MRSS).
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Set {
    /// X coordinate in mm, -8000.00 to 8000.00
    #[arg(value_parser = |text: &str| read("x", text))]
    x: Value,
    /// Y coordinate in mm
    #[arg(value_parser = |text: &str| read("y", text))]
    y: Value,
    /// Z coordinate in mm; 0 without such an axis
    #[arg(value_parser = |text: &str| read("z", text))]
    z: Value,
    /// R coordinate; 0 without such an axis
    #[arg(value_parser = |text: &str| read("r", text))]
    r: Value,
    /// Which task
    #[arg(long, value_name = "N", default_value = "1", value_parser = |text: &str| read("task", text))]
    task: Value,
    /// Row of the speed table, 1 to 10; 0 for the speed that the step names
    #[arg(long, value_name = "ROW", default_value = "0", value_parser = |text: &str| read("speed", text))]
    speed: Value,
}

/// A value of a field of MRSS, in its range.
fn read(name: &str, text: &str) -> Result<Value, String> {
    field(name).read(text).map_err(|error| error.to_string())
}

fn field(name: &str) -> &'static Field {
    let fields = table::Command::Mrss.row().requests[0].fields;
    fields.iter().find(|field| field.name == name).expect("MRSS has these fields")
}

impl Set {
    /// Where to, in words.
    fn aim(&self) -> String {
        let axes = [("x", &self.x), ("y", &self.y), ("z", &self.z), ("r", &self.r)];
        let axes = axes.map(|(name, value)| format!("{} {}", name.to_uppercase(), field(name).meaning(value)));
        let row = match self.speed {
            Value::Number(0) => "the speed of its step".to_owned(),
            _ => format!("the speed of row {}", field("speed").meaning(&self.speed)),
        };
        format!("{} at {row}", axes.join(", "))
    }
}

impl Command for Set {
    type Family = Toyo;
    type Report = Done;
    const ID: &'static str = "toyo.coordinate.set";
    const RISK: Risk = Risk::Motion;

    fn intent(&self) -> String {
        format!("have the next RSMV of task {} move to {}", field("task").meaning(&self.task), self.aim())
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Done, Failure> {
        let Self { x, y, z, r, task, speed } = self;
        let values = [task, x, y, z, r, speed].map(Clone::clone).into();
        let request = Request::new(table::Command::Mrss, values).map_err(|error| wrong(&error))?;
        context.link.ask(&request).await?;
        let number = |name: &str, value: &Value| json(field(name), value);
        let mut new = serde_json::Map::new();
        for (name, value) in [("x", x), ("y", y), ("z", z), ("r", r)] {
            new.insert(format!("{name}_mm"), number(name, value));
        }
        let words = format!("task {} has {}", field("task").meaning(task), self.aim());
        let new = New::of("coordinates", new, words).with("task", number("task", task));
        let new = if *speed == Value::Number(0) { new } else { new.with("speed_row", number("speed", speed)) };
        Ok(new.replaces(Old::UNREAD))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::toyo::testing::{Bench, Fault, blocks, intent, objection};

    #[test]
    fn the_order_is_in_form_and_in_range() {
        let line = ["coordinate", "set", "100", "-20.5", "0", "0", "--task", "2", "--speed", "5"];
        assert_eq!(blocks(&line).unwrap(), ["@MRSS TASK=02 X=+0100.00 Y=-0020.50 Z=+0000.00 R=+0000.00 V=05"]);
        assert_eq!(
            intent(&line),
            "have the next RSMV of task 2 move to X 100.00 mm, Y -20.50 mm, Z 0.00 mm, R 0.00 mm at the speed of row 5"
        );
        assert!(objection(&["coordinate", "set", "1", "2", "3"]).contains("<R>"));
        assert!(objection(&["coordinate", "set", "8000.01", "0", "0", "0"]).contains("-8000.00 to 8000.00 mm"));
        assert!(objection(&["coordinate", "set", "0.001", "0", "0", "0"]).contains("has too many decimals"));
        assert!(objection(&["coordinate", "set", "0", "0", "0", "0", "--speed", "11"]).contains("0 to 10"));
    }

    #[test]
    fn a_waiting_move_goes_there() {
        let state = "origin = true\nsteps = { 1 = [\"RSMV a X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 PASS\", \"END\"] }\n";
        let (mut bench, _) = Bench::with_faults(state, |_, _| Fault::None);
        bench.data(&["run", "sequential", "1", "--no-wait"]);
        bench.data(&["coordinate", "set", "50", "20", "0", "0"]);
        bench.wait(std::time::Duration::from_secs(5));
        assert_eq!(bench.data(&["position"])["x_mm"], 50.0);
    }
}
