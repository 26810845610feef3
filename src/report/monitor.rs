//! Holes of real encoders: lines while they are cut, a table, JSON.

use serde_json::{Value, json};

use super::json::{band, hand_name};
use super::table::columns::Columns;
use crate::link::receiver::Counters;
use crate::link::recording::{Format, Recording};
use crate::run::analysis::{Cutting, MeasuredHole};

/// An in/out offset below this is not worth a sentence.
const NOTABLE_OFFSET_UM: f64 = 5.0;

/// Where the samples came from.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// A serial line.
    Line(Counters),
    /// A file.
    Recording(&'a Recording),
}

/// The line of a hole just done.
#[must_use]
pub fn hole_line(hole: &MeasuredHole) -> String {
    format!(
        "hole {}: {}, e(k) {:.1} to {:.1} µm, peak to peak {:.1} µm{}{}",
        hole.hole,
        hole.judgement().name(),
        hole.error_um.min(),
        hole.error_um.max(),
        hole.error_um.peak_to_peak(),
        hole.tolerance_um.map_or_else(String::new, |tolerance_um| format!(" of {tolerance_um:.0}")),
        gap_words(hole),
    )
}

/// The line of an alarm.
#[must_use]
pub fn alarm_line(cutting: &Cutting) -> String {
    format!(
        "ALARM hole {}: e(k) {:.1} µm at {:.4} s, {:.3} mm deep; peak to peak {:.1} µm is beyond the tolerance",
        cutting.hole,
        cutting.error_um,
        cutting.sample.time_s,
        cutting.z_travel_mm,
        cutting.band_um.peak_to_peak()
    )
}

fn gap_words(hole: &MeasuredHole) -> String {
    match (hole.broken, hole.gaps) {
        (true, _) => "; the data show no end of this hole".into(),
        (false, 0) => String::new(),
        (false, 1) => format!("; {} readings missing in one gap", hole.missing),
        (false, gaps) => format!("; {} readings missing in {gaps} gaps", hole.missing),
    }
}

/// All holes for people.
#[must_use]
pub fn table(name: &str, source: Source<'_>, holes: &[MeasuredHole]) -> String {
    let mut table = Columns::new(
        &[
            "hole", "verdict", "stroke", "start s", "time s", "depth mm", "peak rpm", "min µm", "max µm", "p-p µm",
            "rms µm",
        ],
        3,
    );
    for hole in holes {
        for stroke in &hole.strokes {
            let band = &stroke.error_um;
            let mut cells = vec![String::new(), String::new(), stroke.kind.name().into(), String::new()];
            cells.extend([format!("{:.4}", stroke.duration_s), String::new(), format!("{:.0}", stroke.peak_rpm)]);
            cells.extend([band.min(), band.max(), band.peak_to_peak(), band.rms()].map(|um| format!("{um:.1}")));
            table.row(cells);
        }
        let band = &hole.error_um;
        let mut cells = vec![hole.hole.to_string(), hole.judgement().name().into(), "all".into()];
        let peak_rpm = hole.strokes.iter().map(|stroke| stroke.peak_rpm).fold(0.0, f64::max);
        cells.extend([format!("{:.3}", hole.zero.time_s), format!("{:.4}", hole.end_s - hole.zero.time_s)]);
        cells.extend([format!("{:.3}", hole.reversal.depth_mm), format!("{peak_rpm:.0}")]);
        cells.extend([band.min(), band.max(), band.peak_to_peak(), band.rms()].map(|um| format!("{um:.1}")));
        table.row(cells);
    }
    let period = match source {
        Source::Recording(recording) if recording.format == Format::Halsampler => "servo periods",
        _ => "sampling periods",
    };
    let details: String = holes.iter().map(|hole| detail(hole, period)).collect();
    let found = if holes.is_empty() { "no hole found\n".to_owned() } else { format!("{table}{details}") };
    format!("{name}: {}\n{found}", source_words(source))
}

fn source_words(source: Source<'_>) -> String {
    match source {
        Source::Line(counters) => format!(
            "{} frames; {} lost, {} corrupted, {} repeated, {} out of order, {} late, {} faulty, {} overrun; {} restarts, {} reconnects",
            counters.accepted,
            counters.lost,
            counters.corrupted,
            counters.repeated,
            counters.out_of_order,
            counters.late,
            counters.faulty,
            counters.overrun,
            counters.restarts,
            counters.reconnects,
        ),
        Source::Recording(found) => format!(
            "{}, {} readings every {:.3} ms, jitter {:.3} ms; {} missing in {} gaps, {} repeated, {} restarts, {} spindle resets",
            found.format.name(),
            found.samples.len(),
            found.period_s * 1e3,
            found.jitter_s * 1e3,
            found.missing,
            found.gaps,
            found.repeated,
            found.restarts,
            found.resets,
        ),
    }
}

/// `1.5 ms after`, or whatever the word for later is here, and its opposite.
fn later_than(seconds: f64, decimals: usize, later: &str) -> String {
    let earlier = if later == "after" { "before" } else { "ahead of" };
    format!("{:.decimals$} ms {}", seconds.abs() * 1e3, if seconds < 0.0 { earlier } else { later })
}

/// What stands below the table of a hole.
fn detail(hole: &MeasuredHole, period: &str) -> String {
    let mut text =
        format!("hole {}, pitch {} mm, {} hand{}\n", hole.hole, hole.pitch_mm, hand_name(hole.hand), gap_words(hole));
    let lead_in = &hole.lead_in;
    let judged =
        if lead_in.running_start { "spindle turning, until Z had its speed, not judged" } else { "first revolution" };
    text += &format!(
        "  lead-in ({judged}): {:.1} ms, {:.1} to {:.1} µm\n",
        lead_in.duration_s * 1e3,
        lead_in.error_um.min(),
        lead_in.error_um.max()
    );
    let reversal = &hole.reversal;
    text += &format!(
        "  reversal: at {:.4} s after {:.3} rev, {:.3} mm deep, Z turned {} the spindle; {:.1} to {:.1} µm within 20 ms\n",
        reversal.time_s,
        reversal.spindle_rev,
        reversal.depth_mm,
        later_than(reversal.z_later_s, 1, "after"),
        reversal.error_um.min(),
        reversal.error_um.max()
    );
    if let Some(offset) = hole.in_out_offset.filter(|offset| offset.offset_um.abs() >= NOTABLE_OFFSET_UM) {
        text += &format!(
            "  in/out offset: the stroke out lies {:.1} µm from the stroke in: {:.2} {period} of travel at {:.0} rpm, \
             so that Z is {:.2} {period} {} the spindle both ways\n",
            offset.offset_um,
            offset.periods.abs(),
            offset.speed_rpm,
            offset.periods.abs() / 2.0,
            if offset.periods > 0.0 { "behind" } else { "ahead of" }
        );
    }
    if let Some(found) = hole.estimates {
        text += &format!(
            "  estimates, none of them in e(k): pitch {:.6} of nominal, Z {} the spindle, backlash {:.1} µm, \
             spindle encoder's eccentricity {:.3}° ({:.1} µm); {:.1} µm rms unexplained\n",
            found.pitch_ratio,
            later_than(found.z_lag_s, 3, "behind"),
            found.backlash_um,
            found.eccentricity_deg,
            found.eccentricity_um,
            found.residual_um
        );
    } else {
        text += "  estimates: none, e(k) does not follow from pitch, lag, backlash and eccentricity\n";
    }
    text
}

/// All holes for programs.
#[must_use]
pub fn json(name: &str, pitch_mm: f64, source: Source<'_>, holes: &[MeasuredHole]) -> Value {
    let link = match source {
        Source::Line(counters) => json!({
            "kind": "serial", "frames": counters.accepted, "lost": counters.lost, "corrupted": counters.corrupted,
            "repeated": counters.repeated, "out_of_order": counters.out_of_order, "late": counters.late,
            "faulty": counters.faulty, "overrun": counters.overrun, "restarts": counters.restarts,
            "reconnects": counters.reconnects,
        }),
        Source::Recording(found) => json!({
            "kind": found.format.name(), "readings": found.samples.len(), "period_s": found.period_s,
            "jitter_s": found.jitter_s, "gaps": found.gaps, "missing": found.missing, "repeated": found.repeated,
            "restarts": found.restarts, "spindle_resets": found.resets,
        }),
    };
    json!({ "source": name, "pitch_mm": pitch_mm, "link": link, "holes": holes.iter().map(hole_json).collect::<Vec<_>>() })
}

fn hole_json(hole: &MeasuredHole) -> Value {
    let strokes = hole.strokes.iter().map(|stroke| {
        json!({
            "stroke": stroke.kind.name(), "duration_s": stroke.duration_s, "peak_rpm": stroke.peak_rpm,
            "error_um": band(&stroke.error_um),
        })
    });
    json!({
        "hole": hole.hole,
        "verdict": hole.judgement().name(),
        "zero_s": hole.zero.time_s,
        "duration_s": hole.end_s - hole.zero.time_s,
        "pitch_mm": hole.pitch_mm,
        "hand": hand_name(hole.hand),
        "tolerance_um": hole.tolerance_um,
        "error_um": band(&hole.error_um),
        "peak_um": hole.error_um.magnitude(),
        "gaps": hole.gaps,
        "missing": hole.missing,
        "broken": hole.broken,
        "strokes": strokes.collect::<Vec<_>>(),
        "lead_in": {
            "running_start": hole.lead_in.running_start, "duration_s": hole.lead_in.duration_s,
            "error_um": band(&hole.lead_in.error_um),
        },
        "reversal": {
            "time_s": hole.reversal.time_s, "spindle_rev": hole.reversal.spindle_rev,
            "depth_mm": hole.reversal.depth_mm, "z_later_s": hole.reversal.z_later_s,
            "error_um": band(&hole.reversal.error_um),
        },
        "in_out_offset": hole.in_out_offset.map(|offset| json!({
            "offset_um": offset.offset_um, "periods": offset.periods, "speed_rpm": offset.speed_rpm,
        })),
        "estimates": hole.estimates.map(|found| json!({
            "pitch_ratio": found.pitch_ratio, "z_lag_s": found.z_lag_s, "backlash_um": found.backlash_um,
            "eccentricity_deg": found.eccentricity_deg, "eccentricity_um": found.eccentricity_um,
            "residual_um": found.residual_um,
        })),
    })
}
