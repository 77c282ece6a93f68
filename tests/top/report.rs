//! `armctl report`: content of the archives, names and addresses that it replaces, and that it only reads.

use std::path::Path;
use std::process::Command;

use super::{Recorded, Workspace};

const FILES: &str = "versions.json check.json settings.json status.json alarms.json frames.pcapng";

/// Runs the command; returns the exit code, and stdout with stderr.
fn run(workspace: &Workspace, words: &[&str]) -> (Option<i32>, String) {
    let output = workspace.command(words).output().expect("a process");
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8_lossy(&text).into_owned())
}

/// The archives in a folder, unpacked by the tar of the system: file name, names of the files, their content.
fn archives(folder: &Path) -> Vec<(String, String, Vec<u8>)> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("read").path()).collect();
    names.sort();
    let tar = |option: &str, path: &Path| {
        let output = Command::new("tar").arg(option).arg(path).output().expect("tar");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let archive = |path: &std::path::PathBuf| {
        let listed = String::from_utf8(tar("-tzf", path)).expect("names").lines().collect::<Vec<_>>().join(" ");
        (path.file_name().expect("a name").to_string_lossy().into_owned(), listed, tar("-xzOf", path))
    };
    names.iter().map(archive).collect()
}

fn holds(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}

#[test]
fn packs_every_family_and_only_reads() {
    let recorded = Recorded::start();
    let workspace = Workspace::new(&recorded.targets);
    for (folder, option) in [("open", "--json"), ("masked", "--anonymous")] {
        let path = workspace.folder.path().join(folder);
        let to = path.to_str().expect("a path");
        let words = ["report", "robot1", "robot2", "robot3", "--dir", to, option];
        let (code, text) = run(&workspace, &words);
        // The states of the simulators let some layers of the check fail.
        assert!(matches!(code, Some(0 | 8 | 9)), "{code:?} {text}");
        assert!(text.contains("frames.pcapng"), "{text}");
        let archives = archives(&path);
        assert_eq!(archives.len(), 3);
        for (name, files, content) in archives {
            assert_eq!(files, FILES, "{name}");
            let is_masked = folder == "masked";
            assert_eq!(name.starts_with("report-robot-"), is_masked, "{name}");
            for part in [&b"127.0.0.1"[..], &[127, 0, 0, 1], b"\"robot1\"", b"\"robot2\""] {
                assert!(!is_masked || !holds(&content, part), "{name} has {}", part.escape_ascii());
            }
            assert!(is_masked || holds(&content, &[127, 0, 0, 1]), "{name} has the frames");
            assert!(holds(&content, b"\"layers\"") && holds(&content, b"\"reachable\": true"), "{name}");
        }
        if folder == "open" {
            let (code, text) = run(&workspace, &words);
            assert!(code == Some(1) && text.contains("already exists"), "{code:?} {text}");
        }
    }
    recorded.assert_only_reads();
}

#[test]
fn packs_a_robot_that_does_not_answer() {
    let unused = std::net::UdpSocket::bind("127.0.0.1:0").expect("a port").local_addr().expect("an address");
    let workspace = Workspace::new(&[format!("yerc udp://{unused}")]);
    let path = workspace.folder.path().join("reports");
    let to = path.to_str().expect("a path");
    let options = ["--timeout", "50ms", "--retries", "0"];
    let (code, text) = run(&workspace, &[&["report", "robot1", "--dir", to][..], &options].concat());
    assert_eq!(code, run(&workspace, &[&["robots", "check", "robot1"][..], &options].concat()).0, "{text}");
    let archives = archives(&path);
    assert!(holds(&archives[0].2, b"\"kind\": \"no_answer\"") && holds(&archives[0].2, b"\"failed\""), "{archives:?}");
}
