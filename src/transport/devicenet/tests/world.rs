//! Test bench: a master and slaves on a bus in virtual time. Frames can be lost, doubled, delayed and reordered on the
//! way to each receiver. Frames with the same identifier normally keep their order, because one node sends them in
//! sequence.

use std::collections::HashMap;
use std::time::Duration;

use fastrand::Rng;

use crate::devicenet::Now;
use crate::devicenet::can::bus::{Bus, TransmittedFrame};
use crate::devicenet::can::{Bitrate, Frame};
use crate::devicenet::device::{Application, Device, Setup};
use crate::devicenet::scanner::{Identity, Reply, Scanner, State, Token, View};
use crate::devicenet::settings::{Images, Profile, Purpose, Settings};
use crate::devicenet::wire::{Mac, Request};

pub const MS: Duration = Duration::from_millis(1);
pub const SECOND: Duration = Duration::from_secs(1);
/// Number of the connection in most tests.
pub const LINK: u64 = 1;

pub fn mac(number: u8) -> Mac {
    Mac::new(number).unwrap()
}

/// Echo application: returns the image that it receives, with a counter.
#[derive(Debug, Default)]
pub struct Mirror {
    pub image: Vec<u8>,
    /// Every new image with the time of its arrival, in the order of arrival.
    pub history: Vec<(Now, Vec<u8>)>,
    pub images: u64,
    pub losses: Vec<Now>,
}

impl Application for Mirror {
    fn image_out(&mut self, now: Now, image: &[u8]) {
        self.images += 1;
        if self.image != image {
            self.image = image.to_vec();
            self.history.push((now, image.to_vec()));
        }
    }

    fn image_in(&mut self, _now: Now, image: &mut [u8]) {
        for (shown, taken) in image.iter_mut().zip(&self.image) {
            *shown = *taken;
        }
    }

    fn on_master_lost(&mut self, now: Now) {
        self.losses.push(now);
    }
}

pub fn setup(number: u8, size: u16) -> Setup {
    let name = "YRCX (sim)".to_owned();
    Setup { serial: 0x00C0_FFEE, name, ..Setup::sample_controller(mac(number), Bitrate::K500, size) }
}

/// Returns a resting image that is not all zeros.
pub fn resting(size: usize) -> Vec<u8> {
    let mut image = vec![0; size];
    image[0] = 0x41;
    image
}

pub fn images(number: u8) -> Settings {
    let profiles = [("Normal", 48), ("Compact", 4)].map(|(name, size)| Profile { name, resting: resting(size) });
    Settings { slave: mac(number), purpose: Purpose::Images(Images::usual(profiles.to_vec(), None)), timeout: SECOND }
}

/// Rates of faults for each receiver, in 1/10,000 of the frames.
#[derive(Debug, Clone, Copy, Default)]
pub struct Line {
    pub drop: u16,
    pub duplicate: u16,
    pub late: u16,
    /// Rate of short delays. A frame with another identifier can overtake a delayed frame.
    pub swap: u16,
    /// Rate of long delays. A later frame with the same identifier can overtake a delayed frame. No bus does this, but
    /// a faulty adapter can do it.
    pub reorder: u16,
}

#[derive(Debug)]
pub struct World {
    pub now: Now,
    pub scanner: Scanner,
    pub devices: Vec<Device<Mirror>>,
    pub bus: Bus,
    pub line: Line,
    /// Whether the bus is cut, so that no frame passes.
    pub is_cut: bool,
    pub trace: Vec<(Now, Frame)>,
    pub replies: Vec<Reply>,
    rng: Rng,
    /// Delayed frames: time, receiver, frame.
    incoming: Vec<(Now, usize, Frame)>,
    /// Time at which the last frame arrived, by node and identifier.
    last: HashMap<(usize, u16), Now>,
}

impl World {
    pub fn new(devices: Vec<Device<Mirror>>, seed: u64) -> Self {
        let scanner = Scanner::new(Identity { mac: mac(1), vendor: 0xFFFF, serial: 7 });
        Self {
            now: Now::ZERO,
            scanner,
            bus: Bus::new(Bitrate::K500, devices.len() + 1),
            devices,
            line: Line::default(),
            is_cut: false,
            trace: Vec::new(),
            replies: Vec::new(),
            rng: Rng::with_seed(seed),
            incoming: Vec::new(),
            last: HashMap::new(),
        }
    }

    /// Creates slave 5, which is on line with images of this size, and opens a link to it.
    pub fn linked(size: u16, seed: u64) -> Self {
        let mut world = Self::new(vec![Device::on_line(setup(5, size), Mirror::default())], seed);
        world.scanner.open(LINK, images(5)).unwrap();
        world.until(SECOND * 5, |world| world.view().state == State::Open);
        world
    }

    pub fn view(&self) -> View {
        self.scanner.view(LINK).unwrap().clone()
    }

    pub fn mirror(&mut self) -> &mut Mirror {
        &mut self.devices[0].application
    }

    /// Runs until the condition is true, and returns the time. Panics after `longest`.
    pub fn until(&mut self, longest: Duration, mut condition: impl FnMut(&mut Self) -> bool) -> Now {
        let end = self.now + longest;
        while !condition(self) {
            assert!(self.now < end, "{:?} {:?}\n{:?}", self.scanner.view(LINK), self.devices, self.trace.last());
            self.step(end);
        }
        self.now
    }

    pub fn run(&mut self, time: Duration) {
        let end = self.now + time;
        while self.now < end {
            self.step(end);
        }
    }

    /// Sends a request on the link, and waits for the answer.
    pub fn ask(&mut self, request: Request) -> Reply {
        self.scanner.ask(LINK, Token(9), request);
        self.until(SECOND * 30, |world| !world.replies.is_empty());
        self.replies.remove(0)
    }

    /// Advances to the next event, but not beyond `end`.
    fn step(&mut self, end: Now) {
        let now = self.now;
        while let Some(frame) = self.scanner.poll(now) {
            self.bus.send(now, 0, frame);
        }
        while let Some(reply) = self.scanner.reply() {
            self.replies.push(reply);
        }
        for (node, device) in self.devices.iter_mut().enumerate() {
            while let Some(frame) = device.poll(now) {
                self.bus.send(now, node + 1, frame);
            }
        }
        while let Some(transmitted) = self.bus.pass(now) {
            self.pass(transmitted);
        }
        let due: Vec<(Now, usize, Frame)> = self.incoming.extract_if(.., |(at, ..)| *at <= now).collect();
        for (_, node, frame) in &due {
            match node {
                0 => self.scanner.handle(now, frame),
                node => self.devices[node - 1].handle(now, frame),
            }
        }
        if !due.is_empty() {
            return;
        }
        let wakes = self.devices.iter().filter_map(Device::wake).chain(self.scanner.wake()).chain(self.bus.wake());
        let next = wakes.chain(self.incoming.iter().map(|(at, ..)| *at)).min();
        self.now = next.map_or(end, |next| next.clamp(now, end));
        if self.now == now && next.is_some_and(|next| next <= now) {
            // Work that is due at once is done at the start of the next step. The time advances a little each time, so
            // that the test detects endless work.
            self.now += Duration::from_nanos(100);
        }
    }

    fn pass(&mut self, transmitted: TransmittedFrame) {
        self.trace.push((transmitted.at, transmitted.frame));
        if self.trace.len() > 200_000 {
            self.trace.clear();
        }
        if self.is_cut {
            return;
        }
        for node in 0..=self.devices.len() {
            if node == transmitted.from {
                continue;
            }
            let mut hits = |share: u16| self.rng.u16(0..10_000) < share;
            let (drop, duplicate, late, swap) =
                (hits(self.line.drop), hits(self.line.duplicate), hits(self.line.late), hits(self.line.swap));
            if hits(self.line.reorder) {
                let hold = Duration::from_micros(self.rng.u64(100..30_000));
                self.incoming.push((transmitted.at + hold, node, transmitted.frame));
                continue;
            }
            if drop {
                continue;
            }
            let delay = match (late, swap) {
                (true, _) => MS * self.rng.u32(1..60),
                (_, true) => MS * self.rng.u32(200..2000) / 1000,
                _ => Duration::ZERO,
            };
            let last = self.last.entry((node, transmitted.frame.id())).or_default();
            let at = (transmitted.at + delay).max(*last);
            *last = at;
            for _ in 0..=u8::from(duplicate) {
                self.incoming.push((at, node, transmitted.frame));
            }
        }
    }
}
