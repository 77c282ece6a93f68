//! Parser for GSD files. A GSD file describes a slave: ident number, bit rates, modules, user parameters.
//!
//! Lines have the form `Keyword = value`. A `\` at the end of a line continues the line. A `;` starts a comment. A
//! block of lines extends from `Module` to `EndModule`. Keywords are not case-sensitive. Unknown keywords are skipped.

use thiserror::Error;

use super::rates::{RATES, Rate};
use super::wire::{Configuration, MAX_DATA, Parameters};

/// Maximum size of a file. Files of manufacturers have a few hundred thousand bytes.
pub const MAX_FILE: u64 = 4 << 20;

/// Contents of a GSD file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Gsd {
    /// Vendor name.
    pub vendor: String,
    /// Model name.
    pub model: String,
    /// Ident number.
    pub ident: u16,
    /// Slave family (main family); 0 means general.
    pub family: Option<u8>,
    /// Bit rates that both the slave and this program support.
    pub rates: Vec<Rate>,
    /// Whether the slave is modular. A slave that is not modular has one fixed set of modules.
    pub is_modular: bool,
    /// User parameters of the slave itself.
    pub parameters: Vec<u8>,
    /// Available modules.
    pub modules: Vec<Module>,
}

/// A module of a slave.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Module {
    /// Name of the module.
    pub name: String,
    /// Identifier bytes of the module.
    pub configuration: Vec<u8>,
    /// User parameters of the module.
    pub parameters: Vec<u8>,
}

/// Error in a GSD file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}: {keyword}: {problem}")]
pub struct GsdError {
    /// Line number, from 1.
    pub line: usize,
    /// The keyword of the line.
    pub keyword: String,
    /// Description of the problem.
    pub problem: String,
}

/// A logical line: a keyword with its value.
struct Entry<'a> {
    line: usize,
    keyword: &'a str,
    value: &'a str,
}

impl Entry<'_> {
    fn error(&self, problem: impl Into<String>) -> GsdError {
        GsdError { line: self.line, keyword: self.keyword.to_owned(), problem: problem.into() }
    }

    fn is(&self, keyword: &str) -> bool {
        self.keyword.eq_ignore_ascii_case(keyword)
    }

    /// Parses a number, for example `0x1F` or `31`.
    fn number(&self, text: &str) -> Result<u32, GsdError> {
        let text = text.trim();
        let hex = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
        let number = hex.map_or_else(|| text.parse(), |digits| u32::from_str_radix(digits, 16));
        number.map_err(|_| self.error(format!("'{text}' is not a number")))
    }

    fn byte(&self, text: &str) -> Result<u8, GsdError> {
        u8::try_from(self.number(text)?).map_err(|_| self.error(format!("'{}' does not fit in one byte", text.trim())))
    }

    fn bytes(&self, text: &str) -> Result<Vec<u8>, GsdError> {
        let bytes: Vec<u8> = text
            .split(',')
            .filter(|part| !part.trim().is_empty())
            .map(|part| self.byte(part))
            .collect::<Result<_, _>>()?;
        if bytes.len() > MAX_DATA { Err(self.error(format!("{} bytes are too many", bytes.len()))) } else { Ok(bytes) }
    }

    /// Splits the value into the quoted text and the rest.
    fn quoted(&self) -> Result<(&str, &str), GsdError> {
        let wrong = || self.error("a name in quotation marks is missing");
        let rest = self.value.trim().strip_prefix('"').ok_or_else(wrong)?;
        rest.split_once('"').ok_or_else(wrong)
    }

    /// Parses bytes of user parameters. The number after the keyword is their offset, for example `(3)`.
    fn place(&self, parameters: &mut Vec<u8>) -> Result<bool, GsdError> {
        let Some((keyword, rest)) = self.keyword.split_once('(') else { return Ok(false) };
        if !keyword.trim().eq_ignore_ascii_case("Ext_User_Prm_Data_Const") {
            return Ok(false);
        }
        let at = usize::try_from(self.number(rest.trim_end_matches([')', ' ']))?).unwrap_or(usize::MAX);
        let bytes = self.bytes(self.value)?;
        if at.saturating_add(bytes.len()) > Parameters::MAX_USER {
            return Err(self.error(format!("at most {} bytes of user parameters are possible", Parameters::MAX_USER)));
        }
        if parameters.len() < at + bytes.len() {
            parameters.resize(at + bytes.len(), 0);
        }
        parameters[at..at + bytes.len()].copy_from_slice(&bytes);
        Ok(true)
    }

    /// Parses the length of the user parameters.
    fn length(&self, parameters: &mut Vec<u8>) -> Result<(), GsdError> {
        let len = usize::try_from(self.number(self.value)?).unwrap_or(usize::MAX);
        if len > Parameters::MAX_USER {
            return Err(self.error(format!("at most {} bytes of user parameters are possible", Parameters::MAX_USER)));
        }
        if parameters.len() < len {
            parameters.resize(len, 0);
        }
        Ok(())
    }
}

impl Gsd {
    /// Parses a file. Bytes above 127 are decoded as Latin-1.
    ///
    /// # Errors
    /// [`GsdError`] contains the line and the keyword.
    pub fn parse(bytes: &[u8]) -> Result<Self, GsdError> {
        let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
        let mut gsd = Self::default();
        let mut module: Option<(usize, Module)> = None;
        let (mut has_header, mut ident) = (false, None);
        for (line, text) in logical_lines(&text) {
            if text.trim().starts_with('#') {
                has_header |= text.trim().eq_ignore_ascii_case("#Profibus_DP");
                continue;
            }
            let (keyword, value) = text.split_once('=').unwrap_or((&text, ""));
            let entry = Entry { line, keyword: keyword.trim(), value: value.trim() };
            if entry.keyword.is_empty() {
                continue;
            }
            if !has_header {
                return Err(entry.error("#Profibus_DP must be before this line; check that this is a GSD file"));
            }
            if let Some((_, inside)) = &mut module {
                if entry.is("EndModule") {
                    gsd.modules.extend(module.take().map(|(_, module)| module));
                } else if entry.is("Module") {
                    return Err(entry.error("EndModule is missing in the module before this line"));
                } else if entry.is("Ext_Module_Prm_Data_Len") {
                    entry.length(&mut inside.parameters)?;
                } else {
                    entry.place(&mut inside.parameters)?;
                }
            } else if entry.is("Module") {
                let (name, configuration) = entry.quoted()?;
                let configuration = entry.bytes(configuration)?;
                Configuration::parse(&configuration).map_err(|error| entry.error(error.to_string()))?;
                module = Some((line, Module { name: name.trim().to_owned(), configuration, parameters: Vec::new() }));
            } else if entry.is("EndModule") {
                return Err(entry.error("Module is missing before this line"));
            } else if entry.is("Ident_Number") {
                let number = entry.number(entry.value)?;
                ident = Some(u16::try_from(number).map_err(|_| entry.error("it must have two bytes"))?);
            } else {
                gsd.take(&entry)?;
            }
        }
        let missing = |line: usize, keyword: &str, problem: &str| GsdError {
            line,
            keyword: keyword.to_owned(),
            problem: problem.to_owned(),
        };
        if let Some((line, _)) = module {
            return Err(missing(line, "Module", "it has no EndModule"));
        }
        gsd.ident = ident.ok_or_else(|| missing(1, "Ident_Number", "it is missing"))?;
        Ok(gsd)
    }

    fn take(&mut self, entry: &Entry<'_>) -> Result<(), GsdError> {
        if entry.is("Vendor_Name") {
            entry.quoted()?.0.trim().clone_into(&mut self.vendor);
        } else if entry.is("Model_Name") {
            entry.quoted()?.0.trim().clone_into(&mut self.model);
        } else if entry.is("Modular_Station") {
            self.is_modular = entry.number(entry.value)? != 0;
        } else if entry.is("Slave_Family") {
            // After the family, an `@` and a sub-family may follow.
            self.family = Some(entry.byte(entry.value.split('@').next().unwrap_or_default())?);
        } else if entry.is("User_Prm_Data_Len") || entry.is("Max_User_Prm_Data_Len") && !self.is_modular {
            entry.length(&mut self.parameters)?;
        } else if entry.is("User_Prm_Data") {
            let bytes = entry.bytes(entry.value)?;
            if self.parameters.len() < bytes.len() {
                self.parameters.resize(bytes.len(), 0);
            }
            self.parameters[..bytes.len()].copy_from_slice(&bytes);
        } else if let Some(rate) = rate(entry.keyword) {
            if entry.number(entry.value)? != 0 {
                self.rates.push(rate);
            }
        } else {
            entry.place(&mut self.parameters)?;
        }
        Ok(())
    }

    /// Combines modules by name. Returns identifier bytes and user parameters.
    ///
    /// # Errors
    /// A description of the problem: an unknown name, or too many modules.
    pub fn assemble(&self, names: &[&str]) -> Result<(Vec<u8>, Vec<u8>), String> {
        let (mut configuration, mut parameters) = (Vec::new(), self.parameters.clone());
        for name in names {
            let found = self.modules.iter().find(|module| module.name.eq_ignore_ascii_case(name.trim()));
            let module = found.ok_or_else(|| {
                let names: Vec<&str> = self.modules.iter().map(|module| module.name.as_str()).collect();
                format!("no module '{name}'; known: {}", names.join(", "))
            })?;
            configuration.extend(&module.configuration);
            parameters.extend(&module.parameters);
        }
        if parameters.len() > Parameters::MAX_USER {
            return Err("these modules have too many user parameters for a telegram".to_owned());
        }
        Ok((configuration, parameters))
    }

    /// Returns the module (or set of modules) with these image sizes. Returns `None` if no module fits, or more than
    /// one.
    pub fn fitting(&self, input: usize, output: usize) -> Option<&Module> {
        let mut fitting = self.modules.iter().filter(|module| {
            Configuration::parse(&module.configuration)
                .is_ok_and(|configuration| (configuration.input(), configuration.output()) == (input, output))
        });
        let first = fitting.next()?;
        fitting.next().is_none().then_some(first)
    }
}

/// Bit rate that a keyword stands for, for example `45.45_supp`.
fn rate(keyword: &str) -> Option<Rate> {
    let name = keyword.to_ascii_lowercase();
    let name = name.strip_suffix("_supp")?;
    RATES.into_iter().find(|rate| match rate.name {
        "1.5M" => name == "1.5m",
        other => other.trim_end_matches('k') == name,
    })
}

/// Returns the logical lines without comments. Each line has the number of its first line in the file.
fn logical_lines(text: &str) -> Vec<(usize, String)> {
    let mut lines = Vec::new();
    let mut open: Option<(usize, String)> = None;
    for (number, line) in (1..).zip(text.lines()) {
        let line = without_comment(line).trim_end();
        let (part, goes_on) = line.strip_suffix('\\').map_or((line, false), |part| (part, true));
        let (first, mut whole) = open.take().unwrap_or((number, String::new()));
        whole.push_str(part);
        if goes_on {
            open = Some((first, whole));
        } else {
            lines.push((first, whole));
        }
    }
    lines.extend(open);
    lines
}

/// A `;` in quotation marks does not start a comment.
fn without_comment(line: &str) -> &str {
    let mut is_quoted = false;
    for (at, character) in line.char_indices() {
        match character {
            '"' => is_quoted = !is_quoted,
            ';' if !is_quoted => return &line[..at],
            _ => {}
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FILE: &str = r#"; a slave that is made up
#Profibus_DP
GSD_Revision = 3
Vendor_Name = "Somebody; else" ; a comment
Model_Name  = "Robot"
Ident_Number = 0x1234
Slave_Family = 3@TdF@Robots
9.6_supp = 1
45.45_supp = 0
500_supp = 1
1.5M_supp = 1
12M_supp = 1
MaxTsdr_9.6 = 60
Modular_Station = 1
User_Prm_Data_Len = 5
User_Prm_Data = 0x00, 0x00, \
                0x00
Ext_User_Prm_Data_Const(3) = 0x10, 0x20
Module = "24 words in, out" 0xC0, 0xD7, \
  0xD7
1
Ext_Module_Prm_Data_Len = 2
Ext_User_Prm_Data_Const(0) = 0x01,0x02
EndModule
Module = "2 words" 0x71
EndModule
"#;

    #[test]
    fn parses_all_values_for_a_master() {
        let gsd = Gsd::parse(FILE.as_bytes()).unwrap();
        assert_eq!((gsd.vendor.as_str(), gsd.model.as_str()), ("Somebody; else", "Robot"));
        assert_eq!((gsd.ident, gsd.family, gsd.is_modular), (0x1234, Some(3), true));
        let rates: Vec<&str> = gsd.rates.iter().map(|rate| rate.name).collect();
        assert_eq!(rates, ["9.6k", "500k", "1.5M"]);
        assert_eq!(gsd.parameters, [0, 0, 0, 0x10, 0x20]);
        let (configuration, parameters) = gsd.assemble(&["24 WORDS in, out"]).unwrap();
        assert_eq!((configuration.as_slice(), parameters.len()), (&[0xC0, 0xD7, 0xD7][..], 7));
        assert_eq!(gsd.fitting(48, 48).unwrap().name, "24 words in, out");
        assert_eq!(gsd.fitting(2, 2), None);
        assert!(gsd.assemble(&["24"]).unwrap_err().contains("known: 24 words in, out, 2 words"));
    }

    #[test]
    fn errors_have_line_and_keyword() {
        for (from, to, message) in [
            ("0x1234", "0x12345", "line 6: Ident_Number: it must have two bytes"),
            ("Ident_Number = 0x1234", "", "line 1: Ident_Number: it is missing"),
            ("0x10, 0x20", "0x10, 0x200", "line 18: Ext_User_Prm_Data_Const(3): '0x200' does not fit in one byte"),
            (
                "Const(3)",
                "Const(300)",
                "line 18: Ext_User_Prm_Data_Const(300): at most 237 bytes of user parameters are possible",
            ),
            (
                "0xC0, 0xD7, \\\n  0xD7",
                "0xC0",
                "line 19: Module: length of an identifier at offset 1: needs 1 bytes, but only 0 are present",
            ),
            ("\"2 words\"", "2 words", "line 25: Module: a name in quotation marks is missing"),
            ("0x71\nEndModule", "0x71", "line 25: Module: it has no EndModule"),
            (
                "#Profibus_DP",
                "",
                "line 3: GSD_Revision: #Profibus_DP must be before this line; check that this is a GSD file",
            ),
            ("User_Prm_Data_Len = 5", "User_Prm_Data_Len = five", "line 15: User_Prm_Data_Len: 'five' is not a number"),
        ] {
            assert!(FILE.contains(from), "{from}");
            let error = Gsd::parse(FILE.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn no_file_makes_it_panic(cut in 0..FILE.len(), at in 0..FILE.len(), byte in any::<u8>()) {
            let mut bytes = FILE.as_bytes()[..cut.max(1)].to_vec();
            let at = at % bytes.len();
            bytes[at] = byte;
            let _ = Gsd::parse(&bytes);
        }

        #[test]
        fn no_text_makes_it_panic(text in "(#Profibus_DP\n)?((Module|EndModule|[A-Z_a-z]{1,12}(\\([0-9]{1,9}\\))?) ?=? ?[0-9x,\"\\\\; ]{0,12}\n){0,12}") {
            let _ = Gsd::parse(text.as_bytes());
        }
    }
}
