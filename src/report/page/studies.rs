//! Figures of sweeps, comparisons and advice.

use super::html::{Chart, ChartSet, Level, Line, Page, Table};
use crate::control::units::MS_PER_S;
use crate::report::advice::{Asked, ControlSheet, kind_name, limit_sentence, trial_cells, trials};
use crate::study::{Advice, Comparison, KindAdvice, Sweep, Trial};

/// Bars of a histogram.
const BARS: usize = 40;

/// A sweep: the distribution of what its first hole uses, the tolerance, and what makes the tail.
///
/// # Errors
/// Where the machines cannot be read again.
pub fn sweep_charts(sweep: &mut Sweep, tolerance_um: Option<f64>) -> std::io::Result<(Vec<ChartSet>, Table)> {
    let all = sweep.worst_um()?;
    let machines = all.len();
    let values: Vec<f64> = all.into_iter().filter(|um| um.is_finite()).collect();
    let most = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let width = most / BARS as f64;
    let mut counts = vec![0.0; BARS];
    for value in &values {
        counts[((value / width) as usize).min(BARS - 1)] += 1.0;
    }
    let limit = |part: f64, name: &str| {
        tolerance_um.map(|um| Level { y: part * um, name: format!("{name} {:.1} µm", part * um) })
    };
    let bars = Line {
        name: "machines".into(),
        x: (0..BARS).map(|bar| bar as f64 * width).collect(),
        y: counts.into_iter().map(Some).collect(),
    };
    let mut sorted = values;
    sorted.sort_by(f64::total_cmp);
    let yielded = Line {
        name: "machines up to this error".into(),
        y: (1..=sorted.len()).map(|rank| Some(100.0 * rank as f64 / machines as f64)).collect(),
        x: sorted,
    };
    let chart = |title: &str, y_label: &str, line: Line, bars: bool| Chart {
        title: title.into(),
        group: "sweep".into(),
        x_label: "peak-to-peak e(k) of the first hole, the worse of measured and true, µm".into(),
        y_label: y_label.into(),
        series: vec![line],
        x_limits: limit(0.5, "half").into_iter().chain(limit(1.0, "tolerance")).collect(),
        bars,
        from_zero: true,
        ..Chart::default()
    };
    let distribution = tolerance_um.map_or_else(
        || "Distribution over the machines".to_owned(),
        |um| format!("Distribution over the machines, tolerance {um:.1} µm"),
    );
    let charts =
        vec![chart(&distribution, "machines", bars, true), chart("Yield", "% of the machines", yielded, false)];
    let mut table = Table {
        head: ["effect", "median of all", "median of the worst hundredth", "rank of that"].map(str::to_owned).to_vec(),
        rows: Vec::new(),
    };
    for shift in sweep.summary.tail.iter().take(10) {
        table.rows.push(vec![
            shift.key.clone(),
            format!("{:.4}", shift.all),
            format!("{:.4}", shift.tail),
            format!("{:.2}", shift.rank),
        ]);
    }
    Ok((vec![ChartSet { name: "all machines".into(), charts }], table))
}

/// A program under several settings, e(k) over each other.
#[must_use]
pub fn compare_charts(program: &str, comparisons: &[(String, &Comparison)], period_s: f64) -> Vec<ChartSet> {
    let holes: Vec<u32> = {
        let mut holes: Vec<u32> =
            comparisons.iter().flat_map(|(_, found)| found.series.points.iter().map(|point| point.hole)).collect();
        holes.sort_unstable();
        holes.dedup();
        holes.truncate(30);
        holes
    };
    let of_hole = |hole: u32| {
        let series = comparisons.iter().map(|(name, found)| {
            let points: Vec<_> = found.series.points.iter().filter(|point| point.hole == hole).collect();
            let first = points.first().map_or(0, |point| point.k);
            Line {
                name: name.clone(),
                x: points.iter().map(|point| (point.k - first) as f64 * period_s).collect(),
                y: points.iter().map(|point| Some(point.error_um).filter(|um| um.is_finite())).collect(),
            }
        });
        let tolerance_um =
            comparisons.iter().find_map(|(_, found)| found.outcome.holes.first().map(|hole| hole.tolerance_um));
        let tolerance = tolerance_um.map_or_else(String::new, |um| format!(", tolerance {um:.1} µm peak to peak"));
        ChartSet {
            name: format!("hole {hole}"),
            charts: vec![Chart {
                title: format!("{program}, hole {hole}: measured e(k){tolerance}"),
                group: program.to_owned(),
                x_label: "time from the hole's first synchronous period, s".into(),
                y_label: "µm".into(),
                series: series.collect(),
                band: tolerance_um.map(|um| [-um / 2.0, um / 2.0]),
                ..Chart::default()
            }],
        }
    };
    holes.into_iter().map(of_hole).collect()
}

/// All of an advice below its heading.
pub fn advise_page(page: &mut Page, advice: &Advice, asked: &Asked, control: Option<&ControlSheet>, toml: &str) {
    for kind in &advice.kinds {
        page.heading(&kind_name(&kind.kind));
        page.say(&format!(
            "Line {}: S{:.0} F{:.1}. Limit: {}.",
            kind.kind.line,
            kind.trial.speed_rpm,
            kind.trial.speed_rpm * kind.kind.hole.pitch_mm,
            limit_sentence(kind)
        ));
        page.table(&speeds(kind));
        page.figures(vec![ChartSet { name: String::new(), charts: curves(kind, asked.margin) }]);
    }
    page.heading("Settings that were looked at");
    let rows = advice.alternatives.iter().map(|found| {
        vec![
            found.law.name().to_owned(),
            found.share.map_or_else(String::new, |share| format!("{share:.2}")),
            found.holes_s.map_or_else(|| "does not hold".to_owned(), |seconds| format!("{seconds:.3}")),
        ]
    });
    page.table(&Table { head: ["law", "share", "all holes s"].map(str::to_owned).to_vec(), rows: rows.collect() });
    if let Some(sheet) = control {
        page.heading(&format!("{}: what to type in", sheet.control.name()));
        let rows = sheet.parameters.iter().map(|found| {
            let number = found.number.unwrap_or("–").to_owned();
            let value = format!("{} {}", found.value, found.unit);
            vec![number, value.trim_end().to_owned(), found.name.into(), found.rounding.into(), found.source.into()]
        });
        let head = ["number", "value", "meaning", "rounding", "source"].map(str::to_owned).to_vec();
        page.table(&Table { head, rows: rows.collect() });
        sheet.notes.iter().for_each(|note| page.say(note));
    }
    page.heading("To paste into the machine file");
    page.verbatim(toml);
}

fn speeds(kind: &KindAdvice) -> Table {
    let rows = trials(kind).into_iter().map(|(name, trial)| trial_cells(name, &trial));
    let head = ["", "S rpm", "hole ms", "worst µm", "too deep µm", "used %", "good"].map(str::to_owned).to_vec();
    Table { head, rows: rows.collect() }
}

fn curves(kind: &KindAdvice, margin: f64) -> Vec<Chart> {
    let rows: Vec<Trial> =
        trials(kind).into_iter().filter(|(name, _)| *name != "now").map(|(_, trial)| trial).collect();
    let line = |name: &str, of: &dyn Fn(&Trial) -> f64| Line {
        name: name.into(),
        x: rows.iter().map(|trial| trial.speed_rpm).collect(),
        y: rows.iter().map(|trial| Some(of(trial)).filter(|value| value.is_finite())).collect(),
    };
    let chart = |title: &str, y_label: &str, line: Line, limits: Vec<Level>| Chart {
        title: title.into(),
        group: format!("line {}", kind.kind.line),
        x_label: "S, rpm".into(),
        y_label: y_label.into(),
        series: vec![line],
        limits,
        x_limits: vec![Level { y: kind.trial.speed_rpm, name: "advised".into() }],
        from_zero: true,
        ..Chart::default()
    };
    vec![
        chart("Time of one hole", "ms", line("hole", &|trial| trial.hole_s * MS_PER_S), Vec::new()),
        chart(
            "What the worst machine uses of tolerance and clearance",
            "%",
            line("used", &|trial| 100.0 * trial.used),
            vec![Level { y: 100.0 * margin, name: "margin".into() }],
        ),
    ]
}
