//! The list: one line per robot.

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::{answer, format_interval};
use crate::command::fleet::top::model::{Contact, Model, Moment, RobotRow, Severity, Sort};
use armctl_frame::output::painter::{self, Painter, line_of, rest_after, width};
use armctl_frame::output::view::Tone;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Name,
    Family,
    Mode,
    Servo,
    State,
    /// Uses the remaining width.
    Alarm,
    Position {
        decimals: usize,
    },
    Answer,
    /// Last answer times.
    Trend,
}

/// Minimum and maximum width of names. `ALARM` is the minimum width of alarms.
const NAME: (usize, usize) = (5, 20);
const ALARM: u16 = 8;
/// Number of answer times shown.
const PAST: usize = 12;
/// Bar characters, lowest first.
const LEVELS: [&str; 8] = ["▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"];

/// First line: number of robots and of problems.
pub fn head(painter: &mut Painter<'_>, line: Rect, model: &Model) {
    let robots = model.robots();
    let count = |trouble| robots.iter().filter(|seen| seen.severity_of() == trouble).count();
    let (silent, alarms) = (count(Severity::Silent), count(Severity::Alarm));
    let waiting = robots.iter().filter(|seen| seen.contact == Contact::Waiting).count();
    let plural = if robots.len() == 1 { "" } else { "s" };
    let mut parts = vec![
        (" armctl top".to_owned(), painter.palette.accent()),
        (format!("  {} robot{plural}", robots.len()), Style::new()),
    ];
    let mut count_part = |count: usize, what: &str, tone| {
        if count > 0 {
            parts.push((format!(" · {count} {what}"), painter.palette.tone(tone)));
        }
    };
    count_part(robots.len() - silent - waiting, "answer", Tone::Good);
    count_part(alarms, if alarms == 1 { "alarm" } else { "alarms" }, Tone::Bad);
    count_part(silent, "silent", Tone::Bad);
    count_part(waiting, "waiting", Tone::Warning);
    if !model.filter.is_empty() && !model.is_typing {
        parts.push((format!(" · only '{}'", model.filter), painter.palette.accent()));
    }
    if model.sort != Sort::Unsorted {
        parts.push((format!(" · {}", model.sort.name()), painter.palette.quiet()));
    }
    let parts: Vec<(&str, Style)> = parts.iter().map(|(text, style)| (text.as_str(), *style)).collect();
    painter.draw_parts(Rect { width: line.width.saturating_sub(14), ..line }, &parts);
    format_interval(painter, line, model);
}

/// Draws headings and robots, and the full problem of the selected robot.
pub fn body(painter: &mut Painter<'_>, area: Rect, model: &Model, now: Moment) {
    let columns = columns(area.width, model.robots());
    let heading = line_of(area, 0);
    painter.paint(heading, painter.palette.heading());
    let style = painter.palette.heading();
    for (column, place) in &columns {
        if column.is_right() {
            painter.draw_right(draw_cell(*place, heading), column.title(), style);
        } else {
            painter.draw_left(draw_cell(*place, heading), column.title(), style);
        }
    }
    let room = Rect { y: area.y.saturating_add(1), height: area.height.saturating_sub(2), ..area };
    let listed = model.visible_robots();
    let cursor = listed.iter().position(|robot| *robot == model.cursor).unwrap_or_default();
    let first = first_line(cursor, listed.len(), room.height.into());
    for (line, robot) in (0..room.height).zip(listed.iter().skip(first)) {
        let line = line_of(room, line);
        let Some(seen) = model.robots().get(*robot) else { continue };
        for (column, place) in &columns {
            column.draw(painter, draw_cell(*place, line), seen, now, model);
        }
        if *robot == model.cursor {
            painter.draw_left(Rect { width: line.width.min(1), ..line }, "▌", painter.palette.accent());
            painter.paint(rest_after(line, 1), Style::new().add_modifier(Modifier::BOLD));
        }
    }
    if listed.is_empty() {
        painter.draw_left(rest_after(line_of(room, 1), 2), "no robot matches the filter", painter.palette.quiet());
    } else if area.height > 2 {
        draw_fault(painter, line_of(area, area.height - 1), model);
    }
}

/// First visible robot. The selected robot is in the middle if possible.
fn first_line(cursor: usize, robots: usize, lines: usize) -> usize {
    cursor.saturating_sub(lines / 2).min(robots.saturating_sub(lines))
}

/// Draws the problem of the selected robot.
fn draw_fault(painter: &mut Painter<'_>, line: Rect, model: &Model) {
    let Some(seen) = model.selected_robot() else { return };
    let (text, tone) = if let Contact::Unreachable(failure) = &seen.contact {
        let hint = failure.hint.as_ref().map(|hint| format!("; {hint}")).unwrap_or_default();
        (format!("{}{hint}", failure.message), Tone::Bad)
    } else {
        let (alarm, tone) = seen.alarm();
        (if alarm.is_empty() { seen.place.clone() } else { format!("{}: {alarm}", seen.name) }, tone)
    };
    let style = if tone == Tone::Plain { painter.palette.quiet() } else { painter.palette.tone(tone) };
    painter.draw_left(rest_after(line, 1), &text, style);
}

/// Columns that fit the width, with position and width.
fn columns(width: u16, robots: &[RobotRow]) -> Vec<(Column, Rect)> {
    let name = robots.iter().map(|seen| painter::width(&seen.name)).max().unwrap_or_default();
    let name = u16::try_from(name.clamp(NAME.0, NAME.1)).unwrap_or_default();
    let is_mixed = robots.windows(2).any(|pair| pair[0].family != pair[1].family);
    let gap = if width >= 100 { 2 } else { 1 };
    // The number is the minimum screen width for the column.
    let all = [
        (Column::Name, name, 0),
        (Column::Family, 6, if is_mixed { 76 } else { 90 }),
        (Column::Mode, 9, 40),
        (Column::Servo, 5, 50),
        (Column::State, 7, 30),
        (Column::Alarm, 0, 20),
        (Column::Position { decimals: 1 }, 26, 110),
        (Column::Position { decimals: 0 }, 17, 80),
        (Column::Answer, 7, 60),
        (Column::Trend, u16::try_from(PAST).unwrap_or_default(), 120),
    ];
    let has_fine = width >= 110;
    let available = all
        .into_iter()
        .filter(|(column, _, least)| width >= *least && !(has_fine && *column == Column::Position { decimals: 0 }));
    let mut available_width: Vec<(Column, u16)> = available.map(|(column, columns, _)| (column, columns)).collect();
    let taken: u16 = 2 + available_width.iter().map(|(_, columns)| columns + gap).sum::<u16>();
    for (column, columns) in &mut available_width {
        if *column == Column::Alarm {
            *columns = width.saturating_sub(taken).max(ALARM);
        }
    }
    let mut x = 2;
    let mut columns_with_area = Vec::with_capacity(available_width.len());
    for (column, columns) in available_width {
        columns_with_area.push((column, Rect { x, width: columns.min(width.saturating_sub(x)), ..Rect::ZERO }));
        x += columns + gap;
    }
    columns_with_area
}

/// Position of a column in a line.
fn draw_cell(column: Rect, line: Rect) -> Rect {
    Rect { x: line.x + column.x, y: line.y, width: column.width, height: line.height }
}

impl Column {
    fn title(self) -> &'static str {
        match self {
            Self::Name => "NAME",
            Self::Family => "FAMILY",
            Self::Mode => "MODE",
            Self::Servo => "SERVO",
            Self::State => "STATE",
            Self::Alarm => "ALARM",
            Self::Position { .. } => "X Y Z (mm)",
            Self::Answer => "ANSWER",
            Self::Trend => "LAST ANSWERS",
        }
    }

    fn is_right(self) -> bool {
        matches!(self, Self::Position { .. } | Self::Answer)
    }

    fn draw(self, painter: &mut Painter<'_>, place: Rect, seen: &RobotRow, now: Moment, model: &Model) {
        let palette = painter.palette;
        let line = seen.sample().map(|sample| &sample.line);
        let is_old = seen.is_stale(now, model.every);
        // Outdated values are dimmed.
        let plain = if is_old { palette.quiet() } else { Style::new() };
        let toned = |tone| if is_old { palette.quiet() } else { palette.tone(tone) };
        let dash = ("-", palette.quiet());
        let (text, style) = match self {
            Self::Name => (seen.name.as_str(), Style::new()),
            Self::Family => (seen.family.name(), palette.quiet()),
            Self::Mode => line.and_then(|line| line.state.controller_mode).map_or(dash, |mode| (mode, plain)),
            Self::Servo => match line.and_then(|line| line.state.servo_on) {
                Some(true) => ("on", toned(Tone::Good)),
                Some(false) => ("off", plain),
                None => dash,
            },
            Self::State => match line.map(|line| (line.state.held, line.state.running)) {
                Some((Some(true), _)) => ("hold", toned(Tone::Warning)),
                Some((_, Some(true))) => ("running", toned(Tone::Good)),
                Some((_, Some(false))) => ("stopped", plain),
                Some(_) | None => dash,
            },
            Self::Alarm => {
                let (text, tone) = seen.alarm();
                let style = if tone == Tone::Plain { palette.quiet() } else { palette.tone(tone) };
                painter.draw_left(place, &text, style);
                return;
            }
            Self::Position { decimals } => return position(painter, place, seen, decimals, plain),
            Self::Answer => {
                let (text, style) = answer(painter, seen, now, model.every);
                painter.draw_right(place, &text, style);
                return;
            }
            Self::Trend => return trend(painter, place, seen),
        };
        painter.draw_left(place, text, style);
    }
}

/// Draws three coordinates in columns.
fn position(painter: &mut Painter<'_>, place: Rect, seen: &RobotRow, decimals: usize, style: Style) {
    let Some(sample) = seen.sample() else { return painter.draw_right(place, "-", painter.palette.quiet()) };
    let Some(at) = sample.line.state.position else {
        let why = if sample.line.not_asked.is_some() { "not asked" } else { "-" };
        return painter.draw_right(place, why, painter.palette.quiet());
    };
    let columns = (place.width.saturating_sub(2)) / 3;
    for (index, value) in (0..).zip([at.x_mm, at.y_mm, at.z_mm]) {
        let column = rest_after(place, index * (columns + 1));
        painter.draw_right(Rect { width: columns.min(column.width), ..column }, &format!("{value:.decimals$}"), style);
    }
}

/// Draws the last answer times as bars, relative to the longest.
fn trend(painter: &mut Painter<'_>, place: Rect, seen: &RobotRow) {
    let last = seen.answers.iter().rev().take(PAST).rev();
    let longest = last.clone().max().copied().unwrap_or_default().as_secs_f64();
    let signs = last.map(|time| {
        let share = if longest > 0.0 { time.as_secs_f64() / longest } else { 0.0 };
        let level = LEVELS.iter().zip(1..).find(|(_, level)| share * 8.0 <= f64::from(*level));
        level.map_or(LEVELS[7], |(sign, _)| *sign)
    });
    let signs: String = signs.collect();
    debug_assert!(width(&signs) <= PAST);
    painter.draw_left(place, &signs, painter.palette.quiet());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_the_cursor_visible() {
        assert_eq!(first_line(0, 50, 10), 0);
        assert_eq!(first_line(20, 50, 10), 15);
        assert_eq!(first_line(49, 50, 10), 40);
        assert_eq!(first_line(3, 5, 10), 0);
        for cursor in 0..50 {
            for lines in 1..60 {
                let first = first_line(cursor, 50, lines);
                assert!((first..first + lines).contains(&cursor), "{cursor} {lines}");
            }
        }
    }

    #[test]
    fn columns_fit_the_line() {
        for columns_of_line in [80, 100, 120, 200] {
            let columns = columns(columns_of_line, &[]);
            assert!(
                columns.iter().all(|(_, place)| place.right() <= columns_of_line),
                "{columns_of_line}: {columns:?}"
            );
            assert!(columns.iter().any(|(column, _)| *column == Column::Alarm));
        }
    }
}
