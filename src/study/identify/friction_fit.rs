//! Z's friction over speed, place and travel since a reversal, fitted to forces and encoder counts.
//!
//! Balances of momentum over short windows, so that the encoders' noise stays at a window's ends: mean force = mass ×
//! change of speed / time + friction. The friction is that of a [`Stribeck`] contact at the motor and one at the table,
//! each with its own travel. Its scale over the place and the weight enter linearly and are solved for inside; Gauss and
//! Newton's method, damped after Levenberg and Marquardt, moves the three others (variable projection: Golub, Pereyra,
//! 1973).
//!
//! The estimator in the period ([`Adaptation`](crate::control::sync::Adaptation)) answers another question: how great the
//! sliding friction is now, in bounded time and with the file's value as prior; it knows neither speed nor pre-sliding.

use nalgebra::{DMatrix, DVector, Matrix3, MatrixXx3, Vector3};

use crate::control::machine::Machine;
use crate::control::model::friction::{Stribeck, preslide_one_way};
use crate::control::units::{m_from_mm, mm_from_um, um_from_mm};

use super::motion::Motion;

/// Length of a window: some periods of the screw's resonance would be too long for a reversal, one is enough.
const WINDOW_S: f64 = 0.012;
/// Force that a window is off by anyway, as a share of the file's friction, and share of its inertial force: mass and
/// stiffness are not exactly the file's.
const NOISE_SHARE: f64 = 0.02;
const INERTIAL_SHARE: f64 = 0.05;
/// Distance of the knots between which the scale over the place is straight, and how many at most.
const KNOT_MM: f64 = 2.0;
const KNOTS: usize = 200;
/// Weight of neighbouring knots' difference: it only fills places that were not visited.
const SMOOTHNESS: f64 = 0.02;
/// Travel in pre-sliding travels after which the contact's state at the start is forgotten.
const FORGOTTEN: f64 = 12.0;
/// Parameters stay within this many times the file's.
const REACH: f64 = 20.0;
const STATIC_RATIO_MAX: f64 = 5.0;
const ITERATIONS: u32 = 40;
/// Times that the damping is raised in search of a better step.
const DAMPINGS: u32 = 8;
/// Step of a parameter, a logarithm, for the residuals' change by it.
const STEP: f64 = 1e-3;
/// Keeps the matrix of a held parameter regular.
const TINY: f64 = 1e-9;
/// Standard error up to which a parameter counts as measured, relative.
const MEASURED: f64 = 0.15;
/// Static ratio below which there is no Stribeck effect whose speed could be measured.
const FLAT: f64 = 1.05;

/// What was found; none where the motion does not say it and the file's value was held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FrictionFit {
    /// Sliding friction, mean over the travel.
    pub(super) coulomb_n: f64,
    pub(super) static_ratio: Option<f64>,
    pub(super) stribeck_mm_per_s: Option<f64>,
    pub(super) presliding_um: Option<f64>,
}

/// One balance: the force less the inertial one, and where and when.
struct Window {
    from: usize,
    to: usize,
    friction_n: f64,
    place_mm: f64,
    /// One over the standard deviation expected.
    weight: f64,
}

struct Problem<'a> {
    motions: &'a [Motion],
    windows: Vec<Window>,
    table_share: f64,
    nominal: Stribeck,
    period_s: f64,
    first_mm: f64,
    knot_mm: f64,
    knots: usize,
}

/// Shape of the friction for given parameters, with the linear part solved.
struct Solved {
    residuals: DVector<f64>,
    scales_n: Vec<f64>,
}

/// Fits the friction; none where there is nothing to fit it to.
pub(super) fn fit(motions: &[Motion], machine: &Machine) -> Option<FrictionFit> {
    let problem = Problem::new(motions, machine)?;
    let mut free = [true; 3];
    loop {
        let found = problem.fit(free)?;
        let [ratio, speed, presliding] = found.errors;
        let flat = found.contact.static_ratio < FLAT;
        // Without the speed the ratio is anything, unless it is none at all.
        let ratio_measured = ratio < MEASURED && (flat || (free[1] && speed < MEASURED));
        let measured = [ratio_measured, ratio_measured && !flat && speed < MEASURED, presliding < MEASURED];
        let kept = [free[0] && measured[0], free[1] && measured[1], free[2] && measured[2]];
        if kept == free {
            let contact = found.contact;
            return Some(FrictionFit {
                coulomb_n: found.coulomb_n,
                static_ratio: free[0].then_some(contact.static_ratio),
                stribeck_mm_per_s: free[1].then_some(contact.stribeck_speed),
                presliding_um: free[2].then_some(um_from_mm(contact.presliding)),
            });
        }
        free = kept;
    }
}

/// One fit with its parameters' standard errors, relative.
struct Fitted {
    coulomb_n: f64,
    contact: Stribeck,
    errors: [f64; 3],
}

impl<'a> Problem<'a> {
    fn new(motions: &'a [Motion], machine: &Machine) -> Option<Self> {
        let spec = &machine.spec().z_axis;
        let period_s = machine.spec().control.period_s;
        let presliding = mm_from_um(spec.presliding_um);
        let periods = (WINDOW_S / period_s).round().max(2.0) as usize;
        let start = motions.iter().position(|motion| {
            let from = motions.first();
            from.is_some_and(|from| {
                (motion.motor_mm - from.motor_mm).abs().min((motion.table_mm - from.table_mm).abs())
                    > FORGOTTEN * presliding
            })
        })?;
        let noise_n = NOISE_SHARE * spec.coulomb_n.max(1.0);
        let speeds = |at: usize| {
            let (now, before) = (motions.get(at)?, motions.get(at.checked_sub(1)?)?);
            let table = (now.table_mm - before.table_mm) / period_s;
            Some(spec.table_share * table + (1.0 - spec.table_share) * (now.motor_mm - before.motor_mm) / period_s)
        };
        let mut windows = Vec::new();
        for from in (start.max(1)..motions.len()).step_by(periods) {
            let to = from + periods;
            let (Some(last), Some(first), Some(inside)) = (motions.get(to), motions.get(from), motions.get(from..=to))
            else {
                break;
            };
            // The drive says nothing here.
            if inside.iter().all(|motion| motion.force_n == 0.0) || first.table_mm == last.table_mm {
                continue;
            }
            let change = m_from_mm(speeds(to)? - speeds(from)?);
            let inertial_n = spec.mass_kg * change / (periods as f64 * period_s);
            let sum: f64 = inside.iter().map(|motion| motion.force_n).sum();
            let force_n = (sum - 0.5 * (first.force_n + last.force_n)) / periods as f64;
            windows.push(Window {
                from,
                to,
                friction_n: force_n - inertial_n,
                place_mm: 0.5 * (first.motor_mm + last.motor_mm),
                weight: 1.0 / noise_n.hypot(INERTIAL_SHARE * inertial_n),
            });
        }
        let places = || windows.iter().map(|window| window.place_mm);
        let (first_mm, last_mm) = (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
        let travel_mm = last_mm - first_mm;
        if !(travel_mm > 0.0) {
            return None;
        }
        let knots = ((travel_mm / KNOT_MM).ceil() as usize).clamp(1, KNOTS - 1) + 1;
        Some(Self {
            motions,
            windows,
            table_share: spec.friction_table_share,
            nominal: Stribeck {
                coulomb: 1.0,
                static_ratio: spec.static_ratio.max(1.01),
                stribeck_speed: spec.stribeck_mm_per_s,
                presliding,
            },
            period_s,
            first_mm,
            knot_mm: travel_mm / (knots - 1) as f64,
            knots,
        })
    }

    /// Fits those parameters that are free, the others stay the file's.
    fn fit(&self, free: [bool; 3]) -> Option<Fitted> {
        let mut parameters = Vector3::new(self.nominal.static_ratio.ln(), 0.0, 0.0);
        let mut solved = self.solve(&parameters)?;
        let mut damping = 1e-3;
        let mut curvature = Matrix3::identity();
        for _ in 0..ITERATIONS {
            let jacobian = self.jacobian(&parameters, &solved, free)?;
            curvature = jacobian.tr_mul(&jacobian);
            let slope = jacobian.tr_mul(&solved.residuals);
            let cost = solved.residuals.norm_squared();
            let mut gained = 0.0;
            for _ in 0..DAMPINGS {
                let damped = curvature + Matrix3::from_diagonal(&curvature.diagonal().map(|d| damping * d + TINY));
                let tried = self.within(parameters - damped.lu().solve(&slope)?);
                let there = self.solve(&tried)?;
                let gain = cost - there.residuals.norm_squared();
                if gain > 0.0 {
                    (parameters, solved, gained) = (tried, there, gain);
                    damping *= 0.2;
                    break;
                }
                damping *= 5.0;
            }
            if gained <= 1e-9 * cost {
                break;
            }
        }
        let freedom = self.windows.len().saturating_sub(self.knots + 4).max(1) as f64;
        // Never better than the noise that was expected.
        let variance = (solved.residuals.norm_squared() / freedom).max(1.0);
        let covariance = (curvature + Matrix3::from_diagonal_element(TINY)).try_inverse()? * variance;
        Some(Fitted {
            coulomb_n: self.mean_scale(&solved.scales_n),
            contact: self.contact(&parameters),
            errors: [0, 1, 2].map(|index| covariance[(index, index)].max(0.0).sqrt()),
        })
    }

    fn within(&self, parameters: Vector3<f64>) -> Vector3<f64> {
        let reach = REACH.ln();
        Vector3::new(
            parameters[0].clamp(0.0, STATIC_RATIO_MAX.ln()),
            parameters[1].clamp(-reach, reach),
            parameters[2].clamp(-reach, reach),
        )
    }

    /// Parameters are logarithms: of the static ratio, and of the two others over the file's.
    fn contact(&self, parameters: &Vector3<f64>) -> Stribeck {
        Stribeck {
            coulomb: 1.0,
            static_ratio: parameters[0].exp(),
            stribeck_speed: self.nominal.stribeck_speed * parameters[1].exp(),
            presliding: self.nominal.presliding * parameters[2].exp(),
        }
    }

    /// Mean friction of each window where the scale is 1.
    fn shapes(&self, contact: &Stribeck) -> Vec<f64> {
        let (mut motor, mut table) = (0.0, 0.0);
        let mut before = self.motions.first().copied().unwrap_or_default();
        let mut each = Vec::with_capacity(self.motions.len());
        for motion in self.motions {
            let of = |state: &mut f64, travel_mm: f64| {
                let old = *state;
                if travel_mm != 0.0 {
                    *state = preslide_one_way(old, travel_mm / contact.presliding);
                }
                0.5 * (old + *state) * contact.level(travel_mm / self.period_s)
            };
            let at_motor = of(&mut motor, motion.motor_mm - before.motor_mm);
            let at_table = of(&mut table, motion.table_mm - before.table_mm);
            each.push((1.0 - self.table_share) * at_motor + self.table_share * at_table);
            before = *motion;
        }
        let mean = |window: &Window| {
            let inside = each.get(window.from..=window.to).unwrap_or_default();
            let ends = inside.first().copied().unwrap_or_default() + inside.last().copied().unwrap_or_default();
            (inside.iter().sum::<f64>() - 0.5 * ends) / (window.to - window.from) as f64
        };
        self.windows.iter().map(mean).collect()
    }

    /// Knot below a place, and the share of the way to the next.
    fn knot(&self, place_mm: f64) -> (usize, f64) {
        let at = ((place_mm - self.first_mm) / self.knot_mm).clamp(0.0, (self.knots - 1) as f64);
        let below = (at as usize).min(self.knots - 2);
        (below, at - below as f64)
    }

    /// Solves for the scales at the knots and the weight.
    fn solve(&self, parameters: &Vector3<f64>) -> Option<Solved> {
        let shapes = self.shapes(&self.contact(parameters));
        let unknowns = self.knots + 1;
        let mut normal = DMatrix::<f64>::zeros(unknowns, unknowns);
        let mut right = DVector::<f64>::zeros(unknowns);
        let row = |window: &Window, shape: f64| {
            let (below, share) = self.knot(window.place_mm);
            let scaled = window.weight * shape;
            [(below, scaled * (1.0 - share)), (below + 1, scaled * share), (self.knots, window.weight)]
        };
        for (window, shape) in self.windows.iter().zip(&shapes) {
            let entries = row(window, *shape);
            for (i, a) in entries {
                right[i] += a * window.weight * window.friction_n;
                for (j, b) in entries {
                    normal[(i, j)] += a * b;
                }
            }
        }
        for below in 0..self.knots - 1 {
            let square = SMOOTHNESS * SMOOTHNESS;
            normal[(below, below)] += square;
            normal[(below + 1, below + 1)] += square;
            normal[(below, below + 1)] -= square;
            normal[(below + 1, below)] -= square;
        }
        normal[(self.knots, self.knots)] += 1e-9;
        normal[(0, 0)] += 1e-9;
        let solution = normal.cholesky()?.solve(&right);
        let residual = |(window, shape): (&Window, &f64)| {
            row(window, *shape).iter().map(|(i, a)| a * solution[*i]).sum::<f64>() - window.weight * window.friction_n
        };
        let residuals = self.windows.iter().zip(&shapes).map(residual);
        Some(Solved {
            residuals: DVector::from_iterator(self.windows.len(), residuals),
            scales_n: solution.iter().take(self.knots).copied().collect(),
        })
    }

    /// Change of the residuals by each parameter, the linear part solved anew each time.
    fn jacobian(&self, parameters: &Vector3<f64>, here: &Solved, free: [bool; 3]) -> Option<MatrixXx3<f64>> {
        let mut jacobian = MatrixXx3::zeros(self.windows.len());
        for (index, _) in free.iter().enumerate().filter(|(_, free)| **free) {
            let mut moved = *parameters;
            moved[index] += STEP;
            jacobian.set_column(index, &((self.solve(&moved)?.residuals - &here.residuals) / STEP));
        }
        Some(jacobian)
    }

    /// Mean over the places that were passed both ways: where only one was, weight and friction are hard to tell apart.
    fn mean_scale(&self, scales_n: &[f64]) -> f64 {
        let mut passed = vec![[false; 2]; self.knots - 1];
        for window in &self.windows {
            let upwards = matches!((self.motions.get(window.from), self.motions.get(window.to)), (Some(from), Some(to)) if to.table_mm > from.table_mm);
            if let Some(cell) = passed.get_mut(self.knot(window.place_mm).0) {
                cell[usize::from(upwards)] = true;
            }
        }
        let cells = || scales_n.windows(2).zip(&passed).filter(|(_, passed)| passed.iter().all(|way| *way));
        let sum: f64 = cells().map(|(ends, _)| ends.iter().sum::<f64>() / 2.0).sum();
        sum / cells().count().max(1) as f64
    }
}
