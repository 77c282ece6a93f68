//! Connection to a controller for commands: the client, with error messages, a trace of the traffic, and a journal of
//! temporary changes.

mod abandoned_changes;
mod observer;

use std::sync::Mutex;

use derive_more::{Deref, DerefMut};

use super::change_journal::{AbandonedEntry, ChangeJournal};
use super::connect;
use super::failure::failure;
pub use super::failure::{misuse, wrong};
use super::position::Coordinates;
use super::program::source_texts::SourceTexts;
use super::refusal;
use super::trace::Trace;
use super::user_choices::UserChoices;
use super::write_log::WriteLog;
use crate::prelude::basics::*;
use armctl_client::toyo::{Client, Error, Line, is_stop, status_page};
pub use armctl_client::toyo::{MotionKind, Refusal, jog};
use armctl_controller::toyo::request::Answer;
use armctl_controller::toyo::session::Counters;
use armctl_controller::toyo::table::Command;
use armctl_frame::Family;
use armctl_frame::dry_run::Plan;
use armctl_frame::face::sample::{Traffic, counter};
use armctl_frame::settings::target;
use armctl_frame::settings_report::{OLD_VALUE, nothing_written};
use armctl_frame::trace::lock_writer;
use observer::{Observer, PrintedNotices, SharedObserver};

/// The toyo family.
#[derive(Debug)]
pub struct Toyo;

/// A connection to one controller. Operations that cannot fail are available through the client, to which the link
/// dereferences.
#[derive(Debug, Deref, DerefMut)]
pub struct Link {
    #[deref]
    #[deref_mut]
    client: Client,
    observer: Arc<Mutex<Observer>>,
    screen: Screen,
    label: String,
    /// Changes that other processes left on the controller when they ended, and that were not reported yet.
    abandoned: Vec<AbandonedEntry>,
    /// Log of the writes to the EEPROM.
    pub(super) write_log: WriteLog,
    /// Source texts of the programs that armctl wrote.
    pub(super) sources: SourceTexts,
}

impl Family for Toyo {
    const FAMILY: Option<target::Family> = Some(target::Family::Toyo);
    type Link = Link;
    const STOP: &'static [&'static str] = &["stop"];

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link> {
        Link::of(connect::open(robot, &access, screen).await?, robot, &access, screen)
    }

    async fn halt(link: &mut Link) -> Result<String> {
        let Some(moving) = link.moving() else { return Ok("no motion command was sent".to_owned()) };
        // The stop is sent before anything is printed, because a blocked terminal must not delay it.
        link.send_urgent(moving).await;
        let stop = moving.stop().text();
        link.screen.note(&format!("stopping the robot: {stop}"));
        let coordinates = link.stop(moving).await?;
        let coordinates = link.coordinates(&coordinates).await;
        Ok(format!("the robot was stopped ({stop}); the axes are at {}", coordinates.in_a_line()))
    }

    fn needs_halt(link: &Link) -> bool {
        link.moving() == Some(MotionKind::Jog)
    }

    /// A serial port and a device server have only one line each.
    fn takes_one_client(robot: &Robot) -> bool {
        matches!(robot.target.value.place, target::Place::Serial(_) | target::Place::Tcp(_))
    }

    fn planned(link: &mut Link) -> Plan {
        link.take_plan()
    }

    async fn settle(link: &mut Link) -> Result<()> {
        let settled = link.client.settle().await;
        settled.map_err(|error| link.failure(error))
    }

    async fn close(mut link: Link, screen: &Screen) -> Result<()> {
        link.report_abandoned_changes().await;
        let Link { client, observer, label, mut write_log, .. } = link;
        let (totals, closed) = client.close().await;
        // Motion that continues on purpose was already reported, so it is not in the journal.
        lock_writer(&observer).journal.moving(None);
        let Counters { sent, received, .. } = totals.counters;
        screen.detail(1, &format!("{sent} blocks sent, {received} received in {:.1?}", totals.waited));
        if let Some(counts) = counter(&disturbances(&totals.counters)) {
            screen.detail(1, &format!("on the line: {counts}"));
        }
        if let Err(error) = write_log.keep() {
            screen.detail(1, &format!("the EEPROM write log could not be saved: {error}"));
        }
        closed.map_err(|error| failure(&label, error)).and(lock_writer(&observer).trace.finish())
    }
}

/// Counters of disturbances on the line, with their names.
fn disturbances(counters: &Counters) -> [(u64, &'static str); 5] {
    let Counters { sent: _, received: _, noise, garbled, foreign, echoes, repeats } = *counters;
    [
        (noise.into(), "stray characters"),
        (garbled.into(), "garbled"),
        (foreign.into(), "foreign or late"),
        (echoes.into(), "echoes"),
        (repeats.into(), "repeated"),
    ]
}

impl Link {
    /// Traffic counters of the connection.
    pub(super) fn traffic(&self) -> Traffic {
        let Counters { sent, received, .. } = self.client.totals().counters;
        let disturbances = disturbances(&self.client.totals().counters).iter().map(|(count, _)| count).sum();
        Traffic { sent: sent.into(), received: received.into(), disturbances }
    }

    /// Creates a link from a client.
    pub(super) fn of(mut client: Client, robot: &Robot, access: &Access, screen: &Screen) -> Result<Self> {
        let (target, label) = (robot.target.value.to_string(), robot.label());
        let has_files = !robot.target.value.is_simulated();
        let write_log = if has_files { WriteLog::of(&target) } else { WriteLog::without_file() };
        let (journal, choices) = if has_files && !access.dry_run {
            (ChangeJournal::of(&target), UserChoices::of(&target))
        } else {
            (ChangeJournal::without_files(), UserChoices::without_file())
        };
        let abandoned = journal.abandoned_entries();
        let trace = Trace::open(access, screen, client.address_pair())?;
        let (screen, printed) = (*screen, PrintedNotices::from_journal(&abandoned));
        let observer = Observer { trace, journal, choices, printed, screen, label: label.clone() };
        let observer = Arc::new(Mutex::new(observer));
        client.watch(SharedObserver(Arc::clone(&observer)));
        let sources = if access.dry_run { SourceTexts::default() } else { SourceTexts::of(robot) };
        Ok(Self { client, observer, screen, label, abandoned, write_log, sources })
    }

    /// Returns the line for a session; `None` in a dry run.
    pub(super) fn into_line(self) -> Option<Line> {
        self.client.into_line()
    }

    /// Sends a request. A refusal is a failure.
    pub async fn ask(&mut self, request: &Request) -> Result<Record> {
        match self.try_ask(request).await? {
            Ok(record) => Ok(record),
            Err(Refusal(request)) => Err(refusal::with_reason(self, &request).await),
        }
    }

    /// Sends a request. A refusal is a valid result.
    pub async fn try_ask(&mut self, request: &Request) -> Result<Result<Record, Refusal>> {
        self.report_abandoned_changes().await;
        self.before_steps_change(request);
        self.client.try_ask(request).await.map_err(|error| self.failure(error))
    }

    /// Marks the stored source text as uncertain. This is done before a command changes steps in another way than
    /// `program put` does.
    fn before_steps_change(&mut self, request: &Request) {
        let changes =
            [Command::Wstx, Command::Istx, Command::Dstx, Command::Dstl, Command::Cpss, Command::Mint, Command::Rmca];
        if changes.contains(&request.command()) {
            self.sources.mark_uncertain();
        }
    }

    /// Sends a request unchanged, and returns the whole answer, even if it is a refusal.
    pub async fn raw(&mut self, request: &Request) -> Result<Answer> {
        if !is_stop(request) {
            self.report_abandoned_changes().await;
        }
        self.before_steps_change(request);
        self.client.raw(request).await.map_err(|error| self.failure(error))
    }

    /// Sends a block that is not in the command table, and returns the answer.
    pub async fn raw_text(&mut self, block: &str) -> Result<String> {
        self.report_abandoned_changes().await;
        self.sources.mark_uncertain();
        self.client.raw_text(block).await.map_err(|error| self.failure(error))
    }

    /// Reads the value that a write replaces. Returns `None` if the controller refuses to report it. A dry run records
    /// the request and returns `None`. If the line is lost, the failure states that nothing was written.
    pub async fn before(&mut self, question: &Request) -> Result<Option<Record>> {
        if self.is_dry_run() {
            self.plan(question, OLD_VALUE);
            return Ok(None);
        }
        Ok(self.try_ask(question).await.map_err(nothing_written)?.ok())
    }

    /// Reads one page of the status before a write. The other pages are 0.
    pub async fn status_before(&mut self, page: u8) -> Result<Option<Status>> {
        let record = self.before(&status_page(page)).await?;
        Ok(record.and_then(|record| record.byte("st1")).map(|byte| Status::default().with(page, byte)))
    }

    /// Reads all five pages of the status.
    pub async fn status(&mut self) -> Result<Status> {
        self.status_of(&[0, 1, 2, 3, 4]).await
    }

    /// Reads some pages of the status. The other pages are 0.
    pub async fn status_of(&mut self, pages: &[u8]) -> Result<Status> {
        self.report_abandoned_changes().await;
        self.client.status_of(pages).await.map_err(|error| self.failure(error))
    }

    /// Reads the position of the axes. The reason for a refusal is not read, because this takes time, and the
    /// controller is only busy for a moment.
    pub async fn read_position(&mut self) -> Result<Record> {
        self.report_abandoned_changes().await;
        self.client.read_position().await.map_err(|error| self.failure(error))
    }

    /// Reads the letters of the axes from the controller.
    pub async fn letters(&mut self) -> Result<Letters> {
        self.report_abandoned_changes().await;
        self.client.letters().await.map_err(|error| self.failure(error))
    }

    /// Converts a position record for a report. If the letters of the axes cannot be read, the report names the axes by
    /// number.
    pub async fn coordinates(&mut self, record: &Record) -> Coordinates {
        Coordinates::of(record, self.letters().await.unwrap_or(Letters::UNKNOWN))
    }

    /// Changes a setting temporarily. [`Link::put_back`], or the end of the link, restores the setting with `back`.
    pub async fn borrow(&mut self, change: &Request, back: Request) -> Result<()> {
        self.report_abandoned_changes().await;
        match self.client.borrow(change, back).await {
            Err(Error::Refused(Refusal(request))) => Err(refusal::with_reason(self, &request).await),
            borrowed => borrowed.map_err(|error| self.failure(error)),
        }
    }

    /// Restores all settings that [`Link::borrow`] changed. If this fails for a setting, continues with the others and
    /// returns the first failure.
    pub async fn put_back(&mut self) -> Result<()> {
        self.client.put_back().await.map_err(|error| self.failure(error))
    }

    /// Stops the motion, and returns the position at rest.
    pub async fn stop(&mut self, moving: MotionKind) -> Result<Record> {
        // Changes of earlier processes are reported after the stop.
        let printed = std::mem::replace(&mut lock_writer(&self.observer).printed, PrintedNotices::ALL);
        let stopped = self.client.stop(moving).await;
        let mut observer = lock_writer(&self.observer);
        observer.printed = printed;
        observer.trace.resume();
        stopped.map_err(|error| self.failure(error))
    }

    /// Stops a motion that the controller refused before it began. The stop is sent only once.
    pub async fn stop_refused_motion(&mut self, moving: MotionKind) {
        self.client.stop_refused_motion(moving).await;
        lock_writer(&self.observer).trace.resume();
    }

    /// Sets short timeouts that detect a lost connection early, and buffers trace text until [`Link::stop`]. Neither
    /// long timeouts nor a blocked terminal may delay the stop.
    pub fn use_short_timeouts(&mut self) {
        self.client.use_short_timeouts();
        lock_writer(&self.observer).trace.pause();
    }

    /// Records that the user chose the present state of the host.
    pub fn choose_host(&mut self, is_on: bool) {
        lock_writer(&self.observer).choose_host(is_on);
    }

    /// Records that the user chose this task as the current task.
    pub fn choose_task(&mut self, task: u8) {
        lock_writer(&self.observer).choose_task(task);
    }

    /// In a dry run, records requests. Their answers are not known.
    pub fn plan_all(&mut self, requests: &[Request]) -> Result<()> {
        self.client.plan_all(requests).map_err(|error| self.failure(error))
    }

    /// In a dry run, records a command after the requests that precede every command. `on` is the earlier answer that
    /// determines whether the command is sent.
    pub async fn plan_order(&mut self, text: &str, on: &str) -> Result<()> {
        self.client.plan_order(text, on).await.map_err(|error| self.failure(error))
    }

    /// In a dry run, records a temporary change. `back` restores the setting; `?` in it stands for the value that was
    /// read.
    pub async fn plan_to_borrow(&mut self, change: &Request, back: &str, on: &str) -> Result<()> {
        self.client.plan_to_borrow(change, back, on).await.map_err(|error| self.failure(error))
    }

    /// Failure: an answer makes no sense.
    pub fn malformed(&self, block: &str, why: &str) -> Failure {
        self.failure(Error::Malformed { block: block.to_owned(), why: why.to_owned() })
    }

    fn failure(&self, error: Error) -> Failure {
        failure(&self.label, error)
    }
}
