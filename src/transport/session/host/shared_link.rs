//! The link that a host owns: images, datagrams or a byte stream.

use std::collections::BTreeMap;
use std::future::Future;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use futures_util::future::select_all;
use tokio::sync::Mutex;
use tokio::time::{Instant, sleep_until, timeout_at};

use crate::BACKOFF;
use crate::image::{Event, ImageLink, image_after_loss};
use crate::session::wire::{self, Change};
use crate::sim::{InProcess, Peer};
use crate::stream::Stream;
use crate::udp::Udp;

/// The link of a session.
pub enum SharedLink {
    /// An image link.
    Images(Images),
    /// A datagram link.
    Datagrams(Datagrams),
    /// A byte stream.
    Stream(Line),
}

/// Event of the link.
#[derive(Debug)]
pub enum LinkEvent {
    /// All images that clients have sent to the host were sent to the device.
    Sent,
    /// A new image of the device.
    Image(Arc<[u8]>),
    /// The link was lost for this reason.
    Lost(String),
    /// The link is open again.
    Reopened,
    /// Received bytes for a client.
    Data {
        /// The client for which the bytes are; `None` means the owner of the line.
        to: Option<u64>,
        /// Channel of the device.
        channel: u8,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// Receiving from the device failed.
    Broken {
        /// The client that waits for the answer.
        to: u64,
        /// The error.
        error: io::Error,
    },
}

/// A time that is longer than any wait.
const NO_DEADLINE: Duration = Duration::from_secs(3600);
/// Size of the receive buffer: larger than any frame of a controller, so that oversized datagrams are detected.
const BUFFER: usize = 4096;

impl SharedLink {
    /// Waits for the next event. The future is cancel safe.
    pub async fn next(&mut self) -> LinkEvent {
        match self {
            Self::Images(images) => images.next().await,
            Self::Datagrams(datagrams) => datagrams.next().await,
            Self::Stream(line) => line.next().await,
        }
    }

    /// Reason why the link is down; `None` while it is up.
    pub fn down(&self) -> Option<&str> {
        match self {
            Self::Images(images) => images.down.as_deref(),
            Self::Datagrams(_) => None,
            Self::Stream(line) => line.down.as_deref(),
        }
    }

    /// The image link; `None` if the link has no images.
    pub fn images(&mut self) -> Option<&mut Images> {
        match self {
            Self::Images(images) => Some(images),
            Self::Datagrams(_) | Self::Stream(_) => None,
        }
    }

    /// The carrier of a datagram link for a client of this process; `None` for other links.
    pub(in crate::session) fn carrier(&self) -> Option<Carrier> {
        match self {
            Self::Datagrams(datagrams) => Some(datagrams.carrier.for_client()),
            Self::Images(_) | Self::Stream(_) => None,
        }
    }

    /// Prepares the link for the next owner of the line. Bytes of a stream that have already arrived are dropped.
    pub fn begin(&mut self) {
        if let Self::Stream(Line { stream: Some(stream), .. }) = self {
            stream.discard();
        }
    }

    /// Whether several clients can use this channel at the same time. This is possible for the file channel, so that a
    /// file transfer does not delay a stop.
    pub fn is_parallel(&self, channel: u8) -> bool {
        matches!(self, Self::Datagrams(Datagrams { carrier: Carrier::Udp(_), .. })) && channel > 0
    }

    /// Stops receiving for a client that waits for no more answers.
    pub fn pause(&mut self, client: u64) {
        if let Self::Datagrams(datagrams) = self {
            datagrams.expecting.remove(&client);
        }
    }

    /// Sends the bytes of a client.
    pub async fn send(&mut self, client: u64, channel: u8, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Images(_) => Ok(()),
            Self::Datagrams(datagrams) => datagrams.send(client, channel, bytes).await,
            Self::Stream(line) => line.send(bytes).await,
        }
    }

    /// Opens a new socket for a channel of a client.
    pub fn renew(&mut self, client: u64, channel: u8) {
        if let Self::Datagrams(Datagrams { sockets, .. }) = self
            && let Some(udp) = sockets.get_mut(&client)
            && channel < CHANNELS
        {
            udp.renew(channel.into());
        }
    }

    /// Removes a client.
    pub fn forget(&mut self, client: u64) {
        if let Self::Datagrams(datagrams) = self {
            datagrams.sockets.remove(&client);
            datagrams.expecting.remove(&client);
        }
    }

    /// Closes the link.
    ///
    /// # Errors
    /// A description of what was not closed properly.
    pub async fn close(self) -> Result<(), String> {
        match self {
            Self::Images(images) => images.link.close().await.map_err(|last_error| last_error.to_string()),
            Self::Datagrams(_) | Self::Stream(_) => Ok(()),
        }
    }
}

/// Rules for images. Because of these rules, the host need not interpret the images.
#[derive(Debug, Clone)]
pub struct Rules {
    /// Whether the link can send images.
    pub is_owner: bool,
    /// Size of the exclusive part in bytes. This part is at the start of the image, and only the owner of the line can
    /// change it.
    pub exclusive: usize,
    /// Size of the command part in bytes. This part is at the start of the image, and is 0 while no command is active.
    pub command: usize,
    /// Image that is sent first. After a loss, [`image_after_loss`] returns the image.
    pub resting: Vec<u8>,
    /// Function that returns whether the robot is moving. Its arguments are the output image and the input image.
    pub is_moving: fn(&[u8], &[u8]) -> bool,
}

/// An image link with its rules.
pub struct Images {
    link: ImageLink,
    /// Rules for the images of this link.
    pub rules: Rules,
    /// Image to the device.
    pub shown: Vec<u8>,
    /// Image from the device; `None` while the link is down.
    pub seen: Option<Arc<[u8]>>,
    /// Number of times that the link was lost.
    pub generation: u32,
    down: Option<String>,
}

impl Images {
    /// Creates the link. If the link can send images, the first image is the resting image.
    pub fn new(mut link: ImageLink, rules: Rules) -> Result<Self, String> {
        if rules.is_owner {
            link.set_output(&rules.resting).map_err(|last_error| last_error.to_string())?;
        }
        Ok(Self { link, shown: rules.resting.clone(), rules, seen: None, generation: 0, down: None })
    }

    /// Waits until `until` for the first image of the device. Returns `false` after a timeout.
    pub async fn begin(&mut self, until: Instant) -> bool {
        while self.seen.is_none() {
            match self.link.next(until).await {
                Event::Image(image) => self.seen = Some(image),
                Event::Timeout => return false,
                _ => {}
            }
        }
        true
    }

    async fn next(&mut self) -> LinkEvent {
        loop {
            match self.link.next(Instant::now() + NO_DEADLINE).await {
                Event::Sent => return LinkEvent::Sent,
                Event::Image(image) => {
                    self.seen = Some(Arc::clone(&image));
                    return LinkEvent::Image(image);
                }
                Event::Lost(error) => {
                    let why = error.to_string();
                    self.seen = None;
                    self.generation = self.generation.wrapping_add(1);
                    self.down = Some(why.clone());
                    return LinkEvent::Lost(why);
                }
                Event::Reopened => {
                    self.down = None;
                    self.shown = image_after_loss(&self.rules.resting, &self.shown);
                    self.set_output();
                    return LinkEvent::Reopened;
                }
                Event::OutputChanged(_) | Event::Denied | Event::Timeout => {}
            }
        }
    }

    /// Applies a change of a client. If the client does not own the line, the exclusive part stays unchanged. Returns
    /// the change that was applied, or `None` if the change cannot be applied, for example because it is from before a
    /// loss.
    pub fn change(&mut self, mut change: Change, has_line: bool) -> Option<Change> {
        if change.generation != self.generation || self.down.is_some() || !self.rules.is_owner {
            return None;
        }
        if !has_line {
            change.mask.iter_mut().take(self.rules.exclusive).for_each(|mask| *mask = 0);
        }
        change.apply(&mut self.shown);
        self.set_output();
        Some(change)
    }

    fn set_output(&mut self) {
        if self.rules.is_owner {
            // An error is ignored. The size was checked with the first image, and `next` reports a loss.
            let _ = self.link.set_output(&self.shown);
        }
    }

    /// Whether the image contains no active command.
    pub fn is_clear(&self) -> bool {
        self.shown.iter().take(self.rules.command).all(|byte| *byte == 0)
    }

    /// Whether the robot is moving.
    pub fn is_moving(&self) -> bool {
        self.seen.as_ref().is_some_and(|seen| (self.rules.is_moving)(&self.shown, seen))
    }

    /// Returns the state of the images for a new client.
    pub fn welcome(&self) -> wire::Images {
        wire::Images {
            generation: self.generation,
            exclusive: self.rules.exclusive,
            shown: self.shown.clone(),
            seen: self.seen.as_ref().map(|seen| seen.to_vec()),
            watchdog_ms: u64::try_from(self.link.watchdog().as_millis()).unwrap_or(u64::MAX),
        }
    }
}

/// A datagram link. Each client has its own sockets, so a late answer cannot reach another client.
pub struct Datagrams {
    carrier: Carrier,
    sockets: BTreeMap<u64, Udp>,
    /// Clients that wait for an answer, each with the channel of the answer.
    expecting: BTreeMap<u64, u8>,
}

/// Carrier of datagrams.
#[derive(Debug)]
pub(in crate::session) enum Carrier {
    Udp(Udp),
    /// All clients share the peer. The line decides which of them uses it.
    InProcess(Arc<Mutex<InProcess<Box<dyn Peer + Send>>>>),
}

impl Carrier {
    /// The same peer, over sockets of a client.
    pub fn for_client(&self) -> Self {
        match self {
            Self::Udp(udp) => Self::Udp(udp.with_new_sockets()),
            Self::InProcess(peer) => Self::InProcess(Arc::clone(peer)),
        }
    }

    /// See [`SharedLink::renew`].
    pub fn renew(&mut self, channel: u8) {
        if let Self::Udp(udp) = self {
            udp.renew(channel.into());
        }
    }

    pub async fn send(&mut self, channel: u8, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Udp(udp) => udp.send(channel.into(), bytes).await,
            Self::InProcess(peer) => {
                peer.lock().await.send(channel.into(), bytes);
                Ok(())
            }
        }
    }

    /// Waits until `until` for a datagram. The future is cancel safe.
    pub async fn receive(&mut self, channel: u8, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        match self {
            Self::Udp(udp) => udp.receive(channel.into(), buffer, until).await,
            Self::InProcess(peer) => {
                let received = async { peer.lock().await.receive(channel.into(), buffer).await };
                Ok(timeout_at(until, received).await.ok())
            }
        }
    }
}

/// Number of channels of a device.
const CHANNELS: u8 = 2;

impl Datagrams {
    /// Creates a link to a network host.
    pub fn udp(udp: Udp) -> Self {
        Self::over(Carrier::Udp(udp))
    }

    /// Creates a link to an in-process peer.
    pub fn in_process(peer: InProcess<Box<dyn Peer + Send>>) -> Self {
        Self::over(Carrier::InProcess(Arc::new(Mutex::new(peer))))
    }

    fn over(carrier: Carrier) -> Self {
        Self { carrier, sockets: BTreeMap::new(), expecting: BTreeMap::new() }
    }

    async fn send(&mut self, client: u64, channel: u8, bytes: &[u8]) -> io::Result<()> {
        if channel >= CHANNELS {
            return Ok(());
        }
        self.expecting.insert(client, channel);
        match &mut self.carrier {
            Carrier::Udp(udp) => {
                let socket = self.sockets.entry(client).or_insert_with(|| udp.with_new_sockets());
                socket.send(channel.into(), bytes).await
            }
            Carrier::InProcess(peer) => {
                peer.lock().await.send(channel.into(), bytes);
                Ok(())
            }
        }
    }

    async fn next(&mut self) -> LinkEvent {
        let (to, channel, received) = match &mut self.carrier {
            Carrier::Udp(_) => {
                let expecting = &self.expecting;
                let expected = self.sockets.iter_mut().filter_map(|(client, socket)| {
                    let channel = *expecting.get(client)?;
                    Some(Box::pin(async move { (*client, channel, datagram(socket, channel).await) }))
                });
                let expected: Vec<_> = expected.collect();
                if expected.is_empty() {
                    return std::future::pending().await;
                }
                select_all(expected).await.0
            }
            Carrier::InProcess(peer) => {
                let Some((client, channel)) = self.expecting.first_key_value() else {
                    return std::future::pending().await;
                };
                let mut buffer = vec![0; BUFFER];
                let length = peer.lock().await.receive((*channel).into(), &mut buffer).await;
                buffer.truncate(length);
                (*client, *channel, Ok(buffer))
            }
        };
        match received {
            Ok(bytes) => LinkEvent::Data { to: Some(to), channel, bytes },
            Err(error) => {
                // After an error, the host receives nothing for this client until the client sends again.
                self.expecting.remove(&to);
                LinkEvent::Broken { to, error }
            }
        }
    }
}

/// Receives the next datagram of a channel.
async fn datagram(socket: &mut Udp, channel: u8) -> io::Result<Vec<u8>> {
    let mut buffer = vec![0; BUFFER];
    loop {
        if let Some(length) = socket.receive(channel.into(), &mut buffer, Instant::now() + NO_DEADLINE).await? {
            buffer.truncate(length);
            return Ok(buffer);
        }
    }
}

/// An open stream, or the reason why it could not be opened.
pub type OpenResult = Result<Stream<Box<dyn Peer + Send>>, String>;
type Opening = Pin<Box<dyn Future<Output = OpenResult>>>;

/// A byte stream that is reopened after a loss.
pub struct Line {
    stream: Option<Stream<Box<dyn Peer + Send>>>,
    open: Box<dyn Fn() -> Opening>,
    opening: Option<Opening>,
    /// Time of the next attempt to open the stream. The field below is the number of failed attempts.
    due: Instant,
    tries: usize,
    down: Option<String>,
}

impl Line {
    /// Creates a line from an open stream. `open` reopens the stream.
    pub fn new(stream: Stream<Box<dyn Peer + Send>>, open: impl Fn() -> Opening + 'static) -> Self {
        Self { stream: Some(stream), open: Box::new(open), opening: None, due: Instant::now(), tries: 0, down: None }
    }

    async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let Some(stream) = &mut self.stream else { return Err(self.absent()) };
        stream.send(bytes).await
    }

    fn absent(&self) -> io::Error {
        io::Error::new(io::ErrorKind::NotConnected, self.down.clone().unwrap_or_default())
    }

    async fn next(&mut self) -> LinkEvent {
        let mut buffer = [0; 1024];
        loop {
            if let Some(stream) = &mut self.stream {
                match stream.receive(&mut buffer, Instant::now() + NO_DEADLINE).await {
                    Ok(None) => continue,
                    Ok(Some(length)) => {
                        return LinkEvent::Data { to: None, channel: 0, bytes: buffer[..length].to_vec() };
                    }
                    Err(error) => {
                        // The handle is dropped here, because a serial port of this computer cannot be opened a second
                        // time while the handle exists.
                        self.stream = None;
                        self.down = Some(error.to_string());
                        (self.tries, self.due) = (0, Instant::now() + BACKOFF[0]);
                        return LinkEvent::Lost(error.to_string());
                    }
                }
            }
            if self.opening.is_none() {
                sleep_until(self.due).await;
            }
            match self.opening.get_or_insert_with(|| (self.open)()).await {
                Ok(stream) => {
                    (self.opening, self.stream, self.down) = (None, Some(stream), None);
                    return LinkEvent::Reopened;
                }
                Err(why) => {
                    self.opening = None;
                    self.down = Some(why);
                    self.tries = (self.tries + 1).min(BACKOFF.len() - 1);
                    self.due = Instant::now() + BACKOFF[self.tries];
                }
            }
        }
    }
}
