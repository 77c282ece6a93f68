//! JSON as rows for a spreadsheet: the fields of a report under their own names, one value a cell.
//!
//! A list of things is a row for each of them; what stands beside the list is in every row. What is nested has dotted
//! names: `sub_code.raw`, `position_mm.0`. Where there are several lists, their names stand before those of the fields.

use serde_json::Value;

use super::render::{csv_line, harmless};

/// Which lists of a report are rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lists<'a> {
    /// None: it is one row.
    None,
    /// Every list of things.
    All,
    /// Only this one; the others are left out.
    One(&'a str),
}

/// Rows under the names of fields.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Rows {
    columns: Vec<String>,
    rows: Vec<Vec<(usize, String)>>,
}

impl Rows {
    /// Rows below columns that are there already.
    pub fn under(columns: Vec<String>) -> Self {
        Self { columns, rows: Vec::new() }
    }

    /// The names of the columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Adds a report: one row, or one for each thing of its lists. `before` are cells in front. Of a list without things
    /// `columns` has the names of the fields that they would have.
    pub fn add(
        &mut self,
        before: &[(&str, &str)],
        data: &Value,
        which: Lists<'_>,
        columns: impl Fn(&str) -> Vec<String>,
    ) {
        let before = || before.iter().map(|(name, text)| ((*name).to_owned(), harmless(text)));
        let all = if which == Lists::None { Vec::new() } else { lists(data) };
        let is_row = |name: &str| !matches!(which, Lists::One(one) if one != name);
        let lists: Vec<_> = all.iter().copied().filter(|(name, _)| is_row(name)).collect();
        let mut beside: Vec<(String, String)> = before().collect();
        match data {
            Value::Object(fields) => {
                for (name, value) in fields.iter().filter(|(name, _)| !all.iter().any(|(list, _)| list == name)) {
                    flatten(name, value, &mut beside);
                }
            }
            value => flatten("value", value, &mut beside),
        }
        if lists.is_empty() {
            return self.push(beside);
        }
        let filled = lists.iter().filter(|(_, items)| !items.is_empty()).count();
        if filled == 0 {
            // A table of nothing has a head and no rows.
            let below = lists.iter().flat_map(|(list, _)| {
                let is_taken = |name: &str| lists.len() > 1 || beside.iter().any(|(other, _)| other == name);
                let named = |name: String| if is_taken(&name) { format!("{list}.{name}") } else { name };
                columns(list).into_iter().map(named).collect::<Vec<_>>()
            });
            let below: Vec<String> = below.collect();
            for name in beside.into_iter().map(|(name, _)| name).chain(below) {
                self.column(name);
            }
            return;
        }
        for (list, items) in lists {
            for item in items {
                let mut row = beside.clone();
                let is_taken = |name: &str| beside.iter().any(|(other, _)| other == name);
                let mut cells = Vec::new();
                match item {
                    Value::Object(fields) => fields.iter().for_each(|(name, value)| flatten(name, value, &mut cells)),
                    value => flatten("value", value, &mut cells),
                }
                let named = |(name, text): (String, String)| {
                    let name = if filled > 1 || is_taken(&name) { format!("{list}.{name}") } else { name };
                    (name, text)
                };
                row.extend(cells.into_iter().map(named));
                self.push(row);
            }
        }
    }

    fn push(&mut self, cells: Vec<(String, String)>) {
        let row = cells.into_iter().map(|(name, text)| (self.column(name), text)).collect();
        self.rows.push(row);
    }

    fn column(&mut self, name: String) -> usize {
        self.columns.iter().position(|column| *column == name).unwrap_or_else(|| {
            self.columns.push(name);
            self.columns.len() - 1
        })
    }

    /// As CSV (RFC 4180), with a line of names or without.
    pub fn csv(&self, has_header: bool) -> String {
        // What is null in one row may have fields in another, which are columns then.
        let is_parent = |name: &str| {
            let below = format!("{name}.");
            self.columns.iter().any(|column| column.starts_with(&below))
        };
        let shown: Vec<bool> = self.columns.iter().map(|name| !is_parent(name)).collect();
        let line_of = |cells: &[String]| -> Vec<String> {
            cells.iter().zip(&shown).filter(|(_, is_shown)| **is_shown).map(|(cell, _)| cell.clone()).collect()
        };
        let mut out = String::new();
        if has_header && !self.columns.is_empty() {
            csv_line(&mut out, &line_of(&self.columns));
        }
        for row in &self.rows {
            let mut line = vec![String::new(); self.columns.len()];
            for (column, text) in row {
                line[*column].clone_from(text);
            }
            csv_line(&mut out, &line_of(&line));
        }
        out
    }
}

/// The lists of objects of a report.
fn lists(data: &Value) -> Vec<(&str, &[Value])> {
    let fields = data.as_object().into_iter().flatten();
    fields
        .filter_map(|(name, value)| {
            let items = value.as_array()?;
            items.iter().all(Value::is_object).then_some((name.as_str(), items.as_slice()))
        })
        .collect()
}

fn flatten(name: &str, value: &Value, cells: &mut Vec<(String, String)>) {
    match value {
        Value::Object(fields) if !fields.is_empty() => {
            for (inner, value) in fields {
                flatten(&format!("{name}.{inner}"), value, cells);
            }
        }
        Value::Array(items) if !items.is_empty() => {
            for (index, value) in items.iter().enumerate() {
                flatten(&format!("{name}.{index}"), value, cells);
            }
        }
        Value::Null | Value::Object(_) | Value::Array(_) => cells.push((name.to_owned(), String::new())),
        Value::String(text) => cells.push((name.to_owned(), harmless(text))),
        Value::Bool(_) | Value::Number(_) => cells.push((name.to_owned(), value.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn csv(data: &Value, which: Lists<'_>) -> String {
        let mut rows = Rows::default();
        rows.add(&[], data, which, |list| vec![format!("of_{list}")]);
        rows.csv(true)
    }

    #[test]
    fn fields_keep_their_names_and_what_is_nested_is_dotted() {
        let data = json!({"mode": "play", "held": false, "at": {"x_mm": 1.5}, "axes": [1, 2], "none": null, "no": []});
        assert_eq!(csv(&data, Lists::None), "mode,held,at.x_mm,axes.0,axes.1,none,no\nplay,false,1.5,1,2,,\n");
        assert_eq!(csv(&json!("=x"), Lists::None), "value\n'=x\n");
    }

    #[test]
    fn a_list_is_a_row_for_each_thing() {
        let data = json!({"task": 1, "points": [{"point": 1, "ok": true}, {"point": 2, "error": {"code": "NG"}}]});
        assert_eq!(csv(&data, Lists::All), "task,point,ok,error.code\n1,1,true,\n1,2,,NG\n");
        assert_eq!(csv(&json!({"task": 1, "points": []}), Lists::All), "task,of_points\n", "a head without rows");
        assert_eq!(csv(&json!({"name": 1, "x": [{"name": 2}]}), Lists::All), "name,x.name\n1,2\n");
        let two = json!({"signals": [{"on": true}], "groups": [{"value": 7}]});
        assert_eq!(csv(&two, Lists::All), "signals.on,groups.value\ntrue,\n,7\n");
        assert_eq!(csv(&two, Lists::One("groups")), "value\n7\n");
    }

    #[test]
    fn several_reports_share_their_columns() {
        let mut rows = Rows::default();
        rows.add(&[("robot", "a")], &json!({"x": 1}), Lists::None, |_| Vec::new());
        rows.add(&[("robot", "b")], &json!({"y": "2,5"}), Lists::None, |_| Vec::new());
        assert_eq!(rows.csv(true), "robot,x,y\na,1,\nb,,\"2,5\"\n");
        let mut later = Rows::under(rows.columns().to_vec());
        later.add(&[("robot", "a")], &json!({"y": 3}), Lists::None, |_| Vec::new());
        assert_eq!(later.csv(false), "a,,3\n");
    }
}
