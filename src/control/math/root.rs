//! Bracketed roots of monotonic functions, in a bounded number of steps.

/// Steps of [`increasing`]: bisection alone would halve a bracket to the last bit of an f64 in these.
pub const MAX_STEPS: u32 = 80;
/// Steps in a row that may leave more than half of the bracket before one halves it.
const MAX_SLOW: u32 = 3;

/// The largest `x` in [`low`, `high`] with f(x) ≤ 0, for a non-decreasing `f`; `low` where even f(low) > 0.
///
/// Regula falsi with the Illinois weight, bisecting whenever that stalls; stops when the bracket is one ulp wide.
/// The answer is on the side f ≤ 0, so a limit that `f` states is kept, not just nearly kept.
///
/// ```
/// use rigidtap::control::math::root::increasing;
/// assert!((increasing(0.0, 2.0, |x| x * x - 2.0) - 2f64.sqrt()).abs() < 1e-15);
/// ```
pub fn increasing(mut low: f64, mut high: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let mut f_high = f(high);
    if f_high <= 0.0 {
        return high;
    }
    let mut f_low = f(low);
    if f_low >= 0.0 {
        return low;
    }
    let (mut slow, mut last_was_low) = (0_u32, None);
    for _ in 0..MAX_STEPS {
        let width = high - low;
        // At least a last bit away from either end: so a bracket with one end at the root closes at once.
        let least = f64::EPSILON * low.abs().max(high.abs());
        let secant = (low - f_low * width / (f_high - f_low)).max(low + least).min(high - least);
        let x = if slow >= MAX_SLOW || !(secant > low && secant < high) { low + width / 2.0 } else { secant };
        if x <= low || x >= high {
            break;
        }
        let y = f(x);
        let is_low = y <= 0.0;
        // The end that stays a second time loses half its weight.
        let stays = if last_was_low == Some(is_low) { 0.5 } else { 1.0 };
        if is_low {
            (low, f_low) = (x, y);
            f_high *= stays;
        } else {
            (high, f_high) = (x, y);
            f_low *= stays;
        }
        last_was_low = Some(is_low);
        slow = if high - low > width / 2.0 { slow + 1 } else { 0 };
        if y == 0.0 {
            break;
        }
    }
    low
}
