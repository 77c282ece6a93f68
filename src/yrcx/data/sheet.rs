//! Points with their comments, as a spreadsheet has them: `yrcx point dump` and `restore`.

use std::collections::{HashMap, HashSet};

use super::{Comments, Points};
use crate::numbered_tables::{Draft as Texts, Kind as _, Numbered, Row};
use crate::prelude::*;
use crate::read_requests::plan_each;
use armctl_frame::robot::item::Plain;
use armctl_frame::robot::position::FourAxes;
use armctl_frame::store::{Row as TableRow, rows_of_file};

/// The points with their comments.
#[derive(Debug, Default)]
pub struct PointSheet {
    points: Numbered<Points>,
    comments: Numbered<Comments>,
}

/// A point and its comment; `None` for a part that was not read.
#[derive(Debug, Clone, PartialEq)]
pub struct Content {
    point: Option<Row>,
    comment: Option<Row>,
}

/// New content of a point and of its comment; `None` for a part that is not given.
#[derive(Debug, Clone)]
pub struct Draft {
    point: Option<Texts>,
    comment: Option<Texts>,
}

/// A point with its comment.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointWithComment {
    #[serde(flatten)]
    point: Option<FourAxes>,
    comment: Option<String>,
}

impl Content {
    /// Point and comment in a line.
    fn line(&self) -> String {
        let point = self.point.as_ref().and_then(|row| Points::line(row.values()));
        let comment = self.comment.as_ref().and_then(|row| Comments::value(row.values()));
        point.into_iter().chain(comment.map(|text| format!("'{text}'"))).collect::<Vec<_>>().join(" ")
    }
}

impl PointSheet {
    /// Points in a file, such as the file of a backup.
    ///
    /// # Errors
    /// The file cannot be read, or has mistakes.
    pub fn points_in(path: &Path) -> Result<Vec<(i32, FourAxes)>> {
        let table = Self::default();
        let mut points = Vec::new();
        for (number, draft) in rows_of_file(&table, path)? {
            let content = table.complete_draft(number, &draft, None)?;
            points.extend(content.point.and_then(|row| Points::value(row.values())).map(|point| (number, point)));
        }
        Ok(points)
    }

    /// Reads points, if they are requested, and the comments of some of them, if they are defined.
    async fn read_parts(
        &self,
        link: &mut Link,
        screen: &Screen,
        (numbers, has_points): (&[i32], bool),
        commented: &[i32],
    ) -> Result<Answers<Content>> {
        if link.is_dry_run() {
            let points = numbers.iter().filter(|_| has_points).map(|number| Numbered::<Points>::read_order(*number));
            let comments = commented.iter().map(|number| Numbered::<Comments>::read_order(*number));
            plan_each(link, &points.chain(comments).collect::<Result<Vec<_>>>()?)?;
        }
        let mut asked = numbers.len();
        let points: Vec<Result<Option<Row>>> = if has_points {
            let answers = self.points.read(link, screen, numbers).await?;
            asked = answers.asked;
            answers.rows
        } else {
            numbers.iter().map(|_| Ok(None)).collect()
        };
        let undefined = numbers.iter().zip(&points).filter(|(_, point)| point.is_err());
        let undefined: HashSet<i32> = undefined.map(|(number, _)| *number).collect();
        let commented: Vec<i32> = commented.iter().copied().filter(|number| !undefined.contains(number)).collect();
        let comments =
            if commented.is_empty() { Vec::new() } else { self.comments.read(link, screen, &commented).await?.rows };
        let mut comments: HashMap<i32, _> = commented.into_iter().zip(comments).collect();
        let content = |(number, point): (&i32, Result<Option<Row>>)| {
            let point = point?;
            let comment = match comments.remove(number).transpose() {
                Err(failure) if !Self::is_undefined(&failure) => return Err(failure),
                comment => comment.ok().flatten().flatten(),
            };
            Ok(Some(Content { point, comment }))
        };
        Ok(Answers { rows: numbers.iter().zip(points).map(content).collect(), asked })
    }
}

impl Store for PointSheet {
    type Family = Yrcx;
    type Key = i32;
    type Wire = Content;
    type Value = PointWithComment;
    type More = Plain;
    type Options = Single;

    const WORDS: TableWords = Points::WORDS;
    const IDS: Ids = ids!("yrcx.point");

    fn keys(text: &str) -> Result<Vec<i32>, String> {
        Numbered::<Points>::keys(text)
    }

    fn name(number: i32) -> String {
        Numbered::<Points>::name(number)
    }

    fn names(numbers: &[i32]) -> String {
        Numbered::<Points>::names(numbers)
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self::default())
    }

    fn fields(&self) -> Vec<Field> {
        let comment = self.comments.fields().into_iter().map(Field::optional);
        self.points.fields().into_iter().chain(comment).collect()
    }

    fn texts(&self, Content { point, comment }: &Content) -> Vec<String> {
        let blank = || vec![String::new(); Points::FIELDS.len()];
        let point = point.as_ref().map_or_else(blank, |row| self.points.texts(row));
        let comment = comment.as_ref().map_or_else(|| vec![String::new()], |row| self.comments.texts(row));
        [point, comment].concat()
    }

    fn difference(&self, old: &Content, new: &Content) -> [String; 2] {
        [old.line(), new.line()]
    }

    fn value(&self, Content { point, comment }: &Content) -> Option<PointWithComment> {
        let point = point.as_ref().and_then(|row| self.points.value(row));
        Some(PointWithComment { point, comment: comment.as_ref().and_then(|row| self.comments.value(row)) })
    }

    fn more(&self, _number: i32, _content: Option<&Content>) -> Plain {
        Plain {}
    }

    fn is_undefined(failure: &Failure) -> bool {
        Numbered::<Points>::is_undefined(failure)
    }

    fn consequences(&self, rows: &[RowDifference<'_, Self>]) -> Vec<String> {
        let added = rows.iter().filter(|(_, old, _)| old.is_none()).count();
        if added == 0 { Vec::new() } else { vec![format!("New points are added: {added}.")] }
    }

    async fn read(&self, link: &mut Link, screen: &Screen, numbers: &[i32]) -> Result<Answers<Content>> {
        self.read_parts(link, screen, (numbers, true), numbers).await
    }
}

impl Writable for PointSheet {
    type Draft = Draft;

    const RISK: Risk = Risk::Destroy;

    fn draft(&self, number: i32, texts: &[Option<&str>]) -> Result<Draft, String> {
        let (point, comment) = texts.split_at(Points::FIELDS.len());
        if point[0].is_none() && point[1..5].iter().any(Option::is_some) {
            return Err("column `unit` is missing: the axes are in mm or in pulses".to_owned());
        }
        let is_given = |texts: &[Option<&str>]| texts.iter().any(Option::is_some);
        let point = is_given(point).then(|| self.points.draft(number, point)).transpose()?;
        let comment = is_given(comment).then(|| self.comments.draft(number, comment)).transpose()?;
        Ok(Draft { point, comment })
    }

    fn complete_draft(&self, number: i32, draft: &Draft, old: Option<&Content>) -> Result<Content> {
        let held = old.cloned().unwrap_or(Content { point: None, comment: None });
        let point = match &draft.point {
            Some(texts) => Some(self.points.complete_draft(number, texts, held.point.as_ref())?),
            None => held.point,
        };
        let comment = match &draft.comment {
            Some(texts) => Some(self.comments.complete_draft(number, texts, held.comment.as_ref())?),
            None => held.comment,
        };
        Ok(Content { point, comment })
    }

    async fn read_old(&self, link: &mut Link, screen: &Screen, rows: &[TableRow<Self>]) -> Result<Answers<Content>> {
        let numbers: Vec<i32> = rows.iter().map(|(number, _)| *number).collect();
        let has_points = rows.iter().any(|(_, draft)| draft.point.is_some());
        let commented = rows.iter().filter(|(_, draft)| draft.comment.is_some());
        let commented: Vec<i32> = commented.map(|(number, _)| *number).collect();
        self.read_parts(link, screen, (&numbers, has_points), &commented).await
    }

    async fn plan(&self, link: &mut Link, rows: &[TableRow<Self>]) -> Result<()> {
        for (number, Draft { point, comment }) in rows {
            if let Some(texts) = point {
                self.points.plan(link, &[(*number, texts.clone())]).await?;
            }
            if let Some(texts) = comment {
                self.comments.plan(link, &[(*number, texts.clone())]).await?;
            }
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for (number, old, new) in rows {
            let (old_point, old_comment) = old.map_or((None, None), |old| (old.point.as_ref(), old.comment.as_ref()));
            let mut is_half = false;
            if let Some(point) = new.point.as_ref().filter(|new| Some(*new) != old_point) {
                self.points.write(link, screen, &[(*number, old_point, point)]).await?;
                is_half = true;
            }
            if let Some(comment) = new.comment.as_ref().filter(|new| Some(*new) != old_comment) {
                let written = self.comments.write(link, screen, &[(*number, old_comment, comment)]).await;
                written.map_err(|failure| {
                    let message = format!("the point was written; {}", failure.message);
                    if is_half { Failure { message, ..failure } } else { failure }
                })?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns point 7 as it is stored: in mm and left-handed, or in pulses.
    fn stored_point(texts: [&str; 6]) -> Content {
        let texts: Vec<Option<String>> = texts.into_iter().map(|text| Some(text.to_owned())).collect();
        let point = Numbered::<Points>::default().complete_draft(7, &texts, None).unwrap();
        Content { point: Some(point), comment: Some(Row::new::<Comments>(Values::default())) }
    }

    #[test]
    fn point_keeps_data_without_a_column() {
        let sheet = PointSheet::default();
        let draft = sheet.draft(7, &[Some("mm"), None, Some("-2.5"), None, None, None, None]).unwrap();
        let old = stored_point(["mm", "1", "2", "3", "4", "right"]);
        let new = sheet.complete_draft(7, &draft, Some(&old)).unwrap();
        assert_eq!(sheet.texts(&new)[..6], ["mm", "1.000", "-2.500", "3.000", "4.000", "right"]);
        assert!(sheet.complete_draft(7, &draft, None).unwrap_err().message.contains("axis_1"));
        let pulses = stored_point(["pulse", "1", "2", "3", "4", ""]);
        assert!(sheet.complete_draft(7, &draft, Some(&pulses)).is_err(), "millimetres and pulses are not mixed");
        let comment = sheet.draft(7, &[None, None, None, None, None, None, Some("WAIT")]).unwrap();
        let new = sheet.complete_draft(7, &comment, Some(&old)).unwrap();
        assert_eq!((&new.point, sheet.texts(&new)[6].as_str()), (&old.point, "WAIT"));
        assert!(
            sheet.draft(7, &[None, Some("1"), None, None, None, None, None]).unwrap_err().contains("column `unit`")
        );
    }
}
