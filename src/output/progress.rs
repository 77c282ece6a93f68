//! Progress of long work on stderr: a bar on a terminal, a line now and then elsewhere.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{Screen, escape};

/// Progress of one thing, shown until dropped.
#[derive(Debug)]
pub struct Progress {
    bar: Option<ProgressBar>,
    lines: bool,
    what: String,
    done: u64,
    next_line: NextLine,
}

/// When the next line is due off a terminal.
#[derive(Debug)]
enum NextLine {
    /// When so many bytes are done.
    Bytes(u64),
    /// At a moment, for so many items that were begun at another.
    Items { total: u64, began: Instant, due: Instant },
}

/// Off a terminal, a line each time so many bytes more are done.
const LINE_EVERY: u64 = 1 << 20;
/// The same for items, by time: they take as long as they take.
const LINE_AFTER: Duration = Duration::from_secs(10);

impl Screen {
    /// Starts to show the transfer of bytes called `what`; `total` where it is known.
    pub fn bytes_progress(&self, what: &str, total: Option<u64>) -> Progress {
        let template = match total {
            Some(_) => "{msg} {bar:24} {bytes}/{total_bytes} {bytes_per_sec} {eta}",
            None => "{msg} {spinner} {bytes} {bytes_per_sec} {elapsed}",
        };
        self.progress(what, total, template, NextLine::Bytes(LINE_EVERY))
    }

    /// Starts to show how many of `total` items called `what` are done, and how long the rest takes.
    pub fn items_progress(&self, what: &str, total: u64) -> Progress {
        let began = Instant::now();
        let next_line = NextLine::Items { total, began, due: began + LINE_AFTER };
        self.progress(what, Some(total), "{msg} {bar:24} {pos}/{len} {eta} left", next_line)
    }

    /// Starts to show that `what` takes its time.
    pub fn spinner(&self, what: &str) -> Progress {
        self.progress(what, None, "{msg} {spinner} {elapsed}", NextLine::Bytes(LINE_EVERY))
    }

    fn progress(&self, what: &str, total: Option<u64>, template: &str, next_line: NextLine) -> Progress {
        let what = escape::line(what).into_owned();
        let bar = self.can_redraw().then(|| {
            let bar = ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr_with_hz(10));
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_message(what.clone());
            bar.enable_steady_tick(Duration::from_millis(100));
            bar
        });
        Progress { bar, lines: !self.quiet && !self.is_json(), what, done: 0, next_line }
    }
}

impl Progress {
    /// So many bytes or items more are done.
    pub fn advance(&mut self, more: u64) {
        self.done += more;
        match &self.bar {
            Some(bar) => bar.inc(more),
            None if self.lines => self.line(Instant::now()),
            None => {}
        }
    }

    /// Writes a line, if one is due.
    fn line(&mut self, now: Instant) {
        let (what, done) = (&self.what, self.done);
        match &mut self.next_line {
            NextLine::Bytes(due) if done >= *due => {
                *due = done - done % LINE_EVERY + LINE_EVERY;
                Screen::stderr(&format!("{what} {} KiB\n", done >> 10));
            }
            NextLine::Items { total, began, due } if now >= *due => {
                *due = now + LINE_AFTER;
                let rest = left(done, *total, now - *began);
                Screen::stderr(&format!("{what}: {done} of {total}, {rest} left\n"));
            }
            _ => {}
        }
    }

    /// Changes what stands beside the bar; off a terminal, says nothing.
    pub fn say(&self, text: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(escape::line(text).into_owned());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// How long the rest takes if it goes on like that: `1 min 20 s`.
fn left(done: u64, total: u64, passed: Duration) -> String {
    let rest = u128::from(total.saturating_sub(done)) * passed.as_millis() / u128::from(done.max(1));
    let seconds = rest.div_ceil(1000);
    if seconds < 60 { format!("{seconds} s") } else { format!("{} min {} s", seconds / 60, seconds % 60) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_takes_as_long_as_what_was_done() {
        let passed = Duration::from_secs(10);
        assert_eq!(left(100, 999, passed), "1 min 30 s");
        assert_eq!(left(500, 999, passed), "10 s");
        assert_eq!(left(0, 10, passed), "1 min 40 s");
        assert_eq!(left(10, 10, passed), "0 s");
    }
}
