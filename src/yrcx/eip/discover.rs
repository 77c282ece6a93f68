//! Discovery of EtherNet/IP boards on the network.

use std::io::ErrorKind;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};

use super::board::Identity;
use crate::fieldbus::{self, Device, Scope, VENDOR_ID, fields};
use crate::prelude::basics::*;
use armctl_frame::failure::plain;
use armctl_frame::settings::target::eip::SCHEME;
use armctl_transport::eip::PORT;
use armctl_transport::eip::discovery::{self, list_identity};
use armctl_transport::image::tap::Tap;

/// Addresses to search.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Search {
    /// Send the search only to these addresses
    #[arg(value_name = "ADDRESS[:PORT]", value_parser = address)]
    targets: Vec<SocketAddrV4>,
    /// Broadcast address (repeatable) [default: 255.255.255.255]
    #[arg(long, value_name = "ADDRESS[:PORT]", value_parser = address)]
    broadcast: Vec<SocketAddrV4>,
    /// Address of this computer from which armctl searches
    #[arg(long, value_name = "ADDRESS", default_value_t = Ipv4Addr::UNSPECIFIED, hide_default_value = true)]
    bind: Ipv4Addr,
}

fn address(text: &str) -> Result<SocketAddrV4, String> {
    let parsed = text.parse().or_else(|_| text.parse::<Ipv4Addr>().map(|address| SocketAddrV4::new(address, PORT)));
    parsed.map_err(|_| format!("'{text}' is not a valid IPv4 address, such as 192.168.0.2 or 192.168.0.2:{PORT}"))
}

impl fieldbus::Search for Search {
    fn scope(&self) -> Scope {
        match (self.targets.is_empty(), self.broadcast.is_empty()) {
            (false, _) => Scope::Devices,
            (true, false) => Scope::Network,
            (true, true) => Scope::Usual,
        }
    }

    fn search(&self, wait: Duration, tap: Tap) -> LocalBoxFuture<'_, Result<Vec<Device>>> {
        async move {
            let mut targets = [&self.targets[..], &self.broadcast].concat();
            let is_open = targets.is_empty();
            if is_open {
                targets.push(SocketAddrV4::new(Ipv4Addr::BROADCAST, PORT));
            }
            let tap = tap.into();
            let mut asked = list_identity(self.bind, &targets, wait, &tap).await;
            // A computer that is only in the robot network, for example, has no default route. Then search each local
            // network by its own broadcast address.
            if is_open && asked.as_ref().is_err_and(|error| error.kind() == ErrorKind::NetworkUnreachable) {
                let networks = discovery::broadcasts().unwrap_or_default();
                let networks: Vec<_> = networks.into_iter().map(|own| SocketAddrV4::new(own, PORT)).collect();
                if !networks.is_empty() {
                    asked = list_identity(self.bind, &networks, wait, &tap).await;
                }
            }
            let found = asked.map_err(|error| {
                Failure::new(Kind::NoAnswer, format!("the network cannot be searched: {}", plain(&error)))
                    .hint("select the network card with --bind, or the network with --broadcast, such as 192.168.0.255")
            })?;
            found.into_iter().map(found_board).collect()
        }
        .boxed_local()
    }
}

fn found_board(found: discovery::DiscoveredDevice) -> Result<Device> {
    let (host, port) = (found.address.ip(), found.address.port());
    let scheme = SCHEME.name;
    let target = if port == PORT { format!("{scheme}://{host}") } else { format!("{scheme}://{host}:{port}") };
    let is_yrcx = found.identity.vendor == VENDOR_ID;
    let identity = Identity::from(found.identity);
    let Identity { name, vendor, product, revision, serial, owned, .. } = &identity;
    let owner = if *owned { ", owned by a master" } else { "" };
    let device = format!("{name}, vendor {vendor}, product {product}, revision {revision}, {serial}{owner}");
    let address = SocketAddr::from(found.address).to_string();
    Ok(Device { address, target, is_yrcx, device, identity: fields(&identity)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_the_usual_port() {
        assert_eq!(address("10.0.0.2").unwrap().to_string(), "10.0.0.2:44818");
        assert_eq!(address("10.0.0.2:1").unwrap().to_string(), "10.0.0.2:1");
        for wrong in ["robot", "::1", "10.0.0", "10.0.0.2:"] {
            assert!(address(wrong).is_err(), "{wrong}");
        }
    }
}
