//! Reads the state of a DX200, fetches a job and moves an axis: `cargo run --example yerc`.
//!
//! The controller is a simulator in this process; `Endpoint::udp("192.0.2.10")` is one on the network.
#![expect(clippy::print_stdout, reason = "an example prints what it does")]

use std::error::Error;
use std::time::Duration;

use armctl_client::Risk;
use armctl_client::units::{Percent, Pulses};
use armctl_client::yerc::{
    Client, Coordinates, Endpoint, FileName, Group, Model::Dx200, MoveKind, MovePulse, Options, PulseMove,
    ReadPosition, ReadStatus, Servo, Speed,
};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    // Without `with_risk`, a client only reads.
    let options = Options::new(Dx200).with_risk(Risk::Motion);
    let mut robot = Client::connect(Endpoint::simulator(Dx200), options).await?;

    let status = robot.ask(&ReadStatus).await?;
    println!("servo on: {}, alarm: {}", status.servo_on(), status.alarm());

    let job = robot.read_file(&FileName::new("TESTJOB.JBI")?).await?;
    println!("TESTJOB.JBI: {} bytes", job.len());

    robot.ask(&Servo(true)).await?;
    let target = [5_000, 0, 0, 0, 0, 0, 0, 0].map(Pulses::from_steps);
    let target = PulseMove::of_robot(1, target, Speed::Percent(Percent::from(10)));
    robot.ask(&MovePulse::new(Dx200, MoveKind::Link, target)?).await?;
    let position = ReadPosition::new(Dx200, Group::R1, Coordinates::Pulse)?;
    loop {
        let pulses = robot.ask(&position).await?.pulses().unwrap_or_default();
        if pulses.first() == Some(&Pulses::from(5_000)) {
            break;
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    println!("S is at {}", Pulses::from(5_000));
    robot.close().await?;
    Ok(())
}
