//! Explicit messages to the network board of a controller, without an I/O connection.

use std::net::SocketAddrV4;

use super::{check, connect};
use crate::fieldbus::{BusBoard, Checked, ConnectionParameters};
use crate::prelude::basics::*;
use armctl_controller::text;
use armctl_frame::settings::target::eip::{self, EipRole, SCHEME};
use armctl_transport::eip::ASSEMBLY;
use armctl_transport::eip::client::Client;
use armctl_transport::eip::error::EipError;
use armctl_transport::eip::explicit::{Answer, Message};
use armctl_transport::eip::link::with_advice;
use armctl_transport::eip::probe::{self, AssemblyPresence, Findings, Instances};
use armctl_transport::eip::status;
use armctl_transport::eip::wire;
use armctl_transport::image::LinkError;

/// Attribute 3 of an assembly, which has the data.
const IMAGE: u32 = 3;
/// Usual output assembly of a YRCX. `USUAL_INPUT` is the usual input assembly.
const USUAL_OUTPUT: u32 = 150;
const USUAL_INPUT: u32 = 100;

/// Explicit messaging session with a board.
#[derive(Debug)]
pub struct Board {
    client: Client,
    /// Options of the URL.
    pub eip: eip::Eip,
    /// Robot in messages.
    pub label: String,
}

impl Board {
    /// Resolves the address of the board. The first request opens the connection.
    pub(super) async fn open(at: &ConnectionParameters<'_>) -> Result<Self, LinkError> {
        let (client, eip) = connect::client(at).await?;
        Ok(Self { client, eip, label: at.robot.label() })
    }

    /// Returns the TCP address of the board.
    pub fn address(&self) -> SocketAddrV4 {
        self.client.target()
    }

    /// Reads the identity; `None` if the board does not support the request.
    pub async fn identity(&mut self) -> Result<Option<Identity>> {
        match self.client.identity().await {
            Ok(identity) => Ok(identity.map(Identity::from)),
            Err(EipError::Encapsulation { .. }) => Ok(None),
            Err(error) => Err(self.failure(error)),
        }
    }

    /// Reads the list of services; `None` if the board does not support the request.
    pub async fn services(&mut self) -> Result<Option<Vec<&'static str>>> {
        match self.client.services().await {
            Ok(services) => Ok(services.map(|services| {
                let known = [(5, "messages over TCP"), (8, "images over UDP")];
                known.iter().filter(|(bit, _)| services.flags >> bit & 1 == 1).map(|(_, what)| *what).collect()
            })),
            Err(EipError::Encapsulation { .. }) => Ok(None),
            Err(error) => Err(self.failure(error)),
        }
    }

    /// Reads an attribute, or all attributes of an instance.
    pub async fn get(&mut self, object: Object) -> Result<Vec<u8>> {
        let answer = self.client.ask(object.reading(), &object.get()).await;
        let answer = answer.map_err(|error| self.failure(error))?;
        if answer.status.is_ok() { Ok(answer.data) } else { Err(self.refused(object.reading(), object, &answer)) }
    }

    /// Writes an attribute. The request is sent only once, so if the answer is lost, the outcome is unknown.
    pub async fn set(&mut self, object: Object, value: &[u8]) -> Result<()> {
        // Check with a harmless request first that the board answers.
        self.services().await?;
        let answer = match self.client.ask(SETTING, &object.set(value)).await {
            Ok(answer) => answer,
            Err(error @ (EipError::Unreachable { .. } | EipError::Impossible(_) | EipError::Encapsulation { .. })) => {
                return Err(self.failure(error));
            }
            Err(error) => {
                let message = format!("{}: the request was sent once, and the result is unknown: {error}", self.label);
                return Err(Failure::new(Kind::OutcomeUnknown, message)
                    .hint(format!("read the value with `yrcx eip get {}`", object.arguments())));
            }
        };
        if answer.status.is_ok() { Ok(()) } else { Err(self.refused(SETTING, object, &answer)) }
    }

    /// Reads the image of the controller.
    pub async fn image(&mut self) -> Result<Image> {
        let object = Object { class: ASSEMBLY, instance: self.eip.input, attribute: Some(IMAGE) };
        let bytes = self.get(object).await?;
        let image = bytes.get(..Image::BYTES).and_then(Image::from_bytes);
        image.ok_or_else(|| {
            let message = format!("assembly {} has {} bytes, fewer than an image", self.eip.input, bytes.len());
            Failure::new(Kind::Malformed, message)
                .hint("check `in=` in the URL; use `yrcx eip probe` to find the assemblies")
        })
    }

    /// Reads assemblies to find the existing assemblies and their sizes. `identity` is the identity of the board.
    pub async fn survey(&mut self, identity: Option<&Identity>) -> Result<ProbeResult> {
        let url_instances = self.url_instances();
        let exchanged = Instances { output: url_instances.input, input: url_instances.output, ..url_instances };
        let usual = Instances { output: USUAL_OUTPUT, input: USUAL_INPUT, ..url_instances };
        let found = probe::survey(&mut self.client, &[url_instances, usual, exchanged]).await;
        Ok(ProbeResult::of(&found.map_err(|error| self.failure(error))?, &self.eip, identity))
    }

    /// Finds the connection parameters. For this, armctl also requests connections. `identity` is the identity of the
    /// board.
    pub async fn probe(&mut self, identity: Option<&Identity>) -> Result<ProbeResult> {
        let url_instances = self.url_instances();
        let found = probe::probe(&mut self.client, url_instances).await.map_err(|error| self.failure(error))?;
        Ok(ProbeResult::of(&found, &self.eip, identity))
    }

    /// Reads whether the assemblies of the URL exist: input, output.
    pub async fn assemblies(&mut self) -> Result<[(u32, AssemblyPresence); 2]> {
        let Instances { output, input, .. } = self.url_instances();
        let mut found = [(input, AssemblyPresence::Unknown), (output, AssemblyPresence::Unknown)];
        for (instance, presence) in &mut found {
            *presence = probe::assembly(&mut self.client, *instance).await.map_err(|error| self.failure(error))?;
        }
        Ok(found)
    }

    /// Returns the assemblies that the URL names. If the URL has no output assembly, the usual output assembly is used.
    fn url_instances(&self) -> Instances {
        let usual = if self.eip.role == EipRole::Owner { self.eip.output } else { USUAL_OUTPUT };
        Instances { output: usual, input: self.eip.input, configuration: self.eip.configuration }
    }

    fn failure(&self, error: EipError) -> Failure {
        not_open(&self.label, &SCHEME, &LinkError::from(error))
    }

    fn refused(&self, what: &str, object: Object, answer: &Answer) -> Failure {
        let text = status::describe(&answer.status);
        let failure = Failure::new(Kind::Refused, format!("{}: {what} of {object} was refused: {text}", self.label))
            .code(format!("{:#04x}", answer.status.general));
        match status::meaning(&answer.status) {
            Some(code) => failure.hint(with_advice(code.remedy)),
            None => failure.hint("look up this status in the manual of the board"),
        }
    }
}

impl BusBoard for Board {
    const BUS: &'static str = SCHEME.bus;
    const DEVICE: &'static str = "board";

    async fn check_layers(&mut self, layers: &mut Layers) -> Checked<Option<Image>> {
        check::check_layers(self, layers).await
    }

    async fn end(self) {
        self.client.close().await;
    }
}

const SETTING: &str = "Set_Attribute_Single";

/// An object of a board, or one of its attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Object {
    /// Number of the class.
    pub class: u32,
    /// Number of the instance; 0 means the class itself.
    pub instance: u32,
    /// Number of the attribute; `None` means all attributes.
    pub attribute: Option<u32>,
}

impl Object {
    /// Encoded read request.
    pub fn get_bytes(self) -> Vec<u8> {
        self.get().request()
    }

    /// Encoded write request.
    pub fn set_bytes(self, value: &[u8]) -> Vec<u8> {
        self.set(value).request()
    }

    /// Returns the name of the service that reads the object.
    pub fn reading(self) -> &'static str {
        if self.attribute.is_some() { "Get_Attribute_Single" } else { "Get_Attributes_All" }
    }

    /// Whether the object is an assembly. An assembly can contain the output image.
    pub fn is_assembly(self) -> bool {
        self.class == ASSEMBLY
    }

    fn get(self) -> Message {
        match self.attribute {
            Some(attribute) => Message::get(self.class, self.instance, attribute),
            None => Message::get_all(self.class, self.instance),
        }
    }

    fn set(self, value: &[u8]) -> Message {
        Message::set(self.class, self.instance, self.attribute.unwrap_or_default(), value)
    }

    fn arguments(self) -> String {
        let attribute = self.attribute.map(|attribute| format!(" {attribute}")).unwrap_or_default();
        format!("{:#x} {}{attribute}", self.class, self.instance)
    }
}

impl fmt::Display for Object {
    /// Formats the object, for example "class 0x04 (assembly), instance 100, attribute 3".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "class {:#04x}", self.class)?;
        if let Some((_, name)) = CLASSES.iter().find(|(class, _)| *class == self.class) {
            write!(f, " ({name})")?;
        }
        write!(f, ", instance {}", self.instance)?;
        self.attribute.map_or(Ok(()), |attribute| write!(f, ", attribute {attribute}"))
    }
}

/// Names of classes (volume 1, chapter 5; volume 2, chapter 5).
const CLASSES: [(u32, &str); 7] = [
    (0x01, "identity"),
    (0x02, "message router"),
    (0x04, "assembly"),
    (0x06, "connection manager"),
    (0xF4, "port"),
    (0xF5, "TCP/IP interface"),
    (0xF6, "Ethernet link"),
];

/// Identity of a board. Do not trust the name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Identity {
    /// Vendor id; YRCX has 636.
    pub vendor: u16,
    /// Device type; 43 is generic.
    pub device_type: u16,
    /// Product code.
    pub product: u16,
    /// Major and minor revision.
    pub revision: String,
    /// Serial number, for example `0x0001E240`.
    pub serial: String,
    /// Product name that the board reports.
    pub name: String,
    /// Status word, for example `0x0030`.
    pub status: String,
    /// Meaning of the status word.
    pub status_text: Vec<&'static str>,
    /// Whether a master owns the outputs.
    pub owned: bool,
    /// State of the board, for example `operational` or `standby`; null if the board does not report its state.
    pub state: Option<&'static str>,
}

impl From<wire::Identity> for Identity {
    fn from(found: wire::Identity) -> Self {
        let known = STATUS.iter().filter(|(mask, value, _)| found.status & mask == *value);
        Self {
            vendor: found.vendor,
            device_type: found.device_type,
            product: found.product,
            revision: found.revision.to_string(),
            serial: format!("{:#010x}", found.serial),
            name: found.name,
            status: format!("{:#06x}", found.status),
            status_text: known.map(|(_, _, text)| *text).collect(),
            owned: found.status & 1 == 1,
            state: found.state.map(|state| STATES.get(usize::from(state)).copied().unwrap_or("unknown")),
        }
    }
}

/// Meanings of the bits of the status word: mask, value, text (volume 1, 5-2.2.1.5).
const STATUS: [(u16, u16, &str); 14] = [
    (0x0001, 0x0001, "owned by a master"),
    (0x0004, 0x0004, "configured"),
    (0x00F0, 0x0010, "firmware update"),
    (0x00F0, 0x0020, "a connection is faulted"),
    (0x00F0, 0x0030, "no connection for images"),
    (0x00F0, 0x0040, "bad configuration in memory"),
    (0x00F0, 0x0050, "major fault"),
    (0x00F0, 0x0060, "a connection runs"),
    (0x00F0, 0x0070, "a connection idles"),
    (0x0100, 0x0100, "minor fault that can be reset"),
    (0x0200, 0x0200, "minor fault that cannot be reset"),
    (0x0400, 0x0400, "major fault that can be reset"),
    (0x0800, 0x0800, "major fault that cannot be reset"),
    (0x000E, 0x0002, "reserved bit 1"),
];

/// States of a device (volume 2, 2-4.2.2).
const STATES: [&str; 6] =
    ["nonexistent", "self test", "standby", "operational", "major recoverable fault", "major unrecoverable fault"];

impl Identity {
    /// Fields of a view.
    pub fn fields(&self) -> Vec<(&'static str, Cell)> {
        let status = format!("{}: {}", self.status, self.status_text.join(", "));
        vec![
            ("name", self.name.as_str().into()),
            ("vendor", self.vendor.to_string().into()),
            ("device type", self.device_type.to_string().into()),
            ("product", self.product.to_string().into()),
            ("revision", self.revision.as_str().into()),
            ("serial number", self.serial.as_str().into()),
            ("status", status.trim_end_matches(": ").into()),
            ("state", Cell::optional(self.state)),
        ]
    }
}

/// Result of a probe: assemblies and connection parameters.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProbeResult {
    /// Assemblies that can be read.
    pub assemblies: Vec<Assembly>,
    /// Connection requests with `--try`. They have invalid sizes, so that no connection opens.
    pub attempts: Vec<Attempt>,
    /// Parameters that a connection can use; null if none were found. Without `--try`, they are derived from the
    /// readable assemblies.
    pub connectable: Option<Connectable>,
    /// Whether another master owns the outputs. Either the board reports this in its status, or it refuses a second
    /// owner when armctl uses `--try`. Some boards do only one of the two.
    pub owned: bool,
}

/// An assembly.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Assembly {
    /// Instance number.
    pub instance: u32,
    /// Size in bytes; null if the board does not report it.
    pub bytes: Option<u16>,
}

/// A connection request and its answer.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Attempt {
    /// Assembly with the data from the controller.
    #[serde(rename = "in")]
    pub input: u32,
    /// Assembly with the data to the controller.
    #[serde(rename = "out")]
    pub output: u32,
    /// Configuration assembly; null if there is none.
    pub config: Option<u32>,
    /// Requested number of bytes from the controller.
    pub in_size: u16,
    /// Requested number of bytes to the controller.
    pub out_size: u16,
    /// Status code, for example `0x01/0x0109`.
    pub code: String,
    /// Meaning of the status code.
    pub answer: String,
    /// Advice for this status code.
    pub advice: Option<&'static str>,
}

/// Parameters of a connection.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Connectable {
    /// Assembly with the data from the controller.
    #[serde(rename = "in")]
    pub input: u32,
    /// Assembly with the data to the controller.
    #[serde(rename = "out")]
    pub output: u32,
    /// Configuration assembly; null if there is none.
    pub config: Option<u32>,
    /// Number of bytes from the controller; null if the board does not report it.
    pub in_size: Option<u16>,
    /// Number of bytes to the controller; null if the board does not report it.
    pub out_size: Option<u16>,
    /// URL with these parameters.
    pub target: String,
}

/// Extended status for "another originator owns the outputs".
const OWNED: u16 = 0x0106;

impl ProbeResult {
    fn of(found: &Findings, eip: &eip::Eip, identity: Option<&Identity>) -> Self {
        let refuses = found.attempts.iter().any(|attempt| attempt.status.extended.first() == Some(&OWNED));
        let owned = refuses || identity.is_some_and(|identity| identity.owned);
        let attempts: Vec<Attempt> = found
            .attempts
            .iter()
            .map(|attempt| Attempt {
                input: attempt.instances.input,
                output: attempt.instances.output,
                config: attempt.instances.configuration,
                out_size: attempt.sizes.0,
                in_size: attempt.sizes.1,
                code: match attempt.status.extended.first() {
                    Some(extended) => format!("{:#04x}/{extended:#06x}", attempt.status.general),
                    None => format!("{:#04x}", attempt.status.general),
                },
                answer: status::describe(&attempt.status),
                advice: status::meaning(&attempt.status).map(|code| code.remedy),
            })
            .collect();
        let connectable = found.connectable.map(|connectable| {
            let Instances { output, input, configuration } = connectable.instances;
            let config = configuration.map_or_else(|| "none".to_owned(), |instance| instance.to_string());
            let mut target = format!("eip://{}:{}?in={input}&out={output}&config={config}", eip.host, eip.port);
            // The URL omits sizes that are the default.
            for (name, size) in [("in_size", connectable.input_size), ("out_size", connectable.output_size)] {
                if let Some(size) = size.filter(|size| usize::from(*size) != Image::BYTES) {
                    target.push_str(&format!("&{name}={size}"));
                }
            }
            Connectable {
                input,
                output,
                config: configuration,
                in_size: connectable.input_size,
                out_size: connectable.output_size,
                target,
            }
        });
        let assemblies = found.assemblies.iter();
        let assemblies = assemblies.map(|found| Assembly { instance: found.instance, bytes: found.size }).collect();
        Self { assemblies, attempts, connectable, owned }
    }
}

/// Bytes as pairs of hexadecimal digits.
pub fn hex_pairs(bytes: &[u8]) -> String {
    let digits: Vec<String> = bytes.iter().map(|byte| text::hex(&[*byte])).collect();
    digits.join(" ")
}

/// Cell in the warning color.
pub fn warning_cell(text: &str) -> Cell {
    Cell::from(text).tone(Tone::Warning)
}
