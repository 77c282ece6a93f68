//! `yrcx devicenet probe`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::Identity;
use super::check::profile;
use super::{NO_UNIT, board_of};
use crate::link::Yrcx;
use armctl_frame::failure::{Failure, Kind};
use armctl_frame::output::view::{Cell, Section, View};
use armctl_frame::{Command, ConnectMode, Context, Report};

/// Reads the image sizes from the node; they show how the unit is set. Its connections are allocated for the request
/// and released; no polls are sent.
#[derive(Debug, Args)]
pub struct Probe {}

impl Command for Probe {
    type Family = Yrcx;
    type Report = Probed;
    const ID: &'static str = "yrcx.devicenet.probe";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Probed, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("messages that read the identity and the image sizes of the node");
        let board = board_of(context.link)?;
        let identity = match board.identity().await {
            Ok(identity) => Some(identity),
            Err(failure) if failure.kind == Kind::Refused => None,
            Err(failure) => return Err(failure),
        };
        let owned = identity.is_none();
        let sizes = if owned { (None, None) } else { board.sizes().await? };
        let profile = profile(sizes);
        Ok(Probed { identity, owned, in_size: sizes.0, out_size: sizes.1, profile })
    }
}

/// Result of the probe.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Probed {
    /// Null if another master owns the connections, because no other client can then read.
    identity: Option<Identity>,
    /// Whether another master owns the connections of the node.
    owned: bool,
    /// Bytes from the controller.
    in_size: Option<u16>,
    /// Bytes to the controller.
    out_size: Option<u16>,
    /// Meaning of the sizes.
    profile: Option<&'static str>,
}

impl Report for Probed {
    fn view(&self) -> View {
        let mut fields = self.identity.as_ref().map(Identity::fields).unwrap_or_default();
        let owner = if self.owned { "another master" } else { "free" };
        fields.push(("owner", owner.into()));
        fields.push(("from the controller", Cell::optional(self.in_size.map(|size| format!("{size} bytes")))));
        fields.push(("to the controller", Cell::optional(self.out_size.map(|size| format!("{size} bytes")))));
        fields.push(("I/O size", Cell::optional(self.profile)));
        View::default().append(Section::Fields(fields))
    }

    fn failure(&self) -> Option<Failure> {
        (!self.owned && self.profile.is_none()).then(|| {
            Failure::new(Kind::ConditionNotMet, "the image sizes are not those of a YRCX")
                .hint("set the I/O size of the controller to Normal (48 bytes) or Compact (4)")
        })
    }
}
