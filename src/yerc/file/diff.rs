//! `yerc file diff`: shows the changes that an upload of the local file would make.

use super::compare::{Comparer, Comparison};
use super::content::Content;
use super::name::{self, ReportedName};
use super::transfer;
use crate::prelude::*;
use armctl_frame::backup::compare::{Compared, State};
use armctl_frame::backup::job_date::{DATE_LINE, align_files};
use armctl_frame::backup::manifest::Hash;
use armctl_frame::backup::text_diff::{self, Change, Ending, MAX_TEXT, TextDifference};
use armctl_frame::local_names::{local_name, private_folder};
use armctl_frame::robot::file::{FILES, FileItem};

/// Compares a file on the controller with a local file.
#[derive(Debug, Args)]
pub struct Diff {
    /// Name on the controller
    #[arg(add = complete::FILE)]
    name: String,
    /// Local file [default: the file with the same name in the current folder]
    #[arg(value_name = "FILE")]
    local: Option<PathBuf>,
    /// Also compare the line ///DATE of a job, which controllers rewrite
    #[arg(long)]
    exact: bool,
    /// No effect: jobs are always compared without their date
    #[arg(long, hide = true, conflicts_with = "exact")]
    ignore_header: bool,
}

impl Command for Diff {
    type Family = Yerc;
    type Report = Difference;
    const ID: &'static str = "yerc.file.diff";
    const USES_FILES: bool = true;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Difference> {
        let Context { link, screen, robot, several, .. } = context;
        let file = name::parse_name(link.encoding, &self.name)?;
        let local = self.local.clone().unwrap_or_else(|| {
            private_folder("".as_ref(), &robot.name, several).join(local_name(link.encoding, file.as_bytes()))
        });
        let mut source = Content::open_file(&local)?;
        let shown = ReportedName::new(link.encoding, file.as_bytes());
        let mut controller_bytes = Vec::new();
        let mut progress = screen.bytes_progress(&shown.name, None);
        let without_date = !self.exact && (self.ignore_header || file.file_type() == Some(FileType::Jbi));
        let mut comparer = Comparer::new(source.pieces()?, without_date);
        transfer::fetch(link, &file, |block| {
            progress.advance(block.len() as u64);
            // One byte more than the limit is enough to show that the file is too long.
            let remaining = (MAX_TEXT + 1).saturating_sub(controller_bytes.len());
            controller_bytes.extend_from_slice(block.get(..remaining).unwrap_or(block));
            comparer.take(block)
        })
        .await
        .map_err(|failure| transfer::describe_request(&shown.name, failure))?;
        let (comparison, hash) = comparer.finish()?;
        drop(progress);
        let text = if comparison.first_difference.is_some() && comparison.local_bytes <= MAX_TEXT as u64 {
            let mut local_text = Vec::new();
            let mut pieces = source.pieces()?;
            while local_text.len() <= MAX_TEXT {
                let piece = pieces.next_piece()?;
                if piece.is_empty() {
                    break;
                }
                local_text.extend(piece);
            }
            if without_date {
                ([controller_bytes, local_text], _) = align_files(controller_bytes, local_text);
            }
            TextDifference::of(link.encoding, &controller_bytes, &local_text)
        } else {
            None
        };
        Ok(Difference::new(shown, &local, (comparison, hash), text))
    }
}

/// Difference between a file on the controller (old) and a local file (new).
#[derive(Debug, Serialize, JsonSchema)]
pub struct Difference {
    /// Whether the files are equal. Ignored lines do not count.
    equal: bool,
    /// The local file.
    files: [FileItem<Sides>; 1],
}

/// Further fields of the compared files.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct Sides {
    /// Bytes of the name, if the text cannot be converted back to these bytes.
    name_hex: Option<String>,
    #[serde(flatten)]
    compared: Compared,
    /// Size of the controller's file.
    controller_bytes: u64,
    /// Offset of the first difference; null if there is none.
    first_difference_offset: Option<u64>,
}

impl Difference {
    fn new(
        name: ReportedName,
        local: &Path,
        (comparison, hash): (Comparison, Hash),
        text: Option<TextDifference>,
    ) -> Self {
        let Comparison { controller_bytes, first_difference, dates_differ, .. } = comparison;
        let mut compared = match first_difference {
            Some(_) => Compared::texts(text),
            None if dates_differ => Compared::new(State::SameButDate),
            None => Compared::new(State::Same),
        };
        compared.ignored.extend(dates_differ.then_some(DATE_LINE));
        let ReportedName { name, name_hex } = name;
        let more = Sides { name_hex, compared, controller_bytes, first_difference_offset: first_difference };
        let file = FileItem::new(name, more, Ok(())).with_path(local).with_content(hash);
        Self { equal: first_difference.is_none(), files: [file] }
    }

    fn summary(&self) -> String {
        let [FileItem { name, path, bytes, more, .. }] = &self.files;
        let (path, local_bytes) = (path.as_deref().unwrap_or_default(), bytes.unwrap_or_default());
        let Sides { compared, controller_bytes, first_difference_offset, .. } = more;
        match (first_difference_offset, compared.only_line_endings) {
            (None, _) if !compared.ignored.is_empty() => {
                format!("{name} on the controller and {path} are the same; the comparison ignores the line {DATE_LINE}")
            }
            (None, _) => format!("{name} on the controller and {path} are the same, {local_bytes} bytes"),
            (Some(_), Some(true)) => format!("{name} on the controller and {path} differ only in line endings"),
            (Some(at), None) => {
                format!(
                    "{name} on the controller ({controller_bytes} bytes) and {path} ({local_bytes} bytes) differ, \
                     starting at byte {at}"
                )
            }
            (Some(_), Some(false)) => format!("{name} on the controller and {path} differ"),
        }
    }
}

impl Report for Difference {
    fn view(&self) -> View {
        let [FileItem { name, path, more: Sides { compared, .. }, .. }] = &self.files;
        let path = path.as_deref().unwrap_or_default();
        if let Some(hunks) = compared.changes() {
            let mut lines = text_diff::unified(&format!("{name} (controller)"), path, hunks);
            if !compared.ignored.is_empty() {
                lines.push(format!("the line {DATE_LINE} also differs, but the comparison ignores it").into());
            }
            return View::default().append(Section::Lines(lines)).append(Section::Text(self.summary()));
        }
        match &compared.hunks {
            Some(hunks) if !self.equal => {
                let ends = |bare: Change| {
                    let lines = hunks.iter().flat_map(|hunk| &hunk.lines).filter(|line| line.change == bare);
                    let count = |ending| lines.clone().filter(|line| line.ending == ending).count();
                    let named = [(Ending::CrLf, "CR LF"), (Ending::Lf, "LF"), (Ending::None, "no line ending")];
                    let named = named.map(|(ending, name)| (count(ending), name));
                    named.iter().filter(|(n, _)| *n > 0).map(|(n, name)| format!("{n} with {name}")).collect::<Vec<_>>()
                };
                View::text(format!(
                    "only line endings differ: the controller has {}, {path} has {}",
                    ends(Change::Removed).join(", "),
                    ends(Change::Added).join(", ")
                ))
            }
            _ => View::text(self.summary()),
        }
    }

    fn failure(&self) -> Option<Failure> {
        (!self.equal).then(|| Failure::difference(self.summary()))
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::output::render;

    fn difference(theirs: &[u8], ours: &[u8]) -> Difference {
        let first = theirs.iter().zip(ours).position(|(a, b)| a != b);
        let first = first.or((theirs.len() != ours.len()).then_some(theirs.len().min(ours.len())));
        let comparison = Comparison {
            controller_bytes: theirs.len() as u64,
            local_bytes: ours.len() as u64,
            first_difference: first.map(|at| at as u64),
            dates_differ: false,
        };
        let text = TextDifference::of(Encoding::ShiftJis, theirs, ours);
        let name = ReportedName::new(Encoding::ShiftJis, b"A.JBI");
        Difference::new(name, Path::new("a.jbi"), (comparison, Hash::of(ours)), text)
    }

    fn text(theirs: &[u8], ours: &[u8]) -> String {
        render::text(&difference(theirs, ours).view(), 80, false)
    }

    #[test]
    fn equal_files_are_no_failure() {
        assert!(difference(b"a\r\n", b"a\r\n").failure().is_none());
        assert_eq!(text(b"a\0", b"a\0"), "A.JBI on the controller and a.jbi are the same, 2 bytes\n");
    }

    #[test]
    fn formats_changes_like_diff() {
        let theirs = b"/JOB\r\n1\r\n2\r\n3\r\n4\r\n5\r\n6\r\n'\x83\x5c\x1b\r\nEND\r\n";
        let ours = b"/JOB\r\n1\r\n2\r\n3\r\n4\r\n5\r\n6\r\nMOVJ\n\r\nEND";
        let failure = difference(theirs, ours).failure().unwrap();
        assert_eq!(failure.kind.exit(), 8);
        assert_eq!(
            text(theirs, ours),
            "--- A.JBI (controller)\n+++ a.jbi\n@@ -5,5 +5,6 @@\n 4\n 5\n 6\n-'ソ\\x1b\n-END\n+MOVJ [LF]\n+\n+END\n\
             \\ no line ending\n\nA.JBI on the controller and a.jbi differ\n"
        );
        assert_eq!(
            text(b"", b"a\n"),
            "--- A.JBI (controller)\n+++ a.jbi\n@@ -0,0 +1,1 @@\n+a\n\nA.JBI on the controller and a.jbi differ\n"
        );
    }

    #[test]
    fn summarizes_line_ending_differences() {
        let found = difference(b"a\r\nb\r\nc\r\n", b"a\nb\r\nc");
        let Compared { only_line_endings, hunks, .. } = &found.files[0].more.compared;
        assert_eq!((*only_line_endings, hunks.as_ref().map(Vec::len)), (Some(true), Some(1)));
        assert_eq!(
            render::text(&found.view(), 80, false),
            "only line endings differ: the controller has 2 with CR LF, a.jbi has 1 with LF, 1 with no line ending\n"
        );
    }

    #[test]
    fn reports_the_offset_of_a_binary_difference() {
        assert_eq!(
            text(b"a\0bc", b"a\0bd!"),
            "A.JBI on the controller (4 bytes) and a.jbi (5 bytes) differ, starting at byte 3\n"
        );
        assert!(difference(b"a\0bc", b"a\0bd!").files[0].more.compared.hunks.is_none());
    }

    #[test]
    fn reports_differences_invisible_in_text() {
        // Both byte sequences decode to the same character, but a controller may treat them as different.
        let found = difference(b"\x81\xca\r\n", b"\xee\xf9\r\n");
        assert_eq!(found.files[0].more.compared.hunks.as_ref().map(|hunks| hunks[0].lines.len()), Some(2));
    }
}
