use super::*;
use crate::control::machine::{MachineSpec, ZEncoderAt};
use crate::run::RunSettings;
use crate::sim::{Actual, Plant, PlantOptions};

/// What a machine shows that differs from the reference machine, which is all that the control knows; and its own data.
fn found(change: impl FnOnce(&mut MachineSpec), actual: Actual, seed: u64) -> (Findings, Machine) {
    let known = Machine::reference();
    let real = known.with(change).unwrap().with(|spec| spec.tap.kc_n_per_mm2 = 0.0).unwrap();
    let options =
        PlantOptions { actual, seed, z_start_mm: RunSettings::default().start_mm[2], ..PlantOptions::default() };
    let feedback = run_dry_cycle(&known, &mut Plant::new(&real, &options)).unwrap();
    (identify(&feedback, &known), real)
}

/// Off by, relative.
fn off(found: Option<f64>, truth: f64) -> f64 {
    (found.expect("shown") / truth - 1.0).abs()
}

#[test]
fn machines_that_differ_from_their_file_are_found_as_they_are() {
    let mut seed = 0;
    for friction in [0.5, 1.0, 2.0] {
        for backlash_um in [0.0, 2.0, 5.0] {
            for (inertia, z_resonance) in [(0.8, 1.2), (1.2, 0.8)] {
                seed += 1;
                let actual = Actual {
                    friction,
                    backlash_um: Some(backlash_um),
                    inertia,
                    z_resonance,
                    encoder_error: 2.0,
                    ..Actual::default()
                };
                let (found, real) = found(|_| (), actual, seed);
                let z = &real.spec().z_axis;
                let screw = TwoMass::of_z(z).stiffness * z_resonance * z_resonance;
                let friction_n = z.coulomb_n * friction;
                let twist_um = um_from_mm(mm_from_m(2.0 * friction_n * z.friction_table_share / screw));
                let lost_off_um = (found.lost_motion_um.unwrap() - backlash_um - twist_um).abs();
                assert!(off(found.friction_n, friction_n) < 0.015, "{actual:?} {found:?}");
                assert!(off(found.static_ratio, z.static_ratio) < 0.01, "{actual:?} {found:?}");
                assert!(off(found.stribeck_mm_per_s, z.stribeck_mm_per_s) < 0.03, "{actual:?} {found:?}");
                assert!(off(found.presliding_um, z.presliding_um) < 0.05, "{actual:?} {found:?}");
                assert!(lost_off_um < 0.3, "{lost_off_um} of {actual:?} {found:?}");
                assert!(off(found.resonance_hz, z.resonance_hz * z_resonance) < 0.01, "{actual:?} {found:?}");
                assert!((found.backlash_um.unwrap() - backlash_um).abs() < 0.3, "{actual:?} {found:?}");
                assert!(off(found.inertia_ratio, inertia) < 0.01, "{actual:?} {found:?}");
            }
        }
    }
}

#[test]
fn friction_of_another_kind_than_the_files_is_found() {
    for (ratio, speed, presliding) in
        [(1.15, 1.0, 2.5), (1.6, 4.0, 10.0), (2.0, 1.0, 10.0), (1.3, 5.0, 2.5), (1.3, 0.7, 20.0), (1.1, 2.0, 5.0)]
    {
        let change = |spec: &mut MachineSpec| {
            let z = &mut spec.z_axis;
            (z.static_ratio, z.stribeck_mm_per_s, z.presliding_um) = (ratio, speed, presliding);
        };
        let (found, real) = found(change, Actual::default(), 7);
        assert!(off(found.friction_n, real.spec().z_axis.coulomb_n) < 0.015, "{found:?}");
        assert!(off(found.static_ratio, ratio) < 0.01, "{ratio} {speed} {presliding}: {found:?}");
        assert!(off(found.stribeck_mm_per_s, speed) < 0.03, "{ratio} {speed} {presliding}: {found:?}");
        assert!(off(found.presliding_um, presliding) < 0.05, "{ratio} {speed} {presliding}: {found:?}");
    }
}

#[test]
fn no_stribeck_effect_has_no_speed() {
    let (found, _) = found(|spec| spec.z_axis.static_ratio = 1.0, Actual::default(), 1);
    assert!(off(found.static_ratio, 1.0) < 0.01 && found.stribeck_mm_per_s.is_none(), "{found:?}");
}

#[test]
fn an_encoder_at_the_motor_alone_shows_no_lost_motion() {
    let known = Machine::reference().with(|spec| spec.z_axis.encoder_at = ZEncoderAt::Motor).unwrap();
    let z_start_mm = RunSettings::default().start_mm[2];
    let mut plant = Plant::new(&known, &PlantOptions { z_start_mm, ..PlantOptions::default() });
    let found = identify(&run_dry_cycle(&known, &mut plant).unwrap(), &known);
    assert!(off(found.friction_n, 300.0) < 0.015, "{found:?}");
    assert_eq!((found.lost_motion_um, found.backlash_um, found.presliding_um), (None, None, None));
}

#[test]
fn what_does_not_move_shows_nothing() {
    assert_eq!(identify(&[], &Machine::reference()), Findings::default());
    assert_eq!(identify(&[Feedback::default(); 1000], &Machine::reference()), Findings::default());
}

/// Strokes at 40 mm/s alone, between 0 and 32 mm, against a friction of 300 N and a lost motion of 5 µm.
fn fast_strokes(z_motor: bool, force: bool) -> Vec<Feedback> {
    let mut feedback = Vec::new();
    let mut place_um = 0.0;
    for stroke in 0..6 {
        let sign = if stroke % 2 == 0 { 1.0 } else { -1.0 };
        for _ in 0..800 {
            place_um += sign * 40.0;
            let z_counts = (place_um * 10.0) as i64;
            feedback.push(Feedback {
                z_counts,
                z_motor_counts: z_motor.then_some(z_counts + (sign * 25.0) as i64),
                z_force_n: force.then_some(sign * 300.0),
                ..Feedback::default()
            });
        }
    }
    feedback
}

#[test]
fn what_is_not_shown_is_left_out() {
    let machine = Machine::reference();
    let found = identify(&fast_strokes(true, true), &machine);
    assert!(off(found.friction_n, 300.0) < 0.01 && off(found.lost_motion_um, 5.0) < 0.02, "{found:?}");
    assert_eq!((found.static_ratio, found.stribeck_mm_per_s, found.presliding_um), (None, None, None));
    assert_eq!((found.inertia_ratio, found.torque_limit_ratio, found.spindle_drag_nm), (None, None, None));
    let one_encoder = identify(&fast_strokes(false, true), &machine);
    assert!(one_encoder.friction_n.is_some() && one_encoder.lost_motion_um.is_none(), "{one_encoder:?}");
    // Two encoders say what lies between them without a force; how much of it is backlash, friction would have to say.
    let no_force = identify(&fast_strokes(true, false), &machine);
    assert!(off(no_force.lost_motion_um, 5.0) < 0.02, "{no_force:?}");
    let left_out = Findings { lost_motion_um: None, resonance_hz: None, ..no_force };
    assert_eq!(left_out, Findings::default());
    assert_eq!(identify(&fast_strokes(false, false), &machine), Findings::default());
}
