//! YRCX: the words of commands and answers, typed names and values, the server.

use armctl_controller::Now;
use armctl_controller::yrcx::alarm::Alarm;
use armctl_controller::yrcx::answer::{Answer, Status, fields};
use armctl_controller::yrcx::bus::Bus;
use armctl_controller::yrcx::describe::{answer, answer_summary, command, command_summary};
use armctl_controller::yrcx::image::{IMAGE_WORDS, Image, Words};
use armctl_controller::yrcx::image_changes::changes;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::read_only_filter::only_stops;
use armctl_controller::yrcx::register::Register;
use armctl_controller::yrcx::signal::{Side, Signal};
use armctl_controller::yrcx::simulator::{Simulator, Start};
use armctl_controller::yrcx::table::ROWS;

use super::{pause, seen, text_of};

fn words_of(data: &[u8]) -> Words {
    let mut words = Words::default();
    for (word, bytes) in words.iter_mut().zip(data.chunks(2)) {
        *word = u16::from_le_bytes([bytes[0], bytes.get(1).copied().unwrap_or_default()]);
    }
    words
}

/// 32 bytes of a command, then 32 bytes of an answer.
pub fn words(data: &[u8]) {
    let asked = words_of(data);
    let answered = words_of(data.get(32..).unwrap_or_default());
    seen(format!("{:?} {:?}", command(&asked), command_summary(&asked)));
    for request in [None, Some(&asked)] {
        seen(format!("{:?} {:?}", answer(&answered, request), answer_summary(&answered)));
    }
    if let Ok(order) = Order::parse(&asked) {
        assert_eq!(Order::parse(order.words()).as_ref(), Ok(&order));
        seen(order.risk());
        for (field, value) in fields(&order, &answered) {
            seen(field.show(&value));
        }
        if let Some(parsed) = Answer::parse(&order, &answered) {
            seen(format!("{parsed:?} {:?}", parsed.words(&order)));
        }
    }
    seen(Status::from_word(answered[0]).to_string());
    for size in [data.len(), Image::BYTES, Image::SIGNAL_BYTES] {
        let Some(image) = data.get(..size).and_then(Image::from_link) else { continue };
        let again = Image::from_link(&image.to_link(size)).expect("a link of this size");
        for side in [Side::Input, Side::Output] {
            for before in [None, Some(&again)] {
                let all = changes(side, before, &image);
                all.iter().for_each(|change| seen((change.line(true), change.line(false))));
            }
        }
    }
    let (before, after) = data.split_at(data.len() / 2);
    only_stops(before, after);
}

pub fn text(data: &[u8]) {
    let Some(text) = text_of(data) else { return };
    if let Ok(alarm) = text.parse::<Alarm>() {
        assert_eq!(alarm.to_string().parse(), Ok(alarm));
    }
    for side in [Side::Input, Side::Output] {
        if let Ok(signal) = Signal::parse(side, text) {
            assert_eq!(Signal::parse(side, &signal.to_string()), Ok(signal));
        }
    }
    if let Some(Ok(register)) = Register::parse(text) {
        seen((register.to_string(), register.value(text)));
    }
    seen(text.parse::<Bus>());
    for field in ROWS.iter().flat_map(|row| row.request().chain(row.answer())) {
        if let Ok(value) = field.parse(text) {
            let shown = field.show(&value);
            let mut words = Words::default();
            if field.accept(&value).is_ok() && field.write(&mut words, &value).is_ok() {
                // A controller pads texts with blanks.
                assert_eq!(field.show(&field.read(&words)), shown.trim_end(), "{}", field.name);
            }
        }
    }
}

pub fn texts() -> Vec<Vec<u8>> {
    const TEXTS: [&str; 10] =
        ["14.001", "SO(27)", "servo-on", "WI3", "0x4000", "-12.345", "1.5e3", "HELLO WORLD", "on", "123456789"];
    TEXTS.map(|text| text.as_bytes().to_vec()).to_vec()
}

/// Images to the simulator: pairs of a control byte and a change of a word.
pub fn server(data: &[u8]) {
    let mut simulator = Simulator::new(Start::default());
    let mut image = Image::default();
    let mut now = Now::ZERO;
    let (asked, rest) = data.split_at(data.len().min(64));
    image.set_command(&words_of(asked));
    image.0[16] = 0x0043;
    for control in [2, 5, 6] {
        now += pause(control);
        simulator.input(now, Some(&image));
        simulator.advance(now);
    }
    for change in rest.chunks_exact(4).take(100) {
        now += pause(change[0]);
        image.0[usize::from(change[1]) % IMAGE_WORDS] = u16::from_le_bytes([change[2], change[3]]);
        simulator.input(now, (change[0] & 0xF0 != 0xF0).then_some(&image));
        simulator.advance(now);
        assert!(simulator.wake().is_none_or(|wake| wake > now));
        seen(answer_summary(&simulator.output().command()));
    }
}
