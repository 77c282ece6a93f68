use crate::prelude::basics::*;
use crate::testing::{
    Bench, Reply, Scripted, answer, entries, example, frames, intent, run_on, undefined, words, written,
};
use armctl_controller::yrcx::image::Words;

/// A command line for each worked example of 4.2. Misprints of the manual are corrected, as in the data file.
pub(crate) const EXAMPLES: &[(&str, &str)] = &[
    ("4.2.1-ptp", "move --point 100 --speed 50 --report pulse"),
    ("4.2.1-arch", "move --point 100 --speed 50 --arch 3:1.000 --arch-start 0 --arch-end 0 --report mm"),
    ("4.2.1-linear", "move --point 100 --linear --speed 200mm/s --accel 50 --report mm"),
    ("4.2.1-circular", "move --point 100,101 --circular --speed 20 --decel 50 --report mm"),
    ("4.2.1-direct-mm", "move --to 10,-20,5,-18 --speed 50 --report mm"),
    ("4.2.1-direct-pulse", "move --to-pulse 100000,-200000,50000,-180000 --speed 50 --report pulse"),
    ("4.2.2-ptp", "movei --point 100 --speed 50 --report pulse"),
    ("4.2.2-linear", "movei --point 100 --linear --speed 200mm/s --accel 50 --report mm"),
    ("4.2.2-direct-mm", "movei --by 10,-20,5,-18 --speed 50 --report mm"),
    ("4.2.2-direct-pulse", "movei --by-pulse 100000,-200000,50000,-180000 --speed 50 --report pulse"),
    ("4.2.3-point", "drive --axis 3 --point 100 --speed 50 --report pulse"),
    ("4.2.3-direct-mm", "drive --axis 3 --to 5 --speed 50 --report mm"),
    ("4.2.3-direct-pulse", "drive --axis 3 --to-pulse 5000 --speed 50 --report pulse"),
    ("4.2.4-point", "drivei --axis 3 --point 100 --speed 50 --report pulse"),
    ("4.2.4-direct-mm", "drivei --axis 3 --by 5.000 --speed 50 --report mm"),
    ("4.2.4-direct-pulse", "drivei --axis 3 --by-pulse 5000 --speed 50 --report pulse"),
    ("4.2.5-ptp", "pallet --pallet 1 --position 21 --speed 70 --report mm"),
    ("4.2.5-arch", "pallet --pallet 10 --position 32 --speed 70 --arch 3:1 --report mm"),
    ("4.2.6-pulse", "jog pulse 1 -"),
    ("4.2.6-cartesian", "jog cartesian 1 -"),
    ("4.2.6-tool", "jog tool 1 - --report mm"),
    ("4.2.7-pulse", "inch pulse 2 +"),
    ("4.2.7-cartesian", "inch cartesian 2 + --report mm"),
    ("4.2.7-tool", "inch tool 2 +"),
    ("4.2.8-amount", "inch-distance 100"),
    ("4.2.10-absmove", "abs-reset --axis 2 --move -"),
    ("4.2.11-absreset", "abs-reset --axis 2"),
    ("4.2.12-robot", "origin --unit 1"),
    ("4.2.12-axis", "origin --axis 1"),
    ("4.2.13-free", "servo free --axis 4"),
    ("4.2.14-manual", "speed manual 20"),
    ("4.2.15-auto", "speed auto 80"),
    ("4.2.16-program", "speed program 80"),
    ("4.2.17-shift", "shift select 4"),
    ("4.2.18-hand", "hand select 1"),
    ("4.2.19-arm", "arm select right"),
    ("4.2.20-on", "motor on"),
    ("4.2.21-ptp", "movet --point 100 --speed 50 --report pulse"),
    ("4.2.21-linear", "movet --point 100 --linear --speed 200mm/s --accel 50 --report mm"),
    ("4.2.22-torque", "torque-limit --axis 1 50"),
    ("4.2.23-point", "push --axis 3 --point 100 --speed 50 --force 100 --time 100ms --report mm"),
    ("4.2.23-direct-mm", "push --axis 3 --to 10 --speed 50 --force 100 --time 100ms --report mm"),
    ("4.2.23-direct-pulse", "push --axis 3 --to-pulse 10000 --speed 50 --force 100 --time 0.1s --report pulse"),
];

/// Whether a single command sends the example. The command line for teaching sends several commands, so its example is
/// in `orders`.
fn is_one_order(id: &str) -> bool {
    id.starts_with("4.2.") && id != "4.2.9-teach"
}

fn split(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

#[test]
fn every_example_of_the_section_has_a_command_line() {
    let printed = entries();
    let printed: Vec<&str> = printed.iter().filter_map(|entry| entry["id"].as_str()).collect();
    let printed: Vec<&str> = printed.into_iter().filter(|id| is_one_order(id)).collect();
    assert_eq!(EXAMPLES.iter().map(|(id, _)| *id).collect::<Vec<_>>(), printed);
}

#[test]
fn command_lines_send_the_words_of_the_examples() {
    for (id, line) in EXAMPLES {
        assert_eq!(written(&split(line)).unwrap(), [example(id)], "{id}");
    }
    let walk_through = words(&split("move --point 19 --speed 50")).unwrap();
    assert_eq!(walk_through, [example("2-ptp-walkthrough")]);
    // According to its text, the example in the manual is for robot 1, but its words select all robots (4.2.12).
    assert_eq!(words(&["origin"]).unwrap()[0][0], "0x0032");
}

/// Positions that the manual prints as numbers.
fn positions(entry: &Value) -> (Value, Value) {
    let number = |key: &str| entry["answer"][key].as_str().unwrap().parse::<f64>().unwrap();
    let axes = ["axis_1", "axis_2", "axis_3", "axis_4"];
    match entry["request"]["report"].as_str() {
        Some("mm") => (json!(axes.map(number)), Value::Null),
        #[expect(clippy::cast_possible_truncation, reason = "pulses are whole numbers")]
        Some(_) => (Value::Null, json!(axes.map(|axis| number(axis) as i32))),
        None => (Value::Null, Value::Null),
    }
}

#[test]
fn answers_give_the_reports_of_the_examples() {
    for ((id, line), entry) in
        EXAMPLES.iter().zip(entries().iter().filter(|entry| is_one_order(entry["id"].as_str().unwrap())))
    {
        let reply = if entry["refused"] == "12.400" { Reply::UntilStop } else { |words| Reply::AddressPair(1, words) };
        let mut line = split(line);
        if entry["refused"] == "12.400" {
            line.extend(["--for", "200ms"]);
        }
        let before = undefined(&line);
        let count = before.len() + 1;
        let (outcome, peer) = run_on(Scripted::new(before.into_iter().chain([reply(answer(id))])), &line);
        let report = outcome.unwrap_or_else(|failure| panic!("{id}: {failure}"));
        assert_eq!(peer.taken.len(), count, "{id}");
        if report.get("elapsed_ms").is_some() {
            let axes = |unit: &str| {
                let joints = report["position"]["joints"].as_array();
                let values = joints.map(|joints| joints.iter().map(|joint| joint[unit].clone()).collect::<Value>());
                values.filter(|values| !values[0].is_null()).unwrap_or_default()
            };
            let reported = (axes("mm"), axes("pulses"));
            assert_eq!((reported, &report["reached"]), (positions(entry), &true.into()), "{id}: {report}");
        }
        if entry["answer"]["push_result"].is_string() {
            assert_eq!(report["push_result"], 1, "{id}");
        }
    }
}

fn words_of(head: &[u16]) -> Words {
    let mut words = [0; 16];
    words[..head.len()].copy_from_slice(head);
    words
}

/// Word of the dedicated inputs in the resting image: the emergency-stop input and the stop input are on. In `HELD`,
/// the stop input is off.
const REST: u16 = 0x0041;
const HELD: u16 = 0x0001;

/// A line for each kind of motion.
const KINDS: [&str; 11] = [
    "move --point 1",
    "movei --point 1",
    "movet --point 1",
    "drive --axis 1 --to 5",
    "drivei --axis 1 --by 5",
    "pallet --pallet 1 --position 1",
    "push --axis 1 --to 5",
    "inch pulse 1 +",
    "origin",
    "abs-reset --axis 1 --move +",
    "jog pulse 1 +",
];

#[test]
fn an_interrupt_stops_every_kind_of_motion() {
    for line in KINDS {
        let mut bench = Bench::new(Scripted::new([Reply::UntilStop(words_of(&[0x4000, 12, 400]))]));
        bench.interrupt(&split(line), Duration::from_secs(2));
        let told = bench.halt().unwrap();
        assert!(
            told.starts_with("the robot was stopped by the stop input SI(06), which is on again"),
            "{line}: {told}"
        );
        assert_eq!(told.contains("moves to the old target"), line.contains("ei --"), "{line}: {told}");
        let peer = bench.into_peer();
        assert_eq!((peer.taken.len(), &peer.bits[..]), (1, &[REST, HELD, REST][..]), "{line}");
    }
}

#[test]
fn interrupt_at_any_moment_stops_the_motion() {
    for line in ["move --point 1", "jog pulse 1 +", "jog pulse 1 + --for 50ms"] {
        let (mut stopped, mut unsent) = (0, 0);
        for ms in (0..90).step_by(3) {
            let mut bench = Bench::new(Scripted::new([Reply::UntilStop(words_of(&[0x4000, 12, 400]))]));
            if !bench.run_and_drop(&split(line), Duration::from_millis(ms)) {
                continue;
            }
            let told = bench.halt().unwrap();
            let peer = bench.into_peer();
            let bits: &[u16] = match peer.taken.len() {
                0 => &[REST],
                _ => &[REST, HELD, REST],
            };
            assert_eq!((&peer.bits[..], peer.image.0[0]), (bits, 0), "{line} {ms}: {told}");
            stopped += u32::from(!peer.taken.is_empty());
            unsent += u32::from(peer.taken.is_empty());
        }
        assert!(stopped > 10 && unsent > 0, "{line}: {stopped} stopped, {unsent} not sent");
    }
}

#[test]
fn lost_answer_of_any_motion_is_an_unknown_outcome() {
    for line in KINDS {
        let lost = Reply::Loses(2, Duration::from_millis(300));
        let (outcome, peer) = run_on(Scripted::new([lost]), &split(line));
        let failure = outcome.unwrap_err();
        assert_eq!((failure.kind, peer.taken.len()), (Kind::OutcomeUnknown, 1), "{line}");
        assert!(failure.hint.unwrap().starts_with("keep clear"), "{line}");
    }
}

#[test]
fn no_wait_needs_a_session() {
    for line in KINDS.iter().filter(|line| !line.starts_with("jog")) {
        let mut bench = Bench::new(Scripted::new([Reply::AddressPair(200, words_of(&[0x0200]))]));
        let begun = bench.run(&[&split(line)[..], &["--no-wait"]].concat()).unwrap();
        assert_eq!((&begun["reached"], &begun["elapsed_ms"]), (&Value::Null, &Value::Null), "{line}");
    }
}

#[test]
fn interrupted_relative_motion_warns_about_its_target() {
    for line in ["movei --point 1", "drivei --axis 1 --by 5"] {
        let (outcome, _) = run_on(Scripted::new([Reply::AddressPair(9, words_of(&[0x4000, 12, 600]))]), &split(line));
        let hint = outcome.unwrap_err().hint.unwrap();
        assert!(hint.contains("release the emergency stop") && hint.contains("moves to the old target"), "{hint}");
    }
    let (outcome, _) =
        run_on(Scripted::new([Reply::AddressPair(9, words_of(&[0x4000, 12, 600]))]), &split("move --point 1"));
    assert!(!outcome.unwrap_err().hint.unwrap().contains("old target"));
}

#[test]
fn every_confirmation_names_the_robot() {
    for line in KINDS {
        let robot = if line == "origin" { "all robots" } else { "robot 1" };
        assert!(intent(&split(line)).contains(robot), "{line}");
        let second = intent(&[&split(line)[..], &["--unit", "2"]].concat());
        assert_eq!(second.matches("robot 2").count(), 1, "{second}");
    }
}

#[test]
fn a_dry_run_of_a_jog_shows_the_stop() {
    let frames = frames(&["jog", "pulse", "1", "+"]).unwrap();
    let told: Vec<&Value> = frames.iter().map(|frame| &frame["about"]).collect();
    assert_eq!(told, [&Value::Null, &"stop (SI(06)) off".into(), &"stop (SI(06)) on".into()]);
    assert_eq!((&frames[1]["bits"][0], &frames[2]["bits"][0]), (&"0x0001".into(), &"0x0041".into()));
}
