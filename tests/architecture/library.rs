//! Compares the public items of `armctl-client` with those of the last release, which `docs/library.txt` lists. Also
//! checks that each of its types has an example. The items that it re-exports count too.
//!
//! The list is made from the sources, which rustfmt lays out. A line is a path and a declaration. Items that macros
//! declare have their names only.

use std::collections::BTreeSet;

use super::source::{Source, expand_tree, has_word, root, sources};
use super::surface::{is_next_major, version};

#[test]
fn breaks_nothing_of_the_last_release() {
    let path = root().join("docs/library.txt");
    let current = listing(&sources());
    let blessed = std::env::var("ARMCTL_BLESS").ok();
    let released = match std::fs::read_to_string(&path) {
        Err(_) if blessed.is_some() => current.clone(),
        read => read.expect("docs/library.txt is there"),
    };
    let lines = |text: &str| text.lines().skip(1).map(str::to_owned).collect::<BTreeSet<_>>();
    let only = |one: &str, other: &str| lines(one).difference(&lines(other)).cloned().collect::<Vec<_>>().join("\n");
    let (gone, new) = (only(&released, &current), only(&current, &released));
    let is_allowed = is_next_major(version(&released), version(&current)) || blessed.as_deref() == Some("breaking");
    assert!(
        gone.is_empty() || is_allowed,
        "gone or changed since release {} of armctl-client:\n{gone}\nnew:\n{new}\nKeep the old form, or set a new major \
         version. If no release has it, run `ARMCTL_BLESS=breaking cargo test --test architecture library`.",
        version(&released),
    );
    if blessed.is_some() {
        std::fs::write(&path, current).expect("the file can be written");
    } else {
        let hint = "docs/library.txt is not current; run `ARMCTL_BLESS=1 cargo test --test architecture library`";
        assert!(released == current, "{hint}\ngone:\n{gone}\nnew:\n{new}");
    }
}

#[test]
fn every_type_of_the_client_has_an_example() {
    let files: Vec<Source> = sources().into_iter().filter(is_of_client).collect();
    // Docs of the types of a file: name and text. `code` has no comments, but the same lines as `text`.
    let docs: Vec<(String, String, String)> = files
        .iter()
        .flat_map(|file| {
            let lines: Vec<&str> = file.text.lines().collect();
            let declared = statements(&file.code, 0).into_iter().filter(Statement::is_public_type);
            declared.map(move |statement| {
                let above = lines[..statement.line].iter().rev().take_while(|line| line.starts_with(['/', '#']));
                let docs: Vec<&str> = above.filter(|line| line.starts_with("///")).copied().collect();
                let docs: String = docs.into_iter().rev().map(|line| format!("{line}\n")).collect();
                (module(file), statement.name(), docs)
            })
        })
        .collect();
    let has_example = |(module, name, text): &(String, String, String)| {
        let link = text.split("Example: [`").nth(1).and_then(|rest| rest.split('`').next());
        let Some(link) = link.map(|link| link.trim_start_matches("enum@")) else { return text.contains("```") };
        let is_linked = |of: &str, other: &str| other == link && (of == module || of.is_empty());
        docs.iter().any(|(of, other, text)| {
            let example = text.split("```").nth(1).unwrap_or_default();
            is_linked(of, other) && example.contains(name.as_str())
        })
    };
    let without: Vec<String> =
        docs.iter().filter(|item| !has_example(item)).map(|(module, name, _)| format!("{module}::{name}")).collect();
    assert!(docs.len() > 30, "the types are found: {}", docs.len());
    assert_eq!(without, [""; 0], "give each an example, or a line `/// Example: [`TYPE`]` whose example uses it");
}

/// A declaration, as rustfmt lays it out.
#[derive(Debug)]
struct Statement {
    attributes: String,
    /// Text up to the body, in one line.
    head: String,
    body: String,
    /// Number of the first line after the attributes, counted from 0.
    line: usize,
}

impl Statement {
    fn is_public(&self) -> bool {
        self.head.starts_with("pub ") && !self.attributes.contains("doc(hidden)")
    }

    fn is_public_type(&self) -> bool {
        let kinds = ["pub struct ", "pub enum ", "pub trait ", "pub type "];
        self.is_public() && kinds.iter().any(|kind| self.head.starts_with(kind))
    }

    /// Name of a declared item, or of the type of an `impl`.
    fn name(&self) -> String {
        let head = self.head.split(" where ").next().unwrap_or_default();
        let words = if head.starts_with("impl") {
            let of = head.split_once(" for ").map_or_else(|| after_generics(&head[4..]), |(_, of)| of);
            of.trim_start().rsplit("::").last().unwrap_or_default().to_owned()
        } else {
            let keywords = ["pub", "async", "const", "struct", "enum", "trait", "type", "fn", "mod", "static"];
            head.split(' ').find(|word| !keywords.contains(word)).unwrap_or_default().to_owned()
        };
        words.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    }

    /// Text without body and value.
    fn signature(&self) -> String {
        let head = if self.head.contains("const ") && !self.head.contains("fn ") {
            self.head.split(" = ").next().unwrap_or_default()
        } else {
            &self.head
        };
        head.trim_start_matches("pub ").trim_end_matches(['{', ';', ' ']).to_owned()
    }

    /// Lines of a list for this item and what belongs to it.
    fn lines(&self) -> Vec<String> {
        let (name, signature) = (self.name(), self.signature());
        let is_open = self.attributes.contains("non_exhaustive");
        let mut lines = Vec::new();
        if self.head.starts_with("impl") {
            if self.head.contains(" for ") {
                return vec![signature];
            }
            let members = statements(&self.body, 4).into_iter().filter(Statement::is_public);
            return members.map(|member| format!("{name}::{}", member.signature())).collect();
        }
        for derived in self.attributes.split("derive(").skip(1).filter_map(|rest| rest.split(')').next()) {
            lines.extend(derived.split(',').map(|derived| format!("{name}: {}", derived.trim())));
        }
        if self.head.starts_with("pub trait ") {
            let (provided, required): (Vec<_>, Vec<_>) =
                statements(&self.body, 4).into_iter().partition(|member| member.head.ends_with('{'));
            let required: Vec<String> = required.iter().map(Statement::signature).collect();
            lines.push(format!("{signature} {{ {} }}", required.join("; ")));
            lines.extend(provided.iter().map(|member| format!("{name}::{}", member.signature())));
        } else if self.head.starts_with("pub mod ") {
            lines.extend(statements(&self.body, 4).iter().map(|member| format!("{name}::{}", member.signature())));
        } else if self.head.ends_with('{') && self.is_public_type() {
            let all = entries(&self.body);
            let is_enum = self.head.starts_with("pub enum ");
            let (public, private): (Vec<&String>, Vec<&String>) =
                all.iter().partition(|entry| is_enum || entry.starts_with("pub "));
            if is_open || !private.is_empty() {
                lines.push(format!("{signature} {{ .. }}"));
                lines.extend(public.iter().map(|entry| format!("{name}.{entry}")));
            } else {
                lines.push(format!("{signature} {{ {} }}", all.join(", ")));
            }
        } else if let Some((head, fields)) = signature.split_once('(').filter(|_| self.head.starts_with("pub struct "))
        {
            let fields = entries(fields.trim_end_matches(')')).into_iter();
            let fields = fields.map(|field| if field.starts_with("pub ") { field } else { "_".to_owned() });
            lines.push(format!("{head}({})", fields.collect::<Vec<_>>().join(", ")));
        } else {
            lines.push(signature);
        }
        lines
    }
}

/// Text after a list of generic parameters at its start.
fn after_generics(text: &str) -> &str {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '<' => depth += 1,
            '>' => depth -= 1,
            _ if depth == 0 => return &text[at..],
            _ => {}
        }
    }
    ""
}

/// Entries of a body: fields or variants, without attributes.
fn entries(body: &str) -> Vec<String> {
    let mut text = body.split_whitespace().collect::<Vec<_>>().join(" ");
    while let Some(start) = text.find("#[") {
        let end = text[start..].find(']').map_or(text.len(), |end| start + end + 1);
        text.replace_range(start..end, "");
    }
    let (mut depth, mut entry, mut all) = (0, String::new(), Vec::new());
    for c in text.chars().chain([',']) {
        match c {
            '(' | '{' | '[' | '<' => depth += 1,
            ')' | '}' | ']' | '>' => depth -= 1,
            ',' if depth == 0 => {
                all.push(std::mem::take(&mut entry).split_whitespace().collect::<Vec<_>>().join(" "));
                continue;
            }
            _ => {}
        }
        entry.push(c);
    }
    all.retain(|entry| !entry.is_empty());
    all
}

/// Declarations with this indentation. Tests at the end of a file do not count.
fn statements(code: &str, indent: usize) -> Vec<Statement> {
    let lines: Vec<&str> = code.lines().collect();
    let begins = |line: &str| {
        line.len() > indent && line[..indent].trim().is_empty() && !line[indent..].starts_with([' ', '}', ')'])
    };
    let ends = |head: &str, line: &str| {
        let is_use = head.starts_with("use ") || head.starts_with("pub use ");
        if is_use { line.ends_with(';') } else { line.ends_with(['{', ';', '}', ']', ',']) }
    };
    let mut all = Vec::new();
    let mut attributes = String::new();
    let mut at = 0;
    while at < lines.len() {
        if !begins(lines[at]) {
            at += 1;
            continue;
        }
        let first = at;
        let (mut head, mut depth) = (String::new(), 0);
        loop {
            let line = lines[at].trim();
            at += 1;
            for c in line.chars() {
                match c {
                    '(' | '[' => depth += 1,
                    ')' | ']' => depth -= 1,
                    _ => {}
                }
            }
            format!("{head} {line}").trim().clone_into(&mut head);
            if at >= lines.len() || depth == 0 && ends(&head, line) {
                break;
            }
        }
        if head.starts_with("#[") {
            attributes.push_str(&head);
            continue;
        }
        let mut body = String::new();
        if head.ends_with('{') {
            let close = format!("{}}}", " ".repeat(indent));
            while at < lines.len() && lines[at].trim_end_matches(';') != close {
                body.push_str(lines[at]);
                body.push('\n');
                at += 1;
            }
        }
        let attributes = std::mem::take(&mut attributes);
        if attributes.contains("cfg(test)") && head.starts_with("mod ") && head.ends_with('{') {
            break;
        }
        // Commas after opening brackets are of rustfmt, and not part of the declaration.
        let head = head.replace("( ", "(").replace(", )", ")").replace(",)", ")");
        all.push(Statement { attributes, head, body, line: first });
    }
    all
}

fn is_of_client(file: &Source) -> bool {
    file.name.starts_with("client/") && !file.name.ends_with("/tests.rs")
}

/// Public module of a file of the client: a family, `units`, or the root.
fn module(file: &Source) -> String {
    let part = file.name.split('/').nth(1).unwrap_or_default().trim_end_matches(".rs");
    if ["toyo", "units", "yerc", "yrcx"].contains(&part) { part.to_owned() } else { String::new() }
}

/// The public items of the client, with a line for the release.
fn listing(sources: &[Source]) -> String {
    let mut lines = BTreeSet::new();
    for file in sources.iter().filter(|file| is_of_client(file)) {
        let module = module(file);
        let path = |line: String| if module.is_empty() { line } else { format!("{module}: {line}") };
        for statement in statements(&file.code, 0) {
            if statement.head.starts_with("pub use armctl_") {
                let tree = statement.head.trim_start_matches("pub use ").trim_end_matches(';');
                expand_tree(tree, "", &mut |item| lines.extend(reexported(sources, item).into_iter().map(&path)));
            } else if statement.is_public()
                && !statement.head.starts_with("pub use ")
                && !statement.head.contains("mod ")
                || statement.head.starts_with("impl")
            {
                lines.extend(statement.lines().into_iter().map(&path));
            }
        }
    }
    let lines: Vec<String> = lines.into_iter().collect();
    format!("release {}\n{}\n", env!("CARGO_PKG_VERSION"), lines.join("\n"))
}

/// Lines of a re-exported item, for example `armctl_controller::yerc::query::ReadStatus`.
fn reexported(sources: &[Source], item: &str) -> Vec<String> {
    let path = item.trim_start_matches("armctl_").replace("::", "/");
    let (folder, name) = path.rsplit_once('/').expect("an item is in a crate");
    let crate_and_family: Vec<&str> = folder.split('/').take(2).collect();
    let family = crate_and_family.join("/");
    let is_in = |file: &Source, folder: &str| {
        let stem = file.name.trim_end_matches(".rs").trim_end_matches("/mod");
        stem == folder || stem.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'))
    };
    // A whole module.
    if let Some(file) = sources.iter().find(|file| file.name == format!("{path}.rs")) {
        let public = statements(&file.code, 0).into_iter().filter(Statement::is_public_type);
        return public.flat_map(|item| item.lines()).map(|line| format!("{name}::{line}")).collect();
    }
    let mut lines = Vec::new();
    for file in sources.iter().filter(|file| is_in(file, folder)) {
        for statement in statements(&file.code, 0) {
            if statement.is_public() && statement.name() == name && !statement.head.starts_with("pub use ") {
                lines.extend(statement.lines());
                // A macro that has an `impl` of this type declares some of its functions.
                let has_impl = file.code.contains(&format!("  impl {name} {{"));
                let declared = declared_by_macros(file).into_iter().filter(|_| has_impl);
                lines.extend(declared.map(|declared| format!("{name}, by a macro: {declared}")));
            }
        }
    }
    if lines.is_empty() {
        for file in sources.iter().filter(|file| is_in(file, folder)) {
            let declared = declared_by_macros(file);
            if declared.iter().any(|declared| declared == name) {
                lines.push(format!("{name}, by a macro"));
            } else if ["enum", "struct"].iter().any(|kind| file.code.contains(&format!("pub {kind} {name} "))) {
                lines.extend(declared.iter().map(|declared| format!("{name}, by a macro: {declared}")));
            }
        }
    }
    if lines.is_empty() {
        let mut files = sources.iter().filter(|file| is_in(file, folder));
        let is_foreign =
            |statement: &Statement| statement.head.starts_with("pub use ") && has_word(&statement.head, name);
        assert!(files.any(|file| statements(&file.code, 0).iter().any(is_foreign)), "{item} is not found");
        lines.push(format!("{name}, of another crate"));
    }
    for file in sources.iter().filter(|file| is_in(file, &family)) {
        let own = statements(&file.code, 0).into_iter();
        let own = own.filter(|statement| statement.head.starts_with("impl") && statement.name() == name);
        lines.extend(own.flat_map(|statement| statement.lines()));
    }
    lines
}

/// Names that the macros of a file declare: the first word of each entry.
fn declared_by_macros(file: &Source) -> Vec<String> {
    let calls = statements(&file.code, 0).into_iter().filter(|statement| {
        statement.head.ends_with("! {") && !statement.head.contains(' ')
            || statement.head.split(' ').next().is_some_and(|word| word.ends_with('!') && word != "macro_rules!")
    });
    let first_word = |line: &str| -> String {
        let line = line.strip_prefix("    ").filter(|line| line.starts_with(char::is_alphabetic)).unwrap_or_default();
        line.trim_start_matches("pub ").chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let names = calls.flat_map(|call| call.body.lines().map(first_word).collect::<Vec<_>>());
    names.filter(|name| !name.is_empty()).collect()
}

#[test]
fn lists_declarations() {
    let code = "\
pub use armctl_controller::yerc::query::{
    Query, ReadStatus, Selection,
};

#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Error {
    #[error()]
    Refused(#[from] Refusal),
    NoAnswer {
        waited: Duration,
    },
}

pub struct Options {
    pub retries: u32,
    pub timeout: Option<Duration>,
}

pub struct Client {
    pub totals: Totals,
    private: u8,
}

#[doc(hidden)]
pub struct Hidden;

pub trait Watcher<E> {
    fn event(&mut self, event: E);
    fn frame(&mut self) {
        let _ = 1;
    }
}

impl<E> Watcher<E> for () {}

impl Client {
    pub const LIMIT: u32 = 3;

    pub async fn ask<Q: Query>(
        &mut self,
        query: &Q,
    ) -> Result<Q::Answer, Error> {
        Ok(())
    }

    fn inner(&self) {}

    #[doc(hidden)]
    pub fn hidden(&self) {}
}

pub struct Id(u8, pub u8);

pub(crate) fn no() {}

#[cfg(test)]
mod tests {
    pub struct InTests;
}
";
    let protocol = "\
macro_rules! order {
    ($name:ident) => {
        pub struct $name;
    };
}
order! {
    ReadStatus, 0x72
}
pub trait Query {
    type Answer;
}
pub enum Selection {
    Execute { line: u32 },
    Master,
}
impl Selection {
    pub fn line(self) -> u32 {
        0
    }
}
";
    let files = [("client/yerc/x.rs", code), ("controller/yerc/query/read.rs", protocol)];
    let expected = "\
release VERSION
yerc: Client.pub totals: Totals
yerc: Client::async fn ask<Q: Query>(&mut self, query: &Q) -> Result<Q::Answer, Error>
yerc: Client::const LIMIT: u32
yerc: Error.NoAnswer { waited: Duration, }
yerc: Error.Refused( Refusal)
yerc: Error: Clone
yerc: Error: Debug
yerc: ReadStatus, by a macro
yerc: Selection::fn line(self) -> u32
yerc: Watcher::fn frame(&mut self)
yerc: enum Error { .. }
yerc: enum Selection { Execute { line: u32 }, Master }
yerc: impl<E> Watcher<E> for () {}
yerc: struct Client { .. }
yerc: struct Id(_, pub u8)
yerc: struct Options { pub retries: u32, pub timeout: Option<Duration> }
yerc: trait Query { type Answer }
yerc: trait Watcher<E> { fn event(&mut self, event: E) }
";
    let files = files.map(|(name, text)| Source::new(name, text));
    assert_eq!(listing(&files), expected.replace("VERSION", env!("CARGO_PKG_VERSION")));
}
