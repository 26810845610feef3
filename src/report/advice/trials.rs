//! The speeds that advice looked at, as rows.

use crate::control::units::MS_PER_S;
use crate::study::{KindAdvice, Trial};

/// The speeds that were tried for holes of a kind, slower first, each with what it stands for: the advised one, and the
/// program as it is now.
pub(in crate::report) fn trials(kind: &KindAdvice) -> Vec<(&'static str, Trial)> {
    let mut rows: Vec<(&str, Trial)> = kind.others.iter().map(|trial| ("", *trial)).collect();
    rows.push(("advised", kind.trial));
    rows.extend(kind.present.map(|trial| ("now", trial)));
    rows.sort_by(|left, right| left.1.speed_rpm.total_cmp(&right.1.speed_rpm));
    rows
}

/// Such a trial as cells: name, rpm, ms a hole, error and depth in µm, share of the tolerance in percent, machines that held.
pub(in crate::report) fn trial_cells(name: &str, trial: &Trial) -> Vec<String> {
    let shown = |value: f64, digits: usize| if value.is_finite() { format!("{value:.digits$}") } else { "–".into() };
    vec![
        name.to_owned(),
        format!("{:.0}", trial.speed_rpm),
        shown(trial.hole_s * MS_PER_S, 0),
        shown(trial.worst_um, 1),
        shown(trial.deepest_um, 1),
        shown(100.0 * trial.used, 0),
        format!("{}/{}", trial.good, trial.runs),
    ]
}
