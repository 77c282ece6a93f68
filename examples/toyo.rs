//! Asks a Toyo controller how it is, reads a point and moves an axis by a small step: `cargo run --example toyo`.
//!
//! The controller is a simulator in this process; `Endpoint::serial("/dev/ttyUSB0")` is one at a serial port.
#![expect(clippy::print_stdout, reason = "an example tells what it does")]

use std::error::Error;
use std::time::Duration;

use armctl_client::toyo::{Client, Endpoint, MotionKind, Options, jog};
use armctl_controller::Risk;
use armctl_controller::toyo::request::Request;
use armctl_controller::toyo::table::Parameter;

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    // Without a grant a client reads.
    let options = Options::default().with_risk(Risk::Motion);
    let mut robot = Client::connect(Endpoint::simulator(), options).await?;

    let status = robot.status().await?;
    println!("servo on: {}, host on: {}", status.servo_on(), status.host_on());

    let point =
        robot.ask(&Request::read_parameter(Parameter::named("T1").ok_or("no table of points")?, Some(1))?).await?;
    println!("point 1: {}", point.written());

    // The host is switched ON for it, and OFF again at the end.
    robot.ask(&jog("RS", None)).await?;
    robot.ask(&jog("+C", Some(0))).await?;
    while robot.read_position().await?.number("x") == Some(0) {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    // Until it is told to stop, an axis may move.
    let place = robot.stop(MotionKind::Jog).await?;
    println!("axis 1 is at {:.2} mm", f64::from(place.number("x").unwrap_or_default()) / 100.0);
    let (_, closed) = robot.close().await;
    Ok(closed?)
}
