//! The pitches of the usual series, to tell a pitch from one that is nearly it.

use crate::control::units::MM_PER_INCH;

/// A pitch that taps are made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandardPitch {
    /// Usual sizes of this pitch.
    pub name: &'static str,
    /// The pitch.
    pub pitch_mm: f64,
}

const fn metric(pitch_mm: f64, name: &'static str) -> StandardPitch {
    StandardPitch { name, pitch_mm }
}

const fn per_inch(threads: f64, name: &'static str) -> StandardPitch {
    StandardPitch { name, pitch_mm: MM_PER_INCH / threads }
}

/// Pitches of ISO 261 (coarse and fine, M1 to M64), of ASME B1.1 (UNC, UNF and UNEF), of BS 84 and ISO 228-1, and those that
/// only ASME B1.20.1 has: its threads taper.
#[rustfmt::skip]
pub const PITCHES: [StandardPitch; 55] = [
    metric(0.2, "M1x0.2"), metric(0.25, "M1"), metric(0.3, "M1.4"), metric(0.35, "M1.6"), metric(0.4, "M2"), metric(0.45, "M2.5"),
    metric(0.5, "M3"), metric(0.6, "M3.5"), metric(0.7, "M4"), metric(0.75, "M6x0.75"), metric(0.8, "M5"),
    metric(1.0, "M6, M8x1"), metric(1.25, "M8, M10x1.25"), metric(1.5, "M10, M12x1.5"), metric(1.75, "M12"),
    metric(2.0, "M16, M14"), metric(2.5, "M20"), metric(3.0, "M24"), metric(3.5, "M30"), metric(4.0, "M36"),
    metric(4.5, "M42"), metric(5.0, "M48"), metric(5.5, "M56"), metric(6.0, "M64"),
    per_inch(80.0, "0-80 UNF"), per_inch(72.0, "1-72 UNF"), per_inch(64.0, "1-64 UNC, 2-64 UNF"), per_inch(60.0, "1/16-60 BSW"),
    per_inch(56.0, "2-56 UNC"), per_inch(48.0, "3-48 UNC, 4-48 UNF"), per_inch(44.0, "5-44 UNF"),
    per_inch(40.0, "4-40 UNC"), per_inch(36.0, "8-36 UNF"), per_inch(32.0, "8-32 UNC, 10-32 UNF"),
    per_inch(28.0, "1/4-28 UNF"), per_inch(27.0, "1/8-27 NPT"), per_inch(24.0, "10-24 UNC, 5/16-24 UNF"), per_inch(20.0, "1/4-20 UNC"),
    per_inch(19.0, "G1/4"),
    per_inch(18.0, "5/16-18 UNC"), per_inch(16.0, "3/8-16 UNC"), per_inch(14.0, "7/16-14 UNC"),
    per_inch(13.0, "1/2-13 UNC"), per_inch(12.0, "9/16-12 UNC"), per_inch(11.5, "1-11 1/2 NPT"), per_inch(11.0, "5/8-11 UNC"),
    per_inch(10.0, "3/4-10 UNC"), per_inch(9.0, "7/8-9 UNC"), per_inch(8.0, "1-8 UNC"),
    per_inch(7.0, "1 1/4-7 UNC"), per_inch(6.0, "1 1/2-6 UNC"), per_inch(5.0, "1 3/4-5 UNC"), per_inch(4.5, "2-4.5 UNC"),
    per_inch(4.0, "2 1/2-4 UNC"), per_inch(3.5, "3-3.5 BSW"),
];

impl StandardPitch {
    /// A pitch is this one if it differs by less: F is written with few digits, and 20 mm of thread then miss 20 µm.
    const SAME_RATIO: f64 = 1e-3;
    /// A pitch that differs by less is hardly meant as it stands.
    const NEAR_RATIO: f64 = 0.03;

    /// Whether only threads that taper have it (ASME B1.20.1).
    #[must_use]
    pub fn is_tapered(&self) -> bool {
        self.name.ends_with("NPT")
    }

    /// The standard pitch next to this one.
    fn nearest(pitch_mm: f64) -> Option<Self> {
        let off = |standard: &Self| (standard.pitch_mm - pitch_mm).abs();
        PITCHES.into_iter().min_by(|left, right| off(left).total_cmp(&off(right)))
    }

    /// Whether two pitches are one, written with few digits.
    pub(super) fn is_same(one_mm: f64, other_mm: f64) -> bool {
        (other_mm / one_mm - 1.0).abs() < Self::SAME_RATIO
    }

    fn ratio(&self, pitch_mm: f64) -> f64 {
        (pitch_mm / self.pitch_mm - 1.0).abs()
    }

    /// The standard pitch that this one is.
    ///
    /// ```
    /// use rigidtap::control::thread::StandardPitch;
    /// assert_eq!(StandardPitch::of(1.27).unwrap().name, "1/4-20 UNC");
    /// assert_eq!(StandardPitch::of(0.98), None);
    /// ```
    #[must_use]
    pub fn of(pitch_mm: f64) -> Option<Self> {
        Self::nearest(pitch_mm).filter(|standard| standard.ratio(pitch_mm) < Self::SAME_RATIO)
    }

    /// The standard pitch that is probably meant where this one is none, but nearly.
    ///
    /// ```
    /// use rigidtap::control::thread::StandardPitch;
    /// assert_eq!(StandardPitch::near_miss(0.98).unwrap().pitch_mm, 1.0);
    /// assert_eq!((StandardPitch::near_miss(1.0), StandardPitch::near_miss(1.1)), (None, None));
    /// ```
    #[must_use]
    pub fn near_miss(pitch_mm: f64) -> Option<Self> {
        let near = |standard: &Self| (Self::SAME_RATIO..Self::NEAR_RATIO).contains(&standard.ratio(pitch_mm));
        Self::nearest(pitch_mm).filter(near)
    }
}
