//! Mutations of valid inputs: the changes that find mistakes in parsers without feedback.

use fastrand::Rng;

/// Numbers at the limits of lengths, counts and types.
const LIMITS: [u32; 14] =
    [0, 1, 2, 0x7F, 0x80, 0xFF, 0x100, 0x7FFF, 0x8000, 0xFFFF, 0x1_0000, 0x7FFF_FFFF, 0x8000_0000, u32::MAX];

/// Texts that mean something in one of the formats.
const WORDS: [&[u8]; 24] = [
    b"-1",
    b"0",
    b"99999999999999999999",
    b"-2147483648",
    b"1e309",
    b"NaN",
    b"0x",
    b"\"",
    b"'",
    b"\\",
    b"\r\n",
    b"\0",
    b"=",
    b",",
    b";",
    b"[",
    b"]",
    b"{}",
    b"..",
    b"\xEF\xBB\xBF",
    b"\xC3\xA9",
    b"\x83\x65",
    b"@",
    b"<a/>",
];

/// Changes a seed up to eight times.
pub fn mutate(seeds: &[Vec<u8>], rng: &mut Rng, longest: usize) -> Vec<u8> {
    let mut input = rng.choice(seeds).cloned().unwrap_or_default();
    for _ in 0..rng.u8(1..=8) {
        change(&mut input, seeds, rng);
    }
    input.truncate(longest);
    input
}

fn change(input: &mut Vec<u8>, seeds: &[Vec<u8>], rng: &mut Rng) {
    let at = rng.usize(..=input.len());
    let some = at..(at + rng.usize(..=16)).min(input.len());
    match rng.u8(..9) {
        0 => {
            if let Some(byte) = input.get_mut(at) {
                *byte ^= 1 << rng.u8(..8);
            }
        }
        1 => {
            if let Some(byte) = input.get_mut(at) {
                *byte = rng.u8(..);
            }
        }
        2 => drop(input.drain(some)),
        3 => input.truncate(at),
        4 => {
            let copy = input[some].to_vec();
            drop(input.splice(at..at, copy));
        }
        5 => {
            let word = WORDS[rng.usize(..WORDS.len())];
            drop(input.splice(at..at, word.iter().copied()));
        }
        6 => {
            // A length, in each width and byte order; sometimes the length of the input, and one more or less.
            let near = u32::try_from(input.len()).unwrap_or(0).wrapping_add(rng.u32(..3)).wrapping_sub(1);
            let number = if rng.bool() { near } else { LIMITS[rng.usize(..LIMITS.len())] };
            let bytes = if rng.bool() { number.to_be_bytes() } else { number.to_le_bytes() };
            let width = [1, 2, 4][rng.usize(..3)];
            let bytes = if rng.bool() { &bytes[..width] } else { &bytes[4 - width..] };
            let end = (at + width).min(input.len());
            input[at..end].copy_from_slice(&bytes[..end - at]);
        }
        7 => {
            let mut noise = vec![0; rng.usize(..16)];
            rng.fill(&mut noise);
            drop(input.splice(at..at, noise));
        }
        _ => {
            let other = rng.choice(seeds).map_or(&[][..], Vec::as_slice);
            input.truncate(at);
            input.extend_from_slice(&other[rng.usize(..=other.len())..]);
        }
    }
}
