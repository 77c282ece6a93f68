//! Reads and their answers as text, for recordings.

use super::image::{COMMAND_WORDS, Image, Words};

/// Request of a recording that stands for the output image of the controller. The other requests are the words of
/// remote commands.
pub const IMAGE: &str = "image";

/// Text of the signals of an image: the words after the words of the remote command.
pub fn signals_text(image: &Image) -> String {
    text(&image.0[COMMAND_WORDS..])
}

/// Parses the signals of an image. The words of the remote command are 0.
pub fn parse_signals(text: &str) -> Option<Image> {
    let mut image = Image::default();
    parse(text, &mut image.0[COMMAND_WORDS..])?;
    Some(image)
}

/// Text of the words of a remote command, or of its answer.
pub fn words_text(words: &Words) -> String {
    text(words)
}

/// Parses the words of a remote command, or of its answer.
pub fn parse_words(text: &str) -> Option<Words> {
    let mut words = Words::default();
    parse(text, &mut words)?;
    Some(words)
}

/// Words in hexadecimal, without the zeros at the end.
fn text(words: &[u16]) -> String {
    let used = words.iter().rposition(|word| *word != 0).map_or(0, |last| last + 1);
    words[..used].iter().map(|word| format!("{word:04x}")).collect::<Vec<_>>().join(" ")
}

fn parse(text: &str, into: &mut [u16]) -> Option<()> {
    let mut places = into.iter_mut();
    text.split_whitespace().try_for_each(|word| {
        *places.next()? = u16::from_str_radix(word, 16).ok()?;
        Some(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_words_are_parsed_again() {
        let mut words = Words::default();
        (words[0], words[2]) = (0x0501, 0xABCD);
        assert_eq!(words_text(&words), "0501 0000 abcd");
        assert_eq!(parse_words("0501 0000 abcd"), Some(words));
        let mut image = Image::default();
        image.0[COMMAND_WORDS] = 0x17;
        assert_eq!((signals_text(&image), parse_signals("0017")), ("0017".to_owned(), Some(image)));
        image.0[0] = 1;
        assert_eq!(signals_text(&image), "0017", "the answer of a remote command is not a signal");
        let too_many = vec!["1"; COMMAND_WORDS + 1].join(" ");
        assert_eq!((parse_words("x"), parse_words(&too_many)), (None, None));
    }
}
