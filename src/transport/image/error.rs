//! Errors of image links. The kinds of error are the same on every fieldbus. The error contains the code of the device
//! and the options to check as data.

use std::borrow::Cow;
use std::fmt;
use std::time::Duration;

use thiserror::Error;

/// An error that prevented or ended a link.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LinkError {
    /// The device already has another master, and accepts only one.
    #[error("{0}")]
    Owned(Cause),
    /// The image sizes of the device are not the expected sizes.
    #[error("{0}")]
    Size(Cause),
    /// The device refuses for a reason that is not one of the others.
    #[error("{0}")]
    Refused(Cause),
    /// The device does not answer.
    #[error("{0}")]
    Silent(Cause),
    /// The answer is not valid for a device of this kind.
    #[error("{0}")]
    Malformed(Cause),
    /// The link was open, and was lost. It opens again automatically.
    #[error("{cause}")]
    Lost {
        /// Cause of the loss.
        cause: Cause,
        /// State of the outputs after the loss.
        outputs: Outputs,
    },
    /// The settings are invalid; nothing was sent.
    #[error("{0}")]
    Settings(Cause),
    /// A local adapter, port or socket failed.
    #[error("{0}")]
    Local(Cause),
}

/// Cause of an error, as text and data.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Cause {
    /// Description of the request and of its answer, or of the missing answer.
    pub text: String,
    /// Error code of the device, for example `0x0106`.
    pub code: Option<String>,
    /// Names of the URL options that may be wrong.
    pub options: &'static [&'static str],
    /// More advice: in lower case, without a period at the end.
    pub advice: Option<Cow<'static, str>>,
}

/// State of the outputs of the device after the link was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outputs {
    /// This link never controlled the outputs.
    Never,
    /// The device has cleared the outputs.
    Released,
    /// The device keeps the outputs at first. It clears them after this time without contact.
    ReleasedWithin(Duration),
}

impl Cause {
    /// Creates a cause with text only.
    pub fn new(text: impl fmt::Display) -> Self {
        Self { text: text.to_string(), ..Self::default() }
    }

    /// Creates the cause of a loss. `trouble` is `None` if the connection is open again.
    pub fn of_loss(last_error: Option<impl fmt::Display>) -> Self {
        last_error.map_or_else(|| Self::new("armctl opened the connection again"), Self::new)
    }

    /// Adds advice.
    #[must_use]
    pub fn advice(self, advice: impl Into<Cow<'static, str>>) -> Self {
        Self { advice: Some(advice.into()), ..self }
    }

    /// Adds the URL options that may be wrong.
    #[must_use]
    pub fn options(self, options: &'static [&'static str]) -> Self {
        Self { options, ..self }
    }
}

impl LinkError {
    /// Cause of the error.
    pub fn cause(&self) -> &Cause {
        match self {
            Self::Owned(cause)
            | Self::Size(cause)
            | Self::Refused(cause)
            | Self::Silent(cause)
            | Self::Malformed(cause)
            | Self::Lost { cause, .. }
            | Self::Settings(cause)
            | Self::Local(cause) => cause,
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl fmt::Display for Outputs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Never => f.write_str("armctl does not control its outputs"),
            Self::Released => f.write_str("the controller has cleared its outputs"),
            Self::ReleasedWithin(time) => {
                write!(f, "the controller keeps its outputs for at most {} ms more", time.as_millis())
            }
        }
    }
}
