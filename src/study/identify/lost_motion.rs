//! Z's lost motion where it moves steadily: there the table's inertia does not push it across the backlash.
//!
//! The estimator in the period fits lost motion and compliance together over all motion; this compares places at steady speed,
//! which takes the whole recording.

use std::collections::BTreeMap;

use crate::control::machine::Machine;
use crate::control::units::m_from_mm;

use super::motion::{Motion, SLIDING_STRIBECK};

/// Length of a window.
const WINDOW_S: f64 = 0.016;
/// Greatest inertial force of the table, as a share of its friction.
const STEADY_SHARE: f64 = 0.3;
/// Places are told apart by this much, and so many have to be passed steadily both ways.
const CELL_MM: f64 = 2.0;
const LEAST_CELLS: usize = 3;

/// Motor less table moving upwards, less the same moving downwards; none where Z never moves steadily both ways.
pub(super) fn steady_mm(motions: &[Motion], machine: &Machine, friction_n: f64) -> Option<f64> {
    let spec = &machine.spec().z_axis;
    let period_s = machine.spec().control.period_s;
    let least_mm_per_s = SLIDING_STRIBECK * spec.stribeck_mm_per_s;
    let limit_n = STEADY_SHARE * friction_n * spec.friction_table_share;
    let periods = (WINDOW_S / period_s).round().max(2.0) as usize;
    let table_kg = spec.mass_kg * spec.table_share;
    // Compared place by place: friction twists the screw, and differs along it.
    let mut cells: BTreeMap<i64, [Mean; 2]> = BTreeMap::new();
    for window in motions.chunks_exact(periods) {
        let (first_mm_per_s, last_mm_per_s) = ends(window, period_s);
        let inertial_n = table_kg * m_from_mm(last_mm_per_s - first_mm_per_s) / ((periods - 1) as f64 * period_s);
        let slides = first_mm_per_s.abs().min(last_mm_per_s.abs()) > least_mm_per_s;
        let one_way = first_mm_per_s * last_mm_per_s > 0.0;
        if let (Some(first), true) = (window.first(), slides && one_way && inertial_n.abs() < limit_n) {
            let cell = cells.entry((first.table_mm / CELL_MM).floor() as i64).or_default();
            let [downwards, upwards] = cell;
            let way = if last_mm_per_s > 0.0 { upwards } else { downwards };
            window.iter().for_each(|motion| way.add(motion.motor_mm - motion.table_mm));
        }
    }
    let differences: Vec<_> =
        cells.values().filter_map(|[downwards, upwards]| Some(upwards.mean()? - downwards.mean()?)).collect();
    (differences.len() >= LEAST_CELLS).then(|| differences.iter().sum::<f64>() / differences.len() as f64)
}

/// Speed of the table at both ends of a window.
fn ends(window: &[Motion], period_s: f64) -> (f64, f64) {
    let speed = |pair: Option<&[Motion]>| match pair {
        Some([before, now]) => (now.table_mm - before.table_mm) / period_s,
        _ => 0.0,
    };
    (speed(window.get(..2)), speed(window.len().checked_sub(2).and_then(|from| window.get(from..))))
}

#[derive(Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn mean(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / f64::from(self.count))
    }
}
