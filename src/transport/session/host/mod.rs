//! Session host: holds the link, and gives clients access one at a time.

mod clients;
pub mod held;

use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::time::Duration;

use futures_util::future::join_all;
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until};

use self::clients::{Client, Letter, milliseconds};
use self::held::{Happening, Held};
use super::place::Claim;
use super::socket::{Listener, ReadHalf, WriteHalf};
use super::wire::{
    Broken, Change, Control, Frame, Hello, Info, Leftover, Peer, Purpose, Status, VERSION, Welcome, short,
};

/// Size of the queue of received frames.
const LETTERS: usize = 64;
/// How long the line is reserved for the client that stops the robot.
const STOP_FIRST: Duration = Duration::from_secs(10);
const MOST_CLIENTS: usize = 64;

/// A session.
pub struct Host {
    claim: Claim,
    listener: Listener,
    key: String,
    info: Info,
    held: Held,
    clients: BTreeMap<u64, Client>,
    last: u64,
    letters: mpsc::Receiver<Letter>,
    letterbox: mpsc::Sender<Letter>,
    /// Client with the line, and the queue for it.
    line: Option<u64>,
    queue: VecDeque<(u64, u32)>,
    /// Client that moves the robot.
    motion: Option<u64>,
    /// Clients whose images were not sent yet.
    showing: Vec<u64>,
    leftover: Option<(Leftover, Instant)>,
    began: Instant,
    reopenings: u32,
    /// Log of events.
    say: Box<dyn FnMut(&str)>,
    /// Filter for a read-only robot.
    lock: Option<Lock>,
    /// Stops the robot after the client that moved it died; gets the reason.
    stop: Option<Stop>,
    /// Until this time, only a client that stops the robot gets the line.
    stop_first: Option<Instant>,
    /// Reports whether a client of another process moves the robot, and the last reported value.
    guard: Option<Guarding>,
    is_guarding: bool,
    /// Whether the link was lost while a client moved the robot.
    was_lost_in_motion: bool,
    /// Idle time without clients after which the session ends (`None`: never), and the start of the current one.
    idle: Option<Duration>,
    idle_since: Instant,
}

/// Reason for the end of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Why {
    /// A client has closed it.
    Asked,
    /// No client for the idle time.
    Idle,
}

/// Filter for a read-only device.
#[derive(Debug, Clone, Copy)]
pub struct Guard {
    /// Whether these bytes can be sent.
    pub sends: fn(&[u8]) -> bool,
    /// Whether the second image can replace the first one.
    pub shows: fn(&[u8], &[u8]) -> bool,
}

/// Stops the robot, with the reason.
type Stop = Box<dyn FnMut(&str)>;
/// Reports whether the motion of a client must be stopped when this process ends. The error is a text.
type Guarding = Box<dyn FnMut(bool) -> Result<(), String>>;

/// Read-only lock, closed or still open.
struct Lock {
    guard: Guard,
    is_closed: bool,
    /// Whether it must be closed now.
    must_close: Box<dyn FnMut() -> Result<bool, String>>,
}

impl Host {
    /// Starts to accept clients.
    pub fn new(claim: Claim, key: String, info: Info, held: Held, say: impl FnMut(&str) + 'static) -> io::Result<Self> {
        let (letterbox, letters) = mpsc::channel(LETTERS);
        Ok(Self {
            listener: claim.listen()?,
            claim,
            key,
            info,
            held,
            clients: BTreeMap::new(),
            last: 0,
            letters,
            letterbox,
            line: None,
            queue: VecDeque::new(),
            motion: None,
            showing: Vec::new(),
            leftover: None,
            began: Instant::now(),
            reopenings: 0,
            say: Box::new(say),
            lock: None,
            stop: None,
            stop_first: None,
            guard: None,
            is_guarding: false,
            was_lost_in_motion: false,
            idle: None,
            idle_since: Instant::now(),
        })
    }

    /// Installs a read-only filter. `is_read_only` is called before every frame that changes something. After its first
    /// `true`, the filter stays active for the rest of the session.
    #[must_use]
    pub fn guarded(self, guard: Guard, is_read_only: impl FnMut() -> Result<bool, String> + 'static) -> Self {
        Self { lock: Some(Lock { guard, is_closed: false, must_close: Box::new(is_read_only) }), ..self }
    }

    /// Sets the function that stops the robot. It is called after the client that moved the robot died, or when a link
    /// is open again that was lost during a motion.
    #[must_use]
    pub fn stopped_by(self, stop: impl FnMut(&str) + 'static) -> Self {
        Self { stop: Some(Box::new(stop)), ..self }
    }

    /// Sets the function that reports whether the motion of a client from another process must be stopped when this
    /// process ends.
    #[must_use]
    pub fn watched_by(self, guard: impl FnMut(bool) -> Result<(), String> + 'static) -> Self {
        Self { guard: Some(Box::new(guard)), ..self }
    }

    /// Sets the idle time after which the session ends.
    #[must_use]
    pub fn ending_after(self, idle: Option<Duration>) -> Self {
        Self { idle, ..self }
    }

    /// Serves clients until one of them closes the session, or until the idle time is over. Cancel safe: [`Host::end`]
    /// continues from there.
    pub async fn serve(&mut self) -> Why {
        loop {
            let idle = self.idle.filter(|_| self.clients.is_empty()).map(|idle| self.idle_since + idle);
            tokio::select! {
                Some((client, frame)) = self.letters.recv() => {
                    if self.heard(client, frame).await {
                        return Why::Asked;
                    }
                }
                Ok(connection) = self.listener.accept() => self.accept(connection),
                happening = self.held.next() => self.happened(happening),
                () = sleep_until(self.stop_first.unwrap_or_else(Instant::now)), if self.stop_first.is_some() => {
                    self.stop_first = None;
                    self.keep_guard();
                    self.next_in_queue();
                }
                () = sleep_until(idle.unwrap_or_else(Instant::now)), if idle.is_some() => return Why::Idle,
            }
        }
    }

    /// Whether the robot moves.
    pub fn under_way(&mut self) -> bool {
        self.held.images().is_some_and(|images| images.under_way())
    }

    /// Ends the session: accepts no new clients, informs all clients, closes the link.
    ///
    /// # Errors
    /// A text: what was not closed properly.
    pub async fn end(self, why: &str) -> Result<(), String> {
        self.claim.hide();
        drop(self.listener);
        join_all(self.clients.values().map(|client| client.dismiss(Control::Ended(why.to_owned())))).await;
        let closed = self.held.close().await;
        // Connections are closed last, because a client that closes the session waits for that.
        drop(self.claim);
        drop(self.clients);
        closed
    }

    fn accept(&mut self, connection: (ReadHalf, WriteHalf, Option<u32>)) {
        if self.clients.len() < MOST_CLIENTS {
            self.last += 1;
            self.clients.insert(self.last, Client::new(self.last, connection, self.letterbox.clone()));
        }
    }

    /// Handles a frame of a client. Returns whether the session must end.
    async fn heard(&mut self, id: u64, frame: Option<Frame>) -> bool {
        let Some(client) = self.clients.get_mut(&id) else { return false };
        let is_named = client.is_named();
        let Some(frame) = frame else {
            self.gone(id);
            return false;
        };
        match frame {
            Frame::Control(Control::Hello(hello)) => self.welcome(id, &hello),
            Frame::Control(Control::Ask) => self.tell_status(id),
            Frame::Control(Control::Close { force }) => return self.may_close(id, force),
            // All other frames need a hello first.
            _ if !is_named => self.gone(id),
            Frame::Control(Control::Bye) => client.has_left = true,
            Frame::Control(Control::Will(will)) => client.will = will,
            Frame::Control(Control::Take { number, channel }) => self.queue_up(id, number, channel),
            Frame::Control(Control::Over) => self.release(id),
            Frame::Control(Control::Motion) => self.claim_motion(id),
            Frame::Control(Control::Renew(channel)) => self.held.renew(id, channel),
            Frame::Show(change) if !self.may_show(&change) => self.refuse(id),
            Frame::Data { bytes, .. } if !self.passes(|guard| (guard.sends)(&bytes)) => self.refuse(id),
            Frame::Show(change) => {
                let has_line = self.line == Some(id);
                let changed = self.held.images().and_then(|images| {
                    let before = images.shown.clone();
                    let change = images.change(change, has_line)?;
                    Some((images.shown != before, images.is_clear(), change))
                });
                // A change from before a loss is dropped. The client already knows of the loss.
                if let Some((is_new, is_clear, change)) = changed {
                    if is_clear {
                        self.leftover = None;
                    }
                    if !self.showing.contains(&id) {
                        self.showing.push(id);
                    }
                    if is_new {
                        self.others(id).for_each(|other| other.send(Frame::Show(change.clone())));
                    }
                }
            }
            Frame::Data { channel, bytes } if self.line == Some(id) || self.held.is_parallel(channel) => {
                if let Err(error) = self.held.send(id, channel, &bytes).await {
                    self.break_to(id, &error);
                }
            }
            // Data without the line is dropped, and so are frames that only a host sends.
            _ => {}
        }
        false
    }

    fn may_show(&mut self, change: &Change) -> bool {
        let Some(before) = self.held.images().map(|images| images.shown.clone()) else { return true };
        let mut after = before.clone();
        change.apply(&mut after);
        self.passes(|guard| (guard.shows)(&before, &after))
    }

    /// Whether a frame can pass: reads and stops always, anything else only if the robot is not read-only.
    fn passes(&mut self, is_harmless: impl Fn(&Guard) -> bool) -> bool {
        let Some(lock) = &mut self.lock else { return true };
        if is_harmless(&lock.guard) {
            return true;
        }
        if !lock.is_closed {
            match (lock.must_close)() {
                Ok(false) => {}
                Ok(true) => lock.is_closed = true,
                Err(why) => (self.say)(&why),
            }
        }
        !lock.is_closed
    }

    /// Refuses a frame, because the robot is read-only.
    fn refuse(&mut self, id: u64) {
        if let Some(client) = self.clients.get(&id) {
            let by = client.peer(client.since);
            (self.say)(&format!("refused client {}: the robot is read-only ({})", by.pid, by.command));
        }
        let shown = self.held.images().map(|images| images.shown.clone());
        if let Some(client) = self.clients.get(&id) {
            client.tell(Control::Denied { shown });
        }
    }

    fn break_to(&self, id: u64, error: &io::Error) {
        if let Some(client) = self.clients.get(&id) {
            client.tell(Control::Broken(Broken::from(error)));
        }
    }

    fn others(&self, id: u64) -> impl Iterator<Item = &Client> {
        self.clients.iter().filter(move |(other, client)| **other != id && client.is_named()).map(|(_, client)| client)
    }

    fn welcome(&mut self, id: u64, hello: &Hello) {
        let welcome = Welcome {
            version: VERSION,
            pid: std::process::id(),
            for_ms: milliseconds(self.began),
            down: self.held.down().map(str::to_owned),
            leftover: self.leftover(),
            images: self.held.images().map(|images| images.welcome()),
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
            // The refusal is still sent.
            client.tell(Control::Refused(why));
            self.gone(id);
            return;
        }
        client.named(hello.pid, short(&hello.command));
        client.purpose = hello.purpose;
        client.tell(Control::Welcome(Box::new(welcome)));
    }

    fn queue_up(&mut self, id: u64, take: u32, channel: u8) {
        if self.held.is_parallel(channel) {
            if let Some(client) = self.clients.get(&id) {
                client.tell(Control::Taken(take));
            }
            return;
        }
        let holder = self.line.and_then(|holder| self.clients.get(&holder));
        if let (Some(holder), Some(client)) = (holder, self.clients.get(&id)) {
            client.tell(Control::Queued(holder.peer(holder.line_since)));
        }
        self.queue.retain(|(other, _)| *other != id);
        if self.is_stop(id) {
            self.queue.push_front((id, take));
        } else {
            self.queue.push_back((id, take));
        }
        self.next_in_queue();
    }

    fn next_in_queue(&mut self) {
        while self.line.is_none() {
            // A client that stops the robot is first in the queue.
            let first = self.queue.front().map(|(id, _)| *id);
            if self.stop_first.is_some() && !first.is_some_and(|id| self.is_stop(id)) {
                return;
            }
            let Some((id, take)) = self.queue.pop_front() else { return };
            let Some(client) = self.clients.get_mut(&id) else { continue };
            self.line = Some(id);
            client.line_since = Instant::now();
            self.held.begin();
            client.tell(Control::Taken(take));
            if let Some(why) = self.held.down().filter(|_| !matches!(self.held, Held::Images(_))) {
                client.tell(Control::Lost(why.to_owned()));
            }
        }
    }

    fn is_stop(&self, id: u64) -> bool {
        self.clients.get(&id).is_some_and(|client| client.purpose == Purpose::Stop)
    }

    /// Starts a stop before any other client gets the line. The current owner loses it.
    fn stop_before_all(&mut self, why: &str) {
        let Some(stop) = &mut self.stop else { return };
        stop(why);
        self.stop_first = Some(Instant::now() + STOP_FIRST);
        if let Some(id) = self.line.filter(|id| !self.is_stop(*id)) {
            self.break_to(id, &io::Error::new(io::ErrorKind::NotConnected, "armctl stops the robot first"));
            self.held.pause(id);
            self.line = None;
        }
        self.next_in_queue();
    }

    /// The client releases the line, or loses it.
    fn release(&mut self, id: u64) {
        self.queue.retain(|(other, _)| *other != id);
        self.held.pause(id);
        if self.line == Some(id) {
            self.line = None;
            self.next_in_queue();
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
            self.keep_guard();
        }
        if let Some(client) = self.clients.get(&id) {
            client.tell(answer);
        }
    }

    /// Updates the guardian of this process. It is not needed for an image link, because the device stops by itself
    /// after a loss. A client in this process has its own guardian.
    fn keep_guard(&mut self) {
        let mover = self.motion.and_then(|id| self.clients.get(&id));
        let is_foreign = |mover: &Client| mover.peer(mover.since).pid != std::process::id();
        let is_left = |mover: &Client| mover.purpose == Purpose::LeavesMotion;
        let is_foreign_motion = mover.is_some_and(|mover| is_foreign(mover) && !is_left(mover));
        let must_guard = (is_foreign_motion || self.stop_first.is_some()) && self.held.images().is_none();
        if must_guard != self.is_guarding
            && let Some(guard) = &mut self.guard
        {
            self.is_guarding = must_guard;
            if let Err(why) = guard(must_guard) {
                (self.say)(&why);
            }
        }
    }

    /// Removes a client and releases all it has. Its changes of the image stay, except that its last will is sent if it
    /// died.
    fn gone(&mut self, id: u64) {
        let Some(client) = self.clients.remove(&id) else { return };
        self.idle_since = Instant::now();
        let died = client.is_named() && !client.has_left;
        let leaves = self.line == Some(id) && self.held.images().is_some_and(|images| !images.is_clear());
        let by = client.peer(client.since);
        let mut orphans =
            died && self.motion == Some(id) && client.purpose != Purpose::LeavesMotion && self.may_be_moving(leaves);
        if died {
            let mut what = vec![format!("client {} has died ({})", by.pid, by.command)];
            if self.motion == Some(id) {
                what.push("it moved the robot".to_owned());
            }
            if leaves && !orphans {
                what.push("its command stays active".to_owned());
            }
            let will = client.will.clone().filter(|will| self.may_show(will));
            if let Some(will) = will.and_then(|will| self.held.images()?.change(will, false)) {
                what.push("armctl sends its stop signals".to_owned());
                orphans = false;
                self.others(id).for_each(|other| other.send(Frame::Show(will.clone())));
            }
            (self.say)(&what.join("; "));
        }
        if leaves {
            self.leftover = Some((Leftover { by, died }, Instant::now()));
        }
        if self.motion == Some(id) {
            self.motion = None;
        }
        self.held.forget(id);
        if orphans {
            self.stop_before_all("the client that moved the robot has died");
        }
        if client.purpose == Purpose::Stop {
            self.stop_first = None;
        }
        self.keep_guard();
        self.release(id);
        self.next_in_queue();
    }

    /// Whether the robot can still move without the client. An image link shows it by the active command.
    fn may_be_moving(&mut self, leaves_command: bool) -> bool {
        leaves_command || self.held.images().is_none()
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
            for_ms: milliseconds(self.began),
            down: self.held.down().map(str::to_owned),
            reopenings: self.reopenings,
            clients: self
                .clients
                .values()
                .filter(|client| client.is_named())
                .map(|client| client.peer(client.since))
                .collect(),
            leftover: self.leftover(),
            under_way: self.under_way(),
        }
    }

    fn tell_status(&mut self, id: u64) {
        let status = Control::Status(Box::new(self.status()));
        if let Some(client) = self.clients.get(&id) {
            client.tell(status);
        }
    }

    fn may_close(&mut self, id: u64, force: bool) -> bool {
        let status = self.status();
        let moves = match &status.motion {
            Some(Peer { pid, command, .. }) => Some(format!("client {pid} moves the robot ({command})")),
            None if status.under_way => Some("the controller reports a running motion".to_owned()),
            None => None,
        };
        let Some(client) = self.clients.get(&id) else { return false };
        let refused = moves.filter(|_| !force);
        let closes = refused.is_none();
        client.tell(refused.map_or(Control::Closing, Control::Refused));
        closes
    }

    /// Handles an event of the link.
    fn happened(&mut self, happening: Happening) {
        match happening {
            Happening::Sent => {
                for id in std::mem::take(&mut self.showing) {
                    if let Some(client) = self.clients.get(&id) {
                        client.tell(Control::Sent);
                    }
                }
            }
            Happening::Image(image) => self.everybody(|| Frame::Image(image.to_vec())),
            Happening::Data { to, channel, bytes } => {
                // Data without a request is dropped.
                if let Some(client) = to.or(self.line).and_then(|id| self.clients.get(&id)) {
                    client.send(Frame::Data { channel, bytes });
                }
            }
            Happening::Broken { to, error } => self.break_to(to, &error),
            Happening::Lost(why) => {
                (self.say)(&format!("the connection was lost: {why}; armctl opens it again"));
                self.showing.clear();
                let mover = self.motion.and_then(|id| self.clients.get(&id));
                // A device with an image link stops by itself after a loss.
                self.was_lost_in_motion |=
                    mover.is_some_and(|mover| mover.purpose != Purpose::LeavesMotion) && self.held.images().is_none();
                if self.leftover.take().is_some() {
                    (self.say)("the command that a client left active has ended too");
                }
                self.everybody(|| Frame::Control(Control::Lost(why.clone())));
            }
            Happening::Reopened => {
                self.reopenings = self.reopenings.saturating_add(1);
                (self.say)("the connection is open again");
                if std::mem::take(&mut self.was_lost_in_motion) {
                    self.stop_before_all("the connection was lost while a client moved the robot");
                }
                if let Some(images) = self.held.images() {
                    let (generation, shown) = (images.generation, images.shown.clone());
                    self.everybody(|| Frame::Control(Control::Reopened { generation, shown: shown.clone() }));
                }
            }
        }
    }

    fn everybody(&self, frame: impl Fn() -> Frame) {
        self.clients.values().filter(|client| client.is_named()).for_each(|client| client.send(frame()));
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests;
