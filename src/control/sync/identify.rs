//! What the machine shows of itself while it moves: in the program's own approach, in a dry cycle, in each hole.
//!
//! Momentum balances over short windows: what the drives gave, less what the speeds took. Between neighbouring windows
//! the noise of the speeds cancels, so sums are far better than any single one.

use crate::control::machine::{Machine, ZEncoderAt};
use crate::control::math::{round, sign};
use crate::control::motor::Motor;
use crate::control::port::Feedback;
use crate::control::units::{RAD_PER_REV, rpm_from_rev_per_s};

use super::means::{BothWays, KEPT_BY_HOLE, Mean};
use super::screw_fit::ScrewFit;
use super::z_model::ZModel;

/// What the machine has shown of itself, in place of what its file says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identified {
    /// The spindle's inertia per torque constant, over the file's.
    pub inertia_ratio: f64,
    /// The spindle motor's torque limit, over the file's curve.
    pub torque_limit_ratio: f64,
    /// Torque against the spindle's turning beyond the file's friction.
    pub spindle_drag_nm: f64,
    /// Z's sliding friction, both directions' mean.
    pub z_friction_n: f64,
    /// Z's force at constant speed that is the same both ways: weight that nothing balances.
    pub z_weight_n: f64,
    /// Z's motor less its scale at constant speed, one direction less the other.
    pub z_lost_motion_mm: f64,
    /// The screw's compliance, over the file's: its resonance falls with the root.
    pub z_compliance_ratio: f64,
    /// Z's motor less its scale in the middle of the lost motion, where both directions were seen.
    pub z_twist_middle_mm: Option<f64>,
}

impl Identified {
    /// What the machine's file says.
    #[must_use]
    pub fn nominal(machine: &Machine) -> Self {
        Self {
            inertia_ratio: 1.0,
            torque_limit_ratio: 1.0,
            spindle_drag_nm: 0.0,
            z_friction_n: machine.spec().z_axis.coulomb_n,
            z_weight_n: 0.0,
            z_lost_motion_mm: ZModel::nominal_play_mm(machine)
                + ZModel::new(machine).twist_mm(machine.spec().z_axis.coulomb_n),
            z_compliance_ratio: 1.0,
            z_twist_middle_mm: None,
        }
    }

    /// Where in the lost motion Z's motor stands, −1…1 and beyond by noise, 1 where it pushes into the hole, for its
    /// twist against the scale; none where that is not known, or nothing is lost.
    pub(super) fn z_side(&self, twist_mm: f64) -> Option<f64> {
        let lead_mm = self.z_lead_mm(twist_mm).filter(|_| self.z_lost_motion_mm > 0.0)?;
        Some(2.0 * lead_mm / self.z_lost_motion_mm)
    }

    /// How far Z's motor leads the table into the hole, for its twist against the scale; none where that is not known.
    pub(super) fn z_lead_mm(&self, twist_mm: f64) -> Option<f64> {
        // The motor leads downwards where it pushes into the hole.
        Some(self.z_twist_middle_mm? - twist_mm)
    }
}

/// Length of a window: long against the noise of a speed, short against a stroke.
const WINDOW_S: f64 = 0.016;
/// Below this the spindle's direction is not sure.
const SPINDLE_TURNING_REV_PER_S: f64 = 2.0;
/// Windows that what the file says counts as, and their torque, a share of the motor's: a slow tap shows its inertia in a
/// few windows of which the acceleration fills a part.
const PRIOR_WINDOWS: f64 = 1.0;
const PRIOR_SHARE: f64 = 0.4;
/// Torque of an acceleration, as a share of the motor's, from which on it says something of the inertia, and below which
/// there is none. Between, and above all in the many windows at constant speed, an acceleration is mostly the encoder's
/// noise, and a fit that took it for one would find next to no inertia.
const ACCELERATING_SHARE: f64 = 0.1;
const STEADY_SHARE: f64 = 0.02;
/// Least and greatest ratio to the file's value: no machine is further from it.
const RATIO: (f64, f64) = (0.5, 2.0);
/// Share of the motor's torque that drag can take at most.
const DRAG_SHARE: f64 = 0.3;
/// Share of Z's force that friction can take at most.
const FRICTION_SHARE: f64 = 0.5;
/// A pair of means is worth its trouble only where both ways were seen well: windows of each that tell weight from friction.
const BOTH_WAYS_WINDOWS: f64 = 8.0;
/// Greatest lost motion that is believed.
const LOST_MOTION_MAX_MM: f64 = 0.05;
/// Periods at the limit after which the torque is taken for the limit.
const LIMIT_PERIODS: u32 = 3;
/// Share that each further one counts for.
const LIMIT_SHARE: f64 = 0.2;

/// Positions and efforts of one period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sample {
    spindle_rev: f64,
    table_mm: f64,
    motor_mm: f64,
    torque_nm: f64,
    force_n: f64,
}

/// One window: its first period's speeds, and what was given since.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Window {
    periods: u32,
    spindle_rev_per_s: f64,
    table_mm_per_s: f64,
    motor_mm_per_s: f64,
    torque_nm: f64,
    force_n: f64,
    twist_mm: f64,
    friction_nm: f64,
}

/// Gathers what the machine shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Identification {
    motor: Motor,
    z: ZModel,
    force_limit_n: f64,
    nominal: Identified,
    coulomb_nm: f64,
    viscous_nm_per_rpm: f64,
    counts_per_rev: f64,
    counts_per_mm: f64,
    motor_counts_per_mm: f64,
    period_s: f64,
    window_periods: u32,
    /// Whether Z's motor tells where it is: none that has ever stood beside 0.
    motor_tells: bool,
    last: Option<Sample>,
    window: Option<Window>,
    /// Σ a², Σ a·s, Σ s², Σ a·y, Σ s·y of torque y = κ·J·a + c·s, s the direction; accelerations in torque of J.
    normal: [f64; 5],
    force_n: BothWays,
    screw: ScrewFit,
    /// Backlash, by the file.
    play_mm: f64,
    two_encoders: bool,
    saturated_periods: u32,
    limit_ratio: f64,
}

impl Identification {
    /// Nothing shown yet.
    pub(super) fn new(machine: &Machine) -> Self {
        let spec = machine.spec();
        let period_s = spec.control.period_s;
        Self {
            motor: machine.motor().clone(),
            z: ZModel::new(machine),
            force_limit_n: spec.z_axis.force_limit_n,
            nominal: Identified::nominal(machine),
            coulomb_nm: spec.spindle.coulomb_nm,
            viscous_nm_per_rpm: spec.spindle.viscous_nm_per_rpm,
            counts_per_rev: spec.spindle.encoder_counts_per_rev,
            counts_per_mm: spec.z_axis.encoder_counts_per_mm,
            motor_counts_per_mm: spec.z_axis.motor_counts_per_mm,
            period_s,
            window_periods: round(WINDOW_S / period_s).max(2.0) as u32,
            motor_tells: false,
            last: None,
            window: None,
            normal: [0.0; 5],
            force_n: BothWays::default(),
            screw: ScrewFit::default(),
            play_mm: ZModel::nominal_play_mm(machine),
            two_encoders: spec.z_axis.encoder_at == ZEncoderAt::Table,
            saturated_periods: 0,
            limit_ratio: 1.0,
        }
    }

    pub(super) fn nominal(&self) -> Identified {
        self.nominal
    }

    /// What is known by now: what was shown, as far as it was shown, else what the file says.
    pub(super) fn identified(&self) -> Identified {
        let [aa, a_s, ss, ay, sy] = self.normal;
        // What the file says counts as windows of κ = 1 at a torque, and of no drag.
        let prior_nm = PRIOR_SHARE * self.motor.curve.torque_nm(0.0);
        let prior = PRIOR_WINDOWS * prior_nm * prior_nm;
        let determinant = (aa + prior) * (ss + PRIOR_WINDOWS) - a_s * a_s;
        let ratio = ((ay + prior) * (ss + PRIOR_WINDOWS) - sy * a_s) / determinant;
        let drag_nm = (sy * (aa + prior) - (ay + prior) * a_s) / determinant;
        let greatest_nm = DRAG_SHARE * self.motor.curve.torque_nm(0.0);
        let within = |value: f64, (low, high): (f64, f64)| value.max(low).min(high);
        let (weight_n, friction_n) = self.weight_and_friction_n();
        let friction_n = within(friction_n, (0.0, FRICTION_SHARE * self.force_limit_n));
        let screw = self.screw.fit(&self.z, self.z.table_friction_share * friction_n, self.play_mm);
        let lost_mm = screw.play_mm + screw.compliance_ratio * self.z.twist_mm(friction_n);
        Identified {
            inertia_ratio: within(ratio, RATIO),
            torque_limit_ratio: self.limit_ratio,
            spindle_drag_nm: within(drag_nm, (-greatest_nm, greatest_nm)),
            z_friction_n: friction_n,
            z_weight_n: weight_n,
            z_lost_motion_mm: within(lost_mm, (0.0, LOST_MOTION_MAX_MM)),
            z_compliance_ratio: screw.compliance_ratio,
            z_twist_middle_mm: screw.middle_mm,
        }
    }

    fn weight_and_friction_n(&self) -> (f64, f64) {
        let BothWays { outwards, inwards } = &self.force_n;
        let weight_n = match self.force_n.means() {
            Some((up_n, down_n)) if self.force_n.least_weight() >= BOTH_WAYS_WINDOWS => 0.5 * (up_n + down_n),
            _ => 0.0,
        };
        let friction = Mean {
            sum: outwards.sum - inwards.sum - weight_n * (outwards.weight - inwards.weight),
            weight: outwards.weight + inwards.weight,
        };
        (weight_n, friction.or(self.nominal.z_friction_n))
    }

    /// Z's motor less its scale in one period.
    pub(super) fn twist_mm(&self, feedback: &Feedback) -> f64 {
        feedback.z_motor_counts.unwrap_or(0) as f64 / self.motor_counts_per_mm
            - feedback.z_counts as f64 / self.counts_per_mm
    }

    /// A hole begins: what older ones showed fades.
    pub(super) fn begin_hole(&mut self) {
        self.normal.iter_mut().for_each(|sum| *sum *= KEPT_BY_HOLE);
        self.force_n.fade();
        self.screw.fade(KEPT_BY_HOLE);
    }

    /// The next period is not measured against the last.
    pub(super) fn note_gap(&mut self) {
        (self.last, self.window) = (None, None);
        self.screw.note_gap();
    }

    /// One period's feedback, in machine coordinates.
    pub(super) fn observe(&mut self, feedback: &Feedback) {
        if !self.motor_tells && feedback.z_motor_counts.is_some() {
            self.motor_tells = true;
            self.note_gap();
        }
        let table_mm = feedback.z_counts as f64 / self.counts_per_mm;
        let motor_mm = feedback.z_motor_counts.unwrap_or(0) as f64 / self.motor_counts_per_mm;
        let sample = Sample {
            spindle_rev: feedback.spindle_counts as f64 / self.counts_per_rev,
            table_mm,
            motor_mm: if self.motor_tells { motor_mm } else { table_mm },
            torque_nm: feedback.spindle_torque_nm.unwrap_or(0.0),
            force_n: feedback.z_force_n.unwrap_or(0.0),
        };
        let Some(last) = self.last.replace(sample) else { return };
        let rate = |now: f64, then: f64| (now - then) / self.period_s;
        let spindle_rev_per_s = rate(sample.spindle_rev, last.spindle_rev);
        let table_mm_per_s = rate(sample.table_mm, last.table_mm);
        let motor_mm_per_s = rate(sample.motor_mm, last.motor_mm);
        self.limit(feedback, spindle_rev_per_s);
        let rpm = rpm_from_rev_per_s(spindle_rev_per_s);
        let friction_nm = self.coulomb_nm * sign(rpm) + self.viscous_nm_per_rpm * rpm;
        let opened = Window {
            periods: 0,
            spindle_rev_per_s,
            table_mm_per_s,
            motor_mm_per_s,
            torque_nm: 0.5 * sample.torque_nm,
            force_n: 0.5 * sample.force_n,
            twist_mm: sample.motor_mm - sample.table_mm,
            friction_nm: 0.5 * friction_nm,
        };
        let Some(mut window) = self.window else {
            self.window = Some(opened);
            return;
        };
        window.periods += 1;
        if window.periods < self.window_periods {
            window.twist_mm += sample.motor_mm - sample.table_mm;
            window.torque_nm += sample.torque_nm;
            window.force_n += sample.force_n;
            window.friction_nm += friction_nm;
            self.window = Some(window);
            return;
        }
        // The last period's mean speed stands for its middle, so half of its effort belongs to this window.
        window.torque_nm += 0.5 * sample.torque_nm;
        window.force_n += 0.5 * sample.force_n;
        window.friction_nm += 0.5 * friction_nm;
        self.window = Some(opened);
        self.close(&window, spindle_rev_per_s, table_mm_per_s, motor_mm_per_s);
    }

    fn close(&mut self, window: &Window, spindle_rev_per_s: f64, table_mm_per_s: f64, motor_mm_per_s: f64) {
        let periods = f64::from(window.periods);
        let length_s = periods * self.period_s;
        let turning = |speed: f64| speed.abs() > SPINDLE_TURNING_REV_PER_S;
        let same = |one: f64, other: f64| one * other > 0.0;
        if window.torque_nm != 0.0
            && turning(spindle_rev_per_s)
            && turning(window.spindle_rev_per_s)
            && same(spindle_rev_per_s, window.spindle_rev_per_s)
        {
            let direction = sign(spindle_rev_per_s);
            let acceleration = (spindle_rev_per_s - window.spindle_rev_per_s) / length_s;
            let a = self.motor.inertia_kg_m2 * RAD_PER_REV * acceleration;
            let y = (window.torque_nm - window.friction_nm) / periods;
            let motor_nm = self.motor.curve.torque_nm(0.0);
            let a = if a.abs() < STEADY_SHARE * motor_nm { 0.0 } else { a };
            if a == 0.0 || a.abs() > ACCELERATING_SHARE * motor_nm {
                for (sum, term) in self.normal.iter_mut().zip([a * a, a * direction, 1.0, a * y, direction * y]) {
                    *sum += term;
                }
            }
        }
        let sliding = |speed: f64| speed.abs() > self.z.sliding_mm_per_s();
        if window.force_n != 0.0
            && sliding(table_mm_per_s)
            && sliding(window.table_mm_per_s)
            && same(table_mm_per_s, window.table_mm_per_s)
        {
            let direction = sign(table_mm_per_s);
            let table_change = table_mm_per_s - window.table_mm_per_s;
            let share = self.z.table_mass_share;
            let change = share * table_change + (1.0 - share) * (motor_mm_per_s - window.motor_mm_per_s);
            self.force_n.of(direction).add(window.force_n / periods - self.z.inertia_n(change / length_s));
            if self.motor_tells && self.two_encoders {
                let (_, friction_n) = self.weight_and_friction_n();
                let table_n = self.z.table_friction_share * friction_n;
                self.screw.add(&self.z, table_n, direction, table_change / length_s, window.twist_mm / periods);
            }
        }
    }

    /// The limit shows itself only while the drive stands at it, and tells its torque.
    fn limit(&mut self, feedback: &Feedback, spindle_rev_per_s: f64) {
        let Some(torque_nm) = feedback.spindle_torque_nm.filter(|_| feedback.torque_saturated()) else {
            self.saturated_periods = 0;
            return;
        };
        self.saturated_periods += 1;
        if self.saturated_periods >= LIMIT_PERIODS {
            let curve_nm = self.motor.curve.torque_nm(rpm_from_rev_per_s(spindle_rev_per_s.abs()));
            let ratio = (torque_nm.abs() / curve_nm).max(RATIO.0).min(1.0);
            self.limit_ratio += LIMIT_SHARE * (ratio - self.limit_ratio);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Identified;
    use crate::control::machine::Machine;

    #[test]
    fn motor_that_leads_downwards_pushes_into_the_hole() {
        let nominal = Identified::nominal(&Machine::reference());
        let known = Identified { z_lost_motion_mm: 0.008, z_twist_middle_mm: Some(0.5), ..nominal };
        for (twist_mm, side) in [(0.496, 1.0), (0.5, 0.0), (0.502, -0.5)] {
            assert!((known.z_side(twist_mm).unwrap() - side).abs() < 1e-9);
        }
        assert_eq!(nominal.z_side(0.0), None);
    }

    /// 0/0 here would be a setpoint that is no number.
    #[test]
    fn without_lost_motion_there_are_no_sides() {
        let nominal = Identified::nominal(&Machine::reference());
        let stiff = Identified { z_lost_motion_mm: 0.0, z_twist_middle_mm: Some(0.5), ..nominal };
        assert_eq!((stiff.z_side(0.5), stiff.z_side(0.4)), (None, None));
    }
}
