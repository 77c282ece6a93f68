//! Editor for `robots.toml`. It keeps the comments and the order.

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TomlError, Value, value};

/// Content of an inventory that can be edited.
#[derive(Debug, Clone)]
pub struct Document {
    toml: DocumentMut,
    /// Whether lines end with CR LF, as Windows editors write them.
    has_crlf: bool,
}

/// Reason why the inventory cannot be edited.
pub type DocumentError = &'static str;

const NO_LIST: DocumentError = "`robot` is not a list of [[robot]] tables";
const NO_ENTRY: DocumentError = "the robot has no [[robot]] table";

impl Document {
    /// Parses the content of an inventory.
    pub fn parse(text: &str) -> Result<Self, TomlError> {
        // toml_edit would write each CR LF as LF.
        let has_crlf = text.split_inclusive('\n').next().is_some_and(|line| line.ends_with("\r\n"));
        Ok(Self { toml: text.replace("\r\n", "\n").parse()?, has_crlf })
    }

    /// Appends an entry. If it is the first entry, it becomes the default.
    pub fn add(&mut self, entry: Table, is_default: bool) -> Result<(), DocumentError> {
        let name = entry.get("name").cloned().unwrap_or_default();
        let list = self.toml.entry("robot").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
        let list = list.as_array_of_tables_mut().ok_or(NO_LIST)?;
        list.push(entry);
        if is_default || list.len() == 1 {
            self.set_default(name.as_str().unwrap_or_default());
        }
        Ok(())
    }

    /// Removes an entry, and the comment directly above it.
    pub fn remove(&mut self, name: &str) -> Result<(), DocumentError> {
        let list = self.list()?;
        let at = list.iter().position(|entry| is_called(entry, name)).ok_or(NO_ENTRY)?;
        let removed_lines = list.remove(at);
        let above = removed_lines.decor().prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default();
        // A comment above an empty line is not about the entry. It may be about the file, for example, so it is kept.
        let kept = above.rfind("\n\n").map_or("", |end| &above[..=end]);
        if kept.contains('#') {
            self.insert_before_table(removed_lines.position(), kept);
        }
        if self.default() == Some(name) {
            self.remove_default();
        }
        Ok(())
    }

    /// Renames an entry. If the entry is the default robot, the default gets the new name.
    pub fn rename(&mut self, old: &str, new: &str) -> Result<(), DocumentError> {
        insert(self.entry(old)?, "name", new.into());
        if self.default() == Some(old) {
            self.set_default(new);
        }
        Ok(())
    }

    /// Sets the default robot.
    pub fn set_default(&mut self, name: &str) {
        let is_first = self.toml.as_table().get_values().is_empty();
        insert(self.toml.as_table_mut(), "default", name.into());
        if is_first {
            self.keep_header();
        }
    }

    /// Moves the header comment of the file above the new first key.
    fn keep_header(&mut self) {
        let Some(first) = self.tables().min_by_key(|table| table.position()) else { return };
        let above = first.decor().prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default().to_owned();
        let Some(end) = above.rfind("\n\n").filter(|_| above.contains('#')) else { return };
        let (head, own) = above.split_at(end + 1);
        first.decor_mut().set_prefix(own);
        if let Some(mut key) = self.toml.as_table_mut().key_mut("default") {
            key.leaf_decor_mut().set_prefix(format!("{head}\n"));
        }
    }

    /// Sets or removes a setting of an entry. Returns the old value.
    pub fn set(&mut self, name: &str, key: &str, new: Option<Value>) -> Result<Option<Value>, DocumentError> {
        let entry = self.entry(name)?;
        if let Some(name) = key.strip_prefix("names.") {
            return set_name(entry, name, new);
        }
        Ok(match new {
            Some(new) => insert(entry, key, new),
            None => entry.remove(key).and_then(|item| item.into_value().ok()),
        })
    }

    fn default(&self) -> Option<&str> {
        self.toml.get("default").and_then(Item::as_str)
    }

    /// Removes the default robot, but keeps the comment above it. The comment may be the header comment of the file.
    pub fn remove_default(&mut self) {
        let Some((key, _)) = self.toml.as_table_mut().remove_entry("default") else { return };
        let above = key.leaf_decor().prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default();
        if above.contains('#') {
            self.insert_before_table(None, above);
        }
    }

    fn list(&mut self) -> Result<&mut ArrayOfTables, DocumentError> {
        self.toml.get_mut("robot").and_then(Item::as_array_of_tables_mut).ok_or(NO_LIST)
    }

    fn entry(&mut self, name: &str) -> Result<&mut Table, DocumentError> {
        self.list()?.iter_mut().find(|entry| is_called(entry, name)).ok_or(NO_ENTRY)
    }

    fn tables(&mut self) -> impl Iterator<Item = &mut Table> {
        self.toml.iter_mut().flat_map(|(_, item)| match item {
            Item::Table(table) => vec![table],
            Item::ArrayOfTables(list) => list.iter_mut().collect(),
            _ => Vec::new(),
        })
    }

    /// Inserts comments before the table that follows a position. If no table follows, inserts them at the end.
    fn insert_before_table(&mut self, place: Option<isize>, text: &str) {
        let next = self.tables().filter(|table| table.position() > place).min_by_key(|table| table.position());
        if let Some(next) = next {
            let own = next.decor().prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default();
            let whole = format!("{text}{own}");
            next.decor_mut().set_prefix(whole);
        } else {
            let whole = format!("{text}{}", self.toml.trailing().as_str().unwrap_or_default());
            self.toml.set_trailing(whole);
        }
    }
}

impl std::fmt::Display for Document {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.has_crlf { f.write_str(&self.toml.to_string().replace('\n', "\r\n")) } else { self.toml.fmt(f) }
    }
}

fn is_called(entry: &Table, name: &str) -> bool {
    entry.get("name").and_then(Item::as_str) == Some(name)
}

/// Sets or removes a name in the table of names of an entry. If the table is then empty, it is removed.
fn set_name(entry: &mut Table, name: &str, new: Option<Value>) -> Result<Option<Value>, DocumentError> {
    const NO_TABLE: DocumentError = "`names` is not a table";

    let Some(new) = new else {
        let Some(names) = entry.get_mut("names") else { return Ok(None) };
        let names = names.as_table_like_mut().ok_or(NO_TABLE)?;
        let old = names.remove(name).and_then(|item| item.into_value().ok());
        if names.is_empty() {
            entry.remove("names");
        }
        return Ok(old);
    };
    let names = entry.entry("names").or_insert_with(|| Item::Table(Table::new()));
    let names = names.as_table_like_mut().ok_or(NO_TABLE)?;
    if let Some(Item::Value(old)) = names.get_mut(name) {
        let mut new = new;
        *new.decor_mut() = old.decor().clone();
        return Ok(Some(std::mem::replace(old, new)));
    }
    names.insert(name, value(new));
    Ok(None)
}

/// Replaces a value, and keeps the comment after it. If the key is missing, adds it at the end of the table. Returns
/// the old value.
fn insert(table: &mut Table, key: &str, mut new: Value) -> Option<Value> {
    if let Some(Item::Value(old)) = table.get_mut(key) {
        *new.decor_mut() = old.decor().clone();
        return Some(std::mem::replace(old, new));
    }
    table.insert(key, value(new));
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with a comment in every usual place.
    const TEXT: &str = "\
# Hall 3, kept by Ann

# who answers when nobody is named
default = \"a\" # for now

[defaults] # of all
timeout = \"2s\"

# Cells

# the old one
[[robot]]
name = \"a\"   # left
read_only = true # until May
target = \"udp://h\"

# the new one
[[robot]]
target = \"udp://i\"
name = \"b\"
# the end
";

    fn changed(change: impl FnOnce(&mut Document)) -> String {
        let mut document = Document::parse(TEXT).unwrap();
        change(&mut document);
        document.to_string()
    }

    /// Returns the removed lines and the added lines, in their order.
    fn difference(text: &str) -> (Vec<&str>, Vec<&str>) {
        let (old, new): (Vec<&str>, Vec<&str>) = (TEXT.lines().collect(), text.lines().collect());
        let gone = old.iter().filter(|line| !new.contains(line)).copied().collect();
        (gone, new.iter().filter(|line| !old.contains(line)).copied().collect())
    }

    #[test]
    fn changes_only_the_requested_setting() {
        let set = changed(|document| {
            assert_eq!(document.set("a", "read_only", Some(false.into())).unwrap().unwrap().as_bool(), Some(true));
            assert!(document.set("b", "retries", Some(5.into())).unwrap().is_none());
        });
        let (gone, new) = difference(&set);
        assert_eq!(gone, ["read_only = true # until May"]);
        assert_eq!(new, ["read_only = false # until May", "retries = 5"]);

        let renamed = changed(|document| document.rename("a", "press").unwrap());
        let (_, new) = difference(&renamed);
        assert_eq!(new, ["default = \"press\" # for now", "name = \"press\"   # left"]);
        let defaulted = changed(|document| document.set_default("b"));
        assert_eq!(difference(&defaulted).1, ["default = \"b\" # for now"]);
        let unset = changed(|document| assert!(document.set("a", "read_only", None).unwrap().is_some()));
        assert_eq!(difference(&unset), (vec!["read_only = true # until May"], vec![]));
    }

    #[test]
    fn writes_names_below_their_entry() {
        let set =
            |document: &mut Document, name: &str, key: &str, new: Option<Value>| document.set(name, key, new).unwrap();
        let named = changed(|document| {
            assert!(set(document, "a", "names.clamp", Some(27010.into())).is_none());
            assert!(set(document, "a", "names.FILTER CLEAN", Some("#10011".into())).is_none());
            assert!(set(document, "b", "names.parts", Some("B5".into())).is_none());
        });
        let expected =
            ["[robot.names]", "clamp = 27010", "\"FILTER CLEAN\" = \"#10011\"", "[robot.names]", "parts = \"B5\""];
        assert_eq!(difference(&named), (vec![], expected.to_vec()));
        assert!(named.find("clamp") < named.find("name = \"b\"") && named.find("parts") > named.find("name = \"b\""));
        let mut document = Document::parse(&named).unwrap();
        assert_eq!(set(&mut document, "a", "names.clamp", Some(27011.into())).unwrap().as_integer(), Some(27010));
        assert!(set(&mut document, "b", "names.parts", None).is_some());
        assert!(set(&mut document, "b", "names.parts", None).is_none());
        let text = document.to_string();
        assert!(text.contains("clamp = 27011") && text.matches("[robot.names]").count() == 1, "{text}");
        assert!(text.contains("# the end"), "{text}");
    }

    #[test]
    fn removes_an_entry_with_its_own_comment() {
        let removed = changed(|document| document.remove("a").unwrap());
        for kept in ["# Hall 3, kept by Ann", "# Cells", "# the new one", "# of all", "# the end", "name = \"b\""] {
            assert!(removed.contains(kept), "{kept}:\n{removed}");
        }
        assert!(!removed.contains("the old one") && !removed.contains("default ="), "{removed}");
        assert!(removed.find("# Cells") > removed.find("timeout"), "{removed}");
        let mut document = Document::parse(&removed).unwrap();
        document.remove("b").unwrap();
        let empty = document.to_string();
        assert!(empty.contains("# Cells") && empty.contains("# Hall 3"), "{empty}");
        assert_eq!(document.remove("b"), Err(NO_ENTRY));
    }

    #[test]
    fn adds_an_entry_at_the_end() {
        let mut entry = Table::new();
        entry.insert("name", value("c"));
        entry.insert("target", value("udp://j"));
        let added = changed(|document| document.add(entry.clone(), false).unwrap());
        assert_eq!(difference(&added), (vec![], vec!["name = \"c\"", "target = \"udp://j\""]));
        assert!(added.find("\"c\"") > added.find("\"b\""), "{added}");
        let mut bare = Document::parse("# Hall 3\n\n# the old one\n[[robot]]\nname = \"a\"\n").unwrap();
        bare.set_default("a");
        let expected = "# Hall 3\n\ndefault = \"a\"\n\n# the old one\n[[robot]]\nname = \"a\"\n";
        assert_eq!(bare.to_string(), expected);
        let mut none = Document::parse("").unwrap();
        none.add(entry, false).unwrap();
        assert!(none.to_string().starts_with("default = \"c\""), "{none}");
        assert!(Document::parse("robot = 1").unwrap().add(Table::new(), false).is_err());
    }

    #[test]
    fn keeps_the_line_ends_of_windows() {
        let mut document = Document::parse(&TEXT.replace('\n', "\r\n")).unwrap();
        document.rename("a", "press").unwrap();
        document.remove("b").unwrap();
        let expected = changed(|document| {
            document.rename("a", "press").unwrap();
            document.remove("b").unwrap();
        });
        assert_eq!(document.to_string(), expected.replace('\n', "\r\n"));
    }
}
