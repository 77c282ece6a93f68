//! Trace of images: as text when an image changes, or as a capture file with every packet.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, SyncSender};
use std::sync::{Mutex, PoisonError};
use std::thread::JoinHandle;

use crate::prelude::basics::*;
use armctl_controller::text::hex;
use armctl_controller::yrcx::image_changes::changes;
use armctl_frame::trace;
use armctl_transport::image::tap::{Tap, TrafficRecord};
use armctl_transport::tap::Direction;

/// Text trace of the images of one link. If the link uses no network, the trace also records the bytes of the images.
#[derive(Debug)]
pub struct Trace {
    text: trace::Trace,
    sent: Option<Image>,
    received: Option<Image>,
}

impl Trace {
    /// Opens the trace that the options request.
    pub fn open(access: &Access, screen: &Screen, is_network: bool) -> Result<Self> {
        let to_file = access.trace.as_deref().is_some_and(|path| path != Path::new("-"));
        let text = if is_network && to_file {
            // On a network, the packet recorder writes the file: see `Recorder`.
            trace::Trace::of_lines(&Access { trace: None, ..access.clone() }, screen)?
        } else {
            trace::Trace::of_lines(access, screen)?
        };
        Ok(Self { text, sent: None, received: None })
    }

    /// Records an image to the controller.
    pub fn sent(&mut self, image: &Image) {
        let before = self.sent.replace(*image);
        self.image(Direction::Sent, Side::Input, before.as_ref(), image);
    }

    /// Records an image from the controller.
    pub fn received(&mut self, image: &Image) {
        let before = self.received.replace(*image);
        self.image(Direction::Received, Side::Output, before.as_ref(), image);
    }

    /// Records a message to or from the network board.
    pub fn message(&mut self, direction: Direction, bytes: &[u8], about: &str) {
        if self.text.level() > 0 {
            self.text.line(direction, &format!("{}  # {about}", hex(bytes)));
        }
    }

    /// See [`trace::Trace::answered`].
    pub fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        self.text.answered(exchange);
    }

    /// Closes the trace and reports whether it is complete.
    pub fn finish(&mut self) -> Result<()> {
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

/// Packets from before the link is open, for `-vvv`. If the link does not open, armctl prints them to show the reason.
#[derive(Debug)]
pub struct Opening {
    passed: Arc<Mutex<VecDeque<String>>>,
}

/// Maximum number of packets that are printed after a failure.
const MAX_PRINTED: usize = 64;

impl Opening {
    /// Returns a tap that records packets, if `-vvv` is set.
    pub fn watch(screen: &Screen) -> Option<(Self, Tap)> {
        /// Verbosity of `-vvv`.
        const BYTES: u8 = 3;

        if screen.verbosity < BYTES {
            return None;
        }
        let passed = Arc::new(Mutex::new(VecDeque::new()));
        let kept = Arc::clone(&passed);
        let tap = Tap::new(move |packet: TrafficRecord| {
            let line = match packet {
                TrafficRecord::Datagram { from, to, bytes } => format!("udp {from} -> {to}  {}", hex(&bytes)),
                TrafficRecord::Segment { from, to, bytes } => format!("tcp {from} -> {to}  {}", hex(&bytes)),
                TrafficRecord::Adapter { direction, bytes } => {
                    format!("adapter {}  {}", direction.arrow(), bytes.escape_ascii())
                }
                TrafficRecord::Frame(bytes) => format!("frame  {}", hex(&bytes)),
            };
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            if kept.len() == MAX_PRINTED {
                kept.pop_front();
            }
            kept.push_back(line);
        });
        Some((Self { passed }, tap))
    }

    /// Prints the packets after the link failed to open.
    pub fn show(&self, screen: &Screen) {
        let passed = self.passed.lock().unwrap_or_else(PoisonError::into_inner);
        if passed.is_empty() {
            screen.note("no frame was sent or received");
        }
        passed.iter().for_each(|line| screen.note(line));
    }
}

/// Maximum number of packets that wait for the disk: a few minutes of one connection.
const MAX_QUEUED: usize = 65_536;

/// Writes the packets of `--trace` in its own thread, because the threads that transfer images must not wait for the
/// disk.
#[derive(Debug)]
pub struct Recorder {
    writer: JoinHandle<Result<()>>,
    /// Packets with their time; `None` marks the end.
    packets: SyncSender<Option<(Duration, TrafficRecord)>>,
    /// Number of packets dropped because the queue was full.
    lost: Arc<AtomicU64>,
}

impl Recorder {
    /// Starts the recording, if the user requested a file. `link_type` is the link type of a capture file.
    pub fn start(access: &Access, screen: &Screen, link_type: u16) -> Result<Option<(Self, Tap)>> {
        if access.trace.as_deref().is_none_or(|path| path == Path::new("-")) {
            return Ok(None);
        }
        let mut record = trace::Trace::of_packets(access, screen, link_type)?;
        let (packets, coming) = mpsc::sync_channel::<Option<(Duration, TrafficRecord)>>(MAX_QUEUED);
        let writer = std::thread::Builder::new().name("trace".to_owned()).spawn(move || {
            while let Ok(Some((time, passed))) = coming.recv() {
                record.capture(|capture, _| match passed {
                    TrafficRecord::Datagram { from, to, bytes } => capture.datagram(time, from, to, &bytes),
                    TrafficRecord::Segment { from, to, bytes } => capture.segment(time, from, to, &bytes),
                    TrafficRecord::Adapter { .. } => Ok(()),
                    TrafficRecord::Frame(bytes) => capture.frame(time, &bytes),
                });
            }
            record.finish()
        });
        let writer = writer.context("trace")?;
        let lost = Arc::new(AtomicU64::new(0));
        let (counted, sender) = (Arc::clone(&lost), packets.clone());
        let tap = Tap::new(move |passed| {
            let time = trace::now();
            // If the disk is slow, packets are dropped, so that the robot is not delayed.
            if sender.try_send(Some((time, passed))).is_err() {
                counted.fetch_add(1, Ordering::Relaxed);
            }
        });
        Ok(Some((Self { writer, packets, lost }, tap)))
    }

    /// Waits until all packets are written, and reports whether the trace is complete.
    pub fn finish(self) -> Result<()> {
        // If the writer has already ended, `join` returns its error.
        let _ = self.packets.send(None);
        self.writer.join().unwrap_or_else(|_| Err(trace::incomplete("the writer failed")))?;
        match self.lost.load(Ordering::Relaxed) {
            0 => Ok(()),
            lost => Err(trace::incomplete(&format!("the disk was too slow for {lost} packets"))),
        }
    }
}
