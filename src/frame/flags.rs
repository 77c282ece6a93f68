//! Flags of every command.

use crate::ValueKind;
use crate::gate::OnInterrupt;
use crate::output::{ColorChoice, Format};
use crate::prelude::basics::*;
use crate::settings::target::TargetArgument;
use armctl_controller::text::Encoding;

/// Flags of every command. They can be at any place of the command line.
#[derive(Debug, Clone, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent flag")]
pub struct Globals {
    /// Use the built-in simulator
    #[arg(long, global = true, help_heading = "Which robot", conflicts_with_all = ["target", "robot", "all", "tag"])]
    pub sim: bool,
    /// Controller: a URL, for example udp://192.168.1.31, or only an address or serial port, for example 192.168.1.31,
    /// COM3 or /dev/ttyUSB0 (ARMCTL_TARGET)
    #[arg(short, long, global = true, value_name = "URL", add = ValueKind::Url, help_heading = "Which robot", conflicts_with_all = ["robot", "all", "tag"])]
    pub target: Option<TargetArgument>,
    /// Robots in the inventory: names or patterns, separated by commas (ARMCTL_ROBOT)
    #[arg(short, long, global = true, value_name = "NAME", value_delimiter = ',', add = ValueKind::Robot, help_heading = "Which robot")]
    pub robot: Vec<String>,
    /// All robots in the inventory
    #[arg(long, global = true, hide_short_help = true, help_heading = "Which robot")]
    pub all: bool,
    /// Robots in the inventory with this tag (repeatable)
    #[arg(long, global = true, hide_short_help = true, value_name = "TAG", add = ValueKind::Tag, help_heading = "Which robot")]
    pub tag: Vec<String>,
    /// Inventory file, instead of robots.toml in the configuration folder (ARMCTL_CONFIG)
    #[arg(long, global = true, hide_short_help = true, value_name = "FILE", help_heading = "Which robot")]
    pub config: Option<PathBuf>,

    /// Output format (ARMCTL_OUTPUT)
    #[arg(
        short = 'o',
        long = "output",
        alias = "format",
        global = true,
        hide_short_help = true,
        value_name = "FORMAT",
        help_heading = "Output"
    )]
    pub format: Option<Format>,
    /// Print JSON (the same as -o json)
    #[arg(long, global = true, help_heading = "Output", conflicts_with = "format", overrides_with = "json")]
    pub json: bool,
    /// Print the result of a jq filter that is applied to the JSON output
    #[arg(
        long,
        global = true,
        hide_short_help = true,
        allow_hyphen_values = true,
        value_name = "FILTER",
        help_heading = "Output"
    )]
    pub jq: Option<String>,
    /// Ask no questions; fail if a question is necessary
    #[arg(long, global = true, hide_short_help = true, help_heading = "Safety")]
    pub no_input: bool,
    /// Print only errors and questions on stderr
    #[arg(short, long, global = true, hide_short_help = true, help_heading = "Output", conflicts_with = "verbose")]
    pub quiet: bool,
    /// Increase verbosity: -v prints a summary, -vv prints frames, -vvv prints bytes
    #[arg(short, long, global = true, hide_short_help = true, action = clap::ArgAction::Count, help_heading = "Output")]
    pub verbose: u8,
    /// When to use color
    #[arg(
        long,
        global = true,
        hide_short_help = true,
        value_name = "WHEN",
        default_value = "auto",
        help_heading = "Output"
    )]
    pub color: ColorChoice,
    /// No color (the same as --color never)
    #[arg(long, global = true, hide_short_help = true, help_heading = "Output", conflicts_with = "color")]
    pub no_color: bool,
    /// Print long texts without the pager (PAGER)
    #[arg(long, global = true, hide_short_help = true, help_heading = "Output")]
    pub no_pager: bool,
    /// Record the traffic in a .pcapng file for Wireshark, or with - as text on stderr
    #[arg(long, global = true, hide_short_help = true, value_name = "FILE", help_heading = "Output")]
    pub trace: Option<PathBuf>,

    /// Confirm commands that move, delete or overwrite
    #[arg(long, global = true, help_heading = "Safety")]
    pub yes: bool,
    /// Send nothing; print what armctl would send
    #[arg(long, global = true, help_heading = "Safety")]
    pub dry_run: bool,
    /// Effect of Ctrl-C during a motion
    #[arg(
        long,
        global = true,
        hide_short_help = true,
        value_name = "WHAT",
        default_value = "stop",
        help_heading = "Safety"
    )]
    pub on_interrupt: OnInterrupt,

    /// Time limit of each try [default: 3s, for toyo 1.5s] (ARMCTL_TIMEOUT)
    #[arg(long, global = true, hide_short_help = true, value_name = "TIME", value_parser = duration::parse_some, help_heading = "Link")]
    pub timeout: Option<Duration>,
    /// Retries of a read without an answer. A read takes at most N + 1 times the --timeout. A change is never retried
    /// [default: 3] (ARMCTL_RETRIES)
    #[arg(long, global = true, hide_short_help = true, value_name = "N", help_heading = "Link")]
    pub retries: Option<u32>,
    /// Encoding of names and texts on the controller (ARMCTL_ENCODING)
    #[arg(long, global = true, hide_short_help = true, value_name = "NAME", help_heading = "Link")]
    pub encoding: Option<Encoding>,
    /// Connect to the robot directly, even if a session is open
    #[arg(long, global = true, hide_short_help = true, help_heading = "Link")]
    pub no_session: bool,

    /// Repeat a read, every second or every INTERVAL
    #[arg(long, global = true, hide_short_help = true, value_name = "INTERVAL", num_args = 0..=1, default_missing_value = "1s", value_parser = duration::parse_some, help_heading = "Repeat")]
    pub watch: Option<Duration>,
    /// Stop after N reports
    #[arg(long, global = true, hide_short_help = true, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), help_heading = "Repeat")]
    pub count: Option<u64>,
    /// Repeat a read until this condition is met: a state, for example idle, or NAME=VALUE, or a jq filter over the
    /// JSON output
    #[arg(long, global = true, hide_short_help = true, value_name = "CONDITION", help_heading = "Repeat")]
    pub until: Option<String>,
    /// Read once, and exit with code 8 unless this condition is met: a state, for example idle, or NAME=VALUE, or a jq
    /// filter over the JSON output
    #[arg(long, global = true, hide_short_help = true, value_name = "CONDITION", conflicts_with_all = ["watch", "count", "until"], help_heading = "Repeat")]
    pub check: Option<String>,
    /// Longest time that --until waits. After it, the exit code is 8
    #[arg(long = "for", global = true, hide_short_help = true, value_name = "TIME", value_parser = duration::parse, requires = "until", help_heading = "Repeat")]
    pub within: Option<Duration>,
}

impl Globals {
    /// Output settings.
    pub fn screen(&self) -> Screen {
        let format = match self.format {
            Some(format) => format,
            None if self.json || self.jq.is_some() => Format::Json,
            None => Format::Table,
        };
        let is_filtered = self.jq.is_some() && !self.json && self.format.is_none();
        Screen::new(format, self.color(), self.quiet, self.verbose)
            .with_plain_errors(is_filtered)
            .with_questions(!self.no_input)
    }

    /// Returns the flags of one line, completed with the flags for all lines. If the line has a flag for the robot, the
    /// format or the verbosity, this flag replaces all flags of the same group.
    #[must_use]
    pub fn within(self, all: &Self) -> Self {
        let names_robot = self.names_robot();
        let says_how_much = self.quiet || self.verbose > 0;
        let (robot, format, how_much) = (
            if names_robot { self.clone() } else { all.clone() },
            if self.says_format() { self.clone() } else { all.clone() },
            if says_how_much { &self } else { all },
        );
        let (quiet, verbose) = (how_much.quiet, how_much.verbose);
        Self {
            sim: robot.sim,
            target: robot.target,
            robot: robot.robot,
            all: robot.all,
            tag: robot.tag,
            config: self.config.or_else(|| all.config.clone()),
            format: format.format,
            json: format.json,
            jq: format.jq,
            quiet,
            verbose,
            no_color: self.no_color || (all.no_color && self.color == ColorChoice::Auto),
            color: if self.color == ColorChoice::Auto { all.color } else { self.color },
            no_pager: self.no_pager || all.no_pager,
            trace: self.trace.or_else(|| all.trace.clone()),
            no_input: self.no_input || all.no_input,
            yes: self.yes || all.yes,
            dry_run: self.dry_run || all.dry_run,
            on_interrupt: if self.on_interrupt == OnInterrupt::Stop { all.on_interrupt } else { self.on_interrupt },
            timeout: self.timeout.or(all.timeout),
            retries: self.retries.or(all.retries),
            encoding: self.encoding.or(all.encoding),
            no_session: self.no_session || all.no_session,
            watch: self.watch,
            count: self.count,
            until: self.until,
            check: self.check,
            within: self.within,
        }
    }

    /// Whether a flag selects robots.
    pub fn names_robot(&self) -> bool {
        self.sim || self.target.is_some() || !self.robot.is_empty() || self.all || !self.tag.is_empty()
    }

    /// Returns the flags without the robot. For commands about the inventory.
    #[must_use]
    pub fn without_robot(self) -> Self {
        Self { sim: false, target: None, robot: Vec::new(), all: false, tag: Vec::new(), ..self }
    }

    /// When to use color.
    pub fn color(&self) -> ColorChoice {
        if self.no_color { ColorChoice::Never } else { self.color }
    }

    /// Whether a flag sets the output format.
    pub fn says_format(&self) -> bool {
        self.format.is_some() || self.json || self.jq.is_some()
    }

    /// Returns the robot flags as words of a command line.
    pub fn robot_words(&self) -> Vec<String> {
        let flag_words = |flag: &str, value: String| vec![flag.to_owned(), value];
        let mut words = Vec::new();
        words.extend(self.sim.then(|| "--sim".to_owned()));
        words.extend(self.all.then(|| "--all".to_owned()));
        words.extend(self.target.iter().flat_map(|target| flag_words("--target", target.to_string())));
        words.extend(self.robot.iter().flat_map(|robot| flag_words("--robot", robot.clone())));
        words.extend(self.tag.iter().flat_map(|tag| flag_words("--tag", tag.clone())));
        words.extend(self.config.iter().flat_map(|path| flag_words("--config", path.display().to_string())));
        words
    }
}
