//! Tests with other implementations at the remote end: adapter, scanner, explicit client, decoder.
//!
//! `ciplink` is a crate. The other programs are in the folder `ARMCTL_EIP_PEERS`, which `peers/install` creates; tshark
//! must be installed. If something is missing, the tests are skipped with a message. Devices and scanners need port
//! 2222 of a separate address; the loopback network of Linux has such addresses.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use armctl_transport::eip::adapter::server::{AdapterAddresses, Server};
use armctl_transport::eip::client::Client;
use armctl_transport::eip::discovery::list_identity;
use armctl_transport::eip::explicit::Message;
use armctl_transport::eip::probe::{Instances, probe};
use armctl_transport::eip::scanner::Scanner;
use armctl_transport::eip::settings::{Role, Settings};
use armctl_transport::eip::tap::Tap;
use armctl_transport::eip::{IO_PORT, PORT};
use ciplink::adapter::{Adapter, AdapterConfig, Assembly, Event};

use super::pcap;
use super::world::{MS, Mirror, setup, with_long_timeout};

/// A loopback address on which port 2222 is free. Each test that runs in parallel has its own address.
fn address(last: u8) -> Option<Ipv4Addr> {
    let address = Ipv4Addr::new(127, 44, 18, last);
    UdpSocket::bind((address, IO_PORT)).ok().map(|_| address)
}

const NO_ADDRESS: &str = "skipped: the loopback has only one address here, or port 2222 of another is taken";

/// Folder of the programs that are not crates.
fn folder() -> Option<PathBuf> {
    std::env::var_os("ARMCTL_EIP_PEERS").map(PathBuf::from)
}

const NO_FOLDER: &str = "skipped: ARMCTL_EIP_PEERS does not name a folder of tests/eip/peers/install";

fn ciplink(address: Ipv4Addr) -> Adapter {
    let config = AdapterConfig {
        assemblies: vec![Assembly::input(100, 48), Assembly::output(150, 48), Assembly::config(1, 0)],
        bind: address,
        port: 0,
        ..AdapterConfig::default()
    };
    Adapter::start(config).unwrap()
}

fn v4(address: SocketAddr) -> SocketAddrV4 {
    match address {
        SocketAddr::V4(address) => address,
        SocketAddr::V6(_) => panic!("an adapter of EtherNet/IP has an IPv4 address"),
    }
}

#[tokio::test]
async fn our_scanner_owns_ciplink() {
    let Some(address) = address(1) else { return println!("{NO_ADDRESS}") };
    let adapter = ciplink(address);
    let scanner = Scanner::start(Ipv4Addr::LOCALHOST).unwrap();
    let mut connection = scanner
        .open(v4(adapter.addr()), Settings { rpi: 10 * MS, ..with_long_timeout() }, Tap::default())
        .await
        .unwrap();
    let info = adapter.connections().pop().unwrap();
    assert_eq!((info.input, info.output, info.multicast), (100, Some(150), false));
    assert_eq!((info.o_t_rpi, info.t_o_rpi), (10 * MS, 10 * MS));

    adapter.set_input(100, &[0x77; 48]).unwrap();
    connection.set_image(1, &[0x5A; 48]).unwrap();
    let run = connection.set_run(1, true).unwrap();
    let view = connection.views.until(|view| view.input.as_ref().is_some_and(|input| *input.image == [0x77; 48])).await;
    assert_eq!(view.statistics.size_error, 0);
    connection.views.until(|view| view.sent >= run).await;
    loop {
        let output = adapter.output(150).unwrap();
        if output.run && output.data == [0x5A; 48] {
            break;
        }
        assert!(adapter.next_event(Some(Duration::from_secs(20))).is_some(), "{output:?}");
    }

    let vendor = connection.ask("the vendor", &Message::get(1, 1, 1)).await.unwrap();
    assert_eq!((vendor.status.is_ok(), vendor.data.len()), (true, 2));
    connection.close().await.unwrap();
    assert!(adapter.connections().is_empty());
    while let Some(event) = adapter.next_event(Some(Duration::from_secs(20))) {
        assert!(!matches!(event, Event::TimedOut(_)), "{event:?}");
        if matches!(event, Event::Closed(_)) {
            break;
        }
    }
}

#[tokio::test]
async fn our_scanner_listens_to_ciplink() {
    let Some(address) = address(2) else { return println!("{NO_ADDRESS}") };
    let adapter = ciplink(address);
    adapter.set_input(100, &[9; 48]).unwrap();
    let scanner = Scanner::start(Ipv4Addr::LOCALHOST).unwrap();
    let inputs =
        Settings { role: Role::InputOnly, output: 238, output_size: 0, resting: vec![], ..with_long_timeout() };
    let mut connection = scanner.open(v4(adapter.addr()), inputs, Tap::default()).await.unwrap();
    let view = connection.views.until(|view| view.input.is_some()).await;
    assert_eq!(*view.input.unwrap().image, [9; 48]);
    connection.close().await.unwrap();
}

#[tokio::test]
async fn ciplink_refuses_wrong_settings() {
    let Some(address) = address(3) else { return println!("{NO_ADDRESS}") };
    let adapter = ciplink(address);
    let scanner = Scanner::start(Ipv4Addr::LOCALHOST).unwrap();
    let cases = [
        (
            Settings { output_size: 40, resting: vec![0; 40], ..with_long_timeout() },
            "(0x01/0x0109), the correct size is 54 bytes",
        ),
        (Settings { input_size: 600, ..with_long_timeout() }, "(0x01/0x0109), the correct size is 50 bytes"),
        (Settings { output: 100, input: 150, ..with_long_timeout() }, "(0x01/0x0117)"),
        (Settings { rpi: MS, ..with_long_timeout() }, "(0x01/0x0111)"),
    ];
    for (settings, end) in cases {
        let last_error = scanner.open(v4(adapter.addr()), settings, Tap::default()).await.unwrap_err().to_string();
        assert!(last_error.ends_with(end), "{last_error}");
    }
}

#[tokio::test]
async fn ciplink_reports_its_identity() {
    let Some(address) = address(4) else { return println!("{NO_ADDRESS}") };
    let adapter = ciplink(address);
    let target = v4(adapter.addr());
    let found =
        list_identity(Ipv4Addr::UNSPECIFIED, &[target], Duration::from_secs(20), &Tap::default()).await.unwrap();
    assert_eq!(found[0].identity.name, "ciplink adapter");
    let mut client = Client::new(target, Duration::from_secs(20), Tap::default());
    assert_eq!(client.identity().await.unwrap().unwrap().name, "ciplink adapter");
    assert_eq!(client.ask("the image", &Message::get(4, 100, 3)).await.unwrap().data, [0; 48]);
    let reported = Instances { output: 100, input: 150, configuration: None };
    let found = probe(&mut client, reported).await.unwrap().connectable.unwrap();
    assert_eq!((found.instances.output, found.instances.input), (150, 100));
    assert_eq!((found.output_size, found.input_size), (Some(48), Some(48)));
    assert!(adapter.next_event(Some(Duration::ZERO)).is_none(), "nothing was opened on the way");
    client.close().await;
}

/// Starts the adapter of this project on its default ports.
fn serve(address: Ipv4Addr) -> Option<Server<Mirror>> {
    Server::start(setup(), Mirror::default(), AdapterAddresses::usual(address), None).ok()
}

#[test]
fn st_ethernet_ip_owns_our_adapter() {
    let Some(folder) = folder() else { return println!("{NO_FOLDER}") };
    let (Some(own), Some(there)) = (address(5), address(6)) else { return println!("{NO_ADDRESS}") };
    let Some(server) = serve(there) else { return println!("skipped: port {PORT} of {there} is taken") };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/eip/peers/scanner.js");
    let mut node = Command::new("timeout");
    node.args(["60", "node", script, &own.to_string(), &there.to_string()]);
    let output = node.env("NODE_PATH", folder.join("node_modules")).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "a5".repeat(48), "{error}");
    server.with(|adapter, _| {
        assert_eq!(adapter.application.image, [0x5A; 48]);
        assert!(adapter.application.run);
    });
}

#[test]
fn pycomm3_asks_our_adapter() {
    let Some(folder) = folder() else { return println!("{NO_FOLDER}") };
    let server =
        Server::start(setup(), Mirror::default(), AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST), None).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/eip/peers/explicit.py");
    let mut python = Command::new("timeout");
    python.arg("60").arg(folder.join("venv/bin/python")).arg(script);
    let output = python.args(["127.0.0.1", &server.address().port().to_string()]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{error}"));
    assert_eq!(found["product"], "RCX");
    assert_eq!(found["serial"], "01020304");
    assert_eq!(found["revision"], serde_json::json!({"major": 1, "minor": 2}));
    assert_eq!(found["all"]["value"], "7c022b000500010230000403020103524358");
    assert_eq!(found["size"]["value"], "3000");
    assert_eq!(found["image"]["value"], "00".repeat(48));
    assert!(found["nothing"]["error"].as_str().unwrap().starts_with("Destination unknown"), "{found}");
    assert_eq!(found["write"]["error"], serde_json::Value::Null, "{found}");
    assert_eq!(server.with(|adapter, _| adapter.application.image.clone()), [b'Z'; 48], "nobody owns it");
    assert_eq!(found["refused"]["error"], "Attribute not settable");
}

/// tshark reads a complete exchange from a capture file.
#[tokio::test]
async fn tshark_decodes_recorded_packets() {
    if Command::new("tshark").arg("--version").output().is_err() {
        return println!("skipped: tshark is not installed");
    }
    let Some(there) = address(7) else { return println!("{NO_ADDRESS}") };
    let Some(server) = serve(there) else { return println!("skipped: port {PORT} of {there} is taken") };
    let passed = Arc::new(Mutex::new(pcap::Capture::default()));
    let tap = {
        let passed = Arc::clone(&passed);
        Tap::new(move |packet| passed.lock().unwrap().add(packet))
    };
    let scanner = Scanner::start(Ipv4Addr::LOCALHOST).unwrap();
    let mut connection = scanner.open(server.address(), with_long_timeout(), tap.clone()).await.unwrap();
    connection.set_run(1, true).unwrap();
    connection.views.until(|view| view.statistics.received >= 3).await;
    connection.ask("the size", &Message::get(4, 150, 4)).await.unwrap();
    connection.close().await.unwrap();
    let large = Settings { input_size: 600, ..with_long_timeout() };
    scanner.open(server.address(), large, tap.clone()).await.unwrap_err();
    list_identity(Ipv4Addr::UNSPECIFIED, &[server.address()], Duration::from_secs(20), &tap).await.unwrap();

    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("passed.pcap");
    std::fs::write(&file, passed.lock().unwrap().bytes()).unwrap();
    let read = |filter: &str, fields: &[&str]| {
        let mut tshark = Command::new("tshark");
        tshark.arg("-r").arg(&file).args(["-Y", filter, "-T", "fields", "-E", "separator=|"]);
        tshark.args(fields.iter().flat_map(|field| ["-e", field]));
        let output = tshark.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(read("_ws.malformed || _ws.expert.severity == error", &["frame.number"]), [""; 0]);

    // Some versions of tshark write numbers in decimal, and others in hexadecimal.
    let numbers = |filter: &str, fields: &[&str]| {
        let lines = read(filter, fields);
        let parts = lines.iter().flat_map(|line| line.split(['|', ',']));
        parts
            .map(|part| {
                part.strip_prefix("0x").map_or_else(|| part.parse(), |hex| u32::from_str_radix(hex, 16)).unwrap()
            })
            .collect::<Vec<u32>>()
    };
    let begin = "cip.cm.sc == 0x54 && cip.rr == 0";
    assert_eq!(numbers(begin, &["cip.cm.otrpi", "cip.cm.torpi", "cip.cm.timeout_multiplier"]), [20_000, 20_000, 7]);
    assert_eq!(numbers(begin, &["cip.cm.fwo.consize", "cip.cm.fwo.type", "cip.cm.fwo.f_v"]), [54, 50, 2, 2, 0, 0]);
    assert_eq!(numbers(begin, &["cip.cm.fwo.prio", "cip.cm.fwo.transport"]), [2, 2, 1]);
    assert_eq!(numbers(begin, &["cip.connpoint"]), [150, 100]);
    assert_eq!(
        numbers("cip.cm.sc == 0x54 && cip.rr == 1", &["cip.genstat", "cip.cm.otapi", "cip.cm.toapi"]),
        [0, 20_000, 20_000]
    );
    assert_eq!(numbers("cip.cm.sc == 0x5b && cip.rr == 0", &["cip.cm.fwo.consize"]), [54, 602]);
    assert_eq!(numbers("cip.cm.sc == 0x5b && cip.rr == 1", &["cip.genstat", "cip.cm.ext_status"]), [0x01, 0x0109]);
    assert_eq!(numbers("cip.cm.sc == 0x4e && cip.rr == 1", &["cip.genstat"]), [0]);
    assert_eq!(read("enip.lir.vendor == 636", &["enip.lir.name"]), ["RCX"]);

    // tshark needs the request that opens a connection to determine the direction of an image.
    let out =
        read("cipio && cip.32bitheader", &["enip.cpf.sai.seq", "cip.seq", "cip.32bitheader.run_idle", "udp.length"]);
    let mut runs = Vec::new();
    for (line, number) in out.iter().zip(1..) {
        let [sequence, count, run, len] = line.split('|').collect::<Vec<_>>()[..] else { panic!("{line}") };
        assert_eq!((sequence, count, len), (&*number.to_string(), &*number.to_string(), "80"));
        runs.push(run.ends_with('1'));
    }
    runs.dedup();
    // The connection is idle until the scanner sets run. It may be idle again before the end.
    assert!([&[true, false][..], &[false, true, false]].contains(&&runs[..]), "{out:?}");
    let reparsed = read("cipio && !cip.32bitheader", &["udp.length"]);
    assert!(reparsed.len() >= 3 && reparsed.iter().all(|len| len == "76"), "{reparsed:?}");
}
