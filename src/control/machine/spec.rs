//! The machine's data as an engineer writes them: the machine file's tables, in its units.
//!
//! A [`MachineSpec`] may hold anything; [`Machine::check`](super::Machine::check) makes a machine of it.

use arrayvec::ArrayVec;

use super::law_spec::LawSpec;
use crate::control::math::list::copied;
use crate::control::motor::{MAX_POINTS, TorquePoint};
use crate::control::thread::StandardThread;

/// All of a machine, table by table. Field names are the file's keys.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineSpec {
    /// `[control]`
    pub control: ControlSpec,
    /// `[spindle]`
    pub spindle: SpindleSpec,
    /// `[x]`
    pub x: AxisSpec,
    /// `[y]`
    pub y: AxisSpec,
    /// `[z]`, limits
    pub z: AxisSpec,
    /// `[z]`, mechanics and encoders
    pub z_axis: ZSpec,
    /// `[drive]`
    pub drive: DriveSpec,
    /// `[sync]`
    pub sync: SyncSpec,
    /// `[supervision]`
    pub supervision: SupervisionSpec,
    /// `[law]` and its tables
    pub law: LawSpec,
    /// `[tap]`
    pub tap: TapSpec,
    /// `[tolerance]`
    pub tolerance: ToleranceSpec,
}

/// `[control]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlSpec {
    /// Interpolation period T.
    pub period_s: f64,
}

/// Where the spindle's encoder sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleEncoderAt {
    /// On the motor shaft.
    Motor,
    /// At the tool.
    Tool,
}

/// Where Z's position encoder sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZEncoderAt {
    /// A linear scale at the table.
    Table,
    /// On the motor.
    Motor,
}

/// `[spindle]`
#[derive(Debug, PartialEq)]
pub struct SpindleSpec {
    /// Greatest speed.
    pub max_rpm: f64,
    /// Motor, shaft, chuck and tool together.
    pub inertia_kg_m2: f64,
    /// The tool's side of the torsional spring, part of the total.
    pub tool_inertia_kg_m2: f64,
    /// Torsional resonance, both sides free.
    pub resonance_hz: f64,
    /// Damping ratio of that resonance.
    pub damping_ratio: f64,
    /// Time constant of the current loop.
    pub torque_lag_s: f64,
    /// Coulomb friction.
    pub coulomb_nm: f64,
    /// Viscous friction.
    pub viscous_nm_per_rpm: f64,
    /// Amplitude of the torque ripple, as a share of the torque.
    pub torque_ripple: f64,
    /// Share of the power limit that the supply loses at full power.
    pub supply_sag_ratio: f64,
    /// Time constant of that loss.
    pub supply_sag_s: f64,
    /// Where the encoder sits.
    pub encoder_at: SpindleEncoderAt,
    /// Counts per revolution after multiplication.
    pub encoder_counts_per_rev: f64,
    /// Torque over speed; the last point reaches `max_rpm`.
    pub torque_curve: ArrayVec<TorquePoint, MAX_POINTS>,
}

impl Clone for SpindleSpec {
    fn clone(&self) -> Self {
        Self { torque_curve: copied(&self.torque_curve), ..*self }
    }
}

/// Limits of an axis: `[x]`, `[y]`, `[z]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSpec {
    /// Greatest speed.
    pub max_mm_per_s: f64,
    /// Greatest acceleration.
    pub max_mm_per_s2: f64,
    /// Greatest jerk.
    pub max_mm_per_s3: f64,
}

/// `[z]` beyond its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZSpec {
    /// Moving mass and the rotating parts' equivalent.
    pub mass_kg: f64,
    /// The table's side of the axial spring, as a share of the mass.
    pub table_share: f64,
    /// Axial resonance of the table with the motor's side held.
    pub resonance_hz: f64,
    /// Damping ratio of that resonance.
    pub damping_ratio: f64,
    /// Time constant of the current loop.
    pub torque_lag_s: f64,
    /// Greatest force of the drive.
    pub force_limit_n: f64,
    /// Coulomb friction, motor's and table's side together.
    pub coulomb_n: f64,
    /// Breakaway over Coulomb friction.
    pub static_ratio: f64,
    /// Speed over which the Stribeck effect decays.
    pub stribeck_mm_per_s: f64,
    /// Travel over which friction builds up after a reversal.
    pub presliding_um: f64,
    /// Amplitude of friction's change over position, as a share.
    pub friction_ripple: f64,
    /// Difference of friction between the directions, as a share.
    pub friction_direction: f64,
    /// Half-width of friction's change from hole to hole, as a share.
    pub friction_hole_spread: f64,
    /// The table side's share of the friction.
    pub friction_table_share: f64,
    /// Backlash between motor and table.
    pub backlash_um: f64,
    /// Where the position encoder sits.
    pub encoder_at: ZEncoderAt,
    /// Counts of the position encoder per mm.
    pub encoder_counts_per_mm: f64,
    /// Counts of the motor's encoder per mm of Z.
    pub motor_counts_per_mm: f64,
}

/// What of a setpoint a drive takes; the names are those of the greatest derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Takes {
    /// A speed alone, as a frequency converter: no position loop. Of the spindle only.
    Speed,
    /// A position alone: no feedforward of any kind.
    Position,
    /// Position and velocity.
    Velocity,
    /// Position, velocity, acceleration, and torque or force.
    #[default]
    Torque,
}

impl Takes {
    /// Every kind, in the order of documentation.
    pub const ALL: [Self; 4] = [Self::Speed, Self::Position, Self::Velocity, Self::Torque];

    /// Name in machine files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Torque => "torque",
        }
    }
}

/// `[drive]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSpec {
    /// Period of the position and velocity loops.
    pub period_s: f64,
    /// Interpolation periods by which a setpoint acts late.
    pub latency_periods: f64,
    /// What the spindle's drive takes of a setpoint.
    pub spindle_takes: Takes,
    /// What Z's drive takes of it; never a speed alone.
    pub z_takes: Takes,
    /// Spindle's position gain.
    pub spindle_position_gain_per_s: f64,
    /// Spindle's velocity gain, per its inertia.
    pub spindle_velocity_gain_per_s: f64,
    /// Integral time of the spindle's velocity loop.
    pub spindle_integral_s: f64,
    /// Z's position gain.
    pub z_position_gain_per_s: f64,
    /// Z's velocity gain, per its mass.
    pub z_velocity_gain_per_s: f64,
    /// Integral time of Z's velocity loop.
    pub z_integral_s: f64,
    /// Time constant of the filter on measured velocity.
    pub velocity_filter_s: f64,
    /// Age of an encoder reading when it is latched.
    pub encoder_latency_s: f64,
    /// Greatest deviation of the latching instant, either way.
    pub encoder_jitter_s: f64,
    /// Amplitude of the spindle encoder's interpolation error.
    pub spindle_interpolation_counts: f64,
    /// Amplitude of Z's interpolation error.
    pub z_interpolation_um: f64,
}

/// `[sync]`: gains of `compensation = full`; [`SyncSpec::by_rules`] says which suit a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SyncSpec {
    /// Time over which Z's motor crosses its backlash where the screw's force turns round.
    pub backlash_crossing_s: f64,
    /// Poles of the observer of the spindle's tracking error.
    pub observer_rad_per_s: f64,
    /// Tracking errors, as travel of Z, below which Z follows the spindle less and less: they are mostly noise.
    pub dead_zone_um: f64,
    /// Greatest fall of the path rate per second.
    pub governor_per_s: f64,
    /// Share of a hole's error that the next one's correction takes up.
    pub learning_gain: f64,
    /// Share of a correction that stays from hole to hole.
    pub learning_forgetting: f64,
    /// Half-width of the smoothing along the path.
    pub learning_smoothing_s: f64,
    /// By how much a correction comes before the error that it is for.
    pub learning_lead_s: f64,
    /// Time from rest over which corrections grow at the start of a hole.
    pub learning_taper_s: f64,
}

/// `[supervision]`: limits of the alarms; a limit that is absent follows from the other tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisionSpec {
    /// Periods without a sample, or left out by the host, that the model bridges; a whole number.
    pub bridge_periods: f64,
    /// Greatest |e(k)|; the thread's tolerance where absent.
    pub error_limit_um: Option<f64>,
    /// Greatest tracking error of the spindle; [`SupervisionSpec::spindle_rule_rev`] where absent.
    pub spindle_limit_rev: Option<f64>,
    /// Greatest following error of Z; [`SupervisionSpec::z_rule_um`] where absent.
    pub z_limit_um: Option<f64>,
    /// Greatest deviation of an encoder's scale, as a ratio; no rule uses it yet.
    pub scale_ratio: f64,
}

impl Default for SupervisionSpec {
    fn default() -> Self {
        Self {
            bridge_periods: 5.0,
            error_limit_um: None,
            spindle_limit_rev: None,
            z_limit_um: None,
            scale_ratio: 0.005,
        }
    }
}

/// `[tap]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TapSpec {
    /// Pitch P; any where absent. A hole of another pitch is refused.
    pub pitch_mm: Option<f64>,
    /// Major diameter D; that of the usual size of the programmed pitch where absent.
    pub major_mm: Option<f64>,
    /// Tap-drill diameter Do; likewise.
    pub hole_mm: Option<f64>,
    /// Specific cutting force; 0 cuts air.
    pub kc_n_per_mm2: f64,
    /// Factor K of the tap's form.
    pub tool_factor: f64,
    /// The work piece's surface below the R plane.
    pub surface_below_r_mm: f64,
    /// Pitches over which the torque rises: the tap's chamfer.
    pub ramp_pitches: f64,
    /// Amplitude of the chip noise, as a share of the torque.
    pub chip_noise_ratio: f64,
    /// Torque on the way out, as a share of that on the way in.
    pub out_torque_ratio: f64,
    /// Axial force of the engaged tap along its travel, positive where it draws itself in.
    pub axial_n: f64,
    /// How far the tip may go below the programmed bottom; half a pitch where absent.
    pub bottom_clearance_mm: Option<f64>,
}

impl TapSpec {
    /// Major and tap-drill diameter for a pitch in mm: the file's, else those of its usual size; none outside both.
    #[must_use]
    pub fn size(&self, pitch_mm: f64) -> Option<(f64, f64)> {
        let usual = || StandardThread::by_pitch(pitch_mm).map(|size| (size.major_mm, size.hole_mm));
        self.major_mm.zip(self.hole_mm).or_else(usual)
    }
}

/// `[tolerance]`
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToleranceSpec {
    /// Greatest peak-to-peak synchronisation error; that of the usual size of the programmed pitch where absent.
    pub error_um: Option<f64>,
}
