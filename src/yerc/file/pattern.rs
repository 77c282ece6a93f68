//! Patterns of file names, such as `*.JBI`. They are matched against the lists of the controller. A pattern is never
//! sent, because a controller might interpret it differently.

use super::name::{self, ReportedName};
use super::transfer;
use crate::link::Link;
use armctl_controller::yerc::files::{self, FileName, FileType};
use armctl_frame::backup::continues_after;
use armctl_frame::failure::{Failure, Kind};
use armctl_frame::settings::inventory::matches_pattern;

/// A requested file, or the reason why no file was found.
#[derive(Debug)]
pub struct FilePattern {
    /// Name of the file, or the pattern or list that has no result.
    pub name: ReportedName,
    /// Name to send to the controller.
    pub file: Result<FileName, Failure>,
}

/// Whether an argument is a pattern. An argument with `hex:` is always a name.
pub fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?']) && !text.starts_with("hex:")
}

/// File types that a pattern can match.
fn types(pattern: &str) -> Vec<FileType> {
    let ending = pattern.rsplit_once('.').map_or("*", |(_, ending)| ending);
    FileType::ALL.into_iter().filter(|kind| matches_pattern(&ending.to_uppercase(), kind.extension())).collect()
}

/// Finds the files for arguments, without duplicates. Names are used unchanged, and patterns are replaced by the names
/// that match. In a dry run, records the requests and returns `None`.
pub async fn find(link: &mut Link, asked: &[String]) -> Result<Option<Vec<FilePattern>>, Failure> {
    let (patterns, names): (Vec<&String>, Vec<&String>) = asked.iter().partition(|text| is_pattern(text));
    let names: Vec<String> = names.into_iter().cloned().collect();
    let files = name::parse_names(link.encoding, &names)?;
    let kinds: Vec<FileType> = {
        let wanted: Vec<FileType> = patterns.iter().flat_map(|pattern| types(pattern)).collect();
        FileType::ALL.into_iter().filter(|kind| wanted.contains(kind)).collect()
    };
    if let Some(pattern) = patterns.iter().find(|pattern| types(pattern).is_empty()) {
        return Err(Failure::usage(format!("no controller file can match '{pattern}'"))
            .hint("use a file name that ends in JBI, DAT, CND, PRM, SYS or LST"));
    }
    if link.is_dry_run() {
        transfer::plan_all(link, transfer::LISTS, kinds.into_iter().map(files::list))?;
        transfer::plan_all(link, "downloads the file", files.iter().map(FileName::save))?;
        if !patterns.is_empty() {
            link.then("armctl downloads every listed file that matches a pattern, and acknowledges each block");
        }
        return Ok(None);
    }
    let encoding = link.encoding;
    let shown = |bytes: &[u8]| ReportedName::new(encoding, bytes);
    let mut found: Vec<FilePattern> =
        files.into_iter().map(|file| FilePattern { name: shown(file.as_bytes()), file: Ok(file) }).collect();
    let mut matched = vec![false; patterns.len()];
    let mut refused = Vec::new();
    for kind in kinds {
        let listed = match transfer::list(link, kind).await {
            Ok(listed) => listed,
            Err(failure) if continues_after(&failure) => {
                refused.push(FilePattern { name: shown(kind.filter().as_bytes()), file: Err(failure) });
                continue;
            }
            Err(failure) => return Err(transfer::describe_request(&kind.filter(), failure)),
        };
        for bytes in listed {
            let name = shown(&bytes);
            let mut matches_any = false;
            for (pattern, fitted) in patterns.iter().zip(&mut matched) {
                let is_match = matches_pattern(pattern, &name.name);
                *fitted |= is_match;
                matches_any |= is_match;
            }
            let is_new = !found.iter().any(|other| other.name == name);
            if matches_any && is_new {
                // If the list contains a name that is not allowed, this is an error of the controller, and not of the
                // user.
                let file = name::exact(bytes).map_err(|failure| Failure { kind: Kind::Malformed, ..failure });
                found.push(FilePattern { name, file });
            }
        }
    }
    for (pattern, fitted) in patterns.into_iter().zip(matched) {
        // If a list was refused, it is unknown which files match.
        if !fitted && !types(pattern).iter().any(|kind| refused.iter().any(|list| list.name.name == kind.filter())) {
            let no_match = Failure::new(Kind::Refused, "no file on the controller matches")
                .hint("use `yerc file list --type all` to see the names; names are case-sensitive");
            found.push(FilePattern {
                name: ReportedName { name: pattern.clone(), name_hex: None },
                file: Err(no_match),
            });
        }
    }
    found.extend(refused);
    Ok(Some(found))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pattern_selects_the_requested_lists() {
        assert_eq!(types("*.JBI"), [FileType::Jbi]);
        assert_eq!(types("WELD*.jbi"), [FileType::Jbi]);
        assert_eq!(types("*.?S?"), [FileType::Lst]);
        assert_eq!(types("VAR*"), FileType::ALL);
        assert_eq!(types("*"), FileType::ALL);
        assert_eq!(types("*.TXT"), []);
        assert!(is_pattern("A?.JBI") && !is_pattern("A.JBI") && !is_pattern("hex:2a"));
    }
}
