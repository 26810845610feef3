//! The work piece: the torque that tapping takes, and the force with which the tap draws Z along.

use rand::{Rng, RngExt};

use crate::control::cycle::TapCycle;
use crate::control::machine::{Machine, TapSpec};
use crate::control::math::sqrt;
use crate::control::model::cutting::{engagement, tapping_torque_nm};

use super::actual::Actual;
use super::effects::{Effect, Effects};
use super::spindle::lag_share;

/// Time over which the chip noise is correlated: chips break some hundred times a second.
const CHIP_S: f64 = 0.002;
/// A torque that no motor of such a machine overcomes.
const JAMMED_NM: f64 = 200.0;

/// What becomes of a tap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum TapState {
    #[default]
    Whole,
    /// It sticks: chips wedge it.
    Jammed,
    /// It cuts nothing any more.
    Broken,
}

/// What the tap asks for over a drive tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Cut {
    /// Torque against the tool's turning, a magnitude.
    pub(crate) torque_nm: f64,
    /// Force on Z along the tap's travel: into the hole while it turns in.
    pub(crate) along_n: f64,
}

/// What is being tapped, and how hard it is at the moment.
#[derive(Clone, Debug)]
pub(crate) struct WorkPiece {
    tap: TapSpec,
    factor: f64,
    axial_n: f64,
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
    pub(crate) fn new(machine: &Machine, actual: &Actual, effects: Effects, tick_s: f64) -> Self {
        let fresh_share = lag_share(CHIP_S, tick_s);
        Self {
            tap: machine.spec().tap,
            factor: effects.or_zero(Effect::Cutting, actual.cutting_torque),
            axial_n: actual.tap_axial_n,
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

    /// What tapping takes at a tip position, over one drive tick. The axial force goes with the torque: both are of the
    /// same chip, and on the way out of the same flanks.
    pub(crate) fn cut(&mut self, tip_mm: f64, inwards: bool, state: TapState, random: &mut impl Rng) -> Cut {
        let Some(hole) = self.hole else { return Cut::default() };
        let share = engagement(hole.surface_mm - tip_mm, hole.chamfer_mm);
        if share == 0.0 || hole.full_nm == 0.0 {
            return Cut::default();
        }
        if self.noise_ratio > 0.0 {
            let fresh = random.random_range(-1.0..=1.0);
            self.noise = (1.0 - self.fresh_share) * self.noise + self.fresh_factor * fresh;
        }
        match state {
            TapState::Whole => {}
            TapState::Jammed => return Cut { torque_nm: JAMMED_NM, along_n: 0.0 },
            TapState::Broken => return Cut::default(),
        }
        let direction = if inwards { 1.0 } else { self.tap.out_torque_ratio };
        let torque_nm = (hole.full_nm * share * direction * (1.0 + self.noise_ratio * self.noise)).max(0.0);
        Cut { torque_nm, along_n: self.axial_n * torque_nm / hole.full_nm }
    }
}
