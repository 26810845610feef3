//! Standard threads: the ISO metric coarse series, its tap drills, what synchronisation error each thread bears; and the
//! pitches of the usual series, to tell a pitch from one that is nearly it.

use crate::control::units::MM_PER_INCH;

/// One size of the coarse series with its 6H tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandardThread {
    /// Designation, `M6`.
    pub name: &'static str,
    /// Pitch P.
    pub pitch_mm: f64,
    /// Major diameter D.
    pub major_mm: f64,
    /// Usual tap-drill diameter Do.
    pub hole_mm: f64,
    /// Tolerance of the pitch diameter, TD2 of class 6H (ISO 965-1).
    pub pitch_diameter_tolerance_um: f64,
    /// Upper limit of a class ISO 2 tap's pitch diameter above nominal.
    pub tap_upper_limit_um: f64,
}

/// A peak-to-peak axial error R widens the pitch diameter of a 60° thread by R/tan 30°.
pub const WIDENING_PER_ERROR: f64 = 1.732;

const fn size(
    name: &'static str,
    pitch_mm: f64,
    major_mm: f64,
    hole_mm: f64,
    td2_um: f64,
    tap_um: f64,
) -> StandardThread {
    StandardThread {
        name,
        pitch_mm,
        major_mm,
        hole_mm,
        pitch_diameter_tolerance_um: td2_um,
        tap_upper_limit_um: tap_um,
    }
}

/// The sizes known by name, in rising order of pitch.
pub const METRIC_COARSE: [StandardThread; 7] = [
    size("M3", 0.5, 3.0, 2.5, 100.0, 40.0),
    size("M4", 0.7, 4.0, 3.3, 118.0, 47.0),
    size("M5", 0.8, 5.0, 4.2, 125.0, 50.0),
    size("M6", 1.0, 6.0, 5.0, 150.0, 59.0),
    size("M8", 1.25, 8.0, 6.8, 160.0, 63.0),
    size("M10", 1.5, 10.0, 8.5, 180.0, 70.0),
    size("M12", 1.75, 12.0, 10.2, 200.0, 80.0),
];

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

/// Pitches of ISO 261 (coarse and fine, M1 to M64) and of ASME B1.1 (UNC and UNF, No. 0 to 4 inch).
#[rustfmt::skip]
pub const PITCHES: [StandardPitch; 44] = [
    metric(0.25, "M1"), metric(0.3, "M1.4"), metric(0.35, "M1.6"), metric(0.4, "M2"), metric(0.45, "M2.5"),
    metric(0.5, "M3"), metric(0.6, "M3.5"), metric(0.7, "M4"), metric(0.75, "M6x0.75"), metric(0.8, "M5"),
    metric(1.0, "M6, M8x1"), metric(1.25, "M8, M10x1.25"), metric(1.5, "M10, M12x1.5"), metric(1.75, "M12"),
    metric(2.0, "M16, M14"), metric(2.5, "M20"), metric(3.0, "M24"), metric(3.5, "M30"), metric(4.0, "M36"),
    metric(4.5, "M42"), metric(5.0, "M48"), metric(5.5, "M56"), metric(6.0, "M64"),
    per_inch(80.0, "0-80 UNF"), per_inch(72.0, "1-72 UNF"), per_inch(64.0, "1-64 UNC, 2-64 UNF"),
    per_inch(56.0, "2-56 UNC"), per_inch(48.0, "3-48 UNC, 4-48 UNF"), per_inch(44.0, "5-44 UNF"),
    per_inch(40.0, "4-40 UNC"), per_inch(36.0, "8-36 UNF"), per_inch(32.0, "8-32 UNC, 10-32 UNF"),
    per_inch(28.0, "1/4-28 UNF"), per_inch(24.0, "10-24 UNC, 5/16-24 UNF"), per_inch(20.0, "1/4-20 UNC"),
    per_inch(18.0, "5/16-18 UNC"), per_inch(16.0, "3/8-16 UNC"), per_inch(14.0, "7/16-14 UNC"),
    per_inch(13.0, "1/2-13 UNC"), per_inch(12.0, "9/16-12 UNC"), per_inch(11.0, "5/8-11 UNC"),
    per_inch(10.0, "3/4-10 UNC"), per_inch(9.0, "7/8-9 UNC"), per_inch(8.0, "1-8 UNC"),
];

impl StandardPitch {
    /// A pitch is this one if it differs by less: F is written with few digits, and 20 mm of thread then miss 20 µm.
    const SAME_RATIO: f64 = 1e-3;
    /// A pitch that differs by less is hardly meant as it stands.
    const NEAR_RATIO: f64 = 0.03;

    /// The standard pitch next to this one.
    fn nearest(pitch_mm: f64) -> Option<Self> {
        let off = |standard: &Self| (standard.pitch_mm - pitch_mm).abs();
        PITCHES.into_iter().min_by(|left, right| off(left).total_cmp(&off(right)))
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

impl StandardThread {
    /// The size of a designation such as `M6`, in either case.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        METRIC_COARSE.into_iter().find(|size| size.name.eq_ignore_ascii_case(name))
    }

    /// The size of a pitch; between two of the series every measure is interpolated, outside it there is none.
    ///
    /// ```
    /// use rigidtap::control::thread::StandardThread;
    /// let m6 = StandardThread::by_pitch(1.0).unwrap();
    /// assert_eq!((m6.name, m6.sync_tolerance_um().round()), ("M6", 53.0));
    /// assert!(StandardThread::by_pitch(3.0).is_none());
    /// ```
    #[must_use]
    pub fn by_pitch(pitch_mm: f64) -> Option<Self> {
        // Inch programs arrive at a pitch by division, so an exact match would miss its own size.
        const SAME_MM: f64 = 1e-9;
        let mut pairs = METRIC_COARSE.iter().zip(METRIC_COARSE.iter().skip(1));
        let (low, high) =
            pairs.find(|(low, high)| pitch_mm >= low.pitch_mm - SAME_MM && pitch_mm <= high.pitch_mm + SAME_MM)?;
        if (pitch_mm - low.pitch_mm).abs() <= SAME_MM {
            return Some(*low);
        }
        if (pitch_mm - high.pitch_mm).abs() <= SAME_MM {
            return Some(*high);
        }
        let share = (pitch_mm - low.pitch_mm) / (high.pitch_mm - low.pitch_mm);
        let between = |low: f64, high: f64| low + share * (high - low);
        Some(Self {
            name: "between coarse sizes",
            pitch_mm,
            major_mm: between(low.major_mm, high.major_mm),
            hole_mm: between(low.hole_mm, high.hole_mm),
            pitch_diameter_tolerance_um: between(low.pitch_diameter_tolerance_um, high.pitch_diameter_tolerance_um),
            tap_upper_limit_um: between(low.tap_upper_limit_um, high.tap_upper_limit_um),
        })
    }

    /// Greatest peak-to-peak synchronisation error: what a tap at its upper limit leaves of TD2.
    #[must_use]
    pub fn sync_tolerance_um(&self) -> f64 {
        (self.pitch_diameter_tolerance_um - self.tap_upper_limit_um) / WIDENING_PER_ERROR
    }
}
