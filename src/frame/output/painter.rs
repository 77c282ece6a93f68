//! Text drawing for full-screen mode. Text is escaped, cut to the available width, and colored by its meaning.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Span;
use ratatui::widgets::{Block, Clear, Widget as _};

use super::escape;
use super::view::Tone;

/// What the terminal can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Palette {
    /// Whether the terminal has colors. Without colors, text is bold, underlined or reversed.
    pub has_color: bool,
    /// Whether the terminal can show more than ASCII.
    pub is_unicode: bool,
}

impl Palette {
    /// Style for a tone.
    pub fn tone(self, tone: Tone) -> Style {
        let style = Style::new();
        match (tone, self.has_color) {
            (Tone::Plain, _) | (Tone::Good, false) => style,
            (Tone::Good, true) => style.fg(Color::Green),
            (Tone::Warning, true) => style.fg(Color::Yellow),
            (Tone::Bad, true) => style.fg(Color::Red).add_modifier(Modifier::BOLD),
            (Tone::Warning, false) => style.add_modifier(Modifier::BOLD),
            (Tone::Bad, false) => style.add_modifier(Modifier::BOLD | Modifier::UNDERLINED),
        }
    }

    /// Style for less important text: headings, units, and values that are off.
    pub fn quiet(self) -> Style {
        if self.has_color { Style::new().fg(Color::DarkGray) } else { Style::new() }
    }

    /// Style for keys and for the selection.
    pub fn accent(self) -> Style {
        let bold = Style::new().add_modifier(Modifier::BOLD);
        if self.has_color { bold.fg(Color::Cyan) } else { bold }
    }

    /// Style for column headings.
    pub fn heading(self) -> Style {
        self.quiet().add_modifier(Modifier::UNDERLINED)
    }
}

/// A key with its help texts.
#[derive(Debug, Clone, Copy)]
pub struct KeyHelp {
    /// Name of the key.
    pub key: &'static str,
    /// Text for the last line of the screen. Empty if the key is only in the help.
    pub short: &'static str,
    /// Text for the help.
    pub full: &'static str,
}

/// Draws text into the buffer of a screen. Text outside of the buffer is omitted.
#[derive(Debug)]
pub struct Painter<'a> {
    /// Buffer that receives the text.
    pub buffer: &'a mut Buffer,
    /// Styles that the terminal can show.
    pub palette: Palette,
}

impl Painter<'_> {
    /// Draws text at the left end of a line. Returns the width of the text.
    pub fn draw_left(&mut self, line: Rect, text: &str, style: Style) -> u16 {
        let line = line.intersection(self.buffer.area);
        if line.is_empty() {
            return 0;
        }
        let text = escape::line(text);
        let room = usize::from(line.width);
        if width(&text) <= room {
            let (end, _) = self.buffer.set_stringn(line.x, line.y, &text, room, style);
            return end - line.x;
        }
        let (end, _) = self.buffer.set_stringn(line.x, line.y, &text, room - 1, style);
        self.buffer.set_stringn(end, line.y, "…", 1, style);
        line.width
    }

    /// Draws text at the right end of a line. Text that does not fit is cut.
    pub fn draw_right(&mut self, line: Rect, text: &str, style: Style) {
        let taken = u16::try_from(width(&escape::line(text))).unwrap_or(u16::MAX).min(line.width);
        let start = line.x + (line.width - taken);
        self.draw_left(Rect { x: start, width: taken, ..line }, text, style);
    }

    /// Draws the parts of a line one after the other. Returns their total width.
    pub fn draw_parts(&mut self, line: Rect, parts: &[(&str, Style)]) -> u16 {
        let mut taken = 0;
        for (text, style) in parts {
            taken += self.draw_left(rest_after(line, taken), text, *style);
        }
        taken
    }

    /// Draws the last line of a screen with as many keys as fit. The last two keys are always shown.
    pub fn draw_keys(&mut self, line: Rect, keys: &[&KeyHelp]) {
        let (accent, quiet) = (self.palette.accent(), self.palette.quiet());
        let columns = |key: &KeyHelp| width(key.key) + width(key.short) + 3;
        let mut at = 1;
        for (index, key) in keys.iter().enumerate() {
            let taken = u16::try_from(columns(key)).unwrap_or(u16::MAX);
            let rest: usize = keys.iter().skip(index + 1).rev().take(2).map(|key| columns(key)).sum();
            let is_last = index + 2 >= keys.len();
            let needed = usize::from(at) + usize::from(taken) + if is_last { 0 } else { rest };
            if needed > usize::from(line.width) + 2 && !is_last {
                continue;
            }
            let place = rest_after(line, at);
            self.draw_parts(
                Rect { width: place.width.min(taken), ..place },
                &[(key.key, accent), (" ", quiet), (key.short, quiet)],
            );
            at = at.saturating_add(taken);
        }
    }

    /// Draws the help for all keys over the screen.
    pub fn draw_help<'a>(&mut self, area: Rect, title: &str, keys: impl ExactSizeIterator<Item = &'a KeyHelp> + Clone) {
        const KEY: u16 = 8;
        let title_width = width(title).saturating_sub(usize::from(KEY));
        let columns = keys.clone().map(|key| width(key.full)).max().unwrap_or_default().max(title_width);
        let needed =
            (u16::try_from(columns).unwrap_or_default() + KEY + 6, u16::try_from(keys.len()).unwrap_or_default() + 5);
        let (columns, lines) = (needed.0.min(area.width), needed.1.min(area.height));
        let place = Rect {
            x: area.x + (area.width - columns) / 2,
            y: area.y + (area.height - lines) / 2,
            width: columns,
            height: lines,
        };
        Clear.render(place, self.buffer);
        Block::bordered().border_style(self.palette.quiet()).render(place, self.buffer);
        let inside = Rect {
            x: place.x.saturating_add(3).min(place.right()),
            y: place.y.saturating_add(1).min(place.bottom()),
            width: place.width.saturating_sub(6),
            height: place.height.saturating_sub(2),
        };
        self.draw_left(line_of(inside, 0), title, Style::new().add_modifier(Modifier::BOLD));
        for (line, key) in (2..).zip(keys) {
            let line = line_of(inside, line);
            self.draw_left(Rect { width: line.width.min(KEY), ..line }, key.key, self.palette.accent());
            self.draw_left(rest_after(line, KEY), key.full, Style::new());
        }
    }

    /// Sets the style of a line without changing its text.
    pub fn paint(&mut self, line: Rect, style: Style) {
        self.buffer.set_style(line.intersection(self.buffer.area), style);
    }
}

/// Returns the rest of a line after `columns`.
pub fn rest_after(line: Rect, columns: u16) -> Rect {
    let columns = columns.min(line.width);
    Rect { x: line.x + columns, width: line.width - columns, ..line }
}

/// Returns a line of an area, counted from the top. The line is empty if it is below the area.
pub fn line_of(area: Rect, line: u16) -> Rect {
    Rect { y: area.y.saturating_add(line), height: u16::from(line < area.height), ..area }
}

/// Width of a text in columns.
pub fn width(text: &str) -> usize {
    Span::raw(text).width()
}

/// Breaks a text between words.
pub fn wrap(text: &str, columns: usize) -> Vec<String> {
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

/// ASCII replacements for symbols. All other characters are text and are not replaced.
const ASCII: [(&str, &str); 24] = [
    ("●", "*"),
    ("○", "."),
    ("█", "#"),
    ("░", "-"),
    ("▌", ">"),
    ("│", "|"),
    ("─", "-"),
    ("└", "+"),
    ("┌", "+"),
    ("┐", "+"),
    ("┘", "+"),
    ("…", "~"),
    ("↑", "^"),
    ("↓", "v"),
    ("←", "<"),
    ("→", ">"),
    ("▁", "_"),
    ("▂", "_"),
    ("▃", "-"),
    ("▄", "-"),
    ("▅", "="),
    ("▆", "="),
    ("▇", "#"),
    ("·", "-"),
];

/// Replaces symbols by ASCII. Each symbol stays in its cell.
pub fn to_ascii(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        if let Some((_, plain)) = ASCII.iter().find(|(sign, _)| *sign == cell.symbol()) {
            cell.set_symbol(plain);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(columns: u16, draw: impl FnOnce(&mut Painter<'_>, Rect)) -> String {
        let area = Rect::new(0, 0, columns, 1);
        let mut buffer = Buffer::empty(area);
        draw(&mut Painter { buffer: &mut buffer, palette: Palette { has_color: false, is_unicode: true } }, area);
        // The cell after a wide character contains a space.
        buffer.content.iter().map(ratatui::buffer::Cell::symbol).collect()
    }

    fn left(columns: u16, text: &str) -> String {
        drawn(columns, |painter, line| _ = painter.draw_left(line, text, Style::new()))
    }

    #[test]
    fn truncates_text() {
        assert_eq!(left(5, "abc"), "abc  ");
        assert_eq!(left(5, "abcdef"), "abcd…");
        assert_eq!(left(1, "ab"), "…");
        assert_eq!(left(0, "ab"), "");
        // Each character has two columns. Three characters do not fit, and a part of a character is not drawn.
        assert_eq!(left(6, "溶接機"), "溶 接 機 ");
        assert_eq!(left(4, "溶接機"), "溶 … ");
    }

    #[test]
    fn wraps_between_words() {
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("immeasurable", 3), ["immeasurable"]);
        assert_eq!(wrap("", 3), [""]);
    }

    #[test]
    fn aligns_numbers_right() {
        let right = |text: &str| drawn(5, |painter, line| painter.draw_right(line, text, Style::new()));
        assert_eq!(right("1.0"), "  1.0");
        assert_eq!(right("1234567"), "1234…");
    }

    #[test]
    fn shows_control_characters() {
        assert_eq!(left(12, "a\x1b[2Jb"), "a\\x1b[2Jb   ");
    }
}
