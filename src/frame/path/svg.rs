//! Picture of a motion as SVG.

use std::fmt::Write as _;

use super::layout::{Panel, Range, panels};
use super::model::{Drawing, Interpolation, Motion};
use super::report::{notes, omissions};

/// Width of the picture, and the space at its sides.
const WIDTH: f64 = 1000.0;
const SIDE: f64 = 24.0;
/// Space for the numbers at the left of a panel, above a panel, and below it.
const LEFT: f64 = 58.0;
const ABOVE: f64 = 26.0;
const BELOW: f64 = 38.0;
/// Maximum height of the panels of a space, and height of an axis over time.
const MAX_HEIGHT: f64 = 760.0;
const HEIGHT_OF_AXIS: f64 = 96.0;
/// Pixels between two marks of an axis.
const TICK: f64 = 70.0;
/// Maximum number of steps with their numbers, and with their texts.
const MAX_NUMBERS: usize = 80;
const MAX_TITLES: usize = 1000;
/// Maximum number of arrows in a panel.
const MAX_ARROWS: usize = 200;
/// Characters of a line of text below the picture.
const CHARACTERS: usize = 150;

/// Colors and lines. Style elements apply to the whole page, so each class begins with `p-`.
pub const STYLE: &str = "\
.p-pic{--bg:#fff;--fg:#1f2328;--dim:#656d76;--grid:#e7eaee;--edge:#c8cdd3;--new:#0b62c4;--old:#d1571b;--now:#b3005e;\
font:13px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans',sans-serif}\
@media (prefers-color-scheme:dark){.p-pic{--bg:#0f1318;--fg:#e8ecf1;--dim:#97a1ac;--grid:#222932;--edge:#3a434e;\
--new:#58a6ff;--old:#f0883e;--now:#ff7bbd}}\
@media print{.p-pic{--bg:#fff;--fg:#000;--dim:#444;--grid:#ddd;--edge:#888;--new:#0b3d91;--old:#c2410c;--now:transparent}}\
.p-bg{fill:var(--bg)}.p-pic text{fill:var(--fg)}.p-pic .p-dim{fill:var(--dim)}.p-title{font-size:20px;font-weight:600}\
.p-name{font-weight:600}.p-box{fill:none;stroke:var(--edge)}.p-grid{stroke:var(--grid);fill:none}\
.p-line{fill:none;stroke:var(--new);stroke-width:2;stroke-linejoin:round;stroke-linecap:round}\
.p-old .p-line{stroke:var(--old);stroke-width:1.6;opacity:.85}.p-dash{stroke-dasharray:3 6}\
.p-order{stroke-dasharray:.1 6;opacity:.6}.p-dot{fill:var(--bg);stroke:var(--new);stroke-width:1.8}\
.p-old .p-dot{stroke:var(--old)}.p-dots{stroke:var(--new);stroke-width:4;stroke-linecap:round;fill:none}\
.p-old .p-dots{stroke:var(--old)}.p-arrow{fill:var(--new)}.p-pic .p-number{font-size:11px;font-weight:600;\
paint-order:stroke;stroke:var(--bg);stroke-width:3px}.p-tick{font-size:11px}\
.p-now{fill:var(--now);stroke:var(--bg);stroke-width:2}.p-then{stroke:var(--now);stroke-width:1.4}";

/// A panel at its place.
#[derive(Debug, Clone)]
pub struct Placed {
    pub panel: Panel,
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Placed {
    /// Place of a point of the panel.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let share = |value: f64, range: Range| (value - range.least) / range.length();
        [
            self.left + share(x, self.panel.x.range) * self.width,
            self.top + (1.0 - share(y, self.panel.y.range)) * self.height,
        ]
    }
}

/// A picture with the places of its panels.
#[derive(Debug)]
pub struct Picture {
    /// The `svg` element, without its style.
    pub body: String,
    pub panels: Vec<Placed>,
    pub height: f64,
}

/// A complete SVG file.
pub fn document(drawing: &Drawing) -> String {
    let Picture { body, height, .. } = draw(drawing, true);
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}<style>{STYLE}</style>\n<rect class=\"p-bg\" width=\"100%\" \
         height=\"100%\"/>\n{body}</svg>\n",
        head(&drawing.motion, height)
    )
}

/// Start of an `svg` element of this height.
pub fn head(motion: &Motion, height: f64) -> String {
    let (width, height) = (number(WIDTH), number(height));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"p-pic\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" role=\"img\" aria-label=\"{}\">\n",
        escape(&format!("Path of {}", motion.program))
    )
}

/// Draws the panels; `has_text` adds the title, and the sentences below.
pub fn draw(drawing: &Drawing, has_text: bool) -> Picture {
    let mut body = String::new();
    let mut top = 16.0;
    if has_text {
        top = heading(&mut body, drawing);
    }
    top = legend(&mut body, drawing, top);
    let panels = placed(drawing, top);
    let mut height = panels.iter().map(|panel| panel.top + panel.height).fold(top, f64::max) + BELOW;
    for (index, panel) in panels.iter().enumerate() {
        // Axes over time have a common time.
        let has_numbers = panel.panel.x.axis.is_some() || index + 1 == panels.len();
        draw_panel(&mut body, drawing, panel, has_numbers);
    }
    if has_text {
        for line in remarks(drawing).iter().flat_map(|remark| wrapped(remark)) {
            height += 18.0;
            text(&mut body, [SIDE, height], "p-dim", &line);
        }
        height += 8.0;
    }
    Picture { body, panels, height: height + 12.0 }
}

/// Title and frame. Returns the space that is used.
fn heading(body: &mut String, drawing: &Drawing) -> f64 {
    text(body, [SIDE, 36.0], "p-title", &drawing.motion.program);
    text(body, [SIDE, 57.0], "p-dim", &summary(drawing));
    72.0
}

/// Steps, frame and time in a line.
pub fn summary(drawing: &Drawing) -> String {
    let motion = &drawing.motion;
    let count = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let mut parts = vec![
        count(motion.steps.len(), if motion.is_points { "point" } else { "step" }),
        format!("{} ({})", motion.frame, motion.unit),
    ];
    parts.extend(motion.is_timed.then(|| format!("{:.2} s", motion.end())));
    parts.extend(
        (!motion.not_drawn.is_empty()).then(|| format!("{} not drawn", count(motion.not_drawn.len(), motion.noun()))),
    );
    parts.join(" · ")
}

/// Sentences below the picture, and the lines that are not drawn.
pub fn remarks(drawing: &Drawing) -> Vec<String> {
    [notes(drawing), omissions(&drawing.motion)].concat()
}

/// What the lines mean. Returns the space that is used.
fn legend(body: &mut String, drawing: &Drawing, top: f64) -> f64 {
    let mut entries: Vec<(&str, &str, &str)> = Vec::new();
    if drawing.old.is_some() {
        entries.extend([("", "", "new"), ("p-old", "", "old")]);
    }
    let has = |interpolations: &[Interpolation]| {
        drawing
            .motions()
            .any(|(_, motion)| motion.steps.iter().any(|step| interpolations.contains(&step.interpolation)))
    };
    if drawing.motion.has_space() {
        for (interpolations, class, what) in [
            (&[Interpolation::Straight, Interpolation::Arc][..], "", "straight line or arc"),
            (&[Interpolation::Joints], "p-dash", "joint motion: not a straight line"),
            (&[Interpolation::Curve], "p-dash", "free curve: only its points are known"),
            (&[Interpolation::Order], "p-order", "order of the numbers, not a motion"),
        ] {
            entries.extend(has(interpolations).then_some(("", class, what)));
        }
    }
    let mut x = SIDE;
    for (group, class, what) in &entries {
        let _ = write!(
            body,
            "<g class=\"{group}\"><path class=\"p-line {class}\" d=\"M{} {}h28\"/></g>",
            number(x),
            number(top + 6.0)
        );
        text(body, [x + 36.0, top + 10.0], "p-dim", what);
        x += 62.0 + 6.6 * count(what.chars().count());
    }
    if entries.is_empty() { top } else { top + 22.0 }
}

/// Places the panels. A space is drawn as on a sheet: the view from above, the view from the front below it, and the
/// view from the side at its right, all in the same scale.
fn placed(drawing: &Drawing, top: f64) -> Vec<Placed> {
    let panels = panels(drawing);
    let inner = WIDTH - 2.0 * SIDE;
    let top = top + ABOVE;
    if !drawing.motion.has_space() {
        let mut next = top;
        let place = |panel| {
            let placed = Placed { panel, left: SIDE + LEFT, top: next, width: inner - LEFT, height: HEIGHT_OF_AXIS };
            next += HEIGHT_OF_AXIS + ABOVE;
            placed
        };
        return panels.into_iter().map(place).collect();
    }
    let [x, y, z] = [panels[0].x.range, panels[0].y.range, panels[1].y.range].map(Range::length);
    let scale = ((inner - 2.0 * LEFT) / (x + y)).min((MAX_HEIGHT - ABOVE - BELOW) / (y + z));
    let (wide, deep, high) = (x * scale, y * scale, z * scale);
    let (left, second) = (SIDE + LEFT, top + deep + BELOW + ABOVE);
    let places = [(left, top, wide, deep), (left, second, wide, high), (left + wide + LEFT, second, deep, high)];
    let place = |(panel, (left, top, width, height))| Placed { panel, left, top, width, height };
    panels.into_iter().zip(places).map(place).collect()
}

fn draw_panel(body: &mut String, drawing: &Drawing, placed: &Placed, has_numbers: bool) {
    let Placed { panel, left, top, width, height } = placed;
    let (right, bottom) = (left + width, top + height);
    let _ = writeln!(body, "<g data-panel=\"{}\">", escape(&panel.title));
    text(body, [*left, top - 9.0], "p-name", &panel.title);
    let count_y = (height / (TICK * 0.6)).max(1.0);
    for tick in panel.x.range.ticks(width / TICK) {
        let [x, _] = placed.place([tick, panel.y.range.least]);
        let _ = write!(body, "<path class=\"p-grid\" d=\"M{} {}V{}\"/>", number(x), number(*top), number(bottom));
        if has_numbers {
            anchored(body, [x, bottom + 15.0], "middle", &number(tick));
        }
    }
    for tick in panel.y.range.ticks(count_y) {
        let [_, y] = placed.place([panel.x.range.least, tick]);
        let _ = write!(body, "<path class=\"p-grid\" d=\"M{} {}H{}\"/>", number(*left), number(y), number(right));
        anchored(body, [left - 6.0, y + 4.0], "end", &number(tick));
    }
    let _ = write!(
        body,
        "<rect class=\"p-box\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
        number(*left),
        number(*top),
        number(*width),
        number(*height)
    );
    if has_numbers {
        anchored(body, [right, bottom + 30.0], "end", &panel.x.label);
    }
    anchored(body, [right, top - 9.0], "end", &panel.y.label);
    for trace in &panel.traces {
        let steps = drawing.motions().find(|(is_old, _)| *is_old == trace.is_old).map(|(_, motion)| &motion.steps);
        let steps = steps.map_or(&[][..], Vec::as_slice);
        let _ = writeln!(body, "<g class=\"{}\">", if trace.is_old { "p-old" } else { "p-new" });
        let mut arrows = String::new();
        let mut arrows_left = if trace.is_old || panel.x.axis.is_none() { 0 } else { MAX_ARROWS };
        for stroke in &trace.strokes {
            let class = match stroke.interpolation {
                // Over time, each axis is drawn as it is known: at the steps.
                _ if panel.x.axis.is_none() => "p-line",
                Interpolation::Joints | Interpolation::Curve => "p-line p-dash",
                Interpolation::Order => "p-line p-order",
                Interpolation::Start | Interpolation::Straight | Interpolation::Arc => "p-line",
            };
            let points: Vec<[f64; 2]> = stroke.points.iter().map(|point| placed.place(*point)).collect();
            if points.len() < 2 {
                continue;
            }
            let _ = writeln!(body, "<path class=\"{class}\" d=\"{}\"/>", path(&points));
            for (from, to) in points.iter().zip(&points[1..]) {
                if stroke.interpolation != Interpolation::Order && arrows_left > 0 && arrow(&mut arrows, *from, *to) {
                    arrows_left -= 1;
                }
            }
        }
        if !arrows.is_empty() {
            let _ = writeln!(body, "<path class=\"p-arrow\" d=\"{arrows}\"/>");
        }
        let targets = || trace.targets.iter().map(|(index, target)| (*index, placed.place(*target)));
        if steps.len() > MAX_TITLES {
            // Each dot is a line without length.
            let dots: String = targets().map(|(_, [x, y])| format!("M{} {}h0", number(x), number(y))).collect();
            let _ = writeln!(body, "<path class=\"p-dots\" d=\"{dots}\"/>");
        } else {
            for (index, [x, y]) in targets() {
                let title = steps
                    .get(index)
                    .map(|step| format!("{}: {} {}, {}", index + 1, drawing.motion.noun(), step.line, step.text));
                let _ = writeln!(
                    body,
                    "<circle class=\"p-dot\" cx=\"{}\" cy=\"{}\" r=\"3.4\"><title>{}</title></circle>",
                    number(x),
                    number(y),
                    escape(&title.unwrap_or_default())
                );
            }
        }
        if !trace.is_old && steps.len() <= MAX_NUMBERS && panel.x.axis.is_some() {
            let numbered = targets().map(|(index, place)| (drawing.motion.number(index), place));
            numbers(body, numbered, placed);
        }
        body.push_str("</g>\n");
    }
    body.push_str("</g>\n");
}

/// Numbers of the steps next to their points. Steps at the same place share a text, and a text that would cover another
/// text is left out.
fn numbers(body: &mut String, targets: impl Iterator<Item = (usize, [f64; 2])>, placed: &Placed) {
    let mut groups: Vec<([f64; 2], Vec<usize>)> = Vec::new();
    let is_near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 5.0 && (a[1] - b[1]).abs() < 5.0;
    for (number, place) in targets {
        match groups.iter_mut().find(|(other, _)| is_near(*other, place)) {
            Some((_, numbers)) => numbers.push(number),
            None => groups.push((place, vec![number])),
        }
    }
    let mut boxes: Vec<[f64; 4]> = Vec::new();
    for ([x, y], steps) in groups {
        let shown = if let [first, second, third, _, ..] = steps[..] {
            format!("{first},{second},{third}…")
        } else {
            steps.iter().map(usize::to_string).collect::<Vec<_>>().join(",")
        };
        let width = 6.4 * count(shown.chars().count());
        let fits = |at: &[f64; 2]| {
            let [left, base] = *at;
            let is_inside =
                left >= placed.left && left + width <= placed.left + placed.width && base - 10.0 >= placed.top;
            is_inside
                && !boxes.iter().any(|[l, t, r, b]| left < *r && left + width > *l && base - 10.0 < *b && base > *t)
        };
        let spots = [[x + 6.0, y - 6.0], [x + 6.0, y + 13.0], [x - 6.0 - width, y - 6.0], [x - 6.0 - width, y + 13.0]];
        if let Some([left, base]) = spots.into_iter().find(fits) {
            boxes.push([left, base - 10.0, left + width, base]);
            text(body, [left, base], "p-number", &shown);
        }
    }
}

/// Adds an arrow in the middle of a line that is long enough.
fn arrow(arrows: &mut String, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) -> bool {
    let (dx, dy) = (x2 - x1, y2 - y1);
    let length = dx.hypot(dy);
    if length < 44.0 {
        return false;
    }
    let (ux, uy) = (dx / length, dy / length);
    let (x, y) = (f64::midpoint(x1, x2), f64::midpoint(y1, y2));
    let corner = |along: f64, across: f64| {
        format!("{} {}", number(x + ux * along - uy * across), number(y + uy * along + ux * across))
    };
    let _ = write!(arrows, "M{}L{}L{}Z", corner(7.0, 0.0), corner(-4.0, 4.5), corner(-4.0, -4.5));
    true
}

fn path(points: &[[f64; 2]]) -> String {
    let mut path = String::with_capacity(points.len() * 12);
    for (index, [x, y]) in points.iter().enumerate() {
        let _ = write!(path, "{}{} {}", if index == 0 { 'M' } else { 'L' }, number(*x), number(*y));
    }
    path
}

fn text(body: &mut String, [x, y]: [f64; 2], class: &str, words: &str) {
    let _ = writeln!(body, "<text class=\"{class}\" x=\"{}\" y=\"{}\">{}</text>", number(x), number(y), escape(words));
}

fn anchored(body: &mut String, [x, y]: [f64; 2], anchor: &str, words: &str) {
    let _ = writeln!(
        body,
        "<text class=\"p-dim p-tick\" text-anchor=\"{anchor}\" x=\"{}\" y=\"{}\">{}</text>",
        number(x),
        number(y),
        escape(words)
    );
}

/// Number with at most two decimals.
pub fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn count(count: usize) -> f64 {
    f64::from(u32::try_from(count).unwrap_or(u32::MAX))
}

/// Lines of a text, broken between words.
fn wrapped(words: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words.split_whitespace() {
        let last = lines.last().map_or(0, |line| line.chars().count());
        if last > 0 && last + 1 + word.chars().count() > CHARACTERS {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            line.push_str(if line.is_empty() { "" } else { " " });
            line.push_str(word);
        }
    }
    lines
}

/// Escapes text of an element or an attribute. Control characters are not allowed in XML.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
