//! One panel of the error figure.

use super::axis::{Frame, Range};
use super::canvas::{Area, Canvas};
use crate::study::ErrorPoint;

use super::error_scale::{Budget, ErrorPanel, allowed, strokes, verdict_text};
use super::fault::PlotError;
use super::reduce::by_column;
use super::style::{
    Align, BAD, DATA, Font, GRID, MARGIN_PX, SOFT_INK, TOLERANCE, WIDTH_PX, signed, stroke_color, verdict_color,
};

/// Room for the verdict.
const CHIP_PX: f64 = 62.0;
/// Strip at the bottom of a frame that shows the strokes.
const STRIP_PX: f64 = 5.0;
/// Least height between the labels of a band's two edges.
const LABEL_PX: f64 = 14.0;

/// First period of some points, and the one after their last.
fn extent(points: &[ErrorPoint]) -> (f64, f64) {
    (points.first().map_or(0.0, |point| point.k as f64), points.last().map_or(0.0, |point| point.k as f64 + 1.0))
}

/// One panel, ready to draw.
pub(super) struct Drawing<'a> {
    pub(super) panel: &'a ErrorPanel,
    pub(super) band: Option<Range>,
    pub(super) frame: Frame,
    pub(super) budget: Budget,
}

impl Drawing<'_> {
    /// Ground, marks, axes, error and heading, from back to front.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>) -> Result<(), PlotError> {
        let Self { panel, band, frame, .. } = self;
        frame.ground(canvas)?;
        if panel.tolerance_um > 0.0 {
            let shade = allowed(panel, *band);
            canvas.fill(frame.row(shade.low, shade.high), TOLERANCE)?;
        }
        frame.axes(canvas, true)?;
        if panel.period_s > 0.0 {
            frame.second_x(canvas, panel.period_s)?;
        }
        frame.name_y(canvas, "e(k), µm")?;
        if self.budget.strokes {
            self.holes(canvas)?;
        }
        if let Some(band) = band {
            self.band_edges(canvas, *band)?;
            self.trace(canvas)?;
        }
        self.heading(canvas)
    }

    fn heading(&self, canvas: &mut Canvas<'_>) -> Result<(), PlotError> {
        let Self { panel, band, frame, .. } = self;
        let y = frame.area.top - 12.0;
        let right = WIDTH_PX - MARGIN_PX;
        let mut text_right = right;
        if band.is_some() {
            canvas.fill(
                Area { left: right - CHIP_PX, top: y - 9.0, right, bottom: y + 8.0 },
                verdict_color(panel.verdict),
            )?;
            let white = Font::VALUE.aligned(Align::Middle).colored(plotters::style::WHITE);
            canvas.text((right - CHIP_PX / 2.0, y), panel.verdict.name(), Font { bold: true, ..white })?;
            text_right -= CHIP_PX + 10.0;
        }
        let text = verdict_text(panel, *band);
        let font = Font::VALUE.aligned(Align::Right);
        canvas.text((text_right, y), &text, font)?;
        let room = text_right - font.width_px(&text) - frame.area.left - 12.0;
        canvas.text((frame.area.left, y), &Font::HEADING.fit(&panel.title, room), Font::HEADING)
    }

    /// Boundaries and numbers of holes, and a strip that shows the strokes.
    fn holes(&self, canvas: &mut Canvas<'_>) -> Result<(), PlotError> {
        let Area { top, bottom, .. } = self.frame.area;
        let holes = || self.panel.points.chunk_by(|a, b| a.hole == b.hole);
        let every = self.numbered_holes();
        for (index, hole) in holes().enumerate() {
            let (from, to) = extent(hole);
            let column = self.frame.column(from, to);
            if index > 0 {
                canvas.path(&[(column.left, top), (column.left, bottom)], GRID, 1.0)?;
            }
            let number = hole.first().map_or(0, |point| point.hole);
            if every.is_some_and(|every| index % every == 0) {
                let middle = (column.left + column.right) / 2.0;
                canvas.text((middle, top + 8.0), &number.to_string(), Font::MARK.aligned(Align::Middle))?;
            }
        }
        for stroke in strokes(&self.panel.points) {
            let (from, to) = extent(stroke);
            if let Some(point) = stroke.first() {
                let strip = Area { top: bottom - STRIP_PX, ..self.frame.column(from, to) };
                canvas.fill(strip, stroke_color(point.kind))?;
            }
        }
        Ok(())
    }

    /// Every how many holes there is room for a number; none for a single hole, which needs none.
    fn numbered_holes(&self) -> Option<usize> {
        let points = &self.panel.points;
        let count = points.chunk_by(|a, b| a.hole == b.hole).count();
        let (from, to) = extent(points);
        let last = points.last().map_or(0, |point| point.hole).to_string();
        let room_px = self.frame.column(from, to).width() / count.max(1) as f64;
        let needed_px = Font::MARK.width_px(&last) + 4.0;
        let fits = |every: &usize| *every as f64 * room_px >= needed_px;
        [1, 2, 5, 10, 20, 50, 100].into_iter().find(fits).filter(|_| count > 1)
    }

    /// Lines at the band's edges, their values beside the frame.
    fn band_edges(&self, canvas: &mut Canvas<'_>, band: Range) -> Result<(), PlotError> {
        let Self { frame, .. } = self;
        let Area { left, top, right, bottom } = frame.area;
        let [high, low] = [band.high, band.low].map(|value| frame.y_px(frame.y.clamp(value)));
        // The two labels make room for each other, and stay beside the frame.
        let middle = ((high + low) / 2.0).max(top + LABEL_PX).min(bottom - LABEL_PX);
        let high_label = high.min(middle - LABEL_PX / 2.0).max(top + 8.0);
        let low_label = low.max(middle + LABEL_PX / 2.0).min(bottom - 4.0);
        for (value, y, label, name) in [(band.high, high, high_label, "max"), (band.low, low, low_label, "min")] {
            let outside = value < frame.y.low || value > frame.y.high;
            let color = if outside { BAD } else { SOFT_INK };
            if !outside {
                canvas.path(&[(left, y), (right, y)], SOFT_INK, 0.75)?;
            }
            canvas.path(&[(right, y), (right + 4.0, y), (right + 8.0, label)], color, 0.75)?;
            let arrow = match (outside, value > 0.0) {
                (false, _) => "",
                (true, true) => " ▲",
                (true, false) => " ▼",
            };
            canvas.text(
                (right + 11.0, label),
                &format!("{name} {}{arrow}", signed(value)),
                Font::VALUE.colored(if outside { BAD } else { Font::VALUE.color }),
            )?;
        }
        Ok(())
    }

    /// The error itself; where it leaves the scale it runs along the frame, marked.
    fn trace(&self, canvas: &mut Canvas<'_>) -> Result<(), PlotError> {
        let Self { panel, frame, budget, .. } = self;
        let same_run = |a: &ErrorPoint, b: &ErrorPoint| !budget.strokes || a.hole == b.hole;
        for run in panel.points.chunk_by(same_run) {
            let (from, to) = extent(run);
            let points: Vec<(f64, f64)> = run.iter().map(|point| (point.k as f64, point.error_um)).collect();
            let share = (to - from) / frame.x.span();
            let columns = (share * budget.columns as f64).max(2.0) as usize;
            let kept = by_column(&points, from, to, columns);
            canvas.path(&frame.places(&kept), DATA, 1.25)?;
            let Area { top, bottom, .. } = frame.area;
            self.cuts(canvas, (top - 3.0, top + 1.0), &kept, |error_um| error_um > frame.y.high)?;
            self.cuts(canvas, (bottom - 1.0, bottom + 3.0), &kept, |error_um| error_um < frame.y.low)?;
        }
        Ok(())
    }

    /// Bars on the frame where the error is outside.
    fn cuts(
        &self,
        canvas: &mut Canvas<'_>,
        (top, bottom): (f64, f64),
        points: &[(f64, f64)],
        outside: impl Fn(f64) -> bool,
    ) -> Result<(), PlotError> {
        let mut bar: Option<(f64, f64)> = None;
        // Even a single period shows.
        let mut draw = |(left, right)| canvas.fill(Area { left: left - 0.5, right: right + 0.5, top, bottom }, BAD);
        for (k, _) in points.iter().filter(|point| outside(point.1)) {
            let x = self.frame.x_px(*k);
            bar = match bar {
                Some((left, right)) if x - right <= self.budget.gap_px => Some((left, x)),
                Some(ended) => {
                    draw(ended)?;
                    Some((x, x))
                }
                None => Some((x, x)),
            };
        }
        bar.map_or(Ok(()), draw)
    }
}
