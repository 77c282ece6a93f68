//! What keys order. None of them reaches a robot.

use crate::output::fullscreen::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// What a key orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
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
    /// Back to the list; in the list, all robots again.
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
pub fn order(key: KeyEvent, is_typing: bool) -> Option<Order> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if key.modifiers.contains(KeyModifiers::CONTROL) {
        return match key.code {
            KeyCode::Char('c') => Some(Order::Interrupt),
            KeyCode::Char('z') => Some(Order::Suspend),
            KeyCode::Char('l') => Some(Order::Refresh),
            KeyCode::Char('h') if is_typing => Some(Order::Erase),
            _ => None,
        };
    }
    if is_typing {
        return match key.code {
            KeyCode::Enter => Some(Order::Keep),
            KeyCode::Esc => Some(Order::Discard),
            KeyCode::Backspace => Some(Order::Erase),
            KeyCode::Char(character) => Some(Order::Type(character)),
            _ => None,
        };
    }
    Some(match key.code {
        KeyCode::Up | KeyCode::Char('k') => Order::Up(1),
        KeyCode::Down | KeyCode::Char('j') => Order::Down(1),
        KeyCode::PageUp => Order::Up(PAGE),
        KeyCode::PageDown => Order::Down(PAGE),
        KeyCode::Home | KeyCode::Char('g') => Order::Up(usize::MAX),
        KeyCode::End | KeyCode::Char('G') => Order::Down(usize::MAX),
        KeyCode::Left | KeyCode::Char('p') => Order::Previous,
        KeyCode::Right | KeyCode::Char('n') => Order::Next,
        KeyCode::Enter => Order::Open,
        KeyCode::Esc | KeyCode::Backspace => Order::Back,
        KeyCode::Char('s') => Order::Sort,
        KeyCode::Char(' ') => Order::Pause,
        KeyCode::Char('+' | '=') => Order::Faster,
        KeyCode::Char('-' | '_') => Order::Slower,
        KeyCode::Char('?' | 'h') => Order::Help,
        KeyCode::Char('/') => Order::Filter,
        KeyCode::Char('q' | 'Q') => Order::Quit,
        _ => return None,
    })
}

/// A key and what it does, for people: where it counts, the key, in short, in full.
pub struct Explained {
    /// Whether it counts in the list, and on the screen of one robot.
    pub counts: (bool, bool),
    /// The key as it is written.
    pub key: &'static str,
    /// For the last line of the screen; empty for keys that are only in the help.
    pub short: &'static str,
    /// For the help.
    pub full: &'static str,
}

/// Every key, in the order in which they are explained.
pub const KEYS: [Explained; 15] = [
    explained((true, false), "↑ ↓", "choose", "choose a robot; also j k, PgUp PgDn, Home End"),
    explained((true, false), "Enter", "open", "all about the chosen robot"),
    explained((false, true), "Esc", "list", "back to the list; also Backspace"),
    explained((false, true), "↑ ↓", "axis", "choose the axis of the charts"),
    explained((false, true), "← →", "robot", "the robot before, the one behind; also p n"),
    explained((true, false), "/", "filter", "only robots with a text in name, family, address or tag"),
    explained((true, false), "Esc", "", "all robots again"),
    explained((true, false), "s", "sort", "as given, trouble first, by name, slowest first"),
    explained((true, true), "Space", "pause", "pause the display; polling continues"),
    explained((true, true), "+ -", "pace", "look more often, less often"),
    explained((true, true), "?", "help", "this list; also h"),
    explained((true, true), "q", "quit", "end"),
    explained((true, true), "Ctrl-C", "", "end with exit code 130"),
    explained((true, true), "Ctrl-Z", "", "suspend; `fg` goes on"),
    explained((true, true), "Ctrl-L", "", "draw everything anew"),
];

const fn explained(counts: (bool, bool), key: &'static str, short: &'static str, full: &'static str) -> Explained {
    Explained { counts, key, short, full }
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
        assert_eq!(order(pressed(KeyCode::Char('q')), false), Some(Order::Quit));
        assert_eq!(order(pressed(KeyCode::Char('q')), true), Some(Order::Type('q')));
        assert_eq!(order(pressed(KeyCode::Esc), false), Some(Order::Back));
        assert_eq!(order(pressed(KeyCode::Esc), true), Some(Order::Discard));
        assert_eq!(order(pressed(KeyCode::Char('x')), false), None);
    }

    #[test]
    fn control_keys_count_everywhere() {
        for is_typing in [false, true] {
            assert_eq!(order(with_control('c'), is_typing), Some(Order::Interrupt));
            assert_eq!(order(with_control('z'), is_typing), Some(Order::Suspend));
            assert_eq!(order(with_control('q'), is_typing), None);
        }
    }

    #[test]
    fn a_key_counts_once() {
        let released = KeyEvent { kind: KeyEventKind::Release, ..pressed(KeyCode::Enter) };
        assert_eq!(order(released, false), None);
    }
}
