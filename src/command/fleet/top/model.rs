//! State of a live view: robots with their newest samples and a limited history, and the selection. Its input is
//! samples, keys and the time. It has no terminal, no link and no clock.

use std::collections::VecDeque;

use super::keys::KeyAction;
use super::track::Track;
use crate::command::fleet::poll::{Event, RobotId};
use armctl_frame::face::sample::Sample;
use armctl_frame::prelude::*;

/// Time since the view started.
pub type Moment = Duration;

/// Number of answer times kept per robot.
const ANSWERS: usize = 24;
/// Intervals for the keys, ascending.
const INTERVALS: [Duration; 8] = [
    Duration::from_millis(100),
    Duration::from_millis(200),
    Duration::from_millis(500),
    Duration::from_secs(1),
    Duration::from_secs(2),
    Duration::from_secs(5),
    Duration::from_secs(10),
    Duration::from_secs(30),
];
/// An answer is out of date after this number of intervals, but not before this time.
const STALE_AFTER: (u32, Duration) = (3, Duration::from_secs(2));
/// Longest filter.
const FILTER: usize = 40;

/// State of the screen.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent state")]
pub struct Model {
    /// Current robots; a pause shows older data.
    robots: Vec<RobotRow>,
    /// Start and data of a pause.
    frozen: Option<(Moment, Vec<RobotRow>)>,
    /// Polling interval.
    pub every: Duration,
    /// Selected robot.
    pub cursor: usize,
    /// Whether the screen of the selected robot is open.
    pub is_open: bool,
    /// Selected axis.
    pub axis: usize,
    /// Sort order of the list.
    pub sort: Sort,
    /// Filter: part of the name, family, target or a tag.
    pub filter: String,
    /// Whether the filter is being typed.
    pub is_typing: bool,
    /// Whether the help is open.
    pub has_help: bool,
    /// Whether the robot screen shows signals.
    pub has_signals: bool,
}

/// Sort order of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sort {
    /// As selected, or as in the inventory.
    Unsorted,
    /// Most severe first.
    BySeverity,
    /// By name.
    Name,
    /// Slowest answer first.
    Answer,
}

impl Sort {
    const ALL: [(Self, &'static str); 4] = [
        (Self::Unsorted, "inventory order"),
        (Self::BySeverity, "alarms first"),
        (Self::Name, "by name"),
        (Self::Answer, "slowest first"),
    ];

    /// Name of the order.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(sort, _)| *sort == self).map_or("", |(_, name)| name)
    }

    fn next(self) -> Self {
        let at = Self::ALL.iter().position(|(sort, _)| *sort == self).unwrap_or_default();
        Self::ALL[(at + 1) % Self::ALL.len()].0
    }
}

/// A robot of the view.
#[derive(Debug, Clone)]
pub struct RobotRow {
    /// Name.
    pub name: String,
    /// Family.
    pub family: Family,
    /// Target URL.
    pub place: String,
    tags: Vec<String>,
    /// Whether the robot answers.
    pub contact: Contact,
    /// Newest sample and its time.
    pub last: Option<(Moment, Sample)>,
    /// Last answer times, newest last.
    pub answers: VecDeque<Duration>,
    /// History of each axis of the newest full sample.
    pub tracks: Vec<Track>,
}

/// Whether a robot answers.
#[derive(Debug, Clone, PartialEq)]
pub enum Contact {
    /// Not polled yet, or no answer yet.
    Waiting,
    /// The robot answers.
    Reachable,
    /// The last poll failed.
    Unreachable(Failure),
}

/// Severity of a robot's state, in rising order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// No problem.
    None,
    /// On hold, or not polled yet.
    Held,
    /// An alarm or error.
    Alarm,
    /// No answer.
    Silent,
}

impl Model {
    /// Creates a view without data.
    pub fn new(robots: &[Robot], every: Duration) -> Self {
        Self {
            robots: robots.iter().map(RobotRow::new).collect(),
            frozen: None,
            every,
            cursor: 0,
            // A single robot needs no list.
            is_open: robots.len() == 1,
            axis: 0,
            sort: Sort::Unsorted,
            filter: String::new(),
            is_typing: false,
            has_help: false,
            has_signals: true,
        }
    }

    /// Gives the space of the signals to the axes.
    #[must_use]
    pub fn without_signals(self) -> Self {
        Self { has_signals: false, ..self }
    }

    /// Selects an axis by name, if it exists.
    pub fn select_axis(&mut self, name: &str) {
        let axes = self.selected_robot().and_then(RobotRow::sample).and_then(|sample| sample.full.as_ref());
        let found = axes.and_then(|whole| whole.axes.iter().position(|axis| axis.name.eq_ignore_ascii_case(name)));
        self.axis = found.unwrap_or(self.axis);
    }

    /// Handles a poller event of a robot. Returns whether anything is new.
    pub fn handle_event(&mut self, now: Moment, alarm_text: Event) -> bool {
        let (robot, looked) = match alarm_text {
            Event::Polled(look) => {
                // The user can correct an unreadable text file, so show its error.
                let looked = look.unexplained.clone().map_or_else(|| Ok(look.sample.clone()), Err);
                (RobotId::for_robot(&look.robot), looked)
            }
            Event::Failed { robot, failure, .. } => (RobotId::for_robot(&robot), Err(failure)),
            Event::Appeared(_) | Event::Gone(_) | Event::Inventory(_) => return false,
        };
        let at = self.robots.iter().position(|seen| seen.id() == robot);
        if let Some(at) = at {
            self.take(now, at, looked);
        }
        at.is_some()
    }

    /// Adds a robot that was added or changed, unless it is already present.
    pub fn add_robot(&mut self, robot: &Robot) {
        if !self.robots.iter().any(|seen| seen.id() == RobotId::for_robot(robot)) {
            self.robots.push(RobotRow::new(robot));
        }
    }

    /// Removes the row of a robot that was removed.
    pub fn remove_robot(&mut self, robot: &RobotId) {
        let selected = self.selected_robot().map(RobotRow::id);
        self.robots.retain(|seen| seen.id() != *robot);
        self.choose(selected.as_ref());
    }

    /// Selects a robot if it is still present.
    fn choose(&mut self, robot: Option<&RobotId>) {
        let robots = self.robots();
        let at = robots.iter().position(|seen| Some(&seen.id()) == robot);
        let last = robots.len().saturating_sub(1);
        self.is_open &= at.is_some();
        self.cursor = at.unwrap_or(self.cursor.min(last));
        self.keep_cursor();
    }

    /// Handles the result of a poll.
    pub fn take(&mut self, now: Moment, robot: usize, looked: Result<Sample>) {
        let every = self.every;
        if let Some(seen) = self.robots.get_mut(robot) {
            seen.take(now, every, looked);
        }
    }

    /// The shown robots in their original order.
    pub fn robots(&self) -> &[RobotRow] {
        self.frozen.as_ref().map_or(&self.robots, |(_, robots)| robots)
    }

    /// The shown time.
    pub fn displayed_time(&self, now: Moment) -> Moment {
        self.frozen.as_ref().map_or(now, |(since, _)| *since)
    }

    /// Whether the display is paused.
    pub fn is_paused(&self) -> bool {
        self.frozen.is_some()
    }

    /// The robot with the open screen; it is polled in full detail.
    pub fn open(&self) -> Option<RobotId> {
        self.selected_robot().filter(|_| self.is_open).map(RobotRow::id)
    }

    /// The selected robot.
    pub fn selected_robot(&self) -> Option<&RobotRow> {
        self.robots().get(self.cursor)
    }

    /// Indexes of the robots in the list, sorted and filtered.
    pub fn visible_robots(&self) -> Vec<usize> {
        let robots = self.robots();
        let matches_filter = self.filter.to_lowercase();
        let mut listed: Vec<usize> = (0..robots.len()).filter(|robot| robots[*robot].has(&matches_filter)).collect();
        match self.sort {
            Sort::Unsorted => {}
            Sort::BySeverity => listed.sort_by_key(|robot| std::cmp::Reverse(robots[*robot].severity_of())),
            Sort::Name => listed.sort_by(|a, b| robots[*a].name.cmp(&robots[*b].name)),
            Sort::Answer => listed.sort_by_key(|robot| std::cmp::Reverse(robots[*robot].answers.back())),
        }
        listed
    }

    /// Handles a key, except actions of the process, which the caller handles.
    pub fn handle_key(&mut self, now: Moment, order: KeyAction) {
        // Any key closes the help.
        if std::mem::take(&mut self.has_help) {
            return;
        }
        match order {
            KeyAction::Up(steps) if self.is_open => self.axis = self.axis.saturating_sub(steps),
            KeyAction::Down(steps) if self.is_open => self.axis = self.axis.saturating_add(steps).min(self.last_axis()),
            KeyAction::Up(steps) => self.step(|at, _| at.saturating_sub(steps)),
            KeyAction::Down(steps) => self.step(|at, last| at.saturating_add(steps).min(last)),
            KeyAction::Previous => self.step(|at, _| at.saturating_sub(1)),
            KeyAction::Next => self.step(|at, last| (at + 1).min(last)),
            KeyAction::Open => self.is_open = !self.visible_robots().is_empty(),
            KeyAction::Back if !self.is_open => self.filter.clear(),
            KeyAction::Back => self.is_open = false,
            KeyAction::Sort => self.sort = self.sort.next(),
            KeyAction::Pause if self.is_paused() => {
                let chosen = self.selected_robot().map(RobotRow::id);
                self.frozen = None;
                self.choose(chosen.as_ref());
            }
            KeyAction::Pause => self.frozen = Some((now, self.robots.clone())),
            KeyAction::Faster => self.every = nearest(self.every, true),
            KeyAction::Slower => self.every = nearest(self.every, false),
            KeyAction::Help => self.has_help = true,
            KeyAction::Filter => (self.is_typing, self.is_open) = (true, false),
            KeyAction::Type(character) if self.filter.chars().count() < FILTER => self.filter.push(character),
            KeyAction::Erase => _ = self.filter.pop(),
            KeyAction::ApplyFilter => self.is_typing = false,
            KeyAction::CancelFilter => (self.is_typing, self.filter) = (false, String::new()),
            KeyAction::Type(_) | KeyAction::Quit | KeyAction::Interrupt | KeyAction::Suspend | KeyAction::Refresh => {}
        }
        self.keep_cursor();
    }

    /// Moves the selection in the list.
    fn step(&mut self, to: impl FnOnce(usize, usize) -> usize) {
        let listed = self.visible_robots();
        let at = listed.iter().position(|robot| *robot == self.cursor).unwrap_or_default();
        if let Some(robot) = listed.get(to(at, listed.len().saturating_sub(1))) {
            self.cursor = *robot;
        }
        let axis = self.axis.min(self.last_axis());
        self.axis = axis;
    }

    /// Keeps the selection on a robot of the list.
    fn keep_cursor(&mut self) {
        let listed = self.visible_robots();
        if !self.is_open
            && !listed.contains(&self.cursor)
            && let Some(first) = listed.first()
        {
            self.cursor = *first;
        }
    }

    fn last_axis(&self) -> usize {
        self.selected_robot().map_or(0, |seen| seen.tracks.len().saturating_sub(1))
    }
}

impl RobotRow {
    fn new(robot: &Robot) -> Self {
        Self {
            name: robot.name.clone(),
            family: robot.family,
            place: robot.target.value.url().to_owned(),
            tags: robot.tags.iter().cloned().chain(robot.place.tags()).collect(),
            contact: Contact::Waiting,
            last: None,
            answers: VecDeque::with_capacity(ANSWERS),
            tracks: Vec::new(),
        }
    }

    /// Unique id.
    pub fn id(&self) -> RobotId {
        RobotId { name: self.name.clone(), family: self.family }
    }

    /// Whether its name, family, target or a tag contains this text.
    fn has(&self, wanted: &str) -> bool {
        let own = [self.name.as_str(), self.family.name(), self.place.as_str()];
        own.into_iter().chain(self.tags.iter().map(String::as_str)).any(|text| text.to_lowercase().contains(wanted))
    }

    fn take(&mut self, now: Moment, every: Duration, looked: Result<Sample>) {
        let sample = match looked {
            Ok(sample) => sample,
            Err(failure) => {
                self.contact = Contact::Unreachable(failure);
                return;
            }
        };
        self.contact = Contact::Reachable;
        if let Some(answered_in) = sample.answered_in {
            if self.answers.len() == ANSWERS {
                self.answers.pop_front();
            }
            self.answers.push_back(answered_in);
        }
        if let Some(whole) = &sample.full {
            if !Track::fit(&self.tracks, &whole.axes) {
                self.tracks = whole.axes.iter().map(Track::new).collect();
            }
            for (track, axis) in self.tracks.iter_mut().zip(&whole.axes) {
                track.push(now, every, axis);
            }
        }
        let whole = sample.full.or_else(|| self.last.take().and_then(|(_, last)| last.full));
        self.last = Some((now, Sample { full: whole, ..sample }));
    }

    /// Newest sample, while the robot answers.
    pub fn sample(&self) -> Option<&Sample> {
        let answers = matches!(self.contact, Contact::Reachable);
        self.last.as_ref().filter(|_| answers).map(|(_, sample)| sample)
    }

    /// Time since the last answer.
    pub fn age(&self, now: Moment) -> Option<Duration> {
        self.last.as_ref().map(|(then, _)| now.saturating_sub(*then))
    }

    /// Whether the last answer is out of date.
    pub fn is_stale(&self, now: Moment, every: Duration) -> bool {
        let (intervals, least) = STALE_AFTER;
        self.age(now).is_some_and(|age| age > every.saturating_mul(intervals).max(least))
    }

    /// Severity of its state.
    pub fn severity_of(&self) -> Severity {
        if let Contact::Unreachable(_) = self.contact {
            return Severity::Silent;
        }
        let Some(line) = self.sample().map(|sample| &sample.line) else { return Severity::Held };
        match (line.state.fault.faulted == Some(true), line.state.held) {
            (true, _) => Severity::Alarm,
            (_, Some(true)) => Severity::Held,
            _ => Severity::None,
        }
    }

    /// Short alarm text and its tone.
    pub fn alarm(&self) -> (String, Tone) {
        if let Contact::Unreachable(failure) = &self.contact {
            return (format_short(failure.kind).to_owned(), Tone::Bad);
        }
        let Some(sample) = self.sample() else { return ("waiting".to_owned(), Tone::Plain) };
        sample.line.fault_text().map_or_else(Default::default, |told| (told, Tone::Bad))
    }
}

/// Short reason for a missing sample.
fn format_short(kind: Kind) -> &'static str {
    match kind {
        Kind::NoAnswer => "no answer",
        Kind::Refused => "refuses to report",
        Kind::Malformed => "invalid answer",
        _ => "cannot be read",
    }
}

/// Next faster or slower interval.
fn nearest(every: Duration, faster: bool) -> Duration {
    let found = if faster {
        INTERVALS.into_iter().rev().find(|interval| *interval < every)
    } else {
        INTERVALS.into_iter().find(|interval| *interval > every)
    };
    found.unwrap_or(every)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{fail, fleet, sample};
    use super::*;
    use armctl_frame::robot::state::Fault;

    const NOW: Moment = Duration::from_secs(10);
    const POLL_INTERVAL: Duration = Duration::from_millis(500);

    fn names(model: &Model) -> Vec<&str> {
        model.visible_robots().into_iter().map(|robot| model.robots()[robot].name.as_str()).collect()
    }

    #[test]
    fn sorts_by_severity() {
        let mut model = Model::new(&fleet(4), POLL_INTERVAL);
        model.take(NOW, 0, Ok(sample(0.0)));
        model.take(NOW, 1, Err(fail()));
        let mut alarmed = sample(0.0);
        alarmed.line.state.fault = Fault::new(true, None);
        model.take(NOW, 2, Ok(alarmed));
        assert_eq!(names(&model), ["cell1", "cell2", "cell3", "cell4"]);
        model.handle_key(NOW, KeyAction::Sort);
        assert_eq!(names(&model), ["cell2", "cell3", "cell4", "cell1"]);
        assert_eq!(model.robots()[1].alarm(), ("no answer".to_owned(), Tone::Bad));
    }

    #[test]
    fn filter_keeps_the_cursor_in_the_list() {
        let mut model = Model::new(&fleet(12), POLL_INTERVAL);
        model.handle_key(NOW, KeyAction::Filter);
        "L1".chars().for_each(|character| model.handle_key(NOW, KeyAction::Type(character)));
        assert_eq!(names(&model), ["cell1", "cell10", "cell11", "cell12"]);
        model.handle_key(NOW, KeyAction::Type('2'));
        assert_eq!((names(&model), model.cursor), (vec!["cell12"], 11));
        model.handle_key(NOW, KeyAction::Type('x'));
        assert!(names(&model).is_empty());
        model.handle_key(NOW, KeyAction::ApplyFilter);
        model.handle_key(NOW, KeyAction::Open);
        assert!(!model.is_open, "no window can open");
        model.handle_key(NOW, KeyAction::Back);
        assert_eq!((model.visible_robots().len(), model.cursor), (12, 11));
    }

    #[test]
    fn pause_freezes_the_display_without_losing_data() {
        let mut model = Model::new(&fleet(1), POLL_INTERVAL);
        model.take(NOW, 0, Ok(sample(1.0)));
        model.handle_key(NOW, KeyAction::Pause);
        let later = NOW + POLL_INTERVAL;
        model.take(later, 0, Ok(sample(2.0)));
        assert_eq!(model.robots()[0].tracks[0].positions.len(), 1);
        assert_eq!(model.displayed_time(later), NOW);
        model.handle_key(later, KeyAction::Pause);
        assert_eq!(model.robots()[0].tracks[0].positions.len(), 2);
        assert_eq!(model.displayed_time(later), later);
    }

    #[test]
    fn polls_full_detail_of_the_open_robot_only() {
        let mut model = Model::new(&fleet(2), POLL_INTERVAL);
        assert_eq!(model.open(), None);
        model.handle_key(NOW, KeyAction::Open);
        let id = |model: &Model, at: usize| Some(model.robots[at].id());
        assert_eq!(model.open(), id(&model, 0));
        model.handle_key(NOW, KeyAction::Next);
        assert_eq!(model.open(), id(&model, 1));
        model.handle_key(NOW, KeyAction::Back);
        assert_eq!(model.open(), None);
        let single = Model::new(&fleet(1), POLL_INTERVAL);
        assert_eq!(single.open(), id(&single, 0), "a single one needs no list");
    }

    #[test]
    fn changes_the_interval_in_steps() {
        let mut model = Model::new(&fleet(1), Duration::from_millis(300));
        model.handle_key(NOW, KeyAction::Faster);
        assert_eq!(model.every, Duration::from_millis(200));
        (0..9).for_each(|_| model.handle_key(NOW, KeyAction::Faster));
        assert_eq!(model.every, Duration::from_millis(100));
        (0..9).for_each(|_| model.handle_key(NOW, KeyAction::Slower));
        assert_eq!(model.every, Duration::from_secs(30));
    }

    #[test]
    fn hides_outdated_data_of_a_silent_robot() {
        let mut model = Model::new(&fleet(1), POLL_INTERVAL);
        model.take(NOW, 0, Ok(sample(1.0)));
        model.take(NOW + POLL_INTERVAL, 0, Err(fail()));
        let seen = &model.robots()[0];
        assert_eq!(seen.sample(), None);
        assert_eq!(seen.age(NOW + POLL_INTERVAL), Some(POLL_INTERVAL));
        assert!(seen.is_stale(NOW + Duration::from_secs(3), POLL_INTERVAL));
        model.take(NOW + 2 * POLL_INTERVAL, 0, Ok(sample(2.0)));
        assert!(model.robots()[0].sample().is_some());
    }

    #[test]
    fn cursor_stays_at_its_robot() {
        let robots = fleet(4);
        let mut model = Model::new(&robots[..3], POLL_INTERVAL);
        model.handle_key(NOW, KeyAction::Down(2));
        model.handle_key(NOW, KeyAction::Open);
        model.add_robot(&robots[0]);
        assert_eq!(names(&model), ["cell1", "cell2", "cell3"], "one that is known is not there twice");
        model.remove_robot(&RobotId::for_robot(&robots[0]));
        assert_eq!((names(&model), model.cursor, model.is_open), (vec!["cell2", "cell3"], 1, true));
        model.add_robot(&robots[3]);
        assert_eq!(model.selected_robot().map(|seen| seen.name.as_str()), Some("cell3"));
        // A pause shows old data. After it, the same robot is selected.
        model.handle_key(NOW, KeyAction::Pause);
        model.remove_robot(&RobotId::for_robot(&robots[1]));
        assert_eq!(names(&model), ["cell2", "cell3", "cell4"]);
        model.handle_key(NOW, KeyAction::Pause);
        assert_eq!((names(&model), model.cursor, model.is_open), (vec!["cell3", "cell4"], 0, true));
        model.remove_robot(&RobotId::for_robot(&robots[2]));
        assert_eq!((names(&model), model.is_open), (vec!["cell4"], false), "nothing is shown of one that has gone");
        model.remove_robot(&RobotId::for_robot(&robots[3]));
        assert!(model.selected_robot().is_none() && model.open().is_none());
    }

    #[test]
    fn cursor_stays_in_range() {
        let mut model = Model::new(&fleet(3), POLL_INTERVAL);
        model.handle_key(NOW, KeyAction::Down(99));
        assert_eq!(model.cursor, 2);
        model.handle_key(NOW, KeyAction::Up(99));
        assert_eq!(model.cursor, 0);
        model.take(NOW, 0, Ok(sample(0.0)));
        model.handle_key(NOW, KeyAction::Open);
        model.handle_key(NOW, KeyAction::Down(99));
        assert_eq!(model.axis, model.robots()[0].tracks.len() - 1);
        model.handle_key(NOW, KeyAction::Next);
        assert_eq!((model.cursor, model.axis), (1, 0));
        let mut empty = Model::new(&[], POLL_INTERVAL);
        for order in [
            KeyAction::Down(1),
            KeyAction::Up(1),
            KeyAction::Next,
            KeyAction::Previous,
            KeyAction::Open,
            KeyAction::Back,
        ] {
            empty.handle_key(NOW, order);
        }
        assert!(empty.selected_robot().is_none());
    }
}
