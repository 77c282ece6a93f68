//! Session client: finds the session of a device, and uses the connection that the session owns.

mod connection;

use std::collections::VecDeque;
use std::io;

use futures_util::FutureExt as _;
use thiserror::Error;
use tokio::task::yield_now;
use tokio::time::{Instant, sleep_until, timeout_at};

use self::connection::{ANSWER_TIMEOUT, Connection, is_gone};
use super::direct::{ClientEnds, DirectClientLine, HostHandle, Revoked, STOP_FIRST};
use super::location::{LocationError, SessionFolder, SessionPath};
use super::milliseconds;
use super::wire::{Change, Control, Frame, Hello, Images, Peer, Purpose, Status, VERSION, Welcome, WireError, shorten};

/// Reason that is reported if a session ended without a message. Its process was killed or has crashed.
const HOST_ENDED: &str = "the process of the session has ended";

/// Reason why an existing session cannot be used.
#[derive(Debug, Error)]
pub enum AttachError {
    /// The folder or socket of the session is not safe, or cannot be read.
    #[error("{0}")]
    Location(#[from] LocationError),
    /// The session does not answer.
    #[error("the session does not answer")]
    Silent,
    /// The session refuses this client.
    #[error("{0}")]
    Refused(String),
    /// The answer does not come from a session of this version.
    #[error("the answer is not from a session of this version of armctl")]
    WrongVersion,
    /// The socket failed.
    #[error("{0}")]
    Io(#[from] io::Error),
}

impl From<WireError> for AttachError {
    fn from(error: WireError) -> Self {
        match error {
            WireError::Io(error) => Self::Io(error),
            WireError::TooLong(_) | WireError::Invalid => Self::WrongVersion,
        }
    }
}

/// Result of an attempt to attach to a session.
#[derive(Debug)]
pub enum AttachResult {
    /// There is no session.
    Nothing,
    /// There is a socket, but no session listens on it any more.
    Dead,
    /// There is a session. This client is now attached to it.
    Session(Box<Attached>),
}

/// Reason why a client cannot use the session at the moment.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SessionBusy {
    /// The session has ended for this reason.
    #[error("{0}")]
    Ended(String),
    /// Another client owns the line, and did not release it in time.
    #[error("another client uses the connection")]
    Busy(Option<Peer>),
    /// Another client moves the robot.
    #[error("another client moves the robot; nothing was sent")]
    LocationChanged(Peer),
    /// The robot is read-only. The session passes on only reads and stop commands.
    #[error("the robot is read-only, so its session sent nothing")]
    ReadOnly,
}

impl SessionBusy {
    /// Reason in an I/O error of a session link. `None` if the error has another cause.
    pub fn of(error: &io::Error) -> Option<Self> {
        error.get_ref()?.downcast_ref().cloned()
    }
}

/// Finds the session with this key, and attaches to it.
pub async fn attach(key: &str, command: &str, purpose: Purpose) -> Result<AttachResult, AttachError> {
    match SessionFolder::find()? {
        Some(folder) => attach_at(&folder.location(key), key, command, purpose).await,
        None => Ok(AttachResult::Nothing),
    }
}

/// Attaches to a session at a known location.
pub async fn attach_at(
    location: &SessionPath,
    key: &str,
    command: &str,
    purpose: Purpose,
) -> Result<AttachResult, AttachError> {
    let Some(mut connection) = Connection::connect(location).await? else {
        return Ok(if location.check()? { AttachResult::Dead } else { AttachResult::Nothing });
    };
    connection.send_control(hello(key, command, purpose));
    finish_attach(connection).await
}

/// Attaches to a session of this process.
pub async fn attach_in_process(
    host: &HostHandle,
    command: &str,
    purpose: Purpose,
) -> Result<AttachResult, AttachError> {
    let hello = hello(&host.key, command, purpose);
    if host.has_state {
        let mut connection = Connection::Channel(ClientEnds::join(&host.joins));
        connection.send_control(hello);
        return finish_attach(connection).await;
    }
    if host.has_ended() {
        return Ok(AttachResult::Nothing);
    }
    let (pid, version, for_ms) = (std::process::id(), VERSION, milliseconds(host.started));
    let welcome = Welcome { version, pid, for_ms, down: None, leftover: None, images: None };
    let connection = Connection::Unjoined { host: host.clone(), hello: Box::new(hello) };
    let mut attached = Attached::new(connection, welcome);
    attached.direct = host.direct.as_ref().map(|access| DirectClientLine::new(access, command));
    Ok(AttachResult::Session(Box::new(attached)))
}

fn hello(key: &str, command: &str, purpose: Purpose) -> Control {
    let (key, pid, command) = (key.to_owned(), std::process::id(), shorten(command));
    Control::Hello(Hello { version: VERSION, key, pid, command, purpose })
}

/// Waits for the answer to the Hello of a client.
async fn finish_attach(mut connection: Connection) -> Result<AttachResult, AttachError> {
    match connection.answer().await? {
        Control::Welcome(welcome) if welcome.version == VERSION => {
            Ok(AttachResult::Session(Box::new(Attached::new(connection, *welcome))))
        }
        Control::Refused(why) => Err(AttachError::Refused(why)),
        Control::Ended(_) => {
            // The session closes this socket only after it has closed the link. So after this wait, the link is free
            // for another session.
            let closed = async { while let Ok(Some(_)) = connection.next().await {} };
            timeout_at(Instant::now() + ANSWER_TIMEOUT, closed).await.map_err(|_| AttachError::Silent)?;
            Ok(AttachResult::Nothing)
        }
        _ => Err(AttachError::WrongVersion),
    }
}

/// Returns the status of the session at a location; `None` if there is no session.
pub async fn status(location: &SessionPath) -> Result<Option<Status>, AttachError> {
    let Some(mut connection) = Connection::connect(location).await? else { return Ok(None) };
    connection.send_control(Control::Ask);
    match connection.answer().await? {
        Control::Status(status) => Ok(Some(*status)),
        // The session is just closing, so it has no status any more.
        Control::Ended(_) => Ok(None),
        _ => Err(AttachError::WrongVersion),
    }
}

/// Closes the session at a location, and waits until it has ended. Returns `false` if there is no session.
///
/// # Errors
/// [`AttachError::Refused`] if a motion is in progress and `force` is `false`.
pub async fn close(location: &SessionPath, force: bool) -> Result<bool, AttachError> {
    let Some(mut connection) = Connection::connect(location).await? else { return Ok(false) };
    connection.send_control(Control::Close { force });
    match connection.answer().await? {
        Control::Closing | Control::Ended(_) => {}
        Control::Refused(why) => return Err(AttachError::Refused(why)),
        _ => return Err(AttachError::WrongVersion),
    }
    // The host closes the connection when the session has ended. Frames that arrive before are ignored.
    while let Ok(Some(_)) = connection.next().await {}
    Ok(true)
}

/// A client attached to a session.
#[derive(Debug)]
pub struct Attached {
    connection: Connection,
    /// Use of the line without the host, for a client in the process of the host of a datagram link.
    direct: Option<DirectClientLine>,
    /// Frames that arrived while the client waited for a certain other frame.
    early_frames: VecDeque<Frame>,
    /// Bytes of the last frame that did not fit into the buffer of the caller.
    unread_bytes: Vec<u8>,
    line: LineState,
    requests: u32,
    may_move: bool,
    ended: Option<String>,
    /// Whether [`Event::Lost`] has reported the end of the session.
    is_loss_reported: bool,
    /// State of the session at the time when this client attached to it. Only its image to the device is kept up to
    /// date.
    pub welcome: Welcome,
}

/// State of the line for this client. Only the owner of the line can exchange data with the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LineState {
    Free,
    /// The client has requested the line, and waits for it.
    Requested,
    Owned,
    /// The client has taken the line without the host. For a request that only the host may pass on, it waits until
    /// this time for the line of the host.
    Direct(Instant),
}

impl Attached {
    fn new(connection: Connection, mut welcome: Welcome) -> Self {
        let seen = welcome.images.as_mut().and_then(|images| images.seen.take());
        let early_frames = seen.map(Frame::Image).into_iter().collect();
        let (line, unread_bytes) = (LineState::Free, Vec::new());
        Self {
            connection,
            direct: None,
            early_frames,
            unread_bytes,
            line,
            requests: 0,
            may_move: false,
            ended: None,
            is_loss_reported: false,
            welcome,
        }
    }

    /// Reason for the end of the session; `None` if it has not ended.
    pub fn ended(&self) -> Option<&str> {
        self.ended.as_deref()
    }

    /// Whether this client owns the line.
    pub fn has_line(&self) -> bool {
        self.line == LineState::Owned
    }

    /// Waits until `until` for the line. The future is cancel safe.
    pub async fn acquire(&mut self, until: Instant) -> Result<(), SessionBusy> {
        self.acquire_channel(0, until).await
    }

    /// Waits until `until` for one channel of the line. Other clients may own other channels at the same time.
    pub async fn acquire_channel(&mut self, channel: u8, until: Instant) -> Result<(), SessionBusy> {
        if let LineState::Direct(_) = self.line {
            // An exchange was cut short, and the host may have revoked the line in the meantime.
            self.release();
        }
        if let (LineState::Free, Some(direct)) = (self.line, &self.direct) {
            if channel == 0 && direct.take() {
                self.line = LineState::Direct(until);
                return Ok(());
            }
            if let Some(why) = direct.ended() {
                self.ended = Some(why);
            }
        }
        self.acquire_from_host(channel, until).await
    }

    async fn acquire_from_host(&mut self, channel: u8, until: Instant) -> Result<(), SessionBusy> {
        if self.line == LineState::Owned {
            return Ok(());
        }
        if let Some(why) = &self.ended {
            return Err(SessionBusy::Ended(why.clone()));
        }
        if self.line == LineState::Free {
            self.requests = self.requests.wrapping_add(1);
            self.send_control(Control::Take { number: self.requests, channel });
            self.line = LineState::Requested;
        }
        let mut holder = None;
        while self.line == LineState::Requested {
            match self.next_from_socket(until).await? {
                None => {
                    self.release();
                    return Err(SessionBusy::Busy(holder));
                }
                Some(Frame::Control(Control::Taken(take))) if take == self.requests => self.line = LineState::Owned,
                Some(Frame::Control(Control::Queued(peer))) => holder = Some(peer),
                Some(frame) => self.early_frames.push_back(frame),
            }
        }
        if self.images().is_none() {
            // Frames that arrived before the client got the line belong to earlier exchanges.
            self.early_frames.clear();
            self.unread_bytes.clear();
        }
        Ok(())
    }

    /// Releases the line.
    pub fn release(&mut self) {
        match (self.line, &self.direct) {
            (LineState::Free, _) => {}
            (LineState::Direct(_), Some(direct)) => direct.release(),
            _ => self.connection.send_control(Control::Over),
        }
        self.line = LineState::Free;
    }

    /// Sends a control frame to the host. Before its first frame, a client of this process joins the host.
    fn send_control(&mut self, control: Control) {
        self.connection.send_control(control);
        if let Some(direct) = &self.direct {
            direct.has_joined();
        }
    }

    /// Claims motion for this client, so that no other client of the session may move the robot.
    pub async fn claim_motion(&mut self) -> Result<(), SessionBusy> {
        if self.may_move {
            return Ok(());
        }
        self.send_control(Control::Motion);
        let until = Instant::now() + ANSWER_TIMEOUT;
        loop {
            match self.next_from_socket(until).await? {
                None => return Err(SessionBusy::Ended("the session does not answer".to_owned())),
                Some(Frame::Control(Control::Granted)) => break,
                Some(Frame::Control(Control::Held(peer))) => return Err(SessionBusy::LocationChanged(peer)),
                Some(frame) => self.early_frames.push_back(frame),
            }
        }
        self.may_move = true;
        Ok(())
    }

    /// Detaches from the session.
    pub async fn leave(mut self) {
        // An error is ignored: a host that no longer exists needs no message.
        let _ = timeout_at(Instant::now() + ANSWER_TIMEOUT, self.connection.flush()).await;
    }

    /// Sends a datagram or bytes of a stream. If the client does not own the line, nothing is sent, because the host
    /// would drop the bytes.
    pub async fn send(&mut self, channel: u8, bytes: &[u8]) -> io::Result<()> {
        if let Some(why) = &self.ended {
            return Err(io::Error::new(io::ErrorKind::NotConnected, why.clone()));
        }
        if let (LineState::Direct(until), Some(direct)) = (self.line, &mut self.direct) {
            if direct.may_send(bytes) {
                let sent = direct.send(channel, bytes).await;
                return sent.map_err(|revoked| self.revoked_error(revoked));
            }
            // Only the host may pass on a change, because it checks whether the robot is read-only.
            self.release();
            self.acquire_from_host(channel, until).await.map_err(io::Error::other)?;
        }
        if self.has_line() {
            self.connection.send_frame(Frame::Data { channel, bytes: bytes.to_vec() });
            if let Err(error) = self.connection.flush().await {
                let why = self.end_with(Some(error.into()));
                return Err(io::Error::new(io::ErrorKind::NotConnected, why));
            }
        }
        Ok(())
    }

    /// Error of a client that has lost the line.
    fn revoked_error(&mut self, revoked: Revoked) -> io::Error {
        let why = match revoked {
            Revoked::Socket(error) => return error,
            Revoked::Stop => STOP_FIRST.to_owned(),
            Revoked::Ended(why) => {
                self.ended = Some(why.clone());
                why
            }
        };
        io::Error::new(io::ErrorKind::NotConnected, why)
    }

    /// Marks the session as ended, because its socket was closed or failed. Returns the reason.
    fn end_with(&mut self, error: Option<WireError>) -> String {
        let why = match error {
            Some(error) if !is_gone(&error) => format!("the session was lost: {error}"),
            _ => HOST_ENDED.to_owned(),
        };
        self.ended = Some(why.clone());
        why
    }

    /// Requests that the host opens a new socket for a channel.
    pub fn renew(&mut self, channel: u8) {
        match &mut self.direct {
            Some(direct) => {
                direct.renew(channel);
                // A client that has not joined the host has no other sockets.
                if let Connection::Channel(_) = self.connection {
                    self.connection.send_control(Control::Renew(channel));
                }
            }
            None => self.connection.send_control(Control::Renew(channel)),
        }
    }

    /// Waits until `until` for a datagram of a channel. Bytes that do not fit into the buffer are dropped.
    pub async fn receive(
        &mut self,
        expected_channel: u8,
        buffer: &mut [u8],
        until: Instant,
    ) -> io::Result<Option<usize>> {
        if let (LineState::Direct(_), Some(direct)) = (self.line, &mut self.direct) {
            let received = direct.receive(expected_channel, buffer, until).await;
            return received.map_err(|revoked| self.revoked_error(revoked));
        }
        loop {
            match self.data(until).await? {
                Some((channel, bytes)) if channel == expected_channel => return Ok(Some(copy(&bytes, buffer))),
                Some(_) => {}
                None => return Ok(None),
            }
        }
    }

    /// Waits until `until` for bytes of a stream. Bytes that do not fit into the buffer are returned by the next call.
    pub async fn read(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        if self.unread_bytes.is_empty() {
            let Some((_, bytes)) = self.data(until).await? else { return Ok(None) };
            self.unread_bytes = bytes;
        }
        let length = copy(&self.unread_bytes, buffer);
        self.unread_bytes.drain(..length);
        Ok(Some(length))
    }

    async fn data(&mut self, until: Instant) -> io::Result<Option<(u8, Vec<u8>)>> {
        loop {
            match self.next(until).await {
                Some(Frame::Data { channel, bytes }) => return Ok(Some((channel, bytes))),
                Some(Frame::Control(Control::Broken(broken))) => return Err(broken.into()),
                Some(Frame::Control(Control::Denied { .. })) => {
                    return Err(io::Error::other(SessionBusy::ReadOnly));
                }
                Some(Frame::Control(Control::Lost(why))) => {
                    return Err(io::Error::new(io::ErrorKind::NotConnected, why));
                }
                Some(_) => {}
                None => match &self.ended {
                    Some(why) => return Err(io::Error::new(io::ErrorKind::NotConnected, why.clone())),
                    None => return Ok(None),
                },
            }
        }
    }

    /// Returns the next frame; `None` after a timeout or the end of the session.
    async fn next(&mut self, until: Instant) -> Option<Frame> {
        match self.early_frames.pop_front() {
            Some(frame) => Some(frame),
            None => self.next_from_socket(until).await.unwrap_or_default(),
        }
    }

    /// Returns the next frame from the socket; `None` after a timeout.
    async fn next_from_socket(&mut self, until: Instant) -> Result<Option<Frame>, SessionBusy> {
        if let Some(why) = &self.ended {
            return Err(SessionBusy::Ended(why.clone()));
        }
        let next = if Instant::now() < until {
            timeout_at(until, self.connection.next()).await.ok()
        } else {
            // An expired timer needs a millisecond to fire. Without a timer, frames that have already arrived are read
            // at once.
            yield_now().await;
            self.connection.next().now_or_never()
        };
        let why = match next {
            None => return Ok(None),
            Some(Ok(Some(Frame::Control(Control::Ended(why))))) => {
                self.ended = Some(why.clone());
                why
            }
            Some(Ok(Some(frame))) => return Ok(Some(frame)),
            Some(Ok(None)) => self.end_with(None),
            Some(Err(error)) => self.end_with(Some(error)),
        };
        Err(SessionBusy::Ended(why))
    }
}

/// Sends Bye if the client ends normally. A killed process sends no Bye, and the host detects this.
impl Drop for Attached {
    fn drop(&mut self) {
        if self.ended.is_none() {
            self.connection.send_last(Control::Bye);
        }
    }
}

fn copy(bytes: &[u8], buffer: &mut [u8]) -> usize {
    let length = bytes.len().min(buffer.len());
    buffer[..length].copy_from_slice(&bytes[..length]);
    length
}

/// Event of an image session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// The last image of [`Attached::set_output`] was sent.
    Sent,
    /// A new image of the device.
    Image(Vec<u8>),
    /// Another client has changed the image to the device.
    OutputChanged(Change),
    /// The host refused the last image, because the robot is read-only. [`Attached::output`] is the image that the
    /// device really gets.
    Denied,
    /// The link was lost for this reason.
    Lost(String),
    /// The link is open again. [`Attached::output`] is the image that the device now gets.
    Reopened,
    /// There was no event before the deadline.
    Timeout,
}

impl Attached {
    /// State of the images; `None` if the session has no images.
    fn images(&self) -> Option<&Images> {
        self.welcome.images.as_ref()
    }

    /// Current image to the device, as last reported to this client. `None` if the session has no images.
    pub fn output(&self) -> Option<&[u8]> {
        self.images().map(|images| &images.shown[..])
    }

    /// Sends the bits of this image that differ from the current image. If the client does not own the line, the
    /// exclusive part of the image stays unchanged.
    pub fn set_output(&mut self, image: &[u8]) {
        let has_line = self.has_line();
        let Some(images) = &mut self.welcome.images else { return };
        let masks = images.shown.iter().zip(image).enumerate().map(|(at, (before, after))| {
            if at < images.exclusive { if has_line { 0xFF } else { 0 } } else { before ^ after }
        });
        let mask: Vec<u8> = masks.collect();
        let value = image.iter().copied().take(mask.len()).collect();
        let change = Change { generation: images.generation, mask, value };
        change.apply(&mut images.shown);
        self.connection.send_frame(Frame::Show(change));
    }

    /// Sets the last will: bits (mask and value) that the host sends if this process is killed. `None` removes the last
    /// will. The host stores the last will before it handles the next image of this client.
    pub fn set_last_will(&mut self, bits: Option<(&[u8], &[u8])>) {
        let Some(images) = &self.welcome.images else { return };
        let generation = images.generation;
        let will = bits.map(|(mask, value)| Change { generation, mask: mask.to_vec(), value: value.to_vec() });
        self.connection.send_control(Control::Will(will));
    }

    /// Waits until `until` for the next event. The future is cancel safe.
    pub async fn event(&mut self, until: Instant) -> Event {
        loop {
            match self.next(until).await {
                Some(Frame::Image(image)) => return Event::Image(image),
                Some(Frame::Control(Control::Sent)) => return Event::Sent,
                Some(Frame::Control(Control::Lost(why))) => return Event::Lost(why),
                Some(Frame::Control(Control::Reopened { generation, shown })) => {
                    if let Some(images) = &mut self.welcome.images {
                        (images.generation, images.shown) = (generation, shown);
                    }
                    return Event::Reopened;
                }
                Some(Frame::Show(change)) => {
                    if let Some(images) = &mut self.welcome.images {
                        change.apply(&mut images.shown);
                    }
                    return Event::OutputChanged(change);
                }
                Some(Frame::Control(Control::Denied { shown })) => {
                    if let (Some(images), Some(shown)) = (&mut self.welcome.images, shown) {
                        images.shown = shown;
                    }
                    return Event::Denied;
                }
                Some(_) => {}
                None => {
                    match self.ended.clone() {
                        Some(why) if !std::mem::replace(&mut self.is_loss_reported, true) => return Event::Lost(why),
                        // The session has ended, so no more events follow.
                        Some(_) => sleep_until(until).await,
                        None => {}
                    }
                    return Event::Timeout;
                }
            }
        }
    }
}
