//! A station of PROFINET, as it answers questions that connect nobody.

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::{check, connect};
use crate::command::face::layers::Layers;
use crate::command::yrcx::fieldbus::{self, At};
use crate::command::yrcx::link_error::not_open;
use crate::controller::yrcx::image::Image;
use crate::failure::Failure;
use crate::settings::target::profinet::{Profinet, SCHEME};
use crate::transport::image::LinkError;
use crate::transport::image::tap::Tap;
use crate::transport::profinet::commission::{self, Found, Identity};
use crate::transport::profinet::error::ProfinetError;
use crate::transport::profinet::interface::Interface;

/// A station that is asked when something is asked.
#[derive(Debug)]
pub struct Board {
    profinet: Profinet,
    label: String,
    tap: Tap,
}

impl Board {
    /// The station of a URL.
    pub fn new(at: &At<'_>) -> Result<Self, LinkError> {
        Ok(Self { profinet: connect::options(at)?.clone(), label: at.robot.label(), tap: at.tap.clone() })
    }

    /// What its URL says.
    pub const fn settings(&self) -> &Profinet {
        &self.profinet
    }

    /// The interface that leads to it, and records what passes.
    pub fn interface(&self) -> Result<Interface, Failure> {
        let mut interface = Interface::find(&self.profinet.interface).map_err(|error| self.failure(error))?;
        interface.tap = self.tap.clone();
        Ok(interface)
    }

    /// Asks through the interface, which may take its time.
    pub async fn ask<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Interface) -> Result<T, ProfinetError> + Send + 'static,
    ) -> Result<T, Failure> {
        let interface = self.interface()?;
        match tokio::task::spawn_blocking(move || question(&interface)).await {
            Ok(answer) => answer.map_err(|error| self.failure(error)),
            Err(error) => Err(Failure::local(error.to_string())),
        }
    }

    /// The station.
    pub async fn station(&self) -> Result<Found, Failure> {
        let station = self.profinet.station.clone();
        self.ask(move |interface| commission::find(interface, &station)).await
    }

    /// What it says of itself in its records.
    pub async fn identity(&self, found: Found) -> Result<Identity, Failure> {
        self.ask(move |interface| commission::identity(interface, &found)).await
    }

    /// Why something did not come about.
    pub fn failure(&self, error: ProfinetError) -> Failure {
        self.failure_of(&LinkError::from(error))
    }

    /// Likewise, of a link.
    pub fn failure_of(&self, error: &LinkError) -> Failure {
        not_open(&self.label, &SCHEME, error)
    }
}

impl fieldbus::Board for Board {
    fn check<'a>(&'a mut self, layers: &'a mut Layers) -> LocalBoxFuture<'a, Option<Image>> {
        check::look(self, layers).boxed_local()
    }

    fn close(self: Box<Self>) -> LocalBoxFuture<'static, ()> {
        std::future::ready(()).boxed_local()
    }
}
