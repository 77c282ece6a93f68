//! Chart of a value over time.

use std::collections::VecDeque;
use std::time::Duration;

use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::{Canvas, Line};

use super::whole;
use crate::command::fleet::top::model::Moment;
use crate::command::fleet::top::track::window;
use armctl_frame::output::painter::{Painter, line_of, rest_after, width};
use armctl_frame::output::view::Tone;

/// Data of a chart.
#[derive(Debug)]
pub struct Chart<'a> {
    /// Name of the axis.
    pub subject: &'a str,
    /// Quantity and unit.
    pub what: &'a str,
    /// Decimals of the scale.
    pub decimals: u8,
    /// Times in seconds and values, ascending.
    pub points: &'a VecDeque<(f64, f64)>,
}

impl Chart<'_> {
    /// Width of the scale.
    pub fn side(&self) -> u16 {
        let (bottom, top) = self.numbers();
        u16::try_from(width(&top).max(width(&bottom))).unwrap_or(u16::MAX)
    }

    /// Scale: smallest and largest value.
    fn numbers(&self) -> (String, String) {
        let (least, most) = range(self.points);
        let text = |value: f64| format!("{value:.*}", usize::from(self.decimals));
        (text(least), text(most))
    }
}

/// Draws a heading, the scale in `side` columns at the left, and the line.
pub fn draw(painter: &mut Painter<'_>, area: Rect, chart: &Chart<'_>, side: u16, now: Moment, every: Duration) {
    let (quiet, style) = (painter.palette.quiet(), painter.palette.heading());
    let time = window(every);
    let heading = line_of(area, 0);
    painter.paint(heading, style);
    painter.draw_parts(heading, &[(chart.subject, style), ("  ", style), (chart.what, style)]);
    painter.draw_right(heading, &format!("last {}", whole(time)), style);
    if area.height < 3 || chart.points.is_empty() {
        return;
    }
    let (bottom, top) = chart.numbers();
    let side = side.min(area.width / 2);
    let first = line_of(area, 1);
    let last = line_of(area, area.height - 1);
    painter.draw_right(Rect { width: side, ..first }, &top, quiet);
    painter.draw_right(Rect { width: side, ..last }, &bottom, quiet);
    for line in 1..area.height {
        let place = rest_after(line_of(area, line), side);
        painter.draw_left(Rect { width: place.width.min(2), ..place }, " │", quiet);
    }
    let picture = rest_after(Rect { y: first.y, height: area.height - 1, ..area }, side + 2);
    let color = painter.palette.tone(Tone::Good).fg.unwrap_or_default();
    plot(painter, picture, chart.points, (now.as_secs_f64(), time.as_secs_f64()), color);
}

fn plot(painter: &mut Painter<'_>, area: Rect, points: &VecDeque<(f64, f64)>, (now, long): (f64, f64), color: Color) {
    let area = area.intersection(painter.buffer.area);
    if area.is_empty() {
        return;
    }
    let (least, most) = range(points);
    let marker = if painter.palette.is_unicode { Marker::Braille } else { Marker::Custom('*') };
    let canvas = Canvas::default().marker(marker).x_bounds([now - long, now]).y_bounds([least, most]);
    let canvas = canvas.paint(|context| {
        for ((x1, y1), (x2, y2)) in points.iter().zip(points.iter().skip(1)) {
            context.draw(&Line::new(*x1, *y1, *x2, *y2, color));
        }
    });
    canvas.render(area, painter.buffer);
}

/// Range of the values; never empty, even for a constant value.
fn range(points: &VecDeque<(f64, f64)>) -> (f64, f64) {
    let values = || points.iter().map(|(_, value)| *value);
    let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    if most > least { (least, most) } else { (least - 1.0, most + 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_value_has_a_margin() {
        assert_eq!(range(&VecDeque::from([(0.0, 5.0), (1.0, 5.0)])), (4.0, 6.0));
        assert_eq!(range(&VecDeque::from([(0.0, 5.0), (1.0, -5.0)])), (-5.0, 5.0));
    }
}
