//! The limits of one hole's supervision: from the machine, by the rules of [`SupervisionSpec`], and the hole's plan.

use crate::control::cycle::CyclePlan;
use crate::control::machine::{Machine, SupervisionLimits, Takes};
use crate::control::model::closed_loop::ClosedLoop;
use crate::control::model::drive_response::DriveResponse;
use crate::control::units::{m_from_mm, mm_from_um, rev_per_s_from_rpm};

use super::alarm::Axis;
use super::bounds::AxisBounds;
use super::followed_stop::StopConfig;
use super::following::FollowingLimits;
use super::sample::AxisLimits;
use super::travel::TravelLimits;

/// Torque and friction together brake harder than the motor alone.
const BRAKING_SHARE: f64 = 1.25;
/// A drive may report more than its file's limit: its own constant is another.
const EFFORT_SHARE: f64 = 1.5;
/// Friction may be twice the file's.
const FRICTION_SHARE: f64 = 2.0;
/// By how much the gains of a drive that takes positions alone may be off, as a ratio: it lags by speed over gain.
const GAIN_SHARE: f64 = 0.2;
/// Of the tracking limit, what the spindle's friction may withhold.
const HELD_SHARE: f64 = 0.01;

/// What is the same for every period of a hole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HoleLimits {
    pub(super) period_s: f64,
    pub(super) bridge_periods: u32,
    /// Periods from a setpoint to the sample that shows it.
    pub(super) delay_periods: f64,
    /// Periods from a setpoint to the drive that acts on it.
    pub(super) latency_periods: f64,
    pub(super) error_um: f64,
    pub(super) torque_nm: f64,
    pub(super) force_n: f64,
    pub(super) spindle: AxisLimits,
    pub(super) z: AxisLimits,
    pub(super) following: FollowingLimits,
    pub(super) spindle_travel: TravelLimits,
    pub(super) z_travel: TravelLimits,
    pub(super) spindle_bounds: AxisBounds,
    pub(super) z_bounds: AxisBounds,
    /// How drives answer to what they are sent, where that is not the commanded motion: spindle and Z.
    pub(super) responses: [DriveResponse; 2],
    pub(super) stop: StopConfig,
}

impl HoleLimits {
    /// Of drives that are sent the commanded motion as it is, or what makes them move so.
    pub(super) fn new(machine: &Machine, plan: &CyclePlan, by_model: bool) -> Self {
        let (spec, cycle) = (machine.spec(), plan.cycle());
        let SupervisionLimits { bridge_periods, error_um, spindle_rev, z_um, scale_ratio, bottom_clearance_mm } =
            machine.supervision(cycle.pitch_mm);
        let (drive, z_axis, period_s) = (&spec.drive, &spec.z_axis, spec.control.period_s);
        let motor = machine.motor();
        let rated_nm = motor.curve.points().iter().map(|point| point.torque_nm).fold(0.0, f64::max);
        let full_rev_per_s2 = motor.acceleration_rev_per_s2(0.0, 1.0);
        let static_n = FRICTION_SHARE * z_axis.static_ratio * z_axis.coulomb_n;
        let stiffness_n_per_mm = z_axis.mass_kg * m_from_mm(drive.z_position_gain_per_s * drive.z_velocity_gain_per_s);
        let z_mm_per_s2 = z_axis.force_limit_n / z_axis.mass_kg / m_from_mm(1.0);
        let (spindle_loops, z_loops) = (ClosedLoop::of_spindle(drive), ClosedLoop::of_z(drive));
        let taken = |takes: Takes| if by_model { Takes::Torque } else { takes };
        let takes_speed = drive.spindle_takes == Takes::Speed;
        // A frequency converter's torque is some periods late; what is seen of a servo drive's is under one.
        let converter_s = if takes_speed { spec.spindle.torque_lag_s } else { 0.0 };
        let axis = |axis: Axis, counts_per_unit: f64, acceleration: f64, held: f64| AxisLimits {
            axis,
            counts_per_unit,
            acceleration,
            held,
            bridge_periods,
            period_s,
        };
        Self {
            period_s,
            bridge_periods,
            delay_periods: drive.latency_periods + (drive.encoder_latency_s + converter_s) / period_s,
            latency_periods: drive.latency_periods,
            error_um,
            torque_nm: EFFORT_SHARE * rated_nm,
            force_n: EFFORT_SHARE * z_axis.force_limit_n,
            spindle: axis(
                Axis::Spindle,
                spec.spindle.encoder_counts_per_rev,
                full_rev_per_s2,
                HELD_SHARE * spindle_rev,
            ),
            z: axis(
                Axis::Z,
                z_axis.encoder_counts_per_mm,
                z_mm_per_s2,
                static_n / stiffness_n_per_mm + mm_from_um(z_axis.backlash_um),
            ),
            following: FollowingLimits {
                motor: motor.clone(),
                coulomb_nm: spec.spindle.coulomb_nm,
                // Nothing holds the angle of a spindle that takes a speed alone: that it does not turn as told is a jam.
                spindle_rev: if takes_speed { f64::INFINITY } else { spindle_rev },
                z_mm: mm_from_um(z_um),
                position_gain_per_s: if takes_speed { 0.0 } else { drive.spindle_position_gain_per_s },
                velocity_gain_per_s: drive.spindle_velocity_gain_per_s,
                delay_s: match drive.spindle_takes {
                    Takes::Position => period_s + GAIN_SHARE / drive.spindle_position_gain_per_s,
                    _ => period_s,
                },
                count_rev: 1.0 / spec.spindle.encoder_counts_per_rev,
                period_s,
            },
            spindle_travel: TravelLimits {
                axis: Axis::Spindle,
                whole: 1.0,
                scale_ratio,
                tracking: spindle_rev,
                period_s,
            },
            z_travel: TravelLimits {
                axis: Axis::Z,
                whole: cycle.pitch_mm,
                scale_ratio,
                tracking: mm_from_um(z_um),
                period_s,
            },
            spindle_bounds: AxisBounds {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
                speed: rev_per_s_from_rpm(spec.spindle.max_rpm),
                acceleration: BRAKING_SHARE * full_rev_per_s2,
            },
            z_bounds: AxisBounds {
                low: cycle.bottom_mm - bottom_clearance_mm,
                high: cycle.r_plane_mm + bottom_clearance_mm,
                speed: spec.z.max_mm_per_s,
                acceleration: spec.z.max_mm_per_s2,
            },
            responses: [
                DriveResponse::new(taken(drive.spindle_takes), spindle_loops, full_rev_per_s2, period_s),
                DriveResponse::new(taken(drive.z_takes), z_loops, z_mm_per_s2, period_s),
            ],
            stop: StopConfig {
                motor: motor.clone(),
                position_gain_per_s: if takes_speed { 0.0 } else { drive.spindle_position_gain_per_s },
                velocity_gain_per_s: drive.spindle_velocity_gain_per_s,
                counts_per_rev: spec.spindle.encoder_counts_per_rev,
                pitch_mm: cycle.pitch_mm,
                period_s,
                horizon_s: drive.latency_periods * period_s,
            },
        }
    }
}
