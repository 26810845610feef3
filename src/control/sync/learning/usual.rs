//! What a hole is mostly off by, whatever a part of it does.

/// Share of the points that are off by no more.
const SHARE: f64 = 0.85;
/// Steps of a bin: a quarter of an octave, by the leading bits of a single's pattern.
const BIN_BITS: u32 = 21;
/// From 0.06 nm to beyond a metre.
const LEAST_BIN: u32 = (94 << 23) >> BIN_BITS;
const BINS: usize = 192;

/// Collects what points are off by, in bins, so that it takes no sorting.
pub(super) struct Usual {
    bins: [u16; BINS],
    points: u32,
}

impl Usual {
    pub(super) fn new() -> Self {
        Self { bins: [0; BINS], points: 0 }
    }

    pub(super) fn add(&mut self, error_mm: f32) {
        let bin = (error_mm.abs().to_bits() >> BIN_BITS).saturating_sub(LEAST_BIN) as usize;
        if let Some(count) = self.bins.get_mut(bin.min(BINS - 1)) {
            *count = count.saturating_add(1);
            self.points += 1;
        }
    }

    /// What most points do not exceed, mm, up to a quarter too large; 0 without any.
    pub(super) fn mm(&self) -> f32 {
        let needed = SHARE * f64::from(self.points);
        let mut sum = 0;
        for (bin, count) in (1..).zip(&self.bins) {
            sum += u32::from(*count);
            if sum > 0 && f64::from(sum) >= needed {
                return f32::from_bits((LEAST_BIN + bin) << BIN_BITS);
            }
        }
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::Usual;

    #[test]
    fn a_part_of_the_points_changes_nothing() {
        let mut usual = Usual::new();
        assert_eq!(usual.mm(), 0.0);
        (0..900).for_each(|k| usual.add(0.002 * if k % 2 == 0 { 1.0 } else { -1.0 }));
        let without = usual.mm();
        assert!((0.002..0.0025).contains(&without), "{without}");
        (0..100).for_each(|_| usual.add(0.2));
        assert_eq!(usual.mm(), without);
        (0..200).for_each(|_| usual.add(0.2));
        assert!(usual.mm() > 0.1);
        // Whatever it is.
        [f32::NAN, f32::INFINITY, 0.0, 1e-30].into_iter().for_each(|error_mm| usual.add(error_mm));
    }
}
