//! Bumpless transfer from a hole to what follows it.
//!
//! Under model-based compensation a hole ends with a force on Z and a position reference beside its target. Dropped at once
//! they would be a blow. They decay instead, while the drive's own loops take over.

use crate::control::machine::{Machine, Takes};
use crate::control::math::{exp, poly::State};
use crate::control::port::Setpoint;

use super::frame::{Measured, Scale};

/// Decay constants of the force in integral times of Z's drive: at standstill, slowly so that Z is not moved; in motion, soon,
/// since each hole would add to what is left of the one before.
const RESTING_INTEGRALS: f64 = 200.0;
const MOVING_INTEGRALS: f64 = 2.0;

/// Feedforward that is left of the last hole, to be added to Z's setpoints until the next hole starts. Machine coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ResidualFeedforward {
    /// Beside Z's setpoint, in mm. It decays with Z's position gain, so that the drive sees no error.
    pub z: State,
    /// Beside Z's force feedforward, in N.
    pub z_force_n: f64,
}

impl ResidualFeedforward {
    /// A setpoint of a move after a hole, with the residual added.
    #[must_use]
    pub fn added_to(&self, setpoint: Setpoint) -> Setpoint {
        let Setpoint { z, z_force_n, .. } = setpoint;
        let z = State { velocity: z.velocity + self.z.velocity, ..z.shifted(self.z.position) };
        Setpoint { z, z_force_n: z_force_n + self.z_force_n, ..setpoint }
    }
}

/// The residual and its decay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HandOver {
    residual: ResidualFeedforward,
    /// Velocity beside a position, per its distance: the drive then sees none. A drive that takes a position alone sees the
    /// distance, which gives what its integrator has not taken over yet.
    z_gain_per_s: f64,
    /// What one period leaves of a position, of a force at standstill and of a force in motion.
    position_kept: f64,
    resting_force_kept: f64,
    moving_force_kept: f64,
    /// Travel of Z in one period beyond which it moves.
    moving_mm: f64,
    load_mm: Option<f64>,
}

impl HandOver {
    /// Nothing left.
    pub(super) fn new(machine: &Machine) -> Self {
        let (spec, period_s) = (machine.spec(), machine.spec().control.period_s);
        let (z_gain_per_s, fades_per_s) = match spec.drive.z_takes {
            Takes::Position => (0.0, 1.0 / spec.drive.z_integral_s),
            _ => (spec.drive.z_position_gain_per_s, spec.drive.z_position_gain_per_s),
        };
        Self {
            residual: ResidualFeedforward::default(),
            z_gain_per_s,
            position_kept: exp(-fades_per_s * period_s),
            resting_force_kept: exp(-period_s / (RESTING_INTEGRALS * spec.drive.z_integral_s)),
            moving_force_kept: exp(-period_s / (MOVING_INTEGRALS * spec.drive.z_integral_s)),
            // Half a count keeps the rounding of two positions out of the comparison.
            moving_mm: spec.z_axis.stribeck_mm_per_s * period_s + 0.5 / Scale::of(machine).counts_per_mm,
            load_mm: None,
        }
    }

    pub(super) fn residual(&self) -> ResidualFeedforward {
        self.residual
    }

    /// One period outside a hole's strokes.
    pub(super) fn decay(&mut self, measured: &Measured) {
        let before_mm = self.load_mm.replace(measured.load_mm).unwrap_or(measured.load_mm);
        let moves = (measured.load_mm - before_mm).abs() > self.moving_mm;
        let force_kept = if moves { self.moving_force_kept } else { self.resting_force_kept };
        self.leave(self.position_kept * self.residual.z.position, force_kept * self.residual.z_force_n);
    }

    /// A hole has ended with Z commanded so far above its target, and with such a force.
    pub(super) fn leave(&mut self, z_mm: f64, z_force_n: f64) {
        let z = State { position: z_mm, velocity: -self.z_gain_per_s * z_mm, ..State::default() };
        self.residual = ResidualFeedforward { z, z_force_n };
    }

    /// Nothing is left: Z was moved without it, its drive was off, or the next hole has taken it over.
    pub(super) fn discard(&mut self) {
        self.residual = ResidualFeedforward::default();
    }

    /// Periods have passed unseen.
    pub(super) fn note_gap(&mut self) {
        self.load_mm = None;
        self.discard();
    }
}

#[cfg(test)]
mod tests {
    use super::{HandOver, ResidualFeedforward, Scale};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::port::{Feedback, Setpoint};

    fn left() -> HandOver {
        let mut hand_over = HandOver::new(&Machine::reference());
        hand_over.leave(0.005, 300.0);
        hand_over
    }

    fn left_after(z_mm_per_period: f64, periods: i64) -> ResidualFeedforward {
        let (mut hand_over, scale) = (left(), Scale::of(&Machine::reference()));
        for k in 0..=periods {
            let z_counts = (k as f64 * z_mm_per_period * 10_000.0) as i64;
            hand_over.decay(&scale.measure(&Feedback { z_counts, ..Feedback::default() }));
        }
        hand_over.residual()
    }

    /// 1/40 s, 2 s and 20 ms of the reference machine.
    #[test]
    fn residual_decays_slowly_at_rest_and_soon_in_motion() {
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        let rested = left_after(0.0, 24);
        near(rested.z.position, 0.005 * (-1.0_f64).exp());
        near(rested.z.velocity, -40.0 * rested.z.position);
        near(rested.z_force_n, 300.0 * (-0.025_f64 / 2.0).exp());
        // The first period has none before it to have moved from.
        near(left_after(0.01, 20).z_force_n, 300.0 * (-0.001_f64 / 2.0 - 1.0).exp());
    }

    #[test]
    fn setpoints_go_on_from_it() {
        let z = State { position: -2.0, velocity: 3.0, ..State::default() };
        let setpoint = Setpoint { z, z_force_n: 10.0, ..Setpoint::default() };
        assert_eq!(ResidualFeedforward::default().added_to(setpoint), setpoint);
        let beside = left().residual().added_to(setpoint);
        assert_eq!((beside.z.position, beside.z.velocity, beside.z_force_n), (-1.995, 2.8, 310.0));
    }

    #[test]
    fn a_gap_leaves_nothing() {
        let mut hand_over = left();
        hand_over.note_gap();
        assert_eq!(hand_over.residual(), ResidualFeedforward::default());
    }
}
