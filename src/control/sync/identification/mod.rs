//! What is measured of the plant while it moves: in the program's approach, in a dry cycle, in each hole.
//!
//! Momentum balances over short windows: what the drives gave, less what the changes of speed took. Between neighbouring
//! windows the noise of the speeds cancels, so sums are far better than any single window. The fits are solved where their
//! results are used.

mod friction;
mod gain_fit;
#[cfg(test)]
mod identification_tests;
mod inertia;
mod lag_fit;
mod lags;
mod pitch_error;
pub(super) mod restart;
mod screw;
mod tap_kind;
mod tracking_fit;
mod tracking_specs;
mod window;

use crate::control::cycle::CyclePlan;
use crate::control::machine::{Machine, Takes};
use crate::control::math::round;
use crate::control::model::friction::preslide_one_way;

use self::friction::{Forces, FrictionFit, SlidingWindow};
use self::gain_fit::GainFit;
use self::inertia::InertiaFit;
use self::lags::Lags;
use self::pitch_error::PitchErrorFit;
use self::screw::{DeflectionWindow, Known, ScrewFit};
use self::tap_kind::TapKind;
use self::tracking_fit::{AxisSample, Tracking, TrackingFit};
use self::tracking_specs::tracking_specs;
use self::window::{Speeds, Window};
use super::frame::{Commanded, Measured, sees_deflection};
use super::plant_model::{
    AxialForce, Cut, Identified, IdentifiedLatency, IdentifiedSpindle, IdentifiedZ, PitchError, ZModel,
};

/// Errors of the latency fits themselves, in periods: of the spindle's; of Z's beside the spindle's, where friction, backlash and
/// screw shape how it follows more than the bus does; of Z's where the spindle's motor was at its limit; of the spindle's then.
const SPINDLE_PERIODS: f64 = 0.003;
const Z_PERIODS: f64 = 0.08;
const Z_ALONE_PERIODS: f64 = 0.03;
const SATURATED_PERIODS: f64 = 0.15;
/// Share of older values' weight that each new hole leaves.
const KEPT_BY_HOLE: f64 = 0.7;
/// Length of a window: long against the noise of a speed, short against a stroke.
const WINDOW_S: f64 = 0.016;
/// Greatest friction of Z, as a share of its force.
const FRICTION_SHARE: f64 = 0.5;
/// Greatest lost motion that is believed.
const LOST_MOTION_MAX_MM: f64 = 0.05;

/// Gathers what is measured, over holes and between them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Identification {
    z: ZModel,
    nominal: Identified,
    /// As it was found before a restart; without one what the file says.
    latency_before: IdentifiedLatency,
    pitch_before: PitchError,
    greatest_friction_n: f64,
    period_s: f64,
    window_periods: u32,
    /// Whether load and motor of Z have an encoder each.
    two_encoders: bool,
    last: Option<Measured>,
    window: Option<Window>,
    spindle: InertiaFit,
    friction: FrictionFit,
    /// The tap that cut last.
    tap: TapKind,
    /// Where the tap of the hole under way cuts.
    cut: Option<Cut>,
    screw: ScrewFit,
    pitch_fit: PitchErrorFit,
    /// Found before this hole.
    pitch_error: PitchError,
    /// No hole has begun since Z moved last.
    approaches: bool,
    /// Pre-sliding state of Z's friction, −1…1, from the load's travel.
    contact: f64,
    /// What is left of the one at first, which is not known, over it.
    start_contact: f64,
    /// Friction over Coulomb's and Z's force feedforward when commands were first seen after a gap or a hole.
    rest: Option<[f64; 2]>,
    /// What Z was commanded a period ago, which acts about now.
    acting_mm_per_s2: f64,
    load_mm_per_s: f64,
    /// Z's drive has reported its force.
    reports_force: bool,
    /// The next window of a sliding load follows the last.
    window_follows: bool,
    spindle_tracking: TrackingFit,
    z_tracking: GainFit,
    /// In their place where a drive takes positions alone: it lags behind them by its gains.
    lags: Lags,
    /// Whether the spindle has a position to be compared with.
    spindle_has_position: bool,
}

impl Identification {
    /// Nothing measured yet.
    pub(super) fn new(machine: &Machine) -> Self {
        let spec = machine.spec();
        let period_s = spec.control.period_s;
        let z = ZModel::new(machine);
        let [spindle_spec, z_spec] = tracking_specs(machine, &z);
        Self {
            z,
            nominal: Identified::nominal(machine),
            latency_before: IdentifiedLatency::nominal(machine),
            pitch_before: PitchError::NONE,
            greatest_friction_n: FRICTION_SHARE * spec.z_axis.force_limit_n,
            period_s,
            window_periods: round(WINDOW_S / period_s).max(2.0) as u32,
            two_encoders: sees_deflection(machine),
            last: None,
            window: None,
            spindle: InertiaFit::new(machine),
            friction: FrictionFit::new(machine),
            tap: TapKind::default(),
            cut: None,
            screw: ScrewFit::default(),
            pitch_fit: PitchErrorFit::default(),
            pitch_error: PitchError::NONE,
            approaches: false,
            contact: 0.0,
            start_contact: 1.0,
            rest: None,
            acting_mm_per_s2: 0.0,
            load_mm_per_s: 0.0,
            reports_force: false,
            window_follows: false,
            spindle_tracking: TrackingFit::new(spindle_spec),
            z_tracking: GainFit::new(z_spec),
            lags: Lags::new(machine, spindle_spec, z_spec),
            spindle_has_position: spec.drive.spindle_takes != Takes::Speed,
        }
    }

    /// What the machine's file says.
    pub(super) fn nominal(&self) -> Identified {
        self.nominal
    }

    /// What is known by now: what was measured, as far as it was, else what the file says.
    pub(super) fn identified(&self) -> Identified {
        let [of_spindle, of_z] = self.trackings();
        let spindle = self.spindle.identified_as(of_spindle.inertia_ratio);
        let latency = IdentifiedLatency { spindle_s: of_spindle.latency_s, z_s: of_z.latency_s };
        let drives = self.lags.drives(&self.nominal.drives, &latency, spindle.inertia_ratio);
        Identified { spindle, z: self.z(&of_z), latency, drives }
    }

    /// The same of the spindle alone.
    pub(super) fn spindle(&self) -> IdentifiedSpindle {
        self.spindle.identified()
    }

    /// How spindle and Z follow. Both drives hang on one bus, so that what one shows is what the other is thought to have: the
    /// spindle's first, but where its motor was at its limit.
    fn trackings(&self) -> [Tracking; 2] {
        let IdentifiedLatency { spindle_s, z_s } = self.latency_before;
        let of_spindle = |prior_s: f64, own_periods: f64| {
            let lags = self.lags.of_spindle(prior_s);
            lags.unwrap_or_else(|| self.spindle_tracking.identified(prior_s, own_periods))
        };
        let of_z = |prior_s: f64, own_periods: f64| {
            let lags = self.lags.of_z(prior_s);
            lags.unwrap_or_else(|| self.z_tracking.identified(prior_s, own_periods))
        };
        if self.spindle_tracking.was_saturated() {
            let of_z = of_z(z_s, Z_ALONE_PERIODS);
            return [of_spindle(of_z.latency_s, SATURATED_PERIODS), of_z];
        }
        let of_spindle = of_spindle(spindle_s, SPINDLE_PERIODS);
        [of_spindle, of_z(of_spindle.latency_s, Z_PERIODS)]
    }

    /// Z's friction and weight: by its drive's force, and by how it follows where the drive reports none.
    fn forces(&self, tracking: &Tracking) -> Forces {
        if self.reports_force {
            return self.friction.identified();
        }
        Forces {
            axial: self.nominal.z.axial,
            weight_n: 0.0,
            friction_n: self.z.inertia_n(tracking.coulomb),
            viscous_n_s_per_mm: self.z.inertia_n(tracking.viscous_per_s),
        }
    }

    fn known(&self, forces: Forces) -> Known<'_> {
        Known { model: &self.z, forces, pitch_error: self.pitch_error }
    }

    fn z(&self, tracking: &Tracking) -> IdentifiedZ {
        let forces = self.forces(tracking);
        let friction_n = forces.friction_n.min(self.greatest_friction_n);
        let screw = self.screw.identified(&self.known(forces));
        let lost_motion_mm = screw.backlash_mm + screw.compliance_ratio * self.z.friction_deflection_mm(friction_n);
        IdentifiedZ {
            friction_n,
            weight_n: forces.weight_n,
            viscous_n_s_per_mm: forces.viscous_n_s_per_mm,
            lost_motion_mm: lost_motion_mm.clamp(0.0, LOST_MOTION_MAX_MM),
            compliance_ratio: screw.compliance_ratio,
            deflection_middle_mm: screw.middle_mm,
            pitch_error: self.pitch_error,
            axial: forces.axial,
        }
    }

    /// The friction that holds a Z at rest, N, positive where the drive pushes into the hole. Without weight it is what the
    /// drive gives; a drive that reports no force is taken to give it.
    pub(super) fn resting_friction_n(&self, friction_n: f64) -> f64 {
        friction_n * self.z.contact.level(0.0) * self.contact
    }

    /// A hole is to begin, R being at a place of Z's encoder: another tap draws otherwise.
    pub(super) fn note_tap(&mut self, plan: &CyclePlan, r_plane_mm: f64) {
        let tap = TapKind::of(plan);
        if core::mem::replace(&mut self.tap, tap) != tap {
            self.friction.forget_axial();
        }
        self.cut = Some(Cut::of(plan, r_plane_mm));
    }

    /// A hole begins: what older ones showed counts less.
    pub(super) fn begin_hole(&mut self) {
        self.spindle.decay(KEPT_BY_HOLE);
        let [of_spindle, of_z] = self.trackings();
        self.spindle.note_tracked(of_spindle.inertia_ratio);
        let known = Known { model: &self.z, forces: self.forces(&of_z), pitch_error: self.pitch_error };
        self.screw.decay(&known, KEPT_BY_HOLE);
        self.approaches = false;
        self.window_follows = false;
        self.friction.decay(KEPT_BY_HOLE);
        self.spindle_tracking.begin_hole(KEPT_BY_HOLE);
        self.z_tracking.begin_hole(KEPT_BY_HOLE);
        self.rest = None;
        self.lags.begin_hole(KEPT_BY_HOLE);
    }

    /// The next period is not measured against the last.
    pub(super) fn note_gap(&mut self) {
        (self.last, self.window) = (None, None);
        self.window_follows = false;
        self.spindle_tracking.note_gap();
        self.z_tracking.note_gap();
        self.pitch_fit.note_gap();
        self.rest = None;
        self.lags.note_gap();
    }

    /// One period between holes, before [`Identification::observe`].
    pub(super) fn observe_approach(&mut self, now: &Measured) {
        self.cut = None;
        if let Some(deflection_mm) = now.deflection_mm().filter(|_| self.two_encoders) {
            self.approaches = true;
            self.pitch_fit.add(&self.z, self.period_s, now.load_mm, deflection_mm);
        }
    }

    /// What was commanded for the period that was observed last, between holes.
    pub(super) fn note_commanded(&mut self, commanded: &Commanded) {
        let Some(last) = &self.last else { return };
        let of_spindle = AxisSample {
            position: last.spindle_rev,
            deflection: None,
            friction_ratio: None,
            start_ratio: 0.0,
            fed: 0.0,
            saturated: last.torque_saturated,
        };
        if !self.lags.note_spindle(commanded, last) && self.spindle_has_position {
            self.spindle_tracking.add(&commanded.spindle, &of_spindle);
        }
        // Drives hold what friction gives at rest, so that its change is what disturbs them.
        let level = self.z.contact.level(self.load_mm_per_s);
        let [rest_ratio, rest_force_n] = *self.rest.get_or_insert([self.contact * level, commanded.z_force_n]);
        let by_model_mm = self.z.deflection_mm(self.contact * level, self.acting_mm_per_s2);
        self.acting_mm_per_s2 = commanded.z.acceleration;
        let of_z = AxisSample {
            position: last.load_mm,
            deflection: self.two_encoders.then(|| last.deflection_mm().unwrap_or(by_model_mm)),
            friction_ratio: Some(self.contact * level - rest_ratio),
            start_ratio: self.start_contact * level - self.z.contact.level(0.0),
            fed: (commanded.z_force_n - rest_force_n) / self.z.inertia_n(1.0),
            saturated: last.force_saturated,
        };
        if !self.lags.note_z(commanded, last, self.contact * level) {
            self.z_tracking.add(&commanded.z, &of_z, self.reports_force);
        }
    }

    /// One period.
    pub(super) fn observe(&mut self, now: &Measured) {
        if self.last.is_some_and(|last| last.motor_mm.is_some() != now.motor_mm.is_some()) {
            self.note_gap();
        }
        let Some(last) = self.last.replace(*now) else { return };
        let travel_ratio = (now.load_mm - last.load_mm) / self.z.contact.presliding;
        let end = preslide_one_way(0.0, travel_ratio);
        self.contact = preslide_one_way(self.contact, travel_ratio);
        self.start_contact *= 1.0 - end.abs();
        self.load_mm_per_s = (now.load_mm - last.load_mm) / self.period_s;
        self.reports_force |= now.z_force_n.is_some();
        let rate = |now: f64, then: f64| (now - then) / self.period_s;
        let motor_mm = |measured: &Measured| measured.motor_mm.unwrap_or(measured.load_mm);
        let speeds = Speeds {
            spindle_rev_per_s: rate(now.spindle_rev, last.spindle_rev),
            load_mm_per_s: rate(now.load_mm, last.load_mm),
            motor_mm_per_s: rate(motor_mm(now), motor_mm(&last)),
        };
        self.spindle.observe_limit(now.spindle_torque_nm, now.torque_saturated, speeds.spindle_rev_per_s);
        let friction_nm = self.spindle.friction_nm(speeds.spindle_rev_per_s);
        let opened = Window::opened(now, speeds, friction_nm);
        let Some(mut window) = self.window else {
            self.window = Some(opened);
            return;
        };
        let ends = window.periods + 1 >= self.window_periods;
        window.add(now, friction_nm, ends);
        if ends {
            self.window = Some(opened);
            self.close(&window, &speeds, now.z_force_n, now.load_mm);
        } else {
            self.window = Some(window);
        }
    }

    fn close(&mut self, window: &Window, last: &Speeds, last_force_n: Option<f64>, to_mm: f64) {
        // A hole under way has no time for it.
        if self.approaches {
            let found = self.pitch_fit.identified();
            self.pitch_error = if found == PitchError::NONE { self.pitch_before } else { found };
        }
        let (first, periods) = (&window.first, f64::from(window.periods));
        let length_s = periods * self.period_s;
        let at_limit_nm = || self.spindle.torque_at_limit_nm(first.spindle_rev_per_s, last.spindle_rev_per_s);
        let torque_nm = window.torque_nm.or_else(|| window.saturated.then(|| periods * at_limit_nm()));
        if let Some(torque_nm) = torque_nm {
            let mean_nm = (torque_nm - window.friction_nm) / periods;
            self.spindle.add(first.spindle_rev_per_s, last.spindle_rev_per_s, length_s, mean_nm);
        }
        let sliding = |speed: f64| speed.abs() > self.z.sliding_mm_per_s();
        let one_way = first.load_mm_per_s * last.load_mm_per_s > 0.0;
        if !(sliding(first.load_mm_per_s) && sliding(last.load_mm_per_s) && one_way) {
            return;
        }
        let direction = 1f64.copysign(last.load_mm_per_s);
        let load_change = last.load_mm_per_s - first.load_mm_per_s;
        let share = self.z.load_mass_share;
        let change = share * load_change + (1.0 - share) * (last.motor_mm_per_s - first.motor_mm_per_s);
        let speed_mm_per_s = 0.5 * (first.load_mm_per_s + last.load_mm_per_s);
        let engagement = self.cut.map_or(0.0, |cut| cut.engagement_at(0.5 * (window.from_mm + to_mm)));
        let slid = window.force_n.map(|force_n| SlidingWindow {
            direction,
            speed_mm_per_s,
            engagement,
            force_n: force_n / periods,
            inertia_n: self.z.inertia_n(change / length_s),
            rate_n_per_s: window
                .first_force_n
                .zip(last_force_n)
                .map_or(0.0, |(first_n, last_n)| (last_n - first_n) / length_s),
        });
        if let Some(slid) = slid {
            self.friction.add(&slid);
        }
        if let Some(deflection_mm) = window.deflection_mm.filter(|_| self.two_encoders) {
            let [_, of_z] = self.trackings();
            let forces = self.forces(&of_z);
            // What the tap does to the screw's force is no property of the screw.
            if engagement > 0.0 && forces.axial != AxialForce::default() {
                self.window_follows = false;
                return;
            }
            let known = Known { model: &self.z, forces, pitch_error: self.pitch_error };
            let slid = DeflectionWindow {
                direction,
                speed_mm_per_s,
                rate_mm_per_s2: load_change / length_s,
                deflection_mm: deflection_mm / periods,
                from_mm: window.from_mm,
                to_mm,
                follows: core::mem::replace(&mut self.window_follows, true),
            };
            self.screw.add(&known, slid);
        }
    }
}
