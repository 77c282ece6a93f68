//! Fieldbus devices for `armctl robots discover`.

use schemars::{Schema, SchemaGenerator};
use serde_json::Map;

use super::buses::{self, Searches};
use super::fieldbus::{Device, Scope};
use super::trace::Recorder;
use crate::prelude::*;

/// A device that answered. Do not trust its identity.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FoundDevice {
    /// Address of the device.
    address: String,
    /// URL for `-t`.
    pub target: String,
    /// Robot family that the vendor id belongs to; null for other vendors.
    pub family: Option<&'static str>,
    /// Identity of the device, in the form that its fieldbus defines.
    #[serde(flatten)]
    #[schemars(schema_with = "identities")]
    identity: Map<String, Value>,
    /// Identity of the device in one line.
    #[serde(skip)]
    pub device: String,
}

impl From<Device> for FoundDevice {
    fn from(found: Device) -> Self {
        let Device { address, target, is_yrcx, device, identity } = found;
        Self { address, target, family: is_yrcx.then_some("yrcx"), identity, device }
    }
}

/// Schema of the identities of all fieldbuses.
fn identities(generator: &mut SchemaGenerator) -> Schema {
    let mut all = buses::identities(generator);
    if all.len() == 1
        && let Some(only) = all.pop()
    {
        return only;
    }
    let all: Vec<Value> = all.into_iter().map(Value::from).collect();
    schemars::json_schema!({ "anyOf": all })
}

/// Searches the fieldbuses one after the other.
pub async fn discover(
    searches: &Searches,
    wait: Duration,
    access: &Access,
    screen: &Screen,
) -> Result<Vec<FoundDevice>> {
    let narrowest = scope(searches);
    let mut all = Vec::new();
    for (fieldbus, search) in searches.each() {
        let scope = search.scope();
        let is_wanted = scope != Scope::Nothing && (narrowest != Scope::Devices || scope == Scope::Devices);
        if !is_wanted {
            continue;
        }
        let (recorder, tap) = Recorder::start(access, screen, fieldbus.link_type)?.unzip();
        let found = search.search(wait, tap.unwrap_or_default()).await;
        recorder.map_or(Ok(()), Recorder::finish)?;
        match found {
            Ok(found) => all.extend(found.into_iter().map(FoundDevice::from)),
            // A computer without a network may still have serial ports, so the search continues.
            Err(failure) if scope == Scope::Usual => screen.note(&format!("warning: {failure}")),
            Err(failure) => return Err(failure),
        }
    }
    Ok(all)
}

/// Returns the narrowest scope of all searches.
pub fn scope(searches: &Searches) -> Scope {
    searches.each().into_iter().map(|(_, search)| search.scope()).max().unwrap_or(Scope::Nothing)
}
