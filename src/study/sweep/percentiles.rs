//! Percentiles of a sweep.

/// Percentiles by nearest rank: the p-th of N values is the ⌈N·p/100⌉-th in rising order, always one that occurred. With
/// fewer than 1000 values the 99.9th is the greatest, with fewer than 100 the 99th too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Percentiles {
    /// Half of the values are at most this.
    pub p50: f64,
    /// 99 % are.
    pub p99: f64,
    /// 99.9 % are.
    pub p999: f64,
    /// All are.
    pub max: f64,
}

impl Percentiles {
    /// Of values in any order. A value that is no number counts as the greatest; of no values all four are none.
    ///
    /// ```
    /// use rigidtap::study::Percentiles;
    /// let found = Percentiles::of((1..=200).map(f64::from));
    /// assert_eq!((found.p50, found.p99, found.p999, found.max), (100.0, 198.0, 200.0, 200.0));
    /// ```
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        // The sign of a NaN carries no meaning, yet an order by bits would put a negative one first.
        let mut sorted: Vec<f64> =
            values.into_iter().map(|value| if value.is_nan() { f64::NAN } else { value }).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let [p50, p99, p999, max] = Self::ranks(sorted.len() as u64)
            .map(|rank| usize::try_from(rank).ok().and_then(|rank| sorted.get(rank)).copied().unwrap_or(f64::NAN));
        Self { p50, p99, p999, max }
    }

    /// The four ranks, from 0, among so many values.
    pub(super) fn ranks(count: u64) -> [u64; 4] {
        [500, 990, 999, 1000].map(|per_mille| (count * per_mille).div_ceil(1000).max(1) - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn few_values_have_their_greatest_as_tail() {
        let found = Percentiles::of([3.0, -1.0, 2.0]);
        assert_eq!(found, Percentiles { p50: 2.0, p99: 3.0, p999: 3.0, max: 3.0 });
        assert!(Percentiles::of([]).p50.is_nan());
        assert!(Percentiles::of([1.0, -f64::NAN]).max.is_nan());
    }

    proptest! {
        /// By its definition: the least value that so large a share of all does not exceed.
        #[test]
        fn each_is_the_least_value_that_its_share_does_not_exceed(values in proptest::collection::vec(-1e3..1e3f64, 1..3000)) {
            let found = Percentiles::of(values.iter().copied());
            for (share, value) in [(500, found.p50), (990, found.p99), (999, found.p999), (1000, found.max)] {
                let enough = |limit: f64| 1000 * values.iter().filter(|value| **value <= limit).count() >= share * values.len();
                let below = values.iter().copied().filter(|other| *other < value).fold(f64::NEG_INFINITY, f64::max);
                prop_assert!(values.contains(&value) && enough(value) && !enough(below));
            }
        }
    }
}
