//! Yaskawa client (FS100, DX100, DX200, YRC1000): runs the protocol sessions over datagrams.

mod axes;
mod batch;
mod error;
mod model;
mod options;
mod plan;
mod protocol;
mod simulated;
#[cfg(test)]
mod tests;
mod transport;

use std::convert::Infallible;
use std::io;
use std::sync::Arc;
use std::time::Duration;

use armctl_controller::yerc::recording::{answer_text, request_text};
use armctl_controller::yerc::session::{Abort, Download, Ended, Exchange, Ids, Policy, Upload, is_busy};
use armctl_controller::yerc::table::service;
use armctl_controller::yerc::wire::{Division, MAX_DATA};
use armctl_controller::{Risk, Session, Step};
use armctl_transport::session::client::{Attached, SessionBusy};
use armctl_transport::tap::Direction;
use tokio::time::{Instant, sleep, timeout_at};

pub use self::axes::AxisSet;
pub use self::batch::{Batch, Outcome, ReadError};
pub use self::error::{Cause, Error, Refusal, RefusedRequest, TransferError};
pub use self::model::Identity;
use self::model::ModelSource;
pub use self::options::{Event, Options, Totals};
#[doc(inline)]
pub use self::protocol::*;
pub use self::simulated::Simulated;
use self::simulated::channel;
use self::transport::Transport;
pub use self::transport::{Endpoint, PORTS};
use crate::{Grant, LONGEST_TIMEOUT, NotAuthorized, Plan, STOP_INTERVAL, STOP_TIMEOUT, STOP_TRIES, Watcher};

/// Maximum number of frames that are read from the socket after a deadline. A receive buffer of the operating system has
/// fewer small datagrams.
const MAX_QUEUED: u32 = 1000;

/// A connection to one controller.
///
/// The client processes one request at a time. A call may be dropped before its end: the client stays usable, because
/// the session discards late answers.
///
/// ```
/// use armctl_client::Risk;
/// use armctl_client::yerc::{Client, Endpoint, Model, Options, ReadJob, SelectJob, Selection, Totals};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let options = Options { retries: 1, ..Options::auto().with_risk(Risk::Write) };
/// let mut robot = Client::connect(Endpoint::simulator(Model::Dx200), options).await?;
/// let model = robot.model().await?;
/// robot.ask(&SelectJob::new(model, b"TESTJOB", Selection::Execute { line: 0 })?).await?;
/// let job = robot.ask(&ReadJob::new(model, 0)?).await?;
/// assert_eq!(job.name.as_bytes(), b"TESTJOB");
/// let missing = robot.try_ask(&SelectJob::new(model, b"NOSUCH", Selection::Execute { line: 0 })?).await?;
/// println!("the controller refused: {}", missing.unwrap_err());
/// let totals: Totals = robot.close().await?;
/// assert_eq!(totals.exchanges, 3);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Client {
    transport: Transport,
    policy: Policy,
    ids: Ids,
    grant: Grant,
    has_moved: bool,
    /// The model, if known, and its source. Number ranges and layouts depend on the model.
    model_source: ModelSource,
    /// Model and software version that the controller reported.
    identity: Option<Identity>,
    /// Dry run: the model for which the plan is shown, if the frames depend on the model and the model is unknown.
    plan_model: Option<Model>,
    started: Instant,
    buffer: Box<[u8; BUFFER]>,
    watcher: Box<dyn Watcher<Event>>,
    totals: Totals,
    /// The last completed download. The client keeps it, because the final ACK may have been lost.
    last_download: Option<Download>,
    /// The session that ends an aborted transfer at the controller. `None` if no transfer is open there.
    open: Option<Abort>,
    /// Dry run: purpose of the next request.
    purpose: Option<&'static str>,
    /// Existing axes of the groups whose axis configuration was read.
    axis_sets: Vec<(Group, Coordinates, AxisSet)>,
}

/// Size of the receive buffer: larger than the largest frame, so that the client detects an oversized datagram.
const BUFFER: usize = 2048;

/// Largest file that [`Client::read_file`] reads, in bytes.
const MAX_FILE: u64 = 1 << 30;

/// What a transfer session requests from the function of the caller. This function reads or writes the file.
enum FileRequest<'a, S> {
    /// A received piece of the file.
    Received(&'a [u8]),
    /// An upload session that needs the next piece.
    Feed(&'a mut S),
}

impl Client {
    /// Opens the sockets for a controller. This function sends nothing: UDP has no connection, so only the first answer
    /// shows that the controller is reachable.
    ///
    /// # Errors
    /// [`Error::HostNotFound`].
    pub async fn connect(endpoint: Endpoint, options: Options) -> Result<Self, Error> {
        let model = endpoint.model().or(options.model);
        Ok(Self::release(endpoint.open().await?, Options { model, ..options }))
    }

    /// Creates a client in a session. The session owns the link and shares it with other clients.
    #[doc(hidden)]
    pub fn in_session(session: Box<Attached>, options: Options) -> Self {
        Self::release(Transport::Session(session), options)
    }

    /// Creates a client for a dry run: it plans requests ([`Client::take_plan`]) and does not send them. Orders count
    /// as carried out; a read returns [`Error::DryRun`].
    pub fn dry_run(options: Options) -> Self {
        Self::release(Transport::DryRun(Plan::default()), options)
    }

    fn release(transport: Transport, options: Options) -> Self {
        let Options { model, grant, timeout, retries } = options;
        Self {
            transport,
            policy: Policy::default().with(timeout.min(LONGEST_TIMEOUT), retries),
            ids: Ids::default(),
            grant,
            has_moved: false,
            model_source: ModelSource::from_settings(model),
            identity: None,
            plan_model: None,
            started: Instant::now(),
            buffer: Box::new([0; BUFFER]),
            watcher: Box::new(()),
            totals: Totals::default(),
            last_download: None,
            open: None,
            purpose: None,
            axis_sets: Vec::new(),
        }
    }

    /// Sets the observer.
    pub fn watch(&mut self, watcher: impl Watcher<Event> + 'static) {
        self.watcher = Box::new(watcher);
    }

    /// Sends one request, and returns a refusal as an error.
    pub async fn ask<Q: Query>(&mut self, query: &Q) -> Result<Q::Answer, Error> {
        Ok(self.try_ask(query).await??)
    }

    /// Sends one request, and returns a refusal as a value. In a dry run, orders count as carried out and a read
    /// returns [`Error::DryRun`].
    pub async fn try_ask<Q: Query>(&mut self, query: &Q) -> Result<Result<Q::Answer, Refusal>, Error> {
        let request = query.request();
        if self.is_dry_run() && request.risk() > Risk::Read {
            self.plan_next(&request)?;
            // The answer to an accepted order contains no data.
            return query.decode(&[]).map(Ok).map_err(|_| Error::DryRun);
        }
        let Reply { status, data, .. } = self.raw(&request).await?;
        if !status.is_ok() {
            self.check_remembered_model(&request, status).await?;
            return Ok(Err(Refusal { status, to: RefusedRequest::from(&request) }));
        }
        Ok(Ok(query.decode(&data)?))
    }

    /// Sends a request and returns the whole reply, which may be a refusal. Only a request that changes nothing is
    /// repeated after a timeout.
    pub async fn raw(&mut self, request: &Request) -> Result<Reply, Error> {
        self.prepare(request).await?;
        let is_read = request.risk() == Risk::Read;
        let reply = self.transact(request, is_read).await?;
        if is_read && request.division() == Division::Robot {
            self.watcher.answered(&|| (request_text(request), answer_text(reply.status, &reply.data)));
        }
        self.learn_model(request, &reply);
        Ok(reply)
    }

    /// Stops the robot with HOLD on, without a check of the grant. After a timeout, the client repeats the order,
    /// independent of the configured retries. A repeated HOLD is harmless; after a lost HOLD the robot would continue
    /// to move.
    ///
    /// # Errors
    /// [`Error::Unconfirmed`] without an answer within 3 s.
    pub async fn stop(&mut self) -> Result<(), Error> {
        let request = Hold(true).request();
        if self.is_dry_run() {
            return Ok(self.plan_next(&request)?);
        }
        let normal_policy = self.policy;
        self.policy =
            Policy { timeout: STOP_INTERVAL, attempt: STOP_INTERVAL, duplicates: false, retries: STOP_TRIES - 1 };
        let mut lost = None;
        let until = Instant::now() + STOP_TIMEOUT;
        let attempts = async {
            loop {
                match self.transact(&request, true).await {
                    Err(error @ Error::Io { .. }) => lost = Some(error),
                    reply => return reply,
                }
                // The cause may be temporary, for example an unreachable network.
                sleep(STOP_INTERVAL).await;
            }
        };
        let reply = match timeout_at(until, attempts).await {
            Ok(Err(Error::NoAnswer { .. } | Error::Garbage { .. })) => Err(Error::Unconfirmed { waited: STOP_TIMEOUT }),
            Ok(reply) => reply,
            Err(_) => Err(lost.unwrap_or(Error::Unconfirmed { waited: STOP_TIMEOUT })),
        };
        self.policy = normal_policy;
        match reply?.status {
            status if status.is_ok() => Ok(()),
            status => Err(Refusal { status, to: RefusedRequest::from(&request) }.into()),
        }
    }

    /// Whether this client sent a motion request.
    pub fn has_moved(&self) -> bool {
        self.has_moved
    }

    /// Reads a whole file of at most 1 GiB, in the encoding of the controller.
    ///
    /// # Errors
    /// [`Error::Refused`] if the file does not exist, [`Error::Incomplete`] if the client did not receive the complete
    /// file. The received part is then discarded.
    pub async fn read_file(&mut self, file: &FileName) -> Result<Vec<u8>, Error> {
        let mut content = Vec::new();
        let take = |piece: &[u8]| {
            content.extend_from_slice(piece);
            Ok::<(), Infallible>(())
        };
        match self.download(&file.save(), MAX_FILE, None, take).await.map_err(|error| error.cause)? {
            DownloadEnd::Complete { .. } => Ok(content),
            DownloadEnd::Nothing(status) | DownloadEnd::Refused { status, bytes: 0 } => {
                Err(Refusal::of_file(service::SAVE, status).into())
            }
            end => Err(Error::Incomplete(end)),
        }
    }

    /// Downloads a file or list of at most `limit` bytes. Passes the blocks to `take` in order. `first_wait` is the
    /// time limit of the first answer, if the controller needs longer than the normal time limit for it.
    pub async fn download<E>(
        &mut self,
        request: &Request,
        limit: u64,
        first_wait: Option<Duration>,
        mut take: impl FnMut(&[u8]) -> Result<(), E>,
    ) -> Result<DownloadEnd, TransferError<E>> {
        if self.is_dry_run() {
            self.plan_download(request, crate::Reason::default())?;
            return Err(Error::DryRun.into());
        }
        self.prepare(request).await?;
        self.abandon().await;
        let before = self.totals.sent;
        let mut session = Download::new(&request.into(), limit, self.policy, &self.ids);
        if let Some(wait) = first_wait {
            session = session.with_first_wait(wait.min(LONGEST_TIMEOUT));
        }
        let mut bytes = 0;
        let result = self.drive(Division::File, &mut session, |file_request| match file_request {
            FileRequest::Received(piece) => {
                bytes += piece.len() as u64;
                take(piece)
            }
            FileRequest::Feed(_) => Ok(()),
        });
        let end = match result.await {
            Ok(end) => end,
            Err(cause) => return Err(TransferError { bytes, cause: self.cut_short_error(cause, request, before) }),
        };
        self.count_exchange(session.counters());
        match &end {
            DownloadEnd::Complete { .. } | DownloadEnd::Finished | DownloadEnd::Nothing(_) => self.open = None,
            DownloadEnd::Refused { status, .. } if !is_busy(*status) => self.open = None,
            _ => {}
        }
        self.last_download = matches!(end, DownloadEnd::Complete { .. }).then_some(session);
        match end {
            // A risk above `Read` means the batch backup, which changes something in the controller. The outcome of
            // this change is unknown without an answer.
            DownloadEnd::NoAnswer { bytes: 0, counters } if request.risk() > Risk::Read => {
                let waited = first_wait.unwrap_or(self.policy.timeout);
                Err(Error::OutcomeUnknown { request: request.clone(), waited, counters }.into())
            }
            DownloadEnd::NoAnswer { bytes, counters } => {
                Err(TransferError { bytes, cause: Cause::Client(self.silence_error(counters)) })
            }
            end => Ok(end),
        }
    }

    /// Uploads a file. `give` returns the next piece, and an empty piece at the end. The client sends the request once,
    /// and repeats numbered blocks after a timeout.
    pub async fn upload<E>(
        &mut self,
        request: &Request,
        mut give: impl FnMut() -> Result<Vec<u8>, E>,
    ) -> Result<UploadEnd, TransferError<E>> {
        if self.is_dry_run() {
            self.plan_upload(request, crate::Reason::default(), || {
                give().map_err(|error| TransferError { bytes: 0, cause: Cause::Caller(error) })
            })?;
            return Err(Error::DryRun.into());
        }
        self.prepare(request).await?;
        self.abandon().await;
        let before = self.totals.sent;
        // A controller that does not check request ids could add a late block of the previous upload to this upload.
        // With a new local port, this cannot happen.
        self.transport.renew(channel(Division::File));
        self.last_download = None;
        let mut session = Upload::new(&request.into(), self.policy, &self.ids);
        let result = self.drive(Division::File, &mut session, |file_request| {
            if let FileRequest::Feed(session) = file_request {
                let piece = give()?;
                session.feed(&piece, piece.is_empty());
            }
            Ok(())
        });
        let end = match result.await {
            Ok(end) => end,
            Err(cause) => {
                let cause = self.cut_short_error(cause, request, before);
                return Err(TransferError { bytes: session.sent(), cause });
            }
        };
        self.count_exchange(session.counters());
        match &end {
            UploadEnd::Complete { .. } | UploadEnd::Unnumbered { .. } | UploadEnd::Empty => self.open = None,
            UploadEnd::Refused { status, .. } if !is_busy(*status) => self.open = None,
            _ => {}
        }
        Ok(end)
    }

    /// Traffic so far.
    pub fn totals(&self) -> Totals {
        self.totals
    }

    /// Closes the connection and returns its traffic. If a transfer was aborted, ends the transfer at the controller
    /// first.
    pub async fn close(mut self) -> Result<Totals, Error> {
        self.abandon().await;
        // The last download is complete. At worst, the controller keeps it open until its timer expires.
        if self.linger().await.is_err() {
            self.watcher.event(Event::TransferLeftOpen);
        }
        if let Transport::Session(session) = self.transport {
            session.leave().await;
        }
        Ok(self.totals)
    }

    /// Ends an aborted transfer at the controller. Otherwise the controller refuses other transfers until its timer
    /// expires.
    async fn abandon(&mut self) {
        let Some(mut abandon) = self.open.take().filter(Abort::is_open) else { return };
        let ended = self.drive(Division::File, &mut abandon, |_| Ok::<(), Infallible>(())).await;
        self.open = None;
        if !matches!(ended, Ok(true)) {
            self.watcher.event(Event::TransferLeftOpen);
        }
    }

    /// Waits briefly after a download over a lossy link. If the controller repeats the last block, the final ACK was
    /// lost and is sent again. Without the ACK, the controller would keep the transfer open.
    async fn linger(&mut self) -> Result<(), Error> {
        let Some(mut last) = self.last_download.take().filter(|last| last.counters() != Counters::default()) else {
            return Ok(());
        };
        self.acquire(Division::File).await?;
        let channel = channel(Division::File);
        let until = Instant::now() + self.policy.attempt.min(self.policy.timeout);
        while Instant::now() < until
            && let Some(len) = self.receive(channel, until).await?
        {
            if let Some(ack) = last.linger(self.buffer.get(..len).unwrap_or_default()) {
                self.send(channel, &ack).await?;
            }
        }
        Ok(())
    }

    /// Authorizes a request, as the last step before the request is sent. A dry run plans the request and returns
    /// [`Error::DryRun`].
    async fn prepare(&mut self, request: &Request) -> Result<(), Error> {
        self.authorize(request)?;
        if request.data.len() > MAX_DATA {
            return Err(Error::TooLarge { bytes: request.data.len() });
        }
        if self.is_dry_run() {
            self.plan_next(request)?;
            return Err(Error::DryRun);
        }
        if request.risk() == Risk::Motion {
            if let Some(session) = self.transport.session() {
                session.claim_motion().await.map_err(Error::Session)?;
            }
            self.has_moved = true;
        }
        Ok(())
    }

    fn authorize(&self, request: &Request) -> Result<(), NotAuthorized> {
        self.grant.check(request.risk(), &format!("request {:#04x}", request.command))
    }

    /// Sends one request and waits for its reply.
    async fn transact(&mut self, request: &Request, is_repeatable: bool) -> Result<Reply, Error> {
        if request.division() == Division::File {
            self.abandon().await;
        }
        let mut session = Exchange::new(&request.into(), is_repeatable, self.policy, &self.ids);
        let before = self.totals.sent;
        let result = self.drive(request.division(), &mut session, |_| Ok::<(), Infallible>(())).await;
        let ended = result.map_err(|cause| Error::from(self.cut_short_error(cause, request, before)))?;
        self.count_exchange(session.counters());
        match ended {
            Ended::Answered(reply) => Ok(reply),
            Ended::NoAnswer(counters) => Err(self.silence_error(counters)),
            Ended::OutcomeUnknown(counters) => {
                Err(Error::OutcomeUnknown { request: request.clone(), waited: self.policy.timeout, counters })
            }
        }
    }

    /// Runs a session to its end. A shared link stays reserved for this client until then.
    async fn drive<S: Session, E>(
        &mut self,
        division: Division,
        session: &mut S,
        serve: impl FnMut(FileRequest<'_, S>) -> Result<(), E>,
    ) -> Result<S::Outcome, Cause<E>> {
        self.acquire(division).await?;
        let result = self.drive_alone(division, session, serve).await;
        if let Some(session) = self.transport.session() {
            session.release();
        }
        result
    }

    async fn acquire(&mut self, division: Division) -> Result<(), Error> {
        let Some(session) = self.transport.session() else { return Ok(()) };
        let until = Instant::now() + self.policy.timeout;
        session.acquire_channel(transport::number(channel(division)), until).await.map_err(Error::Session)
    }

    async fn drive_alone<S: Session, E>(
        &mut self,
        division: Division,
        session: &mut S,
        mut serve: impl FnMut(FileRequest<'_, S>) -> Result<(), E>,
    ) -> Result<S::Outcome, Cause<E>> {
        let channel = channel(division);
        let began = self.started.elapsed();
        let mut now = began;
        let mut queued = 0;
        loop {
            // The clock is read only where time may have passed: after a wait, or after file access.
            match session.poll(now) {
                Step::Send(bytes) => {
                    self.send(channel, &bytes).await?;
                    queued = 0;
                }
                Step::Data(piece) => {
                    serve(FileRequest::Received(&piece)).map_err(Cause::Caller)?;
                    now = self.started.elapsed();
                }
                Step::Feed => {
                    serve(FileRequest::Feed(session)).map_err(Cause::Caller)?;
                    now = self.started.elapsed();
                }
                Step::Wait(until) => {
                    let received = self.receive(channel, self.started + until).await?;
                    now = self.started.elapsed();
                    let Some(len) = received else { continue };
                    // The socket had the frame before the deadline. The frames behind it still count: the answer can be
                    // one of them, if this process did not run for some time.
                    if now >= until && queued < MAX_QUEUED {
                        queued += 1;
                        now = until.saturating_sub(Duration::from_nanos(1));
                    }
                    if division == Division::File
                        && let Some(open) = &mut self.open
                    {
                        open.answered();
                    }
                    let again = self
                        .last_download
                        .as_mut()
                        .and_then(|last| last.linger(self.buffer.get(..len).unwrap_or_default()));
                    match again {
                        Some(ack) => self.send(channel, &ack).await?,
                        None => session.handle(now, self.buffer.get(..len).unwrap_or_default()),
                    }
                }
                Step::Done(outcome) => {
                    self.totals.waited += now.saturating_sub(began);
                    return Ok(outcome);
                }
            }
        }
    }

    async fn send(&mut self, channel: usize, bytes: &[u8]) -> Result<(), Error> {
        self.transport.send(channel, bytes).await.map_err(|error| self.io_error(channel, error))?;
        self.totals.sent += 1;
        if channel == simulated::channel(Division::File) {
            self.open = Abort::after(bytes);
        }
        self.watcher.frame(Direction::Sent, self.transport.address_pair(channel), bytes);
        Ok(())
    }

    /// Receives a datagram into the buffer; `None` at the deadline.
    async fn receive(&mut self, channel: usize, until: Instant) -> Result<Option<usize>, Error> {
        let received = self.transport.receive(channel, &mut self.buffer[..], until).await;
        let Some(len) = received.map_err(|error| self.io_error(channel, error))? else { return Ok(None) };
        self.totals.received += 1;
        self.watcher.frame(
            Direction::Received,
            self.transport.address_pair(channel),
            self.buffer.get(..len).unwrap_or_default(),
        );
        Ok(Some(len))
    }

    /// Counts a completed exchange or transfer. Reports unexpected traffic to the watcher.
    fn count_exchange(&mut self, counters: Counters) {
        self.totals.exchanges += 1;
        self.totals.disturbances += counters.total();
        if counters != Counters::default() {
            self.watcher.event(Event::UnexpectedTraffic(counters));
        }
    }

    /// Returns the error of a read without an answer.
    fn silence_error(&self, counters: Counters) -> Error {
        let waited = self.policy.patience();
        if counters.is_garbage() { Error::Garbage { waited, counters } } else { Error::NoAnswer { waited, counters } }
    }

    /// Returns the error of a change whose session ended before the answer arrived. `before` is the number of frames
    /// sent before the request.
    fn cut_short_error<E>(&self, cause: Cause<E>, request: &Request, before: u64) -> Cause<E> {
        let (Some(why), Cause::Client(error)) = (self.transport.ended(), &cause) else { return cause };
        if request.risk() == Risk::Read {
            return cause;
        }
        Cause::Client(if self.totals.sent > before {
            Error::CutShort { request: request.clone(), cause: Box::new(error.clone()) }
        } else {
            Error::Session(SessionBusy::Ended(format!("{why}; nothing was sent")))
        })
    }

    /// Returns the error of a failed socket.
    fn io_error(&self, channel: usize, error: io::Error) -> Error {
        match (self.transport.ended(), SessionBusy::of(&error)) {
            (Some(why), _) => Error::Session(SessionBusy::Ended(why.to_owned())),
            (None, Some(busy)) => Error::Session(busy),
            (None, None) => Error::Io { port: self.transport.port(channel), error: Arc::new(error) },
        }
    }
}
