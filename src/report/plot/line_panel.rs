//! A panel of lines below the error figure: what the spindle did meanwhile.

use super::axis::{Frame, Range};
use super::canvas::Canvas;
use super::error_scale::Budget;
use super::fault::{PlotError, check_drawable, check_order};
use super::reduce::by_column;
use super::style::{Font, series};

/// Lines over k, all of one unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinePanel {
    /// What is drawn, with its unit.
    pub title: String,
    /// Name and points (k, value) of each line, in rising order of k.
    pub lines: Vec<(String, Vec<(u64, f64)>)>,
}

impl LinePanel {
    /// Whether it can be drawn.
    pub(super) fn check(&self) -> Result<(), PlotError> {
        for (_, points) in &self.lines {
            check_drawable(points.iter().map(|point| point.1))?;
            check_order(points.iter().map(|point| point.0 as f64))?;
        }
        Ok(())
    }

    /// All values, and zero.
    pub(super) fn range(&self) -> Range {
        let values = self.lines.iter().flat_map(|(_, points)| points.iter().map(|point| point.1));
        Range::of(values.chain([0.0])).unwrap_or(Range { low: -1.0, high: 1.0 }).padded(0.08)
    }

    pub(super) fn draw(
        &self,
        canvas: &mut Canvas<'_>,
        frame: Frame,
        period_s: f64,
        budget: Budget,
    ) -> Result<(), PlotError> {
        frame.ground(canvas)?;
        frame.axes(canvas, true)?;
        if period_s > 0.0 {
            frame.second_x(canvas, period_s)?;
        }
        for (index, (_, points)) in self.lines.iter().enumerate() {
            let points: Vec<(f64, f64)> = points.iter().map(|&(k, value)| (k as f64, value)).collect();
            let kept = by_column(&points, frame.x.low, frame.x.high, budget.columns);
            canvas.path(&frame.places(&kept), series(index), 1.25)?;
        }
        let y = frame.area.top - 12.0;
        canvas.text((frame.area.left, y), &self.title, Font::HEADING)?;
        let left = frame.area.left + Font::HEADING.width_px(&self.title) + 24.0;
        canvas.legend((left, y), self.lines.iter().enumerate().map(|(index, (name, _))| (series(index), name.as_str())))
    }
}
