//! Weighted linear least squares with a prior, a few unknowns at a time: sums now, the solution where it is used.

use super::sqrt;

/// Sums of Σ xᵢ·xⱼ and Σ xᵢ·y over rows y = Σ xᵢ·βᵢ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalEquations<const N: usize> {
    products: [[f64; N]; N],
    values: [f64; N],
}

/// What an unknown is thought to be before anything was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Its value.
    pub mean: f64,
    /// Its standard deviation, above 0.
    pub deviation: f64,
}

impl<const N: usize> Default for NormalEquations<N> {
    fn default() -> Self {
        Self { products: [[0.0; N]; N], values: [0.0; N] }
    }
}

impl<const N: usize> NormalEquations<N> {
    /// Takes in a row.
    pub fn add(&mut self, row: [f64; N], value: f64) {
        for ((products, sum), x) in self.products.iter_mut().zip(&mut self.values).zip(row) {
            products.iter_mut().zip(row).for_each(|(product, other)| *product += x * other);
            *sum += x * value;
        }
    }

    /// Older rows count for this share of what they did.
    pub fn decay(&mut self, kept: f64) {
        self.products.iter_mut().flatten().chain(&mut self.values).for_each(|sum| *sum *= kept);
    }

    /// All sums, to be written down and put back.
    pub(crate) fn numbers_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.products.iter_mut().flatten().chain(&mut self.values)
    }

    /// The same rows without what they say of one unknown, which is another from now on: it is eliminated. Beside it what of
    /// Σ y² that unknown accounts for.
    pub(crate) fn without(&self, unknown: usize) -> (Self, f64) {
        let pivot = self.product(unknown, unknown);
        if !(pivot > 0.0) {
            return (*self, 0.0);
        }
        let mut left = *self;
        let row = self.products.get(unknown).copied().unwrap_or([0.0; N]);
        let value = self.values.get(unknown).copied().unwrap_or_default();
        for ((products, sum), own) in left.products.iter_mut().zip(&mut left.values).zip(row) {
            let share = own / pivot;
            products.iter_mut().zip(row).for_each(|(product, other)| *product -= share * other);
            *sum -= share * value;
        }
        // What rounding leaves of it.
        for (index, (products, sum)) in left.products.iter_mut().zip(&mut left.values).enumerate() {
            if index == unknown {
                (*products, *sum) = ([0.0; N], 0.0);
            } else if let Some(product) = products.get_mut(unknown) {
                *product = 0.0;
            }
        }
        (left, value * value / pivot)
    }

    /// The sums for fewer unknowns, each of which all columns are multiples of: row m of `weights` says how much of each column
    /// the unknown m stands for.
    ///
    /// ```
    /// use rigidtap::control::math::least_squares::{NormalEquations, Prior};
    /// let mut fit = NormalEquations::default();
    /// (1..10).map(f64::from).for_each(|x| fit.add([x, 2.0 * x], 10.0 * x));
    /// // y = β·(x + 2·2·x)
    /// let [beta] = fit.combined([[1.0, 2.0]]).solve([Prior { mean: 0.0, deviation: 1e3 }], 1e-3);
    /// assert!((beta - 2.0).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn combined<const M: usize>(&self, weights: [[f64; N]; M]) -> NormalEquations<M> {
        let dot = |a: [f64; N], b: [f64; N]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let products = weights.map(|left| {
            let column = self.products.map(|row| dot(row, left));
            weights.map(|right| dot(column, right))
        });
        NormalEquations { products, values: weights.map(|left| dot(self.values, left)) }
    }

    /// Σ xᵢ·xⱼ of two unknowns; 0 beyond them.
    #[must_use]
    pub fn product(&self, i: usize, j: usize) -> f64 {
        self.products.get(i).and_then(|row| row.get(j)).copied().unwrap_or_default()
    }

    /// Σ (y − Σ xᵢ·βᵢ)² of a solution, less Σ y².
    #[must_use]
    pub fn misfit(&self, solution: [f64; N]) -> f64 {
        let dot = |a: [f64; N]| a.iter().zip(solution).map(|(a, b)| a * b).sum::<f64>();
        dot(self.products.map(dot)) - 2.0 * dot(self.values)
    }

    /// The unknowns that fit rows and priors best, where each row's value has a standard deviation of `noise`.
    ///
    /// Gauss's elimination without exchange of rows, which a positive definite matrix does not need; an unknown whose pivot
    /// is lost to rounding stays at its prior.
    ///
    /// ```
    /// use rigidtap::control::math::least_squares::{NormalEquations, Prior};
    /// let mut line = NormalEquations::default();
    /// (0..10).map(f64::from).for_each(|x| line.add([1.0, x], 3.0 + 0.5 * x));
    /// let vague = Prior { mean: 0.0, deviation: 1e3 };
    /// let [offset, slope] = line.solve([vague; 2], 0.01);
    /// assert!((offset - 3.0).abs() < 1e-6 && (slope - 0.5).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn solve(&self, priors: [Prior; N], noise: f64) -> [f64; N] {
        let Self { products: mut matrix, values: mut right } = *self;
        // In units of each prior's deviation and from its mean, so that all unknowns are alike.
        let means = priors.map(|prior| prior.mean);
        for (value, row) in right.iter_mut().zip(&matrix) {
            *value -= row.iter().zip(means).map(|(product, mean)| product * mean).sum::<f64>();
        }
        for (i, (row, value)) in matrix.iter_mut().zip(&mut right).enumerate() {
            let scale = priors.get(i).map_or(1.0, |prior| prior.deviation);
            row.iter_mut().zip(priors).for_each(|(product, prior)| *product *= scale * prior.deviation);
            *value *= scale;
            if let Some(diagonal) = row.get_mut(i) {
                *diagonal += noise * noise;
            }
        }
        let mut solved = eliminated(matrix, right);
        solved.iter_mut().zip(priors).for_each(|(value, prior)| *value = prior.mean + prior.deviation * *value);
        solved
    }

    /// The standard deviation of an unknown in [`Self::solve`]; 0 beyond the unknowns.
    ///
    /// ```
    /// use rigidtap::control::math::least_squares::{NormalEquations, Prior};
    /// let mut mean = NormalEquations::default();
    /// (0..25).for_each(|_| mean.add([1.0], 7.0));
    /// // 0.5/√25
    /// assert!((mean.deviation([Prior { mean: 0.0, deviation: 1e3 }], 0.5, 0) - 0.1).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn deviation(&self, priors: [Prior; N], noise: f64, unknown: usize) -> f64 {
        let mut unit = Self { values: [0.0; N], ..*self };
        if let Some(value) = unit.values.get_mut(unknown) {
            *value = 1.0;
        }
        let column = unit.solve(priors.map(|prior| Prior { mean: 0.0, ..prior }), noise);
        noise * sqrt(column.get(unknown).copied().unwrap_or_default().max(0.0))
    }
}

fn eliminated<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
    for i in 0..N {
        let (Some(pivot_row), Some(pivot_value)) = (matrix.get(i).copied(), right.get(i).copied()) else { continue };
        let pivot = pivot_row.get(i).copied().unwrap_or_default();
        if pivot.is_nan() || pivot <= 0.0 {
            continue;
        }
        for (row, value) in matrix.iter_mut().zip(&mut right).skip(i + 1) {
            let factor = row.get(i).copied().unwrap_or_default() / pivot;
            row.iter_mut().zip(pivot_row).for_each(|(entry, above)| *entry -= factor * above);
            *value -= factor * pivot_value;
        }
    }
    let mut solution = [0.0; N];
    for i in (0..N).rev() {
        let (Some(row), Some(value)) = (matrix.get(i), right.get(i)) else { continue };
        let known: f64 = row.iter().zip(solution).skip(i + 1).map(|(entry, solved)| entry * solved).sum();
        let pivot = row.get(i).copied().unwrap_or_default();
        if let Some(unknown) = solution.get_mut(i) {
            *unknown = if pivot > 0.0 { (value - known) / pivot } else { 0.0 };
        }
    }
    solution
}

#[cfg(test)]
mod tests {
    /// The slope of a line whose offset is another one after a while.
    #[test]
    fn an_unknown_that_changes_is_left_out() {
        let mut line = NormalEquations::default();
        (0..10).map(f64::from).for_each(|x| line.add([1.0, x], 3.0 + 0.5 * x));
        let (mut line, explained) = line.without(0);
        assert!((explained - 10.0 * 5.25 * 5.25).abs() < 1e-9, "ten values of 3 to 7.5");
        line.add([1.0, 4.0], 7.0);
        let vague = Prior { mean: 0.0, deviation: 1e3 };
        let [offset, slope] = line.solve([vague; 2], 0.01);
        assert!((slope - 0.5).abs() < 1e-6 && (offset - 5.0).abs() < 1e-5, "{offset} {slope}");
    }

    use super::{NormalEquations, Prior};
    use nalgebra::{Matrix3, Vector3};

    /// Against nalgebra's Cholesky decomposition of the same normal equations.
    #[test]
    fn solution_is_that_of_another_library() {
        let mut fit = NormalEquations::<3>::default();
        let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for k in 0..50 {
            let x = f64::from(k) * 0.1;
            let (row, value) = ([1.0, x, x * x], 2.0 - x + 0.3 * x * x + 0.01 * (7.0 * x).sin());
            fit.add(row, value);
            let column = Vector3::from(row);
            matrix += column * column.transpose();
            right += column * value;
        }
        let priors = [(1.0, 2.0), (0.0, 0.5), (-1.0, 3.0)].map(|(mean, deviation)| Prior { mean, deviation });
        let noise: f64 = 0.3;
        for (i, prior) in priors.iter().enumerate() {
            let weight = (noise / prior.deviation).powi(2);
            matrix[(i, i)] += weight;
            right[i] += weight * prior.mean;
        }
        let expected = matrix.cholesky().unwrap().solve(&right);
        let found = fit.solve(priors, noise);
        assert!(
            found.iter().zip(expected.iter()).all(|(found, expected)| (found - expected).abs() < 1e-9),
            "{found:?}"
        );
    }

    /// Row by row, of y = 2 + 0.5·x and of a solution that is off.
    #[test]
    fn misfit_is_that_of_the_rows() {
        let (mut fit, mut squares, mut left) = (NormalEquations::default(), 0.0, 0.0);
        for x in (0..10).map(f64::from) {
            let y = 2.0 + 0.5 * x;
            fit.add([1.0, x], y);
            squares += y * y;
            left += (y - 1.5 - 0.7 * x) * (y - 1.5 - 0.7 * x);
        }
        assert!((squares + fit.misfit([1.5, 0.7]) - left).abs() < 1e-9);
        assert!((squares + fit.misfit([2.0, 0.5])).abs() < 1e-9);
    }

    #[test]
    fn nothing_measured_is_the_prior() {
        let priors = [Prior { mean: 3.0, deviation: 2.0 }, Prior { mean: -1.0, deviation: 0.1 }];
        assert_eq!(NormalEquations::default().solve(priors, 1.0), [3.0, -1.0]);
        assert_eq!(NormalEquations::default().solve(priors, 0.0), [3.0, -1.0]);
    }
}
