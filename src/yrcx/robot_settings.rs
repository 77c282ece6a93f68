//! Settings of a robot that can be read and written, as a table.

use super::read_requests::{ask_each, is_undefined};
use super::single_command::format_field;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::Value;
use armctl_frame::robot::item::Plain;
use armctl_frame::store::Row;

/// A setting.
#[derive(Debug, PartialEq, Eq, Hash)]
pub struct Setting {
    name: &'static str,
    /// Command that reads the setting, and the field of the answer.
    pub read: (Command, Key),
    /// Command that writes the setting, and the field of the request.
    pub write: (Command, Key),
}

impl Setting {
    const fn new(name: &'static str, read: (Command, Key), write: (Command, Key)) -> Self {
        Self { name, read, write }
    }
}

/// All settings (4.2.8, 4.2.14 to 16, 4.2.19; 4.7.8, 9, 16).
pub static SETTINGS: [Setting; 5] = [
    Setting::new("auto_speed_percent", (Command::SpeedStatus, Key::AutoSpeed), (Command::SpeedAuto, Key::SpeedPercent)),
    Setting::new(
        "manual_speed_percent",
        (Command::SpeedStatus, Key::ManualSpeed),
        (Command::SpeedManual, Key::SpeedPercent),
    ),
    Setting::new(
        "program_speed_percent",
        (Command::SpeedStatus, Key::ProgramSpeed),
        (Command::SpeedProgram, Key::SpeedPercent),
    ),
    Setting::new(
        "inching_distance",
        (Command::InchAmountGet, Key::InchingAmount),
        (Command::InchAmountSet, Key::InchingAmount),
    ),
    Setting::new("hand_system", (Command::ArmDesignation, Key::Arm), (Command::ArmSelect, Key::Arm)),
];

/// The settings of a robot.
#[derive(Debug)]
pub struct Settings {
    /// Robot number, 1 to 4.
    pub robot: u8,
}

impl Settings {
    /// The requests that read these settings, without repetitions.
    pub fn read_orders(&self, keys: &[&'static Setting]) -> Result<Vec<Order>> {
        let mut commands: Vec<Command> = keys.iter().map(|key| key.read.0).collect();
        commands.dedup();
        commands
            .into_iter()
            .map(|command| command.order().with(Key::Robot, i32::from(self.robot)).valid_order())
            .collect()
    }

    fn write_order(&self, Setting { write: (command, key), .. }: &Setting, text: &str) -> Result<Order> {
        command.order().with(Key::Robot, i32::from(self.robot)).with(*key, text).valid_order()
    }
}

impl Store for Settings {
    type Family = Yrcx;
    type Key = &'static Setting;
    type Wire = String;
    type Value = String;
    type More = Plain;
    type Options = Single;

    const WORDS: TableWords = TableWords {
        nouns: ["setting", "settings"],
        placeholder: "SETTING",
        range: "Name of a setting",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.setting");

    fn keys(text: &str) -> Result<Vec<&'static Setting>, String> {
        let setting = SETTINGS.iter().find(|setting| setting.name == text);
        setting.map(|setting| vec![setting]).ok_or_else(|| format!("setting '{text}' does not exist"))
    }

    fn all() -> Vec<&'static Setting> {
        SETTINGS.iter().collect()
    }

    fn name(setting: &'static Setting) -> String {
        setting.name.to_owned()
    }

    async fn open(link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self { robot: link.unit() })
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::text("value", "value")]
    }

    fn texts(&self, value: &String) -> Vec<String> {
        vec![value.clone()]
    }

    fn value(&self, value: &String) -> Option<String> {
        Some(value.clone())
    }

    fn more(&self, _setting: &'static Setting, _value: Option<&String>) -> Plain {
        Plain {}
    }

    fn is_undefined(failure: &Failure) -> bool {
        is_undefined(failure)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, keys: &[&'static Setting]) -> Result<Answers<String>> {
        let orders = self.read_orders(keys)?;
        let answers = ask_each(link, screen, "reading settings", &orders).await?.outcomes;
        let row = |Setting { read: (command, key), .. }: &Setting| {
            let answer = orders.iter().position(|order| order.command() == *command).map(|at| &answers[at]);
            let values = answer.expect("there is a request for each setting").as_ref().map_err(Clone::clone)?;
            Ok(format_field(*command, values, *key).unwrap_or_default())
        };
        Ok(Answers::of(keys.iter().map(|key| row(key)).collect()))
    }
}

impl Writable for Settings {
    type Draft = Option<String>;

    const RISK: Risk = Risk::Destroy;

    fn draft(&self, setting: &'static Setting, texts: &[Option<&str>]) -> Result<Option<String>, String> {
        let Some(text) = texts[0] else { return Ok(None) };
        let order = self.write_order(setting, text).map_err(|failure| failure.message)?;
        let Setting { read, write, .. } = setting;
        let value = order.values().value(write.1).cloned().unwrap_or(Value::Int(0));
        Ok(format_field(read.0, &Values::from_iter([(read.1, value)]), read.1))
    }

    fn complete_draft(
        &self,
        setting: &'static Setting,
        draft: &Option<String>,
        old: Option<&String>,
    ) -> Result<String> {
        let value = draft.as_ref().or(old).cloned();
        value.ok_or_else(|| Failure::usage(format!("{} has no value to keep", setting.name)).hint("give a value"))
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        for (setting, draft) in rows {
            let order = self.write_order(setting, draft.as_deref().unwrap_or_default())?;
            let about = Self::asked(setting);
            let reason = Reason::about(&about).depending_on("the current value: written if different");
            link.plan_depending(&order, &order, reason);
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for (setting, _, value) in rows {
            link.ask(&self.write_order(setting, value)?).await?;
        }
        Ok(())
    }
}
