//! `armctl session` with processes, sockets and signals. The tests wait for conditions, never for a fixed time.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod orphans;
mod shared;

use std::io::{BufRead as _, BufReader, Read as _};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// The environment of a user: an inventory and a runtime folder.
struct Workspace {
    folder: TempDir,
    program: PathBuf,
}

impl Workspace {
    /// Creates an inventory with these robots: name, family, target.
    fn new(robots: &[(&str, &str, &str)]) -> Self {
        let workspace = Self { folder: tempfile::tempdir().unwrap(), program: env!("CARGO_BIN_EXE_armctl").into() };
        let robots: Vec<String> = robots
            .iter()
            .map(|(name, family, target)| {
                format!("[[robot]]\nname = \"{name}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\n")
            })
            .collect();
        std::fs::write(workspace.folder.path().join("robots.toml"), robots.concat()).unwrap();
        std::fs::create_dir(workspace.folder.path().join("run")).unwrap();
        workspace
    }

    fn command(&self, words: &str) -> Command {
        let mut command = Command::new(&self.program);
        command.env_clear().env("HOME", self.folder.path()).env("XDG_RUNTIME_DIR", self.folder.path().join("run"));
        command.env("ARMCTL_CONFIG", self.folder.path().join("robots.toml")).stdin(Stdio::null());
        command.args(words.split(' '));
        command
    }

    fn run(&self, words: &str) -> Output {
        self.command(words).output().unwrap()
    }

    /// `data` of a command that must succeed.
    fn data(&self, words: &str) -> Value {
        let output = self.run(&format!("{words} --json"));
        assert!(output.status.success(), "{words}: {}", stderr(&output));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["data"].clone()
    }

    /// First session of the session list.
    fn listed_sessions(&self) -> Value {
        self.data("session list")["sessions"][0].clone()
    }

    /// Polls the first session until the condition is true.
    fn until(&self, condition: impl Fn(&Value) -> bool) -> Value {
        loop {
            let session = self.listed_sessions();
            if condition(&session) {
                return session;
            }
        }
    }

    /// Returns the session files with this extension.
    fn files(&self, extension: &str) -> Vec<PathBuf> {
        let Ok(found) = std::fs::read_dir(self.folder.path().join("run/armctl")) else { return Vec::new() };
        found
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|found| found == extension))
            .collect()
    }
}

impl Drop for Workspace {
    fn drop(&mut self) {
        // Background processes must not outlive the test.
        self.run("session close --all --force");
    }
}

/// A process, and a reader for its stderr.
struct Running {
    process: Child,
    stderr: BufReader<ChildStderr>,
    first: String,
}

impl Running {
    /// Starts the process. If `speaks` is set, waits for the first line on stdout.
    fn start(mut command: Command, speaks: bool) -> Self {
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = String::new();
        if speaks {
            BufReader::new(process.stdout.take().unwrap()).read_line(&mut first).unwrap();
        }
        let stderr = BufReader::new(process.stderr.take().unwrap());
        Self { process, stderr, first: first.trim_end().to_owned() }
    }

    /// Starts a session in the foreground.
    fn session(workspace: &Workspace, robot: &str) -> Self {
        let session = Self::start(workspace.command(&format!("-r {robot} session open")), true);
        assert!(session.first.contains("held by process"), "{}", session.first);
        session
    }

    /// Waits until stderr contains this text.
    fn wait_for_message(&mut self, part: &str) {
        let mut line = String::new();
        while !line.contains(part) {
            line.clear();
            assert!(self.stderr.read_line(&mut line).unwrap() > 0, "it never said '{part}'");
            assert!(part.contains("may still move") || !line.contains("may still move"), "{line}");
        }
    }

    /// The next line on stderr that begins with this text.
    fn line(&mut self, beginning: &str) -> String {
        let mut line = String::new();
        while !line.starts_with(beginning) {
            line.clear();
            assert!(self.stderr.read_line(&mut line).unwrap() > 0, "it never said '{beginning}'");
        }
        line
    }

    fn signal(&self, signal: &str) {
        let pid = self.process.id().to_string();
        assert!(Command::new("kill").args(["-s", signal, &pid]).status().unwrap().success());
    }

    /// Waits for the end. Returns the exit code and the remaining output.
    fn end(mut self) -> (Option<i32>, String) {
        let mut rest = String::new();
        self.stderr.read_to_string(&mut rest).unwrap();
        (self.process.wait().unwrap().code(), rest)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // The process may have ended already.
        self.process.kill().unwrap_or_default();
        self.process.wait().unwrap();
    }
}

/// A simulator on this address; port 0 selects a free port. The first output line of the simulator is its target.
fn simulator(workspace: &Workspace, family: &str, address: &str) -> Running {
    serve_simulator(workspace, &format!("{family} --bind {address}"))
}

/// Starts a simulator with these arguments.
fn serve_simulator(workspace: &Workspace, words: &str) -> Running {
    let mut command = workspace.command(&format!("sim {words} --console --jq .data.target"));
    command.stdin(Stdio::piped());
    let mut simulator = Running::start(command, true);
    if !simulator.first.contains("://") {
        let mut output = String::new();
        simulator.stderr.read_to_string(&mut output).unwrap();
        panic!("the simulator does not serve: {output}");
    }
    simulator
}

/// A simulated YRCX, and a user whose inventory has it as `cell`. The long timeout allows for a busy machine.
fn cell_arguments() -> (Running, Workspace) {
    let simulator = simulator(&Workspace::new(&[]), "yrcx", "127.0.0.1:0");
    let workspace = Workspace::new(&[("cell", "yrcx", &format!("{}?rpi=5ms&multiplier=512", simulator.first))]);
    (simulator, workspace)
}

/// A motion that takes minutes.
const SLOW_MOVE: &str = "-r cell yrcx move --to 900,0,0,0 --speed-of-max 0.1 --yes";

/// Starts [`SLOW_MOVE`], and waits until the controller executes the motion.
fn start_motion(workspace: &Workspace) -> Running {
    let mut moving = Running::start(workspace.command(&format!("{SLOW_MOVE} -vv")), false);
    moving.wait_for_message("<- WO 0100");
    moving
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn fails(output: &Output, exit: i32, part: &str) {
    let stderr = stderr(output);
    assert!(output.status.code() == Some(exit) && stderr.contains(part), "{:?}: {stderr}", output.status.code());
    assert!(stderr.contains("hint: "), "{stderr}");
}

fn mode(path: &Path) -> u32 {
    path.metadata().unwrap().permissions().mode() & 0o7777
}

#[test]
fn completion_asks_a_controller_only_through_its_session() {
    let simulator = simulator(&Workspace::new(&[]), "yerc", "127.0.0.1:0");
    let workspace = Workspace::new(&[("cell", "yerc", &simulator.first)]);
    let tab = |words: &str| {
        let output = workspace.command(&format!("-- {words}")).env("ARMCTL_COMPLETE", "zsh").output().unwrap();
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{words}");
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(tab("armctl -r c").starts_with("+cell\tudp://"));
    assert_eq!(tab("armctl -r cell yerc job select TE"), "", "it opens no link of its own");
    let _session = Running::session(&workspace, "cell");
    // On a busy machine, completion may be too slow for the first try.
    while tab("armctl -r cell yerc job select TE") != "+TESTJOB\n" {}
    while !tab("yerc -r cell file get TOOL").contains("+TOOL.CND\tcnd") {}
    assert_eq!(tab("armctl -r cell --no-session yerc job select TE"), "");
    assert!(tab("armctl session close c").contains("cell"));
}

#[test]
fn commands_use_a_session_automatically() {
    let (_simulator, workspace) = cell_arguments();
    let session = Running::session(&workspace, "cell");
    let folder = workspace.folder.path().join("run/armctl");
    let sockets = workspace.files("sock");
    assert_eq!((mode(&folder), sockets.len(), mode(&sockets[0])), (0o700, 1, 0o600));
    for words in ["yrcx info servo -v", "yrcx status -v", "yrcx io get alarm -v", "status -v"] {
        let output = workspace.run(&format!("-r cell {words}"));
        let stderr = stderr(&output);
        assert!(output.status.success() && stderr.contains("through the session of process"), "{words}: {stderr}");
        assert!(!stderr.contains("closed"), "no fault of the link: {stderr}");
    }
    assert_eq!(workspace.data("-r cell yrcx status")["alarm"], false, "the connection stayed open");
    // A command that names the device by its URL uses the same session.
    let url = workspace.listed_sessions()["target"].as_str().unwrap().to_owned();
    assert!(stderr(&workspace.run(&format!("-t {url} yrcx status -v"))).contains("through the session"));
    fails(&workspace.run("-r cell --no-session --yes yrcx info servo"), 3, "[0x0106]");
    let second = workspace.run("-r cell session open");
    fails(&second, 4, &format!("a session is already open: process {}, since", session.process.id()));
    session.signal("TERM");
    assert_eq!(session.end().0, Some(0));
    assert!(workspace.files("sock").is_empty());
}

#[test]
fn one_client_moves_and_another_stops() {
    let (_simulator, workspace) = cell_arguments();
    let _session = Running::session(&workspace, "cell");
    let moving = start_motion(&workspace);
    let pid = moving.process.id();
    let listed = workspace.listed_sessions();
    assert_eq!((&listed["motion"]["pid"], &listed["under_way"]), (&pid.into(), &true.into()));
    assert!(listed["motion"]["command"].as_str().unwrap().contains("yrcx move --to 900,0,0,0"), "{listed}");
    fails(
        &workspace.run("-r cell yrcx servo on --yes"),
        7,
        &format!("another client is moving the robot: process {pid} ("),
    );
    fails(&workspace.run("-r cell yrcx info servo --timeout 100ms"), 4, "the link is in use by process");
    fails(&workspace.run("session close cell"), 7, "moves the robot");
    assert_eq!(workspace.data("-r cell yrcx status")["command_status"], "running");
    assert_eq!(workspace.data("-r cell status")["reachable"], true);

    assert!(workspace.run("-r cell yrcx stop").status.success());
    let (code, said) = moving.end();
    assert!(code == Some(3) && said.contains("12.400"), "{code:?} {said}");
    workspace.data("-r cell yrcx io set stop=on");
    assert!(workspace.run("-r cell yrcx servo on --yes").status.success(), "nobody moves it any more");
}

#[test]
fn interrupt_stops_a_motion_in_a_session() {
    let (_simulator, workspace) = cell_arguments();
    let _session = Running::session(&workspace, "cell");
    let moving = start_motion(&workspace);
    moving.signal("INT");
    let (code, said) = moving.end();
    assert!(code == Some(130) && said.contains("was stopped by the stop input SI(06), which is on again"), "{said}");
}

#[test]
fn reports_and_handles_state_of_a_dead_client() {
    let (_simulator, workspace) = cell_arguments();
    let mut session = Running::session(&workspace, "cell");
    let mut moving = Running::start(workspace.command(&format!("{SLOW_MOVE} --on-interrupt leave -vv")), false);
    moving.wait_for_message("<- WO 0100");
    let pid = moving.process.id();
    moving.signal("KILL");
    session.wait_for_message(&format!("client {pid} has died"));
    let listed = workspace.listed_sessions();
    assert_eq!((&listed["leftover"]["pid"], &listed["leftover"]["died"]), (&pid.into(), &true.into()));
    assert_eq!((&listed["motion"], &listed["under_way"]), (&Value::Null, &true.into()), "it goes on");
    let output = workspace.run("-r cell yrcx servo on --yes");
    fails(&output, 4, "another client's command is still running: move-mm");
    assert!(stderr(&output).contains("a client ended and left a command running"), "{}", stderr(&output));

    assert!(workspace.run("-r cell yrcx stop").status.success());
    // The motion ends a moment after the stop. Until then, new commands are refused.
    let mut next = (0..100).map(|_| workspace.run("-r cell yrcx info servo"));
    let next = next.find(|next| next.status.success()).expect("the motion ends");
    assert!(stderr(&next).contains("another client left move-mm "), "{}", stderr(&next));
    assert_eq!(workspace.listed_sessions()["leftover"], Value::Null);
}

#[test]
fn stops_the_jog_of_a_killed_client() {
    let (_simulator, workspace) = cell_arguments();
    let mut session = Running::session(&workspace, "cell");
    let mut jogging = Running::start(workspace.command("-r cell yrcx jog pulse 1 + --for 1m --yes -vv"), false);
    jogging.wait_for_message("<- WO 0100");
    jogging.signal("KILL");
    session.wait_for_message("armctl sends the stop signals of the client");
    workspace.until(|session| session["under_way"] == false);
    let next = workspace.run("-r cell yrcx info servo");
    assert!(next.status.success() && stderr(&next).contains("12.400 stopped by the stop input"), "{}", stderr(&next));
}

#[test]
fn motion_with_no_wait_continues_after_its_command() {
    let (_simulator, workspace) = cell_arguments();
    let _session = Running::session(&workspace, "cell");
    let moved = workspace.run("-r cell yrcx move --to 10,0,0,0 --speed-of-max 1 --yes --no-wait");
    assert!(moved.status.success(), "{}", stderr(&moved));
    assert_eq!(workspace.listed_sessions()["leftover"]["died"], false);
    let filter = ".data.command_status == \"normal end\"";
    let mut watch = workspace.command("-r cell yrcx status --watch 10ms --for 1m --json");
    let watched = watch.args(["--until", filter]).output().unwrap();
    assert!(watched.status.success(), "{:?}", watched.stdout.rsplit(|byte| *byte == b'\n').nth(1));
    assert_eq!(workspace.data("-r cell yrcx status --full")["position"]["x_mm"], 10.0);
}

/// The session process is killed during a command. The command reports the end of the session, and that its own outcome
/// is unknown.
#[test]
fn command_reports_its_killed_session() {
    for (family, words, until) in [
        ("yerc", "move relative --x 200 --speed 5mm/s --yes", "answer to 0x8a cartesian move: ok"),
        ("yerc", "file put UP.CND --yes", "data: file load, block 3"),
    ] {
        let simulator = simulator(&Workspace::new(&[]), family, "127.0.0.1:0");
        let workspace = Workspace::new(&[("cell", family, &simulator.first)]);
        let up = workspace.folder.path().join("UP.CND");
        std::fs::write(&up, vec![b'x'; 16 << 20]).unwrap();
        let session = Running::session(&workspace, "cell");
        let mut command = workspace.command(&format!("-r cell {family} {words} -vv"));
        command.current_dir(workspace.folder.path());
        let mut commanding_client = Running::start(command, false);
        commanding_client.wait_for_message(until);
        session.signal("KILL");
        let (code, said) = commanding_client.end();
        assert!(code == Some(6) && said.contains("the process of the session has ended"), "{words}: {code:?}, {said}");
        assert!(!said.contains("os error") && !said.contains("reset by peer"), "{words}: {said}");
    }
}

#[test]
fn killed_session_makes_the_outcome_unknown() {
    let (_simulator, workspace) = cell_arguments();
    let session = Running::session(&workspace, "cell");
    let moving = start_motion(&workspace);
    session.signal("KILL");
    let (code, said) = moving.end();
    assert!(
        code == Some(6) && said.contains("the process of the session has ended") && said.contains("hint: keep clear"),
        "{said}"
    );
    assert_eq!((workspace.files("sock").len(), workspace.listed_sessions()["link"].as_str()), (1, Some("dead")));
    assert!(
        stderr(&workspace.run("-r cell yrcx status"))
            .contains("the session process has ended, so the command runs without a session")
    );
    // A stale socket does not prevent a new session. The adapter needs a moment to detect the lost owner.
    while !workspace.run("-r cell session open --background").status.success() {}
    assert_eq!(workspace.listed_sessions()["link"], "up");
    let killed = workspace.listed_sessions()["pid"].to_string();
    assert!(Command::new("kill").args(["-s", "KILL", &killed]).status().unwrap().success());
    workspace.until(|session| session["link"] == "dead");
    assert_eq!(workspace.data("session close cell")["sessions"][0]["became"], "forgotten");
    assert!(workspace.files("sock").is_empty());
}

#[test]
fn closing_session_notifies_its_clients() {
    let (_simulator, workspace) = cell_arguments();
    let session = Running::session(&workspace, "cell");
    let moving = start_motion(&workspace);
    session.signal("TERM");
    let (code, said) = moving.end();
    assert!(
        code == Some(6) && said.contains("the session has ended: termination request (SIGTERM)"),
        "{code:?} {said}"
    );
    let (code, said) = session.end();
    assert!(code == Some(0) && !said.contains("not closed correctly"), "{said}");
    assert!(workspace.files("sock").is_empty());
}

#[test]
fn reopens_a_lost_link() {
    let (simulator, workspace) = cell_arguments();
    let mut session = Running::session(&workspace, "cell");
    let address = simulator.first.trim_start_matches("eip://").to_owned();
    drop(simulator);
    session.wait_for_message("the connection was lost");
    workspace.until(|session| session["link"] == "down");
    fails(&workspace.run("-r cell yrcx info servo --timeout 100ms"), 4, "the controller sends no data");
    let _simulator = self::simulator(&workspace, "yrcx", &format!("{address} --io-port 0"));
    session.wait_for_message("the connection is open again");
    let listed = workspace.until(|session| session["link"] == "up");
    assert_eq!(listed["reopenings"], 1);
    assert!(workspace.run("-r cell yrcx info servo").status.success());
}

#[test]
fn session_keeps_each_fieldbus_and_its_end_is_an_alarm() {
    // The longest possible timeouts, for a busy machine.
    for (words, patience, alarm) in
        [("--bus devicenet", "&rate=10s", "12.541"), ("--bus profibus", "&watchdog=60s&slot=500ms", "12.561")]
    {
        let simulator = serve_simulator(&Workspace::new(&[]), &format!("yrcx {words}"));
        let target = simulator.first.split("&slot=").next().unwrap();
        let workspace = Workspace::new(&[("cell", "yrcx", &format!("{target}{patience}"))]);
        let session = Running::session(&workspace, "cell");
        workspace.data("-r cell yrcx io set 20=on");
        assert_eq!(workspace.data("-r cell yrcx io get SI20")["items"][0]["value"], true, "{target}");
        assert!(
            workspace.run("-r cell yrcx move --to 300,0,0,0 --speed-of-max 100 --yes").status.success(),
            "{target}"
        );
        let closed = workspace.run("session close cell");
        let said = String::from_utf8_lossy(&closed.stderr).into_owned();
        assert!(closed.status.success() && said.contains(&format!("stops and raises alarm {alarm}")), "{said}");
        assert_eq!(session.end().0, Some(0), "{target}");
        let _session = Running::session(&workspace, "cell");
        assert_eq!(workspace.data("-r cell yrcx alarm history 1")["alarms"][0]["code"], alarm);
        fails(&workspace.run("-r cell yrcx move --to 200,0,0,0 --yes"), 3, alarm);
        assert!(workspace.run("-r cell yrcx recover --yes").status.success(), "{target}");
        assert!(workspace.run("-r cell yrcx move --to 200,0,0,0 --yes").status.success(), "{target}");
    }
}

#[test]
fn reports_the_stop_input_after_a_lost_link_returns() {
    const REPORTED: &str = "the connection was lost; the connection is up again, and the stop input SI(06) is on";
    // First through a session, then with a direct connection of the command.
    for is_held in [true, false] {
        let (simulator, workspace) = cell_arguments();
        let mut session = is_held.then(|| Running::session(&workspace, "cell"));
        let mut moving = Running::start(workspace.command(&format!("{SLOW_MOVE} -vv --timeout 1m")), false);
        moving.wait_for_message("<- WO 0100");
        simulator.signal("STOP");
        let lost = " was lost";
        session.as_mut().unwrap_or(&mut moving).wait_for_message(lost);
        simulator.signal("CONT");
        let (code, said) = moving.end();
        assert!(
            code == Some(6) && said.contains(REPORTED) && !said.contains("stays off"),
            "{is_held}: {code:?} {said}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn background_session_keeps_no_file_of_its_starter_open() {
    let (_simulator, workspace) = cell_arguments();
    let inherited = workspace.folder.path().join("inherited");
    let command = workspace.command("-r cell session open --background --json");
    let open = format!("exec 7>'{}' 8</dev/null 9>&1; exec \"$0\" \"$@\"", inherited.display());
    let mut shell = Command::new("sh");
    shell.args(["-c", &open]).arg(command.get_program()).args(command.get_args()).stdin(Stdio::null());
    shell.env_clear().envs(command.get_envs().filter_map(|(name, value)| Some((name, value?))));
    // If the session kept descriptor 9 open, this call would wait for the end of the session.
    let output = shell.output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let opened: Value = serde_json::from_slice(&output.stdout).unwrap();
    let files = std::fs::read_dir(format!("/proc/{}/fd", opened["data"]["pid"])).unwrap();
    let files: Vec<PathBuf> = files.filter_map(|file| std::fs::read_link(file.unwrap().path()).ok()).collect();
    assert!(inherited.exists() && !files.is_empty() && !files.contains(&inherited), "{files:?}");
}

#[test]
fn background_session_is_ready_when_reported() {
    let (_simulator, workspace) = cell_arguments();
    let opened = workspace.data("-r cell session open --background");
    assert_eq!((&opened["robot"], &opened["background"]), (&"cell".into(), &true.into()));
    let log = PathBuf::from(opened["log"].as_str().unwrap());
    assert_eq!(mode(&log), 0o600);
    assert!(std::fs::read_to_string(&log).unwrap().contains("the connection is open"));
    assert_eq!(workspace.listed_sessions()["pid"], opened["pid"]);
    fails(&workspace.run("-r cell session open --background"), 4, "a session is already open");
    fails(&workspace.run("session close elsewhere"), 2, "no session of 'elsewhere' is open");
    assert_eq!(workspace.data("session close cell")["sessions"][0]["became"], "closed");
    assert_eq!(workspace.data("session list")["sessions"].as_array().unwrap().len(), 0);
    // The session and its connection have ended, so a new session is possible.
    workspace.data("-r cell session open --background");

    let no_session = Workspace::new(&[("cell", "yrcx", "eip://127.0.0.1:1"), ("yas", "yerc", "udp://127.0.0.1:1")]);
    for robot in ["cell", "yas"] {
        fails(&no_session.run(&format!("-r {robot} session open --background --retries 0")), 4, "127.0.0.1:1");
    }
    assert!(no_session.files("sock").is_empty());
}

#[test]
fn session_forwards_datagrams() {
    let simulator = simulator(&Workspace::new(&[]), "yerc", "127.0.0.1:0");
    let workspace = Workspace::new(&[("cell", "yerc", &simulator.first)]);
    let session = Running::session(&workspace, "cell");
    let through_session = workspace.run("-r cell yerc status -v");
    assert!(stderr(&through_session).contains("through the session of process"), "{}", stderr(&through_session));
    for old in [0, 7] {
        let written = &workspace.data("-r cell yerc var set B0=7")["items"][0];
        assert_eq!((&written["old"], &written["new"]), (&old.into(), &7.into()), "{written}");
    }
    // A file transfer needs many datagrams, and it uses the other port.
    let file = workspace.folder.path().join("COUNT.JBI");
    let saved = workspace.run(&format!("-r cell yerc file get COUNT.JBI --dir {}", workspace.folder.path().display()));
    assert!(saved.status.success() && file.exists(), "{}", stderr(&saved));
    let sent = workspace.run(&format!("-r cell --yes yerc file put {} --replace", file.display()));
    assert!(sent.status.success(), "{}", stderr(&sent));

    let slow = "-r cell --yes yerc move relative --z -600 --speed 1mm/s";
    let moving = Running::start(workspace.command(slow), false);
    let pid = workspace.until(|session| session["motion"] != Value::Null)["motion"]["pid"].clone();
    assert_eq!(pid, moving.process.id());
    fails(&workspace.run("-r cell --yes yerc servo on"), 7, "another client is moving the robot");
    assert!(workspace.run("-r cell yerc hold on").status.success(), "a hold gets through");
    moving.signal("INT");
    assert_eq!(moving.end().0, Some(130));
    session.signal("INT");
    assert_eq!(session.end().0, Some(0));
}

#[test]
fn clients_take_turns_on_a_serial_line() {
    let simulator = simulator(&Workspace::new(&[]), "toyo", "127.0.0.1:0");
    let workspace = Workspace::new(&[("cell", "toyo", &simulator.first)]);
    let mut session = Running::session(&workspace, "cell");
    let homing = Running::start(workspace.command("-r cell toyo home --yes -vv"), false);
    let pid = workspace.until(|session| session["motion"] != Value::Null)["motion"]["pid"].clone();
    assert_eq!(pid, homing.process.id());
    assert!(workspace.run("-r cell toyo status").status.success(), "questions get through");
    fails(&workspace.run("-r cell toyo servo on --yes"), 7, "another client is moving the robot");
    let stopped = workspace.run("-r cell toyo stop");
    assert!(stopped.status.success(), "{}", stderr(&stopped));
    assert_eq!(homing.end().0, Some(8), "stopped by somebody else");

    let address = simulator.first.trim_start_matches("tcp://").to_owned();
    drop(simulator);
    session.wait_for_message("the connection was lost");
    fails(&workspace.run("-r cell toyo status"), 4, "the connection is lost");
    let _simulator = self::simulator(&workspace, "toyo", &address);
    session.wait_for_message("the connection is open again");
    assert!(workspace.run("-r cell toyo status").status.success());
}

#[test]
fn simulator_in_a_session_keeps_its_state() {
    let workspace = Workspace::new(&[("x", "yrcx", "sim:"), ("y", "yerc", "sim:"), ("t", "toyo", "sim:")]);
    for robot in ["x", "y", "t"] {
        assert!(workspace.run(&format!("-r {robot} session open --background")).status.success());
    }
    assert_eq!(workspace.data("session list")["sessions"].as_array().unwrap().len(), 3);
    workspace.data("-r x yrcx io set 20=on");
    assert_eq!(workspace.data("-r x yrcx io get SI20")["items"][0]["value"], true);
    workspace.data("-r y yerc var set B0=42");
    assert_eq!(workspace.data("-r y yerc var get B0")["items"][0]["value"], 42);
    workspace.data("-r t toyo counter set 7 42");
    assert_eq!(workspace.data("-r t toyo counter get 7")["items"][0]["value"], 42);
    // Without a session, each command has a new simulator with the default state.
    assert_eq!(workspace.data("--no-session -r t toyo counter get 7")["items"][0]["value"], 0);
    assert_eq!(workspace.data("session close --all")["sessions"].as_array().unwrap().len(), 3);
}

#[test]
fn does_not_trust_a_folder_of_another_user() {
    let workspace = Workspace::new(&[("x", "yrcx", "sim:")]);
    let folder = workspace.folder.path().join("run/armctl");
    std::fs::create_dir(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o755)).unwrap();
    fails(&workspace.run("-r x session open"), 1, "other users have access to it");
    let output = workspace.run("-r x yrcx status");
    assert!(output.status.success() && stderr(&output).contains("armctl does not use sessions"), "{}", stderr(&output));
}
