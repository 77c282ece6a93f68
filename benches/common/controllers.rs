//! Simulated controllers on the loopback interface, in this process.

use std::future::Future;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::mpsc;

use anyhow::ensure;
use armctl_controller::{toyo as toyo_controller, yerc as yerc_controller, yrcx as yrcx_controller};
use armctl_toyo as toyo;
use armctl_transport::eip::adapter::server::AdapterAddresses;
use armctl_transport::fault::{Faults, SimulatorFaults};
use armctl_transport::line::Pace;
use armctl_transport::server::Server;
use armctl_transport::stream_server::StreamServer;
use armctl_yerc as yerc;
use armctl_yrcx as yrcx;
use tokio::task::LocalSet;

use super::runtime;

/// Names of the controller families, in the order that a fleet uses.
pub const FAMILIES: [&str; 3] = ["yerc", "toyo", "yrcx"];

/// Delays of the controllers' answers.
#[derive(Clone, Copy, Default)]
pub struct Delays {
    /// Delay of a datagram, in the format of `--fault delay=`.
    pub answer: Option<&'static str>,
    /// Baud rate of a serial line.
    pub baud: Option<u32>,
}

/// Serves this number of controllers of each family until the process ends. Returns their inventory. The robots have
/// the names `yerc0` and so on, and each has one of the tags `shard0` and so on.
pub fn serve(fleet: [usize; 3], delays: Delays, shards: usize) -> anyhow::Result<String> {
    let (tell, told) = mpsc::channel();
    std::thread::spawn(move || {
        let local = LocalSet::new();
        for (family, count) in FAMILIES.into_iter().zip(fleet) {
            for number in 0..count {
                let address_sender = tell.clone();
                let tell = move |target: String| {
                    let named = format!("name = \"{family}{number}\"\ntags = [\"shard{}\"]", number % shards);
                    address_sender
                        .send(format!("[[robot]]\n{named}\ntarget = \"{target}\"\n"))
                        .map_err(|_| anyhow::anyhow!("nobody wants to know where they are"))
                };
                match family {
                    "yerc" => drop(local.spawn_local(serve_until_failure(yerc(tell, delays)))),
                    "toyo" => drop(local.spawn_local(serve_until_failure(toyo(tell, delays)))),
                    _ => drop(local.spawn_local(serve_until_failure(yrcx(tell)))),
                }
            }
        }
        // If a controller fails to start, the list below is too short.
        drop(tell);
        runtime().map(|runtime| runtime.block_on(local))
    });
    let entries: Vec<String> = told.iter().take(fleet.iter().sum()).collect();
    ensure!(entries.len() == fleet.iter().sum::<usize>(), "not every controller could be served");
    Ok(entries.concat())
}

/// Serves a simulator, and prints why it ended.
pub async fn serve_until_failure(served: impl Future<Output = anyhow::Result<()>>) {
    if let Err(error) = served.await {
        println!("a simulated controller ended: {error:#}");
    }
}

/// A free port on the loopback interface.
pub const ANY: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

async fn yerc(tell: impl FnOnce(String) -> anyhow::Result<()>, delays: Delays) -> anyhow::Result<()> {
    let faults = delays.answer.map(|delay| format!("delay={delay}").parse()).transpose().map_err(anyhow::Error::msg)?;
    let mut server = Server::bind([ANY, ANY], faults.map(Faults::pair)).await?;
    tell(format!("udp://{}?file_port={}", server.local(0)?, server.local(1)?.port()))?;
    let start = yerc::simulator_start::start(None, None, yerc_controller::Model::Dx200, None)?;
    let mut controller = yerc::simulator_start::Simulated(yerc_controller::simulator::Simulator::new(start));
    loop {
        server.turn(&mut controller).await?;
    }
}

async fn toyo(tell: impl FnOnce(String) -> anyhow::Result<()>, delays: Delays) -> anyhow::Result<()> {
    let pace = delays.baud.map(|baud| Pace::new(baud, 11));
    let (mut server, address) = StreamServer::tcp(ANY, pace, None).await?;
    tell(format!("tcp://{address}"))?;
    let mut controller = toyo::simulated::Simulated::new(toyo_controller::simulator::Start::default());
    loop {
        server.turn(&mut controller).await?;
    }
}

async fn yrcx(tell: impl FnOnce(String) -> anyhow::Result<()>) -> anyhow::Result<()> {
    let start = yrcx_controller::simulator::Start::default();
    // The server runs on its own threads.
    let server = yrcx::eip::simulated::serve(
        start,
        AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST),
        SimulatorFaults::default(),
    )?;
    tell(format!("eip://{}", server.address()))?;
    std::future::pending().await
}
