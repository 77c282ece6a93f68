//! Stored model of a controller. It is used for a day, and removed if the controller reports a different model.

use crate::prelude::basics::*;
use armctl_client::yerc::Client;
use armctl_frame::settings::model::{ModelCache, ReportedModel};
use armctl_frame::settings::target::Address;

/// The stored model, and where it is stored.
#[derive(Debug)]
pub(super) struct CachedModel {
    store: Option<ModelCache>,
    address: Address,
    stored: Option<ReportedModel>,
}

impl CachedModel {
    /// Gives the stored model to a client, if the user selects no model and the stored model is recent. A dry run does
    /// not ask the controller, so it also uses an older model.
    pub(super) fn recall(robot: &Robot, client: &mut Client) -> Self {
        let target = &robot.target.value;
        let address = target.address();
        let store = if target.is_simulated() { None } else { ModelCache::of_user() };
        let is_open = client.known_model().is_none();
        let stored = store.as_ref().filter(|_| is_open).and_then(|store| store.find(&address));
        if let Some(kept) = stored.as_ref().filter(|kept| kept.is_fresh() || client.is_dry_run()) {
            client.remember(kept.model());
        }
        Self { store, address, stored }
    }

    /// Stores the model that the controller reported, unless it is already stored and recent. `news` is `None` if the
    /// software of the controller belongs to no known model. In that case the stored model is wrong.
    pub(super) fn store_model(&mut self, news: Option<ReportedModel>, screen: &Screen, label: &str) {
        let Some(store) = &self.store else { return };
        let Some(news) = news else {
            if self.stored.take().is_some()
                && let Err(error) = store.forget(&self.address)
            {
                screen.detail(1, &format!("{label}: the stored model is wrong and could not be removed: {error}"));
            }
            return;
        };
        let is_same = |kept: &ReportedModel| kept.is_fresh() && kept.is_same_as(&news);
        if self.stored.as_ref().is_some_and(is_same) {
            return;
        }
        let (model, software) = (news.model(), news.software());
        let unverified = model.unproven().map(|what| format!("; unproven: {what}")).unwrap_or_default();
        screen.detail(1, &format!("{label}: {model}, from software {software}; stored for one day{unverified}"));
        if let Err(error) = store.store(&self.address, news.clone()) {
            screen.detail(
                1,
                &format!("{label}: the model could not be stored, so armctl reads it for each command: {error}"),
            );
        }
        self.stored = Some(news);
    }
}
