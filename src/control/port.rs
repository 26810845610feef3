//! The boundary between the control and a machine, real or simulated. Time is an argument, never a clock.
//!
//! Machine coordinates: X, Y, Z in mm as programmed (Z falls into the hole); spindle in rev, positive as M03 turns.

use crate::control::cycle::TapCycle;
use crate::control::math::poly::State;

/// What the control asks for at the end of an interpolation period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Spindle, rev.
    pub spindle: State,
    /// X, mm.
    pub x: State,
    /// Y, mm.
    pub y: State,
    /// Z, mm.
    pub z: State,
    /// Torque feedforward of the spindle beyond what its nominal inertia takes for the acceleration above; CiA 402's
    /// torque offset.
    pub spindle_torque_nm: f64,
    /// Force feedforward of Z, likewise beyond its nominal mass's, positive upwards as Z is.
    pub z_force_n: f64,
}

/// Whether a drive follows its setpoints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveState {
    /// Enabled and in control: "operation enabled" of CiA 402.
    Ready,
    /// Off, tripped, or not yet enabled: the axis coasts or stands on its brake.
    NotReady,
}

/// What the host knows of an axis's sample and of its drive in one period.
///
/// ```
/// use rigidtap::control::port::AxisStatus;
/// // A host that says nothing: the sample counts, the rest is unknown.
/// let status = AxisStatus::default();
/// assert_eq!((status.sample_valid, status.drive, status.saturated), (true, None, None));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisStatus {
    /// The counts are a new sample of this period, and the bus says that it arrived whole.
    pub sample_valid: bool,
    /// The drive's state; `None` where it does not report one.
    pub drive: Option<DriveState>,
    /// The drive's effort stood at its limit at some time in the last period; `None` where it does not report that.
    pub saturated: Option<bool>,
}

impl Default for AxisStatus {
    fn default() -> Self {
        Self { sample_valid: true, drive: None, saturated: None }
    }
}

/// What the machine reports at the start of an interpolation period. What a drive does not report is `None`, never 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Feedback {
    /// Spindle encoder, signed and unwrapped.
    pub spindle_counts: i64,
    /// Z encoder that closes the position loop, signed and unwrapped.
    pub z_counts: i64,
    /// Encoder on Z's motor, signed and unwrapped.
    pub z_motor_counts: Option<i64>,
    /// Mean torque of the spindle over the last period as its drive knows it: current by the nominal constant.
    pub spindle_torque_nm: Option<f64>,
    /// Mean force of Z over the last period, likewise, positive upwards as Z is.
    pub z_force_n: Option<f64>,
    /// Spindle's sample and drive.
    pub spindle: AxisStatus,
    /// Z's sample and drive.
    pub z: AxisStatus,
}

impl Feedback {
    /// The spindle's drive reports that its torque stood at the limit.
    #[must_use]
    pub fn torque_saturated(&self) -> bool {
        self.spindle.saturated == Some(true)
    }
}

/// What only a simulated machine can tell: where spindle and Z truly are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// Spindle angle at the tool, rev.
    pub spindle_rev: f64,
    /// Tool tip, mm.
    pub z_mm: f64,
    /// Spindle speed at the motor.
    pub spindle_rpm: f64,
    /// Torque of the spindle motor.
    pub spindle_torque_nm: f64,
    /// Force of the Z drive.
    pub z_force_n: f64,
}

/// A machine, real, simulated or recorded, seen once each interpolation period: read, then write.
pub trait Port {
    /// What the encoders read at `now_s`.
    fn read(&mut self, now_s: f64) -> Feedback;

    /// Hands over the setpoint of `now_s`; a simulated machine moves on by one period.
    fn write(&mut self, now_s: f64, setpoint: &Setpoint);

    /// What the host's clock shows at the start of a period that by its own count begins at `now_s`: later where the host
    /// missed periods, and anything where the clock is faulty. The control is told this time.
    fn clock_s(&mut self, now_s: f64) -> f64 {
        now_s
    }

    /// The drives lose their power and coast, or have it back and hold their axes where they rest. Of a real machine nobody is asked.
    fn set_power(&mut self, _is_on: bool) {}

    /// A hole is about to be tapped: what a simulated work piece wants to know. Real machines do not care.
    fn begin_hole(&mut self, _cycle: &TapCycle) {}

    /// Where spindle and Z truly are, if anyone can know.
    fn truth(&self) -> Option<Truth> {
        None
    }
}

/// Unwraps a counter of fixed width into a signed count that does not overflow in practice.
///
/// ```
/// use rigidtap::control::port::CountUnwrapper;
/// let mut encoder = CountUnwrapper::new(16).unwrap();
/// let counts: Vec<i64> = [65530, 4, 65534].into_iter().map(|raw| encoder.unwrap_count(raw)).collect();
/// assert_eq!(counts, [0, 10, 4]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountUnwrapper {
    bits: u32,
    last_raw: Option<u64>,
    count: i64,
}

impl CountUnwrapper {
    /// For a counter of `bits` bits, 2 to 63; none for other widths.
    #[must_use]
    pub fn new(bits: u32) -> Option<Self> {
        (2..=63).contains(&bits).then_some(Self { bits, last_raw: None, count: 0 })
    }

    /// The signed count since the first reading; a step of up to half the counter's range is taken the short way.
    pub fn unwrap_count(&mut self, raw: u64) -> i64 {
        let shift = 64 - self.bits;
        let step = match self.last_raw {
            // Shifted to the top, the difference wraps as the counter does and keeps its sign on the way back.
            Some(last) => (raw.wrapping_sub(last) << shift).cast_signed() >> shift,
            None => 0,
        };
        self.last_raw = Some(raw);
        self.count = self.count.wrapping_add(step);
        self.count
    }
}
