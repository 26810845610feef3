//! Numbers as text: exact for the file, rounded for messages.

/// A TOML number that reads back to the same bits, without an exponent where a person would write none.
pub(super) fn exact(value: f64) -> String {
    if value.is_nan() {
        return "nan".to_owned();
    }
    let size = value.abs();
    // Beyond 2⁵³ a plain number would look exact to the unit while it is not; "-0" would be an integer zero.
    let plain = (1e-7..9e15).contains(&size) || (size == 0.0 && value.is_sign_positive()) || size.is_infinite();
    if plain { format!("{value}") } else { format!("{value:e}").replace("-0e0", "-0.0") }
}

/// Four significant digits: enough to act on, and the same on every host.
pub(super) fn rounded(value: f64) -> String {
    exact(format!("{value:.3e}").parse().unwrap_or(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_a_person_writes_them() {
        let written = [0.000_65, 38_197.0, 1e-9, 1e300, f64::INFINITY, -0.0, 0.0, 0.1 + 0.2].map(exact);
        assert_eq!(written, ["0.00065", "38197", "1e-9", "1e300", "inf", "-0.0", "0", "0.30000000000000004"]);
        assert_eq!(rounded(15.999_999_9), "16");
        assert_eq!(rounded(0.300_000_000_1), "0.3");
    }
}
