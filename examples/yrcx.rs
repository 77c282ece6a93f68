//! Asks a YRCX how it is, reads a point and moves there: `cargo run --example yrcx`.
//!
//! The controller is a simulator in this process. `Client::connect` takes a link over any fieldbus.
#![expect(clippy::print_stdout, reason = "an example tells what it does")]

use std::error::Error;

use armctl_client::yrcx::{Client, Options};
use armctl_controller::Risk;
use armctl_controller::yrcx::signal::output;
use armctl_controller::yrcx::simulator::Start;
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::Key;

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    // Without a grant a client reads.
    let mut robot = Client::simulated(Start::default(), Options::default().with_risk(Risk::Motion)).await?;

    let inputs = robot.input_image().await?;
    println!("servo on: {}, alarm: {}", output::SERVO_ON.is_on(&inputs), output::ALARM.is_on(&inputs));

    let read = Command::PointGet.order().with(Key::Point, 1).build()?;
    println!("point 1: {:?} um", robot.ask(&read).await?.values.axes().ok_or("no position")?);

    // At half the program speed; the answer is to say where the robot is then, in mm.
    let (percent, mm) = (50, 2);
    let go = Command::MovePtp.order().with(Key::Point, 1).with(Key::SpeedPercent, percent).with(Key::Report, mm);
    let moved = robot.ask(&go.build()?).await?;
    println!("moved to {:?} um", moved.values.axes().ok_or("no position")?);
    robot.close().await?;
    Ok(())
}
