//! Decimal numbers of words: read from bytes, written for people.

use std::fmt;

/// Largest magnitude a word may carry. No machine is longer; below it no unit conversion overflows.
pub(crate) const LARGEST: f64 = 1e9;

/// Digits that surely fit the fast path's integer.
const FAST_DIGITS: usize = 18;

const POWERS_OF_TEN: [f64; FAST_DIGITS + 1] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18];

/// Integers up to here are exact in an `f64`, so that one division rounds correctly.
const EXACT_INTEGER: u64 = 1 << 53;

/// A number as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    pub(crate) value: f64,
    /// Some controls count a number without a point in increments.
    pub(crate) has_point: bool,
    /// It comes from an expression, whose value is never counted in increments.
    pub(crate) computed: bool,
}

/// Reads a run of signs, digits and points; none if it is no number. Correctly rounded.
pub(crate) fn parse(run: &[u8]) -> Option<Number> {
    let (negative, digits) = match run {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, run),
    };
    let mut mantissa = 0;
    let mut rest = digits;
    let whole_digits = push_digits(&mut mantissa, &mut rest);
    let has_point = matches!(rest, [b'.', ..]);
    let mut decimals = 0;
    if let [b'.', tail @ ..] = rest {
        rest = tail;
        decimals = push_digits(&mut mantissa, &mut rest);
    }
    if !rest.is_empty() || whole_digits + decimals == 0 {
        return None;
    }
    let magnitude = match POWERS_OF_TEN.get(decimals) {
        Some(power) if whole_digits + decimals <= FAST_DIGITS && mantissa <= EXACT_INTEGER => mantissa as f64 / power,
        _ => std::str::from_utf8(digits).ok()?.parse().ok()?,
    };
    Some(Number { value: if negative { -magnitude } else { magnitude }, has_point, computed: false })
}

/// Moves leading digits of `rest` to `mantissa`; how many there were. Beyond [`FAST_DIGITS`] the mantissa is worthless.
fn push_digits(mantissa: &mut u64, rest: &mut &[u8]) -> usize {
    let before = rest.len();
    while let [digit @ b'0'..=b'9', tail @ ..] = *rest {
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit - b'0'));
        *rest = tail;
    }
    before - rest.len()
}

/// Shows a number with at most six decimals, without trailing zeros and without a negative zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decimal(pub(crate) f64);

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.6}", self.0);
        let text = text.trim_end_matches('0').trim_end_matches('.');
        f.write_str(if text == "-0" { "0" } else { text })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_forms() {
        for (text, value, has_point) in [
            ("-.5", -0.5, true),
            ("5.", 5.0, true),
            ("+3", 3.0, false),
            ("007", 7.0, false),
            ("-0", 0.0, false),
            ("0.1", 0.1, true),
            ("123456789012345678901234567890", 123_456_789_012_345_678_901_234_567_890.0, false),
            ("0.1234567890123456789", 0.123_456_789_012_345_68, true),
        ] {
            assert_eq!(parse(text.as_bytes()), Some(Number { value, has_point, computed: false }), "{text}");
        }
    }

    #[test]
    fn no_numbers() {
        for text in ["", "-", ".", "+.", "1.2.3", "--5", "5-3", "1e5"] {
            assert_eq!(parse(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn written_for_people() {
        for (value, text) in
            [(0.1 + 0.2, "0.3"), (-1e-9, "0"), (140.0, "140"), (-10.5, "-10.5"), (f64::INFINITY, "inf")]
        {
            assert_eq!(Decimal(value).to_string(), text);
        }
    }

    proptest::proptest! {
        #[test]
        fn agrees_with_the_standard_library(text in "[-+]?([0-9]{1,25}\\.?[0-9]{0,25}|\\.[0-9]{1,25})") {
            proptest::prop_assert_eq!(parse(text.as_bytes()).map(|n| n.value), text.parse::<f64>().ok());
        }
    }
}
