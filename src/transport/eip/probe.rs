//! Finds out which assemblies a device has, of which sizes, and which of them make a connection.
//!
//! A survey reads assemblies and asks for nothing else. A probe asks for connections as well, with sizes that no assembly
//! has, so that the device refuses them and says why: which instances it does not have, and which sizes are right. A device
//! that opens one all the same has this program as its master until it is told to close it: a probe may take command.

use std::fmt;
use std::time::Duration;

use super::client::Client;
use super::error::EipError;
use super::explicit::{Answer, Message};
use super::settings::Settings;
use super::wire::{Close, Command, Identity, Open, Opened, RrData, Status, Triad};
use super::{ASSEMBLY, UNREGISTERED_VENDOR};

/// Attributes of an assembly.
const DATA: u32 = 3;
const SIZE: u32 = 4;
/// Instances that are looked at: those of devices with 8-bit numbers.
pub const INSTANCES: std::ops::RangeInclusive<u32> = 1..=255;
/// Configurations that are tried, `None` for none at all.
const CONFIGURATIONS: [Option<u32>; 5] = [Some(1), Some(5), Some(151), Some(199), None];
/// Refusals.
const NO_SUCH_OBJECT: [u8; 2] = [0x05, 0x16];
const SIZES: u16 = 0x0109;
const O_T_SIZE: u16 = 0x0127;
const T_O_SIZE: u16 = 0x0128;
const OWNED: u16 = 0x0106;
/// The interval that is asked for; all devices have it.
const RPI: Duration = Duration::from_millis(100);
/// Bytes on the wire before the image to the device: count and header; and before the one from it.
const O_T_EXTRA: u16 = 6;
const T_O_EXTRA: u16 = 2;
/// A size that no assembly has.
const NEVER: u16 = 499;

/// An assembly that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Assembly {
    /// Its number.
    pub instance: u32,
    /// Its bytes, where the device tells.
    pub size: Option<u16>,
}

/// Instances that a connection may be made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instances {
    /// What the device takes.
    pub output: u32,
    /// What it sends.
    pub input: u32,
    /// Its configuration.
    pub configuration: Option<u32>,
}

impl fmt::Display for Instances {
    /// "out 150, in 100, config 1".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "out {}, in {}, ", self.output, self.input)?;
        match self.configuration {
            Some(configuration) => write!(f, "config {configuration}"),
            None => f.write_str("no config"),
        }
    }
}

/// A connection that was asked for, and how that went.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Attempt {
    /// Of which instances.
    pub instances: Instances,
    /// Bytes of the images: to the device, from it.
    pub sizes: (u16, u16),
    /// What the device said.
    pub status: Status,
}

/// What can be connected to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Connectable {
    /// Of which instances.
    pub instances: Instances,
    /// Bytes of the image to the device, where it tells.
    pub output_size: Option<u16>,
    /// Bytes of the image from the device, likewise.
    pub input_size: Option<u16>,
}

/// All that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Findings {
    /// Who the device is, if it says so.
    pub identity: Option<Identity>,
    /// The assemblies that can be read.
    pub assemblies: Vec<Assembly>,
    /// What was tried, in order.
    pub attempts: Vec<Attempt>,
    /// What can be connected to, if anything.
    pub connectable: Option<Connectable>,
}

/// Reads every assembly of [`INSTANCES`], one by one, and opens no connection. `thought` are instances that may be right,
/// the likeliest first; the first ones that can all be read are connectable.
///
/// # Errors
/// When the device does not answer, or answers nonsense. What it refuses is what is found.
pub async fn survey(client: &mut Client, thought: &[Instances]) -> Result<Findings, EipError> {
    let identity = match client.identity().await {
        Err(EipError::Encapsulation { .. }) => None,
        identity => identity?,
    };
    let mut assemblies = Vec::new();
    for instance in INSTANCES {
        if let Presence::Readable(assembly) = assembly(client, instance).await? {
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

/// A survey, then connections of likely instances, beginning with those that are thought to be right, until one would be
/// opened with the right sizes. A device that opens one in spite of its wrong sizes is commanded until that is closed.
///
/// # Errors
/// Likewise.
pub async fn probe(client: &mut Client, thought: Instances) -> Result<Findings, EipError> {
    let Findings { identity, assemblies, mut attempts, .. } = survey(client, &[]).await?;
    for instances in likely(thought, &assemblies) {
        if let Some(connectable) = attempt(client, instances, &assemblies, &mut attempts).await? {
            return Ok(Findings { identity, assemblies, attempts, connectable: Some(connectable) });
        }
    }
    Ok(Findings { identity, assemblies, attempts, connectable: None })
}

/// What reading tells of one assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// There is none of that number.
    Absent,
    /// The device tells neither its bytes nor its size.
    Unknown,
    /// It can be read, or its size can.
    Readable(Assembly),
}

/// Reads one assembly.
///
/// # Errors
/// Likewise.
pub async fn assembly(client: &mut Client, instance: u32) -> Result<Presence, EipError> {
    let what = "Get_Attribute_Single of an assembly";
    let answer = client.ask(what, &Message::get(ASSEMBLY, instance, DATA)).await?;
    if answer.status.is_ok() {
        return Ok(Presence::Readable(Assembly { instance, size: u16::try_from(answer.data.len()).ok() }));
    }
    if NO_SUCH_OBJECT.contains(&answer.status.general) {
        return Ok(Presence::Absent);
    }
    // It is there, and cannot be read; its size may be.
    let answer = client.ask(what, &Message::get(ASSEMBLY, instance, SIZE)).await?;
    let size = answer.data.first_chunk().filter(|_| answer.status.is_ok()).map(|bytes| u16::from_le_bytes(*bytes));
    // A device that refuses everything alike says nothing by it.
    Ok(size.map_or(Presence::Unknown, |size| Presence::Readable(Assembly { instance, size: Some(size) })))
}

/// Instances worth a try: those thought of, the same exchanged, then pairs that were found; each with likely
/// configurations.
fn likely(thought: Instances, assemblies: &[Assembly]) -> Vec<Instances> {
    let exchanged = (thought.input, thought.output);
    let mut pairs = vec![(thought.output, thought.input), exchanged];
    let found = assemblies.iter().filter(|assembly| assembly.size != Some(0)).map(|assembly| assembly.instance);
    let found: Vec<u32> = found.take(MOST_PAIRED).collect();
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

/// Most assemblies of which all pairs are tried.
const MOST_PAIRED: usize = 6;

/// Asks for a connection of these instances until its sizes are known, or the instances are wrong.
async fn attempt(
    client: &mut Client,
    instances: Instances,
    assemblies: &[Assembly],
    attempts: &mut Vec<Attempt>,
) -> Result<Option<Connectable>, EipError> {
    let mut guess = Guess::default();
    loop {
        let sizes = guess.next();
        let status = open(client, instances, sizes).await?;
        attempts.push(Attempt { instances, sizes, status: status.clone() });
        match guess.take(&status) {
            Progress::Again => {}
            Progress::Wrong => return Ok(None),
            Progress::Known => break,
        }
    }
    let read = |instance| assemblies.iter().find(|assembly| assembly.instance == instance).and_then(|found| found.size);
    Ok(Some(Connectable {
        instances,
        output_size: guess.output.or_else(|| read(instances.output)),
        input_size: guess.input.or_else(|| read(instances.input)),
    }))
}

/// What is known of two sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Guess {
    output: Option<u16>,
    input: Option<u16>,
    /// A size on the wire that the device named without saying for which way, as it is tried now.
    unclear: Option<(u16, Way)>,
    tries: u8,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Out,
    In,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Progress {
    /// Ask again, with the next sizes.
    Again,
    /// These instances make no connection.
    Wrong,
    /// All is known that the device tells.
    Known,
}

impl Guess {
    /// The sizes to ask for next. One of them is always wrong.
    fn next(&mut self) -> (u16, u16) {
        self.tries += 1;
        match self.unclear {
            Some((size, Way::Out)) => (size.saturating_sub(O_T_EXTRA), NEVER),
            Some((size, Way::In)) => (NEVER, size.saturating_sub(T_O_EXTRA)),
            None => {
                (self.output.unwrap_or(NEVER), if self.output.is_some() { NEVER } else { self.input.unwrap_or(NEVER) })
            }
        }
    }

    fn take(&mut self, status: &Status) -> Progress {
        let (code, right) = match status.extended[..] {
            // Opened, or somebody else has it open: there is nothing wrong with the instances.
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
            (_, None) => self.unclear = Some((right, Way::Out)),
            // The size fitted the way to the device, and now the other way is named.
            (_, Some((size, Way::Out))) if size != right => {
                self.output = Some(size.saturating_sub(O_T_EXTRA));
                self.input = Some(right.saturating_sub(T_O_EXTRA));
            }
            // It did not fit: it is named again. So it was for the other way.
            (_, Some((size, Way::Out))) => self.unclear = Some((size, Way::In)),
            (_, Some((size, Way::In))) if size != right => {
                self.input = Some(size.saturating_sub(T_O_EXTRA));
                self.output = Some(right.saturating_sub(O_T_EXTRA));
            }
            // Both ways have the same size on the wire.
            (_, Some((size, Way::In))) => {
                self.output = Some(size.saturating_sub(O_T_EXTRA));
                self.input = Some(size.saturating_sub(T_O_EXTRA));
            }
        }
        let is_known = self.output.is_some() && self.input.is_some();
        if is_known || self.tries >= MOST_TRIES { Progress::Known } else { Progress::Again }
    }
}

/// Most requests for one pair of instances.
const MOST_TRIES: u8 = 5;

/// Asks for a connection; one that is opened is closed.
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

    /// Plays a device with 48 bytes to it and `input` from it, which looks at one way first.
    fn sizes(first: Way, input: u16, codes: (u16, u16)) -> (Guess, u8) {
        let mut guess = Guess::default();
        loop {
            let asked = guess.next();
            let out = (asked.0 != 48).then(|| Status::connection(codes.0, &[48 + O_T_EXTRA]));
            let back = (asked.1 != input).then(|| Status::connection(codes.1, &[input + T_O_EXTRA]));
            let status = if first == Way::Out { out.or(back) } else { back.or(out) };
            let status = status.expect("a size is wrong, so that nothing is opened");
            if guess.take(&status) == Progress::Known {
                return (guess, guess.tries);
            }
        }
    }

    #[test]
    fn sizes_are_found_whichever_way_a_device_looks_at_first() {
        for first in [Way::Out, Way::In] {
            for codes in [(SIZES, SIZES), (O_T_SIZE, T_O_SIZE)] {
                // 52 bytes back are as many on the wire as 48 there.
                for input in [48, 52, 2, 400] {
                    let (guess, tries) = sizes(first, input, codes);
                    assert_eq!((guess.output, guess.input), (Some(48), Some(input)), "{first:?} {codes:?}");
                    assert!(tries <= 3);
                }
            }
        }
    }

    #[test]
    fn a_device_that_names_no_size_is_taken_at_its_word() {
        let mut guess = Guess::default();
        guess.next();
        assert_eq!(guess.take(&Status::connection(SIZES, &[])), Progress::Known);
        assert_eq!(guess.take(&Status::connection(OWNED, &[])), Progress::Known);
        assert_eq!(guess.take(&Status::connection(0x0117, &[])), Progress::Wrong);
        assert_eq!(guess.take(&Status::general(0x08)), Progress::Wrong);
    }

    #[test]
    fn a_device_that_never_has_enough_is_asked_a_few_times_only() {
        let mut guess = Guess::default();
        for size in 100.. {
            guess.next();
            if guess.take(&Status::connection(O_T_SIZE, &[size])) == Progress::Known {
                break;
            }
        }
        assert_eq!(guess.tries, MOST_TRIES);
    }

    #[test]
    fn what_was_thought_is_tried_first_and_the_exchange_next() {
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
