//! `set`: writes one row.

use clap::ArgAction;
use clap::builder::ValueRange;

use super::change::{TableWrite, confirmation, intent, write};
use super::{Store, Writable, WrittenOf, read_keys};
use crate::prelude::basics::*;
use crate::robot::item::as_requested;
use crate::{Command, Context};

/// A row, and its new content.
#[derive(Debug, Args)]
#[command(after_help = S::help().or(S::WORDS.writing))]
pub struct Set<S: Writable> {
    #[command(flatten)]
    options: S::Options,
    #[arg(value_name = S::WORDS.placeholder, value_parser = one::<S>, help = one_of(S::WORDS.range), add = S::COMPLETE)]
    row: SingleRow<S>,
    /// All values in their order, or some values as NAME=VALUE. The other values do not change
    #[arg(required = true, value_name = "VALUE", allow_negative_numbers = true, allow_hyphen_values = S::IS_TEXT,
        action = if S::IS_TEXT { ArgAction::Set } else { ArgAction::Append },
        num_args = if S::IS_TEXT { ValueRange::SINGLE } else { ValueRange::from(1..) })]
    values: Vec<String>,
}

/// A row argument that must be a single row.
#[derive(Debug)]
struct SingleRow<S: Store>(S::Key);

impl<S: Store> Clone for SingleRow<S> {
    fn clone(&self) -> Self {
        Self(self.0)
    }
}

/// Help for one row, from the help for several rows: without the examples after the first one.
fn one_of(rows: &str) -> String {
    let (rows, examples) = rows.split_once(", such as ").unwrap_or((rows, ""));
    match examples.split([',', ' ']).next().map(|first| first.trim_end_matches('.')) {
        Some("") | None => format!("{rows}; type one"),
        Some(first) => format!("{rows}; type one, such as {first}"),
    }
}

/// Hint for values that are joined with commas, such as `5,0,0,0`.
pub fn comma_hint(words: &[String], fields: usize) -> Option<String> {
    let [word] = words else { return None };
    (word.split(',').count() == fields).then(|| format!("type blanks between the values: {}", word.replace(',', " ")))
}

fn one<S: Store>(text: &str) -> Result<SingleRow<S>, String> {
    match read_keys::<S>(text)?[..] {
        [key] => Ok(SingleRow(key)),
        _ => Err(format!("'{text}' selects several {}; type one", S::WORDS.nouns[1])),
    }
}

impl<S: Writable> Command for Set<S> {
    type Family = S::Family;
    type Report = WrittenOf<S>;
    const ID: &'static str = S::IDS.set;
    const RISK: Risk = S::RISK;
    const CONFIRMATION: Confirmation = confirmation::<S>();

    fn intent(&self) -> String {
        intent::<S>()
    }

    async fn run(&self, context: Context<'_, S::Family>) -> Result<WrittenOf<S>> {
        let Context { robot, link, screen, confirmer, .. } = context;
        let key = self.row.0;
        let table = S::open(link, &self.options).await?;
        let draft = table.typed(key, &self.values)?;
        write(TableWrite { table, robot, link, screen, confirmer }, vec![(key, draft)]).await?.or_only_failure()
    }
}

/// Parses new content from words: all values in their order, or some values as `NAME=VALUE`.
pub fn typed<S: Writable>(table: &S, key: S::Key, words: &[String]) -> Result<S::Draft> {
    let fields = table.fields();
    let row = as_requested(S::WORDS.nouns[0], &S::name(key));
    let names: Vec<&str> = fields.iter().map(|field| &*field.name).collect();
    let usage = match &names[..] {
        [_] => "type one value".to_owned(),
        names => format!("type all values in this order, or some values by name: {}", names.join("=… ") + "=…"),
    };
    let invalid = |message: String| Failure::usage(format!("{row}: {message}")).hint(usage.as_str());
    let mut texts: Vec<Option<&str>> = vec![None; fields.len()];
    let has_name = |word: &String| word.split_once('=').is_some_and(|(name, _)| name.starts_with(char::is_alphabetic));
    if !S::IS_TEXT && words.iter().any(has_name) {
        for word in words {
            let (name, value) = word
                .split_once('=')
                .ok_or_else(|| invalid(format!("'{word}' has no name, but other values have names")))?;
            let requested = name.to_ascii_lowercase().replace('-', "_");
            let exact = names.iter().position(|field| *field == requested);
            // A shorter name is accepted: `speed` for `speed_mm_s`.
            let begins = |field: &&str| field.strip_prefix(&*requested).is_some_and(|rest| rest.starts_with('_'));
            let at = exact.or_else(|| names.iter().position(begins)).ok_or_else(|| {
                let similar = nearest(name, names.iter().copied());
                let near = similar.map_or(String::new(), |near| format!("; did you mean {near}?"));
                invalid(format!("unknown value '{}'{near}", name.escape_debug()))
            })?;
            if texts[at].replace(value).is_some() {
                return Err(invalid(format!("{name} appears twice")));
            }
        }
    } else if words.len() == fields.len() {
        texts = words.iter().map(|word| Some(word.as_str())).collect();
    } else {
        let failure = invalid(format!("{} values needed, but {} typed", fields.len(), words.len()));
        return Err(comma_hint(words, fields.len()).into_iter().fold(failure, Failure::hint));
    }
    table.draft(key, &texts).map_err(invalid)
}
