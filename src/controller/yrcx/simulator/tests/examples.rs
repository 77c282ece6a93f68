//! All worked examples of the manual, against a simulator in the required state. The answers are the words that the
//! manual prints, or the corrected words if the manual has a misprint.

use serde_json::Value as Json;

use super::*;

const EXAMPLES: &str = include_str!("../../../../../tests/data/yrcx-examples.json");

/// Additional start state that an example needs.
fn state(id: &str) -> String {
    let robot = |keys: &str| format!("[[robot]]\n{keys}\n");
    let points = |rows: &str| format!("[points]\n{rows}\n");
    let lines = |number: u8, name: &str, before: usize, last: &str| {
        let text = "REM\n".repeat(before);
        format!("[[program]]\nnumber = {number}\nname = \"{name}\"\ntext = \"\"\"{text}{last}\"\"\"\n")
    };
    match id {
        "4.2.1-ptp" | "4.2.2-ptp" => points("100 = { pulse = [123456, -123, 0, 0] }"),
        "4.2.1-circular" => points("100 = { mm = [6.0, 3.0, 0.0, 0.0] }\n101 = { mm = [12.345, -0.123, 5.0, 9.023] }"),
        "4.2.3-point" => robot("position = [123456, -123, 7, 0]") + &points("100 = { pulse = [1, 1, 0, 1] }"),
        "4.2.4-point" => robot("position = [123456, -123, 7, 0]") + &points("100 = { pulse = [1, 1, -7, 1] }"),
        _ if id.starts_with("4.2.3") || id.starts_with("4.2.4") => robot("position = [10000, -20000, 0, -18000]"),
        "4.2.5-ptp" => {
            points("110 = { mm = [0, 0, 2, 0] }\n111 = { mm = [12.345, -0.123, 2, 0] }")
                + "[pallets]\n1 = { counts = [21, 1, 1], first = 110 }"
        }
        "4.2.5-arch" => {
            points("113 = { mm = [12.345, -0.123, 5, 9.023] }") + "[pallets]\n10 = { counts = [8, 4, 1], first = 110 }"
        }
        _ if id.starts_with("4.2.7") => robot("position = [12345, -173, 2000, 0]\ninching = 50"),
        "4.2.10-absmove" => robot("position = [0, 4097, 0, 0]"),
        "4.2.11-absreset" => robot("origin = [true, false, true, true]"),
        "4.2.20-on" => "servo = false".to_owned(),
        "4.2.21-ptp" => points("100 = { mm = [123.456, -0.123, 0, 0] }"),
        "4.2.23-point" => robot("position = [12345, -123, 0, 0]\nobstacles = { 3 = 2000 }"),
        _ if id.starts_with("4.2.23") => robot("position = [12345, -123, 0, 0]\nobstacles = { 3 = 9000 }"),
        "4.3.3-reference" => "[pallets]\n10 = { counts = [10, 15, 1], first = 100 }".to_owned(),
        "4.4.1-reference" => "variables = { SGI5 = 50 }".to_owned(),
        "4.4.2-reference" => robot("parameters = { OUTPOS = [131071] }"),
        "4.6.4-reference" => lines(1, "ABCDEFGH", 100, "HALT") + "[[task]]\nnumber = 2\nprogram = 1\nline = 101",
        "4.7.3-reference" => robot("servos = [\"servo\", \"servo\", \"free\", \"servo\"]"),
        "4.7.4-pulse" | "4.7.4-mm" => robot("position = [20001, 0, -12345, 0]"),
        "4.7.5-reference" | "4.7.6-reference" => {
            "stock = false\n".to_owned()
                + &lines(1, "A", 0, "DELAY 99999999")
                + &lines(2, "B", 18, "DELAY 99999999")
                + &lines(5, "E", 98, "HALT")
                + "[[task]]\nnumber = 1\nprogram = 1\nstate = \"run\"\n"
                + "[[task]]\nnumber = 2\nprogram = 2\nstate = \"run\"\nline = 19\n"
                + "[[task]]\nnumber = 5\nprogram = 5\nstate = \"suspend\"\nline = 99\n"
        }
        "4.7.7-reference" => {
            "[[history]]\nalarm = \"12.600\"\n".repeat(9) + "[[history]]\nalarm = \"12.551\"\nplace = \"C1O1\"\n"
        }
        "4.7.8-reference" => robot("auto_speed = 50\nmanual_speed = 50\nprogram_speed = 50"),
        "4.7.9-reference" => robot("arm = \"left\""),
        "4.7.10-reference" => robot("kind = \"scara\"\nposition = [0, -9000, 0, 0]"),
        "4.7.11-reference" => robot("origin = [true, true, false, true]"),
        "4.7.12-reference" | "4.7.18-reference" => robot("load = [0, 0, 20, 0]"),
        "4.7.13-reference" | "4.7.14-reference" => "clock = \"2014/01/01 10:59:59\"".to_owned(),
        "4.7.17-reference" => "[latest_remote]\nalarm = \"2.334\"\nplace = \"R1A1\"".to_owned(),
        _ => String::new(),
    }
}

/// Words of an example. Misprints are corrected.
fn printed(example: &Json, side: &str) -> Option<Words> {
    let corrected = &example[format!("{side}_corrected")];
    let texts = if corrected.is_array() { corrected } else { &example[side] }.as_array()?;
    let word = |text: &Json| u16::from_str_radix(&text.as_str().unwrap()[2..], 16).unwrap();
    Some(texts.iter().map(word).collect::<Vec<_>>().try_into().unwrap())
}

pub(super) fn examples() -> Vec<(String, Words, Option<Words>)> {
    let examples: Vec<Json> = serde_json::from_str(EXAMPLES).unwrap();
    let read = |example: &Json| {
        (example["id"].as_str().unwrap().to_owned(), printed(example, "wi").unwrap(), printed(example, "wo"))
    };
    examples.iter().map(read).collect()
}

/// Jogs for half a second from a position of axis 1, and then stops.
fn jog(from: i32, words: &Words) -> Words {
    let mut bench = Bench::new(&format!("[[robot]]\nposition = [{from}, -123, 2000, 0]"));
    bench.begin(words);
    bench.wait(500);
    bench.set(input::STOP, false);
    bench.end()
}

#[test]
fn answers_are_the_printed_words() {
    let (mut told, mut jogs) = (0, 0);
    for (id, request, answer) in examples() {
        let Some(answer) = answer else { continue };
        let found = if id.starts_with("4.2.6") {
            jogs += 1;
            // The stop position depends on the duration of the jog. So a second jog starts from a position that is
            // shifted by the distance.
            let there = jog(0, &request);
            let there = (u32::from(there[5]) << 16 | u32::from(there[4])).cast_signed();
            jog(12_345 - there, &request)
        } else {
            Bench::new(&state(&id)).send(&request)
        };
        assert_eq!(found, answer, "{id}");
        told += 1;
    }
    assert_eq!((told, jogs), (96, 3), "97 examples, one of them without an answer");
}

#[test]
fn a_fresh_controller_carries_out_every_example() {
    for (id, request, _) in examples() {
        let mut bench = Bench::default();
        bench.begin(&request);
        if id.starts_with("4.2.6") {
            bench.set(input::STOP, false);
        }
        let status = bench.end()[0];
        let wanted = if id.starts_with("4.2.6") { 0x4000 } else { 0x0200 };
        assert_eq!(status, wanted, "{id}: {}", bench.console("why"));
    }
}
