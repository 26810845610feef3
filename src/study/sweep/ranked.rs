//! Values by their rank in a stream that can be read again: exact, and in memory that does not grow with the stream.
//!
//! Each pass over the stream counts how many values share their leading bits, keeps the group that the rank lies in, and
//! looks twelve bits further in the next one; once a group is small it is sorted. Two or three passes do.

use std::io;

/// Bits that one pass looks at.
const DIGIT_BITS: u32 = 12;
const BUCKETS: usize = 1 << DIGIT_BITS;
/// So many values are sorted at once.
const SORTED_AT_ONCE: u64 = 1 << 14;

/// Reads the whole stream: for each item its values, always as many.
pub(super) type Replay<'a> = dyn FnMut(&mut dyn FnMut(&[f64])) -> io::Result<()> + 'a;

/// A number whose order as an integer is the order by `total_cmp`. A value that is no number counts as the greatest,
/// whatever its sign, which carries no meaning.
fn key_of(value: f64) -> u64 {
    let bits = if value.is_nan() { f64::NAN } else { value }.to_bits();
    bits ^ if bits >> 63 == 0 { 1 << 63 } else { u64::MAX }
}

fn value_of(key: u64) -> f64 {
    f64::from_bits(key ^ if key >> 63 == 1 { 1 << 63 } else { u64::MAX })
}

/// One rank of one column on the way to its value.
struct Sought {
    column: usize,
    /// Rank from 0 within the group.
    rank: u64,
    /// Number of values in the group.
    size: u64,
    /// Leading bits of the group.
    prefix: u64,
    known_bits: u32,
    seen: Seen,
}

enum Seen {
    All(Vec<u64>),
    Counts(Vec<u64>),
    Found(f64),
}

impl Sought {
    fn new(column: usize, rank: u64, size: u64) -> Self {
        Self { column, rank, size, prefix: 0, known_bits: 0, seen: Self::fresh(size) }
    }

    fn fresh(size: u64) -> Seen {
        if size <= SORTED_AT_ONCE { Seen::All(Vec::new()) } else { Seen::Counts(vec![0; BUCKETS]) }
    }

    /// Bits that this pass looks at; at the end fewer are left.
    fn digit_bits(&self) -> u32 {
        DIGIT_BITS.min(u64::BITS - self.known_bits)
    }

    fn see(&mut self, key: u64) {
        let known = key.checked_shr(u64::BITS - self.known_bits).unwrap_or(0);
        if known != self.prefix {
            return;
        }
        let left = u64::BITS - self.known_bits - self.digit_bits();
        let digit = (key >> left) as usize & (BUCKETS - 1) & ((1 << self.digit_bits()) - 1);
        match &mut self.seen {
            Seen::All(keys) => keys.push(key),
            Seen::Counts(counts) => {
                if let Some(count) = counts.get_mut(digit) {
                    *count += 1;
                }
            }
            Seen::Found(_) => {}
        }
    }

    fn end_pass(&mut self) {
        match &mut self.seen {
            Seen::All(keys) => {
                keys.sort_unstable();
                self.seen = Seen::Found(keys.get(self.rank as usize).map_or(f64::NAN, |key| value_of(*key)));
            }
            Seen::Counts(counts) => {
                let mut digit = 0;
                while let Some(count) = counts.get(digit).filter(|count| self.rank >= **count) {
                    self.rank -= count;
                    digit += 1;
                }
                self.size = counts.get(digit).copied().unwrap_or(0);
                let bits = DIGIT_BITS.min(u64::BITS - self.known_bits);
                self.prefix = self.prefix << bits | digit as u64;
                self.known_bits += bits;
                self.seen = if self.known_bits == u64::BITS {
                    Seen::Found(value_of(self.prefix))
                } else {
                    Self::fresh(self.size)
                };
            }
            Seen::Found(_) => {}
        }
    }
}

/// For each `(column, rank)` the value of that rank from 0 in the column's rising order; of a stream of `count` items. A
/// rank that the stream does not have is no number.
pub(super) fn at_ranks(wanted: &[(usize, u64)], count: u64, replay: &mut Replay<'_>) -> io::Result<Vec<f64>> {
    let mut sought: Vec<_> = wanted.iter().map(|(column, rank)| Sought::new(*column, *rank, count)).collect();
    while sought.iter().any(|one| !matches!(one.seen, Seen::Found(_))) {
        replay(&mut |values| {
            for one in &mut sought {
                if let Some(value) = values.get(one.column) {
                    one.see(key_of(*value));
                }
            }
        })?;
        sought.iter_mut().for_each(Sought::end_pass);
    }
    Ok(sought.iter().map(|one| if let Seen::Found(value) = one.seen { value } else { f64::NAN }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};

    fn check(columns: &[Vec<f64>]) {
        let count = columns[0].len();
        let ranks = [0, 1, count / 2, count.saturating_sub(2), count - 1];
        let wanted: Vec<_> =
            (0..columns.len()).flat_map(|column| ranks.map(|rank| (column, rank.min(count - 1) as u64))).collect();
        let mut passes = 0;
        let found = at_ranks(&wanted, count as u64, &mut |each| {
            passes += 1;
            for item in 0..count {
                each(&columns.iter().map(|column| column[item]).collect::<Vec<_>>());
            }
            Ok(())
        });
        for ((column, rank), value) in wanted.iter().zip(found.unwrap()) {
            let mut sorted: Vec<f64> =
                columns[*column].iter().map(|value| if value.is_nan() { f64::NAN } else { *value }).collect();
            sorted.sort_by(f64::total_cmp);
            assert_eq!(sorted[*rank as usize].to_bits(), value.to_bits(), "column {column}, rank {rank} of {count}");
        }
        assert!(passes <= 6, "{passes} passes");
    }

    /// More than are sorted at once, even, in steps, all alike, and of all sizes.
    #[test]
    fn many_values_are_found_as_by_sorting() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        let count = 3 * SORTED_AT_ONCE as usize + 5;
        let mut column = |of: &dyn Fn(f64) -> f64| (0..count).map(|_| of(random.random())).collect::<Vec<_>>();
        check(&[
            column(&|share| 0.8 + 0.4 * share),
            column(&|share| (3.0 * share).floor()),
            column(&|_| 0.1),
            column(&|share| (100.0 * (share - 0.5)).exp()),
            column(&|share| if share < 0.3 { -f64::NAN } else { (share - 0.6) * 1e-300 }),
        ]);
    }

    proptest! {
        #[test]
        fn any_values_are_found_as_by_sorting(
            values in proptest::collection::vec(
                prop_oneof![-1e3..1e3f64, Just(-0.0), Just(0.0), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(f64::NAN)],
                1..200,
            ),
        ) {
            check(&[values]);
        }
    }
}
