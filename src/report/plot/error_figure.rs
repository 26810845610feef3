//! e(k) over k, one panel per law or setting, as in figure 5 of the torque-curve paper.

use crate::control::cycle::LegKind;
use crate::run::Verdict;
use crate::study::ErrorPoint;

use super::axis::{Frame, Range};
use super::canvas::{Area, Canvas, picture};
use super::reduce::by_column;
use super::style::{
    Align, BAD, DATA, DOUBTFUL, DWELL, Font, GOOD, GRID, MARGIN_PX, SOFT_INK, STROKE_IN, STROKE_OUT, TOLERANCE,
    WIDTH_PX, measured, signed,
};
use super::{PlotError, check_drawable, check_order};

/// e(k) of one law or setting.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorPanel {
    /// What was run.
    pub title: String,
    /// What the thread bears, peak to peak.
    pub tolerance_um: f64,
    /// How it was judged; the true error, which is not drawn, has a say in it.
    pub verdict: Verdict,
    /// The synchronous periods in their order; none draws an empty panel.
    pub points: Vec<ErrorPoint>,
}

/// A value beyond so many tolerances is off scale, so that a lost thread does not flatten the good ones beside it.
const SCALE_TOLERANCES: f64 = 3.0;
/// A panel that is off scale asks for so many tolerances of the common scale.
const OFF_SCALE_TOLERANCES: f64 = 1.25;

const LEFT_PX: f64 = 72.0;
/// Room for the band's values.
const RIGHT_PX: f64 = 108.0;
const HEAD_PX: f64 = 44.0;
/// A panel's title line above its frame.
const TITLE_PX: f64 = 26.0;
/// Tick labels under a frame.
const FOOT_PX: f64 = 26.0;
const LEGEND_PX: f64 = 54.0;
const CHIP_PX: f64 = 62.0;
/// Strip at the bottom of a frame that shows the strokes.
const STRIP_PX: f64 = 5.0;
/// Least height between the labels of a band's two edges.
const LABEL_PX: f64 = 14.0;

/// Points of one picture, and strokes that it marks one by one: they keep the file under 300 kB.
const MOST_POINTS: usize = 10_000;
const MOST_STROKES: usize = 400;
/// Narrower strokes than this are not marked.
const LEAST_STROKE_PX: f64 = 3.0;

/// Draws e(k) over k, panels below each other on one common vertical scale.
///
/// The tolerance, a peak-to-peak width, is shaded where it holds the error band if it can; so the band inside the shade
/// means a good thread. A panel whose error goes beyond three tolerances is cut at the frame, with the cut marked and its
/// true band written beside it. Each panel starts at its own first period; all are as wide as the longest.
///
/// # Errors
/// [`PlotError`]: no panel, or values that no axis can show, or k not in rising order.
///
/// ```
/// use rigidtap::control::cycle::LegKind;
/// use rigidtap::report::plot::{ErrorPanel, ErrorPoint, error_figure};
/// let points = (0..500).map(|k| ErrorPoint { k, error_um: (k % 17) as f64 - 8.0, hole: 1, kind: LegKind::In });
/// let panel = ErrorPanel { title: "S3000".into(), tolerance_um: 53.0, points: points.collect(), ..Default::default() };
/// let svg = error_figure("e(k) of one hole", &[panel]).unwrap();
/// assert!(svg.contains("peak to peak 16.0 of 53.0 µm"));
/// ```
pub fn error_figure(title: &str, panels: &[ErrorPanel]) -> Result<String, PlotError> {
    if panels.is_empty() {
        return Err(PlotError::Nothing);
    }
    for panel in panels {
        check_drawable(panel.points.iter().map(|point| point.error_um).chain([panel.tolerance_um]))?;
        check_order(panel.points.iter().map(|point| point.k as f64))?;
    }
    let bands: Vec<Option<Range>> = panels.iter().map(band).collect();
    let y = common_scale(panels, &bands);
    let periods = panels.iter().filter_map(|panel| Some(panel.points.last()?.k - panel.points.first()?.k)).max();
    let budget = Budget::of(panels);
    let frame_px = (800.0 / panels.len() as f64).clamp(92.0, 250.0);
    let panel_px = TITLE_PX + frame_px + FOOT_PX;
    let height_px = HEAD_PX + panels.len() as f64 * panel_px + LEGEND_PX;
    let description =
        panels.iter().zip(&bands).map(|(panel, band)| format!("{}: {}. ", panel.title, verdict_text(panel, *band)));

    picture(title, description.collect::<String>().trim_end(), height_px, |canvas| {
        let mut top = HEAD_PX;
        for (panel, band) in panels.iter().zip(&bands) {
            let first = panel.points.first().map_or(0.0, |point| point.k as f64);
            let area = Area {
                left: LEFT_PX,
                top: top + TITLE_PX,
                right: WIDTH_PX - RIGHT_PX,
                bottom: top + TITLE_PX + frame_px,
            };
            let x = Range { low: first, high: first + periods.unwrap_or(0).max(1) as f64 };
            let drawing = Drawing { panel, band: *band, frame: Frame { area, x, y }, budget };
            drawing.draw(canvas)?;
            top += panel_px;
        }
        let cut = bands.iter().flatten().any(|band| band.low < y.low || band.high > y.high);
        let dwells = panels.iter().any(|panel| panel.points.iter().any(|point| point.kind == LegKind::Dwell));
        canvas.text((WIDTH_PX / 2.0, top + 4.0), "period k", Font::CAPTION.aligned(Align::Middle))?;
        legend(canvas, top + 28.0, budget.strokes, dwells, cut)
    })
}

fn band(panel: &ErrorPanel) -> Option<Range> {
    Range::of(panel.points.iter().map(|point| point.error_um))
}

fn verdict_text(panel: &ErrorPanel, band: Option<Range>) -> String {
    match band {
        None => "no synchronous periods".into(),
        Some(band) if panel.tolerance_um > 0.0 => {
            format!("peak to peak {} of {} µm", measured(band.span()), measured(panel.tolerance_um))
        }
        Some(band) => format!("peak to peak {} µm", measured(band.span())),
    }
}

/// Where the tolerance is shaded: around the band's middle, but holding zero, where e(k) starts.
fn allowed(panel: &ErrorPanel, band: Option<Range>) -> Range {
    let half = panel.tolerance_um.max(0.0) / 2.0;
    let middle = band.map_or(0.0, |band| ((band.low + band.high) / 2.0).max(-half).min(half));
    Range { low: middle - half, high: middle + half }
}

/// The vertical scale of all panels.
fn common_scale(panels: &[ErrorPanel], bands: &[Option<Range>]) -> Range {
    let tolerance_um = panels.iter().map(|panel| panel.tolerance_um).fold(0.0, f64::max);
    // Without a tolerance nothing can be off scale.
    let limit = if tolerance_um > 0.0 { SCALE_TOLERANCES * tolerance_um } else { f64::INFINITY };
    let shown = |value: f64| {
        if value.abs() <= limit { value } else { value.signum() * OFF_SCALE_TOLERANCES * tolerance_um }
    };
    let values = panels.iter().zip(bands).flat_map(|(panel, band)| {
        let shade = allowed(panel, *band);
        let band = band.map_or([0.0, 0.0], |band| [shown(band.low), shown(band.high)]);
        [shade.low, shade.high].into_iter().chain(band)
    });
    Range::of(values.chain([0.0])).unwrap_or(Range { low: -1.0, high: 1.0 }).padded(0.08)
}

/// What the file's size leaves for each panel.
#[derive(Clone, Copy, Debug)]
struct Budget {
    columns: usize,
    strokes: bool,
}

impl Budget {
    fn of(panels: &[ErrorPanel]) -> Self {
        let columns = (MOST_POINTS / (2 * panels.len())).clamp(50, (WIDTH_PX - LEFT_PX - RIGHT_PX) as usize);
        let strokes: Vec<usize> = panels.iter().map(|panel| strokes(&panel.points).count()).collect();
        let most = (WIDTH_PX - LEFT_PX - RIGHT_PX) / LEAST_STROKE_PX;
        let narrow = strokes.iter().any(|count| *count as f64 > most);
        Self { columns, strokes: !narrow && strokes.iter().sum::<usize>() <= MOST_STROKES }
    }
}

fn strokes(points: &[ErrorPoint]) -> impl Iterator<Item = &[ErrorPoint]> {
    points.chunk_by(|a, b| a.hole == b.hole && a.kind == b.kind)
}

/// First period of some points, and the one after their last.
fn extent(points: &[ErrorPoint]) -> (f64, f64) {
    (points.first().map_or(0.0, |point| point.k as f64), points.last().map_or(0.0, |point| point.k as f64 + 1.0))
}

const fn stroke_color(kind: LegKind) -> plotters::style::RGBColor {
    match kind {
        LegKind::In => STROKE_IN,
        LegKind::Dwell => DWELL,
        LegKind::Out => STROKE_OUT,
    }
}

/// One panel, ready to draw.
struct Drawing<'a> {
    panel: &'a ErrorPanel,
    band: Option<Range>,
    frame: Frame,
    budget: Budget,
}

impl Drawing<'_> {
    fn draw(&self, canvas: &mut Canvas<'_>) -> Result<(), PlotError> {
        let Self { panel, band, frame, .. } = self;
        frame.ground(canvas)?;
        if panel.tolerance_um > 0.0 {
            let shade = allowed(panel, *band);
            canvas.fill(frame.row(shade.low, shade.high), TOLERANCE)?;
        }
        frame.axes(canvas, true)?;
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
        let (name, color) = match panel.verdict {
            Verdict::Ok => ("ok", GOOD),
            Verdict::Warning => ("warning", DOUBTFUL),
            Verdict::Fail => ("fail", BAD),
        };
        let mut text_right = right;
        if band.is_some() {
            canvas.fill(Area { left: right - CHIP_PX, top: y - 9.0, right, bottom: y + 8.0 }, color)?;
            let white = Font::VALUE.aligned(Align::Middle).colored(plotters::style::WHITE);
            canvas.text((right - CHIP_PX / 2.0, y), name, Font { bold: true, ..white })?;
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
        for hole in self.panel.points.chunk_by(|a, b| a.hole == b.hole) {
            let (from, to) = extent(hole);
            let column = self.frame.column(from, to);
            if from > self.frame.x.low {
                canvas.path(&[(column.left, top), (column.left, bottom)], GRID, 1.0)?;
            }
            let number = hole.first().map_or(0, |point| point.hole).to_string();
            if column.width() > Font::MARK.width_px(&number) + 4.0 {
                let middle = (column.left + column.right) / 2.0;
                canvas.text((middle, top + 8.0), &number, Font::MARK.aligned(Align::Middle))?;
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

    /// Lines at the band's edges, their values beside the frame.
    fn band_edges(&self, canvas: &mut Canvas<'_>, band: Range) -> Result<(), PlotError> {
        let Self { frame, .. } = self;
        let Area { left, top, right, bottom } = frame.area;
        let [high, low] = [band.high, band.low].map(|value| frame.y_px(frame.y.clamp(value)));
        // The two labels make room for each other, and stay beside the frame.
        let middle = ((high + low) / 2.0).max(top + LABEL_PX).min(bottom - LABEL_PX);
        let high_label = high.min(middle - LABEL_PX / 2.0).max(top + 4.0);
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
            canvas.path(&frame.places(&kept), DATA, 1.0)?;
            for cut in kept.chunk_by(|a, b| side(a.1, frame.y) == side(b.1, frame.y)) {
                self.off_scale(canvas, cut)?;
            }
        }
        Ok(())
    }

    fn off_scale(&self, canvas: &mut Canvas<'_>, cut: &[(f64, f64)]) -> Result<(), PlotError> {
        let (Some(first), Some(last)) = (cut.first(), cut.last()) else { return Ok(()) };
        let Area { left, right, top, bottom } = self.frame.column(first.0, last.0);
        // Even a single period shows.
        let mark = Area { left: left - 0.5, right: right + 0.5, top, bottom };
        match side(first.1, self.frame.y) {
            Side::Above => canvas.fill(Area { top: top - 3.0, bottom: top + 1.0, ..mark }, BAD),
            Side::Below => canvas.fill(Area { top: bottom - 1.0, bottom: bottom + 3.0, ..mark }, BAD),
            Side::Inside => Ok(()),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Below,
    Inside,
    Above,
}

fn side(value: f64, scale: Range) -> Side {
    if value > scale.high {
        Side::Above
    } else if value < scale.low {
        Side::Below
    } else {
        Side::Inside
    }
}

fn legend(canvas: &mut Canvas<'_>, y: f64, strokes: bool, dwells: bool, cut: bool) -> Result<(), PlotError> {
    let all = [
        (true, TOLERANCE, "tolerance (peak to peak)"),
        (strokes, STROKE_IN, "stroke in"),
        (strokes && dwells, DWELL, "dwell"),
        (strokes, STROKE_OUT, "stroke out"),
        (cut, BAD, "off scale, true value beside it"),
    ];
    let mut x = LEFT_PX;
    for (_, color, name) in all.into_iter().filter(|(shown, ..)| *shown) {
        canvas.fill(Area { left: x, top: y - 5.0, right: x + 14.0, bottom: y + 4.0 }, color)?;
        canvas.text((x + 19.0, y), name, Font::CAPTION)?;
        x += 19.0 + Font::CAPTION.width_px(name) + 18.0;
    }
    Ok(())
}
