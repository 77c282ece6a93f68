//! Simulated DP slave without line and clock. The slave is stricter than real slaves: it checks frame counts, lengths,
//! ident number, configuration, parameters, owner and watchdog.

use std::collections::BTreeMap;
use std::time::Duration;

use super::super::image::ImagePeer;
use super::super::sim::Peer;
use super::Now;
use super::rates::Rate;
use super::wire::{
    BROADCAST, Block, Control, Diagnosis, Flag, Frame, FrameCount, GlobalControl, Lock, Parameters, Piece, Service,
    Station, Status, Stream, Telegram, sap,
};

mod fault;

pub use fault::SlaveFault;

/// Pause without a character after which a telegram has certainly ended.
const PAUSE: Duration = Duration::from_millis(100);
/// Shortest delay of an answer, in bits.
const MIN_TSDR: u32 = 11;
/// Owner that the slave reports with [`SlaveFault::Locked`].
const OTHER_MASTER: u8 = 9;

/// Configuration of a slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setup {
    /// Address of the slave.
    pub station: u8,
    /// Ident number.
    pub ident: u16,
    /// The only accepted configuration (identifier bytes).
    pub configuration: Vec<u8>,
    /// Size of the image from the slave in bytes.
    pub input: usize,
    /// Size of the image to the slave in bytes.
    pub output: usize,
    /// User parameters that the slave accepts.
    pub parameters: Vec<Vec<u8>>,
    /// Bit rate. The delay of the answers depends on it.
    pub rate: Rate,
}

impl Setup {
    /// Returns the configuration of station 5 with 24 words in each direction. The ident number is a placeholder,
    /// because the ident number of the YRCX board is not public.
    pub fn sample_controller(rate: Rate) -> Self {
        Self {
            station: 5,
            ident: 0x1234,
            configuration: vec![0xC0, 0xD7, 0xD7],
            input: 48,
            output: 48,
            parameters: vec![Vec::new(), vec![0; 3]],
            rate,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    WaitParameters,
    WaitConfiguration,
    Exchange,
}

/// A simulated slave with an image peer behind it.
#[derive(Debug)]
pub struct Slave<P> {
    setup: Setup,
    /// The image peer.
    pub peer: P,
    state: State,
    /// Address of the owner.
    pub owner: Option<u8>,
    /// Watchdog time.
    patience: Option<Duration>,
    /// Time at which the watchdog expires; `None` while it is off.
    expiry: Option<Now>,
    faults: Vec<Flag>,
    outputs: Vec<u8>,
    is_clear: bool,
    /// Whether the slave has a new diagnosis that the master has not read yet.
    has_new_image: bool,
    /// Frame count bit of the last request of each master, and the answer to this request.
    last: BTreeMap<u8, (bool, Option<Telegram>)>,
    stream: Stream,
    last_request_at: Now,
    answers: Vec<(Now, Vec<u8>)>,
    fault: Option<SlaveFault>,
    answered: u64,
    exchanges: u64,
}

impl<P: ImagePeer> Slave<P> {
    /// Creates a slave without an owner.
    pub fn new(setup: Setup, peer: P) -> Self {
        let outputs = vec![0; setup.output];
        Self {
            setup,
            peer,
            state: State::WaitParameters,
            owner: None,
            patience: None,
            expiry: None,
            faults: Vec::new(),
            outputs,
            is_clear: false,
            has_new_image: false,
            last: BTreeMap::new(),
            stream: Stream::default(),
            last_request_at: Now::ZERO,
            answers: Vec::new(),
            fault: None,
            answered: 0,
            exchanges: 0,
        }
    }

    /// Number of data exchanges, without repeated requests.
    pub const fn exchanges(&self) -> u64 {
        self.exchanges
    }

    /// Activates a fault; `None` deactivates the active fault.
    pub const fn set_fault(&mut self, fault: Option<SlaveFault>) {
        self.fault = fault;
    }

    /// Restarts the slave, as after a power cycle.
    pub fn restart(&mut self, now: Now) {
        self.leave_data_exchange(now);
        self.last.clear();
        self.stream.clear();
        self.answers.clear();
        self.faults.clear();
    }

    /// Leaves data exchange: the slave waits for parameters again.
    fn leave_data_exchange(&mut self, now: Now) {
        if self.state == State::Exchange {
            self.peer.input(now, None);
        }
        self.state = State::WaitParameters;
        self.owner = None;
        self.expiry = None;
        self.patience = None;
        self.outputs.fill(0);
        self.is_clear = false;
    }

    fn watch(&mut self, now: Now) {
        if self.expiry.is_some_and(|expiry| now >= expiry) {
            self.leave_data_exchange(now);
        }
    }

    fn handle_frame(&mut self, now: Now, frame: &Frame) {
        let Control::Request(service, count) = frame.control else { return };
        let is_for_all = frame.to == BROADCAST;
        if !(is_for_all || frame.to == self.setup.station) {
            return;
        }
        if !service.is_answered() {
            if service == Service::SendHigh && frame.to_sap == Some(sap::GLOBAL_CONTROL) && is_for_all {
                self.control(now, frame);
            }
            return;
        }
        if is_for_all {
            return;
        }
        let answer = match (service, count) {
            (Service::FdlStatus, FrameCount::None) => Some(self.frame(frame, Status::Ok, Vec::new())),
            (Service::SendRequestHigh | Service::SendRequestLow, FrameCount::First | FrameCount::Counters(_)) => {
                let bit = count.bit();
                let repeated = self.last.get(&frame.from).filter(|last| count != FrameCount::First && last.0 == bit);
                if let Some((_, answer)) = repeated {
                    answer.clone()
                } else {
                    let answer = self.serve(now, frame);
                    self.last.insert(frame.from, (bit, answer.clone()));
                    answer
                }
            }
            // The request has an invalid frame count, or slaves do not have this service.
            _ => Some(self.frame(frame, Status::NoService, Vec::new())),
        };
        if self.owner == Some(frame.from) {
            self.expiry = self.patience.map(|patience| now + patience);
        }
        if let Some(answer) = answer {
            self.answer(now, &answer);
        }
    }

    fn serve(&mut self, now: Now, frame: &Frame) -> Option<Telegram> {
        let is_owner = self.owner == Some(frame.from);
        let refused = Some(self.frame(frame, Status::NoService, Vec::new()));
        let has_master_sap = frame.from_sap == Some(sap::MASTER);
        if self.fault == Some(SlaveFault::Inactive) || frame.to_sap.is_some() != has_master_sap {
            return refused;
        }
        let is_exchanging = self.state == State::Exchange;
        let data = match frame.to_sap {
            Some(sap::SLAVE_DIAG) if frame.data.is_empty() => self.diagnosis().emit(),
            Some(sap::GET_CFG) if frame.data.is_empty() => match self.fault {
                Some(SlaveFault::OtherSize) => vec![0xC0, 0xC7, 0xC7],
                _ => self.setup.configuration.clone(),
            },
            Some(sap::READ_INPUTS) if is_exchanging && frame.data.is_empty() => self.peer.output(now)?,
            Some(sap::READ_OUTPUTS) if is_exchanging && frame.data.is_empty() => self.outputs.clone(),
            Some(sap::SET_PRM) => {
                if self.owner.is_some() && !is_owner {
                    return refused;
                }
                self.set_parameters(now, frame);
                return Some(Telegram::ShortAcknowledge);
            }
            Some(sap::CHK_CFG) if is_owner => {
                self.check_configuration(now, &frame.data);
                return Some(Telegram::ShortAcknowledge);
            }
            None if is_exchanging && is_owner => return self.exchange(now, frame).or(refused),
            _ => return refused,
        };
        Some(self.frame(frame, Status::Data, data))
    }

    fn diagnosis(&mut self) -> Diagnosis {
        let mut flags = self.faults.clone();
        if self.state != State::Exchange || self.fault == Some(SlaveFault::NotReady) {
            flags.push(Flag::NotReady);
        }
        if self.state == State::WaitParameters {
            flags.push(Flag::ParametersWanted);
        }
        if self.patience.is_some() {
            flags.push(Flag::Watchdog);
        }
        self.has_new_image = self.fault == Some(SlaveFault::Diagnosis);
        let mut blocks = Vec::new();
        if self.has_new_image {
            flags.push(Flag::Extended);
            let channel = Block::Channel { module: 1, channel: 2, io_direction: 2, size: 1, error: 1 };
            blocks = vec![Block::Device(vec![0x12, 0x34]), Block::Modules(vec![1]), channel];
        }
        let is_locked = self.fault == Some(SlaveFault::Locked);
        let is_other = self.fault == Some(SlaveFault::OtherIdent);
        Diagnosis {
            flags: Diagnosis::flags(&flags),
            master: if is_locked { Some(OTHER_MASTER) } else { self.owner },
            ident: if is_other { self.setup.ident ^ 1 } else { self.setup.ident },
            blocks,
        }
    }

    fn set_parameters(&mut self, now: Now, frame: &Frame) {
        self.faults.clear();
        let Ok(parameters) = Parameters::parse(&frame.data) else {
            self.leave_data_exchange(now);
            return self.faults.push(Flag::ParameterFault);
        };
        match parameters.lock {
            Lock::Unchanged => {}
            Lock::Unlock => self.leave_data_exchange(now),
            Lock::Lock => {
                self.leave_data_exchange(now);
                let is_other = self.fault == Some(SlaveFault::OtherIdent);
                let takes =
                    self.setup.parameters.contains(&parameters.user) && self.fault != Some(SlaveFault::NoParameters);
                if parameters.ident != self.setup.ident ^ u16::from(is_other) || !takes {
                    return self.faults.push(Flag::ParameterFault);
                }
                if parameters.sync || parameters.freeze {
                    return self.faults.extend([Flag::ParameterFault, Flag::NotSupported]);
                }
                self.owner = Some(frame.from);
                self.patience = parameters.watchdog.map(super::wire::Watchdog::time);
                self.state = State::WaitConfiguration;
            }
        }
    }

    fn check_configuration(&mut self, now: Now, configuration: &[u8]) {
        if self.state == State::WaitParameters {
            return;
        }
        if configuration != self.setup.configuration || self.fault == Some(SlaveFault::NoConfiguration) {
            self.leave_data_exchange(now);
            return self.faults.push(Flag::ConfigurationFault);
        }
        self.state = State::Exchange;
    }

    /// Handles a data exchange. Returns `None` if there is no answer, for example because the slave leaves data
    /// exchange.
    fn exchange(&mut self, now: Now, frame: &Frame) -> Option<Telegram> {
        if frame.data.len() != self.setup.output {
            self.leave_data_exchange(now);
            self.faults.push(Flag::ConfigurationFault);
            return None;
        }
        self.exchanges += 1;
        self.outputs.clone_from(&frame.data);
        if !self.is_clear {
            self.peer.input(now, Some(&frame.data));
        }
        let mut image = self.peer.output(now)?;
        image.resize(self.setup.input, 0);
        if self.fault == Some(SlaveFault::WrongSize) {
            image.pop();
        }
        let has_new_image = self.has_new_image || self.fault == Some(SlaveFault::Diagnosis);
        Some(self.frame(frame, if has_new_image { Status::DataHigh } else { Status::Data }, image))
    }

    fn control(&mut self, now: Now, frame: &Frame) {
        let Ok(control) = GlobalControl::parse(&frame.data) else { return };
        if self.owner != Some(frame.from) || self.state != State::Exchange || control.groups != 0 {
            return;
        }
        self.is_clear = control.is_clear();
        if self.is_clear {
            self.outputs.fill(0);
            self.peer.input(now, Some(&self.outputs));
        }
    }

    fn frame(&self, asked: &Frame, status: Status, data: Vec<u8>) -> Telegram {
        let kind = if self.fault == Some(SlaveFault::Master) { Station::MasterInRing } else { Station::Slave };
        Telegram::Frame(Frame {
            to: asked.from,
            from: self.setup.station,
            control: Control::Answer(kind, status),
            to_sap: asked.from_sap,
            from_sap: asked.to_sap,
            data,
        })
    }

    fn answer(&mut self, now: Now, answer: &Telegram) {
        self.answered += 1;
        let is_fourth = self.answered.is_multiple_of(4);
        let mut bytes = answer.emit();
        match self.fault {
            Some(SlaveFault::Mute) => return,
            Some(SlaveFault::Lose) if is_fourth => return,
            Some(SlaveFault::BadFcs) if is_fourth => {
                let fcs = bytes.len().saturating_sub(2);
                bytes[fcs] ^= 0x01;
            }
            Some(SlaveFault::Token) => {
                let token = Telegram::Token { to: OTHER_MASTER, from: OTHER_MASTER };
                bytes.extend(token.emit());
            }
            _ => {}
        }
        self.answers.push((now + self.setup.rate.bits(MIN_TSDR), bytes));
    }
}

impl<P: ImagePeer> Peer for Slave<P> {
    fn receive(&mut self, now: Now, _channel: usize, bytes: &[u8]) {
        self.watch(now);
        if now.saturating_sub(self.last_request_at) > PAUSE {
            self.stream.clear();
        }
        self.last_request_at = now;
        // New traffic cancels a pending answer.
        self.answers.retain(|answer| answer.0 <= now);
        self.stream.push(bytes);
        while let Some(piece) = self.stream.next_piece() {
            if let Piece::Telegram(Telegram::Frame(frame), _) = piece {
                self.handle_frame(now, &frame);
            }
        }
    }

    fn damaged(&mut self, now: Now, channel: usize) {
        // A character with a parity error reads as NUL, as with the driver of a serial port.
        self.receive(now, channel, &[0]);
    }

    fn transmit(&mut self, now: Now) -> Option<(usize, Vec<u8>)> {
        self.watch(now);
        // The peer also works while no master reads its image. Otherwise, its next event would stay in the past, and the
        // caller would never sleep.
        if self.peer.wake().is_some_and(|wake| wake <= now) {
            let _unread_image = self.peer.output(now);
        }
        let at = self.answers.iter().position(|answer| answer.0 <= now)?;
        Some((0, self.answers.remove(at).1))
    }

    fn wake(&self) -> Option<Now> {
        self.answers.iter().map(|answer| answer.0).chain(self.expiry).chain(self.peer.wake()).min()
    }
}
