//! Rules that every family follows.

use super::workspace::Workspace;
use crate::support::simulator::Simulator;

fn entry(name: &str, target: &str, more: &str) -> String {
    format!("[[robot]]\nname = \"{name}\"\ntarget = \"{target}\"\n{more}\n")
}

#[test]
fn read_only_applies_to_every_name_of_an_address() {
    let controller = Simulator::start("yerc");
    let (address, settings) = controller.place();
    let desk = Workspace::new(&entry("line3", &controller.url, "read_only = true"));
    let spellings = [
        "-r line3".to_owned(),
        format!("-t udp://{address}?{settings}"),
        format!("-t udp://localhost:{}?{settings}", address.port()),
    ];
    for spelling in &spellings {
        for order in ["var set B0=1", "servo on --yes", "file delete A.JBI --yes"] {
            desk.fails(&format!("{spelling} yerc {order}"), 7, "is read-only");
        }
        // Stops and reads are always allowed.
        assert_eq!(desk.run(&format!("{spelling} yerc hold on")).exit, Some(0));
        assert!(desk.data(&format!("{spelling} yerc var get B0")).to_string().contains("\"value\":0"));
    }
    let mut command = desk.command("yerc var set B0=1");
    let output = command.env("ARMCTL_TARGET", &spellings[2][3..]).output().unwrap();
    assert_eq!(output.status.code(), Some(7), "ARMCTL_TARGET");
}

#[test]
fn session_of_a_read_only_robot_passes_reads_and_stops_only() {
    let controller = Simulator::start("yerc");
    let desk = Workspace::new(&entry("line3", &controller.url, "read_only = true"));
    assert_eq!(desk.run("-r line3 session open --background").exit, Some(0));
    // A client whose inventory does not have this entry uses the same address.
    std::fs::write(desk.folder.path().join("other.toml"), "").unwrap();
    let without_session = |words: &str| desk.run(&format!("--config other.toml -t {} yerc {words}", controller.url));
    let refused = without_session("var set B0=1");
    assert!(refused.exit == Some(7) && refused.stderr.contains("is read-only"), "{refused:?}");
    assert_eq!(without_session("hold on").exit, Some(0));
    assert_eq!(without_session("status").exit, Some(0));
    assert!(desk.data("-r line3 yerc var get B0").to_string().contains("\"value\":0"));
    assert_eq!(desk.run("session close line3").exit, Some(0));
}

/// A session is opened, and then its robot becomes read-only. From this time, the session passes no request that
/// changes something. It reports the reason to a client with another inventory.
#[test]
fn read_only_applies_to_an_open_session() {
    for (family, changes, stop, read) in [
        ("yerc", &["alarm reset", "io set 27010=on", "servo on --yes", "var set B0=2"][..], "hold on", "var get B0"),
        ("toyo", &["host on", "point set 7 1 2 3 4 --yes", "home --yes", "jog X + inch --yes"], "stop", "status"),
        (
            "yrcx",
            &["var set SGI1 1", "info version", "io set 20=on", "move --point 1 --yes", "jog pulse 1 + --for 1s --yes"],
            "stop",
            "io get",
        ),
    ] {
        let controller = Simulator::start(family);
        let desk = Workspace::new(&entry("cell", &controller.url, ""));
        assert_eq!(desk.run("-r cell session open --background").exit, Some(0), "{family}");
        // The other inventory does not have this robot, so the client cannot read there that the robot became
        // read-only.
        std::fs::write(desk.folder.path().join("other.toml"), "").unwrap();
        let around = |words: &str| desk.run(&format!("--config other.toml -t {} {family} {words}", controller.url));
        assert_eq!(around(changes[0]).exit, Some(0), "{family}");
        assert_eq!(desk.run("robots set cell read_only=on").exit, Some(0));
        for change in changes {
            let refused = around(change);
            assert_eq!(refused.exit, Some(7), "{family} {change}: {refused:?}");
            assert!(refused.stderr.contains("is read-only: the session sent nothing"), "{change}: {refused:?}");
        }
        assert_eq!(around(read).exit, Some(0), "{family}: {:?}", around(read));
        // The session stays read-only, even if the setting is removed.
        assert_eq!(desk.run("robots set cell read_only=off").exit, Some(0));
        assert_eq!(around(changes[0]).exit, Some(7), "{family}");
        assert_eq!(around(stop).exit, Some(0), "{family}");
        assert_eq!(desk.run("session close cell").exit, Some(0));
    }
}

#[test]
fn yrcx_command_connection_outside_a_session_is_a_motion() {
    let controller = Simulator::start("yrcx");
    let inventory = [entry("free", &controller.url, ""), entry("kept", "eip://127.0.0.1:1", "read_only = true")];
    let desk = Workspace::new(&inventory.concat());
    desk.fails("-r free yrcx info version", 7, "stops the robot");
    desk.fails("-r kept yrcx info version --yes", 7, "is read-only");
    desk.fails("-r kept session open", 7, "a session takes control of the controller");
    assert_eq!(desk.run("-r free yrcx status").exit, Some(0), "what only looks takes no connection");
    assert_eq!(desk.run("-r free yrcx info version --yes").exit, Some(0));
    assert_eq!(desk.run("-r free session open --background").exit, Some(0));
    assert_eq!(desk.run("-r free yrcx info version").exit, Some(0), "the session holds it");
    assert_eq!(desk.run("session close free").exit, Some(0));
}

#[test]
fn opens_the_session_of_a_robot_with_hold() {
    let controller = Simulator::start("yrcx");
    let desk = Workspace::new(&entry("cell", &controller.url, "hold = true"));
    let first = desk.run("-r cell yrcx info version");
    assert!(first.exit == Some(0) && first.stderr.contains("session opened"), "{first:?}");
    let second = desk.run("-r cell yrcx info version");
    assert!(second.exit == Some(0) && !second.stderr.contains("session"), "{second:?}");
    assert_eq!(desk.data("-r cell yrcx status")["alarm"], false, "the connection stayed open");
    assert_eq!(desk.run("session close cell").exit, Some(0));
}

#[test]
fn several_robots_must_be_named() {
    let controllers = [Simulator::start("yerc"), Simulator::start("yerc")];
    let inventory: String = controllers
        .iter()
        .enumerate()
        .map(|(number, controller)| entry(&format!("c{number}"), &controller.url, "tags = [\"weld\"]"))
        .collect();
    let desk = Workspace::new(&inventory);
    for choice in ["--tag weld", "--all", "-r c*"] {
        for order in ["file delete TEST.JBI --yes", "servo on --yes"] {
            desk.fails(&format!("{choice} yerc {order}"), 7, "on 2 of 2 robots");
        }
        assert_eq!(desk.run(&format!("{choice} yerc var set B0=1")).exit, Some(0), "what can be set again");
    }
    assert_eq!(desk.run("-r c0 -r c1 yerc servo on --yes").exit, Some(0));
}

#[test]
fn rejects_flags_without_effect() {
    let desk = Workspace::new("");
    for (line, part) in [
        ("robots add foo udp://127.0.0.1 --tag line1", "--tag has no effect"),
        ("robots list --sim", "--sim and -t cannot select robots in the inventory"),
        ("robots path --tag line1", "--tag has no effect"),
        ("robots remove foo --dry-run", "--dry-run has no effect"),
        ("decode toyo @STOP --all", "--all has no effect"),
        ("decode toyo @STOP --timeout 1s", "--timeout has no effect"),
        ("yrcx io map --bus devicenet --sim", "--sim has no effect"),
        ("session list --watch", "--watch has no effect"),
    ] {
        desk.fails(line, 2, part);
    }
    assert!(!desk.run("robots list").stdout.contains("foo"), "nothing was added");
    assert_eq!(desk.run("--sim yerc status -y").exit, Some(2), "there is no short form of --yes");
}

#[test]
fn endless_motion_needs_a_limit_without_a_terminal() {
    let desk = Workspace::new("");
    desk.fails("--sim yrcx jog pulse 1 + --yes", 2, "no terminal for Ctrl-C");
    assert_eq!(desk.run("--sim yrcx jog pulse 1 + --for 50ms --yes").exit, Some(0));
}
