//! Checks of `armctl robots check` that are specific to the controller.

use super::overview::left_over;
use crate::prelude::*;
use armctl_controller::yerc::payload::StatusBit;
use armctl_controller::yerc::query::{ReadStatus, ReadSystemInfo, SystemPart};
use armctl_frame::Family as _;
use armctl_frame::face::layers::{Layer, Layers};
use armctl_frame::session_client::is_held;
use armctl_frame::settings::names::CacheFile;

const LAYERS: &[&str] = &["name", "answer", "software", "model", "mode", "command remote", "hold", "alarm", "servo"];

/// Checks the layers. It only reads.
pub async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>> {
    let mut layers = Layers::new(robot.label(), LAYERS);
    match Yerc::connect(robot, access, screen).await {
        Err(failure) => layers.fail("name", &failure),
        Ok(mut link) => {
            layers.ok("name", robot.target.value.to_string());
            look(robot, &mut link, &mut layers).await;
            Yerc::close(link, screen).await?;
        }
    }
    Ok(layers.finish())
}

async fn look(robot: &Robot, link: &mut Link, layers: &mut Layers) {
    let status = match link.ask(&ReadStatus).await {
        Ok(status) => status,
        Err(failure) => return layers.fail("answer", &failure),
    };
    layers.ok("answer", "the controller answers a status request");
    match software(link).await {
        Ok(version) => layers.ok("software", version),
        Err(failure) => layers.warn("software", failure.message, failure.hint.unwrap_or_default()),
    }
    model(robot, link, layers);
    names(robot, link, layers);
    let is_teach = status.has(StatusBit::Teach);
    layers.judge(
        "mode",
        !is_teach,
        ("play", "teach"),
        "turn the mode key of the pendant to PLAY: motion and job start need play mode",
    );
    layers.judge(
        "command remote",
        status.has(StatusBit::CommandRemote),
        ("on", "off"),
        "turn the mode key to REMOTE, and switch CMD REMOTE (#82015) on: the controller refuses changes",
    );
    layers.judge(
        "hold",
        !status.held(),
        ("none", "the robot is held"),
        "use `yerc status` to see the source; use `yerc hold off` to release a hold by command",
    );
    if status.alarm() || status.error() {
        let what = if status.alarm() { "an alarm is present" } else { "an error is present" };
        layers.fail_with("alarm", what, "see `yerc alarm list`, then reset with `yerc alarm reset`");
    } else {
        layers.ok("alarm", "none");
    }
    layers.leftover_drafts(&left_over(status));
    // Servo power without motion may come from an earlier client. It is not a fault.
    let is_idle = !status.running() && !status.held() && !is_held(robot);
    let on = if is_idle {
        "on, but no job is running and no session is open; use `yerc servo off` to switch servo power off"
    } else {
        "on"
    };
    layers.judge("servo", status.servo_on(), (on, "off"), "use `yerc servo on`: a motion needs servo power");
}

/// Checks the model, and reports where armctl has the model from: the settings, the software version, or an earlier
/// connection.
fn model(robot: &Robot, link: &Link, layers: &mut Layers) {
    const NAME: &str = "set the model: ?model=fs100, dx100, dx200 or yrc1000 in the URL, or `armctl robots set NAME \
                        model=…`";

    let by_software = link.identity().and_then(|identity| identity.model);
    let in_words = |model: Model, by: &str| {
        let unproven = model.unproven().map(|what| format!("; unproven: {what}")).unwrap_or_default();
        format!("{model}, {by}{unproven}")
    };
    match (robot.model.value.named(), by_software) {
        (Some(named), Some(told)) if named != told => layers.warn(
            "model",
            format!("set to {named}, but the software is for a {told}"),
            "remove the model, so that armctl reads it from the controller, or set the right model",
        ),
        (Some(named), _) => layers.ok("model", in_words(named, "as named")),
        (None, Some(told)) => layers.ok("model", in_words(told, "read from the software")),
        (None, None) => match link.known_model() {
            Some(known) => layers.ok("model", in_words(known, "from an earlier connection")),
            None => layers.warn("model", "the controller reports no known model", NAME),
        },
    }
}

/// Checks whether the stored names belong to this controller.
fn names(robot: &Robot, link: &Link, layers: &mut Layers) {
    let Some(Ok(Some(kept))) = robot.names.cache_file().map(CacheFile::read) else { return };
    match link.reported_software().map_or(Ok(()), |software| kept.check(&software)) {
        Ok(()) => layers.ok("names", format!("{} stored, read on {}", kept.count(), kept.read_at.strftime("%Y-%m-%d"))),
        Err(failure) => layers.warn("names", failure.message, failure.hint.unwrap_or_default()),
    }
}

/// Reads the version of the system software and the name of the system.
pub(super) async fn software(link: &mut Link) -> Result<String> {
    let question = link.by_model(|model| ReadSystemInfo::new(model, SystemPart::Group(Group::R1))).await?;
    let encoding = link.encoding;
    let info = link.ask(&question).await?;
    let (version, name) = (encoding.decode(info.version.as_bytes()), encoding.decode(info.name.as_bytes()));
    Ok(format!("{version}, {name}"))
}
