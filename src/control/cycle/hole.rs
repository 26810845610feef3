//! The typed tapping cycle that the G-code front end, or a kernel's own, hands to the control.

use super::error::CycleError;
use crate::control::machine::Machine;
use crate::control::units::rev_per_s_from_rpm;

/// Hand of a thread, and of the spindle that cuts it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hand {
    /// M03 on the way in.
    #[default]
    Right,
    /// M04 on the way in.
    Left,
}

impl Hand {
    /// +1 for a right-hand thread, −1 for a left-hand one: spindle direction on the way in.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }
}

/// What a peck does at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Retract {
    /// Turns back a little to break the chip.
    ChipBreak {
        /// How far Z goes back, at most to the R plane.
        back_mm: f64,
    },
    /// Goes back to the R plane to clear the chips.
    Full,
}

/// One tapped hole in absolute machine coordinates. Z falls into the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TapCycle {
    /// Hole position.
    pub x_mm: f64,
    /// Hole position.
    pub y_mm: f64,
    /// Where the synchronous strokes start and end.
    pub r_plane_mm: f64,
    /// Deepest point, below the R plane.
    pub bottom_mm: f64,
    /// Where Z goes after the hole.
    pub return_mm: f64,
    /// Z travel per revolution P, eq. 1, positive.
    pub pitch_mm: f64,
    /// Spindle speed on the way in, positive.
    pub speed_rpm: f64,
    /// Spindle speed on the way out, positive.
    pub out_speed_rpm: f64,
    /// Hand of the thread.
    pub hand: Hand,
    /// Angle at which the spindle rests on the R plane before the hole, from its encoder's zero, positive as M03 turns; whole
    /// turns do not count. None: where it comes to rest. With an angle the same hole has the same helix whatever its speed,
    /// depth or law; with another R plane it has another one, as on a SINUMERIK (CYCLE84's POSS is an angle at its start plane).
    pub start_angle_rev: Option<f64>,
    /// Pause at the bottom, 0 for none.
    pub dwell_s: f64,
    /// Depth of one peck; none taps in one stroke.
    pub peck_mm: Option<f64>,
    /// What each peck does at its end, where there are pecks.
    pub retract: Option<Retract>,
    /// Number of the tool, 0 where it is not known: holes of another tool are of another kind.
    pub tool: u32,
}

impl TapCycle {
    /// A right-hand hole at X0 Y0 without dwell or pecks that returns to the R plane.
    #[must_use]
    pub fn right_hand(r_plane_mm: f64, bottom_mm: f64, pitch_mm: f64, speed_rpm: f64) -> Self {
        Self {
            x_mm: 0.0,
            y_mm: 0.0,
            r_plane_mm,
            bottom_mm,
            return_mm: r_plane_mm,
            pitch_mm,
            speed_rpm,
            out_speed_rpm: speed_rpm,
            hand: Hand::Right,
            start_angle_rev: None,
            dwell_s: 0.0,
            peck_mm: None,
            retract: None,
            tool: 0,
        }
    }

    /// Travel of the whole stroke, R plane to bottom.
    #[must_use]
    pub fn depth_mm(&self) -> f64 {
        self.r_plane_mm - self.bottom_mm
    }

    /// Whether two holes differ in nothing but their place.
    #[must_use]
    pub fn is_alike(&self, other: &Self) -> bool {
        Self { x_mm: self.x_mm, y_mm: self.y_mm, ..*other } == *self
    }

    /// What can be refused before any stroke is planned.
    pub(super) fn check(&self, machine: &Machine) -> Result<(), CycleError> {
        let spec = machine.spec();
        for value in [self.pitch_mm, self.speed_rpm, self.out_speed_rpm] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(CycleError::Invalid { value });
            }
        }
        if !(self.dwell_s >= 0.0 && self.dwell_s.is_finite()) {
            return Err(CycleError::Invalid { value: self.dwell_s });
        }
        if !(self.depth_mm() > 0.0 && self.depth_mm().is_finite()) {
            return Err(CycleError::NoStroke { r_plane_mm: self.r_plane_mm, bottom_mm: self.bottom_mm });
        }
        let back_mm = match self.retract {
            Some(Retract::ChipBreak { back_mm }) => Some(back_mm),
            Some(Retract::Full) | None => None,
        };
        for value in [self.peck_mm, self.peck_mm.and(back_mm)].into_iter().flatten() {
            if !(value > 0.0 && value.is_finite()) {
                return Err(CycleError::Invalid { value });
            }
        }
        if let Some(value) = self.start_angle_rev.filter(|angle| !angle.is_finite()) {
            return Err(CycleError::Invalid { value });
        }
        let needed_rpm = self.speed_rpm.max(self.out_speed_rpm);
        let limit_rpm = spec.spindle.max_rpm;
        if needed_rpm > limit_rpm {
            return Err(CycleError::SpindleTooFast { needed_rpm, limit_rpm });
        }
        let needed_mm_per_s = self.pitch_mm * rev_per_s_from_rpm(needed_rpm);
        let limit_mm_per_s = spec.z.max_mm_per_s;
        if needed_mm_per_s > limit_mm_per_s {
            return Err(CycleError::PitchTooFast { needed_mm_per_s, limit_mm_per_s });
        }
        Ok(())
    }
}
