//! A pseudo-terminal for a program, and the picture that the program has drawn on it.
#![allow(dead_code, reason = "some watch the picture, some what is said line after line")]

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use rustix::termios::{InputModes, LocalModes, OptionalActions, Termios, Winsize, tcgetattr, tcsetattr, tcsetwinsize};
use serialport::{SerialPort as _, TTYPort};

/// Timeout of one read. `MAX_POLLS` is the maximum number of reads.
const POLL_INTERVAL: Duration = Duration::from_secs(1);
const MAX_POLLS: usize = 60;
/// Time limit for a program. If the program has not ended within this time, the test fails.
const END: Duration = Duration::from_secs(600);

/// A program on its own terminal.
pub struct Terminal {
    /// The end of the pseudo-terminal that receives the output of the program.
    master: TTYPort,
    /// The terminal of the program, which is kept open to check its modes.
    slave: File,
    /// Keeps the terminal open.
    _port: TTYPort,
    modes_before: Termios,
    start: Instant,
    pub child: Child,
    pub picture: Picture,
    /// All output.
    pub written: Vec<u8>,
    /// Number of bytes of the plain output that earlier calls of [`Terminal::wait_for_one_of`] have consumed.
    received: usize,
}

impl Terminal {
    /// Starts the program in its own process group.
    pub fn start(mut command: Command, columns: u16, lines: u16) -> std::io::Result<Self> {
        let (mut master, port) = TTYPort::pair()?;
        master.set_timeout(POLL_INTERVAL)?;
        let name = port.name().expect("a pseudo-terminal has a name");
        let slave = File::options().read(true).write(true).open(name)?;
        // The modes of a shell: line mode, echo, and signals from keys.
        let mut modes = tcgetattr(&slave)?;
        modes.local_modes |= LocalModes::ICANON | LocalModes::ECHO | LocalModes::ISIG;
        modes.input_modes |= InputModes::ICRNL;
        tcsetattr(&slave, OptionalActions::Now, &modes)?;
        tcsetwinsize(&slave, Winsize { ws_row: lines, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 })?;
        let before = tcgetattr(&slave)?;
        command.stdin(Stdio::from(slave.try_clone()?)).stdout(Stdio::from(slave.try_clone()?));
        command.stderr(Stdio::from(slave.try_clone()?)).process_group(0);
        let child = command.spawn()?;
        let picture = Picture::new(columns.into(), lines.into());
        Ok(Self {
            master,
            slave,
            _port: port,
            modes_before: before,
            start: Instant::now(),
            child,
            picture,
            written: Vec::new(),
            received: 0,
        })
    }

    /// Reads until the picture satisfies the condition.
    pub fn wait_until(&mut self, what: &str, is_so: impl Fn(&Picture) -> bool) {
        while !is_so(&self.picture) {
            let read = self.read();
            assert!(read, "it never came to this: {what}\n{}", self.picture.text());
        }
    }

    /// Reads until the picture contains this text.
    pub fn wait_for_picture(&mut self, text: &str) {
        self.wait_until(text, |picture| picture.text().contains(text));
    }

    /// Reads until this text appears after the texts of earlier calls. For programs that print lines.
    pub fn wait_for_text(&mut self, text: &str) {
        self.wait_for_one_of(&[text]);
    }

    /// Reads until one of these texts appears after the texts of earlier calls. Returns the index of this text.
    pub fn wait_for_one_of(&mut self, texts: &[&str]) -> usize {
        loop {
            let written = plain(&self.written);
            let places = texts
                .iter()
                .enumerate()
                .filter_map(|(index, text)| Some((written[self.received..].find(text)?, index)));
            if let Some((at, index)) = places.min() {
                self.received += at + texts[index].len();
                return index;
            }
            let read = self.read();
            assert!(read, "it never said any of {texts:?}, but\n{written}");
        }
    }

    /// Reads output. Returns `false` at the end of the output.
    pub fn read(&mut self) -> bool {
        for _ in 0..MAX_POLLS {
            self.fails_when_it_hangs();
            if self.read_available() {
                return true;
            }
            if self.child.try_wait().is_ok_and(|ended| ended.is_some()) {
                return self.read_available();
            }
        }
        false
    }

    fn fails_when_it_hangs(&self) {
        assert!(self.start.elapsed() < END, "it hangs:\n{}", self.picture.text());
    }

    /// Reads the available output. Returns `false` if there is none.
    fn read_available(&mut self) -> bool {
        let mut buffer = [0; 4096];
        match self.master.read(&mut buffer) {
            Ok(0) | Err(_) => false,
            Ok(len) => {
                self.written.extend(&buffer[..len]);
                self.picture.take(&buffer[..len]);
                true
            }
        }
    }

    /// Sends these keys to the program.
    pub fn press(&mut self, keys: &str) {
        self.master.write_all(keys.as_bytes()).expect("the terminal takes keys");
    }

    /// Waits until the program reads single keys. Keys that are pressed earlier would be lost.
    pub fn reads_keys(&self) {
        let is_canonical = || {
            let modes = tcgetattr(&self.slave).expect("a terminal has modes");
            modes.local_modes.contains(LocalModes::ICANON)
        };
        while is_canonical() {
            std::thread::yield_now();
        }
    }

    /// Sends a signal to the program.
    pub fn signal(&self, signal: &str) {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").args(["-s", signal, &pid]).status().expect("kill runs").success());
    }

    /// Waits until the program is suspended.
    #[cfg(target_os = "linux")]
    pub fn is_suspended(&mut self) {
        let stat = format!("/proc/{}/stat", self.child.id());
        while !std::fs::read_to_string(&stat).expect("it is there").contains(") T ") {
            let ended = self.child.try_wait().expect("it is our child");
            assert_eq!(ended, None, "it ended instead:\n{}", plain(&self.written));
            self.fails_when_it_hangs();
            std::thread::yield_now();
        }
    }

    /// Whether the modes, the screen and the cursor of the terminal are restored.
    pub fn is_restored(&self) -> bool {
        let now = tcgetattr(&self.slave).expect("a terminal has modes");
        let modes = |modes: &Termios| (modes.local_modes, modes.input_modes, modes.output_modes, modes.control_modes);
        modes(&now) == modes(&self.modes_before) && !self.picture.is_alternate && self.picture.has_cursor
    }

    /// Waits until the program ends, and reads the remaining output.
    pub fn end(&mut self) -> ExitStatus {
        // Output is still read, because a full terminal would block the program.
        self.master.set_timeout(Duration::from_millis(20)).expect("a terminal takes a timeout");
        let status = loop {
            self.fails_when_it_hangs();
            while self.read_available() {}
            if let Some(status) = self.child.try_wait().expect("it is our child") {
                break status;
            }
        };
        // The program has ended, so all its output is available now.
        self.master.set_timeout(Duration::ZERO).expect("a terminal takes a timeout");
        while self.read_available() {}
        status
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // The program may have ended already.
        self.child.kill().unwrap_or_default();
        let _ended = self.child.wait();
    }
}

/// Content of a terminal. Supports the functions that full-screen programs need.
pub struct Picture {
    columns: usize,
    cells: Vec<char>,
    at: (usize, usize),
    /// Received part of an escape sequence or character that is not complete yet.
    escape_start: Vec<u8>,
    /// Whether the alternate screen is shown.
    pub is_alternate: bool,
    pub has_cursor: bool,
    /// Whether the program has used colors.
    pub has_color: bool,
}

/// Output without cursor and color sequences, and without an incomplete sequence at its end.
fn plain(written: &[u8]) -> String {
    let whole = written.utf8_chunks().next().map_or("", |chunk| chunk.valid());
    let text = whole.trim_end_matches('\x1b');
    let mut parts = text.split("\x1b[");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let rest = part.trim_start_matches(|c: char| c.is_ascii_digit() || "?;<=>".contains(c));
        text + rest.get(1..).unwrap_or_default()
    })
}

impl Picture {
    pub fn new(columns: usize, lines: usize) -> Self {
        Self {
            columns,
            cells: vec![' '; columns * lines],
            at: (0, 0),
            escape_start: Vec::new(),
            is_alternate: false,
            has_cursor: true,
            has_color: false,
        }
    }

    /// Returns the visible lines.
    pub fn text(&self) -> String {
        let lines = self.cells.chunks(self.columns).map(|line| line.iter().collect::<String>());
        lines.map(|line| line.trim_end().to_owned() + "\n").collect()
    }

    fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.escape_start.push(*byte);
            let begun = &self.escape_start;
            let is_whole = match begun[..] {
                [0x1b] | [0x1b, b'['] => false,
                [0x1b, b'[', .., last] => (0x40..=0x7e).contains(&last),
                [0x1b, _, ..] => true,
                _ => std::str::from_utf8(begun).is_ok() || begun.len() > 3,
            };
            if is_whole {
                let whole = std::mem::take(&mut self.escape_start);
                self.handle_sequence(&String::from_utf8_lossy(&whole));
            }
        }
    }

    fn handle_sequence(&mut self, what: &str) {
        let Some(sequence) = what.strip_prefix("\x1b[") else {
            return match what {
                "\r" => self.at.0 = 0,
                "\n" => self.at.1 += 1,
                text => text.chars().filter(|char| !char.is_control()).for_each(|char| self.put(char)),
            };
        };
        let numbers =
            || sequence.trim_end_matches(char::is_alphabetic).split(';').map(|text| text.parse().unwrap_or(0));
        match sequence.chars().last() {
            Some('H') => {
                let mut place = numbers().map(|number: usize| number.max(1) - 1);
                let line = place.next().unwrap_or_default();
                self.at = (place.next().unwrap_or_default(), line);
            }
            Some('J') => self.cells.fill(' '),
            Some('m') => {
                let is_color = |number: usize| matches!(number, 30..=38 | 40..=48 | 90..);
                self.has_color |= numbers().any(is_color);
            }
            Some('h' | 'l') => {
                let is_on = sequence.ends_with('h');
                match sequence.trim_end_matches(['h', 'l']) {
                    "?1049" => self.is_alternate = is_on,
                    "?25" => self.has_cursor = is_on,
                    _ => {}
                }
            }
            _ => {}
        }
    }

    fn put(&mut self, char: char) {
        let (column, line) = self.at;
        if let Some(cell) = self.cells.get_mut(line * self.columns + column) {
            *cell = char;
        }
        self.at.0 += 1;
    }
}
