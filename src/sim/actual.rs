//! How the real machine differs from its file. Read by the plant alone: never by the planner or the synchronizer.

/// `[actual]`: factors on what the file says, and values in place of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actual {
    /// Factor on the spindle's inertia, both sides.
    pub inertia: f64,
    /// Factor on the torque–speed curve.
    pub torque_limit: f64,
    /// Factor on torque per current: the drive commands as if it were 1.
    pub torque_constant: f64,
    /// Factor on Z's and the spindle's friction.
    pub friction: f64,
    /// Factor on the spindle's torsional resonance.
    pub spindle_resonance: f64,
    /// Factor on Z's axial resonance.
    pub z_resonance: f64,
    /// Factor on the tapping torque.
    pub cutting_torque: f64,
    /// Factor on the encoders' interpolation errors and jitter.
    pub encoder_error: f64,
    /// Z's backlash, the file's where absent.
    pub backlash_um: Option<f64>,
    /// Age of an encoder reading, the file's where absent.
    pub encoder_latency_s: Option<f64>,
}

impl Default for Actual {
    /// The machine is as its file says.
    fn default() -> Self {
        Self {
            inertia: 1.0,
            torque_limit: 1.0,
            torque_constant: 1.0,
            friction: 1.0,
            spindle_resonance: 1.0,
            z_resonance: 1.0,
            cutting_torque: 1.0,
            encoder_error: 1.0,
            backlash_um: None,
            encoder_latency_s: None,
        }
    }
}
