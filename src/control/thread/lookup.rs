//! Standard threads by name and by pitch.

use super::designation;
use super::pitch::StandardPitch;
use super::sizes::SIZES;
use super::standard::{Series, StandardThread, ThreadError};

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
}
