//! Golden words of the YRCX family: the 97 worked examples of the manual (`data/yrcx-examples.json` cites the section
//! of each) and the places of all fields (`data/yrcx-layouts.json`).
//!
//! What an example says is built into words and compared; its words are read and compared with what it says; both for
//! commands and for answers. Words that the manual misprints are there twice, as printed and corrected, and named in
//! `misprinted`. If one of these fails, the code is wrong: do not change the words.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::collections::BTreeMap;

use armctl::controller::Risk;
use armctl::controller::yrcx::alarm::Alarm;
use armctl::controller::yrcx::answer::{self, Answer};
use armctl::controller::yrcx::image::Words;
use armctl::controller::yrcx::order::Order;
use armctl::controller::yrcx::table::{Command, Field, Form, ROWS, Row, Show};
use armctl::controller::yrcx::value::{Key, Value, Values};
use serde_json::Value as Json;

#[test]
fn there_are_97_examples() {
    assert_eq!(examples().len(), 97);
}

#[test]
fn commands_are_built_from_what_is_meant() {
    for example in examples() {
        assert_eq!(hex(example.order().words()), hex(&example.command_words()), "{}", example.id());
    }
}

#[test]
fn commands_are_read_into_what_is_meant() {
    for example in examples() {
        let order = Order::parse(&example.command_words()).unwrap();
        let meant = example.strings("request");
        for (key, text) in &meant {
            let found = shown(order.row().request(), order.values(), *key, text);
            assert_eq!(&found, text, "{} {key}", example.id());
        }
        for (key, value) in order.values().iter() {
            // What is not said is a flag that follows, or not given: 0.
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
fn answers_are_read_into_what_is_meant() {
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
fn answers_are_built_from_what_is_meant() {
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
fn misprints_are_flagged_word_by_word() {
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
fn misprinted_commands_are_read_for_what_they_are() {
    let examples = examples();
    let printed = |id: &str| {
        let example = examples.iter().find(|example| example.id() == id).unwrap();
        example.printed("wi").map(|words| Order::parse(&words))
    };
    let value = |id: &str, key| printed(id).unwrap().unwrap().values().int(key);
    assert_eq!(value("4.2.12-robot", Key::Robot), Some(0), "all robots, where robot 1 is meant");
    for id in ["4.2.23-point", "4.2.23-direct-mm", "4.2.23-direct-pulse"] {
        assert_eq!((value(id, Key::PushForce), value(id, Key::PushTime)), (Some(50), Some(50)), "{id}");
    }
    // A word of five digits is no word.
    assert_eq!(printed("4.2.1-direct-pulse"), None);
    let refusal = printed("4.6.3-reset").unwrap().unwrap_err();
    assert_eq!(refusal.to_string(), "WI1: bits 0x0100 are set, which must be 0 here");
}

#[test]
fn the_walk_through_of_chapter_2_section_2() {
    let order = Command::MovePtp.order().with(Key::Point, 19).with(Key::SpeedPercent, 50).build().unwrap();
    assert_eq!(order.words()[..5], [0x0001, 0x0004, 0, 0x0032, 0x0013]);
    assert_eq!(order.words()[5..], [0; 11]);
    assert_eq!(order.risk(), Risk::Motion);
}

#[test]
fn every_field_stands_where_the_manual_has_it() {
    let layouts = json("yrcx-layouts.json");
    assert_eq!(layouts.len(), ROWS.len());
    for layout in &layouts {
        let code = u16::from_str_radix(&layout["code"].as_str().unwrap()[2..], 16).unwrap();
        let row = Row::of(code).unwrap();
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

/// Compares the bits that fields cover; expected are rows of first word, last word, bits, and perhaps a range.
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

/// Compares the ranges of commands; answers are not held to any.
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

/// One worked example.
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
        pairs.map(|(key, text)| (Key::of(key).unwrap(), text.as_str().unwrap().to_owned())).collect()
    }

    /// What the example means, built by the codec.
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

    fn printed(&self, side: &str) -> Option<Words> {
        words_of(&self.0[side])
    }
}

/// What a value says, in the words of the field that takes the text.
fn shown(fields: impl Iterator<Item = &'static Field>, values: &Values, key: Key, text: &str) -> String {
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

/// Words as printed; `None` if one is none.
fn words_of(list: &Json) -> Option<Words> {
    let word = |text: &str| u16::from_str_radix(text.strip_prefix("0x")?, 16).ok();
    let words: Vec<u16> = strings_of(list).into_iter().map(word).collect::<Option<_>>()?;
    Some(words.try_into().unwrap())
}

fn hex(words: &Words) -> String {
    words.iter().map(|word| format!("{word:04X} ")).collect()
}
