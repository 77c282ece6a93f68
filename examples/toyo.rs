//! Reads the state of a Toyo controller and a point, and moves an axis by a small step: `cargo run --example toyo`.
//!
//! The controller is a simulator in this process; `Endpoint::serial("/dev/ttyUSB0")` is one at a serial port.
#![expect(clippy::print_stdout, reason = "an example prints what it does")]

use std::error::Error;
use std::time::Duration;

use armctl_client::Risk;
use armctl_client::toyo::{Client, Endpoint, MotionKind, Options, Parameter, Request, jog};
use armctl_client::units::Millimetres;

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    // Without `with_risk`, a client only reads.
    let options = Options::default().with_risk(Risk::Motion);
    let mut robot = Client::connect(Endpoint::simulator(), options).await?;

    let status = robot.status().await?;
    println!("servo on: {}, host on: {}", status.servo_on(), status.host_on());

    let points = Parameter::named("T1").ok_or("no table of points")?;
    let point = robot.ask(&Request::read_parameter(points, Some(1))?).await?;
    println!("point 1: {}", point.written());

    // The client switches the host ON for the order, and OFF again when it closes.
    robot.ask(&jog("RS", None)).await?;
    robot.ask(&jog("+C", Some(0))).await?;
    while robot.read_position().await?.millimetres("x") == Some(Millimetres::from(0)) {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    // Until it is stopped, an axis may move.
    let place = robot.stop(MotionKind::Jog).await?;
    println!("axis 1 is at {}", place.millimetres("x").ok_or("no position")?);
    let (_, closed) = robot.close().await;
    Ok(closed?)
}
