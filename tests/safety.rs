//! Dangerous cases, tested with the program and faulty controllers: commands sent twice, motions without confirmation,
//! motions that move unread axes to 0, a Ctrl-C that does not stop the robot.

#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Read as _};
use std::net::UdpSocket;
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::support::simulator::Simulator;

/// Command, instance, service and data of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
struct ReceivedRequest {
    command: u16,
    instance: u16,
    service: u8,
    data: Vec<u8>,
}

impl ReceivedRequest {
    /// `None` for a late datagram to the process that had this port before.
    fn parse(frame: &[u8]) -> Option<Self> {
        let (header, data) = frame.split_at_checked(32).filter(|(header, _)| header.starts_with(b"YERC"))?;
        let word = |at: usize| u16::from_le_bytes([header[at], header[at + 1]]);
        Some(Self { command: word(24), instance: word(26), service: header[29], data: data.to_vec() })
    }

    /// Whether the request only reads (FS and DX 3.3, 3.4.3, 3.4.4).
    fn is_read(&self) -> bool {
        matches!(self.service, 0x01 | 0x0E | 0x32 | 0x33)
    }
}

/// How a controller reacts to a request.
enum Reaction {
    Silence,
    Answer(Vec<u8>),
    Refuse(u16),
}

/// A controller with two UDP ports. It stores all requests.
struct Controller {
    url: String,
    requests: Arc<Mutex<Vec<ReceivedRequest>>>,
    /// Gets every received request.
    request_added: Receiver<ReceivedRequest>,
    is_over: Arc<AtomicBool>,
    servers: Vec<JoinHandle<()>>,
}

impl Controller {
    fn new(react: impl FnMut(&ReceivedRequest) -> Reaction + Send + 'static) -> Self {
        let (tell, request_added) = channel();
        let (requests, is_over) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicBool::new(false)));
        let react = Arc::new(Mutex::new(react));
        let mut ports = Vec::new();
        let servers = (0..2).map(|_| {
            let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
            socket.set_read_timeout(Some(Duration::from_millis(20))).expect("a timeout");
            ports.push(socket.local_addr().expect("an address").port());
            let (tell, asked, over, react) = (tell.clone(), requests.clone(), is_over.clone(), react.clone());
            std::thread::spawn(move || {
                let mut buffer = [0; 2048];
                while !over.load(Ordering::Relaxed) {
                    let Ok((len, from)) = socket.recv_from(&mut buffer) else { continue };
                    let Some(request) = ReceivedRequest::parse(&buffer[..len]) else { continue };
                    let reaction = (react.lock().expect("no panic"))(&request);
                    asked.lock().expect("no panic").push(request.clone());
                    if let Some(frame) = answer(&buffer[..len], reaction) {
                        socket.send_to(&frame, from).expect("sent");
                    }
                    let _gone = tell.send(request);
                }
            })
        });
        let servers = servers.collect();
        let url = format!("udp://127.0.0.1:{}?file_port={}&model=dx200", ports[0], ports[1]);
        Self { url, requests, request_added, is_over, servers }
    }

    /// Starts a command line without a terminal.
    fn start(&self, words: &str) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.args(["-t", &self.url, "yerc"]).args(words.split_ascii_whitespace());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().expect("armctl starts")
    }

    fn run(&self, words: &str) -> Output {
        self.start(words).wait_with_output().expect("armctl ends")
    }

    /// Waits until a matching request arrives.
    fn wait_for(&self, wanted: impl Fn(&ReceivedRequest) -> bool) {
        while !wanted(&self.request_added.recv_timeout(Duration::from_secs(30)).expect("the request comes")) {}
    }

    /// Requests that are not reads.
    fn changes(&self) -> Vec<ReceivedRequest> {
        self.requests.lock().expect("no panic").iter().filter(|asked| !asked.is_read()).cloned().collect()
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        for server in self.servers.drain(..) {
            let _ended = server.join();
        }
    }
}

fn answer(request: &[u8], reaction: Reaction) -> Option<Vec<u8>> {
    let (status, added, data) = match reaction {
        Reaction::Silence => return None,
        Reaction::Answer(data) => (0, 0, data),
        Reaction::Refuse(added) => (0x1F, added, Vec::new()),
    };
    let size = u16::try_from(data.len()).expect("short");
    let mut frame = [b"YERC\x20\0", &size.to_le_bytes()[..], &[3, request[9], 1, request[11], 0, 0, 0, 0x80]].concat();
    frame.extend(b"99999999");
    frame.extend([request[29] | 0x80, status, u8::from(added != 0), 0]);
    frame.extend(u32::from(added).to_le_bytes());
    frame.extend(data);
    Some(frame)
}

fn words(words: &[i32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// A robot R1 with servo power. It moves after a motion command and stops at HOLD.
fn robot(mut peculiar: impl FnMut(&ReceivedRequest) -> Option<Reaction> + Send + 'static) -> Controller {
    let (mut x, mut moving) = (0, false);
    Controller::new(move |asked| {
        if let Some(reaction) = peculiar(asked) {
            moving |= matches!((asked.command, &reaction), (0x86 | 0x8A | 0x8B, Reaction::Answer(_)));
            return reaction;
        }
        Reaction::Answer(match (asked.command, asked.instance) {
            (0x75, 1) => {
                x += i32::from(moving) * 500;
                words(&[0, 0, 0, 0, 0, x, 0, 0, 0, 0, 0])
            }
            (0x75, _) => return Reaction::Refuse(0xA001),
            // Mode play, one cycle, remote control by commands, servo on.
            (0x72, _) => words(&[0xC2 | i32::from(moving) << 3, 0x40]),
            (0x86 | 0x8A | 0x8B, _) => {
                moving = true;
                Vec::new()
            }
            (0x83, 1) => {
                moving = false;
                Vec::new()
            }
            _ => Vec::new(),
        })
    })
}

fn interrupt(child: &Child) {
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

const MOVE: &str = "move pulse joint --pulses 90000,0,0,0,0,0 --speed 10% --yes";
const HOLD_ON: &[u8] = &[1, 0, 0, 0];

/// Every state-changing command, and the query in the message with which the user can find out the outcome.
const ORDERS: [(&str, &str); 24] = [
    ("servo on --yes", "yerc status"),
    ("servo off --yes", "yerc status"),
    ("hold off", "yerc status"),
    ("hlock on", "yerc status"),
    ("hlock off", "yerc status"),
    ("cycle once", "yerc status"),
    ("say HELLO", "pendant"),
    ("alarm reset", "yerc alarm list"),
    ("alarm cancel", "yerc alarm list"),
    ("job select A", "yerc job show"),
    ("job start --yes", "yerc job show"),
    ("var set B0=1", "yerc var get"),
    ("var set B0=1 B1=2", "yerc var get"),
    ("var set S0=A", "yerc var get"),
    ("var set P1=pulse:s=1,l=2,u=3,r=4,b=5,t=6 --yes", "yerc var get"),
    ("io set --group 2701=3", "yerc io get"),
    ("io set --group 2701=3 --group 2702=4", "yerc io get"),
    ("register set 1=2", "yerc register get"),
    ("register set 1=2 2=3", "yerc register get"),
    ("move relative --z 1 --speed 1mm/s --no-wait --yes", "yerc position"),
    ("file delete A.JBI --yes", "yerc file list"),
    ("file put Cargo.toml --as A.CND --yes", "yerc file diff A.CND"),
    ("file cmos --start-only --wait 300ms", "--download-only"),
    ("raw --command 0x8D --instance 1 --attribute 1 --service 0x10 --data 01000000 --yes", "yerc status"),
];

#[test]
fn sends_a_command_once_and_reports_an_unknown_outcome() {
    std::thread::scope(|scope| {
        for (order, hint) in ORDERS {
            scope.spawn(move || {
                // The command is sent even if the controller refuses a read before it: here, the position is not
                // defined yet.
                let controller =
                    Controller::new(|asked| if asked.is_read() { Reaction::Refuse(0xB005) } else { Reaction::Silence });
                let output = controller.run(&format!("{order} --timeout 700ms --retries 9"));
                assert_eq!(output.status.code(), Some(6), "{order}: {}", stderr(&output));
                assert_eq!(controller.changes().len(), 1, "{order}");
                assert!(stderr(&output).contains(hint), "{order}: {}", stderr(&output));
            });
        }
    });
}

/// The timeout applies to each attempt, and the retries are additional attempts.
#[test]
fn sends_a_read_once_plus_retries() {
    for (retries, within) in [(0, "300ms"), (2, "900ms"), (4, "1.5s")] {
        let controller = Controller::new(|_| Reaction::Silence);
        let output = controller.run(&format!("status --timeout 300ms --retries {retries}"));
        assert_eq!(output.status.code(), Some(4), "{}", stderr(&output));
        assert!(stderr(&output).contains(&format!("no answer within {within}\n")), "{}", stderr(&output));
        let requests = controller.requests.lock().unwrap().clone();
        assert_eq!(requests.len(), retries + 1, "{requests:?}");
        assert!(requests.windows(2).all(|pair| pair[0] == pair[1]), "{requests:?}");
    }
}

/// To set one signal, its group of eight signals is read, changed and written. If the read fails, nothing is written.
#[test]
fn does_not_write_a_signal_of_an_unread_group() {
    let controller = Controller::new(|_| Reaction::Silence);
    let output = controller.run("io set 27010=on --timeout 400ms");
    assert_eq!((output.status.code(), controller.changes()), (Some(4), Vec::new()), "{}", stderr(&output));
}

#[test]
fn motion_needs_confirmation_and_dry_run_sends_nothing() {
    let controller = robot(|_| None);
    for order in [
        "servo on",
        "job start",
        MOVE.trim_end_matches(" --yes"),
        "raw --command 0x86 --instance 1 --attribute 1 --service 0x10 --data 01000000",
        "raw --command 0x83 --instance 2 --attribute 1 --service 0x10 --data 01000000",
        "raw --command 0x90 --instance 1 --service 0x01",
    ] {
        let output = controller.run(order);
        assert_eq!(output.status.code(), Some(7), "{order}: {}", stderr(&output));
        assert!(stderr(&output).contains("--yes"), "{order}: {}", stderr(&output));
    }
    for (order, _) in ORDERS {
        let output = controller.run(&format!("{order} --dry-run"));
        assert_eq!(output.status.code(), Some(0), "{order}: {}", stderr(&output));
    }
    assert_eq!(*controller.requests.lock().unwrap(), []);
}

#[test]
fn read_only_robot_refuses_commands_even_with_yes() {
    let controller = robot(|_| None);
    let folder = tempfile::tempdir().unwrap();
    let inventory = folder.path().join("robots.toml");
    let entry =
        format!("[[robot]]\nname = \"cell\"\nfamily = \"yerc\"\ntarget = \"{}\"\nread_only = true\n", controller.url);
    std::fs::write(&inventory, &entry).unwrap();
    let run = |words: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.arg("--config").arg(&inventory).args(["-r", "cell", "yerc"]).args(words.split_ascii_whitespace());
        command.env("HOME", folder.path()).output().unwrap()
    };
    for order in ["hold off --yes", "servo on --yes", "var set B0=1 --yes", "job select A", MOVE, "file delete A.JBI"] {
        let output = run(order);
        assert_eq!(output.status.code(), Some(7), "{order}: {}", stderr(&output));
        assert!(stderr(&output).contains("read-only"), "{order}: {}", stderr(&output));
    }
    assert_eq!(*controller.requests.lock().unwrap(), []);
    // A stop is always allowed, also on a read-only robot.
    assert_eq!(run("hold on").status.code(), Some(0));
    assert_eq!(run("status").status.code(), Some(0));
}

#[test]
fn refuses_numbers_and_robots_that_could_be_meant_differently() {
    let controller = robot(|_| None);
    for line in ["move relative --z 5 --speed 10 --yes", "move relative --z 2,5 --speed 10mm/s --yes"] {
        let output = controller.run(line);
        assert_eq!(output.status.code(), Some(2), "{line}: {}", stderr(&output));
    }
    assert_eq!(*controller.requests.lock().unwrap(), []);
    let folder = tempfile::tempdir().unwrap();
    let inventory = folder.path().join("robots.toml");
    let entry =
        |name: &str| format!("[[robot]]\nname = \"{name}\"\nfamily = \"yerc\"\ntarget = \"{}\"\n", controller.url);
    std::fs::write(&inventory, entry("left") + &entry("right").replace("127.0.0.1", "127.0.0.2")).unwrap();
    for words in [&["yerc", "servo", "on", "--yes"][..], &["-r", "lefft", "yerc", "servo", "on", "--yes"]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        let output = command.arg("--config").arg(&inventory).args(words).env("HOME", folder.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{words:?}: {}", stderr(&output));
    }
    assert_eq!(*controller.requests.lock().unwrap(), []);
}

/// A pattern can match any number of robots. Therefore, a motion requires the name of each robot.
#[test]
fn patterns_do_not_move_robots() {
    let controllers = [robot(|_| None), robot(|_| None)];
    let folder = tempfile::tempdir().unwrap();
    let inventory = folder.path().join("robots.toml");
    let [left, right] = [&controllers[0].url, &controllers[1].url];
    let entry =
        |name: &str, url: &str| format!("[[robot]]\nname = \"{name}\"\nfamily = \"yerc\"\ntarget = \"{url}\"\n");
    std::fs::write(&inventory, entry("cell1", left) + &entry("cell2", right)).unwrap();
    let run = |robots: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.arg("--config").arg(&inventory).args(robots).args(["yerc", "job", "start", "--yes"]);
        command.env("HOME", folder.path()).output().unwrap()
    };
    for robots in [&["--all"][..], &["-r", "cell*"], &["-r", "*1", "-r", "*2"], &["-r", "cell1", "-r", "*2"]] {
        let output = run(robots);
        assert_eq!(output.status.code(), Some(7), "{robots:?}: {}", stderr(&output));
    }
    assert!(controllers.iter().all(|controller| controller.changes().is_empty()));
    let output = run(&["-r", "cell1", "-r", "cell2"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(controllers.iter().all(|controller| controller.changes().len() == 1));
}

/// A controller can refuse to report axes, because it is busy or a screen is open. Unread axes must not count as 0.
#[test]
fn does_not_move_unread_axes_to_zero() {
    for (instance, code) in [(11, 0xD8FA), (11, 0x2150), (11, 0xCFFF), (1, 0x3070)] {
        let controller =
            robot(move |asked| (asked.command == 0x75 && asked.instance == instance).then_some(Reaction::Refuse(code)));
        let output = controller.run(&format!("{MOVE} --no-wait --timeout 500ms"));
        assert_eq!(output.status.code(), Some(3), "{code:#x}: {}", stderr(&output));
        assert!(stderr(&output).contains("nothing was sent"), "{code:#x}: {}", stderr(&output));
        assert_eq!(controller.changes(), [], "{code:#x}");
    }
    // If the command line names every axis, the current position is not needed.
    let controller = robot(|asked| (asked.command == 0x75).then_some(Reaction::Refuse(0x2150)));
    let all = "move pulse joint --pulses 1,2,3,4,5,6,0,0 --base-axes 0,0,0 --speed 10% --yes --no-wait";
    let output = controller.run(all);
    assert_eq!((output.status.code(), controller.changes().len()), (Some(0), 1), "{}", stderr(&output));
}

#[test]
fn unanswered_read_before_a_move_prevents_the_move() {
    for instance in [1, 11] {
        let silent = move |asked: &ReceivedRequest| {
            (asked.command == 0x75 && asked.instance == instance).then_some(Reaction::Silence)
        };
        let controller = robot(silent);
        let output = controller.run(&format!("{MOVE} --timeout 400ms"));
        assert_eq!((output.status.code(), controller.changes()), (Some(4), Vec::new()), "{}", stderr(&output));
    }
}

/// After the command is sent, Ctrl-C sends HOLD on: after an answer, without an answer, and during the motion.
#[test]
fn ctrl_c_stops_the_robot_first() {
    for (name, orders_are_answered, polls) in [("unanswered", false, 0), ("accepted", true, 0), ("under way", true, 3)]
    {
        let controller =
            robot(move |asked| (asked.command == 0x8B && !orders_are_answered).then_some(Reaction::Silence));
        let child = controller.start(&format!("{MOVE} --timeout 20s"));
        controller.wait_for(|asked| asked.command == 0x8B);
        for _ in 0..polls {
            controller.wait_for(|asked| asked.command == 0x72);
        }
        interrupt(&child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{name}: {}", stderr(&output));
        assert!(stderr(&output).contains("HOLD is on"), "{name}: {}", stderr(&output));
        let last = controller.changes().pop().unwrap();
        assert_eq!((last.command, last.instance, &last.data[..]), (0x83, 1, HOLD_ON), "{name}");
    }
}

/// The client repeats the stop until the controller confirms it, whatever the options are.
#[test]
fn repeats_a_lost_stop() {
    let mut lost_stop = 12;
    let controller = robot(move |asked| {
        lost_stop -= i32::from(asked.command == 0x83);
        (asked.command == 0x83 && lost_stop >= 0).then_some(Reaction::Silence)
    });
    let child = controller.start(&format!("{MOVE} --timeout 300ms --retries 0"));
    controller.wait_for(|asked| asked.command == 0x72);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stderr(&output).contains("stopping the robot") && stderr(&output).contains("HOLD is on"));
    assert_eq!(controller.changes().iter().filter(|asked| asked.command == 0x83).count(), 13);
}

/// Without an answer, the client repeats the stop for three seconds. It then reports that the stop is not confirmed.
#[test]
fn repeats_and_reports_an_unconfirmed_hold() {
    let controller = Controller::new(|_| Reaction::Silence);
    let output = controller.run("hold on --timeout 60s --retries 0");
    assert_eq!(output.status.code(), Some(6), "{}", stderr(&output));
    assert!(stderr(&output).contains("armctl cannot confirm that the robot is held"), "{}", stderr(&output));
    assert_eq!(controller.changes().len(), 15);
}

/// A second Ctrl-C, or a TERM, ends the process at once. Here, the stop is not confirmed yet.
#[test]
fn second_ctrl_c_ends_the_process_at_once() {
    for signal in ["INT", "TERM"] {
        let has_ended = Arc::new(AtomicBool::new(false));
        let is_silent = Arc::clone(&has_ended);
        let controller = robot(move |asked| {
            (asked.command == 0x83 && !is_silent.load(Ordering::Relaxed)).then_some(Reaction::Silence)
        });
        let mut child = controller.start(&format!("{MOVE} --timeout 600s"));
        controller.wait_for(|asked| asked.command == 0x72);
        interrupt(&child);
        controller.wait_for(|asked| asked.command == 0x83);
        // A signal that comes shortly after the first signal counts as the same signal, so the signal is repeated.
        while child.try_wait().unwrap().is_none() {
            // The process may have ended since the check.
            let pid = child.id().to_string();
            let _sent = Command::new("kill").args(["-s", signal, &pid]).stderr(Stdio::null()).status();
            std::thread::yield_now();
        }
        // The guardian of the process stops the robot, and holds stderr until then.
        has_ended.store(true, Ordering::Relaxed);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        assert!(stderr(&output).contains("again: armctl ended at once"), "{}", stderr(&output));
    }
}

#[test]
fn reports_a_failed_stop() {
    let controller = robot(|asked| (asked.command == 0x83).then_some(Reaction::Refuse(0x2100)));
    let child = controller.start(MOVE);
    controller.wait_for(|asked| asked.command == 0x72);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(stderr(&output).contains("may still move") && stderr(&output).contains("emergency stop"));
}

#[test]
fn on_interrupt_leave_sends_nothing_and_reports_it() {
    let controller = robot(|_| None);
    let child = controller.start(&format!("{MOVE} --on-interrupt leave"));
    controller.wait_for(|asked| asked.command == 0x72);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(stderr(&output).contains("continues"), "{}", stderr(&output));
    assert_eq!(controller.changes().len(), 1);
}

/// If Ctrl-C comes before this client has sent its command, the client does not stop the motion of another client.
#[test]
fn ctrl_c_before_the_command_sends_nothing() {
    let controller = robot(|asked| (asked.command == 0x75).then_some(Reaction::Silence));
    let child = controller.start(&format!("{MOVE} --timeout 20s"));
    controller.wait_for(|asked| asked.command == 0x75);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), controller.changes()), (Some(130), Vec::new()), "{}", stderr(&output));
    assert!(stderr(&output).contains("no motion command was sent"), "{}", stderr(&output));
}

/// armctl reports a capture file that it cannot write before it sends anything to the controller.
#[test]
#[cfg(target_os = "linux")]
fn reports_a_full_disk_of_a_trace_before_the_command() {
    let controller = robot(|_| None);
    let output = controller.run("servo off --yes --trace /dev/full");
    assert_eq!((output.status.code(), controller.changes()), (Some(1), Vec::new()), "{}", stderr(&output));
}

/// A controller serves one transfer at a time. It keeps an interrupted transfer open until a timer expires.
#[test]
fn interrupted_transfer_does_not_block_other_commands() {
    let folder = tempfile::tempdir().unwrap();
    // The files are so large that no transfer ends before it is interrupted.
    std::fs::write(folder.path().join("state.toml"), "[[file]]\nname = \"BIG.DAT\"\nsize = 67108864\n").unwrap();
    std::fs::write(folder.path().join("UP.CND"), vec![b'x'; 16 << 20]).unwrap();
    let state = folder.path().join("state.toml");
    let simulator = Simulator::start_with("yerc", &["--state", state.to_str().unwrap()]);
    let command = |words: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env("HOME", folder.path()).env("XDG_RUNTIME_DIR", folder.path()).current_dir(folder.path());
        command.args(["-t", &simulator.url, "yerc"]).args(words.split(' ')).stdin(Stdio::null());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    };
    let is_free = |after: &str| {
        let output = command("file list --timeout 300ms --retries 0").output().unwrap();
        assert_eq!(output.status.code(), Some(0), "after {after}: {}", stderr(&output));
    };

    let mut child = command("file get BIG.DAT --dir -").spawn().unwrap();
    child.stdout.as_mut().unwrap().read_exact(&mut [0; 1000]).unwrap();
    interrupt(&child);
    // The remaining output is read, so that it does not fill the pipe.
    let mut rest = Vec::new();
    child.stdout.take().unwrap().read_to_end(&mut rest).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    is_free("Ctrl-C in a download");

    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = command("file get BIG.DAT --dir -").stdout(full).spawn().unwrap().wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    is_free("a full disk");

    let mut child = command("file put UP.CND --yes -vv").spawn().unwrap();
    let mut message = BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok);
    assert!(message.any(|line| line.contains("data: file load, block 3")), "no block leaves");
    interrupt(&child);
    message.for_each(drop);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    is_free("Ctrl-C in an upload");
}
