//! Tests of keys and screen of the panel. `ARMCTL_BLESS=1` writes the screens again; check the diff.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};

use super::keys::KeyAction;
use super::model::{Model, PanelCommand, PointUse, Prompt};
use super::view::{Robot, render};
use crate::command::families;
use crate::command::fleet::top;
use crate::command::fleet::top::testing::{fleet, sample};
use armctl_frame::output::painter::Palette;
use armctl_frame::prelude::*;

fn model(family: Family) -> Model {
    Model::new(families::of(family).panel, 10.0, 10)
}

fn typed(model: &mut Model, keys: &str) -> Option<PanelCommand> {
    keys.chars().fold(None, |_, key| model.handle_key(KeyAction::Type(key)))
}

#[test]
fn one_key_is_one_step_and_further_keys_wait() {
    let mut model = model(Family::Yerc);
    assert_eq!(model.handle_key(KeyAction::Step(false)), Some(PanelCommand::Step { axis: 0, by: -0.1 }));
    model.is_moving = true;
    assert_eq!(model.handle_key(KeyAction::Step(true)), None);
    assert_eq!(model.handle_key(KeyAction::Store), None);
    assert_eq!(model.prompt, None);
    assert_eq!(model.handle_key(KeyAction::Stop), Some(PanelCommand::Stop));
}

#[test]
fn limits_the_step_size() {
    let mut yerc = Model::new(families::of(Family::Yerc).panel, 1.0, 10);
    for _ in 0..9 {
        yerc.handle_key(KeyAction::StepSize(1));
    }
    assert_eq!(yerc.step(), Some(1.0));
    // The controller's small step is 0.05 mm, so a hundred of them are 5 mm.
    let mut toyo = Model::new(families::of(Family::Toyo).panel, 1.0, 10);
    toyo.scale_by(vec![0.05; 4]);
    for _ in 0..9 {
        toyo.handle_key(KeyAction::StepSize(1));
    }
    assert_eq!(
        (toyo.step(), toyo.handle_key(KeyAction::Step(true))),
        (Some(0.5), Some(PanelCommand::Step { axis: 0, by: 10.0 }))
    );
    // All steps are above the limit, so nothing moves.
    let mut none = Model::new(families::of(Family::Yerc).panel, 0.001, 10);
    assert_eq!((none.step(), none.handle_key(KeyAction::Step(true))), (None, None));
}

#[test]
fn stores_a_point_after_a_read_and_a_yes() {
    let mut model = model(Family::Yerc);
    model.handle_key(KeyAction::Store);
    assert_eq!(typed(&mut model, "5x"), None);
    assert_eq!(model.handle_key(KeyAction::Enter), Some(PanelCommand::ReadPoint(5)));
    model.point_read(5, Ok(json!({"items": [{"name": "P5", "value": {"text": "pulse:s=1"}}]})));
    assert_eq!(model.prompt, Some(Prompt::Overwrite(PointUse::Store, 5, "pulse:s=1".to_owned())));
    assert_eq!(typed(&mut model, "y"), Some(PanelCommand::Store(5)));

    // Any other key means no.
    model.handle_key(KeyAction::Go);
    typed(&mut model, "7");
    model.point_read(7, Ok(json!({"points": [{"point": 7, "x_mm": 1.5, "y_mm": null, "ok": true}]})));
    assert_eq!(model.prompt, Some(Prompt::Overwrite(PointUse::Go, 7, "x_mm 1.5".to_owned())));
    assert_eq!((typed(&mut model, "n"), &model.prompt), (None, &None));
}

#[test]
fn stores_but_does_not_approach_an_empty_point() {
    let empty = || Err(Failure::new(Kind::Refused, "data undefined"));
    for (action, asked) in
        [(KeyAction::Store, Some(Prompt::Overwrite(PointUse::Store, 5, "empty".to_owned()))), (KeyAction::Go, None)]
    {
        let mut model = model(Family::Yerc);
        model.handle_key(action);
        typed(&mut model, "5");
        model.point_read(5, empty());
        assert_eq!(model.prompt, asked);
    }
}

/// A panel with commands in progress.
fn moving_model() -> Buffer {
    let mut seen = top::Model::new(&fleet(1), Duration::from_millis(250)).without_signals();
    seen.take(Duration::from_secs(1), 0, Ok(sample(1200.0)));
    let mut model = model(Family::Yerc);
    model.handle_key(KeyAction::Axis(1));
    model.handle_key(KeyAction::StepSize(1));
    seen.select_axis(model.axis_name());
    for (words, outcome) in [
        ("move relative --y 1 --coordinate base --speed 5mm/s", Some(Ok(()))),
        ("teach P5", Some(Ok(()))),
        ("move relative --y 1 --coordinate base --speed 5mm/s", None),
    ] {
        let number = model.begin(&[words.to_owned()]);
        if let Some(outcome) = outcome {
            model.end(number, outcome);
        }
    }
    model.is_moving = true;
    let area = Rect::new(0, 0, 80, 24);
    let mut buffer = Buffer::empty(area);
    let robot = Robot { seen: &seen, now: Duration::from_secs(1), is_real: true };
    render(&mut buffer, area, &model, &robot, Palette { has_color: true, is_unicode: true });
    buffer
}

#[test]
fn screen_picture_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures/teach.svg");
    let drawn = drawn(&moving_model());
    if std::env::var_os("ARMCTL_BLESS").is_some() {
        std::fs::write(&path, drawn).unwrap();
    } else {
        assert_eq!(std::fs::read_to_string(&path).unwrap(), drawn, "ARMCTL_BLESS=1 draws it anew");
    }
}

/// The screen as SVG.
fn drawn(buffer: &Buffer) -> String {
    let rows = buffer.content.chunks(usize::from(buffer.area.width));
    let text: String = rows.map(|row| row.iter().map(shown).collect::<String>() + "\n").collect();
    let night = anstyle::Color::Rgb(anstyle::RgbColor(0x16, 0x1b, 0x22));
    let grey = anstyle::Color::Rgb(anstyle::RgbColor(0xcc, 0xcc, 0xcc));
    let term = anstyle_svg::Term::new().fg_color(grey).bg_color(night).palette(anstyle_svg::WIN10_CONSOLE);
    term.render_svg(&text).lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

fn shown(cell: &Cell) -> String {
    let color = match cell.fg {
        Color::Red => Some(anstyle::AnsiColor::BrightRed),
        Color::Green => Some(anstyle::AnsiColor::Green),
        Color::Yellow => Some(anstyle::AnsiColor::Yellow),
        Color::Cyan => Some(anstyle::AnsiColor::Cyan),
        Color::DarkGray => Some(anstyle::AnsiColor::BrightBlack),
        _ => None,
    };
    let mut style = anstyle::Style::new().fg_color(color.map(Into::into));
    for (modifier, effect) in [
        (Modifier::BOLD, anstyle::Effects::BOLD),
        (Modifier::UNDERLINED, anstyle::Effects::UNDERLINE),
        (Modifier::REVERSED, anstyle::Effects::INVERT),
    ] {
        if cell.modifier.contains(modifier) {
            style = style.effects(style.get_effects() | effect);
        }
    }
    format!("{style}{}{style:#}", cell.symbol())
}
