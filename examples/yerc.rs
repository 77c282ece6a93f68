//! Asks a DX200 how it is, fetches a job and moves an axis: `cargo run --example yerc`.
//!
//! The controller is a simulator in this process; `Endpoint::udp("192.0.2.10")` is one on the network.
#![expect(clippy::print_stdout, reason = "an example tells what it does")]

use std::time::Duration;

use anyhow::Context as _;
use armctl_client::yerc::{Client, Endpoint, Options};
use armctl_controller::Risk;
use armctl_controller::yerc::Model::Dx200;
use armctl_controller::yerc::files::FileName;
use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::payload::{PulseMove, SpeedClass};
use armctl_controller::yerc::query::{Coordinates, MoveKind, MovePulse, ReadPosition, ReadStatus, Servo};

#[tokio::main(flavor = "current_thread")]
async fn main() -> anyhow::Result<()> {
    // Without a grant a client reads.
    let options = Options::new(Dx200).with_risk(Risk::Motion);
    let mut robot = Client::connect(Endpoint::simulator(Dx200), options).await.context("connect")?;

    let status = robot.ask(&ReadStatus).await?;
    println!("servo on: {}, alarm: {}", status.servo_on(), status.alarm());

    let job = robot.read_file(&FileName::new("TESTJOB.JBI")?).await.context("TESTJOB.JBI")?;
    println!("TESTJOB.JBI: {} bytes", job.len());

    robot.ask(&Servo(true)).await?;
    let (class, speed) = (SpeedClass::Percent, 1_000);
    let axes = [5_000, 0, 0, 0, 0, 0, 0, 0];
    let target = PulseMove { robot: 1, station: 0, class, speed, axes, tool: 0, base: [0; 3], station_axes: [0; 6] };
    robot.ask(&MovePulse::new(Dx200, MoveKind::Link, target)?).await?;
    let position = ReadPosition::new(Dx200, Group::R1, Coordinates::Pulse)?;
    while robot.ask(&position).await?.axes.as_slice()[0] != 5_000 {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    println!("S is at 5000 pulses");
    robot.close().await?;
    Ok(())
}
