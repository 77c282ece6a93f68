//! Discovery of DeviceNet nodes on an adapter.

use super::board::Node;
use super::connect::adapter;
use crate::fieldbus::{self, Device, Scope, VENDOR_ID, bus_of, fields};
use crate::prelude::basics::*;
use armctl_frame::settings::target::Bus;
use armctl_frame::settings::target::devicenet::DeviceNet;
use armctl_transport::devicenet::network::Network;
use armctl_transport::image::LinkError;
use armctl_transport::image::tap::Tap;

/// Adapters to search.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Search {
    /// Find DeviceNet nodes on this adapter, for example slcan:///dev/ttyACM0, slcan://HOST:PORT or can://can0
    /// (repeatable)
    #[arg(long = "devicenet", value_name = "URL", value_parser = wired)]
    adapters: Vec<(String, Bus)>,
}

/// Parses the URL of an adapter. Appends a MAC ID, so that the text becomes a valid URL of a node.
fn wired(text: &str) -> Result<(String, Bus), String> {
    let sign = if text.contains('?') { '&' } else { '?' };
    let bus = bus_of(&format!("{text}{sign}mac=63")).map_err(|failure| failure.message)?;
    if bus.options::<DeviceNet>().is_none() {
        return Err(format!("'{text}' is not a CAN adapter, such as slcan:///dev/ttyACM0"));
    }
    Ok((text.to_owned(), bus))
}

impl fieldbus::Search for Search {
    fn scope(&self) -> Scope {
        if self.adapters.is_empty() { Scope::Nothing } else { Scope::Network }
    }

    fn search(&self, _wait: Duration, tap: Tap) -> LocalBoxFuture<'_, Result<Vec<Device>>> {
        async move {
            let mut all = Vec::new();
            for (url, bus) in &self.adapters {
                let Some(node) = bus.options::<DeviceNet>() else { continue };
                let failed = |error| not_open(url, bus.scheme, &LinkError::from(error));
                let network = Network::open(&adapter(node), tap.clone()).await.map_err(failed)?;
                let found = network.find().await.map_err(failed)?;
                for node in found.into_iter().map(Node::from) {
                    all.push(found_node(url, &node)?);
                }
            }
            Ok(all)
        }
        .boxed_local()
    }
}

fn found_node(url: &str, node: &Node) -> Result<Device> {
    let sign = if url.contains('?') { '&' } else { '?' };
    Ok(Device {
        address: format!("{url} MAC {}", node.mac),
        target: format!("{url}{sign}mac={}", node.mac),
        is_yrcx: node.vendor == VENDOR_ID,
        device: format!("MAC {}, vendor {}, {}", node.mac, node.vendor, node.serial),
        identity: fields(node)?,
    })
}
