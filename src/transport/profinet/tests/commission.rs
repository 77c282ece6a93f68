//! What stations are asked and told without a connection, in virtual time.

use super::super::commission::{self, Found};
use super::super::device::{Device, Event, Setup};
use super::super::error::ProfinetError;
use super::super::medium::{Medium as _, Simulated};
use super::super::settings::Station;
use super::super::wire::Mac;
use super::super::wire::dcp::Block;
use super::world::{ADDRESS, HERE, MS, Mirror, THERE, setup, suite};

const OTHER: Mac = Mac([2, 0, 0, 0, 0, 9]);

fn network(setups: impl IntoIterator<Item = Setup>) -> Simulated<Mirror> {
    Simulated::new(HERE, setups.into_iter().map(|setup| Device::new(setup, Mirror::default())).collect())
}

fn named(name: &str) -> Station {
    Station::Name(name.to_owned())
}

fn found(network: &mut Simulated<Mirror>) -> Found {
    commission::find(network, &Station::Mac(THERE)).unwrap()
}

#[test]
fn all_stations_answer_once_each() {
    let other = Setup { mac: OTHER, name: String::new(), ip: None, ..setup() };
    let mut network = network([setup(), other]);
    let all = commission::stations(&mut network, 2000 * MS).unwrap();
    let seen: Vec<_> = all.iter().map(|found| (found.mac, found.station.name.as_str(), found.station.address())).collect();
    assert_eq!(seen, [(OTHER, "", None), (THERE, "yrcx-sim", Some(ADDRESS))]);
    assert_eq!(network.now(), 2000 * MS);
}

#[test]
fn a_station_is_found_by_name_and_by_card() {
    let other = Setup { mac: OTHER, name: "other".to_owned(), ip: None, ..setup() };
    let mut network = network([setup(), other]);
    for (wanted, mac) in [(named("yrcx-sim"), THERE), (named("other"), OTHER), (Station::Mac(OTHER), OTHER)] {
        assert_eq!(commission::find(&mut network, &wanted).unwrap().mac, mac);
    }
    assert!(network.now() < 1000 * MS, "nobody waits for what has come: {:?}", network.now());
    let nobody = commission::find(&mut network, &named("nobody")).unwrap_err();
    assert!(matches!(nobody, ProfinetError::NotFound { .. }), "{nobody}");
}

#[test]
fn two_of_one_name_are_none() {
    let mut network = network([setup(), Setup { mac: OTHER, ip: None, ..setup() }]);
    let twice = commission::find(&mut network, &named("yrcx-sim")).unwrap_err();
    assert!(matches!(twice, ProfinetError::Duplicate { cards, .. } if cards == (THERE, OTHER)), "{twice}");
    assert_eq!(found(&mut network).mac, THERE, "the card tells them apart");
}

#[test]
fn what_is_set_is_there_then() {
    let mut network = network([Setup { ip: None, ..setup() }]);
    let (name, ip) = (Block::set_name("robot-7", true), Block::set_ip(&suite([192, 168, 78, 7]), false));
    for block in [name, ip, Block::signal()] {
        commission::change(&mut network, THERE, "DCP Set", &block).unwrap();
    }
    let seen = commission::settled(&mut network, THERE, "DCP Set", |said| said.name == "robot-7").unwrap();
    assert_eq!(seen.station.address(), Some([192, 168, 78, 7].into()));
    let events = [
        Event::Named("robot-7".to_owned(), true),
        Event::Addressed(suite([192, 168, 78, 7]), false),
        Event::Blink,
    ];
    assert_eq!(network.devices()[0].application().events, events);
    commission::change(&mut network, THERE, "DCP Reset", &Block::reset()).unwrap();
    let seen = found(&mut network).station;
    assert_eq!((seen.name.as_str(), seen.address()), ("", None));
    let never = commission::settled(&mut network, THERE, "DCP Set", |said| said.name == "x").unwrap_err();
    assert!(matches!(never, ProfinetError::NoAnswer { .. }), "{never}");
}

#[test]
fn what_a_station_does_not_take_is_told() {
    let mut network = network([Setup { takes_ip: false, ..setup() }]);
    let mut change = |mac, block| commission::change(&mut network, mac, "DCP Set", &block).unwrap_err();
    assert!(matches!(change(THERE, Block::set_name("Robot", true)), ProfinetError::Dcp { error: 3, .. }));
    let elsewhere = Block::set_ip(&suite([192, 168, 78, 9]), true);
    assert!(matches!(change(THERE, elsewhere), ProfinetError::Dcp { error: 5, .. }));
    assert!(matches!(change(OTHER, Block::signal()), ProfinetError::NoAnswer { .. }));
}

#[test]
fn an_address_that_somebody_has_is_seen() {
    let other = Setup { mac: OTHER, ip: Some(suite([192, 168, 78, 9])), ..setup() };
    let mut network = network([setup(), other]);
    let mut holder = |last| commission::holder(&mut network, [192, 168, 78, last].into(), THERE).unwrap();
    assert_eq!(holder(9), Some(OTHER));
    assert_eq!(holder(1), Some(HERE.mac), "this machine's own");
    assert_eq!(holder(2), None, "the station itself");
    assert_eq!(holder(3), None, "nobody's");
}

#[test]
fn records_are_read_without_a_connection() {
    let mut network = network([setup()]);
    let station = found(&mut network);
    let identity = commission::identity(&mut network, &station).unwrap();
    assert_eq!(identity.im0.unwrap().order_id, "RCX340");
    assert_eq!(identity.modules.unwrap().iter().map(|module| module.ident).collect::<Vec<_>>(), [1, 0x101, 0x102]);
}
