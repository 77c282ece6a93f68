//! `armctl top`: all robots, or one, as they are now. A picture that fills the terminal.
//!
//! | file | holds |
//! |---|---|
//! | `poller` | looks at one robot again and again, through links that let only reads pass |
//! | `model` | what is known and chosen; no terminal, no line, no clock |
//! | `track` | the past of an axis |
//! | `keys` | what keys order, and how they are explained |
//! | `view` | the picture of a model |

mod keys;
mod model;
mod poller;
#[cfg(test)]
mod testing;
mod track;
mod view;

use std::time::Duration;

use clap::Args;
use futures_util::StreamExt as _;
use futures_util::stream::FuturesUnordered;
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep_until, timeout};

use self::keys::{KeyAction, order};
pub use self::model::Model;
pub use self::poller::{Pace, Update, follow};
use self::view::Palette;
pub use self::view::robot;
use crate::command::families;
use crate::command::frame::attach::identify;
use crate::command::frame::interrupt::{catch_interrupts, interruptible};
use crate::command::frame::run::{Run, RunError};
use crate::failure::{Failure, Kind};
use crate::output::Format;
use crate::output::fullscreen::{Event, Fullscreen, Keys};

/// All robots, or one, live on the whole screen.
#[derive(Debug, Args)]
#[command(
    after_help = "Without -r, --tag, --sim or -t, all robots of the inventory. --watch INTERVAL sets how often they are \
                  looked at (500ms). The keys are on the screen, `?` explains them. Nothing in here can move a robot or \
                  change anything: only reads are sent, and to a YRCX only messages, unless a session has its command. \
                  `q` ends with exit code 0, Ctrl-C with 130."
)]
pub struct Top {}

/// Time from look to look, unless it is told; and the least one.
const EVERY: Duration = Duration::from_millis(500);
const LEAST: Duration = Duration::from_millis(50);
/// Least time between two pictures, and the greatest: times that pass are shown as well.
const PICTURE: Duration = Duration::from_millis(100);
const TICK: Duration = Duration::from_secs(1);
/// How long links may take to close.
const LEAVE_WITHIN: Duration = Duration::from_secs(1);
/// Update that wait to be taken.
const UPDATES: usize = 64;

impl Top {
    /// Does it.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        let every = run.repeat.every.unwrap_or(EVERY);
        fits(run, every)?;
        let mut robots = run.sources.robots(None)?;
        let screen = run.screen;
        if !screen.can_fill() {
            return Err(Failure::usage("top draws on a terminal, and stdout is none that can be drawn on")
                .hint("`armctl status --watch` prints a table again and again; -o jsonl is for programs")
                .into());
        }
        for robot in &mut robots {
            // One that does not answer is shown as that.
            let _ = identify(&run.sources, families::of(robot.family).driver(), robot, false);
        }
        // What links have to say would be written over the picture.
        let silent = screen.silenced();
        let model = Model::new(&robots, every);
        let (pace, _) = watch::channel(pace_of(&model));
        let (tell, updates) = mpsc::channel(UPDATES);
        let share = every / u32::try_from(robots.len().max(1)).unwrap_or(u32::MAX);
        let mut followers: FuturesUnordered<_> = robots
            .into_iter()
            .zip(0_u32..)
            .enumerate()
            .map(|(index, (robot, at))| follow(index, robot, silent, share * at, pace.subscribe(), tell.clone()))
            .collect();
        drop(tell);
        // From here on nothing may end the process that does not give the terminal back.
        catch_interrupts();
        let palette = Palette { has_color: screen.stdout_color(), is_unicode: screen.is_unicode() };
        let ended = {
            let terminal = screen.fullscreen()?;
            let (press, keys) = mpsc::unbounded_channel();
            let _keys = Keys::listen(move |event| press.send(event).is_ok());
            let mut view = View { terminal, model, palette, pace: &pace, start: Instant::now() };
            let shown = interruptible(view.show(updates, keys));
            tokio::select! {
                ended = shown => ended.and_then(|ended| ended),
                // They go on until they are told.
                () = async { while followers.next().await.is_some() {} } => {
                    Err(Failure::local("nobody looks at the robots any more"))
                }
            }
        };
        // The terminal is as it was found. Links are left properly, but nobody waits long for it.
        pace.send_modify(|pace| pace.is_over = true);
        let _left = timeout(LEAVE_WITHIN, async { while followers.next().await.is_some() {} }).await;
        Ok(ended?)
    }
}

/// Refuses what has no meaning on a screen.
fn fits(run: &Run, every: Duration) -> Result<(), Failure> {
    let wrong = |what: &str, hint: &str| Err(Failure::usage(format!("top {what}")).hint(hint));
    if run.screen.format != Format::Table || run.filter.is_some() {
        return wrong("is for people, and prints no data", "`armctl status --watch -o jsonl` is for programs");
    }
    if run.repeat.count.is_some() || run.repeat.until.is_some() {
        return wrong(
            "goes on until `q`, and waits for no condition",
            "`armctl status --until FILTER` waits for one, --count N with --watch ends after so many",
        );
    }
    if run.gate.dry_run {
        return wrong("sends nothing but reads, over and over", "`armctl status --dry-run` shows some of them");
    }
    if run.trace.is_some() {
        return wrong("keeps no record of its traffic", "--trace goes with `armctl status --watch`");
    }
    if every < LEAST {
        return wrong("looks every 50ms at most", "--watch 50ms or more");
    }
    Ok(())
}

fn pace_of(model: &Model) -> Pace {
    Pace { every: model.every, open: model.open(), is_over: false }
}

/// The picture, and what changes it.
#[derive(Debug)]
struct View<'a> {
    terminal: Fullscreen,
    model: Model,
    palette: Palette,
    pace: &'a watch::Sender<Pace>,
    start: Instant,
}

impl View<'_> {
    /// Shows what comes until a key ends it. Update are drawn together, keys at once.
    async fn show(
        &mut self,
        mut updates: mpsc::Receiver<Update>,
        mut events: mpsc::UnboundedReceiver<Event>,
    ) -> Result<(), Failure> {
        self.draw()?;
        let mut drawn = Instant::now();
        let mut has_updates = false;
        loop {
            let due = drawn + if has_updates { PICTURE } else { TICK };
            tokio::select! {
                biased;
                event = events.recv() => {
                    let Some(event) = event else { return Err(Failure::new(Kind::Interrupted, "the terminal was closed")) };
                    if self.heed(&event)? {
                        return Ok(());
                    }
                    // Several keys that came together make one picture.
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
                told = updates.recv() => {
                    if let Some((robot, looked)) = told {
                        self.model.take(self.start.elapsed(), robot, looked);
                        has_updates = true;
                    }
                    continue;
                }
            }
            self.draw()?;
            drawn = Instant::now();
            has_updates = false;
        }
    }

    fn draw(&mut self) -> Result<(), Failure> {
        let (model, now, palette) = (&self.model, self.start.elapsed(), self.palette);
        self.terminal.draw(|frame| view::draw(frame, model, now, palette))
    }

    /// Does what an event asks for; whether it is the end.
    fn heed(&mut self, event: &Event) -> Result<bool, Failure> {
        let Event::Key(key) = event else { return Ok(false) };
        match order(*key, self.model.is_typing) {
            Some(KeyAction::Quit) => return Ok(true),
            Some(KeyAction::Interrupt) => return Err(Failure::new(Kind::Interrupted, "Ctrl-C")),
            Some(KeyAction::Suspend) => self.terminal.suspend()?,
            Some(KeyAction::Refresh) => self.terminal.refresh()?,
            Some(order) => {
                self.model.obey(self.start.elapsed(), order);
                let pace = pace_of(&self.model);
                self.pace.send_if_modified(|last| std::mem::replace(last, pace) != pace);
            }
            None => {}
        }
        Ok(false)
    }
}
