//! Figures of holes: e(k), speed, torque against the motor's, Z, over seconds.

use super::html::{Chart, ChartSet, Level, Line, Table};
use super::parts::{MOST_HOLES, MOST_POINTS, rounded, with_tolerance};
use crate::control::machine::Machine;
use crate::control::units::{rpm_from_rev_per_s, um_from_mm};
use crate::run::{HoleOutcome, Listener, ProgramOutcome, Row, RowStage};

/// One hole's periods.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HoleCurves {
    /// Its number in the program.
    pub hole: u32,
    rows: Vec<[f64; 8]>,
    outcome: Option<HoleOutcome>,
}

/// A listener that keeps the curves of holes.
#[derive(Clone, Debug, Default)]
pub struct HoleRecorder {
    holes: Vec<HoleCurves>,
    current: HoleCurves,
    start_s: f64,
}

impl HoleRecorder {
    /// The holes that were kept, the worst first.
    #[must_use]
    pub fn finish(mut self) -> Vec<HoleCurves> {
        if !self.current.rows.is_empty() {
            self.holes.push(std::mem::take(&mut self.current));
        }
        let used = |curves: &HoleCurves| curves.outcome.as_ref().map_or(f64::INFINITY, HoleOutcome::used_ratio);
        self.holes.sort_by(|left, right| used(right).total_cmp(&used(left)).then(left.hole.cmp(&right.hole)));
        self.holes
    }
}

impl Listener for HoleRecorder {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        let RowStage::Stroke(_) = row.stage else { return };
        if self.current.rows.is_empty() {
            (self.start_s, self.current.hole) = (row.time_s, row.hole);
        }
        let missing = f64::NAN;
        let truth = row.truth;
        self.current.rows.push([
            row.time_s - self.start_s,
            row.error_um.unwrap_or(missing),
            row.true_error_um.unwrap_or(missing),
            rpm_from_rev_per_s(row.setpoint.spindle.velocity),
            truth.map_or(missing, |truth| truth.spindle_rpm),
            truth.map_or(missing, |truth| truth.spindle_torque_nm),
            row.setpoint.z.position,
            truth.map_or(missing, |truth| truth.z_mm),
        ]);
    }

    fn hole(&mut self, outcome: &HoleOutcome) {
        let mut curves = std::mem::take(&mut self.current);
        curves.outcome = Some(outcome.clone());
        if self.holes.len() < MOST_HOLES {
            self.holes.push(curves);
        } else if let Some(least) = self.holes.iter_mut().skip(1).min_by(|left, right| {
            let used = |curves: &HoleCurves| curves.outcome.as_ref().map_or(f64::INFINITY, HoleOutcome::used_ratio);
            used(left).total_cmp(&used(right))
        }) && least.outcome.as_ref().is_some_and(|kept| kept.used_ratio() < outcome.used_ratio())
        {
            *least = curves;
        }
    }

    fn unfinished(&mut self, outcome: &HoleOutcome) {
        self.hole(outcome);
    }
}

/// The figures of each hole that was kept.
#[must_use]
pub fn simulate_charts(program: &str, machine: &Machine, holes: &[HoleCurves]) -> Vec<ChartSet> {
    holes.iter().filter(|curves| !curves.rows.is_empty()).map(|curves| of_hole(program, machine, curves)).collect()
}

/// Every hole in one line.
#[must_use]
pub fn table_of_holes(outcome: &ProgramOutcome) -> Table {
    let head = [
        "hole",
        "verdict",
        "used %",
        "by",
        "e(k) µm",
        "true µm",
        "tolerance µm",
        "too deep µm",
        "clearance µm",
        "strokes s",
        "wait s",
    ];
    let rows = outcome.holes.iter().map(|hole| {
        vec![
            hole.hole.to_string(),
            hole.verdict().name().to_owned(),
            format!("{:.0}", 100.0 * hole.used_ratio()),
            decided_by(hole).to_owned(),
            format!("{:.1}", hole.error_um.peak_to_peak()),
            format!("{:.1}", hole.true_error_um.peak_to_peak()),
            format!("{:.1}", hole.tolerance_um),
            format!("{:.1}", hole.bottom_overshoot_um),
            format!("{:.0}", hole.bottom_clearance_um),
            format!("{:.4}", hole.strokes.iter().map(|stroke| stroke.duration_s).sum::<f64>()),
            format!("{:.3}", hole.wait_s),
        ]
    });
    Table { head: head.map(str::to_owned).to_vec(), rows: rows.collect() }
}

/// What decides a hole's verdict.
fn decided_by(outcome: &HoleOutcome) -> &'static str {
    if outcome.is_decided_by_depth() { "depth" } else { "thread" }
}

fn of_hole(program: &str, machine: &Machine, curves: &HoleCurves) -> ChartSet {
    let step = curves.rows.len().div_ceil(MOST_POINTS).max(1);
    let line = |name: &str, column: usize| {
        let rows = || curves.rows.iter().step_by(step);
        let y = rows().map(|row| Some(rounded(row[column])).filter(|value| value.is_finite())).collect();
        Line { name: name.into(), x: rows().map(|row| rounded(row[0])).collect(), y }
    };
    let outcome = curves.outcome.as_ref();
    let name = match outcome {
        Some(outcome) => format!(
            "hole {}: {}, {:.0} % used by the {}",
            curves.hole,
            outcome.verdict().name(),
            100.0 * outcome.used_ratio(),
            decided_by(outcome)
        ),
        None => format!("hole {}: not finished", curves.hole),
    };
    let chart = |title: &str, y_label: &str, series: Vec<Line>| Chart {
        title: title.into(),
        group: program.to_owned(),
        x_label: "time from the hole's first synchronous period, s".into(),
        y_label: y_label.into(),
        series,
        ..Chart::default()
    };
    let error = chart("", "µm", vec![line("measured", 1), line("true, at tool and table", 2)]);
    let error = match outcome {
        Some(outcome) => with_tolerance(error, &outcome.error_um, Some(outcome.tolerance_um)),
        None => Chart { title: "Synchronisation error e(k)".into(), ..error },
    };
    let available = |sign: f64, name: &str| {
        let mut available = line(name, 4);
        for (value, row) in available.y.iter_mut().zip(curves.rows.iter().step_by(step)) {
            *value = Some(rounded(sign * machine.motor().curve.torque_nm(row[4]))).filter(|value| value.is_finite());
        }
        available
    };
    let torque = chart(
        "Spindle torque against the motor's curve",
        "N·m",
        vec![line("torque", 5), available(1.0, "the motor's, at this speed"), available(-1.0, "the same, braking")],
    );
    let mut z = chart("Z", "mm", vec![line("command", 6), line("tool tip", 7)]);
    let tip = curves.rows.iter().map(|row| row[7]).fold(f64::INFINITY, f64::min);
    if let Some(outcome) = outcome.filter(|outcome| outcome.bottom_overshoot_um.is_finite() && tip.is_finite()) {
        let bottom_mm = tip + outcome.bottom_overshoot_um / um_from_mm(1.0);
        let lowest_mm = bottom_mm - outcome.bottom_clearance_um / um_from_mm(1.0);
        z.limits = vec![Level { y: lowest_mm, name: "bottom less its clearance".into() }];
    }
    ChartSet {
        name,
        charts: vec![error, chart("Spindle speed", "rpm", vec![line("command", 3), line("actual", 4)]), torque, z],
    }
}
