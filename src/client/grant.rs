//! What a client may send.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use armctl_controller::Risk;
use thiserror::Error;

/// The most that may leave through a client. Clones are the same grant: whoever keeps one can raise it, and the client
/// checks it before every request.
#[derive(Debug, Clone)]
pub struct Grant(Arc<AtomicU8>);

/// Something riskier than what was granted. Nothing was sent.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what} ({}) is not authorized; nothing was sent", .risk.name())]
pub struct NotAuthorized {
    /// What would have been sent.
    pub what: String,
    /// What it does.
    pub risk: Risk,
}

const RISKS: [Risk; 4] = [Risk::Read, Risk::Write, Risk::Destroy, Risk::Motion];

impl Grant {
    /// Lets through what is not riskier than this.
    pub fn of(risk: Risk) -> Self {
        Self(Arc::new(AtomicU8::new(risk as u8)))
    }

    /// The most that may leave.
    pub fn get(&self) -> Risk {
        // Only `raise` writes it, and it writes the number of a risk.
        RISKS[usize::from(self.0.load(Ordering::Relaxed)).min(RISKS.len() - 1)]
    }

    /// Lets this through from now on as well.
    pub fn raise(&self, risk: Risk) {
        self.0.fetch_max(risk as u8, Ordering::Relaxed);
    }

    /// The last check before something leaves: whether `what` may.
    pub fn check(&self, risk: Risk, what: &str) -> Result<(), NotAuthorized> {
        if risk <= self.get() { Ok(()) } else { Err(NotAuthorized { what: what.to_owned(), risk }) }
    }
}

impl Default for Grant {
    /// To read.
    fn default() -> Self {
        Self::of(Risk::Read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grant_is_raised_and_never_lowered() {
        let grant = Grant::default();
        let shared = grant.clone();
        assert!(shared.check(Risk::Write, "a write").is_err());
        grant.raise(Risk::Destroy);
        grant.raise(Risk::Write);
        assert_eq!(shared.get(), Risk::Destroy);
        assert!(shared.check(Risk::Destroy, "a delete").is_ok());
        let denied = shared.check(Risk::Motion, "a move").unwrap_err();
        assert_eq!(denied.to_string(), "a move (motion) is not authorized; nothing was sent");
    }
}
