//! Z to and fro before the whole identification.

#[cfg(test)]
mod tests {
    use crate::control::machine::Machine;
    use crate::control::port::Feedback;
    use crate::control::sync::frame::Scale;
    use crate::control::sync::identification::{Identification, restart::IDENTIFICATION_NUMBERS};
    use crate::control::sync::plant_model::Identified;

    /// Z to and fro at 40 mm/s against 250 N, the drive holding a weight; the motor leads by 3 µm.
    fn slides(held_n: f64, reports: impl Fn(&mut Feedback)) -> Identified {
        let machine = Machine::reference();
        let (mut identification, scale) = (Identification::new(&machine), Scale::of(&machine));
        let mut z_um = 0.0;
        for k in 0..2000 {
            let sign = if (k / 500) % 2 == 0 { -1.0 } else { 1.0 };
            z_um += 40.0 * sign;
            let z_counts = (10.0 * z_um) as i64;
            let mut feedback = Feedback {
                z_counts,
                z_motor_counts: Some(z_counts + (30.0 * sign) as i64),
                z_force_n: Some(250.0 * sign + held_n),
                ..Feedback::default()
            };
            reports(&mut feedback);
            identification.observe(&scale.measure(&feedback));
        }
        identification.identified()
    }

    #[test]
    fn every_number_that_outlives_a_restart_has_its_place() {
        let mut identification = Identification::new(&Machine::reference());
        assert_eq!(identification.kept().count(), IDENTIFICATION_NUMBERS);
    }

    #[test]
    fn friction_and_weight_are_measured() {
        let found = slides(150.0, |_| ()).z;
        assert!((found.friction_n - 250.0).abs() < 1.0 && (found.weight_n - 150.0).abs() < 1.0, "{found:?}");
    }

    #[test]
    fn lost_motion_is_measured() {
        let found = slides(0.0, |_| ()).z;
        assert!((found.lost_motion_mm - 0.006).abs() < 5e-4, "{found:?}");
        assert!(found.deflection_middle_mm.unwrap().abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn without_reports_the_file_stands() {
        let nominal = Identified::nominal(&Machine::reference());
        let no_force = slides(0.0, |feedback| feedback.z_force_n = None);
        let friction = |found: &Identified| (found.z.friction_n, found.z.weight_n, found.z.viscous_n_s_per_mm);
        assert_eq!((no_force.spindle, no_force.latency), (nominal.spindle, nominal.latency));
        assert_eq!(friction(&no_force), friction(&nominal));
        // Motor and scale show the lost motion without it.
        assert!((no_force.z.lost_motion_mm - 0.006).abs() < 5e-4, "{no_force:?}");
        let no_motor = slides(0.0, |feedback| feedback.z_motor_counts = None).z;
        assert_eq!((no_motor.deflection_middle_mm, no_motor.compliance_ratio), (None, 1.0));
    }
}
