//! Search for the assemblies of a device, their sizes, and a combination of assemblies for a connection.
//!
//! A survey only reads assemblies. A probe also requests connections, with a size that no assembly has. The device
//! refuses these connections, and the reason of the refusal reveals missing instances and correct sizes. If a device
//! accepts such a connection, this program is its master until the connection is closed. A probe can therefore take
//! control of the device.

use std::fmt;
use std::time::Duration;

use super::client::Client;
use super::error::EipError;
use super::explicit::{Answer, Message};
use super::settings::Settings;
use super::wire::{Close, Command, Identity, Open, Opened, RrData, Status, Triad};
use super::{ASSEMBLY, UNREGISTERED_VENDOR};

/// Attribute numbers of an assembly.
const DATA: u32 = 3;
const SIZE: u32 = 4;
/// Instances that the survey reads: all 8-bit numbers.
pub const INSTANCES: std::ops::RangeInclusive<u32> = 1..=255;
/// Configuration instances that the probe tries; `None` means no configuration.
const CONFIGURATIONS: [Option<u32>; 5] = [Some(1), Some(5), Some(151), Some(199), None];
/// General status codes of refusals. The codes below are extended status codes.
const NO_SUCH_OBJECT: [u8; 2] = [0x05, 0x16];
const SIZES: u16 = 0x0109;
const O_T_SIZE: u16 = 0x0127;
const T_O_SIZE: u16 = 0x0128;
const OWNED: u16 = 0x0106;
/// Requested packet interval. All devices support it.
const RPI: Duration = Duration::from_millis(100);
/// Number of bytes before the image. To the device, these are the sequence count and the run/idle header. From the
/// device, it is only the sequence count.
const O_T_EXTRA: u16 = 6;
const T_O_EXTRA: u16 = 2;
/// A size that no assembly has.
const IMPOSSIBLE_SIZE: u16 = 499;

/// A readable assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Assembly {
    /// Instance number.
    pub instance: u32,
    /// Size in bytes, if the device reports it.
    pub size: Option<u16>,
}

/// Instances of a possible connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instances {
    /// Consumed assembly (output).
    pub output: u32,
    /// Produced assembly (input).
    pub input: u32,
    /// Configuration assembly.
    pub configuration: Option<u32>,
}

impl fmt::Display for Instances {
    /// Formats the instances, for example "out 150, in 100, config 1".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "out {}, in {}, ", self.output, self.input)?;
        match self.configuration {
            Some(configuration) => write!(f, "config {configuration}"),
            None => f.write_str("no config"),
        }
    }
}

/// A requested connection and its result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Attempt {
    /// Requested instances.
    pub instances: Instances,
    /// Requested image sizes in bytes: to the device, from the device.
    pub sizes: (u16, u16),
    /// Status of the answer.
    pub status: Status,
}

/// A possible connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Connectable {
    /// Instances of the connection.
    pub instances: Instances,
    /// Size of the image to the device in bytes, if the device reports it.
    pub output_size: Option<u16>,
    /// Size of the image from the device in bytes, if the device reports it.
    pub input_size: Option<u16>,
}

/// Result of a search.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Findings {
    /// Identity, if the device reports it.
    pub identity: Option<Identity>,
    /// Readable assemblies.
    pub assemblies: Vec<Assembly>,
    /// Attempts, in order.
    pub attempts: Vec<Attempt>,
    /// The possible connection, if one was found.
    pub connectable: Option<Connectable>,
}

/// Reads every assembly of [`INSTANCES`], without a connection. `thought` contains combinations of likely instances,
/// the likeliest first. The result reports as connectable the first combination whose assemblies can all be read.
///
/// # Errors
/// The device does not answer, or its answer is invalid. A refusal is a result, not an error.
pub async fn survey(client: &mut Client, thought: &[Instances]) -> Result<Findings, EipError> {
    let identity = match client.identity().await {
        Err(EipError::Encapsulation { .. }) => None,
        identity => identity?,
    };
    let mut assemblies = Vec::new();
    for instance in INSTANCES {
        if let AssemblyPresence::Readable(assembly) = assembly(client, instance).await? {
            assemblies.push(assembly);
        }
    }
    let size = |instance| assemblies.iter().find(|assembly| assembly.instance == instance)?.size;
    let connectable = thought.iter().find_map(|instances| {
        let (output_size, input_size) = (Some(size(instances.output)?), Some(size(instances.input)?));
        Some(Connectable { instances: *instances, output_size, input_size })
    });
    Ok(Findings { identity, assemblies, attempts: Vec::new(), connectable })
}

/// Makes a survey, then requests connections with likely instances, beginning with `thought`. Stops when it has found
/// instances with which the device would accept a connection of the correct sizes. If a device accepts wrong sizes,
/// this program controls the device until the connection is closed.
///
/// # Errors
/// The errors of [`survey`].
pub async fn probe(client: &mut Client, thought: Instances) -> Result<Findings, EipError> {
    let Findings { identity, assemblies, mut attempts, .. } = survey(client, &[]).await?;
    for instances in likely(thought, &assemblies) {
        if let Some(connectable) = attempt(client, instances, &assemblies, &mut attempts).await? {
            return Ok(Findings { identity, assemblies, attempts, connectable: Some(connectable) });
        }
    }
    Ok(Findings { identity, assemblies, attempts, connectable: None })
}

/// Result of reading one assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AssemblyPresence {
    /// The instance does not exist.
    Absent,
    /// The instance may exist, but the device reports neither its data nor its size.
    Unknown,
    /// The data or the size can be read.
    Readable(Assembly),
}

/// Reads one assembly.
///
/// # Errors
/// The errors of [`survey`].
pub async fn assembly(client: &mut Client, instance: u32) -> Result<AssemblyPresence, EipError> {
    let what = "Get_Attribute_Single of an assembly";
    let answer = client.ask(what, &Message::get(ASSEMBLY, instance, DATA)).await?;
    if answer.status.is_ok() {
        return Ok(AssemblyPresence::Readable(Assembly { instance, size: u16::try_from(answer.data.len()).ok() }));
    }
    if NO_SUCH_OBJECT.contains(&answer.status.general) {
        return Ok(AssemblyPresence::Absent);
    }
    // The assembly exists, but its data cannot be read. The device may still report its size.
    let answer = client.ask(what, &Message::get(ASSEMBLY, instance, SIZE)).await?;
    let size = answer.data.first_chunk().filter(|_| answer.status.is_ok()).map(|bytes| u16::from_le_bytes(*bytes));
    // If the device refuses both requests, nothing is known about the assembly.
    Ok(size
        .map_or(AssemblyPresence::Unknown, |size| AssemblyPresence::Readable(Assembly { instance, size: Some(size) })))
}

/// Returns the combinations to try: the instances `thought`, the same instances with input and output exchanged, then
/// pairs of the assemblies that were found. Each pair is combined with likely configurations.
fn likely(thought: Instances, assemblies: &[Assembly]) -> Vec<Instances> {
    let exchanged = (thought.input, thought.output);
    let mut pairs = vec![(thought.output, thought.input), exchanged];
    let found = assemblies.iter().filter(|assembly| assembly.size != Some(0)).map(|assembly| assembly.instance);
    let found: Vec<u32> = found.take(MAX_PAIRED_INSTANCES).collect();
    pairs.extend(found.iter().flat_map(|output| found.iter().map(|input| (*output, *input))));
    let mut configurations = vec![thought.configuration];
    configurations.extend(CONFIGURATIONS.into_iter().filter(|other| *other != thought.configuration));
    let mut all = Vec::new();
    for (output, input) in pairs.into_iter().filter(|(output, input)| output != input) {
        for configuration in &configurations {
            let instances = Instances { output, input, configuration: *configuration };
            if !all.contains(&instances) {
                all.push(instances);
            }
        }
    }
    all
}

/// Maximum number of assemblies of which pairs are formed.
const MAX_PAIRED_INSTANCES: usize = 6;

/// Requests connections of these instances until the sizes are known, or the device reports that the instances are
/// wrong.
async fn attempt(
    client: &mut Client,
    instances: Instances,
    assemblies: &[Assembly],
    attempts: &mut Vec<Attempt>,
) -> Result<Option<Connectable>, EipError> {
    let mut sizes_guess = AssemblySizes::default();
    loop {
        let sizes = sizes_guess.next();
        let status = open(client, instances, sizes).await?;
        attempts.push(Attempt { instances, sizes, status: status.clone() });
        match sizes_guess.take(&status) {
            Progress::Again => {}
            Progress::Wrong => return Ok(None),
            Progress::Known => break,
        }
    }
    let read = |instance| assemblies.iter().find(|assembly| assembly.instance == instance).and_then(|found| found.size);
    Ok(Some(Connectable {
        instances,
        output_size: sizes_guess.output.or_else(|| read(instances.output)),
        input_size: sizes_guess.input.or_else(|| read(instances.input)),
    }))
}

/// Known sizes of the two assemblies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct AssemblySizes {
    output: Option<u16>,
    input: Option<u16>,
    /// A size that the device reported without a direction, and the direction for which this size is tried first.
    unclear: Option<(u16, ProbedDirection)>,
    tries: u8,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ProbedDirection {
    Out,
    In,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Progress {
    /// The next request must be sent, with the next sizes.
    Again,
    /// The device reports that a connection with these instances is not possible.
    Wrong,
    /// The device has reported everything that it can report.
    Known,
}

impl AssemblySizes {
    /// Returns the sizes of the next request. At least one of them is [`IMPOSSIBLE_SIZE`], so that the device refuses the
    /// connection.
    fn next(&mut self) -> (u16, u16) {
        self.tries += 1;
        match self.unclear {
            Some((size, ProbedDirection::Out)) => (size.saturating_sub(O_T_EXTRA), IMPOSSIBLE_SIZE),
            Some((size, ProbedDirection::In)) => (IMPOSSIBLE_SIZE, size.saturating_sub(T_O_EXTRA)),
            None => (
                self.output.unwrap_or(IMPOSSIBLE_SIZE),
                if self.output.is_some() { IMPOSSIBLE_SIZE } else { self.input.unwrap_or(IMPOSSIBLE_SIZE) },
            ),
        }
    }

    fn take(&mut self, status: &Status) -> Progress {
        let (code, right) = match status.extended[..] {
            // Either the device accepts the connection, or another originator already has a connection with these
            // instances. In both cases the instances are correct.
            _ if status.is_ok() => return Progress::Known,
            [OWNED, ..] if status.general == 1 => return Progress::Known,
            [code @ (SIZES | O_T_SIZE | T_O_SIZE), ref more @ ..] if status.general == 1 => {
                (code, more.first().copied())
            }
            _ => return Progress::Wrong,
        };
        let Some(right) = right else { return Progress::Known };
        match (code, self.unclear) {
            (O_T_SIZE, _) => self.output = Some(right.saturating_sub(O_T_EXTRA)),
            (T_O_SIZE, _) => self.input = Some(right.saturating_sub(T_O_EXTRA)),
            (_, None) => self.unclear = Some((right, ProbedDirection::Out)),
            // The size was correct for the direction to the device. So the device now reports the size of the other
            // direction.
            (_, Some((size, ProbedDirection::Out))) if size != right => {
                self.output = Some(size.saturating_sub(O_T_EXTRA));
                self.input = Some(right.saturating_sub(T_O_EXTRA));
            }
            // The device reported the same size again. So this size belongs to the direction from the device.
            (_, Some((size, ProbedDirection::Out))) => self.unclear = Some((size, ProbedDirection::In)),
            (_, Some((size, ProbedDirection::In))) if size != right => {
                self.input = Some(size.saturating_sub(T_O_EXTRA));
                self.output = Some(right.saturating_sub(O_T_EXTRA));
            }
            // Both directions have the same size on the wire.
            (_, Some((size, ProbedDirection::In))) => {
                self.output = Some(size.saturating_sub(O_T_EXTRA));
                self.input = Some(size.saturating_sub(T_O_EXTRA));
            }
        }
        let is_known = self.output.is_some() && self.input.is_some();
        if is_known || self.tries >= MAX_TRIES_PER_PAIR { Progress::Known } else { Progress::Again }
    }
}

/// Maximum number of requests per pair of instances.
const MAX_TRIES_PER_PAIR: u8 = 5;

/// Requests a connection. If the device accepts the connection, closes it.
async fn open(
    client: &mut Client,
    instances: Instances,
    (output_size, input_size): (u16, u16),
) -> Result<Status, EipError> {
    let what = "ForwardOpen";
    let settings = Settings {
        output: instances.output,
        input: instances.input,
        configuration: instances.configuration,
        output_size,
        input_size,
        rpi: RPI,
        ..Settings::default()
    };
    let triad = Triad { serial: fastrand::u16(..), vendor: UNREGISTERED_VENDOR, originator: fastrand::u32(..) };
    let path = settings.path();
    let open = Open {
        o_t_id: 0,
        t_o_id: fastrand::u32(1..),
        triad,
        multiplier: 0,
        o_t: settings.o_t(),
        t_o: settings.t_o(),
        transport: 1,
        path: path.clone(),
    };
    let data = client.send(what, Command::SEND_RR_DATA, RrData::new(&open.emit()).emit()).await?;
    let answer = Answer::parse(what, &data)?;
    if answer.status.is_ok() {
        Opened::parse(&answer.data).map_err(|error| EipError::Malformed { what, error })?;
        let close = RrData::new(&Close { triad, path }.emit()).emit();
        client.send("ForwardClose", Command::SEND_RR_DATA, close).await?;
    }
    Ok(answer.status)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulates a device with 48 bytes of output and `input` bytes of input. The device checks the size of the
    /// direction `first` before the size of the other direction.
    fn sizes(first: ProbedDirection, input: u16, codes: (u16, u16)) -> (AssemblySizes, u8) {
        let mut sizes_guess = AssemblySizes::default();
        loop {
            let handle_discovery = sizes_guess.next();
            let out = (handle_discovery.0 != 48).then(|| Status::connection(codes.0, &[48 + O_T_EXTRA]));
            let back = (handle_discovery.1 != input).then(|| Status::connection(codes.1, &[input + T_O_EXTRA]));
            let status = if first == ProbedDirection::Out { out.or(back) } else { back.or(out) };
            let status = status.expect("a size is wrong, so that nothing is opened");
            if sizes_guess.take(&status) == Progress::Known {
                return (sizes_guess, sizes_guess.tries);
            }
        }
    }

    #[test]
    fn finds_sizes_for_both_orders_of_checks() {
        for first in [ProbedDirection::Out, ProbedDirection::In] {
            for codes in [(SIZES, SIZES), (O_T_SIZE, T_O_SIZE)] {
                // 52 bytes of input and 48 bytes of output have the same size on the wire.
                for input in [48, 52, 2, 400] {
                    let (sizes_guess, tries) = sizes(first, input, codes);
                    assert_eq!((sizes_guess.output, sizes_guess.input), (Some(48), Some(input)), "{first:?} {codes:?}");
                    assert!(tries <= 3);
                }
            }
        }
    }

    #[test]
    fn accepts_a_device_that_reports_no_size() {
        let mut sizes_guess = AssemblySizes::default();
        sizes_guess.next();
        assert_eq!(sizes_guess.take(&Status::connection(SIZES, &[])), Progress::Known);
        assert_eq!(sizes_guess.take(&Status::connection(OWNED, &[])), Progress::Known);
        assert_eq!(sizes_guess.take(&Status::connection(0x0117, &[])), Progress::Wrong);
        assert_eq!(sizes_guess.take(&Status::general(0x08)), Progress::Wrong);
    }

    #[test]
    fn limits_the_attempts_for_an_endless_error() {
        let mut sizes_guess = AssemblySizes::default();
        for size in 100.. {
            sizes_guess.next();
            if sizes_guess.take(&Status::connection(O_T_SIZE, &[size])) == Progress::Known {
                break;
            }
        }
        assert_eq!(sizes_guess.tries, MAX_TRIES_PER_PAIR);
    }

    #[test]
    fn tries_the_known_instances_first() {
        let thought = Instances { output: 150, input: 100, configuration: Some(7) };
        let found = [Assembly { instance: 20, size: Some(4) }, Assembly { instance: 30, size: None }];
        let all = likely(thought, &found);
        assert_eq!(all[0], thought);
        assert_eq!(all[1].configuration, Some(1));
        assert_eq!(all[6], Instances { output: 100, input: 150, ..thought });
        assert_eq!(all.len(), 4 * 6);
        assert!(all.contains(&Instances { output: 30, input: 20, configuration: None }));
        assert_eq!(thought.to_string(), "out 150, in 100, config 7");
    }
}
