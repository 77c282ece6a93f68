//! Picture of a motion on the terminal, with braille dots.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::symbols::Marker;
use ratatui::text::Span;
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::{Canvas, Line};

use super::Plane;
use super::layout::{Panel, panels};
use super::model::{Drawing, Interpolation};
use crate::output::painter::width;
use crate::prelude::basics::*;

/// Width of a picture in columns. A column has two dots, and a line has four.
const WIDTH: u16 = 78;
/// Lines of a plane next to another plane, of a plane alone, and of an axis over time.
const LINES: u16 = 14;
const LINES_ALONE: u16 = 24;
const LINES_OF_AXIS: u16 = 4;
/// Columns between two planes.
const GAP: u16 = 4;
/// Maximum number of steps that have their numbers in the picture.
const MAX_NUMBERS: usize = 40;
/// Colors in the buffer. [`row`] converts them to tones.
const NEW: Color = Color::Green;
const OLD: Color = Color::Yellow;

/// Lines of the picture, each with parts of the same tone. Without a plane, all planes in which the robot moves.
pub fn picture(drawing: &Drawing, plane: Option<Plane>) -> Vec<Vec<Cell>> {
    if drawing.motion.steps.is_empty() {
        return Vec::new();
    }
    let panels = panels(drawing);
    let has_numbers = drawing.motion.steps.len() <= MAX_NUMBERS;
    let mut lines = Vec::new();
    if !drawing.motion.has_space() {
        let (still, moving): (Vec<&Panel>, Vec<&Panel>) = panels.iter().partition(|panel| panel.y.is_constant);
        for panel in moving {
            lines.extend(draw(drawing, panel, WIDTH, LINES_OF_AXIS, false));
        }
        let still: Vec<&str> = still.iter().map(|panel| panel.title.as_str()).collect();
        lines.extend((!still.is_empty()).then(|| vec![format!("no motion: {}", still.join(", ")).into()]));
        return [lines, legend(drawing)].concat();
    }
    let is_flat = |panel: &&Panel| panel.x.is_constant || panel.y.is_constant;
    let mut chosen: Vec<&Panel> = match plane {
        Some(plane) => panels.iter().zip(Plane::ALL).filter(|(_, one)| *one == plane).map(|(panel, _)| panel).collect(),
        None => panels.iter().filter(|panel| !is_flat(panel)).collect(),
    };
    if chosen.is_empty() {
        chosen.extend(panels.first());
    }
    if let [panel] = chosen[..] {
        lines.extend(draw(drawing, panel, WIDTH, LINES_ALONE, has_numbers));
    } else {
        for pair in chosen.chunks(2) {
            let half = (WIDTH - GAP) / 2;
            let mut parts = pair.iter().map(|panel| draw(drawing, panel, half, LINES, has_numbers));
            let (left, right) = (parts.next().unwrap_or_default(), parts.next());
            match right {
                None => lines.extend(left),
                Some(right) => lines.extend(
                    left.into_iter()
                        .zip(right)
                        .map(|(left, right)| [left, vec![" ".repeat(GAP.into()).into()], right].concat()),
                ),
            }
        }
    }
    [lines, legend(drawing)].concat()
}

/// Heading, lines with dots, and range of the horizontal axis.
fn draw(drawing: &Drawing, panel: &Panel, columns: u16, rows: u16, has_numbers: bool) -> Vec<Vec<Cell>> {
    let area = Rect::new(0, 0, columns, rows);
    let mut buffer = Buffer::empty(area);
    let (dots_x, dots_y) = (f64::from(columns * 2), f64::from(rows * 4));
    let is_time = panel.x.axis.is_none();
    let (mut x, mut y) = (panel.x.range, panel.y.range);
    if !is_time {
        // A millimeter has the same length in both directions.
        let unit = (x.length() / dots_x).max(y.length() / dots_y);
        (x, y) = (x.widened(unit * dots_x), y.widened(unit * dots_y));
    }
    let canvas = Canvas::default().marker(Marker::Braille).x_bounds([x.least, x.most]).y_bounds([y.least, y.most]);
    let dot = (x.length() / dots_x, y.length() / dots_y);
    let canvas = canvas.paint(|context| {
        for trace in &panel.traces {
            let color = if trace.is_old { OLD } else { NEW };
            for stroke in &trace.strokes {
                for (from, to) in stroke
                    .points
                    .iter()
                    .zip(stroke.points.iter().skip(1).chain(stroke.points.first().filter(|_| stroke.points.len() == 1)))
                {
                    let is_dashed = !matches!(stroke.interpolation, Interpolation::Straight | Interpolation::Arc);
                    for line in dashes(*from, *to, dot, is_dashed && !is_time, color) {
                        context.draw(&line);
                    }
                }
            }
            context.layer();
        }
        let numbered =
            panel.traces.iter().filter(|trace| has_numbers && !trace.is_old).flat_map(|trace| &trace.targets);
        let mut taken: Vec<[f64; 2]> = Vec::new();
        for (index, [x, y]) in numbered {
            // A number has two columns of two dots, and one line of four dots.
            let is_free = |[left, base]: &[f64; 2]| (x - left).abs() > 5.0 * dot.0 || (y - base).abs() > 4.0 * dot.1;
            if taken.iter().all(is_free) {
                taken.push([*x, *y]);
                context.print(
                    *x,
                    *y,
                    Span::styled(drawing.motion.number(*index).to_string(), Style::new().fg(Color::White)),
                );
            }
        }
    });
    canvas.render(area, &mut buffer);
    let number = |value: f64| if value.abs() >= 1000.0 { format!("{value:.0}") } else { format!("{value:.1}") };
    let title = if is_time { String::new() } else { format!("{}  ", panel.title) };
    let heading = format!("{title}{} {} to {}", panel.y.label, number(y.least), number(y.most));
    let footing = format!("{} {} to {}", panel.x.label, number(x.least), number(x.most));
    let filled = |text: String| {
        vec![Cell::from(format!("{text}{}", " ".repeat(usize::from(columns).saturating_sub(width(&text)))))]
    };
    let mut lines = vec![filled(heading)];
    lines.extend(buffer.content.chunks(usize::from(columns)).map(row));
    if !is_time {
        lines.push(filled(footing));
    }
    lines
}

/// The lines from a point to another point; with `is_dashed`, with gaps.
fn dashes(from: [f64; 2], to: [f64; 2], dot: (f64, f64), is_dashed: bool, color: Color) -> Vec<Line> {
    /// Dots of a dash, and of a dash with its gap.
    const DASH: f64 = 2.0;
    const PERIOD: f64 = 5.0;
    let length = ((to[0] - from[0]) / dot.0).hypot((to[1] - from[1]) / dot.1);
    if !is_dashed || length <= PERIOD {
        return vec![Line::new(from[0], from[1], to[0], to[1], color)];
    }
    let at = |dots: f64| {
        let share = (dots / length).min(1.0);
        [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share]
    };
    let mut lines = Vec::new();
    let mut begin = 0.0;
    while begin < length {
        let ([x1, y1], [x2, y2]) = (at(begin), at(begin + DASH));
        lines.push(Line::new(x1, y1, x2, y2, color));
        begin += PERIOD;
    }
    lines
}

/// Joins the cells of a line that have the same color.
fn row(cells: &[ratatui::buffer::Cell]) -> Vec<Cell> {
    let mut parts: Vec<Cell> = Vec::new();
    for cell in cells {
        let tone = match cell.fg {
            NEW => Tone::Good,
            OLD => Tone::Warning,
            _ => Tone::Plain,
        };
        let text = if cell.symbol() == "\u{2800}" { " " } else { cell.symbol() };
        match parts.last_mut() {
            Some(last) if last.tone == tone => last.text.push_str(text),
            _ => parts.push(Cell::from(text).tone(tone)),
        }
    }
    parts
}

/// What the lines mean.
fn legend(drawing: &Drawing) -> Vec<Vec<Cell>> {
    let mut parts = Vec::new();
    if drawing.old.is_some() {
        parts.extend([Cell::from("new").tone(Tone::Good), "  ".into(), Cell::from("old").tone(Tone::Warning)]);
    }
    let has = |interpolation| drawing.motion.steps.iter().any(|step| step.interpolation == interpolation);
    for (interpolation, text) in [
        (Interpolation::Joints, "dashed: joint motion, not a straight line"),
        (Interpolation::Curve, "dashed: free curve, only its points are known"),
        (Interpolation::Order, "dashed: order of the numbers, not a motion"),
    ] {
        if has(interpolation) && drawing.motion.has_space() {
            parts.push(format!("{}{text}", if parts.is_empty() { "" } else { "  " }).into());
        }
    }
    if parts.is_empty() { Vec::new() } else { vec![parts] }
}
