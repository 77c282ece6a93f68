//! Authorization: the highest risk that a client may send.

use std::fmt;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, OnceLock};

use armctl_controller::Risk;
use thiserror::Error;

/// The highest risk that a client may send. Clones share one limit: a call of [`Grant::raise`] on one clone raises the
/// limit of all clones. The client checks the limit before every request.
///
/// ```
/// use armctl_client::{Grant, NotAuthorized, Risk};
///
/// let grant = Grant::up_to(Risk::Write);
/// assert!(grant.check(Risk::Read, "read a variable").is_ok());
/// let refused: NotAuthorized = grant.check(Risk::Motion, "start a job").unwrap_err();
/// assert_eq!(refused.to_string(), "start a job (motion) is not authorized; nothing was sent");
/// ```
#[derive(Debug, Clone)]
pub struct Grant(Arc<GrantState>);

#[derive(Debug)]
struct GrantState {
    highest: AtomicU8,
    /// Called before each motion is sent.
    on_motion: OnceLock<Hook>,
}

struct Hook(Box<dyn Fn() + Send + Sync>);

impl fmt::Debug for Hook {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Hook")
    }
}

/// A request above the authorized risk. Nothing was sent.
///
/// Example: [`Grant`]
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what} ({}) is not authorized; nothing was sent", .risk.name())]
pub struct NotAuthorized {
    /// Name of the request.
    pub what: String,
    /// Risk of the request.
    pub risk: Risk,
}

const RISKS: [Risk; 4] = [Risk::Read, Risk::Write, Risk::Destroy, Risk::Motion];

impl Grant {
    /// Authorizes this risk and everything below it.
    pub fn up_to(risk: Risk) -> Self {
        Self(Arc::new(GrantState { highest: AtomicU8::new(risk as u8), on_motion: OnceLock::new() }))
    }

    /// The highest authorized risk.
    pub fn get(&self) -> Risk {
        let highest = self.0.highest.load(Ordering::Relaxed);
        RISKS.into_iter().rev().find(|risk| *risk as u8 <= highest).unwrap_or(Risk::Read)
    }

    /// Raises the limit. A lower risk than the current limit has no effect.
    pub fn raise(&self, risk: Risk) {
        self.0.highest.fetch_max(risk as u8, Ordering::Relaxed);
    }

    /// Checks one request. The client calls this function directly before it sends the request. If the request is an
    /// authorized motion, the motion hook is called.
    pub fn check(&self, risk: Risk, what: &str) -> Result<(), NotAuthorized> {
        if risk > self.get() {
            return Err(NotAuthorized { what: what.to_owned(), risk });
        }
        if let Some(Hook(hook)) = self.0.on_motion.get().filter(|_| risk == Risk::Motion) {
            hook();
        }
        Ok(())
    }

    /// Sets the hook that runs before each motion is sent. Only the first hook is kept; later calls have no effect.
    pub fn on_motion(&self, hook: impl Fn() + Send + Sync + 'static) {
        let _ = self.0.on_motion.set(Hook(Box::new(hook)));
    }
}

impl Default for Grant {
    /// Authorizes reads only.
    fn default() -> Self {
        Self::up_to(Risk::Read)
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
