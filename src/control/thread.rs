//! Standard threads: the ISO metric coarse series, its tap drills, and what synchronisation error each thread bears.

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
