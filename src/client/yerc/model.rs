//! Model of the controller. The model comes from the settings, from an earlier connection, or from the controller when
//! a request depends on it.
//!
//! Most requests have the same bytes for every model, so the client sends them without the model. For other requests,
//! the client first reads the system information (0x89), once per connection. The first letters of the software version
//! identify the model.

use armctl_controller::Risk;
use armctl_controller::yerc::Model;
use armctl_controller::yerc::payload::Text;
use armctl_controller::yerc::query::{Query as _, ReadSystemInfo};
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::session::Reply;
use armctl_controller::yerc::table::{Availability, service};
use armctl_controller::yerc::wire::Status;

use super::{Client, Error, Refusal, RefusedRequest};
use crate::Reason;

/// Length of a software version in bytes.
const VERSION: usize = 24;
/// Number of the command that reads the software version.
const SYSTEM_INFO: u16 = 0x89;
/// The model for requests that are the same for all models.
const DEFAULT_MODEL: Model = Model::Dx200;

/// Identification of a controller.
///
/// ```
/// use armctl_client::yerc::{Client, Endpoint, Identity, Model, Options, ReadSystemInfo};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(Model::Fs100), Options::auto()).await?;
/// robot.ask(&ReadSystemInfo::FIRST_ROBOT).await?;
/// let Some(Identity { model, software }) = robot.identity() else { return Err("no identity".into()) };
/// assert_eq!(*model, Some(Model::Fs100));
/// println!("{software:?}");
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// Model to which the software belongs; `None` if unknown.
    pub model: Option<Model>,
    /// System software version.
    pub software: Text<VERSION>,
}

/// The known model, and its source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ModelSource {
    /// Unknown.
    Nothing,
    /// The model is in the settings, and the client never reads it.
    Configured(Model),
    /// Known from an earlier connection.
    Remembered(Model),
    /// Reported by the controller on this connection.
    Reported(Model),
    /// Assumed in a dry run, which cannot read the model.
    Assumed,
}

impl ModelSource {
    pub(super) fn from_settings(model: Option<Model>) -> Self {
        model.map_or(Self::Nothing, Self::Configured)
    }

    const fn model(self) -> Option<Model> {
        match self {
            Self::Nothing | Self::Assumed => None,
            Self::Configured(model) | Self::Remembered(model) | Self::Reported(model) => Some(model),
        }
    }
}

impl Client {
    /// The model, if it is known without a request.
    pub fn known_model(&self) -> Option<Model> {
        self.model_source.model()
    }

    /// The known model, or a default model. Use the result only for display.
    pub fn model_for_display(&self) -> Model {
        self.known_model().unwrap_or(DEFAULT_MODEL)
    }

    /// Sets the model of an earlier connection. It is used until the controller reports another model. No effect if the
    /// settings contain a model or the controller reported one.
    pub fn remember(&mut self, model: Model) {
        if self.model_source == ModelSource::Nothing {
            self.model_source = ModelSource::Remembered(model);
        }
    }

    /// Identification of the controller; `None` if it was not read on this connection.
    pub fn identity(&self) -> Option<&Identity> {
        self.identity.as_ref()
    }

    /// Returns the model, and reads it from the controller if it is unknown. A dry run plans the read and continues
    /// with a DX200.
    ///
    /// # Errors
    /// [`Error::ModelRefused`], [`Error::UnknownSoftware`], and errors of the link.
    pub async fn model(&mut self) -> Result<Model, Error> {
        match self.model_source {
            ModelSource::Nothing => self.ask_model().await,
            ModelSource::Assumed => {
                self.plan_model = Some(DEFAULT_MODEL);
                Ok(DEFAULT_MODEL)
            }
            ModelSource::Configured(model) | ModelSource::Remembered(model) | ModelSource::Reported(model) => Ok(model),
        }
    }

    /// Returns the model to use for a request that `make` builds. If `make` has the same result for every model, or
    /// fails for every model, the model need not be known. Otherwise the client reads an unknown model first. A
    /// remembered model is read again if `make` fails for it but works for another model.
    pub async fn model_for<T: PartialEq, E>(&mut self, make: impl Fn(Model) -> Result<T, E>) -> Result<Model, Error> {
        let is_supported = || Model::ALL.iter().any(|model| make(*model).is_ok());
        match self.model_source {
            ModelSource::Configured(model) | ModelSource::Reported(model) => Ok(model),
            ModelSource::Remembered(model) if self.is_dry_run() || make(model).is_ok() || !is_supported() => Ok(model),
            ModelSource::Remembered(_) => self.ask_model().await,
            ModelSource::Nothing | ModelSource::Assumed => {
                let first = make(DEFAULT_MODEL);
                let mut all = Model::ALL.into_iter().map(&make);
                let is_open = match &first {
                    Ok(first) => !all.all(|made| made.is_ok_and(|made| made == *first)),
                    Err(_) => is_supported(),
                };
                self.plan_model = None;
                if !is_open {
                    return Ok(DEFAULT_MODEL);
                }
                let reported = self.model().await?;
                if self.is_dry_run() && first.is_err() {
                    // A dry run cannot read the model, so the plan is shown for the first model that supports the
                    // request.
                    self.plan_model = Model::ALL.into_iter().find(|model| make(*model).is_ok());
                }
                Ok(self.plan_model.unwrap_or(reported))
            }
        }
    }

    /// Reads the identification of the controller.
    async fn ask_model(&mut self) -> Result<Model, Error> {
        let query = ReadSystemInfo::FIRST_ROBOT;
        let request = query.request();
        if self.is_dry_run() {
            let purpose = self.purpose.take();
            self.plan_if(&request, Reason::about("the model of the controller"));
            self.purpose = purpose;
            (self.model_source, self.plan_model) = (ModelSource::Assumed, Some(DEFAULT_MODEL));
            return Ok(DEFAULT_MODEL);
        }
        let reply = self.raw(&request).await?;
        if !reply.status.is_ok() {
            return Err(Error::ModelRefused(Refusal { status: reply.status, to: RefusedRequest::from(&request) }));
        }
        query.decode(&reply.data)?;
        match self.identity() {
            Some(Identity { model: Some(model), .. }) => Ok(*model),
            Some(Identity { software, .. }) => {
                Err(Error::UnknownSoftware { version: software.as_bytes().escape_ascii().to_string() })
            }
            None => Err(Error::UnknownSoftware { version: String::new() }),
        }
    }

    /// Stores the software version and the model, if the reply is the system information that contains them.
    pub(super) fn learn_model(&mut self, request: &Request, reply: &Reply) {
        let has_all_attributes = request.service == service::GET_ALL;
        let has_version = has_all_attributes || request.service == service::GET_SINGLE && request.attribute == 1;
        if request.command != SYSTEM_INFO || !has_version || !reply.status.is_ok() || reply.data.len() < VERSION {
            return;
        }
        let software = Text::cut(&reply.data);
        let model = Model::from_software(software.as_bytes());
        if let (Some(model), false) = (model, matches!(self.model_source, ModelSource::Configured(_))) {
            self.model_source = ModelSource::Reported(model);
        }
        self.identity = Some(Identity { model, software });
    }

    /// Checks a remembered model after a refusal that another model could explain.
    ///
    /// # Errors
    /// [`Error::AnotherModel`] if the controller is another model.
    pub(super) async fn check_remembered_model(&mut self, request: &Request, status: Status) -> Result<(), Error> {
        let ModelSource::Remembered(model) = self.model_source else { return Ok(()) };
        // An FS100 with older software also refuses these requests, so the refusal does not show another model.
        if request.row().is_some_and(|row| row.availability == Availability::Fs114) {
            return Ok(());
        }
        let changes = request.risk() > Risk::Read;
        if !(is_of_another_model(status) || changes && is_of_another_range(status)) {
            return Ok(());
        }
        // An error of this read is ignored: the caller reports the original refusal.
        let found = self.ask_model().await.unwrap_or(model);
        if self.model_source == ModelSource::Remembered(model) {
            self.model_source = ModelSource::Reported(model);
        }
        if found == model { Ok(()) } else { Err(Error::AnotherModel { remembered: model, found }) }
    }
}

/// Whether the status means an unknown command or service (DX 4 and 5).
const fn is_of_another_model(status: Status) -> bool {
    status.code == 0x08 || status.added == 0xA000
}

/// Whether the status means an unknown instance or size (DX 4 and 5).
const fn is_of_another_range(status: Status) -> bool {
    status.code == 0x28 || matches!(status.added, 0xA001 | 0xB002 | 0xB003 | 0xB004)
}

#[cfg(test)]
mod tests {
    use armctl_controller::yerc::group::Group;
    use armctl_controller::yerc::query::{Coordinates, QueryError, ReadPosition, ReadVariable, SystemPart};
    use armctl_controller::yerc::simulator::Start;
    use armctl_controller::yerc::variables::VariableKind;

    use super::*;
    use crate::yerc::{Endpoint, Options};

    /// Connects to a simulator, without a model in the options.
    async fn unknown(start: &str) -> Client {
        let start = Start::parse(start, |_| Err("there are no files".to_owned())).unwrap();
        let endpoint = Endpoint::Simulator { start: Box::new(start), faults: None };
        let mut client = Client::connect(endpoint, Options::auto()).await.unwrap();
        client.model_source = ModelSource::Nothing;
        client
    }

    #[expect(clippy::unnecessary_wraps, reason = "what is made for a model may fail")]
    fn strings(model: Model) -> Result<VariableKind, QueryError> {
        Ok(VariableKind::S32.string_form(model, false))
    }

    fn third_string(model: Model) -> Result<ReadPosition, QueryError> {
        ReadPosition::new(model, Group::Robot(3), Coordinates::Pulse)
    }

    #[tokio::test(start_paused = true)]
    async fn sends_model_independent_requests_without_a_model() {
        let mut client = unknown("").await;
        let first = |model| ReadPosition::new(model, Group::R1, Coordinates::Base);
        let model = client.model_for(first).await.unwrap();
        client.ask(&first(model).unwrap()).await.unwrap();
        assert_eq!((client.known_model(), client.totals.exchanges), (None, 1));
        let nobody = |_| Err::<(), _>("no model has it");
        assert!(client.model_for(nobody).await.is_ok(), "what no model has is no question");
        assert_eq!(client.totals.exchanges, 1);
    }

    #[tokio::test(start_paused = true)]
    async fn asks_for_the_model_once() {
        for model in Model::ALL {
            let mut client = unknown(&format!("model = \"{model}\"")).await;
            assert_eq!(client.model_for(strings).await.unwrap(), model);
            assert_eq!(client.model_for(third_string).await.unwrap(), model);
            assert_eq!(client.model().await.unwrap(), model);
            assert_eq!((client.known_model(), client.totals.exchanges), (Some(model), 1), "{model}");
            assert_eq!(client.identity().unwrap().model, Some(model));
        }
    }

    #[tokio::test(start_paused = true)]
    async fn fails_for_an_unknown_software_version() {
        let mut client = unknown("software = \"XS1.00 \\u001b\"").await;
        let error = client.model().await.unwrap_err();
        assert!(matches!(&error, Error::UnknownSoftware { version } if version == "XS1.00 \\x1b"), "{error}");
        assert_eq!((client.known_model(), client.identity().unwrap().model), (None, None));
        assert!(client.model_for(strings).await.is_err());
    }

    #[tokio::test(start_paused = true)]
    async fn uses_the_remembered_model_until_the_controller_reports_another() {
        let mut client = unknown("model = \"fs100\"").await;
        client.remember(Model::Dx200);
        assert_eq!(client.model_for(strings).await.unwrap(), Model::Dx200);
        assert_eq!(client.totals.exchanges, 0);
        // No FS100 supports this request. After the refusal, the client reads the model.
        let error = client.try_ask(&ReadVariable::new(VariableKind::S32, 0)).await.unwrap_err();
        let (remembered, found) = (Model::Dx200, Model::Fs100);
        assert!(matches!(error, Error::AnotherModel { .. }), "{error}");
        assert_eq!(error.to_string(), Error::AnotherModel { remembered, found }.to_string());
        assert_eq!(client.known_model(), Some(Model::Fs100));
    }

    #[tokio::test(start_paused = true)]
    async fn other_refusals_do_not_ask_for_the_model() {
        let mut client = unknown("").await;
        client.remember(Model::Dx200);
        for _ in 0..2 {
            assert!(client.try_ask(&third_string(Model::Dx200).unwrap()).await.unwrap().is_err(), "there is one robot");
        }
        assert_eq!((client.totals.exchanges, client.identity()), (2, None));
    }

    #[tokio::test(start_paused = true)]
    async fn asks_again_if_the_remembered_model_lacks_the_command() {
        let mut client = unknown("").await;
        client.remember(Model::Fs100);
        assert_eq!(client.model_for(third_string).await.unwrap(), Model::Dx200);
        assert_eq!(client.totals.exchanges, 1);
        client.remember(Model::Fs100);
        assert_eq!(client.known_model(), Some(Model::Dx200), "a reported model is kept");
    }

    #[tokio::test(start_paused = true)]
    async fn learns_the_model_from_other_reads() {
        let mut client = unknown("model = \"yrc1000\"").await;
        client.ask(&ReadSystemInfo::new(DEFAULT_MODEL, SystemPart::Application(1)).unwrap()).await.unwrap();
        assert_eq!((client.known_model(), client.totals.exchanges), (Some(Model::Yrc1000), 1));
    }

    #[tokio::test]
    async fn dry_run_plans_the_model_request_and_dependent_requests() {
        let mut client = Client::dry_run(Options::auto());
        let same = ReadVariable::new(VariableKind::B, 0);
        assert!(client.model_for(|_| Ok::<_, QueryError>(())).await.is_ok());
        client.plan_all(&[same]).unwrap_err();
        let model = client.model_for(strings).await.unwrap();
        client.plan_all(&[ReadVariable::new(strings(model).unwrap(), 0)]).unwrap_err();
        let frames = client.take_plan().frames;
        assert_eq!(frames.len(), 3, "{frames:?}");
        assert!(frames[0]["depends_on"].is_null());
        assert_eq!(frames[1]["about"], "the model of the controller");
        assert!(frames[1]["depends_on"].is_null(), "{}", frames[1]);
        assert_eq!(frames[2]["depends_on"], "the model of the controller; shown for a dx200");
    }
}
