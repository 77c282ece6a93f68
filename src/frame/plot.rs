//! Small chart of values over the rounds of a watch: `position --watch --plot`.

use std::cell::RefCell;
use std::collections::VecDeque;

use crate::output::view::{Cell, Section, Table};

/// Maximum number of rounds in a chart.
const MAX_POINTS: usize = 40;
/// Bars from the minimum to the maximum.
const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Values of earlier rounds of a watch.
#[derive(Debug, Default)]
pub struct SeriesHistory(RefCell<Vec<Series>>);

/// A value over time.
#[derive(Debug, Clone, PartialEq)]
struct Series {
    name: String,
    unit: &'static str,
    decimals: usize,
    values: VecDeque<f64>,
}

/// Chart of all values.
#[derive(Debug, Clone, Default)]
pub struct Plot(Vec<Series>);

impl SeriesHistory {
    /// Adds the values of a round: name, unit, decimals, value. If the set of names changes, the chart starts again.
    pub fn add(&self, values: impl IntoIterator<Item = (String, &'static str, usize, f64)>) -> Plot {
        let mut past = self.0.borrow_mut();
        let values: Vec<_> = values.into_iter().collect();
        let is_same = past.len() == values.len() && past.iter().zip(&values).all(|(one, new)| one.name == new.0);
        if !is_same {
            let begin = |(name, unit, decimals, _): &(String, &'static str, usize, f64)| Series {
                name: name.clone(),
                unit,
                decimals: *decimals,
                values: VecDeque::new(),
            };
            *past = values.iter().map(begin).collect();
        }
        for (series, (.., value)) in past.iter_mut().zip(values) {
            series.values.push_back(value);
            if series.values.len() > MAX_POINTS {
                series.values.pop_front();
            }
        }
        Plot(past.clone())
    }
}

impl Plot {
    /// Section of a view. It has one row per value, with minimum and maximum.
    pub fn section(&self) -> Section {
        let mut table = Table::new(&["axis", "now", "unit", "chart", "min", "max"], "nothing to show");
        for Series { name, unit, decimals, values } in &self.0 {
            let (least, greatest) = range(values);
            let number = |value: f64| Cell::number(format!("{value:.decimals$}"));
            let now = values.back().copied().unwrap_or_default();
            let chart = Cell::from(bars(values)).whole();
            table.row([name.as_str().into(), number(now), (*unit).into(), chart, number(least), number(greatest)]);
        }
        Section::Table(table)
    }
}

fn range(values: &VecDeque<f64>) -> (f64, f64) {
    let minimum = values.iter().copied().fold(f64::INFINITY, f64::min);
    let maximum = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if values.is_empty() { (0.0, 0.0) } else { (minimum, maximum) }
}

/// One bar per round, the latest at the end. A constant value is a line at the bottom.
fn bars(values: &VecDeque<f64>) -> String {
    let (least, greatest) = range(values);
    let step = (greatest - least) / 8.0;
    let bar = |value: &f64| {
        let offset = (1..BARS.len()).filter(|bar| *value > least + step * f64::from(u8::try_from(*bar).unwrap_or(0)));
        BARS[offset.count()]
    };
    values.iter().map(bar).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::render;
    use crate::output::view::View;

    #[test]
    fn draws_bars_between_minimum_and_maximum() {
        let past = SeriesHistory::default();
        let mut plot = Plot::default();
        for value in 0..=7_u8 {
            plot = past.add([("X".to_owned(), "mm", 1, f64::from(value)), ("Y".to_owned(), "mm", 1, 5.0)]);
        }
        let text = render::text(&View { sections: vec![plot.section()] }, 80, false);
        assert!(text.contains("▁▂▃▄▅▆▇█") && text.contains("▁▁▁▁▁▁▁▁"), "{text}");
        assert!(text.contains("0.0") && text.contains("7.0"), "{text}");
        assert_eq!(past.add([("Z".to_owned(), "mm", 1, 1.0)]).0[0].values.len(), 1, "other axes begin anew");
        for _ in 0..100 {
            plot = past.add([("Z".to_owned(), "mm", 1, 1.0)]);
        }
        assert_eq!(plot.0[0].values.len(), MAX_POINTS);
    }
}
