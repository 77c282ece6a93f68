//! Conversion of a sample to Sparkplug metrics with types and units.

use serde_json::Value as Json;
use srad_types::payload::metric::Value;
use srad_types::payload::property_value::Value as Property;
use srad_types::payload::{DataType, Metric, PropertySet, PropertyValue};

use super::super::Kind;
use crate::command::fleet::also::AlsoCommand;
use crate::command::fleet::poll::PollResult;
use crate::command::fleet::report_values::{ReportValue, values_of_report};
use armctl_frame::face::sample::Whole;
use armctl_frame::robot::state::Mode;

/// Units by name suffix, as in reports.
const UNITS: [(&str, &str); 9] = [
    ("_mm", "mm"),
    ("_um", "µm"),
    ("_deg", "°"),
    ("_percent", "%"),
    ("_mm_s", "mm/s"),
    ("_deg_s", "°/s"),
    ("_ms", "ms"),
    ("_s", "s"),
    ("_pulses", "pulses"),
];

/// All metrics of a sample, for these kinds and extra commands.
pub fn metrics_of_poll(look: &PollResult, kinds: &[Kind], also: &[AlsoCommand]) -> Vec<Metric> {
    let line = &look.sample.line.state;
    let text = |text: Option<&str>| text.map(|text| Value::StringValue(text.to_owned()));
    let flag = |flag: Option<bool>| flag.map(Value::BooleanValue);
    let mut metrics = Vec::new();
    for kind in kinds {
        match kind {
            Kind::Status => metrics.extend([
                metric("status/mode", DataType::String, text(line.mode.map(Mode::name))),
                metric("status/controller_mode", DataType::String, text(line.controller_mode)),
                metric("status/servo_on", DataType::Boolean, flag(line.servo_on)),
                metric("status/running", DataType::Boolean, flag(line.running)),
                metric("status/held", DataType::Boolean, flag(line.held)),
                metric("status/homed", DataType::Boolean, flag(line.homed)),
                metric("status/emergency_stop", DataType::Boolean, flag(line.emergency_stop)),
                metric("status/faulted", DataType::Boolean, flag(line.fault.faulted)),
                metric("status/fault_code", DataType::String, text(line.fault.fault_code.as_deref())),
                metric("status/fault_text", DataType::String, text(line.fault.fault_text.as_deref())),
                metric("status/program", DataType::String, text(line.program.as_deref())),
                metric(
                    "status/speed_override_percent",
                    DataType::Double,
                    line.speed_override_percent.map(Value::DoubleValue),
                ),
            ]),
            Kind::Alarms => {
                let alarms = &look.sample.alarms;
                let count = u32::try_from(alarms.len()).unwrap_or(u32::MAX);
                let codes = alarms.iter().filter_map(|alarm| alarm.code.as_deref());
                let codes = codes.collect::<Vec<_>>().join(",");
                metrics.extend([
                    metric("alarms/count", DataType::Int32, Some(Value::IntValue(count))),
                    metric("alarms/codes", DataType::String, Some(Value::StringValue(codes))),
                ]);
            }
            Kind::Position => {
                let at = line.position;
                let axes = [
                    ("position/x_mm", at.map(|at| at.x_mm)),
                    ("position/y_mm", at.map(|at| at.y_mm)),
                    ("position/z_mm", at.map(|at| at.z_mm)),
                ];
                metrics.extend(axes.map(|(name, value)| metric(name, DataType::Double, value.map(Value::DoubleValue))));
            }
            Kind::Axes => metrics.extend(look.sample.full.iter().flat_map(axes)),
        }
    }
    metrics.extend([
        metric("info/family", DataType::String, text(Some(look.robot.family.name()))),
        metric("info/target", DataType::String, text(Some(look.robot.target.value.url()))),
        metric("info/simulated", DataType::Boolean, flag(Some(look.robot.target.value.is_simulated()))),
    ]);
    let place = look.robot.place.levels();
    metrics.extend(place.map(|(key, value)| metric(&format!("info/{key}"), DataType::String, text(value))));
    for (line, answer) in &look.extras {
        if let (Some(also), Ok(data)) = (also.iter().find(|also| also.text() == &**line), answer) {
            metrics.extend(values_of_report(also.name(), data).iter().map(metric_of_value));
        }
    }
    metrics
}

/// Position and torque of all axes and coordinates: `axes/S_pulses`, `axes/Rz_deg`, `axes/S_torque_percent`.
fn axes(whole: &Whole) -> Vec<Metric> {
    let mut metrics: Vec<Metric> = Vec::new();
    let mut add = |name: String, value: f64| {
        // Names of axes can come from the controller. Two metrics of a device must not have the same name.
        if metrics.iter().all(|known| known.name.as_ref() != Some(&name)) {
            metrics.push(metric(&name, DataType::Double, Some(Value::DoubleValue(value))));
        }
    };
    for axis in &whole.axes {
        add(format!("axes/{}_{}", axis.name, axis.unit), axis.position);
        if let Some(torque) = axis.torque {
            let unit = if whole.torque_unit == Some("raw") { "raw" } else { "percent" };
            add(format!("axes/{}_torque_{unit}", axis.name), torque);
        }
    }
    metrics
}

/// A metric, with a unit if its name shows a unit.
fn metric(name: &str, kind: DataType, value: Option<Value>) -> Metric {
    let mut metric = Metric::new();
    metric.set_name(name.to_owned()).set_datatype(kind);
    match value {
        Some(value) => metric.set_value(value),
        None => metric.set_null(),
    };
    metric.properties = unit(name)
        .map(|unit| PropertySet { keys: vec!["engUnit".to_owned()], values: vec![text_property(unit.to_owned())] });
    metric
}

fn unit(name: &str) -> Option<&'static str> {
    let found = UNITS.iter().filter(|(end, _)| name.ends_with(end));
    found.max_by_key(|(end, _)| end.len()).map(|(_, unit)| *unit)
}

/// Metric of a value of a report.
fn metric_of_value(value: &ReportValue<'_>) -> Metric {
    let name = &value.path;
    let mut metric = match value.value {
        Json::Bool(flag) => metric(name, DataType::Boolean, Some(Value::BooleanValue(*flag))),
        Json::String(text) => metric(name, DataType::String, Some(Value::StringValue(text.clone()))),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => metric(name, DataType::Int64, Some(Value::LongValue(whole.cast_unsigned()))),
            None => metric(name, DataType::Double, number.as_f64().map(Value::DoubleValue)),
        },
        // The node uses the type of an earlier value.
        _ => metric(name, DataType::Unknown, None),
    };
    let constants = value.constants.iter().map(|(key, constant)| {
        let key = if *key == "unit" { "engUnit" } else { key };
        (key, constant.as_str().map_or_else(|| constant.to_string(), ToOwned::to_owned))
    });
    let properties = metric.properties.get_or_insert_with(PropertySet::default);
    for (key, text) in constants {
        properties.keys.push(key.to_owned());
        properties.values.push(text_property(text));
    }
    metric.properties = metric.properties.filter(|properties| !properties.keys.is_empty());
    metric
}

fn text_property(text: String) -> PropertyValue {
    PropertyValue { r#type: Some(DataType::String as u32), is_null: None, value: Some(Property::StringValue(text)) }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use armctl_frame::face::sample::Axis;

    #[test]
    fn converts_a_report_to_metrics_with_types_and_properties() {
        let data = json!({
            "items": [
                {"name": "B0", "label": "parts", "kind": "variable", "ok": true, "value": -3},
                {"name": "B1", "label": null, "ok": false, "error": {"message": "refused"}},
            ],
            "x_mm": 2.0,
        });
        let found: Vec<Metric> = values_of_report("parts", &data).iter().map(metric_of_value).collect();
        let texts: Vec<String> = found
            .iter()
            .map(|metric| {
                let keys = metric.properties.as_ref().map_or_else(Vec::new, |set| set.keys.clone());
                format!("{} {:?} {:?} {keys:?}", metric.name.clone().unwrap(), metric.datatype.unwrap(), metric.value)
            })
            .collect();
        assert_eq!(
            texts,
            [
                r#"parts/items/B0 4 Some(LongValue(18446744073709551613)) ["label", "kind"]"#,
                "parts/items/B1 0 None []",
                r#"parts/x_mm 10 Some(DoubleValue(2.0)) ["engUnit"]"#,
            ]
        );
        assert_eq!((unit("speed_mm_s"), unit("elapsed_ms"), unit("servo_on")), (Some("mm/s"), Some("ms"), None));
    }

    #[test]
    fn each_axis_has_a_metric_for_its_position_and_torque() {
        let axis =
            |name: &str, unit, torque| Axis { name: name.to_owned(), position: 1.5, unit, torque, ..Axis::default() };
        let list = vec![axis("S", "pulses", Some(12.0)), axis("Rz", "deg", None), axis("Rz", "deg", None)];
        let found = axes(&Whole { axes: list, torque_unit: Some("% of max"), ..Whole::default() });
        let names: Vec<(&str, Option<&str>)> =
            found.iter().map(|metric| metric.name.as_deref().unwrap()).map(|name| (name, unit(name))).collect();
        assert_eq!(
            names,
            [("axes/S_pulses", Some("pulses")), ("axes/S_torque_percent", Some("%")), ("axes/Rz_deg", Some("°"))]
        );
    }
}
