//! Reads the state of a YRCX and a point, and moves there: `cargo run --example yrcx`.
//!
//! The controller is a simulator in this process; `Client::connect(open_eip("192.0.2.10", EIP_PORT).await?, options)`
//! connects to one on the network.
#![expect(clippy::print_stdout, reason = "an example prints what it does")]

use std::error::Error;

use armctl_client::Risk;
use armctl_client::units::Percent;
use armctl_client::yrcx::{Client, Command, Key, Options, Start, output};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    // Without `with_risk`, a client only reads.
    let mut robot = Client::simulated(Start::default(), Options::default().with_risk(Risk::Motion)).await?;

    let inputs = robot.input_image().await?;
    println!("servo on: {}, alarm: {}", output::SERVO_ON.is_on(&inputs), output::ALARM.is_on(&inputs));

    let read = Command::PointGet.order().with(Key::Point, 1).build()?;
    let point = robot.ask(&read).await?.values;
    println!("point 1: X {}", point.millimetres(Key::Axis1).ok_or("the point is in pulses")?);

    // The answer to a motion has the final position, if the command asks for it: 1 in pulses, 2 in mm.
    let go = Command::MovePtp.order().with(Key::Point, 1).with(Key::SpeedPercent, Percent::from(50));
    let moved = robot.ask(&go.with(Key::Report, 2).build()?).await?.values;
    println!("moved to X {}", moved.millimetres(Key::Axis1).ok_or("no position")?);
    robot.close().await?;
    Ok(())
}
