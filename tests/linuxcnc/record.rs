//! What a session recorded, and the figures of a hole: written out here, so that they check the component's own.

/// One servo period, as it ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) z_mm: f64,
    pub(crate) rev: f64,
    pub(crate) rpm: f64,
    pub(crate) state: i32,
    pub(crate) line: i32,
    pub(crate) alarm: i32,
    pub(crate) tap_clocks: i32,
    pub(crate) motion_clocks: i32,
}

/// States of the component.
pub(crate) const SETTLING: i32 = 2;
pub(crate) const TAPPING: i32 = 3;
pub(crate) const HOLDING: i32 = 5;
pub(crate) const RETRACTING: i32 = 6;
pub(crate) const FINISHED: i32 = 7;

const PERIOD_S: f64 = 0.001;
/// The tool's tip counts as on R within this, at rest.
const ON_R_MM: f64 = 0.02;
/// Z counts as back on R within this: G33.1 goes on from there without a stop.
const BACK_MM: f64 = 0.1;
/// Where a work piece begins: G33.1 is judged only below it.
const SURFACE_BELOW_R_MM: f64 = 2.0;

pub(crate) fn rows(log: &str) -> Vec<Row> {
    assert!(!log.contains("overrun"), "the recorder lost periods");
    // A line cut short ends the record.
    log.lines().map_while(row).collect()
}

fn row(line: &str) -> Option<Row> {
    let mut fields = line.split_whitespace();
    let mut next = || fields.next();
    Some(Row {
        z_mm: next()?.parse().ok()?,
        rev: next()?.parse().ok()?,
        rpm: next()?.parse().ok()?,
        state: next()?.parse().ok()?,
        line: next()?.parse().ok()?,
        alarm: next()?.parse().ok()?,
        tap_clocks: next()?.parse().ok()?,
        motion_clocks: next()?.parse().ok()?,
    })
}

/// A tapped hole as recorded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hole {
    pub(crate) error_um: f64,
    pub(crate) overshoot_um: f64,
    pub(crate) cycle_s: f64,
    /// Greatest speed that the spindle had.
    pub(crate) peak_rpm: f64,
    /// Z came back to R: elsewhere the tap is left in the thread, and its other figures say nothing.
    pub(crate) is_whole: bool,
}

fn runs(rows: &[Row], inside: impl Fn(&Row) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (k, row) in rows.iter().enumerate() {
        match (inside(row), start) {
            (true, None) => start = Some(k),
            (false, Some(from)) => {
                found.push(from..k);
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Greatest less least e(k), one zero at the first row.
fn peak_to_peak_um(rows: &[Row], pitch_mm: f64, hand: f64) -> f64 {
    let error_um = |row: &Row| 1000.0 * ((rows[0].z_mm - row.z_mm) - pitch_mm * hand * (row.rev - rows[0].rev));
    let band = rows.iter().map(error_um).fold((0.0f64, 0.0f64), |(low, high), e| (low.min(e), high.max(e)));
    band.1 - band.0
}

fn hole(
    rows: &[Row],
    r_mm: f64,
    bottom_mm: f64,
    synchronous: &[Row],
    mut start: usize,
    end: usize,
    turn: (f64, f64),
) -> Hole {
    while start > 0 && (rows[start - 1].z_mm - r_mm).abs() < ON_R_MM {
        start -= 1;
    }
    let deepest_mm = rows[start..end].iter().map(|row| row.z_mm).fold(f64::INFINITY, f64::min);
    Hole {
        error_um: peak_to_peak_um(synchronous, turn.0, turn.1),
        overshoot_um: 1000.0 * (bottom_mm - deepest_mm),
        cycle_s: (end - start) as f64 * PERIOD_S,
        is_whole: (rows[end - 1].z_mm - r_mm).abs() < BACK_MM,
        peak_rpm: rows[start..end].iter().map(|row| row.rpm.abs()).fold(0.0, f64::max),
    }
}

/// The holes that the component tapped, judged from its first synchronous period to its last.
pub(crate) fn tapped(rows: &[Row], r_mm: f64, bottom_mm: f64, pitch_mm: f64, hand: f64) -> Vec<Hole> {
    let of_run = |run: std::ops::Range<usize>| {
        let from = rows[run.clone()].iter().position(|row| row.state >= TAPPING).unwrap_or_default();
        hole(rows, r_mm, bottom_mm, &rows[run.start + from..run.end], run.start, run.end, (pitch_mm, hand))
    };
    runs(rows, |row| (SETTLING..=RETRACTING).contains(&row.state)).into_iter().map(of_run).collect()
}

/// The holes of G33.1 in these lines of the program, judged below the surface alone.
pub(crate) fn chased(rows: &[Row], lines: &[i32], r_mm: f64, bottom_mm: f64, pitch_mm: f64) -> Vec<Hole> {
    let of_run = |run: std::ops::Range<usize>| {
        let inside = &rows[run.clone()];
        let below = |row: &Row| row.z_mm < r_mm - SURFACE_BELOW_R_MM;
        let (first, last) = (inside.iter().position(below).expect("in"), inside.iter().rposition(below).expect("out"));
        hole(rows, r_mm, bottom_mm, &inside[first..=last], run.start, run.end, (pitch_mm, 1.0))
    };
    runs(rows, |row| lines.contains(&row.line)).into_iter().map(of_run).collect()
}

pub(crate) fn mean(holes: &[Hole], of: fn(&Hole) -> f64) -> f64 {
    holes.iter().map(of).sum::<f64>() / holes.len() as f64
}

pub(crate) fn worst(holes: &[Hole], of: fn(&Hole) -> f64) -> f64 {
    holes.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
}
