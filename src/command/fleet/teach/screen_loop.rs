//! Event loop of the teach panel: runs the command lines of keys, one motion at a time.

use futures_util::StreamExt as _;
use futures_util::future::FutureExt as _;
use futures_util::stream::FuturesUnordered;
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until};

use super::keys::action;
use super::model::{Model, PanelCommand};
use super::view::{Robot as Shown, draw};
use super::{CommandRunner, Teach};
use crate::command::fleet::poll::{Poll, PollRequest as Looks, RobotId, Subscription};
use crate::command::fleet::top;
use armctl_frame::face::teach_panel::{Panel, SmallStep, Step};
use armctl_frame::interrupt::termination_request;
use armctl_frame::output::fullscreen::{Event, Fullscreen, Keys};
use armctl_frame::output::painter::Palette;
use armctl_frame::prelude::*;

/// Polling interval, and interval of screen updates.
const POLL_INTERVAL: Duration = Duration::from_millis(250);
/// Longest backoff while the robot does not answer.
const MAX_BACKOFF: Duration = Duration::from_secs(1);

enum LoopEvent {
    /// Content of a point.
    Found(u32, Result<Value>),
    /// Result of the command with this number; `true` if other commands wait for it.
    Line(u64, bool, Result<()>),
    /// Result of a step, with its command line, if a command line was run.
    Step(u64, Vec<String>, Result<()>),
}

type Running<'a> = FuturesUnordered<LocalBoxFuture<'a, LoopEvent>>;

/// Shows the panel of a robot. The gate has already authorized it.
pub async fn show(
    screen: &Screen,
    robot: &Robot,
    panel: Panel,
    teach: &Teach,
    lines: &impl CommandRunner,
) -> Result<()> {
    let mut model = Model::new(panel, teach.max_step, teach.max_speed);
    if let Some(SmallStep { words, size }) = panel.small_step {
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        let text = lines.run(&words).await?;
        let sizes = (0..model.system().axes.len()).map(|axis| size(&text, axis)).collect::<Option<Vec<f64>>>();
        model.scale_by(sizes.ok_or_else(|| Failure::local("internal error: no small step for the axes"))?);
    }
    let looks =
        Looks { whole: Some(RobotId::for_robot(robot)), longest_pause: MAX_BACKOFF, ..Looks::every(POLL_INTERVAL) };
    let mut poll = Poll::of(robot.clone(), screen.silenced());
    let mut updates = poll.subscribe(looks);
    let mut polled = poll.run().boxed_local();
    let ended = {
        let terminal = screen.fullscreen()?;
        let (press, keys) = mpsc::unbounded_channel();
        let _keys = Keys::listen(move |event| press.send(event).is_ok());
        let palette = Palette { has_color: screen.stdout_color(), is_unicode: screen.is_unicode() };
        let seen = top::Model::new(std::slice::from_ref(robot), POLL_INTERVAL).without_signals();
        let is_real = !robot.target.value.is_simulated();
        let mut shown = TeachScreen {
            terminal,
            palette,
            model,
            contact: seen,
            is_real_controller: is_real,
            lines,
            start: Instant::now(),
            is_leaving: None,
        };
        tokio::select! {
            ended = shown.run(&mut updates, keys) => ended,
            () = &mut polled => Err(Failure::local("internal error: polling has ended")),
        }
    };
    drop(updates);
    polled.await;
    ended
}

struct TeachScreen<'a, L> {
    terminal: Fullscreen,
    palette: Palette,
    model: Model,
    contact: top::Model,
    is_real_controller: bool,
    lines: &'a L,
    start: Instant,
    /// Result of the panel, after the user quits. The panel ends when no command is in progress.
    is_leaving: Option<Result<()>>,
}

impl<'a, L: CommandRunner> TeachScreen<'a, L> {
    async fn run(&mut self, updates: &mut Subscription, mut events: mpsc::UnboundedReceiver<Event>) -> Result<()> {
        let mut running: Running<'a> = FuturesUnordered::new();
        loop {
            if let Some(leaving) = self.is_leaving.take_if(|_| running.is_empty()) {
                return leaving;
            }
            self.draw()?;
            let next = Instant::now() + POLL_INTERVAL;
            tokio::select! {
                biased;
                event = events.recv() => match event {
                    Some(Event::Key(key)) => {
                        let wish = action(key, self.model.prompt.is_some()).and_then(|action| self.model.handle_key(action));
                        if let Some(wish) = wish {
                            self.execute(wish, &running)?.into_iter().for_each(|line| running.push(line));
                        }
                    }
                    Some(_) => {}
                    None => self.quit(Err(Failure::new(Kind::Interrupted, "the terminal was closed"))),
                },
                Some(done) = running.next(), if !running.is_empty() => self.handle(done),
                // Commands in progress also receive the interrupt, and stop the robot.
                how = termination_request(), if self.is_leaving.is_none() => {
                    self.quit(Err(Failure::new(Kind::Interrupted, how)));
                }
                Some(told) = updates.next() => {
                    self.contact.handle_event(self.start.elapsed(), told);
                }
                () = sleep_until(next) => {}
            }
        }
    }

    fn quit(&mut self, how: Result<()>) {
        if self.is_leaving.is_none() {
            self.is_leaving = Some(how);
        }
    }

    fn draw(&mut self) -> Result<()> {
        let (model, palette) = (&self.model, self.palette);
        self.contact.select_axis(model.axis_name());
        let robot = Shown { seen: &self.contact, now: self.start.elapsed(), is_real: self.is_real_controller };
        self.terminal.draw(|frame| draw(frame, model, &robot, palette))
    }

    /// Starts the command of an action. To quit during a motion, the panel first stops the robot.
    fn execute(&mut self, wish: PanelCommand, running: &Running<'a>) -> Result<Option<LocalBoxFuture<'a, LoopEvent>>> {
        let panel = self.model.panel;
        let line = match wish {
            PanelCommand::Refresh => {
                self.terminal.refresh()?;
                return Ok(None);
            }
            PanelCommand::Quit | PanelCommand::Interrupt => {
                let interrupted = || Err(Failure::new(Kind::Interrupted, "Ctrl-C"));
                self.quit(if wish == PanelCommand::Quit { Ok(()) } else { interrupted() });
                if !self.model.is_moving || running.is_empty() {
                    return Ok(None);
                }
                self.line(to_owned_words(panel.stop), false)
            }
            PanelCommand::Stop => self.line(to_owned_words(panel.stop), false),
            // No new command.
            _ if self.is_leaving.is_some() || self.model.is_moving => return Ok(None),
            PanelCommand::Release => self.line(to_owned_words(panel.release.unwrap_or_default()), true),
            PanelCommand::ReadPoint(point) => {
                let lines = self.lines;
                async move { LoopEvent::Found(point, lines.run(&(panel.stored)(point)).await) }.boxed_local()
            }
            PanelCommand::Store(point) => self.line((panel.store)(point, self.model.system()), true),
            PanelCommand::Go(point) => {
                let speed = self.model.speed().unwrap_or_default();
                self.line((panel.go)(point, self.model.system(), speed), true)
            }
            PanelCommand::Step { axis, by } => self.step(axis, by),
        };
        Ok(Some(line))
    }

    /// Runs a command; with `waits`, other commands wait until it ends.
    fn line(&mut self, words: Vec<String>, waits: bool) -> LocalBoxFuture<'a, LoopEvent> {
        let number = self.model.begin(&words);
        self.model.is_moving |= waits;
        let lines = self.lines;
        async move { LoopEvent::Line(number, waits, lines.run(&words).await.map(|_| ())) }.boxed_local()
    }

    /// Runs a step from the current position.
    fn step(&mut self, axis: usize, by: f64) -> LocalBoxFuture<'a, LoopEvent> {
        let (panel, system, lines) = (self.model.panel, self.model.system(), self.lines);
        let speed = self.model.speed().unwrap_or_default();
        let shown = vec![system.name.to_owned(), self.model.axis_name().to_owned(), format!("{by:+}")];
        let number = self.model.begin(&shown);
        self.model.is_moving = true;
        async move {
            let mut words = shown;
            let report_move = async {
                let from = lines.run(&to_owned_words(panel.position)).await?;
                let step = (system.step)(&Step { axis, by, speed, from: &from });
                words = step.ok_or_else(|| Failure::local("the robot does not report the position of this axis"))?;
                lines.run(&words).await.map(|_| ())
            };
            let outcome = report_move.await;
            LoopEvent::Step(number, words, outcome)
        }
        .boxed_local()
    }

    fn handle(&mut self, done: LoopEvent) {
        match done {
            LoopEvent::Found(point, found) => self.model.point_read(point, found),
            LoopEvent::Line(number, waits, outcome) => {
                self.model.is_moving &= !waits;
                self.model.end(number, outcome);
            }
            LoopEvent::Step(number, words, outcome) => {
                self.model.is_moving = false;
                self.model.set_outcome(number, &words);
                self.model.end(number, outcome);
            }
        }
    }
}

fn to_owned_words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}
