//! Checks that the generated files are current and complete: man pages, schemas and completions.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use armctl::command::families::FAMILIES;
use clap::{CommandFactory as _, ValueEnum as _};

use super::source::{has_word, root};

#[test]
fn completions_cover_all_program_names() {
    use armctl::command::about::completions::Shell;

    assert_eq!(names(&root().join("completions")).len(), Shell::value_variants().len(), "completions/");
    for shell in Shell::value_variants() {
        for name in ["armctl", "yerc", "yrcx", "toyo", "ARMCTL_COMPLETE"] {
            assert!(has_word(shell.script(), name), "{shell:?}: {name}");
        }
    }
}

#[test]
fn documents_name_this_version() {
    let version = env!("CARGO_PKG_VERSION");
    for (file, words) in [
        ("README.md", format!("armctl_{version}-1_amd64.deb")),
        ("README.md", format!("armctl-{version}-linux-x86_64.tar.gz")),
        ("README.md", format!("armctl-{version}-windows-x86_64.zip")),
        ("CHANGELOG.md", format!("## [{version}]")),
    ] {
        assert!(std::fs::read_to_string(root().join(file)).unwrap_or_default().contains(&words), "{file}: {words}");
    }
}

#[test]
fn man_pages_are_current() {
    let pages = armctl::command::about::man::pages(armctl::cli::Cli::command()).expect("the man pages render");
    is_current("man", &pages.into_iter().collect());
}

#[test]
fn schemas_are_current() {
    let generated = armctl::command::about::schema::files().into_iter().map(|(name, schema)| {
        let text = serde_json::to_string_pretty(&schema).expect("a schema is JSON");
        (name, format!("{text}\n").into_bytes())
    });
    is_current("docs/schemas", &generated.collect());
}

#[test]
fn schemas_are_valid() {
    for entry in armctl::command::about::schema::all() {
        let schema = (entry.schema)().to_value();
        if let Err(why) = jsonschema::draft202012::meta::validate(&schema) {
            panic!("{}: {why}", entry.id);
        }
    }
}

/// Reports contain names and values from fixed sets, not sentences, because programs read them.
#[test]
fn reports_contain_no_sentences() {
    const SENTENCES: [&str; 7] = ["done", "message", "text", "result", "summary", "told", "words"];
    let is_text = |schema: &serde_json::Value| schema["type"] == "string" && schema.get("enum").is_none();
    let mut found = Vec::new();
    for entry in armctl::command::about::schema::all() {
        let schema = (entry.schema)().to_value();
        let Some(fields) = schema["properties"].as_object() else { continue };
        let is_sentence =
            |(name, schema): (&String, &serde_json::Value)| SENTENCES.contains(&name.as_str()) && is_text(schema);
        // The report `failure` is an error with a message. In reports of the inventory, `done` is `added` or `removed`.
        if !matches!(entry.id, "failure" | "robots.add" | "robots.remove" | "setup") && fields.iter().any(is_sentence) {
            found.push(entry.id);
        }
    }
    assert_eq!(found, Vec::<&str>::new(), "reports whose data is a sentence");
    let entries_with = |id: &str| armctl::command::about::schema::all().into_iter().find(|entry| entry.id == id);
    let hold = (entries_with("yerc.hold").expect("hold reports").schema)().to_value();
    assert!(["set", "old", "new"].iter().all(|name| hold["properties"].get(name).is_some()), "{hold}");
}

#[test]
fn every_robot_command_has_a_schema_and_help() {
    let ids: Vec<&str> = armctl::command::about::schema::all().iter().map(|entry| entry.id).collect();
    let known: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(known.len(), ids.len(), "an id is there twice: {ids:?}");
    let root = armctl::cli::Cli::command();
    let mut words = BTreeSet::new();
    for family in FAMILIES.iter().map(|face| face.family.name()) {
        leaves(root.find_subcommand(family).expect("the family is there"), family, &mut words);
    }
    // The command `repl` has no report, because each line at its prompt has its own report.
    let is_known = |word: &str| known.contains(word) || word.rsplit('.').next() == Some("repl");
    let without: Vec<&String> = words.iter().filter(|word| !is_known(word)).collect();
    assert!(without.is_empty(), "commands without a schema of their name: {without:?}");
}

#[test]
fn command_flags_do_not_shadow_global_flags() {
    // A global flag would also have its global meaning: `--all` would select all robots. `--for` is a duration in all
    // commands.
    fn check_flags(command: &clap::Command, known: &BTreeSet<String>, path: &str, found: &mut Vec<String>) {
        let own_flags =
            || command.get_arguments().flat_map(|argument| flags(argument).map(move |flag| (flag, argument)));
        let shadowed = own_flags().filter(|(flag, _)| known.contains(flag) && flag != "--for");
        found.extend(shadowed.map(|(flag, _)| format!("{path} {flag}")));
        // The same thing has the same flag in all commands: --dir is written, --from and --compare are read.
        let is_usual = |flag: &str| ["--dir", "--from", "--compare", "--cell"].contains(&flag);
        let into_folder = own_flags().filter(|(flag, argument)| is_folder(argument) && !is_usual(flag));
        found.extend(into_folder.map(|(flag, _)| format!("{path} {flag}: a folder is --dir")));
        let global = own_flags().filter(|(_, argument)| argument.is_global_set()).map(|(flag, _)| flag);
        let known: BTreeSet<String> = known.iter().cloned().chain(global).collect();
        for verb in command.get_subcommands() {
            check_flags(verb, &known, &format!("{path} {}", verb.get_name()), found);
        }
    }
    /// All forms of a flag that clap accepts, including hidden forms.
    fn flags(argument: &clap::Arg) -> impl Iterator<Item = String> {
        let longs = argument.get_long().into_iter().chain(argument.get_all_aliases().unwrap_or_default());
        let shorts = argument.get_short().into_iter().chain(argument.get_all_short_aliases().unwrap_or_default());
        longs.map(|long| format!("--{long}")).chain(shorts.map(|short| format!("-{short}")))
    }

    fn is_folder(argument: &clap::Arg) -> bool {
        let names = argument.get_value_names().unwrap_or_default();
        names.iter().any(|name| ["DIR", "FOLDER"].contains(&name.as_str()))
    }

    let mut found = Vec::new();
    check_flags(&armctl::cli::Cli::command(), &BTreeSet::new(), "armctl", &mut found);
    assert_eq!(found, Vec::<String>::new());
}

#[test]
fn schemas_describe_reports() {
    for entry in armctl::command::about::schema::all() {
        let schema = (entry.schema)();
        let says_what = ["properties", "$ref", "oneOf", "anyOf", "items"].iter().any(|key| schema.get(*key).is_some());
        assert!(says_what, "the schema of {} says nothing: {schema:?}", entry.id);
        assert!(schema.get("title").is_some(), "the schema of {} has no title", entry.id);
    }
}

/// Collects the ids of all commands below a command. An id has the words of the command, joined by dots.
fn leaves(command: &clap::Command, id: &str, all: &mut BTreeSet<String>) {
    if !command.has_subcommands() {
        assert!(command.get_about().is_some(), "{id} has no line of help");
        all.insert(id.to_owned());
    }
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        leaves(sub, &format!("{id}.{}", sub.get_name()), all);
    }
}

/// Compares a folder with its expected content. With `ARMCTL_BLESS`, rewrites the folder instead.
fn is_current(folder: &str, made: &BTreeMap<String, Vec<u8>>) {
    let path = root().join(folder);
    if std::env::var_os("ARMCTL_BLESS").is_some() {
        std::fs::create_dir_all(&path).expect("the folder can be made");
        for (name, content) in made {
            std::fs::write(path.join(name), content).expect("the file can be written");
        }
        // Removes the files of commands that no longer exist.
        for name in names(&path).difference(&made.keys().cloned().collect()) {
            std::fs::remove_file(path.join(name)).expect("the old file can go");
        }
        return;
    }
    let existing = names(&path);
    let stale: Vec<&String> = made
        .keys()
        .chain(&existing)
        .filter(|name| std::fs::read(path.join(name)).ok().as_ref() != made.get(*name))
        .collect();
    assert!(
        stale.is_empty(),
        "{folder}/ is not current; run `ARMCTL_BLESS=1 cargo test --test architecture`: {stale:?}"
    );
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect()
}
