//! Commands `yrcx profinet blink`, `set-name`, `set-ip` and `reset`, which set values by DCP.

use std::net::Ipv4Addr;

use super::board::Board;
use super::{frame_for, plan_search, station_of};
use crate::prelude::*;
use armctl_frame::settings::target::profinet;
use armctl_transport::profinet::commission::StationInfo;
use armctl_transport::profinet::wire::dcp::{Block, IpSuite, Station};

/// Warning: what a new name or address does if a controller is connected to the station.
const ENDS: &str = "If a controller is connected to the station, the connection may end, which stops the robot.";

/// Makes the light of the station blink for about three seconds, so that you can find the station in the cabinet.
#[derive(Debug, Args)]
pub struct Blink {}

/// Sets the station name (DCP Set). The station keeps the name after power-off, unless you give --temporary.
#[derive(Debug, Args)]
#[command(
    after_help = "A name can have lowercase letters, digits, - and dots, with up to 63 characters between dots. \
                  armctl rejects a name that another station has. The new target is profinet://NAME@eth0."
)]
pub struct SetName {
    /// New name, for example robot-7
    #[arg(value_name = "NAME", value_parser = profinet::name)]
    name: String,
    /// Keep the name only until the station is switched off
    #[arg(long)]
    temporary: bool,
}

/// Sets the IP address of the station (DCP Set). The station keeps the address after power-off, unless you give
/// --temporary.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl rejects an address that another device has (ARP check). A target with ip= sets the address \
                  at each connection and needs no set-ip."
)]
pub struct SetIp {
    /// New address with the mask length, for example 192.168.0.10/24
    #[arg(value_name = "ADDRESS/BITS", value_parser = suite)]
    address: IpSuite,
    /// Address of the router to other networks
    #[arg(long, value_name = "ADDRESS")]
    gateway: Option<Ipv4Addr>,
    /// Keep the address only until the station is switched off
    #[arg(long)]
    temporary: bool,
}

/// Deletes the name and the IP address of the station (DCP Reset to factory, communication parameters).
#[derive(Debug, Args)]
#[command(
    after_help = "The station then has no name: use its MAC address, such as profinet://02:00:00:00:00:01@eth0. Data \
                  and programs of the robot do not change."
)]
pub struct Reset {}

fn suite(text: &str) -> Result<IpSuite, String> {
    let short = || format!("the mask length is missing; for example, type {text}/24");
    text.contains('/').then_some(()).ok_or_else(short)?;
    profinet::suite(text).map_err(|why| why.trim_start_matches("ip: ").to_owned())
}

/// A value to set at the station.
struct Task<C: Fn(&StationInfo) -> Change> {
    id: &'static str,
    risk: Risk,
    /// Name of the frame in messages.
    what: &'static str,
    block: Block,
    change: C,
    /// Whether the station reports the new value.
    is_so: Box<dyn Fn(&Station) -> bool + Send>,
}

/// Runs `check`, asks the user to confirm what is overwritten, then sets the value. A dry run notes the frames.
async fn set<C: Fn(&StationInfo) -> Change>(
    context: Context<'_, Yrcx>,
    task: Task<C>,
    check: impl AsyncFnOnce(&Board, &StationInfo) -> Result<()>,
) -> Result<StationInfo> {
    let Context { robot, link, confirmer, .. } = context;
    link.reject_unit_of::<Board>()?;
    plan_search(link, robot).known()?;
    let hex = frame_for(&station_of(robot)?, &task.block);
    link.plan_frame(json!({ "hex": hex, "about": task.what }))?;
    let found = {
        let board: &Board = link.board()?;
        let found = board.station().await?;
        check(board, &found).await?;
        found
    };
    confirmer.confirm(&(task.change)(&found)).await?;
    link.authorize(task.id, task.risk)?;
    link.board::<Board>()?.set(&found, task.what, task.block, task.is_so).await
}

/// Returns the risk of setting a value: a permanent value overwrites the old value.
const fn risk(temporary: bool) -> Risk {
    if temporary { Risk::Write } else { Risk::Destroy }
}

const fn persistence_text(temporary: bool) -> &'static str {
    if temporary { " until the station is switched off" } else { "" }
}

impl Command for Blink {
    type Family = Yrcx;
    type Report = SetReport;
    const ID: &'static str = "yrcx.profinet.blink";
    const RISK: Risk = Risk::Write;
    const INTENT: &'static str = "make the light of the station blink";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<SetReport> {
        let task = Task {
            id: Self::ID,
            risk: self.risk(),
            what: "DCP Set signal",
            block: Block::signal(),
            change: |_: &StationInfo| Change::none(),
            is_so: Box::new(|_| true),
        };
        let found = set(context, task, async |_, _| Ok(())).await?;
        let words = format!("station {} blinks for about three seconds", found.mac);
        Ok(NewValue::of("blinking", true, words).with("mac", found.mac.to_string()).replaces(Old::UNREAD))
    }
}

impl Command for SetName {
    type Family = Yrcx;
    type Report = SetReport;
    const ID: &'static str = "yrcx.profinet.set-name";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    fn risk(&self) -> Risk {
        risk(self.temporary)
    }

    fn intent(&self) -> String {
        format!("set the station name to '{}'{}", self.name, persistence_text(self.temporary))
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<SetReport> {
        let change = |found: &StationInfo| {
            let old = &found.station.name;
            let change = Change::new(format!("overwrite the name of station {}", found.mac));
            if old.is_empty() { Change::none() } else { change.replaces("name", old, &self.name).note(ENDS) }
        };
        let name = self.name.clone();
        let task = Task {
            id: Self::ID,
            risk: self.risk(),
            what: "DCP Set name",
            block: Block::set_name(&self.name, !self.temporary),
            change,
            is_so: Box::new(move |said| said.name == name),
        };
        let found = set(context, task, async |board, found| match board.namesake(&self.name, found).await? {
            Some(other) => Err(in_use_failure(&format!("the name '{}'", self.name), &other)),
            None => Ok(()),
        });
        let found = found.await?;
        let words = format!("station {} has the name '{}'{}", found.mac, self.name, persistence_text(self.temporary));
        let new = NewValue::of("station_name", self.name.as_str(), words).with("mac", found.mac.to_string());
        Ok(new.with("temporary", self.temporary).replaces(Old::read(Some(found.station.name.as_str()))))
    }
}

impl Command for SetIp {
    type Family = Yrcx;
    type Report = SetReport;
    const ID: &'static str = "yrcx.profinet.set-ip";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    fn risk(&self) -> Risk {
        risk(self.temporary)
    }

    fn intent(&self) -> String {
        format!("set the station address to {}{}", self.address.address, persistence_text(self.temporary))
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<SetReport> {
        let address = self.address.address;
        let suite = IpSuite { gateway: self.gateway.unwrap_or(self.address.gateway), ..self.address };
        let change = |found: &StationInfo| match found.station.address() {
            None => Change::none(),
            Some(old) => Change::new(format!("overwrite the address of station {}", found.mac))
                .replaces("address", &old.to_string(), &address.to_string())
                .note(ENDS),
        };
        let task = Task {
            id: Self::ID,
            risk: self.risk(),
            what: "DCP Set IP",
            block: Block::set_ip(&suite, !self.temporary),
            change,
            is_so: Box::new(move |said| said.address() == Some(address)),
        };
        let screen = context.screen;
        let found = set(context, task, async |board, found| {
            if let Some(own) = board.interface()?.ip.filter(|own| !own.is_same_network(address)) {
                screen.note(&format!("warning: {address} is not in the network of {} of this computer", own.address));
            }
            match board.holder(address, found).await? {
                Some(other) => Err(in_use_failure(&format!("the address {address}"), &other)),
                None => Ok(()),
            }
        });
        let found = found.await?;
        let words = format!("station {} has the address {address}{}", found.mac, persistence_text(self.temporary));
        let old = found.station.address().map(|old| old.to_string());
        let new = NewValue::of("address", address.to_string(), words).with("mac", found.mac.to_string());
        Ok(new.with("temporary", self.temporary).replaces(Old::read(old)))
    }
}

/// Returns the failure for a name or address that another device has.
fn in_use_failure(what: &str, other: &str) -> Failure {
    Failure::new(Kind::ConditionNotMet, format!("{what} is in use by {other}"))
        .hint("use `armctl robots discover --interface IFACE` to list names and addresses; nothing was set")
}

impl Command for Reset {
    type Family = Yrcx;
    type Report = SetReport;
    const ID: &'static str = "yrcx.profinet.reset";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "delete the name and the address of the station";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<SetReport> {
        let change = |found: &StationInfo| {
            let (name, address) = (&found.station.name, found.station.address());
            let mut change = Change::new(format!("delete the settings of station {}", found.mac));
            if name.is_empty() && address.is_none() {
                return Change::none();
            }
            if !name.is_empty() {
                change = change.item(format!("name: {name}"));
            }
            if let Some(address) = address {
                change = change.item(format!("address: {address}"));
            }
            change.note(ENDS)
        };
        let task = Task {
            id: Self::ID,
            risk: self.risk(),
            what: "DCP Reset to factory",
            block: Block::reset(),
            change,
            is_so: Box::new(|said| said.name.is_empty()),
        };
        let found = set(context, task, async |_, _| Ok(())).await?;
        let words = format!("station {} has no name and no address", found.mac);
        let new = NewValue::of("station_name", "", words).with("mac", found.mac.to_string());
        Ok(new.replaces(Old::read(Some(found.station.name.as_str()))))
    }
}
