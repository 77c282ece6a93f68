//! Screen of one robot: indicators, alarms, axes as bars with charts, signals.

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::chart::{self, Chart};
use super::{answer, format_interval};
use crate::command::fleet::top::model::{Contact, Model, Moment, RobotRow};
use crate::command::fleet::top::track::Track;
use armctl_frame::face::sample::{Axis, Bank, Indicator, Sample, Whole};
use armctl_frame::output::painter::{Painter, line_of, rest_after, width, wrap};
use armctl_frame::output::view::Tone;
use armctl_frame::robot::alarm::Alarm;

/// Width of the axes next to a chart. `CHART` is the minimum width of a chart.
const AXES: u16 = 46;
const CHART: u16 = 24;
/// Screen height from which the parts are separated by empty lines.
const MIN_SPACED_HEIGHT: u16 = 28;
/// Minimum height of a chart.
const CHART_LINES: u16 = 5;

/// First line: name, state, answer time.
pub fn head(painter: &mut Painter<'_>, line: Rect, model: &Model, seen: &RobotRow, now: Moment) {
    let (answered, style) = answer(painter, seen, now, model.every);
    let quiet = painter.palette.quiet();
    let parts = [
        (" ", quiet),
        (seen.name.as_str(), painter.palette.accent()),
        ("  ", quiet),
        (seen.family.name(), Style::new()),
        ("  answer ", quiet),
        (answered.as_str(), style),
        ("  ", quiet),
        (seen.place.as_str(), quiet),
    ];
    painter.draw_parts(Rect { width: line.width.saturating_sub(14), ..line }, &parts);
    format_interval(painter, line, model);
}

/// The rest of the screen, from the top, as far as there is room.
pub fn body(painter: &mut Painter<'_>, area: Rect, model: &Model, seen: &RobotRow, now: Moment) {
    let Some(sample) = seen.sample() else { return draw_fault(painter, area, seen) };
    let Some(whole) = &sample.full else {
        let why = if model.is_paused() {
            "no details were read before the pause; press Space to continue"
        } else {
            "looking"
        };
        painter.draw_left(rest_after(line_of(area, 1), 2), why, painter.palette.quiet());
        return;
    };
    let mut rest = area;
    // Empty lines, if there is room.
    let spacing = u16::from(area.height >= MIN_SPACED_HEIGHT);
    rest = rows_below(rest, spacing);
    rest = rows_below(rest, indicators(painter, rest, &whole.indicators) + spacing);
    rest = rows_below(rest, alarms(painter, rest, sample) + spacing);
    let signals = if model.has_signals { signal_lines(&whole.banks, rest.width) } else { 0 };
    let needed = u16::try_from(whole.axes.len()).unwrap_or(u16::MAX).saturating_add(1).max(if whole.axes.is_empty() {
        2
    } else {
        2 * (CHART_LINES + 1)
    });
    // Axes have priority; signals are shown completely or not at all.
    let has_signals = signals > 0 && rest.height >= needed.min(8).saturating_add(signals);
    let middle = rest.height.saturating_sub(if has_signals { signals } else { 0 });
    let middle_area = Rect { height: middle, ..rest };
    axes(painter, middle_area, model, seen, whole, now);
    if has_signals {
        banks(painter, rows_below(rest, middle), &whole.banks);
    }
}

/// Draws the reason for missing data.
fn draw_fault(painter: &mut Painter<'_>, area: Rect, seen: &RobotRow) {
    let Contact::Unreachable(failure) = &seen.contact else {
        painter.draw_left(rest_after(line_of(area, 1), 2), "waiting for the first answer", painter.palette.quiet());
        return;
    };
    let mut line = 1;
    let bad = painter.palette.tone(Tone::Bad);
    let hint = failure.hint.as_ref().map(|hint| (format!("hint: {hint}"), Style::new()));
    for (text, style) in [(failure.message.clone(), bad)].into_iter().chain(hint) {
        for part in wrap(&text, usize::from(area.width.saturating_sub(4))) {
            painter.draw_left(rest_after(line_of(area, line), 2), &part, style);
            line += 1;
        }
        line += 1;
    }
    painter.draw_left(rest_after(line_of(area, line), 2), "armctl keeps trying.", painter.palette.quiet());
}

/// Draws the indicators in columns. Returns the number of lines.
fn indicators(painter: &mut Painter<'_>, area: Rect, indicators: &[Indicator]) -> u16 {
    let widest = indicators.iter().map(|indicator| width(indicator.name)).max().unwrap_or_default();
    let columns = u16::try_from(widest).unwrap_or_default() + 3;
    let across = (area.width.saturating_sub(1) / columns).max(1);
    for (at, indicator) in (0..).zip(indicators) {
        let row_area = rest_after(line_of(area, at / across), 1 + at % across * columns);
        let style = light(painter, indicator.is_on, indicator.tone);
        let name = if indicator.is_on || indicator.tone != Tone::Plain { style } else { painter.palette.quiet() };
        painter.draw_parts(row_area, &[(sign(indicator.is_on), style), (" ", style), (indicator.name, name)]);
    }
    u16::try_from(indicators.len()).unwrap_or(u16::MAX).div_ceil(across)
}

fn sign(is_on: bool) -> &'static str {
    if is_on { "●" } else { "○" }
}

fn light(painter: &Painter<'_>, is_on: bool, tone: Tone) -> Style {
    match (is_on, tone) {
        (false, Tone::Plain) => painter.palette.quiet(),
        (true, Tone::Plain) => Style::new().add_modifier(Modifier::BOLD),
        (_, tone) => painter.palette.tone(tone),
    }
}

/// Draws the alarms with remedies. Returns the number of lines.
fn alarms(painter: &mut Painter<'_>, area: Rect, sample: &Sample) -> u16 {
    let bad = painter.palette.tone(Tone::Bad);
    let line = &sample.line;
    if sample.alarms.is_empty() {
        let (text, style) = match line.fault_text() {
            Some(what) => (format!(" {what}; the controller does not report which alarm"), bad),
            None => (" no alarm".to_owned(), painter.palette.quiet()),
        };
        painter.draw_left(line_of(area, 0), &text, style);
        return 1;
    }
    let mut taken = 0;
    for Alarm { code, text, remedy, .. } in &sample.alarms {
        let place = line_of(area, taken);
        let [code, text] = [code, text].map(|text| text.as_deref().unwrap_or("?"));
        let columns = painter.draw_parts(place, &[(" ", bad), (code, bad), ("  ", bad), (text, bad)]);
        if let Some(remedy) = remedy {
            painter.draw_parts(rest_after(place, columns + 2), &[(remedy, Style::new())]);
        }
        taken += 1;
    }
    taken
}

/// Draws the axes on the left, and charts of the selected axis on the right.
fn axes(painter: &mut Painter<'_>, area: Rect, model: &Model, seen: &RobotRow, whole: &Whole, now: Moment) {
    if whole.axes.is_empty() {
        let why = whole.not_asked.unwrap_or("the controller does not report its position");
        for (line, part) in (1..).zip(wrap(why, usize::from(area.width.saturating_sub(2)))) {
            painter.draw_left(rest_after(line_of(area, line), 1), &part, painter.palette.quiet());
        }
        return;
    }
    let has_chart = area.width >= AXES + CHART;
    let columns = if has_chart { AXES.max(area.width * 2 / 5) } else { area.width };
    let chosen = model.axis.min(whole.axes.len() - 1);
    let left = Rect { width: columns, ..area };
    table(painter, left, whole, &seen.tracks, chosen);
    if !has_chart {
        return;
    }
    let right = Rect { x: area.x + columns + 2, width: area.width - columns - 2, ..area };
    let (Some(axis), Some(track)) = (whole.axes.get(chosen), seen.tracks.get(chosen)) else { return };
    let has_torque = whole.torque_unit.filter(|_| !track.torques.is_empty());
    let lines = if has_torque.is_some() { area.height / 2 } else { area.height };
    let position =
        Chart { subject: &axis.name, what: axis.unit, decimals: axis.decimals.min(1), points: &track.positions };
    let what = format!("torque, {}", has_torque.unwrap_or_default());
    let torque = Chart { subject: &axis.name, what: &what, decimals: 0, points: &track.torques };
    // The same scale width for both charts, so that equal times are aligned.
    let side = if has_torque.is_some() { position.side().max(torque.side()) } else { position.side() };
    chart::draw(painter, Rect { height: lines, ..right }, &position, side, now, model.every);
    if has_torque.is_some() {
        chart::draw(painter, rows_below(right, lines), &torque, side, now, model.every);
    }
}

/// One line per axis: name, position, bar, torque.
fn table(painter: &mut Painter<'_>, area: Rect, whole: &Whole, tracks: &[Track], chosen: usize) {
    const NAME: u16 = 4;
    const POSITION: u16 = 11;
    const UNIT: u16 = 7;
    const TORQUE: u16 = 8;
    let torque = if whole.torque_unit.is_some() { TORQUE } else { 0 };
    let bar = area.width.saturating_sub(1 + NAME + POSITION + 1 + UNIT + torque + 1);
    let position_at = 1 + NAME;
    let bar_at = position_at + POSITION + 1 + UNIT;
    let part = |line: Rect, at: u16, columns: u16| {
        let place = rest_after(line, at);
        Rect { width: columns.min(place.width), ..place }
    };
    let heading = line_of(area, 0);
    let style = painter.palette.heading();
    let by_limits = whole.axes.iter().any(|axis| axis.limits.is_some());
    painter.paint(heading, style);
    painter.draw_left(part(heading, 1, NAME), "AXIS", style);
    painter.draw_right(part(heading, position_at, POSITION), "POSITION", style);
    painter.draw_left(part(heading, bar_at, bar), if by_limits { "SOFT LIMITS" } else { "RANGE SEEN" }, style);
    painter.draw_right(part(heading, bar_at + bar, torque), "TORQUE", style);
    // Scroll so that the selected axis is visible.
    let lines = usize::from(area.height.saturating_sub(1));
    let first = (chosen + 1).saturating_sub(lines);
    for (line, (index, axis)) in (1..area.height).zip(whole.axes.iter().enumerate().skip(first)) {
        let line = line_of(area, line);
        let is_chosen = index == chosen;
        if is_chosen {
            painter.draw_left(part(line, 0, 1), "▌", painter.palette.accent());
        }
        let style = if is_chosen { Style::new().add_modifier(Modifier::BOLD) } else { Style::new() };
        painter.draw_left(part(line, 1, NAME), &axis.name, style);
        painter.draw_right(part(line, position_at, POSITION), &number(axis.position, axis.decimals), style);
        painter.draw_left(part(line, position_at + POSITION + 1, UNIT), axis.unit, painter.palette.quiet());
        let seen = tracks.get(index).map_or((axis.position, axis.position), |track| track.range);
        gauge(painter, part(line, bar_at, bar), axis, seen);
        if let Some(value) = axis.torque {
            painter.draw_right(part(line, bar_at + bar, torque), &number(value, 0), style);
        }
    }
}

/// Draws the position of an axis between its limits, or in the range seen so far.
fn gauge(painter: &mut Painter<'_>, place: Rect, axis: &Axis, seen: (f64, f64)) {
    let (least, most) = axis.limits.unwrap_or(seen);
    let columns = place.width;
    let share = if most > least { ((axis.position - least) / (most - least)).clamp(0.0, 1.0) } else { 0.0 };
    let filled = (0..columns).filter(|column| f64::from(*column) + 0.5 < share * f64::from(columns)).count();
    let is_beyond = axis.limits.is_some_and(|(least, most)| !(least..=most).contains(&axis.position));
    let tone = if is_beyond { Tone::Bad } else { Tone::Good };
    let full = "█".repeat(filled);
    let empty = "░".repeat(usize::from(columns) - filled);
    let (style, quiet) = (painter.palette.tone(tone), painter.palette.quiet());
    painter.draw_parts(place, &[(&full, style), (&empty, quiet)]);
}

/// Number of lines for the signals with their heading.
fn signal_lines(banks: &[Bank], columns: u16) -> u16 {
    let lines: u16 = banks.iter().map(|bank| bank_lines(bank, columns)).sum();
    if lines == 0 { 0 } else { lines + 1 }
}

/// Width of the name of a bank. `BANK_WIDTH` is the width of eight signals with their label.
const BANK: u16 = 9;
const BANK_WIDTH: u16 = 17;

fn bank_lines(bank: &Bank, columns: u16) -> u16 {
    let across = (columns.saturating_sub(BANK) / BANK_WIDTH).max(1);
    u16::try_from(bank.groups.len()).unwrap_or(u16::MAX).div_ceil(across)
}

/// Draws the signals, one indicator each.
fn banks(painter: &mut Painter<'_>, area: Rect, banks: &[Bank]) {
    let heading = line_of(area, 0);
    painter.paint(heading, painter.palette.heading());
    painter.draw_left(rest_after(heading, 1), "SIGNALS", painter.palette.heading());
    let mut first = 1;
    for bank in banks {
        let across = (area.width.saturating_sub(BANK) / BANK_WIDTH).max(1);
        painter.draw_left(rest_after(line_of(area, first), 1), bank.name, painter.palette.quiet());
        for (at, eight) in (0..).zip(&bank.groups) {
            let place = rest_after(line_of(area, first + at / across), BANK + at % across * BANK_WIDTH);
            let label = Rect { width: place.width.min(6), ..place };
            painter.draw_right(label, &eight.label, painter.palette.quiet());
            let on = painter.palette.tone(Tone::Good);
            let off = painter.palette.quiet();
            for (at, is_on) in (0..).zip(eight.signals) {
                let cell = rest_after(place, 7 + at);
                painter.draw_left(Rect { width: cell.width.min(1), ..cell }, sign(is_on), if is_on { on } else { off });
            }
        }
        first += bank_lines(bank, area.width);
    }
}

/// A number with fixed decimals.
fn number(value: f64, decimals: u8) -> String {
    format!("{value:.*}", usize::from(decimals))
}

/// The part of an area below `lines` lines.
fn rows_below(area: Rect, lines: u16) -> Rect {
    let lines = lines.min(area.height);
    Rect { y: area.y + lines, height: area.height - lines, ..area }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn computes_the_lines_of_signals() {
        let bank =
            |groups| Bank { name: "inputs", groups: vec![armctl_frame::face::sample::SignalByte::default(); groups] };
        assert_eq!(signal_lines(&[bank(4), bank(4)], 80), 3);
        assert_eq!(signal_lines(&[bank(4), bank(4)], 50), 5);
        assert_eq!(signal_lines(&[bank(0)], 80), 0);
    }
}
