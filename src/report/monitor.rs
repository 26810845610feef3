//! Holes of real encoders: lines while they are cut, and a table.

use super::table::Layout;
use super::table::columns::{Columns, number, text};
use super::table::layout::Page;
use crate::control::cycle::Hand;
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
pub fn table(layout: Layout, name: &str, source: Source<'_>, holes: &[MeasuredHole]) -> String {
    let mut table = Columns::new(&[
        number("hole", 0),
        text("verdict", 0),
        text("stroke", 0),
        number("start s", 3),
        number("time s", 0),
        number("depth mm", 2),
        number("peak rpm", 1),
        number("min µm", 4),
        number("max µm", 4),
        number("p-p µm", 0),
        number("rms µm", 5),
    ]);
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
    let mut page = Page::new(layout);
    page.say(format!("{name}: {}", source_words(source)));
    if let Source::Recording(found) = source {
        corrupt(&mut page, name, found);
    }
    if holes.is_empty() {
        return page.say("no hole found").finish();
    }
    page.blank().table(&table).blank();
    holes.iter().for_each(|hole| detail(&mut page, hole, period));
    page.finish()
}

/// The readings that cannot be, each with its place.
fn corrupt(page: &mut Page, name: &str, found: &Recording) {
    if found.corrupt == 0 {
        return;
    }
    page.say(format!("CORRUPT: {} readings cannot be, and no hole passes", found.corrupt));
    for reading in &found.first_corrupt {
        page.say(format!("  {name}:{}, column {}: {reading}", reading.line, reading.column));
    }
}

/// Where the samples came from, and what was wrong with them.
#[must_use]
pub fn source_words(source: Source<'_>) -> String {
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
            found.readings,
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
fn detail(page: &mut Page, hole: &MeasuredHole, period: &str) {
    let hand = if hole.hand == Hand::Right { "right" } else { "left" };
    page.say(format!("hole {}, pitch {} mm, {hand} hand{}", hole.hole, hole.pitch_mm, gap_words(hole)));
    let lead_in = &hole.lead_in;
    let judged =
        if lead_in.running_start { "spindle turning, until Z had its speed, not judged" } else { "first revolution" };
    page.say(format!(
        "  lead-in ({judged}): {:.1} ms, {:.1} to {:.1} µm",
        lead_in.duration_s * 1e3,
        lead_in.error_um.min(),
        lead_in.error_um.max()
    ));
    let reversal = &hole.reversal;
    page.say(format!(
        "  reversal: at {:.4} s after {:.3} rev, {:.3} mm deep, Z turned {} the spindle; {:.1} to {:.1} µm within 20 ms",
        reversal.time_s,
        reversal.spindle_rev,
        reversal.depth_mm,
        later_than(reversal.z_later_s, 1, "after"),
        reversal.error_um.min(),
        reversal.error_um.max()
    ));
    if let Some(offset) = hole.in_out_offset.filter(|offset| offset.offset_um.abs() >= NOTABLE_OFFSET_UM) {
        page.say(format!(
            "  in/out offset: the stroke out lies {:.1} µm from the stroke in: {:.2} {period} of travel at {:.0} rpm, \
             so that Z is {:.2} {period} {} the spindle both ways",
            offset.offset_um,
            offset.periods.abs(),
            offset.speed_rpm,
            offset.periods.abs() / 2.0,
            if offset.periods > 0.0 { "behind" } else { "ahead of" }
        ));
    }
    if let Some(found) = hole.estimates {
        page.say(format!(
            "  estimates, none of them in e(k): pitch {:.6} of nominal, Z {} the spindle, backlash {:.1} µm, \
             spindle encoder's eccentricity {:.3}° ({:.1} µm); {:.1} µm rms unexplained",
            found.pitch_ratio,
            later_than(found.z_lag_s, 3, "behind"),
            found.backlash_um,
            found.eccentricity_deg,
            found.eccentricity_um,
            found.residual_um
        ));
    } else {
        page.say("  estimates: none, e(k) does not follow from pitch, lag, backlash and eccentricity");
    }
}
