//! From a recorded run-up to a torque curve.
//!
//! Speed differentiated from row to row is mostly noise. Instead, the kinetic energy per inertia w = v²/2 grows by the
//! power, dw/dt = a·v = P(v), and between the points of a torque curve P is linear in v. So the gain of w over a window
//! of time is linear in P's unknowns, with integrals of the measured speed as factors: one weighted least-squares fit,
//! indifferent to the rows' spacing. Where P bends is found point by point, as long as that explains more than noise.

use nalgebra::{DMatrix, DVector};

use super::run_up::{LEAST_ROWS, RunUp, RunUpError, RunUpFault, Sample};
use crate::control::motor::{MAX_POINTS, Motor, TorqueCurve, TorquePoint};
use crate::control::units::{RAD_PER_REV, rev_per_s_from_rpm};

/// The run-up counts from here…
const FROM: f64 = 0.02;
/// …to here, of the greatest speed: drives start and settle softly.
const TO: f64 = 0.97;
/// A log has to reach this much of the spindle's greatest speed…
const REACH: f64 = 0.9;
/// …and to start below this much.
const START: f64 = 0.25;
/// Rise of the speed over one window, of the greatest speed.
const WINDOW: f64 = 0.03;
/// Candidates for the bends of P(v), and their least distance, both of the greatest speed.
const CANDIDATE: f64 = 0.005;
const APART: f64 = 0.03;
/// Most bends; with both ends of the curve well within what a machine file takes.
const MOST_BENDS: usize = 8;
const _: () = assert!(MOST_BENDS + 3 <= MAX_POINTS);
/// Deviations below this are no reason for another bend.
const FLOOR: f64 = 1e-3;

/// A part of the run-up, with speeds over the greatest one.
struct Window {
    duration_s: f64,
    speed: f64,
    /// Mean dw/dt.
    power: f64,
    /// Its rows and both ends.
    samples: Vec<(f64, f64)>,
}

impl RunUp {
    /// The motor that would have run up like this, turning `inertia_kg_m2`: what friction took is not in its curve.
    ///
    /// The torque follows from the inertia, the acceleration does not depend on it. The curve ends at `max_rpm`; the
    /// last 3 % of the speed are taken to have the power below them, since there the drive settles.
    ///
    /// # Errors
    /// [`RunUpFault::StartsFast`], [`RunUpFault::EndsSlow`], [`RunUpFault::FewRows`], [`RunUpFault::NoCurve`].
    pub fn motor(&self, max_rpm: f64, inertia_kg_m2: f64) -> Result<Motor, RunUpError> {
        motor(&self.samples, max_rpm, inertia_kg_m2).map_err(|fault| RunUpError {
            line: self.last_line,
            column: 1,
            fault,
        })
    }
}

/// The motor whose whole torque gives this run-up.
fn motor(samples: &[Sample], max_rpm: f64, inertia_kg_m2: f64) -> Result<Motor, RunUpFault> {
    let rising = run_up(&without_spikes(samples), max_rpm)?;
    if rising.len() < LEAST_ROWS {
        return Err(RunUpFault::FewRows { found: rising.len() });
    }
    let windows = steady(windows(&rising));
    let fit = Fit::of(&windows).ok_or(RunUpFault::NoCurve)?;
    let rate_to_nm = inertia_kg_m2 * RAD_PER_REV * rev_per_s_from_rpm(max_rpm);
    let mut points: arrayvec::ArrayVec<TorquePoint, MAX_POINTS> = arrayvec::ArrayVec::new();
    // Above the last rows the power is not known to rise further.
    let (settling, full) = (fit.power(TO), fit.power(1.0));
    let held = (full > settling).then_some((TO, settling));
    let bends = fit.bends.iter().map(|&speed| (speed, fit.power(speed)));
    let corners = bends.chain(held).chain([(1.0, full.min(settling))]);
    for (speed, power) in corners {
        let torque_nm = rate_to_nm * power / speed;
        if points.is_empty() {
            points.push(TorquePoint { speed_rpm: 0.0, torque_nm });
        }
        points.push(TorquePoint { speed_rpm: speed * max_rpm, torque_nm });
    }
    let curve = TorqueCurve::new(&points).map_err(|_| RunUpFault::NoCurve)?;
    Ok(Motor { curve, inertia_kg_m2 })
}

/// Each speed as the median of five rows: a dropped or doubled count lasts one or two.
fn without_spikes(samples: &[Sample]) -> Vec<Sample> {
    let middle = |index: usize| {
        let reach = 2.min(index).min(samples.len() - 1 - index);
        median(samples[index - reach..=index + reach].iter().map(|sample| sample.rpm).collect())
    };
    samples.iter().enumerate().map(|(index, sample)| Sample { rpm: middle(index), ..*sample }).collect()
}

/// The first run-up of the log, as pairs of time and speed over the greatest speed.
fn run_up(samples: &[Sample], max_rpm: f64) -> Result<Vec<(f64, f64)>, RunUpFault> {
    let speeds = || samples.iter().map(|sample| sample.rpm / max_rpm);
    let reached = speeds().fold(0.0, f64::max);
    if reached < REACH {
        return Err(RunUpFault::EndsSlow { reached_rpm: reached * max_rpm, needed_rpm: REACH * max_rpm });
    }
    let to = TO * reached.min(1.0);
    let end = speeds().position(|speed| speed >= to).unwrap_or(samples.len() - 1);
    let standing = speeds().take(end).collect::<Vec<_>>().iter().rposition(|speed| *speed <= FROM);
    let start = standing.map_or(0, |standing| standing + 1).min(end);
    let from = speeds().nth(start).unwrap_or(0.0);
    if from > START {
        return Err(RunUpFault::StartsFast { from_rpm: from * max_rpm, limit_rpm: START * max_rpm });
    }
    let rising = samples.iter().zip(speeds()).take(end + 1).skip(start);
    Ok(rising.map(|(sample, speed)| (sample.time_s, speed)).collect())
}

fn windows(rising: &[(f64, f64)]) -> Vec<Window> {
    let mut windows = Vec::new();
    let mut start = 0;
    for end in 1..rising.len() {
        let ((from_s, from), (to_s, to)) = (rising[start], rising[end]);
        if to - from >= WINDOW {
            let duration_s = to_s - from_s;
            windows.push(Window {
                duration_s,
                speed: (from + to) / 2.0,
                power: (to * to - from * from) / (2.0 * duration_s),
                samples: rising[start..=end].to_vec(),
            });
            start = end;
        }
    }
    windows
}

/// The windows without those in which the motor, or the log, stood still: much unlike their neighbours.
fn steady(windows: Vec<Window>) -> Vec<Window> {
    const REACH: usize = 4;
    const LEAST: f64 = 0.1;
    /// Standard deviations of a normal distribution in its median absolute deviation.
    const SIGMA: f64 = 1.4826;
    let rates: Vec<f64> = windows.iter().map(|window| window.power / window.speed).collect();
    let deviations: Vec<f64> = (0..rates.len())
        .map(|index| {
            let near = index.saturating_sub(REACH)..(index + REACH + 1).min(rates.len());
            rates[index] / median(rates[near].to_vec()) - 1.0
        })
        .collect();
    let limit = (4.0 * SIGMA * median(deviations.iter().map(|deviation| deviation.abs()).collect())).max(LEAST);
    windows.into_iter().zip(deviations).filter(|(_, off)| off.abs() <= limit).map(|(window, _)| window).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// P(v) = c₀·v + Σ cᵢ·(v − bendᵢ)⁺, with v over the greatest speed.
struct Fit {
    bends: Vec<f64>,
    factors: DVector<f64>,
}

impl Fit {
    /// Bends are added where they explain most, then each is moved to where it explains more; the information criterion
    /// of Schwarz (1978) says when to stop.
    fn of(windows: &[Window]) -> Option<Self> {
        let problem = Problem::of(windows);
        let mut bends = Vec::new();
        let mut least = problem.criterion(&bends)?;
        while bends.len() < MOST_BENDS {
            let mut more = bends.clone();
            more.push(0);
            // Twice: the first bends were placed for want of the later ones.
            for index in (0..more.len()).rev().chain(0..more.len()) {
                problem.place(&mut more, index);
            }
            match problem.criterion(&more) {
                Some(criterion) if criterion < least => (bends, least) = (more, criterion),
                _ => break,
            }
        }
        bends.sort_unstable();
        let factors = problem.solve(&bends)?.0;
        Some(Self { bends: bends.iter().map(|bend| problem.candidates[bend - 1]).collect(), factors })
    }

    fn power(&self, speed: f64) -> f64 {
        let bent: f64 = self.bends.iter().zip(self.factors.iter().skip(1)).map(|(k, c)| c * (speed - k).max(0.0)).sum();
        self.factors[0] * speed + bent
    }
}

/// The normal equations of all candidates at once; a set of bends picks its rows and columns.
struct Problem {
    /// Speeds at which P may bend; candidate i is column i + 1, and column 0 is c₀'s.
    candidates: Vec<f64>,
    products: DMatrix<f64>,
    targets: DVector<f64>,
    target_square: f64,
    windows: f64,
}

impl Problem {
    fn of(windows: &[Window]) -> Self {
        let steps = ((TO - APART - 2.0 * APART) / CANDIDATE) as u32;
        let candidates: Vec<f64> = (0..=steps).map(|step| 2.0 * APART + f64::from(step) * CANDIDATE).collect();
        let columns = candidates.len() + 1;
        // A window's power is as uncertain as the speeds at its ends: by speed over duration. Over P, that is 1/(a·t).
        let weight = |window: &Window| window.duration_s / window.speed;
        let factors = DMatrix::from_fn(windows.len(), columns, |row, column| {
            let above = column.checked_sub(1).map_or(0.0, |candidate| candidates[candidate]);
            weight(&windows[row]) * mean_above(&windows[row], above)
        });
        let values = DVector::from_fn(windows.len(), |row, _| weight(&windows[row]) * windows[row].power);
        Self {
            products: factors.tr_mul(&factors),
            targets: factors.tr_mul(&values),
            target_square: values.norm_squared(),
            windows: windows.len() as f64,
            candidates,
        }
    }

    /// Factors and residual for bends at these candidates, from 1.
    fn solve(&self, bends: &[usize]) -> Option<(DVector<f64>, f64)> {
        let columns: Vec<usize> = std::iter::once(0).chain(bends.iter().copied()).collect();
        let products = self.products.select_rows(&columns).select_columns(&columns);
        let targets = self.targets.select_rows(&columns);
        let factors = products.cholesky()?.solve(&targets);
        let residual = self.target_square - factors.dot(&targets);
        Some((factors, residual))
    }

    /// Schwarz's criterion; a bend counts twice, for its place and its factor.
    fn criterion(&self, bends: &[usize]) -> Option<f64> {
        let residual = self.solve(bends)?.1.max(FLOOR * FLOOR * self.target_square);
        Some(self.windows * (residual / self.windows).ln() + 2.0 * (bends.len() + 1) as f64 * self.windows.ln())
    }

    /// Moves one bend to the candidate that explains most, apart from the others.
    fn place(&self, bends: &mut [usize], index: usize) {
        let apart = (APART / CANDIDATE) as usize;
        let mut best = (f64::INFINITY, bends[index]);
        for candidate in 1..=self.candidates.len() {
            let near = |(other, bend): (usize, &usize)| other != index && bend.abs_diff(candidate) < apart;
            if bends.iter().enumerate().any(near) {
                continue;
            }
            bends[index] = candidate;
            if let Some((_, residual)) = self.solve(bends)
                && residual < best.0
            {
                best = (residual, candidate);
            }
        }
        bends[index] = best.1;
    }
}

/// Mean over a window's time of (v − above)⁺, the speed taken as linear between rows.
fn mean_above(window: &Window, above: f64) -> f64 {
    let integral = |v: f64| (v - above).max(0.0).powi(2) / 2.0;
    let pairs = window.samples.iter().zip(window.samples.iter().skip(1));
    let sum: f64 = pairs
        .map(|(&(from_s, from), &(to_s, to))| {
            let mean = if from == to { (from - above).max(0.0) } else { (integral(to) - integral(from)) / (to - from) };
            mean * (to_s - from_s)
        })
        .sum();
    sum / window.duration_s
}
