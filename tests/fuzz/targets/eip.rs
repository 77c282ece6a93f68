//! EtherNet/IP: encapsulation, CIP, connections, the adapter.

use std::net::{Ipv4Addr, SocketAddrV4};

use armctl_controller::Now;
use armctl_transport::eip::adapter::{Adapter, Application, Event, Output, Setup};
use armctl_transport::eip::explicit::Answer;
use armctl_transport::eip::status::describe;
use armctl_transport::eip::wire::{
    Close, Closed, Cyclic, Frame, Frames, Identity, Item, Open, Opened, Path, Refused, Reply, Request, Revision,
    RrData, Services,
};
use armctl_transport::eip::{IO_PORT, PORT};

use super::{pause, pieces, seen};
use crate::seeds;

/// Every parser at every offset where a message can begin: frame, items, message, data.
pub fn frame(data: &[u8]) {
    let mut frames = Frames::default();
    frames.push(data);
    while let Some(bytes) = frames.pop() {
        assert!(bytes.len() <= data.len());
        if let Ok(frame) = Frame::parse(&bytes) {
            assert_eq!(Frame::parse(&frame.emit()).as_ref(), Ok(&frame));
            content(frame.data);
        }
    }
    content(data);
}

fn content(data: &[u8]) {
    if let Ok(items) = Item::parse_all(data) {
        assert!(items.len() <= data.len());
        items.iter().for_each(|item| message(item.data));
    }
    for parse in [RrData::parse, RrData::parse_answer] {
        if let Ok(rr) = parse(data) {
            message(rr.message);
            RrData::parse(&rr.emit()).expect("an encoded message");
        }
    }
    seen((Identity::parse(data), Services::parse(data)));
    if let Ok(datagram) = Cyclic::parse(data) {
        seen(format!("{datagram:?}"));
    }
    message(data);
}

fn message(data: &[u8]) {
    if let Ok(request) = Request::parse(data) {
        assert_eq!(Request::parse(&request.emit()).as_ref(), Ok(&request));
        connection(request.data);
    }
    if let Ok(reply) = Reply::parse(data) {
        assert_eq!(Reply::parse(&reply.emit()).as_ref(), Ok(&reply));
        seen((reply.status.to_string(), describe(&reply.status)));
        connection(reply.data);
    }
    if let Ok(answer) = Answer::parse("a message", data) {
        seen(format!("{:?}", answer.done("a message")));
    }
    connection(data);
}

fn connection(data: &[u8]) {
    for large in [false, true] {
        if let Ok(open) = Open::parse(data, large) {
            seen(format!("{open:?} {:?}", open.path.object_named()));
            // A path of bytes can be longer in words. armctl sends no such path.
            if open.path.emit().len() <= 510 {
                let bytes = open.emit();
                let request = Request::parse(&bytes).expect("an encoded request");
                assert_eq!(Open::parse(request.data, open.is_large()).as_ref(), Ok(&open));
            }
        }
    }
    macro_rules! round_trip {
        ($($parse:path),*) => {
            $(if let Ok(value) = $parse(data) {
                assert_eq!($parse(&value.emit()).as_ref(), Ok(&value));
            })*
        };
    }
    round_trip!(Opened::parse, Refused::parse, Closed::parse, Path::parse);
    if let Ok(close) = Close::parse(data)
        && close.path.emit().len() <= 510
    {
        let bytes = close.emit();
        let request = Request::parse(&bytes).expect("an encoded request");
        assert_eq!(Close::parse(request.data).as_ref(), Ok(&close));
    }
    seen(Identity::parse_attributes(data, SocketAddrV4::new(Ipv4Addr::LOCALHOST, PORT)));
}

struct Nothing;

impl Application for Nothing {
    fn image_out(&mut self, _: Now, _: u32, _: &[u8], _: bool) {}
    fn image_in(&mut self, _: Now, _: u32, _: &mut [u8]) {}
    fn event(&mut self, _: Now, event: &Event) {
        seen(format!("{event:?}"));
    }
}

/// Two TCP clients and datagrams to an adapter. Most answers to it are one per frame.
pub fn server(data: &[u8]) {
    let address = SocketAddrV4::new(Ipv4Addr::new(10, 0, 0, 2), PORT);
    let revision = Revision { major: 1, minor: 2 };
    let name = "RCX".to_owned();
    let identity = Identity {
        address,
        vendor: 636,
        device_type: 43,
        product: 5,
        revision,
        status: 0,
        serial: 1,
        name,
        state: None,
    };
    let mut adapter = Adapter::new(Setup::new(identity, (100, 48), (150, 48), 1), Nothing);
    let peer = Ipv4Addr::new(10, 0, 0, 1);
    adapter.connected(0, peer);
    adapter.connected(1, peer);
    let mut now = Now::ZERO;
    for (control, piece) in pieces(data) {
        now += pause(control);
        let from = SocketAddrV4::new(peer, IO_PORT);
        match control >> 4 {
            0..=9 => adapter.received(now, u64::from(control >> 4 & 1), piece),
            10..=12 => adapter.receive_datagram(now, from, piece),
            13 => adapter.discovered(from, piece),
            _ => {
                adapter.disconnected(1);
                adapter.connected(1, peer);
            }
        }
        for _ in 0..100 {
            match adapter.poll(now) {
                Some(Output::Send(_, bytes) | Output::Discovered(_, bytes)) => {
                    Frame::parse(&bytes).expect("the adapter sends valid frames");
                }
                Some(Output::Datagram(_, bytes)) => seen(Cyclic::parse(&bytes).expect("a valid datagram")),
                Some(Output::HangUp(_)) => {}
                None => break,
            }
        }
        seen(format!("{:?}", adapter.peers().collect::<Vec<_>>()));
    }
}

pub fn server_scripts() -> Vec<Vec<u8>> {
    let traffic = seeds::traffic(crate::links::eip);
    vec![seeds::script(1, &traffic), seeds::script(0xA1, &traffic), seeds::script(0xD0, &traffic)]
}
