//! DP master of one slave. The steps of an opening are diagnosis, parameters, configuration, diagnosis and data
//! exchange. The master has no port and no clock.
//!
//! The master never sends Clear, because Clear would be an emergency stop for a robot. The first image after every
//! opening is the resting image.

use crate::refuse_if;
use std::collections::VecDeque;
use std::time::Duration;

use super::Now;
use super::error::ProfibusError;
use super::line_check::LineCheck;
use super::request::{Answer, Outcome, Requester};
use super::settings::{Settings, Timing};
use super::wire::{
    Configuration, Control, Diagnosis, Flag, Frame, GlobalControl, Lock, Parameters, Service, Station, Status,
    Telegram, sap,
};

mod answer;
mod view;

use answer::{acknowledged, data};

use crate::image::image_after_loss;
pub use view::{Details, Input, State, Statistics, View, Views};

/// Time limit for a slave to become ready.
const READY: Duration = Duration::from_secs(5);
/// Interval of the diagnosis requests until the slave is ready.
const DIAGNOSIS_INTERVAL: Duration = Duration::from_millis(10);
/// Pause before a link is reopened.
const REOPEN_PAUSE: Duration = Duration::from_secs(1);
/// Default user parameters, in the order in which they are tried. First none, then the three bytes of slaves with
/// acyclic services (DP-V1).
const USUAL_PARAMETERS: [&[u8]; 2] = [&[], &[0, 0, 0]];

/// State of the master.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// The master listens for other traffic.
    Listen,
    /// The master checks whether the station exists (FDL status).
    Find,
    /// The master reads the diagnosis, which contains the state and the owner of the slave.
    Diagnose,
    /// The master reads the configuration (Get_Cfg).
    Ask,
    /// The master sends the parameters (Set_Prm).
    Parameters,
    /// The master sends the configuration (Chk_Cfg).
    Check,
    /// The master reads the diagnosis until the slave is ready.
    Confirm,
    /// The master exchanges data with the slave.
    Data,
    /// The master releases the slave (Set_Prm with unlock).
    Release,
    /// The link is closed.
    Over,
}

/// Task within a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Job {
    Exchange,
    Diagnose,
    Operate,
    Token,
}

/// A DP master.
#[derive(Debug)]
pub struct Master {
    settings: Settings,
    timing: Timing,
    requester: Requester,
    quiet: LineCheck,
    step: Step,
    /// Earliest time of the next request.
    not_before: Now,
    /// Time at which the master first checked whether the slave is ready.
    request_started_at: Option<Now>,
    ident: u16,
    /// Configuration that the slave reports.
    reported_configuration: Option<Vec<u8>>,
    /// Index of the default user parameters in use.
    parameter_index: usize,
    /// Whether this master may have locked the slave.
    locked: bool,
    jobs: VecDeque<Job>,
    is_diagnosing: bool,
    next_cycle: Now,
    /// Time at which the last Operate telegram was sent. This telegram is for all slaves.
    last_operate_at: Now,
    image: Vec<u8>,
    changes: u64,
    /// Number of a change that was not sent yet; `None` if all changes were sent.
    pending: Option<u64>,
    view: View,
    has_changed: bool,
}

impl Master {
    /// Creates a master that starts at `now`.
    pub fn new(now: Now, settings: Settings) -> Result<Self, ProfibusError> {
        let timing = settings.timing()?;
        let details = Details {
            diagnosis: None,
            configuration: None,
            echoes: false,
            cycle: timing.cycle,
            watchdog: timing.watchdog.time(),
        };
        Ok(Self {
            requester: Requester::new(settings.master, settings.rate, timing.slot, settings.retries),
            quiet: LineCheck::until(now + timing.listen),
            step: Step::Listen,
            not_before: now,
            request_started_at: None,
            ident: settings.ident.unwrap_or_default(),
            reported_configuration: None,
            parameter_index: 0,
            locked: false,
            jobs: VecDeque::new(),
            is_diagnosing: false,
            next_cycle: now,
            last_operate_at: now,
            image: settings.resting.clone(),
            changes: 0,
            pending: None,
            settings,
            timing,
            view: View::new(details),
            has_changed: true,
        })
    }

    /// Current state.
    pub fn view(&self) -> View {
        let counters = self.requester.counters();
        let mut view = self.view.clone();
        let Statistics { repeated, noise, unexpected, .. } = &mut view.statistics;
        (*repeated, *noise, *unexpected) = (counters.repeated, counters.noise, counters.unexpected);
        view.details.echoes = self.requester.echoes();
        view
    }

    /// Whether the view has changed after the last call. Counters in the view do not count.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.has_changed)
    }

    /// Sends this image in this generation, starting with the next cycle. Returns the number of the change. When
    /// [`View::sent`] has reached this number, the image was sent.
    ///
    /// # Errors
    /// [`ProfibusError::Outdated`] if the link was lost in the meantime, [`ProfibusError::Settings`] for a wrong size.
    pub fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, ProfibusError> {
        if image.len() != self.settings.output_size {
            let (len, size) = (image.len(), self.settings.output_size);
            return Err(ProfibusError::Settings(format!("the image has {len} bytes, not {size}")));
        }
        self.view.check(generation)?;
        self.image = image.to_vec();
        self.changes += 1;
        self.pending = Some(self.changes);
        Ok(self.changes)
    }

    /// Releases the slave and closes the link.
    pub fn close(&mut self, now: Now) {
        match self.view.state {
            State::Closing | State::Closed => {}
            _ if self.locked => {
                self.set_state(State::Closing);
                self.view.last_error = None;
                self.jobs.clear();
                self.requester.forget(self.settings.station);
                self.requester.wait(now + self.timing.slot);
                self.enter_step(now, Step::Release);
            }
            _ => self.end(),
        }
    }

    /// Handles a failure of the port. The master continues after [`Master::port_is_back`].
    pub fn port_failed(&mut self, now: Now, error: ProfibusError) {
        match self.view.state {
            State::Closed => {}
            State::Open | State::Lost => {
                self.failed(now, error);
                self.listen_until(Now::MAX);
            }
            State::Opening | State::Closing => {
                self.view.last_error = Some(error);
                self.end();
            }
        }
    }

    /// Handles the reopening of the port. The master listens first, then continues.
    pub fn port_is_back(&mut self, now: Now) {
        if self.view.state == State::Lost {
            self.listen_until(now + self.timing.listen);
        }
    }

    /// Time at which [`Master::poll`] must be called again. `None` if the link is closed or has no port.
    pub fn due(&self) -> Option<Now> {
        match self.step {
            Step::Over => None,
            Step::Listen => self.quiet.due(),
            _ if self.requester.is_busy() => Some(self.requester.due()),
            Step::Data if self.jobs.is_empty() => Some(self.next_cycle.max(self.requester.due())),
            _ => Some(self.not_before.max(self.requester.due())),
        }
    }

    /// Returns the bytes to send at `now`.
    pub fn poll(&mut self, now: Now) -> Option<Vec<u8>> {
        match self.requester.poll(now) {
            Some(Ok(bytes)) => return Some(bytes),
            Some(Err(outcome)) => self.outcome(now, outcome),
            None => {}
        }
        if self.step == Step::Listen {
            match self.quiet.poll(now)? {
                Ok(()) => self.enter_step(now, Step::Find),
                Err(error) => self.failed(now, error),
            }
        }
        if self.requester.is_busy() || self.due().is_none_or(|due| now < due) {
            return None;
        }
        let station = self.settings.station;
        let request = |this: &Self, sap: u8, data: Vec<u8>| {
            this.requester.request(Service::SendRequestHigh, station, Some(sap), data)
        };
        let frame = match self.step {
            Step::Find => self.requester.request(Service::FdlStatus, station, None, Vec::new()),
            Step::Diagnose | Step::Confirm => request(self, sap::SLAVE_DIAG, Vec::new()),
            Step::Ask => request(self, sap::GET_CFG, Vec::new()),
            Step::Parameters => {
                self.locked = true;
                request(self, sap::SET_PRM, self.parameters().emit())
            }
            Step::Check => {
                let configuration = self.view.details.configuration.clone().unwrap_or_default();
                request(self, sap::CHK_CFG, configuration)
            }
            Step::Data => return self.run_job(now),
            Step::Release => request(self, sap::SET_PRM, Parameters::unlock(self.ident).emit()),
            Step::Listen | Step::Over => return None,
        };
        Some(self.requester.ask(now, frame))
    }

    /// Handles received bytes.
    pub fn handle(&mut self, now: Now, bytes: &[u8]) {
        match self.step {
            Step::Over => {}
            Step::Listen => {
                if let Err(error) = self.quiet.handle(bytes) {
                    self.failed(now, error);
                }
            }
            _ => {
                let mut bytes = bytes;
                while let Some(outcome) = self.requester.handle(now, std::mem::take(&mut bytes)) {
                    self.outcome(now, outcome);
                }
            }
        }
    }

    /// Executes the next job of a cycle.
    fn run_job(&mut self, now: Now) -> Option<Vec<u8>> {
        if self.jobs.is_empty() {
            self.jobs.push_back(Job::Exchange);
            // Missed cycles are not sent later, so there is no burst.
            let late = now.saturating_sub(self.next_cycle);
            self.next_cycle += self.timing.cycle;
            if late > self.timing.cycle {
                let missed = late.as_nanos() / self.timing.cycle.as_nanos().max(1);
                self.view.statistics.skipped += u64::try_from(missed).unwrap_or(u64::MAX);
                self.next_cycle = now + self.timing.cycle;
            }
            if now.saturating_sub(self.last_operate_at) >= self.timing.watchdog.time() / 3 {
                self.jobs.push_back(Job::Operate);
            }
            self.jobs.push_back(Job::Token);
        }
        match self.jobs.pop_front()? {
            Job::Exchange => {
                let data = self.image.clone();
                let frame = self.requester.request(Service::SendRequestHigh, self.settings.station, None, data);
                self.view.statistics.sent += 1;
                self.is_diagnosing = false;
                if let Some(change) = self.pending.take() {
                    self.view.sent = change;
                    self.has_changed = true;
                }
                Some(self.requester.ask(now, frame))
            }
            Job::Diagnose => {
                self.is_diagnosing = true;
                let station = self.settings.station;
                let service = Service::SendRequestHigh;
                let frame = self.requester.request(service, station, Some(sap::SLAVE_DIAG), Vec::new());
                Some(self.requester.ask(now, frame))
            }
            Job::Operate => {
                self.last_operate_at = now;
                let data = GlobalControl::OPERATE.emit().to_vec();
                let broadcast = super::wire::BROADCAST;
                let frame = self.requester.request(Service::SendHigh, broadcast, Some(sap::GLOBAL_CONTROL), data);
                Some(self.requester.encode_unanswered(now, &Telegram::Frame(frame)))
            }
            // This master is the only master of the ring, so it passes the token to itself.
            Job::Token => {
                let own_address = self.settings.master;
                Some(self.requester.encode_unanswered(now, &Telegram::Token { to: own_address, from: own_address }))
            }
        }
    }

    fn parameters(&self) -> Parameters {
        Parameters {
            lock: Lock::Lock,
            sync: false,
            freeze: false,
            watchdog: Some(self.timing.watchdog),
            min_tsdr: 11,
            ident: self.ident,
            groups: 0,
            user: self.user_parameters(),
        }
    }

    fn user_parameters(&self) -> Vec<u8> {
        self.settings.parameters.clone().unwrap_or_else(|| USUAL_PARAMETERS[self.parameter_index].to_vec())
    }

    fn outcome(&mut self, now: Now, outcome: Outcome) {
        match outcome {
            Outcome::Foreign(master, heard) => self.failed(now, ProfibusError::OtherMaster { master, heard }),
            Outcome::NoAnswer { attempts, heard } => {
                let (station, request_name, slot) = (self.settings.station, self.request_name(), self.timing.slot);
                self.failed(now, ProfibusError::NoAnswer { station, request_name, attempts, slot, heard });
            }
            Outcome::Answer(answer) => {
                if let Err(error) = self.answered(now, answer) {
                    self.failed(now, error);
                }
            }
        }
    }

    /// Name of the current request.
    fn request_name(&self) -> &'static str {
        match self.step {
            Step::Find => "the status request",
            Step::Diagnose | Step::Confirm => sap::name(Some(sap::SLAVE_DIAG)),
            Step::Ask => sap::name(Some(sap::GET_CFG)),
            Step::Parameters => sap::name(Some(sap::SET_PRM)),
            Step::Check => sap::name(Some(sap::CHK_CFG)),
            Step::Release => "the release (Set_Prm)",
            Step::Data if self.is_diagnosing => sap::name(Some(sap::SLAVE_DIAG)),
            Step::Data | Step::Listen | Step::Over => sap::name(None),
        }
    }

    fn answered(&mut self, now: Now, answer: Answer) -> Result<(), ProfibusError> {
        let station = self.settings.station;
        let request_name = self.request_name();
        match self.step {
            Step::Find => {
                let Answer::Frame(Frame { control: Control::Answer(kind, _), .. }) = answer else { return Ok(()) };
                refuse_if(kind != Station::Slave, ProfibusError::IsMaster(station))?;
                self.enter_step(now, Step::Diagnose);
            }
            Step::Diagnose => {
                let diagnosis = self.diagnosis(answer)?;
                self.compare(&diagnosis)?;
                self.image = image_after_loss(&self.settings.resting, &self.image);
                self.enter_step(now, Step::Ask);
            }
            Step::Ask => self.configure(now, answer)?,
            Step::Parameters => {
                acknowledged(station, request_name, &answer)?;
                self.enter_step(now, Step::Check);
            }
            Step::Check => {
                // A slave that has rejected the parameters may refuse the configuration. In this case the master
                // continues, because the diagnosis contains the reason.
                if !matches!(&answer, Answer::Frame(Frame { control: Control::Answer(_, Status::NoService), .. })) {
                    acknowledged(station, request_name, &answer)?;
                }
                self.request_started_at = Some(now);
                self.enter_step(now, Step::Confirm);
            }
            Step::Confirm => self.confirm(now, answer)?,
            Step::Release => {
                self.locked = false;
                self.end();
            }
            Step::Data => self.exchanged(now, answer)?,
            Step::Listen | Step::Over => {}
        }
        Ok(())
    }

    /// Decodes the diagnosis in an answer, and stores it.
    fn diagnosis(&mut self, answer: Answer) -> Result<Diagnosis, ProfibusError> {
        let station = self.settings.station;
        let request_name = sap::name(Some(sap::SLAVE_DIAG));
        let data = data(station, request_name, answer)?.1;
        let diagnosis = Diagnosis::parse(&data).map_err(|error| ProfibusError::Malformed {
            station,
            request_name,
            why: error.to_string(),
        })?;
        if self.view.details.diagnosis.as_ref() != Some(&diagnosis) {
            self.view.details.diagnosis = Some(diagnosis.clone());
            self.has_changed = true;
        }
        Ok(diagnosis)
    }

    /// Checks that the slave has the expected ident number, and that no other master has locked the slave.
    fn compare(&mut self, diagnosis: &Diagnosis) -> Result<(), ProfibusError> {
        let station = self.settings.station;
        if let Some(expected) = self.settings.ident.filter(|expected| *expected != diagnosis.ident) {
            return Err(ProfibusError::Ident { station, found: diagnosis.ident, expected });
        }
        self.ident = diagnosis.ident;
        let master = diagnosis.master.filter(|master| *master != self.settings.master);
        refuse_if(master.is_some() || diagnosis.has(Flag::Locked), ProfibusError::Locked { station, master })?;
        Ok(())
    }

    /// Selects the configuration. If the settings contain none, the master uses the configuration that the slave
    /// reports.
    fn configure(&mut self, now: Now, answer: Answer) -> Result<(), ProfibusError> {
        let station = self.settings.station;
        let request_name = sap::name(Some(sap::GET_CFG));
        let reported_configuration = data(station, request_name, answer);
        self.reported_configuration =
            reported_configuration.as_ref().ok().map(|reported_configuration| reported_configuration.1.clone());
        self.view.details.configuration = match (&self.settings.configuration, reported_configuration) {
            // The configuration in the settings has priority, because a slave may report a default configuration until
            // it has received its real one.
            (Some(set), _) => Some(set.clone()),
            (None, reported_configuration) => {
                let bytes = reported_configuration?.1;
                let configuration = Configuration::parse(&bytes).map_err(|error| ProfibusError::Malformed {
                    station,
                    request_name,
                    why: error.to_string(),
                })?;
                self.settings.fits(&configuration)?;
                Some(bytes)
            }
        };
        self.enter_step(now, Step::Parameters);
        Ok(())
    }

    /// Checks whether the slave is ready for data. If the slave is not ready, selects the next attempt.
    fn confirm(&mut self, now: Now, answer: Answer) -> Result<(), ProfibusError> {
        let diagnosis = self.diagnosis(answer)?;
        let station = self.settings.station;
        if diagnosis.has(Flag::ParameterFault) {
            if self.settings.parameters.is_none() && self.parameter_index + 1 < USUAL_PARAMETERS.len() {
                self.parameter_index += 1;
                self.enter_step(now, Step::Parameters);
                return Ok(());
            }
            let sent = self.user_parameters();
            self.parameter_index = 0;
            return Err(ProfibusError::ParameterFault { station, sent });
        }
        if diagnosis.has(Flag::ConfigurationFault) {
            let sent = self.view.details.configuration.clone().unwrap_or_default();
            return Err(ProfibusError::ConfigurationFault {
                station,
                sent,
                reported_configuration: self.reported_configuration.clone(),
            });
        }
        let is_ready = !diagnosis.has(Flag::NotReady) && !diagnosis.has(Flag::Static);
        if !is_ready || diagnosis.has(Flag::ParametersWanted) {
            let after = now.saturating_sub(self.request_started_at.unwrap_or(now));
            if after >= READY {
                return Err(ProfibusError::NotReady { station, after, diagnosis: Box::new(diagnosis) });
            }
            self.not_before = now + DIAGNOSIS_INTERVAL;
            return Ok(());
        }
        self.compare(&diagnosis)?;
        self.view.generation += 1;
        self.next_cycle = now;
        self.jobs = VecDeque::from([Job::Operate]);
        self.enter_step(now, Step::Data);
        Ok(())
    }

    fn exchanged(&mut self, now: Now, answer: Answer) -> Result<(), ProfibusError> {
        let station = self.settings.station;
        if self.is_diagnosing {
            let diagnosis = self.diagnosis(answer)?;
            let is_ours = diagnosis.master == Some(self.settings.master);
            if !is_ours || [Flag::NotReady, Flag::ParametersWanted].into_iter().any(|flag| diagnosis.has(flag)) {
                return Err(ProfibusError::Left { station, why: diagnosis.to_string() });
            }
            return Ok(());
        }
        let (status, image) = match data(station, sap::name(None), answer) {
            Err(ProfibusError::Refused { status: Status::NoService, .. }) => {
                let why = Status::NoService.text().to_owned();
                return Err(ProfibusError::Left { station, why });
            }
            read => read?,
        };
        if matches!(status, Status::DataNoResource | Status::DataHighNoResource) {
            return Err(ProfibusError::Refused { station, request_name: sap::name(None), status });
        }
        if image.len() != self.settings.input_size {
            let (found, expected) = (image.len(), self.settings.input_size);
            return Err(ProfibusError::Length { station, found, expected });
        }
        if status == Status::DataHigh {
            self.jobs.push_front(Job::Diagnose);
        }
        self.view.statistics.received += 1;
        let generation = self.view.generation;
        self.view.input = Some(Input { image: image.into(), at: now, generation });
        self.has_changed = true;
        if self.view.state != State::Open {
            self.view.last_error = None;
            self.set_state(State::Open);
        }
        Ok(())
    }

    /// Handles an error. During an opening, the error ends the opening. On an open link, it means that the link is
    /// lost.
    fn failed(&mut self, now: Now, error: ProfibusError) {
        self.requester.forget(self.settings.station);
        self.requester.wait(now + self.settings.rate.bits(super::rates::SYNC));
        self.jobs.clear();
        self.pending = None;
        self.request_started_at = None;
        let was_closing = self.view.state == State::Closing;
        let must_be_quiet = matches!(error, ProfibusError::OtherMaster { .. } | ProfibusError::Unreadable(_));
        // Whether the slave has left data exchange while the link was open. The master then retries at once. If this
        // happens again before the link is open, the master waits first.
        let has_left = self.view.state == State::Open
            && matches!(error, ProfibusError::Left { .. } | ProfibusError::Length { .. });
        // The first cause of a loss is more useful than the error of a retry, so it is kept.
        let is_known = matches!(self.view.state, State::Lost | State::Closing) && self.view.last_error.is_some();
        if !is_known || must_be_quiet {
            self.view.last_error = Some(error);
        }
        if self.view.state == State::Opening || was_closing {
            // If this master may have locked the slave, it releases the slave. It does not do this if the release
            // itself failed, or if there is other traffic on the bus.
            if self.locked && !was_closing && !must_be_quiet {
                self.set_state(State::Closing);
                return self.enter_step(now, Step::Release);
            }
            return self.end();
        }
        self.set_state(State::Lost);
        if must_be_quiet {
            return self.listen_until(now + self.timing.listen.max(REOPEN_PAUSE));
        }
        self.step = Step::Find;
        self.not_before = if has_left { now } else { now + REOPEN_PAUSE };
    }

    fn enter_step(&mut self, now: Now, step: Step) {
        self.step = step;
        self.not_before = now;
    }

    fn listen_until(&mut self, until: Now) {
        self.quiet = LineCheck::until(until);
        self.step = Step::Listen;
    }

    fn set_state(&mut self, state: State) {
        self.view.state = state;
        self.has_changed = true;
    }

    fn end(&mut self) {
        self.step = Step::Over;
        self.set_state(State::Closed);
    }
}
