//! Runs the program in different environments: terminal widths, locales, no home folder, a read-only home folder,
//! closed descriptors, and names of the families as program names.
#![cfg(unix)]

use std::fs::File;
use std::io::{ErrorKind, Read as _};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::time::Duration;

use serialport::{SerialPort as _, TTYPort};

const BINARY: &str = env!("CARGO_BIN_EXE_armctl");

/// A command that runs in this folder, without the environment variables of the test process.
fn armctl(line: &str, folder: &Path) -> Command {
    let mut command = Command::new(BINARY);
    command.args(line.split(' ')).current_dir(folder).env_clear().env("HOME", folder);
    command.stdin(Stdio::null());
    command
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("stdout is UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("stderr is UTF-8")
}

/// A pseudo-terminal with this number of columns.
struct Terminal {
    screen: TTYPort,
    name: String,
    /// Keeps the other end of the terminal open, because a closed terminal discards its output.
    _open: TTYPort,
}

impl Terminal {
    fn new(columns: u16) -> Self {
        let (mut screen, open) = TTYPort::pair().expect("a pseudo-terminal");
        screen.set_timeout(Duration::from_millis(20)).expect("a timeout");
        let terminal = Self { screen, name: open.name().expect("it has a name"), _open: open };
        let size = ["cols".to_owned(), columns.to_string(), "rows".to_owned(), "24".to_owned()];
        let set = Command::new("stty").args(size).stdin(terminal.device()).status();
        assert!(set.expect("stty runs").success());
        terminal
    }

    fn device(&self) -> File {
        File::options().read(true).write(true).open(&self.name).expect("the terminal opens")
    }

    /// Starts a command with the terminal as its stdin, stdout and stderr.
    fn start(&self, mut command: Command) -> Child {
        let child = command.stdin(self.device()).stdout(self.device()).stderr(self.device()).spawn();
        child.expect("the binary starts")
    }

    /// Reads the output of the command until it contains `enough` or the command has ended.
    fn read(&mut self, child: &mut Child, enough: impl Fn(&str) -> bool) -> (String, Option<ExitStatus>) {
        let mut written = Vec::new();
        loop {
            let ended = child.try_wait().expect("it can be waited for");
            let mut some_output = [0; 4096];
            match self.screen.read(&mut some_output) {
                Ok(count) => written.extend_from_slice(&some_output[..count]),
                Err(error) if error.kind() == ErrorKind::TimedOut && ended.is_some() => {
                    return (String::from_utf8(written).expect("what is shown is UTF-8"), ended);
                }
                Err(error) => assert_eq!(error.kind(), ErrorKind::TimedOut, "{error}"),
            }
            let text = String::from_utf8_lossy(&written);
            if enough(&text) {
                return (text.into_owned(), None);
            }
        }
    }

    fn run(&mut self, command: Command) -> String {
        let mut child = self.start(command);
        self.read(&mut child, |_| false).0
    }
}

#[test]
fn tables_fit_terminals_of_every_width() {
    let folder = tempfile::tempdir().unwrap();
    for columns in [40, 80, 300] {
        let shown = Terminal::new(columns).run(armctl("--sim yerc alarm history --color never", folder.path()));
        // The text has wide characters, so a line can have fewer characters than columns.
        assert!(shown.lines().all(|line| line.chars().count() <= usize::from(columns)), "{columns}:\n{shown}");
        assert!(shown.contains("SYNCHRONIZING") && shown.contains("2025/11/02 06:12"), "{columns}:\n{shown}");
        let is_table = shown.contains("LIST ");
        assert_eq!(is_table, columns >= 80, "{columns}:\n{shown}");
    }
}

#[test]
fn pages_long_texts_on_a_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let shown = |line: &str| {
        let mut command = armctl(line, folder.path());
        command.env("PAGER", "sed 's/^/| /'").env("PATH", std::env::var_os("PATH").unwrap_or_default());
        Terminal::new(80).run(command)
    };
    for line in ["yrcx -h", "yerc move joint -h", "help safety", "yerc help"] {
        assert!(shown(line).lines().all(|line| line.starts_with("| ")), "{line}: {}", shown(line));
    }
    for line in ["yerc job select -h", "yrcx -h --no-pager", "--no-pager help safety", "--sim yerc alarm history"] {
        assert!(!shown(line).contains("| "), "{line}: {}", shown(line));
    }
    let mut command = armctl("yrcx -h --color never", folder.path());
    command.env("PAGER", "no-such-pager");
    assert!(Terminal::new(80).run(command).contains("Usage: armctl yrcx"));
}

#[test]
fn wraps_error_messages_between_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let shown = Terminal::new(80).run(armctl("--sim yrcx param get TOEL.1 --color never", folder.path()));
    assert!(shown.lines().all(|line| line.chars().count() <= 80) && shown.contains("did you mean TOLE?"), "{shown}");
}

#[test]
fn watch_redraws_in_place_on_capable_terminals() {
    let home = tempfile::tempdir().expect("a folder");
    let watch = |term: &str| {
        let mut command = armctl("--sim yerc status --watch 10ms --count 3", home.path());
        command.env("TERM", term);
        Terminal::new(80).run(command)
    };
    // The cursor moves up nine lines, and all lines below are removed.
    assert_eq!(watch("xterm").matches("\x1b[9A\r\x1b[J").count(), 2);
    assert!(!watch("dumb").contains('\x1b'));
}

#[test]
fn uses_color_on_capable_terminals_only() {
    let folder = tempfile::tempdir().unwrap();
    let shown = |line: &str, variables: &[(&str, &str)]| {
        let mut command = armctl(line, folder.path());
        // A long text would wait in the pager for a key.
        command.env("PAGER", "cat").envs(variables.iter().copied());
        Terminal::new(80).run(command)
    };
    for line in ["--sim status", "--sim yerc job select NONE", "yerc -h", "-r none status"] {
        let plain = |variables: &[(&str, &str)]| !shown(line, variables).contains('\u{1b}');
        assert!(!plain(&[("TERM", "xterm")]), "{line} has no colour on a terminal");
        assert!(!plain(&[("TERM", "xterm"), ("CI", "true")]), "{line} has no colour on a terminal of a CI");
        assert!(!plain(&[("TERM", "xterm"), ("NO_COLOR", "")]), "{line}: an empty NO_COLOR is none");
        assert!(plain(&[("TERM", "dumb")]), "{line} has colour on a dumb terminal");
        assert!(plain(&[("TERM", "xterm"), ("NO_COLOR", "1")]), "{line} has colour against NO_COLOR");
        let output = armctl(line, folder.path()).env("TERM", "xterm").env("CI", "true").output().unwrap();
        assert!(!(stdout(&output) + &stderr(&output)).contains('\u{1b}'), "{line} has colour in a pipe");
    }
}

#[test]
fn names_do_not_depend_on_the_locale() {
    let folder = tempfile::tempdir().unwrap();
    let listed = |locale: &str| {
        let command = armctl("--sim yerc file list -o csv", folder.path()).env("LC_ALL", locale).output();
        stdout(&command.unwrap())
    };
    let expected = listed("C");
    assert!(expected.contains("テスト.JBI"), "{expected}");
    for locale in ["ja_JP.UTF-8", "ja_JP.SJIS", "POSIX", "nowhere"] {
        assert_eq!(listed(locale), expected, "{locale}");
    }
}

#[test]
fn works_without_a_home_folder() {
    let folder = tempfile::tempdir().unwrap();
    let bare = |line: &str| armctl(line, folder.path()).env_remove("HOME").output().unwrap();
    for line in ["--sim yerc status", "--sim yrcx status", "--sim toyo status", "help", "explain toyo 28", "-h"] {
        assert_eq!(bare(line).status.code(), Some(0), "{line}: {}", stderr(&bare(line)));
    }
}

#[test]
fn names_a_read_only_home_folder() {
    let folder = tempfile::tempdir().unwrap();
    // Permissions do not restrict root. Therefore, the home folder is a file, in which nothing can be created.
    let home = folder.path().join("home");
    std::fs::write(&home, "").unwrap();
    let run = |line: &str| armctl(line, folder.path()).env("HOME", &home).output().unwrap();
    assert_eq!(run("--sim yerc status").status.code(), Some(0));
    let output = run("robots add cell1 udp://192.168.1.31");
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("robots.toml: ") && stderr(&output).contains("\nhint: "), "{}", stderr(&output));
    assert!(!stderr(&output).contains("os error"), "{}", stderr(&output));
}

#[test]
fn exit_codes_do_not_depend_on_closed_descriptors() {
    let folder = tempfile::tempdir().unwrap();
    let run = |line: &str, closed: &str| {
        let script = format!("exec {closed}; exec \"{BINARY}\" {line}");
        let mut shell = Command::new("sh");
        shell.args(["-c", &script]).env("HOME", folder.path()).env_remove("ARMCTL_TARGET").current_dir(folder.path());
        shell.output().unwrap()
    };
    for closed in ["<&-", ">&-", "2>&-", "<&- >&- 2>&-", "2>/dev/null"] {
        for (line, code) in [
            ("--sim yerc status", 0),
            ("-h", 0),
            ("--sim yerc hold on --json", 0),
            ("--sim yerc job select NONE", 3),
            ("bogus", 2),
            ("-t udp://192.0.2.1 yerc servo on", 7),
        ] {
            assert_eq!(run(line, closed).status.code(), Some(code), "{line} {closed}");
        }
    }
}

#[test]
fn link_with_a_family_name_is_its_subcommand() {
    let folder = tempfile::tempdir().unwrap();
    for family in ["yerc", "yrcx", "toyo"] {
        let link = folder.path().join(family);
        std::os::unix::fs::symlink(BINARY, &link).unwrap();
        let run = |arguments: &[&str]| Command::new(&link).args(arguments).env("HOME", folder.path()).output().unwrap();
        let full_output = armctl(&format!("--sim {family} status"), folder.path()).output().unwrap();
        assert_eq!(stdout(&run(&["--sim", "status"])), stdout(&full_output), "{family}");
        assert!(stdout(&run(&["-h"])).contains(&format!("Usage: armctl {family} ")), "{family}");
        let version = format!("armctl {}\n", env!("CARGO_PKG_VERSION"));
        assert_eq!(stdout(&run(&["-V"])), version);
        assert_eq!(run(&["bogus"]).status.code(), Some(2), "{family}");
    }
}

#[test]
fn shows_progress_and_restores_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("long.toyo"), "OUT STN=0 PN1=.......1\n".repeat(300)).unwrap();
    std::fs::write(folder.path().join("big.toml"), "[[file]]\nname = \"BIG.DAT\"\nsize = 268435456\n").unwrap();
    for (line, progress) in [
        ("-t sim:?baud=9600 toyo program put long.toyo", "steps"),
        ("-t sim:?baud=9600 toyo backup saved", "0/"),
        // This controller answers without a delay.
        ("-t sim:?state=big.toml yerc file get BIG.DAT", "BIG.DAT"),
        ("-t sim:?state=big.toml yerc backup copies", "BIG.DAT"),
    ] {
        let mut terminal = Terminal::new(80);
        let mut command = armctl(line, folder.path());
        command.env("TERM", "xterm");
        let mut child = terminal.start(command);
        let (before, ended) = terminal.read(&mut child, |text| text.contains(progress) && text.contains('\r'));
        assert_eq!(ended, None, "{line} ended before it could be interrupted:\n{before}");
        let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(interrupt.unwrap().success());
        let (after, ended) = terminal.read(&mut child, |_| false);
        assert_eq!(ended.and_then(|status| status.code()), Some(130), "{line}:\n{after}");
        let all = before + &after;
        assert!(all.rfind("\u{1b}[?25l") <= all.rfind("\u{1b}[?25h"), "{line} hides the cursor for good: {all:?}");
        let (_, last) = all.rsplit_once("\u{1b}[2K").unwrap_or_default();
        assert!(last.contains("interrupted:") && !last.contains('\r'), "{line} leaves its progress there: {all:?}");
        assert!(!folder.path().join("BIG.DAT").exists(), "half a file is there");
    }
}

#[test]
fn a_chain_of_own_processes_has_an_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |generation: &str| {
        let mut command = armctl("--sim yerc status --jq .ok", folder.path());
        command.env("ARMCTL_CHILD", generation).output().expect("it runs")
    };
    assert_eq!(stdout(&run("1")), "true\n");
    let last = run("5");
    assert!(!last.status.success() && stderr(&last).contains("starts itself again and again"), "{last:?}");
}
