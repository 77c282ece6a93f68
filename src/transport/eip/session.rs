//! Encapsulation session on a TCP connection, with one request at a time. The session has no sockets and no clock.
//!
//! The TCP connection opens with the first request, and opens again after a loss. A request is never sent twice.

use std::collections::VecDeque;
use std::time::Duration;

use super::Now;
use super::error::EipError;
use super::wire::{Command, Frame, Frames};

/// Maximum number of queued requests.
const MAX_QUEUED: usize = 64;
/// Status of a refused RegisterSession: the device has no free session.
const NO_FREE_SESSION: u32 = 0x02;
/// Longest pause before another attempt to register. The first pause is a sixteenth of this time. A random factor
/// shortens every pause: clients that were refused at the same time then retry at different times.
const MAX_RETRY_PAUSE: Duration = Duration::from_millis(800);

/// Number that identifies the request to which an answer belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Token(pub u64);

/// A request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ask {
    /// Token of the answer.
    pub token: Token,
    /// Name of the request in error texts.
    pub what: &'static str,
    /// Encapsulation command.
    pub command: Command,
    /// Command data.
    pub data: Vec<u8>,
}

/// An action that the driver must execute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Open the TCP connection; then call [`Session::connected`] or [`Session::lost`].
    Connect,
    /// Send these bytes.
    Send(Vec<u8>),
    /// Close the TCP connection. If bytes still arrive from this connection, the driver must drop them.
    Disconnect,
    /// A request is complete.
    Answer {
        /// Token of the request.
        token: Token,
        /// Whether the request was sent, so that the device may have executed it.
        sent: bool,
        /// Data of the answer, or the error.
        result: Result<Vec<u8>, EipError>,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Down,
    Connecting { until: Now },
    Registering { until: Now },
    // The device has no free session. The session waits for the next attempt to register.
    Full { until: Now },
    Up,
}

/// An encapsulation session.
#[derive(Debug, Clone)]
pub struct Session {
    phase: Phase,
    handle: u32,
    frames: Frames,
    waiting: VecDeque<Ask>,
    pending: Option<(Ask, Now)>,
    /// Number of the current request. The sender context of the request contains this number, so that a late answer is
    /// detected.
    number: u64,
    timeout: Duration,
    /// Time for which the session retries if the device has no free session.
    patience: Duration,
    /// Time at which the device first refused because it has no free session, and the number of attempts after this
    /// time.
    refused_since: Option<(Now, u32)>,
    steps: VecDeque<Step>,
}

impl Session {
    /// Creates a session. `timeout` is the time limit of the TCP connection and of each answer.
    pub fn new(timeout: Duration) -> Self {
        Self {
            phase: Phase::Down,
            handle: 0,
            frames: Frames::default(),
            waiting: VecDeque::new(),
            pending: None,
            number: 0,
            timeout,
            patience: Duration::ZERO,
            refused_since: None,
            steps: VecDeque::new(),
        }
    }

    /// Sets the time for which the session retries if the device has no free session. A retry is safe, because the
    /// device has not executed any request.
    #[must_use]
    pub fn is_waiting_for_session(self, patience: Duration) -> Self {
        Self { patience, ..self }
    }

    /// Queues a request.
    pub fn ask(&mut self, ask: Ask) {
        if self.waiting.len() >= MAX_QUEUED {
            let why = "too many waiting requests";
            self.answer(ask.token, false, Err(EipError::Impossible(why.to_owned())));
        } else {
            self.waiting.push_back(ask);
        }
    }

    /// Returns the next action at `now`. The caller repeats the call until it returns `None`.
    pub fn poll(&mut self, now: Now) -> Option<Step> {
        if self.steps.is_empty() {
            self.advance(now);
        }
        self.steps.pop_front()
    }

    /// Latest time of the next call of [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        match self.phase {
            Phase::Connecting { until } | Phase::Registering { until } | Phase::Full { until } => Some(until),
            Phase::Down | Phase::Up => self.pending.as_ref().map(|(_, until)| *until),
        }
    }

    /// Handles the opening of the TCP connection.
    pub fn connected(&mut self, now: Now) {
        if matches!(self.phase, Phase::Connecting { .. }) {
            self.frames.clear();
            self.number += 1;
            self.steps.push_back(Step::Send(Frame::register(self.number.to_le_bytes()).emit()));
            self.phase = Phase::Registering { until: now.saturating_add(self.timeout) };
        }
    }

    /// Handles bytes from the TCP connection.
    pub fn received(&mut self, now: Now, bytes: &[u8]) {
        if matches!(self.phase, Phase::Down | Phase::Full { .. }) {
            return;
        }
        self.frames.push(bytes);
        while let Some(bytes) = self.frames.pop() {
            if let Ok(frame) = Frame::parse(&bytes) {
                self.take(now, &frame);
            }
        }
    }

    /// Handles the failure or the end of the TCP connection. `why` is the error for queued requests.
    pub fn lost(&mut self, why: &EipError) {
        let was_up = self.phase == Phase::Up;
        self.phase = Phase::Down;
        if let Some((ask, _)) = self.pending.take() {
            self.answer(ask.token, true, Err(EipError::Hangup(ask.what)));
        }
        // If no session was open, queued requests fail at once. If an open session ended, the queued requests use a new
        // TCP connection.
        if !was_up {
            self.fail_queued(why);
        }
    }

    /// Unregisters the session and closes the TCP connection. Queued requests fail.
    pub fn end(&mut self) {
        if self.phase == Phase::Up {
            self.steps.push_back(Step::Send(Frame::unregister(self.handle).emit()));
        }
        self.disconnect();
        if let Some((ask, _)) = self.pending.take() {
            self.answer(ask.token, true, Err(EipError::Ended));
        }
        self.fail_queued(&EipError::Ended);
    }

    fn advance(&mut self, now: Now) {
        match self.phase {
            Phase::Down if !self.waiting.is_empty() => self.connect(now),
            Phase::Full { until } if now >= until => self.connect(now),
            Phase::Connecting { until } if now >= until => self.give_up("the TCP connection"),
            Phase::Registering { until } if now >= until => self.give_up("RegisterSession"),
            Phase::Up => match &self.pending {
                Some((ask, until)) if now >= *until => {
                    let (token, what) = (ask.token, ask.what);
                    self.pending = None;
                    // An answer that arrives late must be ignored, so the next request uses a new TCP connection.
                    self.disconnect();
                    self.answer(token, true, Err(EipError::NoAnswer { what, after: self.timeout }));
                }
                Some(_) => {}
                None => self.send_next(now),
            },
            _ => {}
        }
    }

    fn connect(&mut self, now: Now) {
        self.steps.push_back(Step::Connect);
        self.phase = Phase::Connecting { until: now.saturating_add(self.timeout) };
    }

    /// Handles the refusal of RegisterSession: waits for a free session, or gives up.
    fn refused(&mut self, now: Now, status: u32) {
        self.disconnect();
        let (since, tries) = self.refused_since.unwrap_or((now, 0));
        let longest = MAX_RETRY_PAUSE / 16 * 2_u32.pow(tries.min(4));
        let pause = longest.mul_f64(0.5 + fastrand::f64() / 2.0);
        if status == NO_FREE_SESSION && now.saturating_add(pause) < since.saturating_add(self.patience) {
            self.refused_since = Some((since, tries + 1));
            self.phase = Phase::Full { until: now.saturating_add(pause) };
        } else {
            self.refused_since = None;
            self.fail_queued(&EipError::Encapsulation { what: "RegisterSession", status });
        }
    }

    fn send_next(&mut self, now: Now) {
        let Some(ask) = self.waiting.pop_front() else { return };
        self.number += 1;
        let context = self.number.to_le_bytes();
        let frame = Frame { command: ask.command, session: self.handle, status: 0, context, data: &ask.data };
        self.steps.push_back(Step::Send(frame.emit()));
        self.pending = Some((ask, now.saturating_add(self.timeout)));
    }

    fn take(&mut self, now: Now, frame: &Frame<'_>) {
        if frame.context != self.number.to_le_bytes() {
            return;
        }
        match self.phase {
            Phase::Registering { .. } if frame.command == Command::REGISTER_SESSION => {
                if frame.status == 0 {
                    self.handle = frame.session;
                    self.refused_since = None;
                    self.phase = Phase::Up;
                    self.advance(now);
                } else {
                    self.refused(now, frame.status);
                }
            }
            Phase::Up => {
                let Some((ask, _)) = self.pending.take_if(|(ask, _)| ask.command == frame.command) else { return };
                let result = if frame.status == 0 {
                    Ok(frame.data.to_vec())
                } else {
                    // The session itself may be invalid, so the next request opens a new session.
                    self.disconnect();
                    Err(EipError::Encapsulation { what: ask.what, status: frame.status })
                };
                self.answer(ask.token, true, result);
            }
            _ => {}
        }
    }

    fn give_up(&mut self, what: &'static str) {
        self.disconnect();
        self.fail_queued(&EipError::NoAnswer { what, after: self.timeout });
    }

    fn disconnect(&mut self) {
        if self.phase != Phase::Down {
            if !matches!(self.phase, Phase::Full { .. }) {
                self.steps.push_back(Step::Disconnect);
            }
            self.phase = Phase::Down;
        }
    }

    fn fail_queued(&mut self, why: &EipError) {
        for ask in std::mem::take(&mut self.waiting) {
            self.answer(ask.token, false, Err(why.clone()));
        }
    }

    fn answer(&mut self, token: Token, sent: bool, result: Result<Vec<u8>, EipError>) {
        self.steps.push_back(Step::Answer { token, sent, result });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMEOUT: Duration = Duration::from_secs(3);
    const NOW: Now = Duration::from_secs(100);

    fn ask(token: u64) -> Ask {
        Ask { token: Token(token), what: "the test", command: Command::SEND_RR_DATA, data: vec![1, 2] }
    }

    fn sent(session: &mut Session, now: Now) -> Vec<u8> {
        match session.poll(now) {
            Some(Step::Send(bytes)) => bytes,
            other => panic!("nothing is sent: {other:?}"),
        }
    }

    /// Returns the answer to a frame that was sent, with session handle 7.
    fn answer(bytes: &[u8], status: u32, data: &[u8]) -> Vec<u8> {
        Frame { session: 7, status, data, ..Frame::parse(bytes).unwrap() }.emit()
    }

    /// Returns a session with a request in progress, and the bytes of the request.
    fn current_request() -> (Session, Vec<u8>) {
        let mut session = Session::new(TIMEOUT);
        session.ask(ask(1));
        assert_eq!(session.poll(NOW), Some(Step::Connect));
        assert_eq!(session.poll(NOW), None);
        session.connected(NOW);
        let register = sent(&mut session, NOW);
        session.received(NOW, &answer(&register, 0, &[1, 0, 0, 0]));
        let request = sent(&mut session, NOW);
        assert_eq!(session.poll(NOW), None);
        (session, request)
    }

    #[test]
    fn request_opens_connection_and_session() {
        let (mut session, request) = current_request();
        let frame = Frame::parse(&request).unwrap();
        assert_eq!((frame.command, frame.session, frame.data), (Command::SEND_RR_DATA, 7, &[1, 2][..]));
        let reply = answer(&request, 0, &[9]);
        let (one, two) = reply.split_at(20);
        session.received(NOW, one);
        assert_eq!(session.poll(NOW), None);
        session.received(NOW, two);
        assert_eq!(session.poll(NOW), Some(Step::Answer { token: Token(1), sent: true, result: Ok(vec![9]) }));
        session.end();
        assert_eq!(session.poll(NOW), Some(Step::Send(Frame::unregister(7).emit())));
        assert_eq!(session.poll(NOW), Some(Step::Disconnect));
        assert_eq!((session.poll(NOW), session.wake()), (None, None));
    }

    #[test]
    fn ignores_answers_to_other_requests() {
        let (mut session, request) = current_request();
        let mut other = answer(&request, 0, &[9]);
        other[12] ^= 1;
        session.received(NOW, &other);
        assert_eq!(session.poll(NOW), None);
    }

    #[test]
    fn lost_answer_closes_the_connection_without_a_repeat() {
        let (mut session, request) = current_request();
        session.ask(ask(2));
        let late = NOW + TIMEOUT;
        assert_eq!(session.wake(), Some(late));
        assert_eq!(session.poll(late), Some(Step::Disconnect));
        let result = Err(EipError::NoAnswer { what: "the test", after: TIMEOUT });
        assert_eq!(session.poll(late), Some(Step::Answer { token: Token(1), sent: true, result }));
        session.received(late, &answer(&request, 0, &[9]));
        assert_eq!(session.poll(late), Some(Step::Connect), "for the second");
    }

    #[test]
    fn fails_queued_requests_if_the_device_is_silent() {
        let mut session = Session::new(TIMEOUT);
        session.ask(ask(1));
        session.ask(ask(2));
        assert_eq!(session.poll(NOW), Some(Step::Connect));
        let last_error = EipError::NoAnswer { what: "the TCP connection", after: TIMEOUT };
        session.lost(&last_error);
        for token in [1, 2] {
            let result = Err(last_error.clone());
            assert_eq!(session.poll(NOW), Some(Step::Answer { token: Token(token), sent: false, result }));
        }
        assert_eq!(session.poll(NOW), None);
    }

    #[test]
    fn retries_while_the_device_has_no_free_session() {
        let mut session = Session::new(TIMEOUT).is_waiting_for_session(TIMEOUT);
        session.ask(ask(1));
        let mut now = NOW;
        let mut tries = 0;
        let result = loop {
            match session.poll(now) {
                Some(Step::Connect) => session.connected(now),
                Some(Step::Send(register)) => {
                    tries += 1;
                    session.received(now, &answer(&register, NO_FREE_SESSION, &[1, 0, 0, 0]));
                }
                Some(Step::Disconnect) => {}
                Some(Step::Answer { sent, result, .. }) => break (sent, result),
                None => now = session.wake().expect("it waits for something").max(now),
            }
        };
        assert!((4..30).contains(&tries), "{tries}");
        assert!(now < NOW + TIMEOUT, "not longer than its timeout");
        let last_error = EipError::Encapsulation { what: "RegisterSession", status: NO_FREE_SESSION };
        assert_eq!(result, (false, Err(last_error)));
        // A refusal with another status is reported at once. Without time for retries, every refusal is reported at
        // once.
        for (patience, status) in [(TIMEOUT, 0x69), (Duration::ZERO, NO_FREE_SESSION)] {
            let mut session = Session::new(TIMEOUT).is_waiting_for_session(patience);
            session.ask(ask(1));
            assert_eq!(session.poll(NOW), Some(Step::Connect));
            session.connected(NOW);
            let register = sent(&mut session, NOW);
            session.received(NOW, &answer(&register, status, &[]));
            assert_eq!(session.poll(NOW), Some(Step::Disconnect));
            assert!(matches!(session.poll(NOW), Some(Step::Answer { sent: false, result: Err(_), .. })));
        }
    }

    #[test]
    fn opens_a_new_session_if_the_device_lost_it() {
        let (mut session, request) = current_request();
        session.received(NOW, &answer(&request, 0x64, &[]));
        assert_eq!(session.poll(NOW), Some(Step::Disconnect));
        let result = Err(EipError::Encapsulation { what: "the test", status: 0x64 });
        assert_eq!(session.poll(NOW), Some(Step::Answer { token: Token(1), sent: true, result }));
        session.ask(ask(2));
        assert_eq!(session.poll(NOW), Some(Step::Connect));
    }

    #[test]
    fn disconnect_fails_sent_requests_and_keeps_queued_requests() {
        let (mut session, _) = current_request();
        session.ask(ask(2));
        session.lost(&EipError::Ended);
        let result = Err(EipError::Hangup("the test"));
        assert_eq!(session.poll(NOW), Some(Step::Answer { token: Token(1), sent: true, result }));
        assert_eq!(session.poll(NOW), Some(Step::Connect));
    }
}
