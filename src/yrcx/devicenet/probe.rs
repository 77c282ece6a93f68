//! `yrcx devicenet probe`.

use super::board::{Board, Identity};
use super::check::profile;
use crate::board_report::BoardReport;
use crate::prelude::*;

/// Image sizes of the node; they show which setting the fieldbus unit has. Its connections are allocated for the
/// request and released; no polls are sent.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProbeReport {
    /// Identity of the node. Null if another master owns the connections, because other clients then cannot read it.
    identity: Option<Identity>,
    /// Whether another master owns the connections of the node.
    owned: bool,
    /// Number of bytes from the controller.
    in_size: Option<u16>,
    /// Number of bytes to the controller.
    out_size: Option<u16>,
    /// Setting of the fieldbus unit that has these sizes.
    profile: Option<&'static str>,
}

impl BoardReport for ProbeReport {
    type Board = Board;
    const ID: &'static str = "yrcx.devicenet.probe";
    const MESSAGES: &'static str = "messages that read the identity and the image sizes of the node";

    async fn read(board: &mut Board) -> Result<Self> {
        let identity = match board.identity().await {
            Ok(identity) => Some(identity),
            Err(failure) if failure.kind == Kind::Refused => None,
            Err(failure) => return Err(failure),
        };
        let owned = identity.is_none();
        let sizes = if owned { (None, None) } else { board.sizes().await? };
        let profile = profile(sizes);
        Ok(Self { identity, owned, in_size: sizes.0, out_size: sizes.1, profile })
    }
}

impl Report for ProbeReport {
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
