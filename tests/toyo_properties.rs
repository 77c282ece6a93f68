//! Properties of the Toyo codec. Written values have the full width and can be read again, and values out of range are
//! never written.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use armctl_controller::toyo::describe::{Sender, describe};
use armctl_controller::toyo::field::{Field, Form, Mask, Value};
use armctl_controller::toyo::layout::{Layout, Record};
use armctl_controller::toyo::program;
use armctl_controller::toyo::request::{MAX_BLOCK_LEN, Request};
use armctl_controller::toyo::table::Op;
use armctl_controller::toyo::table::commands::ROWS;
use armctl_controller::toyo::table::instructions::INSTRUCTIONS;
use armctl_controller::toyo::table::palletizing::RECORDS;
use armctl_controller::toyo::table::parameters::PARAMETERS;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// All layouts of both directions. Each has the text that comes before it in a block.
fn layouts() -> Vec<(&'static str, Layout)> {
    let requests = ROWS.iter().flat_map(|row| row.requests).map(|layout| ("@", *layout));
    let answers = ROWS.iter().flat_map(|row| row.answers).map(|layout| ("@", *layout));
    let parameters = PARAMETERS.iter().flat_map(|row| [("@WPAR ", row.layout), ("@RPAR ", row.key)]);
    let instructions = INSTRUCTIONS.iter().map(|row| ("@WSTX 0001 ", row.layout));
    let records = RECORDS.iter().map(|row| ("@WPLT 01 SNO=01 ", row.layout));
    requests.chain(answers).chain(parameters).chain(instructions).chain(records).collect()
}

/// A valid value of a field; `pick` selects the value.
fn value(field: &Field, pick: u32) -> Value {
    let [low, high, ..] = pick.to_le_bytes();
    if field.starred && pick.is_multiple_of(8) {
        return Value::Stars;
    }
    match field.form {
        Form::Number(number) => {
            let step = 10_i64.pow(number.spare.into());
            let (least, most) = (i64::from(number.least) / step, i64::from(number.most) / step);
            let units = (least + i64::from(pick) % (most - least + 1)) * step;
            Value::Number(i32::try_from(units).unwrap())
        }
        Form::Hex => Value::Byte(low),
        Form::Word(words) => Value::Word(words[usize::from(low) % words.len()].text),
        Form::Bits => Value::Bits(low),
        Form::Mask => Value::Mask(Mask { care: high, bits: low & high }),
        Form::Token | Form::Text => Value::Text(format!("T{low}")),
    }
}

/// Values for the fields of a layout. RSMV always has the word PASS (ambiguity R4).
fn values(layout: &Layout, picks: &[u32]) -> Vec<Value> {
    let passes = layout.text.starts_with(Op::Rsmv.row().word);
    let values = layout.fields.iter().zip(picks).map(|(field, pick)| match value(field, *pick) {
        Value::Word("POST") if passes => Value::Word("PASS"),
        value => value,
    });
    values.collect()
}

fn picks() -> impl Strategy<Value = Vec<u32>> {
    vec(any::<u32>(), 12)
}

/// Width of a value in bytes, calculated only from the format of the field.
fn width(field: &Field, value: &Value) -> usize {
    match (field.form, value) {
        (Form::Number(number), _) => {
            let point = usize::from(number.decimals > 0);
            usize::from(number.signed) + usize::from(number.whole) + point + usize::from(number.decimals)
        }
        (Form::Hex, _) => 2,
        (Form::Bits | Form::Mask, _) => 8,
        (_, Value::Word(word)) => word.len(),
        (_, Value::Text(text)) => text.len(),
        (_, other) => panic!("{}: {other:?}", field.name),
    }
}

/// Records of a valid program. Each used tag exists exactly once, and RSMV has the word PASS.
fn steps() -> impl Strategy<Value = Vec<Record>> {
    vec((select(&INSTRUCTIONS[..]), picks()), 0..60).prop_map(|rows| {
        let mut tags = std::collections::BTreeSet::new();
        let mut named = std::collections::BTreeSet::new();
        let mut steps = Vec::new();
        for (row, picks) in rows {
            let record = row.layout.record(values(&row.layout, &picks)).unwrap();
            let own = ["tag", "then", "else"].map(|name| record.number(name));
            if row.op != Op::Tag {
                named.extend(own.into_iter().flatten());
            } else if !tags.insert(own[0].unwrap()) {
                continue;
            }
            steps.push(record);
        }
        for tag in named.difference(&tags) {
            steps.push(Op::Tag.row().layout.record(vec![Value::Number(*tag)]).unwrap());
        }
        steps.push(Op::End.row().layout.record(Vec::new()).unwrap());
        steps
    })
}

proptest! {
    #[test]
    fn written_values_read_back_in_full_width(row: Index, picks in picks()) {
        let (front, layout) = layouts()[row.index(layouts().len())];
        let values = values(&layout, &picks);
        let text = layout.emit(&values).unwrap();
        let record = layout.parse(&text).unwrap();
        prop_assert_eq!(record.values(), &values[..], "{}", text);
        prop_assert_eq!(record.emit().unwrap(), text.clone());
        prop_assert_eq!(record.written(), text.clone());
        let stars = values.contains(&Value::Stars);
        let words: usize = layout.text.split("{}").map(str::len).sum();
        let fields: usize = layout.fields.iter().zip(&values).filter(|_| !stars).map(|(field, value)| width(field, value)).sum();
        prop_assert!(stars || text.len() == words + fields, "{}", text);
        let block = format!("{front}{text}\r\n");
        prop_assert!(block.len() <= MAX_BLOCK_LEN, "{}", block);
        prop_assert!(block.split_ascii_whitespace().all(|item| item.len() <= 15), "{}", block);
    }

    #[test]
    fn values_out_of_range_are_never_written(row: Index, picks in picks(), at: Index, wrong: i32) {
        let with_fields: Vec<Layout> = layouts().into_iter().map(|(_, layout)| layout).filter(|layout| !layout.fields.is_empty()).collect();
        let layout = row.get(&with_fields);
        let mut values = values(layout, &picks);
        let at = at.index(values.len());
        let fits = match layout.fields[at].form {
            Form::Number(number) => {
                (number.least..=number.most).contains(&wrong) && wrong % 10_i32.pow(number.spare.into()) == 0
            }
            _ => false,
        };
        values[at] = Value::Number(wrong);
        prop_assert_eq!(layout.emit(&values).is_ok(), fits, "{:?}", values);
        values[at] = Value::Word("never");
        prop_assert!(layout.emit(&values).is_err());
        values.pop();
        prop_assert!(layout.emit(&values).is_err());
    }

    #[test]
    fn the_limits_of_each_range_can_be_written(row: Index, picks in picks()) {
        let (_, layout) = layouts()[row.index(layouts().len())];
        let values = values(&layout, &picks);
        for (at, field) in layout.fields.iter().enumerate() {
            let Form::Number(number) = field.form else { continue };
            let with = |edge: i32| {
                let mut values = values.clone();
                values[at] = Value::Number(edge);
                layout.emit(&values)
            };
            prop_assert!(with(number.least).is_ok() && with(number.most).is_ok());
            prop_assert!(with(number.least - 1).is_err() && with(number.most + 1).is_err());
        }
    }

    #[test]
    fn round_trips_requests(row: Index, picks in picks()) {
        let row = &ROWS[row.index(ROWS.len())];
        for (form, layout) in row.requests.iter().enumerate() {
            let request = Request::in_form(row.command, form, values(layout, &picks)).unwrap();
            prop_assert_eq!(Request::parse(&request.text()), Ok(request));
        }
    }

    #[test]
    fn round_trips_parameters_steps_and_records(picks in picks(), step in 1_i32..=5000, pallet in 1_i32..=16, row: Index) {
        let parameter = &PARAMETERS[row.index(PARAMETERS.len())];
        let whole = values(&parameter.layout, &picks);
        let request = Request::parse(&Request::write_parameter(parameter, &whole).unwrap().text()).unwrap();
        prop_assert_eq!(request.parameter().map(|row| row.id), Some(parameter.id));
        let content = request.content().unwrap().unwrap();
        prop_assert_eq!(content.values(), &whole[..]);
        let read = Request::read_parameter(parameter, parameter.row().and_then(|row| content.number(row.name))).unwrap();
        let answer = format!("@RPAR {}", content.written());
        prop_assert!(read.answer(&answer).is_ok(), "{} {}", read.text(), answer);
        let row = &INSTRUCTIONS[row.index(INSTRUCTIONS.len())];
        let record = row.layout.record(values(&row.layout, &picks)).unwrap();
        let request = Request::parse(&Request::write_step(step, &record).unwrap().text()).unwrap();
        prop_assert_eq!(request.content().unwrap(), Some(record));
        let record = &RECORDS[usize::try_from(pallet).unwrap() - 1];
        let whole = values(&record.layout, &picks);
        let request = Request::parse(&Request::write_pallet(pallet, record, &whole).unwrap().text()).unwrap();
        let content = request.content().unwrap().unwrap();
        prop_assert_eq!(content.values(), &whole[..]);
    }

    #[test]
    fn blocks_in_range_have_no_problem(row: Index, picks in picks()) {
        let row = &ROWS[row.index(ROWS.len())];
        // These fields belong to another table, or the manual does not specify them (ambiguity C5).
        let opaque = |layout: &&Layout| !layout.fields.iter().any(|field| ["body", "key", "text", "point"].contains(&field.name) && field.form == Form::Text);
        for (layouts, sender) in [(row.requests, Sender::Host), (row.answers, Sender::Controller)] {
            for layout in layouts.iter().filter(opaque) {
                let text = format!("@{}", layout.emit(&values(layout, &picks)).unwrap());
                prop_assert_eq!(describe(&text, sender, None).problem, None, "{}", text);
            }
        }
    }

    #[test]
    fn round_trips_programs(steps in steps(), numbered: bool, room in 0_usize..200) {
        let style = program::Style { first: 1, is_whole: true, is_numbered: numbered };
        let listing = program::listing(&steps, style, &program::Rows::new());
        let checked = program::check(listing.text.as_bytes(), program::MAX_STEPS);
        prop_assert!(checked.errors().count() == 0, "{}{:?}", listing.text, checked.findings);
        let read: Vec<Record> = checked.program.unwrap().steps.into_iter().map(|step| step.record).collect();
        prop_assert_eq!(&read[..], &steps[..steps.len() - listing.left_out]);
        let fits = program::check(listing.text.as_bytes(), room).program.is_some();
        prop_assert_eq!(fits, read.len() <= room);
    }
}
