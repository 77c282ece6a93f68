//! Client side of sessions: finds the session that has the link of a robot, and connects to it.

use jiff::Timestamp;
use jiff::tz::TimeZone;
use tokio::time::timeout;

use crate::prelude::basics::*;
use crate::settings::target::{self, Address, Target};
use crate::settings::{Sessions, Sources};
use crate::{Access, Driver};
use armctl_transport::session::client::{self, AttachError, AttachResult, Attached, SessionBusy};
use armctl_transport::session::location::{self, Claim, LocationError, SessionFolder, SessionPath, key};
use armctl_transport::session::process;
use armctl_transport::session::wire::{Info, Peer, Purpose};

/// Returns the session of the robot, if one is open and `--no-session` is not set.
pub async fn attach(robot: &Robot, access: &Access, screen: &Screen) -> Result<Option<Box<Attached>>> {
    let attached = find_session(robot, access, screen).await?;
    if attached.is_none() && robot.sessions == Sessions::Only {
        let failure = Failure::new(Kind::NoAnswer, format!("{}: no session is open", robot.label()));
        return Err(failure.hint("open a session with `armctl session open`"));
    }
    Ok(attached)
}

/// Access to a controller that accepts only one client.
pub enum LockResult {
    /// Through the session of the controller.
    Session(Box<Attached>),
    /// Through a link of this process. While the claim exists, no other process of this computer opens a link.
    Own(Option<Claim>),
}

/// Returns the session of a link that accepts only one client, or the claim to open the link. If another command has
/// the claim, waits a short time for it.
pub async fn lock_or_attach(robot: &Robot, access: &Access, screen: &Screen) -> Result<LockResult> {
    loop {
        if let Some(attached) = attach(robot, access, screen).await? {
            return Ok(LockResult::Session(attached));
        }
        // A stop must not wait, and a simulator in this process has no other clients.
        let is_alone = robot.target.value.is_simulated() || robot.sessions == Sessions::None || access.is_stop;
        // Without a session folder, processes cannot coordinate their links.
        let Some(place) = (if is_alone { None } else { SessionFolder::create().ok() }) else {
            return Ok(LockResult::Own(None));
        };
        let location = place.location(&session_key(robot));
        match location.lock_or_attach(&info(robot, access)).await {
            Ok(location::LockResult::Locked(claim)) => return Ok(LockResult::Own(Some(claim))),
            Ok(location::LockResult::Session) => {}
            Ok(location::LockResult::Busy) => return Err(in_use(robot, &location)),
            Err(_) => return Ok(LockResult::Own(None)),
        }
    }
}

/// Information about this process, for other processes that wait for its link.
pub fn info(robot: &Robot, access: &Access) -> Info {
    Info::own(&robot.name, robot.family.name(), robot.target.value.url(), &command_line(access))
}

/// Failure: another command uses the link.
pub fn in_use(robot: &Robot, location: &SessionPath) -> Failure {
    let process = location.owner().map_or_else(
        || "another process".to_owned(),
        |Info { pid, command, .. }| format!("process {pid} (`{command}`)"),
    );
    Failure::new(
        Kind::NoAnswer,
        format!("{}: the controller accepts one client, and {process} is connected", robot.label()),
    )
    .hint("wait until that process ends, or use `armctl session open` first, so that commands share the connection")
}

async fn find_session(robot: &Robot, access: &Access, screen: &Screen) -> Result<Option<Box<Attached>>> {
    if robot.sessions == Sessions::None || access.dry_run {
        return Ok(None);
    }
    let bypasses_session = access.is_stop && matches!(robot.target.value.place, target::Place::Udp(_));
    let limit = if bypasses_session { STOP_TIMEOUT } else { Duration::MAX };
    let purpose = match access {
        Access { is_stop: true, .. } => Purpose::Stop,
        Access { leaves_motion: true, .. } => Purpose::LeavesMotion,
        _ => Purpose::Any,
    };
    let typed = command_line(access);
    let attaching = async {
        match access.session.as_ref().filter(|own| own.key == own_key(robot)) {
            Some(own) => client::attach_in_process(&own.host, &typed, purpose).await,
            None => client::attach(&session_key(robot), &typed, purpose).await,
        }
    };
    let attached = match timeout(limit, attaching).await.unwrap_or(Err(AttachError::Silent)) {
        Ok(AttachResult::Session(attached)) => attached,
        Ok(AttachResult::Nothing) => return Ok(None),
        Ok(AttachResult::Dead) => {
            let open = "use `armctl session open` to open a new session, or `armctl session close` to remove the old \
                        session";
            screen.note(&format!(
                "{}: the session process has ended, so the command runs without a session; {open}",
                robot.label()
            ));
            return Ok(None);
        }
        // armctl does not use a session folder that belongs to another user. The user may expect a session, so the note
        // says why there is none.
        Err(AttachError::Location(error @ LocationError::Unsafe { .. })) => {
            screen.note(&format!("warning: armctl does not use sessions: {error}"));
            return Ok(None);
        }
        // A controller on UDP accepts a stop from any client.
        Err(AttachError::Silent) if bypasses_session => {
            screen.note(&format!(
                "{}: {} does not respond, so armctl sends the stop directly",
                robot.label(),
                describe_owner(robot)
            ));
            return Ok(None);
        }
        Err(AttachError::Silent) => return Err(unresponsive_session(robot)),
        Err(error) => return Err(attach_failure(&robot.label(), &error)),
    };
    let welcome = &attached.welcome;
    if screen.verbosity > 0 {
        // Computing the local time takes longer than the rest of a status command, so it is done only for `-v`.
        let since = format_since(welcome.for_ms);
        let through = format!("through the session of process {}, open since {since}", welcome.pid);
        screen.detail(1, &format!("{}: {through}", robot.label()));
    }
    if let Some(leftover) = welcome.leftover.as_ref().filter(|leftover| leftover.died) {
        let peer = peer(&leftover.by);
        screen.note(&format!("{}: a client ended and left a command running: {peer}", robot.label()));
    }
    if let Some(why) = &welcome.down {
        screen.note(&format!(
            "{}: the session has lost its connection: {why}; the session connects again",
            robot.label()
        ));
    }
    if access.trace.as_deref().is_some_and(|path| path != Path::new("-")) {
        let missing = "to record packets and addresses, open the session with `armctl session open --trace FILE` \
                       (yrcx)";
        screen.note(&format!("{}: --trace records the messages of the session; {missing}", robot.label()));
    }
    Ok(Some(attached))
}

/// Time that a stop waits for a reply from the session. A running session replies within milliseconds.
const STOP_TIMEOUT: Duration = Duration::from_millis(300);

/// Process that has the link of a robot.
fn owner(robot: &Robot) -> Option<Info> {
    SessionFolder::find().ok().flatten()?.location(&session_key(robot)).owner()
}

fn describe_owner(robot: &Robot) -> String {
    owner(robot).map_or_else(|| "its session".to_owned(), |owner| format!("the session (process {})", owner.pid))
}

/// Failure: a session has the only link, but does not respond.
fn unresponsive_session(robot: &Robot) -> Failure {
    let failure =
        Failure::new(Kind::NoAnswer, format!("{}: {} does not respond", robot.label(), describe_owner(robot)));
    let Some(Info { pid, .. }) = owner(robot) else { return failure };
    failure.hint(if cfg!(windows) {
        format!("use `taskkill /F /PID {pid}` to end the process and free the connection")
    } else {
        format!(
            "use `kill -CONT {pid}` to continue the process if it is suspended, or `kill -KILL {pid}` to end the \
             process and free the connection"
        )
    })
}

/// Whether a session has the link of the robot, and commands can use this session.
pub fn is_held(robot: &Robot) -> bool {
    robot.sessions != Sessions::None
        && SessionFolder::find()
            .is_ok_and(|place| place.is_some_and(|place| place.location(&session_key(robot)).is_open()))
}

/// Whether a session of another process has the link of the robot, and commands can use this session.
pub fn is_held_by_other_process(robot: &Robot) -> bool {
    is_held(robot) && owner(robot).is_some_and(|owner| owner.pid != process())
}

/// Session key of the robot: its address, or the alias address with which its session was opened.
pub fn session_key(robot: &Robot) -> String {
    let own = own_key(robot);
    let Ok(Some(place)) = SessionFolder::find() else { return own };
    if robot.target.value.is_simulated() || place.location(&own).socket().exists() {
        return own;
    }
    let mut others = sessions(&place, robot.family).into_iter();
    others.find(|(_, address)| robot.has_address(address)).map_or(own, |(location, _)| location.key())
}

/// Sessions of a family, each with the address with which it was opened.
fn sessions(place: &SessionFolder, family: Family) -> Vec<(SessionPath, Address)> {
    // An unreadable folder counts as empty. When a session is opened there, the error is reported.
    let locations = place.locations().unwrap_or_default().into_iter();
    let owned = locations
        .filter_map(|location| Some((location.owner().filter(|owner| owner.family == family.name())?, location)));
    owned.filter_map(|(owner, location)| Some((location, owner.target.parse::<Target>().ok()?.address()))).collect()
}

/// Resolves all addresses of a robot from its network, if the robot may also have an address that matters here. Such an
/// address is the address of an open session. For a command that changes something, the address of a read-only robot
/// also matters.
///
/// # Errors
/// If the robot does not answer, so that its identity is unknown.
pub fn identify(sources: &Sources, driver: &Driver, robot: &mut Robot, changes: bool) -> Result<()> {
    let own = robot.target.value.address();
    let is_bound = changes && sources.read_only(robot.family).any(|(address, _)| own.may_match(&address));
    if is_bound || may_be_held(robot, &own) {
        robot.aliases = (driver.addresses)(robot)?;
        sources.apply_read_only(robot);
    }
    Ok(())
}

/// Whether a session that was opened with another address may have the link of the robot.
fn may_be_held(robot: &Robot, own: &Address) -> bool {
    let is_possible = own.has_aliases() && robot.sessions != Sessions::None;
    let place = if is_possible { SessionFolder::find().ok().flatten() } else { None };
    place.is_some_and(|place| {
        !place.location(&own_key(robot)).socket().exists()
            && sessions(&place, robot.family).iter().any(|(_, address)| own.may_match(address))
    })
}

/// Key of a session that is opened for the robot now.
pub fn own_key(robot: &Robot) -> String {
    let (family, url) = (robot.family.name(), robot.target.value.url());
    if let Some(address) = robot.target.value.address().key() {
        return key(family, &address);
    }
    if robot.sessions == Sessions::OwnSimulators && robot.target.value.is_simulated() {
        return key(family, &format!("{url} as {} in process {}", robot.name, process()));
    }
    key(family, url)
}

/// Command line to show to other clients that wait for the robot.
fn command_line(access: &Access) -> String {
    if let Some(typed) = &access.typed {
        return typed.to_string();
    }
    let mut words = std::env::args_os();
    let program = words.next().unwrap_or_default();
    let program = Path::new(&program).file_name().unwrap_or(&program).to_string_lossy().into_owned();
    let words = words.map(|word| word.to_string_lossy().into_owned());
    std::iter::once(program).chain(words).collect::<Vec<_>>().join(" ")
}

/// Failure for a session folder that cannot be used.
pub fn folder_failure(error: &LocationError) -> Failure {
    let failure = Failure::new(Kind::Local, format!("sessions: {error}"));
    match error {
        LocationError::Unsafe { path, .. } => {
            failure.hint(format!("remove {}, or set XDG_RUNTIME_DIR to your own folder", path.display()))
        }
        LocationError::Io { .. } => failure.hint("set XDG_RUNTIME_DIR to the folder for sessions"),
    }
}

/// Failure: a session exists, but cannot be used.
pub fn attach_failure(label: &str, error: &AttachError) -> Failure {
    let hint = "list sessions with `armctl session list`, or bypass the session with --no-session";
    let kind = match error {
        AttachError::Location(_) | AttachError::Io(_) => Kind::Local,
        AttachError::Silent | AttachError::Refused(_) => Kind::NoAnswer,
        AttachError::WrongVersion => Kind::Malformed,
    };
    Failure::new(kind, format!("{label}: {error}")).hint(hint)
}

/// Failure: the session is busy.
pub fn session_busy(label: &str, busy: &SessionBusy) -> Failure {
    match busy {
        SessionBusy::Ended(why) => Failure::new(Kind::NoAnswer, format!("{label}: {why}"))
            .hint("check the robot, then use `armctl session open` to open a new session"),
        SessionBusy::Busy(describe_owner) => {
            let who = describe_owner.as_ref().map_or_else(|| "another client".to_owned(), peer);
            Failure::new(Kind::NoAnswer, format!("{label}: the link is in use by {who}")).hint(
                "wait until that client ends; you can always stop the robot with `yrcx stop`, `toyo stop` or `yerc \
                 hold on`",
            )
        }
        SessionBusy::ReadOnly => {
            Failure::new(Kind::Rejected, format!("{label} is read-only: the session sent nothing")).hint(
                "use `armctl robots set NAME read_only=off` to allow changes, then close the session and open it \
                 again",
            )
        }
        SessionBusy::LocationChanged(describe_owner) => {
            let message =
                format!("{label}: another client is moving the robot: {}; nothing was sent", peer(describe_owner));
            Failure::new(Kind::Rejected, message).hint(
                "wait until that client ends; you can always stop the robot with `yrcx stop`, `toyo stop` or `yerc \
                 hold on`",
            )
        }
    }
}

/// Description of a client: its command and start time.
pub fn peer(peer: &Peer) -> String {
    format!("process {} (`{}`), since {}", peer.pid, peer.command, format_since(peer.for_ms))
}

/// Local time `for_ms` milliseconds ago.
pub fn format_since(for_ms: u64) -> String {
    let then = Timestamp::now().checked_sub(Duration::from_millis(for_ms)).unwrap_or(Timestamp::MIN);
    then.to_zoned(TimeZone::system()).strftime("%Y-%m-%d %H:%M:%S").to_string()
}
