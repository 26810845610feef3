//! One size of a series as its standard names it.

use super::standard::{Series, StandardThread};
use super::tolerance::{Tolerance, metric, pipe as pipe_tolerance, unified, whitworth as whitworth_tolerance};
use crate::control::units::MM_PER_INCH;

/// A row of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Size {
    pub(super) name: &'static str,
    pub(super) series: Series,
    pub(super) major_mm: f64,
    pub(super) pitch_mm: f64,
    /// TD2 of ISO 228-1, which has no formula; zero elsewhere.
    pipe_um: f64,
}

const fn size(name: &'static str, series: Series, major_mm: f64, pitch_mm: f64) -> Size {
    Size { name, series, major_mm, pitch_mm, pipe_um: 0.0 }
}

const fn inch(name: &'static str, series: Series, major_in: f64, per_inch: f64) -> Size {
    size(name, series, major_in * MM_PER_INCH, MM_PER_INCH / per_inch)
}

pub(super) const fn coarse(name: &'static str, major_mm: f64, pitch_mm: f64) -> Size {
    size(name, Series::MetricCoarse, major_mm, pitch_mm)
}

pub(super) const fn fine(name: &'static str, major_mm: f64, pitch_mm: f64) -> Size {
    size(name, Series::MetricFine, major_mm, pitch_mm)
}

pub(super) const fn unc(name: &'static str, major_in: f64, per_inch: f64) -> Size {
    inch(name, Series::Unc, major_in, per_inch)
}

pub(super) const fn unf(name: &'static str, major_in: f64, per_inch: f64) -> Size {
    inch(name, Series::Unf, major_in, per_inch)
}

pub(super) const fn unef(name: &'static str, major_in: f64, per_inch: f64) -> Size {
    inch(name, Series::Unef, major_in, per_inch)
}

pub(super) const fn whitworth(name: &'static str, major_in: f64, per_inch: f64) -> Size {
    inch(name, Series::Whitworth, major_in, per_inch)
}

pub(super) const fn pipe(name: &'static str, major_mm: f64, per_inch: f64, tolerance_um: f64) -> Size {
    Size { name, series: Series::Pipe, major_mm, pitch_mm: MM_PER_INCH / per_inch, pipe_um: tolerance_um }
}

impl Size {
    /// With its drill and its tolerance.
    pub(super) fn thread(self) -> StandardThread {
        let Self { name, series, major_mm, pitch_mm, pipe_um } = self;
        let Tolerance { class, pitch_diameter_um, tap_upper_limit_um } = match series {
            Series::MetricCoarse | Series::MetricFine => metric(major_mm, pitch_mm),
            Series::Unc | Series::Unf => unified(major_mm, pitch_mm, false),
            Series::Unef => unified(major_mm, pitch_mm, true),
            Series::Whitworth => whitworth_tolerance(major_mm, pitch_mm),
            Series::Pipe => pipe_tolerance(pipe_um),
        };
        StandardThread {
            name,
            series,
            pitch_mm,
            major_mm,
            hole_mm: major_mm - pitch_mm + drill_step_mm(pitch_mm),
            tolerance_class: class,
            pitch_diameter_tolerance_um: pitch_diameter_um,
            tap_upper_limit_um,
        }
    }
}

/// Tap drills are the diameter less the pitch, and drills are made in tenths of a millimetre (ISO 2306: M8 6.8, M12 10.2,
/// M4.5 3.7).
fn drill_step_mm(pitch_mm: f64) -> f64 {
    const STEP_MM: f64 = 0.05;
    if pitch_mm == 1.25 {
        STEP_MM
    } else if pitch_mm == 1.75 || pitch_mm == 0.75 {
        -STEP_MM
    } else {
        0.0
    }
}
