//! Replay of a recording: signals and state of the machine follow the recorded image and answers.

use super::alarms::{AlarmSource, EMERGENCY_STOP};
use super::robot::Servo;
use super::world::{Mode, World};
use crate::simulator::recording::Replay;
use crate::yrcx::alarm::Alarm;
use crate::yrcx::answer::Status;
use crate::yrcx::image::{DEDICATED_WORD, Image, Words};
use crate::yrcx::recording::{IMAGE, parse_signals, parse_words, words_text};
use crate::yrcx::signal::output;
use crate::yrcx::table::Command;
use crate::yrcx::value::Key;

/// Applies the recorded image. The checks of changes use the state of the machine.
pub(super) fn follow(world: &mut World, replay: &Replay) {
    let Some(image) = replay.answer(IMAGE).and_then(parse_signals) else { return };
    let (motor, emergency) = (output::SERVO_ON.is_on(&image), output::EMERGENCY_STOP.is_on(&image));
    world.switches.mode = if output::AUTO_MODE.is_on(&image) { Mode::Auto } else { Mode::Manual };
    world.switches.warning = output::WARNING.is_on(&image);
    world.switches.estop = emergency;
    world.reset_done = output::PROGRAM_RESET.is_on(&image);
    world.motor = motor;
    let is_at_home = output::ORIGIN_COMPLETE.is_on(&image);
    for axis in world.robots.iter_mut().flat_map(|robot| &mut robot.axes) {
        axis.servo = if motor { Servo::On } else { Servo::Brake };
        axis.origin |= is_at_home;
    }
    if !output::ALARM.is_on(&image) {
        world.alarms.clear();
    } else if world.alarms.active().is_none() {
        let recorded = latest_alarm(replay).unwrap_or(EMERGENCY_STOP);
        world.alarms.raise(recorded, AlarmSource::Controller, !output::CPU_OK.is_on(&image));
    }
}

/// Shows the recorded signals in the output image.
pub(super) fn show(replay: &Replay, image: &mut Image) {
    if let Some(recorded) = replay.answer(IMAGE).and_then(parse_signals) {
        image.0[DEDICATED_WORD..].copy_from_slice(&recorded.0[DEDICATED_WORD..]);
    }
}

/// Recorded answer to a remote command.
pub(super) fn answer(replay: &Replay, words: &Words) -> Option<Words> {
    replay.answer(&words_text(words)).and_then(parse_words).filter(|words| words[0] != Status::Ready.word())
}

/// Entry 1 of the recorded alarm history.
fn latest_alarm(replay: &Replay) -> Option<Alarm> {
    let order = Command::AlarmHistory.order().with(Key::History, 1).build().ok()?;
    let answer = answer(replay, order.words())?;
    Some(Alarm::new(answer[1], answer[2]))
}
