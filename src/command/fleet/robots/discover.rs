//! `armctl robots discover`: finds controllers on the network, and lists serial ports.

use clap::FromArgMatches as _;

use armctl_frame::prelude::*;
use armctl_toyo::ports::{self, Port};
use armctl_yrcx::buses::Searches;
use armctl_yrcx::discover::{self, FoundDevice};
use armctl_yrcx::fieldbus::Scope;

/// Searches for controllers with the EtherNet/IP request ListIdentity, and lists serial ports without opening them.
#[derive(Debug, Args)]
#[command(
    after_help = "A broadcast reaches only the network of its network card. Use --bind to select the card by its \
                  address, and --broadcast to select the network, such as 192.168.0.255. A yerc controller does not \
                  answer a broadcast: use `armctl robots check udp://ADDRESS`."
)]
pub struct Discover {
    #[command(flatten)]
    searches: Box<Searches>,
    /// Time to wait for answers
    #[arg(long, value_name = "TIME", default_value = "2500ms", value_parser = wait)]
    wait: Duration,
}

/// Longest wait.
const MAX_WAIT: Duration = Duration::from_secs(60);

fn wait(text: &str) -> Result<Duration, String> {
    match duration::parse_some(text)? {
        wait if wait <= MAX_WAIT => Ok(wait),
        _ => Err(format!("{} at most", duration::display(MAX_WAIT))),
    }
}

impl Discover {
    /// Default arguments.
    pub fn default_arguments() -> Result<Self> {
        let matches = Self::augment_args(clap::Command::new("discover")).get_matches_from(["discover"]);
        Self::from_arg_matches(&matches).map_err(|error| Failure::local(format!("internal error: {error}")))
    }

    pub(super) async fn run(self, run: &Run) -> Result<(), RunError> {
        if run.gate.dry_run {
            return Err(Failure::usage("discover has no dry run")
                .hint("run the command without --dry-run; discover only reads")
                .into());
        }
        run.local("robots.discover", &self.find(run).await?)
    }

    /// Runs the search.
    pub async fn find(self, run: &Run) -> Result<Discovered> {
        let access = Access { trace: run.trace.clone(), ..Access::reading(ConnectMode::Explicit) };
        run.begin_trace()?;
        let boards = discover::discover(&self.searches, self.wait, &access, &run.screen).await?;
        let has_ports = discover::scope(&self.searches) < Scope::Devices;
        let serial_ports = if has_ports { serial_ports(run) } else { Vec::new() };
        let nothing = if has_ports { NOTHING } else { "no answer" };
        Ok(Discovered { boards, serial_ports, nothing })
    }
}

fn serial_ports(run: &Run) -> Vec<Port> {
    ports::all().unwrap_or_else(|failure| {
        run.screen.note(&format!("warning: {failure}"));
        Vec::new()
    })
}

/// Found controllers and ports.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Discovered {
    /// Network boards that answered.
    boards: Vec<FoundDevice>,
    /// Serial ports of this computer; only for a search by broadcast.
    serial_ports: Vec<Port>,
    #[serde(skip)]
    nothing: &'static str,
}

impl Discovered {
    /// Targets that were found, with family, if known, and description.
    pub fn places(&self) -> Vec<(String, Option<&'static str>, String)> {
        let boards = self.boards.iter().map(|board| (board.target.clone(), board.family, board.device.clone()));
        let port = |port: &Port| (port.target().to_owned(), None, format!("serial port: {}", port.device()));
        boards.chain(self.serial_ports.iter().map(port)).collect()
    }
}

const NOTHING: &str = "no answer, and no serial port found. Connect this computer to the network of the robots, or \
                       set a network with --broadcast 192.168.0.255";

impl Report for Discovered {
    fn view(&self) -> View {
        let mut table = Table::new(&["family", "target", "device"], self.nothing);
        for (number, (target, family, device)) in self.places().into_iter().enumerate() {
            let is_port = number >= self.boards.len();
            let family = if is_port { "toyo?".into() } else { Cell::optional(family) };
            table.row([family, Cell::from(target).whole(), device.into()]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requires_no_argument() {
        assert_eq!(Discover::default_arguments().unwrap().wait, Duration::from_millis(2500));
    }

    #[test]
    fn limits_the_wait() {
        assert!(wait("2m").unwrap_err().contains("at most"));
        assert!(wait("0s").is_err());
    }
}
