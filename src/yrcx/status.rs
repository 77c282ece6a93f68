//! `yrcx status`: the dedicated outputs, servos and position.

use super::info::{AxisServo, servos};
use super::overview::{alarm, latest, not_asked, state};
use super::position::{Unit, mm, position};
use super::read_requests::{ask_each, plan_each};
use crate::prelude::*;
use armctl_controller::yrcx::answer::Status as CommandStatus;
use armctl_frame::items::{ItemError, verdict};
use armctl_frame::robot::position::{Joint, joint_table};
use armctl_frame::robot::state::{Fault, Mode, PositionMm, State};

/// Shows the signals. Also shows servos and position in a session, on a simulator in this process, or with --full.
#[derive(Debug, Args)]
#[command(
    after_help = "Reading signals does not affect the controller. Servos and position need remote commands. In a \
                  session, armctl reads servos and position, unless another client's command is running. Without a \
                  session, --full takes control of the controller to read servos and position. The controller then \
                  raises an alarm when the command ends (`armctl help safety`)."
)]
pub struct Status {
    /// Take control of the controller and also read servos and position
    #[arg(long)]
    full: bool,
}

impl Command for Status {
    type Family = Yrcx;
    type Report = StatusReport;
    const ID: &'static str = "yrcx.status";

    fn connect_mode(&self) -> ConnectMode {
        if self.full { ConnectMode::Control } else { ConnectMode::Monitor }
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<StatusReport> {
        let Context { link, screen, .. } = context;
        let servo = link.draft(table::Command::ServoStatus)?.valid_order()?;
        let place = link.draft(table::Command::PositionMm)?.valid_order()?;
        let mut orders = vec![servo, place];
        let latest = latest()?;
        if link.is_dry_run() && (self.full || link.commands()) {
            let noted = plan_each(link, &orders);
            let reason = Reason::about("which alarm").depending_on("the signals: sent only if there is an alarm");
            link.plan_depending(&latest, &latest, reason);
            noted?;
        }
        if link.is_dry_run() && link.is_held() {
            let reason = Reason::default().depending_on("the session: sent only if no other command is running");
            for order in &orders {
                link.plan_depending(order, order, reason);
            }
        }
        let image = link.look().await?;
        // Show the signals at once: a motion of another client may take a long time.
        let not_asked = if self.full { None } else { not_asked(link, &image) };
        if not_asked.is_some() {
            return Ok(StatusReport { not_asked, ..StatusReport::of(link, &image) });
        }
        let mut report = StatusReport::of(link, &image);
        if report.alarm {
            orders.push(latest);
        }
        let outcomes = match ask_each(link, screen, "reading servos and position", &orders).await {
            Ok(answers) => answers.outcomes,
            Err(failure) if failure.kind == Kind::Usage => return Err(failure),
            // The signals are valid even if the other requests failed.
            Err(failure) => vec![Err(failure); orders.len()],
        };
        for (name, outcome) in ["servos", "position", "alarm"].into_iter().zip(outcomes) {
            match outcome {
                Ok(values) if name == "servos" => report.servos = Some(servos(&values)),
                Ok(values) if name == "alarm" => report.state.fault = Fault::new(true, alarm(&values).as_ref()),
                Ok(values) => {
                    report.state.position = mm(&values).map(PositionMm::of_axes);
                    report.joints = position(&values, Unit::Mm).map(|position| position.joints);
                }
                Err(failure) => report.errors.push(ItemError::new(name, failure)),
            }
        }
        Ok(report)
    }
}

/// Number of parts: signals, servos and position. The alarm is one more part, if there is an alarm.
const PARTS: usize = 3;

/// Controller state (chapter 1, section 2).
#[derive(Debug, Serialize, JsonSchema, Default)]
#[expect(clippy::struct_excessive_bools, reason = "the controller shows bits")]
pub struct StatusReport {
    /// State from the signals SO(00), SO(02), SO(03), SO(10), SO(11) and SO(13). The alarm number and the position
    /// need remote commands.
    #[serde(flatten)]
    state: State,
    /// Status of remote commands, for example `ready` or `running`.
    command_status: String,
    /// SO(01): controller CPU ready.
    cpu_ok: bool,
    /// SO(03): serious error.
    alarm: bool,
    /// SO(04): servos can be switched on.
    mp_ready: bool,
    /// SO(12): the sequence program is running.
    sequence_running: bool,
    /// SO(14): the robot program is at its first line.
    program_reset: bool,
    /// SO(15): a warning is present.
    warning: bool,
    /// Servo state of each axis; null if not read.
    servos: Option<Vec<AxisServo>>,
    /// Reason why servos and position were not read; null if they were read.
    not_asked: Option<&'static str>,
    /// Position of each axis; null if not read.
    joints: Option<Vec<Joint>>,
    /// Requests that failed, with the reason.
    errors: Vec<ItemError>,
}

impl StatusReport {
    /// Builds the report from the signals.
    fn of(link: &Link, image: &Image) -> Self {
        Self {
            state: state(link, image, None),
            command_status: CommandStatus::from_word(image.0[0]).to_string(),
            cpu_ok: output::CPU_OK.is_on(image),
            alarm: output::ALARM.is_on(image),
            mp_ready: output::MP_READY.is_on(image),
            sequence_running: output::SEQUENCE_RUNNING.is_on(image),
            program_reset: output::PROGRAM_RESET.is_on(image),
            warning: output::WARNING.is_on(image),
            ..Self::default()
        }
    }
}

impl Report for StatusReport {
    const ROWS: RowsOf = RowsOf::Report;

    fn view(&self) -> View {
        let state = &self.state;
        let is = |told: Option<bool>| told == Some(true);
        let toned = |on: bool, tone: Tone| {
            let cell = Cell::from(if on { "yes" } else { "no" });
            if on { cell.tone(tone) } else { cell }
        };
        let good =
            |on: bool| if on { Cell::from("yes").tone(Tone::Good) } else { Cell::from("no").tone(Tone::Warning) };
        let told = |servos: &Vec<AxisServo>| {
            servos.iter().map(|servo| format!("{} {}", servo.axis, servo.state)).collect::<Vec<_>>().join(", ")
        };
        let servos = self.servos.as_ref().map(told).filter(|told| !told.is_empty());
        let view = View::fields([
            ("remote command", self.command_status.as_str().into()),
            ("emergency stop", toned(is(state.emergency_stop), Tone::Bad)),
            (
                "alarm",
                state
                    .fault
                    .describe()
                    .map_or_else(|| toned(self.alarm, Tone::Bad), |told| Cell::from(told).tone(Tone::Bad)),
            ),
            ("warning", toned(self.warning, Tone::Warning)),
            ("CPU OK", good(self.cpu_ok)),
            ("MP ready", good(self.mp_ready)),
            ("motor power", Cell::switch(is(state.servo_on))),
            ("servos", Cell::optional(servos)),
            ("AUTO mode", toned(state.mode == Some(Mode::Automatic), Tone::Plain)),
            ("origin", if is(state.homed) { "complete".into() } else { Cell::from("incomplete").tone(Tone::Warning) }),
            ("program", if is(state.running) { Cell::from("running").tone(Tone::Good) } else { "stopped".into() }),
            ("program reset", toned(self.program_reset, Tone::Plain)),
            ("sequence", if self.sequence_running { "running".into() } else { "stopped".into() }),
        ]);
        match (self.joints.as_deref().map(joint_table), self.not_asked) {
            (Some(table), _) => view.append(Section::Table(table)),
            (None, Some(why)) => view.append(Section::Text(why.to_owned())),
            (None, None) => view,
        }
    }

    fn failure(&self) -> Option<Failure> {
        verdict(PARTS + usize::from(self.alarm), &self.errors)
    }
}

/// Reads the current position. A robot whose origin is unknown refuses to report its position. In this case, returns
/// `None`.
pub(super) async fn position_mm(link: &mut Link) -> Result<Option<[f64; 4]>> {
    let order = link.draft(table::Command::PositionMm)?.valid_order()?;
    let done = link.try_ask(&order).await?.ok();
    Ok(done.and_then(|done| mm(&done.values)))
}
