//! Screen of the teach panel: the robot as in `top`, with the panel below.

use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::keys::KEYS;
use super::model::{HistoryEntry, Model, PointUse, Prompt};
use crate::command::fleet::top;
use armctl_frame::output::painter::{Painter, Palette, line_of, rest_after, to_ascii, wrap};
use armctl_frame::output::view::Tone;

/// Lines of the panel. `HISTORY_LINES` is the maximum number of lines for past commands.
const PANEL: u16 = 3;
const HISTORY_LINES: u16 = 6;

/// State of the robot.
pub struct Robot<'a> {
    /// Model of the `top` screen.
    pub seen: &'a top::Model,
    /// Time since the panel started.
    pub now: std::time::Duration,
    /// Whether it is a real controller.
    pub is_real: bool,
}

/// Draws the screen.
pub fn draw(frame: &mut Frame<'_>, model: &Model, robot: &Robot<'_>, palette: Palette) {
    let area = frame.area();
    render(frame.buffer_mut(), area, model, robot, palette);
}

pub(super) fn render(buffer: &mut Buffer, area: Rect, model: &Model, robot: &Robot<'_>, palette: Palette) {
    let mut painter = Painter { buffer, palette };
    let history = HISTORY_LINES.min(area.height / 4);
    let rest = (PANEL + history + 1).min(area.height);
    let foot = line_of(area, area.height.saturating_sub(1));
    let head = line_of(area, 0);
    let body = Rect { y: area.y + head.height, height: area.height.saturating_sub(rest + 1), ..area };
    top::robot(&mut painter, [head, body], robot.seen, robot.now);
    let panel = Rect { y: area.y + area.height.saturating_sub(rest), height: rest.saturating_sub(1), ..area };
    painter.paint(line_of(panel, 0), palette.heading());
    controls(&mut painter, panel, model, robot.is_real);
    lines(&mut painter, Rect { y: panel.y + PANEL, height: panel.height.saturating_sub(PANEL), ..panel }, model);
    let shown: Vec<_> = KEYS.iter().filter(|key| !key.short.is_empty()).collect();
    painter.draw_keys(foot, &shown);
    if model.has_help {
        painter.draw_help(
            area,
            "Each key moves one axis by one step. The next key works after that step.",
            KEYS.iter(),
        );
    }
    if !palette.is_unicode {
        to_ascii(painter.buffer);
    }
}

/// Draws axis, step, speed, and the open question.
fn controls(painter: &mut Painter<'_>, area: Rect, model: &Model, is_real: bool) {
    let (accent, quiet) = (painter.palette.accent(), painter.palette.quiet());
    let robot_text = if is_real { "REAL CONTROLLER" } else { "simulator" };
    let tone = painter.palette.tone(if is_real { Tone::Bad } else { Tone::Good });
    painter.draw_left(rest_after(line_of(area, 0), 1), "teach", accent);
    painter.draw_right(line_of(area, 0), &format!("{robot_text} "), tone);
    let step = model.step().map_or("not allowed".to_owned(), |step| format!("{step} {}", model.unit()));
    let speed = model.speed().map(|speed| format!("{speed} {}", model.system().speed_unit));
    let speed = speed.unwrap_or_else(|| "the controller's".to_owned());
    let state = if model.is_moving { (" MOVING ", tone.add_modifier(Modifier::REVERSED)) } else { ("", quiet) };
    painter.draw_parts(
        rest_after(line_of(area, 1), 1),
        &[
            (model.system().name, Style::new()),
            ("  axis ", quiet),
            (model.axis_name(), accent),
            ("  step ", quiet),
            (&step, accent),
            ("  speed ", quiet),
            (&speed, accent),
            ("  ", quiet),
            state,
        ],
    );
    let line = rest_after(line_of(area, 2), 1);
    let question = model.prompt.as_ref().map(|asked| question(model, asked));
    if let Some(question) = question {
        painter.draw_left(line, &question, painter.palette.tone(Tone::Warning));
    }
}

/// Text of the open question.
fn question(model: &Model, asked: &Prompt) -> String {
    let point = model.panel.point;
    match asked {
        Prompt::PointNumber(PointUse::Store, typed) => {
            format!("Store the current position as: {typed}_  (number, Enter; Esc)")
        }
        Prompt::PointNumber(PointUse::Go, typed) => format!("Move to: {typed}_  (number, Enter; Esc)"),
        Prompt::Overwrite(PointUse::Store, number, old) => {
            format!("y stores the position as {}, Esc cancels; now: {old}", point(*number))
        }
        Prompt::Overwrite(PointUse::Go, number, place) => {
            format!("y moves to {} in one motion, Esc cancels; the point is {place}", point(*number))
        }
        Prompt::Release => "y releases the hold, Esc cancels; a stopped motion may continue".to_owned(),
    }
}

/// Draws past commands, newest at the bottom, with the full error of the newest.
fn lines(painter: &mut Painter<'_>, area: Rect, model: &Model) {
    let mut bottom = area.height;
    for (age, HistoryEntry { words, outcome, .. }) in model.history.iter().rev().enumerate() {
        let (sign, tone) = match outcome {
            None => ("…", Tone::Plain),
            Some(Ok(())) => ("ok", Tone::Good),
            Some(Err(_)) => ("no", Tone::Bad),
        };
        let (style, quiet) = (painter.palette.tone(tone), painter.palette.quiet());
        let failure = outcome.as_ref().and_then(|outcome| outcome.as_ref().err());
        let why = failure.map(|failure| match &failure.hint {
            Some(hint) if age == 0 => format!("{}; {hint}", failure.message),
            _ => failure.message.clone(),
        });
        let mut why = why.map(|why| wrap(&why, usize::from(area.width.saturating_sub(5)))).unwrap_or_default();
        why.truncate(if age == 0 { usize::from(area.height.saturating_sub(1)) } else { 1 });
        let taken = u16::try_from(1 + why.len()).unwrap_or(u16::MAX);
        let Some(top) = bottom.checked_sub(taken) else { return };
        painter.draw_parts(rest_after(line_of(area, top), 1), &[(sign, style), (" ", quiet), (words.as_str(), quiet)]);
        for (line, text) in (top + 1..).zip(&why) {
            painter.draw_left(rest_after(line_of(area, line), 4), text, style);
        }
        bottom = top;
    }
}
