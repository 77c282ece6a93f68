//! `yerc status`.

use super::alarm::{plan_latest, present};
use super::link::{Link, Yerc};
use super::overview::state;
use crate::prelude::basics::*;
use armctl_controller::yerc::payload::{ControllerStatus, CycleMode, StatusBit};
use armctl_controller::yerc::query::ReadStatus;
use armctl_frame::robot::state::{Fault, State};

/// Shows all status bits of the controller.
#[derive(Debug, Args)]
pub struct Status {}

impl Command for Status {
    type Family = Yerc;
    type Report = StatusReport;
    const ID: &'static str = "yerc.status";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<StatusReport> {
        let link = context.link;
        let Some(status) = link.ask(&ReadStatus).await.known()? else {
            plan_latest(link)?;
            return Err(unknown());
        };
        Ok(StatusReport::of(status, fault(link, status).await?))
    }
}

/// Present fault: the latest alarm, which is read if there is an alarm. An error has no number in this report.
pub(super) async fn fault(link: &mut Link, status: ControllerStatus) -> Result<Fault> {
    let alarms = if status.alarm() { present(link, &mut true, 1).await? } else { Vec::new() };
    Ok(Fault::new(status.faulted(), alarms.first()))
}

/// Controller state (FS and DX 3.3.3).
#[derive(Debug, Serialize, JsonSchema)]
#[expect(clippy::struct_excessive_bools, reason = "the controller reports bits")]
pub struct StatusReport {
    #[serde(flatten)]
    state: State,
    /// Whether the controller accepts external commands (CMD REMOTE).
    command_remote: bool,
    /// Cycle mode: `step`, `one_cycle` or `continuous`; null if the controller reports none or several.
    cycle: Option<&'static str>,
    /// Sources of the hold: `pendant`, `external`, `command`.
    hold_sources: Vec<&'static str>,
    alarm: bool,
    #[serde(rename = "has_error")]
    error: bool,
    /// Whether in-guard safe operation is active.
    safe_operation: bool,
    /// The two status words.
    raw: RawStatus,
}

/// Status words in hexadecimal.
#[derive(Debug, Serialize, JsonSchema)]
struct RawStatus {
    data_1: String,
    data_2: String,
}

/// Sources of a hold, and their names in the report.
const HOLDS: [(StatusBit, &str); 3] =
    [(StatusBit::HoldPendant, "pendant"), (StatusBit::HoldExternal, "external"), (StatusBit::HoldCommand, "command")];

impl StatusReport {
    fn of(status: ControllerStatus, fault: Fault) -> Self {
        let [data_1, data_2] = status.words;
        Self {
            state: state(status, fault, None),
            command_remote: status.has(StatusBit::CommandRemote),
            cycle: status.cycle().map(cycle_name),
            hold_sources: HOLDS.iter().filter(|(bit, _)| status.has(*bit)).map(|(_, name)| *name).collect(),
            alarm: status.alarm(),
            error: status.error(),
            safe_operation: status.has(StatusBit::Guarded),
            raw: RawStatus { data_1: format!("{data_1:#010x}"), data_2: format!("{data_2:#010x}") },
        }
    }
}

/// Name of a cycle mode in JSON.
pub(super) const fn cycle_name(cycle: CycleMode) -> &'static str {
    match cycle {
        CycleMode::Step => "step",
        CycleMode::Once => "one_cycle",
        CycleMode::Continuous => "continuous",
    }
}

impl Report for StatusReport {
    fn view(&self) -> View {
        let state = &self.state;
        let error_text = state.fault.describe().unwrap_or_else(|| "yes".to_owned());
        let bad = |on: bool, told: &str| if on { Cell::from(told).tone(Tone::Bad) } else { "no".into() };
        let remote = if self.command_remote { Tone::Good } else { Tone::Warning };
        let hold = if state.held == Some(true) {
            Cell::from(self.hold_sources.join(", ")).tone(Tone::Warning)
        } else {
            "no".into()
        };
        View::fields([
            ("mode", Cell::optional(state.controller_mode)),
            ("command remote", Cell::switch(self.command_remote).tone(remote)),
            ("cycle", Cell::optional(self.cycle.map(|cycle| cycle.replace('_', " ")))),
            ("running", if state.running == Some(true) { Cell::from("yes").tone(Tone::Good) } else { "no".into() }),
            ("servo", Cell::optional(state.servo_on.map(Cell::switch))),
            ("hold", hold),
            ("alarm", bad(self.alarm, &error_text)),
            ("error", bad(self.error, "yes")),
            ("safe operation", if self.safe_operation { "yes".into() } else { "no".into() }),
        ])
    }
}
