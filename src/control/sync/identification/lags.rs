//! The fits of both drives where they take positions alone: in place of those of drives that follow without a lag.

use crate::control::machine::{Machine, Takes};
use crate::control::model::closed_loop::ClosedLoop;
use crate::control::sync::frame::{Commanded, Measured};
use crate::control::sync::plant_model::{IdentifiedDrives, IdentifiedLatency};

use super::lag_fit::{LagAges, LagFit, LagSample};
use super::tracking_fit::{Tracking, TrackingSpec};

/// None of a drive that takes more than a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lags {
    spindle: Option<LagFit>,
    z: Option<LagFit>,
    /// The load's share of Z's mass.
    load_share: f64,
}

impl Lags {
    pub(super) fn new(machine: &Machine, spindle: TrackingSpec, z: TrackingSpec) -> Self {
        let spec = machine.spec();
        let drive = &spec.drive;
        let fit = |takes: Takes, tracking: TrackingSpec, torque_lag_s: f64| {
            let ages = LagAges {
                sample_s: drive.encoder_latency_s,
                velocity_s: tracking.velocity_age_s,
                effort_s: torque_lag_s + 0.5 * drive.period_s,
            };
            (takes == Takes::Position).then(|| LagFit::new(tracking, ages))
        };
        Self {
            spindle: fit(drive.spindle_takes, spindle, spec.spindle.torque_lag_s),
            z: fit(drive.z_takes, z, spec.z_axis.torque_lag_s),
            load_share: spec.z_axis.table_share,
        }
    }

    /// What was commanded of the spindle for a period, and measured at its start; false where its drive is none of these.
    pub(super) fn note_spindle(&mut self, commanded: &Commanded, measured: &Measured) -> bool {
        let Some(fit) = &mut self.spindle else { return false };
        let position = measured.spindle_rev;
        let sample = LagSample { position, motor: position, mass: position, friction_ratio: None };
        fit.add(commanded.spindle.position, sample, measured.torque_saturated);
        true
    }

    /// The same of Z, with its friction over Coulomb's.
    pub(super) fn note_z(&mut self, commanded: &Commanded, measured: &Measured, friction_ratio: f64) -> bool {
        let Some(fit) = &mut self.z else { return false };
        let position = measured.load_mm;
        let motor = measured.motor_mm.unwrap_or(position);
        let mass = motor + self.load_share * (position - motor);
        let sample = LagSample { position, motor, mass, friction_ratio: Some(friction_ratio) };
        fit.add(commanded.z.position, sample, measured.force_saturated);
        true
    }

    /// How the spindle follows, for the latency that is thought to be without the fit.
    pub(super) fn of_spindle(&self, prior_s: f64) -> Option<Tracking> {
        self.spindle.as_ref().map(|fit| fit.identified(prior_s).0)
    }

    /// The same of Z.
    pub(super) fn of_z(&self, prior_s: f64) -> Option<Tracking> {
        self.z.as_ref().map(|fit| fit.identified(prior_s).0)
    }

    /// The loops of both drives, for how late they were found to act and a spindle's inertia over the file's; as the file says
    /// where they are not fitted.
    pub(super) fn drives(
        &self,
        file: &IdentifiedDrives,
        latency: &IdentifiedLatency,
        inertia_ratio: f64,
    ) -> IdentifiedDrives {
        let found = |fit: &Option<LagFit>, prior_s: f64| fit.as_ref().map(|fit| fit.identified(prior_s).1);
        let of_spindle = found(&self.spindle, latency.spindle_s)
            .map(|loops| ClosedLoop { velocity_gain_per_s: loops.velocity_gain_per_s * inertia_ratio, ..loops });
        IdentifiedDrives {
            spindle: of_spindle.unwrap_or(file.spindle),
            z: found(&self.z, latency.z_s).unwrap_or(file.z),
        }
    }

    /// Periods have passed unseen.
    pub(super) fn note_gap(&mut self) {
        self.fits().for_each(LagFit::note_gap);
    }

    /// A hole begins.
    pub(super) fn begin_hole(&mut self, kept: f64) {
        self.fits().for_each(|fit| fit.begin_hole(kept));
    }

    fn fits(&mut self) -> impl Iterator<Item = &mut LagFit> {
        self.spindle.iter_mut().chain(&mut self.z)
    }
}
