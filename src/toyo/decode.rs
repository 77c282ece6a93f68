//! `armctl decode toyo`: explanation of protocol lines.

mod capture;

pub use self::capture::LineDecoder;
use crate::prelude::*;
use armctl_controller::toyo::describe::{Description, FieldNote, Sender, describe};
use armctl_frame::decode::capture::{Input, Selection, file_among};
use armctl_frame::decode::{self, damage, field_table, in_parentheses, problem_lines, stdin};

/// Decode lines of the Toyo host communication
#[derive(Debug, Args)]
#[command(
    after_help = "The form of a line shows the sender. A prefix -> or <- also shows the sender, so `armctl decode \
                  toyo -` reads the output of `--trace -`. A request before an answer explains the answer. A damaged \
                  line is explained up to the damage, and the exit code is 5.\n\nFor a capture file, the command \
                  lists the lines as --trace does. NUMBER and TIME are the same as in Wireshark. A file without lines \
                  is not an error. A damaged file is listed up to the damage, and the exit code is 1."
)]
pub struct Decode {
    /// Lines, for example '@STAS SNO=0' or '@STAS SNO=0 ST1=22 ST2=00', or - to read lines on stdin, or a capture file
    /// (FILE.pcap or FILE.pcapng)
    #[arg(required = true, value_name = "LINE")]
    lines: Vec<String>,
    #[command(flatten)]
    selection: Selection,
}

/// Marks that a trace uses for the sender. `REMARK` is the text before the explanation of a line.
const MARKS: [(&str, Sender); 2] = [("->", Sender::Host), ("<-", Sender::Controller)];
const REMARK: &str = "  # ";
/// Maximum number of lines. The explanation of a line takes about 1 kB, and all explanations are one report.
const MAX_LINES: usize = 100_000;

impl decode::Decode for Decode {
    const ID: &'static str = "decode.toyo";
    const CAPTURE_ID: &'static str = "decode.toyo.capture";
    type Report = DecodedLines;
    type Capture = LineDecoder;

    fn capture(&self) -> Result<Option<(Input<'_>, LineDecoder)>> {
        Ok(file_among(&self.lines).map(|path| (Input::File(path), LineDecoder::default())))
    }

    fn selection(&self) -> &Selection {
        &self.selection
    }

    fn decode(&self) -> Result<DecodedLines> {
        Ok(decode_lines(&self.lines()?))
    }

    /// The lines of a trace are explained while the trace is recorded.
    fn decode_stdin(&self) -> Option<impl Iterator<Item = decode::LineReport<DecodedLines>>> {
        let mut decoder = LineByLine::default();
        let lines = (self.lines == ["-"]).then(decode::stdin_lines)?;
        let lines = lines.filter(|line| line.as_ref().map_or(true, |line| is_line(line)));
        Some(lines.map(move |line| {
            let line = decoder.decode(&line?);
            let problem = line.problem.clone();
            Ok((DecodedLines { lines: vec![line] }, problem))
        }))
    }
}

impl Decode {
    fn lines(&self) -> Result<Vec<String>> {
        let lines =
            if self.lines == ["-"] { stdin()?.lines().map(str::to_owned).collect() } else { joined(&self.lines) };
        // A block is never empty. In a trace, the bytes repeat the line above them.
        let lines: Vec<String> = lines.into_iter().filter(|line| is_line(line)).collect();
        match lines.len() {
            0 => Err(Failure::usage("the input has no lines").hint("type lines such as '@STAS SNO=0'")),
            1..=MAX_LINES => Ok(lines),
            count => Err(Failure::usage(format!("the input has {count} lines; the maximum is {MAX_LINES}")).hint(
                "split the input with `split -l 100000`, or record with --trace FILE.pcapng and decode the file",
            )),
        }
    }
}

fn is_line(line: &str) -> bool {
    !line.trim().is_empty() && !line.starts_with("   ")
}

/// Joins arguments that a shell split at blanks. A line begins with its mark, or with `@`.
fn joined(arguments: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for argument in arguments {
        let is_mark = |text: &str| MARKS.iter().any(|(mark, _)| text.trim() == *mark);
        let begins = argument.starts_with('@') || MARKS.iter().any(|(mark, _)| argument.starts_with(mark));
        match lines.last_mut() {
            Some(last) if !begins || is_mark(last) => {
                last.push(' ');
                last.push_str(argument);
            }
            _ => lines.push(argument.clone()),
        }
    }
    lines
}

/// Explains each line. An answer is explained with the request before it.
fn decode_lines(lines: &[String]) -> DecodedLines {
    let mut decoder = LineByLine::default();
    DecodedLines { lines: lines.iter().map(|line| decoder.decode(line)).collect() }
}

/// Explains lines in their order.
#[derive(Default)]
struct LineByLine {
    last_request: Option<Request>,
}

impl LineByLine {
    fn decode(&mut self, line: &str) -> DecodedLine {
        let (marked, text) = unmarked(line);
        // The answer to TYPE has the same form as its request.
        let is_answer = || self.last_request.as_ref().is_some_and(|request| request.answer(text).is_ok());
        let sender = marked.unwrap_or_else(|| if is_answer() { Sender::Controller } else { Sender::guess(text) });
        let description = describe(text, sender, self.last_request.take().as_ref());
        if sender == Sender::Host {
            self.last_request = Request::parse(text).ok();
        }
        DecodedLine::new(text, sender, description)
    }
}

/// The line without the text that a trace adds.
fn unmarked(line: &str) -> (Option<Sender>, &str) {
    let trimmed = line.trim_start();
    let marked =
        MARKS.iter().find_map(|(mark, sender)| Some((Some(*sender), trimmed.strip_prefix(mark)?.trim_start())));
    match marked {
        Some((sender, text)) => (sender, text.split_once(REMARK).map_or(text, |(text, _)| text)),
        None => (None, trimmed),
    }
}

/// Lines with their explanations.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DecodedLines {
    lines: Vec<DecodedLine>,
}

/// A line with its explanation.
#[derive(Debug, Serialize, JsonSchema)]
struct DecodedLine {
    /// Text of the line.
    text: String,
    /// Meaning of the line.
    title: String,
    /// Section of the manual; null if the command is unknown.
    section: Option<String>,
    /// Sender of the line: `host` or `controller`.
    sender: &'static str,
    fields: Vec<FieldRow>,
    /// Error in the line.
    problem: Option<String>,
}

impl DecodedLine {
    fn new(text: &str, sender: Sender, description: Description) -> Self {
        let Description { title, section, fields, problem } = description;
        let sender = match sender {
            Sender::Host => "host",
            Sender::Controller => "controller",
        };
        let fields = fields.into_iter().map(FieldRow).collect();
        Self { text: text.to_owned(), title, section, sender, fields, problem }
    }
}

armctl_frame::field_row!(FieldNote);

impl decode::Field for FieldRow {
    const COLUMNS: &'static [&'static str] = &["column", "field", "raw", "meaning"];

    fn cells(&self) -> Vec<Cell> {
        let FieldNote { column, name, raw, meaning, .. } = &self.0;
        vec![(*column).into(), (*name).into(), raw.as_str().into(), meaning.as_str().into()]
    }
}

impl Report for DecodedLines {
    fn view(&self) -> View {
        let mut sections = Vec::new();
        for DecodedLine { text, title, section, fields, problem, .. } in &self.lines {
            let (section, problem) = (in_parentheses(section.as_deref()), problem_lines(problem));
            sections.push(Section::Text(format!("{text}\n{title}{section}{problem}")));
            if !fields.is_empty() {
                sections.push(field_table(fields));
            }
        }
        View { sections }
    }

    fn failure(&self) -> Option<Failure> {
        damage("line", self.lines.iter().map(|line| line.problem.as_ref()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn senders(lines: &[&str]) -> Vec<&'static str> {
        let lines = lines.iter().map(ToString::to_string).collect();
        let toyo = Decode { lines, selection: Selection::default() };
        decode_lines(&toyo.lines().unwrap()).lines.iter().map(|line| line.sender).collect()
    }

    #[test]
    fn a_line_can_be_separate_words_or_a_line_of_a_trace() {
        assert_eq!(senders(&["@STAS", "SNO=0", "@STAS", "SNO=0", "ST1=22", "ST2=00"]), ["host", "controller"]);
        assert_eq!(senders(&["-> @HOME  # request: HOME", "<- @OK  # answer to HOME: done"]), ["host", "controller"]);
        assert_eq!(senders(&["->", "@TYPE", "AX1", "RTYP=000000", "<-", "@NG"]), ["host", "controller"]);
        assert_eq!(senders(&["@TYPE AX1 RTYP=000001", "@TYPE AX1 RTYP=000000"]), ["host", "controller"]);
        assert_eq!(senders(&["@HSON", "   40 48 53 4f 4e", "@HSOF"]), ["host", "host"]);
        assert!(Decode { lines: vec![" ".into()], selection: Selection::default() }.lines().is_err());
        let many = Decode { lines: vec!["@HOME".to_owned(); MAX_LINES + 1], selection: Selection::default() };
        let failure = many.lines().unwrap_err();
        assert_eq!((failure.kind, failure.message.contains("100001 lines")), (Kind::Usage, true), "{failure:?}");
    }

    #[test]
    fn an_answer_is_decoded_with_the_request_before_it() {
        let lines = ["@HOME", "@OK", "@OK"].map(str::to_owned);
        let titles: Vec<String> = decode_lines(&lines).lines.into_iter().map(|line| line.title).collect();
        assert_eq!(titles[1..], ["answer to HOME: done", "answer: done"]);
    }

    #[test]
    fn a_damaged_line_fails_and_shows_the_fields_before_the_damage() {
        let lines = decode_lines(&["@STAS SNO=0 ST1=2".to_owned()]);
        assert_eq!(lines.lines[0].fields.len(), 2);
        let failure = Report::failure(&lines).unwrap();
        assert_eq!(failure.kind, Kind::Malformed);
        assert!(Report::failure(&decode_lines(&["@HOME".to_owned()])).is_none());
    }
}
