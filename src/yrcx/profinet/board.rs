//! Requests to a PROFINET station that need no connection.

use std::net::Ipv4Addr;

use super::{check, connect};
use crate::fieldbus::{BusBoard, Checked, ConnectionParameters};
use crate::prelude::basics::*;
use armctl_frame::settings::target::profinet::{Profinet, SCHEME};
use armctl_transport::image::LinkError;
use armctl_transport::image::tap::Tap;
use armctl_transport::profinet::commission::{self, Identity, StationInfo};
use armctl_transport::profinet::error::ProfinetError;
use armctl_transport::profinet::interface::Interface;
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::settings::Station;
use armctl_transport::profinet::wire::dcp::{self, Block};

/// Station of a URL. Each request opens the interface.
#[derive(Debug)]
pub struct Board {
    /// Options of the URL.
    pub profinet: Profinet,
    label: String,
    tap: Tap,
}

impl Board {
    /// Station of a URL.
    pub fn new(at: &ConnectionParameters<'_>) -> Result<Self, LinkError> {
        Ok(Self { profinet: at.options::<Profinet>()?.clone(), label: at.robot.label(), tap: at.tap.clone() })
    }

    /// Returns the interface, with the recorder of packets.
    pub fn interface(&self) -> Result<Interface> {
        let mut interface = Interface::find(&self.profinet.interface).map_err(|error| self.failure(error))?;
        interface.tap = self.tap.clone();
        Ok(interface)
    }

    /// Runs a blocking request on the interface.
    pub async fn ask<T: Send + 'static>(
        &self,
        question: impl FnOnce(&Interface) -> Result<T, ProfinetError> + Send + 'static,
    ) -> Result<T> {
        let interface = self.interface()?;
        match tokio::task::spawn_blocking(move || question(&interface)).await {
            Ok(answer) => answer.map_err(|error| self.failure(error)),
            Err(error) => Err(Failure::local(error.to_string())),
        }
    }

    /// Finds the station.
    pub async fn station(&self) -> Result<StationInfo> {
        let station = self.profinet.station.clone();
        self.ask(move |interface| commission::find(interface, &station)).await
    }

    /// Reads the records of the station.
    pub async fn identity(&self, found: StationInfo) -> Result<Identity> {
        self.ask(move |interface| commission::identity(interface, &found)).await
    }

    /// Finds another station with this name.
    pub async fn namesake(&self, name: &str, than: &StationInfo) -> Result<Option<String>> {
        let (station, mac) = (Station::Name(name.to_owned()), than.mac);
        let other = self.ask(move |interface| commission::find_duplicate(interface, &station, mac)).await?;
        Ok(other.map(|mac| format!("station {mac}")))
    }

    /// Finds another device that has this IP address.
    pub async fn holder(&self, address: Ipv4Addr, than: &StationInfo) -> Result<Option<String>> {
        let (mac, own) = (than.mac, self.interface()?.mac);
        let other = self.ask(move |interface| commission::holder(interface, address, mac)).await?;
        Ok(other.map(|mac| if mac == own { "this machine".to_owned() } else { format!("the card {mac}") }))
    }

    /// Sets a value at the station, and waits until the station reports it.
    pub async fn set(
        &self,
        found: &StationInfo,
        what: &'static str,
        block: Block,
        is_so: impl Fn(&dcp::Station) -> bool + Send + 'static,
    ) -> Result<StationInfo> {
        let mac = found.mac;
        let set = self.ask(move |interface| {
            let answer = commission::change(interface, mac, what, &block);
            let is_open = matches!(answer, Err(ProfinetError::NoAnswer { .. }));
            match answer {
                // If the station refuses, do not wait for the new value.
                Err(error @ ProfinetError::Dcp { .. }) => return Ok(Err(error)),
                Err(error) if !is_open => return Err(error),
                _ => {}
            }
            Ok(commission::wait_until_active(interface, mac, what, is_so))
        });
        match set.await? {
            Ok(found) => Ok(found),
            Err(error @ ProfinetError::Dcp { .. }) => {
                let failure = Failure::new(Kind::Refused, format!("{}: {error}", self.label));
                Err(failure.hint("use `yrcx profinet identify` to see the current settings; nothing was changed"))
            }
            Err(error) => {
                let message = format!("{}: the request was sent, and the result is unknown: {error}", self.label);
                Err(Failure::new(Kind::OutcomeUnknown, message)
                    .hint("use `yrcx profinet identify` to see the current settings"))
            }
        }
    }

    /// Opens a connection with this layout until data flows, then closes it. Returns the answer of the station.
    pub async fn attempt(&self, layout: &Layout) -> Result<Result<(), ProfinetError>> {
        let profinet = Profinet { layout: Some(layout.clone()), gsdml: None, ..self.profinet.clone() };
        let settings = connect::settings(&profinet, Duration::ZERO).map_err(|error| self.failure_of(&error))?;
        Ok(connect::attempt(&profinet, settings, self.tap.clone()).await)
    }

    /// Failure of a request.
    pub fn failure(&self, error: ProfinetError) -> Failure {
        self.failure_of(&LinkError::from(error))
    }

    /// Failure of a link.
    pub fn failure_of(&self, error: &LinkError) -> Failure {
        not_open(&self.label, &SCHEME, error)
    }
}

impl BusBoard for Board {
    const BUS: &'static str = SCHEME.bus;
    const DEVICE: &'static str = "station";

    async fn check_layers(&mut self, layers: &mut Layers) -> Checked<Option<Image>> {
        check::check_layers(self, layers).await
    }
}
