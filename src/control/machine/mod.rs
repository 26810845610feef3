//! What the control knows of the machine: checked once, after which nothing re-checks.

mod check;
mod fingerprint;
mod law;
mod law_spec;
mod reference;
mod spec;
mod strokes;
mod supervision_limits;
mod supervision_rules;
mod sync_rules;
mod warnings;

pub use check::{MachineError, MachineFault, MachineWarning, MachineWarningKind};
pub use law::Law;
pub use law_spec::{
    BandSpec, ImprovedSCurveLawSpec, LawSpec, LinearLawSpec, Ramp, SCurveLawSpec, TorqueCurveLawSpec,
    TorqueCurveSmoothLawSpec, TrapezoidJerkLawSpec,
};
pub use spec::{
    AxisSpec, ControlSpec, DriveSpec, MachineSpec, SpindleEncoderAt, SpindleSpec, SupervisionSpec, SyncSpec, Takes,
    TapSpec, ToleranceSpec, ZEncoderAt, ZSpec,
};

pub use supervision_limits::{LongestStop, SupervisionLimits};

use crate::control::math::list::copied;
use crate::control::motor::{Friction, Motor, TorqueCurve};
use crate::control::profile::{
    ImprovedSCurveLaw, LinearLaw, MAX_BANDS, SCurveLaw, SpeedBand, TorqueCurveLaw, TorqueCurveSmoothLaw,
    TorqueLimitLaw, TrapezoidJerkLaw,
};
use crate::control::thread::StandardThread;
use crate::control::units::rev_per_s_from_rpm;

/// A checked machine: its data, and what follows from them in base units.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    spec: MachineSpec,
    motor: Motor,
    torque_curve: TorqueCurveLaw,
    s_curve: SCurveLaw,
    linear: LinearLaw,
    torque_limit: TorqueLimitLaw,
    torque_curve_smooth: TorqueCurveSmoothLaw,
    trapezoid_jerk: TrapezoidJerkLaw,
    improved_s_curve: ImprovedSCurveLaw,
    fingerprint: u64,
    motion_fingerprint: u64,
    tap_fingerprint: u64,
}

impl Machine {
    /// Checks the data, each by itself and against the others.
    ///
    /// # Errors
    /// The first fault in the order of the file's tables, see [`MachineError`]; [`MachineSpec::faults`] lists all.
    ///
    /// ```
    /// use rigidtap::control::machine::{Machine, MachineSpec};
    /// let mut spec = MachineSpec::reference();
    /// spec.spindle.max_rpm = -1.0;
    /// assert_eq!(Machine::check(spec).unwrap_err().key, "spindle.max_rpm");
    /// ```
    pub fn check(spec: MachineSpec) -> Result<Self, MachineError> {
        let mut first = None;
        spec.faults(&mut |fault| first = first.or(Some(fault)));
        first.map_or_else(|| Ok(Self::derive(spec)), Err)
    }

    /// The machine of data that have no faults.
    fn derive(spec: MachineSpec) -> Self {
        let law = &spec.law;
        let motor = Motor {
            curve: TorqueCurve::of_checked(copied(&spec.spindle.torque_curve)),
            inertia_kg_m2: spec.spindle.inertia_kg_m2,
        };
        let friction =
            Friction { coulomb_nm: spec.spindle.coulomb_nm, viscous_nm_per_rpm: spec.spindle.viscous_nm_per_rpm };
        let smooth_jerk = rev_per_s_from_rpm(law.torque_curve_smooth.jerk_rpm_per_s2);
        Self {
            torque_limit: TorqueLimitLaw::new(&motor, friction, law.motor_share),
            torque_curve_smooth: TorqueCurveSmoothLaw::new(&motor, law.motor_share, smooth_jerk),
            motor,
            torque_curve: TorqueCurveLaw {
                start_rev_per_s: rev_per_s_from_rpm(law.torque_curve.start_rpm),
                end_rev_per_s: rev_per_s_from_rpm(law.torque_curve.end_rpm),
                bands: resolve_bands(&law.torque_curve),
            },
            s_curve: SCurveLaw {
                acceleration: rev_per_s_from_rpm(law.s_curve.accel_rpm_per_s),
                jerk: rev_per_s_from_rpm(law.s_curve.jerk_rpm_per_s2),
            },
            linear: LinearLaw { acceleration: rev_per_s_from_rpm(law.linear.accel_rpm_per_s) },
            trapezoid_jerk: TrapezoidJerkLaw {
                acceleration: rev_per_s_from_rpm(law.trapezoid_jerk.accel_rpm_per_s),
                jerk: rev_per_s_from_rpm(law.trapezoid_jerk.jerk_rpm_per_s2),
                snap: rev_per_s_from_rpm(law.trapezoid_jerk.snap_rpm_per_s3),
                quantised_s: law.trapezoid_jerk.quantised.then_some(spec.control.period_s),
            },
            improved_s_curve: ImprovedSCurveLaw {
                acceleration: rev_per_s_from_rpm(law.improved_s_curve.accel_rpm_per_s),
            },
            fingerprint: fingerprint::of_all(&spec),
            motion_fingerprint: fingerprint::of_motion(&spec),
            tap_fingerprint: fingerprint::of_tap(&spec),
            spec,
        }
    }

    /// A number that tells this machine's data from others': their CRC-64.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        self.fingerprint
    }

    /// The same of what moves and how it is synchronised: without time laws, limits of the supervision, tap and tolerance.
    #[must_use]
    pub fn motion_fingerprint(&self) -> u64 {
        self.motion_fingerprint
    }

    /// The same of tap and material.
    #[must_use]
    pub fn tap_fingerprint(&self) -> u64 {
        self.tap_fingerprint
    }

    /// The data it was made of.
    #[must_use]
    pub fn spec(&self) -> &MachineSpec {
        &self.spec
    }

    /// The spindle motor with the inertia it turns.
    #[must_use]
    pub fn motor(&self) -> &Motor {
        &self.motor
    }

    /// Law `torque-curve`, its bands resolved to accelerations.
    #[must_use]
    pub fn torque_curve(&self) -> &TorqueCurveLaw {
        &self.torque_curve
    }

    /// Law `s-curve`.
    #[must_use]
    pub fn s_curve(&self) -> &SCurveLaw {
        &self.s_curve
    }

    /// Law `linear`.
    #[must_use]
    pub fn linear(&self) -> &LinearLaw {
        &self.linear
    }

    /// Law `torque-limit` at the file's torque utilisation, with the spindle's friction.
    #[must_use]
    pub fn torque_limit(&self) -> &TorqueLimitLaw {
        &self.torque_limit
    }

    /// Law `torque-curve-smooth` at the file's torque utilisation.
    #[must_use]
    pub fn torque_curve_smooth(&self) -> &TorqueCurveSmoothLaw {
        &self.torque_curve_smooth
    }

    /// Law `trapezoid-jerk`.
    #[must_use]
    pub fn trapezoid_jerk(&self) -> &TrapezoidJerkLaw {
        &self.trapezoid_jerk
    }

    /// Law `improved-s-curve`.
    #[must_use]
    pub fn improved_s_curve(&self) -> &ImprovedSCurveLaw {
        &self.improved_s_curve
    }

    /// The same machine with one change to its data, checked again.
    ///
    /// # Errors
    /// As [`Machine::check`].
    pub fn with(&self, change: impl FnOnce(&mut MachineSpec)) -> Result<Self, MachineError> {
        let mut spec = self.spec.clone();
        change(&mut spec);
        Self::check(spec)
    }

    /// The same machine with `law.motor_share` changed: what the laws that follow the motor plan with. `torque-curve`'s
    /// bands stay as they are, since they are tuned outside the core.
    ///
    /// # Errors
    /// [`MachineFault::OutOfRange`] unless 0.01 ≤ share ≤ 1.
    pub fn with_motor_share(&self, share: f64) -> Result<Self, MachineError> {
        self.with(|spec| spec.law.motor_share = share)
    }

    /// Major and tap-drill diameter for a pitch in mm: the file's, else those of its usual size; none outside both.
    #[must_use]
    pub fn tap_size(&self, pitch_mm: f64) -> Option<(f64, f64)> {
        self.spec.tap.size(pitch_mm)
    }

    /// Greatest peak-to-peak synchronisation error of a pitch; none beyond the usual sizes unless the file gives one.
    #[must_use]
    pub fn sync_tolerance_um(&self, pitch_mm: f64) -> Option<f64> {
        self.spec.tolerance.error_um.or_else(|| StandardThread::by_pitch(pitch_mm).map(|size| size.sync_tolerance_um()))
    }
}

/// Accelerations of the bands, eq. 4 as errata.md corrects it: the first band is crossed from Vs (or Ve), the others
/// from the band below; where Vs lies above the first band, that band's constant counts from rest.
fn resolve_bands(law: &TorqueCurveLawSpec) -> arrayvec::ArrayVec<SpeedBand, MAX_BANDS> {
    let first_top = law.bands.first().map_or(0.0, |band| band.to_rpm);
    let from_first = |rpm: f64| if rpm < first_top { rpm } else { 0.0 };
    let mut below = (from_first(law.start_rpm), from_first(law.end_rpm));
    let mut out = arrayvec::ArrayVec::new();
    for band in &law.bands {
        let (accel, decel) = match band.ramp {
            Ramp::Time { accel_s, decel_s } => ((band.to_rpm - below.0) / accel_s, (band.to_rpm - below.1) / decel_s),
            Ramp::Rate { accel_rpm_per_s, decel_rpm_per_s } => (accel_rpm_per_s, decel_rpm_per_s),
        };
        below = (band.to_rpm, band.to_rpm);
        let band = SpeedBand {
            to_rev_per_s: rev_per_s_from_rpm(band.to_rpm),
            accel_rev_per_s2: rev_per_s_from_rpm(accel),
            decel_rev_per_s2: rev_per_s_from_rpm(decel),
        };
        // The same capacity as the file's list, so this cannot fail.
        let _ = out.try_push(band);
    }
    out
}
