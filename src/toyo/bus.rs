//! `toyo bus`: the CC-Link board.

use super::number_arguments::saturated_byte;
use crate::prelude::*;

/// Show settings and errors of CC-Link.
#[derive(Debug, Args)]
#[command(
    after_help = "Controllers without CC-Link refuse the command. The manual of the bus describes the error and \
                        status bytes."
)]
pub struct Bus {}

impl Command for Bus {
    type Family = Toyo;
    type Report = CcLink;
    const ID: &'static str = "toyo.bus";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<CcLink> {
        let page = |form| Request::in_form(table::Command::Mbus, form, Vec::new()).map_err(|error| wrong(&error));
        let (settings, errors) = (page(0)?, page(1)?);
        context.link.plan_all(&[settings.clone(), errors.clone()])?;
        let settings = context.link.ask(&settings).await?;
        let errors = context.link.ask(&errors).await?;
        let hex = |name| format!("{:02X}", errors.byte(name).unwrap_or(0));
        Ok(CcLink {
            station: saturated_byte(&settings, "station"),
            rate: settings.word("rate").unwrap_or_default(),
            hardware_version: saturated_byte(&settings, "version"),
            errors: ["error1", "error2", "error3"].map(hex),
            main_status: ["status1", "status2"].map(hex),
        })
    }
}

/// Settings and errors of CC-Link.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CcLink {
    station: u8,
    /// Bit rate in bits per second: `156K`, `625K`, `2.5M`, `5M` or `10M`.
    rate: &'static str,
    hardware_version: u8,
    /// The three error bytes in hexadecimal.
    errors: [String; 3],
    /// The two bytes of the main status in hexadecimal.
    main_status: [String; 2],
}

impl Report for CcLink {
    fn view(&self) -> View {
        View::fields([
            ("station", self.station.into()),
            ("rate (bit/s)", Cell::number(self.rate)),
            ("hardware version", self.hardware_version.into()),
            ("errors", self.errors.join(" ").into()),
            ("main status", self.main_status.join(" ").into()),
        ])
    }
}
