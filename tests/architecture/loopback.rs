//! No transcript sends a byte to another machine. A line with the address of another machine is a dry run, uses the
//! built-in simulator, works only on files, or is refused before sending.

use std::fs;
use std::net::Ipv4Addr;

use super::source::root;

/// Commands that use no controller.
const FILES_ALONE: [&str; 4] = ["robots add ", "robots list", "robots show ", "decode "];
/// Exit codes of lines that are refused before anything is sent: usage error, and refused by armctl.
const NOT_SENT: [&str; 2] = ["? 2", "? 7"];

#[test]
fn transcripts_stay_on_this_machine() {
    let mut wrong = Vec::new();
    for entry in fs::read_dir(root().join("tests/cli")).expect("the transcripts are there") {
        let path = entry.expect("a transcript").path();
        let Some("console") = path.extension().and_then(|extension| extension.to_str()) else { continue };
        let text = fs::read_to_string(&path).expect("a transcript is text");
        for run in text.split("\n$ ").skip(1) {
            let (line, said) = run.split_once('\n').unwrap_or((run, ""));
            let is_harmless = line.contains("--dry-run")
                || line.contains("-t 'sim:")
                || FILES_ALONE.iter().any(|words| line.contains(words))
                || said.lines().any(|line| NOT_SENT.contains(&line));
            if is_elsewhere(line) && !is_harmless {
                wrong.push(format!("{}: {line}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whether a line contains an address of another machine.
fn is_elsewhere(line: &str) -> bool {
    let words = line.split(|c: char| !c.is_ascii_digit() && c != '.');
    words
        .filter_map(|word| word.parse::<Ipv4Addr>().ok())
        .any(|address| !address.is_loopback() && !address.is_unspecified())
}
