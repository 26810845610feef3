//! Z's feedforward against formulas.

#[cfg(test)]
mod tests {
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::sync::feedforward::z::{ZExtra, ZFeedforward, ZRest};
    use crate::control::sync::feedforward::z_config::{ZConfig, ZDelays};
    use crate::control::sync::plant_model::{AxialForce, Cut, Identified, IdentifiedZ};

    const PERIOD_S: f64 = 0.001;
    const DELAYS: ZDelays = ZDelays { acting_s: -0.0002, read_s: -0.001, position_s: -0.0007 };
    const LOST_MM: f64 = 0.008;
    const ACCELERATION: f64 = 637.0;
    /// To 32 mm/s.
    const RAMP_S: f64 = 0.05;
    /// The reference machine's, sliding and before it does.
    const COULOMB_N: f64 = 300.0;
    const STATIC_N: f64 = 390.0;
    /// The work piece lies 0.5 mm below R; and nowhere.
    const CUT: Cut = Cut { surface_mm: 0.5, chamfer_mm: 1.0, out_ratio: 0.3 };
    const AIR: Cut = Cut { surface_mm: 1e3, ..CUT };

    fn config() -> ZConfig {
        ZConfig::new(&Machine::reference(), DELAYS)
    }

    fn begun_in(cut: Cut, known: IdentifiedZ, held_n: f64, flank: Option<f64>) -> ZFeedforward {
        let lead_mm = flank.map(|flank| 0.5 * known.lost_motion_mm * flank);
        let rest = ZRest { held_n, fed_n: 0.0, lead_mm, load_mm: 0.0, encoder_mm: 0.0 };
        ZFeedforward::new(config(), &known, &rest, cut)
    }

    fn begun_with(known: IdentifiedZ, held_n: f64, flank: Option<f64>) -> ZFeedforward {
        begun_in(AIR, known, held_n, flank)
    }

    fn nominal() -> IdentifiedZ {
        IdentifiedZ { lost_motion_mm: LOST_MM, ..Identified::nominal(&Machine::reference()).z }
    }

    fn begun(held_n: f64, flank: Option<f64>) -> ZFeedforward {
        begun_with(nominal(), held_n, flank)
    }

    /// Speeds up, cruises for as long, turns round as it sped up, and cruises back.
    fn load(t_s: f64) -> State {
        let parts = [(RAMP_S, ACCELERATION), (RAMP_S, 0.0), (2.0 * RAMP_S, -ACCELERATION), (f64::INFINITY, 0.0)];
        let mut state = State::default();
        let mut left_s = t_s.max(0.0);
        for (length_s, acceleration) in parts {
            let step_s = left_s.min(length_s);
            state = State {
                position: state.position + step_s * (state.velocity + 0.5 * step_s * acceleration),
                velocity: state.velocity + step_s * acceleration,
                acceleration: if t_s > 0.0 { acceleration } else { 0.0 },
                jerk: 0.0,
            };
            left_s -= step_s;
            if left_s <= 0.0 {
                break;
            }
        }
        state
    }

    /// Instants of [`load`] at which everything has settled.
    const SPEEDING: f64 = 0.045;
    const CRUISING: f64 = 0.09;
    const SLOWING: f64 = 0.145;
    const SPEEDING_BACK: f64 = 0.19;
    const CRUISING_BACK: f64 = 0.25;

    fn moved(z: &mut ZFeedforward, (from_s, to_s): (f64, f64)) -> Vec<ZExtra> {
        let periods = (from_s / PERIOD_S).round() as u32..(to_s / PERIOD_S).round() as u32;
        let ahead_s = config().look_ahead_s();
        periods.map(|k| f64::from(k) * PERIOD_S).map(|t_s| z.step(&load(t_s), &load(t_s + ahead_s))).collect()
    }

    /// 100 N that draw in and 40 N that draw out are what the drive gives less; the engaged screw carries less of it, too.
    #[test]
    fn a_tap_that_draws_is_given_less() {
        let axial = AxialForce { in_n: 100.0, out_n: 40.0 };
        let mut with = begun_in(CUT, IdentifiedZ { axial, ..nominal() }, 0.0, Some(0.0));
        let (with, without) = (moved(&mut with, (0.0, 0.3)), moved(&mut begun(0.0, Some(0.0)), (0.0, 0.3)));
        let less_n = |at_s: f64| {
            let k = (at_s / PERIOD_S) as usize;
            without[k].friction_n - with[k].friction_n
        };
        // Above the work piece, and with all of the tap in it.
        for (at_s, expected_n) in [(0.02, 0.0), (CRUISING, 100.0), (SPEEDING_BACK, -40.0)] {
            assert!((less_n(at_s) - expected_n).abs() < 1e-6, "{at_s}: {}", less_n(at_s));
        }
    }

    /// By how much the motor's lead over the table grows from each instant to the next.
    fn leads_mm<const N: usize>(z: &mut ZFeedforward, to_s: [f64; N]) -> [f64; N] {
        let mut from_s = 0.0;
        to_s.map(|to_s| {
            let extras = moved(z, (from_s, to_s));
            from_s = to_s;
            extras.iter().map(|extra| extra.motor_velocity_mm_per_s * PERIOD_S).sum()
        })
    }

    fn assert_leads<const N: usize>(z: &mut ZFeedforward, to_s: [f64; N], expected_mm: [f64; N]) {
        let found_mm = leads_mm(z, to_s);
        for (found, expected) in found_mm.iter().zip(expected_mm) {
            assert!((found - expected).abs() < 1e-5, "{found_mm:?} {expected_mm:?}");
        }
    }

    #[test]
    fn motor_crosses_all_of_the_lost_motion() {
        for (flank, first_mm) in [(1.0, 0.0), (0.0, 0.5 * LOST_MM), (-0.5, 0.75 * LOST_MM), (-1.0, LOST_MM)] {
            assert_leads(&mut begun(0.0, Some(flank)), [CRUISING, CRUISING_BACK], [first_mm, -LOST_MM]);
        }
    }

    #[test]
    fn screw_winds_up_while_the_load_speeds_up() {
        let mut z = begun(COULOMB_N, Some(1.0));
        // ω² of 100 Hz.
        let wind_up_mm = ACCELERATION / 394_784.176_043_574_3;
        assert_leads(&mut z, [SPEEDING, CRUISING], [wind_up_mm, -wind_up_mm]);
        let soft = IdentifiedZ { compliance_ratio: 1.5, ..nominal() };
        assert_leads(&mut begun_with(soft, COULOMB_N, Some(1.0)), [SPEEDING], [1.5 * wind_up_mm]);
    }

    /// The load's friction, 50 N, slows 200 kg less than 637 mm/s² do: it runs against the motor before it turns round.
    #[test]
    fn backlash_is_crossed_where_the_screws_force_turns_round() {
        let light = IdentifiedZ { friction_n: 100.0, ..nominal() };
        let mut z = begun_with(light, 0.0, Some(1.0));
        let wind_up_mm = ACCELERATION / 394_784.176_043_574_3;
        let friction_mm = 50.0 / 78_956.835_208_714_86;
        let backlash_mm = LOST_MM - 2.0 * friction_mm;
        let expected_mm = [0.0, -backlash_mm - wind_up_mm, -2.0 * friction_mm];
        assert_leads(&mut z, [CRUISING, SLOWING, SPEEDING_BACK], expected_mm);
    }

    #[test]
    fn motor_does_not_wander_through_the_backlash_without_force() {
        let free = IdentifiedZ { friction_n: 0.0, lost_motion_mm: 0.005, ..nominal() };
        let mut z = begun_with(free, 0.0, Some(1.0));
        let [speeding_mm, cruising_mm] = leads_mm(&mut z, [SPEEDING, CRUISING]);
        assert!((speeding_mm + cruising_mm).abs() < 1e-9 && z.backlash.flank() == 1.0);
    }

    #[test]
    fn crossing_starts_and_ends_without_speed() {
        let extras = moved(&mut begun(0.0, Some(-1.0)), (0.0, CRUISING_BACK));
        let greatest =
            |extras: &[ZExtra]| extras.iter().map(|extra| extra.motor_velocity_mm_per_s.abs()).fold(0.0, f64::max);
        assert!(greatest(&extras[..1]) < 0.05 * greatest(&extras), "{:?}", extras[0]);
        let last = extras[extras.len() - 1];
        assert!(last.motor_velocity_mm_per_s.abs() < 1e-9 && last.acceleration_mm_per_s2.abs() < 1e-6, "{last:?}");
    }

    fn last_n(extras: &[ZExtra]) -> f64 {
        extras[extras.len() - 1].friction_n
    }

    #[test]
    fn friction_counts_from_what_holds_z_already() {
        for held_n in [0.0, 100.0, -200.0] {
            let mut z = begun(held_n, None);
            let first_n = z.step(&State::default(), &State::default()).friction_n;
            assert!(first_n.abs() < 1e-9, "{held_n}: {first_n}");
            let (inwards_n, outwards_n) =
                (last_n(&moved(&mut z, (0.0, CRUISING))), last_n(&moved(&mut z, (CRUISING, CRUISING_BACK))));
            assert!((inwards_n - (COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {inwards_n}");
            assert!((outwards_n - (-COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {outwards_n}");
        }
    }

    #[test]
    fn a_force_that_is_fed_forward_goes_on() {
        let mut z = ZFeedforward::new(
            config(),
            &nominal(),
            &ZRest { held_n: 200.0, fed_n: 150.0, lead_mm: None, load_mm: 0.0, encoder_mm: 0.0 },
            AIR,
        );
        let first_n = z.step(&State::default(), &State::default()).friction_n;
        assert!((first_n - 150.0).abs() < 1e-9, "{first_n}");
    }

    #[test]
    fn more_than_friction_is_handed_over_up_to_a_limit() {
        for (held_n, taken_n) in [(600.0, 600.0), (5000.0, 2.5 * STATIC_N), (-5000.0, -2.5 * STATIC_N)] {
            let first = begun(held_n, None).step(&State::default(), &State::default());
            assert!((first.friction_n - (STATIC_N.copysign(held_n) - taken_n)).abs() < 1e-9, "{held_n}: {first:?}");
        }
    }

    /// The drive's integral holds what differs on the way in; the way out differs by as much again.
    #[test]
    fn measured_friction_counts_at_the_reversal() {
        let (mut z, measured_n) = (begun(0.0, Some(1.0)), 1.2 * COULOMB_N);
        let before_n = last_n(&moved(&mut z, (0.0, CRUISING)));
        (0..500).for_each(|_| z.observe_force(measured_n, &load(CRUISING)));
        let after_n = z.step(&load(CRUISING), &load(CRUISING)).friction_n;
        assert!((after_n - before_n).abs() < 1e-6, "{before_n} {after_n}");
        let back_n = last_n(&moved(&mut z, (CRUISING, CRUISING_BACK)));
        assert!((back_n - (before_n - 2.0 * measured_n)).abs() < 1e-6, "{back_n}");
    }

    /// As far as the work piece is cut, what friction changes by along the way is friction, and what is beyond draws the tap in.
    #[test]
    fn much_less_friction_in_the_cut_is_a_tap_that_draws() {
        for (less_n, seen_n) in [(30.0, 0.0), (200.0, 200.0), (-200.0, -200.0)] {
            let mut z = begun_in(CUT, nominal(), 0.0, Some(1.0));
            let before_n = last_n(&moved(&mut z, (0.0, CRUISING)));
            (0..500).for_each(|_| z.observe_force(COULOMB_N - less_n, &load(CRUISING)));
            assert!((z.friction_n - (COULOMB_N - less_n + seen_n)).abs() < 0.1, "{less_n}: {}", z.friction_n);
            // The way out differs by twice the friction, and by what the tap draws in and, less, out.
            let back_n = last_n(&moved(&mut z, (CRUISING, SPEEDING_BACK)));
            let expected_n = before_n - 2.0 * z.friction_n + (1.0 + CUT.out_ratio) * seen_n;
            assert!((back_n - expected_n).abs() < 0.5, "{less_n}: {back_n} {expected_n}");
        }
    }

    #[test]
    fn friction_is_measured_in_sliding_alone_and_without_inertia() {
        let mut z = begun(0.0, Some(1.0));
        let state = z.clone();
        z.observe_force(900.0, &State { velocity: 7.9, ..State::default() });
        assert_eq!(z, state);
        // 600 kg.
        let slowing = State { velocity: -50.0, acceleration: 500.0, ..State::default() };
        (0..500).for_each(|_| z.observe_force(300.0 - COULOMB_N, &slowing));
        assert!((z.friction_n - COULOMB_N).abs() < 1e-9, "{}", z.friction_n);
    }

    #[test]
    fn held_force_says_on_which_flank_the_motor_stands() {
        let flank = |held_n, flank| begun(held_n, flank).backlash.flank();
        assert_eq!((flank(300.0, None), flank(-300.0, None), flank(0.0, None)), (1.0, -1.0, 0.0));
        assert_eq!(flank(300.0, Some(-1.0)), -1.0, "what was measured says it better");
    }
}
