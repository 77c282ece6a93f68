//! Conversion of PROFINET errors to [`LinkError`]: cause, advice, and URL options that can be wrong.

use super::error::ProfinetError;
use crate::image::{Cause, LinkError};

/// Advice for the Linux capability that raw Ethernet needs.
const PRIVILEGE: &str = "run `sudo setcap cap_net_raw+ep $(command -v armctl)`, or run armctl as root";
/// URL options for the modules of a device.
const MODULES: &[&str] = &["layout", "gsdml"];
/// URL options for the times of a connection.
const TIMES: &[&str] = &["cycle", "watchdog"];

impl From<ProfinetError> for LinkError {
    fn from(error: ProfinetError) -> Self {
        use ProfinetError as E;
        let code = error.status().map(|status| format!("{:#010x}", status.0));
        let cause = Cause { code, ..Cause::new(&error) };
        match error {
            E::NotFound { .. } => Self::Silent(cause.advice(
                "check the name with `armctl robots discover`, the cable, and that the unit of the controller is on",
            )),
            E::Duplicate { .. } => Self::Silent(cause.advice("give one of the two another name")),
            E::NoAddress { .. } => {
                Self::Silent(cause.advice("give it one where names are set, or name it with ip= in the target"))
            }
            E::AddressConflict { .. } => Self::Silent(cause.advice("give one of the two another address")),
            E::OtherNetwork { .. } => Self::Settings(
                cause.advice("give this machine an address in the device's network, or the device one with ip="),
            ),
            E::Dcp { .. } => Self::Refused(cause.options(&["ip"])),
            E::NoAnswer { .. } => Self::Silent(
                cause
                    .advice("check that no firewall drops UDP port 34964, and that no other controller has the device"),
            ),
            E::Refused { status, .. } if status.is_owned() => Self::Owned(cause.advice(
                "stop the other controller first: take the device out of the PLC's project, or close the session that holds it; \
                 a device shows its signals to its controller alone",
            )),
            E::Refused { .. } => Self::Refused(cause.options(MODULES)),
            E::Rejected { .. } => Self::Refused(cause),
            E::Malformed { .. } | E::Senseless { .. } => {
                Self::Malformed(cause.advice("check that an IO device of PROFINET has this name"))
            }
            E::Modules(_) => Self::Size(cause.options(MODULES)),
            E::NeverReady { .. } => Self::Refused(cause.options(MODULES).advice(
                "a device that takes everything and is never ready mostly has other data lengths, or wants parameters",
            )),
            E::NoData { .. } | E::Unusable(_) => {
                Self::Refused(cause.advice("check the state of the controller behind the device"))
            }
            E::Silent { .. } | E::Aborted(_) | E::Plugged { .. } | E::AlarmUnanswered => {
                Self::Silent(cause.options(TIMES))
            }
            E::Impossible(_) => Self::Settings(cause),
            E::NoInterface { present, .. } if present.is_empty() => {
                Self::Settings(cause.advice("there are no Ethernet interfaces here"))
            }
            E::NoInterface { present, .. } => Self::Settings(cause.advice(format!("there are {}", present.join(", ")))),
            E::Privilege => Self::Local(cause.advice(PRIVILEGE)),
            E::Interface { .. } => Self::Local(cause.advice("check the cable and the settings of the interface")),
            E::PortTaken { .. } => {
                Self::Silent(cause.advice("close the other program: `ss -lunp sport = 34964` shows which it is"))
            }
            E::Outdated | E::Ended | E::Local(_) => {
                Self::Local(cause.advice("check the network settings of this machine"))
            }
        }
    }
}
