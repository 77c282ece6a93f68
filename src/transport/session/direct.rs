//! Clients in the process of the host. They reach the host through channels, and need no socket.
//!
//! For a read on a datagram link, they do not even need the thread of the host: if the line is free, the client takes
//! it from the host, exchanges datagrams itself, and returns the line. Everything else passes
//! through the host, which checks it like the frames of any client: changes, motions, and exchanges for which the line
//! is not free.

use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::{Notify, mpsc};
use tokio::time::Instant;

use super::host::shared_link::Carrier;
use super::milliseconds;
use super::wire::{Frame, Peer, shorten};

/// Maximum number of frames on the way to a client. Further frames wait in the outbox of the client.
const CHANNEL_SIZE: usize = 64;

/// Access to a host of this process, for clients in other threads.
#[derive(Debug, Clone)]
pub struct HostHandle {
    /// Key of the session.
    pub(super) key: Arc<str>,
    /// Start of the session.
    pub(super) started: Instant,
    pub(super) joins: mpsc::UnboundedSender<HostEnds>,
    /// Whether the link has a state that a new client must receive first: it can be down, or has images.
    pub(super) has_state: bool,
    /// The line, and what a client needs to use it without the host. `None` for a link that only the host can use.
    pub(super) direct: Option<DirectAccess>,
}

impl HostHandle {
    /// Whether the session has ended.
    pub fn has_ended(&self) -> bool {
        self.joins.is_closed()
    }
}

/// What a client needs to read without the thread of the host.
#[derive(Debug, Clone)]
pub(super) struct DirectAccess {
    pub line: Arc<DirectLine>,
    pub carrier: Arc<Carrier>,
    /// Whether these bytes only read, or stop the robot. The host checks all other bytes.
    pub is_harmless: fn(&[u8]) -> bool,
}

/// The host's ends of the channels of a client.
#[derive(Debug)]
pub(super) struct HostEnds {
    pub from_client: mpsc::UnboundedReceiver<Frame>,
    pub to_client: mpsc::Sender<Frame>,
}

/// The client's ends of its channels.
#[derive(Debug)]
pub(super) struct ClientEnds {
    pub to_host: mpsc::UnboundedSender<Frame>,
    pub from_host: mpsc::Receiver<Frame>,
}

impl ClientEnds {
    /// Connects to a host. If the session has ended, the client receives the end of the connection.
    pub fn join(host: &mpsc::UnboundedSender<HostEnds>) -> Self {
        let (to_host, from_client) = mpsc::unbounded_channel();
        let (to_client, from_host) = mpsc::channel(CHANNEL_SIZE);
        // If the host no longer exists, its ends are dropped here, and this closes the channels.
        drop(host.send(HostEnds { from_client, to_client }));
        Self { to_host, from_host }
    }
}

/// The line of a datagram link, shared by the host and the clients of its process. While no client waits for the line
/// at the host, the host offers it, and a client can take it without the host.
#[derive(Debug, Default)]
pub(super) struct DirectLine {
    state: Mutex<State>,
    /// Notified when a client returns the line to the host.
    returned: Notify,
    /// Notified when the host revokes the line.
    revoked: Notify,
}

#[derive(Debug, Default)]
struct State {
    owner: Owner,
    last: u64,
    /// Clients that have not joined the host.
    clients: Vec<DirectClient>,
}

/// A client that has not joined the host.
#[derive(Debug)]
struct DirectClient {
    id: u64,
    command: String,
    since: Instant,
}

/// Owner of the line.
#[derive(Debug, Default)]
enum Owner {
    /// The host, for itself or for a client that has joined it.
    #[default]
    Host,
    /// The line is free for the clients of this process.
    Offered,
    Client {
        id: u64,
        command: String,
        since: Instant,
        /// Whether the host waits for the line.
        is_wanted: bool,
    },
    /// The session has ended for this reason.
    Ended(String),
}

impl DirectLine {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Host: lets clients of this process take the line.
    pub fn offer(&self) {
        let mut state = self.state();
        if matches!(state.owner, Owner::Host) {
            state.owner = Owner::Offered;
        }
    }

    /// Host: takes the line. If a client has it, returns `false`, and [`DirectLine::returned`] reports when the client
    /// has returned it.
    pub fn withdraw(&self) -> bool {
        let mut state = self.state();
        match &mut state.owner {
            Owner::Client { is_wanted, .. } => {
                *is_wanted = true;
                false
            }
            owner => {
                if matches!(owner, Owner::Offered) {
                    *owner = Owner::Host;
                }
                true
            }
        }
    }

    /// Host: takes the line, also from a client.
    pub fn revoke(&self) {
        let mut state = self.state();
        if !matches!(state.owner, Owner::Ended(_)) {
            state.owner = Owner::Host;
        }
        drop(state);
        self.revoked.notify_waiters();
    }

    /// Host: ends the line with the session.
    pub fn end(&self, why: &str) {
        self.state().owner = Owner::Ended(why.to_owned());
        self.revoked.notify_waiters();
    }

    /// Host: waits until a client returns the line that the host waits for. The future is cancel safe.
    pub async fn returned(&self) {
        self.returned.notified().await;
    }

    /// Host: client that has the line.
    pub fn holder(&self) -> Option<Peer> {
        match &self.state().owner {
            Owner::Client { command, since, .. } => Some(peer(command, *since)),
            Owner::Host | Owner::Offered | Owner::Ended(_) => None,
        }
    }

    /// Host: clients that have not joined the host.
    pub fn clients(&self) -> Vec<Peer> {
        self.state().clients.iter().map(|client| peer(&client.command, client.since)).collect()
    }

    fn enter(&self, command: &str) -> u64 {
        let mut state = self.state();
        state.last += 1;
        let id = state.last;
        state.clients.push(DirectClient { id, command: shorten(command), since: Instant::now() });
        id
    }

    /// Reason for the end of the session; `None` if it has not ended.
    fn ended(&self) -> Option<String> {
        match &self.state().owner {
            Owner::Ended(why) => Some(why.clone()),
            Owner::Host | Owner::Offered | Owner::Client { .. } => None,
        }
    }

    fn leave(&self, id: u64) {
        self.state().clients.retain(|client| client.id != id);
    }

    fn take(&self, id: u64, command: &str) -> bool {
        let mut state = self.state();
        let is_free = matches!(state.owner, Owner::Offered);
        if is_free {
            state.owner = Owner::Client { id, command: shorten(command), since: Instant::now(), is_wanted: false };
        }
        is_free
    }

    fn release(&self, id: u64) {
        let mut state = self.state();
        let Owner::Client { id: owner, is_wanted, .. } = state.owner else { return };
        if owner == id {
            state.owner = if is_wanted { Owner::Host } else { Owner::Offered };
            drop(state);
            if is_wanted {
                self.returned.notify_one();
            }
        }
    }

    /// Checks that the client has the line.
    ///
    /// # Errors
    /// The reason why the client lost it, and whether the session has ended.
    fn check(&self, id: u64) -> Result<(), Revoked> {
        match &self.state().owner {
            Owner::Client { id: owner, .. } if *owner == id => Ok(()),
            Owner::Ended(why) => Err(Revoked::Ended(why.clone())),
            Owner::Host | Owner::Offered | Owner::Client { .. } => Err(Revoked::Stop),
        }
    }

    /// Waits until the host revokes the line of this client.
    async fn lost(&self, id: u64) -> Revoked {
        loop {
            let notified = self.revoked.notified();
            tokio::pin!(notified);
            // From here on, a notification is not missed.
            notified.as_mut().enable();
            if let Err(revoked) = self.check(id) {
                return revoked;
            }
            notified.await;
        }
    }
}

/// Reason why a client lost the line.
#[derive(Debug)]
pub(super) enum Revoked {
    /// The host stops the robot.
    Stop,
    /// The session has ended for this reason.
    Ended(String),
    /// The socket failed.
    Socket(io::Error),
}

/// Reason that a client reports if it loses the line to a stop.
pub(super) const STOP_FIRST: &str = "armctl stops the robot first";

fn peer(command: &str, since: Instant) -> Peer {
    Peer { pid: std::process::id(), command: command.to_owned(), for_ms: milliseconds(since) }
}

/// A client's use of a [`DirectLine`], with the socket of the client.
#[derive(Debug)]
pub(super) struct DirectClientLine {
    access: DirectAccess,
    carrier: Carrier,
    id: u64,
    command: String,
}

impl DirectClientLine {
    pub fn new(access: &DirectAccess, command: &str) -> Self {
        let id = access.line.enter(command);
        Self { carrier: access.carrier.for_client(), access: access.clone(), id, command: command.to_owned() }
    }

    /// Takes the line if it is free.
    pub fn take(&self) -> bool {
        self.access.line.take(self.id, &self.command)
    }

    pub fn release(&self) {
        self.access.line.release(self.id);
    }

    /// See [`DirectLine::ended`].
    pub fn ended(&self) -> Option<String> {
        self.access.line.ended()
    }

    /// Removes the client from the list of clients that have not joined the host.
    pub fn has_joined(&self) {
        self.access.line.leave(self.id);
    }

    /// Whether these bytes may be sent without the host.
    pub fn may_send(&self, bytes: &[u8]) -> bool {
        (self.access.is_harmless)(bytes)
    }

    pub fn renew(&mut self, channel: u8) {
        self.carrier.renew(channel);
    }

    pub async fn send(&mut self, channel: u8, bytes: &[u8]) -> Result<(), Revoked> {
        self.access.line.check(self.id)?;
        self.carrier.send(channel, bytes).await.map_err(Revoked::Socket)
    }

    /// Waits until `until` for a datagram. The future is cancel safe.
    pub async fn receive(&mut self, channel: u8, buffer: &mut [u8], until: Instant) -> Result<Option<usize>, Revoked> {
        tokio::select! {
            biased;
            revoked = self.access.line.lost(self.id) => Err(revoked),
            received = self.carrier.receive(channel, buffer, until) => received.map_err(Revoked::Socket),
        }
    }
}

impl Drop for DirectClientLine {
    fn drop(&mut self) {
        self.release();
        self.has_joined();
    }
}
