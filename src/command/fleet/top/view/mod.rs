//! Screen of a live view: the list of robots, the screen of one robot, the help.

mod chart;
mod detail;
mod list;

use std::time::Duration;

use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::keys::KEYS;
use super::model::{Model, Moment, RobotRow};
pub use armctl_frame::output::painter::Palette;
use armctl_frame::output::painter::{Painter, line_of, rest_after, to_ascii};
use armctl_frame::output::view::Tone;

/// Draws the screen.
pub fn draw(frame: &mut Frame<'_>, model: &Model, now: Moment, palette: Palette) {
    let area = frame.area();
    render(frame.buffer_mut(), area, model, model.displayed_time(now), palette);
}

fn render(buffer: &mut Buffer, area: Rect, model: &Model, now: Moment, palette: Palette) {
    let mut painter = Painter { buffer, palette };
    let [head, body, foot] = rows(area);
    if let Some(seen) = model.selected_robot().filter(|_| model.is_open) {
        detail::head(&mut painter, head, model, seen, now);
        detail::body(&mut painter, body, model, seen, now);
    } else {
        list::head(&mut painter, head, model);
        list::body(&mut painter, body, model, now);
    }
    keys(&mut painter, foot, model);
    if model.has_help {
        let title = "No key can move a robot or change anything.";
        painter.draw_help(area, title, KEYS.iter().map(|(_, key)| key));
    }
    if !palette.is_unicode {
        to_ascii(painter.buffer);
    }
}

/// Draws the screen of one robot: its first line, and the rest.
pub fn robot(painter: &mut Painter<'_>, [head, body]: [Rect; 2], model: &Model, now: Moment) {
    if let Some(seen) = model.selected_robot() {
        detail::head(painter, head, model, seen, now);
        detail::body(painter, body, model, seen, now);
    }
}

/// First line, last line, and the area between.
fn rows(area: Rect) -> [Rect; 3] {
    let head = line_of(area, 0);
    let foot = if area.height > 1 { line_of(area, area.height - 1) } else { Rect::ZERO };
    let body = Rect { y: area.y + head.height, height: area.height.saturating_sub(2), ..area };
    [head, body, foot]
}

/// Draws the polling interval and the pause mark at the end of the first line.
fn format_interval(painter: &mut Painter<'_>, line: Rect, model: &Model) {
    let pace = format!("every {:?} ", model.every);
    painter.draw_right(line, &pace, painter.palette.quiet());
    if model.is_paused() {
        let taken = u16::try_from(pace.len()).unwrap_or_default();
        let room = Rect { width: line.width.saturating_sub(taken + 1), ..line };
        let style = painter.palette.tone(Tone::Warning).add_modifier(Modifier::REVERSED);
        painter.draw_right(room, " PAUSED ", style);
    }
}

/// Last line: keys, as many as fit; or the filter that is being typed.
fn keys(painter: &mut Painter<'_>, line: Rect, model: &Model) {
    let (accent, quiet) = (painter.palette.accent(), painter.palette.quiet());
    if model.is_typing {
        let parts = [(" filter: ", accent), (model.filter.as_str(), Style::new()), ("█", accent)];
        let taken = painter.draw_parts(line, &parts);
        painter.draw_left(rest_after(line, taken + 2), "Enter keeps the filter, Esc shows all again", quiet);
        return;
    }
    let counts = |(list, one): (bool, bool)| if model.is_open { one } else { list };
    let shown = KEYS.iter().filter(|(place, key)| !key.short.is_empty() && counts(*place)).map(|(_, key)| key);
    painter.draw_keys(line, &shown.collect::<Vec<_>>());
}

/// Time of the last answer: `4.1 ms`, or `12s ago` if it is late.
fn answer(painter: &Painter<'_>, seen: &RobotRow, now: Moment, every: Duration) -> (String, Style) {
    let Some(age) = seen.age(now) else { return ("-".to_owned(), painter.palette.quiet()) };
    if seen.sample().is_none() || seen.is_stale(now, every) {
        let tone = if seen.sample().is_none() { Tone::Bad } else { Tone::Warning };
        return (format!("{} ago", short(age)), painter.palette.tone(tone));
    }
    match seen.sample().and_then(|sample| sample.answered_in) {
        Some(time) => (milliseconds(time), Style::new()),
        // No polling: the controller sends its state cyclically.
        None => ("live".to_owned(), painter.palette.quiet()),
    }
}

fn milliseconds(time: Duration) -> String {
    let milliseconds = time.as_secs_f64() * 1000.0;
    if milliseconds < 10.0 { format!("{milliseconds:.1} ms") } else { format!("{milliseconds:.0} ms") }
}

/// A time with two digits and a letter, below four days.
fn short(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..100 => format!("{seconds}s"),
        seconds @ 100..6000 => format!("{}m", seconds / 60),
        seconds => format!("{}h", seconds / 3600),
    }
}

/// A time in its largest unit.
fn whole(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..120 => format!("{seconds} s"),
        seconds @ 120..7200 => format!("{} min", seconds / 60),
        seconds => format!("{} h", seconds / 3600),
    }
}

#[cfg(test)]
mod tests;
