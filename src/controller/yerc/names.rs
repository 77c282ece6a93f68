//! Names that a controller keeps for signals, variables and registers: what is in `IONAME.DAT`, `EXIONAME.DAT`,
//! `VARNAME.DAT` and `IOMNAME.DAT`.
//!
//! The manuals of the protocol do not describe these files. What is read here is proven by public material, and nothing
//! beyond it:
//!
//! - The BSD-licensed editor extension `tshikina/YaskawaInformSupport` (`server/src/IoNameDatFile.ts`,
//!   `VarNameDatFile.ts`, `IoMNameDatFile.ts` and its grammars): sections, which name belongs to which number, 16
//!   characters a name.
//! - Saved controllers that were published: `lukelalondePZ/Fiberdome-GP88-Spindle-Cell` (YRC1000), where the name at place
//!   17 of the outputs is that of the job with `OT#(17)`, 19 to 21 likewise, and its ladder program passes #10030 on as
//!   `OT#(17)`; `SinaiAranda/motoman_sda20d_sys`, whose variables are neither in order nor without gaps.
//!
//! Other files with names (`.LST`, `.CND`) have no public description, and are not read.

use std::fmt::Write as _;

use thiserror::Error;

use super::signal::Signal;
use super::variables::Reference;
use crate::names::{Grammar, Kind, LONGEST, Name, Source};
use crate::text::Encoding;
use crate::typed::unsigned;

/// The files that have names, in the order they are asked for.
pub const FILES: [&str; 4] = ["IONAME.DAT", "EXIONAME.DAT", "VARNAME.DAT", "IOMNAME.DAT"];

/// Signals, variables and registers: `#27010`, `B5`, `M5`.
pub const GRAMMAR: Grammar = Grammar { address, prefixes: &["B", "I", "D", "R", "S", "P", "BP", "EX", "M"] };

/// More names than these are in no controller: 8192 signals, and some thousand variables of each kind.
const MOST: usize = 1 << 16;

/// A file that is none of those.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum WrongFile {
    /// It begins otherwise.
    #[error("it does not begin as a file of names does")]
    Head,
    /// None of its sections is known.
    #[error("it has no section that is known")]
    Sections,
    /// It has more names than a controller has addresses.
    #[error("it has more than {MOST} names")]
    Many,
}

/// What a file says.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FileNames {
    /// Its names, in the order of the file.
    pub names: Vec<Name>,
    /// How many lines were passed over, as they have another form.
    pub passed_over: usize,
}

/// The name of a signal.
pub fn signal(signal: Signal) -> (Kind, String) {
    (Kind::Signal, signal.to_string())
}

/// An address as typed, and as it is written.
fn address(text: &str) -> Option<(Kind, String)> {
    if let Some(number) = register(text) {
        return Some((Kind::Register, register_address(number)));
    }
    match text.parse::<Signal>() {
        Ok(found) => Some(signal(found)),
        Err(_) => text.parse::<Reference>().ok().map(|reference| (Kind::Variable, reference.to_string())),
    }
}

/// `M5` and `M005`.
pub fn register(text: &str) -> Option<u16> {
    let digits = text.strip_prefix(['M', 'm'])?;
    unsigned(digits)
}

/// `M5`.
pub fn register_address(number: u16) -> String {
    format!("M{number}")
}

/// Reads one of [`FILES`].
///
/// # Errors
/// It is not of their form.
pub fn read(file: &str, bytes: &[u8], encoding: Encoding) -> Result<FileNames, WrongFile> {
    let mut reader = Reader { file, encoding, section: None, line: 0, found: FileNames::default(), is_known: false };
    // Neither a line feed nor a comma is ever a part of a wider character.
    let mut lines = bytes.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii_end);
    if !lines.next().is_some_and(|head| head.starts_with(b"/")) {
        return Err(WrongFile::Head);
    }
    for line in lines {
        reader.take(line)?;
    }
    if reader.is_known { Ok(reader.found) } else { Err(WrongFile::Sections) }
}

/// What the lines of a section are.
#[derive(Debug, Clone, Copy)]
enum Section {
    /// Four names a line, from the signals of this group on.
    Signals(u16),
    /// A variable of this kind a line: `0012 1,0,NAME`.
    Variables(&'static str),
    /// A name a line, from register 0 on.
    Registers,
}

/// Sections, by the line that begins them. The groups are those of the protocol's signals (FS and DX 3.3.9): general
/// inputs and outputs, and external ones.
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

/// Names of signals in a line.
const A_LINE: usize = 4;

struct Reader<'a> {
    file: &'a str,
    encoding: Encoding,
    section: Option<Section>,
    /// Of the section.
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
        if self.found.names.len() > MOST { Err(WrongFile::Many) } else { Ok(()) }
    }

    fn signals(&mut self, first_group: u16, at: usize, line: &[u8]) {
        let names: Vec<&[u8]> = line.split(|byte| *byte == b',').collect();
        // Which names belong to which signal cannot be told in a line of another length.
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

    /// `0012 1,0,NAME`: what the two numbers are is not known, and nothing depends on them.
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
        if name.len() > LONGEST {
            self.found.passed_over += 1;
            return;
        }
        self.found.names.push(Name { kind, address, name, source: Source::File(self.file.to_owned()) });
    }
}

/// A file as a controller writes it, for the simulator: lines end in CR LF.
pub(in crate::yerc) fn written(head: &str, sections: &[(&str, Vec<String>)]) -> String {
    let mut text = format!("{head}\n");
    for (section, lines) in sections {
        // Nothing fails when text is written to a string.
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

    /// Files made by hand in the form of the published ones, which may not be copied; the names and places are other ones
    /// but for those that prove a place.
    fn read_text(file: &str, text: &str) -> Vec<String> {
        let found = read(file, &encode(text), Encoding::ShiftJis).unwrap();
        found.names.iter().map(|name| format!("{}={}", name.address, name.name)).collect()
    }

    fn encode(text: &str) -> Vec<u8> {
        Encoding::ShiftJis.encode(&text.replace('\n', "\r\n")).unwrap()
    }

    #[test]
    fn signals_have_four_names_a_line() {
        // OT#(17) is #10030, OT#(19) #10032, OT#(21) #10034 (see the head of this file); IN#(1) is #00010.
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
    fn variables_say_their_number() {
        let text = "//VARNAME\n///SHARE 100,100,100,100,100,128,128,128\n///B\n0000 1,0,MOVE\n\n0017 1,0,A, B\n\n\n\
                    ///P\n0000 1,0,HERE\n0120 1,0,FAR\n0002 1,0,NEAR\n///BP\n///EX\n0000 1,0,HOME\n";
        assert_eq!(
            read_text("VARNAME.DAT", text),
            ["B0=MOVE", "B17=A, B", "P0=HERE", "P120=FAR", "P2=NEAR", "EX0=HOME"]
        );
    }

    #[test]
    fn registers_are_counted_by_lines() {
        // The controllers write the head so.
        assert_eq!(read_text("IOMNAME.DAT", "/IOMMAME\n//NAME\n\n\nSPEED\n\nCOUNT\n"), ["M2=SPEED", "M4=COUNT"]);
    }

    #[test]
    fn what_has_another_form_is_passed_over_or_refused() {
        let read = |text: &str| read("X.DAT", &encode(text), Encoding::ShiftJis);
        let odd = read("/IONAME\n//IN\nA,B\nC,,,\n//ELSE\nX,,,\n///B\nno number\n0001 NAME\n1 1,0,OK\n").unwrap();
        assert_eq!(odd.passed_over, 3);
        assert_eq!(odd.names.iter().map(|name| name.address.as_str()).collect::<Vec<_>>(), ["#00014", "B1"]);
        assert_eq!(read("IONAME\n//IN\n"), Err(WrongFile::Head));
        assert_eq!(read("/IONAME\n//OTHER\nA,,,\n"), Err(WrongFile::Sections));
        assert_eq!(read(""), Err(WrongFile::Head));
        let long = format!("/IOMMAME\n//NAME\n{}\n", "A".repeat(LONGEST + 1));
        assert_eq!(read(&long).unwrap().passed_over, 1);
    }

    #[test]
    fn addresses_are_written_one_way() {
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
