//! What a standard thread is.

use core::fmt;

/// A family of sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Series {
    /// M6: ISO 261, one pitch for each diameter.
    MetricCoarse,
    /// M10x1.25: ISO 261.
    MetricFine,
    /// 1/4-20 UNC: ASME B1.1.
    Unc,
    /// 1/4-28 UNF: ASME B1.1.
    Unf,
    /// 1/4-32 UNEF: ASME B1.1.
    Unef,
    /// 1/4-20 BSW: BS 84, 55° flanks.
    Whitworth,
    /// G1/4: ISO 228-1, parallel pipe threads, 55° flanks.
    Pipe,
}

impl Series {
    /// Letters of the designation.
    #[must_use]
    pub const fn mark(self) -> &'static str {
        match self {
            Self::MetricCoarse | Self::MetricFine => "M",
            Self::Unc => "UNC",
            Self::Unf => "UNF",
            Self::Unef => "UNEF",
            Self::Whitworth => "BSW",
            Self::Pipe => "G",
        }
    }

    /// The standard that its tolerance is of.
    #[must_use]
    pub const fn tolerance_standard(self) -> &'static str {
        match self {
            Self::MetricCoarse | Self::MetricFine => "ISO 965-1",
            Self::Unc | Self::Unf | Self::Unef => "ASME B1.1",
            Self::Whitworth => "BS 84",
            Self::Pipe => "ISO 228-1",
        }
    }

    /// A peak-to-peak axial error R widens the pitch diameter by R/tan of half the flank angle: 60° or 55°.
    #[must_use]
    pub const fn widening_per_error(self) -> f64 {
        match self {
            Self::Whitworth | Self::Pipe => 1.921,
            _ => 1.732,
        }
    }
}

/// Why a designation names no thread that is known here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThreadError {
    /// NPT, NPTF, R, Rc: the thread is not cylindrical.
    Tapered,
    /// No size of the series.
    Unknown,
}

impl fmt::Display for ThreadError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Tapered => "the thread tapers, so that no one diameter, torque and tolerance holds for its depth",
            Self::Unknown => {
                "it is no size of ISO 261 (M1 to M64), UNC, UNF, UNEF (ASME B1.1), BSW (BS 84) or G (ISO 228-1)"
            }
        })
    }
}

impl core::error::Error for ThreadError {}

/// One size of a series with its tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandardThread {
    /// Designation, `M6`.
    pub name: &'static str,
    /// Its family.
    pub series: Series,
    /// Pitch P.
    pub pitch_mm: f64,
    /// Major diameter D.
    pub major_mm: f64,
    /// Usual tap-drill diameter Do, D less P.
    pub hole_mm: f64,
    /// Class of the tolerance: 6H, 5H where the pitch is too fine for 6H, 2B, medium of BS 84; G has one.
    pub tolerance_class: &'static str,
    /// Tolerance of the pitch diameter in that class.
    pub pitch_diameter_tolerance_um: f64,
    /// Upper limit of the usual tap's pitch diameter above nominal: class ISO 2 (ISO 2857); for threads in inches the
    /// same share of the tolerance.
    pub tap_upper_limit_um: f64,
}

impl StandardThread {
    /// Greatest peak-to-peak synchronisation error: what a tap at its upper limit leaves of the tolerance.
    #[must_use]
    pub fn sync_tolerance_um(&self) -> f64 {
        (self.pitch_diameter_tolerance_um - self.tap_upper_limit_um) / self.series.widening_per_error()
    }
}
