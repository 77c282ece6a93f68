//! The link that a host holds, of whichever kind.

use std::collections::BTreeMap;
use std::future::Future;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use futures_util::future::select_all;
use tokio::time::{Instant, sleep_until};

use crate::image::{Event, ImageLink};
use crate::session::wire::{self, Change};
use crate::sim::{InProcess, Peer};
use crate::stream::Stream;
use crate::udp::Udp;

/// A link.
pub enum Held {
    /// Images each way.
    Images(Images),
    /// Datagrams.
    Datagrams(Datagrams),
    /// A byte stream.
    Stream(Line),
}

/// What happens on it.
#[derive(Debug)]
pub enum Happening {
    /// All that is shown has left.
    Sent,
    /// The device shows something new.
    Image(Arc<[u8]>),
    /// The link is down, and why.
    Lost(String),
    /// It is up again.
    Reopened,
    /// Bytes for a client, or for the holder of the line.
    Data {
        /// Whom for, if not for the holder.
        to: Option<u64>,
        /// Which port of the device they come from.
        channel: u8,
        /// They.
        bytes: Vec<u8>,
    },
    /// Receiving failed.
    Broken {
        /// For whom.
        to: u64,
        /// Why.
        error: io::Error,
    },
}

/// Longer than anything that is waited for.
const LONG: Duration = Duration::from_secs(3600);
/// Room for more than a frame of any controller, so that an oversized datagram shows.
const BUFFER: usize = 4096;
/// Waits before another try to open a stream, one after the other; the last one again and again.
const BACKOFF: [Duration; 5] = [
    Duration::from_millis(250),
    Duration::from_millis(500),
    Duration::from_secs(1),
    Duration::from_secs(2),
    Duration::from_secs(5),
];

impl Held {
    /// Waits for the next thing to happen. The future may be dropped.
    pub async fn next(&mut self) -> Happening {
        match self {
            Self::Images(images) => images.next().await,
            Self::Datagrams(datagrams) => datagrams.next().await,
            Self::Stream(line) => line.next().await,
        }
    }

    /// Why the link is down; `None` while it is up.
    pub fn down(&self) -> Option<&str> {
        match self {
            Self::Images(images) => images.down.as_deref(),
            Self::Datagrams(_) => None,
            Self::Stream(line) => line.down.as_deref(),
        }
    }

    /// The images, if there are some.
    pub fn images(&mut self) -> Option<&mut Images> {
        match self {
            Self::Images(images) => Some(images),
            Self::Datagrams(_) | Self::Stream(_) => None,
        }
    }

    /// The line goes to a client: what came before is not for him.
    pub fn begin(&mut self) {
        if let Self::Stream(Line { stream: Some(stream), .. }) = self {
            stream.discard();
        }
    }

    /// Whether clients may use this channel at the same time: one that carries files must not keep a stop waiting.
    pub fn is_parallel(&self, channel: u8) -> bool {
        matches!(self, Self::Datagrams(Datagrams { way: Way::Udp(_), .. })) && channel > 0
    }

    /// A client expects no answer any more.
    pub fn pause(&mut self, client: u64) {
        if let Self::Datagrams(datagrams) = self {
            datagrams.expecting.remove(&client);
        }
    }

    /// Sends what a client has to say.
    pub async fn send(&mut self, client: u64, channel: u8, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Images(_) => Ok(()),
            Self::Datagrams(datagrams) => datagrams.send(client, channel, bytes).await,
            Self::Stream(line) => line.send(bytes).await,
        }
    }

    /// Gives a client a new socket for a channel.
    pub fn renew(&mut self, client: u64, channel: u8) {
        if let Self::Datagrams(Datagrams { sockets, .. }) = self
            && let Some(udp) = sockets.get_mut(&client)
            && channel < CHANNELS
        {
            udp.renew(channel.into());
        }
    }

    /// A client has gone.
    pub fn forget(&mut self, client: u64) {
        if let Self::Datagrams(datagrams) = self {
            datagrams.sockets.remove(&client);
            datagrams.expecting.remove(&client);
        }
    }

    /// Closes it.
    ///
    /// # Errors
    /// What was not closed properly, in words.
    pub async fn close(self) -> Result<(), String> {
        match self {
            Self::Images(images) => images.link.close().await.map_err(|trouble| trouble.to_string()),
            Self::Datagrams(_) | Self::Stream(_) => Ok(()),
        }
    }
}

/// What a host has to know of images whose meaning it does not know.
#[derive(Debug, Clone)]
pub struct Rules {
    /// Whether anything may be shown at all.
    pub is_owner: bool,
    /// Bytes of the output, from the first, that one client at a time changes.
    pub exclusive: usize,
    /// So many of them, from the first, are 0 when nothing is under way there.
    pub command: usize,
    /// What is shown at first.
    pub resting: Vec<u8>,
    /// What is shown after a loss, of what was shown before.
    pub rest: fn(&[u8]) -> Vec<u8>,
    /// Whether something moves, by what is shown and seen.
    pub under_way: fn(&[u8], &[u8]) -> bool,
}

/// An image link.
pub struct Images {
    link: ImageLink,
    /// What it goes by.
    pub rules: Rules,
    /// What the device is shown.
    pub shown: Vec<u8>,
    /// What it shows; `None` while the link is down.
    pub seen: Option<Arc<[u8]>>,
    /// How often the link went down.
    pub generation: u32,
    down: Option<String>,
}

impl Images {
    /// Begins with what is shown at first.
    ///
    /// # Errors
    /// When that has another size than the images of the link.
    pub fn new(mut link: ImageLink, rules: Rules) -> Result<Self, String> {
        if rules.is_owner {
            link.show(&rules.resting).map_err(|trouble| trouble.to_string())?;
        }
        Ok(Self { link, shown: rules.resting.clone(), rules, seen: None, generation: 0, down: None })
    }

    /// Waits until the device shows something; `false` if it does not by then.
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

    async fn next(&mut self) -> Happening {
        loop {
            match self.link.next(Instant::now() + LONG).await {
                Event::Sent => return Happening::Sent,
                Event::Image(image) => {
                    self.seen = Some(Arc::clone(&image));
                    return Happening::Image(image);
                }
                Event::Lost(error) => {
                    let why = error.to_string();
                    self.seen = None;
                    self.generation = self.generation.wrapping_add(1);
                    self.down = Some(why.clone());
                    return Happening::Lost(why);
                }
                Event::Reopened => {
                    self.down = None;
                    self.shown = (self.rules.rest)(&self.shown);
                    self.show();
                    return Happening::Reopened;
                }
                Event::Shown(_) | Event::Denied | Event::Timeout => {}
            }
        }
    }

    /// Shows what a client wants shown; without the line the exclusive part stays as it is. What has changed, if it was
    /// not meant for the time before a loss.
    pub fn change(&mut self, mut change: Change, has_line: bool) -> Option<Change> {
        if change.generation != self.generation || self.down.is_some() || !self.rules.is_owner {
            return None;
        }
        if !has_line {
            change.mask.iter_mut().take(self.rules.exclusive).for_each(|mask| *mask = 0);
        }
        change.apply(&mut self.shown);
        self.show();
        Some(change)
    }

    fn show(&mut self) {
        if self.rules.is_owner {
            // It has the size of the image that was shown at first. A loss is told by `next`.
            let _ = self.link.show(&self.shown);
        }
    }

    /// Whether nothing is under way on the exclusive part.
    pub fn is_clear(&self) -> bool {
        self.shown.iter().take(self.rules.command).all(|byte| *byte == 0)
    }

    /// Whether something moves.
    pub fn under_way(&self) -> bool {
        self.seen.as_ref().is_some_and(|seen| (self.rules.under_way)(&self.shown, seen))
    }

    /// For a client that comes.
    pub fn welcome(&self) -> wire::Images {
        wire::Images {
            generation: self.generation,
            exclusive: self.rules.exclusive,
            shown: self.shown.clone(),
            seen: self.seen.as_ref().map(|seen| seen.to_vec()),
        }
    }
}

/// Datagrams: every client has sockets of its own, so that an answer that comes late is nobody else's.
pub struct Datagrams {
    way: Way,
    sockets: BTreeMap<u64, Udp>,
    /// Who expects an answer, and on which channel.
    expecting: BTreeMap<u64, u8>,
}

enum Way {
    Udp(Udp),
    InProcess(Box<InProcess<Box<dyn Peer>>>),
}

/// Channels of a device.
const CHANNELS: u8 = 2;

impl Datagrams {
    /// To a host on a network.
    pub fn udp(udp: Udp) -> Self {
        Self::over(Way::Udp(udp))
    }

    /// To a peer in this process.
    pub fn in_process(peer: InProcess<Box<dyn Peer>>) -> Self {
        Self::over(Way::InProcess(Box::new(peer)))
    }

    fn over(way: Way) -> Self {
        Self { way, sockets: BTreeMap::new(), expecting: BTreeMap::new() }
    }

    async fn send(&mut self, client: u64, channel: u8, bytes: &[u8]) -> io::Result<()> {
        if channel >= CHANNELS {
            return Ok(());
        }
        self.expecting.insert(client, channel);
        match &mut self.way {
            Way::Udp(udp) => {
                let own = self.sockets.entry(client).or_insert_with(|| udp.another());
                own.send(channel.into(), bytes).await
            }
            Way::InProcess(peer) => {
                peer.send(channel.into(), bytes);
                Ok(())
            }
        }
    }

    async fn next(&mut self) -> Happening {
        let (to, channel, received) = match &mut self.way {
            Way::Udp(_) => {
                let expecting = &self.expecting;
                let expected = self.sockets.iter_mut().filter_map(|(client, own)| {
                    let channel = *expecting.get(client)?;
                    Some(Box::pin(async move { (*client, channel, datagram(own, channel).await) }))
                });
                let expected: Vec<_> = expected.collect();
                if expected.is_empty() {
                    return std::future::pending().await;
                }
                select_all(expected).await.0
            }
            Way::InProcess(peer) => {
                let Some((client, channel)) = self.expecting.first_key_value() else {
                    return std::future::pending().await;
                };
                let mut buffer = vec![0; BUFFER];
                let length = peer.receive((*channel).into(), &mut buffer).await;
                buffer.truncate(length);
                (*client, *channel, Ok(buffer))
            }
        };
        match received {
            Ok(bytes) => Happening::Data { to: Some(to), channel, bytes },
            Err(error) => {
                // Until he sends again there is nothing to receive.
                self.expecting.remove(&to);
                Happening::Broken { to, error }
            }
        }
    }
}

/// The next datagram on a channel.
async fn datagram(own: &mut Udp, channel: u8) -> io::Result<Vec<u8>> {
    let mut buffer = vec![0; BUFFER];
    loop {
        if let Some(length) = own.receive(channel.into(), &mut buffer, Instant::now() + LONG).await? {
            buffer.truncate(length);
            return Ok(buffer);
        }
    }
}

/// A stream that was opened, or why not.
pub type Opened = Result<Stream<Box<dyn Peer + Send>>, String>;
type Opening = Pin<Box<dyn Future<Output = Opened>>>;

/// A byte stream, which is opened again when it is gone.
pub struct Line {
    stream: Option<Stream<Box<dyn Peer + Send>>>,
    open: Box<dyn Fn() -> Opening>,
    opening: Option<Opening>,
    /// When to try again, and how often that was in vain.
    due: Instant,
    tries: usize,
    down: Option<String>,
}

impl Line {
    /// An open stream, and how it is opened again.
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

    async fn next(&mut self) -> Happening {
        let mut buffer = [0; 1024];
        loop {
            if let Some(stream) = &mut self.stream {
                match stream.receive(&mut buffer, Instant::now() + LONG).await {
                    Ok(None) => continue,
                    Ok(Some(length)) => {
                        return Happening::Data { to: None, channel: 0, bytes: buffer[..length].to_vec() };
                    }
                    Err(error) => {
                        // A port of this machine is free again only once this handle is gone.
                        self.stream = None;
                        self.down = Some(error.to_string());
                        (self.tries, self.due) = (0, Instant::now() + BACKOFF[0]);
                        return Happening::Lost(error.to_string());
                    }
                }
            }
            if self.opening.is_none() {
                sleep_until(self.due).await;
            }
            match self.opening.get_or_insert_with(|| (self.open)()).await {
                Ok(stream) => {
                    (self.opening, self.stream, self.down) = (None, Some(stream), None);
                    return Happening::Reopened;
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
