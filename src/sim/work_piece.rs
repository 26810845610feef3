//! The work piece: the torque that tapping takes.

use rand::{Rng, RngExt};

use crate::control::cycle::TapCycle;
use crate::control::machine::{Machine, TapSpec};
use crate::control::math::sqrt;
use crate::control::model::cutting::{engagement, tapping_torque_nm};

use super::effects::{Effect, Effects};
use super::spindle::lag_share;

/// Time over which the chip noise is correlated: chips break some hundred times a second.
const CHIP_S: f64 = 0.002;

/// What is being tapped, and how hard it is at the moment.
#[derive(Clone, Debug)]
pub(crate) struct WorkPiece {
    tap: TapSpec,
    factor: f64,
    noise_ratio: f64,
    /// Share of a fresh value in the noise of each tick.
    fresh_share: f64,
    /// Scaled so that the filtered noise keeps the variance of the fresh one.
    fresh_factor: f64,
    hole: Option<Hole>,
    noise: f64,
}

#[derive(Clone, Copy, Debug)]
struct Hole {
    surface_mm: f64,
    chamfer_mm: f64,
    full_nm: f64,
}

impl WorkPiece {
    pub(crate) fn new(machine: &Machine, cutting_factor: f64, effects: Effects, tick_s: f64) -> Self {
        let fresh_share = lag_share(CHIP_S, tick_s);
        Self {
            tap: machine.spec().tap,
            factor: effects.or_zero(Effect::Cutting, cutting_factor),
            noise_ratio: effects.or_zero(Effect::ChipNoise, machine.spec().tap.chip_noise_ratio),
            fresh_share,
            fresh_factor: sqrt(fresh_share * (2.0 - fresh_share)),
            hole: None,
            noise: 0.0,
        }
    }

    pub(crate) fn begin_hole(&mut self, cycle: &TapCycle) {
        let tap = &self.tap;
        self.hole = tap.size(cycle.pitch_mm).map(|(major_mm, hole_mm)| Hole {
            surface_mm: cycle.r_plane_mm - tap.surface_below_r_mm,
            chamfer_mm: tap.ramp_pitches * cycle.pitch_mm,
            full_nm: self.factor * tapping_torque_nm(major_mm, hole_mm, tap.kc_n_per_mm2, tap.tool_factor),
        });
        self.noise = 0.0;
    }

    /// Magnitude of the torque against the tool at a tip position, over one drive tick.
    pub(crate) fn torque_nm(&mut self, tip_mm: f64, inwards: bool, random: &mut impl Rng) -> f64 {
        let Some(hole) = self.hole else { return 0.0 };
        let share = engagement(hole.surface_mm - tip_mm, hole.chamfer_mm);
        if share == 0.0 || hole.full_nm == 0.0 {
            return 0.0;
        }
        if self.noise_ratio > 0.0 {
            let fresh = random.random_range(-1.0..=1.0);
            self.noise = (1.0 - self.fresh_share) * self.noise + self.fresh_factor * fresh;
        }
        let direction = if inwards { 1.0 } else { self.tap.out_torque_ratio };
        (hole.full_nm * share * direction * (1.0 + self.noise_ratio * self.noise)).max(0.0)
    }
}
