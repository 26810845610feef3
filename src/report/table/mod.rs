//! Tables for people.

pub(super) mod columns;
mod holes;
mod sweep;

pub use holes::{HoleGroups, holes};
pub use sweep::swept_program;

use columns::Columns;

use crate::control::cycle::Hand;
use crate::control::machine::{Law, Machine, Ramp};
use crate::control::motor::TorquePoint;
use crate::control::profile::Profile;
use crate::control::sync::{Compensation, ErrorBand, Settings};
use crate::control::units::rpm_from_rev_per_s;
use crate::gcode::SpindleCommand;
use crate::run::{HoleOutcome, ProgramOutcome, StrokeOutcome};
use crate::study::{Comparison, Summary, TimelineEntry, TimelineKind, Tuning};

use super::unit::deg_and_pulses_per_um;

/// One stroke's plan, segment by segment.
#[must_use]
pub fn stroke_plan(law: Law, command_rpm: f64, profile: &Profile, bound_s: f64) -> String {
    let mut table = Columns::new(&["segment", "start s", "time s", "from rev", "from rpm", "to rpm", "rpm/s"], 0);
    for (index, segment) in profile.segments().iter().enumerate() {
        table.row(vec![
            (index + 1).to_string(),
            format!("{:.4}", segment.start_s),
            format!("{:.4}", segment.duration_s),
            format!("{:.3}", segment.start.position),
            format!("{:.0}", rpm_from_rev_per_s(segment.start.velocity)),
            format!("{:.0}", rpm_from_rev_per_s(segment.end().velocity)),
            format!("{:.0}", rpm_from_rev_per_s(segment.start.acceleration)),
        ]);
    }
    let peak_rpm = rpm_from_rev_per_s(profile.peak_velocity());
    let short = if peak_rpm < command_rpm - 0.5 {
        format!(", {command_rpm:.0} rpm commanded and not reached")
    } else {
        String::new()
    };
    format!(
        "{law}: {distance} rev in {time:.4} s, peak {peak_rpm:.0} rpm{short}; {over:.3} times the bound ({bound_s:.4} s with \
         100 % of the motor, frictionless)\n{table}",
        law = law.name(),
        distance = profile.distance(),
        time = profile.duration_s(),
        over = profile.duration_s() / bound_s,
    )
}

/// Most steps under one heading: what is longer comes as several tables, so that it need not be in memory whole.
const STEPS_OF_A_PAGE: usize = 1000;

/// A program's timeline as planned, page by page.
pub struct TimelinePages {
    page: Columns,
    steps: usize,
}

impl TimelinePages {
    /// No step yet.
    #[must_use]
    pub fn new() -> Self {
        Self { page: Self::empty(), steps: 0 }
    }

    fn empty() -> Columns {
        Columns::new(&["what", "detail", "line", "start s", "time s", "X mm", "Y mm", "Z mm"], 2)
    }

    /// Adds a step; a page that is full.
    pub fn add(&mut self, entry: &TimelineEntry) -> Option<String> {
        self.page.row(timeline_row(entry));
        self.steps += 1;
        (self.steps.is_multiple_of(STEPS_OF_A_PAGE))
            .then(|| std::mem::replace(&mut self.page, Self::empty()).to_string())
    }

    /// The last page, and how long the program takes.
    #[must_use]
    pub fn finish(self, total_s: f64) -> String {
        let full = self.steps > 0 && self.steps.is_multiple_of(STEPS_OF_A_PAGE);
        let page = if full { String::new() } else { self.page.to_string() };
        format!("{page}{total_s:.3} s as planned, without settling at each R plane (10 ms and more)\n")
    }
}

impl Default for TimelinePages {
    fn default() -> Self {
        Self::new()
    }
}

fn timeline_row(entry: &TimelineEntry) -> Vec<String> {
    let detail = match entry.what {
        TimelineKind::Spindle(SpindleCommand::On { hand, speed_rpm }) => {
            format!("{} {speed_rpm:.0} rpm", if hand == Hand::Right { "M03" } else { "M04" })
        }
        TimelineKind::Leg { hole, peak_rpm, .. } if peak_rpm > 0.0 => {
            format!("hole {hole}, peak {peak_rpm:.0} rpm")
        }
        TimelineKind::Leg { hole, .. } => format!("hole {hole}"),
        _ => String::new(),
    };
    let [x, y, z] = entry.to_mm.map(|mm| format!("{mm:.3}"));
    vec![
        entry.what.name().into(),
        detail,
        entry.line.to_string(),
        format!("{:.4}", entry.start_s),
        format!("{:.4}", entry.duration_s),
        x,
        y,
        z,
    ]
}

/// Most holes that are shown one by one without being asked for.
const MOST_HOLES: usize = 50;

/// One simulated program, hole by hole; of many holes the worst, unless all are asked for.
#[must_use]
pub fn simulated_program(
    file: &str,
    law: Law,
    sync: Settings,
    machine: &Machine,
    outcome: &ProgramOutcome,
    all: bool,
) -> String {
    let mut table = Columns::new(
        &[
            "hole",
            "verdict",
            "stroke",
            "stroke s",
            "/bound",
            "peak rpm",
            "min µm",
            "max µm",
            "p-p µm",
            "rms µm",
            "p-p deg",
            "p-p pulses",
            "follow rev",
        ],
        3,
    );
    let worst = worst_hole(outcome);
    let brief = !all && outcome.holes.len() > MOST_HOLES;
    let shown = outcome.holes.iter().filter(|hole| !brief || worst.is_some_and(|worst| worst.hole == hole.hole));
    for hole in shown {
        for stroke in &hole.strokes {
            table.row(stroke_row(hole, stroke, machine));
        }
        table.row(hole_row(hole, machine));
    }
    let header = format!(
        "{file}: {law}, {mode}, compensation {compensation}{adapting}\n",
        law = law.name(),
        mode = sync.mode.name(),
        compensation = sync.compensation.name(),
        adapting = adapting(sync),
    );
    let others = if brief {
        format!("the worst of {}; -v shows all\n", counted(outcome.holes.len(), "hole"))
    } else {
        String::new()
    };
    format!("{header}{table}{others}{}", summary(machine, outcome))
}

fn worst_hole(outcome: &ProgramOutcome) -> Option<&HoleOutcome> {
    outcome.holes.iter().max_by(|left, right| left.worst_um().total_cmp(&right.worst_um()))
}

fn stroke_row(hole: &HoleOutcome, stroke: &StrokeOutcome, machine: &Machine) -> Vec<String> {
    let mut row = vec![
        String::new(),
        String::new(),
        stroke.kind.name().into(),
        format!("{:.4}", stroke.duration_s),
        format!("{:.3}", stroke.stroke_over_bound()),
        format!("{:.0}", stroke.peak_rpm),
    ];
    row.extend(error_cells(&stroke.error_um, hole, machine));
    row.push(format!("{:.3}", stroke.spindle_following_error_rev));
    row
}

fn hole_row(hole: &HoleOutcome, machine: &Machine) -> Vec<String> {
    let time_s: f64 = hole.strokes.iter().map(|stroke| stroke.duration_s).sum();
    let bound_s: f64 = hole.strokes.iter().map(|stroke| stroke.bound_s).sum();
    let peak_rpm = hole.strokes.iter().map(|stroke| stroke.peak_rpm).fold(0.0, f64::max);
    let mut row = vec![
        hole.hole.to_string(),
        verdict_and_saturation(hole.verdict().name(), hole.saturated),
        if hole.strokes.len() > 2 { "all" } else { "both" }.into(),
        format!("{time_s:.4}"),
        format!("{:.3}", time_s / bound_s),
        format!("{peak_rpm:.0}"),
    ];
    row.extend(error_cells(&hole.error_um, hole, machine));
    row.push(format!("{:.3}", hole.spindle_following_error_rev()));
    row
}

fn verdict_and_saturation(verdict: &str, saturated: bool) -> String {
    if saturated { format!("{verdict}, saturated") } else { verdict.to_owned() }
}

fn error_cells(band: &ErrorBand, hole: &HoleOutcome, machine: &Machine) -> [String; 6] {
    let (deg_per_um, pulses_per_um) = deg_and_pulses_per_um(hole.pitch_mm, machine);
    let peak_to_peak = band.peak_to_peak();
    [
        format!("{:.1}", band.min()),
        format!("{:.1}", band.max()),
        format!("{peak_to_peak:.1}"),
        format!("{:.1}", band.rms()),
        format!("{:.2}", peak_to_peak * deg_per_um),
        format!("{:.0}", peak_to_peak * pulses_per_um),
    ]
}

/// The worst hole in all three units, the truth beside it, and the verdict.
fn summary(machine: &Machine, outcome: &ProgramOutcome) -> String {
    let Some(worst) = worst_hole(outcome) else {
        return format!("no hole tapped; {:.3} s in all\n{}", outcome.total_s, stopped(outcome));
    };
    let (deg_per_um, pulses_per_um) = deg_and_pulses_per_um(worst.pitch_mm, machine);
    let mut text = format!("worst hole {}, e(k) over all its synchronous periods (e > 0: Z leads):\n", worst.hole);
    for (unit, band, digits) in [
        ("µm", worst.error_um, 1),
        ("spindle degrees", worst.error_um.scaled(deg_per_um), 2),
        ("encoder pulses", worst.error_um.scaled(pulses_per_um), 0),
        ("µm, true, at tool and table", worst.true_error_um, 1),
    ] {
        text += &format!(
            "  min {:.digits$}  max {:.digits$}  p-p {:.digits$}  rms {:.digits$}  {unit}\n",
            band.min(),
            band.max(),
            band.peak_to_peak(),
            band.rms(),
        );
    }
    let overshoot_um = outcome.holes.iter().map(|hole| hole.bottom_overshoot_um).fold(f64::NEG_INFINITY, f64::max);
    let deepest = if overshoot_um > 0.0 {
        format!("{overshoot_um:.1} µm too deep")
    } else {
        format!("{:.1} µm short of the programmed bottom", -overshoot_um)
    };
    text += &format!(
        "{} of tolerance {:.1} µm peak to peak: {}; deepest bottom {deepest}; {} in {:.3} s\n",
        percent(worst.worst_um() / worst.tolerance_um),
        worst.tolerance_um,
        outcome.verdict().name(),
        counted(outcome.holes.len(), "hole"),
        outcome.total_s,
    );
    text + &stopped(outcome)
}

/// The alarm that ended a run, as a line; nothing where none did.
fn stopped(outcome: &ProgramOutcome) -> String {
    outcome.fault.map_or_else(String::new, |fault| format!("stopped by an alarm: {}\n", super::alarm::sentence(&fault)))
}

/// A number of things, in the singular where it is one.
#[must_use]
pub fn counted(number: usize, thing: &str) -> String {
    if number == 1 { format!("1 {thing}") } else { format!("{number} {thing}s") }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}

/// Programs side by side under many settings, worst over the holes of each.
#[must_use]
pub fn compared(programs: &[(String, Vec<Comparison>)]) -> String {
    let with = |of: fn(&Comparison) -> bool| programs.iter().flat_map(|(_, list)| list).any(of);
    let shares = with(|comparison| comparison.variant.share.is_some());
    let withouts = with(|comparison| comparison.variant.without.is_some());
    let mut headings = vec!["program", "law", "sync", "compensation"];
    headings.extend(withouts.then_some("without"));
    headings.push("verdict");
    let text_columns = headings.len();
    headings.extend(shares.then_some("share"));
    headings.extend([
        "stroke s",
        "/bound",
        "peak rpm",
        "torque %",
        "jerk Mrpm/s²",
        "min µm",
        "max µm",
        "p-p µm",
        "true p-p",
        "follow rev",
    ]);
    let mut table = Columns::new(&headings, text_columns);
    for (file, comparisons) in programs {
        for comparison in comparisons {
            let (variant, summary) = (comparison.variant, Summary::of(&comparison.outcome));
            let mut row = vec![
                file.clone(),
                variant.law.name().into(),
                variant.sync.mode.name().into(),
                variant.sync.compensation.name().into(),
            ];
            if withouts {
                row.push(variant.without.map_or("", |effect| effect.name()).into());
            }
            row.push(verdict_and_saturation(summary.verdict.name(), summary.saturated));
            if shares {
                row.push(variant.share.map_or_else(String::new, |share| format!("{share:.2}")));
            }
            row.extend([
                format!("{:.4}", summary.stroke_s),
                format!("{:.3}", summary.stroke_over_bound),
                format!("{:.0}", summary.peak_rpm),
                format!("{:.0}", summary.peak_torque_share * 100.0),
                summary.peak_jerk_rpm_per_s2.map_or_else(|| "steps".into(), |jerk| format!("{:.2}", jerk / 1e6)),
                format!("{:.1}", summary.error_um.min()),
                format!("{:.1}", summary.error_um.max()),
                format!("{:.1}", summary.error_um.peak_to_peak()),
                format!("{:.1}", summary.true_error_um.peak_to_peak()),
                format!("{:.3}", summary.spindle_following_error_rev),
            ]);
            table.row(row);
        }
    }
    let alarms = programs.iter().flat_map(|(file, comparisons)| {
        comparisons.iter().filter_map(move |found| found.outcome.fault.map(|fault| (file, found.variant.law, fault)))
    });
    let told = alarms.map(|(file, law, fault)| {
        format!("{file}, {}: stopped by an alarm: {}\n", law.name(), super::alarm::sentence(&fault))
    });
    table.to_string() + &told.collect::<String>()
}

/// Tuned bands with their price, and what other numbers of bands would cost.
#[must_use]
pub fn tuning(tuning: &Tuning) -> String {
    let mut bands = Columns::new(&["band", "to rpm", "accel s", "decel s", "rpm/s", "motor at top"], 0);
    for ((number, band), spec) in (1..).zip(&tuning.best.bands).zip(&tuning.specs) {
        let time = |of: fn((f64, f64)) -> f64| match spec.ramp {
            Ramp::Time { accel_s, decel_s } => format!("{:.5}", of((accel_s, decel_s))),
            Ramp::Rate { .. } => String::new(),
        };
        bands.row(vec![
            i32::to_string(&number),
            band.to_rpm.to_string(),
            time(|pair| pair.0),
            time(|pair| pair.1),
            format!("{:.0}", band.rate_rpm_per_s),
            percent(band.motor_ratio_at_top),
        ]);
    }
    let mut prices = Columns::new(&["bands", "/bound"], 0);
    for (count, price) in (1..).zip(&tuning.prices) {
        prices.row(vec![i32::to_string(&count), format!("{price:.3}")]);
    }
    let strokes: Vec<_> = tuning.strokes_rev.iter().map(f64::to_string).collect();
    let measured = tuning.measured.as_ref().map_or_else(String::new, |curve| {
        let point = |point: &TorquePoint| format!("[{:.0}, {:.2}]", point.speed_rpm, point.torque_nm);
        let points: Vec<_> = curve.points().iter().map(point).collect();
        format!("measured, less friction: torque_curve = [{}]\n", points.join(", "))
    });
    format!(
        "{measured}{share} of the motor, strokes of {strokes} rev at {max_rpm} rpm: {price:.3} times the bound at the same share\n\
         {bands}\n{prices}",
        share = percent(tuning.motor_share),
        strokes = strokes.join(", "),
        max_rpm = tuning.max_rpm,
        price = tuning.best.stroke_over_bound,
    )
}

/// What the synchronizer takes from the machine itself, beyond the usual.
fn adapting(sync: Settings) -> String {
    let mut words = String::new();
    if sync.compensation == Compensation::Full {
        if !sync.identify {
            words += ", not identified";
        }
        if sync.learn {
            words += ", learning";
        }
    }
    words
}
