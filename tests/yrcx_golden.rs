//! Golden words of the YRCX family: the 97 worked examples of the manual (`data/yrcx-examples.json` cites the section
//! of each) and the places of all fields (`data/yrcx-layouts.json`).
//!
//! The meaning of an example is encoded into words and compared with its words. The words are also decoded and compared
//! with the meaning. Both are done for commands and for answers. Words that the manual misprints are in the file twice,
//! as printed and corrected, and are named in `misprinted`. If a test fails, the code is wrong: do not change the
//! words.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::collections::BTreeMap;

use armctl_controller::Risk;
use armctl_controller::yrcx::alarm::Alarm;
use armctl_controller::yrcx::answer::{self, Answer};
use armctl_controller::yrcx::describe;
use armctl_controller::yrcx::image::Words;
use armctl_controller::yrcx::order::{Draft, Order};
use armctl_controller::yrcx::table::{Command, Field, Form, ROWS, Row, Show};
use armctl_controller::yrcx::value::{Key, Value, Values};
use serde_json::Value as Json;

#[test]
fn has_97_examples() {
    assert_eq!(examples().len(), 97);
}

#[test]
fn builds_commands_from_values() {
    for example in examples() {
        assert_eq!(hex(example.order().words()), hex(&example.command_words()), "{}", example.id());
    }
}

#[test]
fn parses_commands_into_values() {
    for example in examples() {
        let order = Order::parse(&example.command_words()).unwrap();
        let meant = example.strings("request");
        for (key, text) in &meant {
            let found = shown_values(order.row().request(), order.values(), *key, text);
            assert_eq!(&found, text, "{} {key}", example.id());
        }
        for (key, value) in order.values().iter() {
            // A value that the example does not mention is a flag or a mode that another value determines, or it is 0.
            let follows = key.name().ends_with("_flag")
                || matches!(key, Key::SpeedMode | Key::Selection)
                || *value == Value::Int(0);
            assert!(meant.contains_key(&key) || follows, "{} {key} {value:?}", example.id());
        }
        let mut again = order.command().order();
        for (key, value) in order.values().iter() {
            again = again.with(key, value.clone());
        }
        assert_eq!(again.build().unwrap(), order, "{}", example.id());
    }
}

#[test]
fn parses_answers_into_values() {
    for example in examples() {
        let Some(words) = example.answer_words() else { continue };
        let (order, id) = (example.order(), example.id());
        let values = match Answer::parse(&order, &words).unwrap() {
            Answer::Done(values) => {
                assert_eq!(example.refused(), None, "{id}");
                values
            }
            Answer::Refused { alarm, positions } => {
                assert_eq!(example.refused(), Some(alarm), "{id}");
                positions
            }
            Answer::Running(_) => panic!("{id}: over"),
        };
        let meant = example.strings("answer");
        let found: BTreeMap<Key, String> =
            answer::fields(&order, &words).map(|(field, value)| (field.key, field.show(&value))).collect();
        for (key, text) in &meant {
            assert_eq!(found.get(key), Some(text), "{id} {key}");
        }
        for (key, value) in values.iter() {
            assert!(meant.contains_key(&key) || *value == Value::Int(0), "{id} {key} {value:?}");
        }
    }
}

#[test]
fn builds_answers_from_values() {
    for example in examples() {
        let Some(words) = example.answer_words() else { continue };
        let values: Values = example.strings("answer").into_iter().collect();
        let answer = match example.refused() {
            Some(alarm) => Answer::Refused { alarm, positions: values },
            None => Answer::Done(values),
        };
        assert_eq!(hex(&answer.words(&example.order()).unwrap()), hex(&words), "{}", example.id());
    }
}

#[test]
fn marks_misprints_per_word() {
    let mut flagged = 0;
    for example in examples() {
        let mut differ = Vec::new();
        for side in ["wi", "wo"] {
            let Some(corrected) = example.0.get(format!("{side}_corrected")) else { continue };
            let pairs = example.0[side].as_array().unwrap().iter().zip(corrected.as_array().unwrap()).enumerate();
            differ.extend(pairs.filter(|(_, (a, b))| a != b).map(|(n, _)| format!("{}{n}", side.to_uppercase())));
        }
        let named: Vec<&str> = example.0.get("misprinted").map_or(Vec::new(), strings_of);
        assert_eq!(differ, named, "{}", example.id());
        assert!(named.is_empty() || example.0.get("note").is_some(), "{}", example.id());
        flagged += usize::from(!named.is_empty());
    }
    assert_eq!(flagged, 10);
}

#[test]
fn parses_misprinted_commands_literally() {
    let examples = examples();
    let printed = |id: &str| {
        let example = examples.iter().find(|example| example.id() == id).unwrap();
        example.printed_words("wi").map(|words| Order::parse(&words))
    };
    let value = |id: &str, key| printed(id).unwrap().unwrap().values().int(key);
    assert_eq!(value("4.2.12-robot", Key::Robot), Some(0), "all robots, where robot 1 is meant");
    for id in ["4.2.23-point", "4.2.23-direct-mm", "4.2.23-direct-pulse"] {
        assert_eq!((value(id, Key::PushForce), value(id, Key::PushTime)), (Some(50), Some(50)), "{id}");
    }
    // The manual prints five digits here, which is not a valid word.
    assert_eq!(printed("4.2.1-direct-pulse"), None);
    let refusal = printed("4.6.3-reset").unwrap().unwrap_err();
    assert_eq!(refusal.to_string(), "WI1: bits 0x0100 must be 0 here, but are set");
}

#[test]
fn explains_every_example_with_its_section() {
    for example in examples() {
        let (request, id) = (example.command_words(), example.id());
        let explained = describe::command(&request);
        assert_eq!(explained.problems, Vec::<String>::new(), "{id}");
        assert_eq!(explained.section, Some(example.row().section), "{id}");
        let Some(words) = example.answer_words() else { continue };
        let explained = describe::answer(&words, Some(&request));
        assert_eq!(explained.problems, Vec::<String>::new(), "{id}");
        let keys: Vec<Key> = explained.fields.iter().filter_map(|note| note.key).collect();
        assert!(example.strings("answer").keys().all(|key| keys.contains(key)), "{id} {keys:?}");
        assert!(explained.fields.iter().all(|note| note.name != "not used"), "{id}");
    }
}

#[test]
fn refuses_invalid_commands_before_sending() {
    let refusal = |draft: Draft| draft.build().unwrap_err();
    let to_point = || Command::MovePtp.order().with(Key::Point, 19);
    let both = refusal(to_point().with(Key::Report, 3));
    assert_eq!(both.alarm.unwrap().to_string(), "4.202", "4.2.1: both position outputs");
    let drive = || Command::DriveMm.order().with(Key::Target, "5.000");
    let arch = || Command::MoveArch.order().with(Key::Point, 1).with(Key::ArchUnit, "mm").with(Key::ArchPosition, "1");
    let cases: [(Draft, &str); 21] = [
        (Command::MovePtp.order(), "WI4 point: missing; allowed: 0 to 29999"),
        (to_point().with(Key::Point, 30_000), "WI4 point: 30000 is out of range; allowed: 0 to 29999"),
        (to_point().with(Key::Axes, 0), "WI2 axes: 0 selected; select 1 to 4"),
        (to_point().with(Key::Axes, "5"), "WI2 axes: 5: must be from 1 to 4"),
        (
            to_point().with(Key::Robot, 5),
            "WI0 robot: 5 is not defined; use 0 = none (robot 1), 1 = 1, 2 = 2, 3 = 3, 4 = 4",
        ),
        (to_point().with(Key::SpeedPercent, 0), "WI3 speed_percent: 0 is out of range; allowed: 1 to 100 %"),
        (
            to_point().with(Key::SpeedOfMax, "100.01"),
            "WI3 speed_of_max_percent: 100.01 is out of range; allowed: 0.01 to 100.00 %",
        ),
        (
            to_point().with(Key::SpeedPercent, 1).with(Key::SpeedOfMax, 1),
            "WI3 speed_percent: is not possible with speed_mode = 1, which is set or follows from another field",
        ),
        (to_point().with(Key::SpeedMmS, 100), "speed_mm_s: this command has no such field"),
        (drive(), "WI2 axes: missing; select exactly 1"),
        (drive().with(Key::Axes, "1,3"), "WI2 axes: 2 selected; select exactly 1"),
        (
            Command::PushPulse.order().with(Key::Target, 1).with(Key::Axes, "1,2"),
            "WI2 axes: 2 selected; select exactly 1",
        ),
        (Command::ServoOn.order().with(Key::Axes, "1,2"), "WI2 axes: 2 selected; select 0 to 1"),
        (Command::AbsoluteReset.order(), "WI2 axes: missing; select exactly 1"),
        (arch().with(Key::ArchAxis, "2,3"), "WI2 arch_axis: 2 selected; select exactly 1"),
        (
            Command::MoveMm.order().with(Key::Axis1, "10").with(Key::Axis2, "20"),
            "WI8 axis_3: missing; allowed: -2147483.648 to 2147483.647 mm",
        ),
        (
            Command::PalletSet
                .order()
                .with(Key::Pallet, 1)
                .with(Key::FirstPoint, 0)
                .with(Key::CountX, 200)
                .with(Key::CountY, 200)
                .with(Key::CountZ, 1),
            "WI3 nx: X times Y times Z is 40000; a pallet has 1 to 32767 positions",
        ),
        (
            Command::ParamSet.order().with(Key::Parameter, "TOLE").with(Key::Value, 1000),
            "WI3 axes: TOLE belongs to an axis; set the axis",
        ),
        (
            Command::PortSet.order().with(Key::PortType, "DO").with(Key::Port, 8).with(Key::Value, 1),
            "WI2 port: 8 is out of range; allowed: 2 to 7, 10 to 17, 20 to 27",
        ),
        (
            Command::ProgramRun.order().with(Key::ProgramName, "pick"),
            "WI6 program_name: 'pick' is not valid; allowed: 1 to 16 characters from A-Z, 0-9 and _",
        ),
        (
            Command::ProgramRun.order(),
            "WI1 selection: missing; use 0 = all, 1 = program number, 2 = task number, 4 = program name",
        ),
    ];
    for (draft, text) in cases {
        assert_eq!(refusal(draft).to_string(), text);
    }
}

#[test]
fn unmoved_axes_need_no_target() {
    let order = Command::MoveMm.order().with(Key::Axes, "1,3").with(Key::Axis1, "10").with(Key::Axis3, "-5").build();
    assert_eq!(order.unwrap().words()[..12], [6, 1, 0b101, 0, 0x2710, 0, 0, 0, 0xEC78, 0xFFFF, 0, 0]);
}

#[test]
fn sends_real_variables_in_single_precision() {
    let order = Command::VarSet.order().with(Key::Variable, "SGR5").with(Key::Value, "-1.5").build().unwrap();
    assert_eq!(order.words()[..6], [0x0200, 0, 0x0105, 0, 0x0000, 0xBFC0]);
    assert_eq!(order.values().value(Key::Value), Some(&Value::Real(-1.5)));
    assert!(Command::VarSet.order().with(Key::Variable, "SGI5").with(Key::Value, "-1.5").build().is_err());
    assert!(Command::VarSet.order().with(Key::Variable, "SGR5").with(Key::Value, f32::NAN).build().is_err());
}

#[test]
fn the_walk_through_of_chapter_2_section_2() {
    let order = Command::MovePtp.order().with(Key::Point, 19).with(Key::SpeedPercent, 50).build().unwrap();
    assert_eq!(order.words()[..5], [0x0001, 0x0004, 0, 0x0032, 0x0013]);
    assert_eq!(order.words()[5..], [0; 11]);
    assert_eq!(order.risk(), Risk::Motion);
}

#[test]
fn every_field_has_the_position_of_the_manual() {
    let layouts = json("yrcx-layouts.json");
    assert_eq!(layouts.len(), ROWS.len());
    for layout in &layouts {
        let code = u16::from_str_radix(&layout["code"].as_str().unwrap()[2..], 16).unwrap();
        let row = Row::from_word(code).unwrap();
        let name = row.id;
        assert_eq!(row.section, layout["section"], "{name}");
        assert_eq!(Json::from(row.has_robot()), layout["robot"], "{name}");
        assert_eq!(Json::from(row.enabled_under_programming_box()), layout["programming_box"], "{name}");
        let fields: Vec<&Field> = row.request().collect();
        check_places(name, &fields, &layout["wi"]);
        check_ranges(name, &fields, &layout["wi"]);
        check_places(name, &row.answer().collect::<Vec<_>>(), &layout["wo"]);
    }
}

/// Compares the bits of the fields with the expected rows: first word, last word, bits, and sometimes a range.
fn check_places(name: &str, fields: &[&Field], expected: &Json) {
    let mut table = [0_u16; 16];
    for field in fields {
        table[field.word..field.word + field.size()].iter_mut().for_each(|word| *word |= field.mask());
    }
    let mut manual = [0_u16; 16];
    for row in expected.as_array().unwrap() {
        let at = |n: usize| usize::try_from(row[n].as_u64().unwrap()).unwrap();
        manual[at(0)..=at(1)].iter_mut().for_each(|word| *word |= mask_of(row[2].as_str().unwrap()));
    }
    assert_eq!(hex(&table), hex(&manual), "{name}");
}

/// Compares the ranges of command fields. Answer fields have no ranges.
fn check_ranges(name: &str, fields: &[&Field], expected: &Json) {
    for row in expected.as_array().unwrap() {
        let Some(range) = row.get(3) else { continue };
        let bound = |n: usize| i32::try_from(range[n].as_i64().unwrap()).unwrap();
        let spans: Vec<(i32, i32)> = fields
            .iter()
            .filter(|field| row[0] == field.word)
            .map(|field| match (field.form, field.spans) {
                (Form::Bits { show: Show::Choice(choices), .. }, _) => (0, i32::from(choices.last().unwrap().0)),
                (Form::Bits { low, .. }, []) => (0, i32::from(field.mask() >> low)),
                (_, spans) => (spans.first().unwrap().0, spans.last().unwrap().1),
            })
            .collect();
        assert!(spans.contains(&(bound(0), bound(1))), "{name} {row} {spans:?}");
    }
}

fn mask_of(bits: &str) -> u16 {
    if bits == "all" {
        return u16::MAX;
    }
    let (high, low) = bits.split_once('-').unwrap_or((bits, bits));
    let (high, low): (u16, u16) = (high.parse().unwrap(), low.parse().unwrap());
    (u16::MAX >> (15 - high + low)) << low
}

/// One worked example of the manual.
struct Example(Json);

impl Example {
    fn id(&self) -> &str {
        self.0["id"].as_str().unwrap()
    }

    fn row(&self) -> &'static Row {
        Row::named(self.0["command"].as_str().unwrap()).unwrap()
    }

    fn strings(&self, part: &str) -> BTreeMap<Key, String> {
        let pairs = self.0[part].as_object().unwrap().iter();
        pairs.map(|(key, text)| (Key::from_name(key).unwrap(), text.as_str().unwrap().to_owned())).collect()
    }

    /// The command of the example, built by the codec from its meaning.
    fn order(&self) -> Order {
        let mut draft = self.row().command.order();
        for (key, text) in self.strings("request") {
            draft = draft.with(key, text);
        }
        draft.build().unwrap_or_else(|error| panic!("{}: {error}", self.id()))
    }

    fn refused(&self) -> Option<Alarm> {
        Some(self.0.get("refused")?.as_str().unwrap().parse().unwrap())
    }

    fn command_words(&self) -> Words {
        words_of(self.0.get("wi_corrected").unwrap_or(&self.0["wi"])).unwrap()
    }

    fn answer_words(&self) -> Option<Words> {
        words_of(self.0.get("wo_corrected").or(self.0.get("wo"))?)
    }

    fn printed_words(&self, side: &str) -> Option<Words> {
        words_of(&self.0[side])
    }
}

/// Text of a value. If several fields have the key, the field that shows `text` is used.
fn shown_values(fields: impl Iterator<Item = &'static Field>, values: &Values, key: Key, text: &str) -> String {
    let value = values.value(key).unwrap_or_else(|| panic!("{key} is not there"));
    let texts: Vec<String> = fields.filter(|field| field.key == key).map(|field| field.show(value)).collect();
    texts.iter().find(|shown| *shown == text).unwrap_or(&texts[0]).clone()
}

fn examples() -> Vec<Example> {
    json("yrcx-examples.json").into_iter().map(Example).collect()
}

fn json(file: &str) -> Vec<Json> {
    let path = format!("{}/tests/data/{file}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn strings_of(list: &Json) -> Vec<&str> {
    list.as_array().unwrap().iter().map(|item| item.as_str().unwrap()).collect()
}

/// Words as printed; `None` if one of them is not a valid word.
fn words_of(list: &Json) -> Option<Words> {
    let word = |text: &str| u16::from_str_radix(text.strip_prefix("0x")?, 16).ok();
    let words: Vec<u16> = strings_of(list).into_iter().map(word).collect::<Option<_>>()?;
    Some(words.try_into().unwrap())
}

fn hex(words: &Words) -> String {
    words.iter().map(|word| format!("{word:04X} ")).collect()
}
