//! Plots as SVG text: one file per kind of picture over one common style.
//!
//! Every picture is about 900 px wide, on a light background of its own, with plain text elements in a generic font,
//! colours that the colour-blind tell apart, and a title and description for screen readers. The same input gives the
//! same bytes.

mod axis;
mod canvas;
mod error_figure;
mod error_panel;
mod histogram_figure;
mod profile_figure;
mod program_figure;
mod reduce;
mod style;

pub use error_figure::{ErrorPanel, error_figure};
pub use histogram_figure::histogram_figure;
pub use profile_figure::profile_figure;
pub use program_figure::{HoleMark, ProgramPicture, ZPoint, program_figure};

/// Greatest magnitude that a plot shows; anything beyond is no measurement.
const GREATEST: f64 = 1e15;

/// Why there is no picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlotError {
    /// No panel, profile, hole or point to draw.
    Nothing,
    /// A number that is not finite, or beyond 1e15.
    NotDrawable {
        /// The number.
        value: f64,
    },
    /// Points are not in rising order of period or time.
    Order {
        /// Period or time of the offending point.
        at: f64,
        /// That of the point before it.
        previous: f64,
    },
    /// The drawing library refused.
    Drawing,
}

impl core::fmt::Display for PlotError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Nothing => write!(f, "nothing to draw"),
            Self::NotDrawable { value } => write!(f, "cannot draw the value {value}"),
            Self::Order { at, previous } => write!(f, "cannot draw points out of order: {at} after {previous}"),
            Self::Drawing => write!(f, "the drawing library refused"),
        }
    }
}

impl core::error::Error for PlotError {}

/// Refuses what no axis can show.
fn check_drawable(values: impl IntoIterator<Item = f64>) -> Result<(), PlotError> {
    match values.into_iter().find(|value| !(-GREATEST..=GREATEST).contains(value)) {
        Some(value) => Err(PlotError::NotDrawable { value }),
        None => Ok(()),
    }
}

/// Refuses points that go back.
fn check_order(positions: impl Iterator<Item = f64>) -> Result<(), PlotError> {
    let mut previous = f64::NEG_INFINITY;
    for at in positions {
        if at < previous {
            return Err(PlotError::Order { at, previous });
        }
        previous = at;
    }
    Ok(())
}

#[cfg(test)]
mod well_formed {
    //! A check of what a picture's text must be; enough XML for what is written here.

    /// Tags open and close in order, attributes are quoted, no stray markup or control character, one root.
    pub(super) fn assert_well_formed(svg: &str) {
        let mut open: Vec<&str> = Vec::new();
        let mut rest = svg;
        assert!(svg.starts_with("<svg ") && svg.contains("<title>"), "no title: {}", &svg[..svg.len().min(200)]);
        while let Some((text, tail)) = rest.split_once('<') {
            assert_text(text);
            let (tag, tail) = tail.split_once('>').expect("a tag without end");
            if let Some(name) = tag.strip_prefix('/') {
                assert_eq!(open.pop(), Some(name));
            } else {
                let name = tag.split([' ', '/']).next().expect("a name");
                assert_eq!(tag.matches('"').count() % 2, 0, "quotes in <{tag}>");
                tag.split('"').for_each(assert_text);
                if !tag.ends_with('/') {
                    open.push(name);
                }
            }
            rest = tail;
            assert!(!open.is_empty() || rest.trim().is_empty(), "text after the root");
        }
        assert!(open.is_empty(), "left open: {open:?}");
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "a number that is none");
    }

    fn assert_text(text: &str) {
        assert!(!text.contains('>') && !text.chars().any(|c| c.is_control() && c != '\n'), "stray markup: {text:?}");
        for entity in text.split('&').skip(1) {
            let name = entity.split(';').next();
            assert!(matches!(name, Some("lt" | "gt" | "amp" | "quot" | "apos")), "entity {name:?}");
        }
    }
}
