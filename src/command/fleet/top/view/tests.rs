//! Tests of screens as text. `ARMCTL_BLESS=1` writes them again; check the diff.

use std::path::Path;
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::super::keys::KeyAction;
use super::super::model::{Model, Moment};
use super::super::testing::{alarmed, fleet, sample, silence};
use super::{Palette, render};

const EVERY: Duration = Duration::from_millis(500);
const RICH: Palette = Palette { has_color: true, is_unicode: true };
const POOR: Palette = Palette { has_color: false, is_unicode: false };

/// Text of a screen, without colors.
fn picture(model: &Model, now: Moment, columns: u16, lines: u16, palette: Palette) -> String {
    let area = Rect::new(0, 0, columns, lines);
    let mut buffer = Buffer::empty(area);
    render(&mut buffer, area, model, model.moment(now), palette);
    let rows = buffer.content.chunks(usize::from(columns).max(1));
    let text = |row: &[ratatui::buffer::Cell]| {
        let mut text = String::new();
        let mut hidden = 0;
        for cell in row {
            if hidden == 0 {
                text.push_str(cell.symbol());
                hidden = crate::output::painter::width(cell.symbol());
            }
            hidden = hidden.saturating_sub(1);
        }
        text.trim_end().to_owned() + "\n"
    };
    rows.map(text).collect()
}

/// Four robots: running, silent, with alarms, not polled yet.
fn four() -> (Model, Moment) {
    let mut model = Model::new(&fleet(4), EVERY);
    let mut now = Duration::ZERO;
    for look in 0..40_u32 {
        now = EVERY * look;
        let wave = (f64::from(look) / 6.0).sin();
        let mut moving = sample(wave * 45_000.0);
        moving.answered_in = Some(Duration::from_millis(4) + Duration::from_millis(u64::from(look % 5)));
        if let Some(whole) = &mut moving.full {
            whole.axes[0].torque = Some((wave * 80.0).round());
        }
        model.take(now, 0, Ok(moving));
    }
    model.take(now, 1, Err(silence()));
    model.take(now, 2, Ok(alarmed()));
    (model, now)
}

#[track_caller]
fn is_as_before(name: &str, shown: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/top").join(name);
    if std::env::var_os("ARMCTL_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, shown).unwrap();
    }
    let before = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(before, shown, "{name} is another picture; ARMCTL_BLESS=1 takes it");
}

#[test]
fn the_list_at_80_and_120_columns() {
    let (model, now) = four();
    is_as_before("list-80x24.txt", &picture(&model, now, 80, 24, RICH));
    is_as_before("list-120x40.txt", &picture(&model, now, 120, 40, RICH));
    is_as_before("list-80x24-ascii.txt", &picture(&model, now, 80, 24, POOR));
}

#[test]
fn one_robot_at_80_and_120_columns() {
    let (mut model, now) = four();
    model.obey(now, KeyAction::Open);
    is_as_before("robot-80x24.txt", &picture(&model, now, 80, 24, RICH));
    is_as_before("robot-120x40.txt", &picture(&model, now, 120, 40, RICH));
    is_as_before("robot-80x24-ascii.txt", &picture(&model, now, 80, 24, POOR));
}

#[test]
fn robots_in_trouble_on_their_screens() {
    let (mut model, now) = four();
    model.obey(now, KeyAction::Open);
    model.obey(now, KeyAction::Next);
    is_as_before("silent-80x24.txt", &picture(&model, now, 80, 24, RICH));
    model.obey(now, KeyAction::Next);
    is_as_before("alarmed-80x24.txt", &picture(&model, now, 80, 24, RICH));
}

#[test]
fn the_keys_are_explained() {
    let (mut model, now) = four();
    model.obey(now, KeyAction::Help);
    is_as_before("help-80x24.txt", &picture(&model, now, 80, 24, RICH));
}

#[test]
fn no_size_is_too_small_and_none_too_big() {
    let (mut model, now) = four();
    for order in [
        KeyAction::Sort,
        KeyAction::Open,
        KeyAction::Next,
        KeyAction::Next,
        KeyAction::Next,
        KeyAction::Help,
        KeyAction::Pause,
        KeyAction::Filter,
    ] {
        model.obey(now, order);
        for (columns, lines) in (0..50).flat_map(|columns| (0..30).map(move |lines| (columns, lines))) {
            picture(&model, now, columns, lines, RICH);
        }
        for (columns, lines) in [(1, 300), (400, 1), (400, 2), (400, 3), (500, 120), (81, 25)] {
            picture(&model, now, columns, lines, POOR);
        }
    }
}

#[test]
fn nothing_that_a_controller_says_steers_the_terminal() {
    let (mut model, now) = four();
    model.cursor = 2;
    model.obey(now, KeyAction::Open);
    let shown = picture(&model, now, 120, 40, RICH);
    assert!(shown.contains("衝突\\x1b[2J検出"), "{shown}");
    assert!(!shown.contains('\x1b'));
}

#[test]
fn ascii_is_ascii() {
    let (mut model, now) = four();
    for order in [KeyAction::Refresh, KeyAction::Open, KeyAction::Help] {
        model.obey(now, order);
        let shown = picture(&model, now, 120, 40, POOR);
        assert!(shown.is_ascii(), "{}", shown.lines().find(|line| !line.is_ascii()).unwrap());
    }
}

#[test]
fn a_pause_is_seen() {
    let (mut model, now) = four();
    assert!(!picture(&model, now, 80, 24, RICH).contains("PAUSED"));
    model.obey(now, KeyAction::Pause);
    assert!(picture(&model, now, 80, 24, RICH).contains("PAUSED"));
}

#[test]
fn what_is_late_says_so() {
    let (model, now) = four();
    let late = picture(&model, now + Duration::from_secs(90), 80, 24, RICH);
    assert!(late.contains("90s ago"), "{late}");
}
