//! Example lines of the commands that send no request themselves, or that select robots in their own way.

/// Commands of [`EXAMPLES`] that delete something, or move or stop a robot.
pub const NO_DEFAULT: &[&str] = &["robots remove", "session close", "teach"];

/// The commands, each with the arguments of its examples.
pub const EXAMPLES: &[(&str, &[&str])] = &[
    ("yerc repl", &["-r cell3", "--sim"]),
    ("yrcx repl", &["-r press", "--sim"]),
    ("yrcx io map", &["--bus ethernet-ip", "--bus profinet --input-start 256 --output-start 256"]),
    ("yrcx profinet gsdml", &["GSDML-V2.35-maker-robot.xml", "GSDML-V2.35-maker-robot.xml --json"]),
    ("toyo repl", &["-r loader", "--sim"]),
    ("toyo ports", &["", "--json"]),
    ("toyo program check", &["pick.toyo", "pick.toyo --strict"]),
    ("toyo sim run", &["pick.toyo", "pick.toyo --points points.csv --input 'at 2s 0/01/3 on'"]),
    ("repl", &["-r cell3", "--sim"]),
    ("batch", &["morning.txt -r cell3", "morning.txt --set job=WELD --dry-run"]),
    ("top", &["", "-r cell3"]),
    #[cfg(feature = "plant")]
    ("serve metrics", &["", "--tag line1 --listen 0.0.0.0:9464"]),
    #[cfg(feature = "plant")]
    (
        "publish",
        &[
            "mqtt://192.168.1.5",
            "mqtts://broker.example --user plant --password-file plant.txt --tag line1",
            "mqtt://192.168.1.5 --also 'parts=yerc var get B0..B9' --watch 500ms",
            "mqtt://192.168.1.5 --sparkplug --group Plant --node Cell7",
        ],
    ),
    ("teach", &["-r cell3", "-r cell3 --max-step 1 --max-speed 5"]),
    ("robots list", &["", "--json"]),
    ("robots show", &["cell3", "cell3 --origin"]),
    ("robots add", &["cell3 udp://192.168.1.31 --read-only", "loader serial:///dev/ttyUSB0 --with-tag line1"]),
    ("names list", &["-r cell3", "clamp"]),
    ("names set", &["clamp 27010 -r cell3", "parts B5"]),
    (
        "robots set",
        &["cell3 read_only=off", "cell3 names.clamp=27010", "cell3 timeout=5s site=berlin line=3 tags=welding"],
    ),
    ("robots rename", &["cell3 press", "cell3 press --json"]),
    ("robots default", &["cell3", "cell3 --config plant.toml"]),
    ("robots edit", &["", "--config plant.toml"]),
    ("robots path", &["", "--json"]),
    ("setup", &["", "--config plant.toml"]),
    ("robots remove", &["cell3", "cell3 --config plant.toml"]),
    ("robots check", &["cell3", "udp://192.168.1.31"]),
    ("report", &["cell3", "--all --dir reports --anonymous"]),
    ("robots discover", &["", "192.168.1.50", "--profibus /dev/ttyUSB0"]),
    ("session open", &["-r press", "-r press --background"]),
    ("session list", &["", "--json"]),
    ("session close", &["press", "--all"]),
    ("sim yerc", &["", "--bind 127.0.0.1:10040 --console"]),
    ("sim yrcx", &["", "--bus devicenet --console"]),
    ("sim toyo", &["", "--pty --axes 2"]),
    ("decode yerc", &["capture.pcapng", "'59 45 52 43 20 00 00 00'"]),
    (
        "decode yrcx",
        &["--wi 0x0001,0x0004,0,0x0032", "capture.pcapng --every-image", "68 05 05 68 85 82 6D 3C 3E EE 16"],
    ),
    ("decode toyo", &["'@STAS SNO=0'", "capture.pcapng --port 4001"]),
    ("explain yerc", &["0x2060", "1F"]),
    ("explain yrcx", &["12.600", "14.400"]),
    ("explain toyo", &["28", "0xA1"]),
    ("wireshark", &["$HOME/.local/lib/wireshark/plugins", "dissectors --json"]),
    ("completions", &["bash", "zsh"]),
    ("man", &["--dir /usr/local/share/man/man1", ""]),
    ("schema", &["", "yerc.status"]),
    ("help", &["safety", "yerc job"]),
];
