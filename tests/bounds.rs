//! Limits of memory, files, filters, tables and reaction time, tested with the binary under limits of the operating
//! system.
#![cfg(unix)]

use std::io::Write as _;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use tempfile::TempDir;

fn armctl(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env_clear().env("HOME", folder).env("XDG_RUNTIME_DIR", folder).args(words);
    command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn run(folder: &Path, words: &[&str]) -> Output {
    armctl(folder, words).output().expect("it runs")
}

/// The command with a limit of the shell's `ulimit`. Its threads share heaps: otherwise the C library reserves 64 MB for
/// each thread, so that a limit of the address space would count threads.
fn limited_command(folder: &Path, limit: &str, words: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.env_clear().env("HOME", folder).env("XDG_RUNTIME_DIR", folder).env("MALLOC_ARENA_MAX", "1");
    command.current_dir(folder).stdin(Stdio::null());
    command.args(["-c", &format!("ulimit {limit}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_armctl")]).args(words);
    command
}

fn limited(folder: &Path, limit: &str, words: &[&str]) -> Output {
    limited_command(folder, limit, words).output().expect("a shell")
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn end_within_limit(output: &Output, code: i32, says: &str) {
    assert_eq!(output.status.code(), Some(code), "{} {}", stdout(output), stderr(output));
    assert!(stderr(output).contains(says), "{says}: {}", stderr(output));
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

fn signal(child: &Child, name: &str) {
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-s", name, &pid]).status().expect("kill runs").success());
}

/// Creates a capture with raw IP packets of one TCP connection, each with this content. The IP length is 0, as a
/// network card with offloading reports it.
fn capture(path: &Path, packets: u32, content: &[u8]) {
    let mut file = std::io::BufWriter::new(std::fs::File::create(path).expect("it works here"));
    file.write_all(&[&0xA1B2_C3D4_u32.to_be_bytes()[..], &[0, 2, 0, 4], &[0; 12], &[0, 0, 0, 101]].concat())
        .expect("it works here");
    let len = u32::try_from(content.len()).expect("it works here");
    for number in 0..packets {
        let ip = [&[0x45, 0, 0, 0, 0, 0, 0, 0, 64, 6, 0, 0][..], &[10, 0, 0, 1, 10, 0, 0, 2]].concat();
        let sequence = 1 + number * len;
        let tcp = [&[0x9C, 0x40, 0xAF, 0x12][..], &sequence.to_be_bytes(), &[0; 4], &[0x50, 0x10], &[0; 6]].concat();
        let size = (len + 40).to_be_bytes();
        for part in [&[0; 8][..], &size, &size, &ip, &tcp, content] {
            file.write_all(part).expect("it works here");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn limits_the_memory_for_many_small_messages() {
    let folder = folder();
    // Each packet has 2,700 NOP messages of 24 bytes.
    capture(&folder.path().join("nop.pcap"), 60, &vec![0; 24 * 2700]);
    let output = limited(folder.path(), "-v 500000", &["decode", "yrcx", "nop.pcap"]);
    end_within_limit(&output, 0, "");
    // The table begins before the end of the file is known, so the summary is below it.
    let text = stdout(&output);
    let (table, summary) = text.split_once("\n\n").expect("a table and a summary");
    assert!(table.trim_start().starts_with("NUMBER"), "{table:.300}");
    assert_eq!(table.lines().skip(1).filter(|line| line.contains("->")).count(), 162_000);
    assert!(summary.contains("60 packets, 60 of them") && summary.contains("162000 messages"), "{summary}");
}

#[cfg(target_os = "linux")]
#[test]
fn json_of_a_large_capture_has_the_keys_of_a_small_one() {
    let folder = folder();
    let [small, large] = [1, 8].map(|packets| {
        let name = format!("{packets}.pcap");
        capture(&folder.path().join(&name), packets, &vec![0; 24 * 2700]);
        let output = limited(folder.path(), "-v 500000", &["decode", "yrcx", &name, "--json"]);
        end_within_limit(&output, 0, "");
        serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("JSON")
    });
    for place in ["", "/data", "/data/links/0"] {
        let keys = |report: &serde_json::Value| -> std::collections::BTreeSet<String> {
            report.pointer(place).and_then(|value| value.as_object()).expect("an object").keys().cloned().collect()
        };
        assert_eq!(keys(&large), keys(&small), "{place}");
    }
    let messages = |report: &serde_json::Value| report["data"]["messages"].as_array().expect("a list").clone();
    let (few, many) = (messages(&small), messages(&large));
    assert_eq!((few.len(), many.len()), (2700, 8 * 2700));
    assert_eq!(many[..2700], few[..]);
    assert_eq!((&large["ok"], &large["data"]["packets"]), (&true.into(), &8.into()));
    assert_eq!(large["data"]["links"][0]["messages"], 8 * 2700);
}

#[cfg(target_os = "linux")]
#[test]
fn reads_a_capture_in_pieces() {
    let folder = folder();
    // The packets belong to no family. They have half a gigabyte; the memory limit is a quarter of a gigabyte.
    capture(&folder.path().join("large.pcap"), 8000, &vec![b'x'; 65_000]);
    for family in ["yerc", "yrcx", "toyo"] {
        let output = limited(folder.path(), "-v 250000", &["decode", family, "large.pcap"]);
        end_within_limit(&output, 0, "");
        assert!(stdout(&output).contains("8000 packets, 0 of them"), "{}", stdout(&output));
    }
}

#[test]
fn reads_only_regular_files_of_limited_size() {
    let folder = folder();
    let fifo = folder.path().join("fifo");
    assert!(Command::new("mkfifo").arg(&fifo).status().expect("mkfifo runs").success());
    let large = std::fs::File::create(folder.path().join("large")).unwrap();
    large.set_len(1 << 40).unwrap();
    std::fs::create_dir(folder.path().join("saved")).unwrap();
    assert!(Command::new("mkfifo").arg(folder.path().join("saved/manifest.json")).status().unwrap().success());
    let (nothing, much) = ("not a regular file", "larger than");
    for (file, why) in [("/dev/zero", nothing), ("fifo", nothing), ("large", much)] {
        for (line, code) in [
            ("--config FILE robots list", 2),
            ("--config FILE robots add a udp://127.0.0.1", 2),
            ("batch FILE --sim", 1),
            ("decode yerc FILE.pcap", 1),
            ("sim yerc --state FILE --bind 127.0.0.1:0", 1),
            ("sim yrcx --state FILE --bind 127.0.0.1:0", 1),
            ("sim toyo --state FILE --bind 127.0.0.1:0", 1),
            ("--sim yerc var restore FILE --yes", 1),
            ("toyo program check FILE", 1),
        ] {
            if line.contains(".pcap") {
                let link = folder.path().join("FILE.pcap");
                std::fs::remove_file(&link).unwrap_or_default();
                std::os::unix::fs::symlink(file, &link).unwrap();
                if why == much {
                    continue;
                }
            }
            let line = if line.contains(".pcap") { line.to_owned() } else { line.replace("FILE", file) };
            let output = limited(folder.path(), "-v 1500000", &line.split(' ').collect::<Vec<_>>());
            let message = stderr(&output);
            assert!(message.contains(why) || message.contains("can hold"), "{line}: {message}");
            assert!([1, 2].contains(&output.status.code().unwrap_or_default()), "{line}: {code} {message}");
        }
    }
    end_within_limit(&run(folder.path(), &["--sim", "diff", "saved"]), 1, nothing);
}

#[test]
fn limits_the_length_of_a_script_line() {
    let folder = folder();
    let endless = std::fs::File::open("/dev/zero").expect("it is there");
    let output = limited_command(folder.path(), "-v 500000", &["repl"]).stdin(endless).output();
    end_within_limit(&output.expect("a shell"), 2, "line 1 of stdin is longer than");
}

#[test]
fn limits_time_and_memory_of_filters() {
    let folder = folder();
    // The memory limit of the process is lower than the limit of a filter, so that the test is faster.
    let status =
        |filter: &str| limited(folder.path(), "-v 300000", &["--sim", "yerc", "status", &format!("--jq={filter}")]);
    let deep = "(".repeat(20_000) + "1" + &")".repeat(20_000);
    for filter in ["def f: 1 + f; f", "def f: [f]; f", "[repeat(1)]", "reduce range(1000000) as $i (0; [.])", &deep] {
        end_within_limit(&status(filter), 5, "it needs too much memory, or its recursion is too deep");
    }
    end_within_limit(&status("reduce range(1000) as $i (0; [.])"), 5, " levels");
    for (filter, expected) in [
        ("nan, [nan]", "null\n[null]\n"),
        ("infinite, -infinite", "1.7976931348623157e+308\n-1.7976931348623157e+308\n"),
        ("limit(3; repeat(1))", "1\n1\n1\n"),
        (".ok", "true\n"),
    ] {
        let output = status(filter);
        end_within_limit(&output, 0, "");
        assert_eq!(stdout(&output), expected, "{filter}");
    }
    end_within_limit(&status(".[0]"), 5, "Cannot index object with number");
    // Like in jq, the outputs before the error are printed.
    let output = status("1, error(\"late\")");
    end_within_limit(&output, 5, "late");
    assert_eq!(stdout(&output), "1\n");
}

#[test]
fn filter_failure_after_a_change_is_no_usage_error() {
    let folder = folder();
    for words in [
        &["--sim", "yerc", "var", "set", "B0=1", "--yes", "--jq", "error"][..],
        &["--config", "robots.toml", "robots", "add", "cell", "udp://127.0.0.1", "--jq", ".[0]"],
    ] {
        let output = run(folder.path(), words);
        end_within_limit(&output, 1, "succeeded, but the report could not be written");
    }
    end_within_limit(&run(folder.path(), &["--config", "robots.toml", "robots", "show", "cell"]), 0, "");
    // A filter that does not compile is reported before any request is sent.
    end_within_limit(
        &run(folder.path(), &["--sim", "yerc", "var", "set", "B0=1", "--jq", ".["]),
        2,
        "cannot be parsed",
    );
}

/// Checks that the process ends at the first signal, which is sent while the filter is computed.
#[cfg(target_os = "linux")]
fn ends_on_first_signal(folder: &Path, words: &[&str], name: &str) {
    let child = armctl(folder, words).spawn().expect("it works here");
    // The filter runs in a separate process. Wait until this process has started.
    let pid = child.id();
    let children = || std::fs::read_to_string(format!("/proc/{pid}/task/{pid}/children")).unwrap_or_default();
    while children().trim().is_empty() {
        std::thread::yield_now();
    }
    let worker = children().trim().to_owned();
    // After some ticks of CPU time, the worker process runs only the filter.
    let ticks = || {
        let stat = std::fs::read_to_string(format!("/proc/{worker}/stat")).unwrap_or_default();
        stat.rsplit(')').next().and_then(|rest| rest.split(' ').nth(12)?.parse::<u64>().ok()).unwrap_or_default()
    };
    while ticks() < 10 {
        std::thread::yield_now();
    }
    signal(&child, name);
    let output = child.wait_with_output().expect("it works here");
    assert_eq!(output.status.code(), Some(130), "{name}: {}", stderr(&output));
    assert!(stderr(&output).contains("interrupted"), "{name}: {}", stderr(&output));
    // The worker process also ends.
    while Path::new(&format!("/proc/{worker}")).exists() {
        std::thread::yield_now();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn endless_filter_does_not_delay_signals() {
    let folder = folder();
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap().trim();
    let is_hangup_ignored = u64::from_str_radix(ignored, 16).unwrap() & 1 == 1;
    // All signals take the same way to the filter, so each of these lines gets one of them.
    let lines = [
        ("INT", &["--sim", "yerc", "status", "--jq", "def f: f; f"][..]),
        ("TERM", &["--sim", "yerc", "status", "--until", "def f: f; f"]),
        ("HUP", &["--sim", "toyo", "home", "--yes", "--jq", "def f: f; f"]),
    ];
    for (name, words) in lines.into_iter().filter(|(name, _)| *name != "HUP" || !is_hangup_ignored) {
        ends_on_first_signal(folder.path(), words, name);
    }
}

#[test]
fn blocked_reader_does_not_delay_signals() {
    let folder = folder();
    let mut child =
        armctl(folder.path(), &["--sim", "yerc", "status", "--watch", "1ms", "-o", "jsonl"]).spawn().unwrap();
    let mut pipe = child.stdout.take().unwrap();
    let mut first = [0; 1];
    std::io::Read::read_exact(&mut pipe, &mut first).unwrap();
    signal(&child, "INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    drop(pipe);
}

#[test]
fn adds_robots_concurrently() {
    let folder = folder();
    let mut adding: Vec<Child> = (0..50)
        .map(|number| {
            let (name, url) = (format!("cell{number}"), format!("udp://127.0.0.{}", number + 1));
            armctl(folder.path(), &["--config", "robots.toml", "robots", "add", &name, &url]).spawn().unwrap()
        })
        .collect();
    for child in &mut adding {
        assert!(child.wait().unwrap().success());
    }
    let output = run(folder.path(), &["--config", "robots.toml", "robots", "list", "--jq", ".data.robots | length"]);
    assert_eq!(stdout(&output), "50\n");
    let names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["robots.toml"], "nothing lies about");
}

#[test]
fn inventory_keeps_its_permissions_and_link() {
    use std::os::unix::fs::PermissionsExt as _;

    let folder = folder();
    let file = folder.path().join("real.toml");
    std::fs::write(&file, "# ours\n").unwrap();
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o664)).unwrap();
    std::os::unix::fs::symlink("real.toml", folder.path().join("robots.toml")).unwrap();
    end_within_limit(
        &run(folder.path(), &["--config", "robots.toml", "robots", "add", "cell", "udp://127.0.0.1"]),
        0,
        "",
    );
    assert!(folder.path().join("robots.toml").is_symlink());
    assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o664);
    assert!(std::fs::read_to_string(&file).unwrap().contains("# ours\n"));
}

#[test]
fn reports_a_missing_descriptor_limit() {
    let folder = folder();
    // With fewer than 5 descriptors, the system cannot load the program.
    for most in 5..12 {
        let output = limited(folder.path(), &format!("-n {most}"), &["--sim", "yerc", "status"]);
        end_within_limit(&output, 1, "ulimit -n");
        assert!(!stderr(&output).contains("panicked"), "{}", stderr(&output));
    }
    for most in [16, 24, 32, 64] {
        let output = limited(folder.path(), &format!("-n {most}"), &["--sim", "yerc", "status", "--jq", ".ok"]);
        assert!(!stderr(&output).contains("panicked"), "{most}: {}", stderr(&output));
        assert!([0, 1].contains(&output.status.code().unwrap()), "{most}: {}", stderr(&output));
    }
}

#[test]
fn removes_drafts_of_killed_runs() {
    let folder = folder();
    let saved = folder.path().join("saved");
    std::fs::create_dir(&saved).unwrap();
    std::fs::write(saved.join(".armctl-dead1.part"), "half").unwrap();
    end_within_limit(&run(folder.path(), &["--sim", "toyo", "backup", "saved"]), 0, "");
    assert!(!saved.join(".armctl-dead1.part").exists());
    std::fs::write(folder.path().join(".armctl-dead2.part"), "half").unwrap();
    end_within_limit(&run(folder.path(), &["--sim", "yerc", "file", "get", "TESTJOB.JBI"]), 0, "");
    assert!(!folder.path().join(".armctl-dead2.part").exists());
}
