//! Test support: returns the words that a command line sends, and runs commands on a scripted controller in virtual
//! time.

use std::collections::VecDeque;
use std::fmt::Debug;

use super::unit_argument::Unit;
use crate::face::FACE;
use crate::prelude::*;
use armctl_controller::yrcx::image::{COMMAND_WORDS, Words};
use armctl_controller::yrcx::table::Row;
use armctl_frame::gate::Grant;
use armctl_frame::output::{ColorChoice, Format};
use armctl_frame::testing;
use armctl_frame::testing::{context, planned};
use armctl_frame::{AnyCommand, Family as _, FamilyArguments};
use armctl_transport::image::ImagePeer;

/// The examples of the manual.
const EXAMPLES: &str = include_str!("../../tests/data/yrcx-examples.json");

/// All examples of the data file.
pub(super) fn entries() -> Vec<Value> {
    serde_json::from_str(EXAMPLES).unwrap()
}

fn entry(id: &str) -> Value {
    entries().into_iter().find(|example| example["id"] == id).unwrap_or_else(|| panic!("no example {id}"))
}

/// Returns WI0 to WI15 of an example of the manual, in the form that dry runs show.
#[track_caller]
pub(super) fn example(id: &str) -> Vec<String> {
    texts(corrected(&entry(id), "wi"))
}

/// WO0 to WO15 of an example of the manual.
#[track_caller]
pub(super) fn answer(id: &str) -> Words {
    numbers(corrected(&entry(id), "wo"))
}

/// Returns the words of an example, with the manual's misprints corrected.
fn corrected<'a>(entry: &'a Value, words: &str) -> &'a Value {
    entry.get(format!("{words}_corrected")).unwrap_or(&entry[words])
}

fn texts(words: &Value) -> Vec<String> {
    words.as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
}

fn numbers(texts: &Value) -> Words {
    let mut words = [0; COMMAND_WORDS];
    for (word, text) in words.iter_mut().zip(texts.as_array().unwrap()) {
        *word = u16::from_str_radix(text.as_str().unwrap().trim_start_matches("0x"), 16).unwrap();
    }
    words
}

/// Runs a command line with the answer of an example, and returns its report.
#[track_caller]
pub(super) fn read_example(id: &str, line: &[&str]) -> Value {
    let before = undefined(line);
    let count = before.len();
    let scripted = Scripted::new(before.into_iter().chain([Reply::AddressPair(1, answer(id))]));
    let (outcome, peer) = run_on(scripted, line);
    assert_eq!(peer.taken[count..], [numbers(corrected(&entry(id), "wi"))]);
    outcome.unwrap()
}

/// Returns the replies to the reads before an overwrite. They report that nothing is defined yet.
pub(super) fn undefined(line: &[&str]) -> Vec<Reply> {
    let mut refused = [0; COMMAND_WORDS];
    refused[..3].copy_from_slice(&[0x4000, 2, 904]);
    let count = if risk(line) == Risk::Destroy { words(line).unwrap().len() - written(line).unwrap().len() } else { 0 };
    let count = count + testing::count_before(&plan(line).unwrap());
    vec![Reply::AddressPair(0, refused); count]
}

/// Runs a command line that sends several commands, each with the answer of its example, and returns its report.
#[track_caller]
pub(super) fn read_in_turn(ids: &[&str], line: &[&str]) -> Value {
    let examples: Vec<Value> = ids.iter().map(|id| entry(id)).collect();
    let before = undefined(line);
    let count = before.len();
    let answers = examples.iter().map(|example| Reply::AddressPair(1, numbers(corrected(example, "wo"))));
    let (outcome, peer) = run_on(Scripted::new(before.into_iter().chain(answers)), line);
    let sent = examples.iter().map(|example| numbers(corrected(example, "wi")));
    assert_eq!(peer.taken[count..], sent.collect::<Vec<_>>());
    outcome.unwrap()
}

/// Error of the command-line parser.
pub(super) fn objection(words: &[&str]) -> String {
    testing::parse(&FACE, "sim:", words).err().expect("the parser objects").to_string()
}

/// Question before the command, without "This will".
pub(super) fn intent(words: &[&str]) -> String {
    own(words).complete(resolved(DRY, words).unwrap().1.intent(None)).text
}

/// Risk of the command.
pub(super) fn risk(words: &[&str]) -> Risk {
    resolved(DRY, words).unwrap().1.intent(None).risk
}

/// Data of a command that needs no robot.
pub(super) fn workspace(words: &[&str]) -> Value {
    let command = resolved(DRY, words).unwrap().1;
    command.without_robot(&quiet()).expect("no robot is wanted").unwrap().data().unwrap()
}

/// Returns WI0 to WI15 of each command that `armctl yrcx WORDS…` would send.
pub(super) fn words(words: &[&str]) -> Result<Vec<Vec<String>>> {
    Ok(frames(words)?.iter().map(|frame| &frame["wi"]).filter(|words| words.is_array()).map(texts).collect())
}

/// Returns WI0 to WI15 of each command that would change something.
pub(super) fn written(line: &[&str]) -> Result<Vec<Vec<String>>> {
    let code = |words: &Vec<String>| u16::from_str_radix(words[0].trim_start_matches("0x"), 16).unwrap();
    let is_written = |words: &Vec<String>| Row::from_word(code(words)).unwrap().risk > Risk::Read;
    Ok(words(line)?.into_iter().filter(is_written).collect())
}

/// Frames that `armctl yrcx WORDS…` would send.
pub(super) fn frames(words: &[&str]) -> Result<Vec<Value>> {
    Ok(testing::frames(&plan(words)?))
}

/// Report of a dry run.
pub(super) fn plan(words: &[&str]) -> Result<Value> {
    let (robot, command) = resolved(DRY, words)?;
    planned::<Yrcx>(&robot, &*command, |link| link.set_unit(unit(words)))
}

/// Returns the report of a dry run of a command line for this target.
pub(super) fn planned_line(target: &str, line: &str) -> Result<Value> {
    let words: Vec<&str> = line.split(' ').collect();
    let (robot, command) = resolved(target, &words)?;
    planned::<Yrcx>(&robot, &*command, |link| link.set_unit(unit(&words)))
}

/// Target for dry runs: a real controller.
const DRY: &str = "eip://127.0.0.1";

/// Runs a command line on a scripted controller. Returns its data and the controller.
pub(super) fn run_on(scripted: Scripted, line: &[&str]) -> (Result<Value>, Scripted) {
    let mut bench = Bench::new(scripted);
    let outcome = bench.run(line);
    (outcome, bench.into_peer())
}

/// Runs a command line whose report may be a failure. Returns its data, the failure and the controller.
pub(super) fn report_on(scripted: Scripted, line: &[&str]) -> (Value, Option<Failure>, Scripted) {
    let mut bench = Bench::new(scripted);
    let (data, failure) = bench.report(line).expect("a report");
    (data, failure, bench.into_peer())
}

/// Scripted controller with a link for several command lines, in virtual time.
pub(super) struct Bench {
    pub(super) runtime: tokio::runtime::Runtime,
    pub(super) robot: Robot,
    pub(super) link: Link,
    peer: SharedController,
}

/// Controller that the link and the test share.
type SharedController = Arc<std::sync::Mutex<Scripted>>;

#[derive(Debug)]
struct Handle(SharedController);

impl ImagePeer for Handle {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        self.0.lock().unwrap().input(now, image);
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.0.lock().unwrap().output(now)
    }

    fn wake(&self) -> Option<Duration> {
        self.0.lock().unwrap().wake()
    }
}

/// Controller on a fieldbus that supports only signals.
#[derive(Debug)]
struct SignalsOnly(Handle);

impl ImagePeer for SignalsOnly {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        let whole = image.map(|bytes| {
            assert_eq!(bytes.len(), Image::SIGNAL_BYTES);
            Image::from_link(bytes).unwrap().to_bytes()
        });
        self.0.input(now, whole.as_ref().map(|bytes| &bytes[..]));
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.0.output(now).map(|bytes| Image::from_link(&bytes).unwrap().to_link(Image::SIGNAL_BYTES))
    }

    fn wake(&self) -> Option<Duration> {
        self.0.wake()
    }
}

impl Bench {
    pub(super) fn new(scripted: Scripted) -> Self {
        Self::grant(scripted, Risk::Motion)
    }

    /// Creates a bench whose fieldbus supports only signals.
    pub(super) fn signals_alone(scripted: Scripted) -> Self {
        Self::bench_with(scripted, Risk::Motion, |handle| Box::new(SignalsOnly(handle)))
    }

    /// Creates a bench that grants commands up to this risk.
    pub(super) fn grant(scripted: Scripted, grant: Risk) -> Self {
        Self::bench_with(scripted, grant, |handle| Box::new(handle))
    }

    fn bench_with(scripted: Scripted, grant: Risk, end: impl FnOnce(Handle) -> Box<dyn ImagePeer>) -> Self {
        let runtime =
            tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build().expect("a runtime");
        let (robot, _) = resolved("sim:", &["status"]).expect("a robot");
        let peer = SharedController::new(scripted.into());
        let access = Access { grant: Grant::up_to(grant), ..Access::reading(ConnectMode::Control) };
        let screen = quiet();
        let opening = Link::to_peer(&robot, &access, &screen, end(Handle(SharedController::clone(&peer))));
        let link = runtime.block_on(opening).expect("a link");
        Self { runtime, robot, link, peer }
    }

    /// Runs `armctl yrcx WORDS…` and returns the data of its report. If the report contains a failure, returns this
    /// failure.
    pub(super) fn run(&mut self, words: &[&str]) -> Result<Value> {
        let (data, failure) = self.report(words)?;
        failure.map_or(Ok(data), Err)
    }

    /// Runs a command line, and returns the data of its report and the failure in it.
    pub(super) fn report(&mut self, words: &[&str]) -> Result<(Value, Option<Failure>)> {
        let (_, command) = resolved("sim:", words)?;
        let Self { runtime, robot, link, .. } = self;
        link.set_unit(unit(words));
        let report = runtime.block_on(testing::run::<Yrcx>(&*command, context(robot, link)))?;
        Ok((report.data()?, report.failure()))
    }

    /// Runs a command line for the time `after`, then drops it, as Ctrl-C does. The command line must still be running.
    pub(super) fn interrupt(&mut self, words: &[&str], after: Duration) {
        assert!(self.run_and_drop(words, after), "it still runs");
    }

    /// Runs a command line for the time `after`, then drops it. Returns whether it was still running.
    pub(super) fn run_and_drop(&mut self, words: &[&str], after: Duration) -> bool {
        let (_, command) = resolved("sim:", words).unwrap();
        let Self { runtime, robot, link, .. } = self;
        link.set_unit(unit(words));
        runtime.block_on(async {
            let run = testing::run::<Yrcx>(&*command, context(robot, link));
            tokio::time::timeout(after, run).await.is_err()
        })
    }

    /// Stops a motion, as Ctrl-C does.
    pub(super) fn halt(&mut self) -> Result<String> {
        self.runtime.block_on(Yrcx::halt(&mut self.link))
    }

    /// Gives the test direct access to the controller.
    pub(super) fn peer<T>(&mut self, look: impl FnOnce(&mut Scripted) -> T) -> T {
        look(&mut self.peer.lock().unwrap())
    }

    /// Closes the link and returns the controller.
    pub(super) fn into_peer(self) -> Scripted {
        self.runtime.block_on(Yrcx::close(self.link, &quiet())).expect("it closes");
        Arc::into_inner(self.peer).expect("the link is gone").into_inner().unwrap()
    }
}

/// Reaction of a scripted controller to a command.
#[derive(Debug, Clone)]
pub(super) enum Reply {
    /// Reports the status "running" for this number of scans, then ends with these words.
    AddressPair(u32, Words),
    /// Sends these words, one set per scan, then repeats the last set until the master clears the command (continuous
    /// output).
    Shows(Vec<Words>),
    /// Runs until the master switches the stop input off, then ends with these words.
    UntilStop(Words),
    /// Runs for this number of scans, then loses the link for this time.
    Loses(u32, Duration),
    /// Does not react to the command.
    Ignores,
}

/// Controller with a scan time of 5 ms. It reacts to each command with the next entry of its script, and confirms the
/// signals of procedures.
#[derive(Debug, Default)]
pub(super) struct Scripted {
    script: VecDeque<Reply>,
    /// Commands that the controller received.
    pub(super) taken: Vec<Words>,
    /// Words of dedicated signals in the received images, without consecutive duplicates.
    pub(super) bits: Vec<u16>,
    /// Last image from the master; `None` after the master has disconnected.
    shown: Option<Image>,
    /// Image that the controller sends to the master.
    pub(super) image: Image,
    current: Option<(Reply, u32)>,
    gone_until: Option<Duration>,
    scanned: Duration,
}

const SCAN: Duration = Duration::from_millis(5);

impl Scripted {
    pub(super) fn new(script: impl IntoIterator<Item = Reply>) -> Self {
        let mut image = Image::default();
        for signal in [output::CPU_OK, output::MP_READY, output::AUTO_MODE] {
            signal.set(&mut image, true);
        }
        Self { script: script.into_iter().collect(), image, ..Self::default() }
    }

    fn scan(&mut self) {
        use armctl_controller::yrcx::signal::input;

        let Some(master) = self.shown else { return };
        for (given, confirmed) in [
            (input::SERVO_ON, output::SERVO_ON),
            (input::AUTO_START, output::PROGRAM_RUNNING),
            (input::PROGRAM_RESET, output::PROGRAM_RESET),
        ] {
            if given.is_on(&master) {
                confirmed.set(&mut self.image, true);
            }
        }
        if !input::STOP.is_on(&master) {
            output::PROGRAM_RUNNING.set(&mut self.image, false);
        }
        let wi0 = master.0[0];
        match (&mut self.current, self.image.0[0], wi0) {
            (None, 0, 1..) => {
                self.taken.push(master.command());
                self.current = Some((self.script.pop_front().unwrap_or(Reply::Ignores), 0));
            }
            (None, 1.., 0) => self.image.set_command(&[0; COMMAND_WORDS]),
            _ => {}
        }
        let Some((reply, scans)) = &mut self.current else { return };
        *scans += 1;
        let mut running = [0; COMMAND_WORDS];
        running[0] = 0x0100;
        match reply {
            Reply::AddressPair(after, words) if *scans > *after => {
                let words = *words;
                self.image.set_command(&words);
                self.current = None;
            }
            Reply::Shows(_) if wi0 == 0 => {
                self.image.set_command(&[0; COMMAND_WORDS]);
                self.current = None;
            }
            Reply::Shows(all) => {
                let at = usize::try_from(*scans).expect("few scans").min(all.len());
                let words = all[at - 1];
                self.image.set_command(&words);
            }
            Reply::UntilStop(words) if !input::STOP.is_on(&master) => {
                let words = *words;
                self.image.set_command(&words);
                self.current = None;
            }
            Reply::Loses(after, time) if *scans > *after => {
                self.gone_until = Some(self.scanned + *time);
                self.shown = None;
                self.image.set_command(&[0; COMMAND_WORDS]);
                self.current = None;
            }
            Reply::Ignores => self.current = None,
            Reply::AddressPair(..) | Reply::UntilStop(_) | Reply::Loses(..) => self.image.set_command(&running),
        }
    }

    fn advance(&mut self, now: Duration) {
        while self.scanned + SCAN <= now {
            self.scanned += SCAN;
            if self.gone_until.is_none_or(|until| until <= self.scanned) {
                self.gone_until = None;
                self.scan();
            }
        }
    }
}

impl ImagePeer for Scripted {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        self.advance(now);
        self.shown = image.and_then(Image::from_bytes);
        let bits = self.shown.map(|image| image.0[COMMAND_WORDS]);
        self.bits.extend(bits.filter(|bits| self.bits.last() != Some(bits)));
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.advance(now);
        self.gone_until.is_none().then(|| self.image.to_bytes().to_vec())
    }

    fn wake(&self) -> Option<Duration> {
        Some(self.scanned + SCAN)
    }
}

/// Robot and command of a line.
pub(super) fn resolved(target: &str, words: &[&str]) -> Result<(Robot, Box<dyn AnyCommand>)> {
    testing::resolve(&FACE, target, words)
}

/// Returns the robot number that `--unit` selects.
fn unit(words: &[&str]) -> u8 {
    own(words).get().map_or(0, Unit::number)
}

/// Family arguments before the command.
fn own(words: &[&str]) -> FamilyArguments {
    match testing::parse(&FACE, DRY, words) {
        Ok((_, typed)) => typed.arguments,
        _ => FamilyArguments::default(),
    }
}

/// Screen without output.
pub(super) fn quiet() -> Screen {
    Screen::new(Format::Json, ColorChoice::Never, true, 0)
}
