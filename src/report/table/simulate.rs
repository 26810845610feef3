//! `simulate` for people: what a program comes to, its worst hole, and the holes that are not ok.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use super::words::{counted, percent, settings, yes};
use crate::control::machine::{Law, Machine, Takes, ZEncoderAt};
use crate::control::sync::{ErrorBand, Settings};
use crate::report::alarm::{power_loss_sentence, sentence};
use crate::report::unit::deg_and_pulses_per_um;
use crate::run::{HoleOutcome, ProgramOutcome, StrokeOutcome, Verdict};

/// Most holes that are shown one by one unless all are asked for.
const MOST_HOLES: usize = 50;

/// What the encoders do not see, where Z has one on its motor alone.
fn unseen(machine: &Machine) -> Option<String> {
    let z = &machine.spec().z_axis;
    if z.encoder_at == ZEncoderAt::Table {
        return None;
    }
    if machine.spec().drive.spindle_takes == Takes::Speed {
        return Some(
            "Z's encoder sits on its motor: backlash and wind-up of the screw are in the true e(k) alone.".into(),
        );
    }
    Some({
        format!(
            "Z's encoder sits on its motor: measured e(k) is less backlash ({:.1} µm as told) and wind-up of the screw by the \
             model, and what they are off by, or its pitch error, no encoder sees; the true e(k) has it.",
            z.backlash_um
        )
    })
}

/// One program that ran: its summary, and below it its worst hole and those that are not ok, or all holes.
#[must_use]
pub fn simulated_program(
    layout: Layout,
    file: &str,
    law: Law,
    sync: Settings,
    machine: &Machine,
    outcome: &ProgramOutcome,
    all_holes: bool,
) -> String {
    let mut page = Page::new(layout);
    let worst = worst_hole(outcome);
    page.say(headline(file, outcome, worst));
    if let Some(fault) = &outcome.fault {
        page.say(format!("stopped by an alarm: {}", sentence(fault)));
    }
    if let Some(loss) = &outcome.power_loss {
        page.say(power_loss_sentence(loss));
    }
    if let Some(words) = saturation(&outcome.holes) {
        page.say(words);
    }
    let bridged: u32 = outcome.holes.iter().map(|hole| hole.bridged_samples).sum();
    if bridged > 0 {
        page.say(format!("{} bridged by the model", counted(bridged as usize, "missing sample")));
    }
    page.say(format!("{}, {}", law.name(), settings(sync)));
    let Some(worst) = worst else { return page.finish() };

    page.blank().table(&worst_errors(worst, machine));
    page.say(format!(
        "e(k) = Z travel − pitch × spindle travel over the whole hole; above 0 Z leads. Tolerance {:.1} µm peak to peak. \
         {}.",
        worst.tolerance_um,
        deepest(&outcome.holes),
    ));
    if let Some(words) = unseen(machine) {
        page.say(words);
    }
    page.say(waits(outcome));
    let listed = |hole: &&HoleOutcome| all_holes || hole.hole == worst.hole || hole.verdict() != Verdict::Ok;
    let most = if all_holes { usize::MAX } else { MOST_HOLES };
    let shown: Vec<_> = outcome.holes.iter().filter(listed).take(most).collect();
    page.blank().table(&strokes(&shown, all_holes, worst.hole, machine));
    let others: Vec<_> = outcome.holes.iter().filter(|hole| !shown.iter().any(|one| one.hole == hole.hole)).collect();
    let bad = others.iter().filter(|hole| hole.verdict() != Verdict::Ok).count();
    if others.len() > bad {
        page.say(format!("{} ok; --holes shows all", counted(others.len() - bad, "more hole")));
    }
    if bad > 0 {
        page.say(format!("{} not ok; --holes shows all", counted(bad, "more hole")));
    }
    page.finish()
}

/// Why a spindle falls behind: a line of its own, whatever columns there are.
fn saturation(holes: &[HoleOutcome]) -> Option<String> {
    let count = holes.iter().filter(|hole| hole.saturated).count();
    (count > 0).then(|| {
        format!(
            "the spindle's drive stood at its torque limit in {} of {}: the law asks more than the motor has there",
            count,
            counted(holes.len(), "hole")
        )
    })
}

/// A program in one sentence: its verdict, how long it takes, and its worst hole.
#[must_use]
pub fn program_summary(file: &str, outcome: &ProgramOutcome) -> String {
    headline(file, outcome, worst_hole(outcome))
}

/// The hole whose error or depth uses most of what is allowed.
fn worst_hole(outcome: &ProgramOutcome) -> Option<&HoleOutcome> {
    outcome.holes.iter().max_by(|left, right| left.used_ratio().total_cmp(&right.used_ratio()))
}

/// Verdict first: what a person looks for.
fn headline(file: &str, outcome: &ProgramOutcome, worst: Option<&HoleOutcome>) -> String {
    let verdict = outcome.verdict().name();
    let taken = format!("{} in {:.3} s", counted(outcome.holes.len(), "hole"), outcome.total_s);
    match worst {
        None => format!("{file}: {verdict}, {taken}"),
        Some(worst) => format!(
            "{file}: {verdict}, {taken}; worst hole {} at {} its {}",
            worst.hole,
            of_tolerance(worst.used_ratio()),
            if worst.is_decided_by_depth() { "bottom clearance" } else { "tolerance" }
        ),
    }
}

/// A share of the tolerance, as a person would say it.
fn of_tolerance(share: f64) -> String {
    if share < 10.0 { format!("{} of", percent(share)) } else { format!("{share:.0} times") }
}

/// How deep the deepest hole is.
fn deepest(holes: &[HoleOutcome]) -> String {
    let overshoot_um = holes.iter().map(|hole| hole.bottom_overshoot_um).fold(f64::NEG_INFINITY, f64::max);
    let decides = holes.iter().find(|hole| hole.depth_verdict() > Verdict::Ok);
    if let Some(hole) = decides {
        let (verdict, clearance_um) = (hole.depth_verdict().name(), hole.bottom_clearance_um);
        format!("Deepest bottom {overshoot_um:.1} µm too deep: {verdict}, of a clearance of {clearance_um:.0} µm")
    } else if overshoot_um > 0.0 {
        format!("Deepest bottom {overshoot_um:.1} µm too deep")
    } else {
        format!("Deepest bottom {:.1} µm short of the programmed one", -overshoot_um)
    }
}

/// What the holes wait at R for both axes to stand: part of the program's time, and none of the strokes'.
fn waits(outcome: &ProgramOutcome) -> String {
    let sum_s: f64 = outcome.holes.iter().map(|hole| hole.wait_s).sum();
    let longest = outcome.holes.iter().max_by(|left, right| left.wait_s.total_cmp(&right.wait_s));
    let longest =
        longest.map_or_else(String::new, |hole| format!(", at most {:.3} s (hole {})", hole.wait_s, hole.hole));
    let mean_s = sum_s / outcome.holes.len().max(1) as f64;
    format!("Waits at R for spindle and Z to stand: {sum_s:.3} s in all, {mean_s:.3} s a hole{longest}")
}

/// The worst hole's band in all three units, and the truth beside it.
fn worst_errors(hole: &HoleOutcome, machine: &Machine) -> Columns {
    let (deg_per_um, pulses_per_um) = deg_and_pulses_per_um(hole.pitch_mm, machine);
    let mut table = Columns::new(&[
        text("e(k) of the worst hole", 0),
        number("min", 0),
        number("max", 0),
        number("p-p", 0),
        number("rms", 0),
    ]);
    for (name, band, digits) in [
        ("measured, µm", hole.error_um, 1),
        ("measured, spindle degrees", hole.error_um.scaled(deg_per_um), 2),
        ("measured, encoder pulses", hole.error_um.scaled(pulses_per_um), 0),
        ("true, at tool and table, µm", hole.true_error_um, 1),
    ] {
        let values = [band.min(), band.max(), band.peak_to_peak(), band.rms()].map(|value| format!("{value:.digits$}"));
        table.row(std::iter::once(name.to_owned()).chain(values).collect());
    }
    table
}

/// The holes as a whole; below each other the strokes of the worst one, or of all, and what they come to.
fn strokes(holes: &[&HoleOutcome], all: bool, worst: u32, machine: &Machine) -> Columns {
    let mut table = Columns::new(&[
        number("hole", 0),
        text("verdict", 0),
        text("stroke", 0),
        number("time s", 0),
        number("time/min", 2),
        number("peak rpm", 1),
        number("min µm", 3),
        number("max µm", 3),
        number("p-p µm", 0),
        number("rms µm", 4),
        number("p-p deg", 6),
        number("p-p pulses", 7),
        number("following rev", 8),
        text("saturated", 5),
    ]);
    for hole in holes {
        for stroke in hole.strokes.iter().filter(|_| all || hole.hole == worst) {
            table.row(stroke_row(hole, stroke, machine));
        }
        table.row(hole_row(hole, machine));
    }
    table
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
    row.push(String::new());
    row
}

fn hole_row(hole: &HoleOutcome, machine: &Machine) -> Vec<String> {
    let time_s: f64 = hole.strokes.iter().map(|stroke| stroke.duration_s).sum();
    let minimum_s: f64 = hole.strokes.iter().map(|stroke| stroke.bound_s).sum();
    let peak_rpm = hole.strokes.iter().map(|stroke| stroke.peak_rpm).fold(0.0, f64::max);
    let mut row = vec![
        hole.hole.to_string(),
        hole.verdict().name().into(),
        if hole.strokes.len() > 2 { "all" } else { "both" }.into(),
        format!("{time_s:.4}"),
        format!("{:.3}", time_s / minimum_s),
        format!("{peak_rpm:.0}"),
    ];
    row.extend(error_cells(&hole.error_um, hole, machine));
    row.push(format!("{:.3}", hole.spindle_following_error_rev()));
    row.push(yes(hole.saturated).into());
    row
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
