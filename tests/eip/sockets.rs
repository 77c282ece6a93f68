//! Both ends on loopback sockets. The tests wait for events, never for a fixed time.

use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use armctl_client::yrcx::{Client as Robot, Options, Start, open_eip, output};
use armctl_transport::eip::adapter::server::{AdapterAddresses, Server};
use armctl_transport::eip::adapter::{AdapterFault, Setup};
use armctl_transport::eip::client::Client;
use armctl_transport::eip::discovery::list_identity;
use armctl_transport::eip::error::EipError;
use armctl_transport::eip::explicit::{Answer, Message};
use armctl_transport::eip::image_reader::{Assembly, Reader, Reading};
use armctl_transport::eip::originator::State;
use armctl_transport::eip::probe::{self, AssemblyPresence, Connectable, Instances, probe};
use armctl_transport::eip::scanner::Scanner;
use armctl_transport::eip::settings::{Multiplier, Settings};
use armctl_transport::eip::tap::Tap;
use armctl_transport::eip::wire::Status;
use armctl_transport::fault::{FaultSpec, Faults, SimulatorFaults};

use armctl_transport::image::image_after_loss;

use super::world::{MS, Mirror, identity, resting, setup, with_long_timeout};

const LOOPBACK: Ipv4Addr = Ipv4Addr::LOCALHOST;

fn serve(setup: Setup) -> Server<Mirror> {
    Server::start(setup, Mirror::default(), AdapterAddresses::anywhere(LOOPBACK), None).unwrap()
}

fn quick() -> Settings {
    Settings { rpi: 10 * MS, ..with_long_timeout() }
}

#[tokio::test]
async fn exchanges_images_and_messages() {
    let server = serve(setup());
    let scanner = Scanner::start(LOOPBACK).unwrap();
    let mut connection = scanner.open(server.address(), quick(), Tap::default()).await.unwrap();
    let generation = connection.views.now().generation;
    // In this order, the image that comes back is an answer to both changes.
    connection.set_run(generation, true).unwrap();
    let change = connection.set_image(generation, &[0x5A; 48]).unwrap();
    let is_back = |image: &[u8]| image == [0xA5; 48];
    let view = connection.views.until(|view| view.input.as_ref().is_some_and(|input| is_back(&input.image))).await;
    assert!(view.sent >= change);
    assert!(server.with(|adapter, _| adapter.application.run));

    let answer = connection.ask("the size", &Message::get(4, 150, 4)).await.unwrap();
    assert_eq!(answer, Answer { status: Status::OK, data: vec![48, 0] });
    let answer = connection.ask("nothing", &Message::get(4, 99, 4)).await.unwrap();
    assert_eq!(answer.status, Status::general(0x05));

    connection.close().await.unwrap();
    assert_eq!(server.with(|adapter, _| adapter.peers().count()), 0);
    assert!(server.with(|adapter, _| !adapter.application.run));
}

#[tokio::test]
async fn reads_images_of_an_owned_device() {
    let server = serve(setup());
    let client = || Client::new(server.address(), 200 * MS, Tap::default());
    let assembly = Assembly { instance: 100, size: 48 };
    let wrong = Reader::open(client(), Assembly { size: 50, ..assembly }, MS).await;
    assert_eq!(wrong.unwrap_err(), EipError::WrongSize { found: 48, expected: 50 });
    let absent = Reader::open(client(), Assembly { instance: 99, ..assembly }, MS).await;
    assert!(matches!(absent, Err(EipError::Refused { .. })), "{absent:?}");

    let scanner = Scanner::start(LOOPBACK).unwrap();
    let owner = scanner.open(server.address(), quick(), Tap::default()).await.unwrap();
    let mut reader = Reader::open(client(), assembly, MS).await.unwrap();
    let read_image = async |reader: &mut Reader, is_it: &dyn Fn(&Reading) -> bool| {
        while !is_it(&reader.reading()) {
            reader.changed().await;
        }
    };
    owner.set_image(1, &[0x5A; 48]).unwrap();
    owner.set_run(1, true).unwrap();
    read_image(&mut reader, &|reading| reading.as_deref().is_ok_and(|image| image == [0xA5; 48])).await;
    // The link reports that the device is silent, and later that it answers again.
    server.with(|adapter, _| adapter.set_fault(Some(AdapterFault::Mute)));
    read_image(&mut reader, &|reading| matches!(reading, Err(EipError::NoAnswer { .. }))).await;
    server.with(|adapter, _| adapter.set_fault(None));
    read_image(&mut reader, &Result::is_ok).await;
    reader.close().await;
    assert_eq!(server.with(|adapter, _| adapter.peers().count()), 1, "the owner and nobody else");
    owner.close().await.unwrap();
}

#[tokio::test]
async fn survey_reads_assemblies_without_a_connection() {
    let server = serve(setup());
    let mut client = Client::new(server.address(), Duration::from_secs(20), Tap::default());
    let right = Instances { output: 150, input: 100, configuration: Some(1) };
    let absent = Instances { input: 7, ..right };
    let found = probe::survey(&mut client, &[absent, right]).await.unwrap();
    let expected = Connectable { instances: right, output_size: Some(48), input_size: Some(48) };
    assert_eq!((found.connectable, found.attempts), (Some(expected), Vec::new()));
    assert_eq!(probe::survey(&mut client, &[absent]).await.unwrap().connectable, None);
    assert_eq!(probe::assembly(&mut client, 7).await.unwrap(), AssemblyPresence::Absent);
    let events = server.with(|adapter, _| adapter.application.events.len());
    assert_eq!(events, 0, "nothing was opened on the way");
    client.close().await;
}

#[tokio::test]
async fn several_connections_share_a_socket() {
    let servers: Vec<_> = (0..20).map(|_| serve(setup())).collect();
    let scanner = Scanner::start(LOOPBACK).unwrap();
    let mut connections = Vec::new();
    for (server, mark) in servers.iter().zip(1u8..) {
        let connection = scanner.open(server.address(), quick(), Tap::default()).await.unwrap();
        connection.set_image(1, &[mark; 48]).unwrap();
        connections.push(connection);
    }
    for (connection, mark) in connections.iter_mut().zip(1u8..) {
        let expected = [!mark; 48];
        let view =
            connection.views.until(|view| view.input.as_ref().is_some_and(|input| *input.image == expected)).await;
        assert_eq!(view.state, State::Open);
    }
}

#[tokio::test]
async fn survives_a_bad_network() {
    let faults: FaultSpec = "drop=10%,dup=5%,delay=0..20ms,reorder=2%,seed=5".parse().unwrap();
    let listen = AdapterAddresses::anywhere(LOOPBACK);
    let server = Server::start(setup(), Mirror::default(), listen, Some(Faults::pair(faults))).unwrap();
    let scanner = Scanner::start(LOOPBACK).unwrap();
    let mut connection = scanner.open(server.address(), quick(), Tap::default()).await.unwrap();
    for mark in 1..20 {
        connection.set_image(1, &[mark; 48]).unwrap();
        connection.views.until(|view| view.input.as_ref().is_some_and(|input| *input.image == [!mark; 48])).await;
    }
    let view = connection.views.until(|view| view.statistics.lost > 0 && view.statistics.stale > 0).await;
    assert_eq!((view.state, view.generation), (State::Open, 1));
}

#[tokio::test]
async fn open_returns_refusals() {
    let server = serve(setup());
    let scanner = Scanner::start(LOOPBACK).unwrap();
    let wrong = Settings { input_size: 46, ..quick() };
    let refused = scanner.open(server.address(), wrong, Tap::default()).await.unwrap_err();
    assert_eq!(
        refused.to_string(),
        "ForwardOpen was refused: invalid connection size (0x01/0x0109), the correct size is 50 bytes"
    );
    let first = scanner.open(server.address(), quick(), Tap::default()).await.unwrap();
    let second = scanner.open(server.address(), quick(), Tap::default()).await.unwrap_err();
    assert_eq!(second, EipError::Refused { what: "ForwardOpen", status: Status::connection(0x0106, &[]) });
    first.close().await.unwrap();
    let third = scanner.open(server.address(), quick(), Tap::default()).await.unwrap();
    third.close().await.unwrap();
}

#[tokio::test]
async fn closes_a_dropped_connection() {
    let server = serve(setup());
    let scanner = Scanner::start(LOOPBACK).unwrap();
    drop(scanner.open(server.address(), quick(), Tap::default()).await.unwrap());
    // The device is free for the next owner. This owner may have to wait until the first connection is closed.
    while let Err(last_error) = scanner.open(server.address(), quick(), Tap::default()).await {
        assert_eq!(last_error.code().unwrap().code, 0x0106, "{last_error}");
    }
}

#[tokio::test]
async fn reopens_a_lost_link() {
    let server = serve(setup());
    let scanner = Scanner::start(LOOPBACK).unwrap();
    let settings = Settings { multiplier: Multiplier::of(64).unwrap(), ..quick() };
    let mut connection = scanner.open(server.address(), settings, Tap::default()).await.unwrap();
    connection.set_image(1, &[7; 48]).unwrap();
    connection.views.until(|view| view.input.as_ref().is_some_and(|input| *input.image == [!7; 48])).await;
    server.with(|adapter, _| adapter.set_fault(Some(AdapterFault::Stall)));
    let view = connection.views.until(|view| view.state == State::Lost).await;
    assert_eq!(view.last_error, Some(EipError::Silent(640 * MS)));
    assert_eq!(connection.set_image(1, &[8; 48]), Err(EipError::Outdated));
    server.with(|adapter, _| adapter.set_fault(None));
    connection.views.until(|view| view.generation == 2 && view.state == State::Open).await;
    let rest: Vec<u8> = image_after_loss(&resting(), &[7; 48]).iter().map(|byte| !byte).collect();
    connection.views.until(|view| view.input.as_ref().is_some_and(|input| *input.image == *rest)).await;
}

#[tokio::test]
async fn reports_an_absent_device() {
    let server = serve(setup());
    let address = server.address();
    drop(server);
    let scanner = Scanner::start(LOOPBACK).unwrap();
    assert!(matches!(scanner.open(address, quick(), Tap::default()).await, Err(EipError::Unreachable { .. })));
    let mut client = Client::new(address, Duration::from_secs(3), Tap::default());
    assert!(matches!(client.identity().await, Err(EipError::Unreachable { .. })));
}

#[tokio::test]
async fn reports_a_reset_and_uses_a_new_connection() {
    let server = serve(setup());
    let mut client = Client::new(server.address(), Duration::from_secs(3), Tap::default());
    let message = Message::get(1, 1, 1);
    assert_eq!(client.ask("the vendor", &message).await.unwrap().data, [0x7C, 0x02]);
    server.with(|adapter, _| adapter.set_fault(Some(AdapterFault::Reset)));
    assert_eq!(client.ask("the vendor", &message).await, Err(EipError::Hangup("the vendor")));
    server.with(|adapter, _| adapter.set_fault(None));
    assert_eq!(client.ask("the vendor", &message).await.unwrap().data, [0x7C, 0x02]);
    client.close().await;
}

#[tokio::test]
async fn reads_the_identity_over_tcp_and_udp() {
    let server = serve(setup());
    let expected = armctl_transport::eip::wire::Identity { address: server.address(), status: 0x30, ..identity() };
    let mut client = Client::new(server.address(), Duration::from_secs(3), Tap::default());
    assert_eq!(client.identity().await.unwrap(), Some(expected.clone()));
    assert_eq!(client.services().await.unwrap().unwrap().name, "Communications");
    let absent_device = SocketAddrV4::new(LOOPBACK, 9);
    let found = list_identity(Ipv4Addr::UNSPECIFIED, &[server.address()], Duration::from_secs(20), &Tap::default())
        .await
        .unwrap();
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].address, &found[0].identity), (server.address(), &expected));
    let found = list_identity(Ipv4Addr::UNSPECIFIED, &[absent_device], Duration::from_millis(1), &Tap::default())
        .await
        .unwrap();
    assert_eq!(found, []);
}

#[tokio::test]
async fn tap_receives_all_packets() {
    let server = serve(setup());
    let seen = Arc::new(Mutex::new(Vec::new()));
    let tap = {
        let seen = Arc::clone(&seen);
        Tap::new(move |packets| seen.lock().unwrap().push((packets.is_tcp, packets.from, packets.to)))
    };
    let scanner = Scanner::start(LOOPBACK).unwrap();
    let mut connection = scanner.open(server.address(), quick(), tap).await.unwrap();
    connection.views.until(|view| view.input.is_some()).await;
    connection.close().await.unwrap();
    let seen = seen.lock().unwrap();
    let images = SocketAddrV4::new(LOOPBACK, server.io_port);
    assert!(seen.iter().any(|(tcp, _, to)| *tcp && *to == server.address()));
    assert!(seen.iter().any(|(tcp, from, _)| *tcp && *from == server.address()));
    assert!(seen.iter().any(|(tcp, _, to)| !tcp && *to == images));
    assert!(seen.iter().any(|(tcp, from, to)| !tcp && *from == images && to.port() == scanner.port()));
}

#[tokio::test]
async fn probe_finds_instances_and_sizes() {
    let right = Instances { output: 101, input: 102, configuration: Some(151) };
    let setup = Setup::new(identity(), (102, 36), (101, 20), 151);
    let server = serve(setup);
    let mut client = Client::new(server.address(), Duration::from_secs(20), Tap::default());
    // Both guesses are wrong: the first has wrong instances, and the second has the directions exchanged.
    for thought in
        [Instances { output: 150, input: 100, configuration: Some(1) }, Instances { input: 101, output: 102, ..right }]
    {
        let findings = probe(&mut client, thought).await.unwrap();
        assert_eq!(findings.identity.unwrap().name, "RCX");
        let assembly = |instance, size| probe::Assembly { instance, size: Some(size) };
        assert_eq!(findings.assemblies, [assembly(101, 20), assembly(102, 36), assembly(151, 0)]);
        let found = Connectable { instances: right, output_size: Some(20), input_size: Some(36) };
        assert_eq!(findings.connectable, Some(found), "{:?}", findings.attempts);
    }
    // The probe opened no connection, not even for a short time.
    assert_eq!(server.with(|adapter, _| adapter.application.events.clone()), []);
    client.close().await;
}

#[tokio::test]
async fn the_library_connects_to_a_controller() {
    let faults = SimulatorFaults { link: None, device: None };
    let addresses = AdapterAddresses::anywhere(LOOPBACK);
    let server = armctl_yrcx::eip::simulated::serve(Start::default(), addresses, faults).unwrap();
    let link = open_eip("127.0.0.1", server.address().port()).await.unwrap();
    // On a busy machine, the connection can be lost, and opens again.
    let options = Options { timeout: Duration::from_secs(60), ..Options::default() };
    let mut robot = Robot::connect(link, options).await.unwrap();
    assert!(output::CPU_OK.is_on(&robot.input_image().await.unwrap()));
}
