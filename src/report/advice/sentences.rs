//! The answer in three sentences.

use crate::control::machine::Law;
use crate::control::thread::StandardPitch;
use crate::control::units::S_PER_HOUR;
use crate::report::words::counted;
use crate::study::{Advice, HoleKind, KindAdvice, Limit};

/// What the advice was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Law that the programs run under now.
    pub present: Law,
    /// Machines that the advice is shown on.
    pub runs: u32,
    /// Greatest share of tolerance and clearance.
    pub margin: f64,
    /// Parts in a year.
    pub parts_per_year: Option<f64>,
}

/// What share of such machines hold, by 95 % confidence, where all of `runs` do: 0.05 to the power of 1/runs.
///
/// ```
/// assert!((rigidtap::report::advice::yield_bound(200) - 0.985).abs() < 2e-4);
/// ```
#[must_use]
pub fn yield_bound(runs: u32) -> f64 {
    0.05_f64.powf(1.0 / f64::from(runs))
}

/// "21 holes M6, 25 mm deep".
#[must_use]
pub fn kind_name(kind: &HoleKind) -> String {
    let thread = StandardPitch::of(kind.hole.pitch_mm)
        .map_or_else(|| format!("pitch {} mm", kind.hole.pitch_mm), |found| found.name.to_owned());
    format!("{} {thread}, {:.4} mm deep", counted(kind.count, "hole"), kind.hole.depth_mm()).replace(".0000 mm", " mm")
}

fn setting(law: Law, share: Option<f64>) -> String {
    let share = share.map_or_else(String::new, |share| format!(" at {:.0} % of the motor", 100.0 * share));
    format!("law {}{share}", law.name())
}

/// What to set, what it gains, and what limits it.
#[must_use]
pub fn answer_sentences(advice: &Advice, asked: &Asked) -> [String; 3] {
    let speeds = advice.kinds.iter().map(|kind| format!("S{:.0} for {}", kind.trial.speed_rpm, kind_name(&kind.kind)));
    let worst = advice.kinds.iter().map(|kind| kind.trial.used).fold(0.0, f64::max);
    let set = format!(
        "Set {}: {}; the worst of {} drawn machines uses {:.0} % of what thread and depth allow, and with 95 % confidence \
         at least {:.1} % of such machines stay under {:.0} %.",
        setting(advice.law, advice.share),
        speeds.collect::<Vec<_>>().join(", "),
        asked.runs,
        100.0 * worst,
        100.0 * yield_bound(asked.runs),
        100.0 * asked.margin,
    );
    let gain = match advice.present_s {
        Some(present_s) => {
            let saved_s = present_s - advice.part_s;
            let share = 100.0 * saved_s / present_s;
            let now = format!("as it runs now, law {} at the programs' own S", asked.present.name());
            let gain = if saved_s.abs() < 0.0005 * present_s {
                format!("as long as {now}")
            } else if saved_s > 0.0 {
                format!("{saved_s:.2} s or {share:.1} % less than {now}")
            } else {
                format!("{:.2} s or {:.1} % more than {now}: that one does not hold", -saved_s, -share)
            };
            let year = asked.parts_per_year.map_or_else(String::new, |parts| {
                format!("; in {parts:.0} parts a year {:.1} h", parts * saved_s / S_PER_HOUR)
            });
            format!("A part takes {:.2} s, {gain}{year}.", advice.part_s)
        }
        None => format!(
            "A part takes {:.2} s; as it runs now, law {} has no plan for it on this machine.",
            advice.part_s,
            asked.present.name()
        ),
    };
    let mut limits: Vec<String> = Vec::new();
    for kind in &advice.kinds {
        let said = match kind.limit {
            Limit::Motor { .. } => {
                "the motor's acceleration over the depth, so that a greater S changes nothing".to_owned()
            }
            _ => limit_sentence(kind),
        };
        if !limits.contains(&said) {
            limits.push(said);
        }
    }
    let more = advice.more_torque_s.filter(|more_s| *more_s > 0.0005 * advice.part_s);
    let more =
        more.map_or_else(String::new, |more_s| format!("; 20 % more torque would take another {more_s:.2} s off"));
    [set, gain, format!("What limits it: {}{more}.", limits.join("; "))]
}

/// What keeps a kind from being faster, and what would change that.
#[must_use]
pub fn limit_sentence(advice: &KindAdvice) -> String {
    match advice.limit {
        Limit::Motor { peak_rpm } => format!(
            "the motor's acceleration over this depth: the spindle has to brake at {peak_rpm:.0} rpm, and a greater S changes \
             nothing"
        ),
        Limit::SpindleSpeed { max_rpm } => format!("the spindle's {max_rpm:.0} rpm"),
        Limit::ZSpeed { max_mm_per_s } => format!("Z's {max_mm_per_s:.0} mm/s at this pitch"),
        Limit::Error { fails_at_rpm, by_depth, effect } => {
            let what = if by_depth { "depth of the bottom" } else { "synchronisation error" };
            let effect = effect.map_or_else(
                || "of which no single effect makes most".to_owned(),
                |effect| format!("most of it by {}", effect.name()),
            );
            format!("the {what}, which passes its margin at S{fails_at_rpm:.0}, {effect}")
        }
    }
}
