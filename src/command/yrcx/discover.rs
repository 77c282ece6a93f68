//! Who answers on the fieldbuses, for `armctl robots discover`.

use std::time::Duration;

use futures_util::future::LocalBoxFuture;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use serde_json::{Map, Value};

use super::buses::{self, Searches};
use super::trace::Recorder;
use crate::command::Access;
use crate::failure::Failure;
use crate::output::Screen;
use crate::transport::image::tap::Tap;

/// How one fieldbus is searched, as the command line wants it.
pub trait Search {
    /// What is to be searched.
    fn scope(&self) -> Scope;

    /// Asks who is there until `wait` is over.
    fn search(&self, wait: Duration, tap: Tap) -> LocalBoxFuture<'_, Result<Vec<Found>, Failure>>;
}

/// What is to be searched of a fieldbus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scope {
    /// Nothing, as it has to be told where.
    Nothing,
    /// What is usual. That it cannot be asked is only a warning.
    Usual,
    /// A network or an adapter that was named.
    Network,
    /// Certain devices, and nothing else.
    Devices,
}

/// A device that answered. What it says of itself is untrusted.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Found {
    /// Where the answer came from.
    pub address: String,
    /// The URL for `-t`.
    pub target: String,
    /// The family that it may be of, by the number of its maker; null for makers of other things.
    pub family: Option<&'static str>,
    /// What it says of itself, in the words of its fieldbus.
    #[serde(flatten)]
    #[schemars(schema_with = "identities")]
    identity: Map<String, Value>,
    /// The same in a line.
    #[serde(skip)]
    pub device: String,
}

impl Found {
    /// What answered, where, whether it is one of the family, and what it says of itself: in a line, and as data.
    pub fn new(
        address: String,
        target: String,
        is_yrcx: bool,
        device: String,
        identity: &impl Serialize,
    ) -> Result<Self, Failure> {
        let identity = serde_json::to_value(identity).map_err(|error| Failure::local(error.to_string()))?;
        let Value::Object(identity) = identity else { return Err(Failure::local("an identity has no fields")) };
        Ok(Self { address, target, family: is_yrcx.then_some("yrcx"), identity, device })
    }
}

/// What devices of each fieldbus say of themselves.
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

/// Searches them, one after the other.
pub async fn discover(
    searches: &Searches,
    wait: Duration,
    access: &Access,
    screen: &Screen,
) -> Result<Vec<Found>, Failure> {
    let narrowest = scope(searches);
    let mut all = Vec::new();
    for (fieldbus, search) in searches.each() {
        let scope = search.scope();
        let is_wanted = scope != Scope::Nothing && (narrowest != Scope::Devices || scope == Scope::Devices);
        if !is_wanted {
            continue;
        }
        let (recorder, tap) = Recorder::start(access, screen, fieldbus.link_type())?.unzip();
        let found = search.search(wait, tap.unwrap_or_default()).await;
        recorder.map_or(Ok(()), Recorder::finish)?;
        match found {
            Ok(found) => all.extend(found),
            // A machine without a network still has ports.
            Err(failure) if scope == Scope::Usual => screen.note(&format!("warning: {failure}")),
            Err(failure) => return Err(failure),
        }
    }
    Ok(all)
}

/// The narrowest of what is wanted.
pub fn scope(searches: &Searches) -> Scope {
    searches.each().into_iter().map(|(_, search)| search.scope()).max().unwrap_or(Scope::Nothing)
}
