//! Link to a controller for a session.

use tokio::time::Instant;

use super::connect::endpoint;
use super::failure::failure;
use super::trace::Recorder;
use crate::prelude::*;
use armctl_client::yrcx;
use armctl_frame::face::HeldLink;
use armctl_transport::session::host::shared_link::SharedLink;

/// Opens the connection that the session keeps open.
pub async fn open_session_link(robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldLink> {
    let endpoint = endpoint(robot)?;
    let (link, recorder) = endpoint.open(robot, access, screen).await?;
    let held = yrcx::open_session_link(link, endpoint.is_owner(), Instant::now() + robot.timeout.value).await;
    let held = SharedLink::Images(held.map_err(|error| failure(&robot.label(), error))?);
    Ok(HeldLink { held, finish: recorder.map(|recorder| Box::new(|| Recorder::finish(recorder)) as Box<_>) })
}
