//! `armctl session close`: closes sessions, and waits until they are closed.

use super::list::locations;
use crate::command::families;
use armctl_frame::interrupt::catch_interrupts;
use armctl_frame::prelude::*;
use armctl_frame::prompt::ask;
use armctl_frame::session_client::{attach_failure, folder_failure, identify};
use armctl_frame::settings::target::Target;
use armctl_transport::session::client::{AttachError, close};
use armctl_transport::session::location::SessionPath;
use armctl_transport::session::wire::Info;

/// Arguments of `session close`.
#[derive(Debug, Args)]
pub struct Close {
    /// Robots whose sessions to close, by name or target URL; -r, -t and --all also select robots
    #[arg(add = ValueKind::Session)]
    names: Vec<String>,
    /// Close even while a motion runs; the controller then stops the motion
    #[arg(long)]
    force: bool,
}

/// Result of `session close`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Closed {
    sessions: Vec<Session>,
    #[serde(skip)]
    failure: Option<Failure>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Session {
    robot: String,
    family: String,
    target: String,
    /// `closed`, `forgotten` (its process had died) or `open` (it could not be closed).
    became: &'static str,
}

/// Session that the user chooses; `None` without sessions or without a terminal.
async fn choose(run: &Run) -> Result<Option<String>> {
    if !run.screen.can_choose() {
        return Ok(None);
    }
    let open: Vec<Info> = locations()?.iter().filter_map(SessionPath::owner).collect();
    if open.is_empty() {
        return Ok(None);
    }
    let options: Vec<String> = open.iter().map(|info| format!("{}  {}", info.robot, info.target)).collect();
    let screen = run.screen;
    let question = "session to close (type to search, Enter selects, Esc cancels)";
    catch_interrupts();
    let at = ask(screen, move || screen.ask_one_of(question, &options, false)).await?;
    let robot = open.into_iter().nth(at).map(|info| info.robot);
    if let Some(robot) = &robot {
        screen.note_command("the same command without the question:", &format!("armctl session close {robot}"));
    }
    Ok(robot)
}

/// What the controller does at the end of this session.
fn end_effect(run: &Run, info: &Info) -> Option<String> {
    let (target, family) = (info.target.parse().ok()?, info.family.parse().ok()?);
    let robot = run.sources.at(&target, family).ok()?;
    (families::driver(&robot).end_effect)(&robot)
}

impl Close {
    pub(super) async fn run(self, run: &Run) -> Result<(), RunError> {
        let selection = &run.sources.selection;
        let mut names: Vec<&str> = self.names.iter().chain(&selection.robots).map(String::as_str).collect();
        let target = selection.target.as_ref().map(ToString::to_string);
        names.extend(target.as_deref());
        if selection.sim {
            names.push("sim:");
        }
        let chosen = if names.is_empty() && !selection.all { choose(run).await? } else { None };
        names.extend(chosen.as_deref());
        if names.is_empty() && !selection.all {
            return Err(Failure::usage("no session selected")
                .hint(
                    "select a robot, or close all sessions with --all; use `armctl session list` to list the sessions",
                )
                .into());
        }
        let mut selected = if target.is_some() { run.sources.robots(None).unwrap_or_default() } else { Vec::new() };
        for robot in &mut selected {
            // A robot that does not answer is identified by the typed address.
            let _ = identify(&run.sources, families::driver(robot), robot, false);
        }
        let is_named = |info: &Info, name: &str| {
            let is_meant =
                |robot: &Robot| info.target.parse::<Target>().is_ok_and(|held| robot.has_address(&held.address()));
            is_named(info, name) || target.as_deref() == Some(name) && selected.iter().any(is_meant)
        };
        let found: Vec<(SessionPath, Info)> =
            locations()?.into_iter().filter_map(|location| Some((location.clone(), location.owner()?))).collect();
        for name in &names {
            if !found.iter().any(|(_, info)| is_named(info, name)) {
                let open_names = found.iter().map(|(_, info)| info.robot.as_str());
                let failure = Failure::usage(format!("no session of '{name}' is open"));
                return Err(match nearest(name, open_names) {
                    Some(near) => failure.hint(format!("did you mean '{near}'?")),
                    None => failure.hint("use `armctl session list` to list the open sessions"),
                }
                .into());
            }
        }
        let mut closed = Closed { sessions: Vec::new(), failure: None };
        for (location, info) in found {
            if selection.all || names.iter().any(|name| is_named(&info, name)) {
                let label = format!("{} ({})", info.robot, info.target);
                let became = match close(&location, self.force).await {
                    Ok(true) => {
                        if let Some(effect) = end_effect(run, &info) {
                            run.screen.note(&format!("{label}: the session is closed. {effect}"));
                        }
                        "closed"
                    }
                    Ok(false) => {
                        location.clear().map_err(|error| folder_failure(&error))?;
                        "forgotten"
                    }
                    Err(error) => {
                        closed.failure.get_or_insert(still_open(&label, &error));
                        "open"
                    }
                };
                let Info { robot, family, target, .. } = info;
                closed.sessions.push(Session { robot, family, target, became });
            }
        }
        match closed.failure.take_if(|_| closed.sessions.len() == 1) {
            Some(failure) => Err(failure.into()),
            None => run.local("session.close", &closed),
        }
    }
}

fn is_named(info: &Info, name: &str) -> bool {
    info.robot == name || info.target == name || info.target.split_once("://").is_some_and(|(_, bare)| bare == name)
}

fn still_open(label: &str, error: &AttachError) -> Failure {
    match error {
        AttachError::Refused(why) => Failure::new(Kind::Rejected, format!("{label}: the session stays open: {why}"))
            .hint(
                "wait for the end of the motion, or stop the robot; with --force the session closes now, and the \
                 controller stops the motion",
            ),
        _ => attach_failure(label, error),
    }
}

impl Report for Closed {
    fn view(&self) -> View {
        let mut table = Table::new(&["robot", "family", "target", "result"], "no open session");
        for session in &self.sessions {
            table.row([
                session.robot.as_str().into(),
                session.family.as_str().into(),
                session.target.as_str().into(),
                session.became.into(),
            ]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
