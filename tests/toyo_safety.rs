//! Safety of a machine with a Toyo controller, tested with the binary and a controller in the test. No axis continues
//! to jog, Ctrl-C stops a program, and no order is sent twice.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{Shutdown, TcpListener};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::support::simulator::Simulator;

/// Fault of the line that occurs at a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BlockFault {
    None,
    NoAnswer,
    Disconnect,
}

/// A controller with a known origin and servo power. Its axis 1 moves during a jog or a program.
#[derive(Default)]
struct Machine {
    host: bool,
    jogs: bool,
    runs: bool,
    x: i32,
    /// Current task. The first task is 0.
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

/// A controller behind a device server. It stores the blocks that it receives.
struct Controller {
    url: String,
    incoming: Receiver<String>,
    received: Vec<String>,
    server: JoinHandle<Machine>,
}

impl Controller {
    /// Starts a controller that serves one connection.
    fn new(mut fault: impl FnMut(&str) -> BlockFault + Send + 'static) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let url = format!("tcp://{}", listener.local_addr().unwrap());
        let (sender, incoming): (Sender<String>, _) = channel();
        let server = std::thread::spawn(move || {
            let mut machine = Machine::default();
            let (mut stream, _) = listener.accept().unwrap();
            for block in BufReader::new(stream.try_clone().unwrap()).lines().map_while(Result::ok) {
                let _is_sent = sender.send(block.clone());
                match fault(&block) {
                    BlockFault::NoAnswer => continue,
                    BlockFault::Disconnect => drop(stream.shutdown(Shutdown::Both)),
                    BlockFault::None => {}
                }
                let answer = machine.answer(&block);
                if stream.write_all(format!("{answer}\r\n").as_bytes()).is_err() {
                    break;
                }
            }
            machine
        });
        Self { url, incoming, received: Vec::new(), server }
    }

    fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env("XDG_STATE_HOME", env!("CARGO_TARGET_TMPDIR"));
        command.args(["-t", &self.url, "--yes", "toyo"]).args(words.split_ascii_whitespace());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Waits until this block was received `count` times.
    fn wait_for(&mut self, block: &str, count: usize) {
        for _ in 0..count {
            while let received = self.incoming.recv_timeout(Duration::from_secs(30)).expect("the block comes")
                && received != block
            {
                self.received.push(received);
            }
            self.received.push(block.to_owned());
        }
    }

    /// Returns all received blocks and the final state of the machine.
    fn end(mut self) -> (Vec<String>, Machine) {
        let machine = self.server.join().unwrap();
        self.received.extend(self.incoming.try_iter());
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

fn count(received: &[String], block: &str) -> usize {
    received.iter().filter(|received| *received == block).count()
}

#[track_caller]
fn assert_axis_stopped(controller: Controller) -> Vec<String> {
    let (received, machine) = controller.end();
    assert_eq!(count(&received, GO), 1, "{received:?}");
    assert!(
        received.iter().rposition(|block| block == STOP) > received.iter().position(|block| block == GO),
        "{received:?}"
    );
    assert!(!machine.jogs, "the axis is left jogging");
    received
}

/// Every signal that a process can handle stops the axis. This includes the signals of the keys that suspend a process.
#[test]
fn every_signal_that_ends_the_process_stops_the_jog() {
    // Under nohup, the test does not receive SIGHUP.
    let ignored = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = ignored.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    for (name, messages) in [
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
            let mut controller = Controller::new(|_| BlockFault::None);
            let child = controller.command(&format!("{JOG}{flags}")).spawn().unwrap();
            controller.wait_for(GO, 1);
            controller.wait_for("@MPST", 3);
            signal(&child, name);
            let output = child.wait_with_output().unwrap();
            assert_eq!(output.status.code(), Some(130), "{name}{flags}: {}", errors(&output));
            assert!(errors(&output).contains(messages), "{name}{flags}: {}", errors(&output));
            assert_eq!(assert_axis_stopped(controller).last().unwrap(), "@HSOF", "the host is released");
        }
    }
}

/// Ctrl-C comes before the answer to the jog, or during a status or position read that gets no answer.
#[test]
fn ctrl_c_during_a_missing_answer_stops_the_jog() {
    for unanswered in [GO, "@STAS SNO=0", "@MPST"] {
        let (mut is_jogging, mut was_silent) = (false, false);
        let mut controller = Controller::new(move |block| {
            is_jogging |= block == GO;
            if is_jogging && !was_silent && block == unanswered {
                was_silent = true;
                return BlockFault::NoAnswer;
            }
            BlockFault::None
        });
        let child = controller.command(JOG).spawn().unwrap();
        controller.wait_for(GO, 1);
        if unanswered != GO {
            controller.wait_for(unanswered, 1);
        }
        signal(&child, "INT");
        let output = child.wait_with_output().unwrap();
        // The timeout can expire before the signal arrives.
        assert!(matches!(output.status.code(), Some(130 | 4 | 6)), "{unanswered}: {}", errors(&output));
        let (received, machine) = controller.end();
        assert!(!machine.jogs && count(&received, STOP) > 0, "{unanswered}: {received:?}");
    }
}

#[test]
fn a_closed_output_pipe_does_not_prevent_the_stop() {
    let controller = Controller::new(|_| BlockFault::None);
    let mut child = controller.command("jog X + low --for 200ms").spawn().unwrap();
    drop(child.stdout.take());
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_axis_stopped(controller);
}

#[test]
fn a_lost_line_during_a_jog_has_a_hint_to_press_the_emergency_stop() {
    let mut is_jogging = false;
    let controller = Controller::new(move |block| {
        let cut = is_jogging;
        is_jogging |= block == GO;
        if cut { BlockFault::Disconnect } else { BlockFault::None }
    });
    let output = controller.command(JOG).output().unwrap();
    assert_eq!(output.status.code(), Some(6), "{}", errors(&output));
    let message = errors(&output);
    assert!(message.contains("the axis can still move"), "{message}");
    assert!(message.contains("press the emergency stop") && message.contains("`armctl toyo stop --jog`"), "{message}");
}

/// Ctrl-C comes after the order was sent, after its acceptance, or during the motion.
#[test]
fn ctrl_c_stops_a_running_program() {
    for (words, order) in [("run sequential 1 --wait", "@SPST 0001"), ("home", "@HOME")] {
        for (is_answered, status_reads) in [(false, 0), (true, 0), (true, 3)] {
            let mut controller =
                Controller::new(
                    move |block| {
                        if block == order && !is_answered { BlockFault::NoAnswer } else { BlockFault::None }
                    },
                );
            let child = controller.command(&format!("{words} --timeout 20s")).spawn().unwrap();
            controller.wait_for(order, 1);
            controller.wait_for("@STAS SNO=0", status_reads);
            signal(&child, "INT");
            let output = child.wait_with_output().unwrap();
            assert_eq!(output.status.code(), Some(130), "{words}: {}", errors(&output));
            assert!(errors(&output).contains("the robot was stopped (@STOP)"), "{words}: {}", errors(&output));
            let (received, machine) = controller.end();
            assert_eq!((count(&received, order), machine.runs), (1, false), "{received:?}");
        }
    }
}

#[test]
fn on_interrupt_leave_does_not_stop_the_program() {
    let mut controller = Controller::new(|_| BlockFault::None);
    let child = controller.command("run sequential 1 --wait --on-interrupt leave").spawn().unwrap();
    controller.wait_for("@SPST 0001", 1);
    controller.wait_for("@STAS SNO=0", 2);
    signal(&child, "INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(errors(&output).contains("not stopped; the motion or program continues"), "{}", errors(&output));
    let (received, machine) = controller.end();
    assert!(machine.runs && count(&received, "@STOP") == 0, "{received:?}");
}

/// An order without an answer is sent only once, and its outcome is reported as unknown.
#[test]
fn an_unanswered_order_is_sent_once() {
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
        let controller =
            Controller::new(move |block| if block == order { BlockFault::NoAnswer } else { BlockFault::None });
        let output = controller.command(&format!("{words} --timeout 100ms")).output().unwrap();
        assert_eq!(output.status.code(), Some(6), "{words}: {}", errors(&output));
        assert!(errors(&output).contains("hint: "), "{words}: {}", errors(&output));
        let (received, _) = controller.end();
        assert_eq!(count(&received, order), 1, "{words}: {received:?}");
    }
}

/// A device server with a controller. It serves one connection after the other until the test ends. `fault` selects the
/// blocks at which it disconnects.
fn serve_connections(mut fault: impl FnMut(&str) -> BlockFault + Send + 'static) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("tcp://{}", listener.local_addr().unwrap());
    std::thread::spawn(move || {
        let mut machine = Machine::default();
        for stream in listener.incoming().map_while(Result::ok) {
            let mut writer = stream.try_clone().unwrap();
            for block in BufReader::new(stream).lines().map_while(Result::ok) {
                if fault(&block) == BlockFault::Disconnect {
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
    // The command runs without the inventory of the user. With an inventory, armctl shares the connection, and connects
    // later.
    command
        .env("XDG_STATE_HOME", state)
        .env("XDG_CONFIG_HOME", state)
        .args(["-t", url, "--yes", "toyo"])
        .args(words.split_ascii_whitespace());
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[test]
fn changes_of_a_killed_command_are_reported_until_they_are_undone() {
    let state = tempfile::tempdir().unwrap();
    let (sender, moves) = channel();
    let url = serve_connections(move |block| {
        if block == GO {
            sender.send(()).unwrap_or_default();
        }
        BlockFault::None
    });
    let mut jog = toyo(&url, state.path(), JOG).spawn().unwrap();
    moves.recv_timeout(Duration::from_secs(30)).unwrap();
    signal(&jog, "KILL");
    jog.wait().unwrap();
    let messages = || errors(&toyo(&url, state.path(), "position").output().unwrap());
    assert!(messages().contains("the host is still ON, and was OFF before; use `toyo host off`"));
    // The guardian stops the jog.
    assert!((0..1000).any(|_| !messages().contains("the robot still runs")), "{}", messages());
    let messages = errors(&toyo(&url, state.path(), "position").output().unwrap());
    assert!(!messages.contains("the robot still runs") && messages.contains("the host is still ON"), "{messages}");
    assert!(toyo(&url, state.path(), "host off").status().unwrap().success());
    toyo(&url, state.path(), "position").status().unwrap();
    let messages = errors(&toyo(&url, state.path(), "position").output().unwrap());
    assert_eq!(messages, "");
}

/// Sends a block as another client of the device server, and then disconnects.
fn send_as_other_client(url: &str, block: &str) {
    let mut stream = std::net::TcpStream::connect(url.trim_start_matches("tcp://")).unwrap();
    stream.write_all(format!("{block}\r\n").as_bytes()).unwrap();
    let mut answer = String::new();
    BufReader::new(&stream).read_line(&mut answer).unwrap();
    assert_eq!(answer, "@OK\r\n");
}

#[test]
fn a_host_switched_on_by_another_client_is_reported() {
    let state = tempfile::tempdir().unwrap();
    let url = serve_connections(|_| BlockFault::None);
    let messages = |words: &str| {
        let output = toyo(&url, state.path(), words).output().unwrap();
        assert!(output.status.success(), "{words}: {}", errors(&output));
        errors(&output)
    };
    assert_eq!(messages("status"), "");
    send_as_other_client(&url, "@HSON");
    let message = messages("status");
    assert!(message.contains("another client switched the host ON, which disables the start input"), "{message}");
    assert!(message.contains("use `toyo host off` to release the host"), "{message}");
    assert_eq!(
        messages("status --watch=20ms --count 3").matches("another client switched the host ON").count(),
        1,
        "the notice is printed once"
    );
    // The message appears only for a command that reads the host state.
    assert!(messages("stop").is_empty() && messages("position").is_empty());
    send_as_other_client(&url, "@SPST 0001");
    let message = messages("status");
    assert!(message.contains("another client switched the host ON and started a program"), "{message}");
    assert!(
        message.contains("use `toyo stop` to stop the program and `toyo host off` to release the host"),
        "{message}"
    );
    messages("stop");
    messages("host off");
    assert_eq!(messages("status"), "");
    // A host that this user has switched ON is not reported.
    messages("raw @HSON");
    assert_eq!(messages("status"), "");
    messages("host off");
    messages("host on");
    assert_eq!(messages("status"), "");
    send_as_other_client(&url, "@HSOF");
    assert_eq!(messages("status"), "");
    send_as_other_client(&url, "@HSON");
    assert!(messages("status").contains("another client switched the host ON"));
}

#[test]
fn a_task_selected_by_another_client_is_reported() {
    let state = tempfile::tempdir().unwrap();
    let url = serve_connections(|_| BlockFault::None);
    let messages = |words: &str| errors(&toyo(&url, state.path(), words).output().unwrap());
    assert_eq!(messages("task get"), "");
    send_as_other_client(&url, "@CTSK TASK=02");
    let message = messages("task get");
    assert!(message.contains("another client selected task 2"), "{message}");
    assert!(message.contains("use `toyo task set 1` to select task 1"), "{message}");
    messages("task set 2");
    assert_eq!(messages("task get"), "");
    send_as_other_client(&url, "@CTSK TASK=03");
    assert!(messages("task get").contains("another client selected task 3"));
    messages("task set 1");
    assert_eq!(messages("task get"), "");
}

#[test]
fn a_watch_continues_after_a_reconnect() {
    let state = tempfile::tempdir().unwrap();
    let mut position_reads = 0;
    let url = serve_connections(move |block| {
        position_reads += u32::from(block == "@MPST");
        if block == "@MPST" && position_reads == 3 { BlockFault::Disconnect } else { BlockFault::None }
    });
    let watch = toyo(&url, state.path(), "position --watch=50ms --count 6 -o jsonl").output().unwrap();
    assert!(watch.status.success(), "{}", errors(&watch));
    let lines = String::from_utf8_lossy(&watch.stdout).into_owned();
    let ok: Vec<bool> = lines.lines().map(|line| line.contains(r#""ok":true"#)).collect();
    assert_eq!(ok, [true, true, false, true, true, true], "{lines}");
    // With `--until`, the watch also continues after a lost connection.
    let mut position_reads = 0;
    let url = serve_connections(move |block| {
        position_reads += u32::from(block == "@STAS SNO=0");
        if block == "@STAS SNO=0" && position_reads == 2 { BlockFault::Disconnect } else { BlockFault::None }
    });
    let mut until = toyo(&url, state.path(), "status --watch=50ms");
    let until = until.args(["--until", ".data.servo_on and false", "--count", "4"]).output().unwrap();
    assert_eq!(until.status.code(), Some(8), "{}", errors(&until));
}

/// Only one program can use a serial port. The error names the process that uses the port, and the command that ends
/// this process.
#[test]
fn a_busy_serial_port_names_the_process_that_uses_it() {
    let folder = tempfile::tempdir().unwrap();
    let simulator = Simulator::start_with("toyo", &["--pty"]);
    let mut home = toyo(&simulator.url, folder.path(), "home --no-session -vv").spawn().unwrap();
    let mut messages = BufReader::new(home.stderr.take().unwrap()).lines().map_while(Result::ok);
    assert!(messages.any(|line| line.contains("-> @HOME")), "the origin return did not start");
    let stop = toyo(&simulator.url, folder.path(), "stop --no-session").output().unwrap();
    let pid = home.id();
    assert_eq!(stop.status.code(), Some(4), "{}", errors(&stop));
    for part in [
        format!("another armctl, process {pid}, uses "),
        format!("hint: use `kill {pid}` to stop its motion and end it"),
    ] {
        assert!(errors(&stop).contains(&part), "{part}: {}", errors(&stop));
    }
    // The command in the hint works: the process stops its motion and releases the port.
    signal(&home, "TERM");
    assert_eq!(home.wait().unwrap().code(), Some(130));
    let status = toyo(&simulator.url, folder.path(), "status --json --jq .data.running --no-session").output().unwrap();
    assert_eq!(String::from_utf8_lossy(&status.stdout).trim(), "false", "{}", errors(&status));
}
