//! Fields of decoded words as rows of a table.

use armctl_controller::yrcx::describe::FieldNote;
use armctl_frame::decode;
use armctl_frame::output::view::Cell;

armctl_frame::field_row!(FieldNote);

impl decode::Field for FieldRow {
    const COLUMNS: &'static [&'static str] = &["word", "field", "raw", "meaning"];

    fn cells(&self) -> Vec<Cell> {
        let FieldNote { place, name, raw, meaning, .. } = &self.0;
        [place, name, raw, meaning].map(|text| text.as_str().into()).into()
    }
}
