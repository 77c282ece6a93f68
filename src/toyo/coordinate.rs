//! `toyo coordinate set`: sends coordinates to a program that waits for them.

use super::field_values::{Changes, assignment, json};
use super::point::table as point_table;
use super::position::Coordinates;
use crate::prelude::*;
use armctl_controller::toyo::field::Field;

commands! {
    /// Commands for coordinates that the host sends.
    pub enum Coordinate {
        /// Send coordinates to a waiting RSMV step, which moves to them
        Set(Set),
    }
}

/// Send coordinates to a task. The waiting or next RSMV step of the task moves to them (TO 2-8, MRSS).
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Set {
    /// X, Y, Z and R in mm, -8000.00 to 8000.00; or by name, for example z=12.5 or ax1=12.5. Use 0 for an axis that
    /// does not exist
    #[arg(required = true, num_args = 4, value_names = ["X", "Y", "Z", "R"], value_parser = coordinate)]
    values: Vec<String>,
    /// Task of the program
    #[arg(long, value_name = "N", default_value = "1", value_parser = |text: &str| read("task", text))]
    task: Value,
    /// Row of the speed table, 1 to 10; 0 uses the speed of the step
    #[arg(long = "speed-row", value_name = "ROW", default_value = "0", value_parser = |text: &str| read("speed", text))]
    speed: Value,
}

/// Parses a field of MRSS within its range.
fn read(name: &str, text: &str) -> Result<Value, String> {
    field(name).read(text).map_err(|error| error.to_string())
}

/// Parses a coordinate with or without its name.
fn coordinate(text: &str) -> Result<String, String> {
    read("x", assignment(text).map_or(text, |(_, value)| value)).map(|_| text.to_owned())
}

fn field(name: &str) -> &'static Field {
    let fields = table::Command::Mrss.row().requests[0].fields;
    fields.iter().find(|field| field.name == name).expect("MRSS has these fields")
}

impl Set {
    /// Text about the speed.
    fn pace(&self) -> String {
        match self.speed {
            Value::Number(0) => "the speed of the step".to_owned(),
            _ => format!("the speed of row {}", field("speed").meaning(&self.speed)),
        }
    }

    /// Text that completes "This will …".
    fn in_words(&self, coordinates: &str) -> String {
        format!(
            "move to {coordinates} with the next RSMV step of task {} at {}",
            field("task").meaning(&self.task),
            self.pace()
        )
    }
}

impl Command for Set {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = "toyo.coordinate.set";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        let axes = self.values.iter().zip(["X", "Y", "Z", "R"]).map(|(text, usual)| {
            let (name, value) = assignment(text).unwrap_or((usual, text));
            format!("{} {value} mm", name.to_uppercase())
        });
        self.in_words(&axes.collect::<Vec<_>>().join(", "))
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        let Self { values, task, speed } = self;
        let Context { link, confirmer, .. } = context;
        let letters = link.letters().await?;
        let changes = Changes::read("coordinates", &point_table().body(), &letters, values)?;
        let coordinates = changes.whole().ok_or_else(|| {
            Failure::usage("coordinates: a value is missing; each axis needs a value")
                .hint("see `toyo coordinate set -h` for examples")
        })?;
        let values = std::iter::once(task.clone()).chain(coordinates).chain([speed.clone()]).collect();
        let request = Request::new(table::Command::Mrss, values).map_err(|error| wrong(&error))?;
        let coordinates = Coordinates::of(request.record(), letters);
        let target = format!("{} (mm)", coordinates.in_a_line());
        confirmer.confirm(&Change::new(self.in_words(&target))).await?;
        link.ask(&request).await?;
        let words =
            format!("task {} has received {target}, for a move at {}", field("task").meaning(task), self.pace());
        let new =
            NewValue::of("coordinates", serde_json::json!(coordinates), words).with("task", json(field("task"), task));
        let new = if *speed == Value::Number(0) { new } else { new.with("speed_row", json(field("speed"), speed)) };
        Ok(new.replaces(Old::UNREAD))
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault};

    #[test]
    fn a_waiting_move_goes_to_the_sent_coordinates() {
        let state = "origin = true\nsteps = { 1 = [\"RSMV a X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 PASS\", \"END\"] }\n";
        let (mut bench, _) = Bench::with_faults(state, |_, _| Fault::None);
        bench.data(&["run", "sequential", "1", "--no-wait"]);
        bench.data(&["coordinate", "set", "50", "20", "0", "0"]);
        bench.wait(std::time::Duration::from_secs(5));
        assert_eq!(bench.data(&["position"])["positions"][0]["x_mm"], 50.0);
    }
}
