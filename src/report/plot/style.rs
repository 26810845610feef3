//! The common style: palette, sizes, fonts, and how numbers are written.

use plotters::style::RGBColor;

use crate::control::cycle::StrokeKind;
use crate::run::Verdict;

/// Width of every picture.
pub(super) const WIDTH_PX: f64 = 900.0;
/// Free border of every picture.
pub(super) const MARGIN_PX: f64 = 20.0;

/// Behind everything.
pub(super) const BACKGROUND: RGBColor = RGBColor(0xFA, 0xFA, 0xF8);
/// Behind the data.
pub(super) const PLOT_AREA: RGBColor = RGBColor(0xFF, 0xFF, 0xFF);
/// Titles and values.
pub(super) const INK: RGBColor = RGBColor(0x26, 0x2B, 0x33);
/// Axes and captions.
pub(super) const SOFT_INK: RGBColor = RGBColor(0x5B, 0x63, 0x6E);
/// Grid lines.
pub(super) const GRID: RGBColor = RGBColor(0xE6, 0xE8, 0xEB);
/// Frames around the data, and the line at zero.
pub(super) const FRAME: RGBColor = RGBColor(0xB9, 0xBF, 0xC7);
/// What is allowed.
pub(super) const TOLERANCE: RGBColor = RGBColor(0xDC, 0xED, 0xE4);
/// What is not.
pub(super) const FORBIDDEN: RGBColor = RGBColor(0xF7, 0xE6, 0xDD);

/// Stroke in.
pub(super) const STROKE_IN: RGBColor = RGBColor(0x00, 0x72, 0xB2);
/// Dwell.
pub(super) const DWELL: RGBColor = RGBColor(0xE6, 0x9F, 0x00);
/// Stroke out.
pub(super) const STROKE_OUT: RGBColor = RGBColor(0x6F, 0xBD, 0xE8);
/// Measured values.
pub(super) const DATA: RGBColor = RGBColor(0x1F, 0x4E, 0x79);

/// Good.
const GOOD: RGBColor = RGBColor(0x00, 0x7A, 0x5A);
/// To be watched.
const DOUBTFUL: RGBColor = RGBColor(0x9A, 0x6A, 0x00);
/// Bad.
pub(super) const BAD: RGBColor = RGBColor(0xB8, 0x45, 0x0B);

/// Things side by side: the palette of Okabe and Ito, told apart by colour-blind readers, its yellow left out.
const SERIES: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xB8, 0x5C, 0x8E),
    RGBColor(0xD6, 0x91, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
    RGBColor(0x4A, 0x4F, 0x57),
];

/// What stands for a colour where the reader prefers dark pages; a colour that is not here stays.
const DARK: [(RGBColor, RGBColor); 15] = [
    (BACKGROUND, RGBColor(0x14, 0x17, 0x1B)),
    (PLOT_AREA, RGBColor(0x1B, 0x1F, 0x24)),
    (INK, RGBColor(0xE4, 0xE7, 0xEB)),
    (SOFT_INK, RGBColor(0xA4, 0xAC, 0xB8)),
    (GRID, RGBColor(0x2C, 0x32, 0x39)),
    (FRAME, RGBColor(0x4A, 0x52, 0x5C)),
    (TOLERANCE, RGBColor(0x1C, 0x3B, 0x2E)),
    (FORBIDDEN, RGBColor(0x42, 0x29, 0x1D)),
    (STROKE_IN, RGBColor(0x3A, 0x9B, 0xDC)),
    (STROKE_OUT, RGBColor(0x2C, 0x5F, 0x80)),
    (DATA, RGBColor(0x84, 0xBD, 0xF0)),
    (GOOD, RGBColor(0x4C, 0xC7, 0x9F)),
    (DOUBTFUL, RGBColor(0xE0, 0xB0, 0x40)),
    (BAD, RGBColor(0xF0, 0x88, 0x4E)),
    (RGBColor(0x4A, 0x4F, 0x57), RGBColor(0xA9, 0xB0, 0xBA)),
];

/// The rules that give a picture its dark colours.
pub(super) fn dark_rules() -> String {
    let hex = |RGBColor(red, green, blue): RGBColor| format!("#{red:02X}{green:02X}{blue:02X}");
    let rule = |(light, dark): (RGBColor, RGBColor)| {
        let (light, dark) = (hex(light), hex(dark));
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    format!("@media (prefers-color-scheme: dark){{{}}}", DARK.map(rule).concat())
}

/// Colour of a verdict.
pub(super) const fn verdict_color(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Ok => GOOD,
        Verdict::Warning => DOUBTFUL,
        Verdict::Fail => BAD,
    }
}

/// Colour of a part of a hole.
pub(super) const fn stroke_color(kind: StrokeKind) -> RGBColor {
    match kind {
        StrokeKind::In => STROKE_IN,
        StrokeKind::Dwell => DWELL,
        StrokeKind::Out => STROKE_OUT,
    }
}

/// Colour of the n-th of several things.
pub(super) fn series(index: usize) -> RGBColor {
    SERIES.get(index % SERIES.len()).copied().unwrap_or(INK)
}

/// How text stands to its point, horizontally.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Middle,
    Right,
}

/// How a text looks; it is centred on its point vertically.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font {
    pub(super) size_px: f64,
    pub(super) color: RGBColor,
    pub(super) bold: bool,
    pub(super) align: Align,
    /// Reads from bottom to top.
    pub(super) upwards: bool,
}

impl Font {
    const fn plain(size_px: f64, color: RGBColor) -> Self {
        Self { size_px, color, bold: false, align: Align::Left, upwards: false }
    }

    /// The picture's title.
    pub(super) const TITLE: Self = Self { bold: true, ..Self::plain(16.0, INK) };
    /// A panel's title.
    pub(super) const HEADING: Self = Self { bold: true, ..Self::plain(12.5, INK) };
    /// Values.
    pub(super) const VALUE: Self = Self::plain(11.0, INK);
    /// Captions, legends, tick labels.
    pub(super) const CAPTION: Self = Self::plain(11.0, SOFT_INK);
    /// Small marks inside the data.
    pub(super) const MARK: Self = Self::plain(9.0, SOFT_INK);

    pub(super) const fn aligned(self, align: Align) -> Self {
        Self { align, ..self }
    }

    pub(super) const fn colored(self, color: RGBColor) -> Self {
        Self { color, ..self }
    }

    /// Width that a text takes at most, estimated: the reader's font is not known.
    pub(super) fn width_px(&self, text: &str) -> f64 {
        let share = if self.bold { 0.64 } else { 0.58 };
        text.chars().count() as f64 * share * self.size_px
    }

    /// As much of a text as fits, with an ellipsis for the rest.
    pub(super) fn fit(&self, text: &str, width_px: f64) -> String {
        if self.width_px(text) <= width_px {
            return text.to_owned();
        }
        let count = (width_px / self.width_px("m")).max(1.0) as usize;
        text.chars().take(count.saturating_sub(1)).chain(['…']).collect()
    }
}

/// A number with so many decimals, a true minus sign, and thin spaces between thousands from 10 000 on.
pub(super) fn number(value: f64, decimals: usize) -> String {
    if value.abs() >= 1e7 {
        return format!("{value:.2e}").replace('-', "−");
    }
    let digits = format!("{:.decimals$}", value.abs());
    let (whole, fraction) = digits.split_once('.').map_or((digits.as_str(), None), |(w, f)| (w, Some(f)));
    let mut text = String::new();
    // A value that rounds to nothing has no sign.
    if value < 0.0 && digits.contains(|c: char| ('1'..='9').contains(&c)) {
        text.push('−');
    }
    for (index, digit) in whole.chars().enumerate() {
        if index > 0 && whole.len() > 4 && (whole.len() - index) % 3 == 0 {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    if let Some(fraction) = fraction {
        text.push('.');
        text.push_str(fraction);
    }
    text
}

/// A measured value: three or four digits that matter.
pub(super) fn measured(value: f64) -> String {
    let decimals = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 0.995 => 1,
        0.0 => 0,
        _ => 2,
    };
    number(value, decimals)
}

/// The same with its sign, also where it is positive.
pub(super) fn signed(value: f64) -> String {
    let text = measured(value);
    if value > 0.0 { format!("+{text}") } else { text }
}

/// Power of a thousand that an axis up to `greatest` is divided by, with its name before the unit.
pub(super) fn thousands(greatest: f64) -> (f64, &'static str) {
    match greatest {
        size if size < 1e4 => (1.0, ""),
        size if size < 1e6 => (1e3, "10³ "),
        size if size < 1e9 => (1e6, "10⁶ "),
        _ => (1e9, "10⁹ "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(number(-0.001, 1), "0.0");
        assert_eq!(number(-14012.4, 0), "−14\u{2009}012");
        assert_eq!(number(1234567.5, 1), "1\u{2009}234\u{2009}567.5");
        assert_eq!(measured(12.345), "12.3");
        assert_eq!(measured(0.0), "0");
        assert_eq!(signed(0.25), "+0.25");
        assert_eq!(number(-3e12, 0), "−3.00e12");
    }

    #[test]
    fn a_long_text_is_cut_to_its_width() {
        let cut = Font::HEADING.fit(&"S-curve ".repeat(50), 300.0);
        assert!(cut.ends_with('…') && Font::HEADING.width_px(&cut) <= 300.0);
    }
}
