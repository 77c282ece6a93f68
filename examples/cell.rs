//! A cell with a robot of each family: `cargo run --example cell`.
//!
//! A YRCX reports a part (SO(20)). A Toyo slider moves by a step, a DX200 runs a job, and the YRCX moves to its point. If
//! a step fails, all three robots are stopped. The controllers are simulators in this process.
#![expect(clippy::print_stdout, reason = "an example prints what it does")]

use std::error::Error;
use std::time::Duration;

use armctl_client::toyo::{self, MotionKind, jog};
use armctl_client::units::{Millimetres, Percent};
use armctl_client::yerc::{
    self, Model::Dx200, ReadStatus, ReadVariable, SelectJob, Selection, StartJob, Value, VariableKind,
};
use armctl_client::yrcx::{self, Command, Key, Side, Signal};
use armctl_client::{Risk, yerc::Servo};

struct Cell {
    picker: yrcx::Client,
    slider: toyo::Client,
    welder: yerc::Client,
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    // The simulated YRCX switches its signal on after 50 ms.
    let start = yrcx::Start::parse("[[event]]\nat_ms = 50\ndo = \"SO(20)=1\"\n")?;
    let picker = yrcx::Client::simulated(start, yrcx::Options::default().with_risk(Risk::Motion));
    let slider = toyo::Client::connect(toyo::Endpoint::simulator(), toyo::Options::default().with_risk(Risk::Motion));
    let welder =
        yerc::Client::connect(yerc::Endpoint::simulator(Dx200), yerc::Options::new(Dx200).with_risk(Risk::Motion));
    let (picker, slider, welder) = tokio::join!(picker, slider, welder);
    let mut cell = Cell { picker: picker?, slider: slider?, welder: welder? };

    let outcome = cell.run_cycle().await;
    if let Err(error) = &outcome {
        println!("stopping all robots: {error}");
        let Cell { picker, slider, welder } = &mut cell;
        let (picker, slider, welder) = tokio::join!(picker.stop(), slider.stop(MotionKind::Jog), welder.stop());
        println!("stopped: {} {} {}", picker.is_ok(), slider.is_ok(), welder.is_ok());
    }
    let (picker, (_, slider), welder) = tokio::join!(cell.picker.close(), cell.slider.close(), cell.welder.close());
    outcome?;
    picker?;
    slider?;
    welder?;
    Ok(())
}

impl Cell {
    async fn run_cycle(&mut self) -> Result<(), Box<dyn Error>> {
        let part = Signal::parse(Side::Output, "20")?;
        self.picker.wait_for_input(|image| part.is_on(image)).await?;
        println!("picker: {} is on", part.name());

        self.slider.ask(&jog("RS", None)).await?;
        self.slider.ask(&jog("+C", Some(0))).await?;
        while self.slider.read_position().await?.millimetres("x") == Some(Millimetres::from(0)) {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
        let place = self.slider.stop(MotionKind::Jog).await?;
        println!("slider: at {}", place.millimetres("x").ok_or("no position")?);

        self.welder.ask(&Servo(true)).await?;
        self.welder.ask(&SelectJob::new(Dx200, b"COUNT", Selection::Execute { line: 0 })?).await?;
        self.welder.ask(&StartJob).await?;
        while self.welder.ask(&ReadStatus).await?.running() {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
        if let Value::Double(parts) = self.welder.ask(&ReadVariable::new(VariableKind::D, 0)).await? {
            println!("welder: D000 is {parts}");
        }

        let go = Command::MovePtp.order().with(Key::Point, 1).with(Key::SpeedPercent, Percent::from(100));
        let moved = self.picker.ask(&go.with(Key::Report, 2).build()?).await?.values;
        println!("picker: at X {}", moved.millimetres(Key::Axis1).ok_or("no position")?);
        Ok(())
    }
}
