//! Images in the record of the traffic: as text when they change, as packets whenever they pass.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, SyncSender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use anyhow::Context as _;

use crate::command::Access;
use crate::command::frame::trace;
use crate::controller::text::hex;
use crate::controller::yrcx::changes::changes;
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::signal::Side;
use crate::failure::Failure;
use crate::output::Screen;
use crate::transport::image::tap::{Passed, Tap};
use crate::transport::tap::Direction;

/// What the images of one link say, as text. Where there is no network, the images themselves are recorded as well.
#[derive(Debug)]
pub struct Trace {
    text: trace::Trace,
    sent: Option<Image>,
    received: Option<Image>,
}

impl Trace {
    /// As flags want it.
    pub fn open(access: &Access, screen: &Screen, is_network: bool) -> Result<Self, Failure> {
        let to_file = access.trace.as_deref().is_some_and(|path| path != Path::new("-"));
        let text = if is_network && to_file {
            // The packets are the record: see `Recorder`.
            trace::Trace::of_lines(&Access { trace: None, ..access.clone() }, screen)?
        } else {
            trace::Trace::of_lines(access, screen)?
        };
        Ok(Self { text, sent: None, received: None })
    }

    /// An image was shown to the controller.
    pub fn sent(&mut self, image: &Image) {
        let before = self.sent.replace(*image);
        self.image(Direction::Sent, Side::Input, before.as_ref(), image);
    }

    /// The controller showed an image.
    pub fn received(&mut self, image: &Image) {
        let before = self.received.replace(*image);
        self.image(Direction::Received, Side::Output, before.as_ref(), image);
    }

    /// A message went to the network board, or came from it.
    pub fn message(&mut self, direction: Direction, bytes: &[u8], about: &str) {
        if self.text.level() > 0 {
            self.text.line(direction, &format!("{}  # {about}", hex(bytes)));
        }
    }

    /// Tells whether the record is whole.
    pub fn finish(&mut self) -> Result<(), Failure> {
        self.text.finish()
    }

    fn image(&mut self, direction: Direction, side: Side, before: Option<&Image>, image: &Image) {
        self.text.piece(direction, None, &image.to_bytes());
        if self.text.level() > 0 {
            for change in changes(side, before, image) {
                self.text.line(direction, &change.line(self.text.level() > 1));
            }
        }
    }
}

/// The packets that passed before a link was open, for `-vvv`: where it did not open, they tell why.
#[derive(Debug)]
pub struct Opening {
    passed: Arc<Mutex<VecDeque<String>>>,
}

/// The last packets before a failure that are shown.
const MOST_SHOWN: usize = 64;

impl Opening {
    /// Keeps what passes the tap, if bytes are wanted.
    pub fn watch(screen: &Screen) -> Option<(Self, Tap)> {
        /// `-vvv`.
        const BYTES: u8 = 3;

        if screen.verbosity < BYTES {
            return None;
        }
        let passed = Arc::new(Mutex::new(VecDeque::new()));
        let kept = Arc::clone(&passed);
        let tap = Tap::new(move |packet: Passed| {
            let line = match packet {
                Passed::Datagram { from, to, bytes } => format!("udp {from} -> {to}  {}", hex(&bytes)),
                Passed::Segment { from, to, bytes } => format!("tcp {from} -> {to}  {}", hex(&bytes)),
                Passed::Frame(bytes) => format!("frame  {}", hex(&bytes)),
            };
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            if kept.len() == MOST_SHOWN {
                kept.pop_front();
            }
            kept.push_back(line);
        });
        Some((Self { passed }, tap))
    }

    /// Shows what passed until the link did not open.
    pub fn show(&self, screen: &Screen) {
        let passed = self.passed.lock().unwrap_or_else(PoisonError::into_inner);
        if passed.is_empty() {
            screen.note("no frame was sent or received");
        }
        passed.iter().for_each(|line| screen.note(line));
    }
}

/// Packets most that wait to be written: some minutes of one connection.
const MOST_WAITING: usize = 65_536;

/// Writes packets to the file of `--trace`, on a thread of its own: those that move images must not wait for a disk.
#[derive(Debug)]
pub struct Recorder {
    writer: JoinHandle<Result<(), Failure>>,
    /// `None` says that there is no more.
    packets: SyncSender<Option<(Duration, Passed)>>,
    /// Packets that there was no room for.
    lost: Arc<AtomicU64>,
}

impl Recorder {
    /// Begins to record what passes the tap, if that is wanted; `link_type` is the kind of packets, as in a capture file.
    pub fn start(access: &Access, screen: &Screen, link_type: u16) -> Result<Option<(Self, Tap)>, Failure> {
        if access.trace.as_deref().is_none_or(|path| path == Path::new("-")) {
            return Ok(None);
        }
        let mut record = trace::Trace::of_packets(access, screen, link_type)?;
        let (packets, coming) = mpsc::sync_channel::<Option<(Duration, Passed)>>(MOST_WAITING);
        let writer = std::thread::Builder::new().name("trace".to_owned()).spawn(move || {
            while let Ok(Some((time, passed))) = coming.recv() {
                record.capture(|capture, _| match passed {
                    Passed::Datagram { from, to, bytes } => capture.datagram(time, from, to, &bytes),
                    Passed::Segment { from, to, bytes } => capture.segment(time, from, to, &bytes),
                    Passed::Frame(bytes) => capture.frame(time, &bytes),
                });
            }
            record.finish()
        });
        let writer = writer.context("trace")?;
        let lost = Arc::new(AtomicU64::new(0));
        let (counted, sender) = (Arc::clone(&lost), packets.clone());
        let tap = Tap::new(move |passed| {
            let time = trace::now();
            // A disk that is minutes behind loses packets, not the robot.
            if sender.try_send(Some((time, passed))).is_err() {
                counted.fetch_add(1, Ordering::Relaxed);
            }
        });
        Ok(Some((Self { writer, packets, lost }, tap)))
    }

    /// Waits until all is written, and tells whether the record is whole.
    pub fn finish(self) -> Result<(), Failure> {
        // A writer that is gone says so when it is joined.
        let _ = self.packets.send(None);
        self.writer.join().unwrap_or_else(|_| Err(trace::not_whole("its writer broke down")))?;
        match self.lost.load(Ordering::Relaxed) {
            0 => Ok(()),
            lost => Err(trace::not_whole(&format!("the disk was too slow for {lost} packets"))),
        }
    }
}
