//! Counts into rev and mm, and the signs of a hole: the only place for scale, hand, direction and zero.
//!
//! Inside the synchronizer everything of Z is positive into the hole: positions, speeds and forces. The spindle is positive
//! as M03 turns until [`Frame::travel`] brings it into the thread's hand. [`Feedback`] and
//! [`Setpoint`](crate::control::port::Setpoint) are in machine coordinates, with Z positive upwards.

use crate::control::cycle::{Hand, TapCycle};
use crate::control::machine::{Machine, ZEncoderAt};
use crate::control::math::{poly::State, round};
use crate::control::port::{Feedback, Setpoint};

use super::error::synchronisation_error_mm;

/// Counts of the encoders per unit of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Spindle counts per revolution, above 0.
    pub counts_per_rev: f64,
    /// Counts of Z's position encoder per mm, above 0.
    pub counts_per_mm: f64,
    /// Counts of the encoder on Z's motor per mm of Z, above 0.
    pub motor_counts_per_mm: f64,
}

impl Scale {
    /// The machine's encoders.
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, sync::Scale};
    /// let scale = Scale::of(&Machine::reference());
    /// assert_eq!((scale.spindle_rev(8192), scale.z_mm(-25_000)), (0.5, -2.5));
    /// ```
    #[must_use]
    pub fn of(machine: &Machine) -> Self {
        let (spindle, z) = (&machine.spec().spindle, &machine.spec().z_axis);
        Self {
            counts_per_rev: spindle.encoder_counts_per_rev,
            counts_per_mm: z.encoder_counts_per_mm,
            motor_counts_per_mm: z.motor_counts_per_mm,
        }
    }

    /// Spindle angle in rev, positive as M03 turns.
    #[must_use]
    pub fn spindle_rev(&self, counts: i64) -> f64 {
        counts as f64 / self.counts_per_rev
    }

    /// Z in machine coordinates, mm.
    #[must_use]
    pub fn z_mm(&self, counts: i64) -> f64 {
        counts as f64 / self.counts_per_mm
    }

    /// One period's feedback in units of the synchronizer.
    pub(super) fn measure(&self, feedback: &Feedback) -> Measured {
        let load_mm = -self.z_mm(feedback.z_counts);
        Measured {
            spindle_counts: feedback.spindle_counts,
            z_counts: feedback.z_counts,
            spindle_rev: self.spindle_rev(feedback.spindle_counts),
            load_mm,
            motor_mm: feedback.z_motor_counts.map(|counts| -(counts as f64 / self.motor_counts_per_mm)),
            spindle_torque_nm: feedback.spindle_torque_nm,
            z_force_n: feedback.z_force_n.map(|force_n| -force_n),
            torque_saturated: feedback.torque_saturated(),
            force_saturated: feedback.z.saturated == Some(true),
        }
    }

    /// One period's setpoint in units of the synchronizer.
    pub(super) fn commanded(&self, setpoint: &Setpoint) -> Commanded {
        Commanded { spindle: setpoint.spindle, z: setpoint.z.scaled(-1.0), z_force_n: -setpoint.z_force_n }
    }
}

/// What was measured in one period: Z positive into the hole, the spindle as M03 turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    spindle_counts: i64,
    z_counts: i64,
    pub(super) spindle_rev: f64,
    /// Z at its position encoder: the load's side where that is a scale at the table.
    pub(super) load_mm: f64,
    /// Z at its motor.
    pub(super) motor_mm: Option<f64>,
    pub(super) spindle_torque_nm: Option<f64>,
    pub(super) z_force_n: Option<f64>,
    pub(super) torque_saturated: bool,
    pub(super) force_saturated: bool,
}

/// What was commanded for one period: Z positive into the hole, the spindle as M03 turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Commanded {
    /// rev.
    pub(super) spindle: State,
    /// mm.
    pub(super) z: State,
    /// Force feedforward of Z beyond its acceleration's.
    pub(super) z_force_n: f64,
}

impl Measured {
    /// Motor–load deflection of Z in mm, positive where the motor leads into the hole; none without an encoder on the motor.
    pub(super) fn deflection_mm(&self) -> Option<f64> {
        Some(self.motor_mm? - self.load_mm)
    }
}

/// Whether Z's motor and load have an encoder each, so that what lies between them can be seen.
pub(super) fn sees_deflection(machine: &Machine) -> bool {
    machine.spec().z_axis.encoder_at == ZEncoderAt::Table
}

/// Travels of a hole since its zero, both positive into it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Travel {
    pub(super) z_mm: f64,
    pub(super) spindle_rev: f64,
}

/// Position errors of spindle and Z at rest: Z's is positive where it stands too deep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PositionError {
    pub(super) spindle_rev: f64,
    pub(super) z_deep_mm: f64,
}

/// Both axes' commands from the hole's start, positive into the hole, and their efforts beyond the accelerations'.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct AxisCommands {
    /// rev.
    pub(super) spindle: State,
    /// mm.
    pub(super) z: State,
    pub(super) spindle_torque_nm: f64,
    pub(super) z_force_n: f64,
}

/// Counts of spindle and Z in a hole's first synchronous period. Of absolute encoders they are the hole's helix of angle and Z,
/// whatever happens to the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HelixZero {
    /// Spindle's encoder.
    pub spindle_counts: i64,
    /// Z's position encoder.
    pub z_counts: i64,
}

/// Where spindle and Z stand on a hole's helix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// The helix's zero by the turns that the spindle's encoder counts now.
    pub zero: HelixZero,
    /// Travel of the spindle from it, rev into the hole.
    pub spindle_rev: f64,
    /// Travel of Z from it, mm into the hole.
    pub depth_mm: f64,
    /// e(k): by how much Z leads the helix, mm.
    pub offset_mm: f64,
}

impl HelixZero {
    /// Where the axes stand. A spindle's absolute encoder knows its angle within one turn, and the host that counted the turns
    /// may have been off since: Z tells which turn it is, the one that is nearest to the helix.
    #[must_use]
    pub fn standing(self, machine: &Machine, hand: Hand, pitch_mm: f64, feedback: &Feedback) -> Standing {
        let scale = Scale::of(machine);
        let measured = scale.measure(feedback);
        let told = travel(&scale, hand.sign(), self, &measured);
        let turns = round(told.z_mm / pitch_mm - told.spindle_rev);
        let lost_counts = round(hand.sign() * turns * scale.counts_per_rev) as i64;
        let zero = Self { spindle_counts: self.spindle_counts.wrapping_sub(lost_counts), ..self };
        let Travel { z_mm, spindle_rev } = travel(&scale, hand.sign(), zero, &measured);
        let offset_mm = synchronisation_error_mm(z_mm, pitch_mm, spindle_rev);
        Standing { zero, spindle_rev, depth_mm: z_mm, offset_mm }
    }
}

/// Differences of counts first, so that nothing is lost where the counts are large.
fn travel(scale: &Scale, hand: f64, zero: HelixZero, measured: &Measured) -> Travel {
    Travel {
        z_mm: -(measured.z_counts.wrapping_sub(zero.z_counts) as f64) / scale.counts_per_mm,
        spindle_rev: hand * measured.spindle_counts.wrapping_sub(zero.spindle_counts) as f64 / scale.counts_per_rev,
    }
}

/// Coordinates of one hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    scale: Scale,
    /// ±1, 1 for a right-hand thread.
    hand: f64,
    r_plane_mm: f64,
    spindle_rest_rev: f64,
    /// Counts of spindle and Z in the hole's first synchronous period.
    zero: HelixZero,
}

impl Frame {
    /// For a hole whose spindle rests at an angle before it starts.
    pub(super) fn new(machine: &Machine, cycle: &TapCycle, spindle_rest_rev: f64) -> Self {
        Self {
            scale: Scale::of(machine),
            hand: cycle.hand.sign(),
            r_plane_mm: cycle.r_plane_mm,
            spindle_rest_rev,
            zero: HelixZero { spindle_counts: 0, z_counts: 0 },
        }
    }

    /// For a hole that is gone on with: its zero is where its helix has it.
    pub(super) fn of_helix(machine: &Machine, cycle: &TapCycle, zero: HelixZero) -> Self {
        let spindle_rest_rev = Scale::of(machine).spindle_rev(zero.spindle_counts);
        Self { zero, ..Self::new(machine, cycle, spindle_rest_rev) }
    }

    pub(super) fn spindle_rest_rev(&self) -> f64 {
        self.spindle_rest_rev
    }

    pub(super) fn measure(&self, feedback: &Feedback) -> Measured {
        self.scale.measure(feedback)
    }

    /// Latches the zero of both travels.
    pub(super) fn latch_zero(&mut self, measured: &Measured) {
        self.zero = HelixZero { spindle_counts: measured.spindle_counts, z_counts: measured.z_counts };
    }

    /// The zero, once it is latched.
    pub(super) fn zero(&self) -> HelixZero {
        self.zero
    }

    /// Since the zero.
    pub(super) fn travel(&self, measured: &Measured) -> Travel {
        travel(&self.scale, self.hand, self.zero, measured)
    }

    /// How far spindle and Z are from rest at the hole's start angle and at a height in machine coordinates.
    pub(super) fn position_error(&self, measured: &Measured, z_target_mm: f64) -> PositionError {
        PositionError {
            spindle_rev: measured.spindle_rev - self.spindle_rest_rev,
            z_deep_mm: z_target_mm + measured.load_mm,
        }
    }

    /// Commands in machine coordinates, Z so much deeper than they say.
    pub(super) fn machine(&self, commands: &AxisCommands, deeper_mm: f64) -> AxisCommands {
        AxisCommands {
            spindle: commands.spindle.scaled(self.hand).shifted(self.spindle_rest_rev),
            z: commands.z.scaled(-1.0).shifted(self.r_plane_mm - deeper_mm),
            spindle_torque_nm: self.hand * commands.spindle_torque_nm,
            z_force_n: -commands.z_force_n,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{AxisCommands, Frame, HelixZero, Scale, Travel};
    use crate::control::cycle::{Hand, TapCycle};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::port::Feedback;

    fn frame(hand: Hand) -> Frame {
        let cycle = TapCycle { hand, ..TapCycle::right_hand(2.0, -10.0, 1.0, 1000.0) };
        Frame::new(&Machine::reference(), &cycle, 0.25)
    }

    /// 16384 counts a revolution, 0.1 µm; half a revolution back in M03's sense, and 1.5 mm down.
    #[test]
    fn travel_is_positive_into_the_hole_for_either_hand() {
        let start = Feedback { spindle_counts: i64::MAX - 100, z_counts: 20_000, ..Feedback::default() };
        let later = Feedback { spindle_counts: start.spindle_counts - 8192, z_counts: 5000, ..Feedback::default() };
        for (hand, spindle_rev) in [(Hand::Right, -0.5), (Hand::Left, 0.5)] {
            let mut frame = frame(hand);
            frame.latch_zero(&frame.measure(&start));
            assert_eq!(frame.travel(&frame.measure(&later)), Travel { z_mm: 1.5, spindle_rev });
        }
    }

    /// 1.5 mm in, a quarter of a turn beyond the helix, for encoders that lost 1000 turns or none.
    #[test]
    fn z_tells_the_turn_that_the_spindle_is_in() {
        let machine = Machine::reference();
        let zero = HelixZero { spindle_counts: 4096, z_counts: 20_000 };
        for (hand, turns) in [(Hand::Right, 0), (Hand::Right, 1000), (Hand::Left, -1000)] {
            let turned = (hand.sign() * 1.75 * 16_384.0) as i64 + turns * 16_384;
            let feedback = Feedback { spindle_counts: 4096 + turned, z_counts: 5000, ..Feedback::default() };
            let standing = zero.standing(&machine, hand, 1.0, &feedback);
            assert_eq!((standing.depth_mm, standing.spindle_rev, standing.offset_mm), (1.5, 1.75, -0.25));
            assert_eq!(standing.zero.spindle_counts - zero.spindle_counts, turns * 16_384);
        }
    }

    #[test]
    fn commands_come_back_as_what_was_measured() {
        for hand in [Hand::Right, Hand::Left] {
            let frame = frame(hand);
            let commands = AxisCommands {
                spindle: State { position: 3.0, velocity: 2.0, ..State::default() },
                z: State { position: 4.0, velocity: 5.0, ..State::default() },
                spindle_torque_nm: 1.0,
                z_force_n: 7.0,
            };
            let machine = frame.machine(&commands, -0.5);
            assert_eq!((machine.z.position, machine.z.velocity, machine.z_force_n), (2.0 - 4.0 + 0.5, -5.0, -7.0));
            assert_eq!(machine.spindle.position, 0.25 + hand.sign() * 3.0);
            assert_eq!(machine.spindle_torque_nm, hand.sign());
        }
    }

    #[test]
    fn position_errors_are_zero_at_rest_on_the_r_plane() {
        let frame = frame(Hand::Left);
        let feedback = Feedback { spindle_counts: 4096, z_counts: 20_000, ..Feedback::default() };
        let error = frame.position_error(&frame.measure(&feedback), 2.0);
        assert_eq!((error.spindle_rev, error.z_deep_mm), (0.0, 0.0));
        let deep = frame.position_error(&frame.measure(&Feedback { z_counts: 19_990, ..feedback }), 2.0);
        assert!((deep.z_deep_mm - 0.001).abs() < 1e-12);
    }

    #[test]
    fn what_no_drive_reports_stays_absent() {
        let scale = Scale::of(&Machine::reference());
        let nothing = scale.measure(&Feedback::default());
        assert_eq!((nothing.deflection_mm(), nothing.z_force_n, nothing.spindle_torque_nm), (None, None, None));
        let motor = scale.measure(&Feedback { z_counts: 100, z_motor_counts: Some(60), ..Feedback::default() });
        assert!((motor.deflection_mm().unwrap() - 0.004).abs() < 1e-12);
    }
}
