//! `[gcode]`: how programs are read.

use crate::control::cycle::Retract;
use crate::gcode::{CycleWords, DecimalPoint, Dialect, G81, PECK_BACK_MM};

/// `[gcode]`: how programs are read; what is none stays as the dialect has it.
#[derive(Clone, Debug, PartialEq)]
pub struct GcodeOptions {
    /// Name of one of [`Dialect::ALL`].
    pub dialect: String,
    /// The cycle that G81 calls.
    pub g81: Option<G81>,
    /// What a number without a decimal point means.
    pub decimal_point: Option<DecimalPoint>,
    /// Lengths are in inches until G20 or G21.
    pub power_on_inch: bool,
    /// Angle at which the spindle rests on the R plane before each hole that says none itself; none: wherever it comes to rest.
    pub start_angle_deg: Option<f64>,
    /// What a peck does at its end.
    pub peck: Peck,
    /// How far a chip-breaking peck turns back.
    pub peck_back_mm: f64,
}

/// What Q makes of a tapping cycle: on a Fanuc parameter 5200 bit 5 says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Peck {
    /// Turns back a little.
    #[default]
    ChipBreak,
    /// Comes back to R.
    Full,
}

impl Default for GcodeOptions {
    /// As the torque-curve paper's programs are written.
    fn default() -> Self {
        Self {
            dialect: Dialect::PAPER.name.to_owned(),
            g81: None,
            decimal_point: None,
            power_on_inch: false,
            start_angle_deg: None,
            peck: Peck::default(),
            peck_back_mm: PECK_BACK_MM,
        }
    }
}

impl GcodeOptions {
    /// A dialect with these options.
    ///
    /// ```
    /// use rigidtap::config::GcodeOptions;
    /// use rigidtap::gcode::{DecimalPoint, Dialect};
    /// let options = GcodeOptions { decimal_point: Some(DecimalPoint::Calculator), ..GcodeOptions::default() };
    /// assert_eq!(Dialect::FANUC.decimal_point, DecimalPoint::Fanuc);
    /// assert_eq!(options.apply(Dialect::FANUC).decimal_point, DecimalPoint::Calculator);
    /// ```
    #[must_use]
    pub fn apply(&self, dialect: Dialect) -> Dialect {
        let retract = match self.peck {
            Peck::ChipBreak => Retract::ChipBreak { back_mm: self.peck_back_mm },
            Peck::Full => Retract::Full,
        };
        Dialect {
            g81: self.g81.unwrap_or(dialect.g81),
            decimal_point: self.decimal_point.unwrap_or(dialect.decimal_point),
            power_on_inch: self.power_on_inch,
            start_angle_deg: self.start_angle_deg.or(dialect.start_angle_deg),
            cycle: CycleWords { peck: dialect.cycle.peck.map(|_| retract), ..dialect.cycle },
            ..dialect
        }
    }
}
