//! A controller's `@NG` in words: it has no code, so the status must tell why.

use super::link::Link;
use crate::controller::Risk;
use crate::controller::toyo::errors;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::{ProgramKind, RunMode, Status};
use crate::controller::toyo::table::commands::{Command, Row};
use crate::failure::{Failure, Kind};

/// What may be behind a refusal, as far as the status tells.
pub async fn explained(link: &mut Link, request: &Request) -> Failure {
    let row = request.row();
    if row.risk == Risk::Read {
        return of_question(request);
    }
    let status = match link.status().await {
        Ok(status) => status,
        // It was answered with yes as well.
        Err(failure) if failure.kind == Kind::OutcomeUnknown => return failure,
        // That it was refused is known, whatever becomes of the question why.
        Err(_) => {
            return refused(request, "the status, which may tell why, could not be read", "`toyo status` may tell why");
        }
    };
    match reason(status, row) {
        Some((why, hint)) => refused(request, &why, &hint),
        None => refused(request, "the status does not tell why", &unexplained(row)),
    }
}

/// A question was refused, of which nothing in the status tells why.
pub fn of_question(request: &Request) -> Failure {
    refused(request, "the status does not tell why", &unexplained(request.row()))
}

/// The teach pendant has the controller.
pub fn pendant() -> Failure {
    Failure::new(Kind::Refused, "the controller refused: the teach pendant is ON, and the host cannot take over")
        .hint("switch the teach pendant OFF, then repeat the command")
        .code("NG")
}

/// Not even the status is told.
pub fn mute() -> Failure {
    Failure::new(Kind::Refused, "the controller refuses even to tell its status (@NG)")
        .hint("it is busy, or no such controller: try again, then look at the teach pendant")
        .code("NG")
}

/// Names the whole block: which point, counter or step it was about.
fn refused(request: &Request, why: &str, hint: &str) -> Failure {
    let text = request.text();
    let block = text.trim_start_matches('@');
    Failure::new(Kind::Refused, format!("the controller refused {block} (@NG): {why}")).hint(hint).code("NG")
}

/// The weightiest thing in the status that keeps a command from being done, with what to do.
fn reason(status: Status, row: &Row) -> Option<(String, String)> {
    let told = |why: &str, hint: &str| Some((why.to_owned(), hint.to_owned()));
    let moves = row.risk == Risk::Motion;
    if status.pendant_on() {
        return told("the teach pendant is ON", "switch the teach pendant OFF");
    }
    if status.needs_power_cycle() {
        return told(
            "parameter 2 was changed: only communication works until the power was off",
            "switch the controller's power off and on",
        );
    }
    if status.has_error() {
        let error = errors::explain(status.error);
        let hint = if row.command == Command::Cerr { error.remedy.to_owned() } else { cure(error.remedy) };
        return Some((format!("error {}", error.in_a_line()), hint));
    }
    if row.needs_host && !status.host_on() {
        return told("the host is OFF", "`toyo host on`");
    }
    if status.card_reading() || status.card_writing() {
        return told(
            "the memory card is being used",
            "wait until it is done: `toyo status --until '.data.card | (.reading or .writing) | not'`",
        );
    }
    if status.homing() {
        return told("the axes are returning to the origin", "wait for the end, or `toyo stop`");
    }
    if status.executing() {
        return told("a program or command is being executed", "wait for the end, or `toyo stop`");
    }
    if moves && !status.servo_on() && !matches!(row.command, Command::Svon | Command::Svof | Command::Mrss) {
        return told("servo power is off", "`toyo servo on`");
    }
    if let Some((kind, how)) = kind_of(row.command) {
        if status.run_mode() == Some(RunMode::Program) {
            return told("the controller is in program mode", "`toyo mode auto`");
        }
        if status.program_kind() != kind {
            let mode = status.program_kind().name().replace('_', " ");
            return Some((format!("the controller is in {mode} mode"), how.to_owned()));
        }
        if !status.homed() {
            return told("the axes have not returned to the origin", "`toyo home`");
        }
    }
    match row.command {
        Command::Wmca | Command::Rmca if !status.card_inserted() => told("there is no memory card", "insert one"),
        Command::Rmca => told("the status does not tell why", "there may be nothing on the card that can be read"),
        Command::Mrss => told("the status does not tell why", "coordinates sent before may still wait for their RSMV"),
        _ if row.writes_eeprom && status.run_mode() != Some(RunMode::Program) => {
            told("the controller is not in program mode", "`toyo mode program`, if the controller asks for it")
        }
        _ => None,
    }
}

/// What to do about an error, in the order in which a controller takes it: nothing moves before the error is cancelled.
pub fn cure(remedy: &str) -> String {
    match remedy.strip_suffix(" first") {
        Some(motion) => format!("`toyo alarm reset`, then {motion}"),
        None => format!("{remedy}; then `toyo alarm reset`"),
    }
}

/// What a start runs, and how that mode is chosen.
fn kind_of(start: Command) -> Option<(ProgramKind, &'static str)> {
    Some(match start {
        Command::Spst => (
            ProgramKind::Sequential,
            "`toyo mode sequential`; easy and external point mode end with `toyo param set M10 I`",
        ),
        Command::Ppst => (
            ProgramKind::Palletizing,
            "`toyo mode palletizing`; easy and external point mode end with `toyo param set M10 I`",
        ),
        Command::Sesy => (ProgramKind::Easy, "`toyo param set M10 E` chooses easy mode"),
        Command::Extp => (ProgramKind::ExternalPoint, "`toyo param set M10 P` chooses external point mode"),
        _ => return None,
    })
}

fn unexplained(row: &Row) -> String {
    if row.command == Command::Dout {
        "there may be no such output, or parameter M12 (direct-outputs) have no bit for F1 to F4".to_owned()
    } else if row.only_on.is_empty() {
        "the value may be out of what this controller has, or the controller be busy: try again".to_owned()
    } else {
        format!("only some controllers have it: {}", row.only_on.join(", "))
    }
}

/// What tells whether an order was carried out whose answer was lost.
pub fn verification_hint(command: Command) -> &'static str {
    match command {
        Command::Home | Command::Sorg => {
            "keep clear; `toyo status` tells whether it moves, and whether the origin is done"
        }
        Command::Spst | Command::Ppst | Command::Sesy | Command::Extp | Command::Mrss => {
            "keep clear; `toyo status` and `toyo position` tell whether it moves, and where it is"
        }
        Command::Jgst => "keep clear; `toyo stop --jog` stops it, `toyo position` tells where it is",
        Command::Svon | Command::Svof => "`toyo status` tells whether servo power is on",
        Command::Wpar => "`toyo param get` tells what is stored",
        Command::Wstx | Command::Istx | Command::Dstx | Command::Dstl | Command::Cpss => {
            "`toyo program get` tells what is stored"
        }
        Command::Wplt | Command::Cppl => "`toyo palletizing get` tells what is stored",
        Command::Wesy | Command::Cesy => "`toyo easy get` tells what is stored",
        Command::Dout => "`toyo io list --out` reads them",
        Command::Wovr => "`toyo override get` tells",
        Command::Mcst => "`toyo counter get` tells",
        Command::Ctsk => "`toyo task get` tells",
        Command::Wmca | Command::Rmca => "`toyo status` tells whether the card is being used",
        _ => "`toyo status` tells how the controller stands",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::toyo::field::Value;

    #[test]
    fn the_status_tells_why() {
        let fine = Status::default().with(0, 0x30).with(2, 0x80).with(3, 0x11);
        let why = |status: Status, command: Command| reason(status, command.row()).map(|(why, _)| why);
        assert_eq!(why(fine, Command::Home), None);
        assert_eq!(why(fine.with(2, 0x40), Command::Home).unwrap(), "the teach pendant is ON");
        assert_eq!(why(fine.with(2, 0), Command::Home).unwrap(), "the host is OFF");
        assert_eq!(why(fine.with(0, 0x32), Command::Spst).unwrap(), "a program or command is being executed");
        assert_eq!(why(fine.with(3, 0x10), Command::Spst).unwrap(), "servo power is off");
        assert_eq!(why(fine.with(0, 0x20), Command::Spst).unwrap(), "the axes have not returned to the origin");
        assert!(why(fine.with(0, 0x31).with(1, 0x28), Command::Spst).unwrap().starts_with("error 28: axis 1"));
        let question = of_question(&Request::of(Command::Mcnt, [Value::Number(5)]));
        assert_eq!(question.message, "the controller refused MCNT CN=05 (@NG): the status does not tell why");
        assert!(why(fine.with(0, 0xB0), Command::Cerr).unwrap().starts_with("parameter 2 was changed"));
        assert_eq!(why(fine.with(2, 0x83), Command::Spst).unwrap(), "the controller is in easy mode");
        assert_eq!(why(fine.with(2, 0x80), Command::Extp).unwrap(), "the controller is in sequential mode");
        assert_eq!(why(fine.with(2, 0x88), Command::Ppst).unwrap(), "the controller is in program mode");
        assert_eq!(why(fine, Command::Wmca).unwrap(), "there is no memory card");
    }
}
