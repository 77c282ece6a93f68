//! `armctl report`: an archive for a bug report: versions, check, settings, state, alarms, recent frames.

use std::io::Write as _;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use flate2::Compression;
use flate2::write::GzEncoder;
use jiff::Zoned;

use crate::command::fleet::robots::Shown;
use crate::command::fleet::robots::check::{CheckReport, Checked};
use crate::command::fleet::status::{Fleet, Link};
use armctl_frame::face::overview::OverviewReport;
use armctl_frame::local_names::{Target, make_folder};
use armctl_frame::output::envelope::ErrorBody;
use armctl_frame::prelude::*;
use armctl_frame::{AnyReport, Family as _};
use armctl_transport::capture::{Carrier, LINKTYPE_ETHERNET, read};
use armctl_transport::tap::CaptureWriter;

/// Packs what a bug report needs into an archive for each robot: report-NAME-DATE.tar.gz. It only reads. The exit code is
/// that of `robots check`.
#[derive(Debug, Args)]
#[command(
    after_help = "Read the archive before you send it to other people. It has no passwords, but it has names, addresses, \
                  the position and the alarms of the robot, and the frames of these reads. With --anonymous, names, \
                  addresses and places are replaced, and packets with serial numbers are left out. Texts that the \
                  controller stores, such as names of programs, stay.\n\nA robot that does not answer also gets an \
                  archive. A file that exists is never overwritten."
)]
pub struct Pack {
    /// Robots in the inventory, or a target URL [default: the robots that -r, -t and other flags select]
    #[arg(value_name = "ROBOT", add = ValueKind::RobotOrUrl)]
    pub robots: Vec<String>,
    /// Folder for the archives; it is created if it does not exist
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    dir: PathBuf,
    /// Replace names, addresses and places, and leave serial numbers out
    #[arg(long)]
    anonymous: bool,
}

impl Command for Pack {
    type Family = Checked;
    type Report = Packed;
    const ID: &'static str = "report";
    const USES_FILES: bool = true;
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Checked>) -> Result<Packed> {
        let Context { robot, screen, .. } = context;
        if context.link.dry_run {
            return Err(Failure::usage("a report has no dry run: its requests depend on the answers")
                .hint("run the command without --dry-run; a report only reads"));
        }
        if context.link.trace.is_some() {
            return Err(Failure::usage("--trace has no effect on this command")
                .hint("remove --trace; the archive has the frames"));
        }
        let mut masks = Masks::default();
        let name = if self.anonymous { masks.robot(robot) } else { robot.name.clone() };
        let file = format!("report-{}-{}.tar.gz", file_part(&name), Zoned::now().strftime("%Y-%m-%d"));
        make_folder(&self.dir)?;
        let target = Target::new(self.dir.join(file), false)
            .map_err(|failure| failure.hint("move the file, or name another folder with --dir"))?;
        let folder = tempfile::tempdir().context("a temporary folder")?;
        let trace = folder.path().join("frames.pcapng");
        let access = Access { trace: Some(trace.clone()), ..context.link.clone() };
        let check = CheckReport::of(robot, access.clone(), screen).await?;
        let (status, alarms) = read_state(robot, Access { mode: ConnectMode::Monitor, ..access }, screen).await;
        // Without an answer, there may be no frames.
        let frames = files::read(&trace, MAX_FRAMES).unwrap_or_default();
        let (mut shown, mut frames) = (Shown::of(robot), Some(frames));
        if self.anonymous {
            shown.hide_places();
            frames = frames.and_then(|frames| masks.capture(&frames));
        }
        let mut parts = Vec::new();
        for (name, data) in [
            ("versions.json", Ok(versions())),
            ("check.json", AnyReport::data(&check)),
            ("settings.json", AnyReport::data(&shown)),
            ("status.json", Ok(status)),
            ("alarms.json", Ok(alarms)),
        ] {
            let mut data = data?;
            masks.value(&mut data);
            parts.push((name, format!("{data:#}\n").into_bytes()));
        }
        parts.extend(frames.filter(|frames| !frames.is_empty()).map(|frames| ("frames.pcapng", frames)));
        write(&target, &parts)?;
        let files = parts.iter().map(|(name, content)| PackedFile { name, bytes: content.len() }).collect();
        Ok(Packed { path: target.path().display().to_string(), anonymous: self.anonymous, files, check })
    }
}

/// Maximum size of the recorded frames.
const MAX_FRAMES: u64 = 64 << 20;

/// State and alarms of a robot, or the reason why they cannot be read.
async fn read_state(robot: &Robot, access: Access, screen: &Screen) -> (Value, Value) {
    let failed = |failure: Failure| json!({"error": ErrorBody::from(failure)});
    let (face, mut connection) = match Fleet::connect(robot, access, screen).await {
        Ok(Link::Open(face, connection)) => (face, connection),
        Ok(Link::Absent(absent)) => return (failed(absent.failure.clone()), failed(absent.failure)),
        Err(failure) => return (failed(failure.clone()), failed(failure)),
    };
    let status = (face.overview)(&mut *connection).await;
    let alarms = (face.alarms)(&mut *connection).await;
    // The archive does not depend on how the connection ends.
    let _ = connection.close(screen).await;
    (
        status.map_or_else(failed, |status| json!(OverviewReport { family: robot.family.name(), ..status })),
        alarms.map_or_else(failed, |alarms| json!({"alarms": alarms})),
    )
}

fn versions() -> Value {
    let features = [("plant", cfg!(feature = "plant")), ("plant-tls", cfg!(feature = "plant-tls"))];
    let features: Vec<&str> = features.into_iter().filter_map(|(name, is_on)| is_on.then_some(name)).collect();
    json!({
        "armctl": env!("CARGO_PKG_VERSION"),
        "commit": env!("BUILT_COMMIT"),
        "target": env!("BUILT_TARGET"),
        "features": features,
        "time": Zoned::now().timestamp(),
    })
}

/// Part of a file name without characters that a path has.
fn file_part(name: &str) -> String {
    name.chars().map(|char| if char.is_ascii_alphanumeric() || "-_.".contains(char) { char } else { '_' }).collect()
}

/// Writes a compressed tar archive.
fn write(target: &Target, parts: &[(&'static str, Vec<u8>)]) -> Result<()> {
    let mut tar = GzEncoder::new(Vec::new(), Compression::default());
    let packed = parts.iter().try_for_each(|(name, content)| {
        tar.write_all(&tar_header(name, content.len()))?;
        tar.write_all(content)?;
        tar.write_all(&vec![0; content.len().next_multiple_of(TAR_BLOCK) - content.len()])
    });
    // Two empty blocks end an archive.
    let packed = packed.and_then(|()| tar.write_all(&[0; 2 * TAR_BLOCK])).and_then(|()| tar.finish());
    let mut draft = target.begin()?;
    draft.write(&packed.context("the archive")?)?;
    draft.commit()
}

const TAR_BLOCK: usize = 512;

/// Header of a file in an archive (POSIX ustar): texts at fixed offsets, numbers as octal text.
fn tar_header(name: &str, len: usize) -> [u8; TAR_BLOCK] {
    let mut header = [0; TAR_BLOCK];
    let mut put = |at: usize, text: &str| header[at..at + text.len()].copy_from_slice(text.as_bytes());
    put(0, name);
    put(100, "0000600\0");
    put(108, "0000000\0");
    put(116, "0000000\0");
    put(124, &format!("{len:011o}\0"));
    put(136, "00000000000\0");
    // The checksum counts its own field as blanks.
    put(148, "        0");
    put(257, "ustar\x0000");
    let sum: u32 = header.iter().map(|byte| u32::from(*byte)).sum();
    header[148..156].copy_from_slice(format!("{sum:06o}\0 ").as_bytes());
    header
}

/// Replacements of an anonymous report.
#[derive(Debug, Default)]
struct Masks {
    texts: BTreeMap<String, String>,
    addresses: BTreeMap<IpAddr, IpAddr>,
}

impl Masks {
    /// Masks the name and the address of a robot. Returns the new name.
    fn robot(&mut self, robot: &Robot) -> String {
        let name = format!("robot-{:04x}", fastrand::u16(..));
        let url = robot.target.value.url();
        let place = url.split_once("://").map_or(url, |(_, rest)| rest).split(['?', '/']).next().unwrap_or_default();
        let host = match place.rsplit_once(':') {
            Some((host, _)) if !host.contains(':') || host.ends_with(']') => host,
            _ => place,
        };
        // PROFINET: the name of the station, then the interface. The file of a serial port says nothing about a plant.
        let host = host.split('@').next().unwrap_or_default().trim_matches(['[', ']']);
        match host.parse() {
            Ok(address) => {
                self.address(address);
            }
            Err(_) if host.is_empty() => {}
            Err(_) => {
                self.texts.insert(host.to_owned(), "host.example".to_owned());
            }
        }
        if let Some(path) = &robot.inventory {
            self.texts.insert(files::folder_of(path).display().to_string(), "FOLDER".to_owned());
        }
        self.texts.insert(robot.name.clone(), name.clone());
        name
    }

    /// Address from the block for documentation (RFC 5737).
    fn address(&mut self, address: IpAddr) -> IpAddr {
        let number = u8::try_from(self.addresses.len() + 1).unwrap_or(u8::MAX);
        let masked = *self.addresses.entry(address).or_insert_with(|| Ipv4Addr::new(192, 0, 2, number).into());
        self.texts.insert(address.to_string(), masked.to_string());
        masked
    }

    /// Replaces names and addresses in all texts of a value, the longest first, because a name can be a part of another.
    fn value(&self, value: &mut Value) {
        match value {
            Value::String(text) => {
                let mut texts: Vec<_> = self.texts.iter().collect();
                texts.sort_by_key(|(from, _)| std::cmp::Reverse(from.len()));
                *text = texts.into_iter().fold(std::mem::take(text), |text, words| replace_word(&text, words));
            }
            Value::Array(items) => items.iter_mut().for_each(|item| self.value(item)),
            Value::Object(entries) => entries.values_mut().for_each(|item| self.value(item)),
            _ => {}
        }
    }

    /// The capture with other addresses, and without the messages that identify a device. `None` for PROFINET, whose
    /// frames have the addresses and the name of the station everywhere.
    fn capture(&mut self, capture: &[u8]) -> Option<Vec<u8>> {
        let mut masked = Vec::new();
        let (mut is_framed, mut is_ethernet) = (false, false);
        let mut writer = CaptureWriter::streams(&mut masked).ok()?;
        let summary = read(capture, |message| {
            let mut ends = |from: SocketAddr, to: SocketAddr| {
                [from, to].map(|end| SocketAddr::new(self.address(end.ip()), end.port()))
            };
            // A full memory is the only possible failure of the writer.
            let _ = match message.carrier {
                Carrier::Datagram { from, to } if !identifies(message.bytes) => {
                    let [from, to] = ends(from, to);
                    writer.datagram(message.time, from, to, message.bytes)
                }
                Carrier::Stream { from, to, .. } if !identifies(message.bytes) => {
                    let [from, to] = ends(from, to);
                    writer.segment(message.time, from, to, message.bytes)
                }
                Carrier::Line { direction, .. } => writer.line(message.time, direction, message.bytes),
                Carrier::Frame { link_type } => {
                    is_framed = true;
                    is_ethernet |= link_type == LINKTYPE_ETHERNET;
                    Ok(())
                }
                _ => Ok(()),
            };
        });
        summary.ok()?;
        // Frames of DeviceNet and PROFIBUS have only station numbers.
        if is_framed { (!is_ethernet).then(|| capture.to_vec()) } else { Some(masked) }
    }
}

/// Replaces a word; 10.0.0.1 is not a word of 10.0.0.12.
fn replace_word(text: &str, (from, to): (&String, &String)) -> String {
    let is_inside = |char: Option<char>| char.is_some_and(char::is_alphanumeric);
    let (mut replaced, mut rest) = (String::new(), text);
    while let Some((before, after)) = rest.split_once(from.as_str()) {
        replaced.push_str(before);
        let is_part = is_inside(replaced.chars().next_back()) || is_inside(after.chars().next());
        replaced.push_str(if is_part { from } else { to });
        rest = after;
    }
    replaced + rest
}

/// Whether a message of EtherNet/IP has the identity of a device with its serial number: an answer to ListIdentity, or
/// to a read of all attributes.
fn identifies(bytes: &[u8]) -> bool {
    const LIST_IDENTITY: &[u8] = &[0x63, 0];
    const SEND_RR_DATA: &[u8] = &[0x6F, 0];
    const SERVICE_AT: usize = 40;
    const ALL_ATTRIBUTES_ANSWER: u8 = 0x81;
    bytes.starts_with(LIST_IDENTITY)
        || bytes.starts_with(SEND_RR_DATA) && bytes.get(SERVICE_AT) == Some(&ALL_ATTRIBUTES_ANSWER)
}

/// A written archive.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Packed {
    path: String,
    /// Whether names and addresses were replaced.
    anonymous: bool,
    files: Vec<PackedFile>,
    /// Result of the check, which is also in the archive.
    #[serde(flatten)]
    check: CheckReport,
}

/// A file in the archive.
#[derive(Debug, Serialize, JsonSchema)]
struct PackedFile {
    name: &'static str,
    bytes: usize,
}

impl Report for Packed {
    fn view(&self) -> View {
        let mut table = Table::new(&["file", "bytes"], "");
        for file in &self.files {
            table.row([file.name.into(), file.bytes.to_string().into()]);
        }
        let note = if self.anonymous { "; names and addresses are replaced" } else { "" };
        let head = format!("{}: read it before you send it{note}", self.path);
        View { sections: vec![Section::Text(head), Section::Table(table)] }
    }

    fn failure(&self) -> Option<Failure> {
        Report::failure(&self.check)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_addresses_are_replaced_in_texts() {
        let mut masks = Masks::default();
        masks.texts.insert("cell".to_owned(), "robot".to_owned());
        let masked = masks.address([10, 0, 0, 12].into());
        assert_eq!(masks.address([10, 0, 0, 12].into()), masked);
        masks.address([10, 0, 0, 1].into());
        let mut value = json!({"cell": ["cell has 10.0.0.12, not 10.0.0.1:80; cells"], "index": 1});
        masks.value(&mut value);
        assert_eq!(value, json!({"cell": ["robot has 192.0.2.1, not 192.0.2.2:80; cells"], "index": 1}));
    }

    #[test]
    fn tar_reads_the_header() {
        let header = tar_header("check.json", 8);
        assert_eq!(&header[124..136], b"00000000010\0");
        let sum: u32 = header
            .iter()
            .enumerate()
            .map(|(at, byte)| if (148..156).contains(&at) { 32 } else { u32::from(*byte) })
            .sum();
        assert_eq!(&header[148..156], format!("{sum:06o}\0 ").as_bytes());
    }
}
