//! `yerc raw`.

use tokio::time::Instant;

use super::decode::FieldRow;
use super::file::download_failed;
use super::link::{self, Refusal};
use super::var::confirm_raw;
use crate::failure::refusal_failure;
use crate::prelude::*;
use armctl_controller::text::hex;
use armctl_controller::yerc::describe::{Sender, describe};
use armctl_controller::yerc::session::{DownloadEnd, Reply};
use armctl_controller::yerc::status;
use armctl_controller::yerc::table::{BATCH_BACKUP_PATH, Row, service};
use armctl_controller::yerc::wire::{ANSWER_BIT, AnswerFrame, Division, HEADER_LEN, LAST_BLOCK, MAX_DATA, Status};
use armctl_frame::decode::capture::parse_hex;
use armctl_frame::decode::field_table;

/// Sends one raw request and shows the answer.
#[derive(Debug, Args)]
#[command(
    after_help = "Numbers are decimal, or hexadecimal after 0x. armctl sends a request that the manuals do not list \
                  with a warning, or rejects it with --strict. armctl treats an unknown request as a motion and asks \
                  for confirmation. List (0x32) and save (0x16) show all blocks of the transfer as one block. To send \
                  a file, use `yerc file put`. If the controller refuses the request, the command prints the answer, \
                  and the exit code is 3."
)]
pub struct Raw {
    /// Command number, such as 0x72
    #[arg(long, value_name = "N", value_parser = word, required_unless_present = "file")]
    command: Option<u16>,
    /// Instance: number of the item
    #[arg(long, value_name = "N", value_parser = word, required_unless_present = "file")]
    instance: Option<u16>,
    /// Attribute: number of the field. 0 means all fields
    #[arg(long, value_name = "N", value_parser = byte, default_value = "0")]
    attribute: u8,
    /// Service: 0x01 or 0x0E to read, 0x02 or 0x10 to write, 0x33 to read several items, 0x34 to write several items
    #[arg(long, value_name = "N", value_parser = byte)]
    service: u8,
    /// Data of the request in hexadecimal; spaces, colons and 0x are allowed
    #[arg(long, value_name = "HEX", value_parser = Bytes::parse)]
    data: Option<Bytes>,
    /// Send to the file server instead of the robot server
    #[arg(long, conflicts_with_all = ["command", "instance"])]
    file: bool,
    /// Reject a request that the manuals do not list for this model
    #[arg(long)]
    strict: bool,
}

#[derive(Debug, Clone)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn parse(text: &str) -> Result<Self, String> {
        let bytes = parse_hex(text)?;
        if bytes.len() > MAX_DATA {
            return Err(format!("{} bytes; a frame has at most {MAX_DATA}", bytes.len()));
        }
        Ok(Self(bytes))
    }
}

fn word(text: &str) -> Result<u16, String> {
    let number = user_input::unsigned(text);
    number.ok_or_else(|| "expected a number from 0 to 65535 (0x0000 to 0xFFFF)".to_owned())
}

fn byte(text: &str) -> Result<u8, String> {
    let number = user_input::unsigned(text);
    number.ok_or_else(|| "expected a number from 0 to 255 (0x00 to 0xFF)".to_owned())
}

impl Raw {
    fn request(&self) -> Request {
        Request {
            command: self.command.unwrap_or(0),
            instance: self.instance.unwrap_or(0),
            attribute: self.attribute,
            service: self.service,
            data: self.data.as_ref().map_or_else(Vec::new, |data| data.0.clone()),
        }
    }
}

impl Command for Raw {
    type Family = Yerc;
    type Report = Answer;
    const ID: &'static str = "yerc.raw";

    fn risk(&self) -> Risk {
        self.request().risk()
    }

    fn intent(&self) -> String {
        let request = self.request();
        if let (true, Ok(file)) = (self.file, std::str::from_utf8(&request.data)) {
            let what = if request.service == service::DELETE { "delete the file" } else { "request the file" };
            return format!("{what} {:?} with a raw request (file service {:#04x})", file, request.service);
        }
        let name = request.row().map_or("unknown", |row| row.name);
        format!(
            "send a raw request ({name}: command {:#04x}, instance {}, attribute {}, service {:#04x})",
            request.command, request.instance, request.attribute, request.service
        )
    }

    /// If positions are written, the command reads their current content, and then asks the question itself.
    fn confirmation(&self) -> Confirmation {
        let is_known = !self.file && self.risk() == Risk::Destroy;
        if is_known { Confirmation::WhenKnown } else { Confirmation::Question }
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Answer> {
        let Context { link, screen, confirmer, .. } = context;
        let request = self.request();
        if !self.file && request.division() == Division::File {
            return Err(Failure::usage("command 0 belongs to the file server").hint("use --file without --command"));
        }
        if self.file && request.service == service::LOAD {
            return Err(Failure::usage(format!("file service {:#04x} sends blocks", request.service))
                .hint("use `yerc file put`"));
        }
        // While the model is unknown, a request that some model supports is not an error.
        let uncertainty = match link.known_model() {
            Some(model) => request.check(model).err(),
            None if Model::ALL.iter().any(|model| request.check(*model).is_ok()) => None,
            None => request.check(link.model_for_display()).err(),
        };
        let doubt = uncertainty.map(|error| error.to_string());
        if let Some(doubt) = &doubt {
            if self.strict {
                return Err(Failure::usage(doubt.clone()).hint("remove --strict to send the request anyway"));
            }
            screen.note(&format!("warning: {doubt}"));
        }
        if self.confirmation() == Confirmation::WhenKnown {
            confirm_raw(link, &confirmer, &request, self.intent()).await?;
        }
        let reply = if self.file && matches!(request.service, service::SAVE | service::LIST) {
            transfer(link, &request).await?
        } else {
            link.raw(&request).await?
        };
        Ok(Answer::new(&request, doubt, reply))
    }
}

/// Maximum number of bytes of a transfer that are displayed.
const MAX_TRANSFER: u64 = 4 << 20;
/// Maximum time until the first answer, if the controller first writes its batch backup.
const BACKUP: Duration = Duration::from_secs(15 * 60);

/// Executes a transfer, and returns all its blocks as the data of one answer.
async fn transfer(link: &mut Link, request: &Request) -> Result<Reply> {
    let began = Instant::now();
    let mut data = Vec::new();
    // The backup must not be requested twice, so the request is not repeated.
    let first_wait = (request.data == BATCH_BACKUP_PATH).then_some(BACKUP);
    let end = link
        .download(request, MAX_TRANSFER, first_wait, |piece| {
            data.extend_from_slice(piece);
            Ok(())
        })
        .await?;
    let status = match &end {
        DownloadEnd::Complete { .. } | DownloadEnd::Finished => Status::OK,
        DownloadEnd::Nothing(status) | DownloadEnd::Refused { status, .. } => *status,
        end => {
            download_failed(request.service, end)?;
            Status::OK
        }
    };
    Ok(Reply { status, data, elapsed: began.elapsed(), attempts: 1 })
}

/// A raw request and its answer.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Answer {
    request: DecodedRequest,
    /// Status; `0x00` is success.
    status: String,
    /// Added status; null if the answer has none.
    added_status: Option<String>,
    /// Meaning of the status.
    meaning: String,
    cause: String,
    remedy: String,
    /// Data part of the answer.
    data_hex: String,
    data_bytes: usize,
    /// Decoded fields of the data part.
    fields: Vec<FieldRow>,
    round_trip_ms: f64,
    /// Number of times that the request was sent.
    attempts: u32,
    #[serde(skip)]
    refusal: Option<Failure>,
}

/// Decoded request.
#[derive(Debug, Serialize, JsonSchema)]
struct DecodedRequest {
    command: String,
    instance: u16,
    attribute: u8,
    service: String,
    data_hex: String,
    /// Name of the command; null if the command is unknown.
    name: Option<&'static str>,
    /// Manual and section; null if the command is unknown.
    section: Option<String>,
    /// Text about a difference between the request and the manuals.
    warning: Option<String>,
}

impl Answer {
    fn new(request: &Request, warning: Option<String>, reply: Reply) -> Self {
        let Reply { status, data, elapsed, attempts } = reply;
        let explanation = status::explain(status);
        let frame = AnswerFrame {
            division: request.division(),
            ack: true,
            id: 0,
            block: LAST_BLOCK,
            service: request.service.wrapping_add(ANSWER_BIT),
            status,
            data: data.get(..MAX_DATA).unwrap_or(&data),
        };
        let fields = describe(&frame.emit(), Sender::Controller, Some(request)).fields;
        let row = request.row();
        Self {
            request: DecodedRequest {
                command: format!("{:#04x}", request.command),
                instance: request.instance,
                attribute: request.attribute,
                service: format!("{:#04x}", request.service),
                data_hex: hex(&request.data),
                name: row.map(|row| row.name),
                section: row.map(Row::citation),
                warning,
            },
            status: format!("{:#04x}", status.code),
            added_status: match status.added_size {
                0 => None,
                1 => Some(format!("{:#06x}", status.added)),
                _ => Some(format!("{:#010x}", status.added)),
            },
            meaning: explanation.name.into_owned(),
            cause: explanation.cause.into_owned(),
            remedy: explanation.remedy.into_owned(),
            data_hex: hex(&data),
            data_bytes: data.len(),
            fields: fields.into_iter().filter(|field| field.offset >= HEADER_LEN).map(FieldRow).collect(),
            round_trip_ms: elapsed.as_secs_f64() * 1000.0,
            attempts,
            refusal: (!status.is_ok())
                .then(|| refusal_failure(Refusal { status, to: link::RefusedRequest::from(request) })),
        }
    }
}

impl Report for Answer {
    fn view(&self) -> View {
        let name = self.request.name.unwrap_or("unknown command");
        let about =
            self.request.section.as_ref().map_or_else(|| name.to_owned(), |section| format!("{name} ({section})"));
        let view = View::fields([
            ("request", about.into()),
            ("status", self.status.as_str().into()),
            ("added status", Cell::optional(self.added_status.as_deref())),
            ("meaning", self.meaning.as_str().into()),
            ("data", if self.data_hex.is_empty() { "-".into() } else { self.data_hex.as_str().into() }),
        ]);
        if self.fields.is_empty() { view } else { view.append(field_table(&self.fields)) }
    }

    fn failure(&self) -> Option<Failure> {
        self.refusal.clone()
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::testing::{Bench, DX200, same};

    fn answer(status: Status, data: &[u8]) -> Answer {
        let request = Request { command: 0x7A, instance: 5, attribute: 1, service: 0x0E, data: Vec::new() };
        let reply = Reply { status, data: data.to_vec(), elapsed: Duration::from_millis(5), attempts: 1 };
        Answer::new(&request, None, reply)
    }

    #[test]
    fn refusal_is_data_and_a_failure() {
        let refused = answer(Status::refused(0x2060), &[]);
        assert_eq!((refused.status.as_str(), refused.added_status.as_deref()), ("0x1f", Some("0x2060")));
        let failure = Report::failure(&refused).unwrap();
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::Refused, Some("0x2060")));
    }

    #[test]
    fn explains_data() {
        let value = answer(Status::OK, &[200]);
        assert!(Report::failure(&value).is_none());
        let field = &value.fields[0].0;
        assert_eq!((field.offset, field.size, field.name.as_str(), field.meaning.as_str()), (32, 1, "value", "200"));
    }

    #[test]
    fn raw_sends_the_given_request() {
        let words = [
            "raw",
            "--command",
            "0x80",
            "--instance",
            "5",
            "--attribute",
            "2",
            "--service",
            "0x10",
            "--data",
            "ff ff:ff,0xff",
        ];
        same("R35", DX200, &words);
        same("M01", DX200, &["raw", "--command", "0x72", "--instance", "1", "--service", "0x01"]);
    }

    #[test]
    fn raw_lists_and_fetches() {
        let mut bench = Bench::new("sim:");
        let list = bench.data(&["raw", "--file", "--service", "0x32", "--data", &hex(b"*.PRM")]);
        assert_eq!(list["data_hex"], hex(b"ALL.PRM\r\nRC.PRM\r\n"));
        let file = bench.data(&["raw", "--file", "--service", "0x16", "--data", &hex(b"TESTJOB.JBI")]);
        assert!(file["data_bytes"].as_u64().unwrap() > 479, "more than a block: {file}");
        let (missing, _) = bench.run(&["raw", "--file", "--service", "0x16", "--data", &hex(b"NO.JBI")]).unwrap();
        assert_eq!((&missing["status"], &missing["added_status"]), (&Value::from("0x00"), &Value::from("0xe29c")));
        assert!(bench.run(&["raw", "--file", "--service", "0x15", "--data", "41"]).is_err());
    }

    #[test]
    fn raw_prints_a_refusal_and_fails() {
        let mut bench = Bench::new("sim:");
        let words = ["raw", "--command", "0x7f", "--instance", "100", "--service", "1"];
        let (data, failure) = bench.run(&words).unwrap();
        assert_eq!((&data["status"], &data["added_status"]), (&Value::from("0x1f"), &Value::from("0xb005")));
        assert_eq!(failure.unwrap().kind.exit(), 3);
        let data = bench.data(&["raw", "--command", "0x72", "--instance", "1", "--service", "1"]);
        assert_eq!((&data["data_bytes"], data["fields"].as_array().unwrap().len()), (&Value::from(8), 2));
    }
}
