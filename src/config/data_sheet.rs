//! What data sheets say beside what the control needs: the file's other keys are checked against it.

/// Optional keys that only check others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DataSheet {
    /// Continuous power on the spindle motor's plate.
    pub plate_kw: Option<f64>,
    /// Lines of the spindle's encoder, before multiplication.
    pub encoder_lines_per_rev: Option<f64>,
}
