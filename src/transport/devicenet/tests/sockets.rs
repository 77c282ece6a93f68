//! Tests of the master on its own thread, with slaves behind SLCAN adapters on TCP and on a pseudo-terminal.

use std::net::SocketAddr;

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

use super::world::{Mirror, SECOND, images, mac, resting, setup};
use crate::devicenet::can::{Bitrate, PortError};
use crate::devicenet::device::{Device, DeviceFault};
use crate::devicenet::error::Error;
use crate::devicenet::hub::{Hub, Listen};
use crate::devicenet::network::{Adapter, AdapterLocation, Network, Tap};
use crate::devicenet::scanner::{Identity, State};
use crate::devicenet::settings::{Purpose, Settings};
use crate::devicenet::wire::{Answer, Request, class};

fn hub(size: u16, listen: &[Listen]) -> Hub<Mirror> {
    let device = Device::on_line(setup(5, size), Mirror::default());
    Hub::start(Bitrate::K500, Some(device), listen, None).unwrap()
}

fn anywhere() -> Listen {
    Listen::Tcp(SocketAddr::from(([127, 0, 0, 1], 0)))
}

fn place(hub: &Hub<Mirror>) -> AdapterLocation {
    let address: SocketAddr = hub.endpoint_addresses[0].parse().unwrap();
    AdapterLocation::Tcp { host: address.ip().to_string(), port: address.port() }
}

fn adapter(place: AdapterLocation, master: u8) -> Adapter {
    let identity = Some(Identity { mac: mac(master), vendor: 0xFFFF, serial: master.into() });
    Adapter { place, bitrate: Bitrate::K500, identity }
}

#[tokio::test]
async fn exchanges_images_over_tcp_and_a_pseudo_terminal() {
    #[cfg(unix)]
    let listen = [anywhere(), Listen::Pty];
    #[cfg(not(unix))]
    let listen = [anywhere()];
    for (number, _) in listen.iter().enumerate() {
        let hub = hub(48, &listen);
        let place = match number {
            0 => place(&hub),
            _ => AdapterLocation::Serial { path: hub.endpoint_addresses[1].clone(), baud: 115_200 },
        };
        let network = Network::open(&adapter(place, 1), Tap::default()).await.unwrap();
        let mut connection = network.connect(images(5)).await.unwrap();
        let view = connection.views.now();
        assert_eq!((view.details.size, view.generation), (Some(48), 1));
        let mut image = resting(48);
        image[32..].fill(0x5A);
        let change = connection.set_image(1, &image).unwrap();
        connection.views.until(|view| view.sent >= change).await;
        assert_eq!(hub.with(|device, _| device.application.image.clone()), Some(image.clone()));
        connection.views.until(|view| view.input.as_ref().is_some_and(|input| *input.image == *image)).await;
        let name = connection.ask(Request::get(class::IDENTITY, 1, 7)).await.unwrap();
        assert!(matches!(name, Answer::Done { data, .. } if data[1..] == *b"YRCX (sim)"));
        connection.close().await.unwrap();
        assert_eq!(hub.with(|device, _| device.master()), Some(None));
    }
}

#[tokio::test]
async fn several_adapters_share_a_hub_and_one_of_them_listens() {
    let hub = hub(4, &[anywhere()]);
    let master = Network::open(&adapter(place(&hub), 1), Tap::default()).await.unwrap();
    // Another process would have its own adapter. The test uses a second name for the same endpoint, which has the same
    // effect.
    let AdapterLocation::Tcp { port, .. } = place(&hub) else { panic!() };
    let elsewhere = AdapterLocation::Tcp { host: "localhost".to_owned(), port };
    let listener = Network::open(&Adapter { identity: None, ..adapter(elsewhere, 0) }, Tap::default()).await.unwrap();
    assert!(matches!(listener.connect(images(5)).await, Err(Error::Settings(_))));
    let connection = master.connect(images(5)).await.unwrap();
    let last_traffic = listener.listen(mac(5), SECOND * 20).await;
    assert_eq!(last_traffic.output.map(|seen| seen.image), Some(resting(4)));
    assert!(last_traffic.input.is_some());
    // An adapter has only one master.
    assert!(matches!(Network::open(&adapter(place(&hub), 2), Tap::default()).await, Err(Error::Settings(_))));
    let same = Network::open(&adapter(place(&hub), 1), Tap::default()).await.unwrap();
    assert!(matches!(same.connect(images(5)).await, Err(Error::Settings(_))));
    connection.close().await.unwrap();
}

#[tokio::test]
async fn nodes_are_found() {
    let hub = hub(4, &[anywhere()]);
    let network = Network::open(&adapter(place(&hub), 1), Tap::default()).await.unwrap();
    let found = network.find().await.unwrap();
    assert_eq!(found.iter().map(|found| (found.mac, found.vendor)).collect::<Vec<_>>(), [(mac(5), 636)]);
    assert_eq!(hub.with(|device, _| device.master()), Some(None));
}

#[tokio::test]
async fn reopens_an_adapter_after_a_loss() {
    let first = hub(48, &[anywhere()]);
    let address: SocketAddr = first.endpoint_addresses[0].parse().unwrap();
    let network = Network::open(&adapter(place(&first), 1), Tap::default()).await.unwrap();
    let mut connection = network.connect(images(5)).await.unwrap();
    drop(first);
    let view = connection.views.until(|view| view.state == State::Lost).await;
    assert!(matches!(view.last_error, Some(Error::Port(PortError::Gone { .. }))), "{:?}", view.last_error);
    let device = Device::on_line(setup(5, 48), Mirror::default());
    let second = loop {
        // The system may still use the port for a short time.
        match Hub::start(Bitrate::K500, Some(device_like(&device)), &[Listen::Tcp(address)], None) {
            Ok(hub) => break hub,
            Err(_) => tokio::task::yield_now().await,
        }
    };
    let view = connection.views.until(|view| view.state == State::Open).await;
    assert_eq!(view.generation, 2);
    connection.close().await.unwrap();
    drop(second);
}

fn device_like(device: &Device<Mirror>) -> Device<Mirror> {
    Device::on_line(device.setup.clone(), Mirror::default())
}

#[tokio::test]
async fn reports_a_port_without_adapter() {
    // No program listens on this port.
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    drop(listener);
    let open = |place| async { Network::open(&adapter(place, 1), Tap::default()).await.map(|_| ()).unwrap_err() };
    let place = |port| AdapterLocation::Tcp { host: "127.0.0.1".to_owned(), port };
    assert!(matches!(open(place(port)).await, Error::Port(PortError::Open { .. })));
    let absent = AdapterLocation::Serial { path: "/dev/there-is-none".to_owned(), baud: 115_200 };
    let error = open(absent).await;
    assert!(matches!(&error, Error::Port(PortError::Open { advice, .. }) if advice.contains("plug")), "{error:?}");
    // This listener accepts connections but never answers.
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = listener.local_addr().unwrap().port();
    let silent = async {
        let accepted = listener.accept().await;
        std::future::pending::<()>().await;
        drop(accepted);
    };
    tokio::select! {
        error = open(place(port)) => assert!(matches!(error, Error::Port(PortError::Mute(_))), "{error}"),
        () = silent => {}
    }
}

/// The peer answers no command. It sends a single byte from time to time, at different speeds.
#[tokio::test]
async fn rejects_a_port_with_other_traffic() {
    for text in ["t4058AABBCCDDEEFF0011\r", "x", "z\r\x07"] {
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
        let place = AdapterLocation::Tcp { host: "127.0.0.1".to_owned(), port: listener.local_addr().unwrap().port() };
        let sends = async {
            let (mut stream, _) = listener.accept().await.unwrap();
            for byte in text.bytes().cycle() {
                if stream.write_all(&[byte]).await.is_err() {
                    break;
                }
                tokio::time::sleep(std::time::Duration::from_millis(90)).await;
            }
        };
        let error = tokio::select! {
            error = async { Network::open(&adapter(place, 1), Tap::default()).await.map(|_| ()).unwrap_err() } => error,
            () = sends => unreachable!("it goes on"),
        };
        let code = crate::image::LinkError::from(error.clone());
        assert!(matches!(code, crate::image::LinkError::Malformed(_)), "{text:?}: {error}");
    }
}

#[tokio::test]
async fn reports_wrong_bit_rate_and_bus_off() {
    let hub = hub(48, &[anywhere()]);
    let slow = Adapter { bitrate: Bitrate::K125, ..adapter(place(&hub), 1) };
    let network = Network::open(&slow, Tap::default()).await.unwrap();
    let error = network.connect(images(5)).await.unwrap_err().to_string();
    assert!(error.contains("no node acknowledges"), "{error}");
    drop(network);
    let network = Network::open(&adapter(place(&hub), 1), Tap::default()).await.unwrap();
    let mut connection = network.connect(images(5)).await.unwrap();
    hub.with(|device, _| device.set_fault(Some(DeviceFault::BusOff)));
    let view = connection.views.until(|view| view.state == State::Lost).await;
    assert!(matches!(view.last_error, Some(Error::BusOff | Error::Lost { .. })), "{:?}", view.last_error);
}

/// Lines that python-can sends to open an adapter: `C` on a closed channel, an empty line, and `O` twice.
#[tokio::test]
async fn accepts_the_lines_of_python_can() {
    let hub = hub(48, &[anywhere()]);
    let mut stream = TcpStream::connect(hub.endpoint_addresses[0].as_str()).await.unwrap();
    stream.write_all(b"C\rS6\r\rO\rO\rt42FZ\rt42F700FFFF07000000\r").await.unwrap();
    let mut got = Vec::new();
    // The test reads until the slave has answered the check of MAC 5.
    while !got.ends_with(b"t42F7807C02EEFFC000\r") {
        assert!(stream.read_buf(&mut got).await.unwrap() > 0);
    }
    assert_eq!(String::from_utf8_lossy(&got), "\r\r\r\r\x07\x07z\rt42F7807C02EEFFC000\r");
}

#[tokio::test]
async fn a_forgotten_connection_is_released() {
    let hub = hub(48, &[anywhere()]);
    let network = Network::open(&adapter(place(&hub), 1), Tap::default()).await.unwrap();
    let settings = Settings { purpose: Purpose::Messages { with_poll: false }, ..images(5) };
    let connection = network.connect(settings).await.unwrap();
    assert_eq!(hub.with(|device, _| device.master()), Some(Some(mac(1))));
    drop((connection, network));
    // The drop waited until the adapter was closed.
    assert_eq!(hub.with(|device, _| device.master()), Some(None));
}
