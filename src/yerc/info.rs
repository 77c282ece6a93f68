//! `yerc info`: software, models, parameters.

use super::axes::{Groups, groups_of};
use super::item_requests::ask_existing;
use super::number_arguments::parse_in_range;
use crate::prelude::*;
use armctl_controller::yerc::payload::{SystemInfo, Text};
use armctl_controller::yerc::query::{QueryError, ReadSystemInfo, SystemPart};
use armctl_frame::items;
use armctl_frame::items::{ItemError, ItemOutcome};

/// Reads versions and names (FS and DX 3.3.26).
#[derive(Debug, Args)]
pub struct Info {
    /// Robot or station, or `all` for all groups and applications [default: all]
    #[arg(long, value_name = "R1|all")]
    group: Option<Groups>,
    /// Application number
    #[arg(long, value_name = "N", conflicts_with = "group", value_parser = parse_in_range::<u8>(1, 8))]
    application: Option<u8>,
}

impl Info {
    fn parts(&self, model: Model) -> Vec<SystemPart> {
        match (self.application, self.group) {
            (Some(application), _) => vec![SystemPart::Application(application)],
            (None, Some(Groups::One(group))) => vec![SystemPart::Group(group)],
            (None, None | Some(Groups::All)) => {
                let groups = groups_of(model).filter(|group| !matches!(group, Group::Base(_)));
                groups.map(SystemPart::Group).chain((1..=applications(model)).map(SystemPart::Application)).collect()
            }
        }
    }
}

/// Number of applications that a model has.
const fn applications(model: Model) -> u8 {
    match model {
        Model::Fs100 => 1,
        Model::Dx100 | Model::Dx200 | Model::Yrc1000 => 8,
    }
}

impl Command for Info {
    type Family = Yerc;
    type Report = Versions;
    const ID: &'static str = "yerc.info";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Versions> {
        let link = context.link;
        let make = |model| {
            self.parts(model).into_iter().map(|part| ReadSystemInfo::new(model, part)).collect::<Result<Vec<_>, _>>()
        };
        let (model, encoding) = (link.model_for(make).await?, link.encoding);
        let question = |part| Ok((part, ReadSystemInfo::new(model, part)?));
        let parts = self.parts(model).into_iter();
        let questions: Vec<_> = parts.map(question).collect::<Result<_, QueryError>>().map_err(usage)?;
        // If only one part is requested, its refusal is the failure of the command.
        let is_single = questions.len() == 1;
        let answers = ask_existing(link, questions).await?;
        // For groups that do not exist, controllers answer with only the version.
        let exists = |info: &SystemInfo| is_single || !(info.name.is_empty() && info.parameters.is_empty());
        let first = answers.iter().find_map(|(_, outcome)| outcome.as_ref().ok());
        let software_version = first.map(|info| encoding.decode(info.version.as_bytes()));
        let parts = answers.into_iter().filter(|(_, outcome)| outcome.as_ref().map_or(true, exists));
        let parts = parts.map(|(part, outcome)| Part::new(part, outcome.map_err(read_failure), encoding));
        Ok(Versions { software_version, parts: parts.collect() })
    }
}

/// Versions and names of the controller and its parts.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Versions {
    /// System software version. It is the same for every part.
    software_version: Option<String>,
    parts: Vec<Part>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Part {
    /// Control group; null for an application.
    group: Option<String>,
    /// Number of the application; null for a control group.
    application: Option<u8>,
    #[serde(flatten)]
    outcome: ItemOutcome<Named>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Named {
    /// Robot model or name of the application; null for stations.
    name: Option<String>,
    /// Parameter version; only robots have a parameter version.
    parameter_version: Option<String>,
}

impl Part {
    fn new(part: SystemPart, info: Result<SystemInfo>, encoding: Encoding) -> Self {
        let (group, application) = match part {
            SystemPart::Group(group) => (Some(group.to_string()), None),
            SystemPart::Application(number) => (None, Some(number)),
        };
        let named = info.map(|info| Named {
            name: reported_name(&info.name, encoding),
            parameter_version: reported_name(&info.parameters, encoding),
        });
        let outcome = ItemOutcome::new(name_of(group.as_deref(), application), named);
        Self { group, application, outcome }
    }
}

/// Name of a part.
fn name_of(group: Option<&str>, application: Option<u8>) -> String {
    group.map_or_else(|| format!("application {}", application.unwrap_or_default()), ToOwned::to_owned)
}

fn reported_name<const N: usize>(text: &Text<N>, encoding: Encoding) -> Option<String> {
    (!text.is_empty()).then(|| encoding.decode(text.as_bytes()))
}

impl Report for Versions {
    fn view(&self) -> View {
        let mut table = Table::new(&["part", "name", "version"], "no part");
        table.row(["controller".into(), "system software".into(), Cell::optional(self.software_version.as_deref())]);
        for part in &self.parts {
            let what = name_of(part.group.as_deref(), part.application);
            let [name, version] = match (part.outcome.data(), part.outcome.error()) {
                (Some(part), _) => {
                    [Cell::optional(part.name.as_deref()), Cell::optional(part.parameter_version.as_deref())]
                }
                (None, error) => [error.map_or_else(|| "-".into(), ItemError::cell), "-".into()],
            };
            table.row([what.into(), name, version]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.parts.len(), self.parts.iter().filter_map(|part| part.outcome.error()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{frames, frames_on, golden, reports};
    use armctl_frame::output::render;

    #[test]
    fn selects_parts_by_model() {
        assert_eq!(frames("info --group R1").unwrap(), [golden("R55")]);
        assert_eq!(frames("info --application 8").unwrap(), ["89006c0000010000"]);
        assert_eq!(frames("info").unwrap().len(), 8 + 24 + 8);
        assert_eq!(frames_on("udp://h?model=fs100", "info").unwrap().len(), 2 + 3 + 1);
        assert_eq!(frames_on("udp://h?model=fs100", "info --application 2").unwrap_err().kind, Kind::Usage);
        assert_eq!(frames("info --group B1").unwrap_err().kind, Kind::Usage);
    }

    #[test]
    fn shows_the_version_once() {
        let info = SystemInfo {
            version: Text::cut(b"DS2.07"),
            name: Text::cut(b"ES0165D-A0*"),
            parameters: Text::cut(b"12.34"),
        };
        let station = SystemInfo { version: Text::cut(b"DS2.07"), ..SystemInfo::default() };
        let versions = Versions {
            software_version: Some("DS2.07".into()),
            parts: vec![
                Part::new(SystemPart::Group(Group::R1), Ok(info.clone()), Encoding::ShiftJis),
                Part::new(SystemPart::Group(Group::Station(1)), Ok(station), Encoding::ShiftJis),
                Part::new(
                    SystemPart::Application(1),
                    Ok(SystemInfo { parameters: Text::default(), ..info }),
                    Encoding::ShiftJis,
                ),
            ],
        };
        assert_eq!(
            render::csv(&versions.view()),
            "part,name,version\ncontroller,system software,DS2.07\nR1,ES0165D-A0*,12.34\nS1,-,-\napplication \
             1,ES0165D-A0*,-\n"
        );
    }

    #[tokio::test(start_paused = true)]
    async fn lists_existing_parts_only() {
        let [all, one] = reports("groups = [\"R1\"]", &["info", "info --group R2"]).await.try_into().unwrap();
        let all = all.unwrap();
        assert_eq!(all["software_version"], "DN2.07.00A(JP/US)-00");
        assert_eq!(all["parts"][0]["name"], "ES0165D-A0*");
        assert_eq!(all["parts"].as_array().map(Vec::len), Some(2), "{all}");
        assert!(!one.is_ok_and(|one| one["parts"][0]["name"].is_string()), "R2 has no name");
    }
}
