//! Existence of files on the controller, according to its lists. With this information, the confirmation can name the
//! files that will be overwritten or deleted.

use super::transfer;
use crate::prelude::*;
use armctl_controller::yerc::files;
use armctl_frame::backup::continues_after;

/// Whether a file exists on the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existence {
    /// The file exists.
    Yes,
    /// The file does not exist.
    No,
    /// Unknown, because there is no list of this type, or the controller refused to send it.
    Unlisted,
}

/// Lists of file names, for some types.
#[derive(Debug, Default)]
pub struct Lists(Vec<(FileType, Option<Vec<Vec<u8>>>)>);

impl Lists {
    /// Reads the lists for these files. In a dry run, records the requests and returns `None`.
    pub async fn ask<'a>(link: &mut Link, is_asked: impl IntoIterator<Item = &'a FileName>) -> Result<Option<Self>> {
        let mut types: Vec<FileType> = Vec::new();
        for kind in is_asked.into_iter().filter_map(FileName::file_type) {
            if !types.contains(&kind) {
                types.push(kind);
            }
        }
        if link.is_dry_run() {
            for kind in types {
                link.plan_download(&files::list(kind), Reason::about(transfer::LISTS))?;
            }
            return Ok(None);
        }
        let mut lists = Self::default();
        for kind in types {
            let names = match transfer::list(link, kind).await {
                Ok(names) => Some(names),
                Err(failure) if continues_after(&failure) => None,
                Err(failure) => return Err(transfer::describe_request(&kind.filter(), failure)),
            };
            lists.0.push((kind, names));
        }
        Ok(Some(lists))
    }

    /// Whether a file exists. A name that differs only in upper and lower case also counts, because a controller may
    /// treat it as the same file.
    pub fn existence(&self, file: &FileName) -> Existence {
        let list = self.0.iter().find(|(kind, _)| Some(*kind) == file.file_type());
        match list {
            Some((_, Some(names))) if names.iter().any(|name| name.eq_ignore_ascii_case(file.as_bytes())) => {
                Existence::Yes
            }
            Some((_, Some(_))) => Existence::No,
            Some((_, None)) | None => Existence::Unlisted,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refused_list_leaves_existence_unknown() {
        let file = |name: &str| FileName::new(name).unwrap();
        let lists = Lists(vec![(FileType::Jbi, Some(vec![b"a.JBI".to_vec()])), (FileType::Prm, None)]);
        assert_eq!(lists.existence(&file("A.JBI")), Existence::Yes);
        assert_eq!(lists.existence(&file("B.JBI")), Existence::No);
        assert_eq!(lists.existence(&file("ALL.PRM")), Existence::Unlisted);
        assert_eq!(lists.existence(&file("A.DAT")), Existence::Unlisted);
    }
}
