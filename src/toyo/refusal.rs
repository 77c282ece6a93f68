//! Explanation of a refusal. `@NG` has no code, so the reason must be read from the status.

use super::link::Link;
use crate::prelude::basics::*;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::status::{ProgramKind, RunMode};
use armctl_controller::toyo::table::commands::{Command, Row};

/// Failure for a refusal. It contains the reason if the status shows one.
pub async fn with_reason(link: &mut Link, request: &Request) -> Failure {
    let row = request.row();
    if row.risk == Risk::Read {
        return of_question(request);
    }
    let status = match link.status().await {
        Ok(status) => status,
        // The controller also answered `@OK` to the same command.
        Err(failure) if failure.kind == Kind::OutcomeUnknown => return failure,
        // The status could not be read, but the refusal itself is certain.
        Err(_) => {
            return refused(
                request,
                "the reason is unknown, because the status could not be read",
                "use `toyo status` to see a possible reason",
            );
        }
    };
    match reason(status, row) {
        Some((why, hint)) => refused(request, &why, &hint),
        None => refused(request, "the status shows no reason", &unexplained(row)),
    }
}

/// Failure: a read was refused, and the status does not show the reason.
pub fn of_question(request: &Request) -> Failure {
    refused(request, "the status shows no reason", &unexplained(request.row()))
}

/// Failure: the teach pendant has control.
pub fn pendant() -> Failure {
    Failure::new(Kind::Refused, "the controller refused: the teach pendant is ON, and the host cannot take over")
        .hint("switch the teach pendant OFF, then repeat the command")
        .code("NG")
}

/// Failure: the controller refuses to report its status.
pub fn status_refused() -> Failure {
    Failure::new(Kind::Refused, "the controller refused to report its status (@NG)")
        .hint("try again, then check the teach pendant: the controller is busy or is another model")
        .code("NG")
}

/// Failure with the whole block, because the block contains the number of the point, counter or step.
fn refused(request: &Request, why: &str, hint: &str) -> Failure {
    let text = request.text();
    let block = text.trim_start_matches('@');
    Failure::new(Kind::Refused, format!("the controller refused {block} (@NG): {why}")).hint(hint).code("NG")
}

/// The most important reason in the status why a command is not possible, and its remedy.
fn reason(status: Status, row: &Row) -> Option<(String, String)> {
    let reason_and_hint = |why: &str, hint: &str| Some((why.to_owned(), hint.to_owned()));
    let moves = row.risk == Risk::Motion;
    if status.pendant_on() {
        return reason_and_hint("the teach pendant is ON", "switch the teach pendant OFF");
    }
    if status.needs_power_cycle() {
        return reason_and_hint(
            "a machine parameter (parameter 2) was changed, and the controller needs a restart",
            "switch the controller's power off and on",
        );
    }
    if status.has_error() {
        let error = errors::explain(status.error);
        let hint = if row.command == Command::Cerr { error.remedy.to_owned() } else { cure(error.remedy) };
        return Some((format!("error {}", error.in_a_line()), hint));
    }
    if row.needs_host && !status.host_on() {
        return reason_and_hint("the host is OFF", "use `toyo host on`");
    }
    if status.card_reading() || status.card_writing() {
        return reason_and_hint(
            "the memory card is in use",
            "wait until the card is no longer in use: `toyo status --until '.data.card | (.reading or .writing) | \
             not'`",
        );
    }
    if status.homing() {
        return reason_and_hint("the axes are returning to the origin", "wait until the axes stop, or use `toyo stop`");
    }
    if status.executing() {
        return reason_and_hint(
            "the controller executes a program or command",
            "wait until the program or command has ended, or use `toyo stop`",
        );
    }
    if moves && !status.servo_on() && !matches!(row.command, Command::Svon | Command::Svof | Command::Mrss) {
        return reason_and_hint("servo power is off", "use `toyo servo on`");
    }
    if let Some((kind, how)) = kind_of(row.command) {
        if status.run_mode() == Some(RunMode::Program) {
            return reason_and_hint("the controller is in program mode", "use `toyo mode auto`");
        }
        if status.program_kind() != kind {
            let mode = status.program_kind().name().replace('_', " ");
            return Some((format!("the controller is in {mode} mode"), how.to_owned()));
        }
        if !status.homed() {
            return reason_and_hint("the axes have not returned to the origin", "`toyo home`");
        }
    }
    match row.command {
        Command::Wmca | Command::Rmca if !status.card_inserted() => {
            reason_and_hint("there is no memory card", "insert one")
        }
        Command::Rmca => {
            reason_and_hint("the status shows no reason", "check that the card contains data of this controller")
        }
        Command::Mrss => reason_and_hint(
            "the status shows no reason",
            "check whether earlier coordinates still wait for their RSMV step",
        ),
        _ if row.writes_eeprom && status.run_mode() != Some(RunMode::Program) => reason_and_hint(
            "the controller is not in program mode",
            "use `toyo mode program` if the controller requires program mode",
        ),
        _ => None,
    }
}

/// Remedy for an error. The steps are in the order that the controller requires: nothing moves before the error is
/// cancelled.
pub fn cure(remedy: &str) -> String {
    match remedy.strip_suffix(" first") {
        Some(motion) => format!("use `toyo alarm reset`, then {motion}"),
        None => format!("{remedy}; then use `toyo alarm reset`"),
    }
}

/// Program kind that a command starts, and a hint how to select this kind.
fn kind_of(start: Command) -> Option<(ProgramKind, &'static str)> {
    Some(match start {
        Command::Spst => (
            ProgramKind::Sequential,
            "use `armctl toyo mode sequential`; `armctl toyo param set M10 I` ends easy and external point mode",
        ),
        Command::Ppst => (
            ProgramKind::Palletizing,
            "use `armctl toyo mode palletizing`; `armctl toyo param set M10 I` ends easy and external point mode",
        ),
        Command::Sesy => (ProgramKind::Easy, "use `armctl toyo param set M10 E` to select easy mode"),
        Command::Extp => (
            ProgramKind::ExternalPoint,
            "use `armctl toyo param set M10 P` to select external point mode, then repeat the command",
        ),
        _ => return None,
    })
}

fn unexplained(row: &Row) -> String {
    if row.command == Command::Dout {
        "check that the output exists; for F1 to F4, check that parameter M12 (direct-outputs) has a bit for the \
         output"
            .to_owned()
    } else if row.only_on.is_empty() {
        "try again, and check that this controller has the requested item".to_owned()
    } else {
        format!("check the model; only these controllers support the command: {}", row.only_on.join(", "))
    }
}

/// Hint with the command that shows whether a command without an answer was executed.
pub fn verification_hint(command: Command) -> &'static str {
    match command {
        Command::Home | Command::Sorg => "keep clear of the robot; use `toyo status` to see motion and origin",
        Command::Spst | Command::Ppst | Command::Sesy | Command::Extp | Command::Mrss => {
            "keep clear of the robot; use `toyo status` and `toyo position` to see motion and position"
        }
        Command::Jgst => {
            "keep clear of the robot; use `toyo stop --jog` to stop the axis, and `toyo position` to see the position"
        }
        Command::Svon | Command::Svof => "use `toyo status` to see whether servo power is on",
        Command::Wpar => "use `toyo param get` to see the stored value",
        Command::Wstx | Command::Istx | Command::Dstx | Command::Dstl | Command::Cpss => {
            "use `toyo program get` to see the stored steps"
        }
        Command::Wplt | Command::Cppl => "use `toyo palletizing get` to see the stored program",
        Command::Wesy | Command::Cesy => "use `toyo easy get` to see the stored program",
        Command::Dout => "use `toyo io list --out` to see the outputs",
        Command::Wovr => "use `toyo override get` to see the override",
        Command::Mcst => "use `toyo counter get` to see the counter",
        Command::Ctsk => "use `toyo task get` to see the current task",
        Command::Wmca | Command::Rmca => "use `toyo status` to see whether the card is in use",
        _ => "use `toyo status` to see the state of the controller",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_gives_the_reason_of_a_refusal() {
        let fine = Status::default().with(0, 0x30).with(2, 0x80).with(3, 0x11);
        let why = |status: Status, command: Command| reason(status, command.row()).map(|(why, _)| why);
        assert_eq!(why(fine, Command::Home), None);
        assert_eq!(why(fine.with(2, 0x40), Command::Home).unwrap(), "the teach pendant is ON");
        assert_eq!(why(fine.with(2, 0), Command::Home).unwrap(), "the host is OFF");
        assert_eq!(why(fine.with(0, 0x32), Command::Spst).unwrap(), "the controller executes a program or command");
        assert_eq!(why(fine.with(3, 0x10), Command::Spst).unwrap(), "servo power is off");
        assert_eq!(why(fine.with(0, 0x20), Command::Spst).unwrap(), "the axes have not returned to the origin");
        assert!(why(fine.with(0, 0x31).with(1, 0x28), Command::Spst).unwrap().starts_with("error 28: axis 1"));
        let question = of_question(&Request::of(Command::Mcnt, [Value::Number(5)]));
        assert_eq!(question.message, "the controller refused MCNT CN=05 (@NG): the status shows no reason");
        assert!(
            why(fine.with(0, 0xB0), Command::Cerr)
                .unwrap()
                .starts_with("a machine parameter (parameter 2) was changed")
        );
        assert_eq!(why(fine.with(2, 0x83), Command::Spst).unwrap(), "the controller is in easy mode");
        assert_eq!(why(fine.with(2, 0x80), Command::Extp).unwrap(), "the controller is in sequential mode");
        assert_eq!(why(fine.with(2, 0x88), Command::Ppst).unwrap(), "the controller is in program mode");
        assert_eq!(why(fine, Command::Wmca).unwrap(), "there is no memory card");
    }
}
