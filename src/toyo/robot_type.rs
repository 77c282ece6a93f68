//! `toyo robot-type`: robot type of an axis.

use super::number_arguments::number;
use crate::prelude::*;
use armctl_controller::toyo::field::Field;

/// Set the robot type of an axis. The type determines the parameters of the axis.
#[derive(Debug, Args)]
#[command(after_help = "A wrong type can cause wrong motion: use the type on the name plate. An unknown number \
                        changes nothing (exit code 3). On a real controller, type the word 'type' to confirm, or add \
                        --yes. `toyo info` shows the type of the robot.")]
pub struct RobotType {
    /// Axis, 1 to 4
    #[arg(value_name = "AXIS", value_parser = |text: &str| number(&fields()[0], text))]
    axis: i32,
    /// Robot type, up to six digits
    #[arg(value_name = "TYPE", value_parser = |text: &str| number(&fields()[1], text))]
    robot_type: i32,
}

/// Fields of TYPE AX1 RTYP=000000.
fn fields() -> &'static [Field] {
    table::Command::Type.row().requests[0].fields
}

impl Command for RobotType {
    type Family = Toyo;
    type Report = RobotTypeReport;
    const ID: &'static str = "toyo.robot-type";
    const RISK: Risk = Risk::Destroy;

    fn intent(&self) -> String {
        format!("set axis {} to robot type {:06}; the parameters of the axis can change", self.axis, self.robot_type)
    }

    fn confirmation(&self) -> Confirmation {
        Confirmation::Word("type")
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<RobotTypeReport> {
        let Self { axis, robot_type } = *self;
        let order = Request::of(table::Command::Type, [Value::Number(axis), Value::Number(robot_type)]);
        let Some(answer) = context.link.ask(&order).await.known()? else {
            // In a dry run, records the later requests and ends here.
            context.link.status_of(&[0]).await?;
            return Err(unknown());
        };
        let type_text = |number: i32| fields()[1].written(&Value::Number(number));
        let in_force = type_text(answer.number("in_force").unwrap_or(0));
        let status = context.link.status_of(&[0]).await.map_err(|failure| {
            let message =
                format!("robot type {in_force} is active now, but the next status request failed: {}", failure.message);
            Failure { message, ..failure }
        })?;
        Ok(RobotTypeReport {
            axis: u8::try_from(axis).unwrap_or(u8::MAX),
            robot_type: in_force,
            ordered_type: type_text(robot_type),
            needs_power_cycle: status.needs_power_cycle(),
        })
    }
}

/// Robot type of an axis.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RobotTypeReport {
    #[serde(rename = "axis_number")]
    axis: u8,
    /// Active type, six digits.
    robot_type: String,
    /// Type that the user requested: six digits.
    ordered_type: String,
    /// Whether the controller needs a restart before it executes anything.
    needs_power_cycle: bool,
}

impl Report for RobotTypeReport {
    fn view(&self) -> View {
        let then = if self.needs_power_cycle { "; switch the controller's power off and on" } else { "" };
        View::text(format!("axis {} has robot type {}{then}", self.axis, self.robot_type))
    }

    fn failure(&self) -> Option<Failure> {
        let Self { axis, robot_type, ordered_type, .. } = self;
        let message = format!(
            "the controller does not accept robot type {ordered_type}: axis {axis} still has type {robot_type}"
        );
        (robot_type != ordered_type)
            .then(|| Failure::new(Kind::Refused, message).hint("check the number on the name plate"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rejected_type_is_a_refusal() {
        let of = |robot_type: &str| RobotTypeReport {
            axis: 2,
            robot_type: robot_type.into(),
            ordered_type: "000123".into(),
            needs_power_cycle: false,
        };
        assert_eq!(of("000123").failure(), None);
        let failure = of("000000").failure().unwrap();
        assert_eq!(failure.kind, Kind::Refused);
        assert_eq!(failure.message, "the controller does not accept robot type 000123: axis 2 still has type 000000");
    }
}
