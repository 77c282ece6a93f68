//! `armctl top` on a terminal, with simulated controllers: display, keys, restored terminal at every exit. `top` must
//! only read. This is also tested for services.
#![cfg(unix)]

mod proxy;
mod recorded;
mod report;

use std::io::Read as _;
use std::os::unix::process::CommandExt as _;
use std::process::{Command, Stdio};
use std::time::Duration;

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use tempfile::TempDir;

use crate::support::terminal::Terminal;
use recorded::Recorded;

/// The environment of a user. The robots of the inventory are robot1, robot2 … with these targets.
struct Workspace {
    folder: TempDir,
}

impl Workspace {
    fn new(targets: &[String]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let robots = (1..).zip(targets).map(|(number, target)| {
            let (family, target) = target.split_once(' ').expect("family and target");
            format!("[[robot]]\nname = \"robot{number}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\n")
        });
        std::fs::write(folder.path().join("robots.toml"), robots.collect::<String>()).expect("written");
        Self { folder }
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", self.folder.path()).env("XDG_RUNTIME_DIR", self.folder.path());
        command.env("ARMCTL_CONFIG", self.folder.path().join("robots.toml"));
        command.env("TERM", "xterm-256color").env("LANG", "C.UTF-8").args(words);
        command
    }

    fn top(&self, words: &[&str]) -> Terminal {
        Terminal::start(self.command(&[&["top"], words].concat()), 100, 30).expect("a terminal")
    }
}

/// An inventory with the built-in simulator of each family.
fn simulated_robot() -> Workspace {
    Workspace::new(&["yerc sim:", "toyo sim:", "yrcx sim:"].map(str::to_owned))
}

#[test]
fn lists_and_opens_robots_and_q_quits() {
    let workspace = simulated_robot();
    let mut top = workspace.top(&["--watch", "100ms"]);
    top.wait_for_picture("3 robots · 3 answer");
    top.wait_for_picture("robot2  toyo");
    assert!(top.picture.is_alternate && !top.picture.has_cursor && top.picture.has_color);
    top.press("\x1b[B");
    top.press("\r");
    top.wait_until("the screen of robot2", |picture| picture.text().contains("robot2  toyo  answer"));
    top.wait_for_picture("SOFT LIMITS");
    top.press("n");
    top.wait_for_picture("robot3  yrcx");
    top.wait_for_picture("TORQUE");
    top.press("\x7f");
    top.wait_for_picture("3 robots · 3 answer");
    top.press("?");
    top.wait_for_picture("No key can move a robot");
    top.press("?");
    top.press("/yer\r");
    top.wait_until("only one robot", |picture| {
        !picture.text().contains("robot2") && picture.text().contains("only 'yer'")
    });
    top.press("q");
    assert_eq!(top.end().code(), Some(0));
    assert!(top.is_restored());
}

#[test]
fn single_robot_uses_the_full_screen() {
    let workspace = simulated_robot();
    let mut top = workspace.top(&["-r", "robot1"]);
    top.wait_for_picture("SIGNALS");
    top.press("q");
    assert_eq!(top.end().code(), Some(0));
}

#[test]
fn every_exit_restores_the_terminal() {
    let workspace = simulated_robot();
    // Each way to end: a key (no signal) or a signal.
    let ends = [
        ("Ctrl-C", None),
        ("Ctrl-C", Some("INT")),
        ("SIGTERM", Some("TERM")),
        ("SIGHUP", Some("HUP")),
        ("SIGQUIT", Some("QUIT")),
    ];
    for (said, signal) in ends {
        let mut top = workspace.top(&[]);
        top.wait_for_picture("3 answer");
        match signal {
            Some(signal) => top.signal(signal),
            None => top.press("\x03"),
        }
        assert_eq!(top.end().code(), Some(130), "{said}");
        assert!(top.is_restored(), "{said}");
        assert!(String::from_utf8_lossy(&top.written).contains(said), "it says why it ended: {said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_z_suspends_and_continues() {
    let workspace = simulated_robot();
    let mut top = workspace.top(&[]);
    top.wait_for_picture("3 answer");
    top.press("\x1a");
    top.is_suspended();
    top.wait_until("the usual screen", |picture| !picture.is_alternate);
    assert!(top.is_restored());
    top.signal("CONT");
    top.wait_until("the picture again", |picture| picture.is_alternate);
    top.wait_for_picture("3 answer");
    top.press("q");
    assert_eq!(top.end().code(), Some(0));
    assert!(top.is_restored());
}

/// As in a container, the session leader is outside the namespace, and its process id is unknown.
#[cfg(target_os = "linux")]
#[test]
fn ctrl_z_suspends_in_a_pid_namespace() {
    let in_namespace = |words: &[&str]| Command::new("unshare").args(["-Urpf", "--mount-proc"]).args(words).output();
    if !in_namespace(&["true"]).is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: no PID namespaces here");
        return;
    }
    let own = std::env::current_exe().expect("a test has a path");
    let own = own.to_str().expect("in UTF-8");
    let test = in_namespace(&[own, "--exact", "top::ctrl_z_suspends_and_continues"]).expect("unshare runs");
    let messages = String::from_utf8_lossy(&test.stdout);
    assert!(test.status.success() && messages.contains("1 passed"), "{messages}");
}

#[test]
fn limits_output_to_terminal_capabilities() {
    let workspace = simulated_robot();
    for (variable, value, words) in [("NO_COLOR", "1", &[][..]), ("LANG", "C", &["--color", "never"])] {
        let mut command = workspace.command(&[&["top"], words].concat());
        command.env(variable, value);
        let mut top = Terminal::start(command, 80, 24).expect("a terminal");
        top.wait_for_picture("3 answer");
        top.press("q");
        assert_eq!(top.end().code(), Some(0));
        assert!(!top.picture.has_color, "{variable}");
        assert_eq!(top.written.is_ascii(), variable == "LANG");
    }
}

#[test]
fn sends_only_reads_for_every_key() {
    let controllers = Recorded::start();
    let workspace = Workspace::new(&controllers.targets);
    let mut top = workspace.top(&["--watch", "50ms"]);
    top.wait_for_picture("3 robots · 3 answer");
    for robot in ["robot1", "robot2", "robot3"] {
        top.press("\r");
        top.wait_until(robot, |picture| {
            picture.text().contains("SIGNALS") && picture.text().starts_with(&format!(" {robot}"))
        });
        // All characters are pressed, except for the keys that end the program or select another robot.
        top.press("\x1b[A\x1b[B\x1b[5~\x1b[6~\x1b[H\x1b[F");
        top.press(&(' '..='~').filter(|key| !"qQ/np?h".contains(*key)).collect::<String>());
        top.press(" \x7f");
        top.wait_for_picture("3 robots · 3 answer");
        top.press("\x1b[B");
        top.wait_until("the cursor is there", |picture| {
            robot == "robot3" || !picture.text().contains(&format!("▌ {robot}"))
        });
    }
    top.press("q");
    assert_eq!(top.end().code(), Some(0));
    controllers.assert_only_reads();
}

/// Word that stands for a folder of the test.
const FOLDER: &str = "FOLDER";

#[test]
fn services_send_only_reads() {
    for words in [
        ["serve", "metrics", "--listen", "127.0.0.1:0"],
        ["publish", "mqtt://127.0.0.1:1", "--every", "1s"],
        ["record", FOLDER, "--max-size", "1G"],
    ] {
        let controllers = Recorded::start();
        let workspace = Workspace::new(&controllers.targets);
        let folder = workspace.folder.path().join("recordings").into_os_string().into_string().expect("a path");
        let words = words.map(|word| if word == FOLDER { folder.as_str() } else { word });
        let mut command = workspace.command(&[&words[..], &["--all", "--watch", "50ms"]].concat());
        let mut service = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
        while controllers.fewest_requests() < 60 {
            assert!(service.try_wait().expect("it is our child").is_none(), "{words:?} goes on");
            std::thread::park_timeout(Duration::from_millis(20));
        }
        service.kill().expect("it runs");
        service.wait().expect("it ends");
        controllers.assert_only_reads();
    }
}

#[test]
fn lost_terminal_ends_the_monitor_if_hangups_are_ignored() {
    let workspace = simulated_robot();
    // This end is closed in every child process, because it would keep the terminal open.
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).expect("a pseudo-terminal");
    grantpt(&master).and_then(|()| unlockpt(&master)).expect("it can be opened");
    let name = ptsname(&master, Vec::new()).expect("it has a name").into_string().expect("in UTF-8");
    let slave = std::fs::File::options().read(true).write(true).open(name).expect("opened");
    let mut master = std::fs::File::from(master);
    let command = workspace.command(&[]);
    let armctl = command.get_program().to_owned();
    let mut program = Command::new("sh");
    program.args(["-c", "trap '' HUP; exec \"$0\" top"]).arg(armctl).env_clear();
    program.envs(command.get_envs().filter_map(|(name, value)| Some((name, value?))));
    program.stdin(slave.try_clone().expect("another")).stdout(slave.try_clone().expect("another")).stderr(slave);
    let mut child = program.process_group(0).spawn().expect("it starts");
    drop(program);
    let mut written: Vec<u8> = Vec::new();
    // The program reads keys after it has switched to the alternate screen.
    while !written.windows(8).any(|part| part == b"\x1b[?1049h") {
        let mut buffer = [0; 4096];
        let len = master.read(&mut buffer).expect("it draws");
        written.extend(&buffer[..len]);
    }
    drop(master);
    let ended = (0..3000).find_map(|_| {
        std::thread::park_timeout(Duration::from_millis(20));
        child.try_wait().expect("it is our child")
    });
    child.kill().unwrap_or_default();
    // The program ends with an error code, because a drawing or a read of a key fails.
    let code = ended.expect("it goes on without a terminal").code();
    assert!(matches!(code, Some(1 | 130)), "{code:?}");
}
