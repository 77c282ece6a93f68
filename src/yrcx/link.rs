//! Controller connection of a command: the client with error conversion and trace, or only the explicit messaging
//! client.

mod board;
mod observer;

use std::sync::Mutex;

use derive_more::{Deref, DerefMut};

use self::observer::TrafficObserver;
pub use super::command_result::CommandResult;
use super::connect::{self, Endpoint, OpenBoard};
use super::failure::{failure, stopped};
use super::fieldbus::Fieldbus;
use super::trace::{Recorder, Trace};
use super::unit_argument::Unit;
use crate::prelude::basics::*;
use armctl_client::yrcx;
pub use armctl_client::yrcx::hex;
use armctl_client::yrcx::{Client, Error, Options, Refusal, Reply, Totals};
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::register::Register;
use armctl_controller::yrcx::table::Command;
use armctl_frame::dry_run::Plan;
use armctl_frame::face::sample::{Traffic, counter};
use armctl_frame::session_client::{attach, is_held};
use armctl_frame::settings::target;
use armctl_frame::trace::lock_writer;
use armctl_frame::{ConnectionEffect, Family};
use armctl_transport::image::{self, ImageLink};

/// The yrcx family.
#[derive(Debug)]
pub struct Yrcx;

/// Connection to one controller. It dereferences to the client, for operations that cannot fail or whose errors do not
/// need the robot's label.
#[derive(Debug, Deref, DerefMut)]
pub struct Link {
    #[deref]
    #[deref_mut]
    client: Client,
    /// Explicit messaging client, if this connection is only for explicit messages. If the device is simulated, also
    /// the simulator, which must live as long as the client.
    board: Option<OpenBoard>,
    trace: Arc<Mutex<Trace>>,
    /// Packet recorder, for `--trace` on a network.
    recorder: Option<Recorder>,
    pub(crate) label: String,
    /// Alarm that the controller raises when it loses the link.
    link_alarm: Alarm,
    is_simulated: bool,
    /// Robot that commands apply to, 1 to 4. With 0, commands apply to the first robot, or to all robots if the command
    /// supports this.
    unit: u8,
    /// Last image that a watch reported.
    pub last_reported: Option<Image>,
    /// Image that a watch received and has not reported yet.
    pub last_received: Option<Image>,
}

impl Family for Yrcx {
    const FAMILY: Option<target::Family> = Some(target::Family::Yrcx);
    type Link = Link;
    const STOP: &'static [&'static str] = &["stop"];

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link> {
        let endpoint = connect::endpoint(robot)?;
        let options = options(robot, &endpoint, &access);
        if access.dry_run {
            let opens_session = access.mode == ConnectMode::Control && robot.hold.value && !robot.read_only.value;
            let options = Options { is_held: options.is_held || opens_session || is_held(robot), ..options };
            return Link::new(robot, &access, screen, Client::dry_run(options), None);
        }
        if access.mode == ConnectMode::Explicit {
            let (board, recorder) = endpoint.board(robot, &access, screen).await?;
            let link = Link::new(robot, &access, screen, Client::without_link(options), recorder)?;
            return Ok(Link { board: Some(board), ..link });
        }
        let (client, recorder) = if let Some(attached) = Box::pin(attach(robot, &access, screen)).await? {
            let options = Options { commands: endpoint.is_owner(), ..options };
            (Client::over(ImageLink::in_session(attached), options), None)
        } else {
            let (image, recorder) = Box::pin(endpoint.open(robot, &access, screen)).await?;
            (Client::over(image, options), recorder)
        };
        Link::new(robot, &access, screen, client, recorder)?.ready(screen).await
    }

    async fn halt(link: &mut Link) -> Result<String> {
        link.client.stop().await.map(stopped).map_err(|error| link.failure(error))
    }

    fn needs_halt(link: &Link) -> bool {
        link.is_jogging()
    }

    fn planned(link: &mut Link) -> Plan {
        link.take_plan()
    }

    fn connection_effect(robot: &Robot, mode: ConnectMode) -> ConnectionEffect {
        let fieldbus = match connect::endpoint(robot) {
            Ok(Endpoint::Bus(bus, fieldbus)) if bus.is_owner && mode == ConnectMode::Control => fieldbus,
            _ => return ConnectionEffect::Harmless,
        };
        if is_held(robot) {
            ConnectionEffect::ThroughSession
        } else {
            ConnectionEffect::Stops(format!(
                "open the command connection and close it at the end; closing it stops the robot: motor power goes off \
                 with alarm {} (`armctl session open` keeps a connection open)",
                fieldbus.link_alarm
            ))
        }
    }

    fn end_effect(robot: &Robot) -> Option<String> {
        match connect::endpoint(robot) {
            Ok(Endpoint::Bus(bus, fieldbus)) if bus.is_owner => Some(end_effect(fieldbus.link_alarm)),
            _ => None,
        }
    }

    fn addresses(robot: &Robot) -> Result<Vec<target::Address>> {
        match connect::endpoint(robot)? {
            Endpoint::Bus(bus, Fieldbus { addresses: Some(addresses), .. }) => {
                addresses(bus).map_err(|error| not_open(&robot.label(), bus.scheme, &error))
            }
            Endpoint::Bus(..) | Endpoint::Sim(_) => Ok(Vec::new()),
        }
    }

    async fn close(link: Link, screen: &Screen) -> Result<()> {
        let Link { mut client, board, trace, recorder, label, link_alarm, is_simulated, .. } = link;
        if client.is_dry_run() {
            return Ok(());
        }
        let left = client.leave().await.map_err(|error| failure(&label, error));
        let ends_link = client.commands() && !is_simulated && !client.is_shared();
        if let Some((board, kept)) = board {
            board.close().await;
            // The simulator must live until the connection is closed.
            drop(kept);
        } else {
            print_statistics(&client, screen);
        }
        if let Err(error) = client.end().await {
            screen.detail(1, &format!("{label}: the connection was not closed properly: {error}"));
        }
        if ends_link {
            screen.note(&format!(
                "{label}: the connection is closed. {}. Use `armctl session open -r NAME` to keep a connection open",
                end_effect(link_alarm)
            ));
        }
        let recorded = lock_writer(&trace).finish().and(recorder.map_or(Ok(()), Recorder::finish));
        left.and(recorded)
    }
}

/// What the controller does at the end of a connection.
fn end_effect(link_alarm: Alarm) -> String {
    let lasting = Alarm::new(link_alarm.group, link_alarm.category + 1);
    format!(
        "The controller treats the close as a link fault: the controller stops and raises alarm {link_alarm} or \
         {lasting} (`armctl help safety`)"
    )
}

/// Client options for these settings.
fn options(robot: &Robot, endpoint: &Endpoint<'_>, access: &Access) -> Options {
    let commands = match endpoint {
        Endpoint::Bus(bus, _) => bus.is_owner && access.mode == ConnectMode::Control,
        Endpoint::Sim(_) => access.mode != ConnectMode::Explicit,
    };
    Options {
        commands,
        is_held: robot.target.value.is_simulated(),
        grant: access.grant.clone(),
        timeout: robot.timeout.value,
        retries: robot.retries.value,
    }
}

fn print_statistics(client: &Client, screen: &Screen) {
    let Totals { commands, waited, losses } = client.totals();
    screen.detail(1, &format!("{commands} remote commands, {waited:.1?} from start to end"));
    let Some(image::Traffic { sent, received, intervals, mut irregular }) = client.traffic() else { return };
    let every = intervals.map(|(to, from)| format!(" every {to:?} and {from:?}")).unwrap_or_default();
    screen.detail(1, &format!("{sent} images sent, {received} received{every}"));
    irregular.push((losses.into(), "losses of the link"));
    if let Some(text) = counter(&irregular) {
        screen.detail(1, &format!("link faults: {text}"));
    }
}

impl Link {
    /// Returns the traffic of this client's own connection; zeros for a client of a session, because the session counts
    /// the traffic.
    pub(super) fn traffic(&self) -> Traffic {
        let image::Traffic { sent, received, irregular, .. } = self.client.traffic().unwrap_or_default();
        let irregular: u64 = irregular.iter().map(|(count, _)| count).sum();
        Traffic { sent, received, disturbances: irregular + u64::from(self.client.totals().losses) }
    }

    /// Link to a peer in this process.
    #[cfg(test)]
    pub(super) async fn to_peer(
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        peer: Box<dyn image::ImagePeer>,
    ) -> Result<Self> {
        let options = options(robot, &connect::endpoint(robot)?, access);
        let client = Client::over(ImageLink::in_process(peer), options);
        Self::new(robot, access, screen, client, None)?.ready(screen).await
    }

    fn new(
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        mut client: Client,
        recorder: Option<Recorder>,
    ) -> Result<Self> {
        let is_simulated = robot.target.value.is_simulated();
        let trace = Trace::open(access, screen, !is_simulated && !client.is_shared())?;
        let trace = Arc::new(Mutex::new(trace));
        let label = robot.label();
        client.watch(TrafficObserver { trace: Arc::clone(&trace), screen: *screen, label: label.clone() });
        let link_alarm = connect::endpoint(robot)?.fieldbus().link_alarm;
        Ok(Self {
            client,
            board: None,
            trace,
            recorder,
            label,
            link_alarm,
            is_simulated,
            unit: access.own.get().map_or(0, Unit::number),
            last_reported: None,
            last_received: None,
        })
    }

    /// Waits until the controller has sent an image.
    async fn ready(mut self, screen: &Screen) -> Result<Self> {
        match self.client.ready().await {
            Ok(()) => Ok(self),
            Err(error) => {
                let failure = self.failure(error);
                // The missing image is reported, so an error from closing is ignored.
                let _ = Yrcx::close(self, &screen.silenced()).await;
                Err(failure)
            }
        }
    }

    /// Creates a draft of a remote command for the robot that `--unit` selects.
    pub fn draft(&self, command: Command) -> Result<Draft> {
        let row = command.row();
        match self.unit {
            0 => Ok(command.order()),
            unit if row.has_robot() => Ok(command.order().with(Key::Robot, i32::from(unit))),
            _ => self.reject_unit(&format!("{} applies to the whole controller", row.id)).map(|()| command.order()),
        }
    }

    /// Returns the robot that `--unit` selects; 0 without `--unit`.
    pub fn unit(&self) -> u8 {
        self.unit
    }

    /// Returns a usage error if the user gave `--unit`; `why` is the reason why the command does not use this argument.
    pub fn reject_unit(&self, why: &str) -> Result<()> {
        if self.unit == 0 {
            return Ok(());
        }
        Err(Failure::usage(format!("--unit is not possible here: {why}")).hint("remove --unit"))
    }

    /// Reserves the robot before a read, if the next command depends on the value read: [`Client::reserve`].
    pub async fn reserve(&mut self, order: &Order) -> Result<()> {
        self.client.reserve(order).await.map_err(|error| self.failure(error))
    }

    /// Executes a remote command; a refusal is a failure.
    pub async fn ask(&mut self, order: &Order) -> Result<CommandResult> {
        self.client.ask(order).await.map(CommandResult::from).map_err(|error| self.failure(error))
    }

    /// Executes a remote command; a refusal is a result.
    pub async fn try_ask(&mut self, order: &Order) -> Result<Result<yrcx::CompletedCommand, Refusal>> {
        self.client.try_ask(order).await.map_err(|error| self.failure(error))
    }

    /// Executes a remote command and returns the whole reply, including an error reply.
    pub async fn raw(&mut self, order: &Order) -> Result<Reply> {
        self.client.raw(order).await.map_err(|error| self.failure(error))
    }

    /// Executes a remote command until it has ended or runs independently: [`Client::begin`].
    pub async fn begin(&mut self, order: &Order) -> Result<Option<CommandResult>> {
        let begun = self.client.begin(order).await.map_err(|error| self.failure(error))?;
        Ok(begun.map(CommandResult::from))
    }

    /// Jogs: [`Client::jog`].
    pub async fn jog(&mut self, order: &Order, time: Option<Duration>) -> Result<CommandResult> {
        self.client.jog(order, time).await.map(CommandResult::from).map_err(|error| self.failure(error))
    }

    /// Next value of continuous output: [`Client::next_output`].
    pub async fn next_output(&mut self, order: &Order) -> Result<CommandResult> {
        self.client.next_output(order).await.map(CommandResult::from).map_err(|error| self.failure(error))
    }

    /// Executes a procedure on the dedicated signals, and returns its duration.
    pub async fn execute(&mut self, procedure: Procedure) -> Result<Duration> {
        self.reject_unit("signals belong to the whole controller")?;
        self.client.run_procedure(procedure).await.map_err(|error| self.failure(error))
    }

    /// Sets general-purpose words: [`Client::set_words`].
    pub async fn set_words(&mut self, changes: &[(Register, u32)]) -> Result<()> {
        self.reject_unit("words belong to the whole controller")?;
        self.client.set_words(changes).await.map_err(|error| self.failure(error))
    }

    /// Current image of the controller, for a command about its signals.
    pub async fn read_signals(&mut self) -> Result<Image> {
        self.reject_unit("signals belong to the whole controller")?;
        self.look().await
    }

    /// Current image of the controller.
    pub async fn look(&mut self) -> Result<Image> {
        self.client.input_image().await.map_err(|error| self.failure(error))
    }

    /// Waits for an image that matches, and returns it. A loss of the link is reported once.
    pub async fn wait_for_image(&mut self, matters: impl FnMut(&Image) -> bool) -> Result<Image> {
        self.client.wait_for_input(matters).await.map_err(|error| self.failure(error))
    }

    /// Checks the permission for this risk, as the last check before a frame is sent.
    pub fn authorize(&self, name: &str, risk: Risk) -> Result<()> {
        self.client.authorize(name, risk).map_err(|error| self.failure(error))
    }

    /// Alarm of the controller after loss of the link.
    pub fn link_alarm(&self) -> Alarm {
        self.link_alarm
    }

    /// Sets the robot that commands apply to.
    #[cfg(test)]
    pub(super) fn set_unit(&mut self, unit: u8) {
        self.unit = unit;
    }

    fn failure(&self, error: Error) -> Failure {
        failure(&self.label, error)
    }
}

#[cfg(test)]
mod tests;
