//! CAN, SLCAN, candump and DeviceNet messages.

use armctl_transport::devicenet::can::Frame;
use armctl_transport::devicenet::can::slcan::{AdapterMessage, Command, Lines, emit};
use armctl_transport::devicenet::monitor::{Monitor, describe};
use armctl_transport::devicenet::wire::{
    Answer, Assembler, AssemblyResult, DuplicateCheck, Format, Fragment, Header, Id, Mac, Request, split,
};

use super::{seen, text_of};

/// Lines of an adapter and of candump.
pub fn text(data: &[u8]) {
    let mut lines = Lines::default();
    for line in data.iter().filter_map(|byte| lines.push(*byte)) {
        let message = line.adapter_messages();
        seen(format!("{message:?}"));
        for frame in [message, None].into_iter().flatten() {
            if let AdapterMessage::Frame(frame) = frame {
                same(&frame);
            }
        }
        if let Command::Send(frame) = line.command() {
            same(&frame);
        }
    }
    let Some(text) = text_of(data) else { return };
    for line in text.lines() {
        if let Some((_, frame)) = Frame::from_candump(line) {
            same(&frame);
        }
    }
    if let Ok(mac) = text.parse::<Mac>() {
        assert_eq!(mac.to_string().parse(), Ok(mac));
    }
}

fn same(frame: &Frame) {
    let mut lines = Lines::default();
    let line = emit(frame).iter().find_map(|byte| lines.push(*byte)).expect("a line");
    assert_eq!(line.adapter_messages(), Some(AdapterMessage::Frame(*frame)));
    assert_eq!(Frame::from_capture(&frame.to_capture()).as_ref(), Some(frame));
    seen((frame.to_string(), describe(frame), frame.bits()));
}

pub fn texts() -> Vec<Vec<u8>> {
    const TEXTS: [&[u8]; 7] = [
        b"t4252012A\r",
        b"\rz\rt3C5811223344556677880A1B\r",
        b"V1013\rNA123\rF20\r\x07",
        b"S6\rO\rC\rL\rZ1\r",
        b"T0000042580011\r",
        b"(1700000000.123456) can0 42D#0501\n(1700000000.2) can0 3C5#1122334455667788\n",
        b"63",
    ];
    TEXTS.map(<[u8]>::to_vec).to_vec()
}

/// Frames of 2 bytes of identifier, 1 byte of length, and data.
pub fn frame(data: &[u8]) {
    seen(Frame::from_capture(data));
    let mut monitor = Monitor::default();
    let mut assemblers = [4, 8, 48].map(Assembler::new);
    let mut rest = data;
    while let Some((&[high, low], more)) = rest.split_first_chunk() {
        let (piece, more) = more.split_at(more.len().min(8));
        rest = more;
        let id = u16::from_be_bytes([high & 7, low]);
        if let Some(id) = Id::parse(id) {
            assert_eq!(Id::parse(id.emit()), Some(id));
            seen((id.to_string(), id.sender(), id.group()));
        }
        let Some(frame) = Frame::new(id, piece) else { continue };
        seen(describe(&frame));
        monitor.handle_frame(std::time::Duration::ZERO, &frame);
        assemblers.iter_mut().for_each(|assembler| seen(format!("{:?}", assembler.take(piece))));
    }
    monitor.slaves().iter().for_each(|slave| seen(format!("{:?}", monitor.last_traffic(*slave))));
    for format in (0..=255).filter_map(Format::from_code) {
        if let Some(request) = Request::parse(format, data)
            && let Some(bytes) = request.emit(format)
        {
            assert_eq!(Request::parse(format, &bytes), Some(request));
        }
    }
    if let Some(answer) = Answer::parse(data) {
        assert_eq!(Answer::parse(&answer.emit()), Some(answer));
    }
    if let Some(check) = DuplicateCheck::parse(data) {
        assert_eq!(DuplicateCheck::parse(&check.emit()).map(DuplicateCheck::emit), Some(check.emit()));
    }
    if let Some(byte) = data.first() {
        assert_eq!(Header::parse(*byte).emit(), *byte);
        seen(Fragment::parse(*byte).emit());
    }
    let image = &data[..data.len().min(255)];
    if image.len() > 8 {
        let mut assembler = Assembler::new(image.len());
        let results: Vec<AssemblyResult> = split(image).iter().map(|piece| assembler.take(piece)).collect();
        assert_eq!(results.last(), Some(&AssemblyResult::Whole(image.to_vec())));
    }
}
