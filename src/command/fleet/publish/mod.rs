//! `armctl publish`: publishes robot data to an MQTT broker when the data changes; with a list of brokers, to one of
//! them at a time. It only reads robots. Nothing from a broker reaches a robot.
//!
//! | file | contents |
//! |---|---|
//! | `broker` | addresses and credentials of the brokers |
//! | `topic` | names as topic levels |
//! | `announced` | retained topics of this node, for the next process |
//! | `message_format` | trait for a message format |
//! | `plain_format` | one topic per robot and kind, with envelopes |
//! | `sparkplug` | a Sparkplug B node whose devices are robots |
//! | `outbox` | queue of unsent messages in memory; no broker, no clock |
//! | `spool` | the same queue on disk |
//! | `delivery` | from poller to broker |
//! | `uplink` | the connection |
//! | `log` | log, and status for the service manager |
//! | `error_text` | texts of broker refusals |

mod announced;
mod broker;
mod delivery;
mod error_text;
mod log;
mod message_format;
mod outbox;
mod plain_format;
mod sparkplug;
mod spool;
#[cfg(test)]
mod tests;
pub(super) mod topic;
mod uplink;

use std::env;
use std::future::pending;
use std::io;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;

use clap::ValueEnum;
use futures_util::future::join;
use tokio::time::timeout;

use self::announced::AnnouncedTopics;
use self::broker::{Broker, Login, Url};
use self::delivery::{Backoff, Broker as _, Counts, Delivery, Listener as _};
use self::log::BrokerLog;
use self::message_format::MessageFormat;
use self::outbox::Outbox;
use self::plain_format::{Alarms, PlainFormat, Position, Times};
use self::sparkplug::{Names, Node};
use self::spool::{Spool, SyncPolicy};
use self::topic::{Levels, Template, Topics};
use crate::command::fleet::also::{AlsoArguments, AlsoCommand};
use crate::command::fleet::axes::Axes;
use crate::command::fleet::byte_size::size;
use crate::command::fleet::poll::{Event, Poll, PollCounter, PollRequest, RobotId};
use crate::command::fleet::service::{END_TIMEOUT, Service};
use armctl_files as files;
use armctl_frame::SchemaEntry;
use armctl_frame::face::sample::Detail;
use armctl_frame::interrupt::{catch_interrupts, interruptible};
use armctl_frame::local_names::state_folder;
use armctl_frame::output::log::Level;
use armctl_frame::prelude::*;
use armctl_frame::settings::duration;

/// Publish the data of robots to an MQTT broker when the data changes.
#[derive(Debug, Args)]
#[command(
    after_help = "Without -r, --tag, --sim or -t, armctl publishes all robots in the inventory. --watch INTERVAL sets \
                  how often armctl polls the robots (1s). The topics are PREFIX/ROBOT/status and so on, or as --topic says. Messages are \
                  retained, and their payload is the envelope of --json with the name of this publisher (`node`). \
                  PREFIX/NODE/state is online or offline. \
                  Messages from the broker cannot move a robot or change anything. publish runs until Ctrl-C or \
                  SIGTERM (exit code 0), and connects again after the broker was away. With --count N, publish ends \
                  after N polls of each robot, or with exit code 4 if there is no broker. See \
                  docs/monitoring/mqtt.md."
)]
pub struct Publish {
    // clap does not parse this value, because its error message would show the password of an invalid URL.
    #[arg(
        value_name = "URL",
        required = true,
        help = "mqtt://HOST[:1883], or mqtts://HOST[:8883] for TLS. With several URLs, armctl uses one broker at a time"
    )]
    brokers: Vec<String>,
    #[command(flatten)]
    login: Login,
    /// What to publish of each robot
    #[arg(long, value_name = "KIND", value_delimiter = ',', default_value = "status,alarms,position")]
    kinds: Vec<Kind>,
    #[command(flatten)]
    also: AlsoArguments,
    /// Longest time between two messages of a topic. After it, armctl sends the data even without a change
    #[arg(long, value_name = "TIME", default_value = "1m", value_parser = duration::parse_some)]
    every: Duration,
    /// First levels of all topics
    #[arg(long, value_name = "TOPIC", default_value = "armctl", value_parser = topic::prefix)]
    prefix: String,
    /// Topics of robots, with the place of a robot: '{site}/{area}/{line}/{robot}/{kind}'
    #[arg(long, value_name = "TEMPLATE", conflicts_with = "is_wanted")]
    topic: Option<Template>,
    /// Name of this publisher at the broker [default: the name of this computer]
    #[arg(long, value_name = "NAME")]
    node: Option<String>,
    #[command(flatten)]
    sparkplug: SparkplugArguments,
    #[command(flatten)]
    buffer: BufferArguments,
}

/// Sparkplug B instead of armctl's topics.
#[derive(Debug, Args)]
#[group(skip)]
struct SparkplugArguments {
    /// Publish as a Sparkplug B node, with the robots as its devices
    #[arg(long = "sparkplug", requires = "group", conflicts_with = "prefix", help_heading = "Sparkplug")]
    is_wanted: bool,
    /// Sparkplug group of this node
    #[arg(long, value_name = "GROUP", requires = "is_wanted", value_parser = topic::identifier, help_heading = "Sparkplug")]
    group: Option<String>,
    /// The primary host (repeatable); while all of these hosts are offline, armctl stores the data and sends it later
    /// as history
    #[arg(long, value_name = "ID", requires = "is_wanted", value_parser = topic::identifier, help_heading = "Sparkplug")]
    host: Vec<String>,
}

/// Buffer for messages while the broker is away.
#[derive(Debug, Args)]
#[group(skip)]
struct BufferArguments {
    /// Memory limit of the buffer
    #[arg(long = "buffer-memory", value_name = "SIZE", default_value = "16M", value_parser = memory_size, help_heading = "While the broker is not available")]
    memory: u64,
    /// Disk limit of the buffer. 0 means no disk
    #[arg(long = "buffer-disk", value_name = "SIZE", default_value = "256M", value_parser = disk_size, help_heading = "While the broker is not available")]
    disk: u64,
    /// Folder for the buffers on disk; each broker and node has its own folder in it [default: the state folder]
    #[arg(long = "buffer-dir", value_name = "PATH", help_heading = "While the broker is not available")]
    path: Option<PathBuf>,
    /// How often armctl flushes waiting messages to disk: a time, `always` (after each message), or `never` (use the
    /// disk only when the memory is full)
    #[arg(
        long = "buffer-sync",
        value_name = "TIME",
        default_value = "1s",
        help_heading = "While the broker is not available"
    )]
    sync: SyncPolicy,
}

/// Minimum size of a buffer in bytes, so that an envelope with a full position fits.
const MIN_SIZE: u64 = 64 << 10;
/// Minimum and default polling interval.
const MIN_INTERVAL: Duration = Duration::from_millis(50);
const DEFAULT_INTERVAL: Duration = Duration::from_secs(1);

fn memory_size(text: &str) -> Result<u64, String> {
    match size(text)? {
        bytes if bytes < MIN_SIZE => Err("the buffer needs at least 64K".to_owned()),
        bytes => Ok(bytes),
    }
}

fn disk_size(text: &str) -> Result<u64, String> {
    if size(text)? == 0 { Ok(0) } else { memory_size(text) }
}

/// Published data of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// State, as in `armctl status`
    Status,
    /// Alarms and errors
    Alarms,
    /// Position of the first robot in base coordinates
    Position,
    /// All axes and coordinates, with rotation and torque. This needs more requests to the robot
    Axes,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Status, Self::Alarms, Self::Position, Self::Axes];

    /// Last level of its topic.
    fn name(self) -> &'static str {
        match self {
            Self::Status => "status",
            Self::Alarms => "alarms",
            Self::Position => "position",
            Self::Axes => "axes",
        }
    }

    /// Command id of its envelope, which `armctl schema` accepts.
    fn id(self) -> &'static str {
        match self {
            Self::Status => "status",
            Self::Alarms => "publish.alarms",
            Self::Position => "publish.position",
            Self::Axes => "publish.axes",
        }
    }
}

/// Schemas of the published data and of the final report.
pub fn schemas() -> Vec<SchemaEntry> {
    vec![
        SchemaEntry::of::<Published>("publish"),
        SchemaEntry::of::<Alarms>("publish.alarms"),
        SchemaEntry::of::<Position>("publish.position"),
        SchemaEntry::of::<Axes>("publish.axes"),
    ]
}

/// Report of `publish` at its end.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct Published {
    /// URL of the broker; with several brokers, of the last connection or attempt.
    broker: String,
    /// Name of this publisher at the broker.
    node: String,
    /// Number of robots at the start.
    robots: usize,
    /// Messages that the broker acknowledged; with Sparkplug, the device data.
    published: u64,
    /// Messages that the broker refused.
    refused: u64,
    /// Messages that were dropped because the buffer was full.
    dropped: u64,
    /// Messages that were neither delivered nor stored at the end.
    undelivered: u64,
    /// Number of reconnections to the broker.
    reconnects: u64,
}

impl Report for Published {
    fn view(&self) -> View {
        let count = |count: u64| Cell::from(count).tone(if count == 0 { Tone::Plain } else { Tone::Warning });
        View::fields([
            ("broker", self.broker.as_str().into()),
            ("node", self.node.as_str().into()),
            ("robots", Cell::from(self.robots)),
            ("published", Cell::from(self.published)),
            ("refused", count(self.refused)),
            ("dropped", count(self.dropped)),
            ("undelivered", count(self.undelivered)),
            ("reconnects", Cell::from(self.reconnects)),
        ])
    }
}

impl Publish {
    /// Runs the command.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        let interval = run.repeat.every.unwrap_or(DEFAULT_INTERVAL);
        self.check_globals(run, interval)?;
        let also = self.also.commands(|name| name == "state" || Kind::ALL.iter().any(|kind| kind.name() == name))?;
        let urls = self.urls()?;
        let (brokers, warnings) = Broker::for_urls(&urls, &self.login)?;
        let node = topic::level(&self.node.clone().unwrap_or_else(this_machine))?;
        let mut poll = Poll::new(&run.sources, run.screen.silenced())?;
        let template = self.topic.clone().unwrap_or_default();
        let (prefix, levels) = (self.prefix.clone(), Levels::new(poll.robots()));
        let topics = Topics { prefix, node: node.clone(), template, levels };
        let check = |robot: &Robot| topics.topic_of(robot, Kind::Status.name());
        for robot in poll.robots() {
            check(robot)?;
        }
        let robots: Vec<RobotId> = poll.robots().iter().map(RobotId::for_robot).collect();
        let service = Service::begin(run.screen)?;
        let root = self.buffer_root()?;
        let folders = root.as_deref().map(|root| self.claim_folders(root, &urls, &node)).transpose()?;
        let outbox = self.outbox(folders.as_ref(), &node)?;
        let speech =
            self.create_format((topics.clone(), poll.robots()), &also, interval, (urls.len(), folders.as_ref()));
        let log = BrokerLog::new(&service, brokers[0].url());
        for warning in &warnings {
            log.log(Level::Warning, warning);
        }
        for folder in root.iter().flat_map(|root| spool::folders_without_broker(root)) {
            let what = "messages of an earlier version of armctl, which did not store their broker, so armctl does not \
                        send them; delete the folder";
            log.log(Level::Warning, &format!("{}: {what}", folder.display()));
        }
        for folder in folders.iter().flat_map(Folders::of_single_brokers).filter(|folder| spool::has_records(folder)) {
            let what = "messages that wait for this broker alone; to send them, publish to this broker alone";
            log.log(Level::Warning, &format!("{}: {what}", folder.display()));
        }
        catch_interrupts();
        let extras = also.iter().map(AlsoCommand::extra).collect();
        let detail = if self.kinds.contains(&Kind::Axes) { Detail::Axes } else { Detail::Summary };
        let mut events = poll.subscribe(PollRequest { detail, extras, ..PollRequest::every(interval) });
        let mut polled = Box::pin(poll.run());
        let pauses = Backoff::new(fastrand::u64(..));
        let mut pump = Delivery::new(&brokers, speech, outbox, (&log, pauses), run.repeat.count.is_some());
        let mut looks = PollCounter::new(&robots, run.repeat.count);
        // A broker that is temporarily away must not delay services that wait for this service.
        service.notify_ready(robots.len())?;
        let ended = {
            let found = async || {
                let event = looks.next(&mut events).await?;
                service.note(&event);
                if let Event::Appeared(robot) = &event
                    && let Err(failure) = check(robot)
                {
                    log.log(Level::Warning, &format!("{failure}; armctl does not publish this robot"));
                }
                Some(event)
            };
            let stop = async {
                let _asked = interruptible(pending::<()>()).await;
                service.notify_stopping();
            };
            tokio::select! {
                ended = pump.run(found, stop) => ended,
                () = &mut polled => Err(Failure::local("internal error: polling has ended")),
                () = service.watchdog_interval(|| log.status()) => Err(Failure::local("internal error: no more status")),
            }
        };
        drop(events);
        // If a run with --count found no broker, the failure is the only message.
        let has_failed = ended.is_err() && run.repeat.count.is_some();
        let (counts, _in_time) = join(pump.end(has_failed), timeout(END_TIMEOUT, polled)).await;
        ended?;
        let Counts { published, refused, dropped, reconnects, undelivered } = counts;
        let (broker, robots) = (log.url(), robots.len());
        run.local("publish", &Published { broker, node, robots, published, refused, dropped, undelivered, reconnects })
    }

    /// Rejects options that do not apply to this command.
    fn check_globals(&self, run: &Run, interval: Duration) -> Result<(), Failure> {
        let wrong = |what: &str, hint: &str| Err(Failure::usage(format!("publish {what}")).hint(hint));
        if run.filter.is_some() || run.repeat.until.is_some() {
            return wrong(
                "prints only a report at its end",
                "use `armctl status --until FILTER` to wait for a condition, also with --jq",
            );
        }
        if run.gate.dry_run {
            return wrong(
                "has no dry run: it sends only reads to robots",
                "use `armctl status --dry-run` to see some of the reads",
            );
        }
        if run.trace.is_some() {
            return wrong("does not record its traffic", "use --trace with `armctl status --watch`");
        }
        if run.screen.format.is_rows() {
            return wrong("prints no table", "remove the format, or use --json");
        }
        if interval < MIN_INTERVAL {
            return wrong("polls at most every 50ms", "use --watch 50ms or more");
        }
        if run.repeat.count.is_some() && !self.sparkplug.host.is_empty() {
            return wrong(
                "cannot have --count with --host, because --host waits without a limit",
                "remove --count or --host",
            );
        }
        Ok(())
    }

    /// Folder of all buffers on disk; `None` if no disk is used.
    fn buffer_root(&self) -> Result<Option<PathBuf>, Failure> {
        if self.buffer.disk == 0 {
            return Ok(None);
        }
        let root = self.buffer.path.clone().or_else(|| Some(service_state_folder()?.join("publish")));
        root.map(Some).ok_or_else(|| {
            Failure::usage("armctl found no folder for the buffer on disk")
                .hint("set a folder with --buffer-dir, or use no disk: --buffer-disk 0")
        })
    }

    /// URLs of the brokers. An error does not contain a URL, because a wrong one can include a password.
    fn urls(&self) -> Result<Vec<Url>, Failure> {
        let mut urls: Vec<Url> = Vec::with_capacity(self.brokers.len());
        for text in &self.brokers {
            let url: Url = text.parse().map_err(|why: String| {
                Failure::usage(format!("this is not a valid broker URL: {why}")).hint("example: mqtt://192.168.1.5")
            })?;
            if urls.iter().any(|known| known.key() == url.key()) {
                return Err(Failure::usage(format!("{url} is in the list twice")).hint("remove one of the two URLs"));
            }
            urls.push(url);
        }
        Ok(urls)
    }

    /// Creates and locks the folders of this node.
    fn claim_folders(&self, root: &Path, urls: &[Url], node: &str) -> Result<Folders, Failure> {
        let folder = |urls: &[Url]| root.join(spool::folder_name(urls, self.sparkplug.group.as_deref(), node));
        let brokers: Vec<PathBuf> = urls.iter().map(|url| folder(std::slice::from_ref(url))).collect();
        let spool = folder(urls);
        let claim =
            |broker: &PathBuf| spool::claim_folder(broker).map_err(|error| folder_failure(broker, node, &error));
        let locks: Result<_, Failure> = brokers.iter().filter(|broker| **broker != spool).map(claim).collect();
        Ok(Folders { _locks: locks?, spool, brokers })
    }

    fn outbox(&self, folders: Option<&Folders>, node: &str) -> Result<Outbox, Failure> {
        let memory = usize::try_from(self.buffer.memory).unwrap_or(usize::MAX);
        let Some(folders) = folders else { return Ok(Outbox::new(memory, None)) };
        let spool = Spool::open(&folders.spool, self.buffer.disk, self.buffer.sync)
            .map_err(|error| folder_failure(&folders.spool, node, &error))?;
        Ok(Outbox::new(memory, Some(spool)))
    }

    fn create_format(
        &self,
        (topics, robots): (Topics, &[Robot]),
        also: &Rc<[AlsoCommand]>,
        interval: Duration,
        (brokers, folders): (usize, Option<&Folders>),
    ) -> Box<dyn MessageFormat> {
        let every_ms = u64::try_from(self.every.as_millis()).unwrap_or(u64::MAX);
        let kinds: Vec<Kind> = Kind::ALL.into_iter().filter(|kind| self.kinds.contains(kind)).collect();
        match &self.sparkplug.group {
            None => {
                let times = Times { every_ms, expiry: plain_format::expiry(self.every, interval) };
                let file = |broker: usize| folders.map(|folders| folders.brokers[broker].join("topics"));
                let announced = (0..brokers).map(|broker| AnnouncedTopics::open(file(broker))).collect();
                Box::new(PlainFormat::new(topics, (&kinds, Rc::clone(also)), times, (announced, robots)))
            }
            Some(group) => {
                let (hosts, node, levels) = (self.sparkplug.host.clone(), topics.node, topics.levels);
                let names = Names { group: group.clone(), node, hosts, levels };
                let file = folders.map(|folders| folders.spool.join("bdseq"));
                let text = file.as_deref().and_then(|file| files::text(file, 16).ok());
                let bd_seq = text.and_then(|text| text.trim().parse().ok()).unwrap_or_default();
                let remember = Box::new(move |next: u8| {
                    if let Some(file) = &file {
                        // The new number needs only to differ from the last number. Without a file, the numbers start
                        // with 0.
                        let _kept = files::replace(file, next.to_string().as_bytes());
                    }
                });
                Box::new(Node::new(names, (&kinds, Rc::clone(also)), every_ms, (bd_seq, remember)))
            }
        }
    }
}

/// Folders of this node. Only this process uses them.
struct Folders {
    /// Messages for the list of brokers.
    spool: PathBuf,
    /// Data of each broker: another list that contains the broker has the same folder. With one broker, this is the
    /// folder of the messages.
    brokers: Vec<PathBuf>,
    _locks: Vec<files::FolderLock>,
}

impl Folders {
    /// Folders of the brokers of a list with several brokers.
    fn of_single_brokers(&self) -> impl Iterator<Item = &PathBuf> {
        self.brokers.iter().filter(|broker| **broker != self.spool)
    }
}

fn folder_failure(folder: &Path, node: &str, error: &io::Error) -> Failure {
    if spool::is_locked(error) {
        return Failure::usage(format!("{}: another armctl publishes as '{node}'", folder.display()))
            .hint("set a different name with --node, or a different folder with --buffer-dir");
    }
    Failure::io(folder.display(), error).hint("set another folder with --buffer-dir, or use no disk: --buffer-disk 0")
}

/// State folder of the service or of the user.
fn service_state_folder() -> Option<PathBuf> {
    let service_folder = env::var_os("STATE_DIRECTORY").filter(|folder| !folder.is_empty());
    service_folder.and_then(|folders| env::split_paths(&folders).next()).or_else(state_folder)
}

/// Host name.
#[cfg(unix)]
fn this_machine() -> String {
    rustix::system::uname().nodename().to_string_lossy().into_owned()
}

/// Host name.
#[cfg(not(unix))]
fn this_machine() -> String {
    env::var("COMPUTERNAME").unwrap_or_else(|_| "armctl".to_owned())
}
