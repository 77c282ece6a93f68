//! What keys order.

use crate::output::fullscreen::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use crate::output::painter::Explained;

/// What a key orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyAction {
    /// The axis above, or below.
    Axis(isize),
    /// A step of the chosen axis, forwards or backwards.
    Step(bool),
    /// A larger or a smaller step.
    StepSize(isize),
    /// Faster or slower.
    Speed(isize),
    /// The next way in which axes move.
    System,
    /// Stop.
    Stop,
    /// Let a held robot go on.
    Release,
    /// Store a point.
    Store,
    /// Go to a point.
    Go,
    /// A character of an answer.
    Type(char),
    /// The last character goes.
    Erase,
    /// The answer is whole.
    Enter,
    /// No answer after all; no help any more.
    Escape,
    /// Explain the keys, or no more.
    Help,
    /// End.
    Quit,
    /// End as Ctrl-C ends.
    Interrupt,
    /// Draw everything anew.
    Refresh,
}

/// What a key orders; nothing if it means nothing. `is_asked`: it belongs to an answer. A stop is one everywhere.
pub fn order(key: KeyEvent, is_asked: bool) -> Option<KeyAction> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if key.modifiers.contains(KeyModifiers::CONTROL) {
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

/// Every key, in the order in which they are explained.
pub const KEYS: [Explained; 12] = [
    Explained { key: "← →", short: "step", full: "move the chosen axis by one step, - or +" },
    Explained { key: "↑ ↓", short: "axis", full: "choose the axis" },
    Explained { key: "Space", short: "STOP", full: "stop the robot, at any time" },
    Explained { key: "+ -", short: "size", full: "larger steps, smaller steps" },
    Explained { key: "< >", short: "speed", full: "slower, faster" },
    Explained { key: "c", short: "system", full: "the next way in which axes move; also Tab" },
    Explained { key: "T", short: "teach", full: "store the place of the robot in a point" },
    Explained { key: "G", short: "go", full: "go to a point: one motion, which ends at the point" },
    Explained { key: "r", short: "", full: "release the hold that a stop has left" },
    Explained { key: "?", short: "help", full: "this list; also h" },
    Explained { key: "q", short: "quit", full: "end, once nothing moves" },
    Explained { key: "Ctrl-C", short: "", full: "stop, and end with exit code 130" },
];

#[cfg(test)]
mod tests {
    use super::*;

    fn pressed(code: KeyCode) -> KeyEvent {
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    #[test]
    fn a_stop_is_one_while_a_number_is_typed() {
        for is_asked in [false, true] {
            assert_eq!(order(pressed(KeyCode::Char(' ')), is_asked), Some(KeyAction::Stop));
        }
    }

    #[test]
    fn nothing_moves_while_a_number_is_typed() {
        assert_eq!(order(pressed(KeyCode::Right), false), Some(KeyAction::Step(true)));
        assert_eq!(order(pressed(KeyCode::Right), true), None);
        assert_eq!(order(pressed(KeyCode::Char('g')), true), Some(KeyAction::Type('g')));
    }
}
