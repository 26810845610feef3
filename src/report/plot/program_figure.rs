//! A whole program: where its holes are, and what Z does over time.

use crate::control::cycle::LegKind;
use crate::run::{RowStage, Verdict};

use super::axis::{Frame, Range};
use super::canvas::{Area, Canvas, Point, picture};
use super::reduce::by_column;
use super::style::{
    Align, BAD, DOUBTFUL, DWELL, FRAME, Font, GOOD, MARGIN_PX, SOFT_INK, STROKE_IN, STROKE_OUT, WIDTH_PX,
};
use super::{PlotError, check_drawable, check_order};

/// One hole of the pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleMark {
    /// Number in the program, from 1.
    pub hole: u32,
    /// Position.
    pub x_mm: f64,
    /// Position.
    pub y_mm: f64,
    /// How it was judged; none where the program was only planned.
    pub verdict: Option<Verdict>,
}

/// Z at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZPoint {
    /// Time from the program's start.
    pub time_s: f64,
    /// Position.
    pub z_mm: f64,
    /// What the machine is doing.
    pub stage: RowStage,
}

/// What [`program_figure`] draws.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramPicture {
    /// The holes, in the program's order.
    pub holes: Vec<HoleMark>,
    /// Corners of the path in X and Y.
    pub path_mm: Vec<[f64; 2]>,
    /// Z over time, in rising order.
    pub z: Vec<ZPoint>,
}

const TOP_PX: f64 = 66.0;
const BOTTOM_PX: f64 = 380.0;
const HEIGHT_PX: f64 = 452.0;
const PATTERN: Area = Area { left: 70.0, top: TOP_PX, right: 410.0, bottom: BOTTOM_PX };
const TIMELINE: Area = Area { left: 480.0, top: TOP_PX, right: WIDTH_PX - MARGIN_PX, bottom: BOTTOM_PX };
/// Points, moves and holes that one picture shows one by one.
const MOST_RUNS: usize = 400;
const MOST_CORNERS: usize = 4000;
const MOST_HOLES: usize = 600;
const HOLE_PX: f64 = 3.5;

/// Draws the pattern of holes, numbered, beside Z over time, coloured by what the machine does.
///
/// # Errors
/// [`PlotError`]: nothing to draw, or values that no axis can show, or times not in rising order.
///
/// ```
/// use rigidtap::report::plot::{HoleMark, ProgramPicture, program_figure};
/// let hole = HoleMark { hole: 1, x_mm: 7.0, y_mm: 0.0, verdict: None };
/// let svg = program_figure("One hole", &ProgramPicture { holes: vec![hole], ..Default::default() }).unwrap();
/// assert!(svg.starts_with("<svg"));
/// ```
pub fn program_figure(title: &str, program: &ProgramPicture) -> Result<String, PlotError> {
    let ProgramPicture { holes, path_mm, z } = program;
    if holes.is_empty() && path_mm.is_empty() && z.is_empty() {
        return Err(PlotError::Nothing);
    }
    check_drawable(holes.iter().flat_map(|hole| [hole.x_mm, hole.y_mm]))?;
    check_drawable(path_mm.iter().flatten().copied())?;
    check_drawable(z.iter().flat_map(|point| [point.time_s, point.z_mm]))?;
    check_order(z.iter().map(|point| point.time_s))?;
    let description = format!("{} holes", holes.len());
    picture(title, &description, HEIGHT_PX, |canvas| {
        pattern(canvas, program)?;
        timeline(canvas, z)?;
        legend(canvas, program)
    })
}

fn pattern(canvas: &mut Canvas<'_>, program: &ProgramPicture) -> Result<(), PlotError> {
    let corners = || program.holes.iter().map(|hole| [hole.x_mm, hole.y_mm]).chain(program.path_mm.iter().copied());
    let whole = |axis: usize| Range::of(corners().filter_map(|corner| corner.get(axis).copied()));
    let (x, y) = (whole(0).unwrap_or(Range { low: 0.0, high: 1.0 }), whole(1).unwrap_or(Range { low: 0.0, high: 1.0 }));
    let (x, y) = same_scale(x, y, PATTERN);
    let frame = Frame { area: PATTERN, x, y };
    frame.ground(canvas)?;
    frame.axes(canvas, true)?;
    frame.name_above(canvas, "Y, mm")?;
    frame.name_x(canvas, "X, mm")?;
    let path: Vec<(f64, f64)> = program.path_mm.iter().take(MOST_CORNERS).map(|[x, y]| (*x, *y)).collect();
    if path.len() > 1 {
        canvas.path(&frame.places(&path), FRAME, 1.0)?;
    }
    let mut labels = Labels::default();
    let holes = || program.holes.iter().take(MOST_HOLES);
    for hole in holes() {
        let at = frame.place((hole.x_mm, hole.y_mm));
        canvas.dot(at, HOLE_PX, hole.verdict.map_or(STROKE_IN, verdict_color))?;
        labels.taken.push(around(at, HOLE_PX, HOLE_PX));
    }
    for hole in holes() {
        let at = frame.place((hole.x_mm, hole.y_mm));
        labels.write(canvas, at, &hole.hole.to_string(), PATTERN)?;
    }
    Ok(())
}

/// Both axes widened to one scale in px per mm.
fn same_scale(x: Range, y: Range, area: Area) -> (Range, Range) {
    let (width, height) = (area.width() - 40.0, area.bottom - area.top - 40.0);
    let mm_per_px = (x.span() / width).max(y.span() / height);
    let mm_per_px = if mm_per_px > 1e-9 * (x.high.abs() + y.high.abs()) && mm_per_px > 1e-9 { mm_per_px } else { 0.1 };
    let around = |range: Range, px: f64| {
        let middle = (range.low + range.high) / 2.0;
        Range { low: middle - mm_per_px * px / 2.0, high: middle + mm_per_px * px / 2.0 }
    };
    (around(x, area.width()), around(y, area.bottom - area.top))
}

/// Numbers that keep off each other and off the holes.
#[derive(Default)]
struct Labels {
    taken: Vec<Area>,
}

impl Labels {
    /// Writes a number above its point, or below, or beside it; where there is no room, not at all.
    fn write(&mut self, canvas: &mut Canvas<'_>, at: Point, text: &str, within: Area) -> Result<(), PlotError> {
        let half = Font::MARK.width_px(text) / 2.0;
        let offsets = [(0.0, -10.0), (0.0, 10.0), (half + 6.0, 0.0), (-half - 6.0, 0.0)];
        for offset in offsets {
            let middle = (at.0 + offset.0, at.1 + offset.1);
            let area = around(middle, half + 1.0, 5.0);
            let inside = area.left > within.left
                && area.right < within.right
                && area.top > within.top
                && area.bottom < within.bottom;
            if inside && !self.taken.iter().any(|other| overlap(other, &area)) {
                self.taken.push(area);
                return canvas.text(middle, text, Font::MARK.aligned(Align::Middle));
            }
        }
        Ok(())
    }
}

fn around((x, y): Point, half_width: f64, half_height: f64) -> Area {
    Area { left: x - half_width, top: y - half_height, right: x + half_width, bottom: y + half_height }
}

fn overlap(a: &Area, b: &Area) -> bool {
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom
}

fn timeline(canvas: &mut Canvas<'_>, z: &[ZPoint]) -> Result<(), PlotError> {
    let x = Range::of(z.iter().map(|point| point.time_s)).unwrap_or(Range { low: 0.0, high: 1.0 });
    let x = if x.span() > 0.0 { x } else { x.padded(0.0) };
    let y = Range::of(z.iter().map(|point| point.z_mm)).unwrap_or(Range { low: 0.0, high: 1.0 });
    let frame = Frame { area: TIMELINE, x, y: y.padded(0.07) };
    frame.ground(canvas)?;
    frame.axes(canvas, true)?;
    frame.name_above(canvas, "Z, mm")?;
    frame.name_x(canvas, "time, s")?;
    let runs = z.chunk_by(|a, b| a.stage == b.stage).count();
    let columns = TIMELINE.width() as usize;
    let values = |points: &[ZPoint]| points.iter().map(|point| (point.time_s, point.z_mm)).collect::<Vec<_>>();
    if runs > MOST_RUNS {
        return canvas.path(&frame.places(&by_column(&values(z), x.low, x.high, columns)), SOFT_INK, 1.0);
    }
    let mut previous = None;
    for run in z.chunk_by(|a, b| a.stage == b.stage) {
        let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
        let share = (last.time_s - first.time_s) / x.span();
        let columns = (share * columns as f64).max(2.0) as usize;
        // Each run starts where the one before it ended, so that the line has no gaps.
        let mut points: Vec<(f64, f64)> = previous.into_iter().collect();
        points.extend(by_column(&values(run), first.time_s, last.time_s, columns));
        canvas.path(&frame.places(&points), stage_color(first.stage), 1.5)?;
        previous = Some((last.time_s, last.z_mm));
    }
    Ok(())
}

const fn stage_color(stage: RowStage) -> plotters::style::RGBColor {
    match stage {
        RowStage::Leg(LegKind::In) => STROKE_IN,
        RowStage::Leg(LegKind::Dwell) => DWELL,
        RowStage::Leg(LegKind::Out) => STROKE_OUT,
        RowStage::Rapid => SOFT_INK,
        RowStage::Orient => FRAME,
    }
}

const fn verdict_color(verdict: Verdict) -> plotters::style::RGBColor {
    match verdict {
        Verdict::Ok => GOOD,
        Verdict::Warning => DOUBTFUL,
        Verdict::Fail => BAD,
    }
}

fn legend(canvas: &mut Canvas<'_>, program: &ProgramPicture) -> Result<(), PlotError> {
    let y = HEIGHT_PX - 22.0;
    let mut x = PATTERN.left;
    for verdict in [Verdict::Ok, Verdict::Warning, Verdict::Fail] {
        let count = program.holes.iter().filter(|hole| hole.verdict == Some(verdict)).count();
        if count > 0 {
            canvas.dot((x + 4.0, y), HOLE_PX, verdict_color(verdict))?;
            let name = format!("{count} {}", verdict.name());
            canvas.text((x + 13.0, y), &name, Font::CAPTION)?;
            x += 13.0 + Font::CAPTION.width_px(&name) + 16.0;
        }
    }
    let mut x = TIMELINE.left;
    for (stage, name) in [
        (RowStage::Rapid, "positioning"),
        (RowStage::Orient, "spindle to rest"),
        (RowStage::Leg(LegKind::In), "stroke in"),
        (RowStage::Leg(LegKind::Dwell), "dwell"),
        (RowStage::Leg(LegKind::Out), "stroke out"),
    ] {
        if program.z.iter().any(|point| point.stage == stage) {
            canvas.path(&[(x, y), (x + 14.0, y)], stage_color(stage), 2.5)?;
            canvas.text((x + 19.0, y), name, Font::CAPTION)?;
            x += 19.0 + Font::CAPTION.width_px(name) + 14.0;
        }
    }
    Ok(())
}
