//! Decimal numbers of words: read from bytes, written for people.

use std::fmt;

/// Largest magnitude a word may carry. No machine is longer; below it no unit conversion overflows.
pub(crate) const LARGEST: f64 = 1e9;

/// Integers of so many digits are exact in an `f64`, so that one division rounds correctly.
const EXACT_DIGITS: usize = 15;

const POWERS_OF_TEN: [f64; EXACT_DIGITS + 1] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// A number as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    pub(crate) value: f64,
    /// Some controls count a number without a point in increments.
    pub(crate) has_point: bool,
    /// It comes from an expression, whose value is never counted in increments.
    pub(crate) computed: bool,
}

/// The number that a text begins with, and its length; none if it has more than [`EXACT_DIGITS`], or is no number.
#[inline]
pub(crate) fn begin(text: &[u8]) -> Option<(Number, usize)> {
    let sign = text.first();
    let negative = sign == Some(&b'-');
    let mut at = usize::from(negative || sign == Some(&b'+'));
    let first = at;
    // Signed, since that converts faster.
    let mut mantissa = 0_i64;
    let mut point = None;
    while let Some(&byte) = text.get(at) {
        match byte {
            b'0'..=b'9' => mantissa = mantissa.wrapping_mul(10).wrapping_add(i64::from(byte - b'0')),
            b'.' if point.is_none() => point = Some(at),
            _ => break,
        }
        at += 1;
    }
    let digits = at - first - usize::from(point.is_some());
    let decimals = point.map_or(0, |point| at - point - 1);
    if digits == 0 || digits > EXACT_DIGITS {
        return None;
    }
    let magnitude = match decimals {
        0 => mantissa as f64,
        decimals => mantissa as f64 / POWERS_OF_TEN.get(decimals)?,
    };
    let value = if negative { -magnitude } else { magnitude };
    Some((Number { value, has_point: point.is_some(), computed: false }, at))
}

/// Reads a run of signs, digits and points; none if it is no number. Correctly rounded.
pub(crate) fn parse(run: &[u8]) -> Option<Number> {
    if let Some((number, length)) = begin(run) {
        return (length == run.len()).then_some(number);
    }
    let digits = run.strip_prefix(b"-").or(run.strip_prefix(b"+")).unwrap_or(run);
    let points = digits.iter().filter(|&&byte| byte == b'.').count();
    let plain = digits.iter().all(|byte| byte.is_ascii_digit() || *byte == b'.') && points < digits.len();
    let value = std::str::from_utf8(run).ok().filter(|_| plain && points < 2)?.parse().ok()?;
    Some(Number { value, has_point: points > 0, computed: false })
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
