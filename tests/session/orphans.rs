//! No motion continues without its operator. The process that moves a robot is killed or frozen: in every family, on
//! every bus, with every way to start the motion, directly and through a session. The session can end at the same time.

use std::io::Write as _;
use std::process::Command;

use super::{Running, Workspace, serve_simulator, stderr};
#[cfg(target_os = "linux")]
use crate::support::namespaces;
use crate::support::terminal::Terminal;

/// Signals that kill or freeze the process.
const SIGNALS: [&str; 2] = ["KILL", "STOP"];

/// A motion that takes about a minute.
struct Motion {
    family: &'static str,
    /// Arguments of the simulator, and the parameters that are added to its target.
    serve: &'static str,
    with: &'static str,
    words: &'static str,
    /// Text in the `-vv` output that appears when the robot moves.
    motion_state: &'static str,
    /// Command that reads the state, and a function that checks whether its report shows a robot that has stopped.
    state_command: &'static str,
    is_standing: fn(&serde_json::Value) -> bool,
}

const JOG: Motion = Motion {
    family: "toyo",
    serve: "toyo --bind 127.0.0.1:0",
    with: "",
    words: "toyo jog X + low --for 60s",
    motion_state: "",
    state_command: "toyo status",
    is_standing: |status| status["running"] == false,
};

/// A return to origin on a slow line. A jog is not suitable here: it prints its frames only at its end.
const HOME: Motion = Motion { words: "toyo home", motion_state: "-> @HOME", ..JOG };

const SERIAL: Motion = Motion { serve: "toyo --pty", ..HOME };

const MOVE: Motion = Motion {
    family: "yerc",
    serve: "yerc --bind 127.0.0.1:0",
    with: "",
    words: "yerc move relative --x 200 --speed 4mm/s",
    motion_state: "answer to 0x8a cartesian move: ok",
    state_command: "yerc status",
    is_standing: |status| status["held"] == true,
};

/// The timeouts are long, for a busy machine. The simulator itself reports the state.
const ETHERNET: Motion = Motion {
    family: "yrcx",
    serve: "yrcx --bind 127.0.0.1:0",
    with: "?rpi=5ms&multiplier=512",
    words: "yrcx move --to 900,0,0,0 --speed-of-max 0.1",
    motion_state: "<- WO 0100",
    state_command: "",
    is_standing: |_| false,
};

const DEVICENET: Motion = Motion { serve: "yrcx --bus devicenet", with: "", ..ETHERNET };

const PROFIBUS: Motion = Motion { serve: "yrcx --bus profibus", with: "", ..ETHERNET };

/// How a motion is started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StartKind {
    Direct,
    /// Together with a second robot.
    Several,
    Batch,
    Prompt,
}

/// Ways to start a motion, and whether a session of another process holds the links.
const START_KINDS: [(StartKind, bool); 7] = [
    (StartKind::Direct, false),
    (StartKind::Direct, true),
    (StartKind::Several, false),
    (StartKind::Batch, false),
    (StartKind::Batch, true),
    (StartKind::Prompt, false),
    (StartKind::Prompt, true),
];

/// Two robots `a` and `b`. Each has its own simulator.
fn two_robots(motion: &Motion) -> (Vec<Running>, Workspace) {
    let no_robots = Workspace::new(&[]);
    let simulators: Vec<_> = (0..2).map(|_| serve_simulator(&no_robots, motion.serve)).collect();
    let targets: Vec<_> = simulators.iter().map(|simulator| format!("{}{}", simulator.first, motion.with)).collect();
    let workspace = Workspace::new(&[("a", motion.family, &targets[0]), ("b", motion.family, &targets[1])]);
    (simulators, workspace)
}

/// Waits until the simulator itself reports that the robot has stopped. The alarm must show that the master is lost.
fn wait_until_stopped(simulator: &mut Running) {
    loop {
        writeln!(simulator.process.stdin.as_ref().unwrap(), "robot").unwrap();
        let now = simulator.line("now ");
        if !simulator.line("robot 1 ").contains("moving") {
            assert!(now.contains("alarm 12.5"), "{now}");
            return;
        }
    }
}

/// The process that moves a robot.
enum MovingProcess {
    Process(Running),
    Prompt(Box<Terminal>),
}

impl MovingProcess {
    fn start_motion(workspace: &Workspace, motion: &Motion, way: StartKind) -> Self {
        let file = workspace.folder.path().join("lines");
        std::fs::write(&file, format!("{}\n", motion.words)).unwrap();
        let words = match way {
            StartKind::Direct => format!("-r a {} --yes -vv", motion.words),
            StartKind::Several => format!("-r a -r b {} --yes -vv", motion.words),
            StartKind::Batch => format!("-r a batch {} --yes -vv", file.display()),
            StartKind::Prompt => {
                let mut command = workspace.command("-r a --yes -vv repl");
                command.env("TERM", "xterm-256color").env("LANG", "C.UTF-8");
                let mut prompt = Terminal::start(command, 200, 50).unwrap();
                prompt.wait_for_text("ends the prompt.");
                prompt.press(&format!("{}\r", motion.words));
                prompt.wait_for_text(motion.motion_state);
                return Self::Prompt(Box::new(prompt));
            }
        };
        let mut moving = Running::start(workspace.command(&words), false);
        if motion.motion_state.is_empty() {
            while (motion.is_standing)(&workspace.data(&format!("-r a {}", motion.state_command))) {}
        } else {
            for _ in 0..if way == StartKind::Several { 2 } else { 1 } {
                moving.wait_for_message(motion.motion_state);
            }
        }
        Self::Process(moving)
    }

    fn signal(&self, signal: &str) {
        match self {
            Self::Process(process) => process.signal(signal),
            Self::Prompt(prompt) => prompt.signal(signal),
        }
    }

    fn pid(&self) -> u32 {
        match self {
            Self::Process(process) => process.process.id(),
            Self::Prompt(prompt) => prompt.child.id(),
        }
    }

    /// Waits until the process has ended, and until no guardian remains that would stop the robot. The guardian of a
    /// session may remain. Returns the output.
    fn has_ended(self, workspace: &Workspace, session: Option<&Running>) -> String {
        let (code, said) = match self {
            // The guardian of the process has the same stderr. When stderr ends, both have ended.
            Self::Process(process) => process.end(),
            Self::Prompt(mut prompt) => (prompt.end().code(), String::from_utf8_lossy(&prompt.written).into_owned()),
        };
        assert_eq!(code, None, "it was killed: {said}");
        no_guardian(workspace, session);
        said
    }
}

/// Waits until no guardian of this user remains. The guardian of a session may remain.
fn no_guardian(workspace: &Workspace, session: Option<&Running>) {
    let home = format!("HOME={}", workspace.folder.path().display());
    let parent = session.map_or_else(|| "none".to_owned(), |session| format!("PPid:\t{}\n", session.process.id()));
    let is_guardian = |process: &std::path::Path| {
        let has = |file: &str, what: &str| {
            std::fs::read(process.join(file)).is_ok_and(|text| String::from_utf8_lossy(&text).contains(what))
        };
        has("cmdline", "--guardian=") && has("environ", &home) && !has("status", &parent)
    };
    while std::fs::read_dir("/proc").unwrap().any(|process| is_guardian(&process.unwrap().path())) {}
}

fn wait_for_stop(motion: &Motion, signals: &[&str], ways: &[(StartKind, bool)]) {
    for signal in signals {
        for &(way, in_session) in ways {
            let (mut simulators, workspace) = two_robots(motion);
            let session = in_session.then(|| Running::session(&workspace, "a"));
            let moving = MovingProcess::start_motion(&workspace, motion, way);
            moving.signal(signal);
            let messages = moving.has_ended(&workspace, session.as_ref());
            assert_eq!(*signal == "STOP", messages.contains("did not respond for 2 s"), "{way:?}: {messages}");
            if let Some(mut session) = session {
                session.wait_for_message("the client moved the robot");
                session.wait_for_message("the robot was stopped");
                if motion.family == "yrcx" {
                    workspace.until(|session| session["under_way"] == false);
                    continue;
                }
                // `session` is dropped here. The session process then ends, and its link with it.
            }
            let robots: &[_] = if way == StartKind::Several { &["a", "b"] } else { &["a"] };
            for (robot, simulator) in robots.iter().zip(&mut simulators) {
                if motion.family == "yrcx" {
                    wait_until_stopped(simulator);
                    continue;
                }
                let state = workspace.data(&format!("-r {robot} {}", motion.state_command));
                assert!((motion.is_standing)(&state), "{signal} {way:?} {in_session}: {robot}: {state}");
            }
        }
    }
}

#[test]
fn stops_the_jog_of_a_killed_or_frozen_process() {
    wait_for_stop(&JOG, &SIGNALS, &[(StartKind::Direct, true)]);
}

#[test]
fn stops_the_origin_return_of_a_killed_process() {
    wait_for_stop(&HOME, &SIGNALS, &START_KINDS[..2]);
    wait_for_stop(&HOME, &SIGNALS[..1], &START_KINDS[2..]);
}

#[test]
fn stops_a_serial_motion_of_a_killed_or_frozen_process() {
    wait_for_stop(&SERIAL, &SIGNALS, &START_KINDS[..2]);
    wait_for_stop(&SERIAL, &SIGNALS[..1], &START_KINDS[2..]);
}

#[test]
fn stops_the_move_of_a_killed_or_frozen_process() {
    wait_for_stop(&MOVE, &SIGNALS, &START_KINDS[..2]);
    wait_for_stop(&MOVE, &SIGNALS[..1], &START_KINDS[2..]);
}

/// Outside a session, the guardian does not stop a yrcx: the adapter stops it when its master is lost.
#[test]
fn yrcx_stops_if_its_master_or_client_is_killed_or_frozen() {
    wait_for_stop(&ETHERNET, &SIGNALS, &START_KINDS[..2]);
    wait_for_stop(&ETHERNET, &SIGNALS[..1], &START_KINDS[2..]);
}

#[test]
fn yrcx_on_devicenet_stops_if_its_master_or_client_is_killed_or_frozen() {
    wait_for_stop(&DEVICENET, &SIGNALS, &START_KINDS[..2]);
    wait_for_stop(&DEVICENET, &SIGNALS[..1], &START_KINDS[2..]);
}

#[test]
fn yrcx_on_profibus_stops_if_its_master_or_client_is_killed_or_frozen() {
    wait_for_stop(&PROFIBUS, &SIGNALS, &START_KINDS[..2]);
    wait_for_stop(&PROFIBUS, &SIGNALS[..1], &START_KINDS[2..]);
}

/// The session process ends, alone or together with the process that moves the robot.
#[test]
fn stops_a_motion_when_its_session_process_ends() {
    for motion in [&MOVE, &HOME, &SERIAL] {
        for (holder, client) in [("KILL", "KILL"), ("KILL", ""), ("STOP", ""), ("TERM", ""), ("STOP", "KILL")] {
            let (_simulators, workspace) = two_robots(motion);
            let session = Running::session(&workspace, "a");
            let moving = MovingProcess::start_motion(&workspace, motion, StartKind::Direct);
            let (session_id, moving_id) = (session.process.id(), moving.pid());
            // One `kill` command gets both ids: if only one process were killed first, the other process would end by
            // itself.
            let kill = |signal: &str, pids: &[u32]| {
                let pids = pids.iter().map(u32::to_string);
                assert!(Command::new("kill").args(["-s", signal]).args(pids).status().unwrap().success());
            };
            if holder == client {
                kill(holder, &[moving_id, session_id]);
            } else {
                kill(holder, &[session_id]);
                if !client.is_empty() {
                    kill(client, &[moving_id]);
                }
            }
            let (code, said) = session.end();
            assert_eq!(code, (holder == "TERM").then_some(0), "{said}");
            let MovingProcess::Process(process) = moving else { unreachable!() };
            let (code, said) = process.end();
            assert_ne!(code, Some(0), "{holder} {client}: {said}");
            no_guardian(&workspace, None);
            let state = workspace.data(&format!("-r a --no-session {}", motion.state_command));
            assert!((motion.is_standing)(&state), "{holder} {client}: {}: {state}", motion.words);
        }
    }
}

#[test]
fn background_session_logs_the_result_of_a_stop() {
    let (_simulators, workspace) = two_robots(&MOVE);
    workspace.data("-r a session open --background");
    let moving = MovingProcess::start_motion(&workspace, &MOVE, StartKind::Direct);
    moving.signal("KILL");
    let log = workspace.files("log").remove(0);
    while !std::fs::read_to_string(&log).unwrap().contains(": the robot was stopped\n") {}
}

/// An update removes the program file while the program moves a robot.
#[test]
fn removed_program_file_does_not_prevent_the_stop() {
    for in_session in [false, true] {
        let (_simulators, mut workspace) = two_robots(&MOVE);
        let copy = workspace.folder.path().join("armctl");
        std::fs::copy(&workspace.program, &copy).unwrap();
        let installed = std::mem::replace(&mut workspace.program, copy.clone());
        let session = in_session.then(|| Running::session(&workspace, "a"));
        let moving = MovingProcess::start_motion(&workspace, &MOVE, StartKind::Direct);
        workspace.program = installed;
        std::fs::remove_file(copy).unwrap();
        moving.signal("KILL");
        let said = moving.has_ended(&workspace, session.as_ref());
        assert!(!said.contains("may still move"), "{said}");
        if let Some(mut session) = session {
            session.wait_for_message("the robot was stopped");
        }
        assert_eq!(workspace.data("-r a yerc status")["held"], true, "in a session: {in_session}");
    }
}

/// After a normal end, the guardian sends no additional stop: HOLD stays off.
#[test]
fn does_not_stop_a_finished_motion() {
    let (_simulators, workspace) = two_robots(&MOVE);
    let moved = workspace.run("-r a yerc move relative --x 1 --speed 100mm/s --yes");
    assert!(moved.status.success(), "{}", stderr(&moved));
    // The guardian keeps stderr open. The test has read stderr to its end, so the guardian has ended.
    assert_eq!(workspace.data("-r a yerc status")["held"], false);
}

#[test]
fn move_with_on_interrupt_leave_continues_after_a_kill() {
    for in_session in [false, true] {
        let (_simulators, workspace) = two_robots(&MOVE);
        let mut session = in_session.then(|| Running::session(&workspace, "a"));
        let words = format!("-r a {} --on-interrupt leave --yes -vv", MOVE.words);
        let mut moving = Running::start(workspace.command(&words), false);
        moving.wait_for_message(MOVE.motion_state);
        moving.signal("KILL");
        assert_eq!(moving.end().0, None);
        if let Some(session) = &mut session {
            session.wait_for_message("the client moved the robot");
        }
        let status = workspace.data("-r a yerc status");
        assert_eq!((&status["held"], &status["running"]), (&false.into(), &true.into()), "{status}");
    }
}

/// Keys that end or suspend the process stop the robot, as Ctrl-C does.
#[test]
fn terminal_signals_stop_the_motion() {
    for signal in ["QUIT", "TSTP"] {
        for motion in [&MOVE, &JOG] {
            let (_simulators, workspace) = two_robots(motion);
            let _session = Running::session(&workspace, "a");
            let MovingProcess::Process(moving) = MovingProcess::start_motion(&workspace, motion, StartKind::Direct)
            else {
                unreachable!()
            };
            moving.signal(signal);
            let (code, said) = moving.end();
            assert_eq!(code, Some(130), "{signal} {}: {said}", motion.words);
            assert!(said.contains("the robot was stopped"), "{signal} {}: {said}", motion.words);
            let state = workspace.data(&format!("-r a {}", motion.state_command));
            assert!((motion.is_standing)(&state), "{signal} {}: {state}", motion.words);
        }
        let (_simulator, workspace) = super::cell_arguments();
        let _session = Running::session(&workspace, "cell");
        let moving = super::start_motion(&workspace);
        moving.signal(signal);
        let (code, said) = moving.end();
        assert!(code == Some(130) && said.contains("the robot was stopped"), "{signal}: {code:?}: {said}");
    }
}

/// On UDP, a controller accepts a stop from any client. Other commands report the process that holds the link.
#[test]
fn stop_bypasses_an_unresponsive_session() {
    for (motion, stop) in [(&MOVE, "yerc hold on"), (&JOG, "toyo stop")] {
        let (_simulators, workspace) = two_robots(motion);
        let session = Running::session(&workspace, "a");
        let pid = session.process.id();
        session.signal("STOP");
        let blocked_session = workspace.run(&format!("-r a {}", motion.state_command));
        assert_eq!(blocked_session.status.code(), Some(4), "{}", stderr(&blocked_session));
        for part in [format!("the session (process {pid}) does not respond"), format!("`kill -CONT {pid}`")] {
            assert!(stderr(&blocked_session).contains(&part), "{part}: {}", stderr(&blocked_session));
        }
        let stopped = workspace.run(&format!("-r a {stop}"));
        if motion.family == "yerc" {
            assert!(stopped.status.success(), "{}", stderr(&stopped));
            assert!(stderr(&stopped).contains("so armctl sends the stop directly"), "{}", stderr(&stopped));
            assert_eq!(workspace.data("-r a --no-session yerc status")["held"], true);
        } else {
            assert_eq!(stopped.status.code(), Some(4), "{}", stderr(&stopped));
            assert!(stderr(&stopped).contains(&format!("`kill -KILL {pid}`")), "{}", stderr(&stopped));
        }
        session.signal("CONT");
    }
}

/// A motion over PROFINET in its own network. The simulator must report that the robot has stopped, and the alarm.
#[cfg(target_os = "linux")]
const PROFINET: &str = r#"
export HOME="$FOLDER" XDG_RUNTIME_DIR="$FOLDER"
cd "$FOLDER"
URL='profinet://yrcx-sim@pc0?layout=0:1,0.0x8000:1/0x8000,0.0x8001:1/0x8001,1:0x101:i48,2:0x102:o48&watchdog=1900ms'
stands() {
  while :; do
    SAID=$(grep -c '^robot 1 ' machine)
    echo robot >&9
    while [ "$(grep -c '^robot 1 ' machine)" = "$SAID" ]; do :; done
    grep '^robot 1 ' machine | tail -n 1 | grep -q moving || break
  done
  grep '^now ' machine | tail -n 1
}
for SIGNAL in KILL STOP; do for WAY in direct session; do
  rm -f console sim machine opened session moves; mkfifo console
  $THERE "$ARMCTL" sim yrcx --bus profinet --interface pd0 --console < console > sim 2> machine & D=$!
  exec 9> console
  wait_for 'profinet://' sim $D
  if [ $WAY = session ]; then
    "$ARMCTL" -t "$URL" session open > opened 2> session & H=$!
    wait_for 'held by' opened $H
  fi
  "$ARMCTL" -t "$URL" --yes -vv yrcx move --to 900,0,0,0 --speed-of-max 0.1 > /dev/null 2> moves & P=$!
  wait_for '<- WO 0100' moves $P
  kill -s $SIGNAL $P
  wait $P
  if [ $WAY = session ]; then wait_for 'the robot was stopped' session $H; fi
  echo "$WAY $SIGNAL: $(stands)"
  if [ $WAY = session ]; then kill $H; wait $H; fi
  exec 9>&-
  kill $D; wait $D
done; done
"#;

#[cfg(target_os = "linux")]
#[test]
fn yrcx_on_profinet_stops_if_its_master_or_client_is_killed_or_frozen() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().to_str().unwrap();
    let variables = [("ARMCTL", env!("CARGO_BIN_EXE_armctl")), ("FOLDER", place)];
    let Some(said) = namespaces::run(PROFINET, &variables) else {
        println!("{}", namespaces::SKIPPED);
        return;
    };
    for signal in SIGNALS {
        assert!(
            said.lines()
                .any(|line| line.starts_with(&format!("direct {signal}: now ")) && line.contains("alarm 12.57")),
            "{said}"
        );
        assert!(said.lines().any(|line| line.starts_with(&format!("session {signal}: now "))), "{said}");
    }
}
