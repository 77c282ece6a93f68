//! Tests of the blocks and refusals of `toyo param`.

use crate::testing::{Bench, Fault, blocks};

use proptest::collection::vec;
use proptest::prelude::*;

use super::{Parameters, key_text, machine};
use crate::eeprom_tables::EepromRow as _;
use armctl_controller::toyo::field::{Field, Form, Mask, Value};
use armctl_controller::toyo::table::Parameter;
use armctl_frame::store::{Store as _, Writable as _};

#[test]
fn list_reads_every_parameter() {
    // A parameter that only some controllers have is requested a second time after a refusal.
    let mut all = blocks(&["param", "list"]).unwrap();
    all.dedup();
    assert_eq!(all.len(), 74);
}

#[test]
fn the_confirmation_names_the_effects_of_machine_parameters() {
    let told = |id| machine::consequence_of(&[Parameter::named(id).unwrap()]);
    assert_eq!(told("E06"), "after a change of E06 (max-speed), the controller executes no command until a restart");
    assert!(told("E22").contains("easy programs"));
}

#[test]
fn the_confirmation_names_steps_that_would_be_lost() {
    let steps = Parameter::named("E22").unwrap();
    let record = |numbers: [i32; 4]| steps.layout.record(numbers.map(Value::Number).into()).unwrap();
    let warnings_of = |old, new| machine::warnings(steps, Some(&record(old)), record(new).values());
    assert_eq!(
        warnings_of([1000, 0, 0, 0], [500, 1501, 0, 0]),
        [
            "warning: steps 501 to 1000 of task 1 become NOP",
            "warning: with more than 2000 steps, all easy programs are erased"
        ]
    );
    assert!(warnings_of([3000, 0, 0, 0], [4000, 0, 0, 0]).is_empty());
    assert_eq!(
        machine::warnings(Parameter::named("U03").unwrap(), None, &[]),
        ["warning: U03 (resolver-cable-length) is not for normal use"]
    );
}

/// Returns the number of items that were written.
fn written(report: &serde_json::Value) -> usize {
    report["items"].as_array().unwrap().iter().filter(|item| item["written"] == true).count()
}

/// Writes a file to its own folder, and returns the folder and the path.
fn file_of(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("parameters.csv").to_str().unwrap().to_owned();
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

#[test]
fn restore_writes_machine_parameters_last_or_leaves_them_out() {
    let text = "name,value\nE06,ax1=1000 ax2=1000 ax3=1000 ax4=1000\nT2.3,99.5\nP16,\"compare=<= place=1.0 port=0/01/0\"\n\
                M09,E\n";
    let (_folder, path) = file_of(text);
    let usual = [
        "@RPAR T2 V03",
        "@RPAR P16",
        "@RPAR M09",
        "@WPAR M09 E",
        "@RPAR M09",
        "@WPAR P16 AX4<=+0001.00 0/01/0",
        "@RPAR P16",
        "@WPAR T2 V03=0099.5",
        "@RPAR T2 V03",
    ];
    assert_eq!(blocks(&["param", "restore", &path]).unwrap(), usual);
    let machine = ["@RPAR E06", "@WPAR E06 AX1=1000 AX2=1000 AX3=1000 AX4=1000", "@RPAR E06"];
    assert_eq!(blocks(&["param", "restore", &path, "machine"]).unwrap(), machine);
    assert_eq!(
        blocks(&["param", "restore", &path, "machine,table"]).unwrap(),
        ["@RPAR E06", "@RPAR T2 V03", "@WPAR T2 V03=0099.5", "@RPAR T2 V03", machine[1], machine[2]]
    );
    assert_eq!(blocks(&["param", "restore", &path, "special"]).unwrap_err().kind.exit(), 2);
    std::fs::write(&path, "name,value\nM09,X\n").unwrap();
    let failure = blocks(&["param", "restore", &path]).unwrap_err();
    assert!(
        failure.message.contains(":2:")
            && failure.message.ends_with("language: 'X' is not J (japanese) or E (english)"),
        "{failure}"
    );
}

#[test]
fn restore_of_a_dump_restores_every_value() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (first, second) = (path("first.csv"), path("second.csv"));
    let mut bench = Bench::new("sim:");
    bench.data(&["param", "set", "soft-limit-minus", "-100", "-50.5", "0", "0"]);
    bench.data(&["param", "set", "m14", "0/01/1", "0/02/2", "0/03/3", "0/04/4"]);
    bench.data(&["speed-table", "set", "20", "123.4"]);
    bench.data(&["mvm", "set", "32", "approach=incremental", "approach-z=-1.5"]);
    let dumped = bench.data(&["param", "dump", &first]);
    let counted = dumped["saved"].as_u64().unwrap() + dumped["left_out"].as_array().unwrap().len() as u64;
    assert_eq!(counted, 74 + 20 + 20 + 5 * 32 + 8);
    assert_eq!(bench.run(&["param", "dump", &first]).unwrap_err().kind.exit(), 1);
    let mut other = Bench::new("sim:");
    let restored = other.data(&["param", "restore", &first]);
    assert_eq!(written(&restored), 4, "{restored}");
    other.data(&["param", "dump", &second, "--force"]);
    assert_eq!(std::fs::read_to_string(&first).unwrap(), std::fs::read_to_string(&second).unwrap());
    assert_eq!(written(&other.data(&["param", "restore", &first])), 0);
}

#[test]
fn a_refused_read_is_repeated_once() {
    let (mut bench, _) = Bench::with_faults("", |block, count| match block {
        "@RPAR U21" if count == 1 => Fault::Answered("@NG"),
        "@RPAR U22" => Fault::Answered("@NG"),
        _ => Fault::None,
    });
    let listed = bench.data(&["param", "list", "special"]);
    let ids: Vec<_> = listed["items"].as_array().unwrap().iter().map(|entry| &entry["id"]).collect();
    assert_eq!(ids, ["U03", "U21"]);
    let all = bench.data(&["param", "list", "special", "--empty"]);
    assert_eq!(all["items"][2]["value"], serde_json::Value::Null);
}

#[test]
fn a_file_of_another_controller_restores_the_parameters_that_fit() {
    let (_folder, path) = file_of("name,value\nM09,J\nP17,ax1=1 ax2=0 ax3=0 ax4=0\nT2.1,5\n");
    let mut bench = Bench::new("sim:");
    let (data, failure) = bench.run(&["param", "restore", &path]).unwrap();
    let results: Vec<_> = data["items"].as_array().unwrap().iter().map(|item| &item["written"]).collect();
    assert_eq!(results, [true, false, true]);
    let failure = failure.unwrap();
    assert_eq!(failure.kind.exit(), 9);
    assert!(failure.message.starts_with("1 of 3 failed"), "{failure}");
}

#[test]
fn a_dump_names_values_that_cannot_be_written_back() {
    let (mut bench, _) = Bench::with_faults("", |block, _| match block {
        "@RPAR M17" => Fault::Answered("@RPAR M17 STN=00 BRT=156K OPT=0000"),
        _ => Fault::None,
    });
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("p.csv").to_str().unwrap().to_owned();
    let dumped = bench.data(&["param", "dump", &file]);
    let left_out = dumped["left_out"].as_array().unwrap().iter().find(|row| row["name"] == "cc-link").unwrap();
    assert_eq!(
        left_out["why"],
        "the value station=0 rate=156K options=0 cannot be written back: cc-link: station: 0 is out of range (a \
         number, 1 to 61)"
    );
    assert!(!std::fs::read_to_string(&file).unwrap().contains("cc-link"));
}

/// A value for a field. `pick` selects the value.
fn value(field: &Field, pick: u32) -> Value {
    let [low, high, ..] = pick.to_le_bytes();
    match field.form {
        Form::Number(number) => {
            let step = 10_i64.pow(number.spare.into());
            let (least, most) = (i64::from(number.least) / step, i64::from(number.most) / step);
            Value::Number(i32::try_from((least + i64::from(pick) % (most - least + 1)) * step).unwrap())
        }
        Form::Hex => Value::Byte(low),
        Form::Word(words) => Value::Word(words[usize::from(low) % words.len()].text),
        Form::Bits => Value::Bits(low),
        Form::Mask => Value::Mask(Mask { care: high, bits: low & high }),
        Form::Token | Form::Text => Value::Text(format!("T{low}")),
    }
}

proptest! {
    #[test]
    fn every_value_survives_a_dump_and_a_restore(picks in vec(any::<u32>(), 16)) {
        for key in Parameters::saved() {
            let fields = key.parameter.body().fields;
            let values: Vec<Value> = fields.iter().zip(&picks).map(|(field, pick)| value(field, *pick)).collect();
            let Ok(cell) = Parameters.cell(key, values) else { continue };
            let texts = Parameters.texts(&cell.wanted);
            let texts: Vec<Option<&str>> = texts.iter().map(|text| Some(text.as_str())).collect();
            // The total number of steps of all tasks is limited, so some values of parameter E22 are rejected.
            let Ok(draft) = Parameters.draft(key, &texts) else {
                prop_assert!(key.parameter.id == "E22", "{}: {texts:?}", key_text(key));
                continue;
            };
            prop_assert_eq!(Parameters.complete_draft(key, &draft, None).unwrap(), cell.wanted, "{}: {:?}", key_text(key), texts);
        }
    }
}

#[test]
fn a_written_machine_parameter_needs_a_power_cycle() {
    let mut bench = Bench::new("sim:");
    let before = bench.data(&["param", "get", "e06"])["items"][0]["value"][0]["value"].clone();
    let same = bench.data(&["param", "set", "e06", &format!("ax1={before}")]);
    assert_eq!(same["items"][0]["written"], false);
    let changed = bench.data(&["param", "set", "e06", "ax1=777"]);
    assert_eq!(changed["items"][0]["new"][0]["value"], 777);
    assert_eq!(bench.data(&["status"])["needs_power_cycle"], true);
}

#[test]
fn a_partial_change_reads_the_parameter_once_before_the_write() {
    let (mut bench, received) = Bench::with_faults("", |_, _| Fault::None);
    for (words, read) in [
        (&["param", "set", "P01", "ax2=150"][..], "@RPAR P01"),
        (&["point", "set", "7", "z=5"], "@RPAR T1 PT=007"),
        (&["torque-table", "set", "2", "load=1"], "@RPAR T5 LIM02"),
        (&["easy", "set", "1", "loop=7"], "@RESY PNO=01 ST=000"),
        (&["palletizing", "set", "1", "source-p1", "x=5"], "@RPLT 01 SNO=03"),
        (&["mvm", "set", "1", "origin=5"], "@RPAR T4 S1 GRP=01"),
    ] {
        received.borrow_mut().clear();
        bench.data(words);
        let received = received.borrow();
        // The value is read once before the write, and once after it.
        assert_eq!(received.iter().filter(|block| *block == read).count(), 2, "{received:#?}");
    }
}
