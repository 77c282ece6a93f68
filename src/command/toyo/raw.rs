//! `toyo raw`: any block, and what the answer says.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use super::link;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::describe::{Description, describe};
use crate::controller::toyo::request::{BlockError, Request};
use crate::failure::{Failure, Kind};
use crate::output::view::{Section, Table, View};

/// Sends a block as it is, once. Nothing is done before or after it: no host ON, no comparison.
#[derive(Debug, Args)]
#[command(after_help = "A block that is in no table counts as a motion, as nobody knows what it does.")]
pub struct Raw {
    /// The block without its line end, such as "@STAS SNO=0"
    #[arg(value_name = "BLOCK", value_parser = block)]
    block: Block,
}

/// A block, in the table or not.
#[derive(Debug, Clone)]
enum Block {
    Known(Box<Request>),
    Unknown(String),
}

fn block(text: &str) -> Result<Block, String> {
    match Request::parse(text) {
        Ok(request) => match request.check() {
            Ok(()) if request.text() == text.trim_end() => Ok(Block::Known(Box::new(request))),
            // What is not as the manual prints it goes out as it is.
            _ => Ok(Block::Unknown(text.trim_end_matches(['\r', '\n']).to_owned())),
        },
        Err(error @ (BlockError::Start | BlockError::Long { .. } | BlockError::Character { .. })) => {
            Err(error.to_string())
        }
        Err(_) => Ok(Block::Unknown(text.to_owned())),
    }
}

impl Command for Raw {
    type Family = Family;
    type Report = Exchange;
    const ID: &'static str = "toyo.raw";

    fn risk(&self) -> Risk {
        match &self.block {
            Block::Known(request) => request.risk(),
            Block::Unknown(_) => Risk::Motion,
        }
    }

    fn intent(&self) -> String {
        match &self.block {
            Block::Known(request) => format!("send {} ({})", request.text(), request.row().about),
            Block::Unknown(text) => format!("send {text}, which is in no table"),
        }
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Exchange, Failure> {
        let link = context.link;
        match &self.block {
            Block::Known(request) => {
                if link.is_dry() {
                    link.foresee(request, request.row().about);
                    return std::future::pending().await;
                }
                let answer = link.exchange(request).await?.text();
                Ok(Exchange::of(request.text(), answer))
            }
            Block::Unknown(text) => Ok(Exchange::of(text.clone(), link.raw(text).await?)),
        }
    }
}

/// A block and its answer.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Exchange {
    request: String,
    answer: String,
    /// The answer in words.
    title: String,
    fields: Vec<FieldRow>,
    /// What is wrong with the answer.
    problem: Option<String>,
    #[serde(skip)]
    refused: bool,
}

/// A piece of a block.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FieldRow {
    /// Column, from 1.
    pub column: usize,
    /// What it is called.
    pub name: String,
    /// As it stands there.
    pub raw: String,
    /// What it says.
    pub meaning: String,
}
