//! Candidates for arguments.

use futures_util::FutureExt as _;

use crate::command::frame::kind::{Ask, rows, text};
use crate::command::{Candidate, ValueKind};
use crate::settings::target::Family;

/// A job of the controller.
pub const JOB: ValueKind = ValueKind::Asked(Family::Yerc, |robot| jobs(robot).boxed_local());
/// A file of the controller.
pub const FILE: ValueKind = ValueKind::Asked(Family::Yerc, |robot| files(robot).boxed_local());
/// The beginning of a reference to variables: `B`.
pub const VARIABLE: ValueKind =
    ValueKind::Listed(|| VARIABLES.map(|(letters, about)| Candidate::new(letters, about).begun()).into());

/// What references to variables begin with.
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
        robot.tell(Candidate::new(name.strip_suffix(".JBI").unwrap_or(&name), ""));
    }
}

async fn files(robot: &dyn Ask) {
    for kind in ["jbi", "dat", "cnd", "prm", "sys", "lst"] {
        for (name, kind) in files_of(robot, kind).await {
            robot.tell(Candidate::new(name, kind));
        }
    }
}

/// Names and types.
async fn files_of(robot: &dyn Ask, kind: &str) -> Vec<(String, String)> {
    let data = robot.data(&["yerc", "file", "list", "--type", kind]).await;
    rows(data.as_ref(), "files").map(|file| (text(file, "name"), text(file, "type"))).collect()
}
