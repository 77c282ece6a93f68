//! Device discovery: sends ListIdentity by UDP to one device or to a broadcast address.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::time::Duration;

use tokio::net::UdpSocket;
use tokio::time::{Instant, timeout_at};

use super::tap::Tap;
use super::wire::{Command, Frame, Identity};

/// Time within which devices answer a broadcast. Each device waits for its own delay (volume 2, 2-4.2.2).
const RESPONSE_WINDOW: Duration = Duration::from_millis(500);
const BUFFER: usize = 2048;
/// Maximum number of reported devices.
const MAX_DEVICES: usize = 1024;

/// A device that answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DiscoveredDevice {
    /// Address from which the answer came.
    pub address: SocketAddrV4,
    /// Identity of the device.
    pub identity: Identity,
}

/// Sends ListIdentity from a local address (0.0.0.0 means any) to devices and broadcast addresses. Collects answers
/// until `wait` has passed, or until every target that is a single device has answered. Devices answer a broadcast
/// within half a second, so `wait` should be at least 2 s.
///
/// # Errors
/// No socket can be opened, or nothing can be sent to any target.
pub async fn list_identity(
    own_address: Ipv4Addr,
    targets: &[SocketAddrV4],
    wait: Duration,
    tap: &Tap,
) -> io::Result<Vec<DiscoveredDevice>> {
    let socket = UdpSocket::bind((own_address, 0)).await?;
    socket.set_broadcast(true)?;
    let SocketAddr::V4(local_address) = socket.local_addr()? else { return Err(io::ErrorKind::Unsupported.into()) };
    let spread = u16::try_from(RESPONSE_WINDOW.as_millis()).unwrap_or(u16::MAX).to_le_bytes();
    let request = Frame { context: [spread[0], spread[1], 0, 0, 0, 0, 0, 0], ..Frame::new(Command::LIST_IDENTITY) };
    let request = request.emit();
    let start = Instant::now();
    let mut found: Vec<DiscoveredDevice> = Vec::new();
    // Datagrams can be lost. Therefore, after half of the time, the request is sent again to the targets that have not
    // answered.
    for until in [start + wait / 2, start + wait] {
        let mut failure = None;
        let mut sent = false;
        for target in targets.iter().filter(|target| !found.iter().any(|found| found.address == **target)) {
            match socket.send_to(&request, SocketAddr::V4(*target)).await {
                Ok(_) => {
                    tap.pass(false, local_address, *target, &request);
                    sent = true;
                }
                Err(error) => failure = Some(error),
            }
        }
        if let (false, Some(error)) = (sent, failure) {
            return Err(error);
        }
        collect_answers(&socket, local_address, until, targets, &mut found, tap).await;
    }
    Ok(found)
}

/// Returns the broadcast addresses of the local networks. Without a default route, a broadcast reaches all devices only
/// at these addresses.
#[cfg(target_os = "linux")]
pub fn broadcasts() -> io::Result<Vec<Ipv4Addr>> {
    use nix::net::if_::InterfaceFlags;

    let all = nix::ifaddrs::getifaddrs().map_err(io::Error::from)?;
    let ready = all.filter(|entry| entry.flags.contains(InterfaceFlags::IFF_UP | InterfaceFlags::IFF_BROADCAST));
    Ok(ready.filter_map(|entry| Some(entry.broadcast?.as_sockaddr_in()?.ip())).collect())
}

/// Returns no addresses: this function is not supported on this system.
#[cfg(not(target_os = "linux"))]
pub fn broadcasts() -> io::Result<Vec<Ipv4Addr>> {
    Ok(Vec::new())
}

async fn collect_answers(
    socket: &UdpSocket,
    local_address: SocketAddrV4,
    until: Instant,
    targets: &[SocketAddrV4],
    found: &mut Vec<DiscoveredDevice>,
    tap: &Tap,
) {
    let mut buffer = [0; BUFFER];
    while found.len() < MAX_DEVICES && !targets.iter().all(|target| found.iter().any(|found| found.address == *target))
    {
        let (len, address) = match timeout_at(until, socket.recv_from(&mut buffer)).await {
            Ok(Ok((len, SocketAddr::V4(address)))) => (len, address),
            // On Windows, the error "port unreachable" comes from one device. Other devices may still answer.
            Ok(_) => continue,
            Err(_) => return,
        };
        tap.pass(false, address, local_address, &buffer[..len]);
        let Ok(frame) = Frame::parse(&buffer[..len]) else { continue };
        let is_new = !found.iter().any(|found| found.address == address);
        if let (Command::LIST_IDENTITY, true, Ok(Some(identity))) = (frame.command, is_new, Identity::parse(frame.data))
        {
            found.push(DiscoveredDevice { address, identity });
        }
    }
}
