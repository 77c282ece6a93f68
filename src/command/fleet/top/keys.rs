//! What keys order. None of them reaches a robot.

use crate::output::fullscreen::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use crate::output::painter::Explained;

/// What a key orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyAction {
    /// So many lines up: robots in the list, axes on the screen of one.
    Up(usize),
    /// So many lines down.
    Down(usize),
    /// The robot before.
    Previous,
    /// The robot behind.
    Next,
    /// Give the robot at the cursor the screen.
    Open,
    /// Back to the list; in the list, show all robots again.
    Back,
    /// Another order of the list.
    Sort,
    /// Stand still, or go on.
    Pause,
    /// Look more often.
    Faster,
    /// Look less often.
    Slower,
    /// Explain the keys, or no more.
    Help,
    /// Begin to type a filter.
    Filter,
    /// A character of the filter.
    Type(char),
    /// The last character of the filter goes.
    Erase,
    /// The filter is as it shall be.
    Keep,
    /// No filter after all.
    Discard,
    /// End.
    Quit,
    /// End as Ctrl-C ends.
    Interrupt,
    /// Suspend the process.
    Suspend,
    /// Draw everything anew.
    Refresh,
}

/// Lines of a page.
const PAGE: usize = 10;

/// What a key orders; nothing if it means nothing. `is_typing`: it belongs to the filter.
pub fn order(key: KeyEvent, is_typing: bool) -> Option<KeyAction> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if key.modifiers.contains(KeyModifiers::CONTROL) {
        return match key.code {
            KeyCode::Char('c') => Some(KeyAction::Interrupt),
            KeyCode::Char('z') => Some(KeyAction::Suspend),
            KeyCode::Char('l') => Some(KeyAction::Refresh),
            KeyCode::Char('h') if is_typing => Some(KeyAction::Erase),
            _ => None,
        };
    }
    if is_typing {
        return match key.code {
            KeyCode::Enter => Some(KeyAction::Keep),
            KeyCode::Esc => Some(KeyAction::Discard),
            KeyCode::Backspace => Some(KeyAction::Erase),
            KeyCode::Char(character) => Some(KeyAction::Type(character)),
            _ => None,
        };
    }
    Some(match key.code {
        KeyCode::Up | KeyCode::Char('k') => KeyAction::Up(1),
        KeyCode::Down | KeyCode::Char('j') => KeyAction::Down(1),
        KeyCode::PageUp => KeyAction::Up(PAGE),
        KeyCode::PageDown => KeyAction::Down(PAGE),
        KeyCode::Home | KeyCode::Char('g') => KeyAction::Up(usize::MAX),
        KeyCode::End | KeyCode::Char('G') => KeyAction::Down(usize::MAX),
        KeyCode::Left | KeyCode::Char('p') => KeyAction::Previous,
        KeyCode::Right | KeyCode::Char('n') => KeyAction::Next,
        KeyCode::Enter => KeyAction::Open,
        KeyCode::Esc | KeyCode::Backspace => KeyAction::Back,
        KeyCode::Char('s') => KeyAction::Sort,
        KeyCode::Char(' ') => KeyAction::Pause,
        KeyCode::Char('+' | '=') => KeyAction::Faster,
        KeyCode::Char('-' | '_') => KeyAction::Slower,
        KeyCode::Char('?' | 'h') => KeyAction::Help,
        KeyCode::Char('/') => KeyAction::Filter,
        KeyCode::Char('q' | 'Q') => KeyAction::Quit,
        _ => return None,
    })
}

/// Every key, in the order in which they are explained: whether it counts in the list, and on the screen of one robot.
pub const KEYS: [((bool, bool), Explained); 15] = [
    explained((true, false), "↑ ↓", "choose", "select a robot; also j k, PgUp PgDn, Home End"),
    explained((true, false), "Enter", "open", "open the selected robot"),
    explained((false, true), "Esc", "list", "back to the list; also Backspace"),
    explained((false, true), "↑ ↓", "axis", "select the axis of the charts"),
    explained((false, true), "← →", "robot", "previous robot, next robot; also p n"),
    explained((true, false), "/", "filter", "filter by a text in name, family, address or tag"),
    explained((true, false), "Esc", "", "show all robots again"),
    explained((true, false), "s", "sort", "sort: inventory, alarms first, name, slowest first"),
    explained((true, true), "Space", "pause", "pause the display; polling continues"),
    explained((true, true), "+ -", "pace", "poll more often, less often"),
    explained((true, true), "?", "help", "this list; also h"),
    explained((true, true), "q", "quit", "end"),
    explained((true, true), "Ctrl-C", "", "end with exit code 130"),
    explained((true, true), "Ctrl-Z", "", "suspend; `fg` continues"),
    explained((true, true), "Ctrl-L", "", "redraw the screen"),
];

const fn explained(
    counts: (bool, bool),
    key: &'static str,
    short: &'static str,
    full: &'static str,
) -> ((bool, bool), Explained) {
    (counts, Explained { key, short, full })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pressed(code: KeyCode) -> KeyEvent {
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    fn with_control(character: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(character), KeyModifiers::CONTROL)
    }

    #[test]
    fn letters_are_keys_or_a_filter() {
        assert_eq!(order(pressed(KeyCode::Char('q')), false), Some(KeyAction::Quit));
        assert_eq!(order(pressed(KeyCode::Char('q')), true), Some(KeyAction::Type('q')));
        assert_eq!(order(pressed(KeyCode::Esc), false), Some(KeyAction::Back));
        assert_eq!(order(pressed(KeyCode::Esc), true), Some(KeyAction::Discard));
        assert_eq!(order(pressed(KeyCode::Char('x')), false), None);
    }

    #[test]
    fn control_keys_count_everywhere() {
        for is_typing in [false, true] {
            assert_eq!(order(with_control('c'), is_typing), Some(KeyAction::Interrupt));
            assert_eq!(order(with_control('z'), is_typing), Some(KeyAction::Suspend));
            assert_eq!(order(with_control('q'), is_typing), None);
        }
    }

    #[test]
    fn a_key_counts_once() {
        let released = KeyEvent { kind: KeyEventKind::Release, ..pressed(KeyCode::Enter) };
        assert_eq!(order(released, false), None);
    }
}
