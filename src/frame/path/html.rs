//! Picture of a motion as a page with a slider through time.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::model::Drawing;
use super::svg::{self, Placed, escape, number};

/// Maximum number of rows in the list of steps. The line above the picture shows every step.
const MAX_ROWS: usize = 2000;
/// Script of the page.
const SCRIPT: &str = include_str!("page.js");
/// Style of the page.
const STYLE: &str = include_str!("page.css");

/// A page that needs nothing else: no network, no other file.
pub fn page(drawing: &Drawing) -> String {
    let motion = &drawing.motion;
    let svg::Picture { body, panels, height } = svg::draw(drawing, false);
    let program = escape(&motion.program);
    let mut page = String::with_capacity(body.len() * 2);
    let _ = write!(
        page,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<meta name=\"viewport\" \
         content=\"width=device-width,initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{program}</title>\n<style>{}\n{STYLE}</style>\n</head>\n<body class=\"p-pic\">\n<main>\n<h1>{program}</h1>\n\
         <p class=\"sub\">{}</p>\n",
        svg::STYLE,
        escape(&svg::summary(drawing))
    );
    let time = if motion.is_points { "Point" } else { "Time" };
    let _ = write!(
        page,
        "<div class=\"bar\"><button id=\"play\" type=\"button\" aria-label=\"play\">▶</button><label>{time} <input \
         id=\"time\" type=\"range\" min=\"0\" max=\"1000\" value=\"0\" step=\"1\"></label><output id=\"now\"></output></div>\n\
         <p class=\"line\"><b id=\"step\"></b> <code id=\"text\"></code></p>\n"
    );
    page.push_str(&svg::head(motion, height));
    page.push_str(&body);
    for (index, placed) in panels.iter().enumerate() {
        if placed.panel.x.axis.is_none() {
            let _ = writeln!(
                page,
                "<path class=\"p-then\" id=\"then{index}\" d=\"M0 {}V{}\"/>",
                number(placed.top),
                number(placed.top + placed.height)
            );
        }
        let _ = writeln!(page, "<circle class=\"p-now\" id=\"dot{index}\" r=\"6.5\" cx=\"-99\" cy=\"-99\"/>");
    }
    page.push_str("</svg>\n");
    let remarks = svg::remarks(drawing);
    if !remarks.is_empty() {
        page.push_str("<ul class=\"notes\">\n");
        page.extend(remarks.iter().map(|remark| format!("<li>{}</li>\n", escape(remark))));
        page.push_str("</ul>\n");
    }
    page.push_str(&table(drawing));
    let _ =
        write!(page, "</main>\n<script>const path={};\n{SCRIPT}</script>\n</body>\n</html>\n", data(drawing, &panels));
    page
}

/// List of the steps.
fn table(drawing: &Drawing) -> String {
    let motion = &drawing.motion;
    let axes: String = motion.axes.iter().map(|axis| format!("<th class=\"n\">{}</th>", escape(axis))).collect();
    let time = if motion.is_timed { "<th class=\"n\">time (s)</th>" } else { "" };
    let mut table = format!(
        "<table>\n<thead><tr><th class=\"n\">#</th><th class=\"n\">{}</th><th>text</th>{time}{axes}</tr></thead>\n<tbody>\n",
        motion.noun()
    );
    for (index, step) in motion.steps.iter().take(MAX_ROWS).enumerate() {
        let target: String = step
            .target()
            .unwrap_or_default()
            .iter()
            .map(|value| format!("<td class=\"n\">{}</td>", number(*value)))
            .collect();
        let end = step.track.last().map_or(0.0, |moment| moment.time);
        let time = if motion.is_timed { format!("<td class=\"n\">{end:.2}</td>") } else { String::new() };
        let _ = writeln!(
            table,
            "<tr><td class=\"n\">{}</td><td class=\"n\">{}</td><td><code>{}</code></td>{time}{target}</tr>",
            index + 1,
            step.line,
            escape(&step.text)
        );
    }
    table.push_str("</tbody>\n</table>\n");
    if motion.steps.len() > MAX_ROWS {
        let _ =
            writeln!(table, "<p class=\"sub\">The list has the first {MAX_ROWS} of {} steps.</p>", motion.steps.len());
    }
    table
}

/// Data of the slider as JSON, which cannot end the script element.
fn data(drawing: &Drawing, panels: &[Placed]) -> String {
    let motion = &drawing.motion;
    let exact = |value: f64| (value * 1000.0).round() / 1000.0;
    let moments = motion.steps.iter().enumerate().flat_map(|(index, step)| {
        step.track.iter().map(move |moment| {
            let at = moment.at.iter().map(|value| json!(exact(*value)));
            Value::Array([json!(index), json!(exact(moment.time))].into_iter().chain(at).collect())
        })
    });
    let steps = motion.steps.iter().map(|step| json!([step.line, step.text]));
    // Each panel with its axes, and with the place of the point (0, 0) and of the unit in both directions.
    let panels = panels.iter().map(|placed| {
        let [[x0, y0], [x1, y1]] = [placed.place([0.0, 0.0]), placed.place([1.0, 1.0])];
        json!([placed.panel.x.axis, placed.panel.y.axis, x0, y0, x1 - x0, y1 - y0])
    });
    let data = json!({
        "timed": motion.is_timed,
        "points": motion.is_points,
        "end": exact(motion.end()),
        "unit": motion.unit,
        "axes": motion.axes,
        "steps": steps.collect::<Vec<_>>(),
        "moments": moments.collect::<Vec<_>>(),
        "panels": panels.collect::<Vec<_>>(),
    });
    data.to_string().replace('<', "\\u003c")
}
