//! The LuGre model: Canudas de Wit, Olsson, Åström and Lischinsky, "A new model for control of systems with friction",
//! IEEE Trans. Automatic Control 40 (1995) 419–425.

use super::contact_spec::ContactSpec;
use crate::control::math::{exp, sqrt};

/// Share of critical damping that σ1 gives the mass on its bristles: the paper's own example, σ1 = √σ0 for 1 kg.
const BRISTLE_DAMPING: f64 = 0.5;

/// The contact with its mean bristle deflection z:
/// ż = v − σ0·|v|/g(v)·z, F = σ0·z + σ1(v)·ż. The viscous part of the paper, σ2·v, is a key of its own.
///
/// σ1(v) = σ1·exp(−(v/v_s)²), as Olsson, "Control systems with friction" (1996), has it: a constant one makes the model
/// feed power in at speed.
#[derive(Clone, Debug)]
pub(crate) struct LuGre {
    spec: ContactSpec,
    step_s: f64,
    sigma0: f64,
    sigma1: f64,
    deflection: f64,
}

impl LuGre {
    pub(super) fn new(spec: ContactSpec, step_s: f64) -> Self {
        // The bristles' stiffness is that of the other laws at rest: the static level over the pre-sliding travel.
        let sigma0 = spec.static_ratio * spec.coulomb / spec.presliding;
        let sigma1 = 2.0 * BRISTLE_DAMPING * sqrt(sigma0 * spec.mass);
        Self { spec, step_s, sigma0, sigma1, deflection: 0.0 }
    }

    // Kept out of the plant step, whose standard law would lose its registers to it.
    #[inline(never)]
    pub(super) fn force(&mut self, speed: f64) -> f64 {
        let level = self.spec.level(speed);
        // Implicit in z, so that no speed and no step makes it overshoot g/σ0.
        let rate = self.sigma0 * speed.abs() / level;
        let after = (self.deflection + self.step_s * speed) / (1.0 + self.step_s * rate);
        let deflection_rate = (after - self.deflection) / self.step_s;
        self.deflection = after;
        let ratio = speed / self.spec.stribeck_speed;
        let damping = if ratio.abs() > 4.0 { 0.0 } else { self.sigma1 * exp(-ratio * ratio) };
        self.sigma0 * after + damping * deflection_rate
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{SPEC, STEP_S, travel};
    use super::*;

    fn contact() -> LuGre {
        LuGre::new(SPEC, STEP_S)
    }

    /// Pre-sliding in closed form: from rest at a slow constant speed F = Fs·(1 − exp(−x/x_s)), σ1 aside.
    #[test]
    fn presliding_is_an_exponential_of_the_travel() {
        let mut contact = contact();
        let speed = 1e-5;
        let mut x = 0.0;
        for _ in 0..60_000 {
            let force = contact.force(speed);
            x += speed * STEP_S;
            let level = SPEC.level(speed);
            let expected = level * (1.0 - (-contact.sigma0 * x / level).exp())
                + contact.sigma1 * speed * (-x / SPEC.presliding).exp();
            assert!((force - expected).abs() < 0.005 * level, "{force} for {expected} N at {x} m");
        }
    }

    /// Steady sliding is Stribeck's curve.
    #[test]
    fn steady_sliding_is_the_level() {
        for speed in [1e-4, 1e-3, 2e-3, 5e-3, 0.1, -0.1] {
            let mut contact = contact();
            let force = (0..400_000).map(|_| contact.force(speed)).last().unwrap();
            assert!((force - SPEC.level(speed).copysign(speed)).abs() < 1e-6 * SPEC.coulomb, "{force} at {speed} m/s");
        }
    }

    /// As the paper finds it: break-away force falls as the force rises faster.
    #[test]
    fn breakaway_falls_with_the_rate_of_the_applied_force() {
        let breakaway = |newtons_per_s: f64| {
            let (mut contact, mut speed, mut most) = (contact(), 0.0, 0.0_f64);
            let mut applied = 0.0;
            while speed < 5e-4 {
                applied += newtons_per_s * STEP_S;
                let friction = contact.force(speed);
                most = most.max(friction);
                speed += (applied - friction) / SPEC.mass * STEP_S;
            }
            most
        };
        let (slow, fast) = (breakaway(50.0), breakaway(50_000.0));
        assert!((slow / (1.3 * SPEC.coulomb) - 1.0).abs() < 0.06, "{slow} N");
        assert!(fast < slow, "{fast} N fast, {slow} N slow");
    }

    /// As the paper finds it: at a speed that swings without reversing, friction is higher while the speed rises.
    #[test]
    fn frictional_lag_makes_a_loop_over_speed() {
        let mut contact = contact();
        let (mut rising, mut falling) = (Vec::new(), Vec::new());
        for step in 0..160_000 {
            let phase = std::f64::consts::TAU * 25.0 * f64::from(step) * STEP_S;
            let speed = 1.5e-3 + 1.2e-3 * phase.sin();
            let force = contact.force(speed);
            if step > 80_000 && (speed - 1.5e-3).abs() < 2e-5 {
                if phase.cos() > 0.0 { rising.push(force) } else { falling.push(force) }
            }
        }
        let mean = |forces: &[f64]| forces.iter().sum::<f64>() / forces.len() as f64;
        assert!(mean(&rising) > mean(&falling) + 0.01 * SPEC.coulomb, "{} {}", mean(&rising), mean(&falling));
    }

    #[test]
    fn it_stays_bounded_at_any_speed() {
        let mut contact = contact();
        for step in 0..100_000 {
            let speed = 2.0 * (f64::from(step) * 0.7).sin();
            let force = contact.force(speed);
            assert!(force.abs() < 1.31 * SPEC.coulomb, "{force} N at {speed} m/s");
        }
    }

    #[test]
    fn a_full_stroke_each_way_makes_a_hysteresis_of_twice_the_static_level() {
        let mut contact = contact();
        let forces = travel(40e-6, 1e-4, |speed| contact.force(speed));
        let (least, most) = forces.iter().fold((f64::MAX, f64::MIN), |(a, b), (_, f)| (a.min(*f), b.max(*f)));
        assert!(((most - least) / (2.0 * SPEC.level(1e-4)) - 1.0).abs() < 0.02, "{least} to {most} N");
    }
}
