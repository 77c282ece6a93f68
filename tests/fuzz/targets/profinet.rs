//! PROFINET: frames (DCP, cyclic, alarms), RPC with its blocks, GSDML files, typed layouts.

use armctl_transport::profinet::gsdml::Gsdml;
use armctl_transport::profinet::layout::{Direction, Layout, Submodule};
use armctl_transport::profinet::wire::block::{self, BlockType, Control};
use armctl_transport::profinet::wire::connect::{Request, Response};
use armctl_transport::profinet::wire::record::{self, Im0, Record};
use armctl_transport::profinet::wire::rpc::{Call, Datagram, Reply};
use armctl_transport::profinet::wire::{Mac, alarm, arp, cyclic, dcp, frame, status};

use super::{seen, text_of};
use crate::seeds;

pub fn frame(data: &[u8]) {
    if let Ok(frame) = frame::Frame::parse(data) {
        let again = frame.emit();
        assert_eq!(frame::Frame::parse(&again).map(|again| again.id), Ok(frame.id));
        payload(frame.payload);
    }
    seen(arp::holder(data));
    payload(data);
}

fn payload(data: &[u8]) {
    if let Ok(dcp) = dcp::Dcp::parse(data) {
        assert_eq!(dcp::Dcp::parse(&dcp.emit()).as_ref(), Ok(&dcp));
        if let Ok(station) = dcp.station() {
            seen(format!("{station:?} {:?} {:?}", station.address(), dcp::check_name(&station.name)));
        }
        dcp.outcomes().iter().for_each(|(_, error)| seen(dcp::describe_error(*error)));
    }
    seen(dcp::IpSuite::parse(data));
    if let Ok(rta) = alarm::Rta::parse(data) {
        assert_eq!(alarm::Rta::parse(&rta.emit()).as_ref(), Ok(&rta));
    }
    if let Ok(notification) = alarm::Notification::parse(data) {
        seen(notification.describe());
        let again = alarm::Notification::parse(&notification.emit());
        assert_eq!(again.map(|again| again.describe()), Ok(notification.describe()));
    }
    seen(alarm::Acknowledgement::parse(data));
    for length in [0, 4, 48] {
        if let Ok(cyclic) = cyclic::Cyclic::parse(data, length) {
            seen((cyclic.is_usable(), cyclic::describe_status(cyclic.status, cyclic.transfer)));
            assert_eq!(cyclic::Cyclic::parse(&cyclic.emit(), length).as_ref(), Ok(&cyclic));
        }
    }
}

pub fn rpc(data: &[u8]) {
    if let Ok(datagram) = Datagram::parse(data) {
        let order = datagram.header.order;
        assert_eq!(Datagram::parse(&datagram.emit()).map(|again| again.body), Ok(datagram.body));
        if let Ok(call) = Call::parse(datagram.body, order) {
            blocks(call.blocks);
        }
        if let Ok(reply) = Reply::parse(datagram.body, order) {
            let status = status::Status(reply.status);
            seen((status.to_string(), status.meaning(), status.remedies()));
            blocks(reply.blocks);
        }
    }
    blocks(data);
}

fn blocks(data: &[u8]) {
    if let Ok(all) = block::walk(data) {
        assert!(all.len() <= data.len());
        for block in &all {
            seen((Control::parse(block).map(|control| format!("{control:?}")), Response::parse(block).is_ok()));
        }
    }
    if let Ok(requests) = Request::parse_all(data) {
        // Only the type of an unknown block is kept.
        if !requests.iter().any(|request| matches!(request, Request::Other(_))) {
            let again: Vec<u8> = requests.iter().flat_map(Request::emit).collect();
            assert_eq!(Request::parse_all(&again).as_ref(), Ok(&requests));
        }
    }
    if let Ok(responses) = Response::parse_all(data)
        && !responses.iter().any(|response| matches!(response, Response::Other(_)))
    {
        let again: Vec<u8> = responses.iter().flat_map(Response::emit).collect();
        assert_eq!(Response::parse_all(&again).as_ref(), Ok(&responses));
    }
    for kind in [BlockType::READ, BlockType::WRITE, BlockType::READ.answer(), BlockType::WRITE.answer()] {
        seen(Record::parse(data, kind).is_ok());
    }
    seen((Record::parse_answer(data).is_ok(), Record::write_status(data).is_ok()));
    seen((record::parse_write(data).is_ok(), record::parse_write_answer(data).is_ok()));
    if let Ok(im0) = Im0::parse(data) {
        seen(format!("{im0:?}"));
        seen(Im0::parse(&im0.emit()).expect("an encoded record"));
    }
    if let Ok(modules) = record::parse_identification(data) {
        assert!(modules.len() <= data.len());
        let again = record::parse_identification(&record::emit_identification(&modules));
        assert_eq!(again.as_ref(), Ok(&modules));
    }
}

pub fn gsdml(data: &[u8]) {
    match Gsdml::parse(data) {
        Err(error) => seen(error.to_string()),
        Ok(device) => {
            for head in &device.heads {
                if let Some(chosen) = head.choose(48, 48) {
                    seen((head.layout(&chosen).map(|layout| layout.to_string()), head.parameters(&chosen)));
                }
            }
        }
    }
}

pub fn gsdml_files() -> Vec<Vec<u8>> {
    vec![seeds::file("cli/files/gsdml.xml")]
}

pub fn text(data: &[u8]) {
    let Some(text) = text_of(data) else { return };
    if let Ok(layout) = text.parse::<Layout>() {
        assert_eq!(layout.to_string().parse().as_ref(), Ok(&layout));
        for direction in [Direction::Input, Direction::Output] {
            seen(format!("{:?} {}", layout.frame(direction), layout.size(direction)));
        }
        seen(layout.expected());
    }
    seen(text.parse::<Submodule>());
    if let Ok(mac) = text.parse::<Mac>() {
        assert_eq!(mac.to_string().parse(), Ok(mac));
    }
    seen(dcp::check_name(text));
}

pub fn texts() -> Vec<Vec<u8>> {
    let layout = Layout::two_modules(0x101, 0x102).to_string();
    [&*layout, "02:00:00:00:00:02", "yrcx-sim.cell-3"].map(|text| text.as_bytes().to_vec()).to_vec()
}
