//! The screen of one robot: lamps, alarms, axes as bars with charts beside them, signals.

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::chart::{self, Chart};
use super::pen::{Pen, after, line_of, width};
use super::{answer, pace};
use crate::command::face::sample::{Alarm, Axis, Bank, Lamp, Sample, Whole};
use crate::command::fleet::top::model::{Contact, Model, Moment, Seen};
use crate::command::fleet::top::track::Track;
use crate::output::view::Tone;

/// Columns of the axes beside a chart, and the least that a chart gets.
const AXES: u16 = 46;
const CHART: u16 = 24;
/// Lines from which on there are empty ones between the parts.
const AIRY: u16 = 28;
/// The least lines of a chart.
const CHART_LINES: u16 = 5;

/// The first line: who, how, and how fast it answers.
pub fn head(pen: &mut Pen<'_>, line: Rect, model: &Model, seen: &Seen, now: Moment) {
    let (answered, style) = answer(pen, seen, now, model.every);
    let quiet = pen.palette.quiet();
    let parts = [
        (" ", quiet),
        (seen.name.as_str(), pen.palette.accent()),
        ("  ", quiet),
        (seen.family.name(), Style::new()),
        ("  answer ", quiet),
        (answered.as_str(), style),
        ("  ", quiet),
        (seen.place.as_str(), quiet),
    ];
    pen.parts(Rect { width: line.width.saturating_sub(14), ..line }, &parts);
    pace(pen, line, model);
}

/// Everything else, from the top to where there is no room.
pub fn body(pen: &mut Pen<'_>, area: Rect, model: &Model, seen: &Seen, now: Moment) {
    let Some(sample) = seen.sample() else { return trouble(pen, area, seen) };
    let Some(whole) = &sample.whole else {
        let why = if model.is_paused() { "not looked at in full before the pause; Space goes on" } else { "looking" };
        pen.left(after(line_of(area, 1), 2), why, pen.palette.quiet());
        return;
    };
    let mut rest = area;
    // Air, where there is room for it.
    let air = u16::from(area.height >= AIRY);
    rest = below(rest, air);
    rest = below(rest, lamps(pen, rest, &whole.lamps) + air);
    rest = below(rest, alarms(pen, rest, sample) + air);
    let signals = signal_lines(&whole.banks, rest.width);
    let wanted = u16::try_from(whole.axes.len()).unwrap_or(u16::MAX).saturating_add(1).max(if whole.axes.is_empty() {
        2
    } else {
        2 * (CHART_LINES + 1)
    });
    // Axes come first; signals are whole or not there.
    let has_signals = signals > 0 && rest.height >= wanted.min(8).saturating_add(signals);
    let middle = rest.height.saturating_sub(if has_signals { signals } else { 0 });
    let middle_area = Rect { height: middle, ..rest };
    axes(pen, middle_area, model, seen, whole, now);
    if has_signals {
        banks(pen, below(rest, middle), &whole.banks);
    }
}

/// Why there is nothing to see.
fn trouble(pen: &mut Pen<'_>, area: Rect, seen: &Seen) {
    let Contact::Fails(failure) = &seen.contact else {
        pen.left(after(line_of(area, 1), 2), "waiting for the first answer", pen.palette.quiet());
        return;
    };
    let mut line = 1;
    let bad = pen.palette.tone(Tone::Bad);
    let hint = failure.hint.as_ref().map(|hint| (format!("hint: {hint}"), Style::new()));
    for (text, style) in [(failure.message.clone(), bad)].into_iter().chain(hint) {
        for part in wrapped(&text, usize::from(area.width.saturating_sub(4))) {
            pen.left(after(line_of(area, line), 2), &part, style);
            line += 1;
        }
        line += 1;
    }
    pen.left(after(line_of(area, line), 2), "It is asked again and again.", pen.palette.quiet());
}

/// The lamps, in columns; returns the lines that they took.
fn lamps(pen: &mut Pen<'_>, area: Rect, lamps: &[Lamp]) -> u16 {
    let widest = lamps.iter().map(|lamp| width(lamp.name)).max().unwrap_or_default();
    let columns = u16::try_from(widest).unwrap_or_default() + 3;
    let across = (area.width.saturating_sub(1) / columns).max(1);
    for (at, lamp) in (0..).zip(lamps) {
        let place = after(line_of(area, at / across), 1 + at % across * columns);
        let style = light(pen, lamp.is_on, lamp.tone);
        let name = if lamp.is_on || lamp.tone != Tone::Plain { style } else { pen.palette.quiet() };
        pen.parts(place, &[(sign(lamp.is_on), style), (" ", style), (lamp.name, name)]);
    }
    u16::try_from(lamps.len()).unwrap_or(u16::MAX).div_ceil(across)
}

fn sign(is_on: bool) -> &'static str {
    if is_on { "●" } else { "○" }
}

fn light(pen: &Pen<'_>, is_on: bool, tone: Tone) -> Style {
    match (is_on, tone) {
        (false, Tone::Plain) => pen.palette.quiet(),
        (true, Tone::Plain) => Style::new().add_modifier(Modifier::BOLD),
        (_, tone) => pen.palette.tone(tone),
    }
}

/// Alarms with what to do about them; returns the lines that they took.
fn alarms(pen: &mut Pen<'_>, area: Rect, sample: &Sample) -> u16 {
    let bad = pen.palette.tone(Tone::Bad);
    let line = &sample.line;
    if sample.alarms.is_empty() {
        let (text, style) = match (line.alarm, line.error) {
            (Some(true), _) => (" an alarm; which one is not told here", bad),
            (_, Some(true)) => (" an error; which one is not told here", bad),
            _ => (" no alarm", pen.palette.quiet()),
        };
        pen.left(line_of(area, 0), text, style);
        return 1;
    }
    let mut taken = 0;
    for Alarm { code, text, remedy } in &sample.alarms {
        let place = line_of(area, taken);
        let columns = pen.parts(place, &[(" ", bad), (code, bad), ("  ", bad), (text, bad)]);
        if !remedy.is_empty() {
            pen.parts(after(place, columns + 2), &[(remedy, Style::new())]);
        }
        taken += 1;
    }
    taken
}

/// Axes on the left, and the past of the chosen one on the right.
fn axes(pen: &mut Pen<'_>, area: Rect, model: &Model, seen: &Seen, whole: &Whole, now: Moment) {
    if whole.axes.is_empty() {
        let why = whole.not_asked.unwrap_or("the controller does not tell its position");
        for (line, part) in (1..).zip(wrapped(why, usize::from(area.width.saturating_sub(2)))) {
            pen.left(after(line_of(area, line), 1), &part, pen.palette.quiet());
        }
        return;
    }
    let has_chart = area.width >= AXES + CHART;
    let columns = if has_chart { AXES.max(area.width * 2 / 5) } else { area.width };
    let chosen = model.axis.min(whole.axes.len() - 1);
    let left = Rect { width: columns, ..area };
    table(pen, left, whole, &seen.tracks, chosen);
    if !has_chart {
        return;
    }
    let right = Rect { x: area.x + columns + 2, width: area.width - columns - 2, ..area };
    let (Some(axis), Some(track)) = (whole.axes.get(chosen), seen.tracks.get(chosen)) else { return };
    let has_torque = whole.torque_unit.filter(|_| !track.torques.is_empty());
    let lines = if has_torque.is_some() { area.height / 2 } else { area.height };
    let position = Chart { of: &axis.name, what: axis.unit, decimals: axis.decimals.min(1), points: &track.positions };
    let what = format!("torque, {}", has_torque.unwrap_or_default());
    let torque = Chart { of: &axis.name, what: &what, decimals: 0, points: &track.torques };
    // Both have their numbers in the same columns, so that what happened at the same time stands above each other.
    let side = if has_torque.is_some() { position.side().max(torque.side()) } else { position.side() };
    chart::draw(pen, Rect { height: lines, ..right }, &position, side, now, model.every);
    if has_torque.is_some() {
        chart::draw(pen, below(right, lines), &torque, side, now, model.every);
    }
}

/// A line an axis: name, position, a bar, torque.
fn table(pen: &mut Pen<'_>, area: Rect, whole: &Whole, tracks: &[Track], chosen: usize) {
    const NAME: u16 = 4;
    const POSITION: u16 = 11;
    const UNIT: u16 = 7;
    const TORQUE: u16 = 8;
    let torque = if whole.torque_unit.is_some() { TORQUE } else { 0 };
    let bar = area.width.saturating_sub(1 + NAME + POSITION + 1 + UNIT + torque + 1);
    let position_at = 1 + NAME;
    let bar_at = position_at + POSITION + 1 + UNIT;
    let part = |line: Rect, at: u16, columns: u16| {
        let place = after(line, at);
        Rect { width: columns.min(place.width), ..place }
    };
    let heading = line_of(area, 0);
    let style = pen.palette.heading();
    let by_limits = whole.axes.iter().any(|axis| axis.limits.is_some());
    pen.paint(heading, style);
    pen.left(part(heading, 1, NAME), "AXIS", style);
    pen.right(part(heading, position_at, POSITION), "POSITION", style);
    pen.left(part(heading, bar_at, bar), if by_limits { "SOFT LIMITS" } else { "RANGE SEEN" }, style);
    pen.right(part(heading, bar_at + bar, torque), "TORQUE", style);
    // The chosen one is in sight.
    let lines = usize::from(area.height.saturating_sub(1));
    let first = (chosen + 1).saturating_sub(lines);
    for (line, (index, axis)) in (1..area.height).zip(whole.axes.iter().enumerate().skip(first)) {
        let line = line_of(area, line);
        let is_chosen = index == chosen;
        if is_chosen {
            pen.left(part(line, 0, 1), "▌", pen.palette.accent());
        }
        let style = if is_chosen { Style::new().add_modifier(Modifier::BOLD) } else { Style::new() };
        pen.left(part(line, 1, NAME), &axis.name, style);
        pen.right(part(line, position_at, POSITION), &number(axis.position, axis.decimals), style);
        pen.left(part(line, position_at + POSITION + 1, UNIT), axis.unit, pen.palette.quiet());
        let seen = tracks.get(index).map_or((axis.position, axis.position), |track| track.range);
        gauge(pen, part(line, bar_at, bar), axis, seen);
        if let Some(value) = axis.torque {
            pen.right(part(line, bar_at + bar, torque), &number(value, 0), style);
        }
    }
}

/// Where an axis is between its limits, or in the range that was seen.
fn gauge(pen: &mut Pen<'_>, place: Rect, axis: &Axis, seen: (f64, f64)) {
    let (least, most) = axis.limits.unwrap_or(seen);
    let columns = place.width;
    let share = if most > least { ((axis.position - least) / (most - least)).clamp(0.0, 1.0) } else { 0.0 };
    let filled = (0..columns).filter(|column| f64::from(*column) + 0.5 < share * f64::from(columns)).count();
    let is_beyond = axis.limits.is_some_and(|(least, most)| !(least..=most).contains(&axis.position));
    let tone = if is_beyond { Tone::Bad } else { Tone::Good };
    let full = "█".repeat(filled);
    let empty = "░".repeat(usize::from(columns) - filled);
    let (style, quiet) = (pen.palette.tone(tone), pen.palette.quiet());
    pen.parts(place, &[(&full, style), (&empty, quiet)]);
}

/// Lines that the signals take, with their heading.
fn signal_lines(banks: &[Bank], columns: u16) -> u16 {
    let lines: u16 = banks.iter().map(|bank| bank_lines(bank, columns)).sum();
    if lines == 0 { 0 } else { lines + 1 }
}

/// Columns of the name of a bank, and of eight signals with their label.
const BANK: u16 = 9;
const EIGHT: u16 = 17;

fn bank_lines(bank: &Bank, columns: u16) -> u16 {
    let across = (columns.saturating_sub(BANK) / EIGHT).max(1);
    u16::try_from(bank.groups.len()).unwrap_or(u16::MAX).div_ceil(across)
}

/// The signals, a lamp each.
fn banks(pen: &mut Pen<'_>, area: Rect, banks: &[Bank]) {
    let heading = line_of(area, 0);
    pen.paint(heading, pen.palette.heading());
    pen.left(after(heading, 1), "SIGNALS", pen.palette.heading());
    let mut first = 1;
    for bank in banks {
        let across = (area.width.saturating_sub(BANK) / EIGHT).max(1);
        pen.left(after(line_of(area, first), 1), bank.name, pen.palette.quiet());
        for (at, eight) in (0..).zip(&bank.groups) {
            let place = after(line_of(area, first + at / across), BANK + at % across * EIGHT);
            let label = Rect { width: place.width.min(6), ..place };
            pen.right(label, &eight.label, pen.palette.quiet());
            let on = pen.palette.tone(Tone::Good);
            let off = pen.palette.quiet();
            for (at, is_on) in (0..).zip(eight.signals) {
                let cell = after(place, 7 + at);
                pen.left(Rect { width: cell.width.min(1), ..cell }, sign(is_on), if is_on { on } else { off });
            }
        }
        first += bank_lines(bank, area.width);
    }
}

/// A number with so many digits behind the point.
fn number(value: f64, decimals: u8) -> String {
    format!("{value:.*}", usize::from(decimals))
}

/// What is left of an area below so many lines.
fn below(area: Rect, lines: u16) -> Rect {
    let lines = lines.min(area.height);
    Rect { y: area.y + lines, height: area.height - lines, ..area }
}

/// A text in lines of so many columns, broken between words.
fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last().map_or(0, |line| width(line));
        match lines.last_mut() {
            Some(line) if line.is_empty() || last + 1 + width(word) <= columns => {
                line.push_str(if line.is_empty() { "" } else { " " });
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_broken_between_words() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("immeasurable", 3), ["immeasurable"]);
        assert_eq!(wrapped("", 3), [""]);
    }

    #[test]
    fn signals_take_as_many_lines_as_they_need() {
        let bank =
            |groups| Bank { name: "inputs", groups: vec![crate::command::face::sample::Eight::default(); groups] };
        assert_eq!(signal_lines(&[bank(4), bank(4)], 80), 3);
        assert_eq!(signal_lines(&[bank(4), bank(4)], 50), 5);
        assert_eq!(signal_lines(&[bank(0)], 80), 0);
    }
}
