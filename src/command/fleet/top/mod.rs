//! `armctl top`: full-screen live monitor of all robots, or of one robot.
//!
//! | file | contents |
//! |---|---|
//! | `model` | data and selection; no terminal, no link, no clock |
//! | `track` | history of an axis |
//! | `keys` | key bindings and their help |
//! | `view` | screen of a model |

mod keys;
mod model;
#[cfg(test)]
pub(super) mod testing;
mod track;
mod view;

use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until};

use self::keys::{KeyAction, action};
pub use self::model::Model;
use self::view::Palette;
pub use self::view::robot;
use crate::command::fleet::poll::{self, Poll, PollRequest, RobotId, Subscription};
use armctl_frame::interrupt::{catch_interrupts, interruptible};
use armctl_frame::output::Format;
use armctl_frame::output::fullscreen::{Event, Fullscreen, Keys};
use armctl_frame::prelude::*;

/// Full-screen live monitor of one or all robots.
#[derive(Debug, Args)]
#[command(
    after_help = "Without -r, --tag, --sim or -t, top shows all robots in the inventory. --watch INTERVAL sets how \
                  often top polls the robots (500ms). `?` explains the keys. top cannot move a robot or change \
                  anything, because it sends only reads. To a YRCX without a session, top sends only messages. `q` \
                  ends with exit code 0, Ctrl-C with 130."
)]
pub struct Top {}

/// Default and minimum polling interval.
const DEFAULT_INTERVAL: Duration = Duration::from_millis(500);
const MIN_INTERVAL: Duration = Duration::from_millis(50);
/// Minimum time between two screen updates. `TICK` is the maximum time, so that the displayed elapsed times are
/// current.
const FRAME_INTERVAL: Duration = Duration::from_millis(100);
const TICK: Duration = Duration::from_secs(1);
/// Longest backoff of a robot that does not answer. It is short, because a user is waiting.
const MAX_BACKOFF: Duration = Duration::from_secs(4);

impl Top {
    /// Runs the command.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        let every = run.repeat.every.unwrap_or(DEFAULT_INTERVAL);
        check_globals(run, every)?;
        // Messages of links would damage the screen.
        let mut poll = Poll::new(&run.sources, run.screen.silenced())?;
        let screen = run.screen;
        if !screen.can_fill() {
            return Err(Failure::usage("top needs a terminal, but stdout is not a suitable terminal")
                .hint("use `armctl status --watch`; for programs, add -o jsonl")
                .into());
        }
        let model = Model::new(poll.robots(), every);
        let mut updates = poll.subscribe(poll_request(&model));
        let mut polled = Box::pin(poll.run());
        // From here on, the process must restore the terminal before it ends.
        catch_interrupts();
        let palette = Palette { has_color: screen.stdout_color(), is_unicode: screen.is_unicode() };
        let ended = {
            let terminal = screen.fullscreen()?;
            let (press, keys) = mpsc::unbounded_channel();
            let _keys = Keys::listen(move |event| press.send(event).is_ok());
            let mut view = View { terminal, model, palette, updates: &mut updates, start: Instant::now() };
            let shown = interruptible(view.show(keys));
            tokio::select! {
                ended = shown => ended.and_then(|ended| ended),
                // The poller runs as long as it has a consumer.
                () = &mut polled => Err(Failure::local("internal error: polling has ended")),
            }
        };
        // The terminal is restored. The links are closed within a time limit.
        drop(updates);
        polled.await;
        Ok(ended?)
    }
}

/// Rejects options that do not apply to a screen.
fn check_globals(run: &Run, every: Duration) -> Result<(), Failure> {
    let invalid = |what: &str, hint: &str| Err(Failure::usage(format!("top {what}")).hint(hint));
    if run.screen.format != Format::Table || run.filter.is_some() {
        return invalid("is interactive and prints no data", "use `armctl status --watch -o jsonl` in programs");
    }
    if run.repeat.count.is_some() || run.repeat.until.is_some() {
        return invalid(
            "runs until `q`, and cannot wait for a condition",
            "wait with `armctl status --until FILTER`, or end after N polls with --watch and --count N",
        );
    }
    if run.gate.dry_run {
        return invalid("has no dry run: it only reads", "use `armctl status --dry-run` to see some of the reads");
    }
    if run.trace.is_some() {
        return invalid("does not record its traffic", "use --trace with `armctl status --watch`");
    }
    if every < MIN_INTERVAL {
        return invalid("polls at most every 50ms", "use --watch 50ms or more");
    }
    Ok(())
}

fn poll_request(model: &Model) -> PollRequest {
    PollRequest { whole: model.open(), longest_pause: MAX_BACKOFF, ..PollRequest::every(model.every) }
}

/// The screen and its inputs.
#[derive(Debug)]
struct View<'a> {
    terminal: Fullscreen,
    model: Model,
    palette: Palette,
    updates: &'a mut Subscription,
    start: Instant,
}

impl View<'_> {
    /// Runs until a key quits. Updates are drawn together, keys at once.
    async fn show(&mut self, mut events: mpsc::UnboundedReceiver<Event>) -> Result<(), Failure> {
        self.draw()?;
        let mut drawn = Instant::now();
        let mut has_updates = false;
        loop {
            let due = drawn + if has_updates { FRAME_INTERVAL } else { TICK };
            tokio::select! {
                biased;
                event = events.recv() => {
                    let Some(event) = event else { return Err(Failure::new(Kind::Interrupted, "the terminal was closed")) };
                    if self.execute(&event)? {
                        return Ok(());
                    }
                    // Several keys at once make one screen update.
                    if !events.is_empty() {
                        continue;
                    }
                }
                () = sleep_until(due) => {
                    if self.model.is_paused() {
                        drawn = Instant::now();
                        has_updates = false;
                        continue;
                    }
                }
                Some(told) = self.updates.next() => {
                    has_updates |= self.handle_event(told);
                    continue;
                }
            }
            self.draw()?;
            drawn = Instant::now();
            has_updates = false;
        }
    }

    /// Handles a poller event. Returns whether the screen changes.
    fn handle_event(&mut self, message: poll::Event) -> bool {
        let now = self.start.elapsed();
        match message {
            poll::Event::Appeared(robot) => self.model.add_robot(&robot),
            poll::Event::Gone(robot) => self.model.remove_robot(&RobotId::for_robot(&robot)),
            told => return self.model.handle_event(now, told),
        }
        // Another robot can be open now.
        self.updates.update_request(poll_request(&self.model));
        true
    }

    fn draw(&mut self) -> Result<(), Failure> {
        let (model, now, palette) = (&self.model, self.start.elapsed(), self.palette);
        self.terminal.draw(|frame| view::draw(frame, model, now, palette))
    }

    /// Handles a terminal event. Returns whether to quit.
    fn execute(&mut self, event: &Event) -> Result<bool, Failure> {
        let Event::Key(key) = event else { return Ok(false) };
        match action(*key, self.model.is_typing) {
            Some(KeyAction::Quit) => return Ok(true),
            Some(KeyAction::Interrupt) => return Err(Failure::new(Kind::Interrupted, "Ctrl-C")),
            Some(KeyAction::Suspend) => self.terminal.suspend()?,
            Some(KeyAction::Refresh) => self.terminal.refresh()?,
            Some(order) => {
                self.model.handle_key(self.start.elapsed(), order);
                self.updates.update_request(poll_request(&self.model));
            }
            None => {}
        }
        Ok(false)
    }
}
