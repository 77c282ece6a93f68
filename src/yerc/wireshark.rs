//! Wireshark dissector of the high-speed Ethernet server, from the command table.

use super::decode::IDENTIFIER;
use crate::prelude::basics::*;
use armctl_client::yerc::PORTS;
use armctl_controller::units::{self, Unit};
use armctl_controller::yerc::status;
use armctl_controller::yerc::table::{
    Action, Attribute, BATCH_BACKUP_PATH, Bit, Field, Instances, Kind, ROWS, RiskRule, Row, Service, service,
};
use armctl_controller::yerc::wire::{ANSWER_BIT, Division, HEADER_LEN, MAX_FRAME};
use armctl_frame::wireshark::{FilterFields, part, table};

/// Parts of a frame in their order: name, size, valid values of a part whose other values are damage.
type Parts = &'static [(&'static str, usize, &'static [u32])];
const HEADER: Parts = &[
    ("identifier", 4, &[]),
    ("header size", 2, &[0x20]),
    ("data size", 2, &[]),
    ("reserve 1", 1, &[]),
    ("processing division", 1, &[1, 2]),
    ("ACK", 1, &[0, 1]),
    ("request ID", 1, &[]),
    ("block number", 4, &[]),
    ("reserve 2", 8, &[]),
];
const CLIENT: Parts =
    &[("command", 2, &[]), ("instance", 2, &[]), ("attribute", 1, &[]), ("service", 1, &[]), ("padding", 2, &[])];
const CONTROLLER: Parts = &[
    ("service", 1, &[]),
    ("status", 1, &[]),
    ("added status size", 1, &[]),
    ("padding", 1, &[]),
    ("added status", 4, &[]),
];

/// Lua source of the dissector.
pub fn dissector() -> String {
    let mut fields = FilterFields::default();
    let [header, client, controller] = [HEADER, CLIENT, CONTROLLER].map(|parts| {
        let rows = parts.iter().map(|(name, size, valid)| {
            let key = part_field(&mut fields, name, *size);
            json!({"name": name, "size": size, "key": key, "valid": (!valid.is_empty()).then_some(valid)})
        });
        rows.collect::<Vec<_>>()
    });
    for name in ["section", "risk", "action", "instance name", "data"] {
        fields.add(name, "STRING", "NONE");
    }
    fields.add("count", "UINT32", "DEC");
    for name in ["request in", "response in"] {
        fields.add(name, "FRAMENUM", "NONE");
    }
    let rows: Vec<Value> = ROWS.iter().map(|row| row_data(&mut fields, row)).collect();
    part(
        &json!({
            "identifier": String::from_utf8_lossy(IDENTIFIER),
            "header_len": HEADER_LEN,
            "max_frame": MAX_FRAME,
            "answer_bit": ANSWER_BIT,
            "list_service": service::LIST,
            "ports": PORTS,
            "backup_path": String::from_utf8_lossy(BATCH_BACKUP_PATH),
            "header": header,
            "client": client,
            "controller": controller,
            "rows": rows,
            "fields": fields,
        }),
        include_str!("wireshark.lua"),
    )
}

/// Adds the filter field of a part of the header.
fn part_field(fields: &mut FilterFields, name: &str, size: usize) -> String {
    let named = |pairs: &[(u32, &str)]| pairs.iter().map(|(value, name)| (*value, (*name).to_owned())).collect();
    let (base, values) = match name {
        "processing division" => ("DEC", named(&[(1, "robot control"), (2, "file control")])),
        "ACK" => ("DEC", named(&[(0, "request"), (1, "any frame except a request")])),
        "command" => {
            let robot = ROWS.iter().filter(|row| row.division == Division::Robot);
            ("HEX", robot.map(|row| (row.number.into(), row.name.to_owned())).collect())
        }
        "service" => ("HEX", service_names()),
        "status" => ("HEX", status::all_statuses().map(|row| (row.code.into(), row.name.to_owned())).collect()),
        "added status" => (
            "HEX",
            [(0, "none".to_owned())]
                .into_iter()
                .chain(status::all_added().map(|row| (row.code.into(), row.name.to_owned())))
                .collect(),
        ),
        "block number" => ("HEX", Vec::new()),
        _ => ("DEC", Vec::new()),
    };
    match (name, size) {
        ("identifier" | "reserve 2", _) => fields.add(name, "STRING", "NONE"),
        (_, 1) => fields.add_named(name, "UINT8", base, values),
        (_, 2) => fields.add_named(name, "UINT16", base, values),
        _ => fields.add_named(name, "UINT32", base, values),
    }
}

/// Names of the services, and of the answers to them.
fn service_names() -> Vec<(u32, String)> {
    let mut names: Vec<(u32, String)> = Vec::new();
    for service in ROWS.iter().flat_map(|row| row.services) {
        let number = u32::from(service.number);
        if !names.iter().any(|(known, _)| *known == number) {
            names.push((number, service.meaning.to_owned()));
            names.push((number | u32::from(ANSWER_BIT), format!("answer to {number:#04x}")));
        }
    }
    names
}

fn row_data(fields: &mut FilterFields, row: &Row) -> Value {
    let services = table(row.services.iter().map(|service| (service.number, service_data(row, service))));
    json!({
        "number": row.number,
        "is_file": row.division == Division::File,
        "is_backup": row.is_batch_backup(),
        "name": row.name,
        "section": row.citation(),
        "services": services,
        "fs100": spans(row.instances, Model::Fs100),
        "dx200": spans(row.instances, Model::Dx200),
        "plural": row.plural.map(|plural| json!({"max": plural.max, "even": plural.even})),
        "fields": row.fields.iter().map(|field| field_data(fields, field)).collect::<Vec<_>>(),
        "alternative": row
            .alternative
            .map(|other| other.iter().map(|field| field_data(fields, field)).collect::<Vec<_>>()),
    })
}

fn service_data(row: &Row, service: &Service) -> Value {
    let risk_of = |instance| {
        let request =
            Request { command: row.number, instance, attribute: 0, service: service.number, data: Vec::new() };
        request.risk().name()
    };
    let risks = match service.risk {
        RiskRule::Always(_) => table::<u16, Value>([]),
        RiskRule::Switches => table((1..=3).map(|instance| (instance, risk_of(instance)))),
    };
    let risk = match service.risk {
        RiskRule::Always(risk) => risk.name(),
        RiskRule::Switches => risk_of(u16::MAX),
    };
    json!({
        "meaning": service.meaning,
        "is_write": service.action == Action::Write,
        "by_field": service.attribute == Attribute::Field,
        "risk": risk,
        "risks": risks,
    })
}

fn spans(instances: Instances, model: Model) -> Vec<Value> {
    let spans = instances.for_model(model).iter();
    spans
        .map(|span| {
            let (prefix, from) = span.numbered.unzip();
            json!({"first": span.first, "last": span.last, "meaning": span.meaning, "prefix": prefix, "from": from})
        })
        .collect()
}

fn field_data(fields: &mut FilterFields, field: &Field) -> Value {
    let bits = |bits: &[Bit]| bits.iter().map(|bit| json!([bit.bit, bit.clear, bit.set])).collect::<Vec<_>>();
    // Units by the value of the last choice before the field: the data type of a position, or the speed class.
    let by_kind = |unit: &dyn Fn(PositionKind) -> Unit| {
        let kinds = PositionKind::ALL.iter().map(|(kind, word, _)| (word, unit_data(unit(*kind))));
        json!({"units": table(kinds), "other": unit_data(unit(PositionKind::Other(u32::MAX)))})
    };
    let (form, kind) = match field.kind {
        Kind::U8 => (json!({}), "UINT8"),
        Kind::Signals => (json!({"signals": true}), "UINT8"),
        Kind::U16 => (json!({}), "UINT16"),
        Kind::U32 => (json!({}), "UINT32"),
        Kind::Reserved => (json!({"reserved": true}), "UINT32"),
        Kind::I16 => (json!({}), "INT16"),
        Kind::I32 => (json!({}), "INT32"),
        Kind::F32 => (json!({}), "FLOAT"),
        Kind::Text(_) => (json!({}), "STRING"),
        Kind::FileName | Kind::Filter => (json!({"is_rest": true}), "STRING"),
        Kind::Bits(named) => (json!({"bits": bits(named)}), "UINT32"),
        Kind::Choice(choices) => (json!({"choices": table(choices.iter().copied())}), "UINT32"),
        Kind::Scaled(unit) => (json!({"unit": unit_data(unit)}), "INT32"),
        Kind::Axis(axis) => (by_kind(&|kind| kind.unit(axis)), "INT32"),
        Kind::BaseAxis => {
            let unit = |kind| if kind == PositionKind::Base { units::MILLIMETRE } else { units::PULSE };
            (by_kind(&unit), "INT32")
        }
        Kind::Speed => {
            let classes = [units::PERCENT, units::MILLIMETRE_PER_SECOND, units::DEGREE_PER_SECOND];
            let units = classes.iter().zip(0_u8..).map(|(unit, class)| (class, unit_data(*unit)));
            (json!({"units": table(units)}), "UINT32")
        }
    };
    let base = if matches!(kind, "STRING" | "FLOAT") { "NONE" } else { "DEC" };
    let key = fields.add(field.name, kind, base);
    json!({"name": field.name, "size": field.size(), "key": key, "type": kind, "form": form})
}

fn unit_data(unit: Unit) -> Value {
    json!({"decimals": unit.decimals, "symbol": unit.symbol})
}
