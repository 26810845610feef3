//! Where the bands should end.
//!
//! To first order, an acceleration lower than the curve's at speed v costs a stroke 2·(1/a − 1/a_curve)·(1 − v/peak) of
//! time: what the slower ramp takes, less what it no longer has to cruise. That sum has one term for each band, so
//! dynamic programming finds its least over a grid of speeds, whatever the curve's form. From there a pattern search
//! over the real planner's times goes the rest of the way.

use crate::control::profile::MAX_BANDS;
use crate::control::units::rev_per_s_from_rpm;

use super::error::TuneError;
use super::staircase::Staircase;
use super::task::TuneTask;

/// Speeds of the grid, beside the points of the torque curve.
const GRID: u32 = 240;
/// Weight of a ramp to the greatest speed beside the strokes: bands above all their peaks should make sense, too.
const RAMP_WEIGHT: f64 = 1e-4;
/// The pattern search's last step, of the greatest speed.
const LAST_STEP: f64 = 1e-5;
/// Gains of the price below this are rounding.
const LEAST_GAIN: f64 = 1e-10;

impl TuneTask {
    /// The bands with the least price there is for their number, 1 to [`MAX_BANDS`].
    ///
    /// Within 0.5 % of the best staircase of as many bands; tops are rounded to a thousandth of the greatest speed's
    /// decade (1 rpm for 8000 rpm), except where they stand on a point of the torque curve.
    ///
    /// # Errors
    /// [`TuneError::BandCount`].
    ///
    /// ```
    /// use rigidtap::{control::machine::Machine, laws::{STROKES_REV, TuneTask}};
    /// let task = TuneTask::new(Machine::reference().motor().clone(), 8000.0, 0.8, &STROKES_REV).unwrap();
    /// let tuned = task.best(2).unwrap();
    /// // The first band ends where constant torque does.
    /// assert_eq!(tuned.bands[0].to_rpm, 3000.0);
    /// assert!((tuned.stroke_over_bound - 1.072).abs() < 0.002);
    /// ```
    pub fn best(&self, count: usize) -> Result<Staircase, TuneError> {
        self.best_up_to(count)?.pop().ok_or(TuneError::BandCount { count })
    }

    /// The best bands for every number from 1 to `most`, in this order.
    ///
    /// # Errors
    /// [`TuneError::BandCount`].
    pub fn best_up_to(&self, most: usize) -> Result<Vec<Staircase>, TuneError> {
        if !(1..=MAX_BANDS).contains(&most) {
            return Err(TuneError::BandCount { count: most });
        }
        tops_up_to(self, most).iter().map(|tops_rpm| self.with_tops(tops_rpm)).collect()
    }
}

/// The best tops for every number of bands from 1 to `most`, in rpm.
fn tops_up_to(task: &TuneTask, most: usize) -> Vec<Vec<f64>> {
    let grid = grid_rpm(task);
    let mut starts = staircases(task, &grid, most);
    starts.iter_mut().for_each(|tops| refine(task, tops));
    starts.into_iter().map(|tops| rounded(task, tops)).collect()
}

/// The grid from 0 to the greatest speed, with the curve's points: between neighbours the curve is monotonic.
fn grid_rpm(task: &TuneTask) -> Vec<f64> {
    let max_rpm = task.max_rpm;
    let corners = task.motor.curve.points().iter().map(|point| point.speed_rpm);
    let mut grid: Vec<f64> = (0..=GRID).map(|step| max_rpm * f64::from(step) / f64::from(GRID)).collect();
    grid.extend(corners.filter(|speed| (0.0..max_rpm).contains(speed)));
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

/// ∫ of the weight of slowness from 0 to a speed.
fn weight(task: &TuneTask, speed: f64) -> f64 {
    let ramp = |peak: f64| {
        let reached = speed.min(peak);
        2.0 * reached * (1.0 - reached / (2.0 * peak))
    };
    let strokes: f64 = task.targets.iter().map(|target| ramp(target.peak_rev_per_s) / target.bound_s).sum();
    strokes + RAMP_WEIGHT * 2.0 * speed
}

/// Dynamic programming: the cheapest ways from 0 up the grid in 1, 2, … bands.
fn staircases(task: &TuneTask, grid: &[f64], most: usize) -> Vec<Vec<f64>> {
    let speeds: Vec<f64> = grid.iter().map(|rpm| rev_per_s_from_rpm(*rpm)).collect();
    let weights: Vec<f64> = speeds.iter().map(|speed| weight(task, *speed)).collect();
    let accelerations: Vec<f64> =
        speeds.iter().map(|speed| task.motor.acceleration_rev_per_s2(*speed, task.share)).collect();
    let last = grid.len() - 1;
    // Cheapest cost up to each node with the bands so far, and for each number of bands where its last band starts.
    let mut cost = vec![f64::INFINITY; grid.len()];
    cost[0] = 0.0;
    let mut starts: Vec<Vec<usize>> = Vec::new();
    let mut found = Vec::new();
    for _ in 0..most {
        let mut next = vec![f64::INFINITY; grid.len()];
        let mut start = vec![0; grid.len()];
        for high in 1..=last {
            let mut least = accelerations[high];
            for low in (0..high).rev() {
                least = least.min(accelerations[low]);
                let total = cost[low] + (weights[high] - weights[low]) / least;
                if total < next[high] {
                    (next[high], start[high]) = (total, low);
                }
            }
        }
        cost = next;
        starts.push(start);
        let mut at = last;
        let mut tops = Vec::new();
        for start in starts.iter().rev() {
            tops.push(grid[at]);
            at = start[at];
        }
        tops.reverse();
        found.push(tops);
    }
    found
}

/// Pattern search: each top up and down by a step that halves when none of them gains. The last top stays.
fn refine(task: &TuneTask, tops: &mut [f64]) {
    let Some(mut price) = task.price(tops) else { return };
    let mut step_rpm = task.max_rpm / 64.0;
    while step_rpm > LAST_STEP * task.max_rpm {
        let mut gained = false;
        for index in 0..tops.len() - 1 {
            for move_rpm in [step_rpm, -step_rpm] {
                let before = tops[index];
                tops[index] = before + move_rpm;
                let between =
                    tops[index] < tops[index + 1] && tops[index] > index.checked_sub(1).map_or(0.0, |i| tops[i]);
                match task.price(tops).filter(|new| between && *new < price - LEAST_GAIN) {
                    Some(new) => (price, gained) = (new, true),
                    None => tops[index] = before,
                }
            }
        }
        if !gained {
            step_rpm /= 2.0;
        }
    }
}

/// Tops as a person would enter them, wherever they are not the curve's own points and stay apart.
fn rounded(task: &TuneTask, mut tops: Vec<f64>) -> Vec<f64> {
    let per_rpm = 10f64.powf(3.0 - task.max_rpm.log10().floor());
    let own = |top: f64| task.motor.curve.points().iter().any(|point| point.speed_rpm == top);
    for index in 0..tops.len() - 1 {
        let top = (tops[index] * per_rpm).round() / per_rpm;
        let below = index.checked_sub(1).map_or(0.0, |below| tops[below]);
        if !own(tops[index]) && top > below && top < tops[index + 1] {
            tops[index] = top;
        }
    }
    tops
}
