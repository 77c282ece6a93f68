use super::*;

/// Returns the candidates for the word after the last blank.
fn values_of(line: &str) -> Vec<String> {
    let words: Vec<OsString> = line.split(' ').map(Into::into).collect();
    complete(&words, words.len() - 1, false).into_iter().map(|candidate| candidate.value).collect()
}

#[test]
fn completes_words_and_flags_of_the_command() {
    for (line, expected) in [
        ("armctl ye", &["yerc"][..]),
        ("armctl yerc st", &["status", "stop"]),
        ("yerc st", &["status", "stop"]),
        ("/usr/bin/yerc.exe job sel", &["select"]),
        ("armctl --sim yerc job ", &["calls", "check", "edit", "list", "search", "select", "show", "start", "stop"]),
        ("armctl yerc --sim servo o", &["on", "off"]),
        ("armctl yerc job select --li", &["--line"]),
        ("armctl -o j", &["json", "jsonl"]),
        ("armctl -oj", &["-ojson", "-ojsonl"]),
        ("armctl --output=c", &["--output=csv"]),
        ("armctl explain y", &["yerc", "yrcx"]),
        ("armctl nonsense x", &[]),
        ("armctl yerc --help job ", &[]),
    ] {
        let mut expected = expected.to_vec();
        let mut found = values_of(line);
        expected.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, expected, "{line}");
    }
}

#[test]
fn completes_values_of_each_kind() {
    for (line, expected) in [
        ("armctl help exi", &["exit-codes"][..]),
        ("armctl schema yerc.job.", &["yerc.job.show", "yerc.job.select", "yerc.job.start"]),
        ("armctl explain yerc 0x206", &["0x2060"]),
        ("armctl explain yrcx 12.60", &["12.600"]),
        ("armctl explain toyo 2", &["20"]),
        ("armctl toyo param get soft-limit", &["soft-limit-plus", "soft-limit-minus"]),
        ("armctl toyo param get SOFT-LIMIT-P", &["soft-limit-plus"]),
        ("armctl toyo program insert 5 MV", &["MVB"]),
        ("armctl toyo palletizing get 1 source-p", &["source-p0"]),
        ("armctl yrcx io get serv", &["servo-on"]),
        ("armctl yrcx io set alarm-res", &["alarm-reset=on", "alarm-reset=off"]),
        ("armctl yrcx param get TOLE,OUT", &["TOLE,OUTPOS"]),
        ("armctl yrcx var get SGR3", &["SGR3", "SGR30", "SGR31"]),
        ("armctl yrcx port set DO2", &["DO2", "DO20", "DO27"]),
        ("armctl yrcx port get LO", &["LO0", "LO1"]),
        ("armctl yerc var get B", &["B", "BP"]),
        ("armctl yerc --target s", &["sim:", "serial://"]),
        ("armctl --sim yerc io get grip", &["GRIPPER"]),
        ("armctl --sim yerc io set BUSY", &["BUSY=on", "BUSY=off"]),
        ("armctl --sim yerc var set parts_d", &["PARTS_DONE="]),
        ("armctl --sim yerc register get L", &["LINE_SPEED"]),
        ("armctl session open --family t", &["toyo"]),
    ] {
        let found = values_of(line);
        let missing: Vec<_> = expected.iter().filter(|value| !found.iter().any(|found| found == *value)).collect();
        assert!(missing.is_empty() && (!expected.is_empty() || found.is_empty()), "{line}: {found:?}");
    }
}

#[test]
fn completes_robots_and_tags_of_the_inventory() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("robots.toml");
    std::fs::write(
        &file,
        "[[robot]]\nname = \"cell1\"\ntarget = \"udp://h\"\ntags = [\"welding\"]\n\
         [[robot]]\nname = \"press\"\ntarget = \"tcp://h:1\"\ntags = [\"line2\", \"welding\"]\n",
    )
    .unwrap();
    let config = file.to_str().unwrap();
    let candidates = |line: &str| {
        let words: Vec<OsString> = line.replace("ROBOTS", config).split(' ').map(Into::into).collect();
        let found = complete(&words, words.len() - 1, false);
        found.into_iter().map(|found| (found.value, found.help.unwrap_or_default())).collect::<Vec<_>>()
    };
    let pair = |value: &str, help: &str| (value.to_owned(), help.to_owned());
    assert_eq!(candidates("armctl --config ROBOTS -r "), [pair("cell1", "udp://h"), pair("press", "tcp://h:1")]);
    assert_eq!(candidates("armctl yerc --config=ROBOTS status --robot=ce"), [pair("--robot=cell1", "udp://h")]);
    assert_eq!(candidates("armctl --config ROBOTS yerc -rp"), [pair("-rpress", "tcp://h:1")]);
    assert_eq!(candidates("armctl --config ROBOTS robots show p"), [pair("press", "tcp://h:1")]);
    assert_eq!(candidates("armctl --config ROBOTS --tag "), [pair("line2", "press"), pair("welding", "cell1, press")]);
    assert_eq!(candidates("armctl --config ROBOTS.none -r "), []);
}

#[test]
fn answers_every_line() {
    // Lines that the engine would reject as impossible.
    for line in [
        "",
        "armctl",
        "armctl toyo jog -r -z x",
        "armctl toyo jog X -- ",
        "armctl -r -- x",
        "armctl yerc move linear --x -10 --y ",
        "armctl yrcx point set 5 --mm -1,-2 --",
        "armctl --robot= --=x -",
        "armctl yrcx var set SGI0 -5 ",
        "armctl -",
        "armctl --",
    ] {
        values_of(line);
    }
    assert_eq!(complete(&[], 0, false), []);
    assert_eq!(complete(&["armctl".into()], 7, false), complete(&["armctl".into(), "".into()], 1, false));
}

/// Returns the candidates with their help. The time limit is long enough for a busy computer.
fn values_of_robot(line: &str) -> Vec<(String, String)> {
    let words: Vec<OsString> = line.split(' ').map(Into::into).collect();
    let found = complete_within(&words, words.len() - 1, false, Duration::from_secs(60), false);
    found.into_iter().map(|found| (found.value, found.help.unwrap_or_default())).collect()
}

#[test]
fn completes_values_of_simulators() {
    let has = |line: &str, value: &str, help: &str| {
        let found = values_of_robot(line);
        assert!(found.contains(&(value.to_owned(), help.to_owned())), "{line}: {found:?}");
    };
    has("armctl --sim yerc job select TE", "TESTJOB", "");
    has("armctl -t sim: yerc file get ", "TOOL.CND", "cnd");
    has("yerc --sim file delete test", "TESTJOB.JBI", "jbi");
    has("armctl yrcx --sim program show --task ", "1", "stop");
    has("armctl yrcx program run --sim --name M", "MAIN", "program 1: task 1, stop");
    has("armctl yrcx program run --sim --program=", "--program=1", "MAIN: task 1, stop");
}

#[test]
fn never_opens_a_link_for_a_candidate() {
    // The completion must not send anything to this socket.
    let socket = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_nonblocking(true).unwrap();
    let target = format!("udp://{}", socket.local_addr().unwrap());
    for line in ["armctl -t TARGET yerc job select W", "armctl -t TARGET --no-session yerc file get W"] {
        assert_eq!(values_of_robot(&line.replace("TARGET", &target)), []);
    }
    assert_eq!(socket.recv(&mut [0; 64]).unwrap_err().kind(), std::io::ErrorKind::WouldBlock);
}
