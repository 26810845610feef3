//! stub
use crate::control::{motor::Motor, profile::Profile};
use crate::run::{ProgramOutcome, Verdict};
use crate::study::{ErrorPoint, TimelineEntry};
pub struct ErrorPanel {
    pub title: String,
    pub tolerance_um: f64,
    pub verdict: Verdict,
    pub points: Vec<ErrorPoint>,
}
#[derive(Debug)]
pub struct PlotError;
impl std::fmt::Display for PlotError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("x")
    }
}
impl ErrorPanel {
    pub fn of(title: String, outcome: &ProgramOutcome, points: Vec<ErrorPoint>) -> Self {
        Self {
            title,
            tolerance_um: outcome.holes.first().map_or(0.0, |h| h.tolerance_um),
            verdict: outcome.verdict(),
            points,
        }
    }
}
pub fn error_figure(_t: &str, _p: &[ErrorPanel]) -> Result<String, PlotError> {
    Err(PlotError)
}
pub fn profile_figure(_p: &[(&str, &Profile)], _m: &Motor) -> Result<String, PlotError> {
    Err(PlotError)
}
pub struct ProgramPicture;
impl ProgramPicture {
    pub fn of(_n: &str, _e: &[TimelineEntry]) -> Self {
        Self
    }
}
pub fn program_figure(_p: &ProgramPicture) -> Result<String, PlotError> {
    Err(PlotError)
}
