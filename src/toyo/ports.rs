//! `toyo ports`: serial ports of this computer.

use crate::prelude::basics::*;
use armctl_frame::OfflineCommand;
use armctl_transport::port_list::{self, PortInfo, PortKind, PortUser};

/// Failure: another program uses the port. If that program is armctl and receives a termination signal, it first stops
/// its motion.
pub fn in_use(label: &str, path: &str) -> Failure {
    let failure = |by: &str| Failure::new(Kind::NoAnswer, format!("{label}: {by} uses {path}"));
    match port_list::user(path) {
        Some(PortUser { pid, name }) if ["armctl", "toyo"].contains(&&name[..]) => failure(&format!(
            "another armctl, process {pid},"
        ))
        .hint(format!("use `kill {pid}` to stop its motion and end it, or share the line with `armctl session open`")),
        Some(PortUser { pid, name }) => failure(&format!("{}, process {pid},", name.escape_debug()))
            .hint("close the other program: a line can have only one host at a time"),
        None => failure("another program").hint("close the other program: a line can have only one host at a time"),
    }
}

/// List the serial ports of this computer without opening them.
#[derive(Debug, Args)]
#[command(after_help = "Use the target with -t or `armctl robots add`. `armctl help toyo-setup` describes \
                        cable and settings.")]
pub struct Ports {}

impl OfflineCommand for Ports {
    type Report = List;
    const ID: &'static str = "toyo.ports";

    fn run(&self, _screen: &Screen) -> Result<List> {
        Ok(List { ports: all()? })
    }
}

/// Serial ports of this computer.
pub fn all() -> Result<Vec<Port>> {
    let ports = port_list::ports().context("the list of serial ports")?;
    Ok(ports.into_iter().map(Port::from).collect())
}

/// Serial ports.
#[derive(Debug, Serialize, JsonSchema)]
pub struct List {
    ports: Vec<Port>,
}

/// A serial port.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Port {
    /// Name, such as `/dev/ttyUSB0` or `COM3`.
    name: String,
    /// Name that stays the same if other devices are added or removed (Linux).
    stable_name: Option<String>,
    /// URL for `-t`, with the stable name.
    target: String,
    /// Kind of port: `usb`, `pci`, `bluetooth` or `other`.
    kind: &'static str,
    /// Manufacturer, as the USB device reports it.
    maker: Option<String>,
    /// Product, as the USB device reports it.
    product: Option<String>,
    /// Serial number, as the USB device reports it.
    serial_number: Option<String>,
    /// Vendor id and product id of USB in hexadecimal, for example `0403:6001`.
    usb_id: Option<String>,
}

impl From<PortInfo> for Port {
    fn from(PortInfo { name, stable_name, kind }: PortInfo) -> Self {
        let target = format!("serial://{}", stable_name.as_ref().unwrap_or(&name));
        let plain = Self {
            name,
            stable_name,
            target,
            kind: "other",
            maker: None,
            product: None,
            serial_number: None,
            usb_id: None,
        };
        match kind {
            PortKind::Usb { vendor, product, maker, product_name, serial_number } => Self {
                kind: "usb",
                maker,
                product: product_name,
                serial_number,
                usb_id: Some(format!("{vendor:04x}:{product:04x}")),
                ..plain
            },
            PortKind::Pci => Self { kind: "pci", ..plain },
            PortKind::Bluetooth => Self { kind: "bluetooth", ..plain },
            PortKind::Unknown => plain,
        }
    }
}

impl Port {
    /// The URL for `-t`.
    pub fn target(&self) -> &str {
        &self.target
    }

    /// Describes the device, for example `FTDI FT232R USB UART (usb 0403:6001)`.
    pub fn device(&self) -> String {
        let names: Vec<&str> = [&self.maker, &self.product].into_iter().flatten().map(String::as_str).collect();
        let kind = self.usb_id.as_ref().map_or_else(|| self.kind.to_owned(), |id| format!("{} {id}", self.kind));
        if names.is_empty() { kind } else { format!("{} ({kind})", names.join(" ")) }
    }
}

impl Report for List {
    fn view(&self) -> View {
        let mut table = Table::new(
            &["port", "device", "target"],
            "no serial port found; plug the adapter in, or connect it to this container or virtual machine",
        );
        for port in &self.ports {
            table.row([Cell::from(port.name.as_str()).whole(), port.device().into(), port.target.as_str().into()]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::output::render;

    #[test]
    fn each_port_is_listed_with_its_device() {
        let usb = PortKind::Usb {
            vendor: 0x0403,
            product: 0x6001,
            maker: Some("FTDI".into()),
            product_name: Some("FT232R USB UART".into()),
            serial_number: Some("A9".into()),
        };
        let stable_name = Some("/dev/serial/by-id/usb-FTDI_FT232R_USB_UART_A9-if00-port0".to_owned());
        let list = List {
            ports: vec![
                Port::from(PortInfo { name: "/dev/ttyS0".into(), stable_name: None, kind: PortKind::Unknown }),
                Port::from(PortInfo { name: "/dev/ttyUSB0".into(), stable_name, kind: usb }),
            ],
        };
        assert_eq!(
            render::csv(&list.view()),
            "port,device,target\n\
             /dev/ttyS0,other,serial:///dev/ttyS0\n\
             /dev/ttyUSB0,FTDI FT232R USB UART (usb 0403:6001),\
             serial:///dev/serial/by-id/usb-FTDI_FT232R_USB_UART_A9-if00-port0\n"
        );
    }

    #[test]
    fn without_serial_ports_a_hint_is_shown() {
        let text = render::text(&List { ports: Vec::new() }.view(), 80, false);
        assert!(text.contains("plug the adapter in"), "{text}");
    }
}
