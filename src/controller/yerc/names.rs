//! Names of signals, variables and registers on a controller: files `IONAME.DAT`, `EXIONAME.DAT`, `VARNAME.DAT` and
//! `IOMNAME.DAT`.
//!
//! The protocol manuals do not describe these files. The parser is based only on public material:
//!
//! - The BSD-licensed editor extension `tshikina/YaskawaInformSupport` (`server/src/IoNameDatFile.ts`,
//!   `VarNameDatFile.ts`, `IoMNameDatFile.ts` and its grammars): sections, numbers of the names, 16 characters per
//!   name.
//! - Published backups of controllers. In `lukelalondePZ/Fiberdome-GP88-Spindle-Cell` (YRC1000), the name at position
//!   17 of the outputs is the name of the job with `OT#(17)`. The same is true for positions 19 to 21. The ladder
//!   program of this backup copies #10030 to `OT#(17)`. In `SinaiAranda/motoman_sda20d_sys`, the variables are
//!   unordered and have gaps.
//!
//! Other files with names (`.LST`, `.CND`) have no public description and are not parsed.

use std::fmt::Write as _;

use thiserror::Error;

use super::signal::Signal;
use super::variables::Reference;
use crate::names::{Grammar, Kind, MAX_NAME_BYTES, Name, Source};
use crate::text::Encoding;
use crate::user_input::unsigned;

/// Files with names, in the order of reading.
pub const FILES: [&str; 4] = ["IONAME.DAT", "EXIONAME.DAT", "VARNAME.DAT", "IOMNAME.DAT"];

/// Address notation of signals, variables and registers, for example `#27010`, `B5` or `M5`.
pub const GRAMMAR: Grammar = Grammar { address, prefixes: &["B", "I", "D", "R", "S", "P", "BP", "EX", "M"] };

/// Maximum number of names in a file. A controller has 8192 signals, and some thousand variables of each kind.
const MAX_NAMES: usize = 1 << 16;

/// Why a file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum WrongFile {
    /// The first line is unknown.
    #[error("its first line is not the first line of a name file")]
    Head,
    /// The file has no known section.
    #[error("it has no known section")]
    Sections,
    /// The file has too many names.
    #[error("it has more than {MAX_NAMES} names")]
    Many,
}

/// Names of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FileNames {
    /// Names in file order.
    pub names: Vec<Name>,
    /// Number of lines that were skipped because they have another format.
    pub passed_over: usize,
}

/// Kind and address of a signal.
pub fn signal(signal: Signal) -> (Kind, String) {
    (Kind::Signal, signal.to_string())
}

/// Parses an address and normalizes it.
fn address(text: &str) -> Option<(Kind, String)> {
    if let Some(number) = register(text) {
        return Some((Kind::Register, register_address(number)));
    }
    match text.parse::<Signal>() {
        Ok(found) => Some(signal(found)),
        Err(_) => text.parse::<Reference>().ok().map(|reference| (Kind::Variable, reference.to_string())),
    }
}

/// Parses a register, for example `M5` or `M005`.
pub fn register(text: &str) -> Option<u16> {
    let digits = text.strip_prefix(['M', 'm'])?;
    unsigned(digits)
}

/// Address of a register, for example `M5`.
pub fn register_address(number: u16) -> String {
    format!("M{number}")
}

/// Parses one of [`FILES`].
///
/// # Errors
/// If the file has another format.
pub fn read(file: &str, bytes: &[u8], encoding: Encoding) -> Result<FileNames, WrongFile> {
    let mut reader = Reader { file, encoding, section: None, line: 0, found: FileNames::default(), is_known: false };
    // Line feeds and commas are never part of a multi-byte character.
    let mut lines = bytes.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii_end);
    if !lines.next().is_some_and(|head| head.starts_with(b"/")) {
        return Err(WrongFile::Head);
    }
    for line in lines {
        reader.take(line)?;
    }
    if reader.is_known { Ok(reader.found) } else { Err(WrongFile::Sections) }
}

/// Format of the lines of a section.
#[derive(Debug, Clone, Copy)]
enum Section {
    /// Four names per line, for the signals from this group on.
    Signals(u16),
    /// One variable of this kind per line, for example `0012 1,0,NAME`.
    Variables(&'static str),
    /// One name per line, from register 0 on.
    Registers,
}

/// Sections by their first line. Each number is a group of signals of the protocol (FS and DX 3.3.9): general and
/// external inputs and outputs.
const SECTIONS: [(&[u8], Section); 13] = [
    (b"//IN", Section::Signals(1)),
    (b"//OUT", Section::Signals(1001)),
    (b"//EXIN", Section::Signals(2001)),
    (b"//EXOUT", Section::Signals(3001)),
    (b"//NAME", Section::Registers),
    (b"///B", Section::Variables("B")),
    (b"///I", Section::Variables("I")),
    (b"///D", Section::Variables("D")),
    (b"///R", Section::Variables("R")),
    (b"///S", Section::Variables("S")),
    (b"///P", Section::Variables("P")),
    (b"///BP", Section::Variables("BP")),
    (b"///EX", Section::Variables("EX")),
];

/// Signal names per line.
const A_LINE: usize = 4;

struct Reader<'a> {
    file: &'a str,
    encoding: Encoding,
    section: Option<Section>,
    /// Number of the line within the section.
    line: usize,
    found: FileNames,
    is_known: bool,
}

impl Reader<'_> {
    fn take(&mut self, line: &[u8]) -> Result<(), WrongFile> {
        if line.starts_with(b"/") {
            self.section = SECTIONS.iter().find(|(head, _)| *head == line).map(|(_, section)| *section);
            self.is_known |= self.section.is_some();
            self.line = 0;
            return Ok(());
        }
        let at = self.line;
        self.line += 1;
        match self.section {
            None => {}
            Some(Section::Signals(group)) => self.signals(group, at, line),
            Some(Section::Variables(letters)) => self.variable(letters, line),
            Some(Section::Registers) => match u16::try_from(at) {
                Ok(number) => self.add(Kind::Register, register_address(number), line),
                Err(_) => self.found.passed_over += 1,
            },
        }
        if self.found.names.len() > MAX_NAMES { Err(WrongFile::Many) } else { Ok(()) }
    }

    fn signals(&mut self, first_group: u16, at: usize, line: &[u8]) {
        let names: Vec<&[u8]> = line.split(|byte| *byte == b',').collect();
        // If the number of names in a line is not four, the names cannot be assigned to signals.
        if names.len() != A_LINE {
            self.found.passed_over += usize::from(!line.is_empty());
            return;
        }
        for (place, name) in names.into_iter().enumerate() {
            let index = at * A_LINE + place;
            let group = u16::try_from(index / 8).ok().filter(|group| *group < 1000).map(|group| first_group + group);
            let number = group.and_then(|group| Some(u32::from(group) * 10 + u32::try_from(index % 8).ok()?));
            match number.map(Signal::new) {
                Some(Ok(found)) => {
                    let (kind, address) = signal(found);
                    self.add(kind, address, name);
                }
                _ => self.found.passed_over += usize::from(!name.is_empty()),
            }
        }
    }

    /// Parses a line of a variable, for example `0012 1,0,NAME`. The meaning of the values `1` and `0` is unknown and
    /// not needed.
    fn variable(&mut self, letters: &str, line: &[u8]) {
        if line.is_empty() {
            return;
        }
        let read = || {
            let at = line.iter().position(|byte| *byte == b' ')?;
            let digits = std::str::from_utf8(&line[..at]).ok()?;
            let number: u16 = unsigned(digits).filter(|_| digits.bytes().all(|byte| byte.is_ascii_digit()))?;
            let mut fields = line[at..].trim_ascii_start().splitn(3, |byte| *byte == b',');
            let is_number = |field: Option<&[u8]>| {
                field.is_some_and(|field| !field.is_empty() && field.iter().all(u8::is_ascii_digit))
            };
            let is_form = is_number(fields.next()) && is_number(fields.next());
            fields.next().filter(|_| is_form).map(|name| (number, name))
        };
        match read() {
            Some((number, name)) => self.add(Kind::Variable, format!("{letters}{number}"), name),
            None => self.found.passed_over += 1,
        }
    }

    fn add(&mut self, kind: Kind, address: String, name: &[u8]) {
        let name = name.trim_ascii();
        if name.is_empty() {
            return;
        }
        let name = self.encoding.decode(name);
        if name.len() > MAX_NAME_BYTES {
            self.found.passed_over += 1;
            return;
        }
        self.found.names.push(Name { kind, address, name, source: Source::File(self.file.to_owned()) });
    }
}

/// Formats a file as a controller does, with CR LF. The simulator uses this function.
pub(in crate::yerc) fn written(head: &str, sections: &[(&str, Vec<String>)]) -> String {
    let mut text = format!("{head}\n");
    for (section, lines) in sections {
        // Writing to a string never fails.
        let _ = writeln!(text, "{section}");
        for line in lines {
            let _ = writeln!(text, "{line}");
        }
    }
    text.replace('\n', "\r\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads hand-made files. They have the format of the published files, which may not be copied. Names and positions
    /// are different, except the positions that prove a fact.
    fn read_text(file: &str, text: &str) -> Vec<String> {
        let found = read(file, &encode(text), Encoding::ShiftJis).unwrap();
        found.names.iter().map(|name| format!("{}={}", name.address, name.name)).collect()
    }

    fn encode(text: &str) -> Vec<u8> {
        Encoding::ShiftJis.encode(&text.replace('\n', "\r\n")).unwrap()
    }

    #[test]
    fn signal_files_have_four_names_per_line() {
        // OT#(17) is #10030, OT#(19) #10032, OT#(21) #10034 (see the module comment); IN#(1) is #00010.
        let text = "/IONAME\n//IN\nGATE,VACUUM GOOD,,\n,,,\n//OUT\nRUN,,,\n,,,\n,,,\n,,,\nAIR,,LOCK,\nFILTER,,,LAST\n";
        let expected = [
            "#00010=GATE",
            "#00011=VACUUM GOOD",
            "#10010=RUN",
            "#10030=AIR",
            "#10032=LOCK",
            "#10034=FILTER",
            "#10037=LAST",
        ];
        assert_eq!(read_text("IONAME.DAT", text), expected);
        let external = "/EXIONAME\n//EXIN\n,,,\n扉,,,\n//EXOUT\nLAMP,,,\n";
        assert_eq!(read_text("EXIONAME.DAT", external), ["#20014=扉", "#30010=LAMP"]);
    }

    #[test]
    fn variable_lines_contain_their_number() {
        let text = "//VARNAME\n///SHARE 100,100,100,100,100,128,128,128\n///B\n0000 1,0,MOVE\n\n0017 1,0,A, B\n\n\n\
                    ///P\n0000 1,0,HERE\n0120 1,0,FAR\n0002 1,0,NEAR\n///BP\n///EX\n0000 1,0,HOME\n";
        assert_eq!(
            read_text("VARNAME.DAT", text),
            ["B0=MOVE", "B17=A, B", "P0=HERE", "P120=FAR", "P2=NEAR", "EX0=HOME"]
        );
    }

    #[test]
    fn line_number_is_the_register_number() {
        // Controllers write the first line with this spelling.
        assert_eq!(read_text("IOMNAME.DAT", "/IOMMAME\n//NAME\n\n\nSPEED\n\nCOUNT\n"), ["M2=SPEED", "M4=COUNT"]);
    }

    #[test]
    fn skips_or_rejects_other_formats() {
        let read = |text: &str| read("X.DAT", &encode(text), Encoding::ShiftJis);
        let odd = read("/IONAME\n//IN\nA,B\nC,,,\n//ELSE\nX,,,\n///B\nno number\n0001 NAME\n1 1,0,OK\n").unwrap();
        assert_eq!(odd.passed_over, 3);
        assert_eq!(odd.names.iter().map(|name| name.address.as_str()).collect::<Vec<_>>(), ["#00014", "B1"]);
        assert_eq!(read("IONAME\n//IN\n"), Err(WrongFile::Head));
        assert_eq!(read("/IONAME\n//OTHER\nA,,,\n"), Err(WrongFile::Sections));
        assert_eq!(read(""), Err(WrongFile::Head));
        let long = format!("/IOMMAME\n//NAME\n{}\n", "A".repeat(MAX_NAME_BYTES + 1));
        assert_eq!(read(&long).unwrap().passed_over, 1);
    }

    #[test]
    fn addresses_have_a_canonical_form() {
        let written = |text| (GRAMMAR.address)(text).map(|(_, address)| address);
        for (text, address) in [("27010", "#27010"), ("#10", "#00010"), ("b005", "B5"), ("M007", "M7"), ("ex1", "EX1")]
        {
            assert_eq!(written(text).as_deref(), Some(address), "{text}");
        }
        for text in ["", "clamp", "27018", "B", "M", "X1", "B0..B3"] {
            assert_eq!(written(text), None, "{text}");
        }
    }
}
