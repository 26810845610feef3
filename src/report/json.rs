//! JSON for programs. The fields are a contract: more may come beside them, these stay.

use serde_json::{Value, json};

use crate::control::cycle::{Hand, Retract, TapCycle};
use crate::control::machine::{Law, Machine, Ramp};
use crate::control::profile::Profile;
use crate::control::sync::{ErrorBand, Settings};
use crate::control::units::rpm_from_rev_per_s;
use crate::gcode::{Command, CommandKind, Diagnostic, SpindleCommand};
use crate::run::{HoleOutcome, ProgramOutcome, StrokeOutcome};
use crate::sim::{Actual, ActualValue};
use crate::study::{
    Comparison, Percentiles, Summary, Sweep, SweepSettings, SweptMachine, TimelineEntry, TimelineKind, Tuning,
};

use super::unit::deg_and_pulses_per_um;

/// `plan` of one stroke.
#[must_use]
pub fn stroke_plan(law: Law, command_rpm: f64, profile: &Profile) -> Value {
    let segments = profile.segments().iter().map(|segment| {
        json!({
            "start_s": segment.start_s,
            "duration_s": segment.duration_s,
            "position_rev": segment.start.position,
            "velocity_rev_per_s": segment.start.velocity,
            "acceleration_rev_per_s2": segment.start.acceleration,
            "jerk_rev_per_s3": segment.start.jerk,
            "snap_rev_per_s4": segment.snap,
        })
    });
    json!({
        "law": law.name(),
        "distance_rev": profile.distance(),
        "command_rpm": command_rpm,
        "peak_rpm": rpm_from_rev_per_s(profile.peak_velocity()),
        "duration_s": profile.duration_s(),
        "segments": segments.collect::<Vec<_>>(),
    })
}

/// A diagnostic of `check`.
#[must_use]
pub fn diagnostic(diagnostic: &Diagnostic) -> Value {
    json!({
        "severity": diagnostic.severity().name(),
        "code": diagnostic.code(),
        "line": diagnostic.line,
        "column": diagnostic.column,
        "message": diagnostic.message(),
        "hint": diagnostic.hint(),
    })
}

/// A command of `check`.
#[must_use]
pub fn command(command: &Command) -> Value {
    let line = command.line;
    let [x, y, z] = ["x_mm", "y_mm", "z_mm"];
    match command.kind {
        CommandKind::Rapid { to_mm } => {
            json!({ "kind": "rapid", "line": line, x: to_mm[0], y: to_mm[1], z: to_mm[2] })
        }
        CommandKind::Feed { to_mm, feed_mm_per_s } => json!({
            "kind": "feed", "line": line, x: to_mm[0], y: to_mm[1], z: to_mm[2], "feed_mm_per_s": feed_mm_per_s,
        }),
        CommandKind::Dwell { dwell_s } => json!({ "kind": "dwell", "line": line, "dwell_s": dwell_s }),
        CommandKind::Spindle(SpindleCommand::Off) => json!({ "kind": "spindle-off", "line": line }),
        CommandKind::Spindle(SpindleCommand::On { hand, speed_rpm }) => {
            json!({ "kind": "spindle-on", "line": line, "hand": hand_name(hand), "speed_rpm": speed_rpm })
        }
        CommandKind::Tap(cycle) => tap(line, &cycle),
        CommandKind::End => json!({ "kind": "end", "line": line }),
    }
}

fn tap(line: u32, cycle: &TapCycle) -> Value {
    json!({
        "kind": "tap",
        "line": line,
        "x_mm": cycle.x_mm,
        "y_mm": cycle.y_mm,
        "r_plane_mm": cycle.r_plane_mm,
        "bottom_mm": cycle.bottom_mm,
        "return_mm": cycle.return_mm,
        "pitch_mm": cycle.pitch_mm,
        "speed_rpm": cycle.speed_rpm,
        "out_speed_rpm": cycle.out_speed_rpm,
        "hand": hand_name(cycle.hand),
        "dwell_s": cycle.dwell_s,
        "peck_mm": cycle.peck_mm,
        "retract": cycle.retract.map(|retract| match retract {
            Retract::ChipBreak { .. } => "chip-break",
            Retract::Full => "full",
        }),
    })
}

pub(super) const fn hand_name(hand: Hand) -> &'static str {
    match hand {
        Hand::Right => "right",
        Hand::Left => "left",
    }
}

/// One program of `simulate`.
#[must_use]
pub fn simulated_program(file: &str, law: Law, sync: Settings, machine: &Machine, outcome: &ProgramOutcome) -> Value {
    json!({
        "file": file,
        "law": law.name(),
        "sync": sync.mode.name(),
        "compensation": sync.compensation.name(),
        "identify": sync.identify,
        "learn": sync.learn,
        "total_s": outcome.total_s,
        "verdict": outcome.verdict().name(),
        "alarm": outcome.fault.map(|fault| super::alarm::sentence(&fault)),
        "holes": outcome.holes.iter().map(|found| hole(found, machine)).collect::<Vec<_>>(),
    })
}

fn hole(hole: &HoleOutcome, machine: &Machine) -> Value {
    let (deg_per_um, pulses_per_um) = deg_and_pulses_per_um(hole.pitch_mm, machine);
    json!({
        "hole": hole.hole,
        "x_mm": hole.x_mm,
        "y_mm": hole.y_mm,
        "verdict": hole.verdict().name(),
        "pitch_mm": hole.pitch_mm,
        "tolerance_um": hole.tolerance_um,
        "error_um": band(&hole.error_um),
        "error_deg": band(&hole.error_um.scaled(deg_per_um)),
        "error_pulses": band(&hole.error_um.scaled(pulses_per_um)),
        "true_error_um": band(&hole.true_error_um),
        "bottom_overshoot_um": hole.bottom_overshoot_um,
        "saturated": hole.saturated,
        "strokes": hole.strokes.iter().map(stroke).collect::<Vec<_>>(),
    })
}

fn stroke(stroke: &StrokeOutcome) -> Value {
    json!({
        "stroke": stroke.kind.name(),
        "duration_s": stroke.duration_s,
        "bound_s": stroke.bound_s,
        "stroke_over_bound": stroke.stroke_over_bound(),
        "peak_rpm": stroke.peak_rpm,
        "error_um": band(&stroke.error_um),
        "spindle_following_error_rev": stroke.spindle_following_error_rev,
        "phases": stroke.phases.iter().map(|phase| json!({
            "phase": phase.phase, "error_um": band(&phase.error_um),
        })).collect::<Vec<_>>(),
    })
}

/// An error band E.
pub(super) fn band(band: &ErrorBand) -> Value {
    json!({ "min": band.min(), "max": band.max(), "peak_to_peak": band.peak_to_peak(), "rms": band.rms() })
}

/// One program of `compare`.
#[must_use]
pub fn compared_program(file: &str, comparisons: &[Comparison]) -> Value {
    let laws = comparisons.iter().map(|comparison| {
        let summary = Summary::of(&comparison.outcome);
        let variant = comparison.variant;
        json!({
            "law": variant.law.name(),
            "sync": variant.sync.mode.name(),
            "compensation": variant.sync.compensation.name(),
            "share": variant.share,
            "without": variant.without.map(|effect| effect.name()),
            "stroke_s": summary.stroke_s,
            "stroke_over_bound": summary.stroke_over_bound,
            "peak_rpm": summary.peak_rpm,
            "peak_torque_share": summary.peak_torque_share,
            "peak_jerk_rpm_per_s2": summary.peak_jerk_rpm_per_s2,
            "error_um": band(&summary.error_um),
            "true_error_um": band(&summary.true_error_um),
            "spindle_following_error_rev": summary.spindle_following_error_rev,
            "saturated": summary.saturated,
            "verdict": summary.verdict.name(),
            "alarm": comparison.outcome.fault.map(|fault| super::alarm::sentence(&fault)),
        })
    });
    json!({ "file": file, "laws": laws.collect::<Vec<_>>() })
}

/// `sweep`. A number that an alarm kept from being is null.
#[must_use]
pub fn swept_program(file: &str, law: Law, sync: Settings, settings: &SweepSettings, sweep: &Sweep) -> Value {
    let of = |number: fn(&SweptMachine) -> f64| {
        let Percentiles { p50, p99, p999, max } = sweep.percentiles(number);
        json!({ "p50": p50, "p99": p99, "p999": p999, "max": max })
    };
    let mut value = json!({
        "file": file,
        "law": law.name(),
        "sync": sync.mode.name(),
        "compensation": sync.compensation.name(),
        "identify": sync.identify,
        "learn": sync.learn,
        "runs": settings.runs.get(),
        "seed": settings.seed,
        "holes": settings.holes.get(),
        "nominal": settings.spread.is_none(),
        "hard": settings.hard.is_some(),
        "unstable": sweep.count(|machine| machine.unstable),
        "saturated": sweep.count(|machine| machine.saturated),
        "alarms": sweep.count(|machine| machine.alarm.is_some()),
        "error_um": of(|machine| machine.first.error_um),
        "true_error_um": of(|machine| machine.first.true_error_um),
        "worst_um": of(|machine| machine.first.worst_um),
        "bottom_overshoot_um": of(|machine| machine.first.bottom_overshoot_um),
        "stroke_over_bound": of(|machine| machine.first.stroke_over_bound),
        "fail_ratio": sweep.fail_ratio(),
        "warning_ratio": sweep.warning_ratio(),
        "tail": sweep.tail().iter().map(|shift| json!({
            "key": shift.key, "all": shift.all, "tail": shift.tail, "rank": shift.rank,
        })).collect::<Vec<_>>(),
        "worst": sweep.worst().map(|machine| json!({
            "run": machine.run, "seed": machine.seed, "worst_um": machine.first.worst_um, "actual": actual(&machine.actual),
        })),
    });
    if settings.holes.get() > 1 {
        let which = if sync.learn { "learned" } else { "last" };
        value[format!("{which}_worst_um")] = of(|machine| machine.last.worst_um);
        value[format!("{which}_bottom_overshoot_um")] = of(|machine| machine.last.bottom_overshoot_um);
        value["worst_growth_ratio"] = of(|machine| machine.worst_growth_ratio.unwrap_or(f64::NAN));
    }
    value
}

fn actual(actual: &Actual) -> Value {
    let value = |value: ActualValue| match value {
        ActualValue::Number(number) => json!(number),
        ActualValue::Word(word) => json!(word),
        ActualValue::Switch(on) => json!(on),
    };
    actual.values().into_iter().map(|(key, found)| (key.to_owned(), value(found))).collect()
}

/// A table of a TOML text; null where there is none.
#[must_use]
pub fn toml_table(text: &str, name: &str) -> Value {
    let table = text.parse::<toml::Table>().ok().and_then(|mut text| text.remove(name));
    table.and_then(|table| serde_json::to_value(table).ok()).unwrap_or_default()
}

/// `tune`.
#[must_use]
pub fn tuning(tuning: &Tuning) -> Value {
    let bands = tuning.best.bands.iter().zip(&tuning.specs).map(|(band, spec)| {
        let mut value = json!({ "to_rpm": band.to_rpm });
        if let Ramp::Time { accel_s, decel_s } = spec.ramp {
            value["accel_s"] = json!(accel_s);
            value["decel_s"] = json!(decel_s);
        }
        value["rate_rpm_per_s"] = json!(band.rate_rpm_per_s);
        value["motor_ratio_at_top"] = json!(band.motor_ratio_at_top);
        value
    });
    let prices = (1..).zip(&tuning.prices).map(|(bands, price)| json!({ "bands": bands, "stroke_over_bound": price }));
    let measured = tuning
        .measured
        .as_ref()
        .map(|curve| curve.points().iter().map(|point| json!([point.speed_rpm, point.torque_nm])).collect::<Vec<_>>());
    json!({
        "bands": bands.collect::<Vec<_>>(),
        "prices": prices.collect::<Vec<_>>(),
        "motor_share": tuning.motor_share,
        "max_rpm": tuning.max_rpm,
        "strokes_rev": tuning.strokes_rev,
        "measured_torque_curve": measured,
    })
}

/// A step of a program's `plan`.
#[must_use]
pub fn timeline_entry(entry: &TimelineEntry) -> Value {
    let mut value = json!({
        "kind": entry.what.name(),
        "line": entry.line,
        "start_s": entry.start_s,
        "duration_s": entry.duration_s,
        "from_mm": entry.from_mm,
        "to_mm": entry.to_mm,
    });
    match entry.what {
        TimelineKind::Leg { hole, pitch_mm, command_rpm, peak_rpm, .. } => {
            value["hole"] = json!(hole);
            value["pitch_mm"] = json!(pitch_mm);
            value["command_rpm"] = json!(command_rpm);
            value["peak_rpm"] = json!(peak_rpm);
        }
        TimelineKind::Spindle(SpindleCommand::On { hand, speed_rpm }) => {
            value["hand"] = json!(hand_name(hand));
            value["speed_rpm"] = json!(speed_rpm);
        }
        _ => {}
    }
    value
}
