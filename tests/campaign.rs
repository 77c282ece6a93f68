//! A small run of the fault campaign: the built binary against strict controllers in Python, on real sockets and
//! pseudo-terminals, with a fault in each operation. `docs/reliability.md` has the large run. Without Python 3.9 or
//! later, the test is skipped with a message; without user namespaces, only PROFINET is skipped.

use std::path::Path;
use std::process::Command;

/// The campaign uses pidfd watchers of asyncio.
const PYTHON_CHECK: &str = "import asyncio, sys; sys.exit(0 if hasattr(asyncio, 'PidfdChildWatcher') else 1)";

#[test]
fn faults_cause_no_wrong_data_no_doubled_change_and_no_hang() {
    let python = Command::new("python3").args(["-c", PYTHON_CHECK]).output();
    if !python.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: no python3 with asyncio.PidfdChildWatcher");
        return;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/campaign/run");
    let run = Command::new("python3")
        .arg(script)
        .args(["--operations", "60", "--workers", "4", "--seed", "7", "--armctl", env!("CARGO_BIN_EXE_armctl")])
        .output()
        .expect("python3 starts");
    let report = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success(), "{report}");
    report.lines().filter(|line| line.starts_with("skipped")).for_each(|line| eprintln!("{line}"));
}
