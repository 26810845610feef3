//! A report as one page for a browser, with nothing beside it: no network, no other file.
//!
//! The figures are drawn by a script of some kilobytes in the page itself. (The crate `plotly` embeds a script of four
//! megabytes in each page, and brings a template engine: more than all of this program's own text.) The answer in JSON
//! stands in the page, too, so that whoever reads it by program has the same numbers.

mod html;
mod monitor;
mod parts;
mod simulate;
mod studies;

pub use html::{Chart, ChartSet, Heading, Level, Line, Page, Table};
pub use monitor::{MeasuredRecorder, table_of_measured};
pub use simulate::{HoleCurves, HoleRecorder, simulate_charts, table_of_holes};
pub use studies::{advise_page, compare_charts, sweep_charts};
