//! `monitor`.

use schemars::JsonSchema;
use serde::Serialize;

use super::parts::{Band, HandName};
use crate::link::receiver::Counters;
use crate::link::recording::{Corrupt, Recording};
use crate::report::monitor::Source;
use crate::run::analysis::{Estimates, InOutOffset, LeadIn, MeasuredHole, MeasuredStroke, Reversal};

/// Holes of real encoders.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct MonitorAnswer {
    /// Name of the recording, or the port.
    source: String,
    /// Nominal pitch.
    pitch_mm: f64,
    /// How sound the readings are.
    link: LinkAnswer,
    /// Holes in their order.
    holes: Vec<HoleAnswer>,
}

#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
#[serde(untagged)]
enum LinkAnswer {
    /// A serial line.
    Line {
        #[schemars(extend("const" = "serial"))]
        kind: &'static str,
        /// Frames that became samples.
        frames: u64,
        lost: u64,
        corrupted: u64,
        repeated: u64,
        out_of_order: u64,
        late: u64,
        faulty: u64,
        overrun: u64,
        restarts: u64,
        reconnects: u64,
    },
    /// A recording.
    Recording {
        /// What it was read as.
        kind: &'static str,
        readings: u64,
        /// Usual step of time.
        period_s: f64,
        /// Greatest deviation from it.
        jitter_s: f64,
        gaps: u64,
        missing: u64,
        repeated: u64,
        restarts: u64,
        spindle_resets: u64,
        /// Readings that cannot be; with any of them no hole passes.
        corrupt: u64,
        /// The first of them.
        first_corrupt: Vec<CorruptAnswer>,
    },
}

/// A reading that cannot be.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct CorruptAnswer {
    /// Line, from 1.
    line: usize,
    /// Column of the table, from 1.
    column: usize,
    /// The column's heading, or `#` and its number.
    name: String,
    /// What stands there.
    value: String,
    message: String,
}

#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct HoleAnswer {
    /// Number, from 1.
    hole: u32,
    /// `ok`, `warning` or `fail`; another word where the hole cannot be judged.
    verdict: &'static str,
    /// Time of the first synchronous period.
    zero_s: f64,
    duration_s: f64,
    pitch_mm: f64,
    hand: HandName,
    /// What the thread bears, peak to peak; null where that is not known.
    tolerance_um: Option<f64>,
    /// Measured synchronisation error e(k).
    error_um: Band,
    /// Greatest magnitude of e(k).
    peak_um: f64,
    /// Places where readings are missing.
    gaps: u32,
    /// Readings missing there.
    missing: u64,
    /// The data show no end of this hole.
    broken: bool,
    strokes: Vec<StrokeAnswer>,
    lead_in: LeadInAnswer,
    reversal: ReversalAnswer,
    /// Between stroke in and stroke out at speed; null where it does not stand out.
    in_out_offset: Option<OffsetAnswer>,
    /// What e(k) lets one estimate; null where it does not follow from these causes.
    estimates: Option<EstimatesAnswer>,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct StrokeAnswer {
    stroke: &'static str,
    duration_s: f64,
    peak_rpm: f64,
    error_um: Band,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct LeadInAnswer {
    /// The spindle turned when Z set off: the lead-in is not judged.
    running_start: bool,
    duration_s: f64,
    error_um: Band,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct ReversalAnswer {
    time_s: f64,
    spindle_rev: f64,
    depth_mm: f64,
    /// Time from the spindle's turn to Z's.
    z_later_s: f64,
    error_um: Band,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct OffsetAnswer {
    offset_um: f64,
    /// The offset in sampling periods of travel at `speed_rpm`.
    periods: f64,
    speed_rpm: f64,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct EstimatesAnswer {
    /// Real pitch over the nominal one.
    pitch_ratio: f64,
    /// How much later Z is than the spindle.
    z_lag_s: f64,
    backlash_um: f64,
    /// Amplitude of what repeats with each revolution.
    eccentricity_deg: f64,
    /// The same as an axial error.
    eccentricity_um: f64,
    /// What the fit leaves of e(k), root mean square.
    residual_um: f64,
}

impl MonitorAnswer {
    /// Of holes that were found.
    #[must_use]
    pub fn new(name: &str, pitch_mm: f64, source: Source<'_>, holes: &[MeasuredHole]) -> Self {
        let link = match source {
            Source::Line(counters) => LinkAnswer::from(&counters),
            Source::Recording(recording) => LinkAnswer::from(recording),
        };
        Self { source: name.to_owned(), pitch_mm, link, holes: holes.iter().map(HoleAnswer::from).collect() }
    }
}

impl From<&Counters> for LinkAnswer {
    fn from(counters: &Counters) -> Self {
        Self::Line {
            kind: "serial",
            frames: counters.accepted,
            lost: counters.lost,
            corrupted: counters.corrupted,
            repeated: counters.repeated,
            out_of_order: counters.out_of_order,
            late: counters.late,
            faulty: counters.faulty,
            overrun: counters.overrun,
            restarts: counters.restarts,
            reconnects: counters.reconnects,
        }
    }
}

impl From<&Recording> for LinkAnswer {
    fn from(found: &Recording) -> Self {
        Self::Recording {
            kind: found.format.name(),
            readings: found.readings,
            period_s: found.period_s,
            jitter_s: found.jitter_s,
            gaps: found.gaps,
            missing: found.missing,
            repeated: found.repeated,
            restarts: found.restarts,
            spindle_resets: found.resets,
            corrupt: found.corrupt,
            first_corrupt: found.first_corrupt.iter().map(CorruptAnswer::from).collect(),
        }
    }
}

impl From<&Corrupt> for CorruptAnswer {
    fn from(found: &Corrupt) -> Self {
        let Corrupt { line, column, name, value, .. } = found;
        Self { line: *line, column: *column, name: name.clone(), value: value.clone(), message: found.to_string() }
    }
}

impl From<&MeasuredHole> for HoleAnswer {
    fn from(hole: &MeasuredHole) -> Self {
        Self {
            hole: hole.hole,
            verdict: hole.judgement().name(),
            zero_s: hole.zero.time_s,
            duration_s: hole.end_s - hole.zero.time_s,
            pitch_mm: hole.pitch_mm,
            hand: hole.hand.into(),
            tolerance_um: hole.tolerance_um,
            error_um: (&hole.error_um).into(),
            peak_um: hole.error_um.magnitude(),
            gaps: hole.gaps,
            missing: hole.missing,
            broken: hole.broken,
            strokes: hole.strokes.iter().map(StrokeAnswer::from).collect(),
            lead_in: (&hole.lead_in).into(),
            reversal: (&hole.reversal).into(),
            in_out_offset: hole.in_out_offset.as_ref().map(OffsetAnswer::from),
            estimates: hole.estimates.as_ref().map(EstimatesAnswer::from),
        }
    }
}

impl From<&MeasuredStroke> for StrokeAnswer {
    fn from(stroke: &MeasuredStroke) -> Self {
        Self {
            stroke: stroke.kind.name(),
            duration_s: stroke.duration_s,
            peak_rpm: stroke.peak_rpm,
            error_um: (&stroke.error_um).into(),
        }
    }
}

impl From<&LeadIn> for LeadInAnswer {
    fn from(found: &LeadIn) -> Self {
        Self { running_start: found.running_start, duration_s: found.duration_s, error_um: (&found.error_um).into() }
    }
}

impl From<&Reversal> for ReversalAnswer {
    fn from(found: &Reversal) -> Self {
        Self {
            time_s: found.time_s,
            spindle_rev: found.spindle_rev,
            depth_mm: found.depth_mm,
            z_later_s: found.z_later_s,
            error_um: (&found.error_um).into(),
        }
    }
}

impl From<&InOutOffset> for OffsetAnswer {
    fn from(found: &InOutOffset) -> Self {
        Self { offset_um: found.offset_um, periods: found.periods, speed_rpm: found.speed_rpm }
    }
}

impl From<&Estimates> for EstimatesAnswer {
    fn from(found: &Estimates) -> Self {
        Self {
            pitch_ratio: found.pitch_ratio,
            z_lag_s: found.z_lag_s,
            backlash_um: found.backlash_um,
            eccentricity_deg: found.eccentricity_deg,
            eccentricity_um: found.eccentricity_um,
            residual_um: found.residual_um,
        }
    }
}
