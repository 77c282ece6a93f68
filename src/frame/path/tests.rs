//! Tests of pictures: nothing leaves the picture, no text becomes markup, and large programs stay small.

use proptest::prelude::*;

use super::*;
use crate::Report as _;
use crate::output::render;

const SPACE: [&str; 4] = ["X", "Y", "Z", "R"];

fn step(name: &str, text: &str, interpolation: Interpolation) -> Step {
    Step { name: name.to_owned(), line: 1, text: text.to_owned(), interpolation, track: Vec::new() }
}

/// Motion through these points at 100 mm/s.
fn motion(points: &[[f64; 4]], text: &str, interpolation: Interpolation, unit: &'static str) -> Motion {
    let mut recorder = Recorder::default();
    for (index, point) in points.iter().enumerate() {
        recorder.go(step(&format!("C{index}"), text, interpolation), &[], point.to_vec(), |points| {
            Some(length(points) / 100.0)
        });
    }
    let (steps, is_timed) = recorder.finish();
    let not_drawn = vec![NotDrawn { line: 9, text: text.to_owned(), reason: "<b>".to_owned() }];
    let frame = "base, tool 1".to_owned();
    Motion {
        program: text.to_owned(),
        frame,
        axes: SPACE.to_vec(),
        unit,
        is_timed,
        steps,
        not_drawn,
        ..Motion::default()
    }
}

/// Values of an attribute.
fn attributes<'t>(svg: &'t str, name: &str) -> impl Iterator<Item = &'t str> {
    let mark = format!(" {name}=\"");
    svg.match_indices(&mark)
        .map(|(at, mark)| svg[at + mark.len()..].split('"').next().unwrap())
        .collect::<Vec<_>>()
        .into_iter()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn every_point_is_inside_the_view_box(
        points in prop::collection::vec(prop::array::uniform4(-8000.0..8000.0_f64), 0..12),
        old in prop::collection::vec(prop::array::uniform4(-8000.0..8000.0_f64), 1..12),
        unit in prop::sample::select(vec!["mm", "pulses"]),
        text in "[a-z<>&\"'\u{1b}語 ]{0,20}",
    ) {
        let drawing = Drawing::new(
            motion(&points, &text, Interpolation::Joints, unit),
            Some(motion(&old, &text, Interpolation::Straight, unit)),
        );
        let svg = svg::document(&drawing);
        let view_box = attributes(&svg, "viewBox").next().unwrap();
        let size: Vec<f64> = view_box.split(' ').map(|number| number.parse().unwrap()).collect();
        let check = |x: f64, y: f64| (0.0..=size[2]).contains(&x) && (0.0..=size[3]).contains(&y);
        for (x, y) in attributes(&svg, "cx").zip(attributes(&svg, "cy")) {
            prop_assert!(check(x.parse().unwrap(), y.parse().unwrap()), "{x} {y} {view_box}");
        }
        for pair in attributes(&svg, "d").filter(|d| d.contains('L')).flat_map(|d| d.split(['M', 'L', 'Z'])).filter(|pair| !pair.is_empty()) {
            let (x, y) = pair.split_once(' ').unwrap();
            prop_assert!(check(x.parse().unwrap(), y.parse().unwrap()), "{pair} {view_box}");
        }
        prop_assert_eq!(svg.matches("<circle ").count(), (points.len() + if drawing.old.is_some() { old.len() } else { 0 }) * drawing_panels(unit));
        let shown = render::text(&PathReport::new(drawing, None, Vec::new()).view(), 80, false);
        prop_assert!(!shown.contains('\u{1b}'), "escaped");
    }
}

fn drawing_panels(unit: &str) -> usize {
    if unit == "mm" { 3 } else { SPACE.len() }
}

#[test]
fn text_never_becomes_markup() {
    let text = "</text></script><script>alert(1)</script>\u{7}\"'&";
    let drawing = Drawing::new(motion(&[[0.0; 4], [1.0; 4]], text, Interpolation::Straight, "mm"), None);
    let (svg, page) = (svg::document(&drawing), html::page(&drawing));
    for (document, own) in [(&svg, 0), (&page, 1)] {
        assert_eq!(document.matches("<script").count(), own);
        assert_eq!(document.matches("</script").count(), own);
        assert!(!document.contains('\u{7}') && document.contains("&lt;script&gt;alert"));
    }
    let addresses = page.matches("://").count();
    assert_eq!(addresses, 1, "only the name of the SVG language looks like an address");
}

#[test]
fn ten_thousand_steps_stay_small() {
    let points: Vec<[f64; 4]> = (0..10_000_u32)
        .map(|index| {
            let turn = f64::from(index) / 50.0;
            [800.0 + 300.0 * turn.cos(), 300.0 * turn.sin(), turn, 0.0]
        })
        .collect();
    let old = motion(&points[..9000], "MOVL C00001 V=100.0", Interpolation::Straight, "mm");
    let drawing = Drawing::new(motion(&points, "MOVL C00001 V=100.0", Interpolation::Straight, "mm"), Some(old));
    let (svg, page) = (svg::document(&drawing), html::page(&drawing));
    assert!(svg.len() < 2 << 20 && page.len() < 5 << 20, "{} {}", svg.len(), page.len());
    let view = PathReport::new(drawing, None, Vec::new()).view();
    assert!(render::text(&view, 80, false).lines().count() < 120);
}

#[test]
fn difference_has_names_and_the_greatest_distance() {
    let old = motion(&[[0.0; 4], [10.0, 0.0, 0.0, 0.0], [5.0; 4]], "", Interpolation::Straight, "mm");
    let mut new = motion(&[[0.0; 4], [13.0, 4.0, 0.0, 2.0]], "", Interpolation::Straight, "mm");
    new.steps[0].name = "C9".to_owned();
    let difference = Drawing::new(new.clone(), Some(old.clone())).difference.unwrap();
    assert_eq!(
        difference.in_a_line(),
        "1 of 1 positions differ (C1), by 5.000 mm at most, and by 2.000 in the other axes, new: C9, removed: C0 and C2."
    );
    let other = Motion { frame: "user 1, tool 0".to_owned(), ..old.clone() };
    let drawing = Drawing::new(new, Some(other));
    assert!(drawing.old.is_none() && !drawing.difference.unwrap().is_same_frame);
    assert_eq!(Drawing::new(old.clone(), Some(old)).difference.unwrap().in_a_line(), "All 3 positions are the same.");
}

#[test]
fn unknown_times_become_equal_steps() {
    let mut recorder = Recorder::default();
    let mut go = |x: f64, seconds: Option<f64>| {
        recorder.go(step("C1", "", Interpolation::Straight), &[], vec![x, 0.0, 0.0], move |_| seconds);
    };
    go(0.0, None);
    go(10.0, Some(5.0));
    go(20.0, None);
    let (steps, is_timed) = recorder.finish();
    let ends: Vec<f64> = steps.iter().map(|step| step.track.last().unwrap().time).collect();
    assert_eq!((is_timed, ends), (false, vec![1.0, 2.0, 3.0]));
    assert_eq!((steps[0].interpolation, steps[0].track.len()), (Interpolation::Start, 1));
}

#[test]
fn arc_goes_through_its_points() {
    let (from, via, to) = ([10.0, 0.0, 5.0], [0.0, 10.0, 5.0], [-10.0, 0.0, 5.0]);
    for is_first in [true, false] {
        let points = arc(&from, &via, &to, is_first);
        assert!(points.iter().all(|at| (at[0].hypot(at[1]) - 10.0).abs() < 1e-9 && (at[2] - 5.0).abs() < 1e-9));
        assert!(points.iter().all(|at| at[1] > 0.0 && (at[0] > 0.0) == is_first), "{points:?}");
    }
    assert_eq!(arc(&from, &[0.0, 0.0, 5.0], &to, true), Vec::<Vec<f64>>::new());
}

#[test]
fn simplified_track_keeps_a_wait() {
    let track = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 5.0), (4.0, 10.0)];
    let track = track.map(|(time, x)| Moment { time, at: vec![x] });
    let times: Vec<f64> = simplify(track.to_vec(), 0.01).iter().map(|moment| moment.time).collect();
    assert_eq!(times, [0.0, 2.0, 4.0]);
}
