//! Commands without arguments that read a report from the device of a fieldbus with explicit messages.

use std::marker::PhantomData;

use super::fieldbus::BusBoard;
use crate::prelude::*;

/// A report that is read with explicit messages. These messages open no I/O connection, start no polls, and lock
/// nothing.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait BoardReport: Report + Sized + 'static {
    /// Client of the device.
    type Board: BusBoard;
    /// Name in envelopes and schemas.
    const ID: &'static str;
    /// The messages, for a dry run.
    const MESSAGES: &'static str;

    /// Reads the report.
    async fn read(board: &mut Self::Board) -> Result<Self>;
}

/// Reads a report.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ReadBoard<R: BoardReport> {
    #[arg(skip)]
    report: PhantomData<fn() -> R>,
}

impl<R: BoardReport> Command for ReadBoard<R> {
    type Family = Yrcx;
    type Report = R;
    const ID: &'static str = R::ID;
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<R> {
        let link = context.link;
        link.reject_unit_of::<R::Board>()?;
        link.then(R::MESSAGES);
        R::read(link.board()?).await
    }
}
