//! Reads the source files: the paths that a file uses, without comments and texts.

use std::path::{Path, PathBuf};

/// A source file.
pub struct Source {
    /// Path of the file below `src/`, with slashes.
    pub name: String,
    /// Complete text.
    pub text: String,
    /// Text without comments and string contents. The line numbers stay the same.
    pub code: String,
}

pub fn sources() -> Vec<Source> {
    let src = root().join("src");
    let mut sources: Vec<Source> = committed(&src)
        .into_iter()
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("sources are UTF-8");
            let name = path.strip_prefix(&src).expect("it is below src").to_string_lossy().replace('\\', "/");
            Source::new(&name, &text)
        })
        .collect();
    sources.sort_by(|one, other| one.name.cmp(&other.name));
    assert!(sources.len() > 50, "the sources are found");
    sources
}

impl Source {
    pub fn new(name: &str, text: &str) -> Self {
        Self { name: name.to_owned(), text: text.to_owned(), code: strip_code(text) }
    }

    /// Returns every path of two or more words in the code, with its line number. `use` trees are expanded, and `super`
    /// and `self` are resolved.
    pub fn paths(&self) -> Vec<(usize, String)> {
        let module = self.module();
        let mut paths = Vec::new();
        let mut rest = self.code.as_str();
        let mut line = 1;
        while let Some(start) = rest.find(is_word) {
            line += rest[..start].matches('\n').count();
            rest = &rest[start..];
            let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
            let (word, after) = rest.split_at(end);
            let consumed_size = if word == "use" {
                let end = after.find(';').unwrap_or(after.len());
                expand_tree(&after[..end], "", &mut |path| paths.push((line, resolve(&module, path))));
                end
            } else {
                let mut path = word.to_owned();
                let mut at = 0;
                while let Some(next) = after[at..].strip_prefix("::") {
                    let end = next.find(|c| !is_word(c)).unwrap_or(next.len());
                    if end == 0 {
                        break;
                    }
                    path.push_str("::");
                    path.push_str(&next[..end]);
                    at += 2 + end;
                }
                if at > 0 {
                    paths.push((line, resolve(&module, &path)));
                }
                at
            };
            line += after[..consumed_size].matches('\n').count();
            rest = &after[consumed_size..];
        }
        paths
    }

    /// Path of the module: `crate::output::jq` for `output/jq.rs`, `crate::output` for `output/mod.rs`.
    pub fn module(&self) -> Vec<String> {
        let stem = self.name.trim_end_matches(".rs");
        let stem = stem.strip_suffix("/mod").unwrap_or(stem);
        std::iter::once("crate").chain(stem.split('/')).map(str::to_owned).collect()
    }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Splits a `use` tree: `a::{b, c::{d}}` becomes `a::b` and `a::c::d`.
pub fn expand_tree(tree: &str, prefix: &str, take: &mut impl FnMut(&str)) {
    let tree = tree.trim();
    let Some(open) = tree.find('{') else {
        let path = tree.split(" as ").next().unwrap_or_default();
        let path: String = path.chars().filter(|c| !c.is_whitespace()).collect();
        return take(&format!("{prefix}{}", path.trim_start_matches("::")));
    };
    let prefix = format!("{prefix}{}", tree[..open].trim().trim_start_matches("::"));
    let inside = tree[open + 1..].rsplit_once('}').map_or(&tree[open + 1..], |(inside, _)| inside);
    let (mut depth, mut start) = (0usize, 0);
    for (at, c) in inside.char_indices().chain([(inside.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !inside[start..at].trim().is_empty() {
                    expand_tree(&inside[start..at], &prefix, take);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// Resolves a path, starting at the root of the crate.
fn resolve(module: &[String], path: &str) -> String {
    let mut module = module.to_vec();
    let mut words = path.split("::").peekable();
    let mut is_relative = false;
    while let Some(word) = words.next_if(|word| matches!(*word, "super" | "self")) {
        is_relative = true;
        if word == "super" && module.len() > 1 {
            module.pop();
        }
    }
    if !is_relative {
        return is_in_crate(&module, path);
    }
    module.extend(words.map(str::to_owned));
    module.join("::")
}

/// Path as if all members of the workspace were modules of one crate.
fn is_in_crate(module: &[String], path: &str) -> String {
    const MEMBERS: [&str; 8] = ["client", "controller", "files", "frame", "toyo", "transport", "yerc", "yrcx"];
    let (first, rest) = path.split_once("::").unwrap_or((path, ""));
    let member = match first {
        "crate" => module.get(1).map(String::as_str).filter(|part| MEMBERS.contains(part)),
        other => other.strip_prefix("armctl_").filter(|member| MEMBERS.contains(member)),
    };
    match member {
        Some(member) if rest.is_empty() => format!("crate::{member}"),
        Some(member) => format!("crate::{member}::{rest}"),
        None => path.to_owned(),
    }
}

/// Returns the code without comments and without the contents of string and character literals. The line numbers stay
/// the same.
fn strip_code(text: &str) -> String {
    let mut stripped = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(fence) = raw_fence(rest, &stripped) {
            let open = fence.len() + 1;
            let close = format!("\"{}", &fence[1..]);
            rest[open..].find(&close).map_or(rest.len(), |at| open + at + close.len())
        } else if c == '"' {
            closing(rest, '"')
        } else if c == '\'' && is_character(rest) {
            closing(rest, '\'')
        } else {
            stripped.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        stripped.extend(rest[..skipped].chars().filter(|c| *c == '\n'));
        rest = &rest[skipped..];
    }
    stripped
}

/// The prefix of a raw string that begins here, such as `r##`.
fn raw_fence<'a>(rest: &'a str, before: &str) -> Option<&'a str> {
    let hashes = rest.strip_prefix('r')?;
    let count = hashes.len() - hashes.trim_start_matches('#').len();
    let is_start = hashes[count..].starts_with('"') && !before.ends_with(|c: char| is_word(c) && c != 'b');
    is_start.then(|| &rest[..=count])
}

/// Returns the length of the literal that begins here, including its quotes.
fn closing(rest: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            _ if c == quote => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Whether a character literal begins here. Otherwise the quote begins a lifetime.
fn is_character(rest: &str) -> bool {
    let mut next = rest.chars().skip(1);
    match next.next() {
        Some('\\') => true,
        Some(_) => next.next() == Some('\''),
        None => false,
    }
}

#[test]
fn finds_paths_in_sources() {
    let text =
        "use crate::{a, b::{self, c as d}};\n// use crate::no;\nlet s = \"crate::no\"; let q = '\"';\nsuper::x::y();\n";
    let paths = Source::new("one/two.rs", text).paths();
    let expected = [(1, "crate::a"), (1, "crate::b::self"), (1, "crate::b::c"), (4, "crate::one::x::y")];
    assert_eq!(paths, expected.map(|(line, path)| (line, path.to_owned())));
}

/// Whether the text contains the word. The end of a longer word does not count.
pub fn has_word(text: &str, word: &str) -> bool {
    let ends = |at: usize| text[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_');
    text.match_indices(word).any(|(at, _)| !ends(at))
}

pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every file of the project, except for the files of cargo and git.
pub fn committed(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the folder is readable").filter_map(Result::ok) {
        let (path, name) = (entry.path(), entry.file_name());
        if path.is_dir() {
            if name != "target" && name != ".git" {
                files.extend(committed(&path));
            }
        } else if name != ".git" {
            files.push(path);
        }
    }
    files
}
