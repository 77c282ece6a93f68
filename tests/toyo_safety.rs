//! Dangerous cases with a Toyo controller, with the program against a controller of the test: an axis that keeps
//! jogging, a program that Ctrl-C does not stop, a command that is sent twice.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{Shutdown, TcpListener};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::support::simulator::Simulator;

/// Fault for a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    No,
    Silence,
    HangUp,
}

/// A controller with origin and servo power, whose axis 1 moves during a jog or a program.
#[derive(Default)]
struct Machine {
    host: bool,
    jogs: bool,
    runs: bool,
    x: i32,
    /// Current task, starting with 0.
    task: u8,
}

impl Machine {
    fn answer(&mut self, block: &str) -> String {
        match &block[1..5] {
            "HSON" => self.host = true,
            "HSOF" => self.host = false,
            "SPST" | "HOME" => self.runs = true,
            "STOP" => self.runs = false,
            "JGST" => self.jogs = !block.contains("X=SP") && !block.contains("X=RS"),
            "MPST" => {
                self.x += i32::from(self.jogs || self.runs);
                return format!("@MPST X=+{:04}.{:02} Y=+0000.00 Z=+0000.00 R=+0000.00", self.x / 100, self.x % 100);
            }
            "STAS" => {
                let page = match &block[10..] {
                    "0" => 0x30 | u8::from(self.jogs || self.runs) << 1,
                    "2" => u8::from(self.host) << 7,
                    "3" => 0x11,
                    _ => 0,
                };
                return format!("{block} ST1={page:02X} ST2=00");
            }
            "CTSK" => self.task = block[block.len() - 1..].parse::<u8>().unwrap() - 1,
            "MTSK" => return format!("@MTSK TASK={:02}", self.task + 1),
            "RPAR" if block == "@RPAR E01" => return "@RPAR E01 AX1=X AX2=Y AX3=Z AX4=R".to_owned(),
            "RSTX" => return "@RSTX 0001 NOP".to_owned(),
            _ => return "@NG".to_owned(),
        }
        "@OK".to_owned()
    }
}

/// A controller behind a device server, and the received blocks.
struct Controller {
    url: String,
    line_added: Receiver<String>,
    received: Vec<String>,
    server: JoinHandle<Machine>,
}

impl Controller {
    /// Serves one connection.
    fn new(mut peculiar: impl FnMut(&str) -> Fault + Send + 'static) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let url = format!("tcp://{}", listener.local_addr().unwrap());
        let (tell, line_added): (Sender<String>, _) = channel();
        let server = std::thread::spawn(move || {
            let mut machine = Machine::default();
            let (mut stream, _) = listener.accept().unwrap();
            for block in BufReader::new(stream.try_clone().unwrap()).lines().map_while(Result::ok) {
                let _gone = tell.send(block.clone());
                match peculiar(&block) {
                    Fault::Silence => continue,
                    Fault::HangUp => drop(stream.shutdown(Shutdown::Both)),
                    Fault::No => {}
                }
                let answer = machine.answer(&block);
                if stream.write_all(format!("{answer}\r\n").as_bytes()).is_err() {
                    break;
                }
            }
            machine
        });
        Self { url, line_added, received: Vec::new(), server }
    }

    fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env("XDG_STATE_HOME", env!("CARGO_TARGET_TMPDIR"));
        command.args(["-t", &self.url, "--yes", "toyo"]).args(words.split_ascii_whitespace());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Waits for this number of blocks of a kind.
    fn wait_for(&mut self, block: &str, count: usize) {
        for _ in 0..count {
            while let heard = self.line_added.recv_timeout(Duration::from_secs(30)).expect("the block comes")
                && heard != block
            {
                self.received.push(heard);
            }
            self.received.push(block.to_owned());
        }
    }

    /// All received blocks, and the final state of the machine.
    fn end(mut self) -> (Vec<String>, Machine) {
        let machine = self.server.join().unwrap();
        self.received.extend(self.line_added.try_iter());
        (self.received, machine)
    }
}

const JOG: &str = "jog X + low --for 60s";
const GO: &str = "@JGST X=+L Y=SP Z=SP R=SP";
const STOP: &str = "@JGST X=SP Y=SP Z=SP R=SP";

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args(["-s", name, &child.id().to_string()]).status().unwrap().success());
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn count(heard: &[String], block: &str) -> usize {
    heard.iter().filter(|heard| *heard == block).count()
}

#[track_caller]
fn has_stopped(controller: Controller) -> Vec<String> {
    let (heard, machine) = controller.end();
    assert_eq!(count(&heard, GO), 1, "{heard:?}");
    assert!(heard.iter().rposition(|block| block == STOP) > heard.iter().position(|block| block == GO), "{heard:?}");
    assert!(!machine.jogs, "the axis is left jogging");
    heard
}

/// Every signal that ends or suspends a process stops the axis.
#[test]
fn every_end_of_the_process_stops_a_jog() {
    // Under nohup, a test receives no SIGHUP.
    let ignored = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = ignored.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    for (name, said) in [
        ("INT", "the robot was stopped (@JGST X=SP"),
        ("TERM", "the robot was stopped (@JGST X=SP"),
        ("HUP", "the robot was stopped (@JGST X=SP"),
        ("QUIT", "the robot was stopped (@JGST X=SP"),
        ("TSTP", "the robot was stopped (@JGST X=SP"),
    ] {
        if name == "HUP" && ignored.is_none_or(|mask| mask & 1 != 0) {
            continue;
        }
        for flags in ["", " --on-interrupt leave"] {
            let mut controller = Controller::new(|_| Fault::No);
            let child = controller.command(&format!("{JOG}{flags}")).spawn().unwrap();
            controller.wait_for(GO, 1);
            controller.wait_for("@MPST", 3);
            signal(&child, name);
            let output = child.wait_with_output().unwrap();
            assert_eq!(output.status.code(), Some(130), "{name}{flags}: {}", errors(&output));
            assert!(errors(&output).contains(said), "{name}{flags}: {}", errors(&output));
            assert_eq!(has_stopped(controller).last().unwrap(), "@HSOF", "the host is given back");
        }
    }
}

/// Ctrl-C in every phase: before an answer, and during an unanswered status request.
#[test]
fn ctrl_c_stops_a_jog_of_a_silent_controller() {
    for silent in [GO, "@STAS SNO=0", "@MPST"] {
        let (mut goes, mut was_silent) = (false, false);
        let mut controller = Controller::new(move |block| {
            goes |= block == GO;
            if goes && !was_silent && block == silent {
                was_silent = true;
                return Fault::Silence;
            }
            Fault::No
        });
        let child = controller.command(JOG).spawn().unwrap();
        controller.wait_for(GO, 1);
        if silent != GO {
            controller.wait_for(silent, 1);
        }
        signal(&child, "INT");
        let output = child.wait_with_output().unwrap();
        // The silence may be detected before the signal.
        assert!(matches!(output.status.code(), Some(130 | 4 | 6)), "{silent}: {}", errors(&output));
        let (heard, machine) = controller.end();
        assert!(!machine.jogs && count(&heard, STOP) > 0, "{silent}: {heard:?}");
    }
}

#[test]
fn closed_stdout_does_not_prevent_the_stop() {
    let controller = Controller::new(|_| Fault::No);
    let mut child = controller.command("jog X + low --for 200ms").spawn().unwrap();
    drop(child.stdout.take());
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    has_stopped(controller);
}

#[test]
fn lost_line_during_motion_has_a_hint() {
    let mut running_program = false;
    let controller = Controller::new(move |block| {
        let cut_line = running_program;
        running_program |= block == GO;
        if cut_line { Fault::HangUp } else { Fault::No }
    });
    let output = controller.command(JOG).output().unwrap();
    assert_eq!(output.status.code(), Some(6), "{}", errors(&output));
    let reported = errors(&output);
    assert!(reported.contains("the axis may still move"), "{reported}");
    assert!(reported.contains("press the emergency stop") && reported.contains("`toyo stop --jog`"), "{reported}");
}

/// From the time when the command is sent: unanswered, accepted, in progress.
#[test]
fn ctrl_c_stops_a_running_program() {
    for (words, order) in [("run sequential 1 --wait", "@SPST 0001"), ("home", "@HOME")] {
        for (is_answered, looks) in [(false, 0), (true, 0), (true, 3)] {
            let mut controller =
                Controller::new(move |block| if block == order && !is_answered { Fault::Silence } else { Fault::No });
            let child = controller.command(&format!("{words} --timeout 20s")).spawn().unwrap();
            controller.wait_for(order, 1);
            controller.wait_for("@STAS SNO=0", looks);
            signal(&child, "INT");
            let output = child.wait_with_output().unwrap();
            assert_eq!(output.status.code(), Some(130), "{words}: {}", errors(&output));
            assert!(errors(&output).contains("the robot was stopped (@STOP)"), "{words}: {}", errors(&output));
            let (heard, machine) = controller.end();
            assert_eq!((count(&heard, order), machine.runs), (1, false), "{heard:?}");
        }
    }
}

#[test]
fn on_interrupt_leave_does_not_stop() {
    let mut controller = Controller::new(|_| Fault::No);
    let child = controller.command("run sequential 1 --wait --on-interrupt leave").spawn().unwrap();
    controller.wait_for("@SPST 0001", 1);
    controller.wait_for("@STAS SNO=0", 2);
    signal(&child, "INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(errors(&output).contains("not stopped; the motion or program continues"), "{}", errors(&output));
    let (heard, machine) = controller.end();
    assert!(machine.runs && count(&heard, "@STOP") == 0, "{heard:?}");
}

/// A command whose answer is lost is sent once, and its outcome is reported as unknown.
#[test]
fn never_sends_a_command_twice() {
    for (words, order) in [
        ("home", "@HOME"),
        ("home --sync 1", "@SORG 1"),
        ("run sequential 1 --wait", "@SPST 0001"),
        ("run palletizing --program 2", "@SPLN PR=02"),
        ("run palletizing", "@PPST"),
        ("run easy", "@SESY"),
        ("run point 7", "@EXTP PT=007"),
        ("servo on", "@SVON"),
        ("mode auto", "@MAUT"),
        ("reset", "@REST"),
        ("alarm reset", "@CERR"),
        ("coordinate set 1 2 3 4", "@MRSS TASK=01 X=+0001.00 Y=+0002.00 Z=+0003.00 R=+0004.00 V=00"),
        ("card write", "@WMCA"),
        ("card read", "@RMCA"),
    ] {
        let controller = Controller::new(move |block| if block == order { Fault::Silence } else { Fault::No });
        let output = controller.command(&format!("{words} --timeout 100ms")).output().unwrap();
        assert_eq!(output.status.code(), Some(6), "{words}: {}", errors(&output));
        assert!(errors(&output).contains("hint: "), "{words}: {}", errors(&output));
        let (heard, _) = controller.end();
        assert_eq!(count(&heard, order), 1, "{words}: {heard:?}");
    }
}

/// A controller behind a device server that accepts one connection after the other, and closes it at the blocks in
/// `peculiar`; it ends with the test.
fn long_program(mut peculiar: impl FnMut(&str) -> Fault + Send + 'static) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("tcp://{}", listener.local_addr().unwrap());
    std::thread::spawn(move || {
        let mut machine = Machine::default();
        for stream in listener.incoming().map_while(Result::ok) {
            let mut writer = stream.try_clone().unwrap();
            for block in BufReader::new(stream).lines().map_while(Result::ok) {
                if peculiar(&block) == Fault::HangUp {
                    writer.shutdown(Shutdown::Both).unwrap_or_default();
                    break;
                }
                let answer = machine.answer(&block);
                if writer.write_all(format!("{answer}\r\n").as_bytes()).is_err() {
                    break;
                }
            }
        }
    });
    url
}

fn toyo(url: &str, state: &std::path::Path, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env("XDG_STATE_HOME", state).args(["-t", url, "--yes", "toyo"]).args(words.split_ascii_whitespace());
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[test]
fn reports_state_left_by_a_killed_command() {
    let state = tempfile::tempdir().unwrap();
    let (tell, moves) = channel();
    let url = long_program(move |block| {
        if block == GO {
            tell.send(()).unwrap_or_default();
        }
        Fault::No
    });
    let mut jog = toyo(&url, state.path(), JOG).spawn().unwrap();
    moves.recv_timeout(Duration::from_secs(30)).unwrap();
    signal(&jog, "KILL");
    jog.wait().unwrap();
    let messages = || errors(&toyo(&url, state.path(), "position").output().unwrap());
    assert!(messages().contains("the host is still ON, which was OFF; `toyo host off`"));
    // The guardian stops the jog.
    assert!((0..1000).any(|_| !messages().contains("executed")), "{}", messages());
    let said = errors(&toyo(&url, state.path(), "position").output().unwrap());
    assert!(!said.contains("executed") && said.contains("the host is still ON"), "{said}");
    assert!(toyo(&url, state.path(), "host off").status().unwrap().success());
    toyo(&url, state.path(), "position").status().unwrap();
    let said = errors(&toyo(&url, state.path(), "position").output().unwrap());
    assert_eq!(said, "");
}

/// State that another client of a device server leaves.
fn another_client(url: &str, block: &str) {
    let mut stream = std::net::TcpStream::connect(url.trim_start_matches("tcp://")).unwrap();
    stream.write_all(format!("{block}\r\n").as_bytes()).unwrap();
    let mut answer = String::new();
    BufReader::new(&stream).read_line(&mut answer).unwrap();
    assert_eq!(answer, "@OK\r\n");
}

#[test]
fn status_reports_state_left_by_another_client() {
    let state = tempfile::tempdir().unwrap();
    let url = long_program(|_| Fault::No);
    let said = |words: &str| {
        let output = toyo(&url, state.path(), words).output().unwrap();
        assert!(output.status.success(), "{words}: {}", errors(&output));
        errors(&output)
    };
    assert_eq!(said("status"), "");
    another_client(&url, "@HSON");
    let told = said("status");
    assert!(told.contains("the host is ON, and no armctl of this user keeps it so"), "{told}");
    assert!(told.contains("`toyo host off` gives it back"), "{told}");
    assert_eq!(said("status --watch=20ms --count 3").matches("the host is ON").count(), 1, "once is enough");
    // A command that changes something also checks the host; a read does not.
    assert!(said("stop").is_empty() && said("position").is_empty());
    another_client(&url, "@SPST 0001");
    let told = said("status");
    assert!(told.contains("the host is ON and something is executed, and no armctl of this user does that"), "{told}");
    assert!(told.contains("`toyo stop` stops it and `toyo host off` gives"), "{told}");
    said("stop");
    said("host off");
    assert_eq!(said("status"), "");
    // The requested state is not a warning until it ends.
    said("raw @HSON");
    assert_eq!(said("status"), "");
    said("host off");
    said("host on");
    assert_eq!(said("status"), "");
    another_client(&url, "@HSOF");
    assert_eq!(said("status"), "");
    another_client(&url, "@HSON");
    assert!(said("status").contains("the host is ON"));
}

#[test]
fn reports_a_task_selected_by_another_client() {
    let state = tempfile::tempdir().unwrap();
    let url = long_program(|_| Fault::No);
    let said = |words: &str| errors(&toyo(&url, state.path(), words).output().unwrap());
    assert_eq!(said("task get"), "");
    another_client(&url, "@CTSK TASK=02");
    let told = said("task get");
    assert!(told.contains("task 2 is the current one, and no armctl of this user chose it"), "{told}");
    assert!(told.contains("`toyo task set 1` chooses the first"), "{told}");
    said("task set 2");
    assert_eq!(said("task get"), "");
    another_client(&url, "@CTSK TASK=03");
    assert!(said("task get").contains("task 3 is the current one"));
    said("task set 1");
    assert_eq!(said("task get"), "");
}

#[test]
fn watch_continues_when_the_line_returns() {
    let state = tempfile::tempdir().unwrap();
    let mut places = 0;
    let url = long_program(move |block| {
        places += u32::from(block == "@MPST");
        if block == "@MPST" && places == 3 { Fault::HangUp } else { Fault::No }
    });
    let watch = toyo(&url, state.path(), "position --watch=50ms --count 6 -o jsonl").output().unwrap();
    assert!(watch.status.success(), "{}", errors(&watch));
    let lines = String::from_utf8_lossy(&watch.stdout).into_owned();
    let ok: Vec<bool> = lines.lines().map(|line| line.contains(r#""ok":true"#)).collect();
    assert_eq!(ok, [true, true, false, true, true, true], "{lines}");
    // `--until` also continues.
    let mut places = 0;
    let url = long_program(move |block| {
        places += u32::from(block == "@STAS SNO=0");
        if block == "@STAS SNO=0" && places == 2 { Fault::HangUp } else { Fault::No }
    });
    let mut until = toyo(&url, state.path(), "status --watch=50ms");
    let until = until.args(["--until", ".data.servo_on and false", "--count", "4"]).output().unwrap();
    assert_eq!(until.status.code(), Some(8), "{}", errors(&until));
}

/// A serial port has one host: the message names the process and how to end it.
#[test]
fn names_the_process_that_uses_a_serial_port() {
    let folder = tempfile::tempdir().unwrap();
    let simulator = Simulator::start_with("toyo", &["--pty"]);
    let mut home = toyo(&simulator.url, folder.path(), "home --no-session -vv").spawn().unwrap();
    let mut said = BufReader::new(home.stderr.take().unwrap()).lines().map_while(Result::ok);
    assert!(said.any(|line| line.contains("-> @HOME")), "it never moved");
    let stop = toyo(&simulator.url, folder.path(), "stop --no-session").output().unwrap();
    let pid = home.id();
    assert_eq!(stop.status.code(), Some(4), "{}", errors(&stop));
    for part in [format!("another armctl, process {pid}, uses "), format!("hint: `kill {pid}` ends it")] {
        assert!(errors(&stop).contains(&part), "{part}: {}", errors(&stop));
    }
    // The hint works: it stops the motion and frees the port.
    signal(&home, "TERM");
    assert_eq!(home.wait().unwrap().code(), Some(130));
    let status = toyo(&simulator.url, folder.path(), "status --json --jq .data.running --no-session").output().unwrap();
    assert_eq!(String::from_utf8_lossy(&status.stdout).trim(), "false", "{}", errors(&status));
}
