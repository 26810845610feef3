//! A sweep's machines in parts of about the same size.

use std::fmt;
use std::num::NonZeroU32;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// One part of a sweep: the `number`-th of `of`.
///
/// ```
/// use std::num::NonZeroU32;
/// use rigidtap::study::Shard;
/// let shard: Shard = "3/8".parse()?;
/// assert_eq!(shard.runs(NonZeroU32::new(1000).unwrap()), 251..=375);
/// assert!("9/8".parse::<Shard>().is_err() && "0/8".parse::<Shard>().is_err());
/// # Ok::<(), &'static str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: NonZeroU32,
    of: NonZeroU32,
}

impl Shard {
    /// Part `number`, from 1, of `of`; none where there is no such part.
    #[must_use]
    pub fn new(number: u32, of: u32) -> Option<Self> {
        let (number, of) = (NonZeroU32::new(number)?, NonZeroU32::new(of)?);
        (number <= of).then_some(Self { number, of })
    }

    /// Number of the part, from 1.
    #[must_use]
    pub fn number(self) -> u32 {
        self.number.get()
    }

    /// Number of parts.
    #[must_use]
    pub fn of(self) -> u32 {
        self.of.get()
    }

    /// Numbers of its machines, from 1, among so many; none where there are more parts than machines.
    #[must_use]
    pub fn runs(self, all: NonZeroU32) -> RangeInclusive<u32> {
        let before = |parts: u32| (u64::from(all.get()) * u64::from(parts) / u64::from(self.of.get())) as u32;
        before(self.number.get() - 1) + 1..=before(self.number.get())
    }
}

impl FromStr for Shard {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        numbers
            .and_then(|(number, of)| Self::new(number, of))
            .ok_or("expected K/N, part K from 1 to N of N parts, such as 3/8")
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn parts_hold_each_machine_once(all in 1..100_000_u32, of in 1..300_u32) {
            let mut next = 1;
            for number in 1..=of {
                let runs = Shard::new(number, of).unwrap().runs(NonZeroU32::new(all).unwrap());
                prop_assert_eq!(*runs.start(), next);
                let size = runs.count() as u32;
                prop_assert!(size.abs_diff(all / of) <= 1);
                next += size;
            }
            prop_assert_eq!(next, all + 1);
        }
    }
}
