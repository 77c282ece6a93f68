//! The steps of a task as a table, for restores.

use crate::eeprom::Cells;
use crate::field_values::NOT_IN_MANUAL;
use crate::item_reads::read_each;
use crate::prelude::*;
use armctl_controller::toyo::table::Op;
use armctl_frame::robot::item::Plain;
use armctl_frame::store::Row;

/// The steps of a task.
#[derive(Debug)]
pub struct Steps {
    task: u8,
}

impl Steps {
    /// Steps of this task.
    pub const fn of_task(task: u8) -> Self {
        Self { task }
    }
}

impl Store for Steps {
    type Family = Toyo;
    type Key = u16;
    type Wire = Record;
    type Value = String;
    type More = Plain;
    type Options = Single;

    const WORDS: TableWords =
        TableWords { nouns: ["step", "steps"], placeholder: "STEP", range: "1 to 5000", reading: None, writing: None };
    const IDS: Ids = ids!("toyo.program");

    fn keys(text: &str) -> Result<Vec<u16>, String> {
        text.parse().map(|step| vec![step]).map_err(|_| format!("'{text}' is not a step"))
    }

    fn name(step: u16) -> String {
        step.to_string()
    }

    async fn open(link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self::of_task(task_selection::select_task(link, None).await?))
    }

    async fn select(&mut self, link: &mut Link) -> Result<()> {
        task_selection::select_task(link, Some(self.task)).await.map(|_| ())
    }

    async fn deselect<T>(&self, link: &mut Link, outcome: Result<T>) -> Result<T> {
        task_selection::restore_task(link, outcome).await
    }

    fn table_suffix(&self) -> String {
        format!(" of task {}", self.task)
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::text("instruction", "instruction")]
    }

    fn texts(&self, step: &Record) -> Vec<String> {
        vec![step.written()]
    }

    fn value(&self, step: &Record) -> Option<String> {
        Some(step.written())
    }

    fn more(&self, _step: u16, _record: Option<&Record>) -> Plain {
        Plain {}
    }

    fn is_blank(&self, step: &Record) -> bool {
        step.layout() == Op::Nop.row().layout
    }

    async fn read(&self, link: &mut Link, screen: &Screen, steps: &[u16]) -> Result<Answers<Record>> {
        let requests: Vec<_> = steps.iter().copied().map(steps::read_request).collect();
        Ok(Answers::of(read_each(link, screen, "reading steps", &requests).await?))
    }
}

impl Writable for Steps {
    type Draft = Record;

    const RISK: Risk = Risk::Destroy;

    fn draft(&self, step: u16, _texts: &[Option<&str>]) -> Result<Record, String> {
        Err(format!("step {step}: use `toyo program put` to write steps"))
    }

    /// A step that the manual does not list cannot be written. If the controller has another step there, the result
    /// would be a different program, so nothing of the program is written.
    fn complete_draft(&self, step: u16, wanted: &Record, old: Option<&Record>) -> Result<Record> {
        let (text, found) = (wanted.written(), old.map(Record::written).unwrap_or_default());
        match old {
            Some(old) if !wanted.is_listed() && text == found => Ok(old.clone()),
            _ if wanted.is_listed() => Ok(wanted.clone()),
            _ => {
                let message = format!(
                    "step {step} is '{text}' in the backup, which is {NOT_IN_MANUAL} and cannot be written; the \
                     controller has '{found}'"
                );
                Err(Failure::new(Kind::Rejected, message).hint(
                    "write the step with the teach pendant, then restore again; nothing of this program was written",
                ))
            }
        }
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        for (step, instruction) in rows.iter().filter(|(_, instruction)| instruction.is_listed()) {
            let cell = steps::cell(*step, instruction)?;
            link.plan_overwriting(&cell.read, &cell.write.text()).await?;
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for (step, _, instruction) in rows {
            link.overwrite(screen, &steps::cell(*step, instruction)?, &mut Cells::default()).await?;
        }
        Ok(())
    }
}
