//! Tests with other implementations over SLCAN adapters of python-can: a master and a strict slave in Python, and the
//! master `devicenet-py`. `ARMCTL_DEVICENET_PEERS` is the folder that `peers/install` created.

use std::io::{BufRead as _, BufReader, Read as _};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::world::{Mirror, images, mac, resting, setup};
use crate::devicenet::can::Bitrate;
use crate::devicenet::device::Device;
use crate::devicenet::hub::{Hub, Listen};
use crate::devicenet::network::{Adapter, AdapterLocation, Network, Tap};
use crate::devicenet::scanner::Identity;

/// Returns the path of a Python with python-can, and the path of a script.
fn script(name: &str) -> Option<(PathBuf, PathBuf)> {
    let Some(folder) = std::env::var_os("ARMCTL_DEVICENET_PEERS") else {
        println!("skipped: ARMCTL_DEVICENET_PEERS does not name a folder of devicenet/tests/peers/install");
        return None;
    };
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("devicenet/tests/peers");
    Some((Path::new(&folder).join("bin/python"), scripts.join(name)))
}

/// Returns the endpoints of the hub. TCP is first, because our master uses the first endpoint.
fn listen() -> Vec<Listen> {
    let mut listen = vec![Listen::Tcp(SocketAddr::from(([127, 0, 0, 1], 0)))];
    #[cfg(unix)]
    listen.push(Listen::Pty);
    listen
}

/// Returns the indexes of all endpoints, each combined with every image size.
fn channels() -> impl Iterator<Item = (usize, u16)> {
    (0..listen().len()).flat_map(|place| [48, 4].map(|size| (place, size)))
}

fn channel(place: &str) -> String {
    if place.starts_with('/') { place.to_owned() } else { format!("socket://{place}") }
}

#[test]
fn our_slave_serves_a_scripted_master() {
    for (place, size) in channels() {
        let Some((python, script)) = script("master.py") else { return };
        let device = Device::on_line(setup(5, size), Mirror::default());
        let hub = Hub::start(Bitrate::K500, Some(device), &listen(), None).unwrap();
        let output = Command::new(python)
            .arg(script)
            .arg(channel(&hub.endpoint_addresses[place]))
            .arg(size.to_string())
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stdout);
        assert!(
            output.status.success() && told.contains("released"),
            "{told}{}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert_eq!(hub.with(|device, _| device.master()), Some(None));
    }
}

#[test]
fn another_master_polls_our_slave() {
    for place in 0..listen().len() {
        let Some((python, script)) = script("others.py") else { return };
        let device = Device::on_line(setup(5, 4), Mirror::default());
        let hub = Hub::start(Bitrate::K500, Some(device), &listen(), None).unwrap();
        let output = Command::new(python).arg(script).arg(channel(&hub.endpoint_addresses[place])).output().unwrap();
        let told = String::from_utf8_lossy(&output.stdout);
        let complaints = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && told.contains("seen its images come back"), "{told}{complaints}");
        assert_eq!(hub.with(|device, _| device.application.image.clone()), Some(vec![0x41, 0, 5, 0]));
    }
}

#[tokio::test]
async fn our_master_satisfies_a_strict_slave() {
    for (place, size) in channels() {
        let Some((python, script)) = script("slave.py") else { return };
        let hub: Hub<Mirror> = Hub::start(Bitrate::K500, None, &listen(), None).unwrap();
        let mut slave = Command::new(python)
            .arg(script)
            .arg(channel(&hub.endpoint_addresses[place]))
            .arg(size.to_string())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut told = BufReader::new(slave.stdout.take().unwrap());
        let mut ready = String::new();
        told.read_line(&mut ready).unwrap();
        let address: SocketAddr = hub.endpoint_addresses[0].parse().unwrap();
        let place = AdapterLocation::Tcp { host: address.ip().to_string(), port: address.port() };
        let identity = Some(Identity { mac: mac(1), vendor: 0xFFFF, serial: 7 });
        let network =
            Network::open(&Adapter { place, bitrate: Bitrate::K500, identity }, Tap::default()).await.unwrap();
        let mut connection = network.connect(images(5)).await.unwrap();
        let first = connection.views.now().sent;
        connection.views.until(|view| view.sent > first).await;
        let image = vec![0x5A; size.into()];
        let change = connection.set_image(1, &image).unwrap();
        connection.views.until(|view| view.sent >= change).await;
        connection.close().await.unwrap();
        let mut rest = String::new();
        told.read_to_string(&mut rest).unwrap();
        assert!(slave.wait().unwrap().success(), "{rest}");
        let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
        assert_eq!(rest, format!("first {}\nlast {}\n", hex(&resting(size.into())), hex(&image)));
    }
}
