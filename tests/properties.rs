//! Properties of the YERC codec: values are equal after encoding and decoding.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use armctl_controller::units;
use armctl_controller::yerc::Model;
use armctl_controller::yerc::payload::{
    Alarm, AlarmKind, AlarmTexts, Axes, AxisNames, BasePosition, CartesianMove, ControllerStatus, ExtendedForm,
    ExternalPosition, Form, JobInfo, ManagementTime, MoveLayout, Position, PositionKind, PulseMove, SpeedClass,
    SystemInfo, Text,
};
use armctl_controller::yerc::query::{Query, WriteVariable};
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::table::{ROWS, service};
use armctl_controller::yerc::variables::{
    PlannedRead as _, Reference, Value, VariableKind, plan_io_reads, plan_reads, plan_register_reads, plan_writes,
};
use armctl_controller::yerc::wire::{AnswerFrame, Division, RequestFrame, Status};
use proptest::collection::vec;
use proptest::prelude::*;

fn text<const N: usize>() -> impl Strategy<Value = Text<N>> {
    vec(1_u8.., 0..=N).prop_map(|bytes| Text::new(&bytes).unwrap())
}

fn kind() -> impl Strategy<Value = PositionKind> {
    prop_oneof![prop::sample::select(vec![0_u32, 16, 17, 18, 19]), any::<u32>(),].prop_map(PositionKind::from_word)
}

fn position() -> impl Strategy<Value = Position> {
    (kind(), any::<[u32; 4]>(), any::<[i32; 8]>()).prop_map(|(kind, [form, tool, user, extended], axes)| Position {
        kind,
        form: Form(form),
        tool,
        user,
        extended: ExtendedForm(extended),
        axes: Axes::full(axes),
    })
}

fn alarm() -> impl Strategy<Value = Alarm> {
    let texts =
        (text(), text(), text()).prop_map(|(source, sub_code, reversed)| AlarmTexts { source, sub_code, reversed });
    (any::<[u32; 3]>(), text(), text(), proptest::option::of(texts)).prop_map(
        |([code, data, kind], time, name, texts)| Alarm { code, data, kind: AlarmKind(kind), time, name, texts },
    )
}

fn value() -> impl Strategy<Value = Value> {
    prop_oneof![
        any::<u8>().prop_map(Value::Byte),
        any::<i16>().prop_map(Value::Integer),
        any::<i32>().prop_map(Value::Double),
        any::<f32>().prop_filter("NaN equals nothing", |value| !value.is_nan()).prop_map(Value::Real),
        text().prop_map(Value::Short),
        text().prop_map(Value::Long),
        position().prop_map(Value::Position),
        (kind(), any::<[i32; 8]>()).prop_map(|(kind, axes)| Value::Base(BasePosition { kind, axes: Axes::full(axes) })),
        (kind(), any::<[i32; 8]>())
            .prop_map(|(kind, axes)| Value::External(ExternalPosition { kind, axes: Axes::full(axes) })),
    ]
}

fn cartesian() -> impl Strategy<Value = CartesianMove> {
    (any::<bool>(), any::<[u32; 4]>(), kind(), any::<[i32; 8]>(), any::<[u32; 4]>(), any::<[i32; 9]>()).prop_map(
        |(short, head, coordinate, target, [form, extended, tool, user], tail)| CartesianMove {
            layout: if short { MoveLayout::Words25 } else { MoveLayout::Words26 },
            robot: head[0],
            station: head[1],
            class: SpeedClass::from_word(head[2]),
            speed: head[3],
            coordinate,
            target: target[..6].try_into().unwrap(),
            reserved: [target[6], if short { 0 } else { target[7] }],
            form: Form(form),
            extended: ExtendedForm(extended),
            tool,
            user,
            base: tail[..3].try_into().unwrap(),
            station_axes: tail[3..].try_into().unwrap(),
        },
    )
}

fn request() -> impl Strategy<Value = Request> {
    let rows = prop::sample::select(ROWS);
    let known = (rows, any::<u16>(), any::<u8>(), any::<prop::sample::Index>(), vec(any::<u8>(), 0..479)).prop_map(
        |(row, instance, attribute, index, data)| Request {
            command: row.number,
            instance: instance % 4200,
            attribute: attribute % 15,
            service: index.get(row.services).number,
            data,
        },
    );
    let any = (any::<u16>(), any::<u16>(), any::<u8>(), any::<u8>(), vec(any::<u8>(), 0..=479)).prop_map(
        |(command, instance, attribute, service, data)| Request { command, instance, attribute, service, data },
    );
    prop_oneof![3 => known, 1 => any]
}

proptest! {
    #[test]
    fn round_trips_frames(request in request(), id: u8, block: u32, ack: bool, code: u8, added_size in 0_u8..3, added: u32) {
        let file = request.division() == Division::File;
        let frame = RequestFrame {
            division: request.division(),
            ack,
            id,
            block,
            command: if file { 0 } else { request.command },
            instance: request.instance,
            attribute: request.attribute,
            service: request.service,
            data: &request.data,
        };
        let bytes = frame.emit();
        prop_assert_eq!(RequestFrame::parse(&bytes), Ok(frame));
        let added = match added_size { 0 => 0, 1 => added & 0xFFFF, _ => added };
        let status = Status { code, added_size, added };
        let answer = AnswerFrame { division: request.division(), ack, id, block, service: request.service, status, data: &request.data };
        let bytes = answer.emit();
        prop_assert_eq!(AnswerFrame::parse(&bytes), Ok(answer));
    }

    #[test]
    fn round_trips_payloads(
        words: [u32; 2], alarm in alarm(), name in text(), more: [u32; 3], names in vec(text::<4>(), 8),
        start in text(), elapsed in text(), version in text(), model in text(), parameters in text(),
    ) {
        let status = ControllerStatus { words };
        prop_assert_eq!(ControllerStatus::parse(&status.emit()), Ok(status));
        let parsed = if alarm.texts.is_some() { Alarm::parse_with_texts(&alarm.emit()) } else { Alarm::parse(&alarm.emit()) };
        prop_assert_eq!(parsed, Ok(alarm));
        let job = JobInfo { name, line: more[0], step: more[1], speed_override: more[2] };
        prop_assert_eq!(JobInfo::parse(&job.emit()), Ok(job));
        let names = AxisNames { names: names.try_into().unwrap() };
        prop_assert_eq!(AxisNames::parse(&names.emit()), Ok(names));
        let time = ManagementTime { start, elapsed };
        prop_assert_eq!(ManagementTime::parse(&time.emit()), Ok(time));
        let info = SystemInfo { version, name: model, parameters };
        prop_assert_eq!(SystemInfo::parse(&info.emit()), Ok(info));
    }

    #[test]
    fn round_trips_axes_and_positions_of_every_length(values in vec(any::<i32>(), 0..=8), position in position()) {
        let axes = Axes::new(&values).unwrap();
        let fitted = Position { axes, ..position };
        prop_assert_eq!(Position::parse(&fitted.emit_fitted()), Ok(fitted));
        prop_assert_eq!(Position::parse(&position.emit()), Ok(position));
        if !values.is_empty() {
            prop_assert_eq!(Axes::parse(&axes.emit()), Ok(axes));
        }
    }

    #[test]
    fn round_trips_moves(target in cartesian(), words in any::<[u32; 5]>(), axes: [i32; 8], tail: [i32; 9]) {
        prop_assert_eq!(CartesianMove::parse(&target.emit()), Ok(target));
        prop_assert_eq!(target.emit().len(), target.layout.size());
        let pulses = PulseMove {
            robot: words[0],
            station: words[1],
            class: SpeedClass::from_word(words[2]),
            speed: words[3],
            axes,
            tool: words[4],
            base: tail[..3].try_into().unwrap(),
            station_axes: tail[3..].try_into().unwrap(),
        };
        prop_assert_eq!(PulseMove::parse(&pulses.emit()), Ok(pulses));
    }

    #[test]
    fn round_trips_values_with_extra_bytes(value in value(), extra in vec(any::<u8>(), 0..8)) {
        let mut data = value.emit();
        prop_assert_eq!(data.len(), value.kind().size());
        data.extend(extra);
        prop_assert_eq!(Value::parse(value.kind(), &data), Ok(value));
    }

    #[test]
    fn round_trips_positions_as_text(position in position(), axes: [i32; 8], other in kind()) {
        prop_assert_eq!(position.to_string().parse(), Ok(position));
        let base = BasePosition { kind: other, axes: Axes::full(axes) };
        prop_assert_eq!(base.to_string().parse(), Ok(base));
        let external = ExternalPosition { kind: other, axes: Axes::full(axes) };
        prop_assert_eq!(external.to_string().parse(), Ok(external));
    }

    #[test]
    fn round_trips_units(value: i32) {
        for unit in [units::MILLIMETRE, units::DEGREE, units::PERCENT, units::MILLIMETRE_PER_SECOND, units::PULSE] {
            prop_assert_eq!(unit.parse(&unit.show(value).to_string()), Ok(value));
        }
    }

    #[test]
    fn validates_every_request(request in request()) {
        for model in Model::ALL {
            if let Err(error) = request.check(model) {
                prop_assert!(!error.to_string().is_empty());
            }
        }
        let _ = request.risk();
    }

    #[test]
    fn plans_read_every_item_once(picks in vec((0_usize..9, 0_u16..300), 0..200)) {
        let kinds: Vec<VariableKind> = VariableKind::all().collect();
        let mut references: Vec<Reference> = picks.into_iter().map(|(kind, number)| Reference::new(kinds[kind], number)).collect();
        let steps = plan_reads(&references);
        let mut planned: Vec<Reference> = steps.iter().flat_map(|step| step.wanted().to_vec()).collect();
        for step in &steps {
            prop_assert_eq!(step.request().check(Model::Dx200), Ok(()));
            let answers = answer(step, |number| u8::try_from(number % 251).unwrap());
            for (reference, value) in step.decode(&answers).unwrap() {
                prop_assert_eq!(value.emit()[0], if matches!(reference.kind, VariableKind::R) { value.emit()[0] } else { u8::try_from(reference.number % 251).unwrap() });
            }
        }
        planned.sort_unstable();
        references.sort_unstable();
        references.dedup();
        prop_assert_eq!(planned, references);
    }

    #[test]
    fn plans_write_only_named_items(picks in vec((0_u16..400, 1_u8..), 0..200)) {
        let values: Vec<(u16, Value)> = picks.iter().map(|&(number, value)| (number, Value::Byte(value))).collect();
        let mut cells = [0_u8; 500];
        for step in plan_writes(&values).unwrap() {
            let request = step.request();
            prop_assert_eq!(request.check(Model::Fs100), Ok(()));
            let bytes = if request.service == service::WRITE_PLURAL { &request.data[4..] } else { &request.data[..] };
            for (offset, byte) in bytes.iter().enumerate() {
                let cell = &mut cells[usize::from(request.instance) + offset];
                prop_assert_eq!(*cell, 0, "written twice");
                *cell = *byte;
            }
        }
        let mut expected = [0_u8; 500];
        for (number, value) in picks {
            expected[usize::from(number)] = value;
        }
        prop_assert_eq!(&cells[..], &expected[..]);
    }

    #[test]
    fn signal_plans_match_the_table(numbers in vec(0_u16..1000, 0..60), groups in vec(prop_oneof![1_u16..=128, 1001_u16..=1128, 8201_u16..=8220], 0..60)) {
        for model in Model::ALL {
            for step in plan_register_reads(model, &numbers).unwrap() {
                prop_assert_eq!(step.request().check(model), Ok(()));
            }
            for step in plan_io_reads(model, &groups).unwrap() {
                prop_assert_eq!(step.request().check(model), Ok(()));
            }
        }
    }

    #[test]
    fn written_variables_match_the_table(number: u16, value in value()) {
        if let Ok(query) = WriteVariable::new(number, value.clone()) {
            prop_assert_eq!(query.request().check(Model::Dx200), Ok(()));
            prop_assert_eq!(query.request().data, value.emit());
        }
    }
}

/// Data of an answer. The first byte of each element is the result of `first_byte` for the number of the element.
fn answer(step: &impl Query, first_byte: impl Fn(u16) -> u8) -> Vec<u8> {
    let request = step.request();
    let size = request.row().unwrap().size();
    let plural = request.service == service::READ_PLURAL;
    let count = if plural { u16::from_le_bytes([request.data[0], request.data[1]]) } else { 1 };
    let mut data = if plural { request.data.clone() } else { Vec::new() };
    for number in request.instance..request.instance + count {
        data.push(first_byte(number));
        data.resize(data.len() + size - 1, 0);
    }
    data
}
