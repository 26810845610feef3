//! What of Z is read in one period, and whether it says enough.

use crate::control::machine::{Machine, ZEncoderAt};
use crate::control::port::Feedback;

/// Periods of sliding that each direction has to show.
const SLIDING_PERIODS: usize = 50;
/// Speed in the file's Stribeck speeds from which friction slides.
pub(super) const SLIDING_STRIBECK: f64 = 2.0;

/// What of Z is read in one period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Motion {
    pub(super) motor_mm: f64,
    pub(super) table_mm: f64,
    pub(super) force_n: f64,
}

impl Motion {
    pub(super) fn of(feedback: &Feedback, machine: &Machine) -> Self {
        let z = &machine.spec().z_axis;
        let table_mm = feedback.z_counts as f64 / z.encoder_counts_per_mm;
        Self {
            motor_mm: feedback.z_motor_counts.map_or(table_mm, |counts| counts as f64 / z.motor_counts_per_mm),
            table_mm,
            force_n: feedback.z_force_n.unwrap_or(0.0),
        }
    }
}

/// Whether the motor's encoder and the scale are two: else their difference stays what it was, to the count.
pub(super) fn two_encoders(motions: &[Motion], machine: &Machine) -> bool {
    let z = &machine.spec().z_axis;
    let count_mm = 1.0 / z.motor_counts_per_mm + 1.0 / z.encoder_counts_per_mm;
    let deflection_mm = |motion: &Motion| motion.motor_mm - motion.table_mm;
    let first_mm = motions.first().map_or(0.0, deflection_mm);
    z.encoder_at == ZEncoderAt::Table
        && motions.iter().any(|motion| (deflection_mm(motion) - first_mm).abs() > count_mm)
}

/// Whether Z slid long enough in each direction for a fit of its friction.
pub(super) fn slides_both_ways(motions: &[Motion], machine: &Machine) -> bool {
    let least_mm = SLIDING_STRIBECK * machine.spec().z_axis.stribeck_mm_per_s * machine.spec().control.period_s;
    let periods = |sign: f64| {
        let slides = |pair: &&[Motion]| {
            let [before, now] = pair else { return false };
            now.force_n != 0.0 && sign * (now.table_mm - before.table_mm) > least_mm
        };
        motions.windows(2).filter(slides).count()
    };
    periods(1.0) >= SLIDING_PERIODS && periods(-1.0) >= SLIDING_PERIODS
}
