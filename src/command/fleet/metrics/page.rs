//! Encoder for both exposition formats: OpenMetrics 1.0.0, and the Prometheus text format 0.0.4.

use std::fmt::{Display, Write as _};

use armctl_frame::output::escape;

/// Exposition format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// OpenMetrics 1.0.0.
    OpenMetrics,
    /// Prometheus text format 0.0.4.
    Text,
}

/// Metric type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A value that can rise and fall.
    Gauge,
    /// A value that only rises; its samples end in `_total`.
    Counter,
    /// Constant 1 with information in labels; its samples end in `_info`.
    Info,
    /// A histogram.
    Histogram,
}

/// Longest label value, in characters.
const MAX_LABEL_CHARS: usize = 120;

impl Form {
    /// Selects the format for an `Accept` header; the text format by default.
    pub fn preferred_form(accept: Option<&str>) -> Self {
        let mut best = [0.0_f64; 2];
        for wanted in accept.unwrap_or_default().split(',') {
            let mut parts = wanted.split(';').map(str::trim);
            let kind = parts.next().unwrap_or_default().to_ascii_lowercase();
            let settings: Vec<(&str, &str)> = parts.filter_map(|part| part.split_once('=')).collect();
            let find =
                |name: &str| settings.iter().find(|(known, _)| known.trim() == name).map(|(_, value)| value.trim());
            let version = find("version").map(|version| version.trim_matches('"'));
            let weight: f64 = find("q").map_or(Ok(1.0), str::parse).unwrap_or(0.0);
            let at = match (kind.as_str(), version) {
                ("application/openmetrics-text", None | Some("1.0.0")) => 0,
                ("text/plain", None | Some("0.0.4")) | ("text/*" | "*/*", _) => 1,
                _ => continue,
            };
            best[at] = best[at].max(weight);
        }
        let [open, text] = best;
        if open > 0.0 && open >= text { Self::OpenMetrics } else { Self::Text }
    }

    /// `Content-Type` of the format.
    pub fn content_type(self) -> &'static str {
        match self {
            Self::OpenMetrics => "application/openmetrics-text; version=1.0.0; charset=utf-8",
            Self::Text => "text/plain; version=0.0.4; charset=utf-8",
        }
    }
}

/// Text of a page.
#[derive(Debug)]
pub struct Page {
    form: Form,
    text: String,
}

impl Page {
    /// An empty page.
    pub fn new(form: Form) -> Self {
        Self { form, text: String::new() }
    }

    /// Writes a metric with its samples, or nothing if the metric has no samples. The unit is the only suffix of
    /// `name`.
    pub fn metric(&mut self, name: &str, kind: Kind, unit: &str, help: &str, samples: impl FnOnce(&mut Samples<'_>)) {
        let ending = match kind {
            Kind::Counter => "_total",
            Kind::Info => "_info",
            Kind::Gauge | Kind::Histogram => "",
        };
        let is_open = self.form == Form::OpenMetrics;
        let (family, kind) = match (is_open, kind) {
            (true, Kind::Info) => (name.to_owned(), "info"),
            (true, Kind::Counter) => (name.to_owned(), "counter"),
            (false, Kind::Counter) => (format!("{name}{ending}"), "counter"),
            (_, Kind::Histogram) => (name.to_owned(), "histogram"),
            (_, Kind::Gauge | Kind::Info) => (format!("{name}{ending}"), "gauge"),
        };
        let start = self.text.len();
        self.line(format_args!("# HELP {family} {help}"));
        self.line(format_args!("# TYPE {family} {kind}"));
        if is_open && !unit.is_empty() {
            self.line(format_args!("# UNIT {family} {unit}"));
        }
        let empty = self.text.len();
        samples(&mut Samples { page: self, name, suffix: ending });
        if self.text.len() == empty {
            self.text.truncate(start);
        }
    }

    /// Completes the text.
    pub fn end(mut self) -> String {
        if self.form == Form::OpenMetrics {
            self.text.push_str("# EOF\n");
        }
        self.text
    }

    fn line(&mut self, line: impl Display) {
        // Writing to a string cannot fail.
        let _never_fails = writeln!(self.text, "{line}");
    }
}

/// Writer for the samples of a metric.
#[derive(Debug)]
pub struct Samples<'a> {
    page: &'a mut Page,
    name: &'a str,
    suffix: &'static str,
}

impl Samples<'_> {
    /// Writes a sample; `labels` are encoded by [`labels`].
    pub fn write_sample(&mut self, labels: &str, value: impl Display) {
        let (name, ending) = (self.name, self.suffix);
        self.page.line(format_args!("{name}{ending}{} {value}", with_braces(labels)));
    }

    /// Writes a histogram: cumulative counts with upper limits, sum of all values, number of values.
    pub fn histogram(&mut self, labels: &str, buckets: &[(f64, u64)], sum: f64, count: u64) {
        let name = self.name;
        let comma = if labels.is_empty() { "" } else { "," };
        for (up_to, count) in buckets {
            // Both formats accept `1.0`, and OpenMetrics requires it.
            self.page.line(format_args!("{name}_bucket{{{labels}{comma}le=\"{up_to:?}\"}} {count}"));
        }
        self.page.line(format_args!("{name}_bucket{{{labels}{comma}le=\"+Inf\"}} {count}"));
        self.page.line(format_args!("{name}_sum{} {sum}", with_braces(labels)));
        self.page.line(format_args!("{name}_count{} {count}", with_braces(labels)));
    }
}

fn with_braces(labels: &str) -> String {
    if labels.is_empty() { String::new() } else { format!("{{{labels}}}") }
}

/// Encodes labels; `first` are already encoded labels.
pub fn labels(first: &str, more: &[(&str, &str)]) -> String {
    let mut all = first.to_owned();
    for (name, value) in more {
        let comma = if all.is_empty() { "" } else { "," };
        let _never_fails = write!(all, "{comma}{name}=\"{}\"", escape(value));
    }
    all
}

/// Escapes and shortens a label value.
fn escape(value: &str) -> String {
    let value: String = value.chars().take(MAX_LABEL_CHARS).collect();
    escape::line(&value).replace('\\', "\\\\").replace('"', "\\\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selects_the_preferred_form() {
        for (accept, form) in [
            (None, Form::Text),
            (Some(""), Form::Text),
            (Some("*/*"), Form::Text),
            (Some("text/html, text/plain"), Form::Text),
            (Some("application/openmetrics-text"), Form::OpenMetrics),
            (Some("application/openmetrics-text; version=0.0.1"), Form::Text),
            (Some("application/openmetrics-text;version=1.0.0;q=0"), Form::Text),
            (Some("text/plain;version=0.0.4;q=0.9,application/openmetrics-text;q=0.3"), Form::Text),
            // The headers of Prometheus 2 and 3.
            (
                Some(
                    "application/openmetrics-text;version=1.0.0,application/openmetrics-text;version=0.0.1;q=0.75,\
                     text/plain;version=0.0.4;q=0.5,*/*;q=0.1",
                ),
                Form::OpenMetrics,
            ),
            (
                Some(
                    "application/openmetrics-text;version=1.0.0;escaping=allow-utf-8;q=0.6,\
                     application/openmetrics-text;version=0.0.1;q=0.5,text/plain;version=1.0.0;escaping=allow-utf-8;q=0.4,\
                     text/plain;version=0.0.4;q=0.3,*/*;q=0.2",
                ),
                Form::OpenMetrics,
            ),
            (Some(";;q,=,;q=x"), Form::Text),
        ] {
            assert_eq!(Form::preferred_form(accept), form, "{accept:?}");
        }
    }

    fn page(form: Form) -> String {
        let mut page = Page::new(form);
        page.metric("x_seconds", Kind::Histogram, "seconds", "How long.", |samples| {
            samples.histogram("a=\"b\"", &[(0.5, 1), (1.0, 3)], 2.5, 4);
        });
        page.metric("x_polls", Kind::Counter, "", "How often.", |samples| samples.write_sample("", 7));
        page.metric("x_build", Kind::Info, "", "Which.", |samples| samples.write_sample(&labels("", &[("v", "1")]), 1));
        page.metric("x_none", Kind::Gauge, "", "Nothing.", |_| {});
        page.end()
    }

    #[test]
    fn writes_each_form_in_its_syntax() {
        let lines = "x_seconds_bucket{a=\"b\",le=\"0.5\"} 1\nx_seconds_bucket{a=\"b\",le=\"1.0\"} 3\n\
                     x_seconds_bucket{a=\"b\",le=\"+Inf\"} 4\nx_seconds_sum{a=\"b\"} 2.5\nx_seconds_count{a=\"b\"} 4\n";
        assert_eq!(
            page(Form::OpenMetrics),
            format!(
                "# HELP x_seconds How long.\n# TYPE x_seconds histogram\n# UNIT x_seconds seconds\n{lines}\
                 # HELP x_polls How often.\n# TYPE x_polls counter\nx_polls_total 7\n\
                 # HELP x_build Which.\n# TYPE x_build info\nx_build_info{{v=\"1\"}} 1\n# EOF\n"
            )
        );
        assert_eq!(
            page(Form::Text),
            format!(
                "# HELP x_seconds How long.\n# TYPE x_seconds histogram\n{lines}\
                 # HELP x_polls_total How often.\n# TYPE x_polls_total counter\nx_polls_total 7\n\
                 # HELP x_build_info Which.\n# TYPE x_build_info gauge\nx_build_info{{v=\"1\"}} 1\n"
            )
        );
    }

    #[test]
    fn controller_text_stays_inside_its_label() {
        let injection = "a\"} 1\narmctl_robot_up{robot=\"b\\\u{1b}[2J";
        let escaped = labels("x=\"y\"", &[("text", injection)]);
        assert_eq!(escaped.lines().count(), 1);
        assert_eq!(escaped, r#"x="y",text="a\"} 1\\narmctl_robot_up{robot=\"b\\\\x1b[2J""#);
        assert_eq!(labels("", &[("long", &"x".repeat(999))]).len(), MAX_LABEL_CHARS + "long=\"\"".len());
    }
}
