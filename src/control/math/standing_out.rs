//! What of a found value is taken, where the fit that found it is off by itself.

/// A value that is gone below `least`, and whole from twice that on; between them it grows without a step.
///
/// It is a soft threshold that leaves no bias (firm shrinkage; Gao and Bruce, WaveShrink with firm shrinkage, Statistica
/// Sinica 7, 1997).
pub(in crate::control) fn standing_out(value: f64, least: f64) -> f64 {
    value * (value.abs() / least.max(f64::MIN_POSITIVE) - 1.0).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::standing_out;

    #[test]
    fn nothing_below_half_all_above() {
        let found = [0.0, 0.9, -1.0, 1.5, -2.0, 7.0].map(|value| standing_out(value, 1.0));
        assert_eq!(found, [0.0, 0.0, 0.0, 0.75, -2.0, 7.0]);
        assert_eq!(standing_out(0.5, 0.0), 0.5);
    }
}
