//! e(k) over k, one panel per law or setting, as in figure 5 of the torque-curve paper.

use crate::control::cycle::StrokeKind;

use super::axis::{Frame, Range};
use super::canvas::{Area, picture};
use super::error_panel::Drawing;
use super::error_scale::{Budget, ErrorPanel, LEFT_PX, RIGHT_PX, allowed, verdict_text};
use super::fault::{PlotError, check_drawable, check_order};
use super::line_panel::LinePanel;
use super::style::{Align, BAD, DWELL, Font, STROKE_IN, STROKE_OUT, TOLERANCE, WIDTH_PX};

/// A value beyond so many tolerances is off scale, so that a lost thread does not flatten the good ones beside it.
const SCALE_TOLERANCES: f64 = 3.0;
/// A panel that is off scale asks for so many tolerances of the common scale.
const OFF_SCALE_TOLERANCES: f64 = 1.25;

const HEAD_PX: f64 = 44.0;
/// A panel's title line above its frame.
const TITLE_PX: f64 = 26.0;
/// Tick labels under a frame: k, and below it the time.
const FOOT_PX: f64 = 40.0;
/// A tolerance that is this much wider than the error is not drawn whole: the error would be a line.
const WHOLE_TOLERANCE: f64 = 3.0;
const LEGEND_PX: f64 = 54.0;
/// Height of a frame of lines.
const LINES_PX: f64 = 150.0;
const NUMBERS_PX: f64 = 10.0;
const STROKES_PX: f64 = 5.0;

/// Draws e(k) over k, panels below each other on one common vertical scale.
///
/// The tolerance, a peak-to-peak width, is shaded where it holds the error band if it can; so the band inside the shade
/// means a good thread. Where it is more than three times as wide as all that is drawn, the scale is the error's, and the
/// shade fills it. A panel whose error goes beyond three tolerances is cut at the frame, with the cut marked and its
/// true band written beside it. Each panel starts at its own first period; all are as wide as the longest.
///
/// # Errors
/// [`PlotError`]: no panel, or values that no axis can show, or k not in rising order.
///
/// ```
/// use rigidtap::control::cycle::StrokeKind;
/// use rigidtap::report::plot::{ErrorPanel, error_figure};
/// use rigidtap::study::ErrorPoint;
/// let points = (0..500).map(|k| ErrorPoint { k, error_um: (k % 17) as f64 - 8.0, hole: 1, kind: StrokeKind::In });
/// let panel = ErrorPanel { title: "S3000".into(), tolerance_um: 53.0, peak_to_peak_um: 16.0, points: points.collect(), ..Default::default() };
/// let svg = error_figure("e(k) of one hole", &[panel]).unwrap();
/// assert!(svg.contains("peak to peak 16.0 of 53.0 µm"));
/// ```
pub fn error_figure(title: &str, panels: &[ErrorPanel]) -> Result<String, PlotError> {
    figure(title, panels, &[])
}

/// The same of one hole, and below it lines over the same time: what spindle and motor did.
///
/// # Errors
/// As [`error_figure`].
pub fn hole_figure(title: &str, panel: &ErrorPanel, lines: &[LinePanel]) -> Result<String, PlotError> {
    figure(title, std::slice::from_ref(panel), lines)
}

fn figure(title: &str, panels: &[ErrorPanel], lines: &[LinePanel]) -> Result<String, PlotError> {
    if panels.is_empty() {
        return Err(PlotError::Nothing);
    }
    for panel in panels {
        check_drawable(panel.points.iter().map(|point| point.error_um).chain([panel.tolerance_um, panel.period_s]))?;
        check_drawable(panel.points.last().map(|point| point.k as f64))?;
        check_order(panel.points.iter().map(|point| point.k as f64))?;
    }
    lines.iter().try_for_each(LinePanel::check)?;
    let bands: Vec<Option<Range>> = panels.iter().map(band).collect();
    let frame_px = (800.0 / panels.len() as f64).clamp(92.0, 250.0);
    let y = with_room(common_scale(panels, &bands), frame_px);
    let periods = panels.iter().filter_map(|panel| Some(panel.points.last()?.k - panel.points.first()?.k)).max();
    let budget = Budget::of(panels);
    let panel_px = TITLE_PX + frame_px + FOOT_PX;
    let lines_px = TITLE_PX + LINES_PX + FOOT_PX;
    let height_px = HEAD_PX + panels.len() as f64 * panel_px + lines.len() as f64 * lines_px + LEGEND_PX;
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
            Drawing { panel, band: *band, frame: Frame { area, x, y }, budget }.draw(canvas)?;
            top += panel_px;
        }
        for (lines, panel) in lines.iter().zip(panels.iter().cycle()) {
            let first = panel.points.first().map_or(0.0, |point| point.k as f64);
            let area = Area {
                left: LEFT_PX,
                top: top + TITLE_PX,
                right: WIDTH_PX - RIGHT_PX,
                bottom: top + TITLE_PX + LINES_PX,
            };
            let x = Range { low: first, high: first + periods.unwrap_or(0).max(1) as f64 };
            lines.draw(canvas, Frame { area, x, y: lines.range() }, panel.period_s, budget)?;
            top += lines_px;
        }
        let wider = panels.iter().zip(&bands).any(|(panel, band)| {
            let shade = allowed(panel, *band);
            panel.tolerance_um > 0.0 && (shade.low < y.low || shade.high > y.high)
        });
        let cut = bands.iter().flatten().any(|band| band.low < y.low || band.high > y.high);
        let dwells = panels.iter().any(|panel| panel.points.iter().any(|point| point.kind == StrokeKind::Dwell));
        let middle = (LEFT_PX + WIDTH_PX - RIGHT_PX) / 2.0;
        let timed = panels.iter().any(|panel| panel.period_s > 0.0);
        let name = if timed { "period k, and its time" } else { "period k" };
        canvas.text((middle, top + 2.0), name, Font::CAPTION.aligned(Align::Middle))?;
        let entries = [
            (!wider, TOLERANCE, "tolerance, peak to peak"),
            (wider, TOLERANCE, "tolerance, peak to peak: wider than this scale"),
            (budget.strokes, STROKE_IN, "stroke in"),
            (budget.strokes && dwells, DWELL, "dwell"),
            (budget.strokes, STROKE_OUT, "stroke out"),
            (cut, BAD, "off scale, true value at the right"),
        ];
        let shown = entries.into_iter().filter(|(shown, ..)| *shown).map(|(_, color, name)| (color, name));
        canvas.legend((LEFT_PX, top + 28.0), shown)
    })
}

fn band(panel: &ErrorPanel) -> Option<Range> {
    Range::of(panel.points.iter().map(|point| point.error_um))
}

/// The vertical scale of all panels.
fn common_scale(panels: &[ErrorPanel], bands: &[Option<Range>]) -> Range {
    let tolerance_um = panels.iter().map(|panel| panel.tolerance_um).fold(0.0, f64::max);
    // Without a tolerance nothing can be off scale.
    let limit = if tolerance_um > 0.0 { SCALE_TOLERANCES * tolerance_um } else { f64::INFINITY };
    let shown = |value: f64| {
        if value.abs() <= limit { value } else { value.signum() * OFF_SCALE_TOLERANCES * tolerance_um }
    };
    let drawn = bands.iter().flatten().flat_map(|band| [shown(band.low), shown(band.high)]);
    let data = Range::of(drawn.chain([0.0])).unwrap_or(Range { low: 0.0, high: 0.0 });
    let shades = panels.iter().zip(bands).map(|(panel, band)| allowed(panel, *band));
    let fitting = shades.filter(|shade| shade.span() <= WHOLE_TOLERANCE * data.span() || data.span() == 0.0);
    let shown = fitting.flat_map(|shade| [shade.low, shade.high]);
    Range::of(shown.chain([data.low, data.high])).unwrap_or(data).padded(0.05)
}

/// Leaves room on a scale for the numbers of holes above the error, and for the strokes below it.
fn with_room(scale: Range, frame_px: f64) -> Range {
    let per_px = scale.span() / (frame_px - NUMBERS_PX - STROKES_PX);
    Range { low: scale.low - STROKES_PX * per_px, high: scale.high + NUMBERS_PX * per_px }
}

#[cfg(test)]
mod tests {
    use super::super::well_formed::assert_well_formed;
    use super::*;
    use crate::run::Verdict;
    use crate::study::ErrorPoint;
    use proptest::prelude::*;

    fn panel(tolerance_um: f64, errors: impl IntoIterator<Item = f64>) -> ErrorPanel {
        let points = errors.into_iter().zip(0..).map(|(error_um, k)| {
            let kind = if k % 1000 < 500 { StrokeKind::In } else { StrokeKind::Out };
            ErrorPoint { k, error_um, hole: (k / 1000) as u32 + 1, kind }
        });
        ErrorPanel {
            title: "S-curve <S7000>".into(),
            tolerance_um,
            peak_to_peak_um: 1.0,
            verdict: Verdict::Fail,
            period_s: 0.001,
            points: points.collect(),
        }
    }

    #[test]
    fn the_scale_is_the_errors_where_the_tolerance_is_far_wider() {
        let scale = |tolerance_um: f64| {
            let panels = [panel(tolerance_um, [0.0, 4.0, -2.0])];
            common_scale(&panels, &[band(&panels[0])])
        };
        // 18 µm are three times 6 µm: the shade is shown whole, about the error's middle.
        assert!(scale(18.0).low < -8.0 && scale(18.0).high > 10.0);
        assert!(scale(18.1).span() < 7.0 && scale(1000.0) == scale(18.1));
        let svg = error_figure("e(k)", &[panel(1000.0, [0.0, 4.0, -2.0])]).unwrap();
        assert!(
            svg.contains("wider than this scale") && svg.contains("period k, and its time") && svg.contains("of 1")
        );
    }

    #[test]
    fn a_lost_thread_does_not_flatten_the_good_one() {
        let panels = [panel(53.0, [0.0, 14_012.0, -300.0]), panel(53.0, [0.0, 12.0, -8.0])];
        let bands: Vec<_> = panels.iter().map(band).collect();
        let scale = common_scale(&panels, &bands);
        assert!(scale.span() < 3.0 * 53.0 && scale.low < -26.5 && scale.high > 26.5, "{scale:?}");
        let svg = error_figure("e(k)", &panels).unwrap();
        assert!(svg.contains("max +14\u{2009}012 ▲") && svg.contains("min −300 ▼") && svg.contains("min −8.0"));
    }

    #[test]
    fn a_band_that_fits_the_tolerance_lies_in_the_shade() {
        let shade = |errors| {
            let panel = panel(50.0, errors);
            allowed(&panel, band(&panel))
        };
        assert_eq!(shade([0.0, 40.0]), Range { low: -5.0, high: 45.0 });
        assert_eq!(shade([-60.0, 60.0]), Range { low: -25.0, high: 25.0 });
    }

    #[test]
    fn lines_stand_below_the_error_over_the_same_time() {
        let speed = |values: &[f64]| LinePanel {
            title: "spindle speed, rpm".into(),
            lines: vec![("command".into(), (0..).zip(values.iter().copied()).collect())],
        };
        let one = panel(50.0, [0.0, 4.0, -2.0]);
        let svg = hole_figure("one hole", &one, &[speed(&[0.0, 3000.0, 0.0]), speed(&[1.0])]).unwrap();
        assert_well_formed(&svg);
        assert_eq!(svg.matches("spindle speed, rpm").count(), 2);
        assert!(svg.contains("command") && svg.contains("2000"));
        assert!(matches!(hole_figure("", &one, &[speed(&[f64::NAN])]), Err(PlotError::NotDrawable { .. })));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert_eq!(error_figure("", &[]), Err(PlotError::Nothing));
        assert!(matches!(error_figure("", &[panel(53.0, [f64::NAN])]), Err(PlotError::NotDrawable { .. })));
        assert!(matches!(error_figure("", &[panel(f64::INFINITY, [])]), Err(PlotError::NotDrawable { .. })));
        let mut back = panel(53.0, [1.0, 2.0]);
        back.points.reverse();
        assert_eq!(error_figure("", &[back]), Err(PlotError::Order { at: 0.0, previous: 1.0 }));
    }

    #[test]
    fn large_inputs_stay_small_files() {
        let noise = |k: u64, size: f64| ((k * 7919 % 1000) as f64 / 500.0 - 1.0) * size;
        for size in [30.0, 14_000.0] {
            let panels = vec![panel(53.0, (0..300_000).map(|k| noise(k, size))); 9];
            assert!(error_figure("e(k)", &panels).unwrap().len() < 300_000);
        }
        let program = vec![panel(53.0, (0..21_000).map(|k| noise(k, 14_000.0))); 9];
        assert!(error_figure("e(k)", &program).unwrap().len() < 300_000);
    }

    fn any_error() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), -100.0..0.0f64, -20.0..20.0f64, -1e15..1e15f64, Just(f64::MIN_POSITIVE)]
    }

    proptest! {
        #[test]
        fn any_input_gives_a_picture_and_the_same_again(
            panels in prop::collection::vec((0.0..100.0f64, prop::collection::vec(any_error(), 0..200)), 1..10),
            title in any::<String>(),
        ) {
            let panels: Vec<_> = panels.into_iter().map(|(tolerance, errors)| panel(tolerance, errors)).collect();
            let svg = error_figure(&title, &panels).unwrap();
            assert_well_formed(&svg);
            prop_assert_eq!(svg, error_figure(&title, &panels).unwrap());
        }
    }
}
