//! Tests of screens as text. `ARMCTL_BLESS=1` writes them again; check the diff.

use std::path::Path;
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::super::keys::KeyAction;
use super::super::model::{Model, Moment};
use super::super::testing::{fail, fleet, sample, with_alarm};
use super::{Palette, render};

const POLL_INTERVAL: Duration = Duration::from_millis(500);
const UNICODE_PALETTE: Palette = Palette { has_color: true, is_unicode: true };
const ASCII_PALETTE: Palette = Palette { has_color: false, is_unicode: false };

/// Text of a screen, without colors.
fn picture(model: &Model, now: Moment, columns: u16, lines: u16, palette: Palette) -> String {
    let area = Rect::new(0, 0, columns, lines);
    let mut buffer = Buffer::empty(area);
    render(&mut buffer, area, model, model.displayed_time(now), palette);
    let rows = buffer.content.chunks(usize::from(columns).max(1));
    let text = |row: &[ratatui::buffer::Cell]| {
        let mut text = String::new();
        let mut hidden = 0;
        for cell in row {
            if hidden == 0 {
                text.push_str(cell.symbol());
                hidden = armctl_frame::output::painter::width(cell.symbol());
            }
            hidden = hidden.saturating_sub(1);
        }
        text.trim_end().to_owned() + "\n"
    };
    rows.map(text).collect()
}

/// Four robots: running, silent, with alarms, not polled yet.
fn four_robots() -> (Model, Moment) {
    let mut model = Model::new(&fleet(4), POLL_INTERVAL);
    let mut now = Duration::ZERO;
    for look in 0..40_u32 {
        now = POLL_INTERVAL * look;
        let wave = (f64::from(look) / 6.0).sin();
        let mut moving = sample(wave * 45_000.0);
        moving.answered_in = Some(Duration::from_millis(4) + Duration::from_millis(u64::from(look % 5)));
        if let Some(whole) = &mut moving.full {
            whole.axes[0].torque = Some((wave * 80.0).round());
        }
        model.take(now, 0, Ok(moving));
    }
    model.take(now, 1, Err(fail()));
    model.take(now, 2, Ok(with_alarm()));
    (model, now)
}

#[track_caller]
fn assert_picture(name: &str, shown: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/top").join(name);
    if std::env::var_os("ARMCTL_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, shown).unwrap();
    }
    let before = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(before, shown, "{name} is another picture; ARMCTL_BLESS=1 takes it");
}

#[test]
fn draws_the_list_at_80_and_120_columns() {
    let (model, now) = four_robots();
    assert_picture("list-80x24.txt", &picture(&model, now, 80, 24, UNICODE_PALETTE));
    assert_picture("list-120x40.txt", &picture(&model, now, 120, 40, UNICODE_PALETTE));
    assert_picture("list-80x24-ascii.txt", &picture(&model, now, 80, 24, ASCII_PALETTE));
}

#[test]
fn draws_one_robot_at_80_and_120_columns() {
    let (mut model, now) = four_robots();
    model.handle_key(now, KeyAction::Open);
    assert_picture("robot-80x24.txt", &picture(&model, now, 80, 24, UNICODE_PALETTE));
    assert_picture("robot-120x40.txt", &picture(&model, now, 120, 40, UNICODE_PALETTE));
    assert_picture("robot-80x24-ascii.txt", &picture(&model, now, 80, 24, ASCII_PALETTE));
}

#[test]
fn draws_robots_with_faults() {
    let (mut model, now) = four_robots();
    model.handle_key(now, KeyAction::Open);
    model.handle_key(now, KeyAction::Next);
    assert_picture("silent-80x24.txt", &picture(&model, now, 80, 24, UNICODE_PALETTE));
    model.handle_key(now, KeyAction::Next);
    assert_picture("alarmed-80x24.txt", &picture(&model, now, 80, 24, UNICODE_PALETTE));
}

#[test]
fn draws_the_help() {
    let (mut model, now) = four_robots();
    model.handle_key(now, KeyAction::Help);
    assert_picture("help-80x24.txt", &picture(&model, now, 80, 24, UNICODE_PALETTE));
}

#[test]
fn draws_at_every_size() {
    let (mut model, now) = four_robots();
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
        model.handle_key(now, order);
        for (columns, lines) in (0..50).flat_map(|columns| (0..30).map(move |lines| (columns, lines))) {
            picture(&model, now, columns, lines, UNICODE_PALETTE);
        }
        for (columns, lines) in [(1, 300), (400, 1), (400, 2), (400, 3), (500, 120), (81, 25)] {
            picture(&model, now, columns, lines, ASCII_PALETTE);
        }
    }
}

#[test]
fn escapes_control_characters_of_controllers() {
    let (mut model, now) = four_robots();
    model.cursor = 2;
    model.handle_key(now, KeyAction::Open);
    let shown = picture(&model, now, 120, 40, UNICODE_PALETTE);
    assert!(shown.contains("衝突\\x1b[2J検出"), "{shown}");
    assert!(!shown.contains('\x1b'));
}

#[test]
fn draws_only_ascii_characters() {
    let (mut model, now) = four_robots();
    for order in [KeyAction::Refresh, KeyAction::Open, KeyAction::Help] {
        model.handle_key(now, order);
        let shown = picture(&model, now, 120, 40, ASCII_PALETTE);
        assert!(shown.is_ascii(), "{}", shown.lines().find(|line| !line.is_ascii()).unwrap());
    }
}

#[test]
fn draws_the_pause() {
    let (mut model, now) = four_robots();
    assert!(!picture(&model, now, 80, 24, UNICODE_PALETTE).contains("PAUSED"));
    model.handle_key(now, KeyAction::Pause);
    assert!(picture(&model, now, 80, 24, UNICODE_PALETTE).contains("PAUSED"));
}

#[test]
fn draws_stale_data() {
    let (model, now) = four_robots();
    let late = picture(&model, now + Duration::from_secs(90), 80, 24, UNICODE_PALETTE);
    assert!(late.contains("90s ago"), "{late}");
}
