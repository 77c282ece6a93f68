//! The pictures of a terminal in `docs/pictures/` show the output of the program.
//!
//! Each picture is a shell session in its own folder, drawn as a terminal with [`COLUMNS`] columns shows it.
//! `ARMCTL_BLESS=1 cargo test --test terminal pictures::` draws the pictures again. Output must not change between
//! runs: the simulators start with states from files, and [`without_times`] replaces all times by one time.
#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Stdio};

use anstyle_svg::Term;

/// Width of the terminal. Longer lines are wrapped.
const COLUMNS: usize = 90;

/// Pictures: name, and the typed commands.
const PICTURES: [(&str, &[&str]); 5] = [
    ("fleet", &["armctl status"]),
    ("alarm", &["armctl -r weld2 yerc alarm list", "armctl -r tray toyo alarm list", "armctl explain yrcx 12.600"]),
    (
        "refused",
        &["armctl -t udp://192.168.1.31 yerc servo on", "armctl -t udp://192.168.1.31 yerc servo on --dry-run"],
    ),
    (
        "move",
        &[
            "armctl -r pick yrcx move --point 19 --speed 50 --report mm",
            "armctl -r pick yrcx move --point 19 --speed 50 --dry-run",
        ],
    ),
    ("check", &["cat pick.toyo", "armctl toyo program check pick.toyo"]),
];

/// The panel of `armctl teach`, and the motion of a job. Their own tests draw these pictures.
const OTHER_PICTURES: [&str; 3] = ["teach", "path", "soak"];

/// Files in the folder of each session.
const FILES: [(&str, &str); 5] = [
    (
        "robots.toml",
        r#"
robot = [
    { name = "weld1", family = "yerc", target = "sim:" },
    { name = "weld2", family = "yerc", target = "sim:?state=weld2.toml" },
    { name = "press", family = "yerc", target = "sim:?state=press.toml" },
    { name = "tray", family = "toyo", target = "sim:?state=tray.toml" },
    { name = "lift", family = "toyo", target = "tcp://127.0.0.1:1" },
    { name = "pick", family = "yrcx", target = "sim:" },
]
"#,
    ),
    ("weld2.toml", "mode = \"teach\"\nservo = false\nalarm = [{ code = 4315, data = 3, type = 1 }]\n"),
    ("press.toml", "event = [{ at_ms = 0, do = \"hold external on\" }]\n"),
    ("tray.toml", "error = \"28\"\n"),
    (
        "pick.toyo",
        "      SPD V=5\n\
         next: MOVP a PT=1 CN=0 S V=0 POST\n      \
         CNT+ CN1=1\n      \
         JMPP TAG=next CN1<3\n      \
         OUT STN=0 PN1=.......2\n      \
         END\n",
    ),
];

#[test]
fn pictures_are_current() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    let bless = std::env::var_os("ARMCTL_BLESS").is_some();
    let mut stale = Vec::new();
    for (name, typed) in PICTURES {
        let path = folder.join(format!("{name}.svg"));
        let drawn = drawn(&session(typed));
        if bless {
            std::fs::create_dir_all(&folder).expect("the folder can be made");
            std::fs::write(&path, drawn).expect("the picture can be written");
        } else if std::fs::read_to_string(&path).ok().as_ref() != Some(&drawn) {
            stale.push(name);
        }
    }
    assert!(
        stale.is_empty(),
        "not as in docs/pictures; run `ARMCTL_BLESS=1 cargo test --test terminal pictures::`: {stale:?}"
    );
}

#[test]
fn every_picture_is_used() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pages = ["README.md", "docs/yerc.md", "docs/yrcx.md", "docs/toyo.md", "docs/safety.md", "docs/reliability.md"];
    let pages = pages.map(|page| std::fs::read_to_string(root.join(page)).expect("the page is there"));
    for name in PICTURES.map(|(name, _)| name).into_iter().chain(OTHER_PICTURES) {
        assert!(pages.iter().any(|page| page.contains(&format!("pictures/{name}.svg)"))), "nobody shows {name}.svg");
    }
    let files = std::fs::read_dir(root.join("docs/pictures")).expect("the folder is there").count();
    assert_eq!(files, PICTURES.len() + OTHER_PICTURES.len(), "a picture that nobody draws");
}

/// Content of the terminal: a prompt with each command, followed by the output.
fn session(typed: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, content) in FILES {
        std::fs::write(folder.path().join(name), content).expect("a file is written");
    }
    let mut shown = String::new();
    for line in typed {
        let script = format!("exec 2>&1; armctl() {{ \"$ARMCTL\" --color always \"$@\"; }}; {line}");
        let mut shell = Command::new("sh");
        shell.args(["-c", &script]).current_dir(&folder).stdin(Stdio::null()).env_clear();
        shell.env("PATH", std::env::var_os("PATH").unwrap_or_default()).env("ARMCTL", env!("CARGO_BIN_EXE_armctl"));
        shell.env("HOME", folder.path()).env("ARMCTL_CONFIG", "robots.toml").env("TZ", "UTC");
        let output = shell.output().expect("sh runs");
        let printed = String::from_utf8(output.stdout).expect("what is printed is UTF-8");
        assert!(!printed.is_empty(), "{line} prints nothing");
        let gap = if shown.is_empty() { "" } else { "\n" };
        shown.push_str(&format!("{gap}\u{1b}[32m$\u{1b}[0m \u{1b}[1m{line}\u{1b}[0m\n{}", without_times(&printed)));
    }
    shown
}

/// Text in which every motion has the same duration.
fn without_times(text: &str) -> String {
    let Some((before, rest)) = text.split_once("moved to point 19 in ") else { return text.to_owned() };
    let (time, after) = rest.split_once(" s\n").expect("a time ends with its unit");
    assert!(time.parse::<f64>().is_ok_and(|time| (0.3..3.0).contains(&time)), "{time} s");
    format!("{before}moved to point 19 in 0.405 s\n{after}")
}

fn drawn(shown: &str) -> String {
    let wrapped: String = shown.lines().map(|line| wrapped(line) + "\n").collect();
    let term = Term::new().fg_color(GREY).bg_color(NIGHT).palette(anstyle_svg::WIN10_CONSOLE);
    let svg = term.min_width_px(780).render_svg(&wrapped);
    svg.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

const GREY: anstyle::Color = anstyle::Color::Rgb(anstyle::RgbColor(0xcc, 0xcc, 0xcc));
const NIGHT: anstyle::Color = anstyle::Color::Rgb(anstyle::RgbColor(0x16, 0x1b, 0x22));

/// Breaks a line at the width of the terminal.
fn wrapped(line: &str) -> String {
    let mut out = String::new();
    let mut column = 0;
    let mut is_escape = false;
    for c in line.chars() {
        is_escape |= c == '\u{1b}';
        if !is_escape {
            if column == COLUMNS {
                out.push('\n');
                column = 0;
            }
            column += 1;
        }
        is_escape &= !c.is_ascii_alphabetic();
        out.push(c);
    }
    out
}

#[test]
fn wraps_lines_as_a_terminal() {
    let line = format!("\u{1b}[1m{}\u{1b}[0m", "x".repeat(COLUMNS));
    assert_eq!(wrapped(&line), line);
    assert_eq!(wrapped(&format!("{line}y")), format!("{line}\ny"));
}
