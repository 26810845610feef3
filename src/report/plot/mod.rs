//! Plots as SVG text: one file per kind of picture over one common style.
//!
//! Every picture is about 900 px wide, on a background of its own, light or as the reader prefers it, with plain text in a generic font,
//! colours that the colour-blind tell apart, and a title and description for screen readers. The same input gives the
//! same bytes.

mod axis;
mod canvas;
mod error_figure;
mod error_panel;
mod error_scale;
mod fault;
mod histogram_figure;
mod line_panel;
mod profile_figure;
mod program_figure;
mod reduce;
mod style;
#[cfg(test)]
mod well_formed;

pub use error_figure::{error_figure, hole_figure};
pub use error_scale::ErrorPanel;
pub use fault::PlotError;
pub use histogram_figure::histogram_figure;
pub use line_panel::LinePanel;
pub use profile_figure::profile_figure;
pub use program_figure::{HoleMark, ProgramPicture, ZPoint, program_figure};
