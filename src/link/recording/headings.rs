//! Words of the formats that are known without a map.

/// Headings of a trace.
pub(super) const TRACE: [&str; 3] = ["time_s", "spindle_encoder_counts", "z_encoder_counts"];
/// Headings without which a trace says nothing of the drives.
pub(super) const DRIVE: [&str; 3] = ["time_s", "z_encoder_counts", "z_force_n"];
/// What halsampler writes where it lost samples.
pub(super) const OVERRUN: &str = "overrun";
