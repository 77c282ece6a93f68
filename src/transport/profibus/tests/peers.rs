//! Test with an independent implementation: the master of the crate `profirust` with our slave.

use std::time::Duration;

use profirust::phy::ProfibusPhy;
use profirust::time::Instant;
use profirust::{Baudrate, dp, fdl};

use super::super::rates::Rate;
use super::super::slave::{Setup, Slave, SlaveFault};
use super::{Echo, MS, SIZE};
use crate::line::Wire;

/// The port of `profirust` on our simulated line.
struct Phy {
    now: Duration,
    sent_until: Duration,
    wire: Wire,
    slave: Slave<Echo>,
    received: Vec<u8>,
}

impl ProfibusPhy for Phy {
    fn poll_transmission(&mut self, _now: Instant) -> bool {
        self.now < self.sent_until
    }

    fn transmit_data<F, R>(&mut self, _now: Instant, f: F) -> R
    where
        F: FnOnce(&mut [u8]) -> (usize, R),
    {
        let mut buffer = [0; 512];
        let (len, result) = f(&mut buffer);
        if len > 0 {
            self.wire.send(self.now, &buffer[..len]);
            self.sent_until = self.now + rate().pace().time(len);
        }
        result
    }

    fn receive_data<F, R>(&mut self, _now: Instant, f: F) -> R
    where
        F: FnOnce(&[u8]) -> (usize, R),
    {
        let mut buffer = [0; 64];
        loop {
            let len = self.wire.take(self.now, &mut buffer);
            if len == 0 {
                break;
            }
            self.received.extend(&buffer[..len]);
        }
        let (dropped, result) = f(&self.received);
        self.received.drain(..dropped);
        result
    }
}

fn rate() -> Rate {
    Rate::from_name("500k").unwrap()
}

/// Runs the `profirust` master for `time`. Returns the last input image, if the master is in data exchange.
fn drive(time: Duration, ident: u16, fault: Option<SlaveFault>) -> (Option<Vec<u8>>, Slave<Echo>) {
    let (mut inputs, mut outputs, mut diagnosis) = ([0; SIZE], [0; SIZE], [0; 16]);
    outputs[0] = 0x5A;
    outputs[32] = 0x41;
    let mut master = dp::DpMaster::new(vec![]);
    let options = dp::PeripheralOptions {
        ident_number: ident,
        user_parameters: Some(&[0, 0, 0]),
        config: Some(&[0xC0, 0xD7, 0xD7]),
        max_tsdr: 100,
        ..Default::default()
    };
    let peripheral =
        dp::Peripheral::new(5, options, &mut inputs[..], &mut outputs[..]).with_diag_buffer(&mut diagnosis[..]);
    let handle = master.add(peripheral);
    let parameters = fdl::ParametersBuilder::new(2, Baudrate::B500000)
        .slot_bits(4000)
        .max_retry_limit(3)
        .watchdog_timeout(profirust::time::Duration::from_millis(500))
        .build_verified(&master);
    let mut station = fdl::FdlActiveStation::new(parameters);
    let rate = rate();
    let mut slave = Slave::new(Setup::sample_controller(rate), Echo::default());
    slave.set_fault(fault);
    let wire = Wire::new(Some(rate.pace()), None);
    let mut phy = Phy { now: Duration::ZERO, sent_until: Duration::ZERO, wire, slave, received: Vec::new() };
    station.set_online();
    master.enter_operate();
    let step = Duration::from_micros(100);
    while phy.now < time {
        phy.now += step;
        phy.wire.run(phy.now, &mut phy.slave);
        let now = Instant::from_micros(i64::try_from(phy.now.as_micros()).unwrap());
        station.poll(now, &mut phy, &mut master);
        master.take_last_events();
    }
    let peripheral = master.get_mut(handle);
    let shown = peripheral.is_running().then(|| peripheral.pi_i().to_vec());
    (shown, phy.slave)
}

#[test]
fn another_master_exchanges_48_bytes_with_our_slave() {
    let (shown, slave) = drive(3000 * MS, 0x1234, None);
    let mut expected = vec![0; SIZE];
    (expected[0], expected[32]) = (0x5A, 0x41);
    assert_eq!(shown, Some(expected.clone()));
    assert_eq!((slave.owner, slave.peer.image.as_ref()), (Some(2), Some(&expected)));
    assert!(slave.exchanges() > 50, "{}", slave.exchanges());
}

#[test]
fn slave_rejects_another_master_with_a_wrong_ident_number() {
    let (shown, slave) = drive(1000 * MS, 0x1235, None);
    assert_eq!((shown, slave.owner, slave.exchanges()), (None, None, 0));
}

#[test]
fn another_master_recovers_from_lost_answers() {
    for fault in [SlaveFault::Lose, SlaveFault::BadFcs] {
        let (shown, slave) = drive(3000 * MS, 0x1234, Some(fault));
        assert!(shown.is_some() && slave.exchanges() > 20, "{fault:?}: {}", slave.exchanges());
    }
}
