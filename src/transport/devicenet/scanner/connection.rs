//! Master side of a connection: allocation, image sizes, polling, loss detection, reopening.
//!
//! Each opening of the connection starts a new generation. The caller must name the generation with every image. After
//! a loss, the master sends the resting image. It sends another image only when a caller that has seen the loss sets
//! one. Therefore an image from before the loss is never sent again.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use super::polling::{PollResult, Polling};
use super::transaction::{Outcome, RequestSender};
use super::view::{Details, Input, State, View};
use super::{Bus, Token};
use crate::devicenet::Now;
use crate::devicenet::can::Frame;
use crate::devicenet::error::Error;
use crate::devicenet::settings::{Purpose, Settings};
use crate::devicenet::wire::{Answer, Id, Mac, Request, class, connection, general, owner};
use crate::image::image_after_loss;

/// Pauses before attempts to reopen a lost connection. The last pause repeats.
const BACKOFF: [Duration; 3] = [Duration::from_secs(1), Duration::from_secs(2), Duration::from_secs(5)];
/// Keepalive interval. The slave closes an explicit connection after 10 s of silence.
const KEEP_ALIVE: Duration = Duration::from_secs(3);
const ALLOCATION: &str = "the allocation of its connections";
const OWNER: &str = "the read of the owner of its connections";
const RELEASE: &str = "the release of its connections";
const PRODUCED: &str = "the read of its image size";
const CONSUMED: &str = "the read of its output image size";
const RATE: &str = "the setting of the packet rate";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    // The master is not on line yet.
    New,
    // The master allocates the connections. `again` is `true` for the second attempt, after the owner was read.
    Allocating { is_retry: bool },
    // The master reads which connections its own MAC owns.
    AskingOwner,
    // The master releases connections that an earlier use of this MAC has left allocated.
    Freeing,
    // The master reads the size of the image from the slave.
    AskingProduced,
    // The master reads the size of the image to the slave. The value is the size of the image from the slave.
    AskingConsumed(u16),
    // The master sets the packet rate, which establishes the connection.
    SettingRate,
    Open,
    // The master releases the connections. Then the connection ends. If `again` is `true`, it opens again.
    Releasing { is_retry: bool },
    // The master waits until the next attempt to open the connection.
    BoxedFuture(Now),
    Ended,
}

/// Result of a request of a caller.
pub(super) type Reply = (Token, Result<Answer, Error>);

/// A connection to a slave.
#[derive(Debug)]
pub(super) struct Connection {
    settings: Settings,
    own_mac: Mac,
    phase: Phase,
    requester: RequestSender,
    polling: Option<Polling>,
    image: Vec<u8>,
    revision: u64,
    is_over: bool,
    tries: usize,
    /// Waiting requests of callers.
    requests: VecDeque<(Token, Request)>,
    /// Token of the request in progress; `None` for an internal request.
    current_request: Option<Token>,
    replies: VecDeque<Reply>,
    keep_alive: Now,
    view: View,
    has_changed: bool,
}

impl Connection {
    pub(super) fn new(own_mac: Mac, settings: Settings) -> Self {
        Self {
            requester: RequestSender::new(own_mac, settings.slave, settings.timeout),
            settings,
            own_mac,
            phase: Phase::New,
            polling: None,
            image: Vec::new(),
            revision: 0,
            is_over: false,
            tries: 0,
            requests: VecDeque::new(),
            current_request: None,
            replies: VecDeque::new(),
            keep_alive: Now::ZERO,
            view: View::new(Details::default()),
            has_changed: true,
        }
    }

    pub(super) const fn slave(&self) -> Mac {
        self.settings.slave
    }

    pub(super) const fn view(&self) -> &View {
        &self.view
    }

    pub(super) const fn take_changed(&mut self) -> bool {
        std::mem::replace(&mut self.has_changed, false)
    }

    pub(super) fn is_finished(&self) -> bool {
        self.phase == Phase::Ended && self.replies.is_empty()
    }

    /// Sends this image, starting with the next poll; see [`Scanner::set_image`](super::Scanner::set_image).
    pub(super) fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, Error> {
        self.view.check(generation)?;
        if image.len() != self.image.len() {
            let (len, size) = (image.len(), self.image.len());
            return Err(Error::Settings(format!("the image has {size} bytes, not {len}")));
        }
        self.image.copy_from_slice(image);
        self.revision += 1;
        Ok(self.revision)
    }

    /// Queues an explicit request. It is sent when the connection is open.
    pub(super) fn ask(&mut self, token: Token, request: Request) {
        if self.phase == Phase::Ended || self.is_over {
            self.replies.push_back((token, Err(Error::Ended)));
        } else {
            self.requests.push_back((token, request));
        }
    }

    pub(super) fn reply(&mut self) -> Option<Reply> {
        self.replies.pop_front()
    }

    /// Closes the connection, and releases the connections of the slave.
    pub(super) fn close(&mut self, now: Now) {
        if std::mem::replace(&mut self.is_over, true) {
            return;
        }
        match self.phase {
            Phase::New | Phase::BoxedFuture(_) => self.finish(None),
            Phase::Releasing { .. } | Phase::Ended => {}
            Phase::Open => {
                self.polling = None;
                self.requester.cancel();
                self.release(now, false);
            }
            // The release follows after the pending answer.
            _ => self.show(State::Closing),
        }
    }

    /// Handles a failure of the adapter or the bus.
    pub(super) fn fail(&mut self, now: Now, error: Error) {
        self.requester.cancel();
        match self.phase {
            Phase::Ended => {}
            _ if self.is_over => self.finish(Some(error)),
            _ if self.view.generation == 0 => self.finish(Some(error)),
            Phase::BoxedFuture(_) => self.set_error(error),
            _ => self.handle_connection_loss(now, error),
        }
    }

    /// Handles a frame of this slave.
    pub(super) fn take(&mut self, now: Now, id: Id, bytes: &[u8], bus: &Bus) {
        match id {
            Id::Answer(_) => {
                if let Some(outcome) = self.requester.take(now, bytes) {
                    self.done(now, outcome, bus);
                }
            }
            Id::PollAnswer(_) => {
                let Some(polling) = &mut self.polling else { return };
                let PollResult::Image(image, change) = polling.handle_frame(now, bytes, &mut self.view.statistics)
                else {
                    return;
                };
                self.tries = 0;
                if let Some(change) = change {
                    self.view.sent = change;
                }
                let before = self.view.input.as_ref().filter(|input| *input.image == *image);
                let image = before.map_or_else(|| image.into(), |input| Arc::clone(&input.image));
                self.view.input = Some(Input { image, at: now, generation: self.view.generation });
                self.has_changed = true;
            }
            _ => {}
        }
    }

    /// Executes the work that is due. Frames to send are added to `out`.
    pub(super) fn poll(&mut self, now: Now, bus: &Bus, out: &mut VecDeque<Frame>) {
        if let Some(outcome) = self.requester.expire(now) {
            self.done(now, outcome, bus);
        }
        match self.phase {
            Phase::New => self.allocate(now, false),
            Phase::BoxedFuture(until) if now >= until => self.allocate(now, false),
            Phase::Open => self.serve(now, bus, out),
            _ => {}
        }
        out.extend(std::iter::from_fn(|| self.requester.send()));
    }

    pub(super) fn wake(&self) -> Option<Now> {
        let own_mac = match self.phase {
            Phase::New => Some(Now::ZERO),
            Phase::BoxedFuture(until) => Some(until),
            Phase::Open if !self.requester.is_busy() => {
                Some(if self.requests.is_empty() { self.keep_alive } else { Now::ZERO })
            }
            _ => None,
        };
        let polling = self.polling.as_ref().map(|polling| polling.next().min(polling.until()));
        [own_mac, polling, self.requester.wake()].into_iter().flatten().min()
    }

    /// Sends polls, keepalives of the explicit connection, and requests of callers.
    fn serve(&mut self, now: Now, bus: &Bus, out: &mut VecDeque<Frame>) {
        if let Some(polling) = &mut self.polling {
            if now >= polling.until() {
                let (mac, after) = (self.settings.slave, polling.patience());
                let is_bus_alive = bus.is_alive_without(mac, now.saturating_sub(after));
                // Frames in the first half of the timeout may belong to the last complete image. Therefore only frames
                // in the second half count.
                let is_heard = bus.is_heard(mac, now.saturating_sub(after / 2));
                let state = bus.health.state;
                return self.handle_connection_loss(now, Error::Lost { mac, after, is_heard, is_bus_alive, state });
            }
            out.extend(polling.poll(now, &self.image, self.revision, &mut self.view.statistics));
        }
        if self.requester.is_busy() {
            return;
        }
        if let Some((token, request)) = self.requests.pop_front() {
            self.current_request = Some(token);
            self.requester.ask(now, &request, true);
        } else if now >= self.keep_alive {
            self.requester.ask(now, &Request::get(class::DEVICENET, 1, ALLOCATION_ATTRIBUTE), true);
        }
    }

    /// Handles the outcome of a request.
    fn done(&mut self, now: Now, outcome: Outcome, bus: &Bus) {
        self.keep_alive = now + KEEP_ALIVE;
        let mac = self.settings.slave;
        let state = bus.health.state;
        let answer = |what| match &outcome {
            Outcome::Answer(Answer::Done { data, .. }) => Ok(data.clone()),
            Outcome::Answer(Answer::Refused { general, additional }) => {
                Err(Error::Refused { what, mac, general: *general, additional: *additional })
            }
            Outcome::Silent => {
                Err(Error::Silent { mac, what, is_bus_alive: bus.is_alive_without(mac, Now::ZERO), state })
            }
            Outcome::Senseless(why) => Err(Error::Senseless { mac, what, why }),
        };
        match self.phase {
            Phase::Allocating { is_retry } => self.handle_allocation(now, is_retry, answer(ALLOCATION)),
            Phase::AskingOwner => self.handle_owner(now, &answer(OWNER)),
            Phase::Freeing => match answer(RELEASE) {
                Ok(_) => self.allocate(now, true),
                Err(error) => self.give_up(now, error, false),
            },
            Phase::AskingProduced => match answer(PRODUCED).and_then(|data| word(&data, mac, PRODUCED)) {
                Ok(produced_size) => {
                    self.request(
                        now,
                        Phase::AskingConsumed(produced_size),
                        &Request::get(class::CONNECTION, 2, CONSUMED_SIZE),
                    );
                }
                Err(error) => self.give_up(now, error, true),
            },
            Phase::AskingConsumed(produced_size) => {
                let select_profile = answer(CONSUMED).and_then(|data| word(&data, mac, CONSUMED));
                match select_profile.and_then(|consumed_size| self.select_profile(produced_size, consumed_size)) {
                    Ok(rate) => {
                        let request = Request::set(class::CONNECTION, 2, PACKET_RATE, &rate.to_le_bytes());
                        self.request(now, Phase::SettingRate, &request);
                    }
                    Err(error) => self.give_up(now, error, true),
                }
            }
            Phase::SettingRate => match answer(RATE).and_then(|data| word(&data, mac, RATE)) {
                Ok(0) => self.give_up(now, Error::Senseless { mac, what: RATE, why: "it is 0" }, true),
                Ok(rate) => self.opened(now, rate),
                Err(error) => self.give_up(now, error, true),
            },
            Phase::Open => {
                if let Some(token) = self.current_request.take() {
                    let reply = match outcome {
                        Outcome::Answer(answer) => Ok(answer),
                        _ => answer("a request").map(|data| Answer::Done { service: 0, data }),
                    };
                    self.replies.push_back((token, reply));
                }
            }
            Phase::Releasing { is_retry: true } => self.pause(now),
            Phase::Releasing { is_retry: false } => {
                // A silent slave releases the connections after its own timeout. In this case, the error is shown as a
                // warning, and not as an error of the link.
                let error = answer(RELEASE).err().filter(|error| !matches!(error, Error::Refused { .. }));
                self.finish(error);
            }
            Phase::New | Phase::BoxedFuture(_) | Phase::Ended => {}
        }
    }

    fn allocate(&mut self, now: Now, is_retry: bool) {
        if self.is_over {
            return self.finish(None);
        }
        let request = Request::allocate(self.choice(), self.own_mac);
        self.phase = Phase::Allocating { is_retry };
        self.requester.ask(now, &request, false);
    }

    fn handle_allocation(&mut self, now: Now, is_retry: bool, answer: Result<Vec<u8>, Error>) {
        match answer {
            Ok(_) if self.is_over => self.release(now, false),
            Ok(_) => match &self.settings.purpose {
                Purpose::Images(_) => {
                    self.request(now, Phase::AskingProduced, &Request::get(class::CONNECTION, 2, PRODUCED_SIZE));
                }
                Purpose::Messages { .. } => self.opened(now, 0),
            },
            Err(Error::Refused { additional: owner::ANOTHER_MASTER, mac, .. }) => {
                self.give_up(now, Error::Owned(mac), false);
            }
            // The connections are already allocated. Either an earlier process with this MAC ended without a release,
            // or the answer to the first attempt was lost.
            Err(Error::Refused { general: general::ALREADY, .. }) if !is_retry => {
                let request = Request::get(class::DEVICENET, 1, ALLOCATION_ATTRIBUTE);
                self.request(now, Phase::AskingOwner, &request);
            }
            Err(error) => self.give_up(now, error, false),
        }
    }

    /// Handles the allocation attribute of the slave, which contains the allocation choice and the MAC of the master.
    fn handle_owner(&mut self, now: Now, answer: &Result<Vec<u8>, Error>) {
        let mac = self.settings.slave;
        match answer.as_deref() {
            Ok([choice, master, ..]) if *master == self.own_mac.number() && *choice != 0 => {
                self.request(now, Phase::Freeing, &Request::release(*choice));
            }
            Ok([_, master, ..]) if Mac::new(*master).is_some() => self.give_up(now, Error::Owned(mac), false),
            Ok([_, _, ..]) => self.allocate(now, true),
            Ok(_) => self.give_up(now, Error::Senseless { mac, what: OWNER, why: "it is too short" }, false),
            // There is no answer, so the explicit connection has timed out, but the poll connection still exists.
            Err(Error::Silent { .. }) => {
                self.phase = Phase::Freeing;
                self.requester.ask(now, &Request::release(connection::POLL), false);
            }
            Err(error) => self.give_up(now, error.clone(), false),
        }
    }

    /// Selects the profile with these sizes. Returns the packet rate to set.
    fn select_profile(&mut self, produced_size: u16, consumed_size: u16) -> Result<u16, Error> {
        let mac = self.settings.slave;
        let Purpose::Images(images) = &self.settings.purpose else { return Err(Error::Ended) };
        let fits = |len: usize| len == usize::from(produced_size) && len == usize::from(consumed_size);
        let Some(profile) = images.profiles.iter().find(|profile| fits(profile.resting.len())) else {
            let sizes = images.profiles.iter().map(|profile| format!("{} of {}", profile.name, profile.resting.len()));
            let known = sizes.collect::<Vec<_>>().join(", ");
            return Err(Error::Size { mac, produced_size, consumed_size, known });
        };
        if self.view.details.size.is_some_and(|size| size != profile.resting.len()) {
            let known = format!("the earlier {}", self.view.details.size.unwrap_or_default());
            return Err(Error::Size { mac, produced_size, consumed_size, known });
        }
        self.image = image_after_loss(&profile.resting, &self.image);
        self.view.details.size = Some(profile.resting.len());
        Ok(u16::try_from(images.rate.as_millis()).unwrap_or(u16::MAX))
    }

    /// Handles the established connection. `rate` is the packet rate that the slave accepted.
    fn opened(&mut self, now: Now, rate: u16) {
        if self.is_over {
            return self.release(now, false);
        }
        self.phase = Phase::Open;
        self.view.generation += 1;
        if let (Purpose::Images(images), Some(size)) = (&self.settings.purpose, self.view.details.size) {
            let rate = Duration::from_millis(rate.into());
            self.view.details.rate = Some(rate);
            self.polling = Some(Polling::new(now, self.settings.slave, size, images.cycle, rate));
            // The resting image counts as the first change of this generation.
            self.revision += 1;
        }
        self.show(State::Open);
    }

    /// Handles a failed opening. Releases the connections that were allocated.
    fn give_up(&mut self, now: Now, error: Error, is_allocated: bool) {
        let is_retry = self.view.generation > 0 && !self.is_over;
        self.set_error(error);
        if is_allocated {
            self.release(now, is_retry);
        } else if is_retry {
            self.pause(now);
        } else {
            self.finish(None);
        }
    }

    /// Handles a lost connection. Releases the connection if possible, and tries to open it again.
    fn handle_connection_loss(&mut self, now: Now, error: Error) {
        self.polling = None;
        self.requester.cancel();
        self.drop_requests(&error);
        let can_hear = matches!(error, Error::Lost { .. });
        self.set_error(error);
        self.show(State::Lost);
        if can_hear {
            self.release(now, true);
        } else {
            self.pause(now);
        }
    }

    fn release(&mut self, now: Now, is_retry: bool) {
        if !is_retry {
            self.show(State::Closing);
        }
        let request = Request::release(self.choice());
        self.request(now, Phase::Releasing { is_retry }, &request);
    }

    fn pause(&mut self, now: Now) {
        if self.is_over {
            return self.finish(None);
        }
        let wait = BACKOFF.get(self.tries).or(BACKOFF.last()).copied().unwrap_or_default();
        self.tries += 1;
        self.phase = Phase::BoxedFuture(now + wait);
        self.show(State::Lost);
    }

    fn finish(&mut self, error: Option<Error>) {
        if let Some(error) = error {
            self.set_error(error);
        }
        self.polling = None;
        self.requester.cancel();
        self.drop_requests(&Error::Ended);
        self.phase = Phase::Ended;
        self.show(State::Closed);
    }

    fn drop_requests(&mut self, error: &Error) {
        let asked = self.current_request.take().into_iter().chain(self.requests.drain(..).map(|(token, _)| token));
        self.replies.extend(asked.map(|token| (token, Err(error.clone()))));
    }

    fn request(&mut self, now: Now, phase: Phase, request: &Request) {
        self.phase = phase;
        self.requester.ask(now, request, true);
    }

    const fn choice(&self) -> u8 {
        match self.settings.purpose {
            Purpose::Images(_) | Purpose::Messages { with_poll: true } => connection::EXPLICIT | connection::POLL,
            Purpose::Messages { with_poll: false } => connection::EXPLICIT,
        }
    }

    fn set_error(&mut self, error: Error) {
        self.view.last_error = Some(error);
        self.has_changed = true;
    }

    fn show(&mut self, state: State) {
        self.view.state = state;
        self.has_changed = true;
    }
}

/// Attribute 5 of the DeviceNet object: allocation choice and MAC of the master.
const ALLOCATION_ATTRIBUTE: u8 = 5;
/// Attribute numbers of the connection object.
const PRODUCED_SIZE: u8 = 7;
const CONSUMED_SIZE: u8 = 8;
const PACKET_RATE: u8 = 9;

/// Decodes an answer that is a number of two bytes.
fn word(data: &[u8], mac: Mac, what: &'static str) -> Result<u16, Error> {
    let bytes = data.try_into().map_err(|_| Error::Senseless { mac, what, why: "it does not have two bytes" })?;
    Ok(u16::from_le_bytes(bytes))
}
