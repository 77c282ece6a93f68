//! Runs the program for Windows under Wine: output, files, a serial port, sessions, the console. Simulated controllers
//! are processes of this system.
//!
//! `ARMCTL_WINE_EXE=PATH/armctl.exe cargo test --test wine` runs these tests; without the variable, or without Wine,
//! they are skipped. CONTRIBUTING.md has the commands that build the program for Windows.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod console;
#[path = "../support/simulator.rs"]
mod simulator;
#[path = "../support/terminal.rs"]
mod terminal;

use std::io::{BufRead as _, BufReader, Read as _, Seek as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use serde_json::Value;

use self::simulator::Simulator;

/// Program that sends events of a console.
const CONSOLE_EVENT: &str = "console_event.exe";
/// Time limit for a condition.
const PATIENCE: Duration = Duration::from_secs(60);

/// Windows, as Wine shows it to the program.
struct Wine {
    loader: PathBuf,
    prefix: PathBuf,
    program: PathBuf,
}

/// Wine with the program. Prints the reason if there is none.
#[expect(clippy::print_stderr, reason = "the output of a test")]
fn wine() -> Option<&'static Wine> {
    static WINE: OnceLock<Result<Wine, String>> = OnceLock::new();

    match WINE.get_or_init(Wine::prepare) {
        Ok(wine) => Some(wine),
        Err(why) => {
            eprintln!("skipped: {why}");
            None
        }
    }
}

impl Wine {
    fn prepare() -> Result<Self, String> {
        let program = std::env::var_os("ARMCTL_WINE_EXE").ok_or("ARMCTL_WINE_EXE does not name armctl.exe")?;
        let folders = std::env::var_os("PATH").unwrap_or_default();
        let folders = std::env::split_paths(&folders).chain(["/usr/lib/wine".into()]);
        let mut loaders = folders.map(|folder| folder.join("wine64"));
        let loader = loaders.find(|loader| loader.is_file()).ok_or("Wine is not installed")?;
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("wine");
        let (prefix, programs) = (folder.join("prefix"), folder.join("programs"));
        // What a test that failed has left, such as sessions.
        let _ = std::fs::remove_dir_all(prefix.join("drive_c/users"));
        std::fs::create_dir_all(&programs).unwrap();
        for name in ["armctl.exe", "toyo.exe"] {
            std::fs::copy(&program, programs.join(name)).map_err(|error| format!("{}: {error}", program.display()))?;
        }
        let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wine");
        let products =
            [("bcryptprimitives.c", "bcryptprimitives.dll", Some("-shared")), ("console_event.c", CONSOLE_EVENT, None)];
        for (source, product, kind) in products {
            let mut compiler = Command::new("x86_64-w64-mingw32-gcc");
            compiler.args(kind).arg("-o").arg(programs.join(product));
            compiler.arg(sources.join(source)).arg("-ladvapi32");
            let result = compiler.status().map_err(|error| format!("x86_64-w64-mingw32-gcc: {error}"))?;
            assert!(result.success(), "{source} does not compile");
        }
        let wine = Self { loader, prefix, program: programs.join("armctl.exe") };
        let started = wine.wine().args(["wineboot", "--init"]).status().unwrap();
        assert!(started.success(), "Wine does not start");
        Ok(wine)
    }

    fn wine(&self) -> Command {
        let mut command = Command::new("setpriv");
        if rustix::process::geteuid().is_root() {
            // Root can open any port, also one that belongs to another program.
            command.arg("--bounding-set=-sys_admin,-dac_override,-dac_read_search");
        }
        command.arg(&self.loader);
        command.env_clear().env("PATH", std::env::var_os("PATH").unwrap_or_default()).env("HOME", &self.prefix);
        command.env("WINEPREFIX", &self.prefix).env("WINEDEBUG", "-all").env("TZ", "UTC").stdin(Stdio::null());
        // Wine reads arguments in the encoding of the locale.
        command.env("LC_ALL", "C.UTF-8");
        command
    }

    /// Command line of the program for Windows.
    fn command(&self, folder: &Path, words: &str) -> Command {
        let mut command = self.wine();
        command.arg(&self.program).args(words.split(' ')).current_dir(folder);
        if folder.join("robots.toml").exists() {
            command.env("ARMCTL_CONFIG", windows_path(&folder.join("robots.toml")));
        }
        command
    }

    /// Runs a command with files for its output. Under Wine, a background process keeps the pipes of its starter open,
    /// although it inherits no handles.
    fn run(&self, folder: &Path, words: &str) -> Output {
        let [mut stdout, mut stderr] = [(); 2].map(|()| tempfile::tempfile().unwrap());
        let mut command = self.command(folder, words);
        command.stdout(stdout.try_clone().unwrap()).stderr(stderr.try_clone().unwrap());
        let status = command.status().unwrap();
        let [stdout, stderr] = [&mut stdout, &mut stderr].map(|file| {
            let mut bytes = Vec::new();
            file.rewind().unwrap();
            file.read_to_end(&mut bytes).unwrap();
            bytes
        });
        Output { status, stdout, stderr }
    }

    /// `data` of a command that must succeed.
    fn data(&self, folder: &Path, words: &str) -> Value {
        let output = self.run(folder, &format!("{words} --json"));
        assert!(output.status.success(), "{words}: {}", stderr(&output));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["data"].clone()
    }

    fn session(&self, folder: &Path, robot: &str) -> Option<Value> {
        let sessions = self.data(folder, "session list")["sessions"].clone();
        sessions.as_array().unwrap().iter().find(|session| session["robot"] == robot).cloned()
    }

    /// Maps a terminal of this system as a serial port. Returns the name of the port.
    fn map_port(&self, terminal: &Path) -> String {
        static LAST: AtomicU32 = AtomicU32::new(20);

        let port = format!("com{}", LAST.fetch_add(1, Ordering::Relaxed));
        let link = self.prefix.join("dosdevices").join(&port);
        let _ = std::fs::remove_file(&link);
        std::os::unix::fs::symlink(terminal.canonicalize().unwrap(), link).unwrap();
        port.to_uppercase()
    }
}

fn windows_path(path: &Path) -> String {
    format!("Z:{}", path.display()).replace('/', "\\")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Output of the same command on this system.
fn here(folder: &Path, words: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env_clear().env("HOME", folder).env("TZ", "UTC").args(words.split(' ')).current_dir(folder);
    command.stdin(Stdio::null()).output().unwrap()
}

fn inventory(folder: &Path, robots: &[(&str, &str, &str)]) {
    let entry = |(name, family, target): &(&str, &str, &str)| {
        format!("[[robot]]\nname = \"{name}\"\nfamily = \"{family}\"\ntarget = '{target}'\n")
    };
    std::fs::write(folder.join("robots.toml"), robots.iter().map(entry).collect::<String>()).unwrap();
}

fn until(what: &str, is_so: impl Fn() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < PATIENCE, "it never came to this: {what}");
    }
}

/// A pseudo-terminal has no parity.
const NO_PARITY: &str = "parity=none";

/// A simulator on a pseudo-terminal, ended when it is dropped.
struct SerialSimulator(Child);

impl SerialSimulator {
    fn start(folder: &Path) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.args(["sim", "toyo", "-q", "--pty", "--link"]).arg(folder.join("port"));
        let mut process = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
        Self(process)
    }
}

impl Drop for SerialSimulator {
    fn drop(&mut self) {
        self.0.kill().unwrap_or_default();
        let _ended = self.0.wait();
    }
}

/// A sample of the commands in README.md and docs/, and of errors.
const SAMPLE: [&str; 25] = [
    "--sim yerc status",
    "--sim yerc status --json",
    "--sim yerc position -o csv",
    "--sim yerc var get B0..B9",
    "--sim yerc var set B0=255 R3=2.5",
    "--sim yerc job list",
    "--sim yerc hold on --json",
    "--sim yerc alarm history --jq .data",
    "--sim yerc move linear --to 1,2,3,4,5,6 --speed 100mm/s --dry-run",
    "--sim yrcx status",
    "--sim yrcx info version --json",
    "--sim yrcx move --to 10,0,0,0 --speed-of-max 50 --dry-run",
    "--sim toyo status",
    "--sim toyo home --dry-run",
    "--sim toyo param list -o csv",
    "-t sim:?bus=profinet yrcx status",
    "-t sim:?bus=devicenet yrcx info servo --json",
    "-t udp://192.168.1.31 yerc servo on --dry-run --json",
    "explain toyo 28",
    "help sessions",
    "completions powershell",
    "schema yerc.status",
    "yerc status",
    "-t serial://COM3 yerc status",
    "-t udp://192.168.1.31 yerc hold of",
];

#[test]
fn prints_the_same_as_elsewhere() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    for words in SAMPLE {
        let (windows, unix) = (wine.run(folder.path(), words), here(folder.path(), words));
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        assert_eq!(text(&windows.stdout), text(&unix.stdout), "{words}: {}", stderr(&windows));
        assert_eq!(stderr(&windows), stderr(&unix), "{words}");
        assert_eq!(windows.status.code(), unix.status.code(), "{words}");
    }
}

#[test]
fn profinet_says_that_it_needs_linux() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    for words in [
        "-t profinet://robot-1@eth0?layout=0:0x1,1:0x101:i48,2:0x102:o48 --yes yrcx info version",
        "-t profinet://robot-1@eth0 yrcx io get",
        "-t profinet://robot-1@eth0 session open",
        "-t profinet://robot-1@eth0 --yes yrcx servo on",
    ] {
        let output = wine.run(folder.path(), words);
        assert_eq!(output.status.code(), Some(1), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains("PROFINET needs Linux: raw Ethernet"), "{words}: {}", stderr(&output));
    }
}

/// The name of a copy selects the family, but not for the processes that this copy starts.
#[test]
fn copy_with_a_family_name_is_its_subcommand() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut command = wine.wine();
    command.arg(wine.program.with_file_name("toyo.exe")).args(["--sim", "status", "--jq", ".command"]);
    let output = command.current_dir(folder.path()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "toyo.status", "{}", stderr(&output));
}

#[test]
fn transfers_files_with_names_in_japanese() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    let robot = Simulator::start("yerc");
    inventory(folder.path(), &[("cell", "yerc", &robot.url)]);
    let listed = wine.data(folder.path(), "-r cell yerc file list");
    let first = listed["files"][0]["name"].as_str().unwrap_or_else(|| panic!("{listed}")).to_owned();
    let got = wine.run(folder.path(), &format!("-r cell yerc file get {first}"));
    assert!(got.status.success(), "{}", stderr(&got));
    let job = std::fs::read(folder.path().join(&first)).unwrap();
    assert!(job.starts_with(b"/JOB"), "{first}");
    let name = "\u{642c}\u{9001}.JBI";
    let text = String::from_utf8(job).unwrap();
    let own = first.trim_end_matches(".JBI");
    let renamed = text.replacen(&format!("//NAME {own}"), "//NAME \u{642c}\u{9001}", 1);
    let (renamed, _, _) = encoding_rs::SHIFT_JIS.encode(&renamed);
    std::fs::write(folder.path().join(name), &renamed).unwrap();
    let put = wine.run(folder.path(), &format!("-r cell --encoding shift_jis yerc file put {name} --yes"));
    assert!(put.status.success(), "{}", stderr(&put));
    std::fs::remove_file(folder.path().join(name)).unwrap();
    let back = wine.run(folder.path(), &format!("-r cell --encoding shift_jis yerc file get {name}"));
    assert!(back.status.success(), "{}", stderr(&back));
    assert_eq!(std::fs::read(folder.path().join(name)).unwrap(), *renamed);
}

#[test]
fn reads_a_serial_port_and_says_when_it_is_gone() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    let robot = SerialSimulator::start(folder.path());
    let port = wine.map_port(&folder.path().join("port"));
    for target in [&port, &port.to_lowercase(), &format!(r"\\.\{port}")] {
        let output = wine.run(folder.path(), &format!("-t serial://{target}?{NO_PARITY} toyo status --jq .data.mode"));
        assert!(output.status.success(), "{target}: {}", stderr(&output));
    }
    let absent = wine.run(folder.path(), "-t COM77 toyo status");
    assert_eq!(absent.status.code(), Some(4));
    assert!(stderr(&absent).contains("the port COM77 does not exist"), "{}", stderr(&absent));
    let mut watching = wine.command(
        folder.path(),
        &format!("-t serial://{port}?{NO_PARITY} --no-session toyo status --watch 100ms -o jsonl"),
    );
    let mut watching = watching.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(watching.stdout.take().unwrap()).lines().map(Result::unwrap);
    lines.next().unwrap();
    drop(robot);
    let failed = lines.find(|line| line.contains("the connection is lost")).expect("a failure");
    assert!(failed.contains("no_answer") && failed.contains(&port), "{failed}");
    watching.kill().unwrap();
    watching.wait().unwrap();
}

/// A driver of Windows denies access to a port of another program, as this system does with a port of another user.
/// Wine has another error for a port that another program has locked.
#[test]
fn says_that_another_program_uses_the_port() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    let _robot = SerialSimulator::start(folder.path());
    let terminal = folder.path().join("port").canonicalize().unwrap();
    let port = wine.map_port(&terminal);
    let is_busy = || {
        for target in [&port, &format!(r"\\.\{port}")] {
            let words = format!("--timeout 100ms -t serial://{target}?{NO_PARITY} toyo status");
            let output = wine.run(folder.path(), &words);
            let text = stderr(&output);
            assert!(text.contains(&format!("another program uses {target}")), "{text}");
            assert!(text.contains("hint: close the other program"), "{text}");
            assert_eq!(output.status.code(), Some(4), "{text}");
        }
    };
    let permissions = terminal.metadata().unwrap().permissions();
    std::fs::set_permissions(&terminal, std::os::unix::fs::PermissionsExt::from_mode(0o0)).unwrap();
    is_busy();
    std::fs::set_permissions(&terminal, permissions).unwrap();
    let _holder = serialport::TTYPort::open(&serialport::new(terminal.to_str().unwrap(), 9600)).unwrap();
    is_busy();
}

#[test]
fn session_serves_two_clients_until_it_is_closed() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    let robot = Simulator::start("yrcx");
    inventory(folder.path(), &[("tray", "yrcx", &robot.url)]);
    let opened = wine.data(folder.path(), "-r tray session open --background");
    assert_eq!(opened["background"], true, "{opened}");
    let again = wine.run(folder.path(), "-r tray session open --background");
    assert_eq!(again.status.code(), Some(4), "{}", stderr(&again));
    assert!(stderr(&again).contains("a session is already open"), "{}", stderr(&again));

    let mut moving = wine.command(folder.path(), "-r tray yrcx move --to 900,0,0,0 --speed-of-max 0.1 --yes");
    let moving = moving.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    until("a client moves the robot", || {
        wine.session(folder.path(), "tray").unwrap()["motion"]["command"].as_str().is_some()
    });
    let second = wine.run(folder.path(), "-r tray yrcx move --to 5,0,0,0 --yes");
    assert_eq!(second.status.code(), Some(7), "{}", stderr(&second));
    assert!(wine.run(folder.path(), "-r tray yrcx status").status.success());
    let refused = wine.run(folder.path(), "session close tray");
    assert_eq!(refused.status.code(), Some(7), "{}", stderr(&refused));
    let stopped = wine.run(folder.path(), "-r tray yrcx stop");
    assert!(stopped.status.success(), "{}", stderr(&stopped));
    let ended = moving.wait_with_output().unwrap();
    assert!(!ended.status.success(), "{}", stderr(&ended));

    // Lines of a command file share the session.
    std::fs::write(folder.path().join("lines.armctl"), "yrcx status\nyrcx info version\n").unwrap();
    let batch = wine.run(folder.path(), "-r tray batch lines.armctl");
    assert!(batch.status.success(), "{}", stderr(&batch));

    let listed = wine.session(folder.path(), "tray").unwrap();
    assert_eq!((&listed["link"], &listed["clients"]), (&"up".into(), &Value::Array(Vec::new())), "{listed}");
    assert_eq!(listed["leftover"], Value::Null, "{listed}");
    let closed = wine.run(folder.path(), "session close tray");
    assert!(closed.status.success(), "{}", stderr(&closed));
    assert!(wine.session(folder.path(), "tray").is_none());
}

#[test]
fn session_stops_the_motion_of_a_killed_client_and_refuses_a_read_only_robot() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    let robot = Simulator::start("toyo");
    inventory(folder.path(), &[("arm", "toyo", &robot.url)]);
    assert!(wine.run(folder.path(), "-r arm toyo home --yes").status.success());
    wine.data(folder.path(), "-r arm session open --background");
    let mut jogging = wine.command(folder.path(), "-r arm toyo jog X + low --for 60s --yes");
    let mut jogging = jogging.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let motion = || wine.session(folder.path(), "arm").unwrap()["motion"]["pid"].as_u64();
    until("a client moves the robot", || motion().is_some());
    let pid = motion().unwrap().to_string();
    let killed = wine.wine().args(["taskkill", "/F", "/PID", &pid]).output().unwrap();
    assert!(killed.status.success(), "{}", stderr(&killed));
    jogging.wait().unwrap();
    until("the robot stands still", || motion().is_none());
    let log = std::fs::read_to_string(session_log(wine)).unwrap();
    assert!(log.contains("the client that moved the robot has died: armctl stops the robot"), "{log}");
    until("the robot was stopped", || {
        std::fs::read_to_string(session_log(wine)).unwrap().contains("the robot was stopped")
    });
    // From now on, the robot is read-only.
    let entry = std::fs::read_to_string(folder.path().join("robots.toml")).unwrap();
    std::fs::write(folder.path().join("robots.toml"), format!("{entry}read_only = true\n")).unwrap();
    let refused = wine.run(folder.path(), "-r arm toyo counter set 5=7");
    assert_eq!(refused.status.code(), Some(7), "{}", stderr(&refused));
    assert!(wine.run(folder.path(), "-r arm toyo status").status.success());
    assert!(wine.run(folder.path(), "session close arm").status.success());
}

/// The newest log of a session.
fn session_log(wine: &Wine) -> PathBuf {
    let users = std::fs::read_dir(wine.prefix.join("drive_c/users")).unwrap().map(|user| user.unwrap().path());
    let folders = users.map(|user| user.join("AppData/Local/armctl/sessions")).filter(|folder| folder.is_dir());
    let files = folders.flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|file| file.unwrap().path());
    let logs = files.filter(|file| file.extension().is_some_and(|extension| extension == "log"));
    logs.max_by_key(|log| log.metadata().and_then(|log| log.modified()).unwrap()).unwrap()
}

#[test]
fn prompt_keeps_its_connection_open() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    let robot = Simulator::start("yrcx");
    inventory(folder.path(), &[("prompt", "yrcx", &robot.url)]);
    let script = folder.path().join("script");
    std::fs::write(&script, "status\ninfo version\nsession list\n").unwrap();
    let mut prompt = wine.command(folder.path(), "-r prompt --yes yrcx repl");
    let output = prompt.stdin(std::fs::File::open(script).unwrap()).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
}
