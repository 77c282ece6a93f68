//! Progress of long work on stderr: a bar on a terminal, a line now and then elsewhere.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{Screen, escape};

/// Progress of one thing, shown until dropped.
#[derive(Debug)]
pub struct Progress {
    bar: Option<ProgressBar>,
    lines: bool,
    what: String,
    done: u64,
    next_line: u64,
}

/// Off a terminal, a line each time so many bytes more are done.
const LINE_EVERY: u64 = 1 << 20;

impl Screen {
    /// Starts to show the transfer of bytes called `what`; `total` where it is known.
    pub fn bytes_progress(&self, what: &str, total: Option<u64>) -> Progress {
        let template = match total {
            Some(_) => "{msg} {bar:24} {bytes}/{total_bytes} {bytes_per_sec} {eta}",
            None => "{msg} {spinner} {bytes} {bytes_per_sec} {elapsed}",
        };
        self.progress(what, total, template)
    }

    /// Starts to show that `what` takes its time.
    pub fn spinner(&self, what: &str) -> Progress {
        self.progress(what, None, "{msg} {spinner} {elapsed}")
    }

    fn progress(&self, what: &str, total: Option<u64>, template: &str) -> Progress {
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
        Progress { bar, lines: !self.quiet && !self.is_json(), what, done: 0, next_line: LINE_EVERY }
    }
}

impl Progress {
    /// So many bytes more are done.
    pub fn advance(&mut self, bytes: u64) {
        self.done += bytes;
        match &self.bar {
            Some(bar) => bar.inc(bytes),
            None if self.lines && self.done >= self.next_line => {
                self.next_line = self.done - self.done % LINE_EVERY + LINE_EVERY;
                Screen::stderr(&format!("{} {} KiB\n", self.what, self.done >> 10));
            }
            None => {}
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
