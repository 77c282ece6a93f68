//! Explicit messages to the DeviceNet node of a controller. They start no polling of the node.

use super::check;
use super::connect::{adapter, request_timeout};
use crate::fieldbus::{BusBoard, Checked, ConnectionParameters};
use crate::prelude::basics::*;
use armctl_frame::settings::target::bus::Scheme;
use armctl_frame::settings::target::devicenet::{BUS, DeviceNet};
use armctl_transport::devicenet::error::Error;
use armctl_transport::devicenet::link::{produced_size, read};
use armctl_transport::devicenet::network::{Connection, Network, Tap};
use armctl_transport::devicenet::scanner::DiscoveredNode;
use armctl_transport::devicenet::settings::{Purpose, Settings};
use armctl_transport::devicenet::wire::{Request, class, connection};
use armctl_transport::image::LinkError;

/// Time to listen for the polls of another master.
const LISTEN: Duration = Duration::from_secs(1);

/// DeviceNet node of a controller. The first request opens the adapter.
#[derive(Debug)]
pub struct Board {
    /// Options of the URL.
    pub node: DeviceNet,
    scheme: &'static Scheme,
    label: String,
    timeout: Duration,
    tap: Tap,
    network: Option<Network>,
    connection: Option<Connection>,
}

impl Board {
    /// Creates the client for the node of a URL.
    pub(super) fn new(at: &ConnectionParameters<'_>) -> Result<Self, LinkError> {
        Ok(Self {
            node: at.options::<DeviceNet>()?.clone(),
            scheme: at.bus.scheme,
            label: at.robot.label(),
            timeout: request_timeout(at),
            tap: at.tap.clone(),
            network: None,
            connection: None,
        })
    }

    /// Opens the adapter, if necessary. armctl is then a node of the network.
    pub async fn network(&mut self) -> Result<Network> {
        if let Some(network) = &self.network {
            return Ok(network.clone());
        }
        let opened = Network::open(&adapter(&self.node), self.tap.clone()).await;
        let network = opened.map_err(|error| self.failure(error))?;
        self.network = Some(network.clone());
        Ok(network)
    }

    /// Finds all nodes that answer.
    pub async fn nodes(&mut self) -> Result<Vec<Node>> {
        let found = self.network().await?.find().await;
        Ok(found.map_err(|error| self.failure(error))?.into_iter().map(Node::from).collect())
    }

    /// Opens the explicit connection, if necessary.
    async fn connection(&mut self) -> Result<&Connection> {
        if self.connection.is_none() {
            let network = self.network().await?;
            let purpose = Purpose::Messages { with_poll: true };
            let settings = Settings { slave: self.node.mac, purpose, timeout: self.timeout };
            let opened = network.connect(settings).await;
            self.connection = Some(opened.map_err(|error| self.failure(error))?);
        }
        self.connection.as_ref().ok_or_else(|| Failure::local("there is no connection"))
    }

    /// Reads an attribute; `None` if the node refuses it.
    async fn get(&mut self, request: Request) -> Result<Option<Vec<u8>>> {
        let mac = self.node.mac;
        match read(self.connection().await?, mac, &request).await {
            Ok(data) => Ok(Some(data)),
            Err(Error::Refused { .. }) => Ok(None),
            Err(error) => Err(self.failure(error)),
        }
    }

    async fn word(&mut self, request: Request) -> Result<Option<u16>> {
        let data = self.get(request).await?;
        Ok(data.and_then(|data| data.first_chunk().copied()).map(u16::from_le_bytes))
    }

    /// Reads the identity object.
    pub async fn identity(&mut self) -> Result<Identity> {
        let of = |attribute| Request::get(class::IDENTITY, 1, attribute);
        let vendor = self.word(of(1)).await?;
        let device_type = self.word(of(2)).await?;
        let product = self.word(of(3)).await?;
        let revision = self.get(of(4)).await?.and_then(|data| data.first_chunk().copied());
        let serial = self.get(of(6)).await?.and_then(|data| data.first_chunk().copied());
        let name = self.get(of(7)).await?;
        Ok(Identity {
            mac: self.node.mac.number(),
            vendor,
            device_type,
            product,
            revision: revision.map(|[major, minor]: [u8; 2]| format!("{major}.{minor}")),
            serial: serial.map(|bytes| format!("0x{:08X}", u32::from_le_bytes(bytes))),
            name: name.map(|name| String::from_utf8_lossy(name.get(1..).unwrap_or_default()).into_owned()),
        })
    }

    /// Reads the image sizes: bytes from the node, and bytes to the node.
    pub async fn sizes(&mut self) -> Result<(Option<u16>, Option<u16>)> {
        let of = |attribute| Request::get(class::CONNECTION, connection::POLL_INSTANCE.into(), attribute);
        Ok((self.word(of(7)).await?, self.word(of(8)).await?))
    }

    /// Reads the image with explicit messages; `None` if the node sends its image only in polls.
    pub async fn image(&mut self) -> Result<Option<Image>> {
        let mac = self.node.mac;
        let request = match produced_size(self.connection().await?, mac).await {
            Ok(request) => request,
            Err(Error::Refused { .. } | Error::Senseless { .. }) => return Ok(None),
            Err(error) => return Err(self.failure(error)),
        };
        Ok(self.get(request).await?.and_then(|image| Image::from_link(&image)))
    }

    /// Listens to the polls of another master, and returns the image of the node.
    pub async fn overheard(&mut self) -> Result<Option<Image>> {
        let mac = self.node.mac;
        let seen = self.network().await?.listen(mac, LISTEN).await.input;
        Ok(seen.and_then(|seen| Image::from_link(&seen.image)))
    }

    /// Releases the explicit connection to the node.
    pub async fn release(&mut self) {
        if let Some(connection) = self.connection.take() {
            // An error is ignored: if the node does not answer, its connection times out.
            let _ = connection.close().await;
        }
    }

    fn failure(&self, error: Error) -> Failure {
        not_open(&self.label, self.scheme, &LinkError::from(error))
    }

    /// Returns the failure for a node that does not answer. It lists the nodes that answer.
    pub fn absent(&self, nodes: &[Node]) -> Failure {
        let others: Vec<String> = nodes.iter().map(|node| node.mac.to_string()).collect();
        let others = if others.is_empty() {
            "no other node answers".to_owned()
        } else {
            format!("MAC {} answer", others.join(", "))
        };
        Failure::new(Kind::NoAnswer, format!("MAC {} does not answer; {others}", self.node.mac))
            .hint("check `mac=` in the URL, and the MAC ID that is set at the controller")
    }
}

impl BusBoard for Board {
    const BUS: &'static str = BUS;
    const DEVICE: &'static str = "node";

    async fn check_layers(&mut self, layers: &mut Layers) -> Checked<Option<Image>> {
        check::check_layers(self, layers).await
    }

    async fn end(mut self) {
        self.release().await;
    }
}

/// A node that was found on the bus.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Node {
    /// MAC ID of the node.
    pub mac: u8,
    /// Vendor id; YRCX has 636.
    pub vendor: u16,
    /// Serial number, for example `0x00C0FFEE`.
    pub serial: String,
    /// Whether the node answered; false if it only announced that it will go on line.
    pub on_line: bool,
}

impl From<DiscoveredNode> for Node {
    fn from(found: DiscoveredNode) -> Self {
        Self {
            mac: found.mac.number(),
            vendor: found.vendor,
            serial: format!("0x{:08X}", found.serial),
            on_line: found.is_on_line,
        }
    }
}

/// Identity of a node; an attribute that the node does not report is null. Do not trust the name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Identity {
    /// MAC ID of the node.
    pub mac: u8,
    /// Vendor id; YRCX has 636.
    pub vendor: Option<u16>,
    /// Device type.
    pub device_type: Option<u16>,
    /// Product code.
    pub product: Option<u16>,
    /// Major and minor revision.
    pub revision: Option<String>,
    /// Serial number, for example `0x00C0FFEE`.
    pub serial: Option<String>,
    /// Product name that the node reports.
    pub name: Option<String>,
}

impl Identity {
    /// Fields of a view.
    pub fn fields(&self) -> Vec<(&'static str, Cell)> {
        vec![
            ("MAC ID", u32::from(self.mac).into()),
            ("name", Cell::optional(self.name.clone())),
            ("vendor", Cell::optional(self.vendor)),
            ("device type", Cell::optional(self.device_type)),
            ("product", Cell::optional(self.product)),
            ("revision", Cell::optional(self.revision.clone())),
            ("serial", Cell::optional(self.serial.clone())),
        ]
    }
}
