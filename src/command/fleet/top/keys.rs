//! Key bindings of `top`. No key sends anything to a robot.

use armctl_frame::output::fullscreen::{KeyCode, KeyEvent, KeyEventKind, has_control};
use armctl_frame::output::painter::KeyHelp;

/// Action of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyAction {
    /// Move up by lines: robots in the list, axes on the robot screen.
    Up(usize),
    /// Move down by lines.
    Down(usize),
    /// Previous robot.
    Previous,
    /// Next robot.
    Next,
    /// Open the screen of the selected robot.
    Open,
    /// Back to the list; in the list, show all robots again.
    Back,
    /// Next sort order.
    Sort,
    /// Pause or continue the display.
    Pause,
    /// Poll more often.
    Faster,
    /// Poll less often.
    Slower,
    /// Open or close the help.
    Help,
    /// Start to type a filter.
    Filter,
    /// Add a character to the filter.
    Type(char),
    /// Remove the last character of the filter.
    Erase,
    /// Confirm the filter.
    ApplyFilter,
    /// Cancel the filter.
    CancelFilter,
    /// Quit.
    Quit,
    /// Quit as with Ctrl-C.
    Interrupt,
    /// Suspend the process.
    Suspend,
    /// Redraw the screen.
    Refresh,
}

/// Lines of a page.
const PAGE: usize = 10;

/// Action of a key; `None` if the key has no action. With `is_typing`, the key belongs to the filter.
pub fn action(key: KeyEvent, is_typing: bool) -> Option<KeyAction> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if has_control(key) {
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
            KeyCode::Enter => Some(KeyAction::ApplyFilter),
            KeyCode::Esc => Some(KeyAction::CancelFilter),
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

/// All keys in the order of the help, with their validity in the list and on the robot screen.
pub const KEYS: &[((bool, bool), KeyHelp)] = &[
    with_help((true, false), "↑ ↓", "choose", "select a robot; also j k, PgUp PgDn, Home End"),
    with_help((true, false), "Enter", "open", "open the selected robot"),
    with_help((false, true), "Esc", "list", "back to the list; also Backspace"),
    with_help((false, true), "↑ ↓", "axis", "select the axis of the charts"),
    with_help((false, true), "← →", "robot", "previous robot, next robot; also p n"),
    with_help((true, false), "/", "filter", "filter by text in name, family, address or tag"),
    with_help((true, false), "Esc", "", "show all robots again"),
    with_help((true, false), "s", "sort", "sort: inventory, alarms first, name, slowest first"),
    with_help((true, true), "Space", "pause", "pause the display; polling continues"),
    with_help((true, true), "+ -", "pace", "poll more often, less often"),
    with_help((true, true), "?", "help", "this list; also h"),
    with_help((true, true), "q", "quit", "end"),
    with_help((true, true), "Ctrl-C", "", "end with exit code 130"),
    #[cfg(unix)]
    with_help((true, true), "Ctrl-Z", "", "suspend; `fg` continues"),
    with_help((true, true), "Ctrl-L", "", "redraw the screen"),
];

const fn with_help(
    is_relevant: (bool, bool),
    key: &'static str,
    short: &'static str,
    full: &'static str,
) -> ((bool, bool), KeyHelp) {
    (is_relevant, KeyHelp { key, short, full })
}

#[cfg(test)]
mod tests {
    use armctl_frame::output::fullscreen::KeyModifiers;

    use super::*;

    fn pressed(code: KeyCode) -> KeyEvent {
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    fn with_control(character: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(character), KeyModifiers::CONTROL)
    }

    #[test]
    fn letters_are_commands_or_filter_text() {
        assert_eq!(action(pressed(KeyCode::Char('q')), false), Some(KeyAction::Quit));
        assert_eq!(action(pressed(KeyCode::Char('q')), true), Some(KeyAction::Type('q')));
        assert_eq!(action(pressed(KeyCode::Esc), false), Some(KeyAction::Back));
        assert_eq!(action(pressed(KeyCode::Esc), true), Some(KeyAction::CancelFilter));
        assert_eq!(action(pressed(KeyCode::Char('x')), false), None);
    }

    #[test]
    fn control_keys_work_everywhere() {
        for is_typing in [false, true] {
            assert_eq!(action(with_control('c'), is_typing), Some(KeyAction::Interrupt));
            assert_eq!(action(with_control('z'), is_typing), Some(KeyAction::Suspend));
            assert_eq!(action(with_control('q'), is_typing), None);
        }
    }

    #[test]
    fn alt_gr_types_a_character() {
        let alt_gr = KeyEvent::new(KeyCode::Char('@'), KeyModifiers::CONTROL | KeyModifiers::ALT);
        assert_eq!(action(alt_gr, true), Some(KeyAction::Type('@')));
    }

    #[test]
    fn ignores_key_releases() {
        let released = KeyEvent { kind: KeyEventKind::Release, ..pressed(KeyCode::Enter) };
        assert_eq!(action(released, false), None);
    }
}
