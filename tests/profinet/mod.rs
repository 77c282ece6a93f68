//! The binary as a controller and as a simulated device, each in its own network namespace: discovery, naming, remote
//! commands, sessions and recordings. Without user namespaces, the test prints a message and passes.

#![expect(clippy::print_stdout, reason = "a test that is skipped says so")]

mod namespaces;

use std::process::Command;

/// Commands as typed. After each command, its exit code follows.
const COMMANDS: &str = r#"
export HOME="$FOLDER" XDG_RUNTIME_DIR="$FOLDER"
unset XDG_CONFIG_HOME ARMCTL_TARGET
$THERE "$ARMCTL" sim yrcx --bus profinet --interface pd0 > "$FOLDER/sim" 2>&1 & D=$!
wait_for 'profinet://' "$FOLDER/sim" $D
MAC=$($THERE cat /sys/class/net/pd0/address)
M='layout=0:1,0.0x8000:1/0x8000,0.0x8001:1/0x8001,1:0x101:i48,2:0x102:o48&watchdog=1900ms'
typed() { echo "$ $1"; shift; "$@" 2>&1; echo "? $?"; }
robot() { typed "$2" "$ARMCTL" -t "profinet://$1" $2; }
robot "yrcx-sim@pc0?$M" 'robots check'
robot "yrcx-sim@pc0?$M" "--yes --trace $FOLDER/trace.pcapng yrcx info version"
typed decode "$ARMCTL" decode yrcx "$FOLDER/trace.pcapng"
robot "$MAC@pc0?$M&cycle=8ms" '--yes yrcx info servo'
robot "yrcx-sim@pc0?$M" 'yrcx status'
robot "yrcx-sim@pc0?$M" '--yes session open --background'
robot "yrcx-sim@pc0?$M" 'yrcx io get'
robot "yrcx-sim@pc0?$M" 'yrcx position'
robot "$MAC@pc0?$M" 'yrcx io get servo-on'
robot "$MAC@pc0?$M" '--yes session open'
robot "other@pc0?$M" '--yes yrcx info system'
robot "yrcx-sim@pc0?$M" 'session close'
"$ARMCTL" robots add line3 "profinet://yrcx-sim@pc0?$M" --read-only > /dev/null
robot "$MAC@pc0?$M" '--yes yrcx recover'
robot "$MAC@pc0?$M" 'yrcx profinet identify'
robot "$MAC@pc0?$M" 'session open'
robot "02:00:00:00:00:09@pc0?$M" '--yes yrcx alarm reset'
"$ARMCTL" robots remove line3 > /dev/null
robot "other@pc0?$M" '--yes yrcx info tasks'
robot "yrcx-sim@pc9?$M" '--yes yrcx info slots'
robot 'yrcx-sim@pc0?layout=1:0x99:i48,2:0x102:o48' '--yes yrcx info speed'
typed unprivileged setpriv --bounding-set -net_raw --inh-caps -net_raw "$ARMCTL" -t "profinet://yrcx-sim@pc0?$M" --yes yrcx info arm
kill $D
wait $D
"#;

#[test]
fn commands_a_simulated_device_on_another_network_card() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().to_str().expect("its path is UTF-8");
    let variables = [("ARMCTL", env!("CARGO_BIN_EXE_armctl")), ("FOLDER", place)];
    let Some(text) = namespaces::run(COMMANDS, &variables) else {
        println!("{}", namespaces::SKIPPED);
        return;
    };
    let said = |typed: &str| {
        let part = text.split("$ ").find(|part| part.starts_with(&format!("{typed}\n"))).unwrap_or_else(|| {
            panic!("'{typed}' was not typed: {text}");
        });
        let (said, exit) = part.rsplit_once("? ").expect("its exit code");
        (said.split_whitespace().collect::<Vec<_>>().join(" "), exit.trim().to_owned())
    };
    let trace = format!("--yes --trace {place}/trace.pcapng yrcx info version");
    for (typed, exit, parts) in [
        (
            "robots check",
            "0",
            &["station ok 'yrcx-sim'", "RPC ok", "modules ok", "only to the controller that owns"][..],
        ),
        (&trace, "0", &["host V1.08"]),
        (
            "decode",
            "0",
            &["Connect answered: done", "ApplicationReady", "WI 0501 # versions", "Release answered: done"],
        ),
        ("--yes yrcx info servo", "0", &["1 brake", "alarm 12.571"]),
        ("yrcx status", "3", &["open a session"]),
        ("--yes session open --background", "0", &["held by process"]),
        ("yrcx io get", "0", &["CPU_OK"]),
        ("yrcx position", "0", &["mm"]),
        ("yrcx io get servo-on", "0", &["servo-on off"]),
        ("--yes session open", "4", &["a session is already open"]),
        ("--yes yrcx info system", "4", &["UDP port 34964", "ss -lunp"]),
        ("session close", "0", &["closed"]),
        ("--yes yrcx recover", "7", &["read-only", "'line3' in robots.toml has the same address"]),
        ("yrcx profinet identify", "0", &["yrcx-sim"]),
        ("session open", "7", &["read-only"]),
        ("--yes yrcx alarm reset", "4", &["02:00:00:00:00:09 was not found"]),
        ("--yes yrcx info tasks", "4", &["station 'other' was not found"]),
        ("--yes yrcx info slots", "2", &["has no network interface 'pc9'", "use one of pc0"]),
        ("--yes yrcx info speed", "3", &["Connect was refused"]),
        ("unprivileged", "1", &["CAP_NET_RAW", "setcap cap_net_raw+ep"]),
    ] {
        let (said, code) = said(typed);
        assert_eq!(code, exit, "{typed}: {said}");
        for part in parts {
            assert!(said.contains(part), "{typed}: no '{part}' in: {said}");
        }
    }
    check_recording(&format!("{place}/trace.pcapng"));
}

/// Shell script: a controller and a DCP client of other authors command our simulator, which is on the other network
/// card of the pair.
const DRIVER_COMMANDS: &str = r#"
$THERE "$ARMCTL" sim yrcx --bus profinet --interface pd0 > "$FOLDER/sim" 2>&1 & D=$!
wait_for 'profinet://' "$FOLDER/sim" $D
for words in yrcx 'yrcx class2'; do "$PEERS/bin/python" "$SCRIPTS/controller.py" pc0 yrcx-sim $words 2>&1; done
"$PEERS/bin/python" "$SCRIPTS/dcp.py" 192.168.79.1 yrcx-sim 2>&1
kill $D
wait $D
"#;

#[test]
fn other_controllers_command_the_simulated_device() {
    let Some(peers) = std::env::var_os("ARMCTL_PROFINET_PEERS") else {
        println!("skipped: ARMCTL_PROFINET_PEERS does not name a folder of tests/profinet/install");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().to_str().expect("its path is UTF-8");
    let peers = peers.to_str().expect("its path is UTF-8");
    let scripts = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/profinet");
    let variables =
        [("ARMCTL", env!("CARGO_BIN_EXE_armctl")), ("FOLDER", place), ("PEERS", peers), ("SCRIPTS", scripts)];
    let Some(text) = namespaces::run(DRIVER_COMMANDS, &variables) else {
        println!("{}", namespaces::SKIPPED);
        return;
    };
    assert_eq!(text.matches("profinet-py has run a remote command").count(), 2, "{text}");
    assert!(text.contains("pnio-dcp has seen all"), "{text}");
}

/// Checks that tshark can read the complete recording and decodes the cyclic data as Connect specifies it. Skipped
/// without tshark.
fn check_recording(path: &str) {
    let tshark = |arguments: &[&str]| {
        let output = Command::new("tshark").args(["-r", path]).args(arguments).output().ok()?;
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let Some(wrong) = tshark(&["-Y", "_ws.malformed || _ws.expert.severity >= 0x600000"]) else {
        println!("skipped: tshark is not here");
        return;
    };
    assert_eq!(wrong, "");
    let statuses = tshark(&["-Y", "pn_rt && pn_io.ioxs", "-T", "fields", "-e", "pn_io.ioxs"]).unwrap_or_default();
    let good = statuses.lines().filter(|line| line.split(',').all(|status| status == "0x80")).count();
    assert!(good > 2, "{statuses}");
}
