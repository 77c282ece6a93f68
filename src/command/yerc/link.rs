//! The connection to a controller as commands use it: the client, with its errors in words, and its traffic on record.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use derive_more::{Deref, DerefMut};

use super::connect;
use super::each::{Outcome, Round};
use super::failure::{failure, refused};
use super::orders::usage;
use super::told::Told;
use super::trace::Trace;
use crate::client::Watcher;
pub use crate::client::yerc::{Asked, Error, Refusal};
use crate::client::yerc::{Cause, Client, Event, Totals, TransferError};
use crate::command::face::sample::Traffic;
use crate::command::frame::dry_run::{Known as _, Plan};
use crate::command::frame::orders::{BEFORE, unwritten};
use crate::command::frame::trace::locked;
use crate::command::{Access, Family};
use crate::controller::text::Encoding;
use crate::controller::yerc::Model;
use crate::controller::yerc::group::Group;
use crate::controller::yerc::query::{Query, QueryError};
use crate::controller::yerc::request::Request;
use crate::controller::yerc::session::{DownloadEnd, Reply, UploadEnd};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::model::ToldModel;
use crate::settings::target;
use crate::transport::tap::Direction;

/// The yerc family.
#[derive(Debug)]
pub struct Yerc;

/// A connection to one controller. What cannot fail, or fails without a word about the robot, is the client's own.
#[derive(Debug, Deref, DerefMut)]
pub struct Link {
    #[deref]
    #[deref_mut]
    client: Client,
    trace: Arc<Mutex<Trace>>,
    screen: Screen,
    label: String,
    /// Encoding of its texts.
    pub encoding: Encoding,
    /// Pulses of a degree of each axis of R1, as far as the inventory says it.
    pulses_per_degree: Vec<f64>,
    /// Words of a cartesian move, 25 or 26.
    pub move_words: u8,
    /// Where it is kept what the controller told of its model.
    told: Told,
}

impl Family for Yerc {
    const FAMILY: Option<target::Family> = Some(target::Family::Yerc);
    type Link = Link;
    const STOP: &'static [&'static str] = &["hold", "on"];

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link, Failure> {
        let mut client = connect::open(robot, &access, screen).await?;
        let trace = Arc::new(Mutex::new(Trace::open(&access, screen)?));
        let label = robot.label();
        client.watch(Onlooker { trace: Arc::clone(&trace), screen: *screen, label: label.clone() });
        let move_words = robot.target.value.traits().move_words.unwrap_or(26);
        let pulses_per_degree = robot.pulses_per_degree.clone();
        let encoding = robot.encoding.value;
        let told = Told::recall(robot, &mut client);
        Ok(Link { client, trace, screen: *screen, label, encoding, pulses_per_degree, move_words, told })
    }

    async fn halt(link: &mut Link) -> Result<String, Failure> {
        // What else moves there is not this command's to stop.
        if !link.has_moved() {
            return Ok("nothing was sent that moves the robot".to_owned());
        }
        link.screen.note("stopping the robot: HOLD on");
        link.stop().await?;
        Ok("the robot was stopped: HOLD is on; `yerc hold off` releases it".to_owned())
    }

    fn planned(link: &mut Link) -> Plan {
        link.take_plan()
    }

    async fn close(mut link: Link, screen: &Screen) -> Result<(), Failure> {
        link.keep_model();
        let Link { client, trace, label, .. } = link;
        let totals = client.close().await.map_err(|error| failure(&label, error))?;
        let [sent, received] = [totals.sent, totals.received];
        let exchanges = format!("{} exchanges in {:.1?}", totals.exchanges, totals.waited);
        screen.detail(1, &format!("{exchanges}: {sent} frames sent, {received} received"));
        locked(&trace).finish()
    }
}

impl Link {
    /// What was counted on the network so far.
    pub(super) fn traffic(&self) -> Traffic {
        let Totals { sent, received, disturbances, .. } = self.client.totals();
        Traffic { sent, received, disturbances }
    }

    /// Pulses of a degree of each axis of a group, as far as they are known.
    pub fn pulses_per_degree(&self, group: Group) -> &[f64] {
        if group == Group::R1 { &self.pulses_per_degree } else { &[] }
    }

    /// The model of the controller, which is asked if nobody knows it.
    pub async fn model(&mut self) -> Result<Model, Failure> {
        let model = self.client.model().await;
        self.keep_model();
        model.map_err(|error| self.failure(error))
    }

    /// A model to make something for; the controller is asked only if it matters: [`Client::model_for`].
    pub async fn model_for<T: PartialEq, E>(&mut self, make: impl Fn(Model) -> Result<T, E>) -> Result<Model, Failure> {
        let model = self.client.model_for(make).await;
        self.keep_model();
        model.map_err(|error| self.failure(error))
    }

    /// Makes something that may depend on the model.
    pub async fn by_model<T: PartialEq>(
        &mut self,
        make: impl Fn(Model) -> Result<T, QueryError>,
    ) -> Result<T, Failure> {
        let model = self.model_for(&make).await?;
        make(model).map_err(usage)
    }

    /// The version of the system software, if the controller has told it on this connection.
    pub fn told_software(&self) -> Option<String> {
        self.client.identity().map(|identity| self.encoding.decode(identity.software.as_bytes()))
    }

    /// Keeps what the controller told of its model, if it is news.
    fn keep_model(&mut self) {
        if let (Some(identity), Some(software)) = (self.client.identity(), self.told_software()) {
            let news = identity.model.map(|model| ToldModel::now(model, software));
            self.told.keep(news, &self.screen, &self.label);
        }
    }

    /// Asks one question or gives one order; a refusal is a failure.
    pub async fn ask<Q: Query>(&mut self, query: &Q) -> Result<Q::Answer, Failure> {
        self.try_ask(query).await?.map_err(|refusal| refused(refusal, query.risk()))
    }

    /// Holds the robot, as soon as one of several tries has its answer.
    pub async fn stop(&mut self) -> Result<(), Failure> {
        self.client.stop().await.map_err(|error| self.failure(error))
    }

    /// Asks one question or gives one order; a refusal is an answer.
    pub async fn try_ask<Q: Query>(&mut self, query: &Q) -> Result<Result<Q::Answer, Refusal>, Failure> {
        self.client.try_ask(query).await.map_err(|error| self.failure(error))
    }

    /// Reads what a write replaces; nothing where the controller refuses to tell, and in a dry run, which notes the
    /// question. A line that is lost is a failure: nothing was written.
    pub async fn before<Q: Query>(&mut self, question: &Q) -> Result<Option<Q::Answer>, Failure> {
        let answer = self.is_for(BEFORE).try_ask(question).await.known().map_err(unwritten)?;
        Ok(answer.and_then(Result::ok))
    }

    /// Asks several questions; each has its own outcome. A dry run notes them all.
    pub async fn ask_each<Q: Query>(&mut self, queries: &[Q]) -> Result<Vec<Outcome<Q::Answer>>, Failure> {
        let outcomes = self.client.ask_each(queries).await.map_err(|error| self.failure(error))?;
        Ok(outcomes.into_iter().map(|outcome| outcome.map_err(|denied| denied.map(|e| self.failure(e)))).collect())
    }

    /// Asks one question of several.
    pub async fn ask_in<Q: Query>(&mut self, round: &mut Round, query: &Q) -> Result<Outcome<Q::Answer>, Failure> {
        let outcome = self.client.ask_in(round, query).await.map_err(|error| self.failure(error))?;
        Ok(outcome.map_err(|denied| denied.map(|error| self.failure(error))))
    }

    /// Sends a request as it is and returns the whole answer, good or bad.
    pub async fn raw(&mut self, request: &Request) -> Result<Reply, Failure> {
        self.client.raw(request).await.map_err(|error| self.failure(error))
    }

    /// Fetches a file or list: [`Client::download`].
    pub async fn download(
        &mut self,
        request: &Request,
        limit: u64,
        first_wait: Option<Duration>,
        take: impl FnMut(&[u8]) -> Result<(), Failure>,
    ) -> Result<DownloadEnd, Failure> {
        let downloaded = self.client.download(request, limit, first_wait, take).await;
        downloaded.map_err(|TransferError { bytes, cause }| match cause {
            Cause::Caller(failure) => failure,
            Cause::Client(Error::Garbage { counters, .. }) if bytes > 0 => Failure::new(
                Kind::Malformed,
                format!("{}: after {bytes} bytes came nothing of the protocol, but {counters}", self.label),
            )
            .hint("nothing was kept of it; repeat it, and record it with --trace if it comes again"),
            Cause::Client(Error::NoAnswer { .. }) if bytes > 0 => {
                Failure::new(Kind::NoAnswer, format!("{}: the transfer broke off after {bytes} bytes", self.label))
                    .hint("nothing was kept of it; repeat the command, with a longer --timeout if the line is bad")
            }
            Cause::Client(error) => self.failure(error),
        })
    }

    /// Sends a file: [`Client::upload`]. After the first block the controller may hold a part or all.
    pub async fn upload(
        &mut self,
        request: &Request,
        give: impl FnMut() -> Result<Vec<u8>, Failure>,
    ) -> Result<UploadEnd, Failure> {
        let uploaded = self.client.upload(request, give).await;
        uploaded.map_err(|TransferError { bytes, cause }| {
            let failure = match cause {
                Cause::Caller(failure) => failure,
                Cause::Client(error) => self.failure(error),
            };
            if bytes == 0 {
                return failure;
            }
            let message =
                format!("{}; {bytes} bytes had been sent: the file may be there, whole or in part", failure.message);
            let kind = if failure.kind == Kind::NoAnswer { Kind::OutcomeUnknown } else { failure.kind };
            Failure { kind, message, ..failure }
                .hint("compare it with `yerc file diff` before anybody runs it, or send it again")
        })
    }

    /// In a dry run, notes all the questions, whose answers are not known then.
    pub fn plan_all<Q: Query>(&mut self, queries: &[Q]) -> Result<(), Failure> {
        self.client.plan_all(queries).map_err(|error| self.failure(error))
    }

    /// Says what the next request is for, where a dry run notes it.
    pub fn is_for(&mut self, purpose: &'static str) -> &mut Self {
        self.client.is_for(purpose);
        self
    }

    /// A text as the controller stores it.
    pub fn encode(&self, what: &str, text: &str) -> Result<Vec<u8>, Failure> {
        self.encoding.encode(text).map_err(|error| {
            Failure::usage(format!("{what}: {error}")).hint("--encoding or the robot's entry sets the encoding")
        })
    }

    fn failure(&self, error: Error) -> Failure {
        failure(&self.label, error)
    }
}

/// Keeps the record of the traffic, and says at `-v` what else was on the line.
#[derive(Debug)]
struct Onlooker {
    trace: Arc<Mutex<Trace>>,
    screen: Screen,
    label: String,
}

impl Watcher<Event> for Onlooker {
    fn frame(&mut self, direction: Direction, ends: crate::client::Ends, bytes: &[u8]) {
        locked(&self.trace).record(direction, ends, bytes);
    }

    fn event(&mut self, event: Event) {
        match event {
            Event::Disturbed(counters) => self.screen.detail(1, &format!("{}: {counters}", self.label)),
            Event::LeftOpen => self.screen.note(&format!(
                "{}: the controller did not confirm the end of the transfer; it may refuse file commands as busy for some \
                 seconds",
                self.label
            )),
            _ => {}
        }
    }
}
