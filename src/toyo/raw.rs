//! `toyo raw`: sends any block and explains the answer.

use super::decode::FieldRow;
use super::number_arguments::saturated_byte;
use crate::prelude::*;
use armctl_controller::toyo::describe::{Sender, describe};
use armctl_controller::toyo::request::{Answer, BlockError};
use armctl_frame::decode::{field_table, problem_lines};

/// Send a block unchanged. armctl does not switch the host ON, compare values or wait for an end.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl also sends a block that is not in the manual. Such a block counts as a motion, because its \
                  effect is unknown. Before a block that can change something, armctl reads a page of the status, so \
                  that it recognizes a late answer. If the controller refuses the block (@NG), the exit code is 3. \
                  `armctl decode toyo` explains a block without sending it."
)]
pub struct Raw {
    /// Block without its line end, for example '@STAS SNO=0'
    #[arg(value_name = "BLOCK", value_parser = block)]
    block: Block,
}

/// A block, with its parsed request if the manual contains it.
#[derive(Debug, Clone)]
enum Block {
    Known(Box<Request>),
    Unknown(String),
}

fn block(text: &str) -> Result<Block, String> {
    match Request::parse(text) {
        Ok(request) if request.text() == text && request.check().is_ok() => Ok(Block::Known(Box::new(request))),
        Err(error @ (BlockError::Start | BlockError::Long { .. } | BlockError::Character { .. })) => {
            Err(error.to_string())
        }
        _ if text.ends_with(['\r', '\n']) => Err("remove the line end, because armctl adds it".to_owned()),
        _ => Ok(Block::Unknown(text.to_owned())),
    }
}

impl Block {
    fn text(&self) -> String {
        match self {
            Self::Known(request) => request.text(),
            Self::Unknown(text) => text.clone(),
        }
    }

    fn request(&self) -> Option<&Request> {
        match self {
            Self::Known(request) => Some(request),
            Self::Unknown(_) => None,
        }
    }
}

impl Command for Raw {
    type Family = Toyo;
    type Report = Exchange;
    const ID: &'static str = "toyo.raw";

    fn risk(&self) -> Risk {
        self.block.request().map_or(Risk::Motion, Request::risk)
    }

    fn intent(&self) -> String {
        let about = self.block.request().map_or("which is not in the manual", |request| request.row().about);
        format!("send {} ({about})", self.block.text())
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Exchange> {
        let link = context.link;
        let answer = match &self.block {
            Block::Known(request) => {
                let answer = link.raw(request).await?;
                if answer == Answer::Done {
                    record_choice(link, request);
                }
                answer.text()
            }
            Block::Unknown(text) => link.raw_text(text).await?,
        };
        Ok(Exchange::of(&self.block, answer))
    }
}

/// Records settings that the user chose, so that no notice about them is printed.
fn record_choice(link: &mut Link, request: &Request) {
    match request.command() {
        table::Command::Hson => link.choose_host(true),
        table::Command::Hsof => link.choose_host(false),
        table::Command::Ctsk => link.choose_task(saturated_byte(request.record(), "task")),
        _ => {}
    }
}

/// A block and its answer.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Exchange {
    request: String,
    answer: String,
    /// Meaning of the answer.
    title: String,
    /// Fields of the answer.
    fields: Vec<FieldRow>,
    /// Error in the answer, if any.
    problem: Option<String>,
    /// Whether the answer is `@NG`.
    refused: bool,
}

impl Exchange {
    fn of(block: &Block, answer: String) -> Self {
        let description = describe(&answer, Sender::Controller, block.request());
        Self {
            request: block.text(),
            refused: answer.trim_end() == "@NG",
            answer,
            title: description.title,
            fields: description.fields.into_iter().map(FieldRow).collect(),
            problem: description.problem,
        }
    }
}

impl Report for Exchange {
    fn view(&self) -> View {
        let problem = problem_lines(&self.problem);
        let view = View::text(format!("{}\n{}{problem}", self.answer, self.title));
        if self.fields.is_empty() { view } else { view.append(field_table(&self.fields)) }
    }

    fn failure(&self) -> Option<Failure> {
        let refused = || {
            Failure::new(Kind::Refused, format!("the controller refused {} (@NG)", self.request))
                .code("NG")
                .hint("use `toyo status` to see a possible reason; most commands need the host ON (`toyo host on`)")
        };
        self.refused.then(refused)
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault, all_blocks, objection};
    use armctl_controller::Risk;
    use armctl_frame::failure::Kind;

    fn risk(text: &str) -> Risk {
        let raw = super::Raw { block: super::block(text).unwrap() };
        armctl_frame::Command::risk(&raw)
    }

    #[test]
    fn a_fence_is_before_an_order() {
        for text in ["@HOME", "@WOVR OV=001", "@JGST X=+L Y=SP Z=SP R=SP", "@XXXX", "@STAS SNO=9", "@HSON "] {
            let blocks = all_blocks(&["raw", text]).unwrap();
            assert_eq!(blocks[..2], ["@STAS SNO=0", text], "an order has a fence before it");
            assert!(blocks[2..].iter().all(|block| block == "@STAS SNO=0"), "{blocks:?}");
        }
    }

    #[test]
    fn a_late_ok_does_not_confirm_a_raw_order() {
        for order in ["@MCST CN06=0001", "@MCST CN06=1"] {
            let late = move |block: &str, _| match block {
                "@MCST CN05=0007" => Fault::Late(std::time::Duration::from_millis(3010)),
                _ if block == order => Fault::Lost,
                _ => Fault::None,
            };
            let (mut bench, received) = Bench::with_faults("host = true\n", late);
            assert_eq!(bench.run(&["counter", "set", "5", "7"]).unwrap_err().kind, Kind::OutcomeUnknown);
            received.borrow_mut().clear();
            assert_eq!(bench.run(&["raw", order]).unwrap_err().kind, Kind::OutcomeUnknown);
            assert_eq!(received.borrow()[..2], ["@STAS SNO=0", order]);
        }
    }

    #[test]
    fn a_fence_follows_an_unknown_order() {
        let (mut bench, received) = Bench::with_faults("host = true\n", |_, _| Fault::None);
        bench.run(&["raw", "@XXXX"]).unwrap();
        bench.run(&["raw", "@MCST CN06=0001"]).unwrap();
        let sent = ["@STAS SNO=0", "@XXXX", "@STAS SNO=0", "@MCST CN06=0001", "@STAS SNO=0"];
        assert_eq!(received.borrow()[..], sent, "what follows an order settles it");
    }

    #[test]
    fn a_block_outside_the_manual_counts_as_a_motion() {
        assert_eq!(risk("@STAS SNO=0"), Risk::Read);
        assert_eq!(risk("@WOVR OV=001"), Risk::Write);
        assert_eq!(risk("@JGST X=SP Y=SP Z=SP R=SP"), Risk::Write);
        assert_eq!(risk("@HOME"), Risk::Motion);
        for text in ["@WOVR OV=101", "@WOVR OV=1", "@XXXX", "@STAS SNO=0 "] {
            assert_eq!(risk(text), Risk::Motion, "{text}");
        }
    }

    #[test]
    fn a_block_has_a_maximum_length() {
        assert!(objection(&["raw", &format!("@{}", "A".repeat(126))]).contains("128"));
    }

    #[test]
    fn the_answer_is_decoded_and_a_refusal_fails() {
        let mut bench = Bench::new("sim:");
        let status = bench.data(&["raw", "@STAS SNO=3"]);
        assert_eq!((&status["fields"][1]["name"], &status["refused"]), (&"page".into(), &false.into()));
        let (home, failure) = bench.run(&["raw", "@HOME"]).unwrap();
        assert_eq!((&home["answer"], failure.unwrap().kind), (&"@NG".into(), Kind::Refused), "the host is OFF");
        let (unknown, failure) = bench.run(&["raw", "@XXXX"]).unwrap();
        assert_eq!((&unknown["answer"], failure.unwrap().kind), (&"@NG".into(), Kind::Refused));
    }
}
