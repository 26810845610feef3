//! Axes: ranges, ticks with sensible decimals, and the frame around the data.

use super::canvas::{Area, Canvas, Point};
use super::fault::PlotError;
use super::style::{Align, FRAME, Font, GRID, PLOT_AREA, number};

/// Room that a tick label takes beside its neighbour, vertically.
const TICK_HEIGHT_PX: f64 = 24.0;
/// On a high frame more would be noise.
const MOST_TICKS: usize = 7;
/// Room that a tick label takes horizontally.
const TICK_WIDTH_PX: f64 = 76.0;

/// A round step this much finer than asked for is taken; else the next coarser one.
const NEAREST: f64 = 0.7;

/// An interval of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Range {
    /// The least that holds all values; none for no values.
    pub(super) fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        values.into_iter().fold(None, |range, value| match range {
            None => Some(Self { low: value, high: value }),
            Some(Self { low, high }) => Some(Self { low: low.min(value), high: high.max(value) }),
        })
    }

    /// Wider by a share of itself on both sides; never so narrow that it cannot be an axis.
    pub(super) fn padded(self, share: f64) -> Self {
        let least = 1e-6 * self.low.abs().max(self.high.abs()).max(1e-3);
        let pad = share * (self.high - self.low);
        if self.high - self.low > least {
            Self { low: self.low - pad, high: self.high + pad }
        } else {
            let pad = (0.1 * self.low.abs()).max(1.0);
            Self { low: self.low - pad, high: self.high + pad }
        }
    }

    pub(super) fn span(&self) -> f64 {
        self.high - self.low
    }

    pub(super) fn clamp(&self, value: f64) -> f64 {
        value.max(self.low).min(self.high)
    }
}

/// A tick on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: String,
}

/// Round values in a range, about `count` of them, all with the decimals that their step needs.
pub(super) fn ticks(range: Range, count: usize) -> Vec<Tick> {
    let raw = range.span() / count.max(1) as f64;
    let decade = libm::floor(libm::log10(raw));
    let power = libm::pow(10.0, decade);
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * power >= NEAREST * raw).unwrap_or(10.0);
    let step = factor * power;
    let decimals = if factor == 10.0 { -decade - 1.0 } else { -decade }.clamp(0.0, 12.0) as usize;
    let first = libm::ceil(range.low / step - 1e-9);
    let last = libm::floor(range.high / step + 1e-9);
    (0..=(last - first).clamp(0.0, 100.0) as usize)
        .map(|index| (first + index as f64) * step)
        .filter(|value| *value <= range.high + 1e-9 * step)
        .map(|value| Tick { value, label: number(value, decimals) })
        .collect()
}

/// Where data is drawn: an area of the sheet, and the ranges of both axes over it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) area: Area,
    pub(super) x: Range,
    pub(super) y: Range,
}

impl Frame {
    pub(super) fn x_px(&self, value: f64) -> f64 {
        self.area.left + (value - self.x.low) / self.x.span() * self.area.width()
    }

    pub(super) fn y_px(&self, value: f64) -> f64 {
        self.area.bottom - (value - self.y.low) / self.y.span() * (self.area.bottom - self.area.top)
    }

    /// The place of a value on the sheet, moved onto the frame where it lies outside.
    pub(super) fn place(&self, (x, y): (f64, f64)) -> Point {
        (self.x_px(self.x.clamp(x)), self.y_px(self.y.clamp(y)))
    }

    /// The places of many values.
    pub(super) fn places(&self, values: &[(f64, f64)]) -> Vec<Point> {
        values.iter().map(|value| self.place(*value)).collect()
    }

    /// A rectangle between two values of x, over the whole height.
    pub(super) fn column(&self, from: f64, to: f64) -> Area {
        Area { left: self.x_px(self.x.clamp(from)), right: self.x_px(self.x.clamp(to)), ..self.area }
    }

    /// A rectangle between two values of y, over the whole width.
    pub(super) fn row(&self, low: f64, high: f64) -> Area {
        Area { top: self.y_px(self.y.clamp(high)), bottom: self.y_px(self.y.clamp(low)), ..self.area }
    }

    /// The empty area.
    pub(super) fn ground(&self, canvas: &mut Canvas<'_>) -> Result<(), PlotError> {
        canvas.fill(self.area, PLOT_AREA)
    }

    /// Grid, frame and tick labels. Those of x are left out where the panel below carries them.
    pub(super) fn axes(&self, canvas: &mut Canvas<'_>, label_x: bool) -> Result<(), PlotError> {
        let Area { left, top, right, bottom } = self.area;
        for tick in ticks(self.x, ((right - left) / TICK_WIDTH_PX) as usize) {
            let x = self.x_px(tick.value);
            canvas.path(&[(x, top), (x, bottom)], GRID, 1.0)?;
            if label_x {
                canvas.text((x, bottom + 11.0), &tick.label, Font::CAPTION.aligned(Align::Middle))?;
            }
        }
        for tick in ticks(self.y, (((bottom - top) / TICK_HEIGHT_PX) as usize).min(MOST_TICKS)) {
            let y = self.y_px(tick.value);
            // The line at zero is where everything starts.
            let color = if tick.value == 0.0 { FRAME } else { GRID };
            canvas.path(&[(left, y), (right, y)], color, 1.0)?;
            canvas.text((left - 6.0, y), &tick.label, Font::CAPTION.aligned(Align::Right))?;
        }
        canvas.outline(self.area, FRAME)
    }

    /// Labels of a second unit of x under those of the first, `per_x` of it to one of x.
    pub(super) fn second_x(&self, canvas: &mut Canvas<'_>, per_x: f64) -> Result<(), PlotError> {
        let range = Range { low: per_x * self.x.low, high: per_x * self.x.high };
        for tick in ticks(range, (self.area.width() / TICK_WIDTH_PX) as usize) {
            let x = self.x_px(tick.value / per_x);
            canvas.path(&[(x, self.area.bottom), (x, self.area.bottom + 4.0)], FRAME, 1.0)?;
            canvas.text(
                (x, self.area.bottom + 24.0),
                &format!("{} s", tick.label),
                Font::CAPTION.aligned(Align::Middle),
            )?;
        }
        Ok(())
    }

    /// Name and unit of x, under its tick labels.
    pub(super) fn name_x(&self, canvas: &mut Canvas<'_>, name: &str) -> Result<(), PlotError> {
        let middle = (self.area.left + self.area.right) / 2.0;
        canvas.text((middle, self.area.bottom + 27.0), name, Font::CAPTION.aligned(Align::Middle))
    }

    /// Name and unit of y, upwards beside its tick labels.
    pub(super) fn name_y(&self, canvas: &mut Canvas<'_>, name: &str) -> Result<(), PlotError> {
        let middle = (self.area.top + self.area.bottom) / 2.0;
        let font = Font { upwards: true, ..Font::CAPTION.aligned(Align::Middle) };
        canvas.text((self.area.left - 50.0, middle), name, font)
    }

    /// Name and unit of y, in the upper left above the frame.
    pub(super) fn name_above(&self, canvas: &mut Canvas<'_>, name: &str) -> Result<(), PlotError> {
        canvas.text((self.area.left, self.area.top - 9.0), name, Font::CAPTION)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ticks_have_the_decimals_of_their_step() {
        let labels = |low, high, count| -> Vec<String> {
            ticks(Range { low, high }, count).into_iter().map(|tick| tick.label).collect()
        };
        assert_eq!(labels(0.0, 0.45, 5), ["0.0", "0.1", "0.2", "0.3", "0.4"]);
        assert_eq!(labels(-30.0, 30.0, 6), ["−30", "−20", "−10", "0", "10", "20", "30"]);
        assert_eq!(labels(0.0, 24_000.0, 3), ["0", "10\u{2009}000", "20\u{2009}000"]);
        assert_eq!(labels(0.0, 0.95, 1), ["0"]);
        assert_eq!(labels(-44.0, 44.0, 4), ["−40", "−20", "0", "20", "40"]);
    }

    proptest! {
        #[test]
        fn any_range_has_few_ticks_inside(low in -1e12..1e12f64, span in 0.0..1e12f64, count in 1..12usize) {
            let range = Range { low, high: low + span }.padded(0.05);
            let ticks = ticks(range, count);
            prop_assert!(ticks.len() as f64 <= count as f64 / NEAREST + 1.001);
            for tick in ticks {
                prop_assert!(tick.value >= range.low - 1e-6 * range.span() && tick.value <= range.high + 1e-6 * range.span());
            }
        }
    }
}
