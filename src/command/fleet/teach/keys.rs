//! Key bindings of the teach panel.

use armctl_frame::output::fullscreen::{KeyCode, KeyEvent, KeyEventKind, has_control};
use armctl_frame::output::painter::KeyHelp;

/// Action of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyAction {
    /// Previous or next axis.
    Axis(isize),
    /// Move the selected axis by one step, forward or backward.
    Step(bool),
    /// Larger or smaller step.
    StepSize(isize),
    /// Faster or slower.
    Speed(isize),
    /// Next coordinate system.
    System,
    /// Stop the robot.
    Stop,
    /// Release HOLD.
    Release,
    /// Store a point.
    Store,
    /// Move to a point.
    Go,
    /// Add a character to the answer.
    Type(char),
    /// Remove the last character.
    Erase,
    /// Confirm the answer.
    Enter,
    /// Cancel the answer, or close the help.
    Escape,
    /// Open or close the help.
    Help,
    /// Quit.
    Quit,
    /// Quit as with Ctrl-C.
    Interrupt,
    /// Redraw the screen.
    Refresh,
}

/// Action of a key; `None` if the key has no action. With `is_asked`, the key belongs to an answer, but a stop key
/// always stops.
pub fn action(key: KeyEvent, is_asked: bool) -> Option<KeyAction> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if has_control(key) {
        return match key.code {
            KeyCode::Char('c') => Some(KeyAction::Interrupt),
            KeyCode::Char('l') => Some(KeyAction::Refresh),
            _ => None,
        };
    }
    Some(match key.code {
        KeyCode::Char(' ') => KeyAction::Stop,
        KeyCode::Esc => KeyAction::Escape,
        KeyCode::Enter if is_asked => KeyAction::Enter,
        KeyCode::Backspace if is_asked => KeyAction::Erase,
        KeyCode::Char(character) if is_asked => KeyAction::Type(character),
        _ if is_asked => return None,
        KeyCode::Up => KeyAction::Axis(-1),
        KeyCode::Down => KeyAction::Axis(1),
        KeyCode::Left => KeyAction::Step(false),
        KeyCode::Right => KeyAction::Step(true),
        KeyCode::Char('+' | '=') => KeyAction::StepSize(1),
        KeyCode::Char('-' | '_') => KeyAction::StepSize(-1),
        KeyCode::Char('>' | '.') => KeyAction::Speed(1),
        KeyCode::Char('<' | ',') => KeyAction::Speed(-1),
        KeyCode::Char('c') | KeyCode::Tab => KeyAction::System,
        KeyCode::Char('r') => KeyAction::Release,
        KeyCode::Char('t' | 'T') => KeyAction::Store,
        KeyCode::Char('g' | 'G') => KeyAction::Go,
        KeyCode::Char('?' | 'h') => KeyAction::Help,
        KeyCode::Char('q' | 'Q') => KeyAction::Quit,
        _ => return None,
    })
}

/// All keys in the order of the help.
pub const KEYS: [KeyHelp; 12] = [
    KeyHelp { key: "← →", short: "step", full: "move the selected axis by one step in direction - or +" },
    KeyHelp { key: "↑ ↓", short: "axis", full: "select the axis" },
    KeyHelp { key: "Space", short: "STOP", full: "stop the robot, at any time" },
    KeyHelp { key: "+ -", short: "size", full: "larger steps, smaller steps" },
    KeyHelp { key: ", .", short: "speed", full: "slower, faster; also < >" },
    KeyHelp { key: "c", short: "system", full: "next coordinate system; also Tab" },
    KeyHelp { key: "T", short: "teach", full: "teach: store the current position as a point" },
    KeyHelp { key: "G", short: "go", full: "move to a point in one motion" },
    KeyHelp { key: "r", short: "", full: "release the hold after a stop" },
    KeyHelp { key: "?", short: "help", full: "this list; also h" },
    KeyHelp { key: "q", short: "quit", full: "end, after the motion" },
    KeyHelp { key: "Ctrl-C", short: "", full: "stop, and end with exit code 130" },
];

#[cfg(test)]
mod tests {
    use armctl_frame::output::fullscreen::KeyModifiers;

    use super::*;

    fn pressed(code: KeyCode) -> KeyEvent {
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    #[test]
    fn stop_works_while_a_number_is_typed() {
        for is_asked in [false, true] {
            assert_eq!(action(pressed(KeyCode::Char(' ')), is_asked), Some(KeyAction::Stop));
        }
    }

    /// As on a Czech keyboard, where Windows reports AltGr as Ctrl and Alt.
    #[test]
    fn alt_gr_types_a_key() {
        let with = |modifiers| action(KeyEvent::new(KeyCode::Char('<'), modifiers), false);
        assert_eq!(with(KeyModifiers::CONTROL | KeyModifiers::ALT), Some(KeyAction::Speed(-1)));
        assert_eq!(with(KeyModifiers::CONTROL), None);
    }

    #[test]
    fn nothing_moves_while_a_number_is_typed() {
        assert_eq!(action(pressed(KeyCode::Right), false), Some(KeyAction::Step(true)));
        assert_eq!(action(pressed(KeyCode::Right), true), None);
        assert_eq!(action(pressed(KeyCode::Char('g')), true), Some(KeyAction::Type('g')));
    }
}
