//! `armctl serve metrics`: exporter for Prometheus and compatible readers.
//!
//! | file | contents |
//! |---|---|
//! | `catalogue` | the metrics |
//! | `board` | data of the robots |
//! | `page` | text in both exposition formats |
//! | `page_cache` | pages that several scrapers share |

mod board;
mod catalogue;
mod page;
mod page_cache;
#[cfg(test)]
mod tests;

use std::cell::RefCell;
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::{Duration, SystemTime};

use tokio::time::timeout;

use self::board::Board;
use self::page::Form;
use self::page_cache::PageCache;
use super::also::{AlsoArguments, AlsoCommand};
use super::poll::{Poll, PollRequest, Subscription};
use super::service::{END_TIMEOUT, Service};
use armctl_frame::face::sample::Detail;
use armctl_frame::failure::plain;
use armctl_frame::interrupt::{catch_interrupts, interruptible};
use armctl_frame::output::log::Level;
use armctl_frame::prelude::*;
use armctl_transport::http::{Answer, Request, Server, Status};

/// Serves metrics of all robots, or of the selected ones, until Ctrl-C or SIGTERM.
#[derive(Debug, Args)]
#[command(
    after_help = "GET /metrics answers with OpenMetrics, or with the older Prometheus text format if the client \
                  requests this format. GET /healthz answers while armctl runs. --watch INTERVAL sets how often \
                  armctl polls the robots (1s). Without -r, --tag, --sim or -t, armctl polls all robots in the \
                  inventory, and follows changes of the inventory. The command cannot move a robot or change \
                  anything. There is no password: every client that reaches the port can read."
)]
pub struct Metrics {
    /// Address to listen on
    #[arg(long, alias = "bind", value_name = "ADDRESS", default_value_t = DEFAULT_ADDRESS, value_parser = address)]
    listen: SocketAddr,
    #[command(flatten)]
    also: AlsoArguments,
}

/// Default address. The port is one of the usual exporter ports.
const DEFAULT_ADDRESS: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 9464);
/// Default and minimum polling interval.
const DEFAULT_INTERVAL: Duration = Duration::from_secs(1);
const MIN_INTERVAL: Duration = Duration::from_millis(50);

/// Address of the metrics server.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Listening {
    /// URL of the metrics.
    url: String,
    /// Number of robots at the start.
    robots: usize,
    /// Polling interval.
    every_ms: u64,
}

impl Report for Listening {
    fn view(&self) -> View {
        let plural = if self.robots == 1 { "" } else { "s" };
        View::text(format!("metrics of {} robot{plural} at {}", self.robots, self.url))
    }
}

impl Metrics {
    /// Runs the command.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        let every = run.repeat.every.unwrap_or(DEFAULT_INTERVAL);
        check_globals(run, every)?;
        let also = self.also.commands(|_| false)?;
        let service = Service::begin(run.screen)?;
        // Links do not print their own messages; the service reports changes.
        let mut poll = Poll::new(&run.sources, run.screen.silenced())?;
        let robots = poll.robots().len();
        let server = Server::bind(self.listen).await.map_err(|error| bind_failure(self.listen, &error))?;
        let local = server.local().map_err(|error| Failure::io("listen", &error))?;
        catch_interrupts();
        let listening = Listening {
            url: format!("http://{local}/metrics"),
            robots,
            every_ms: u64::try_from(every.as_millis()).unwrap_or(u64::MAX),
        };
        run.local("serve.metrics", &listening)?;
        self.warn(&service);
        let extras = also.iter().map(AlsoCommand::extra).collect();
        let mut events = poll.subscribe(PollRequest { detail: Detail::Axes, extras, ..PollRequest::every(every) });
        let mut polled = Box::pin(poll.run());
        let board = RefCell::new(Board { also, ..Board::default() });
        let pages = PageCache::new(&board);
        service.notify_ready(robots)?;
        let ended = interruptible(async {
            tokio::select! {
                () = &mut polled => Err(Failure::local("internal error: polling has ended")),
                () = listen(&mut events, &service, &board) => Err(Failure::local("internal error: no more updates")),
                ended = server.run(|request| answer(request, &pages)) => {
                    ended.map_err(|error| Failure::io("metrics", &error))
                }
                () = service.watchdog_interval(|| service.robots()) => Ok(()),
            }
        })
        .await;
        service.notify_stopping();
        drop(events);
        let _in_time = timeout(END_TIMEOUT, polled).await;
        match ended {
            Ok(ended) => Ok(ended?),
            // Ctrl-C or SIGTERM is the normal end of a server.
            Err(_) => Ok(()),
        }
    }

    /// Warns if the address is reachable from the network.
    fn warn(&self, service: &Service) {
        if !self.listen.ip().is_loopback() {
            let text = "everyone on the network can read the positions and alarms of these robots; there is no \
                        password";
            service.log_line(Level::Warning, text, &[("listen", &self.listen.to_string())]);
        }
    }
}

/// Applies the events of the poller.
async fn listen(events: &mut Subscription, service: &Service, board: &RefCell<Board>) {
    while let Some(event) = events.next().await {
        service.note(&event);
        board.borrow_mut().record_event(&event, now());
    }
}

/// Seconds since 1970.
fn now() -> f64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_secs_f64()
}

fn answer(request: &Request<'_>, pages: &PageCache<'_>) -> Answer {
    match request.path {
        "/metrics" => {
            let form = Form::preferred_form(request.accept);
            Answer { status: Status::Ok, kind: form.content_type(), body: pages.body(form) }
        }
        "/healthz" => Answer::text(Status::Ok, "ok"),
        _ => Answer::text(Status::NotFound, "the paths are /metrics and /healthz"),
    }
}

/// Rejects options that do not apply to this command.
fn check_globals(run: &Run, every: Duration) -> Result<(), Failure> {
    let invalid = |what: &str, hint: &str| Err(Failure::usage(format!("serve metrics {what}")).hint(hint));
    if run.repeat.count.is_some() || run.repeat.until.is_some() {
        return invalid("runs until Ctrl-C or SIGTERM", "use `armctl status --until FILTER` to wait for a condition");
    }
    if run.trace.is_some() {
        return invalid("does not record its traffic", "use --trace with `armctl status --watch`");
    }
    if every < MIN_INTERVAL {
        return invalid("polls at most every 50ms", "use --watch 50ms or more");
    }
    Ok(())
}

/// Parses an address with or without a port.
fn address(text: &str) -> Result<SocketAddr, String> {
    let address =
        text.parse().or_else(|_| text.parse::<IpAddr>().map(|ip| SocketAddr::new(ip, DEFAULT_ADDRESS.port())));
    address.map_err(|_| format!("'{text}' is not a valid address, such as {DEFAULT_ADDRESS}"))
}

fn bind_failure(on: SocketAddr, error: &io::Error) -> Failure {
    let hint = match error.kind() {
        io::ErrorKind::AddrInUse => "set another port with --listen 127.0.0.1:9465: another program uses this port",
        io::ErrorKind::PermissionDenied => "set a higher port with --listen: ports below 1024 need special rights",
        _ => "set an address of this computer with --listen",
    };
    Failure::new(Kind::NoAnswer, format!("cannot listen on {on}: {}", plain(error))).hint(hint)
}
