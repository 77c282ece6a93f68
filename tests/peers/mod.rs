//! Other implementations at the remote end of a real socket: `moto-hses-mock` in the place of the controller, and
//! `moto-hses-client` as a client of the simulator. Values that both sides support must agree.
//!
//! Neither of them is a reference for errors, retries or uploads. If a peer differs from the manuals, a comment has the
//! reason. A number in parentheses is the number of an ambiguity in the list of the protocol. Everything runs on
//! 127.0.0.1 with free ports. All sockets are bound before anything is sent.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod client;
mod mock;

use std::net::SocketAddr;

use armctl_controller::Risk;
use armctl_controller::yerc::Model;
use armctl_frame::output::{ColorChoice, Format, Screen};
use armctl_frame::settings::target::Family;
use armctl_frame::settings::{Selection, Sources};
use armctl_frame::{Access, ConnectMode, Family as _};
use armctl_yerc::link::{Link, Yerc};

/// Connects the client of this project to a controller at these local addresses.
async fn connect(model: Model, robot: SocketAddr, file: SocketAddr) -> Link {
    connect_with(&format!("udp://{robot}?file_port={}&model={model}", file.port()), None).await
}

async fn connect_with(url: &str, timeout: Option<std::time::Duration>) -> Link {
    let selection = Selection { target: Some(url.parse().unwrap()), ..Selection::default() };
    let mut sources = Sources { selection, ..Sources::default() };
    sources.flags.timeout = timeout;
    let robots = sources.robots(Some(Family::Yerc)).unwrap();
    let access =
        Access { grant: armctl_frame::gate::Grant::up_to(Risk::Motion), ..Access::reading(ConnectMode::Control) };
    let screen = Screen::new(Format::Table, ColorChoice::Never, true, 0);
    Yerc::connect(&robots[0], access, &screen).await.unwrap()
}
