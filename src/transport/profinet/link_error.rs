//! Conversion of PROFINET errors to [`LinkError`]: cause, advice, and URL options that may be wrong.

use super::error::ProfinetError;
use crate::image::{Cause, LinkError};

/// Advice to get the Linux capability that raw Ethernet needs.
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
                "check the name with `armctl robots discover`; check the cable; check that the unit of the controller \
                 is on",
            )),
            E::Duplicate { .. } => Self::Silent(cause.advice("set another name on one of the two stations")),
            E::NoAddress(_) => Self::Silent(
                cause.advice("set an address with the tool that sets station names, or with ip= in the target"),
            ),
            E::AddressConflict { .. } => Self::Silent(cause.advice("set another address on one of the two stations")),
            E::OtherNetwork { .. } => Self::Settings(cause.advice(
                "set an address of this computer in the device's network, or the address of the device with ip=",
            )),
            E::Dcp { .. } => Self::Refused(cause.options(&["ip"])),
            E::NoAnswer { .. } => {
                Self::Silent(cause.advice(
                    "check that no firewall drops UDP port 34964, and that no other controller uses the device",
                ))
            }
            E::Refused { status, .. } if status.is_owned() => Self::Owned(cause.advice(
                "stop that controller first: remove the device from the PLC's project, or close the session of the \
                 device. A device sends its signals only to its controller",
            )),
            E::Refused { .. } => Self::Refused(cause.options(MODULES)),
            E::Rejected { .. } => Self::Refused(cause),
            E::Malformed { .. } | E::Senseless { .. } => {
                Self::Malformed(cause.advice("check that a PROFINET IO device has this name"))
            }
            E::Modules(_) => Self::Size(cause.options(MODULES)),
            E::NeverReady(_) => Self::Refused(
                cause
                    .options(MODULES)
                    .advice("check the data lengths and the parameters: a wrong value usually causes this error"),
            ),
            E::NoData { .. } | E::Unusable(_) => Self::Refused(cause.advice("check the state of the controller")),
            E::Silent(_) | E::Aborted(_) | E::Plugged(_) | E::AlarmUnanswered => Self::Silent(cause.options(TIMES)),
            E::Impossible(_) => Self::Settings(cause),
            E::NoInterface { present, .. } if present.is_empty() => {
                Self::Settings(cause.advice("add an Ethernet interface: this computer has none"))
            }
            E::NoInterface { present, .. } => {
                Self::Settings(cause.advice(format!("use one of {}", present.join(", "))))
            }
            E::Platform => Self::Local(cause.advice("run armctl on a Linux computer in the network of the controller")),
            E::Privilege => Self::Local(cause.advice(PRIVILEGE)),
            E::Interface { .. } => Self::Local(cause.advice("check the cable and the settings of the interface")),
            E::PortTaken(_) => {
                Self::Silent(cause.advice("close the other program; find it with `ss -lunp sport = 34964`"))
            }
            E::Outdated | E::Ended | E::Local(_) => {
                Self::Local(cause.advice("check the network settings of this computer"))
            }
        }
    }
}
