//! `tune`: speed bands, or the dry cycle's program.

use schemars::JsonSchema;
use serde::Serialize;

use crate::control::machine::Ramp;
use crate::study::Tuning;

/// The speed bands of torque-curve, tuned for the motor.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct TuneAnswer {
    /// From standstill up.
    bands: Vec<BandAnswer>,
    /// What other numbers of bands cost.
    prices: Vec<PriceAnswer>,
    /// Torque utilisation that the bands keep to.
    motor_share: f64,
    max_rpm: f64,
    /// Strokes that the bands are tuned for.
    strokes_rev: Vec<f64>,
    /// Points of [rpm, N·m] that a run-up showed; null without one.
    measured_torque_curve: Option<Vec<[f64; 2]>>,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct BandAnswer {
    /// Its upper end.
    to_rpm: f64,
    /// Time constant of speeding up.
    #[serde(skip_serializing_if = "Option::is_none")]
    accel_s: Option<f64>,
    /// Time constant of slowing down.
    #[serde(skip_serializing_if = "Option::is_none")]
    decel_s: Option<f64>,
    rate_rpm_per_s: f64,
    /// Torque asked at the band's upper end, over what the motor has there.
    motor_ratio_at_top: f64,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct PriceAnswer {
    /// Number of bands.
    bands: usize,
    /// Mean stroke time over the minimum at the same torque utilisation.
    stroke_over_bound: f64,
}

/// The program that identifies a machine.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct DryCycleAnswer {
    /// G-code, dialect `paper`.
    pub program: String,
}

impl From<&Tuning> for TuneAnswer {
    fn from(tuning: &Tuning) -> Self {
        let bands = tuning.best.bands.iter().zip(&tuning.specs).map(|(band, spec)| {
            let (accel_s, decel_s) = match spec.ramp {
                Ramp::Time { accel_s, decel_s } => (Some(accel_s), Some(decel_s)),
                Ramp::Rate { .. } => (None, None),
            };
            BandAnswer {
                to_rpm: band.to_rpm,
                accel_s,
                decel_s,
                rate_rpm_per_s: band.rate_rpm_per_s,
                motor_ratio_at_top: band.motor_ratio_at_top,
            }
        });
        let prices = (1..).zip(&tuning.prices);
        let measured = tuning.measured.as_ref();
        Self {
            bands: bands.collect(),
            prices: prices.map(|(bands, price)| PriceAnswer { bands, stroke_over_bound: *price }).collect(),
            motor_share: tuning.motor_share,
            max_rpm: tuning.max_rpm,
            strokes_rev: tuning.strokes_rev.clone(),
            measured_torque_curve: measured
                .map(|curve| curve.points().iter().map(|point| [point.speed_rpm, point.torque_nm]).collect()),
        }
    }
}
