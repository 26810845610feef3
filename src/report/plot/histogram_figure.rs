//! How often each value occurred, with its percentiles.

use crate::study::Percentiles;

use super::axis::{Frame, Range};
use super::canvas::{Area, Canvas, picture};
use super::fault::{PlotError, check_drawable};
use super::style::{Align, DATA, Font, INK, MARGIN_PX, WIDTH_PX, measured, number};

const LEFT_PX: f64 = 70.0;
const TOP_PX: f64 = 108.0;
const BOTTOM_PX: f64 = 380.0;
const HEIGHT_PX: f64 = 430.0;
/// Room that a percentile's name takes; the names stand in rows, so that near ones do not overlap.
const MARK_ROW_PX: f64 = 15.0;
const BARS: usize = 60;
/// The axis ends so far beyond the 99.9th percentile, as a factor on its distance from the least value: a tail that is
/// longer would leave the rest no room.
const TAIL: f64 = 1.5;

/// Draws the distribution of values, with the percentiles of [`Percentiles`]. A tail far beyond the 99.9th percentile,
/// and what is infinite, is counted in the caption and not drawn.
///
/// # Errors
/// [`PlotError`]: no value at all, or one that no axis can show.
///
/// ```
/// use rigidtap::report::plot::histogram_figure;
/// let svg = histogram_figure("Errors", "µm", &[1.0, 2.0, 2.0, 5.0]).unwrap();
/// assert!(svg.contains("99.9 %") && svg.contains("4 machines"));
/// ```
pub fn histogram_figure(title: &str, name: &str, values: &[f64]) -> Result<String, PlotError> {
    let percentiles = Percentiles::of(values.iter().copied());
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    if values.is_empty() {
        return Err(PlotError::Nothing);
    }
    let Range { low, high } = Range::of(finite()).unwrap_or(Range { low: 0.0, high: 1.0 });
    check_drawable([low, high])?;
    let tail_end = low + TAIL * (percentiles.p999 - low);
    let shown = if tail_end > low { high.min(tail_end) } else { high };
    let x = Range { low, high: shown }.padded(0.02);
    let mut counts = [0_u32; BARS];
    for value in finite().filter(|value| *value <= shown) {
        let bar = ((value - x.low) / x.span() * BARS as f64) as usize;
        if let Some(count) = counts.get_mut(bar.min(BARS - 1)) {
            *count += 1;
        }
    }
    let beyond = values.iter().filter(|value| !(**value <= shown)).count();
    let caption = caption(values.len(), beyond, percentiles.max);
    let most = counts.iter().copied().max().map_or(1.0, f64::from);
    let area = Area { left: LEFT_PX, top: TOP_PX, right: WIDTH_PX - MARGIN_PX, bottom: BOTTOM_PX };
    let frame = Frame { area, x, y: Range { low: 0.0, high: 1.05 * most } };
    let marks = marks(&percentiles);
    let description = marks.iter().filter(|(_, value)| value.is_finite());
    let description: Vec<_> = description.map(|(name, value)| format!("{name} {}", measured(*value))).collect();
    picture(title, &format!("{caption}; {}", description.join(", ")), HEIGHT_PX, |canvas| {
        canvas.text((MARGIN_PX, 44.0), &caption, Font::CAPTION)?;
        frame.ground(canvas)?;
        frame.axes(canvas, true)?;
        frame.name_x(canvas, name)?;
        frame.name_y(canvas, "machines")?;
        let width = x.span() / BARS as f64;
        for (index, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let column = frame.column(x.low + width * index as f64, x.low + width * (index + 1) as f64);
            canvas.fill(Area { top: frame.y_px(f64::from(*count)), right: column.right - 1.0, ..column }, DATA)?;
        }
        marks.iter().enumerate().try_for_each(|(row, mark)| draw_mark(canvas, &frame, row, mark))
    })
}

fn marks(percentiles: &Percentiles) -> [(&'static str, f64); 4] {
    let Percentiles { p50, p99, p999, max } = *percentiles;
    [("50 %", p50), ("99 %", p99), ("99.9 %", p999), ("max", max)]
}

/// A percentile's line with its name above the frame; none where it lies beyond the axis.
fn draw_mark(canvas: &mut Canvas<'_>, frame: &Frame, row: usize, (name, value): &(&str, f64)) -> Result<(), PlotError> {
    if frame.x.clamp(*value) != *value {
        return Ok(());
    }
    let x = frame.x_px(*value);
    let y = frame.area.top - 6.0 - MARK_ROW_PX * (3 - row) as f64;
    canvas.path(&[(x, y), (x, frame.area.bottom)], INK, 1.0)?;
    let text = format!("{name}: {}", measured(*value));
    // Where the frame ends the name turns to the other side.
    let (at, align) = if x + Font::VALUE.width_px(&text) > frame.area.right {
        (x - 4.0, Align::Right)
    } else {
        (x + 4.0, Align::Left)
    };
    canvas.text((at, y + 3.0), &text, Font::VALUE.aligned(align))
}

fn caption(all: usize, beyond: usize, max: f64) -> String {
    let machines = format!("{} machines", number(all as f64, 0));
    match beyond {
        0 => machines,
        beyond if max.is_finite() => format!("{machines}, {beyond} of them beyond the axis, up to {}", measured(max)),
        beyond => format!("{machines}, {beyond} of them beyond the axis"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::well_formed::assert_well_formed;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn nothing_is_refused() {
        assert_eq!(histogram_figure("", "", &[]), Err(PlotError::Nothing));
        assert!(histogram_figure("", "", &[f64::INFINITY]).unwrap().contains("1 of them beyond the axis"));
        assert_eq!(histogram_figure("", "", &[1e20]), Err(PlotError::NotDrawable { value: 1e20 }));
    }

    #[test]
    fn a_long_tail_is_counted() {
        let mut values: Vec<f64> = (0..5000).map(|index| 10.0 + f64::from(index % 100) / 100.0).collect();
        values.extend([700.0, f64::INFINITY]);
        let svg = histogram_figure("", "", &values).unwrap();
        assert!(svg.contains("2 of them beyond the axis"));
        assert_well_formed(&svg);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn any_values_give_a_picture_and_the_same_again(
            values in proptest::collection::vec(prop_oneof![-1e3..1e3f64, Just(7.0), Just(f64::INFINITY), Just(f64::NAN)], 1..300),
        ) {
            let svg = histogram_figure("title", "µm", &values).unwrap();
            assert_well_formed(&svg);
            prop_assert_eq!(svg, histogram_figure("title", "µm", &values).unwrap());
        }
    }
}
