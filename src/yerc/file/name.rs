//! Names and types of files in arguments and in reports.

use crate::prelude::*;
use armctl_controller::text::unhex;
use armctl_frame::robot::file::FileItem;

/// Name of a file in a report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ReportedName {
    /// Name of the file on the controller.
    pub name: String,
    /// Bytes of the name, if the text cannot be converted back to these bytes. To use them as an argument, add the
    /// prefix `hex:`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name_hex: Option<String>,
}

impl ReportedName {
    /// Creates a name from the bytes of a controller.
    pub fn new(encoding: Encoding, name: &[u8]) -> Self {
        let name = encoding.name(name);
        Self { name: name.text, name_hex: name.hex }
    }

    /// Report item for a file that was not tried yet.
    pub fn pending(self) -> FileItem {
        let mut file = FileItem::pending(self.name);
        file.more.name_hex = self.name_hex;
        file
    }
}

/// File type as an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TypeArg {
    /// Jobs
    Jbi,
    /// Tools, variables, user coordinates
    Dat,
    /// Conditions
    Cnd,
    /// Parameters
    Prm,
    /// System data
    Sys,
    /// Ladder and other lists
    Lst,
    /// Every type
    All,
}

impl TypeArg {
    fn file_type(self) -> Option<FileType> {
        Some(match self {
            Self::Jbi => FileType::Jbi,
            Self::Dat => FileType::Dat,
            Self::Cnd => FileType::Cnd,
            Self::Prm => FileType::Prm,
            Self::Sys => FileType::Sys,
            Self::Lst => FileType::Lst,
            Self::All => return None,
        })
    }

    /// Selected types, each only once, in the order of the manual.
    pub fn selected_types(args: &[Self]) -> Vec<FileType> {
        let has = |kind| args.iter().any(|arg| arg.file_type().is_none_or(|chosen| chosen == kind));
        FileType::ALL.into_iter().filter(|kind| has(*kind)).collect()
    }
}

/// Type of a file in reports; `None` if the manuals do not list its extension.
pub fn name_of_type(name: &[u8]) -> Option<&'static str> {
    FileType::from_name(name).map(type_word)
}

/// Name of the type in reports and manifests, such as `jbi`.
pub fn type_word(kind: FileType) -> &'static str {
    match kind {
        FileType::Jbi => "jbi",
        FileType::Dat => "dat",
        FileType::Cnd => "cnd",
        FileType::Prm => "prm",
        FileType::Sys => "sys",
        FileType::Lst => "lst",
    }
}

/// Parses a file argument: text in the robot's encoding, or `hex:` followed by bytes.
pub fn parse_name(encoding: Encoding, text: &str) -> Result<FileName> {
    let bytes = if let Some(digits) = text.strip_prefix("hex:") {
        unhex(digits).ok_or_else(|| {
            Failure::usage(format!("'{text}' has an incomplete hexadecimal byte"))
                .hint("type hex: and the name_hex from `yerc file list --json`, such as hex:5445535430312e4a4249")
        })?
    } else {
        encoding.encode_name(text).map_err(|error| {
            Failure::usage(format!("'{text}': {error}"))
                .hint("set the encoding with --encoding or in the robot's entry in robots.toml")
        })?
    };
    exact(bytes)
}

/// Checks that a name is allowed for an upload.
pub fn name_to_send(file: FileName) -> Result<FileName> {
    match file.check_load() {
        Ok(()) => Ok(file),
        Err(error) => Err(Failure::usage(error.to_string()).hint("use a job name such as TESTJOB.JBI")),
    }
}

/// Parses several file arguments, and rejects duplicates.
pub fn parse_names(encoding: Encoding, texts: &[String]) -> Result<Vec<FileName>> {
    let mut files = Vec::with_capacity(texts.len());
    for text in texts {
        let file = parse_name(encoding, text)?;
        if files.contains(&file) {
            return Err(Failure::usage(format!("{text} appears twice")).hint("type every file once"));
        }
        files.push(file);
    }
    Ok(files)
}

/// Checks that a name has no wildcards. A controller might match `*` or `?` with any name, and delete too many files.
pub fn exact(bytes: Vec<u8>) -> Result<FileName> {
    if bytes.iter().any(|byte| matches!(byte, b'*' | b'?')) {
        return Err(Failure::usage(format!("the file name '{}' contains * or ?", bytes.escape_ascii()))
            .hint("use full file names (see `yerc file list`); only `yerc file get` accepts patterns"));
    }
    FileName::new(bytes).map_err(|error| {
        Failure::usage(error.to_string())
            .hint("use a job name such as TESTJOB.JBI; use `yerc file list` to see the files")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_names_in_text_or_hex() {
        let name = |text| parse_name(Encoding::ShiftJis, text).map(|file| file.as_bytes().to_vec());
        assert_eq!(name("TESTJOB.JBI"), Ok(b"TESTJOB.JBI".to_vec()));
        assert_eq!(name("てすと.JBI"), Ok(b"\x82\xC4\x82\xB7\x82\xC6.JBI".to_vec()));
        assert_eq!(name("A\\xff.JBI"), Ok(b"A\xff.JBI".to_vec()));
        assert_eq!(name("hex:41FF2e4a4249"), Ok(b"A\xff.JBI".to_vec()));
        for wrong in ["hex:4", "hex:4g", "", "A", "A.", "*.JBI", "?.JBI", "../A.JBI", "용접.JBI", "/SPDRV/CMOSBK.BIN"]
        {
            let failure = name(wrong).unwrap_err();
            assert_eq!(failure.kind.exit(), 2, "{wrong}");
            assert!(failure.hint.is_some(), "{wrong}");
        }
    }

    #[test]
    fn rejects_a_repeated_file() {
        let texts = ["A.JBI".to_owned(), "hex:412e4a4249".to_owned()];
        assert!(parse_names(Encoding::ShiftJis, &texts).is_err());
    }

    #[test]
    fn orders_types_as_in_the_manual() {
        assert_eq!(TypeArg::selected_types(&[TypeArg::All]), FileType::ALL);
        assert_eq!(
            TypeArg::selected_types(&[TypeArg::Cnd, TypeArg::Jbi, TypeArg::Cnd]),
            [FileType::Jbi, FileType::Cnd]
        );
    }
}
