//! `toyo info`: type and versions of the controller.

use super::number_arguments::saturated_byte;
use crate::prelude::*;

/// Show robot type, versions, axes, task and override.
#[derive(Debug, Args)]
#[command(after_help = "The controller refuses to report the version of a missing station. The report lists the \
                        refused requests.")]
pub struct Info {}

/// Numbers of the stations; 0 is the controller itself.
const STATIONS: [u8; 5] = [0, 1, 2, 3, 4];

impl Command for Info {
    type Family = Toyo;
    type Report = About;
    const ID: &'static str = "toyo.info";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<About> {
        let link = context.link;
        let system = Request::bare(table::Command::Sysp);
        let version = |station: u8| Request::of(table::Command::Cver, [Value::Number(station.into())]);
        let (task, speed) = (Request::bare(table::Command::Mtsk), Request::bare(table::Command::Rovr));
        let versions = STATIONS.map(version);
        let all: Vec<Request> = [&system].into_iter().chain(&versions).chain([&task, &speed]).cloned().collect();
        link.plan_all(&all)?;
        // Every controller answers this request. It may refuse each of the other requests.
        let mut about = About::of(&link.ask(&system).await?);
        for request in &all[1..] {
            match link.try_ask(request).await? {
                Ok(answer) => about.add_answer(request, &answer),
                Err(_) => about.refused.push(request.text()),
            }
        }
        Ok(about)
    }
}

/// Reads the version of the controller.
pub(super) async fn version(link: &mut Link) -> Result<String> {
    Ok(meaning(&link.ask(&Request::bare(table::Command::Sysp)).await?, "version"))
}

/// Identity of a controller.
#[derive(Debug, Serialize, JsonSchema)]
pub struct About {
    /// Robot type: six digits.
    robot_type: String,
    /// Version of the controller, for example `3.36`.
    version: String,
    /// Language of the teach pendant: `Japanese` or `English`.
    language: String,
    /// Letters of axes 1 to 4.
    axes: Vec<&'static str>,
    /// Last part of the answer. The manual does not explain it.
    tail: String,
    /// Versions of the stations that answered.
    stations: Vec<Station>,
    /// The current task; null if the controller refused to report it.
    task: Option<u8>,
    /// Speed override; null if the controller refused to report it.
    speed_override_percent: Option<u8>,
    /// Requests that the controller refused (`@NG`).
    refused: Vec<String>,
}

/// A station of the controller.
#[derive(Debug, Serialize, JsonSchema)]
struct Station {
    /// Number of the station; 0 is the controller itself.
    station: u8,
    version: String,
}

impl About {
    fn of(system: &Record) -> Self {
        Self {
            robot_type: field_text(system, "robot_type"),
            version: meaning(system, "version"),
            language: meaning(system, "language"),
            axes: ["arm1", "arm2", "arm3", "arm4"].iter().filter_map(|arm| system.word(arm)).collect(),
            tail: system.text("tail").unwrap_or_default().to_owned(),
            stations: Vec::new(),
            task: None,
            speed_override_percent: None,
            refused: Vec::new(),
        }
    }

    fn add_answer(&mut self, request: &Request, answer: &Record) {
        match request.command() {
            table::Command::Cver => {
                self.stations
                    .push(Station { station: saturated_byte(answer, "station"), version: meaning(answer, "version") });
            }
            table::Command::Mtsk => self.task = Some(saturated_byte(answer, "task")),
            _ => self.speed_override_percent = Some(saturated_byte(answer, "override")),
        }
    }
}

/// Returns a field in the form of the protocol.
fn field_text(record: &Record, name: &str) -> String {
    record.pairs().find(|(field, _)| field.name == name).map(|(field, value)| field.written(value)).unwrap_or_default()
}

/// Returns the meaning of a field's value.
fn meaning(record: &Record, name: &str) -> String {
    let field = record.pairs().find(|(field, _)| field.name == name);
    field.map(|(field, value)| field.meaning(value).into_owned()).unwrap_or_default()
}

impl Report for About {
    fn view(&self) -> View {
        let stations = self.stations.iter().map(|Station { station, version }| format!("{station}: {version}"));
        let stations: Vec<String> = stations.collect();
        let mut fields = vec![
            ("robot type", Cell::from(self.robot_type.as_str())),
            ("version", self.version.as_str().into()),
            ("language", self.language.as_str().into()),
            ("axes", self.axes.join(" ").into()),
            ("stations", if stations.is_empty() { "-".into() } else { stations.join(", ").into() }),
            ("task", self.task.map_or_else(|| "-".into(), |task| task.to_string().into())),
            (
                "override",
                self.speed_override_percent.map_or_else(|| "-".into(), |percent| format!("{percent} %").into()),
            ),
        ];
        if !self.refused.is_empty() {
            fields.push(("refused", self.refused.join(", ").into()));
        }
        View { sections: vec![Section::Fields(fields)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::toyo::request::Answer;

    #[test]
    fn the_report_describes_the_controller_as_text() {
        let Ok(Answer::Data(record)) =
            Request::bare(table::Command::Sysp).answer("@SYSP RTYP=000123 VER=03.36 E ARM1=X ARM2=Y ARM3=Z ARM4=R N")
        else {
            panic!("it is data")
        };
        let about = About::of(&record);
        assert_eq!((about.robot_type.as_str(), about.version.as_str()), ("000123", "3.36"));
        assert_eq!(
            (about.language.as_str(), about.axes.concat(), about.tail.as_str()),
            ("English", "XYZR".into(), "N")
        );
    }
}
