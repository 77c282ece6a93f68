//! Session host: owns the link, and gives the line to one client at a time.

mod clients;
pub mod shared_link;

use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::sync::Arc;
use std::time::Duration;

use futures_util::future::join_all;
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until};

use self::clients::{Client, ClientFrame};
use self::shared_link::{LinkEvent, SharedLink};
use super::direct::{DirectAccess, DirectLine, HostEnds, HostHandle, STOP_FIRST};
use super::location::Claim;
use super::milliseconds;
use super::socket::{Listener, ReadHalf, WriteHalf};
use super::wire::{
    Broken, Change, Control, Frame, Hello, Info, Leftover, Peer, Purpose, Status, VERSION, Welcome, shorten,
};

/// Maximum number of received frames in the queue.
const INBOX_SIZE: usize = 64;
/// Time during which the line is reserved for a client that stops the robot.
const STOP_RESERVATION: Duration = Duration::from_secs(10);
const MAX_CLIENTS: usize = 64;

/// A session with its clients and its link.
pub struct Host {
    claim: Claim,
    listener: Listener,
    key: String,
    info: Info,
    link: SharedLink,
    clients: BTreeMap<u64, Client>,
    last: u64,
    inbox: mpsc::Receiver<ClientFrame>,
    inbox_sender: mpsc::Sender<ClientFrame>,
    /// New clients of this process.
    joining: mpsc::UnboundedReceiver<HostEnds>,
    join_sender: mpsc::UnboundedSender<HostEnds>,
    /// The line for clients of this process. The host offers it to them while no client needs the host's own line.
    direct: Arc<DirectLine>,
    /// Client that owns the line. The field below is the queue of the clients that wait for the line.
    line: Option<u64>,
    queue: VecDeque<(u64, u32)>,
    /// Client that moves the robot.
    motion: Option<u64>,
    /// Clients that have sent images which the link has not sent yet.
    awaiting_sent: Vec<u64>,
    leftover: Option<(Leftover, Instant)>,
    started: Instant,
    reopenings: u32,
    /// Function that logs an event.
    log: Box<dyn FnMut(&str)>,
    /// Filter that is used for a read-only robot.
    lock: Option<Lock>,
    /// Function that stops the robot after the client that moved it was killed. The argument of the function is the
    /// reason.
    stop: Option<Stop>,
    /// Until this time, only a client that stops the robot gets the line.
    stop_first: Option<Instant>,
    /// Function that is called when the need to guard a motion changes. The field below is the value that was passed
    /// last.
    guard: Option<GuardSwitch>,
    is_guarded: bool,
    /// Whether the link was lost while a client moved the robot.
    was_lost_in_motion: bool,
    /// Time without clients after which the session ends; `None` if it never ends. The field below is the time since
    /// which there are no clients.
    idle: Option<Duration>,
    idle_since: Instant,
}

/// Reason for the end of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndReason {
    /// A client has closed the session.
    Requested,
    /// There was no client for the idle time.
    Idle,
}

/// Filter for a read-only device.
#[derive(Debug, Clone, Copy)]
pub struct Guard {
    /// Whether these bytes may be sent while the robot is read-only.
    pub is_harmless_data: fn(&[u8]) -> bool,
    /// Whether the second image may replace the first image while the robot is read-only.
    pub is_harmless_image: fn(&[u8], &[u8]) -> bool,
}

/// Function that stops the robot. The argument is the reason.
type Stop = Box<dyn FnMut(&str)>;
/// Function that is called with `true` while this process, when it ends, must stop the motion of a client. With
/// `false`, this is no longer necessary. The error is a text.
type GuardSwitch = Box<dyn FnMut(bool) -> Result<(), String>>;

/// Read-only filter, and whether it is active.
struct Lock {
    guard: Guard,
    is_locked: bool,
    /// Function that checks whether the robot has become read-only.
    is_read_only: Box<dyn FnMut() -> Result<bool, String>>,
}

impl Host {
    /// Creates a session that accepts clients.
    pub fn new(
        claim: Claim,
        key: String,
        info: Info,
        link: SharedLink,
        log: impl FnMut(&str) + 'static,
    ) -> io::Result<Self> {
        let (inbox_sender, inbox) = mpsc::channel(INBOX_SIZE);
        let (join_sender, joining) = mpsc::unbounded_channel();
        Ok(Self {
            listener: claim.listen()?,
            claim,
            key,
            info,
            link,
            clients: BTreeMap::new(),
            last: 0,
            inbox,
            inbox_sender,
            joining,
            join_sender,
            direct: Arc::default(),
            line: None,
            queue: VecDeque::new(),
            motion: None,
            awaiting_sent: Vec::new(),
            leftover: None,
            started: Instant::now(),
            reopenings: 0,
            log: Box::new(log),
            lock: None,
            stop: None,
            stop_first: None,
            guard: None,
            is_guarded: false,
            was_lost_in_motion: false,
            idle: None,
            idle_since: Instant::now(),
        })
    }

    /// Installs a read-only filter. `is_read_only` is called before every frame that changes something. When it has
    /// returned `true` once, the filter stays active until the session ends.
    #[must_use]
    pub fn with_read_only_check(
        self,
        guard: Guard,
        is_read_only: impl FnMut() -> Result<bool, String> + 'static,
    ) -> Self {
        Self { lock: Some(Lock { guard, is_locked: false, is_read_only: Box::new(is_read_only) }), ..self }
    }

    /// Sets the function that stops the robot. It is called after the client that moved the robot was killed. If the
    /// link was lost during a motion, the function is called when the link is open again.
    #[must_use]
    pub fn with_stop(self, stop: impl FnMut(&str) + 'static) -> Self {
        Self { stop: Some(Box::new(stop)), ..self }
    }

    /// Sets the guard function. It is called with `true` while this process, when it ends, must stop the motion of a
    /// client of another process.
    #[must_use]
    pub fn with_guard(self, guard: impl FnMut(bool) -> Result<(), String> + 'static) -> Self {
        Self { guard: Some(Box::new(guard)), ..self }
    }

    /// Sets the time without clients after which the session ends.
    #[must_use]
    pub fn with_idle_limit(self, idle: Option<Duration>) -> Self {
        Self { idle, ..self }
    }

    /// Access to this session for other threads of this process.
    pub fn handle(&mut self) -> HostHandle {
        self.serve_queue();
        let direct = self.link.carrier().zip(self.lock.as_ref()).map(|(carrier, lock)| {
            let is_harmless = lock.guard.is_harmless_data;
            DirectAccess { line: Arc::clone(&self.direct), carrier: Arc::new(carrier), is_harmless }
        });
        HostHandle {
            key: self.key.as_str().into(),
            started: self.started,
            joins: self.join_sender.clone(),
            has_state: !matches!(self.link, SharedLink::Datagrams(_)),
            direct,
        }
    }

    /// Serves clients until one of them closes the session, or until the idle time has passed. The future is cancel
    /// safe: the caller can continue with [`Host::end`].
    pub async fn serve(&mut self) -> EndReason {
        loop {
            let idle = self.idle.filter(|_| self.clients.is_empty()).map(|idle| self.idle_since + idle);
            tokio::select! {
                Some((client, frame)) = self.inbox.recv() => {
                    if self.handle_frame(client, frame).await {
                        return EndReason::Requested;
                    }
                }
                Ok(connection) = self.listener.accept() => self.accept(connection),
                Some(ends) = self.joining.recv() => self.join(ends),
                () = self.direct.returned() => self.serve_queue(),
                event = self.link.next() => self.handle_link_event(event),
                () = sleep_until(self.stop_first.unwrap_or_else(Instant::now)), if self.stop_first.is_some() => {
                    self.stop_first = None;
                    self.update_guard();
                    self.serve_queue();
                }
                () = sleep_until(idle.unwrap_or_else(Instant::now)), if idle.is_some() => return EndReason::Idle,
            }
        }
    }

    /// Whether the robot is moving.
    pub fn is_moving(&mut self) -> bool {
        self.link.images().is_some_and(|images| images.is_moving())
    }

    /// Ends the session: accepts no new clients, informs all clients, and closes the link.
    ///
    /// # Errors
    /// A description of what was not closed properly.
    pub async fn end(self, why: &str) -> Result<(), String> {
        self.claim.hide();
        drop(self.listener);
        drop(self.joining);
        self.direct.end(why);
        join_all(self.clients.values().map(|client| client.dismiss(Control::Ended(why.to_owned())))).await;
        let closed = self.link.close().await;
        // The connections are closed last: a client that closes the session waits until its connection ends.
        drop(self.claim);
        drop(self.clients);
        closed
    }

    fn accept(&mut self, connection: (ReadHalf, WriteHalf, Option<u32>)) {
        if self.clients.len() < MAX_CLIENTS {
            self.last += 1;
            self.clients.insert(self.last, Client::new(self.last, connection, self.inbox_sender.clone()));
        }
    }

    fn join(&mut self, ends: HostEnds) {
        self.last += 1;
        self.clients.insert(self.last, Client::in_process(self.last, ends, self.inbox_sender.clone()));
    }

    /// Handles a frame of a client. Returns whether the session must end.
    async fn handle_frame(&mut self, id: u64, frame: Option<Frame>) -> bool {
        let Some(client) = self.clients.get_mut(&id) else { return false };
        let is_named = client.is_named();
        let Some(frame) = frame else {
            self.remove_client(id);
            return false;
        };
        match frame {
            Frame::Control(Control::Hello(hello)) => self.welcome(id, &hello),
            Frame::Control(Control::Ask) => self.send_status(id),
            Frame::Control(Control::Close { force }) => return self.answer_close(id, force),
            // Before its Hello, a client may send no other frame.
            _ if !is_named => self.remove_client(id),
            Frame::Control(Control::Bye) => client.has_left = true,
            Frame::Control(Control::Will(will)) => client.will = will,
            Frame::Control(Control::Take { number, channel }) => self.enqueue(id, number, channel),
            Frame::Control(Control::Over) => self.release(id),
            Frame::Control(Control::Motion) => self.claim_motion(id),
            Frame::Control(Control::Renew(channel)) => self.link.renew(id, channel),
            Frame::Show(change) if !self.is_change_allowed(&change) => self.refuse(id),
            Frame::Data { bytes, .. } if !self.is_allowed(|guard| (guard.is_harmless_data)(&bytes)) => self.refuse(id),
            Frame::Show(change) => {
                let has_line = self.line == Some(id);
                let changed = self.link.images().and_then(|images| {
                    let before = images.shown.clone();
                    let change = images.change(change, has_line)?;
                    Some((images.shown != before, images.is_clear(), change))
                });
                // `None` means that the change is from before a loss and was dropped. In this case, the client has
                // already received a report of the loss.
                if let Some((is_new, is_clear, change)) = changed {
                    if is_clear {
                        self.leftover = None;
                    }
                    if !self.awaiting_sent.contains(&id) {
                        self.awaiting_sent.push(id);
                    }
                    if is_new {
                        self.other_clients(id).for_each(|other| other.send(Frame::Show(change.clone())));
                    }
                }
            }
            Frame::Data { channel, bytes } if self.line == Some(id) || self.link.is_parallel(channel) => {
                if let Err(error) = self.link.send(id, channel, &bytes).await {
                    self.send_error(id, &error);
                }
            }
            // All other frames are dropped: data of a client that does not own the line, and frames that only a host
            // may send.
            _ => {}
        }
        false
    }

    fn is_change_allowed(&mut self, change: &Change) -> bool {
        let Some(before) = self.link.images().map(|images| images.shown.clone()) else { return true };
        let mut after = before.clone();
        change.apply(&mut after);
        self.is_allowed(|guard| (guard.is_harmless_image)(&before, &after))
    }

    /// Whether a frame may be passed on. Reads and stop commands may always pass. All other frames may pass only if the
    /// robot is not read-only.
    fn is_allowed(&mut self, is_harmless: impl Fn(&Guard) -> bool) -> bool {
        let Some(lock) = &mut self.lock else { return true };
        if is_harmless(&lock.guard) {
            return true;
        }
        if !lock.is_locked {
            match (lock.is_read_only)() {
                Ok(false) => {}
                Ok(true) => lock.is_locked = true,
                Err(why) => (self.log)(&why),
            }
        }
        !lock.is_locked
    }

    /// Refuses a frame of a client, because the robot is read-only.
    fn refuse(&mut self, id: u64) {
        if let Some(client) = self.clients.get(&id) {
            let by = client.peer(client.since);
            (self.log)(&format!("refused client {}: the robot is read-only ({})", by.pid, by.command));
        }
        let shown = self.link.images().map(|images| images.shown.clone());
        self.send_control(id, Control::Denied { shown });
    }

    fn send_control(&self, id: u64, control: Control) {
        if let Some(client) = self.clients.get(&id) {
            client.send_control(control);
        }
    }

    fn send_error(&self, id: u64, error: &io::Error) {
        self.send_control(id, Control::Broken(Broken::from(error)));
    }

    fn other_clients(&self, id: u64) -> impl Iterator<Item = &Client> {
        self.clients.iter().filter(move |(other, client)| **other != id && client.is_named()).map(|(_, client)| client)
    }

    fn welcome(&mut self, id: u64, hello: &Hello) {
        let welcome = Welcome {
            version: VERSION,
            pid: std::process::id(),
            for_ms: milliseconds(self.started),
            down: self.link.down().map(str::to_owned),
            leftover: self.leftover(),
            images: self.link.images().map(|images| images.welcome()),
        };
        let refused = if hello.version != VERSION {
            let host = std::process::id();
            Some(format!(
                "the session belongs to another version of armctl (process {host}): close it, and open it again"
            ))
        } else if hello.key != self.key {
            Some("the session is for another device".to_owned())
        } else {
            None
        };
        let Some(client) = self.clients.get_mut(&id) else { return };
        if let Some(why) = refused {
            // The refusal is sent before the connection is closed.
            client.send_control(Control::Refused(why));
            self.remove_client(id);
            return;
        }
        client.set_name(hello.pid, shorten(&hello.command));
        client.purpose = hello.purpose;
        client.send_control(Control::Welcome(Box::new(welcome)));
    }

    fn enqueue(&mut self, id: u64, take: u32, channel: u8) {
        if self.link.is_parallel(channel) {
            return self.send_control(id, Control::Taken(take));
        }
        let holder = self.line.and_then(|holder| self.clients.get(&holder));
        let holder = holder.map(|holder| holder.peer(holder.line_since)).or_else(|| self.direct.holder());
        if let Some(holder) = holder {
            self.send_control(id, Control::Queued(holder));
        }
        self.queue.retain(|(other, _)| *other != id);
        if self.is_stop(id) {
            self.queue.push_front((id, take));
        } else {
            self.queue.push_back((id, take));
        }
        self.serve_queue();
    }

    fn serve_queue(&mut self) {
        while self.line.is_none() {
            // A client that stops the robot gets the line first, whatever its place in the queue is.
            let first = self.queue.front().map(|(id, _)| *id);
            if self.stop_first.is_some() && !first.is_some_and(|id| self.is_stop(id)) {
                return;
            }
            if first.is_none() {
                self.direct.offer();
                return;
            }
            // If a client of this process has the line, `serve` continues here when the client has returned it.
            if !self.direct.withdraw() {
                return;
            }
            let Some((id, take)) = self.queue.pop_front() else { return };
            let Some(client) = self.clients.get_mut(&id) else { continue };
            self.line = Some(id);
            client.line_since = Instant::now();
            self.link.begin();
            client.send_control(Control::Taken(take));
            if let Some(why) = self.link.down().filter(|_| !matches!(self.link, SharedLink::Images(_))) {
                client.send_control(Control::Lost(why.to_owned()));
            }
        }
    }

    fn is_stop(&self, id: u64) -> bool {
        self.clients.get(&id).is_some_and(|client| client.purpose == Purpose::Stop)
    }

    /// Starts a stop of the robot. The current owner loses the line. The next owner must be a client that stops the
    /// robot.
    fn start_stop(&mut self, why: &str) {
        let Some(stop) = &mut self.stop else { return };
        stop(why);
        self.direct.revoke();
        self.stop_first = Some(Instant::now() + STOP_RESERVATION);
        if let Some(id) = self.line.filter(|id| !self.is_stop(*id)) {
            self.send_error(id, &io::Error::new(io::ErrorKind::NotConnected, STOP_FIRST));
            self.link.pause(id);
            self.line = None;
        }
        self.serve_queue();
    }

    /// Takes the line from a client that releases or loses it, and removes the client from the queue.
    fn release(&mut self, id: u64) {
        self.queue.retain(|(other, _)| *other != id);
        self.link.pause(id);
        if self.line == Some(id) {
            self.line = None;
            self.serve_queue();
        }
    }

    fn claim_motion(&mut self, id: u64) {
        let holder = self.motion.filter(|holder| *holder != id).and_then(|holder| self.clients.get(&holder));
        let answer = match holder {
            Some(holder) => Control::Held(holder.peer(holder.motion_since)),
            None => Control::Granted,
        };
        if answer == Control::Granted
            && self.motion != Some(id)
            && let Some(client) = self.clients.get_mut(&id)
        {
            client.motion_since = Instant::now();
            self.motion = Some(id);
            self.update_guard();
        }
        self.send_control(id, answer);
    }

    /// Updates the guardian, which stops the robot if this process ends. An image link needs no guardian, because the
    /// device stops by itself after a loss. A client in this process has its own guardian.
    fn update_guard(&mut self) {
        let mover = self.motion.and_then(|id| self.clients.get(&id));
        let is_foreign = |mover: &Client| mover.peer(mover.since).pid != std::process::id();
        let is_left = |mover: &Client| mover.purpose == Purpose::LeavesMotion;
        let is_foreign_motion = mover.is_some_and(|mover| is_foreign(mover) && !is_left(mover));
        let must_guard = (is_foreign_motion || self.stop_first.is_some()) && self.link.images().is_none();
        if must_guard != self.is_guarded
            && let Some(guard) = &mut self.guard
        {
            self.is_guarded = must_guard;
            if let Err(why) = guard(must_guard) {
                (self.log)(&why);
            }
        }
    }

    /// Removes a client, and releases everything that the client owned. Its changes of the image stay. If the client
    /// was killed, the host sends its last will.
    fn remove_client(&mut self, id: u64) {
        let Some(client) = self.clients.remove(&id) else { return };
        self.idle_since = Instant::now();
        let died = client.is_named() && !client.has_left;
        let leaves_command = self.line == Some(id) && self.link.images().is_some_and(|images| !images.is_clear());
        let by = client.peer(client.since);
        let mut leaves_motion = died
            && self.motion == Some(id)
            && client.purpose != Purpose::LeavesMotion
            && self.may_be_moving(leaves_command);
        if died {
            let mut events = vec![format!("client {} has died ({})", by.pid, by.command)];
            if self.motion == Some(id) {
                events.push("the client moved the robot".to_owned());
            }
            if leaves_command && !leaves_motion {
                events.push("the command of the client stays active".to_owned());
            }
            let will = client.will.clone().filter(|will| self.is_change_allowed(will));
            if let Some(will) = will.and_then(|will| self.link.images()?.change(will, false)) {
                events.push("armctl sends the stop signals of the client".to_owned());
                leaves_motion = false;
                self.other_clients(id).for_each(|other| other.send(Frame::Show(will.clone())));
            }
            (self.log)(&events.join("; "));
        }
        if leaves_command {
            self.leftover = Some((Leftover { by, died }, Instant::now()));
        }
        if self.motion == Some(id) {
            self.motion = None;
        }
        self.link.forget(id);
        if leaves_motion {
            self.start_stop("the client that moved the robot has died");
        }
        if client.purpose == Purpose::Stop {
            self.stop_first = None;
        }
        self.update_guard();
        self.release(id);
        self.serve_queue();
    }

    /// Whether the robot may still move after its client has ended. On an image link, it moves only if the client left
    /// a command active.
    fn may_be_moving(&mut self, leaves_command: bool) -> bool {
        leaves_command || self.link.images().is_none()
    }

    fn leftover(&self) -> Option<Leftover> {
        let (leftover, since) = self.leftover.as_ref()?;
        Some(Leftover { by: Peer { for_ms: milliseconds(*since), ..leftover.by.clone() }, ..leftover.clone() })
    }

    fn status(&mut self) -> Status {
        let mover = self.motion.and_then(|id| self.clients.get(&id));
        Status {
            version: VERSION,
            motion: mover.map(|client| client.peer(client.motion_since)),
            info: self.info.clone(),
            for_ms: milliseconds(self.started),
            down: self.link.down().map(str::to_owned),
            reopenings: self.reopenings,
            clients: self
                .clients
                .values()
                .filter(|client| client.is_named())
                .map(|client| client.peer(client.since))
                .chain(self.direct.clients())
                .collect(),
            leftover: self.leftover(),
            under_way: self.is_moving(),
        }
    }

    fn send_status(&mut self, id: u64) {
        let status = Control::Status(Box::new(self.status()));
        self.send_control(id, status);
    }

    fn answer_close(&mut self, id: u64, force: bool) -> bool {
        let status = self.status();
        let moves = match &status.motion {
            Some(Peer { pid, command, .. }) => Some(format!("client {pid} moves the robot ({command})")),
            None if status.under_way => Some("the controller reports a running motion".to_owned()),
            None => None,
        };
        let Some(client) = self.clients.get(&id) else { return false };
        let refused = moves.filter(|_| !force);
        let closes = refused.is_none();
        client.send_control(refused.map_or(Control::Closing, Control::Refused));
        closes
    }

    /// Handles an event of the link.
    fn handle_link_event(&mut self, event: LinkEvent) {
        match event {
            LinkEvent::Sent => {
                for id in std::mem::take(&mut self.awaiting_sent) {
                    self.send_control(id, Control::Sent);
                }
            }
            LinkEvent::Image(image) => self.broadcast(|| Frame::Image(image.to_vec())),
            LinkEvent::Data { to, channel, bytes } => {
                // Data that no client is waiting for is dropped.
                if let Some(client) = to.or(self.line).and_then(|id| self.clients.get(&id)) {
                    client.send(Frame::Data { channel, bytes });
                }
            }
            LinkEvent::Broken { to, error } => self.send_error(to, &error),
            LinkEvent::Lost(why) => {
                (self.log)(&format!("the connection was lost: {why}; armctl opens it again"));
                self.awaiting_sent.clear();
                let mover = self.motion.and_then(|id| self.clients.get(&id));
                // On an image link, the device stops by itself after a loss.
                self.was_lost_in_motion |=
                    mover.is_some_and(|mover| mover.purpose != Purpose::LeavesMotion) && self.link.images().is_none();
                if self.leftover.take().is_some() {
                    (self.log)("the command that a client left active has also ended");
                }
                self.broadcast(|| Frame::Control(Control::Lost(why.clone())));
            }
            LinkEvent::Reopened => {
                self.reopenings = self.reopenings.saturating_add(1);
                (self.log)("the connection is open again");
                if std::mem::take(&mut self.was_lost_in_motion) {
                    self.start_stop("the connection was lost while a client moved the robot");
                }
                if let Some(images) = self.link.images() {
                    let (generation, shown) = (images.generation, images.shown.clone());
                    self.broadcast(|| Frame::Control(Control::Reopened { generation, shown: shown.clone() }));
                }
            }
        }
    }

    fn broadcast(&self, frame: impl Fn() -> Frame) {
        self.clients.values().filter(|client| client.is_named()).for_each(|client| client.send(frame()));
    }
}

#[cfg(test)]
mod tests;
