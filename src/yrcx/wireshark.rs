//! Wireshark dissector of the images of a YRCX on all fieldbuses, from the tables of commands and signals.

use crate::prelude::basics::*;
use armctl_controller::units::Unit;
use armctl_controller::yrcx::alarm::{KNOWN, STOP_INPUT};
use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::image::{COMMAND_WORDS, IMAGE_WORDS};
use armctl_controller::yrcx::table::{COMMON_LINES, DurationClass, Field, Form, ROWS, Row, Show};
use armctl_frame::wireshark::{FilterFields, part, table};
use armctl_transport::eip::settings::Settings;

/// Lua source of the dissector.
pub fn dissector() -> String {
    let mut fields = FilterFields::default();
    for name in ["bus", "alarm", "risk", "section"] {
        fields.add(name, "STRING", "NONE");
    }
    fields.add("words", "BYTES", "NONE");
    fields.add("request in", "FRAMENUM", "NONE");
    fields.add("response in", "FRAMENUM", "NONE");
    let codes = ROWS.iter().map(|row| (row.code.into(), format!("{}: {}", row.id, row.name))).collect();
    fields.add_named("command", "UINT16", "HEX", codes);
    let statuses = [Status::Ready, Status::Running, Status::NormalEnd, Status::AbnormalEnd];
    let statuses: Vec<(u32, String)> =
        statuses.iter().map(|status| (status.word().into(), status.to_string())).collect();
    fields.add_named("status", "UINT16", "HEX", statuses.clone());
    let groups: Vec<(u32, String)> = (0..=u16::from(u8::MAX))
        .filter_map(|group| Some((group.into(), Alarm::new(group, 0).group_text()?.to_owned())))
        .collect();
    fields.add_named("alarm group", "UINT16", "DEC", groups.clone());
    fields.add("alarm category", "UINT16", "DEC");
    for side in ["wi", "wo"] {
        for word in COMMAND_WORDS..IMAGE_WORDS {
            fields.add(&format!("{side}{word}"), "UINT16", "HEX");
        }
    }
    let rows = table(ROWS.iter().map(|row| (row.code, row_data(&mut fields, row))));
    let signals = [Side::Input, Side::Output].map(|side| signals(&mut fields, side));
    let alarms = table(KNOWN.iter().map(|known| (known.alarm, known.text)));
    part(
        &json!({
            "image_len": Image::BYTES,
            "signals_len": Image::SIGNAL_BYTES,
            "output_assembly": Settings::default().output,
            "command_words": COMMAND_WORDS,
            "common_lines": COMMON_LINES,
            "rows": rows,
            "inputs": signals[0],
            "outputs": signals[1],
            "statuses": table(statuses),
            "groups": table(groups),
            // The number 12.400 is a text, so the keys are texts.
            "alarms": alarms,
            "stop_input": STOP_INPUT.to_string(),
            "status": {
                "ready": Status::Ready.word(),
                "running": Status::Running.word(),
                "normal": Status::NormalEnd.word(),
                "abnormal": Status::AbnormalEnd.word(),
            },
            "fields": fields,
        }),
        include_str!("wireshark.lua"),
    )
}

fn row_data(fields: &mut FilterFields, row: &Row) -> Value {
    json!({
        "id": row.id,
        "name": row.name,
        "section": row.section,
        "risk": row.risk.name(),
        "has_robot": row.has_robot(),
        "is_jog": row.pace == DurationClass::Jog,
        "request": row.request().map(|field| field_data(fields, field)).collect::<Vec<_>>(),
        "answer": row.answer().map(|field| field_data(fields, field)).collect::<Vec<_>>(),
        "continuous": Key::Continuous.name(),
    })
}

fn field_data(fields: &mut FilterFields, field: &Field) -> Value {
    let (kind, form, data) = match field.form {
        Form::Bits { low, width, show } => {
            ("INT32", "bits", json!({"low": low, "size": 1 << u32::from(width), "show": show_data(show)}))
        }
        Form::Short(unit) => ("INT32", "short", unit_data(unit)),
        Form::Long(unit) => ("INT32", "long", unit_data(unit)),
        Form::Real => ("FLOAT", "real", json!({})),
        Form::Text(_) => ("STRING", "text", json!({})),
    };
    let base = if kind == "INT32" { "DEC" } else { "NONE" };
    json!({
        "key": field.key.name(),
        "filter": fields.add(field.key.name(), kind, base),
        "name": field.name,
        "word": field.word,
        "words": field.size(),
        "symbol": field.symbol(),
        "when": field.when.map(|when| json!({"key": when.key.name(), "least": when.least, "most": when.most})),
        "form": form,
        "data": data,
    })
}

fn show_data(show: Show) -> Value {
    match show {
        Show::Number(unit) => unit_data(unit),
        Show::Choice(choices) => {
            json!({"choices": table(choices.iter().copied())})
        }
        Show::Variable => {
            // The number of a variable is its place in two lists.
            let names = (0..=0x11F_i32).map(|number| (number, variable_name(number)));
            let names = names.filter(|(_, name)| !name.starts_with("undocumented"));
            json!({"choices": table(names)})
        }
        Show::Set { .. } => json!({"kind": "set"}),
        Show::Digits => json!({"kind": "digits"}),
        Show::Version => json!({"format": "V%x.%02x", "divisor": 0x100}),
        Show::FpgaVersion => json!({"format": "V%x.%03x", "divisor": 0x1000}),
        Show::Revision => json!({"kind": "revision"}),
        Show::Line => json!({"kind": "line"}),
        Show::Fixed(_) => json!({"kind": "number"}),
    }
}

/// Name of a static variable, as the table shows it.
fn variable_name(number: i32) -> String {
    Field::word(Key::Variable, "variable", 0, Show::Variable).show(&number.into())
}

fn unit_data(unit: Unit) -> Value {
    json!({"decimals": unit.decimals})
}

/// Usable signals of a side, in ascending order.
fn signals(fields: &mut FilterFields, side: Side) -> Vec<Value> {
    Signal::all(side)
        .map(|signal| {
            let dedicated = signal.dedicated();
            let key = dedicated
                .map(|dedicated| fields.add(&format!("{} {}", side.name(), dedicated.name), "BOOLEAN", "NONE"));
            let text = dedicated.map(|dedicated| dedicated.text);
            json!({"signal": signal.to_string(), "word": signal.word(), "bit": signal.bit(), "key": key, "text": text})
        })
        .collect()
}
