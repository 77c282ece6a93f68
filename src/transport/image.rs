//! Links that carry images: what each side shows the other, over and over, where other links carry bytes that pass once.
//!
//! A fieldbus sends the newest image in its own rhythm; what is replaced before its turn never leaves. So whoever needs
//! an image to be seen shows it and waits for [`Event::Sent`]. After a loss the peer is shown what the way rests at,
//! idle, until something is shown again: nothing that was meant for the time before happens a second time.
//!
//! A link may be another process's, which lets several have it: see [`session`](super::session).

use std::fmt;
use std::net::SocketAddrV4;
use std::sync::Arc;
use std::time::Duration;

use tokio::time::Instant;

use super::eip::client::Client;
use super::eip::originator::{State, Statistics};
use super::eip::reader::{Assembly, Reader};
use super::eip::scanner::{Connection, Scanner};
use super::eip::settings::Settings;
use super::eip::tap::Tap;
use super::eip::trouble::Trouble;
use super::session::client::{self, Attached, Hindrance};
use super::session::wire::Change;

/// What happens on a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// What was shown last has left.
    Sent,
    /// The peer shows something new; or it shows something for the first time since the link is up.
    Image(Arc<[u8]>),
    /// The link went down, and why.
    Lost(String),
    /// The link is up again.
    Reopened,
    /// Somebody else who uses the link has changed what the peer is shown.
    Shown(Change),
    /// Nothing until then.
    Timeout,
}

/// Why a link did not come about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OpenError {
    /// No address belongs to the name.
    NotFound,
    /// The addresses are not IPv4.
    NotIpv4,
    /// The device does not open it, or is not there.
    Trouble(Trouble),
}

/// The other end of a link in this process, such as a simulated controller.
pub trait ImagePeer: fmt::Debug {
    /// Takes what it is shown from `now` on; `None`: whoever showed something is gone.
    fn input(&mut self, now: Duration, image: Option<&[u8]>);
    /// What it shows at `now`; `None` while the link is down.
    fn output(&mut self, now: Duration) -> Option<Vec<u8>>;
    /// When it may show something else by itself.
    fn wake(&self) -> Option<Duration>;
}

/// A link to one peer.
#[derive(Debug)]
pub struct ImageLink {
    way: Way,
    /// What the peer was last told to show, to tell news from repetition.
    seen: Option<Arc<[u8]>>,
    is_up: bool,
    /// What must live as long as the link, such as the other end where that is in this process.
    kept: Option<Box<dyn fmt::Debug>>,
}

#[derive(Debug)]
enum Way {
    Eip(Eip),
    Read(Reader),
    InProcess(InProcess),
    Session(Box<Attached>),
}

/// A class 1 connection of EtherNet/IP.
#[derive(Debug)]
struct Eip {
    connection: Connection,
    /// The opening that is known of.
    generation: u32,
    /// The change that has not left yet.
    pending: Option<u64>,
}

/// A peer in this process, on tokio's clock (which tests can halt and turn).
#[derive(Debug)]
struct InProcess {
    peer: Box<dyn ImagePeer>,
    start: Instant,
    /// What has not left yet.
    pending: Option<Vec<u8>>,
    /// The earliest moment for the next image to leave.
    due: Duration,
}

/// Time between two images to a peer in this process.
pub const CYCLE: Duration = Duration::from_millis(5);

impl ImageLink {
    /// Opens a connection to the first IPv4 address of the host, and holds it. All of a process share a UDP socket.
    pub async fn open(host: &str, port: u16, settings: Settings, tap: Tap) -> Result<Self, OpenError> {
        let target = resolve(host, port).await?;
        let scanner = Scanner::shared().map_err(OpenError::Trouble)?;
        let connection = scanner.open(target, settings, tap).await.map_err(OpenError::Trouble)?;
        let generation = connection.view().generation;
        Ok(Self::over(Way::Eip(Eip { connection, generation, pending: None })))
    }

    /// Sees what the device shows in this assembly, by messages with a pause between them. Nothing can be shown to it.
    pub async fn reading(client: Client, assembly: Assembly, pause: Duration) -> Result<Self, OpenError> {
        Ok(Self::over(Way::Read(Reader::open(client, assembly, pause).await.map_err(OpenError::Trouble)?)))
    }

    /// A link to a peer in this process.
    pub fn in_process(peer: Box<dyn ImagePeer>) -> Self {
        Self::over(Way::InProcess(InProcess { peer, start: Instant::now(), pending: None, due: Duration::ZERO }))
    }

    /// A link that another process holds.
    pub fn in_session(attached: Box<Attached>) -> Self {
        let is_up = attached.welcome.down.is_none();
        Self { is_up, ..Self::over(Way::Session(attached)) }
    }

    /// Keeps something until the link is closed.
    #[must_use]
    pub fn keeping(self, kept: Box<dyn fmt::Debug>) -> Self {
        Self { kept: Some(kept), ..self }
    }

    fn over(way: Way) -> Self {
        Self { way, seen: None, is_up: true, kept: None }
    }

    /// Whether the link is up.
    pub fn is_up(&self) -> bool {
        self.is_up
    }

    /// What the peer is shown already where another process holds the link.
    pub fn shown(&self) -> Option<&[u8]> {
        match &self.way {
            Way::Session(attached) => attached.shown(),
            Way::Eip(_) | Way::Read(_) | Way::InProcess(_) => None,
        }
    }

    /// Waits until the exclusive part of what is shown is this process's to change, but not longer than `until`.
    pub async fn take(&mut self, until: Instant) -> Result<(), Hindrance> {
        match &mut self.way {
            Way::Session(attached) => attached.take(until).await,
            Way::Eip(_) | Way::Read(_) | Way::InProcess(_) => Ok(()),
        }
    }

    /// Lets others change the exclusive part.
    pub fn give(&mut self) {
        if let Way::Session(attached) = &mut self.way {
            attached.over();
        }
    }

    /// Has a session show these bits, mask and value, if this process dies; or no more. Without one, the link dies with it.
    pub fn bequeath(&mut self, bits: Option<(&[u8], &[u8])>) {
        if let Way::Session(attached) = &mut self.way {
            attached.bequeath(bits);
        }
    }

    /// Becomes the only one who moves the robot.
    pub async fn claim_motion(&mut self) -> Result<(), Hindrance> {
        match &mut self.way {
            Way::Session(attached) => attached.claim_motion().await,
            Way::Eip(_) | Way::Read(_) | Way::InProcess(_) => Ok(()),
        }
    }

    /// Why the process that held the link holds it no longer.
    pub fn ended(&self) -> Option<&str> {
        match &self.way {
            Way::Session(attached) => attached.ended(),
            Way::Eip(_) | Way::Read(_) | Way::InProcess(_) => None,
        }
    }

    /// Shows the peer this image from the next cycle on; [`Event::Sent`] tells when it has left. While the link is down
    /// it never does.
    ///
    /// # Errors
    /// When the image does not have the size of the connection.
    pub fn show(&mut self, image: &[u8]) -> Result<(), Trouble> {
        match &mut self.way {
            Way::Eip(eip) => eip.show(image),
            Way::Read(_) => Err(Trouble::Impossible("a link that only reads shows nothing".to_owned())),
            Way::InProcess(peer) => {
                peer.pending = Some(image.to_vec());
                Ok(())
            }
            Way::Session(attached) => {
                attached.show(image);
                Ok(())
            }
        }
    }

    /// Waits for the next thing to happen, but not longer than `until`. The future may be dropped.
    pub async fn next(&mut self, until: Instant) -> Event {
        let event = match &mut self.way {
            Way::Eip(eip) => eip.next(self.is_up, self.seen.as_ref(), until).await,
            Way::Read(reader) => next_reading(reader, self.is_up, self.seen.as_ref(), until).await,
            Way::InProcess(peer) => peer.next(self.is_up, self.seen.as_ref(), until).await,
            Way::Session(attached) => attached.event(until).await.into(),
        };
        match &event {
            Event::Image(image) => self.seen = Some(Arc::clone(image)),
            Event::Lost(_) => (self.is_up, self.seen) = (false, None),
            Event::Reopened => self.is_up = true,
            Event::Sent | Event::Shown(_) | Event::Timeout => {}
        }
        event
    }

    /// What was counted, and the intervals that the device keeps, to it and from it; `None` for what has no network.
    pub fn statistics(&self) -> Option<(Statistics, Option<(Duration, Duration)>)> {
        match &self.way {
            Way::Eip(eip) => {
                let view = eip.connection.view();
                Some((view.statistics, view.intervals))
            }
            Way::Read(_) | Way::InProcess(_) | Way::Session(_) => None,
        }
    }

    /// Ends it properly; one that another process holds goes on.
    pub async fn close(self) -> Result<(), Trouble> {
        let Self { way, kept, .. } = self;
        let closed = match way {
            Way::Eip(eip) => eip.connection.close().await,
            Way::Read(reader) => {
                reader.close().await;
                Ok(())
            }
            Way::InProcess(mut peer) => {
                peer.peer.input(peer.start.elapsed(), None);
                Ok(())
            }
            Way::Session(attached) => {
                attached.leave().await;
                Ok(())
            }
        };
        // The other end must not go before it is told.
        drop(kept);
        closed
    }
}

impl From<client::Event> for Event {
    fn from(event: client::Event) -> Self {
        match event {
            client::Event::Sent => Self::Sent,
            client::Event::Image(image) => Self::Image(image.into()),
            client::Event::Shown(change) => Self::Shown(change),
            client::Event::Lost(why) => Self::Lost(why),
            client::Event::Reopened => Self::Reopened,
            client::Event::Timeout => Self::Timeout,
        }
    }
}

/// The first IPv4 address of a host.
pub async fn resolve(host: &str, port: u16) -> Result<SocketAddrV4, OpenError> {
    let addresses = tokio::net::lookup_host((host, port)).await.map_err(|_| OpenError::NotFound)?;
    let target = addresses.filter_map(|address| match address {
        std::net::SocketAddr::V4(address) => Some(address),
        std::net::SocketAddr::V6(_) => None,
    });
    target.into_iter().next().ok_or(OpenError::NotIpv4)
}

async fn next_reading(reader: &mut Reader, is_up: bool, seen: Option<&Arc<[u8]>>, until: Instant) -> Event {
    loop {
        match reader.reading() {
            Ok(_) if !is_up => return Event::Reopened,
            Ok(image) if seen.is_none_or(|seen| *seen != image) => return Event::Image(image),
            Err(trouble) if is_up => return Event::Lost(trouble.to_string()),
            Ok(_) | Err(_) => {}
        }
        tokio::select! {
            () = reader.changed() => {}
            () = tokio::time::sleep_until(until) => return Event::Timeout,
        }
    }
}

impl Eip {
    fn show(&mut self, image: &[u8]) -> Result<(), Trouble> {
        // What was to be seen before is replaced, whatever becomes of this.
        self.pending = None;
        let shown = self.connection.set_image(self.generation, image).and_then(|change| {
            // From the first image after an opening on the device may act upon it.
            if self.connection.view().run { Ok(change) } else { self.connection.set_run(self.generation, true) }
        });
        match shown {
            Ok(change) => {
                self.pending = Some(change);
                Ok(())
            }
            // The loss is told by `next`.
            Err(Trouble::Outdated | Trouble::Ended) => Ok(()),
            Err(trouble) => Err(trouble),
        }
    }

    async fn next(&mut self, is_up: bool, seen: Option<&Arc<[u8]>>, until: Instant) -> Event {
        loop {
            let view = self.connection.view();
            let is_open = view.state == State::Open;
            if is_up && !(is_open && view.generation == self.generation) {
                self.pending = None;
                let why = view.trouble.map_or_else(|| "it was opened anew".to_owned(), |trouble| trouble.to_string());
                return Event::Lost(why);
            }
            if !is_up && is_open {
                self.generation = view.generation;
                return Event::Reopened;
            }
            if is_up && self.pending.is_some_and(|change| view.sent >= change) {
                self.pending = None;
                return Event::Sent;
            }
            let input = view.input.filter(|input| is_up && input.generation == self.generation);
            if let Some(input) = input.filter(|input| seen.is_none_or(|seen| *seen != input.image)) {
                return Event::Image(input.image);
            }
            tokio::select! {
                _ = self.connection.changed() => {}
                () = tokio::time::sleep_until(until) => return Event::Timeout,
            }
        }
    }
}

impl InProcess {
    async fn next(&mut self, is_up: bool, seen: Option<&Arc<[u8]>>, until: Instant) -> Event {
        loop {
            let now = self.start.elapsed();
            let shown = self.peer.output(now);
            match (&shown, is_up) {
                (None, true) => {
                    self.pending = None;
                    return Event::Lost("the peer is gone".to_owned());
                }
                (Some(_), false) => return Event::Reopened,
                _ => {}
            }
            if is_up
                && now >= self.due
                && let Some(image) = self.pending.take()
            {
                self.peer.input(now, Some(&image));
                self.due = now + CYCLE;
                return Event::Sent;
            }
            if let Some(image) = shown.filter(|image| seen.is_none_or(|seen| **seen != image[..])) {
                return Event::Image(image.into());
            }
            if Instant::now() >= until {
                return Event::Timeout;
            }
            // Whoever is due all the time is looked at in the rhythm of the link.
            let wake = self.peer.wake().map(|wake| if wake > now { wake } else { now + CYCLE });
            let leave = self.pending.as_ref().filter(|_| is_up).map(|_| self.due);
            let due = wake.into_iter().chain(leave).min().map_or(until, |due| until.min(self.start + due));
            tokio::time::sleep_until(due).await;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::sync::Mutex;

    use super::*;

    /// What was shown, and when.
    type Heard = Vec<(Duration, Option<Vec<u8>>)>;

    /// Shows back what it is shown, a scan of 3 ms later; is gone between two moments.
    #[derive(Debug, Default)]
    struct Echo {
        coming: VecDeque<(Duration, Vec<u8>)>,
        shown: Vec<u8>,
        gone: Option<(Duration, Duration)>,
        heard: Arc<Mutex<Heard>>,
    }

    impl ImagePeer for Echo {
        fn input(&mut self, now: Duration, image: Option<&[u8]>) {
            self.heard.lock().unwrap().push((now, image.map(<[u8]>::to_vec)));
            self.coming.extend(image.map(|image| (now + Duration::from_millis(3), image.to_vec())));
        }

        fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
            while let Some((_, image)) = self.coming.pop_front_if(|(at, _)| *at <= now) {
                self.shown = image;
            }
            let is_gone = self.gone.is_some_and(|(from, to)| (from..to).contains(&now));
            (!is_gone).then(|| self.shown.clone())
        }

        fn wake(&self) -> Option<Duration> {
            let gone = self.gone.into_iter().flat_map(|(from, to)| [from, to]);
            self.coming.iter().map(|(at, _)| *at).chain(gone).min()
        }
    }

    fn at(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    async fn later(link: &mut ImageLink, ms: u64) -> Event {
        link.next(Instant::now() + at(ms)).await
    }

    fn image(bytes: &[u8]) -> Event {
        Event::Image(bytes.into())
    }

    #[tokio::test(start_paused = true)]
    async fn images_leave_in_the_rhythm_of_the_link_and_only_news_are_told() {
        let echo = Echo::default();
        let heard = Arc::clone(&echo.heard);
        let mut link = ImageLink::in_process(Box::new(echo));
        assert_eq!(later(&mut link, 10).await, image(&[]));
        link.show(b"a").unwrap();
        assert_eq!(later(&mut link, 10).await, Event::Sent);
        link.show(b"b").unwrap();
        link.show(b"c").unwrap();
        assert_eq!(later(&mut link, 10).await, image(b"a"));
        assert_eq!(later(&mut link, 10).await, Event::Sent);
        assert_eq!(later(&mut link, 10).await, image(b"c"));
        assert_eq!(later(&mut link, 10).await, Event::Timeout);
        link.close().await.unwrap();
        let heard: Vec<(u64, Option<Vec<u8>>)> = heard
            .lock()
            .unwrap()
            .iter()
            .map(|(at, image)| (u64::try_from(at.as_millis()).unwrap(), image.clone()))
            .collect();
        assert_eq!(heard, [(0, Some(b"a".to_vec())), (5, Some(b"c".to_vec())), (18, None)], "b never left");
    }

    #[tokio::test(start_paused = true)]
    async fn what_was_to_be_sent_before_a_loss_is_not_sent_after_it() {
        let echo = Echo { gone: Some((at(4), at(20))), ..Echo::default() };
        let heard = Arc::clone(&echo.heard);
        let mut link = ImageLink::in_process(Box::new(echo));
        assert_eq!(later(&mut link, 1).await, image(&[]));
        link.show(b"a").unwrap();
        assert_eq!(later(&mut link, 1).await, Event::Sent);
        link.show(b"b").unwrap();
        assert_eq!(later(&mut link, 100).await, image(b"a"));
        assert_eq!(later(&mut link, 100).await, Event::Lost("the peer is gone".to_owned()));
        assert_eq!(later(&mut link, 10).await, Event::Timeout);
        assert_eq!(later(&mut link, 100).await, Event::Reopened);
        assert_eq!(later(&mut link, 100).await, image(b"a"), "shown again after every opening");
        assert_eq!(later(&mut link, 100).await, Event::Timeout);
        assert_eq!(heard.lock().unwrap().len(), 1);
    }
}
