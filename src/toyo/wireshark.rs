//! Wireshark dissector of the host communication, from the tables of commands, parameters, instructions and records.

use serde_json::{Value, json};

use armctl_controller::toyo::describe::{Sender, describe};
use armctl_controller::toyo::errors;
use armctl_controller::toyo::field::{Field, Form};
use armctl_controller::toyo::layout::Layout;
use armctl_controller::toyo::request::MAX_BLOCK_LEN;
use armctl_controller::toyo::table::commands::ROWS;
use armctl_controller::toyo::table::{instructions, palletizing, parameters};
use armctl_frame::wireshark::{FilterFields, part, table};

/// Number of status pages.
const PAGES: u8 = 5;

/// Lua source of the dissector.
pub fn dissector() -> String {
    let mut fields = FilterFields::default();
    for name in ["command", "verdict", "parameter", "instruction", "risk", "section"] {
        fields.add(name, "STRING", "NONE");
    }
    for name in ["request in", "response in"] {
        fields.add(name, "FRAMENUM", "NONE");
    }
    let rows = table(ROWS.iter().map(|row| {
        let forms = |fields: &mut FilterFields, forms: &[Layout]| {
            forms.iter().map(|form| layout_data(fields, form)).collect::<Vec<_>>()
        };
        let data = json!({
            "word": row.word,
            "about": row.about,
            "risk": row.risk.name(),
            "section": format!("TO {}", row.section),
            "requests": forms(&mut fields, row.requests),
            "answers": forms(&mut fields, row.answers),
        });
        (row.word, data)
    }));
    let parameters: Vec<Value> = parameters::PARAMETERS
        .iter()
        .map(|row| {
            let id = row.key.text.split("{}").next().unwrap_or_default().trim_end();
            json!({
                "id": row.id,
                "words": id.split(' ').collect::<Vec<_>>(),
                "name": row.name,
                "layout": layout_data(&mut fields, &row.layout),
                "key": layout_data(&mut fields, &row.key),
            })
        })
        .collect();
    let instructions = table(
        instructions::INSTRUCTIONS
            .iter()
            .map(|row| (row.word, json!({"about": row.about, "layout": layout_data(&mut fields, &row.layout)}))),
    );
    let records = table(palletizing::RECORDS.iter().map(|row| (row.number, layout_data(&mut fields, &row.layout))));
    part(
        &json!({
            "max_len": MAX_BLOCK_LEN - 2,
            "rows": rows,
            "parameters": parameters,
            "instructions": instructions,
            "records": records,
            "pages": table((0..PAGES).map(|page| (page, page_data(page)))),
            "errors": by_byte(|code| errors::explain(code).in_a_line()),
            "fields": fields,
        }),
        include_str!("wireshark.lua"),
    )
}

/// Meanings of the bytes of a status page.
fn page_data(page: u8) -> Value {
    by_byte(|byte| {
        let answer = describe(&format!("@STAS SNO={page} ST1={byte:02X} ST2=00"), Sender::Controller, None);
        answer.fields.into_iter().find(|field| field.name == "st1").map(|field| field.meaning).unwrap_or_default()
    })
}

fn by_byte(meaning: impl Fn(u8) -> String) -> Value {
    table((0..=u8::MAX).map(|byte| (byte, meaning(byte))))
}

fn layout_data(fields: &mut FilterFields, layout: &Layout) -> Value {
    json!({
        "words": layout.text.split("{}").collect::<Vec<_>>(),
        "fields": layout.fields.iter().map(|field| field_data(fields, field)).collect::<Vec<_>>(),
    })
}

fn field_data(fields: &mut FilterFields, field: &Field) -> Value {
    let (kind, form) = match field.form {
        Form::Number(number) => (
            "DOUBLE",
            json!({
                "signed": number.signed, "whole": number.whole, "decimals": number.decimals, "spare": number.spare,
                "least": number.least, "most": number.most,
            }),
        ),
        Form::Hex => ("UINT8", json!("hex")),
        Form::Word(words) => {
            ("STRING", json!(words.iter().map(|word| json!([word.text, word.about])).collect::<Vec<_>>()))
        }
        Form::Bits => ("STRING", json!("bits")),
        Form::Mask => ("STRING", json!("mask")),
        Form::Token => ("STRING", json!("token")),
        Form::Text => ("STRING", json!("text")),
    };
    let base = if kind == "UINT8" { "HEX" } else { "NONE" };
    let form_key = match field.form {
        Form::Number(_) => "number",
        Form::Word(_) => "choices",
        _ => "form",
    };
    json!({
        "name": field.name,
        "key": fields.add(field.name, kind, base),
        "unit": if field.unit.is_empty() { String::new() } else { format!(" {}", field.unit) },
        "starred": field.starred,
        form_key: form,
    })
}
