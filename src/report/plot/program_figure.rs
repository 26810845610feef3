//! A whole program: where its holes are, and what Z does over time.

use std::collections::BTreeSet;

use crate::control::cycle::StrokeKind;
use crate::run::{RowStage, Verdict};

use super::axis::{Frame, Range};
use super::canvas::{Area, Canvas, Point, picture};
use super::fault::{PlotError, check_drawable, check_order};
use super::reduce::by_column;
use super::style::{Align, FRAME, Font, MARGIN_PX, SOFT_INK, STROKE_IN, WIDTH_PX, stroke_color, verdict_color};

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

/// Where the two parts stand.
struct Layout {
    pattern: Area,
    timeline: Area,
}

const LEFT_PX: f64 = 70.0;
const TOP_PX: f64 = 66.0;
/// Tick labels, name and legend below a frame, and the name above the next one.
const BETWEEN_PX: f64 = 92.0;
const FRAME_PX: f64 = 314.0;
/// A pattern flatter than this, a row of holes, stands above the timeline.
const FLAT: f64 = 0.3;
const FLAT_FRAME_PX: f64 = 230.0;

impl Layout {
    fn of(x: Range, y: Range) -> Self {
        let right = WIDTH_PX - MARGIN_PX;
        let frame = |left, top, right, height| Area { left, top, right, bottom: top + height };
        if x.span() > 0.0 && y.span() <= FLAT * x.span() {
            let width = right - LEFT_PX - 2.0 * INSET_PX;
            let height = (y.span() / x.span() * width + 2.0 * INSET_PX).max(72.0);
            let below = TOP_PX + height + BETWEEN_PX;
            return Self {
                pattern: frame(LEFT_PX, TOP_PX, right, height),
                timeline: frame(LEFT_PX, below, right, FLAT_FRAME_PX),
            };
        }
        Self { pattern: frame(LEFT_PX, TOP_PX, 410.0, FRAME_PX), timeline: frame(480.0, TOP_PX, right, FRAME_PX) }
    }
}

/// Free border around the pattern.
const INSET_PX: f64 = 24.0;
/// With more changes of stage than this, Z is one line of one colour.
const MOST_RUNS: usize = 400;
/// A path of more corners is not drawn.
const MOST_CORNERS: usize = 4000;
/// With more holes than this, those on one place are one, and none has a number.
const MOST_HOLES: usize = 1000;
/// Radius of a hole's mark.
const HOLE_PX: f64 = 3.5;

/// Draws the pattern of holes, numbered, beside Z over time, coloured by what the machine does.
///
/// X and Y have one scale; a pattern that is nearly a row stands above Z instead.
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
    let corners = || holes.iter().map(|hole| [hole.x_mm, hole.y_mm]).chain(path_mm.iter().copied());
    let whole = |axis: usize| Range::of(corners().filter_map(|corner| corner.get(axis).copied()));
    let unit = Range { low: 0.0, high: 1.0 };
    let (x, y) = (whole(0).unwrap_or(unit), whole(1).unwrap_or(unit));
    let layout = Layout::of(x, y);
    let legend_y = layout.timeline.bottom + 50.0;
    picture(title, &description, legend_y + 22.0, |canvas| {
        let (x, y) = same_scale(x, y, layout.pattern);
        pattern(canvas, program, Frame { area: layout.pattern, x, y })?;
        timeline(canvas, z, layout.timeline)?;
        hole_legend(canvas, holes, (layout.pattern.left, layout.pattern.bottom + 50.0))?;
        stage_legend(canvas, z, (layout.timeline.left, legend_y))
    })
}

fn pattern(canvas: &mut Canvas<'_>, program: &ProgramPicture, frame: Frame) -> Result<(), PlotError> {
    frame.ground(canvas)?;
    frame.axes(canvas, true)?;
    frame.name_above(canvas, "Y, mm")?;
    frame.name_x(canvas, "X, mm")?;
    let path: Vec<(f64, f64)> = program.path_mm.iter().map(|[x, y]| (*x, *y)).collect();
    if (2..=MOST_CORNERS).contains(&path.len()) {
        canvas.path(&frame.places(&path), FRAME, 1.0)?;
    }
    let many = program.holes.len() > MOST_HOLES;
    let place = |hole: &HoleMark| frame.place((hole.x_mm, hole.y_mm));
    // The worst are drawn last, and are those that stay where many holes share a place.
    let mut marks: Vec<&HoleMark> = program.holes.iter().collect();
    marks.sort_by_key(|hole| hole.verdict);
    if many {
        let cell = |px: f64| (px / (2.0 * HOLE_PX)) as i64;
        let mut seen = BTreeSet::new();
        marks.reverse();
        marks.retain(|hole| seen.insert((cell(place(hole).0), cell(place(hole).1))));
        marks.reverse();
    }
    let mut labels = Labels::default();
    for hole in marks {
        canvas.dot(place(hole), HOLE_PX, hole.verdict.map_or(STROKE_IN, verdict_color))?;
        labels.taken.push(around(place(hole), HOLE_PX, HOLE_PX));
    }
    for hole in program.holes.iter().filter(|_| !many) {
        labels.write(canvas, place(hole), &hole.hole.to_string(), frame.area)?;
    }
    Ok(())
}

/// Both axes widened to one scale in px per mm.
fn same_scale(x: Range, y: Range, area: Area) -> (Range, Range) {
    let (width, height) = (area.width() - 2.0 * INSET_PX, area.bottom - area.top - 2.0 * INSET_PX);
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

fn timeline(canvas: &mut Canvas<'_>, z: &[ZPoint], area: Area) -> Result<(), PlotError> {
    let x = Range::of(z.iter().map(|point| point.time_s)).unwrap_or(Range { low: 0.0, high: 1.0 });
    let x = if x.span() > 0.0 { x } else { x.padded(0.0) };
    let y = Range::of(z.iter().map(|point| point.z_mm)).unwrap_or(Range { low: 0.0, high: 1.0 });
    let frame = Frame { area, x, y: y.padded(0.07) };
    frame.ground(canvas)?;
    frame.axes(canvas, true)?;
    frame.name_above(canvas, "Z, mm")?;
    frame.name_x(canvas, "time, s")?;
    let runs = z.chunk_by(|a, b| a.stage == b.stage).count();
    let columns = area.width() as usize;
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
        RowStage::Stroke(kind) => stroke_color(kind),
        RowStage::Rapid => SOFT_INK,
        RowStage::Orient => FRAME,
    }
}

fn hole_legend(canvas: &mut Canvas<'_>, holes: &[HoleMark], at: Point) -> Result<(), PlotError> {
    let counted: Vec<_> = [Verdict::Ok, Verdict::Warning, Verdict::Fail]
        .into_iter()
        .map(|verdict| (verdict, holes.iter().filter(|hole| hole.verdict == Some(verdict)).count()))
        .filter(|(_, count)| *count > 0)
        .map(|(verdict, count)| (verdict_color(verdict), format!("{count} {}", verdict.name())))
        .collect();
    canvas.legend(at, counted.iter().map(|(color, name)| (*color, name.as_str())))
}

fn stage_legend(canvas: &mut Canvas<'_>, z: &[ZPoint], at: Point) -> Result<(), PlotError> {
    let stages = [
        (RowStage::Rapid, "positioning"),
        (RowStage::Orient, "to rest"),
        (RowStage::Stroke(StrokeKind::In), "stroke in"),
        (RowStage::Stroke(StrokeKind::Dwell), "dwell"),
        (RowStage::Stroke(StrokeKind::Out), "stroke out"),
    ];
    let seen = stages.into_iter().filter(|(stage, _)| z.iter().any(|point| point.stage == *stage));
    canvas.legend(at, seen.map(|(stage, name)| (stage_color(stage), name)))
}

#[cfg(test)]
mod tests {
    use super::super::well_formed::assert_well_formed;
    use super::*;
    use proptest::prelude::*;

    fn grid(count: u32) -> ProgramPicture {
        let hole = |hole| HoleMark {
            hole,
            x_mm: f64::from(hole % 100) * 7.0,
            y_mm: f64::from(hole / 100) * 7.0,
            verdict: Some(if hole % 7 == 0 { Verdict::Fail } else { Verdict::Ok }),
        };
        let holes: Vec<HoleMark> = (1..=count).map(hole).collect();
        let path_mm = holes.iter().map(|hole| [hole.x_mm, hole.y_mm]).collect();
        let z = (0..200 * count).map(|step| ZPoint {
            time_s: f64::from(step) / 1000.0,
            z_mm: f64::from(step % 200),
            stage: if step % 200 < 100 { RowStage::Stroke(StrokeKind::In) } else { RowStage::Rapid },
        });
        ProgramPicture { holes, path_mm, z: z.collect() }
    }

    #[test]
    fn a_large_program_stays_a_small_file() {
        for count in [150, 900, 5000] {
            let svg = program_figure("grid", &grid(count)).unwrap();
            assert!(svg.len() < 300_000, "{count} holes: {} bytes", svg.len());
        }
    }

    #[test]
    fn every_hole_of_the_papers_row_has_its_number() {
        let svg = program_figure("row", &ProgramPicture { z: Vec::new(), ..grid(21) }).unwrap();
        assert!((1..=21).all(|hole| svg.contains(&format!("\n{hole}\n"))));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert_eq!(program_figure("", &ProgramPicture::default()), Err(PlotError::Nothing));
        let nan = ProgramPicture { path_mm: vec![[f64::NAN, 0.0]], ..Default::default() };
        assert!(matches!(program_figure("", &nan), Err(PlotError::NotDrawable { .. })));
    }

    proptest! {
        #[test]
        fn any_input_gives_a_picture_and_the_same_again(
            holes in prop::collection::vec((-1e15..1e15f64, prop_oneof![Just(0.0), -1e3..1e3f64]), 0..40),
            mut times in prop::collection::vec(-1e15..1e15f64, 1..40),
            title in any::<String>(),
        ) {
            times.sort_by(f64::total_cmp);
            let stage = RowStage::Orient;
            let picture = ProgramPicture {
                holes: holes.iter().map(|(x_mm, y_mm)| HoleMark { hole: 7, x_mm: *x_mm, y_mm: *y_mm, verdict: None }).collect(),
                path_mm: holes.iter().map(|(x_mm, y_mm)| [*x_mm, *y_mm]).collect(),
                z: times.iter().map(|time_s| ZPoint { time_s: *time_s, z_mm: -time_s, stage }).collect(),
            };
            let svg = program_figure(&title, &picture).unwrap();
            assert_well_formed(&svg);
            prop_assert_eq!(svg, program_figure(&title, &picture).unwrap());
        }
    }
}
