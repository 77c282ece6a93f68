//! Conversion of a sample to Sparkplug metrics with types and units.

use serde_json::Value as Json;
use srad_types::payload::metric::Value;
use srad_types::payload::property_value::Value as Property;
use srad_types::payload::{DataType, Metric, PropertySet, PropertyValue};

use super::super::Kind;
use super::super::extra_topic::ExtraTopic;
use crate::command::fleet::poll::PollResult;
use armctl_frame::face::sample::Whole;
use armctl_frame::robot::state::Mode;

/// Limit of metrics per extra command.
const MAX_METRICS: usize = 2000;
/// Limit of nesting levels in the result of an extra command.
const MAX_DEPTH: usize = 8;

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
pub fn metrics_of_poll(look: &PollResult, kinds: &[Kind], also: &[ExtraTopic]) -> Vec<Metric> {
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
            let mut found = Vec::new();
            flatten(also.level(), data, 0, &mut found);
            metrics.extend(found);
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
    metric.properties = unit(name).map(|unit| PropertySet {
        keys: vec!["engUnit".to_owned()],
        values: vec![PropertyValue {
            r#type: Some(DataType::String as u32),
            is_null: None,
            value: Some(Property::StringValue(unit.to_owned())),
        }],
    });
    metric
}

fn unit(name: &str) -> Option<&'static str> {
    let found = UNITS.iter().filter(|(end, _)| name.ends_with(end));
    found.max_by_key(|(end, _)| end.len()).map(|(_, unit)| *unit)
}

/// Converts every value of a report, with its path as name. List items use their names if they have some. Null has no
/// type and is skipped.
fn flatten(path: &str, data: &Json, depth: usize, metrics: &mut Vec<Metric>) {
    if metrics.len() >= MAX_METRICS || depth > MAX_DEPTH {
        return;
    }
    let (kind, value) = match data {
        Json::Null => return,
        Json::Object(fields) => {
            return fields.iter().for_each(|(name, data)| flatten(&format!("{path}/{name}"), data, depth + 1, metrics));
        }
        Json::Array(items) => {
            for (at, item) in items.iter().enumerate() {
                let name = item.get("name").and_then(Json::as_str).filter(|name| !name.is_empty());
                let name = name.map_or_else(|| at.to_string(), ToOwned::to_owned);
                flatten(&format!("{path}/{name}"), item, depth + 1, metrics);
            }
            return;
        }
        Json::Bool(flag) => (DataType::Boolean, Value::BooleanValue(*flag)),
        Json::String(text) => (DataType::String, Value::StringValue(text.clone())),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => (DataType::Int64, Value::LongValue(whole.cast_unsigned())),
            None => (DataType::Double, Value::DoubleValue(number.as_f64().unwrap_or(f64::NAN))),
        },
    };
    metrics.push(metric(path, kind, Some(value)));
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use armctl_frame::face::sample::Axis;

    #[test]
    fn converts_a_report_to_metrics_with_types_and_units() {
        let data =
            json!({"values": [{"name": "B0", "value": -3, "ok": true}, {"value": 1.5, "x_mm": 2.0}], "why": null});
        let mut metrics = Vec::new();
        flatten("parts", &data, 0, &mut metrics);
        let metrics_text: Vec<String> = metrics
            .iter()
            .map(|metric| {
                format!("{} {:?} {:?}", metric.name.clone().unwrap(), metric.datatype, metric.value.clone().unwrap())
            })
            .collect();
        assert_eq!(
            metrics_text,
            [
                "parts/values/B0/name Some(12) StringValue(\"B0\")",
                "parts/values/B0/value Some(4) LongValue(18446744073709551613)",
                "parts/values/B0/ok Some(11) BooleanValue(true)",
                "parts/values/1/value Some(10) DoubleValue(1.5)",
                "parts/values/1/x_mm Some(10) DoubleValue(2.0)",
            ]
        );
        assert!(metrics[4].properties.as_ref().is_some_and(|set| set.keys == ["engUnit"]));
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

    #[test]
    fn limits_the_metrics_of_a_report() {
        let mut metrics = Vec::new();
        flatten("a", &Json::Array(vec![json!(1); 10_000]), 0, &mut metrics);
        assert_eq!(metrics.len(), MAX_METRICS);
        let deep = (0..100).fold(json!(1), |inner, _| json!({ "a": inner }));
        metrics.clear();
        flatten("a", &deep, 0, &mut metrics);
        assert!(metrics.is_empty());
    }
}
