//! Every fault at many moments of a hole: which alarm, how soon, and what is left of the thread.
//!
//! `cargo test --release --test plant the_whole_table -- --ignored` holds `fault_table.txt`; with `BLESS=1` it writes it anew.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rigidtap::control::sync::Compensation;
use rigidtap::sim::Fault;

use crate::fault_bounds::{Bounds, REASONS, bounds, exception, left_um};
use crate::fault_runs::{End, Hole, Seen, tap};

const SPEEDS_RPM: [f64; 3] = [1000.0, 3000.0, 7000.0];

/// One line of the table: the worst of some moments.
pub(crate) struct Row {
    pub(crate) fault: Fault,
    pub(crate) hole: Hole,
    /// How often each alarm came; none is 0.
    pub(crate) codes: BTreeMap<u32, u32>,
    /// Least and greatest periods to the alarm.
    pub(crate) periods: Option<[u32; 2]>,
    pub(crate) error_um: f64,
    pub(crate) z_step: f64,
    pub(crate) spindle_step: f64,
    pub(crate) least_mm: f64,
    ends: BTreeMap<End, u32>,
    /// Greatest |e| of the hole without a fault.
    pub(crate) healthy_um: f64,
}

impl Row {
    fn new(fault: Fault, hole: Hole, moments: u32) -> Self {
        let healthy = tap(hole, None);
        assert!(healthy.alarm.is_none() && healthy.end == End::Done, "{hole:?}: {healthy:?}");
        let [first, last] = healthy.synchronous;
        let seen: Vec<_> = (0..moments)
            .map(|moment| tap(hole, Some((fault, first + (2 * moment + 1) * (last - first) / (2 * moments)))))
            .collect();
        let greatest = |value: fn(&Seen) -> f64| seen.iter().map(value).fold(0.0, f64::max);
        let mut row = Self {
            fault,
            hole,
            codes: BTreeMap::new(),
            periods: None,
            error_um: greatest(|seen| seen.error_um),
            z_step: greatest(|seen| seen.z_step),
            spindle_step: greatest(|seen| seen.spindle_step),
            least_mm: -greatest(|seen| -seen.least_mm),
            ends: BTreeMap::new(),
            healthy_um: healthy.error_um,
        };
        for seen in &seen {
            let (code, periods) = seen.alarm.unwrap_or_default();
            *row.codes.entry(code).or_default() += 1;
            *row.ends.entry(seen.end).or_default() += 1;
            if code > 0 {
                let [least, most] = row.periods.unwrap_or([periods; 2]);
                row.periods = Some([least.min(periods), most.max(periods)]);
            }
        }
        row
    }

    /// More is left of the thread's error than should be.
    fn is_off(&self) -> bool {
        self.error_um > bounds(self).error_um
    }

    /// What of the bounds is broken.
    fn broken(&self) -> Vec<String> {
        let Bounds { codes, periods, error_um } = bounds(self);
        let mut broken = Vec::new();
        // 10 m/s² of Z, and five quarters of 20 N·m on 0.004 kg·m², for a period.
        let most = 0.001 * 1.25 * 20.0 / (0.004 * std::f64::consts::TAU);
        if self.z_step > 10.0 + 1e-6 || self.spindle_step > most + 1e-6 {
            broken.push("a setpoint leaps".to_owned());
        }
        for code in self.codes.keys().filter(|code| !codes.contains(code)) {
            broken.push(format!("alarm {code}, where {codes:?} are right"));
        }
        if let Some([_, most]) = self.periods.filter(|[_, most]| *most > periods) {
            broken.push(format!("{most} periods, {periods} are the most"));
        }
        let error_um = error_um.max(left_um(self));
        if self.error_um > error_um {
            broken.push(format!("{:.1} µm, {error_um:.1} are the most", self.error_um));
        }
        let alarmed: u32 = self.codes.iter().filter(|(code, _)| **code > 0).map(|(_, count)| count).sum();
        if self.ends.get(&End::Held).copied().unwrap_or_default() != alarmed {
            broken.push("what alarmed is not held".to_owned());
        }
        broken
    }

    fn line(&self) -> String {
        let codes = self.codes.iter().rev().map(|(code, count)| match code {
            0 => format!("none×{count}"),
            _ => format!("A{code}×{count}"),
        });
        let codes = codes.collect::<Vec<_>>();
        let ends: Vec<_> = self.ends.iter().map(|(end, count)| format!("{}×{count}", end.name())).collect();
        let periods = self.periods.map_or_else(|| "-".to_owned(), |[least, most]| format!("{least}…{most}"));
        let note = exception(self).filter(|_| self.is_off()).map_or_else(String::new, |reason| format!(" ({reason})"));
        format!(
            "{:<22} {:>4} {:<5} {:<17} {:>8} {:>8.1} {:>5.2} {:>6.3} {:>8.3} {:<14}{note}",
            self.fault.to_string(),
            self.hole.speed_rpm,
            self.hole.compensation.name(),
            codes.join(" "),
            periods,
            self.error_um,
            self.z_step,
            self.spindle_step,
            self.least_mm,
            ends.join(" "),
        )
    }
}

fn rows(speeds_rpm: &[f64], compensations: &[Compensation], moments: u32) -> Vec<Row> {
    let mut cases = Vec::new();
    for fault in Fault::all() {
        for &speed_rpm in speeds_rpm {
            cases.extend(compensations.iter().map(|&compensation| (fault, Hole { speed_rpm, compensation })));
        }
    }
    let (next, rows) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let workers = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(&(fault, hole)) = cases.get(index) else { return };
                    let row = Row::new(fault, hole, moments);
                    rows.lock().expect("no worker panics").push((index, row));
                }
            });
        }
    });
    let mut rows = rows.into_inner().expect("no worker panics");
    rows.sort_by_key(|(index, _)| *index);
    rows.into_iter().map(|(_, row)| row).collect()
}

fn assert_within(rows: &[Row]) {
    let broken: Vec<_> = rows
        .iter()
        .flat_map(|row| row.broken().into_iter().map(|what| format!("{}\n    {what}\n", row.line())))
        .collect();
    assert!(broken.is_empty(), "{} rows are out of bounds:\n{}", broken.len(), broken.concat());
}

fn text(rows: &[Row], moments: u32) -> String {
    let mut text = format!(
        "One M6 hole of 25 mm, torque curve, commanded; each fault at {moments} moments of its strokes, the worst of them.\n\
         Alarms with how often each came; periods from the fault to them; greatest true |e| in the thread from the fault on, µm;\n\
         greatest change of a setpoint's speed in a period, Z in mm/s and spindle in rev/s; the tip's least z, bottom at -25 mm;\n\
         state at the end. A number in brackets says why a row is beyond its bounds: see the end.\n\n\
         {:<22} {:>4} {:<5} {:<17} {:>8} {:>8} {:>5} {:>6} {:>8} state\n",
        "fault", "S", "", "alarms", "periods", "|e| µm", "Z", "sp", "least z"
    );
    for row in rows {
        writeln!(text, "{}", row.line().trim_end()).unwrap();
    }
    text.push('\n');
    for (number, reason) in (1..).zip(REASONS) {
        writeln!(text, "({number}) {reason}").unwrap();
    }
    text
}

#[test]
fn every_fault_is_seen_in_time_and_leaves_a_thread() {
    assert_within(&rows(&[7000.0], &[Compensation::Uncompensated, Compensation::ModelBased], 2));
}

#[test]
#[ignore = "five thousand holes take minutes"]
fn the_whole_table() {
    const MOMENTS: u32 = 16;
    let rows = rows(&SPEEDS_RPM, &Compensation::ALL, MOMENTS);
    let text = text(&rows, MOMENTS);
    assert!(text.lines().all(|line| line.chars().count() <= 120), "a line is too long to read");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/plant/fault_table.txt");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert_within(&rows);
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    for (line, (kept, found)) in (1..).zip(kept.lines().zip(text.lines())) {
        assert_eq!(kept, found, "line {line} of {}", path.display());
    }
    assert_eq!(kept.len(), text.len());
}
