//! Job that a start runs: the text of the confirmation, and a check after the confirmation that the job is still the
//! same.

use crate::failure::refusal_failure;
use crate::prelude::*;
use armctl_controller::units;
use armctl_controller::yerc::payload::JobInfo;
use armctl_controller::yerc::query::ReadJob;
use armctl_frame::gate::data_changed;

/// Job that a start command starts, as the controller reports it.
#[derive(Debug, PartialEq, Eq)]
pub enum SelectedJob {
    /// This job. Contains the line and the speed override.
    Job(JobInfo),
    /// No job is selected.
    None,
    /// The job is unknown. Contains the reason why it could not be read.
    Unread(String),
}

impl SelectedJob {
    /// Reads the job of the master task (FS and DX 3.3.4).
    pub async fn ask(link: &mut Link) -> Result<Self> {
        let unread = |failure: &Failure| Self::Unread(failure.message.trim_end_matches('.').to_owned());
        let question = link.by_model(|model| ReadJob::new(model, 0)).await?;
        match link.for_purpose("selected job").ask_optional(&question).await {
            Ok(Ok(info)) if info.name.is_empty() => Ok(Self::None),
            Ok(Ok(info)) => Ok(Self::Job(info)),
            Ok(Err(refusal)) => Ok(unread(&refusal_failure(refusal))),
            Err(failure) if failure.kind == Kind::Malformed => Ok(unread(&failure)),
            Err(failure) if failure.kind == Kind::DryRun => Ok(Self::None),
            Err(failure) => Err(failure),
        }
    }

    /// Name of the job.
    pub fn name(&self, encoding: Encoding) -> Option<String> {
        match self {
            Self::Job(info) => Some(encoding.decode(info.name.as_bytes())),
            Self::None | Self::Unread(_) => None,
        }
    }

    /// Whether the job has this name, in the bytes of the controller.
    pub fn is(&self, name: &[u8]) -> bool {
        matches!(self, Self::Job(info) if info.name.as_bytes() == name)
    }

    /// Speed override in 0.01 %.
    pub fn speed_override(&self) -> Option<u32> {
        match self {
            Self::Job(info) => Some(info.speed_override),
            Self::None | Self::Unread(_) => None,
        }
    }

    /// Adds a note to the question of a command that first selects another job.
    pub fn item_name(&self, change: Change, encoding: Encoding) -> Change {
        match self {
            Self::Job(info) => {
                let percent = units::PERCENT.show_unsigned(info.speed_override);
                let name = encoding.decode(info.name.as_bytes());
                change.note(format!("The selected job is {name}. The speed override is {percent} %."))
            }
            Self::None => change.note("No job is selected."),
            Self::Unread(why) => change.note(format!("The selected job could not be read: {why}.")),
        }
    }

    /// Text of the confirmation. `times` is the text for the repetitions, such as ` 20 times`.
    pub fn change(&self, encoding: Encoding, times: &str) -> Change {
        let unknown_name = Change::new(format!("start the selected job{times}"));
        match self {
            Self::None => unknown_name.note("The controller reports no job."),
            Self::Unread(why) => unknown_name.note(format!("The job name could not be read: {why}.")),
            Self::Job(info) => {
                let name = encoding.decode(info.name.as_bytes());
                let from = if info.line == 0 { String::new() } else { format!(" from line {}", info.line) };
                let percent = units::PERCENT.show_unsigned(info.speed_override);
                Change::new(format!("start job {name}{from}{times}"))
                    .note(format!("The speed override is {percent} %."))
            }
        }
    }

    /// Rejects the start if the selected job has changed since the question.
    pub async fn check_unchanged(&self, link: &mut Link) -> Result<()> {
        let now = Self::ask(link).await?;
        if now == *self {
            return Ok(());
        }
        let encoding = link.encoding;
        let shown = |chosen: &Self| chosen.name(encoding).unwrap_or_else(|| "an unknown job".to_owned());
        let message = match (shown(self), shown(&now)) {
            (old, new) if old == new => {
                format!("the line or the speed override of {old} changed after the confirmation")
            }
            (old, new) => format!("{new} is selected now, but the confirmation was for {old}"),
        };
        Err(data_changed(format!("{message}; no job was started")))
    }
}
