//! What runs and plans yield, made ready for the plots.

use crate::control::cycle::StrokeKind;
use crate::control::machine::Machine;
use crate::control::units::rpm_from_rev_per_s;
use crate::run::{HoleOutcome, Listener, ProgramOutcome, Row, RowStage};
use crate::study::{ErrorSeries, TimelineEntry, TimelineKind};

use super::plot::{ErrorPanel, HoleMark, LinePanel, ProgramPicture, ZPoint};

/// What of a program is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// One hole; every hole without it.
    pub hole: Option<u32>,
    /// One stroke of each; every stroke without it.
    pub stroke: Option<StrokeKind>,
}

/// A panel of one program's e(k); the verdict is that of the holes drawn.
#[must_use]
pub fn error_panel(
    title: String,
    outcome: &ProgramOutcome,
    series: ErrorSeries,
    period_s: f64,
    selection: Selection,
) -> ErrorPanel {
    let Selection { hole, stroke } = selection;
    let drawn = || outcome.holes.iter().filter(|found| hole.is_none_or(|hole| found.hole == hole));
    // Holes of one program may differ in pitch; the tightest tolerance is drawn.
    let tolerance_um = drawn().map(|hole| hole.tolerance_um).fold(f64::INFINITY, f64::min);
    let mut points = series.points;
    points
        .retain(|point| hole.is_none_or(|hole| point.hole == hole) && stroke.is_none_or(|stroke| point.kind == stroke));
    let which = hole.map_or_else(String::new, |hole| format!(", hole {hole}"));
    let part = stroke.map_or_else(String::new, |stroke| format!(", stroke {}", stroke.name()));
    ErrorPanel {
        title: format!("{title}{which}{part}"),
        tolerance_um: if tolerance_um.is_finite() { tolerance_um } else { 0.0 },
        peak_to_peak_um: drawn().map(|hole| hole.error_um.peak_to_peak()).fold(0.0, f64::max),
        verdict: if hole.is_some() {
            drawn().map(HoleOutcome::verdict).max().unwrap_or_default()
        } else {
            outcome.verdict()
        },
        period_s,
        points,
    }
}

/// A listener that keeps what the spindle does in one hole, for the picture of that hole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpindleLines {
    selection: Selection,
    command_rpm: Vec<(u64, f64)>,
    actual_rpm: Vec<(u64, f64)>,
    torque_nm: Vec<(u64, f64)>,
}

impl SpindleLines {
    /// Of the hole that is drawn; none where all are.
    #[must_use]
    pub fn of(selection: Selection) -> Option<Self> {
        selection.hole.is_some().then(|| Self { selection, ..Self::default() })
    }

    /// Its panels: speed, and torque between what the motor has at that speed.
    #[must_use]
    pub fn panels(self, machine: &Machine) -> Vec<LinePanel> {
        let Self { command_rpm, actual_rpm, torque_nm, .. } = self;
        let available = |sign: f64| {
            actual_rpm.iter().map(|&(k, rpm)| (k, sign * machine.motor().curve.torque_nm(rpm))).collect::<Vec<_>>()
        };
        let torque = vec![
            ("torque".to_owned(), torque_nm),
            ("the motor's, at this speed".to_owned(), available(1.0)),
            ("the same, braking".to_owned(), available(-1.0)),
        ];
        vec![
            LinePanel {
                title: "Spindle speed, rpm".into(),
                lines: vec![("command".into(), command_rpm), ("actual".into(), actual_rpm)],
            },
            LinePanel { title: "Spindle torque, N·m".into(), lines: torque },
        ]
    }
}

impl Listener for SpindleLines {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        let RowStage::Stroke(kind) = row.stage else { return };
        let Selection { hole, stroke } = self.selection;
        if hole != Some(row.hole) || stroke.is_some_and(|stroke| stroke != kind) {
            return;
        }
        self.command_rpm.push((row.k, rpm_from_rev_per_s(row.setpoint.spindle.velocity)));
        if let Some(truth) = row.truth {
            self.actual_rpm.push((row.k, truth.spindle_rpm));
            self.torque_nm.push((row.k, truth.spindle_torque_nm));
        }
    }
}

/// Adds a step of a planned program: its hole and its way, and Z over time.
pub fn add_step(picture: &mut ProgramPicture, entry: &TimelineEntry) {
    let [x_mm, y_mm, _] = entry.to_mm;
    let stage = match entry.what {
        TimelineKind::Stroke { kind, .. } => RowStage::Stroke(kind),
        TimelineKind::SpindleWait => RowStage::Orient,
        _ => RowStage::Rapid,
    };
    if let TimelineKind::Stroke { hole, .. } = entry.what
        && picture.holes.last().is_none_or(|last| last.hole != hole)
    {
        picture.holes.push(HoleMark { hole, x_mm, y_mm, verdict: None });
    }
    picture.path_mm.push([x_mm, y_mm]);
    for &(time_s, z_mm) in &entry.z {
        // Sums of durations: one that ends where the next begins may end a last bit after it.
        let time_s = picture.z.last().map_or(time_s, |before| time_s.max(before.time_s));
        picture.z.push(ZPoint { time_s, z_mm, stage });
    }
}
