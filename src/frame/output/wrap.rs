//! Breaking of lines between words.

use std::borrow::Cow;

use dialoguer::console::measure_text_width;

/// Breaks the text into lines of at most `width` columns. Lines are broken only between words, so that a user can copy
/// an address or a command. Continuation lines have the indentation of their first line.
pub fn wrap(text: &str, width: usize) -> Cow<'_, str> {
    if text.lines().all(|line| measure_text_width(line) <= width) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len() + text.len() / width.max(1) + 1);
    for line in text.split_inclusive('\n') {
        let indent = &line[..line.len() - line.trim_start_matches(' ').len()];
        let mut column = 0;
        for word in line[indent.len()..].split_inclusive(' ') {
            let wide = measure_text_width(word.trim_end());
            if column == 0 {
                out.push_str(indent);
                column = indent.len();
            } else if column + wide > width {
                out.truncate(out.trim_end_matches(' ').len());
                out.push('\n');
                out.push_str(indent);
                column = indent.len();
            }
            out.push_str(word);
            column += measure_text_width(word.trim_end_matches('\n'));
        }
    }
    out.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_between_words_and_keeps_indentation() {
        assert_eq!(wrap("short\nlines\n", 8), "short\nlines\n");
        assert_eq!(wrap("one two three four\n", 9), "one two\nthree\nfour\n");
        assert_eq!(wrap("a\n  bb ccc dddd\n", 7), "a\n  bb\n  ccc\n  dddd\n");
        assert_eq!(wrap("see https://example.org/a/b?c=d now", 12), "see\nhttps://example.org/a/b?c=d\nnow");
        assert_eq!(wrap("\u{1b}[31merror:\u{1b}[0m no answer", 10), "\u{1b}[31merror:\u{1b}[0m no\nanswer");
        assert_eq!(wrap("Continue? [y/N] ", 80), "Continue? [y/N] ");
    }
}
