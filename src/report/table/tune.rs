//! `tune` for people: speed bands, and what other numbers of bands cost.

use super::columns::{Columns, number};
use super::layout::{Layout, Page};
use super::words::percent;
use crate::control::machine::Ramp;
use crate::control::motor::TorquePoint;
use crate::study::Tuning;

/// Tuned bands with their price, and what other numbers of bands would cost.
#[must_use]
pub fn tuning(layout: Layout, tuning: &Tuning) -> String {
    let mut bands = Columns::new(&[
        number("band", 0),
        number("to rpm", 0),
        number("accel s", 0),
        number("decel s", 0),
        number("rpm/s", 0),
        number("motor at top", 0),
    ]);
    for ((count, band), spec) in (1..).zip(&tuning.best.bands).zip(&tuning.specs) {
        let time = |of: fn((f64, f64)) -> f64| match spec.ramp {
            Ramp::Time { accel_s, decel_s } => format!("{:.5}", of((accel_s, decel_s))),
            Ramp::Rate { .. } => String::new(),
        };
        bands.row(vec![
            i32::to_string(&count),
            band.to_rpm.to_string(),
            time(|pair| pair.0),
            time(|pair| pair.1),
            format!("{:.0}", band.rate_rpm_per_s),
            percent(band.motor_ratio_at_top),
        ]);
    }
    let mut prices = Columns::new(&[number("bands", 0), number("time over minimum", 0)]);
    for (count, price) in (1..).zip(&tuning.prices) {
        prices.row(vec![i32::to_string(&count), format!("{price:.3}")]);
    }
    let strokes: Vec<_> = tuning.strokes_rev.iter().map(f64::to_string).collect();
    let mut page = Page::new(layout);
    if let Some(curve) = &tuning.measured {
        let point = |point: &TorquePoint| format!("[{:.0}, {:.2}]", point.speed_rpm, point.torque_nm);
        let points: Vec<_> = curve.points().iter().map(point).collect();
        page.say(format!("measured, less friction: torque_curve = [{}]", points.join(", ")));
    }
    page.say(format!(
        "{share} of the motor, strokes of {strokes} rev at {max_rpm} rpm: time over minimum {price:.3}, the minimum at \
         the same share",
        share = percent(tuning.motor_share),
        strokes = strokes.join(", "),
        max_rpm = tuning.max_rpm,
        price = tuning.best.stroke_over_bound,
    ));
    page.blank().table(&bands).blank().table(&prices).finish()
}
