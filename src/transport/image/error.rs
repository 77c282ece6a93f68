//! Why an image link did not come about, or ended: the same few cases on every fieldbus. What the device said in the
//! words of its own bus, and what can be set about it, comes with them as data.

use std::borrow::Cow;
use std::fmt;
use std::time::Duration;

use thiserror::Error;

/// Why a link did not come about, or ended.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LinkError {
    /// Another master commands the device, and it takes one at a time.
    #[error("{0}")]
    Owned(Cause),
    /// The device has images of another size.
    #[error("{0}")]
    Size(Cause),
    /// The device says no to something else.
    #[error("{0}")]
    Refused(Cause),
    /// Nobody is there, or does not answer.
    #[error("{0}")]
    Silent(Cause),
    /// Something answers that is no such device.
    #[error("{0}")]
    Malformed(Cause),
    /// The link was up, and is lost. It opens itself again.
    #[error("{cause}")]
    Lost {
        /// What happened.
        cause: Cause,
        /// What is now true of what the device was shown.
        outputs: Outputs,
    },
    /// Nothing was sent: no link can be as the settings want it.
    #[error("{0}")]
    Settings(Cause),
    /// An adapter, a port or a socket of this machine does not work.
    #[error("{0}")]
    Local(Cause),
}

/// What happened, in words and as data.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Cause {
    /// What was sent, and what was said to it, or what was waited for.
    pub text: String,
    /// The code that the device gave, such as `0x0106`.
    pub code: Option<String>,
    /// The options of the URL that may be wrong, by their names.
    pub options: &'static [&'static str],
    /// What else to set or to check, as hints are written: small, without a full stop.
    pub advice: Option<Cow<'static, str>>,
}

/// What is true of the outputs of a device whose link is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outputs {
    /// They were never this link's.
    Never,
    /// The device has let go of them.
    Released,
    /// The device holds them as they were, and lets go of them after so long without a word from here.
    ReleasedWithin(Duration),
}

impl Cause {
    /// Nothing but words.
    pub fn new(text: impl fmt::Display) -> Self {
        Self { text: text.to_string(), ..Self::default() }
    }

    /// Why a connection is lost, or that it is another one by now.
    pub fn of_loss(trouble: Option<impl fmt::Display>) -> Self {
        trouble.map_or_else(|| Self::new("it was opened anew"), Self::new)
    }

    /// With what to set or to check.
    #[must_use]
    pub fn advice(self, advice: impl Into<Cow<'static, str>>) -> Self {
        Self { advice: Some(advice.into()), ..self }
    }

    /// With the options of the URL that may be wrong.
    #[must_use]
    pub fn options(self, options: &'static [&'static str]) -> Self {
        Self { options, ..self }
    }
}

impl LinkError {
    /// What happened.
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
            Self::Never => f.write_str("its outputs are not shown from here"),
            Self::Released => f.write_str("it has let go of its outputs"),
            Self::ReleasedWithin(time) => {
                write!(f, "it holds its outputs as they were, for at most {} ms more", time.as_millis())
            }
        }
    }
}
