//! YERC: frames, payloads, files of the controller, typed addresses and positions, the server.

use std::time::Duration;

use armctl_controller::Now;
use armctl_controller::text::Encoding;
use armctl_controller::units;
use armctl_controller::yerc::describe::{Sender, describe, summary};
use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::job::{JobText, names_of, scan};
use armctl_controller::yerc::payload::{
    Alarm, Axes, AxisNames, BasePosition, CartesianMove, ControllerStatus, ExternalPosition, JobInfo, ManagementTime,
    Position, PulseMove, SystemInfo, elapsed_seconds,
};
use armctl_controller::yerc::query::{Query as _, ReadStatus};
use armctl_controller::yerc::read_only_filter::only_reads_or_stops;
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::signal::Signal;
use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_controller::yerc::table::ROWS;
use armctl_controller::yerc::variables::{Reference, Value, VariableKind, parse_numbers, parse_references, plan_reads};
use armctl_controller::yerc::wire::{AnswerFrame, Division, RequestFrame};
use armctl_controller::yerc::{Model, files, names, status};
use armctl_frame::backup::job_date::{DateFilter, align_files};

use super::{pause, pieces, seen, text_of};
use crate::seeds;

pub fn frame(data: &[u8]) {
    if let Ok(frame) = RequestFrame::parse(data) {
        assert_eq!(RequestFrame::parse(&frame.emit()), Ok(frame));
    }
    if let Ok(frame) = AnswerFrame::parse(data) {
        assert_eq!(AnswerFrame::parse(&frame.emit()), Ok(frame));
        seen(format!("{:?}", status::explain(frame.status)));
    }
    let row = &ROWS[usize::from(data.last().copied().unwrap_or_default()) % ROWS.len()];
    let request = Request { command: row.number, instance: 1, attribute: 0, service: 1, data: Vec::new() };
    for sender in [Sender::guess(data), Sender::Client, Sender::Controller] {
        for request in [None, Some(&request)] {
            let description = describe(data, sender, request);
            let end =
                description.fields.iter().try_fold(0, |at, field| (field.offset == at).then_some(at + field.size));
            assert!(end == Some(data.len()) || description.problem.is_some(), "{description:?}");
            assert!(!summary(data, sender, request).contains(char::is_control));
        }
    }
    only_reads_or_stops(data);
}

pub fn payload(data: &[u8]) {
    macro_rules! round_trip {
        ($($parse:path),*) => {
            $(if let Ok(value) = $parse(data) {
                // Values that a short answer leaves out are encoded as 0.
                assert_eq!($parse(&value.emit()).map(|again| again.emit()), Ok(value.emit()), "{value:?}");
            })*
        };
    }
    round_trip!(
        ControllerStatus::parse,
        Alarm::parse,
        Alarm::parse_with_texts,
        JobInfo::parse,
        AxisNames::parse,
        ManagementTime::parse,
        SystemInfo::parse,
        Axes::parse,
        Position::parse,
        BasePosition::parse,
        ExternalPosition::parse,
        CartesianMove::parse,
        PulseMove::parse
    );
    if let Ok(alarm) = Alarm::parse_with_texts(data) {
        Model::ALL.iter().for_each(|model| seen(alarm.sub_code(*model).to_string()));
    }
    if let Ok(time) = ManagementTime::parse(data) {
        seen(time.seconds());
    }
    seen((elapsed_seconds(data), Model::from_software(data)));
    for kind in VariableKind::all() {
        if let Ok(value) = Value::parse(kind, data) {
            let again = Value::parse(kind, &value.emit()).expect("an encoded value");
            assert_eq!(again.emit(), value.emit(), "{value:?}");
        }
        let references: Vec<Reference> = (0..20).map(|number| Reference::new(kind, number)).collect();
        plan_reads(&references).iter().for_each(|step| seen(step.decode(data)));
        seen(Value::from_text(kind, data));
    }
    if let Ok(names) = files::split_list(data) {
        for name in names {
            seen((files::FileName::new(name), files::check_load_name(name), files::FileType::from_name(name)));
            for encoding in Encoding::names().filter_map(|name| name.parse::<Encoding>().ok()) {
                seen(encoding.name(name));
            }
        }
    }
    seen((files::check_filter(data), files::check_name(data)));
}

pub fn name_file(data: &[u8]) {
    for file in names::FILES {
        for encoding in [Encoding::default(), Encoding::Utf8] {
            if let Ok(found) = names::read(file, data, encoding) {
                let lines = data.split(|byte| *byte == b'\n').count();
                assert!(found.names.len() <= 8 * lines, "{} names", found.names.len());
                seen(format!("{found:?}"));
            }
        }
    }
}

pub fn name_files() -> Vec<Vec<u8>> {
    let files = ["IONAME.DAT", "EXIONAME.DAT", "VARNAME.DAT", "IOMNAME.DAT"];
    files.map(|name| seeds::file(&format!("data/contract/backup-yerc/{name}"))).to_vec()
}

pub fn job(data: &[u8]) {
    let text = Encoding::default().decode(data);
    let job = JobText::new(&text);
    for (_, line) in &job.instructions {
        let (references, speeds) = scan(line);
        assert!(references.len() + speeds.len() <= line.len());
        seen(format!("{references:?} {speeds:?}"));
    }
    seen((format!("{job:?}"), names_of(&text)));
    let whole = DateFilter::align(data);
    let (first, second) = data.split_at(data.len() / 2);
    let mut filter = DateFilter::default();
    let mut kept = [filter.take(first), filter.take(second)].concat();
    kept.extend(filter.rest());
    assert_eq!(kept, whole, "pieces give the same as the whole");
    seen(align_files(first.to_vec(), second.to_vec()));
}

pub fn jobs() -> Vec<Vec<u8>> {
    [seeds::folder("data/contract/backup-yerc", ".JBI"), seeds::folder("data/path", ".JBI")].concat()
}

pub fn text(data: &[u8]) {
    let Some(text) = text_of(data) else { return };
    if let Ok(position) = text.parse::<Position>() {
        assert_eq!(position.to_string().parse(), Ok(position));
    }
    if let Ok(position) = text.parse::<BasePosition>() {
        assert_eq!(position.to_string().parse(), Ok(position));
    }
    if let Ok(position) = text.parse::<ExternalPosition>() {
        assert_eq!(position.to_string().parse(), Ok(position));
    }
    for unit in [units::MILLIMETRE, units::DEGREE, units::PERCENT, units::MILLIMETRE_PER_SECOND, units::PULSE] {
        if let Ok(value) = unit.parse(text) {
            assert_eq!(unit.parse(&unit.show(value).to_string()), Ok(value));
        }
        seen(unit.parse_steps(text));
    }
    if let Ok(references) = parse_references(text) {
        references.iter().for_each(|reference| assert_eq!(reference.to_string().parse(), Ok(*reference)));
    }
    if let Ok(signal) = text.parse::<Signal>() {
        assert_eq!(signal.to_string().parse(), Ok(signal));
    }
    seen((parse_numbers(text), text.parse::<Group>(), text.parse::<files::FileType>(), status::lookup(text)));
    seen((text.parse::<Model>(), files::list_by(text), names::register(text)));
}

pub fn texts() -> Vec<Vec<u8>> {
    const TEXTS: [&str; 12] = [
        "base:x=1.5,y=-2,z=0.001,rx=90,ry=0,rz=-180,tool=1,form=3",
        "pulse:1,2,3,4,5,6",
        "type7:1=1,2=2,8=-3",
        "user3:x=1,y=2,z=3",
        "B0-5,I7,D2,R3,S4,P5,BP1,EX2",
        "10010",
        "1-5,7,9-12",
        "R1",
        "2060",
        "12.345 mm",
        "*.JBI",
        "M5",
    ];
    TEXTS.map(|text| text.as_bytes().to_vec()).to_vec()
}

/// Datagrams to the simulator: it answers each at most once, and its own frames are valid.
pub fn server(data: &[u8]) {
    let mut simulator = Simulator::new(Start::default());
    let (mut now, mut received, mut answered) = (Now::ZERO, 0, 0);
    for (control, piece) in pieces(data) {
        now += pause(control);
        let division = if control & 8 == 0 { Division::Robot } else { Division::File };
        simulator.receive(now, division, u64::from(control >> 6), piece);
        received += 1;
        while let Some(outgoing) = simulator.transmit(now) {
            AnswerFrame::parse(&outgoing.bytes).expect("the simulator sends valid frames");
            answered += 1;
        }
        assert!(answered <= received, "{answered} answers to {received} datagrams");
        assert!(simulator.wake().is_none_or(|wake| wake > now));
    }
    // After this, it still answers.
    now += Duration::from_secs(60);
    while simulator.transmit(now).is_some() {}
    let is_ok = (0..100).any(|_| {
        simulator.receive(now, Division::Robot, 9, &ReadStatus.request().frame(1));
        let answer = simulator.transmit(now).expect("an answer");
        AnswerFrame::parse(&answer.bytes).expect("a valid frame").status.is_ok()
    });
    assert!(is_ok, "the status can be read");
}

pub fn server_scripts() -> Vec<Vec<u8>> {
    let frames = seeds::yerc();
    let is_file = |frame: &[u8]| frame.get(9) == Some(&2);
    let (file, robot): (Vec<_>, Vec<_>) = frames.into_iter().partition(|frame| is_file(frame));
    let traffic = seeds::traffic(crate::links::yerc);
    vec![seeds::script(2, &robot[..20]), seeds::script(10, &file), seeds::script(10, &traffic)]
}
