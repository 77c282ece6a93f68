//! Reads old values before a remote command sets new values: which command reads them, and which field of its answer
//! has them.

use serde_json::Value as Json;

use super::confirmed_write::read_current;
use super::robot_settings::{SETTINGS, Setting};
use super::single_command::format_field;
use super::var::held;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;
use armctl_frame::settings_report::{OLD_VALUE, nothing_written};

/// Reads the values that a command replaces. If the controller refuses the read, the old values stay unknown. A dry run
/// only notes the request.
pub async fn read_old_values(link: &mut Link, order: &Order) -> Result<Old> {
    let Some(read) = read_command(order) else { return Ok(Old::UNREAD) };
    let values = read_current(link, &read.valid_order()?, OLD_VALUE).await.map_err(nothing_written)?;
    Ok(Old::read(values.and_then(|values| extract_old_value(order, &values))))
}

/// Builds the confirmation question for a command that sets a value. The question shows old and new value only for
/// servos, and only if the old value was read.
pub fn question(order: &Order, intent: String, old: &Old) -> Change {
    let change = Change::new(if intent.is_empty() { order.row().name.to_owned() } else { intent });
    let new = match order.command() {
        Command::ServoOn => "on",
        Command::ServoOff => "off",
        Command::ServoFree => "free",
        _ => return change,
    };
    match old.describe() {
        Some(old) => change.replaces("servo", &old, new),
        None => change,
    }
}

/// Returns the command that reads the values that `order` sets. The protocol has no such command for a torque limit, a
/// selected shift or hand, and motor power.
fn read_command(order: &Order) -> Option<Draft> {
    let values = order.values();
    let (read, keys): (_, &[Key]) = match order.command() {
        Command::VarSet
        | Command::VarSetVar
        | Command::VarAdd
        | Command::VarAddVar
        | Command::VarSub
        | Command::VarSubVar
        | Command::VarMul
        | Command::VarMulVar
        | Command::VarDiv
        | Command::VarDivVar => (Command::VarGet, &[Key::Variable]),
        Command::PortSet | Command::PortSetBit => (Command::PortGet, &[Key::PortType, Key::Port]),
        Command::ServoOn | Command::ServoOff | Command::ServoFree => (Command::ServoStatus, &[Key::Robot]),
        _ => (find_setting(order)?.read.0, &[Key::Robot]),
    };
    let given = keys.iter().filter_map(|key| Some((*key, values.int(*key)?)));
    Some(given.fold(read.order(), |draft, (key, number)| draft.with(key, number)))
}

/// The setting that a command writes.
fn find_setting(order: &Order) -> Option<&'static Setting> {
    SETTINGS.iter().find(|setting| setting.write.0 == order.command())
}

/// Takes the old values from an answer, in the form of the command's report.
fn extract_old_value(order: &Order, answer: &Values) -> Option<Json> {
    let number = |key| answer.int(key).map(Json::from);
    match order.command() {
        Command::PortSet => number(Key::Value),
        Command::PortSetBit => {
            let bit = order.values().int(Key::PortBit)?;
            answer.int(Key::Value).map(|port| Json::from(port >> bit & 1))
        }
        Command::ServoOn | Command::ServoOff | Command::ServoFree => servo_states(order.values(), answer),
        _ => match find_setting(order).map(|setting| setting.read) {
            None => Some(held(answer.value(Key::Value))),
            Some((command, Key::Arm)) => format_field(command, answer, Key::Arm).map(Json::from),
            Some((_, key)) => number(key),
        },
    }
}

/// Returns `on`, `off` or `free` if all selected axes have the same state. Otherwise returns one value per axis, with
/// null for an axis that does not exist.
fn servo_states(order: &Values, answer: &Values) -> Option<Json> {
    let mask = order.int(Key::Axes).unwrap_or_default();
    let state = |key| match format_field(Command::ServoStatus, answer, key).as_deref() {
        Some("servo") => Some("on"),
        Some("brake") => Some("off"),
        Some("free") => Some("free"),
        _ => None,
    };
    let is_axis_moved = Key::AXES.into_iter().enumerate().filter(|(at, _)| mask == 0 || mask >> at & 1 == 1);
    let states: Vec<Option<&str>> = is_axis_moved.map(|(_, key)| state(key)).collect();
    let mut there = states.iter().flatten();
    let first = there.next()?;
    Some(if there.all(|state| state == first) { Json::from(*first) } else { Json::from(states) })
}
