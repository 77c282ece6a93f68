//! `armctl session list`: open sessions and their clients.

use jiff::Timestamp;

use armctl_frame::prelude::*;
use armctl_frame::session_client::folder_failure;
use armctl_transport::session::client::{AttachError, status};
use armctl_transport::session::location::{SessionFolder, SessionPath};
use armctl_transport::session::wire::{Leftover, Peer, Status, VERSION};

/// Arguments of `session list`.
#[derive(Debug, Args)]
pub struct List {}

impl List {
    pub(super) async fn run(self, run: &Run) -> Result<(), RunError> {
        let mut sessions = Vec::new();
        for location in locations()? {
            sessions.push(Session::of(&location, status(&location).await));
        }
        sessions.sort_by(|one, other| one.robot.cmp(&other.robot));
        run.local("session.list", &Sessions { sessions })
    }
}

/// Locations of sessions, alive or dead.
pub fn locations() -> Result<Vec<SessionPath>> {
    match SessionFolder::find().and_then(|place| place.map_or(Ok(Vec::new()), |place| place.locations())) {
        Ok(locations) => Ok(locations),
        Err(error) => Err(folder_failure(&error)),
    }
}

/// The sessions of this user on this machine.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Sessions {
    sessions: Vec<Session>,
}

/// A session.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct Session {
    robot: String,
    family: String,
    target: String,
    /// Process of the session, also after its end.
    pid: u32,
    /// `up`, `down` (armctl reconnects), `silent` (the process does not answer) or `dead` (the process was killed).
    link: &'static str,
    /// Reason if the link is not `up`.
    why: Option<String>,
    /// Start time of the session.
    since: Option<String>,
    /// Number of reconnections.
    reopenings: u32,
    /// Processes that use the session now.
    clients: Vec<Client>,
    /// Process that moves the robot.
    motion: Option<Client>,
    /// Whether the controller reports a running motion (yrcx).
    under_way: bool,
    /// Process that did not wait for the end of its remote command.
    leftover: Option<DetachedMotion>,
}

/// A process that uses a session.
#[derive(Debug, Serialize, JsonSchema)]
struct Client {
    pid: u32,
    /// Its command line.
    command: String,
    since: String,
}

/// A process that did not wait for the end of its command.
#[derive(Debug, Serialize, JsonSchema)]
struct DetachedMotion {
    #[serde(flatten)]
    client: Client,
    /// Whether the process died. If not, the process ended without a wait, because the user requested this.
    died: bool,
}

impl Session {
    fn of(location: &SessionPath, found: Result<Option<Status>, AttachError>) -> Self {
        let (link, why) = match found {
            Ok(Some(status)) => return Self::living(status),
            Ok(None) => (
                "dead",
                "remove the session with `armctl session close`, or open it again with `armctl session open`"
                    .to_owned(),
            ),
            Err(error) => ("silent", error.to_string()),
        };
        let owner = location.owner();
        let (robot, family, target, pid) =
            owner.map_or_else(Default::default, |owner| (owner.robot, owner.family, owner.target, owner.pid));
        Self { robot, family, target, pid, link, why: Some(why), ..Self::default() }
    }

    fn living(status: Status) -> Self {
        let foreign = (status.version != VERSION)
            .then(|| "opened by another version of armctl; close the session and open it again".to_owned());
        Self {
            robot: status.info.robot,
            family: status.info.family,
            target: status.info.target,
            pid: status.info.pid,
            link: if status.down.is_some() { "down" } else { "up" },
            why: status.down.or(foreign),
            since: Some(local_time(status.for_ms)),
            reopenings: status.reopenings,
            clients: status.clients.into_iter().map(Client::from).collect(),
            motion: status.motion.map(Client::from),
            under_way: status.under_way,
            leftover: status.leftover.map(|Leftover { by, died }| DetachedMotion { client: by.into(), died }),
        }
    }

    /// Remark in addition to the columns.
    fn remarks(&self) -> String {
        let mut remarks = Vec::new();
        remarks.extend(self.why.clone());
        if self.reopenings > 0 {
            remarks.push(format!("reconnected {} times", self.reopenings));
        }
        if let Some(client) = &self.motion {
            remarks.push(format!("process {} moves the robot: {}", client.pid, client.command));
        } else if self.under_way {
            remarks.push("a motion runs".to_owned());
        }
        if let Some(DetachedMotion { client, died }) = &self.leftover {
            let how = if *died { "has died" } else { "did not wait for the end of its command" };
            remarks.push(format!("process {} {how}: {}", client.pid, client.command));
        }
        remarks.join("; ")
    }
}

impl From<Peer> for Client {
    fn from(peer: Peer) -> Self {
        Self { pid: peer.pid, command: peer.command, since: local_time(peer.for_ms) }
    }
}

fn local_time(for_ms: u64) -> String {
    let then = Timestamp::now().checked_sub(Duration::from_millis(for_ms)).unwrap_or(Timestamp::MIN);
    then.strftime("%Y-%m-%dT%H:%M:%SZ").to_string()
}

impl Report for Sessions {
    fn view(&self) -> View {
        let mut table = Table::new(
            &["robot", "family", "link", "process", "clients", "target", "remark"],
            "no open session; open one with `armctl session open -r NAME`",
        );
        for session in &self.sessions {
            let tone = if session.link == "up" { Tone::Good } else { Tone::Bad };
            table.row([
                session.robot.as_str().into(),
                session.family.as_str().into(),
                Cell::from(session.link).tone(tone),
                session.pid.into(),
                session.clients.len().into(),
                session.target.as_str().into(),
                session.remarks().into(),
            ]);
        }
        View::table(table)
    }
}
