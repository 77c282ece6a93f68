//! Tests of the in-process network: images, losses, virtual clock.

use std::time::Duration;

use super::super::device::{Device, Fault, Setup};
use super::super::error::ProfinetError;
use super::super::interface::Interface;
use super::super::simulated::{Link, Network};
use super::world::{Mirror, native_order, resting, settings, setup};
use crate::image::ImagePeer as _;

fn network(fault: Option<Fault>) -> Network {
    faulty(fault, None)
}

fn faulty(fault: Option<Fault>, faults: Option<&str>) -> Network {
    let device = |mac, ip| {
        let mut device = Device::new(Setup { mac, ip: Some(ip), ..setup() }, Mirror::default());
        device.set_fault(fault);
        device
    };
    Network::new(device, faults.map(|faults| faults.parse().unwrap()))
}

/// Returns the time, on the clock of the program, until the link is up or down.
fn until(link: &mut Link, is_up: bool) -> Duration {
    (0..10_000).map(Duration::from_millis).find(|now| link.output(*now).is_some() == is_up).expect("it comes to that")
}

#[test]
fn exchanges_images_with_the_simulated_device() {
    let network = network(None);
    assert!(Network::find(&network.interface().name).is_some());
    assert!(Interface::find(&network.interface().name).unwrap().network().is_some());
    let mut link = network.open(settings()).unwrap();
    let mut image = resting();
    image[0] = 7;
    link.input(Duration::from_millis(5), Some(&image));
    let shown = link.output(Duration::from_millis(40)).unwrap();
    assert_eq!(shown, native_order(&image));
    assert!(link.wake().is_some_and(|wake| wake > Duration::from_millis(40)));
    link.input(Duration::from_millis(50), None);
    assert_eq!(link.output(Duration::from_secs(9)), None);
    // The first connection was released, so a second connection can open at once.
    network.open(settings()).unwrap();
}

#[test]
fn device_gets_the_resting_image_after_a_loss() {
    let mut link = network(Some(Fault::Abort)).open(settings()).unwrap();
    link.input(Duration::ZERO, Some(&[0xFF; 48]));
    let lost = until(&mut link, false);
    assert!((Duration::from_millis(900)..Duration::from_millis(1300)).contains(&lost), "{lost:?}");
    until(&mut link, true);
    let after = |ms| Duration::from_secs(3) + Duration::from_millis(ms);
    assert!((0..2000).any(|ms| link.output(after(ms)) == Some(native_order(&resting()))));
}

#[test]
fn image_arrives_in_spite_of_network_faults() {
    let faults = "drop=5%,dup=5%,delay=0..9ms,reorder=1%";
    let mut opened = 0;
    for seed in 0..20 {
        let mut link = match faulty(None, Some(&format!("{faults},seed={seed}"))).open(settings()) {
            Ok(link) => link,
            // Connect is sent only once, because a device would interpret a second Connect as another controller. So
            // the opening fails if the answer is lost.
            Err(ProfinetError::NoAnswer { what: "Connect", .. }) => continue,
            Err(error) => panic!("seed {seed}: {error}"),
        };
        opened += 1;
        let mut now = Duration::ZERO;
        for round in 1..=20 {
            let mut image = resting();
            image[0] = round;
            // A duplicate call can end a connection. The test then sends the image again, as a client does after a
            // loss.
            let arrives = (0..5000).any(|ms| {
                if ms % 500 == 0 {
                    link.input(now, Some(&image));
                }
                now += Duration::from_millis(1);
                link.output(now) == Some(native_order(&image))
            });
            assert!(arrives, "seed {seed}, round {round}");
        }
    }
    assert!(opened > 10, "{opened} of 20");
    let error = faulty(None, Some("drop=100%")).open(settings()).unwrap_err();
    assert!(matches!(error, ProfinetError::NotFound { .. }), "{error}");
}

#[test]
fn silent_device_takes_no_real_time() {
    let error = network(Some(Fault::NeverReady)).open(settings()).unwrap_err();
    assert!(matches!(error, ProfinetError::NeverReady(_)), "{error}");
    let one = network(None);
    let name = one.interface().name;
    drop(one);
    assert!(Network::find(&name).is_none());
}
