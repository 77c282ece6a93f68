//! TOYO: lines, programs, the server.

use armctl_controller::Now;
use armctl_controller::toyo::describe::{Sender, describe, summary};
use armctl_controller::toyo::program::{self, MAX_STEPS};
use armctl_controller::toyo::read_only_filter::only_reads_or_stops;
use armctl_controller::toyo::request::{Answer, Request, instruction};
use armctl_controller::toyo::session::Framer;
use armctl_controller::toyo::simulator::{Simulator, Start};
use armctl_controller::toyo::table::parameters::Parameter;

use super::{pause, pieces, seen, text_of};
use crate::seeds;

/// A request and, after a line end, its answer.
pub fn line(data: &[u8]) {
    only_reads_or_stops(data);
    let mut framer = Framer::default();
    data.iter().for_each(|byte| seen(format!("{:?}", framer.push(*byte))));
    let Some(text) = text_of(data) else { return };
    let (text, answer) = text.split_once('\n').unwrap_or((text, text));
    seen(Parameter::from_text(text));
    let request = Request::parse(text).ok();
    if let Some(request) = &request {
        seen((request.check(), request.content(), request.risk(), request.parameter()));
        if let Ok(again) = Request::parse(&request.text()) {
            assert_eq!(again.text(), request.text());
        }
        if let Ok(Answer::Data(record)) = request.answer(answer) {
            seen(format!("{:?}", request.answered(&record)));
        }
    }
    for sender in [Sender::guess(answer), Sender::Host, Sender::Controller] {
        for request in [None, request.as_ref()] {
            let description = describe(answer, sender, request);
            assert!(description.problem.is_some() || !description.fields.is_empty());
            for field in &description.fields {
                let raw: String = answer.chars().skip(field.column - 1).take(field.width).collect();
                assert_eq!(raw, field.raw, "{field:?}");
            }
            assert!(!summary(answer, sender, request).contains(char::is_control));
        }
    }
}

pub fn program(data: &[u8]) {
    let checked = program::check(data, MAX_STEPS);
    assert_eq!(checked.program.is_some(), checked.errors().count() == 0);
    for finding in &checked.findings {
        assert!(finding.line >= 1 && finding.column >= 1 && !finding.message.is_empty());
        seen(finding.to_string());
    }
    let Some(read) = checked.program else { return };
    for step in &read.steps {
        assert_eq!(instruction(&step.text()).as_ref(), Ok(&step.record));
    }
    let steps: Vec<_> = read.steps.into_iter().map(|step| step.record).collect();
    let style = program::Style { first: 1, is_whole: true, is_numbered: true };
    let listing = program::listing(&steps, style, &program::Rows::new());
    let again = program::check(listing.text.as_bytes(), MAX_STEPS);
    assert!(again.program.is_some(), "{}{:?}", listing.text, again.findings);
}

pub fn programs() -> Vec<Vec<u8>> {
    let written = "# A comment\nTAG start\nMOVP a 1 CN=0 S V=50 POST\nJMP start\nEND\n";
    let mut programs = vec![seeds::file("data/contract/backup-toyo/program-1.txt"), written.into()];
    programs.extend(seeds::folder("data/path", ".toyo"));
    programs
}

pub fn server(data: &[u8]) {
    let mut simulator = Simulator::new(Start::default());
    let mut now = Now::ZERO;
    for (control, piece) in pieces(data) {
        now += pause(control);
        simulator.receive(now, piece);
        while let Some(bytes) = simulator.transmit(now) {
            assert!(bytes.ends_with(b"\r\n"), "{bytes:?}");
        }
        assert!(simulator.wake().is_none_or(|wake| wake > now));
    }
}

pub fn server_scripts() -> Vec<Vec<u8>> {
    let lines: Vec<Vec<u8>> = seeds::toyo().into_iter().map(|line| [&line[..], b"\r\n"].concat()).collect();
    lines.chunks(8).map(|lines| seeds::script(4, lines)).collect()
}
