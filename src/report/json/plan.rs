//! `plan`: one stroke, or a program's timeline.

use std::cell::Cell;

use schemars::JsonSchema;
use serde::Serialize;

use super::parts::HandName;
use super::streamed::Streamed;
use crate::control::machine::Law;
use crate::control::profile::Profile;
use crate::control::units::{deg_from_rev, rpm_from_rev_per_s};
use crate::gcode::SpindleCommand;
use crate::study::{TimelineEntry, TimelineKind};

/// The plan of one stroke from rest to rest.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct StrokePlan {
    /// Time law, by the command line's name.
    pub law: &'static str,
    /// Travel of the spindle.
    pub distance_rev: f64,
    /// Commanded speed.
    pub command_rpm: f64,
    /// Speed that is reached.
    pub peak_rpm: f64,
    /// Time of the whole stroke.
    pub duration_s: f64,
    /// Pieces of constant snap, in their order.
    pub segments: Vec<SegmentAnswer>,
}

/// A piece of constant snap; its values are those at its start.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say it, and their units")]
pub struct SegmentAnswer {
    pub start_s: f64,
    pub duration_s: f64,
    pub position_rev: f64,
    pub velocity_rev_per_s: f64,
    pub acceleration_rev_per_s2: f64,
    pub jerk_rev_per_s3: f64,
    pub snap_rev_per_s4: f64,
}

impl StrokePlan {
    /// Of a planned stroke.
    #[must_use]
    pub fn new(law: Law, command_rpm: f64, profile: &Profile) -> Self {
        let segments = profile.segments().iter().map(|segment| SegmentAnswer {
            start_s: segment.start_s,
            duration_s: segment.duration_s,
            position_rev: segment.start.position,
            velocity_rev_per_s: segment.start.velocity,
            acceleration_rev_per_s2: segment.start.acceleration,
            jerk_rev_per_s3: segment.start.jerk,
            snap_rev_per_s4: segment.snap,
        });
        Self {
            law: law.name(),
            distance_rev: profile.distance(),
            command_rpm,
            peak_rpm: rpm_from_rev_per_s(profile.peak_velocity()),
            duration_s: profile.duration_s(),
            segments: segments.collect(),
        }
    }
}

/// A program's timeline as planned.
#[derive(Debug, JsonSchema, Serialize)]
pub struct ProgramPlan<'a> {
    /// Its name.
    pub file: String,
    /// Time law of the strokes, by the command line's name.
    pub law: &'static str,
    /// Steps in their order.
    pub entries: Streamed<'a, EntryAnswer>,
    /// Time of the whole program, which is known once the entries are made.
    pub total_s: &'a Cell<f64>,
}

/// One step of a timeline.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
pub struct EntryAnswer {
    /// `rapid`, `feed`, `wait`, `spindle-off`, `spindle-on`, `spindle-wait`, or the stroke: `in`, `dwell`, `out`.
    pub kind: &'static str,
    /// Line of the program, from 1.
    pub line: u32,
    /// When it starts.
    pub start_s: f64,
    /// How long it takes; 0 for what goes on beside the rest.
    pub duration_s: f64,
    /// X, Y, Z at its start.
    pub from_mm: [f64; 3],
    /// X, Y, Z at its end.
    pub to_mm: [f64; 3],
    /// Of a stroke.
    #[serde(flatten)]
    pub stroke: Option<StrokeEntry>,
    /// Of `spindle-on`.
    #[serde(flatten)]
    pub spindle: Option<SpindleEntry>,
}

/// What a stroke of a hole has beside.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
pub struct StrokeEntry {
    /// Hole, from 1.
    pub hole: u32,
    /// Its pitch.
    pub pitch_mm: f64,
    /// Commanded speed.
    pub command_rpm: f64,
    /// Speed that is reached.
    pub peak_rpm: f64,
    /// Angle of the spindle on the R plane, from its encoder's zero; left out where it comes to rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_angle_deg: Option<f64>,
}

/// What the start of the spindle has beside.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
pub struct SpindleEntry {
    /// Direction.
    pub hand: HandName,
    /// Commanded speed.
    pub speed_rpm: f64,
}

impl From<&TimelineEntry> for EntryAnswer {
    fn from(entry: &TimelineEntry) -> Self {
        Self {
            kind: entry.what.name(),
            line: entry.line,
            start_s: entry.start_s,
            duration_s: entry.duration_s,
            from_mm: entry.from_mm,
            to_mm: entry.to_mm,
            stroke: match entry.what {
                TimelineKind::Stroke { hole, pitch_mm, command_rpm, peak_rpm, start_angle_rev, .. } => {
                    let start_angle_deg = start_angle_rev.map(deg_from_rev);
                    Some(StrokeEntry { hole, pitch_mm, command_rpm, peak_rpm, start_angle_deg })
                }
                _ => None,
            },
            spindle: match entry.what {
                TimelineKind::Spindle(SpindleCommand::On { hand, speed_rpm }) => {
                    Some(SpindleEntry { hand: hand.into(), speed_rpm })
                }
                _ => None,
            },
        }
    }
}
