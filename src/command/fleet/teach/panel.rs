//! Event loop of the teach panel: runs the command lines of keys, one motion at a time.

use std::time::Duration;

use futures_util::StreamExt as _;
use futures_util::future::{FutureExt as _, LocalBoxFuture};
use futures_util::stream::FuturesUnordered;
use serde_json::Value;
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until};

use super::keys::order;
use super::model::{Model, Wish};
use super::view::{Robot as Shown, draw};
use super::{Teach, Types};
use crate::command::face::teach_panel::{Panel, SmallStep, Step};
use crate::command::fleet::poll::{Poll, RobotId, Subscription, Wish as Looks};
use crate::command::fleet::top;
use crate::command::frame::interrupt::termination_request;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::fullscreen::{Event, Fullscreen, Keys};
use crate::output::painter::Palette;
use crate::settings::Robot;

/// Polling interval, and interval of screen updates.
const EVERY: Duration = Duration::from_millis(250);
/// Longest backoff while the robot does not answer.
const LONGEST_PAUSE: Duration = Duration::from_secs(1);

enum Done {
    /// Content of a point.
    Found(u32, Result<Value, Failure>),
    /// A command with this number; `true` if others wait for it.
    Line(u64, bool, Result<(), Failure>),
    /// A step, with its command line, if there was one.
    Step(u64, Vec<String>, Result<(), Failure>),
}

type Running<'a> = FuturesUnordered<LocalBoxFuture<'a, Done>>;

/// Shows the panel of a robot. The gate has already authorized it.
pub async fn show(
    screen: &Screen,
    robot: &Robot,
    panel: Panel,
    teach: &Teach,
    lines: &impl Types,
) -> Result<(), Failure> {
    let mut model = Model::new(panel, teach.max_step, teach.max_speed);
    if let Some(SmallStep { words, size }) = panel.small_step {
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        let told = lines.run(&words).await?;
        let sizes = (0..model.system().axes.len()).map(|axis| size(&told, axis)).collect::<Option<Vec<f64>>>();
        model.scale_by(sizes.ok_or_else(|| Failure::local("internal error: no small step for the axes"))?);
    }
    let looks = Looks { whole: Some(RobotId::for_robot(robot)), longest_pause: LONGEST_PAUSE, ..Looks::every(EVERY) };
    let mut poll = Poll::of(robot.clone(), screen.silenced());
    let mut updates = poll.subscribe(looks);
    let mut polled = poll.run().boxed_local();
    let ended = {
        let terminal = screen.fullscreen()?;
        let (press, keys) = mpsc::unbounded_channel();
        let _keys = Keys::listen(move |event| press.send(event).is_ok());
        let palette = Palette { has_color: screen.stdout_color(), is_unicode: screen.is_unicode() };
        let seen = top::Model::new(std::slice::from_ref(robot), EVERY).without_signals();
        let is_real = !robot.target.value.is_simulated();
        let mut shown = Show { terminal, palette, model, seen, is_real, lines, start: Instant::now(), leaving: None };
        tokio::select! {
            ended = shown.run(&mut updates, keys) => ended,
            () = &mut polled => Err(Failure::local("internal error: polling has ended")),
        }
    };
    drop(updates);
    polled.await;
    ended
}

struct Show<'a, L> {
    terminal: Fullscreen,
    palette: Palette,
    model: Model,
    seen: top::Model,
    is_real: bool,
    lines: &'a L,
    start: Instant,
    /// Result of the panel; it ends when no command is in progress.
    leaving: Option<Result<(), Failure>>,
}

impl<'a, L: Types> Show<'a, L> {
    async fn run(
        &mut self,
        updates: &mut Subscription,
        mut events: mpsc::UnboundedReceiver<Event>,
    ) -> Result<(), Failure> {
        let mut running: Running<'a> = FuturesUnordered::new();
        loop {
            if let Some(leaving) = self.leaving.take_if(|_| running.is_empty()) {
                return leaving;
            }
            self.draw()?;
            let next = Instant::now() + EVERY;
            tokio::select! {
                biased;
                event = events.recv() => match event {
                    Some(Event::Key(key)) => {
                        let wish = order(key, self.model.asked.is_some()).and_then(|action| self.model.obey(action));
                        if let Some(wish) = wish {
                            self.heed(wish, &running)?.into_iter().for_each(|line| running.push(line));
                        }
                    }
                    Some(_) => {}
                    None => self.leave(Err(Failure::new(Kind::Interrupted, "the terminal was closed"))),
                },
                Some(done) = running.next(), if !running.is_empty() => self.take(done),
                // Commands in progress also receive the interrupt, and stop the robot.
                how = termination_request(), if self.leaving.is_none() => {
                    self.leave(Err(Failure::new(Kind::Interrupted, how)));
                }
                Some(told) = updates.next() => {
                    self.seen.hear(self.start.elapsed(), told);
                }
                () = sleep_until(next) => {}
            }
        }
    }

    fn leave(&mut self, how: Result<(), Failure>) {
        if self.leaving.is_none() {
            self.leaving = Some(how);
        }
    }

    fn draw(&mut self) -> Result<(), Failure> {
        let (model, palette) = (&self.model, self.palette);
        self.seen.choose_axis(model.axis_name());
        let robot = Shown { seen: &self.seen, now: self.start.elapsed(), is_real: self.is_real };
        self.terminal.draw(|frame| draw(frame, model, &robot, palette))
    }

    /// Starts the command of an action. To quit during a motion, it first stops the robot.
    fn heed(&mut self, wish: Wish, running: &Running<'a>) -> Result<Option<LocalBoxFuture<'a, Done>>, Failure> {
        let panel = self.model.panel;
        let line = match wish {
            Wish::Refresh => {
                self.terminal.refresh()?;
                return Ok(None);
            }
            Wish::Quit | Wish::Interrupt => {
                let interrupted = || Err(Failure::new(Kind::Interrupted, "Ctrl-C"));
                self.leave(if wish == Wish::Quit { Ok(()) } else { interrupted() });
                if !self.model.is_moving || running.is_empty() {
                    return Ok(None);
                }
                self.line(owned(panel.stop), false)
            }
            Wish::Stop => self.line(owned(panel.stop), false),
            // No new command.
            _ if self.leaving.is_some() || self.model.is_moving => return Ok(None),
            Wish::Release => self.line(owned(panel.release.unwrap_or_default()), true),
            Wish::Look(point) => {
                let lines = self.lines;
                async move { Done::Found(point, lines.run(&(panel.stored)(point)).await) }.boxed_local()
            }
            Wish::Store(point) => self.line((panel.store)(point, self.model.system()), true),
            Wish::Go(point) => {
                let speed = self.model.speed().unwrap_or_default();
                self.line((panel.go)(point, self.model.system(), speed), true)
            }
            Wish::Step { axis, by } => self.step(axis, by),
        };
        Ok(Some(line))
    }

    /// Runs a command; with `waits`, others wait for it.
    fn line(&mut self, words: Vec<String>, waits: bool) -> LocalBoxFuture<'a, Done> {
        let number = self.model.begin(&words);
        self.model.is_moving |= waits;
        let lines = self.lines;
        async move { Done::Line(number, waits, lines.run(&words).await.map(|_| ())) }.boxed_local()
    }

    /// Runs a step from the current position.
    fn step(&mut self, axis: usize, by: f64) -> LocalBoxFuture<'a, Done> {
        let (panel, system, lines) = (self.model.panel, self.model.system(), self.lines);
        let speed = self.model.speed().unwrap_or_default();
        let shown = vec![system.name.to_owned(), self.model.axis_name().to_owned(), format!("{by:+}")];
        let number = self.model.begin(&shown);
        self.model.is_moving = true;
        async move {
            let mut words = shown;
            let moved = async {
                let from = lines.run(&owned(panel.position)).await?;
                let step = (system.step)(&Step { axis, by, speed, from: &from });
                words = step.ok_or_else(|| Failure::local("the robot does not report the position of this axis"))?;
                lines.run(&words).await.map(|_| ())
            };
            let outcome = moved.await;
            Done::Step(number, words, outcome)
        }
        .boxed_local()
    }

    fn take(&mut self, done: Done) {
        match done {
            Done::Found(point, found) => self.model.found(point, found),
            Done::Line(number, waits, outcome) => {
                self.model.is_moving &= !waits;
                self.model.end(number, outcome);
            }
            Done::Step(number, words, outcome) => {
                self.model.is_moving = false;
                self.model.was(number, &words);
                self.model.end(number, outcome);
            }
        }
    }
}

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}
