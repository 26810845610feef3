//! What supervision is held to: limits in force, and the longest stop.

/// The limits in force for a pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisionLimits {
    /// Periods without a sample that the model bridges.
    pub bridge_periods: u32,
    /// Greatest |e(k)|.
    pub error_um: f64,
    /// Greatest tracking error of the spindle, rev.
    pub spindle_rev: f64,
    /// Greatest following error of Z.
    pub z_um: f64,
    /// Greatest deviation of a scale, as a ratio.
    pub scale_ratio: f64,
    /// How far below the bottom Z may go.
    pub bottom_clearance_mm: f64,
}

/// The longest synchronous stop of a machine, for the timer of its drives' safe stop 1 (SS1, IEC 61800-5-2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LongestStop {
    /// Seconds from top speed to rest.
    pub time_s: f64,
    /// Revolutions on the way.
    pub angle_rev: f64,
}
