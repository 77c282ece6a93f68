//! Numbers on the command line: decimal, or hexadecimal after `0x`.

use std::fmt::Display;

use armctl_controller::user_input::integer;

/// Parser for whole numbers from `first` to `last`.
pub fn parse_in_range<T>(first: T, last: T) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: TryFrom<i64> + PartialOrd + Display + Copy + Send + Sync + 'static,
{
    move |text| {
        let number = integer(text).ok_or_else(|| format!("'{text}' is not a whole number"))?;
        let number = T::try_from(number).ok().filter(|number| (first..=last).contains(number));
        number.ok_or_else(|| format!("{text} is not in {first}..={last}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_decimal_and_hexadecimal_numbers_in_range() {
        let number = parse_in_range::<u8>(1, 100);
        assert_eq!((number("7"), number("0x10")), (Ok(7), Ok(16)));
        assert_eq!(number("0x65"), Err("0x65 is not in 1..=100".to_owned()));
        assert_eq!(number("-1"), Err("-1 is not in 1..=100".to_owned()));
        assert!(number("1.5").is_err());
    }
}
