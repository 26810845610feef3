//! Standard threads: sizes, tap drills, what synchronisation error each thread bears; and the pitches of the usual series, to
//! tell a pitch from one that is nearly it.

mod designation;
mod pitch;
mod size;
mod sizes;
#[cfg(test)]
mod tests;
mod tolerance;

use core::fmt;

pub use pitch::{PITCHES, StandardPitch};
use sizes::SIZES;

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

/// Sizes of the coarse series that stand for their pitches, in rising order: the first choice of ISO 261.
pub const COARSE_NAMES: [&str; 20] = [
    "M1", "M1.6", "M2", "M2.5", "M3", "M4", "M5", "M6", "M8", "M10", "M12", "M16", "M20", "M24", "M30", "M36", "M42",
    "M48", "M56", "M64",
];

impl StandardThread {
    /// The thread of a designation: `M6`, `M10x1.25`, `1/4-28`, `#10-32 UNF`, `G1/8`, `BSW 1/4`, in either case.
    ///
    /// # Errors
    /// [`ThreadError`].
    ///
    /// ```
    /// use rigidtap::control::thread::{StandardThread, ThreadError};
    /// let fine = StandardThread::by_name("M10x1.25").unwrap();
    /// assert_eq!((fine.hole_mm, fine.pitch_diameter_tolerance_um), (8.8, 160.0));
    /// assert_eq!(StandardThread::by_name("1/4-28").unwrap().name, "1/4-28 UNF");
    /// assert_eq!(StandardThread::by_name("1/8-27 NPT"), Err(ThreadError::Tapered));
    /// ```
    pub fn by_name(name: &str) -> Result<Self, ThreadError> {
        designation::parse(name)
    }

    /// Sizes of the coarse series that stand for their pitches, in rising order.
    pub fn coarse() -> impl Iterator<Item = Self> {
        let named = |name: &&str| SIZES.iter().find(|size| size.name == *name).map(|size| size.thread());
        COARSE_NAMES.iter().filter_map(named)
    }

    /// Every size.
    pub fn all() -> impl Iterator<Item = Self> {
        SIZES.iter().map(|size| size.thread())
    }

    /// The size of a pitch: the coarse series' first choice, else that of UNC; between two of the coarse series every
    /// measure is interpolated, outside it there is none.
    ///
    /// ```
    /// use rigidtap::control::thread::StandardThread;
    /// let m6 = StandardThread::by_pitch(1.0).unwrap();
    /// assert_eq!((m6.name, m6.sync_tolerance_um().round()), ("M6", 53.0));
    /// assert_eq!(StandardThread::by_pitch(1.27).unwrap().name, "1/4-20 UNC");
    /// assert!(StandardThread::by_pitch(7.0).is_none());
    /// ```
    #[must_use]
    pub fn by_pitch(pitch_mm: f64) -> Option<Self> {
        let is = |size: &StandardThread| StandardPitch::is_same(size.pitch_mm, pitch_mm);
        let unc = || SIZES.iter().filter(|size| size.series == Series::Unc).map(|size| size.thread()).find(is);
        Self::coarse().find(is).or_else(unc).or_else(|| Self::between(pitch_mm))
    }

    fn between(pitch_mm: f64) -> Option<Self> {
        let mut pairs = Self::coarse().zip(Self::coarse().skip(1));
        let (low, high) = pairs.find(|(low, high)| (low.pitch_mm..=high.pitch_mm).contains(&pitch_mm))?;
        let share = (pitch_mm - low.pitch_mm) / (high.pitch_mm - low.pitch_mm);
        let between = |low: f64, high: f64| low + share * (high - low);
        Some(Self {
            name: "between coarse sizes",
            pitch_mm,
            major_mm: between(low.major_mm, high.major_mm),
            hole_mm: between(low.hole_mm, high.hole_mm),
            pitch_diameter_tolerance_um: between(low.pitch_diameter_tolerance_um, high.pitch_diameter_tolerance_um),
            tap_upper_limit_um: between(low.tap_upper_limit_um, high.tap_upper_limit_um),
            ..low
        })
    }

    /// Greatest peak-to-peak synchronisation error: what a tap at its upper limit leaves of the tolerance.
    #[must_use]
    pub fn sync_tolerance_um(&self) -> f64 {
        (self.pitch_diameter_tolerance_um - self.tap_upper_limit_um) / self.series.widening_per_error()
    }
}
