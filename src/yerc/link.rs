//! Controller connection of a command: the client, with conversion of its errors and a trace.

use std::sync::Mutex;

use derive_more::{Deref, DerefMut};

use super::connect;
use super::control_commands::usage;
use super::failure::{failure, refused};
use super::item_requests::{Batch, Outcome};
use super::model_cache::CachedModel;
use super::trace::Trace;
use crate::prelude::basics::*;
use armctl_client::Watcher;
use armctl_client::yerc::{Cause, Client, Event, Totals, TransferError};
pub use armctl_client::yerc::{Error, Refusal, RefusedRequest};
use armctl_controller::yerc::query::{Query, QueryError};
use armctl_controller::yerc::session::{DownloadEnd, Reply, UploadEnd};
use armctl_frame::Family;
use armctl_frame::dry_run::Plan;
use armctl_frame::face::sample::Traffic;
use armctl_frame::settings::model::ReportedModel;
use armctl_frame::settings::target;
use armctl_frame::settings_report::{OLD_VALUE, nothing_written};
use armctl_frame::trace::lock_writer;
use armctl_transport::tap::Direction;

/// The `yerc` family.
#[derive(Debug)]
pub struct Yerc;

/// Connection to one controller. Operations that cannot fail, or whose errors need no robot label, are available
/// through the client.
#[derive(Debug, Deref, DerefMut)]
pub struct Link {
    #[deref]
    #[deref_mut]
    client: Client,
    trace: Arc<Mutex<Trace>>,
    screen: Screen,
    label: String,
    /// Encoding of the texts on the controller.
    pub encoding: Encoding,
    /// Pulses per degree of the axes of R1, for as many axes as the inventory has values.
    pulses_per_degree: Vec<f64>,
    /// Number of words in a cartesian move: 25 or 26.
    pub move_words: u8,
    /// Model of the controller that is stored on this computer.
    cached_model: CachedModel,
}

impl Family for Yerc {
    const FAMILY: Option<target::Family> = Some(target::Family::Yerc);
    type Link = Link;
    const STOP: &'static [&'static str] = &["hold", "on"];

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link> {
        let mut client = connect::open(robot, &access, screen).await?;
        let trace = Arc::new(Mutex::new(Trace::open(&access, screen)?));
        let label = robot.label();
        client.watch(TraceObserver { trace: Arc::clone(&trace), screen: *screen, label: label.clone() });
        let move_words = robot.target.value.traits().move_words.unwrap_or(26);
        let pulses_per_degree = robot.pulses_per_degree.clone();
        let encoding = robot.encoding.value;
        let cached_model = CachedModel::recall(robot, &mut client);
        Ok(Link { client, trace, screen: *screen, label, encoding, pulses_per_degree, move_words, cached_model })
    }

    async fn halt(link: &mut Link) -> Result<String> {
        // If this command did not start the motion, the motion is not stopped.
        if !link.has_moved() {
            return Ok("no motion command was sent".to_owned());
        }
        link.screen.note("stopping the robot: HOLD on");
        link.stop().await?;
        Ok("the robot was stopped: HOLD is on; use `yerc hold off` to release HOLD".to_owned())
    }

    fn planned(link: &mut Link) -> Plan {
        link.take_plan()
    }

    async fn close(mut link: Link, screen: &Screen) -> Result<()> {
        link.cache_model();
        let Link { client, trace, label, .. } = link;
        let totals = client.close().await.map_err(|error| failure(&label, error))?;
        let [sent, received] = [totals.sent, totals.received];
        let exchanges = format!("{} exchanges in {:.1?}", totals.exchanges, totals.waited);
        screen.detail(1, &format!("{exchanges}: {sent} frames sent, {received} received"));
        lock_writer(&trace).finish()
    }
}

impl Link {
    /// Number of datagrams on the network so far.
    pub(super) fn traffic(&self) -> Traffic {
        let Totals { sent, received, disturbances, .. } = self.client.totals();
        Traffic { sent, received, disturbances }
    }

    /// Pulses per degree of the axes of a group, for as many axes as they are known.
    pub fn pulses_per_degree(&self, group: Group) -> &[f64] {
        if group == Group::R1 { &self.pulses_per_degree } else { &[] }
    }

    /// Model of the controller. If the model is unknown, it is read from the controller.
    pub async fn model(&mut self) -> Result<Model> {
        let model = self.client.model().await;
        self.cache_model();
        model.map_err(|error| self.failure(error))
    }

    /// Model with which a request can be built. The controller is asked only if the request depends on the model:
    /// [`Client::model_for`].
    pub async fn model_for<T: PartialEq, E>(&mut self, make: impl Fn(Model) -> Result<T, E>) -> Result<Model> {
        let model = self.client.model_for(make).await;
        self.cache_model();
        model.map_err(|error| self.failure(error))
    }

    /// Builds a request that may depend on the model.
    pub async fn by_model<T: PartialEq>(&mut self, make: impl Fn(Model) -> Result<T, QueryError>) -> Result<T> {
        let model = self.model_for(&make).await?;
        make(model).map_err(usage)
    }

    /// Version of the system software, if it was read on this connection.
    pub fn reported_software(&self) -> Option<String> {
        self.client.identity().map(|identity| self.encoding.decode(identity.software.as_bytes()))
    }

    /// Stores the model that the controller reported, if it is not stored yet.
    fn cache_model(&mut self) {
        if let (Some(identity), Some(software)) = (self.client.identity(), self.reported_software()) {
            let reported_model = identity.model.map(|model| ReportedModel::now(model, software));
            self.cached_model.store_model(reported_model, &self.screen, &self.label);
        }
    }

    /// Sends one request. A refusal is a failure.
    pub async fn ask<Q: Query>(&mut self, query: &Q) -> Result<Q::Answer> {
        self.ask_optional(query).await?.map_err(|refusal| refused(refusal, query.risk()))
    }

    /// Applies HOLD. Sends several attempts in parallel until the controller answers one of them.
    pub async fn stop(&mut self) -> Result<()> {
        self.client.stop().await.map_err(|error| self.failure(error))
    }

    /// Sends one request. A refusal is a result, and not a failure.
    pub async fn ask_optional<Q: Query>(&mut self, query: &Q) -> Result<Result<Q::Answer, Refusal>> {
        self.client.try_ask(query).await.map_err(|error| self.failure(error))
    }

    /// Reads the value that a write replaces. Returns `None` if the controller refuses. In a dry run, records the
    /// request and returns `None`. If the connection is lost, the failure states that nothing was written.
    pub async fn before<Q: Query>(&mut self, question: &Q) -> Result<Option<Q::Answer>> {
        let answer = self.for_purpose(OLD_VALUE).ask_optional(question).await.known().map_err(nothing_written)?;
        Ok(answer.and_then(Result::ok))
    }

    /// Sends several requests. Each request has its own outcome. A dry run records them all.
    pub async fn ask_each<Q: Query>(&mut self, queries: &[Q]) -> Result<Vec<Outcome<Q::Answer>>> {
        let outcomes = self.client.ask_each(queries).await.map_err(|error| self.failure(error))?;
        Ok(outcomes.into_iter().map(|outcome| outcome.map_err(|denied| denied.map(|e| self.failure(e)))).collect())
    }

    /// Sends one request of a batch.
    pub async fn ask_in_batch<Q: Query>(&mut self, batch: &mut Batch, query: &Q) -> Result<Outcome<Q::Answer>> {
        let outcome = self.client.ask_in_batch(batch, query).await.map_err(|error| self.failure(error))?;
        Ok(outcome.map_err(|denied| denied.map(|error| self.failure(error))))
    }

    /// Sends a raw request, and returns the whole reply. The reply can also be a refusal.
    pub async fn raw(&mut self, request: &Request) -> Result<Reply> {
        self.client.raw(request).await.map_err(|error| self.failure(error))
    }

    /// Downloads a file or list: [`Client::download`].
    pub async fn download(
        &mut self,
        request: &Request,
        limit: u64,
        first_wait: Option<Duration>,
        take: impl FnMut(&[u8]) -> Result<()>,
    ) -> Result<DownloadEnd> {
        let downloaded = self.client.download(request, limit, first_wait, take).await;
        downloaded.map_err(|TransferError { bytes, cause }| match cause {
            Cause::Caller(failure) => failure,
            Cause::Client(Error::Garbage { counters, .. }) if bytes > 0 => Failure::new(
                Kind::Malformed,
                format!("{}: no valid answer after {bytes} bytes, but {counters}", self.label),
            )
            .hint("repeat the command, and record it with --trace if the problem persists; no data was saved"),
            Cause::Client(Error::NoAnswer { .. }) if bytes > 0 => {
                Failure::new(Kind::NoAnswer, format!("{}: the transfer stopped after {bytes} bytes", self.label))
                    .hint("repeat the command, with a longer --timeout for a bad connection; no data was saved")
            }
            Cause::Client(error) => self.failure(error),
        })
    }

    /// Uploads a file: [`Client::upload`]. After the first block, the controller may have a part of the file or all of
    /// it.
    pub async fn upload(&mut self, request: &Request, give: impl FnMut() -> Result<Vec<u8>>) -> Result<UploadEnd> {
        let uploaded = self.client.upload(request, give).await;
        uploaded.map_err(|TransferError { bytes, cause }| {
            let failure = match cause {
                Cause::Caller(failure) => failure,
                Cause::Client(error) => self.failure(error),
            };
            if bytes == 0 {
                return failure;
            }
            let message = format!(
                "{}; {bytes} bytes were sent: the controller may have a part of the file or the whole file",
                failure.message
            );
            let kind = if failure.kind == Kind::NoAnswer { Kind::OutcomeUnknown } else { failure.kind };
            Failure { kind, message, ..failure }
                .hint("compare the file with `yerc file diff` before you use it, or send the file again")
        })
    }

    /// Records all requests in a dry run, in which the answers are unknown.
    pub fn plan_all<Q: Query>(&mut self, queries: &[Q]) -> Result<()> {
        self.client.plan_all(queries).map_err(|error| self.failure(error))
    }

    /// Sets the purpose of the next request, which a dry run shows.
    pub fn for_purpose(&mut self, purpose: &'static str) -> &mut Self {
        self.client.for_purpose(purpose);
        self
    }

    /// Takes the purpose that was set, for several next requests. A dry run shows it.
    pub fn take_purpose(&mut self) -> Option<&'static str> {
        self.client.take_purpose()
    }

    /// Encodes a text in the encoding of the controller.
    pub fn encode(&self, what: &str, text: &str) -> Result<Vec<u8>> {
        self.encoding.encode(text).map_err(|error| {
            Failure::usage(format!("{what}: {error}"))
                .hint("set the encoding with --encoding or in the robot's entry in robots.toml")
        })
    }

    fn failure(&self, error: Error) -> Failure {
        failure(&self.label, error)
    }
}

/// Observer that records the traffic. With `-v`, it also prints unexpected traffic.
#[derive(Debug)]
struct TraceObserver {
    trace: Arc<Mutex<Trace>>,
    screen: Screen,
    label: String,
}

impl Watcher<Event> for TraceObserver {
    fn frame(&mut self, direction: Direction, ends: armctl_client::AddressPair, bytes: &[u8]) {
        lock_writer(&self.trace).record(direction, ends, bytes);
    }

    fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        lock_writer(&self.trace).answered(exchange);
    }

    fn event(&mut self, event: Event) {
        match event {
            Event::UnexpectedTraffic(counters) => self.screen.detail(1, &format!("{}: {counters}", self.label)),
            Event::TransferLeftOpen => self.screen.note(&format!(
                "{}: the controller did not confirm the end of the transfer; the controller may refuse file commands \
                 as busy for some seconds",
                self.label
            )),
            _ => {}
        }
    }
}
