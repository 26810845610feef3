//! A sheet to draw on in px, over plotters' SVG writer.

use plotters::prelude::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, TextStyle};

use super::fault::PlotError;
use super::style::{Align, BACKGROUND, Font, MARGIN_PX, WIDTH_PX, dark_rules};

/// plotters draws on whole units: this many of them to a px keep slopes smooth.
const UNITS_PER_PX: f64 = 4.0;
/// plotters' SVG writer divides font sizes by this.
const FONT_FACTOR: f64 = 1.24;

/// A point on the sheet, in px from its upper left corner.
pub(super) type Point = (f64, f64);

/// A rectangle on the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }
}

/// The sheet.
pub(super) struct Canvas<'a> {
    backend: SVGBackend<'a>,
}

/// Draws a picture of [`WIDTH_PX`] and a height, with its title on top, and returns its text.
pub(super) fn picture(
    title: &str,
    description: &str,
    height_px: f64,
    draw: impl FnOnce(&mut Canvas<'_>) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let mut body = String::new();
    let mut canvas =
        Canvas { backend: SVGBackend::with_string(&mut body, (unit(WIDTH_PX) as u32, unit(height_px) as u32)) };
    canvas.fill(Area { left: 0.0, top: 0.0, right: WIDTH_PX, bottom: height_px }, BACKGROUND)?;
    let shown = Font::TITLE.fit(title, WIDTH_PX - 2.0 * MARGIN_PX);
    canvas.text((MARGIN_PX, 24.0), &shown, Font::TITLE)?;
    draw(&mut canvas)?;
    canvas.backend.present().map_err(|_| PlotError::Drawing)?;
    drop(canvas);
    // The library's own head states the size in its units, and knows no title.
    let (_, drawn) = body.split_once('>').ok_or(PlotError::Drawing)?;
    let (width, height) = (unit(WIDTH_PX), unit(height_px));
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH_PX}\" height=\"{height_px}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{}</title>\n<desc>{}</desc>\n<style>{}</style>{drawn}",
        escape(title),
        escape(description),
        dark_rules(),
    ))
}

impl Canvas<'_> {
    /// Fills a rectangle.
    pub(super) fn fill(&mut self, area: Area, color: RGBColor) -> Result<(), PlotError> {
        let (from, to) = (units((area.left, area.top)), units((area.right, area.bottom)));
        self.backend.draw_rect(from, to, &color.filled(), true).map_err(|_| PlotError::Drawing)
    }

    /// Fills a polygon.
    pub(super) fn polygon(&mut self, points: &[Point], color: RGBColor) -> Result<(), PlotError> {
        self.backend
            .fill_polygon(points.iter().map(|point| units(*point)), &color.filled())
            .map_err(|_| PlotError::Drawing)
    }

    /// Draws straight lines from point to point; a single point becomes a dot.
    pub(super) fn path(&mut self, points: &[Point], color: RGBColor, width_px: f64) -> Result<(), PlotError> {
        if let [point] = points {
            return self.dot(*point, 1.5 * width_px, color);
        }
        let style = ShapeStyle { color: color.to_rgba(), filled: false, stroke_width: unit(width_px).max(1) as u32 };
        let mut points: Vec<_> = points.iter().map(|point| units(*point)).collect();
        points.dedup();
        self.backend.draw_path(points, &style).map_err(|_| PlotError::Drawing)
    }

    /// Draws the outline of a rectangle.
    pub(super) fn outline(&mut self, area: Area, color: RGBColor) -> Result<(), PlotError> {
        let Area { left, top, right, bottom } = area;
        self.path(&[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], color, 1.0)
    }

    /// Draws a dot.
    pub(super) fn dot(&mut self, at: Point, radius_px: f64, color: RGBColor) -> Result<(), PlotError> {
        self.backend
            .draw_circle(units(at), unit(radius_px).max(1) as u32, &color.filled(), true)
            .map_err(|_| PlotError::Drawing)
    }

    /// Explains colours in a row.
    pub(super) fn legend<'n>(
        &mut self,
        (mut x, y): Point,
        entries: impl IntoIterator<Item = (RGBColor, &'n str)>,
    ) -> Result<(), PlotError> {
        for (color, name) in entries {
            self.fill(Area { left: x, top: y - 4.0, right: x + 14.0, bottom: y + 4.0 }, color)?;
            self.text((x + 19.0, y), name, Font::CAPTION)?;
            x += 33.0 + Font::CAPTION.width_px(name);
        }
        Ok(())
    }

    /// Writes a text, vertically centred on its point.
    pub(super) fn text(&mut self, at: Point, text: &str, font: Font) -> Result<(), PlotError> {
        let h_pos = match font.align {
            Align::Left => HPos::Left,
            Align::Middle => HPos::Center,
            Align::Right => HPos::Right,
        };
        let weight = if font.bold { FontStyle::Bold } else { FontStyle::Normal };
        let face = (FontFamily::SansSerif, font.size_px * UNITS_PER_PX * FONT_FACTOR, weight);
        let mut style = TextStyle::from(face).color(&font.color).pos(Pos::new(h_pos, VPos::Center));
        if font.upwards {
            style = style.transform(FontTransform::Rotate270);
        }
        self.backend.draw_text(&printable(text), &style, units(at)).map_err(|_| PlotError::Drawing)
    }
}

fn unit(px: f64) -> i32 {
    (px * UNITS_PER_PX).round() as i32
}

fn units((x, y): Point) -> (i32, i32) {
    (unit(x), unit(y))
}

/// XML has no place for control characters, however they are escaped.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') { ' ' } else { c }).collect()
}

fn escape(text: &str) -> String {
    printable(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::super::well_formed::assert_well_formed;
    use super::*;

    #[test]
    fn every_colour_of_the_ground_and_of_text_has_its_dark_one() {
        let svg = picture("dark", "", 100.0, |canvas| {
            canvas.text((10.0, 10.0), "text", Font::VALUE)?;
            canvas.text((10.0, 40.0), "caption", Font::CAPTION)
        });
        let svg = svg.unwrap();
        let (rules, drawn) = svg.split_once("</style>").unwrap();
        let colours: Vec<_> = drawn.split("fill=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        assert!(colours.len() >= 4);
        for colour in colours {
            assert!(rules.contains(&format!("[fill=\"{colour}\"]{{fill:")), "{colour}");
        }
    }

    #[test]
    fn names_of_any_kind_stay_text() {
        let svg = picture("<a> & \"b\" \u{0}\n", "'d' ]]>", 100.0, |canvas| {
            canvas.text((10.0, 10.0), "<text> & more\u{1}", Font::VALUE)
        });
        assert_well_formed(&svg.unwrap());
    }
}
