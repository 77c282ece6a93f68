//! Every request and answer in the Toyo manual, parsed and formatted, character for character.
//!
//! For a misprint (`flags` has `typo`), the file has the reason and the corrected text. If a test fails, do not change
//! the test.

use armctl_controller::toyo::request::{Answer, Request};
use serde::Deserialize;

#[derive(Debug, Deserialize)]
struct Transcripts {
    pairs: Vec<Pair>,
    sessions: Vec<Session>,
}

#[derive(Debug, Deserialize)]
struct Pair {
    section: String,
    #[serde(rename = "ref")]
    reference: String,
    tx: String,
    rx: String,
    #[serde(default)]
    rx_alternatives: Vec<String>,
    corrected: Option<Blocks>,
}

#[derive(Debug, Deserialize)]
struct Session {
    id: String,
    steps: Vec<Blocks>,
}

#[derive(Debug, Deserialize)]
struct Blocks {
    tx: String,
    rx: String,
}

fn transcripts() -> Transcripts {
    serde_json::from_str(include_str!("data/toyo-transcripts.json")).expect("the transcripts are well-formed")
}

/// Asserts that a request and its answer can be parsed completely, and are equal after they are formatted again.
fn check_pair(about: &str, tx: &str, rx: &str) {
    let request = Request::parse(tx).unwrap_or_else(|error| panic!("{about}: {tx}: {error}"));
    request.check().unwrap_or_else(|error| panic!("{about}: {tx}: {error}"));
    assert_eq!(request.text(), tx, "{about}");
    let content = request.content().unwrap_or_else(|error| panic!("{about}: {tx}: {error}"));
    if let Some(content) = content {
        let body = content.emit().unwrap_or_else(|error| panic!("{about}: {tx}: {error}"));
        assert!(tx.ends_with(&body), "{about}: {tx}: made anew as {body}");
    }
    let answer = request.answer(rx).unwrap_or_else(|error| panic!("{about}: {tx}: {rx}: {error}"));
    assert_eq!(answer.text().trim_end(), rx.trim_end(), "{about}: {tx}");
    if let Answer::Data(record) = &answer {
        let content = request.answered(record).unwrap_or_else(|error| panic!("{about}: {rx}: {error}"));
        if let Some(content) = content {
            let body = content.emit().unwrap_or_else(|error| panic!("{about}: {rx}: {error}"));
            assert!(rx.ends_with(&body), "{about}: {rx}: made anew as {body}");
        }
    }
}

#[test]
fn every_printed_pair_is_parsed_and_made_again() {
    let pairs = transcripts().pairs;
    assert_eq!(pairs.len(), 410);
    for pair in &pairs {
        let about = format!("TO {} {}", pair.section, pair.reference);
        match &pair.corrected {
            Some(corrected) => check_pair(&about, &corrected.tx, &corrected.rx),
            None => check_pair(&about, &pair.tx, &pair.rx),
        }
        for rx in &pair.rx_alternatives {
            let tx = pair.corrected.as_ref().map_or(&pair.tx, |corrected| &corrected.tx);
            assert!(Request::parse(tx).unwrap().answer(rx).is_ok(), "{about}: {tx}: {rx}");
        }
    }
}

/// The codec never sends a misprint. It still parses a misprint in blanks or digits.
#[test]
fn misprints_are_never_sent() {
    for pair in transcripts().pairs {
        let Some(corrected) = &pair.corrected else { continue };
        let produced_size = Request::parse(&corrected.tx).unwrap().text();
        if pair.tx != corrected.tx {
            assert_ne!(produced_size, pair.tx, "TO {} {}", pair.section, pair.reference);
        }
    }
}

#[test]
fn both_sample_sessions_are_parsed_and_made_again() {
    let sessions = transcripts().sessions;
    assert_eq!(sessions.iter().map(|session| session.steps.len()).collect::<Vec<_>>(), [13, 13]);
    for session in &sessions {
        for step in &session.steps {
            check_pair(&format!("TO {}", session.id), &step.tx, &step.rx);
        }
    }
}
