//! Progress of long work on stderr: a bar on a terminal, otherwise lines from time to time.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{Screen, escape};

/// Progress of one task. It is shown until this value is dropped.
#[derive(Debug)]
pub struct Progress {
    bar: Option<ProgressBar>,
    lines: bool,
    label: String,
    completed: u64,
    next_line: NextLine,
}

/// Time of the next progress line, if there is no terminal.
#[derive(Debug)]
enum NextLine {
    /// The next line is printed at this number of bytes. Used if the total is unknown.
    Bytes(u64),
    /// A line is printed at each tenth of `total`, unless the work is short. The amount is counted in KiB or in items.
    Tenths { total: u64, began: Instant, told: u64, in_kib: bool },
}

/// Number of bytes between two lines, if the total is unknown.
const LINE_INTERVAL: u64 = 1 << 20;
/// Work that takes less than this time prints no lines.
const QUICK_DURATION: Duration = Duration::from_secs(10);

impl Screen {
    /// Starts the progress of a transfer. `total` is the number of bytes, if known.
    pub fn bytes_progress(&self, what: &str, total: Option<u64>) -> Progress {
        let template = match total {
            Some(_) => "{msg} {bar:24} {percent}% {bytes}/{total_bytes} {bytes_per_sec} {eta}",
            None => "{msg} {spinner} {bytes} {bytes_per_sec} {elapsed}",
        };
        let next_line = match total {
            Some(total) => NextLine::Tenths { total, began: Instant::now(), told: 0, in_kib: true },
            None => NextLine::Bytes(LINE_INTERVAL),
        };
        self.progress(what, total, template, next_line)
    }

    /// Starts the progress of a number of items. The progress shows the remaining time.
    pub fn items_progress(&self, what: &str, total: u64) -> Progress {
        let next_line = NextLine::Tenths { total, began: Instant::now(), told: 0, in_kib: false };
        self.progress(what, Some(total), "{msg} {bar:24} {percent}% {pos}/{len} {eta} left", next_line)
    }

    /// Starts the progress of parts. On a terminal, the parts have their own bars. Without a terminal, a line is
    /// printed for each tenth.
    pub fn parts_progress(&self, what: &str, total: usize) -> Progress {
        let next_line = NextLine::Tenths { total: total as u64, began: Instant::now(), told: 0, in_kib: false };
        let lines = !self.can_redraw() && !self.quiet && !self.is_json();
        Progress { bar: None, lines, label: what.to_owned(), completed: 0, next_line }
    }

    /// Starts a spinner for work whose duration is unknown.
    pub fn spinner(&self, what: &str) -> Progress {
        self.progress(what, None, "{msg} {spinner} {elapsed}", NextLine::Bytes(LINE_INTERVAL))
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
        Progress { bar, lines: !self.quiet && !self.is_json(), label: what, completed: 0, next_line }
    }
}

impl Progress {
    /// Adds completed bytes or items.
    pub fn advance(&mut self, more: u64) {
        self.completed += more;
        match &self.bar {
            Some(bar) => bar.inc(more),
            None if self.lines => self.line(Instant::now()),
            None => {}
        }
    }

    /// Prints a line if the next line is due.
    fn line(&mut self, now: Instant) {
        let (what, done) = (&self.label, self.completed);
        match &mut self.next_line {
            NextLine::Bytes(due) if done >= *due => {
                *due = done - done % LINE_INTERVAL + LINE_INTERVAL;
                Screen::stderr(&format!("{what} {} KiB\n", done >> 10));
            }
            NextLine::Bytes(_) => {}
            NextLine::Tenths { total, began, told, in_kib } => {
                if let Some(line) = tenth(done, *total, now - *began, told, *in_kib) {
                    Screen::stderr(&format!("{what}: {line}\n"));
                }
            }
        }
    }

    /// Changes the text next to the bar. Without a terminal, nothing is printed.
    pub fn print_line(&self, text: &str) {
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

/// Returns the line for a new tenth. `told` is the last tenth that was printed.
fn tenth(done: u64, total: u64, passed: Duration, told: &mut u64, in_kib: bool) -> Option<String> {
    let tenths = done.saturating_mul(10) / total.max(1);
    if tenths <= *told || passed < QUICK_DURATION {
        return None;
    }
    *told = tenths;
    let (done_now, total_now, unit) = if in_kib { (done >> 10, total >> 10, " KiB") } else { (done, total, "") };
    Some(format!("{}0 %, {done_now} of {total_now}{unit}, {} left", tenths, remaining(done, total, passed)))
}

/// Returns the estimated remaining time, for example `1 min 20 s`.
fn remaining(done: u64, total: u64, passed: Duration) -> String {
    let rest = u128::from(total.saturating_sub(done)) * passed.as_millis() / u128::from(done.max(1));
    let seconds = rest.div_ceil(1000);
    if seconds < 60 { format!("{seconds} s") } else { format!("{} min {} s", seconds / 60, seconds % 60) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_a_line_per_tenth_in_a_log() {
        let passed = Duration::from_secs(10);
        let mut last = 0;
        let lines: Vec<String> = (1..=200).filter_map(|done| tenth(done, 200, passed, &mut last, false)).collect();
        assert_eq!(lines.len(), 10);
        assert_eq!(
            (lines[0].as_str(), lines[9].as_str()),
            ("10 %, 20 of 200, 1 min 30 s left", "100 %, 200 of 200, 0 s left")
        );
        assert_eq!(tenth(200, 200, passed, &mut last, false), None, "no tenth is printed twice");
        assert_eq!(tenth(2048, 4096, passed, &mut 0, true).as_deref(), Some("50 %, 2 of 4 KiB, 10 s left"));
        assert_eq!(tenth(1, 2, Duration::from_secs(1), &mut 0, false), None, "what is quick has no lines");
    }

    #[test]
    fn estimates_the_remaining_time() {
        let passed = Duration::from_secs(10);
        assert_eq!(remaining(100, 999, passed), "1 min 30 s");
        assert_eq!(remaining(500, 999, passed), "10 s");
        assert_eq!(remaining(0, 10, passed), "1 min 40 s");
        assert_eq!(remaining(10, 10, passed), "0 s");
    }
}
