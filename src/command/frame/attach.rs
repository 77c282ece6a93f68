//! Whether a session holds the link to a robot, and the way through it.

use std::path::Path;
use std::time::Duration;

use jiff::Timestamp;
use jiff::tz::TimeZone;
use tokio::time::timeout;

use crate::command::frame::{Access, Driver};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::target::{self, Address, Family, Target};
use crate::settings::{Robot, Sessions, Sources};
use crate::transport::session::client::{self, AttachError, Attached, Found, SessionBusy};
use crate::transport::session::place::{self, Claim, Place, PlaceError, Spot, key};
use crate::transport::session::process;
use crate::transport::session::wire::{Info, Peer, Purpose};

/// The session that holds the robot's link, if there is one and `--no-session` does not go around it.
pub async fn attach(robot: &Robot, access: &Access, screen: &Screen) -> Result<Option<Box<Attached>>, Failure> {
    let attached = attach_if_there(robot, access, screen).await?;
    if attached.is_none() && robot.sessions == Sessions::Only {
        let failure = Failure::new(Kind::NoAnswer, format!("{}: no session holds its link", robot.label()));
        return Err(failure.hint("`armctl session open` opens one"));
    }
    Ok(attached)
}

/// How a controller is reached that takes one client.
pub enum Turn {
    /// Through the session that holds its link.
    Session(Box<Attached>),
    /// By a link of this command's own; nobody else on this machine opens one as long as it has the claim.
    Own(Option<Claim>),
}

/// The session that holds a link which takes one client, or the turn to open it. Another command that has it is waited for,
/// but not for long.
pub async fn turn(robot: &Robot, access: &Access, screen: &Screen) -> Result<Turn, Failure> {
    loop {
        if let Some(attached) = attach(robot, access, screen).await? {
            return Ok(Turn::Session(attached));
        }
        // A stop waits for nobody, and a simulator in this process is nobody else's.
        let is_alone = robot.target.value.is_simulated() || robot.sessions == Sessions::None || access.is_stop;
        // Where there is no place for sessions, nobody knows of each other.
        let Some(place) = (if is_alone { None } else { Place::make().ok() }) else { return Ok(Turn::Own(None)) };
        let spot = place.spot(&key_of(robot));
        match spot.turn(&info(robot, access)).await {
            Ok(place::Turn::Mine(claim)) => return Ok(Turn::Own(Some(claim))),
            Ok(place::Turn::Session) => {}
            Ok(place::Turn::Taken) => return Err(in_use(robot, &spot)),
            Err(_) => return Ok(Turn::Own(None)),
        }
    }
}

/// What this process says of itself where it has the link to a robot to itself.
pub fn info(robot: &Robot, access: &Access) -> Info {
    Info::own(&robot.name, robot.family.name(), robot.target.value.url(), &command_line(access))
}

/// A command has the link, which takes one client, and keeps it.
pub fn in_use(robot: &Robot, spot: &Spot) -> Failure {
    let who = spot.owner().map_or_else(
        || "another process".to_owned(),
        |Info { pid, command, .. }| format!("process {pid} (`{command}`)"),
    );
    Failure::new(Kind::NoAnswer, format!("{}: its link takes one client, and {who} has it", robot.label()))
        .hint("wait for its end; with `armctl session open` before, commands share the link")
}

async fn attach_if_there(robot: &Robot, access: &Access, screen: &Screen) -> Result<Option<Box<Attached>>, Failure> {
    if robot.sessions == Sessions::None || access.dry_run {
        return Ok(None);
    }
    let goes_around = access.is_stop && matches!(robot.target.value.place, target::Place::Udp(_));
    let within = if goes_around { STOP_WAITS } else { Duration::MAX };
    let purpose = match access {
        Access { is_stop: true, .. } => Purpose::Stop,
        Access { leaves_motion: true, .. } => Purpose::LeavesMotion,
        _ => Purpose::Any,
    };
    let (key, typed) = (key_of(robot), command_line(access));
    let attaching = client::attach(&key, &typed, purpose);
    let attached = match timeout(within, attaching).await.unwrap_or(Err(AttachError::Silent)) {
        Ok(Found::Session(attached)) => attached,
        Ok(Found::Nothing) => return Ok(None),
        Ok(Found::Dead) => {
            let open = "`armctl session open` opens another one, `armctl session close` forgets it";
            screen.note(&format!("{}: its session has died, so this goes without it; {open}", robot.label()));
            return Ok(None);
        }
        // Somebody else's folder is none of ours: there is no session, but somebody may want one to be.
        Err(AttachError::Place(error @ PlaceError::Unsafe { .. })) => {
            screen.note(&format!("warning: sessions are not used: {error}"));
            return Ok(None);
        }
        // A controller on UDP takes the stop from anybody.
        Err(AttachError::Silent) if goes_around => {
            screen.note(&format!("{}: {} does not respond, so the stop goes without it", robot.label(), holder(robot)));
            return Ok(None);
        }
        Err(AttachError::Silent) => return Err(frozen(robot)),
        Err(error) => return Err(refused(&robot.label(), &error)),
    };
    let welcome = &attached.welcome;
    if screen.verbosity > 0 {
        // To find out about the time zone takes longer than all else that a status does.
        let since = since(welcome.for_ms);
        let through = format!("through the session of process {}, open since {since}", welcome.pid);
        screen.detail(1, &format!("{}: {through}", robot.label()));
    }
    if let Some(leftover) = welcome.leftover.as_ref().filter(|leftover| leftover.died) {
        let peer = peer(&leftover.by);
        screen.note(&format!("{}: a command was left under way by a client that has died: {peer}", robot.label()));
    }
    if let Some(why) = &welcome.down {
        screen.note(&format!("{}: the link of the session is down: {why}; it is being opened again", robot.label()));
    }
    if access.trace.as_deref().is_some_and(|path| path != Path::new("-")) {
        let missing = "packets and addresses are the session's (yrcx: `armctl session open --trace FILE`)";
        screen.note(&format!("{}: --trace records what passes through the session; {missing}", robot.label()));
    }
    Ok(Some(attached))
}

/// How long a stop waits for a session that does not respond. One that lives answers within milliseconds.
const STOP_WAITS: Duration = Duration::from_millis(300);

/// The process that holds the link of a robot.
fn owner(robot: &Robot) -> Option<Info> {
    Place::find().ok().flatten()?.spot(&key_of(robot)).owner()
}

fn holder(robot: &Robot) -> String {
    owner(robot).map_or_else(|| "its session".to_owned(), |owner| format!("its session (process {})", owner.pid))
}

/// The session has the link, which takes one client, and does not respond.
fn frozen(robot: &Robot) -> Failure {
    let failure = Failure::new(Kind::NoAnswer, format!("{}: {} does not respond", robot.label(), holder(robot)));
    let Some(Info { pid, .. }) = owner(robot) else { return failure };
    failure.hint(format!(
        "it may be suspended: `kill -CONT {pid}` lets it go on, `kill -KILL {pid}` ends it and frees the link"
    ))
}

/// Whether a session holds the robot's link, and commands may go through it.
pub fn is_held(robot: &Robot) -> bool {
    robot.sessions != Sessions::None
        && Place::find().is_ok_and(|place| place.is_some_and(|place| place.spot(&key_of(robot)).is_open()))
}

/// Whether a session of another process holds the robot's link, and commands may go through it.
pub fn is_held_by_another(robot: &Robot) -> bool {
    is_held(robot) && owner(robot).is_some_and(|owner| owner.pid != process())
}

/// What the robot's session is named by: by its address, or by the other one that a session was opened with.
pub fn key_of(robot: &Robot) -> String {
    let own = own_key(robot);
    let Ok(Some(place)) = Place::find() else { return own };
    if robot.target.value.is_simulated() || place.spot(&own).socket().exists() {
        return own;
    }
    let mut others = sessions(&place, robot.family).into_iter();
    others.find(|(_, address)| robot.is_at(address)).map_or(own, |(spot, _)| spot.key())
}

/// The sessions of a family, each with the address that it was opened with.
fn sessions(place: &Place, family: Family) -> Vec<(Spot, Address)> {
    // A folder that cannot be read has none; whoever opens one there is told.
    let spots = place.spots().unwrap_or_default().into_iter();
    let owned = spots.filter_map(|spot| Some((spot.owner().filter(|owner| owner.family == family.name())?, spot)));
    owned.filter_map(|(owner, spot)| Some((spot, owner.target.parse::<Target>().ok()?.address()))).collect()
}

/// Asks the network of a robot for all its addresses, where one of them may be that of a session, or of a read-only robot
/// that is to be changed: then it is that robot.
///
/// # Errors
/// When the robot does not answer, so that nobody knows which it is.
pub fn identify(sources: &Sources, driver: &dyn Driver, robot: &mut Robot, changes: bool) -> Result<(), Failure> {
    let own = robot.target.value.address();
    let is_bound = changes && sources.read_only(robot.family).any(|(address, _)| own.may_meet(&address));
    if is_bound || may_be_held(robot, &own) {
        robot.aliases = driver.addresses(robot)?;
        sources.bind(robot);
    }
    Ok(())
}

/// Whether there is a session that may hold it, and none of its very address.
fn may_be_held(robot: &Robot, own: &Address) -> bool {
    let place = if robot.sessions == Sessions::None { None } else { Place::find().ok().flatten() };
    place.is_some_and(|place| {
        !place.spot(&own_key(robot)).socket().exists()
            && sessions(&place, robot.family).iter().any(|(_, address)| own.may_meet(address))
    })
}

fn own_key(robot: &Robot) -> String {
    let (family, url) = (robot.family.name(), robot.target.value.url());
    if let Some(address) = robot.target.value.address().key() {
        return key(family, &address);
    }
    if robot.sessions == Sessions::OwnSimulators && robot.target.value.is_simulated() {
        return key(family, &format!("{url} as {} in process {}", robot.name, process()));
    }
    key(family, url)
}

/// What was typed, for others who want the same robot.
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

/// There is no place for sessions.
pub fn no_place(error: &PlaceError) -> Failure {
    let failure = Failure::new(Kind::Local, format!("sessions: {error}"));
    match error {
        PlaceError::Unsafe { path, .. } => {
            failure.hint(format!("remove {}, or set XDG_RUNTIME_DIR to a folder of your own", path.display()))
        }
        PlaceError::Io { .. } => failure.hint("XDG_RUNTIME_DIR names the folder that they are kept in"),
    }
}

/// A session that is there and is not used.
pub fn refused(label: &str, error: &AttachError) -> Failure {
    let hint = "`armctl session list` shows what there is; --no-session goes around it";
    let kind = match error {
        AttachError::Place(_) | AttachError::Io(_) => Kind::Local,
        AttachError::Silent | AttachError::Refused(_) => Kind::NoAnswer,
        AttachError::Foreign => Kind::Malformed,
    };
    Failure::new(kind, format!("{label}: {error}")).hint(hint)
}

/// What stands in the way within a session.
pub fn session_busy(label: &str, busy: &SessionBusy) -> Failure {
    match busy {
        SessionBusy::Ended(why) => Failure::new(Kind::NoAnswer, format!("{label}: {why}"))
            .hint("look at the robot; `armctl session open` opens another session"),
        SessionBusy::Busy(holder) => {
            let who = holder.as_ref().map_or_else(|| "another client".to_owned(), peer);
            Failure::new(Kind::NoAnswer, format!("{label}: the link is in use by {who}"))
                .hint("wait for its end; stops get through: `yrcx stop`, `toyo stop`, `yerc hold on`")
        }
        SessionBusy::ReadOnly => {
            Failure::new(Kind::Rejected, format!("{label} is read-only: its session passed nothing on")).hint(
                "it is so on purpose; where it may be changed: `armctl robots set NAME read_only=off`, then close the \
                 session and open it again",
            )
        }
        SessionBusy::Moved(holder) => {
            let message = format!("{label}: another client moves the robot: {}; nothing was sent", peer(holder));
            Failure::new(Kind::Rejected, message)
                .hint("wait for its end; stops get through: `yrcx stop`, `toyo stop`, `yerc hold on`")
        }
    }
}

/// Who, and since when.
pub fn peer(peer: &Peer) -> String {
    format!("process {} (`{}`), since {}", peer.pid, peer.command, since(peer.for_ms))
}

/// The moment so long ago, in the time of this machine.
pub fn since(for_ms: u64) -> String {
    let then = Timestamp::now().checked_sub(Duration::from_millis(for_ms)).unwrap_or(Timestamp::MIN);
    then.to_zoned(TimeZone::system()).strftime("%Y-%m-%d %H:%M:%S").to_string()
}
