//! `VAR.DAT`, the file of all variables. It is generated when a client reads it, and applied when a client loads it.
//!
//! No known source shows the whole file. The head and the B rows are as on real controllers. Positions are rows of
//! protocol words; this format is specific to the simulator.

use super::memory::{AXIS_WORDS, Kind, Memory, POSITION_WORDS};

/// Name of the file.
pub(super) const NAME: &[u8] = b"VAR.DAT";
/// First lines of the file.
const HEAD: [&[u8]; 2] = [b"//VAR", b"///SHARE"];
/// Sections in the order of the file.
const SECTIONS: [(&str, Kind); 8] = [
    ("////B", Kind::B),
    ("////I", Kind::I),
    ("////D", Kind::D),
    ("////R", Kind::R),
    ("////S", Kind::S),
    ("////P", Kind::P),
    ("////BP", Kind::Bp),
    ("////EX", Kind::Ex),
];
/// Number of values per row of the file.
const ROW: usize = 10;

/// A value in a loaded file: kind, number, and bytes of the variable.
type Setting = (Kind, usize, Vec<u8>);

/// Generates the current file.
pub(super) fn written(memory: &Memory) -> Vec<u8> {
    let mut lines: Vec<Vec<u8>> = HEAD.map(<[u8]>::to_vec).into();
    for (section, kind) in SECTIONS {
        lines.push(section.as_bytes().to_vec());
        match kind {
            Kind::S => lines.extend((0..kind.count()).map(|index| text(memory.element(kind, index)))),
            _ if kind.starts_undefined() => {
                let row = |index| Some(format!("{index:03}={}", words(memory.element(kind, index)?)).into_bytes());
                lines.extend((0..kind.count()).filter_map(row));
            }
            _ => {
                let number = |index: usize| number(kind, memory.element(kind, index).unwrap_or_default());
                let numbers: Vec<String> = (0..kind.count()).map(number).collect();
                lines.extend(numbers.chunks(ROW).map(|row| row.join(",").into_bytes()));
            }
        }
    }
    lines.into_iter().flat_map(|line| [line, b"\r\n".to_vec()].concat()).collect()
}

/// Applies the variables of a file. Returns `false` and changes nothing if the file is invalid. Positions that are
/// missing in their section become undefined.
pub(super) fn load(memory: &mut Memory, file: &[u8]) -> bool {
    let Some((sections, settings)) = read(file) else { return false };
    for kind in sections.into_iter().filter(|kind| kind.starts_undefined()) {
        (0..kind.count()).for_each(|index| memory.forget(kind, index));
    }
    for (kind, index, bytes) in settings {
        memory.store(kind, index, &bytes);
    }
    true
}

fn read(file: &[u8]) -> Option<(Vec<Kind>, Vec<Setting>)> {
    let mut lines = file.split(|byte| *byte == b'\n').map(|line| line.strip_suffix(b"\r").unwrap_or(line));
    if lines.next()? != HEAD[0] {
        return None;
    }
    let (mut sections, mut settings): (Vec<Kind>, Vec<Setting>) = (Vec::new(), Vec::new());
    let mut next = 0;
    for line in lines {
        if let Some((_, kind)) = SECTIONS.iter().find(|(section, _)| section.as_bytes() == line) {
            sections.push(*kind);
            next = 0;
            continue;
        }
        let Some(kind) = sections.last().copied() else { continue };
        if kind == Kind::S {
            // The text after the last line end of the file is empty, and is not a variable.
            if next < kind.count() {
                settings.push((kind, next, line.get(..line.len().min(32))?.to_vec()));
            }
            next += 1;
            continue;
        }
        if line.is_empty() {
            continue;
        }
        let line = std::str::from_utf8(line).ok()?;
        if kind.starts_undefined() {
            let (index, words) = line.split_once('=')?;
            let index = index.parse().ok().filter(|index| *index < kind.count())?;
            let words: Vec<i32> = words.split(',').map(|word| word.parse().ok()).collect::<Option<_>>()?;
            let expected = if kind == Kind::P { POSITION_WORDS } else { AXIS_WORDS };
            let bytes = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            (words.len() == expected).then(|| settings.push((kind, index, bytes)))?;
            continue;
        }
        for number in line.split(',') {
            let bytes = bytes(kind, number.trim())?;
            (next < kind.count()).then(|| settings.push((kind, next, bytes)))?;
            next += 1;
        }
    }
    Some((sections, settings))
}

fn number(kind: Kind, bytes: &[u8]) -> String {
    match (kind, bytes) {
        (Kind::B, &[byte]) => byte.to_string(),
        (Kind::I, &[a, b]) => i16::from_le_bytes([a, b]).to_string(),
        (Kind::D, &[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]).to_string(),
        (Kind::R, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]).to_string(),
        _ => "0".to_owned(),
    }
}

fn bytes(kind: Kind, number: &str) -> Option<Vec<u8>> {
    Some(match kind {
        Kind::B => vec![number.parse::<u8>().ok()?],
        Kind::I => number.parse::<i16>().ok()?.to_le_bytes().into(),
        Kind::D => number.parse::<i32>().ok()?.to_le_bytes().into(),
        Kind::R => number.parse::<f32>().ok()?.to_le_bytes().into(),
        Kind::S | Kind::P | Kind::Bp | Kind::Ex => return None,
    })
}

fn words(bytes: &[u8]) -> String {
    let words = bytes.chunks_exact(4).map(|word| i32::from_le_bytes([word[0], word[1], word[2], word[3]]).to_string());
    words.collect::<Vec<_>>().join(",")
}

/// Text up to the first NUL or line end.
fn text(bytes: Option<&[u8]>) -> Vec<u8> {
    bytes.unwrap_or_default().iter().copied().take_while(|byte| !matches!(byte, 0 | b'\r' | b'\n')).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yerc::Model;

    #[test]
    fn written_file_sets_the_same_variables() {
        let mut memory = Memory::new(Model::Dx200);
        memory.store(Kind::B, 7, &[99]);
        memory.store(Kind::I, 99, &(-2i16).to_le_bytes());
        memory.store(Kind::R, 3, &1.5f32.to_le_bytes());
        memory.store(Kind::S, 8, "\u{3042}".as_bytes());
        memory.store(Kind::P, 127, &[0x80; 4 * POSITION_WORDS]);
        memory.store(Kind::Ex, 10, &[1; 4 * AXIS_WORDS]);
        let file = written(&memory);
        let mut other = Memory::new(Model::Dx200);
        other.store(Kind::P, 5, &[1; 4 * POSITION_WORDS]);
        assert!(load(&mut other, &file));
        assert_eq!(written(&other), file);
        assert_eq!((other.element(Kind::B, 7), other.element(Kind::P, 5)), (Some(&[99][..]), None), "it has no P005");
    }

    #[test]
    fn invalid_file_sets_nothing() {
        let mut memory = Memory::new(Model::Fs100);
        for wrong in
            ["", "//OTHER\r\n////B\r\n1", "//VAR\r\n////B\r\n256", "//VAR\r\n////P\r\n000=1,2", "//VAR\r\n////I\r\nx"]
        {
            assert!(!load(&mut memory, wrong.as_bytes()), "{wrong:?}");
        }
        assert_eq!(memory.element(Kind::B, 0), Some(&[0][..]));
        assert!(load(&mut memory, b"//VAR\n///SHARE\n////B\n0,0,5"), "a part of it");
        assert_eq!(memory.element(Kind::B, 2), Some(&[5][..]));
    }
}
