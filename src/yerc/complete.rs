//! Completion candidates for arguments.

use futures_util::FutureExt as _;

use armctl_controller::names::Kind;
use armctl_frame::settings::target::Family;
use armctl_frame::value_kind::{Ask, Named, rows, text};
use armctl_frame::{Candidate, ValueKind};

/// A job on the controller.
pub const JOB: ValueKind = ValueKind::FromRobot(Family::Yerc, |robot| jobs(robot).boxed_local());
/// A file on the controller.
pub const FILE: ValueKind = ValueKind::FromRobot(Family::Yerc, |robot| files(robot).boxed_local());
/// The name of a variable, or the prefix of a variable reference: `B`.
pub const VARIABLE: ValueKind = ValueKind::Named(
    Family::Yerc,
    Named {
        kinds: &[Kind::Variable],
        endings: &[""],
        listed: || VARIABLES.map(|(letters, about)| Candidate::new(letters, about).incomplete()).into(),
    },
);
/// A variable, and the start of an assignment.
pub const VARIABLE_VALUE: ValueKind = ValueKind::Named(
    Family::Yerc,
    Named {
        kinds: &[Kind::Variable],
        endings: &["="],
        listed: || VARIABLES.map(|(letters, about)| Candidate::new(letters, about).incomplete()).into(),
    },
);
/// The name of a signal.
pub const SIGNAL: ValueKind = named(&[Kind::Signal], &[""]);
/// The name of a signal, and the state to set.
pub const SIGNAL_STATE: ValueKind = named(&[Kind::Signal], &["=on", "=off"]);
/// The name of a register.
pub const REGISTER: ValueKind = named(&[Kind::Register], &[""]);
/// The name of a register, and the start of an assignment.
pub const REGISTER_VALUE: ValueKind = named(&[Kind::Register], &["="]);

const fn named(kinds: &'static [Kind], endings: &'static [&'static str]) -> ValueKind {
    ValueKind::Named(Family::Yerc, Named { kinds, endings, listed: Vec::new })
}

/// Prefixes of variable references.
const VARIABLES: [(&str, &str); 8] = [
    ("B", "byte"),
    ("I", "integer, 16 bits"),
    ("D", "double-precision integer, 32 bits"),
    ("R", "real"),
    ("S", "string"),
    ("P", "position of a robot"),
    ("BP", "position of a base axis"),
    ("EX", "position of a station axis"),
];

async fn jobs(robot: &dyn Ask) {
    for (name, _) in files_of(robot, "jbi").await {
        robot.add_candidate(Candidate::new(name.strip_suffix(".JBI").unwrap_or(&name), ""));
    }
}

async fn files(robot: &dyn Ask) {
    for kind in ["jbi", "dat", "cnd", "prm", "sys", "lst"] {
        for (name, kind) in files_of(robot, kind).await {
            robot.add_candidate(Candidate::new(name, kind));
        }
    }
}

/// Names and types of the files on the controller.
async fn files_of(robot: &dyn Ask, kind: &str) -> Vec<(String, String)> {
    let data = robot.data(&["yerc", "file", "list", "--type", kind]).await;
    rows(data.as_ref(), "files").map(|file| (text(file, "name"), text(file, "type"))).collect()
}
