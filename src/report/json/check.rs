//! `check`.

use schemars::JsonSchema;
use serde::Serialize;

use super::parts::HandName;
use super::streamed::Streamed;
use crate::control::cycle::{Retract, TapCycle};
use crate::control::units::deg_from_rev;
use crate::gcode::{Command, CommandKind, Diagnostic, SpindleCommand};

/// What was read.
#[derive(Debug, JsonSchema, Serialize)]
pub struct CheckAnswer<'a> {
    /// Programs in the order of the command line.
    pub files: Streamed<'a, CheckedFile<'a>>,
}

/// One program.
#[derive(Debug, JsonSchema, Serialize)]
pub struct CheckedFile<'a> {
    /// Its name.
    pub file: String,
    /// Its commands in the order of their execution.
    pub commands: Streamed<'a, CommandAnswer>,
    /// What is wrong with it, or unwise.
    pub diagnostics: Vec<DiagnosticAnswer>,
}

/// A diagnostic with its place.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct DiagnosticAnswer {
    /// `error` or `warning`.
    #[schemars(extend("enum" = ["error", "warning"]))]
    pub severity: &'static str,
    /// Its code, which `check --explain` tells more of.
    pub code: &'static str,
    /// The file of a subprogram, where it is in one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Line, from 1.
    pub line: u32,
    /// Byte in the line, from 1.
    pub column: u32,
    /// What was found, and what was expected.
    pub message: String,
    /// What to do.
    pub hint: String,
}

impl DiagnosticAnswer {
    /// With the file of the subprogram that it is in.
    #[must_use]
    pub fn in_file(diagnostic: &Diagnostic, file: Option<&str>) -> Self {
        Self { file: file.map(str::to_owned), ..Self::from(diagnostic) }
    }
}

impl From<&Diagnostic> for DiagnosticAnswer {
    fn from(diagnostic: &Diagnostic) -> Self {
        Self {
            severity: diagnostic.severity().name(),
            code: diagnostic.code(),
            file: None,
            line: diagnostic.line,
            column: diagnostic.column,
            message: diagnostic.message(),
            hint: diagnostic.hint(),
        }
    }
}

/// A command as the interpreter understood it; lengths in mm, in the program's coordinates.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[expect(missing_docs, reason = "the names say it, and their units")]
pub enum CommandAnswer {
    /// G0.
    Rapid { line: u32, x_mm: f64, y_mm: f64, z_mm: f64 },
    /// G1.
    Feed { line: u32, x_mm: f64, y_mm: f64, z_mm: f64, feed_mm_per_s: f64 },
    /// G4.
    Dwell { line: u32, dwell_s: f64 },
    /// M05.
    SpindleOff { line: u32 },
    /// M03, M04.
    SpindleOn { line: u32, hand: HandName, speed_rpm: f64 },
    /// A tapped hole.
    Tap(TapAnswer),
    /// M30 and its like.
    End { line: u32 },
}

/// A tapped hole.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
pub struct TapAnswer {
    /// Line of the program, from 1.
    pub line: u32,
    /// Position.
    pub x_mm: f64,
    /// Position.
    pub y_mm: f64,
    /// Where the synchronous motion begins.
    pub r_plane_mm: f64,
    /// Its deepest point.
    pub bottom_mm: f64,
    /// Where Z goes after the hole.
    pub return_mm: f64,
    /// Pitch of the thread, above 0.
    pub pitch_mm: f64,
    /// Speed of the stroke in.
    pub speed_rpm: f64,
    /// Speed of the stroke out.
    pub out_speed_rpm: f64,
    /// Direction of the thread.
    pub hand: HandName,
    /// Angle of the spindle on the R plane, from its encoder's zero; null where it comes to rest.
    pub start_angle_deg: Option<f64>,
    /// Rest at the bottom.
    pub dwell_s: f64,
    /// Depth of one peck; null without pecks.
    pub peck_mm: Option<f64>,
    /// What a peck does at its end; null without pecks.
    #[schemars(extend("enum" = ["chip-break", "full", null]))]
    pub retract: Option<&'static str>,
}

impl From<&Command> for CommandAnswer {
    fn from(command: &Command) -> Self {
        let line = command.line;
        match command.kind {
            CommandKind::Rapid { to_mm: [x_mm, y_mm, z_mm] } => Self::Rapid { line, x_mm, y_mm, z_mm },
            CommandKind::Feed { to_mm: [x_mm, y_mm, z_mm], feed_mm_per_s } => {
                Self::Feed { line, x_mm, y_mm, z_mm, feed_mm_per_s }
            }
            CommandKind::Dwell { dwell_s } => Self::Dwell { line, dwell_s },
            CommandKind::Spindle(SpindleCommand::Off) => Self::SpindleOff { line },
            CommandKind::Spindle(SpindleCommand::On { hand, speed_rpm }) => {
                Self::SpindleOn { line, hand: hand.into(), speed_rpm }
            }
            CommandKind::Tap(cycle) => Self::Tap(TapAnswer::of(line, &cycle)),
            CommandKind::End => Self::End { line },
        }
    }
}

impl TapAnswer {
    fn of(line: u32, cycle: &TapCycle) -> Self {
        Self {
            line,
            x_mm: cycle.x_mm,
            y_mm: cycle.y_mm,
            r_plane_mm: cycle.r_plane_mm,
            bottom_mm: cycle.bottom_mm,
            return_mm: cycle.return_mm,
            pitch_mm: cycle.pitch_mm,
            speed_rpm: cycle.speed_rpm,
            out_speed_rpm: cycle.out_speed_rpm,
            hand: cycle.hand.into(),
            start_angle_deg: cycle.start_angle_rev.map(deg_from_rev),
            dwell_s: cycle.dwell_s,
            peck_mm: cycle.peck_mm,
            retract: cycle.retract.map(|retract| match retract {
                Retract::ChipBreak { .. } => "chip-break",
                Retract::Full => "full",
            }),
        }
    }
}
