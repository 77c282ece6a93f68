//! Multicast groups and broadcasts. These tests need port 2222 on all addresses, and therefore a separate test program.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

#[path = "world.rs"]
#[expect(dead_code, reason = "of both ends in virtual time only the settings are needed here")]
mod world;

use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::Duration;

use armctl_transport::eip::IO_PORT;
use armctl_transport::eip::adapter::server::{AdapterAddresses, Server};
use armctl_transport::eip::discovery::list_identity;
use armctl_transport::eip::scanner::Scanner;
use armctl_transport::eip::settings::{Role, Settings};
use armctl_transport::eip::tap::Tap;

use world::{Mirror, setup, with_long_timeout};

#[tokio::test]
async fn every_subscriber_receives_a_multicast_group() {
    let scanner = Scanner::shared().unwrap();
    if scanner.port() != IO_PORT {
        return println!("skipped: another program has UDP port {IO_PORT}");
    }
    assert_eq!(Scanner::shared().unwrap().port(), IO_PORT, "it is the same one");
    let server =
        Server::start(setup(), Mirror::default(), AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST), None).unwrap();
    let owner = Settings { multicast: true, ..with_long_timeout() };
    let listener = Settings { role: Role::ListenOnly, output: 237, output_size: 0, resting: vec![], ..owner.clone() };
    let mut owner = scanner.open(server.address(), owner, Tap::default()).await.unwrap();
    let mut listener = scanner.open(server.address(), listener, Tap::default()).await.unwrap();
    owner.set_image(1, &[0x5A; 48]).unwrap();
    for connection in [&mut owner, &mut listener] {
        let is_back = |image: &[u8]| image == [0xA5; 48];
        let view = connection.views.until(|view| view.input.as_ref().is_some_and(|input| is_back(&input.image))).await;
        assert_eq!(view.generation, 1, "{view:?}");
    }
    listener.close().await.unwrap();
    // The scanner continues to receive the group as long as one connection needs it.
    let received = owner.views.now().statistics.received;
    owner.views.until(|view| view.statistics.received > received + 2).await;
    owner.close().await.unwrap();
}

#[tokio::test]
async fn broadcast_finds_all_devices() {
    let anywhere = AdapterAddresses::anywhere(Ipv4Addr::UNSPECIFIED);
    let server = Server::start(setup(), Mirror::default(), anywhere, None).unwrap();
    let everybody = SocketAddrV4::new(Ipv4Addr::new(127, 255, 255, 255), server.address().port());
    match list_identity(Ipv4Addr::UNSPECIFIED, &[everybody], Duration::from_millis(500), &Tap::default()).await {
        Ok(found) if found.is_empty() => println!("skipped: the loopback has no broadcasts here"),
        Ok(found) => assert_eq!((found.len(), found[0].identity.name.as_str()), (1, "RCX")),
        Err(error) => println!("skipped: the loopback has no broadcasts here: {error}"),
    }
}
