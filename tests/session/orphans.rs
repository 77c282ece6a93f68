//! No motion outlives its operator: the process that moves a robot is killed or frozen, directly and through a session, from
//! a command, a command file and a command for two robots.

use super::{Desk, Running, simulator, stderr};

/// How the process ends.
const SIGNALS: [&str; 2] = ["KILL", "STOP"];

/// A way to type the motion, and whether a session of another process holds the links.
const ROUTES: [(&str, bool); 5] =
    [("direct", false), ("direct", true), ("batch", false), ("batch", true), ("several", false)];

/// A motion that takes a minute.
struct Motion {
    family: &'static str,
    words: &'static str,
    /// What `-vv` shows once it moves; empty where the look tells.
    moves: &'static str,
    /// What is read then, and whether it says that the robot stands.
    look: &'static str,
    stands: fn(&serde_json::Value) -> bool,
}

const JOG: Motion = Motion {
    family: "toyo",
    words: "toyo jog X + low --for 60s",
    moves: "",
    look: "toyo status",
    stands: |status| status["running"] == false,
};

const MOVE: Motion = Motion {
    family: "yerc",
    words: "yerc move relative --x 200 --speed 4mm/s",
    moves: "answer to 0x8a cartesian move: ok",
    look: "yerc status",
    stands: |status| status["held"] == true,
};

/// The robots `a` and `b`, each behind a simulator of its own.
fn two(motion: &Motion) -> (Vec<Running>, Desk) {
    let nobody = Desk::new(&[]);
    let simulators: Vec<_> = (0..2).map(|_| simulator(&nobody, motion.family, "127.0.0.1:0")).collect();
    let named: Vec<_> = ["a", "b"].iter().zip(&simulators).collect();
    let robots: Vec<_> = named.iter().map(|(name, of)| (**name, motion.family, of.first.as_str())).collect();
    let desk = Desk::new(&robots);
    (simulators, desk)
}

fn starts(desk: &Desk, motion: &Motion, route: &str) -> Running {
    let file = desk.folder.path().join("lines");
    std::fs::write(&file, format!("{}\n", motion.words)).unwrap();
    let words = match route {
        "direct" => format!("-r a {} --yes -vv", motion.words),
        "batch" => format!("-r a batch {} --yes -vv", file.display()),
        _ => format!("-r a -r b {} --yes -vv", motion.words),
    };
    let mut moving = Running::start(desk.command(&words), false);
    if motion.moves.is_empty() {
        while (motion.stands)(&desk.data(&format!("-r a {}", motion.look))) {}
    } else {
        for _ in 0..if route == "several" { 2 } else { 1 } {
            moving.says(motion.moves);
        }
    }
    moving
}

fn stops(motion: &Motion, routes: &[(&str, bool)]) {
    for signal in SIGNALS {
        for &(route, in_session) in routes {
            let (_simulators, desk) = two(motion);
            let session = in_session.then(|| Running::session(&desk, "a"));
            let moving = starts(&desk, motion, route);
            moving.signal(signal);
            // Its guardian has the same stderr: both have ended.
            let (code, said) = moving.end();
            assert_eq!(code, None, "{signal} {route}: it was killed: {said}");
            assert_eq!(signal == "STOP", said.contains("did not respond for 2 s"), "{route}: {said}");
            if let Some(mut session) = session {
                session.says("it was moving the robot");
                session.says("the robot was stopped");
                // With the session goes the link that it held.
            }
            let robots: &[_] = if route == "several" { &["a", "b"] } else { &["a"] };
            for robot in robots {
                let state = desk.data(&format!("-r {robot} {}", motion.look));
                assert!((motion.stands)(&state), "{signal} {route} {in_session}: {robot}: {state}");
            }
        }
    }
}

#[test]
fn a_jog_whose_process_is_killed_or_frozen_is_stopped() {
    // A jog shows its frames at its end, and a look beside it needs a session.
    stops(&JOG, &[("direct", true)]);
}

#[test]
fn a_move_whose_process_is_killed_or_frozen_is_stopped() {
    stops(&MOVE, &ROUTES);
}

/// A yrcx is not stopped by the guardian outside a session: its adapter misses the master.
#[test]
fn a_yrcx_whose_master_is_killed_or_frozen_stops() {
    for signal in SIGNALS {
        let nobody = Desk::new(&[]);
        let simulator = simulator(&nobody, "yrcx", "127.0.0.1:0");
        let desk = Desk::new(&[("cell", "yrcx", &simulator.first)]);
        let moving = super::moving(&desk);
        moving.signal(signal);
        while desk.data("-r cell yrcx status")["alarm"] != true {}
        drop(moving);
    }
}

#[test]
fn a_yrcx_motion_whose_client_is_killed_or_frozen_is_stopped_by_the_session() {
    for signal in SIGNALS {
        let (_simulator, desk) = super::cell();
        let mut session = Running::session(&desk, "cell");
        let moving = super::moving(&desk);
        moving.signal(signal);
        session.says("it was moving the robot");
        session.says("the robot was stopped");
        desk.until(|session| session["under_way"] == false);
        assert!(desk.run("-r cell yrcx servo on --yes").status.success(), "the stop input is on again");
        drop(moving);
    }
}

#[test]
fn what_came_of_a_stop_is_in_the_log_of_a_session_in_the_background() {
    let (_simulators, desk) = two(&MOVE);
    desk.data("-r a session open --background");
    let moving = starts(&desk, &MOVE, "direct");
    moving.signal("KILL");
    moving.end();
    let log = desk.files("log").remove(0);
    while !std::fs::read_to_string(&log).unwrap().contains(": the robot was stopped\n") {}
}

/// An update takes the file of the program away while it moves a robot.
#[test]
fn a_program_that_was_removed_stops_what_it_moves() {
    for in_session in [false, true] {
        let (_simulators, mut desk) = two(&MOVE);
        let copy = desk.folder.path().join("armctl");
        std::fs::copy(&desk.program, &copy).unwrap();
        let installed = std::mem::replace(&mut desk.program, copy.clone());
        let session = in_session.then(|| Running::session(&desk, "a"));
        let moving = starts(&desk, &MOVE, "direct");
        desk.program = installed;
        std::fs::remove_file(copy).unwrap();
        moving.signal("KILL");
        let (code, said) = moving.end();
        assert!(code.is_none() && !said.contains("may still move"), "{said}");
        if let Some(mut session) = session {
            session.says("the robot was stopped");
        }
        assert_eq!(desk.data("-r a yerc status")["held"], true, "in a session: {in_session}");
    }
}

/// What ends in order is not stopped once more: HOLD stays off.
#[test]
fn a_motion_that_ends_in_order_is_not_stopped() {
    let (_simulators, desk) = two(&MOVE);
    let moved = desk.run("-r a yerc move relative --x 1 --speed 100mm/s --yes");
    assert!(moved.status.success(), "{}", stderr(&moved));
    // The guardian has stderr as long as it lives, so it had ended when that was whole.
    assert_eq!(desk.data("-r a yerc status")["held"], false);
}

#[test]
fn a_move_that_is_to_be_left_goes_on_when_its_process_is_killed() {
    for in_session in [false, true] {
        let (_simulators, desk) = two(&MOVE);
        let mut session = in_session.then(|| Running::session(&desk, "a"));
        let words = format!("-r a {} --on-interrupt leave --yes -vv", MOVE.words);
        let mut moving = Running::start(desk.command(&words), false);
        moving.says(MOVE.moves);
        moving.signal("KILL");
        assert_eq!(moving.end().0, None);
        if let Some(session) = &mut session {
            session.says("it was moving the robot");
        }
        let status = desk.data("-r a yerc status");
        assert_eq!((&status["held"], &status["running"]), (&false.into(), &true.into()), "{status}");
    }
}

/// Keys that would end or suspend the process stop the robot, as Ctrl-C does.
#[test]
fn keys_that_end_or_suspend_a_process_stop_what_it_moves() {
    for signal in ["QUIT", "TSTP"] {
        for motion in [&MOVE, &JOG] {
            let (_simulators, desk) = two(motion);
            let _session = Running::session(&desk, "a");
            let moving = starts(&desk, motion, "direct");
            moving.signal(signal);
            let (code, said) = moving.end();
            assert_eq!(code, Some(130), "{signal} {}: {said}", motion.words);
            assert!(said.contains("the robot was stopped"), "{signal} {}: {said}", motion.words);
            let state = desk.data(&format!("-r a {}", motion.look));
            assert!((motion.stands)(&state), "{signal} {}: {state}", motion.words);
        }
        let (_simulator, desk) = super::cell();
        let _session = Running::session(&desk, "cell");
        let moving = super::moving(&desk);
        moving.signal(signal);
        let (code, said) = moving.end();
        assert!(code == Some(130) && said.contains("the robot was stopped"), "{signal}: {code:?}: {said}");
    }
}

/// A controller on UDP takes a stop from anybody; whoever else wants the link is told who has it.
#[test]
fn a_stop_goes_around_a_session_that_does_not_respond() {
    for (motion, stop) in [(&MOVE, "yerc hold on"), (&JOG, "toyo stop")] {
        let (_simulators, desk) = two(motion);
        let session = Running::session(&desk, "a");
        let pid = session.process.id();
        session.signal("STOP");
        let blocked = desk.run(&format!("-r a {}", motion.look));
        assert_eq!(blocked.status.code(), Some(4), "{}", stderr(&blocked));
        for part in [format!("its session (process {pid}) does not respond"), format!("`kill -CONT {pid}`")] {
            assert!(stderr(&blocked).contains(&part), "{part}: {}", stderr(&blocked));
        }
        let stopped = desk.run(&format!("-r a {stop}"));
        if motion.family == "yerc" {
            assert!(stopped.status.success(), "{}", stderr(&stopped));
            assert!(stderr(&stopped).contains("so the stop goes without it"), "{}", stderr(&stopped));
            assert_eq!(desk.data("-r a --no-session yerc status")["held"], true);
        } else {
            assert_eq!(stopped.status.code(), Some(4), "{}", stderr(&stopped));
            assert!(stderr(&stopped).contains(&format!("`kill -KILL {pid}`")), "{}", stderr(&stopped));
        }
        session.signal("CONT");
    }
}
