//! The boundary between the control and a machine, real or simulated. Time is an argument, never a clock.
//!
//! Machine coordinates: X, Y, Z in mm as programmed (Z falls into the hole); spindle in rev, positive as M03 turns.

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
}

/// What the machine reports at the start of an interpolation period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Feedback {
    /// Spindle encoder, signed and unwrapped.
    pub spindle_counts: i64,
    /// Z encoder that closes the position loop, signed and unwrapped.
    pub z_counts: i64,
    /// Encoder on Z's motor, signed and unwrapped.
    pub z_motor_counts: i64,
    /// The spindle drive's torque stood at its limit at some time in the period.
    pub torque_saturated: bool,
}

/// A machine: takes a setpoint each interpolation period and answers with what its encoders read at the period's end.
pub trait Port {
    /// Hands over the setpoint of time `now_s` and runs to the next period.
    fn exchange(&mut self, now_s: f64, setpoint: &Setpoint) -> Feedback;
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
