//! Tests of the services that need no connection, in virtual time.

use super::super::commission::{self, StationInfo};
use super::super::device::{Device, Setup};
use super::super::error::ProfinetError;
use super::super::interface::Interface;
use super::super::settings::Station;
use super::super::simulated::Network;
use super::super::wire::Mac;
use super::super::wire::dcp::Block;
use super::world::{Mirror, setup, suite};
use std::time::Duration;

/// Returns the interface of a network with one device.
fn interface(takes_ip: bool) -> Interface {
    let network =
        Network::new(|mac, ip| Device::new(Setup { mac, ip: Some(ip), takes_ip, ..setup() }, Mirror::default()), None);
    network.interface()
}

fn named(name: &str) -> Station {
    Station::Name(name.to_owned())
}

fn only(interface: &Interface) -> StationInfo {
    let all = commission::stations(interface, Duration::from_secs(2)).unwrap();
    let [found] = &all[..] else { panic!("{all:?}") };
    found.clone()
}

#[test]
fn finds_a_station_by_name_and_mac() {
    let interface = interface(true);
    let found = only(&interface);
    for wanted in [named("yrcx-sim"), Station::Mac(found.mac)] {
        assert_eq!(commission::find(&interface, &wanted).unwrap(), found);
    }
    for nobody in [named("nobody"), Station::Mac(Mac([2; 6]))] {
        let error = commission::find(&interface, &nobody).unwrap_err();
        assert!(matches!(error, ProfinetError::NotFound { .. }), "{error}");
    }
}

#[test]
fn setting_is_active_afterwards() {
    let interface = interface(true);
    let mac = only(&interface).mac;
    let ip = suite([192, 0, 2, 7]);
    for block in [Block::set_name("robot-7", true), Block::set_ip(&ip, false), Block::signal()] {
        commission::change(&interface, mac, "DCP Set", &block).unwrap();
    }
    let seen = commission::wait_until_active(&interface, mac, "DCP Set", |said| said.name == "robot-7").unwrap();
    assert_eq!(seen.station.address(), Some(ip.address));
    commission::change(&interface, mac, "DCP Reset", &Block::reset()).unwrap();
    let seen = only(&interface).station;
    assert_eq!((seen.name.as_str(), seen.address()), ("", None));
    let never = commission::wait_until_active(&interface, mac, "DCP Set", |said| said.name == "x").unwrap_err();
    assert!(matches!(never, ProfinetError::NoAnswer { .. }), "{never}");
}

#[test]
fn reports_a_rejected_setting() {
    let interface = interface(false);
    let there = only(&interface).mac;
    let change = |mac, block| commission::change(&interface, mac, "DCP Set", &block).unwrap_err();
    assert!(matches!(change(there, Block::set_name("Robot", true)), ProfinetError::Dcp { error: 3, .. }));
    let elsewhere = Block::set_ip(&suite([192, 0, 2, 9]), true);
    assert!(matches!(change(there, elsewhere), ProfinetError::Dcp { error: 5, .. }));
    assert!(matches!(change(Mac([2; 6]), Block::signal()), ProfinetError::NoAnswer { .. }));
}

#[test]
fn rejects_an_address_of_this_computer() {
    let interface = interface(true);
    let own = interface.ip.unwrap().address;
    let holder = |address| commission::holder(&interface, address, Mac([2; 6])).unwrap();
    assert_eq!((holder(own), holder([192, 0, 2, 9].into())), (Some(interface.mac), None));
}

#[test]
fn records_are_read_without_a_connection() {
    let interface = interface(true);
    let identity = commission::identity(&interface, &only(&interface)).unwrap();
    assert_eq!(identity.im0.unwrap().order_id, "RCX340");
    assert_eq!(identity.modules.unwrap().iter().map(|module| module.ident).collect::<Vec<_>>(), [1, 0x101, 0x102]);
}
