//! Properties of the YRCX family. Valid commands round-trip. For every signal sequence of a
//! controller, a command is sent once, and its words are cleared after it.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::time::Duration;

use armctl_controller::yrcx::answer::Answer;
use armctl_controller::yrcx::image::{Image, Output, Words};
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::sequence::Sequence;
use armctl_controller::yrcx::session::{Ended, Exchange, ImageSession, Next, Policy};
use armctl_controller::yrcx::signal::{Side, Signal, input, resting};
use armctl_controller::yrcx::table::parameter::Parameter;
use armctl_controller::yrcx::table::{Charset, Field, Form, ROWS, Row, Show};
use armctl_controller::yrcx::value::{Key, Value, Values};
use proptest::prelude::*;

/// A valid command of any row of the table.
fn any_order() -> impl Strategy<Value = Order> {
    (0..ROWS.len(), any::<Words>(), any::<[u32; 8]>()).prop_filter_map("a rule of the row", |(row, words, dice)| {
        Order::parse(&with_valid_fields(&ROWS[row], words, &dice)).ok()
    })
}

/// Makes every used field valid, and clears the other fields. A parameter gets the axis and the value that it requires.
fn with_valid_fields(row: &Row, random: Words, dice: &[u32; 8]) -> Words {
    let mut words = random;
    words[0] = row.code | (random[0] & 0xF000 & if row.has_robot() { 0xF000 } else { 0 });
    for field in row.request() {
        if is_counted(row, field, &words) && field.accept(&field.read(&words)).is_err() {
            let value = valid(field, dice[(field.word + field.name.len()) % 8]);
            field.write(&mut words, &value).unwrap();
        }
    }
    let parameter = row.request().find(|field| field.key == Key::Parameter).map(|field| field.read(&words));
    if let Some(Value::Int(number)) = parameter {
        let parameter = Parameter::from_number(number).unwrap();
        for field in row.request() {
            match field.key {
                Key::Axes => field.write(&mut words, &Value::Int(parameter.per_axis.into())).unwrap(),
                Key::Value => field.write(&mut words, &Value::Int(parameter.span.1)).unwrap(),
                _ => {}
            }
        }
    }
    let mut keep = [0; 16];
    keep[0] = 0x0FFF;
    for field in row.request().filter(|field| is_counted(row, field, &words)) {
        keep[field.word..field.word + field.size()].iter_mut().for_each(|word| *word |= field.mask());
    }
    words.iter_mut().zip(keep).for_each(|(word, keep)| *word &= keep);
    words
}

fn is_counted(row: &Row, field: &Field, words: &Words) -> bool {
    field.when.is_none_or(|when| {
        let other = row.request().find(|other| other.key == when.key).unwrap();
        matches!(other.read(words), Value::Int(number) if (when.least..=when.most).contains(&number))
    })
}

fn valid(field: &Field, die: u32) -> Value {
    let pick = |count: usize| usize::try_from(die).unwrap() % count;
    match field.form {
        Form::Bits { show: Show::Choice(choices), .. } => Value::from(choices[pick(choices.len())].0),
        Form::Bits { show: Show::Fixed(fixed), .. } => Value::from(fixed),
        Form::Bits { width, show: Show::Set { least: 1, .. }, .. } => Value::from(1_i32 << pick(usize::from(width))),
        Form::Bits { show: Show::Set { .. }, .. } => Value::Int(0),
        Form::Text(Charset::Program) => Value::from(["A", "PICK_2", "ABCDEFGHIJKLMNO9"][pick(3)]),
        Form::Text(Charset::Comment) => Value::from(["", "WAIT ORG", "~ 0123456789abc!"][pick(3)]),
        Form::Real => Value::Real(1.5),
        _ => {
            let (least, most) = field.spans[pick(field.spans.len())];
            Value::Int(least + i32::try_from(die % (most.abs_diff(least) + 1)).unwrap())
        }
    }
}

proptest! {
    #[test]
    fn round_trips_commands_through_words_and_values(order in any_order()) {
        let read = Order::parse(order.words()).unwrap();
        prop_assert_eq!(&read, &order);
        let mut draft = order.command().order();
        for (key, value) in order.values().iter() {
            draft = draft.with(key, value.clone());
        }
        prop_assert_eq!(draft.build().unwrap(), order);
    }

    #[test]
    fn round_trips_commands_through_text(order in any_order()) {
        let fields = order.row().request().filter(|field| is_counted(order.row(), field, order.words()));
        let mut draft = order.command().order();
        for field in fields {
            let text = field.show(order.values().value(field.key).unwrap());
            draft = draft.with(field.key, text);
        }
        prop_assert_eq!(draft.build().unwrap(), order);
    }

    #[test]
    fn round_trips_answers_through_words(order in any_order(), mut wo in any::<Words>()) {
        wo[0] = 0x0200;
        let answer = Answer::parse(&order, &wo).unwrap();
        let Answer::Done(values) = &answer else { panic!("done is done") };
        prop_assert_eq!(values.iter().count(), keys(values));
        // A number that is not in the manual can be read, but not written.
        if let Ok(words) = answer.words(&order) {
            let again = Answer::parse(&order, &words).unwrap();
            // A text can end with fill characters, so the words are compared only after one round trip.
            prop_assert_eq!(again.words(&order).unwrap(), words);
        }
    }

    #[test]
    fn sends_a_command_once_for_every_signal_sequence(
        order in any_order(),
        events in prop::collection::vec((1_u64..400, 0_usize..9), 1..60),
    ) {
        let policy = Policy { motion: Some(Duration::from_secs(20)), ..Policy::default() };
        let code = order.words()[0];
        let mut exchange = Exchange::new(order, policy);
        let mut output = Output::new(resting());
        let mut now = Duration::ZERO;
        let mut events = events.into_iter();
        let mut shown = Vec::new();
        let ended = loop {
            match exchange.poll(now, &mut output) {
                Next::Done(outcome) => break outcome,
                Next::Wait(until) => {
                    prop_assert!(until > now);
                    let event = events.next();
                    now = event.map_or(until, |(wait, _)| now + Duration::from_millis(wait));
                    match event {
                        Some((_, status @ 0..5)) => {
                            let mut image = Image::default();
                            image.0[0] = [0x0000, 0x0100, 0x0200, 0x4000, 0x0777][status];
                            exchange.handle(now, &image);
                        }
                        Some((_, 5)) => exchange.interrupt(now),
                        Some((391.., 6)) => exchange.handle_link_loss(now),
                        _ => {
                            shown.push(output.next.0[0]);
                            output.sent(now);
                        }
                    }
                }
            }
            prop_assert!(input::EMERGENCY_STOP.is_on(&output.next));
            prop_assert!(now < Duration::from_secs(120));
        };
        shown.push(output.next.0[0]);
        shown.dedup();
        prop_assert!(output.next.command() == [0; 16]);
        prop_assert_eq!(input::STOP.is_on(&output.next), !ended.stop_held);
        let times = shown.iter().filter(|wi0| **wi0 == code && code != 0).count();
        prop_assert!(times <= 1, "{:04X?}", shown);
        if times == 1 {
            prop_assert!(!matches!(ended.ended, Ended::NotSent(_)), "{:?}", ended.ended);
        }
    }

    #[test]
    fn procedures_end_with_all_inputs_off(
        chart in 0_usize..7,
        events in prop::collection::vec((1_u64..400, any::<u16>(), 0_usize..4), 0..40),
    ) {
        let procedure = Procedure::charts()[chart].clone();
        let stops = matches!(procedure.name, "stop" | "emergency-stop");
        let mut sequence = Sequence::new(procedure, Duration::from_secs(5));
        let mut output = Output::new(resting());
        let mut now = Duration::ZERO;
        let mut events = events.into_iter();
        let mut edges: Vec<(Duration, u16)> = Vec::new();
        loop {
            match sequence.poll(now, &mut output) {
                Next::Done(_) => break,
                Next::Wait(until) => {
                    prop_assert!(until > now);
                    let (wait, word, event) = events.next().unwrap_or((20, 0, 0));
                    now += Duration::from_millis(wait);
                    if event == 1 {
                        let mut image = Image::default();
                        image.0[16] = word;
                        sequence.handle(now, &image);
                    } else {
                        let dedicated = output.next.0[16];
                        if edges.last().is_none_or(|(_, last)| *last != dedicated) {
                            edges.push((now, dedicated));
                        }
                        output.sent(now);
                    }
                }
            }
            prop_assert!(now < Duration::from_secs(120));
        }
        prop_assert!(edges.windows(2).all(|pair| pair[1].0 >= pair[0].0 + Duration::from_millis(100)), "{:?}", edges);
        if !stops {
            prop_assert_eq!(output.next, resting());
        }
        for signal in Signal::all(Side::Input).filter(|signal| ![input::STOP, input::EMERGENCY_STOP].contains(signal)) {
            prop_assert!(!signal.is_on(&output.next));
        }
    }
}

fn keys(values: &Values) -> usize {
    let mut keys: Vec<Key> = values.iter().map(|(key, _)| key).collect();
    keys.sort_unstable();
    keys.dedup();
    keys.len()
}

#[test]
fn builds_every_command() {
    for row in ROWS {
        let made = (0_u16..50).any(|seed| {
            let dice = std::array::from_fn(|n| u32::from(seed) * 7 + u32::try_from(n).unwrap());
            Order::parse(&with_valid_fields(row, [seed; 16], &dice)).is_ok_and(|order| order.command() == row.command)
        });
        assert!(made, "{}", row.id);
    }
}
