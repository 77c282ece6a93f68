//! Runs the binary with its own simulator over real sockets: faults of the link, ownership of the controller, Ctrl-C.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Seek as _, Write as _};
use std::net::{Ipv4Addr, SocketAddrV4};
use std::process::{Child, ChildStdin, Command, Output, Stdio};
use std::time::{Duration, Instant};

use armctl_controller::yrcx::image::{COMMAND_WORDS, Image};
use armctl_controller::yrcx::signal::output;
use armctl_transport::eip::adapter::server::{AdapterAddresses, Server};
use armctl_transport::eip::adapter::{Application, Event, Setup};
use armctl_transport::eip::wire::{Identity, Revision};
use serde_json::{Value, json};

fn armctl() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env_clear().stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// `armctl sim yrcx` on free ports; it ends with the test.
struct Simulator {
    process: Child,
    console: ChildStdin,
    target: String,
}

impl Simulator {
    fn start(arguments: &[&str]) -> Self {
        Self::start_at("127.0.0.1:0", arguments).unwrap()
    }

    /// Starts a simulator at an address, or returns why it did not start.
    fn start_at(address: &str, arguments: &[&str]) -> Result<Self, String> {
        let mut command = armctl();
        command.args(["sim", "yrcx", "--bind", address, "--console", "--jq", ".data.target"]).args(arguments);
        let errors = tempfile::tempfile().unwrap();
        command.stdin(Stdio::piped()).stderr(errors.try_clone().unwrap());
        let mut process = command.spawn().unwrap();
        let mut target = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut target).unwrap();
        let console = process.stdin.take().unwrap();
        let simulator = Self { process, console, target: target.trim_end().to_owned() };
        if simulator.target.is_empty() { Err(text_of(errors)) } else { Ok(simulator) }
    }

    fn run(&self, line: &str) -> Output {
        self.command(line).output().unwrap()
    }

    fn command(&self, line: &str) -> Command {
        let mut command = armctl();
        command.args(["-t", &self.target, "--timeout", "400ms", "--yes"]).args(line.split(' '));
        command
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Text of a file that another process has written.
fn text_of(mut file: File) -> String {
    file.rewind().unwrap();
    std::io::read_to_string(file).unwrap()
}

/// Exit code and stderr.
fn failure_of(output: &Output) -> (i32, String) {
    (output.status.code().unwrap(), String::from_utf8(output.stderr.clone()).unwrap())
}

#[test]
fn every_adapter_fault_has_an_exit_code() {
    for (fault, exit, part) in [
        ("mute", 4, "no answer to"),
        ("reset", 4, "ended before"),
        ("stall", 4, "sends no data"),
        ("wrong-id", 4, "sends no data"),
        ("wrong-size", 4, "sends no data"),
        ("garbage", 5, "cannot decode"),
    ] {
        let output = Simulator::start(&["--fault", fault]).run("yrcx info servo");
        let (code, stderr) = failure_of(&output);
        assert!(code == exit && stderr.contains(part), "{fault}: {code} {stderr}");
        assert!(output.stdout.is_empty(), "{fault}");
    }
}

#[test]
fn survives_lost_and_duplicated_images() {
    for fault in ["--fault=half-rate", "--fault=double", "--fault=drop=10%,dup=10%,reorder=10%,seed=7"] {
        let output = Simulator::start(&[fault]).run("yrcx info servo --json");
        assert!(output.status.success(), "{fault}: {:?}", failure_of(&output));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["data"]["axes"][3]["state"], "servo");
    }
}

#[test]
fn one_owner_and_several_listeners() {
    let simulator = Simulator::start(&[]);
    let mut owner = simulator.command("yrcx info servo --watch 1h -o jsonl").spawn().unwrap();
    BufReader::new(owner.stdout.take().unwrap()).lines().next().unwrap().unwrap();
    let mut watch = simulator.command("yrcx io watch alarm -o jsonl").spawn().unwrap();
    let mut told = BufReader::new(watch.stdout.take().unwrap()).lines();
    told.next().unwrap().unwrap();

    let (code, stderr) = failure_of(&simulator.run("yrcx status --full"));
    assert!(code == 3 && stderr.contains("[0x0106]") && stderr.contains("another master"), "{code} {stderr}");
    assert!(stderr.contains("`armctl yrcx io get` and `armctl yrcx status` can read the signals"), "{stderr}");
    let mut listener = armctl();
    listener.args([
        "-t",
        &format!("{}?role=input_only&out=238", simulator.target),
        "yrcx",
        "io",
        "get",
        "cpu-ok",
        "--json",
    ]);
    let heard: Value = serde_json::from_slice(&listener.output().unwrap().stdout).unwrap();
    assert_eq!(heard["data"]["items"][0]["value"], true);

    let mut console = &simulator.console;
    writeln!(console, "estop on").unwrap();
    let change: Value = serde_json::from_str(&told.next().unwrap().unwrap()).unwrap();
    assert_eq!(
        (&change["data"]["items"][0]["name"], &change["data"]["items"][0]["value"]),
        (&"alarm".into(), &true.into())
    );
    for mut child in [watch, owner] {
        interrupt(&child);
        assert_eq!(child.wait().unwrap().code(), Some(130));
    }
}

#[test]
fn monitoring_does_not_disturb_the_owner() {
    let simulator = Simulator::start(&[]);
    let mut owner = simulator.command("yrcx info servo --watch 1h -o jsonl").spawn().unwrap();
    BufReader::new(owner.stdout.take().unwrap()).lines().next().unwrap().unwrap();
    // None of these commands opens an owner connection, because the controller would refuse a second owner.
    for line in ["yrcx status", "status", "yrcx io get", "yrcx io watch --count 1", "yrcx auto-mode"] {
        let output = simulator.run(line);
        let (code, stderr) = failure_of(&output);
        assert!(code == 0 && stderr.is_empty(), "{line}: {code} {stderr}");
    }
    let seen = simulator.run("yrcx status --json").stdout;
    let seen: Value = serde_json::from_slice(&seen).unwrap();
    assert_eq!((&seen["data"]["servos"], &seen["data"]["joints"]), (&Value::Null, &Value::Null));
    assert!(seen["data"]["not_asked"].as_str().unwrap().contains("--full"));
    let (code, stderr) = failure_of(&simulator.run("yrcx io get SI06"));
    assert!(code == 2 && stderr.contains("can be read only by the client that commands"), "{code} {stderr}");
    interrupt(&owner);
    assert_eq!(owner.wait().unwrap().code(), Some(130));
}

#[test]
fn listens_to_a_board_without_readable_assemblies() {
    let output = Simulator::start(&["--fault", "unreadable"]).run("yrcx io get cpu-ok --json");
    let heard: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(heard["data"]["items"][0]["value"], true);
}

#[test]
fn built_in_simulator_supports_faults() {
    let run = |url: &str| armctl().args(["-t", url, "--timeout", "400ms", "yrcx", "info", "servo"]).output().unwrap();
    for url in ["sim:?fault=drop=5%25,seed=7", "sim:?fault=double", "sim:?fault=half-rate"] {
        assert!(run(url).status.success(), "{url}: {:?}", failure_of(&run(url)));
    }
    for (url, exit, part) in [
        ("sim:?fault=stall", 4, "sends no data"),
        ("sim:?fault=mute", 4, "within 400 ms"),
        ("sim:?fault=garbage", 5, "cannot decode"),
        ("sim:?fault=none", 2, "wrong-sequence"),
        ("sim:?fault=busy=5%25", 2, "unknown fault 'busy'; the faults are drop, dup"),
    ] {
        let (code, stderr) = failure_of(&run(url));
        assert!(code == exit && stderr.contains(part), "{url}: {code} {stderr}");
    }
}

#[test]
fn interrupt_stops_the_motion_and_reports_it() {
    let simulator = Simulator::start(&[]);
    let mut moving = simulator.command("yrcx move --to 900,0,0,0 --speed-of-max 1 --yes -vv").spawn().unwrap();
    let mut stderr = BufReader::new(moving.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("<- WO 0100") {
        line.clear();
        assert!(stderr.read_line(&mut line).unwrap() > 0, "it never ran");
    }
    interrupt(&moving);
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).unwrap();
    assert_eq!(moving.wait().unwrap().code(), Some(130));
    assert!(rest.contains("-> SI(06) off") && rest.contains("-> SI(06) on"), "{rest}");
    assert!(rest.contains("interrupted: the robot was stopped by the stop input SI(06), which is on again"), "{rest}");
}

#[test]
fn records_packets_with_their_ports() {
    let simulator = Simulator::start(&[]);
    let file = tempfile::NamedTempFile::new().unwrap();
    let output = simulator.run(&format!("yrcx info servo --trace {}", file.path().display()));
    assert!(output.status.success());
    let record = std::fs::read(file.path()).unwrap();
    let holds = |bytes: &[u8]| record.windows(bytes.len()).any(|window| window == bytes);
    let port: u16 = simulator.target.rsplit(':').next().unwrap().parse().unwrap();
    assert!(holds(&port.to_be_bytes()));
    // RegisterSession, and WI0 of the command in an image.
    assert!(holds(&[0x65, 0, 4, 0]) && holds(&[0x03, 0x05, 0, 0, 0, 0]));
}

#[test]
fn tshark_decodes_the_recording() {
    // A separate address with free default ports: tshark recognizes the protocol by them.
    const ADDRESS: &str = "127.44.18.61";
    let has_tshark = Command::new("tshark").arg("--version").output().is_ok_and(|output| output.status.success());
    assert!(has_tshark || std::env::var_os("CI").is_none(), "tshark belongs to the set-up of .ci/run");
    if !has_tshark {
        return println!("skipped: there is no tshark");
    }
    if std::net::UdpSocket::bind((ADDRESS, 2222)).is_err() {
        return println!("skipped: {ADDRESS} has no free port 2222 here");
    }
    // Clients of other tests use UDP port 2222 of all addresses for a short time.
    let deadline = Instant::now() + Duration::from_secs(60);
    let simulator = loop {
        match Simulator::start_at(ADDRESS, &[]) {
            Ok(simulator) => break simulator,
            Err(why) => assert!(why.contains("address already in use") && Instant::now() < deadline, "{why}"),
        }
    };
    let file = tempfile::NamedTempFile::new().unwrap();
    let read = |line: &str, filter: &str, fields: &[&str]| {
        let output = simulator.run(&format!("{line} --trace {}", file.path().display()));
        assert!(output.status.success(), "{:?}", failure_of(&output));
        let shown = |filter: &str, fields: &[&str]| {
            let mut tshark = Command::new("tshark");
            tshark.arg("-r").arg(file.path()).args(["-Y", filter, "-T", "fields", "-E", "separator=|"]);
            let output = tshark.args(fields.iter().flat_map(|field| ["-e", field])).output().unwrap();
            assert!(output.status.success(), "{}", failure_of(&output).1);
            String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(shown("_ws.malformed || _ws.expert.severity == error", &["frame.number"]), [""; 0], "{line}");
        shown(filter, fields)
    };
    let opened = read("yrcx info servo", "cip.cm.sc == 0x54", &["cip.rr", "cip.cm.fwo.consize", "cip.genstat"]);
    assert_eq!(opened.len(), 2, "{opened:?}");
    assert!(opened[0].contains("54,50") && opened[1].ends_with("0x00"), "{opened:?}");
    // Images to the controller have a run/idle header. Images from the controller have no such header.
    let images = read("yrcx info servo", "cipio", &["udp.length"]);
    assert!(images.iter().any(|length| length == "80") && images.iter().any(|length| length == "76"), "{images:?}");
    assert!(images.iter().all(|length| ["80", "76"].contains(&length.as_str())), "{images:?}");
    // Monitoring opens no connection, and the refused request is also in the recording.
    assert_eq!(read("yrcx io get", "cip.cm.sc == 0x54 || cipio", &["frame.number"]), [""; 0]);
    assert_eq!(read("yrcx io get", "cip.sc == 0x0e && cip.rr == 1", &["cip.genstat"]).last().unwrap(), "0x00");
    assert_eq!(read("yrcx eip identity", "enip.lir.vendor", &["enip.lir.vendor"]).last().unwrap(), "0x027c");
}

fn interrupt(child: &Child) {
    let sent = Command::new("kill").args(["-s", "INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

/// A controller that refuses some remote commands, and answers all others like clock commands.
struct Refusing {
    commands: &'static [u16],
    shown: Image,
}

impl Refusing {
    fn start(commands: &'static [u16]) -> (Server<Self>, String) {
        let identity = Identity {
            address: SocketAddrV4::new(Ipv4Addr::LOCALHOST, 44818),
            vendor: 636,
            device_type: 43,
            product: 5,
            revision: Revision { major: 1, minor: 2 },
            status: 0,
            serial: 1,
            name: "RCX".to_owned(),
            state: Some(3),
        };
        let mut shown = Image::default();
        output::CPU_OK.set(&mut shown, true);
        let setup = Setup::new(identity, (100, 48), (150, 48), 1);
        let listen = AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST);
        let server = Server::start(setup, Self { commands, shown }, listen, None).unwrap();
        let target = format!("eip://{}?rpi=5ms&multiplier=512", server.address());
        (server, target)
    }
}

impl Application for Refusing {
    fn image_out(&mut self, _: Duration, _: u32, image: &[u8], _: bool) {
        let Some(given) = Image::from_bytes(image) else { return };
        let command = given.command()[0] & 0x0FFF;
        let mut words = [0; COMMAND_WORDS];
        let answer: [u16; 5] = match command {
            0 => [0; 5],
            refused if self.commands.contains(&refused) => [0x4000, 5, 1, 0, 0],
            0x511 => [0x0200, 0, 26, 3, 1],
            _ => [0x0200, 0, 8, 45, 0],
        };
        words[..5].copy_from_slice(&answer);
        self.shown.set_command(&words);
    }

    fn image_in(&mut self, _: Duration, _: u32, image: &mut [u8]) {
        image.copy_from_slice(&self.shown.to_bytes());
    }

    fn event(&mut self, _: Duration, _: &Event) {}
}

#[test]
fn date_and_time_have_separate_results() {
    let told = |refused: &'static [u16], line: &str| {
        let (_server, target) = Refusing::start(refused);
        let mut command = armctl();
        command.args(["-t", &target, "--yes", "--json", "-q", "yrcx", "clock"]).args(line.split(' '));
        let Output { status, stdout, stderr } = command.output().unwrap();
        let json = |bytes: &[u8]| serde_json::from_slice(bytes).unwrap_or(Value::Null);
        (status.code(), json(&stdout), json(&stderr))
    };
    let (exit, clock, error) = told(&[], "get");
    assert_eq!((exit, &clock["data"]["time"]), (Some(0), &json!("2026-03-01T08:45:00")), "{error}");
    let (exit, clock, _) = told(&[0x511], "get");
    let data = &clock["data"];
    assert_eq!((exit, &data["date"], &data["time_of_day"]), (Some(9), &json!(null), &json!("08:45:00")), "{clock}");
    assert_eq!((&data["errors"][0]["asked"], &data["errors"][0]["code"]), (&json!("date"), &json!("5.1")));
    assert!(data["errors"][0]["message"].as_str().unwrap().contains("date-get"), "{clock}");
    let (exit, clock, _) = told(&[0x512], "get");
    let data = &clock["data"];
    assert_eq!((exit, &data["date"], &data["time_of_day"]), (Some(9), &json!("2026-03-01"), &json!(null)), "{clock}");
    let (exit, _, error) = told(&[0x511, 0x512], "get");
    assert_eq!((exit, &error["error"]["code"]), (Some(3), &json!("5.1")), "{error}");
    let (exit, clock, _) = told(&[0x602], "set 2026-03-01T08:45:00");
    let data = &clock["data"];
    let items = [&data["items"][0]["ok"], &data["items"][1]["ok"], &data["items"][1]["new"]];
    assert_eq!((exit, items), (Some(9), [&json!(false), &json!(true), &json!("08:45:00")]), "{clock}");
}
