//! `toyo offset`: current offset of coordinates.

use super::position::Coordinates;
use crate::prelude::*;

/// Show the offset that the program has set.
#[derive(Debug, Args)]
pub struct Offset {}

impl Command for Offset {
    type Family = Toyo;
    type Report = Coordinates;
    const ID: &'static str = "toyo.offset";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Coordinates> {
        let letters = context.link.letters().await?;
        let record = context.link.ask(&Request::bare(table::Command::Moff)).await?;
        Ok(Coordinates::of(&record, letters))
    }
}
