//! `toyo status`: all five pages of the status.

use super::overview::state;
use crate::prelude::*;
use armctl_controller::toyo::status::{self, ProgramKind};
use armctl_frame::robot::state::State;

/// Show all five pages of the status.
#[derive(Debug, Args)]
pub struct Status {}

impl Command for Status {
    type Family = Toyo;
    type Report = StatusReport;
    const ID: &'static str = "toyo.status";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<StatusReport> {
        Ok(StatusReport::of(context.link.status().await?))
    }
}

/// State of a controller.
#[derive(Debug, Serialize, JsonSchema)]
#[expect(clippy::struct_excessive_bools, reason = "each is a bit of the status")]
pub struct StatusReport {
    #[serde(flatten)]
    state: State,
    /// Program type: `sequential`, `palletizing`, `external_point` or `easy`.
    program_kind: &'static str,
    host_on: bool,
    pendant_on: bool,
    homing: bool,
    in_position: bool,
    single_movement: bool,
    waits_for_input: bool,
    /// Whether the controller needs a restart before it executes anything, because parameter 2 changed.
    needs_power_cycle: bool,
    slave_not_ready: bool,
    escape_input: bool,
    continuous_input: bool,
    pause_input: bool,
    ready_output: bool,
    card: Card,
    /// Pages as received, in hexadecimal, page 0 first.
    pages: [String; 5],
}

/// State of the memory card.
#[derive(Debug, Serialize, JsonSchema)]
struct Card {
    inserted: bool,
    reading: bool,
    writing: bool,
}

impl StatusReport {
    fn of(status: status::Status) -> Self {
        Self {
            state: state(status),
            program_kind: ProgramKind::name(status.program_kind()),
            host_on: status.host_on(),
            pendant_on: status.pendant_on(),
            homing: status.homing(),
            in_position: status.in_position(),
            single_movement: status.single_movement(),
            waits_for_input: status.waits_for_input(),
            needs_power_cycle: status.needs_power_cycle(),
            slave_not_ready: status.slave_not_ready(),
            escape_input: status.escape_input(),
            continuous_input: status.continuous_input(),
            pause_input: status.pause_input(),
            ready_output: status.ready_output(),
            card: Card {
                inserted: status.card_inserted(),
                reading: status.card_reading(),
                writing: status.card_writing(),
            },
            pages: [0, 1, 2, 3, 4].map(|page| format!("{:02X}", status.page(page))),
        }
    }
}

impl Report for StatusReport {
    fn view(&self) -> View {
        let yes = |is: bool, tone: Tone| if is { Cell::from("yes").tone(tone) } else { "no".into() };
        let state = &self.state;
        let is = |state: Option<bool>| state == Some(true);
        let origin = match (self.homing, is(state.homed)) {
            (true, _) => Cell::from("moving").tone(Tone::Warning),
            (_, true) => Cell::from("done").tone(Tone::Good),
            _ => Cell::from("not done").tone(Tone::Warning),
        };
        let error = match state.fault.describe() {
            Some(error) => Cell::from(error).tone(Tone::Bad),
            None => "none".into(),
        };
        let running = match (is(state.held), is(state.running)) {
            (true, _) => Cell::from("paused").tone(Tone::Warning),
            (_, true) if self.waits_for_input => Cell::from("waits for input").tone(Tone::Warning),
            (_, true) => Cell::from("yes").tone(Tone::Good),
            _ => "no".into(),
        };
        let card = match &self.card {
            Card { writing: true, .. } => "being written",
            Card { reading: true, .. } => "being read",
            Card { inserted: true, .. } => "inserted",
            _ => "none",
        };
        let inputs =
            [(self.escape_input, "escape"), (self.continuous_input, "continuous"), (self.pause_input, "pause")];
        let inputs: Vec<&str> = inputs.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
        let fields = vec![
            ("runs", Cell::from(self.program_kind.replace('_', " "))),
            ("mode", Cell::optional(state.controller_mode)),
            ("host", Cell::switch(self.host_on)),
            ("teach pendant", Cell::switch(self.pendant_on)),
            ("servo", Cell::switch(is(state.servo_on))),
            ("origin", origin),
            ("running", running),
            ("in position", if self.in_position { "yes".into() } else { "no".into() }),
            ("error", error),
            ("ready output", Cell::switch(self.ready_output)),
            ("inputs on", if inputs.is_empty() { "none".into() } else { inputs.join(", ").into() }),
            ("single movement", yes(self.single_movement, Tone::Plain)),
            ("memory card", card.into()),
            ("slave not ready", yes(self.slave_not_ready, Tone::Bad)),
            ("power cycle needed", yes(self.needs_power_cycle, Tone::Bad)),
        ];
        View { sections: vec![Section::Fields(fields)] }
    }
}
