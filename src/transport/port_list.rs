//! List of the serial ports of this computer. The ports are not opened.

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};

use serialport::{SerialPortType, UsbPortInfo};

use armctl_files as files;

/// A serial port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortInfo {
    /// Name that opens the port, for example `/dev/ttyUSB0` or `COM3`.
    pub name: String,
    /// Name that stays the same when other devices are connected (Linux only).
    pub stable_name: Option<String>,
    /// Type of the port.
    pub kind: PortKind,
}

/// Type of a serial port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PortKind {
    /// A USB adapter.
    Usb {
        /// USB vendor id.
        vendor: u16,
        /// USB product id.
        product: u16,
        /// Manufacturer, reported by the device.
        maker: Option<String>,
        /// Product name, reported by the device.
        product_name: Option<String>,
        /// Serial number of the device.
        serial_number: Option<String>,
    },
    /// A PCI card.
    Pci,
    /// A Bluetooth link.
    Bluetooth,
    /// A port on the mainboard, or of unknown type.
    Unknown,
}

/// Linux folder with the terminals. The folder below has the links with stable names.
const TERMINALS: &str = "/sys/class/tty";
const STABLE_NAMES: &str = "/dev/serial/by-id";

/// A process that has a port open.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortUser {
    /// Process id.
    pub pid: u32,
    /// Program name.
    pub name: String,
}

/// Linux folder with the processes and their open files.
const PROCESSES: &str = "/proc";
/// Size limit of a `fdinfo` file. Such a file has a few lines.
const MAX_FDINFO_SIZE: u64 = 64 << 10;
/// Folder of the pseudo-terminals.
const PSEUDO_TERMINALS: &str = "/dev/pts";

/// How a process uses a port. Later variants exclude other processes more than earlier variants.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Usage {
    /// The process has the other end of the pseudo-terminal open, as a simulator does.
    OtherEnd,
    /// The process has the port open.
    Opened,
    /// The process has the port locked.
    Locked,
}

/// Returns the process that blocks a port. Works only on Linux, and only for processes of the same user.
pub fn user(path: &str) -> Option<PortUser> {
    let port = std::fs::canonicalize(path).ok()?;
    let processes = std::fs::read_dir(PROCESSES).ok()?.flatten();
    let numbered = processes.filter_map(|entry| Some((entry.file_name().to_str()?.parse().ok()?, entry.path())));
    let others = numbered.filter(|(pid, _)| *pid != std::process::id());
    let users = others.filter_map(|(pid, process): (u32, PathBuf)| Some((usage(&process, &port)?, pid, process)));
    let (_, pid, process) = users.max_by_key(|(usage, ..)| *usage)?;
    let name = files::text(&process.join("comm"), files::SETTINGS).ok()?;
    Some(PortUser { pid, name: name.trim().to_owned() })
}

/// Returns how a process uses a port; `None` if the process does not use it.
fn usage(process: &Path, port: &Path) -> Option<Usage> {
    let mut usage = None;
    let mut has_other_end = false;
    for file in std::fs::read_dir(process.join("fd")).ok()?.flatten() {
        let Ok(target) = std::fs::read_link(file.path()) else { continue };
        let info = || files::text(&process.join("fdinfo").join(file.file_name()), MAX_FDINFO_SIZE).unwrap_or_default();
        if target == port {
            let found = if info().contains("\nlock:") { Usage::Locked } else { Usage::Opened };
            usage = usage.max(Some(found));
        } else if target.ends_with("ptmx") {
            let index =
                info().lines().find_map(|line| line.strip_prefix("tty-index:").map(|index| index.trim().to_owned()));
            has_other_end |= index.is_some_and(|index| Path::new(PSEUDO_TERMINALS).join(index) == port);
        }
    }
    if has_other_end && usage == Some(Usage::Opened) { Some(Usage::OtherEnd) } else { usage }
}

/// All serial ports, sorted by name (`ttyUSB2` before `ttyUSB10`).
pub fn ports() -> io::Result<Vec<PortInfo>> {
    // The `serialport` crate expects that this folder exists.
    if cfg!(target_os = "linux") {
        let missing = |error: io::Error| io::Error::new(error.kind(), format!("{TERMINALS}: {error}"));
        std::fs::metadata(TERMINALS).map_err(missing)?;
    }
    let stable_names = stable_names(Path::new(STABLE_NAMES))?;
    let found = serialport::available_ports()?.into_iter().filter(|port| has_hardware(&port.port_name));
    let mut ports: Vec<PortInfo> = found
        .map(|port| PortInfo {
            stable_name: stable_names.get(Path::new(&port.port_name)).cloned(),
            kind: kind(port.port_type),
            name: port.port_name,
        })
        .collect();
    ports.sort_by_cached_key(|port| sort_key(&port.name));
    Ok(ports)
}

fn kind(kind: SerialPortType) -> PortKind {
    match kind {
        SerialPortType::UsbPort(UsbPortInfo { vid, pid, serial_number, manufacturer, product, .. }) => {
            PortKind::Usb { vendor: vid, product: pid, maker: manufacturer, product_name: product, serial_number }
        }
        SerialPortType::PciPort => PortKind::Pci,
        SerialPortType::BluetoothPort => PortKind::Bluetooth,
        SerialPortType::Unknown => PortKind::Unknown,
    }
}

/// Size limit of a sysfs file, which is at most one memory page.
const MAX_TYPE_SIZE: u64 = 4096;

/// Whether the hardware of the port exists. Linux also has names for ports that do not exist; the type of these ports
/// is 0.
fn has_hardware(name: &str) -> bool {
    let Some(name) = Path::new(name).file_name() else { return true };
    let kind = files::text(&Path::new(TERMINALS).join(name).join("type"), MAX_TYPE_SIZE);
    kind.map_or(true, |kind| kind.trim() != "0")
}

/// Returns the link to each target in a folder. If several links have the same target, the link that comes first in
/// alphabetical order is used.
fn stable_names(folder: &Path) -> io::Result<HashMap<PathBuf, String>> {
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(HashMap::new()),
        Err(error) => return Err(error),
    };
    let mut links: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    links.sort_unstable_by(|one, other| other.cmp(one));
    // A link that leads nowhere belongs to a port that was just unplugged, so it is skipped.
    let leading = links.into_iter().filter_map(|link| Some((link.canonicalize().ok()?, link.to_str()?.to_owned())));
    Ok(leading.collect())
}

/// Sort key of a name: the text, then the number at the end, so that 10 comes after 2.
fn sort_key(name: &str) -> (String, u64) {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    (stem.to_owned(), name[stem.len()..].parse().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_in_the_order_of_their_numbers() {
        let mut names = ["COM10", "/dev/ttyUSB10", "/dev/ttyS0", "COM3", "/dev/ttyUSB2", "/dev/tty.usb"];
        names.sort_by_cached_key(|name| sort_key(name));
        assert_eq!(names, ["/dev/tty.usb", "/dev/ttyS0", "/dev/ttyUSB2", "/dev/ttyUSB10", "COM3", "COM10"]);
    }

    #[cfg(unix)]
    #[test]
    fn stable_names_lead_to_ports() {
        let folder = tempfile::tempdir().unwrap();
        let (port, links) = (folder.path().join("ttyUSB0"), folder.path().join("by-id"));
        std::fs::write(&port, "").unwrap();
        assert!(stable_names(&links).unwrap().is_empty(), "no folder, no names");
        std::fs::create_dir(&links).unwrap();
        for (link, to) in [("usb-b", "../ttyUSB0"), ("usb-a", "../ttyUSB0"), ("usb-c", "../unplugged")] {
            std::os::unix::fs::symlink(to, links.join(link)).unwrap();
        }
        let names = stable_names(&links).unwrap();
        let expected = links.join("usb-a").to_str().unwrap().to_owned();
        assert_eq!(names, HashMap::from([(port.canonicalize().unwrap(), expected)]));
    }

    #[test]
    fn every_port_is_listed_once() {
        match ports() {
            Ok(ports) => {
                let names: std::collections::HashSet<&str> = ports.iter().map(|port| port.name.as_str()).collect();
                assert_eq!(names.len(), ports.len(), "{ports:?}");
            }
            // This error is correct on a computer that does not have the folder.
            Err(error) => assert!(error.to_string().contains(TERMINALS), "{error}"),
        }
    }
}
