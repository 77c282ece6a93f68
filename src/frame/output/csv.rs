//! Reports as CSV (RFC 4180), with one row per list entry. The columns come from the schema of the report, never from
//! the data of the report.
//!
//! A column has the name of its field; fields of a nested object are joined with `_`: `error_code`. A list with a
//! maximum length has one column per entry (`axes_1`). A list of plain values, or of named values, is one cell. A list
//! of other objects in a row is omitted. If a report has several lists, their names precede the field names.

use std::borrow::Cow;
use std::collections::BTreeSet;

use serde_json::Value;

use super::escape;

/// Maximum nesting depth. Deeper values are one cell.
const MAX_DEPTH: usize = 5;
/// Name of the column with the value of an entry.
const VALUE: &str = "value";
/// Field with the name of a value, in a list of named values.
const NAME: &str = "name";
/// Names of the columns with the result of a robot.
const OUTCOME: [&str; 5] = ["ok", "error_kind", "error_code", "error_message", "error_hint"];
/// Maximum length of a list that gets one column per entry.
const MAX_COLUMNS: u64 = 16;

/// Selection of the rows of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowsOf {
    /// The entries of all required lists of objects are rows. A report without such a list is one row.
    Lists,
    /// The entries of this list are rows. Other fields are omitted.
    List(&'static str),
    /// The report is one row.
    Report,
}

/// Columns of a report.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// Fields of the report itself. They are in every row.
    common: Vec<Column>,
    /// Lists of the report, with the fields of their entries.
    lists: Vec<(String, Vec<Column>)>,
    /// Columns with the result of a robot, at the end of every row. Columns that the report already has are omitted.
    outcome: Vec<&'static str>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Column {
    name: String,
    /// JSON pointer to the value, relative to the report or to the list entry.
    pointer: String,
    /// Whether the fields of an object at this place have columns of their own.
    has_fields: bool,
}

impl Column {
    /// Value of this column in a report or an entry; `None` if the value has columns of its own.
    fn find<'v>(&self, entry: &'v Value) -> Option<&'v Value> {
        entry.pointer(&self.pointer).filter(|value| !(self.has_fields && value.is_object()))
    }
}

impl Sheet {
    /// Creates the columns of a report with this schema.
    pub fn from_schema(schema: &Value, rows: RowsOf) -> Self {
        let mut sheet = Self { common: Vec::new(), lists: Vec::new(), outcome: Vec::new() };
        let all = fields(schema, &[schema]);
        if all.is_empty() {
            sheet.common.push(Column { name: VALUE.to_owned(), pointer: String::new(), has_fields: false });
        }
        for (name, variants) in all {
            let entries: Vec<&Value> = variants.iter().flat_map(|one| items(schema, one)).collect();
            let mut columns = Vec::new();
            for (field, of_field) in fields(schema, &entries) {
                add(schema, &field, &pointer("", &field), &of_field, MAX_DEPTH, &mut columns);
            }
            let is_list = !columns.is_empty();
            let is_wanted = match rows {
                RowsOf::Lists => !is_list || is_required(schema, &name),
                RowsOf::List(list) => list == name,
                RowsOf::Report => !is_list,
            };
            if !is_wanted {
                continue;
            }
            if is_list {
                sheet.lists.push((name, columns));
            } else {
                add(schema, &name, &pointer("", &name), &variants, MAX_DEPTH, &mut sheet.common);
            }
        }
        let has_several = sheet.lists.len() > 1;
        let taken: BTreeSet<&String> = sheet.common.iter().map(|column| &column.name).collect();
        for (list, columns) in &mut sheet.lists {
            for column in columns.iter_mut().filter(|column| has_several || taken.contains(&column.name)) {
                column.name = format!("{list}_{}", column.name);
            }
        }
        sheet
    }

    /// Adds the columns with the result of each robot. Columns that the entries already have are omitted.
    #[must_use]
    pub fn with_outcome(mut self) -> Self {
        self.outcome = OUTCOME.into_iter().filter(|name| !self.has_column(name)).collect();
        self
    }

    /// Whether a column with this name exists.
    pub fn has_column(&self, name: &str) -> bool {
        self.columns().any(|column| column == name)
    }

    /// Names of all columns, in order.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        let listed = self.lists.iter().flat_map(|(_, columns)| columns);
        self.common.iter().chain(listed).map(|column| column.name.as_str()).chain(self.outcome.iter().copied())
    }

    /// Returns the header line. The names `before` of other columns come first.
    pub fn header(&self, before: &[&str]) -> String {
        let mut out = String::new();
        line(&mut out, before.iter().copied().chain(self.columns()));
        out
    }

    /// Appends only the values of a report, separated by tabs: one line for the report, or one line per list entry. If
    /// an entry has a value, the line contains only this value. The line of a position contains the text that a user
    /// can type. The line of a list contains the values of the list. The outcome fields are omitted.
    pub fn values(&self, before: &[&str], data: &Value, out: &mut String) {
        let mut add = |columns: &[Column], entry: &Value| {
            let is_position = columns.iter().any(|column| column.name == "frame");
            let is_value = |column: &&Column| {
                let is_inside = column.pointer.strip_prefix("/value").is_some_and(|rest| rest.starts_with('/'));
                column.name == VALUE || is_inside || (is_position && column.name == "text")
            };
            let is_outcome = |column: &&Column| column.name == "ok" || column.name.starts_with("error_");
            let has_values = columns.iter().any(|column| is_value(&column));
            let chosen =
                columns.iter().filter(|column| if has_values { is_value(column) } else { !is_outcome(column) });
            let cell_text = |column: &Column| column.find(entry).map_or_else(String::new, plain);
            let before = before.iter().map(|text| escape::line(text).into_owned());
            let cells: Vec<String> = match typed_values(&entry[VALUE]) {
                Some(values) => before.chain(values).collect(),
                None => before.chain(chosen.map(cell_text)).collect(),
            };
            out.push_str(cells.join("\t").trim_end_matches('\t'));
            out.push('\n');
        };
        if self.lists.is_empty() {
            return add(&self.common, data);
        }
        for (list, columns) in &self.lists {
            data[list].as_array().into_iter().flatten().for_each(|entry| add(columns, entry));
        }
    }

    /// Appends the row of a robot that has no report. `before` contains the cells of other columns.
    pub fn failed(&self, before: &[&str], error: &Value, out: &mut String) {
        let before: Vec<String> = before.iter().map(|text| neutralize_formula(text).into_owned()).collect();
        let cells: Vec<String> = self.columns().map(|column| outcome(column, Some(error))).collect();
        line(out, before.iter().chain(&cells).map(String::as_str));
    }

    /// Appends the rows of a report. `error` is the reason why the report is not complete. `before` contains the cells
    /// of other columns.
    pub fn rows(&self, before: &[&str], data: &Value, error: Option<&Value>, out: &mut String) {
        let outcome: Vec<String> = self.outcome.iter().map(|column| outcome(column, error)).collect();
        let outcome = || outcome.iter().map(String::as_str);
        let cells = |columns: &[Column], value: &Value| -> Vec<String> {
            columns.iter().map(|column| column.find(value).map_or_else(String::new, cell)).collect()
        };
        let mut common: Vec<String> = before.iter().map(|text| neutralize_formula(text).into_owned()).collect();
        common.extend(cells(&self.common, data));
        if self.lists.is_empty() {
            return line(out, common.iter().map(String::as_str).chain(outcome()));
        }
        let width: usize = self.lists.iter().map(|(_, columns)| columns.len()).sum();
        let mut left = 0;
        for (list, columns) in &self.lists {
            for entry in data[list].as_array().into_iter().flatten() {
                let own = cells(columns, entry);
                let right = width - left - columns.len();
                let empty = |count| std::iter::repeat_n("", count);
                let row = common.iter().map(String::as_str).chain(empty(left));
                line(out, row.chain(own.iter().map(String::as_str)).chain(empty(right)).chain(outcome()));
            }
            left += columns.len();
        }
    }
}

/// Returns the cell of a column with the result, for example `error_code` from `{"code":…}`.
fn outcome(column: &str, error: Option<&Value>) -> String {
    match (column.strip_prefix("error_"), error) {
        (None, error) if column == "ok" => error.is_none().to_string(),
        (Some(field), Some(error)) => cell(&error[field]),
        _ => String::new(),
    }
}

/// Adds the columns of a field: a column of its own if it can be a plain value, and the columns of nested fields.
fn add(root: &Value, name: &str, place: &str, variants: &[&Value], depth: usize, columns: &mut Vec<Column>) {
    let leaf = |has_fields| Column { name: name.to_owned(), pointer: place.to_owned(), has_fields };
    let Some(depth) = depth.checked_sub(1) else { return columns.push(leaf(false)) };
    let nested = fields(root, variants);
    let lists: Vec<&Value> =
        variants.iter().flat_map(|one| resolve_references(root, one)).filter(|one| is_list(one)).collect();
    let of_list: Vec<&Value> = lists.iter().flat_map(|one| items(root, one)).collect();
    let length =
        lists.iter().filter_map(|list| list["maxItems"].as_u64()).max().filter(|length| *length <= MAX_COLUMNS);
    let is_plain = variants.iter().flat_map(|one| resolve_references(root, one)).any(is_plain);
    let entry_fields = fields(root, &of_list);
    let has_entry_field = |name: &str| entry_fields.iter().any(|(field, _)| field == name);
    let is_one_cell = entry_fields.is_empty() || (has_entry_field(NAME) && has_entry_field(VALUE));
    if is_plain || (length.is_none() && !lists.is_empty() && is_one_cell) {
        columns.push(leaf(!nested.is_empty()));
    }
    for (field, of_field) in nested {
        add(root, &format!("{name}_{field}"), &pointer(place, &field), &of_field, depth, columns);
    }
    for index in 0..length.unwrap_or_default() {
        add(root, &format!("{name}_{}", index + 1), &format!("{place}/{index}"), &of_list, depth, columns);
    }
}

/// Returns the properties in `variants`, in the order of their first appearance. Each property has the schemas from all
/// variants that have this property.
fn fields<'a>(root: &'a Value, variants: &[&'a Value]) -> Vec<(String, Vec<&'a Value>)> {
    let mut all: Vec<(String, Vec<&Value>)> = Vec::new();
    for schema in variants.iter().flat_map(|one| resolve_references(root, one)) {
        for (name, field) in schema["properties"].as_object().into_iter().flatten() {
            match all.iter_mut().find(|(known, _)| known == name) {
                Some((_, schemas)) => schemas.push(field),
                None => all.push((name.clone(), vec![field])),
            }
        }
    }
    all
}

fn is_required(root: &Value, name: &str) -> bool {
    let lists = resolve_references(root, root).into_iter().filter_map(|schema| schema["required"].as_array());
    lists.flatten().any(|required| required == name)
}

/// Returns the schemas of the items of a list.
fn items<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a Value> {
    let lists = resolve_references(root, schema).into_iter().filter(|one| is_list(one));
    lists
        .flat_map(|list| list.get("items").into_iter().chain(list["prefixItems"].as_array().into_iter().flatten()))
        .collect()
}

/// Returns the schema with all references and alternatives resolved.
fn resolve_references<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a Value> {
    let mut found = Vec::new();
    let mut open = vec![(schema, MAX_DEPTH)];
    while let Some((schema, depth)) = open.pop() {
        let Some(depth) = depth.checked_sub(1) else { continue };
        found.push(schema);
        let reference = schema["$ref"].as_str().and_then(|reference| reference.strip_prefix('#'));
        let alternatives = ["allOf", "anyOf", "oneOf"].into_iter().filter_map(|kind| schema[kind].as_array()).flatten();
        let pointers: Vec<_> =
            reference.and_then(|place| root.pointer(place)).into_iter().chain(alternatives).collect();
        // The order is reversed, because the stack returns the last schema first.
        open.extend(pointers.into_iter().rev().map(|schema| (schema, depth)));
    }
    found
}

fn is_list(schema: &Value) -> bool {
    types(schema).any(|name| name == "array")
}

/// Whether a value can be a single cell. A map without known keys can also be a single cell.
fn is_plain(schema: &Value) -> bool {
    let is_scalar = types(schema).any(|name| ["string", "number", "integer", "boolean"].contains(&name));
    let is_map = types(schema).any(|name| name == "object") && schema.get("properties").is_none();
    let is_any = schema.as_bool() == Some(true)
        || schema.as_object().is_some_and(|keys| keys.keys().all(|key| key == "description" || key == "default"));
    is_scalar || is_map || is_any || schema.get("enum").is_some() || schema.get("const").is_some()
}

/// Types that the schema itself names.
fn types(schema: &Value) -> impl Iterator<Item = &str> {
    let named = &schema["type"];
    named.as_str().into_iter().chain(named.as_array().into_iter().flatten().filter_map(Value::as_str))
}

fn pointer(place: &str, field: &str) -> String {
    format!("{place}/{}", field.replace('~', "~0").replace('/', "~1"))
}

/// Text of a cell.
fn cell(value: &Value) -> String {
    neutralize_formula(&text(value)).into_owned()
}

/// Returns the values of an entry whose value has no columns of its own. A position is the text that a user can type; a
/// list is its values. `None` for every other value.
fn typed_values(value: &Value) -> Option<Vec<String>> {
    match value {
        Value::Object(position) => position.get("text").filter(|text| text.is_string()).map(|text| vec![plain(text)]),
        Value::Array(values) => Some(values.iter().map(|entry| plain(entry.get(VALUE).unwrap_or(entry))).collect()),
        _ => None,
    }
}

/// Formats a value for a tab-separated line.
fn plain(value: &Value) -> String {
    escape::line(&text(value)).into_owned()
}

fn text(value: &Value) -> String {
    let is_scalar = |value: &Value| !value.is_object() && !value.is_array();
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Array(values) if values.iter().all(is_scalar) => {
            let between = if values.iter().any(Value::is_string) { "; " } else { " " };
            let texts = values.iter().map(|value| value.as_str().map_or_else(|| value.to_string(), str::to_owned));
            texts.collect::<Vec<_>>().join(between)
        }
        Value::Array(values) => named_values(values).unwrap_or_else(|| value.to_string()),
        _ => value.to_string(),
    }
}

/// A list of named values as it can be typed: `ax1=10.0 ax2=2.0`; `None` for another list.
fn named_values(values: &[Value]) -> Option<String> {
    let pair = |entry: &Value| Some(format!("{}={}", entry.get(NAME)?.as_str()?, text(entry.get(VALUE)?)));
    Some(values.iter().map(pair).collect::<Option<Vec<_>>>()?.join(" "))
}

/// Makes a text harmless for terminals and spreadsheets. A text that could be a formula gets an apostrophe (OWASP).
/// Signed numbers, one or several, and a single dash are not formulas.
pub fn neutralize_formula(text: &str) -> Cow<'_, str> {
    let shown = escape::lines(text);
    let is_plain = || shown == "-" || shown.split(' ').all(|number| number.parse::<f64>().is_ok());
    if shown.starts_with(['=', '+', '-', '@']) && !is_plain() { format!("'{shown}").into() } else { shown }
}

/// Appends a line of fields.
pub fn line<'a>(out: &mut String, fields: impl Iterator<Item = &'a str>) {
    for (index, field) in fields.enumerate() {
        if index > 0 {
            out.push(',');
        }
        push_field(out, field);
    }
    out.push('\n');
}

/// Appends a field. It is quoted if necessary.
fn push_field(out: &mut String, field: &str) {
    if field.bytes().any(|byte| matches!(byte, b',' | b'"' | b'\n' | b'\r')) {
        out.push('"');
        out.push_str(&field.replace('"', "\"\""));
        out.push('"');
    } else {
        out.push_str(field);
    }
}

#[cfg(test)]
mod tests {
    use schemars::{JsonSchema, schema_for};
    use serde::Serialize;
    use serde_json::json;

    use super::*;

    #[derive(Serialize, JsonSchema)]
    struct Report {
        group: u8,
        alarms: Vec<Alarm>,
    }

    #[derive(Serialize, JsonSchema)]
    struct Alarm {
        code: String,
        sub_code: Option<SubCode>,
        value: Number,
        axes: [i32; 2],
        remedies: Vec<String>,
        /// A list within a row: the CSV omits it, only the JSON contains it.
        details: Vec<SubCode>,
        group: Option<u8>,
    }

    #[derive(Serialize, JsonSchema)]
    struct SubCode {
        raw: u32,
    }

    #[derive(Serialize, JsonSchema)]
    #[serde(untagged)]
    enum Number {
        Whole(i32),
        Point { x_mm: f64 },
    }

    const HEADER: &str = "group,code,sub_code_raw,value,value_x_mm,axes_1,axes_2,remedies,alarms_group\n";

    fn sheet() -> Sheet {
        Sheet::from_schema(&schema_for!(Report).to_value(), RowsOf::Lists)
    }

    fn rows(sheet: &Sheet, data: &Value) -> String {
        let mut out = String::new();
        sheet.rows(&[], data, None, &mut out);
        out
    }

    #[test]
    fn values_stand_alone() {
        #[derive(serde::Serialize, JsonSchema)]
        struct Item {
            name: &'static str,
            value_hex: &'static str,
            value: Value,
        }
        #[derive(serde::Serialize, JsonSchema)]
        struct Items {
            items: Vec<Item>,
        }
        #[derive(serde::Serialize, JsonSchema)]
        struct Place {
            x_mm: f64,
            text: &'static str,
        }
        let values = |schema: schemars::Schema, data: Value, before: &[&str]| {
            let mut out = String::new();
            Sheet::from_schema(&schema.to_value(), RowsOf::Lists).values(before, &data, &mut out);
            out
        };
        let item = |name, value| Item { name, value_hex: "0x07", value };
        let position = json!({ "frame": "base", "x_mm": 1.5, "text": "base:x=1.5" });
        let list = json!([{ "name": "ax1", "value": 10.0 }, { "name": "ax2", "value": 2 }]);
        let items =
            Items { items: vec![item("B0", json!(-5)), item("B1", json!(7)), item("P1", position), item("P01", list)] };
        let shown = values(schema_for!(Items), serde_json::to_value(&items).unwrap(), &[]);
        assert_eq!(shown, "-5\n7\nbase:x=1.5\n10.0\t2\n");
        let place = serde_json::to_value(Place { x_mm: 1.5, text: "=a\tb" }).unwrap();
        assert_eq!(values(schema_for!(Place), place, &["cell3"]), "cell3\t1.5\t=a\\tb\n");
    }

    #[test]
    fn columns_do_not_depend_on_the_number_of_entries() {
        let none = serde_json::to_value(Report { group: 1, alarms: Vec::new() }).unwrap();
        assert_eq!((sheet().header(&[]).as_str(), rows(&sheet(), &none).as_str()), (HEADER, ""));
        let alarm = |sub_code, value| Alarm {
            code: "4315".to_owned(),
            sub_code,
            value,
            axes: [1, -2],
            remedies: vec!["a, b".to_owned(), "c".to_owned()],
            details: vec![SubCode { raw: 1 }],
            group: None,
        };
        let alarms = vec![alarm(Some(SubCode { raw: 7 }), Number::Whole(5)), alarm(None, Number::Point { x_mm: 1.5 })];
        let many = serde_json::to_value(Report { group: 1, alarms }).unwrap();
        assert_eq!(rows(&sheet(), &many), "1,4315,7,5,,1,-2,\"a, b; c\",\n1,4315,,,1.5,1,-2,\"a, b; c\",\n");
    }

    #[test]
    fn list_of_named_values_is_one_cell() {
        #[derive(Serialize, JsonSchema)]
        struct Parameters {
            items: Vec<Parameter>,
        }
        #[derive(Serialize, JsonSchema)]
        struct Parameter {
            value: Vec<Named>,
        }
        #[derive(Serialize, JsonSchema)]
        struct Named {
            name: &'static str,
            value: Value,
            unit: Option<&'static str>,
        }
        let value = |name, value| Named { name, value, unit: Some("mm") };
        let items = vec![Parameter { value: vec![value("ax1", json!(10.5)), value("mode", json!("fast"))] }];
        let sheet = Sheet::from_schema(&schema_for!(Parameters).to_value(), RowsOf::Lists);
        assert_eq!(sheet.header(&[]), "value\n");
        assert_eq!(rows(&sheet, &serde_json::to_value(Parameters { items }).unwrap()), "ax1=10.5 mode=fast\n");
    }

    #[test]
    fn report_without_a_list_is_one_row() {
        #[derive(JsonSchema)]
        #[expect(dead_code, reason = "only its schema matters")]
        struct Status {
            mode: Option<String>,
            held: bool,
        }
        let sheet = Sheet::from_schema(&schema_for!(Status).to_value(), RowsOf::Lists);
        assert_eq!(sheet.header(&["robot"]), "robot,mode,held\n");
        let mut out = String::new();
        sheet.rows(&["=r"], &json!({"held": true}), None, &mut out);
        assert_eq!(out, "'=r,,true\n");
        let text = Sheet::from_schema(&schema_for!(String).to_value(), RowsOf::Lists);
        assert_eq!((text.header(&[]).as_str(), rows(&text, &json!("-x")).as_str()), ("value\n", "'-x\n"));
    }

    #[test]
    fn failed_robot_is_a_row_with_the_same_columns() {
        #[derive(JsonSchema)]
        #[expect(dead_code, reason = "only its schema matters")]
        struct Held {
            held: bool,
        }
        #[derive(JsonSchema)]
        #[expect(dead_code, reason = "only its schema matters")]
        struct Item {
            name: String,
            ok: bool,
            error_code: Option<String>,
        }
        #[derive(JsonSchema)]
        #[expect(dead_code, reason = "only its schema matters")]
        struct Items {
            items: Vec<Item>,
        }
        let error = json!({"exit": 4, "kind": "no_answer", "code": null, "message": "no answer, at all"});
        let status = Sheet::from_schema(&schema_for!(Held).to_value(), RowsOf::Lists).with_outcome();
        assert_eq!(status.header(&["robot"]), "robot,held,ok,error_kind,error_code,error_message,error_hint\n");
        let mut out = String::new();
        status.rows(&["a"], &json!({"held": true}), None, &mut out);
        status.rows(&["b"], &json!({"held": null}), Some(&error), &mut out);
        status.failed(&["c"], &error, &mut out);
        let no_answer = "false,no_answer,,\"no answer, at all\",\n";
        assert_eq!(out, format!("a,true,true,,,,\nb,,{no_answer}c,,{no_answer}"));
        let items = Sheet::from_schema(&schema_for!(Items).to_value(), RowsOf::Lists).with_outcome();
        assert_eq!(items.header(&[]), "name,ok,error_code,error_kind,error_message,error_hint\n");
        let mut out = String::new();
        items.rows(&[], &json!({"items": [{"name": "B0", "ok": true}]}), None, &mut out);
        items.failed(&[], &error, &mut out);
        assert_eq!(out, format!("B0,true,,,,\n,false,,no_answer,\"no answer, at all\",\n"));
    }

    #[test]
    fn prefixes_columns_of_several_lists() {
        #[derive(JsonSchema)]
        #[expect(dead_code, reason = "only its schema matters")]
        struct Two {
            signals: Vec<SubCode>,
            groups: Option<Vec<SubCode>>,
            #[serde(skip_serializing_if = "Vec::is_empty")]
            left_over: Vec<SubCode>,
        }
        let settings = schemars::generate::SchemaSettings::draft2020_12().for_serialize();
        let schema = settings.into_generator().into_root_schema_for::<Two>().to_value();
        let data = json!({"signals": [{"raw": 1}], "groups": [{"raw": 2}]});
        let both = Sheet::from_schema(&schema, RowsOf::Lists);
        assert_eq!(both.header(&[]), "signals_raw,groups_raw\n");
        assert_eq!(rows(&both, &data), "1,\n,2\n");
        let one = Sheet::from_schema(&schema, RowsOf::List("groups"));
        assert_eq!((one.header(&[]).as_str(), rows(&one, &data).as_str()), ("raw\n", "2\n"));
    }

    #[test]
    fn neutralizes_control_characters_and_formulas() {
        let cases = [
            ("=1+1", "'=1+1\n"),
            ("@SUM", "'@SUM\n"),
            ("-12.5", "-12.5\n"),
            ("-12.5 7 -1", "-12.5 7 -1\n"),
            ("-", "-\n"),
            ("-x", "'-x\n"),
            ("\u{1b}[2J", "\\x1b[2J\n"),
            ("a,\"b\"", "\"a,\"\"b\"\"\"\n"),
        ];
        let sheet = Sheet::from_schema(&schema_for!(String).to_value(), RowsOf::Lists);
        for (text, expected) in cases {
            assert_eq!(rows(&sheet, &json!(text)), expected, "{text:?}");
        }
    }
}
