//! Values as a user types and reads them: `ax1=100.00`, `english`, `0/01/3`.
//!
//! A controller stores a row of fields. A user sees slots. A slot is one field, or the three fields for a bit of a
//! port.

use std::ops::Range;

use serde_json::Value as Json;

use crate::prelude::*;
use armctl_controller::toyo::field::{Field, Form, Number};
use armctl_controller::toyo::layout::{Layout, UNLISTED};
use armctl_frame::store::comma_hint;

/// A slot for one value that the user types.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ValueSlot {
    /// Name of the slot, such as `ax1`, `low`, `port`.
    pub name: String,
    /// Range of the slot's fields in the layout.
    fields: Range<usize>,
}

/// A value with its description.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct NamedValue {
    /// Name that is typed before `=`, such as `ax1`.
    pub name: String,
    /// A number in its unit, a word of the protocol, or a bit of a port as `station/port/bit`.
    pub value: Json,
    /// Unit of the number: `mm`, `mm/s`, `s`; null without a unit.
    pub unit: Option<&'static str>,
    /// Meaning of the word; null if the word is clear by itself.
    pub meaning: Option<&'static str>,
    /// Text of the value in the protocol.
    pub raw: String,
    /// Whether the manual lists the value. Other values are displayed unchanged, and cannot be written.
    pub in_manual: bool,
    /// Text of the value as a user types it.
    #[serde(skip)]
    pub text: String,
}

/// New values for the fields of a record. `None` keeps the old value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changes(Vec<Option<Value>>);

/// Text that replaces the meaning of a value.
pub use armctl_controller::toyo::program::NOT_IN_MANUAL;

/// Returns the axis, 0 to 3, of a coordinate field. In the protocol, X, Y, Z and R are axes 1 to 4, whatever their
/// letters are.
fn axis(field: &Field) -> Option<usize> {
    ["x", "y", "z", "r"].iter().position(|name| *name == field.name)
}

/// Whether the layout has coordinates. Users name coordinates by the letters of the axes.
pub fn has_coordinates(layout: &Layout) -> bool {
    layout.fields.iter().any(|field| axis(field).is_some())
}

/// Slots of a layout. The coordinates have these letters.
pub fn slots(layout: &Layout, letters: &Letters) -> Vec<ValueSlot> {
    let mut slots = Vec::new();
    let mut words = layout.text.split("{}");
    let mut index = 0;
    while let Some(field) = layout.fields.get(index) {
        let before = words.next().unwrap_or_default();
        let is_bit = before != "/" && field.name.starts_with("station") && layout.text.contains("{}/{}/{}");
        if is_bit {
            // In `PN1={}/{}/{}`, the name of the slot is `pn1`.
            let label = before.rsplit(' ').next().and_then(|label| label.strip_suffix('='));
            let label = label.map_or("port".to_owned(), str::to_lowercase);
            slots.push(ValueSlot { name: label, fields: index..index + 3 });
            words.next();
            words.next();
            index += 3;
        } else {
            let name = axis(field).map_or(field.name, |axis| letters.name(axis));
            slots.push(ValueSlot { name: name.to_owned(), fields: index..index + 1 });
            index += 1;
        }
    }
    slots
}

/// Returns the values of a record without coordinates, one per slot.
pub fn named_values(record: &Record) -> Vec<NamedValue> {
    named_values_with(record, &Letters::USUAL)
}

/// Returns the values of a record, one per slot. Coordinates have the names that `letters` gives the axes.
pub fn named_values_with(record: &Record, letters: &Letters) -> Vec<NamedValue> {
    let layout = record.layout();
    if layout == UNLISTED {
        let text = record.written();
        let (name, meaning) = ("unlisted".to_owned(), Some(NOT_IN_MANUAL));
        let value = Json::from(text.as_str());
        return vec![NamedValue { name, value, unit: None, meaning, raw: text.clone(), in_manual: false, text }];
    }
    slots(&layout, letters).into_iter().map(|slot| slot.named_value(&layout, record.values())).collect()
}

/// Values in one line. The units follow the values: `low=10.0 high=100.0 mm/s`.
pub fn in_a_line(values: &[NamedValue]) -> String {
    line(values, values.len() > 1)
}

/// Values in one line, with or without their names.
pub fn line(values: &[NamedValue], is_named: bool) -> String {
    let common =
        values.first().and_then(|first| first.unit).filter(|unit| values.iter().all(|value| value.unit == Some(unit)));
    let mut texts = Vec::with_capacity(values.len() + 1);
    for value in values {
        let name = if is_named { format!("{}=", value.name) } else { String::new() };
        let meaning = value.meaning.map_or(String::new(), |meaning| format!(" ({meaning})"));
        let unit = value.unit.filter(|_| common.is_none()).map_or(String::new(), |unit| format!(" {unit}"));
        texts.push(format!("{name}{}{meaning}{unit}", value.text));
    }
    texts.extend(common.map(ToOwned::to_owned));
    texts.join(" ")
}

/// Values as typed on the command line: `ax1=100.00 ax2=0.00`. A single value has no name.
pub fn as_typed(values: &[NamedValue]) -> String {
    let typed = |value: &NamedValue| {
        if values.len() > 1 { format!("{}={}", value.name, value.text) } else { value.text.clone() }
    };
    values.iter().map(typed).collect::<Vec<_>>().join(" ")
}

/// Values in which two records differ, one line for each record. The coordinates have these letters.
pub fn difference(old: &Record, new: &Record, letters: &Letters) -> [String; 2] {
    let (old, new) = (named_values_with(old, letters), named_values_with(new, letters));
    let is_named = new.len() > 1;
    let different_values = |left: &[NamedValue], right: &[NamedValue]| {
        let differing = left.iter().filter(|value| !right.contains(value)).cloned();
        line(&differing.collect::<Vec<_>>(), is_named)
    };
    [different_values(&old, &new), different_values(&new, &old)]
}

impl ValueSlot {
    fn named_value(&self, layout: &Layout, values: &[Value]) -> NamedValue {
        let pairs: Vec<(&Field, &Value)> =
            self.fields.clone().filter_map(|index| Some((layout.fields.get(index)?, values.get(index)?))).collect();
        let raw = pairs.iter().map(|(field, value)| field.written(value)).collect::<Vec<_>>().join("/");
        let (value, text, unit, meaning) = match pairs[..] {
            [(Field { form: Form::Number(form), unit, .. }, Value::Number(units))] => {
                (number(*form, *units), form.plain(*units), *unit, None)
            }
            [(Field { form: Form::Word(words), .. }, Value::Word(text))] => {
                let about = words.iter().find(|word| word.text == *text).map(|word| word.about);
                (Json::from(text.trim_end()), text.trim_end().to_owned(), "", about.filter(|about| about != text))
            }
            _ => (Json::from(raw.as_str()), raw.clone(), "", None),
        };
        let in_manual = pairs.iter().all(|(field, value)| field.is_listed(value));
        let meaning = if in_manual { meaning } else { Some(NOT_IN_MANUAL) };
        let unit = Some(unit).filter(|unit| !unit.is_empty());
        NamedValue { name: self.name.clone(), value, unit, meaning, raw, in_manual, text }
    }

    /// Parses the text for the slot.
    fn read(&self, layout: &Layout, text: &str) -> Result<Vec<Value>, String> {
        let fields = &layout.fields[self.fields.clone()];
        if let [field] = fields {
            return Ok(vec![word(field, text)?]);
        }
        let parts: Vec<&str> = text.split('/').collect();
        if parts.len() != fields.len() {
            return Err(format!("{}: '{text}' is not STATION/PORT/BIT, such as 0/01/3", self.name));
        }
        fields.iter().zip(parts).map(|(field, part)| word(field, part)).collect()
    }

    fn put(&self, changes: &mut [Option<Value>], values: Vec<Value>) {
        for (index, value) in self.fields.clone().zip(values) {
            changes[index] = Some(value);
        }
    }

    /// Valid input for the slot.
    fn expected(&self, layout: &Layout) -> String {
        match &layout.fields[self.fields.clone()] {
            [field] => expected(field),
            _ => "STATION/PORT/BIT, such as 0/01/3".to_owned(),
        }
    }
}

impl Changes {
    /// Parses the values for a layout: all values in order, or some as `name=value`. `what` names the record in errors.
    /// Coordinates have these letters. If the letters are not the usual letters, coordinates need names, because their
    /// order could mean letters or axes.
    pub fn read(what: &str, layout: &Layout, letters: &Letters, typed: &[String]) -> Result<Self> {
        let slots = slots(layout, letters);
        let wrong = |error: String| Failure::usage(format!("{what}: {error}"));
        let wrong_slot = |error: String| wrong(error).hint(usage(&slots, layout));
        let named: Vec<Option<(&str, &str)>> = typed.iter().map(|text| assignment(text)).collect();
        let mut changes = vec![None; layout.fields.len()];
        if named.iter().all(Option::is_none) {
            if has_coordinates(layout) && !letters.are_usual() {
                let message = format!("coordinates need names on this machine: {}", machine(letters));
                return Err(wrong(message).hint(by_name(&slots)));
            }
            if typed.len() != slots.len() {
                let values = if slots.len() == 1 { "value" } else { "values" };
                let message = format!("{} {values} needed, but {} typed", slots.len(), typed.len());
                return Err(comma_hint(typed, slots.len()).into_iter().fold(wrong_slot(message), Failure::hint));
            }
            for (slot, text) in slots.iter().zip(typed) {
                slot.put(&mut changes, slot.read(layout, text).map_err(wrong)?);
            }
            return Ok(Self(changes));
        }
        for (assignment, text) in named.into_iter().zip(typed) {
            let (name, value) =
                assignment.ok_or_else(|| wrong_slot(format!("'{text}' has no name, but other values have names")))?;
            let slot = slot_by_name(&slots, layout, name).ok_or_else(|| {
                if has_coordinates(layout) && ["x", "y", "z", "r"].iter().any(|axis| axis.eq_ignore_ascii_case(name)) {
                    let message = format!("the axis of {} is unknown: {}", name.to_uppercase(), machine(letters));
                    return wrong(message).hint(by_name(&slots));
                }
                let near = nearest(name, slots.iter().map(|slot| &slot.name[..]));
                let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
                wrong_slot(format!("unknown value '{}'{near}", name.escape_debug()))
            })?;
            if changes[slot.fields.start].is_some() {
                return Err(wrong_slot(format!("{} appears twice", slot.name)));
            }
            slot.put(&mut changes, slot.read(layout, value).map_err(wrong)?);
        }
        Ok(Self(changes))
    }

    /// Creates changes from new values; `None` keeps the present value.
    pub fn of(values: Vec<Option<Value>>) -> Self {
        Self(values)
    }

    /// The new values.
    pub fn values(&self) -> &[Option<Value>] {
        &self.0
    }

    /// All values, if every field has a new value.
    pub fn whole(&self) -> Option<Vec<Value>> {
        self.0.iter().cloned().collect()
    }

    /// All values. Unchanged fields keep the values of `stored`.
    ///
    /// # Errors
    /// If an unchanged value cannot be written again.
    pub fn merged_with(&self, stored: &Record) -> Result<Vec<Value>> {
        // The numbers of rows and programs come before the values.
        let keys = stored.values().len().saturating_sub(self.0.len());
        let unchanged_values = stored.pairs().skip(keys).zip(&self.0).filter(|(_, change)| change.is_none());
        let foreign =
            unchanged_values.map(|((field, value), _)| (field, value)).find(|(field, value)| !field.is_listed(value));
        if stored.layout() == UNLISTED {
            return Err(unwritable_value(&stored.written()));
        }
        if let Some((field, value)) = foreign {
            return Err(unwritable_value(&format!("{}={}", field.name, field.written(value))));
        }
        Ok(self.merged_values(&stored.values()[keys..]))
    }

    /// All values. Unchanged fields keep the values of `stored`.
    pub fn merged_values(&self, stored: &[Value]) -> Vec<Value> {
        self.0.iter().zip(stored).map(|(change, stored)| change.as_ref().unwrap_or(stored).clone()).collect()
    }
}

/// The slot with this name. A coordinate can also be named by the number of its axis: `ax2`.
fn slot_by_name<'p>(slots: &'p [ValueSlot], layout: &Layout, name: &str) -> Option<&'p ValueSlot> {
    let numbered = |slot: &&ValueSlot| {
        let field = layout.fields.get(slot.fields.start)?;
        Some(Letters::UNKNOWN.name(axis(field)?).eq_ignore_ascii_case(name)).filter(|is_it| *is_it)
    };
    let named = slots.iter().find(|slot| slot.name.eq_ignore_ascii_case(name));
    named.or_else(|| slots.iter().find(|slot| numbered(slot).is_some()))
}

/// Describes which letters the axes of this machine have.
pub fn machine(letters: &Letters) -> String {
    if *letters == Letters::UNKNOWN {
        return "the controller does not report the letters of its axes".to_owned();
    }
    let letters = letters.all().map(|letter| if letter.is_empty() { "?".to_owned() } else { letter });
    format!("axes 1 to 4 have the letters {}", letters.join(", "))
}

/// Hint that coordinates need names.
fn by_name(slots: &[ValueSlot]) -> String {
    let names: Vec<String> = slots.iter().map(|slot| format!("{}=…", slot.name)).collect();
    format!("type the coordinates by name: {}; ax1 to ax4 also work on every machine", names.join(" "))
}

/// Failure: an unchanged value cannot be written again.
fn unwritable_value(stored: &str) -> Failure {
    Failure::usage(format!("the stored value '{stored}' is not in the manual and cannot be written again"))
        .hint("type all values; nothing was written")
}

/// Number in its unit. It is a float only if the field has decimals.
fn number(form: Number, units: i32) -> Json {
    if form.scale() > 1 { Json::from(f64::from(units) / f64::from(form.scale())) } else { Json::from(units) }
}

/// Value in the unit of its field; null if the value is not a number.
pub fn json(field: &Field, value: &Value) -> Json {
    match (&field.form, value) {
        (Form::Number(form), Value::Number(units)) => number(*form, *units),
        _ => Json::Null,
    }
}

/// Splits `ax1=5` into name and value. A text that does not begin with a name, such as `<=`, is a value.
pub fn assignment(text: &str) -> Option<(&str, &str)> {
    let (name, value) = text.split_once('=')?;
    name.starts_with(|c: char| c.is_ascii_alphabetic()).then_some((name, value))
}

/// Parses the value of a field. The meaning of a word is also accepted, in any case.
pub fn word(field: &Field, text: &str) -> Result<Value, String> {
    let Form::Word(words) = field.form else { return field.read(text).map_err(|error| error.to_string()) };
    let same = |other: &str| slug(other) == slug(text);
    let word = words.iter().find(|word| word.text.trim_end() == text.trim_end());
    let word = word.or_else(|| words.iter().find(|word| same(word.text) || same(word.about)));
    match word {
        Some(word) => Ok(Value::Word(word.text)),
        None => Err(format!("{}: '{}' is not {}", field.name, text.escape_debug(), expected(field))),
    }
}

/// Describes the valid input for a field, for example `J (japanese) or E (english)`.
fn expected(field: &Field) -> String {
    let Form::Word(words) = field.form else { return field.expected() };
    let texts: Vec<String> = words
        .iter()
        .map(|word| match word.text.trim_end() {
            text if text == word.about => text.to_owned(),
            text => format!("{text} ({})", slug(word.about)),
        })
        .collect();
    match texts.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => texts.concat(),
    }
}

/// Meaning of a word as one word: `external-point`.
fn slug(text: &str) -> String {
    text.trim().to_lowercase().split([' ', '-', '_']).filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

/// Hint about the values of a record.
fn usage(slots: &[ValueSlot], layout: &Layout) -> String {
    match slots {
        [slot] => format!("type the value: {}", slot.expected(layout)),
        [first, ..] => {
            let names: Vec<&str> = slots.iter().map(|slot| &slot.name[..]).collect();
            format!(
                "type all values in the order {}, or only some values by name, such as {}=…",
                names.join(" "),
                first.name
            )
        }
        [] => "remove the values: this item has no values".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(name: &str) -> Layout {
        Parameter::named(name).unwrap().body()
    }

    fn names(name: &str) -> Vec<String> {
        slots(&body(name), &Letters::USUAL).into_iter().map(|slot| slot.name).collect()
    }

    fn read(name: &str, typed: &[&str]) -> Result<String, String> {
        let typed: Vec<String> = typed.iter().map(|text| (*text).to_owned()).collect();
        let changes = Changes::read(name, &body(name), &Letters::USUAL, &typed).map_err(|failure| failure.message)?;
        Ok(body(name).emit(&changes.whole().unwrap()).unwrap())
    }

    #[test]
    fn the_slots_of_each_parameter_cover_all_fields() {
        for row in &table::parameters::PARAMETERS {
            let (layout, slots) = (row.body(), slots(&row.body(), &Letters::USUAL));
            let covered: Vec<usize> = slots.iter().flat_map(|slot| slot.fields.clone()).collect();
            assert_eq!(covered, (0..layout.fields.len()).collect::<Vec<_>>(), "{}", row.id);
        }
        assert_eq!(names("M01"), ["port"]);
        assert_eq!(names("M12"), ["pn1", "pn2", "pn3", "pn4"]);
        assert_eq!(names("M14"), ["ta1", "ta2", "ta3", "ta4"]);
        assert_eq!(names("P08"), ["low", "high"]);
        assert_eq!(names("P13"), ["compare", "place", "port"]);
        let whole = slots(&Parameter::named("M14").unwrap().layout, &Letters::USUAL);
        assert_eq!(whole.iter().map(|slot| &slot.name[..]).collect::<Vec<_>>(), ["ta1", "ta2", "ta3", "ta4"]);
        assert_eq!(names("M17"), ["station", "rate", "options"]);
    }

    #[test]
    fn values_are_typed_in_order_or_by_name() {
        assert_eq!(read("P08", &["10", "100.5"]).unwrap(), "L=010.0 H=100.5");
        assert_eq!(read("P08", &["HIGH=100.5", "low=1"]).unwrap(), "L=001.0 H=100.5");
        assert_eq!(read("M01", &["0/01/3"]).unwrap(), "0/01/3");
        assert_eq!(read("M01", &["0/1/3"]).unwrap(), "0/01/3");
        assert_eq!(read("P13", &["<=", "-5", "1/12/0"]).unwrap(), "AX1<=-0005.00 1/12/0");
        assert_eq!(read("P13", &["compare=at-least", "place=5", "port=0/01/1"]).unwrap(), "AX1>=+0005.00 0/01/1");
        assert_eq!(read("M09", &["english"]).unwrap(), "E");
        assert_eq!(read("M09", &["j"]).unwrap(), "J");
        assert_eq!(read("M10", &["External Point"]).unwrap(), "P");
    }

    #[test]
    fn omitted_values_stay_unchanged() {
        let layout = body("P08");
        let changes = Changes::read("P08", &layout, &Letters::USUAL, &["high=9".to_owned()]).unwrap();
        assert_eq!(changes.whole(), None);
        assert_eq!(changes.merged_values(&[Value::Number(1), Value::Number(2)]), [Value::Number(1), Value::Number(90)]);
    }

    #[test]
    fn error_messages_name_range_unit_and_choices() {
        let error = |name, typed: &[&str]| read(name, typed).unwrap_err();
        assert_eq!(error("P01", &["1", "2"]), "P01: 4 values needed, but 2 typed");
        let joined = Changes::read("P01", &body("P01"), &Letters::USUAL, &["5,0,0,0".to_owned()]).unwrap_err();
        assert_eq!(joined.hint.unwrap(), "type blanks between the values: 5 0 0 0");
        assert_eq!(
            error("P01", &["9000", "0", "0", "0"]),
            "P01: ax1: 9000.00 is out of range (a number, -8000.00 to 8000.00 mm)"
        );
        assert_eq!(error("P08", &["lwo=1"]), "P08: unknown value 'lwo'; did you mean low?");
        assert_eq!(error("P08", &["low=1", "low=2"]), "P08: low appears twice");
        assert_eq!(error("P08", &["low=1", "2"]), "P08: '2' has no name, but other values have names");
        assert_eq!(error("M09", &["french"]), "M09: language: 'french' is not J (japanese) or E (english)");
        assert_eq!(error("M01", &["3"]), "M01: port: '3' is not STATION/PORT/BIT, such as 0/01/3");
        assert!(error("M01", &["9/01/3"]).starts_with("M01: station: 9 is out of range"));
    }

    #[test]
    fn values_are_shown_as_they_are_typed() {
        let line = |name: &str, text: &str| in_a_line(&named_values(&body(name).parse(text).unwrap()));
        assert_eq!(line("P08", "L=010.0 H=100.0"), "low=10.0 high=100.0 mm/s");
        assert_eq!(line("M01", "0/01/3"), "0/01/3");
        assert_eq!(line("M09", "E"), "E (English)");
        assert_eq!(line("M16", "10"), "10 m");
        assert_eq!(line("P13", "AX1<=-0100.00 0/01/3"), "compare=<= (at most) place=-100.00 mm port=0/01/3");
        let [low, _] = &named_values(&body("P08").parse("L=010.5 H=100.0").unwrap())[..] else { panic!() };
        assert_eq!((&low.value, low.unit, &low.raw[..]), (&Json::from(10.5), Some("mm/s"), "010.5"));
    }
}
