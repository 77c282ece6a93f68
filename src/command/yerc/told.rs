//! What a controller told of its model another time: taken for granted for a day, and dropped when it says something else.

use crate::client::yerc::Client;
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::model::{ToldModel, ToldModels};
use crate::settings::target::Address;

/// Where it is kept, and what is there.
#[derive(Debug)]
pub(super) struct Told {
    store: Option<ToldModels>,
    address: Address,
    kept: Option<ToldModel>,
}

impl Told {
    /// Tells a client what its controller was, where nobody names its model and that is not too long ago. A dry run, which
    /// asks nobody, takes an older word too.
    pub(super) fn recall(robot: &Robot, client: &mut Client) -> Self {
        let target = &robot.target.value;
        let address = target.address();
        let store = if target.is_simulated() { None } else { ToldModels::of_user() };
        let is_open = client.known_model().is_none();
        let kept = store.as_ref().filter(|_| is_open).and_then(|store| store.find(&address));
        if let Some(kept) = kept.as_ref().filter(|kept| kept.is_fresh() || client.is_dry()) {
            client.remember(kept.model());
        }
        Self { store, address, kept }
    }

    /// Keeps what the controller told now, unless that is kept and fresh. `news` is `None` where its software is that of no
    /// model: then what was kept is wrong.
    pub(super) fn keep(&mut self, news: Option<ToldModel>, screen: &Screen, label: &str) {
        let Some(store) = &self.store else { return };
        let Some(news) = news else {
            if self.kept.take().is_some()
                && let Err(error) = store.forget(&self.address)
            {
                screen.detail(
                    1,
                    &format!("{label}: the model that was kept is wrong, and could not be removed: {error}"),
                );
            }
            return;
        };
        let is_same = |kept: &ToldModel| kept.is_fresh() && kept.says(&news);
        if self.kept.as_ref().is_some_and(is_same) {
            return;
        }
        let (model, software) = (news.model(), news.software());
        let unproven = model.unproven().map(|what| format!("; unproven: {what}")).unwrap_or_default();
        screen.detail(1, &format!("{label}: {model}, by its software {software}; kept for a day{unproven}"));
        if let Err(error) = store.keep(&self.address, news.clone()) {
            screen.detail(1, &format!("{label}: its model could not be kept, and is asked each time: {error}"));
        }
        self.kept = Some(news);
    }
}
