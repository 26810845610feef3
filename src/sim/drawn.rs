//! What a sweep draws one value from.

use core::fmt;

use rand::{Rng, RngExt};

use super::friction::FrictionModel;

/// Most values of a choice.
pub(super) const MOST_CHOICES: usize = 8;

/// One value's range, or choice. Each draw takes one number of the generator, whatever it is drawn from, so that the
/// others stay as they were.
#[derive(Clone, Copy, PartialEq)]
pub enum Drawn {
    /// Evenly between least and greatest.
    Within([f64; 2]),
    /// What some machines have: evenly within `any` for this share of them, nothing for the others.
    Some {
        /// Least and greatest value of those that have it.
        any: [f64; 2],
        /// Share of the machines that have it.
        ratio: f64,
    },
    /// One of up to eight values, each as likely.
    OneOf([Option<f64>; MOST_CHOICES]),
}

impl fmt::Debug for Drawn {
    /// As a machine file has it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Within([low, high]) => write!(f, "[{low:?}, {high:?}]"),
            Self::Some { any: [low, high], ratio } => write!(f, "{{ any = [{low:?}, {high:?}], ratio = {ratio:?} }}"),
            Self::OneOf(values) => {
                let values: Vec<_> = values.iter().flatten().map(f64::to_string).collect();
                write!(f, "{{ one_of = [{}] }}", values.join(", "))
            }
        }
    }
}

impl From<[f64; 2]> for Drawn {
    fn from(range: [f64; 2]) -> Self {
        Self::Within(range)
    }
}

impl Drawn {
    /// One of these values; of more than eight the first ones.
    #[must_use]
    pub fn one_of(values: &[f64]) -> Self {
        Self::OneOf(std::array::from_fn(|index| values.get(index).copied()))
    }

    /// Every number that bounds the values or is one of them.
    pub fn bounds(&self) -> impl Iterator<Item = f64> {
        let ends: [Option<f64>; MOST_CHOICES] = match *self {
            Self::Within([low, high]) | Self::Some { any: [low, high], .. } => {
                std::array::from_fn(|index| [low, high].get(index).copied())
            }
            Self::OneOf(values) => values,
        };
        ends.into_iter().flatten()
    }

    /// One value; `nothing` for a machine that has none of it.
    ///
    /// ```
    /// use rand::SeedableRng;
    /// use rigidtap::sim::Drawn;
    /// let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    /// let late = Drawn::Some { any: [1.0, 1.0], ratio: 0.05 };
    /// let count = (0..10_000).filter(|_| late.draw(0.0, &mut random) == 1.0).count();
    /// assert!((450..550).contains(&count));
    /// ```
    pub fn draw(&self, nothing: f64, random: &mut impl Rng) -> f64 {
        let share = random.random::<f64>();
        let within = |[low, high]: [f64; 2], share: f64| (low + (high - low) * share).min(high);
        match *self {
            Self::Within(range) => within(range, share),
            // Those that have it are the ones with a small number; over the ratio that is even again.
            Self::Some { any, ratio } if share < ratio => within(any, share / ratio),
            Self::Some { .. } => nothing,
            Self::OneOf(values) => {
                let count = values.iter().flatten().count();
                let chosen = ((share * count as f64) as usize).min(count.saturating_sub(1));
                values.iter().flatten().nth(chosen).copied().unwrap_or(nothing)
            }
        }
    }
}

/// Friction laws to choose from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct FrictionModels {
    chosen: [bool; FrictionModel::ALL.len()],
}

impl fmt::Debug for FrictionModels {
    /// As a machine file has it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = self.iter().map(FrictionModel::name).collect();
        write!(f, "{{ one_of = {names:?} }}")
    }
}

impl FrictionModels {
    /// These laws, each as likely.
    #[must_use]
    pub fn of(models: &[FrictionModel]) -> Self {
        Self { chosen: FrictionModel::ALL.map(|model| models.contains(&model)) }
    }

    /// The laws, in the order of [`FrictionModel::ALL`].
    pub fn iter(&self) -> impl Iterator<Item = FrictionModel> {
        FrictionModel::ALL.into_iter().zip(self.chosen).filter_map(|(model, chosen)| chosen.then_some(model))
    }

    /// One of them; the standard one where there is none.
    pub fn draw(&self, random: &mut impl Rng) -> FrictionModel {
        let share = random.random::<f64>();
        let count = self.iter().count();
        let chosen = ((share * count as f64) as usize).min(count.saturating_sub(1));
        self.iter().nth(chosen).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn each_kind_takes_one_number_and_keeps_its_bounds() {
        let mut other = Pcg64Mcg::seed_from_u64(3);
        let mut random = other.clone();
        for drawn in
            [Drawn::Within([2.0, 3.0]), Drawn::Some { any: [2.0, 3.0], ratio: 0.3 }, Drawn::one_of(&[10.0, 16.0, 20.0])]
        {
            let values: Vec<f64> = (0..3000).map(|_| drawn.draw(0.0, &mut random)).collect();
            (0..3000).for_each(|_| _ = other.random::<f64>());
            assert_eq!(random, other);
            match drawn {
                Drawn::Within(_) => assert!(values.iter().all(|value| (2.0..=3.0).contains(value))),
                Drawn::Some { .. } => {
                    let some: Vec<_> = values.iter().filter(|value| **value != 0.0).collect();
                    assert!((some.len() as f64 / 3000.0 - 0.3).abs() < 0.03);
                    let mean = some.iter().copied().sum::<f64>() / some.len() as f64;
                    assert!((mean - 2.5).abs() < 0.04, "{mean}");
                }
                Drawn::OneOf(_) => {
                    for choice in [10.0, 16.0, 20.0] {
                        let count = values.iter().filter(|value| **value == choice).count();
                        assert!((900..1100).contains(&count), "{choice}: {count}");
                    }
                }
            }
        }
    }
}
