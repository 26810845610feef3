//! The generalised Maxwell slip model: Al-Bender, Lampaert and Swevers, "The generalized Maxwell-slip model: a novel
//! model for friction simulation and compensation", IEEE Trans. Automatic Control 50 (2005) 1883–1887.

use super::contact_spec::ContactSpec;

/// Elements in parallel.
const ELEMENTS: usize = 6;
/// Time in which a slipping element comes to its level: C of the paper is Fc over it. Frictional lag of lubricated
/// contacts is milliseconds (Armstrong-Hélouvry, Dupont and Canudas de Wit 1994).
const ATTRACTION_S: f64 = 0.002;
/// Deflections at which the elements begin to slip, in pre-sliding travels: the last one at three, where the
/// exponential of the other laws has 95 % of its level.
const YIELD: [f64; ELEMENTS] = [0.125, 0.375, 0.75, 1.25, 2.0, 3.0];

/// The contact with the force of each element, which sticks (Ḟ = k·v) until |F| = α·g(v), and then slips
/// (Ḟ = C·(α − F/g)·sgn v) until the speed turns. As everywhere here, forces are over Fc's share and the level applies
/// to their sum.
#[derive(Clone, Debug)]
pub(crate) struct Gms {
    spec: ContactSpec,
    step_s: f64,
    /// Shares α of the level; they sum to 1.
    share: [f64; ELEMENTS],
    /// Stiffness k of each element.
    stiffness: [f64; ELEMENTS],
    force: [f64; ELEMENTS],
    slips: [bool; ELEMENTS],
    /// Share of the way to its level that a slipping element goes in a step, over what is left of it, at Coulomb's level.
    pull: f64,
    forward: bool,
}

/// The same at any level.
fn pull(spec: &ContactSpec, step_s: f64, level: f64) -> f64 {
    step_s * spec.coulomb / (ATTRACTION_S * level.abs())
}

impl Gms {
    pub(super) fn new(spec: ContactSpec, step_s: f64) -> Self {
        // The virgin curve goes through 1 − exp(−y) at each yield y; its slopes' differences are the elements'.
        let curve = |y: f64| 1.0 - (-y).exp();
        let slope = |index: usize| {
            let (from, to) = (if index == 0 { 0.0 } else { YIELD[index - 1] }, YIELD[index]);
            (curve(to) - curve(from)) / (to - from)
        };
        let next = |index: usize| if index + 1 < ELEMENTS { slope(index + 1) } else { 0.0 };
        let share: [f64; ELEMENTS] = std::array::from_fn(|index| (slope(index) - next(index)) * YIELD[index]);
        let total: f64 = share.iter().sum();
        let share = share.map(|share| share / total);
        let most = spec.static_ratio * spec.coulomb;
        let stiffness = std::array::from_fn(|index| share[index] * most / (YIELD[index] * spec.presliding));
        Self {
            pull: pull(&spec, step_s, spec.coulomb),
            spec,
            step_s,
            share,
            stiffness,
            force: [0.0; ELEMENTS],
            slips: [false; ELEMENTS],
            forward: true,
        }
    }

    // Kept out of the plant step, whose standard law would lose its registers to it.
    #[inline(never)]
    pub(super) fn force(&mut self, speed: f64) -> f64 {
        let level = self.spec.level(speed);
        let forward = speed >= 0.0;
        if forward != self.forward {
            self.forward = forward;
            self.slips = [false; ELEMENTS];
        }
        // At speed the level is Coulomb's.
        let pull = if level == self.spec.coulomb { self.pull } else { pull(&self.spec, self.step_s, level) };
        let level = if forward { level } else { -level };
        // Implicit, so that an element never passes its level on the way to it.
        if self.slips == [true; ELEMENTS] {
            // The same as below for all of them, which the processor does two at once.
            let slack = 1.0 + pull;
            for (force, share) in self.force.iter_mut().zip(&self.share) {
                *force = (*force + pull * (share * level)) / slack;
            }
            return self.force.iter().fold(0.0, |sum, force| sum + force);
        }
        let travel = speed * self.step_s;
        let mut sum = 0.0;
        for index in 0..ELEMENTS {
            let limit = self.share[index] * level;
            let force = &mut self.force[index];
            if self.slips[index] {
                *force = (*force + pull * limit) / (1.0 + pull);
            } else {
                *force += self.stiffness[index] * travel;
                if force.abs() >= limit.abs() && *force * limit > 0.0 {
                    *force = limit;
                    self.slips[index] = true;
                }
            }
            sum += *force;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{SPEC, STEP_S, travel};
    use super::*;

    fn contact() -> Gms {
        Gms::new(SPEC, STEP_S)
    }

    /// Slow motion along a list of turning points; the force at each of them.
    fn along(contact: &mut Gms, points: &[f64]) -> Vec<f64> {
        let (mut x, speed, mut forces) = (0.0, 1e-4, Vec::new());
        for point in points {
            let mut force = 0.0;
            let steps = ((point - x) / (speed * STEP_S)).round() as i64;
            for _ in 0..steps.abs() {
                force = contact.force(speed.copysign(*point - x));
            }
            x = *point;
            forces.push(force);
        }
        forces
    }

    /// Non-local memory, the paper's reason for the model: an inner loop that closes comes back to the force that it
    /// left, and the outer one goes on as if nothing had been. LuGre does not do this.
    #[test]
    fn an_inner_loop_closes_and_is_forgotten() {
        let with = along(&mut contact(), &[8e-6, -4e-6, 2e-6, -1e-6, 2e-6, 6e-6]);
        let without = along(&mut contact(), &[8e-6, -4e-6, 2e-6, 6e-6]);
        assert!((with[2] - with[4]).abs() < 0.01 * SPEC.coulomb, "{} and {} N", with[2], with[4]);
        assert!((with[5] - without[3]).abs() < 0.01 * SPEC.coulomb, "{} and {} N", with[5], without[3]);
    }

    /// Masing's rule for elements in parallel: after a reversal the curve is the virgin one, twice as large.
    #[test]
    fn the_branches_after_a_reversal_are_twice_the_virgin_curve() {
        for amplitude in [1e-6, 3e-6, 6e-6] {
            let virgin = along(&mut contact(), &[amplitude])[0];
            let back = along(&mut contact(), &[amplitude, -amplitude]);
            assert!(((back[0] - back[1]) / (2.0 * virgin) - 1.0).abs() < 0.01, "{back:?} after {virgin} N");
        }
    }

    #[test]
    fn the_virgin_curve_has_its_points_on_the_exponential() {
        let total = 1.0 - (-3.0_f64).exp();
        for yielded in YIELD {
            let force = along(&mut contact(), &[yielded * SPEC.presliding])[0];
            let expected = SPEC.level(1e-4) * (1.0 - (-yielded).exp()) / total;
            assert!((force / expected - 1.0).abs() < 0.02, "{force} for {expected} N at {yielded}");
        }
    }

    /// Steady sliding is Stribeck's curve; after a step of speed the force comes to it within the attraction's time.
    #[test]
    fn sliding_comes_to_the_level() {
        for speed in [1e-3, 5e-3, 0.1, -0.1] {
            let mut contact = contact();
            let force = (0..20_000).map(|_| contact.force(speed)).last().unwrap();
            assert!((force - SPEC.level(speed).copysign(speed)).abs() < 1e-6 * SPEC.coulomb, "{force} at {speed} m/s");
        }
        let mut contact = contact();
        (0..20_000).for_each(|_| _ = contact.force(1e-3));
        let steps = (ATTRACTION_S / STEP_S) as u32;
        let force = (0..steps).map(|_| contact.force(0.1)).last().unwrap();
        let (from, to) = (SPEC.level(1e-3), SPEC.level(0.1));
        assert!(((force - to) / (from - to) - (-1.0_f64).exp()).abs() < 0.02, "{force} from {from} to {to} N");
    }

    #[test]
    fn a_full_stroke_each_way_makes_a_hysteresis_of_twice_the_level() {
        let mut contact = contact();
        let forces = travel(40e-6, 1e-4, |speed| contact.force(speed));
        let (least, most) = forces.iter().fold((f64::MAX, f64::MIN), |(a, b), (_, f)| (a.min(*f), b.max(*f)));
        assert!(((most - least) / (2.0 * SPEC.level(1e-4)) - 1.0).abs() < 0.02, "{least} to {most} N");
    }
}
