//! From hole to hole: nothing jumps where a hole ends or the next begins, and nothing adds up.

use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::{Feedback, Port, Setpoint};
use rigidtap::gcode::{Dialect, Options, interpret};
use rigidtap::run::{Listener, ProgramSettings, Row, RowStage, run_program};
use rigidtap::sim::{Plant, PlantOptions};

/// Twelve holes of 12 mm, Z going up to Z20 after each and coming down to R.
const FROM_ABOVE: &[u8] =
    b"G90 M03 S3000 G0 Z20\nG98 G81 X0 Y0 R2 Z-10 F3000 \nX5\nX10\nX15\nX20\nX25\nX30\nX35\nX40\nX45\nX50\nX55\nG80\nM30";
/// The same with Z staying at R.
const AT_R: &[u8] =
    b"G90 M03 S3000 G0 Z2\nG81 X0 Y0 R2 Z-10 F3000 \nX5\nX10\nX15\nX20\nX25\nX30\nX35\nX40\nX45\nX50\nX55\nG80\nM30";

#[derive(Default)]
struct Rows(Vec<Row>);

impl Listener for Rows {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        self.0.push(*row);
    }
}

fn rows<P: Port>(program: &[u8], port: impl FnOnce(Plant) -> P) -> Vec<Row> {
    let machine = Machine::reference();
    let settings = ProgramSettings { law: Law::TorqueCurveSmooth, ..ProgramSettings::default() };
    let options = PlantOptions { z_start_mm: settings.run.start_mm[2], ..PlantOptions::default() };
    let mut port = port(Plant::new(&machine, &options));
    let program = interpret(program, &Dialect::PAPER, Options::default());
    assert!(!program.diagnostics.has_errors());
    let mut rows = Rows::default();
    let outcome = run_program(&program.commands, &machine, &settings, &mut port, &mut rows).unwrap();
    assert!(outcome.fault.is_none() && outcome.holes.len() == 12);
    rows.0
}

/// A drive that tells neither force nor torque nor where its motor is.
struct Silent(Plant);

impl Port for Silent {
    fn read(&mut self, now_s: f64) -> Feedback {
        let Feedback { spindle_counts, z_counts, spindle, .. } = self.0.read(now_s);
        Feedback { spindle_counts, z_counts, spindle, ..Feedback::default() }
    }

    fn write(&mut self, now_s: f64, setpoint: &Setpoint) {
        self.0.write(now_s, setpoint);
    }
}

/// Friction turns round twice a hole, once in it and once on the way to the next, and only the first is fed forward.
#[test]
fn force_does_not_add_up_from_hole_to_hole() {
    for rows in [rows(FROM_ABOVE, |plant| plant), rows(FROM_ABOVE, Silent)] {
        let greatest_n = |hole: u32| {
            let forces = rows.iter().filter(|row| row.hole == hole).map(|row| row.setpoint.z_force_n.abs());
            forces.fold(0.0, f64::max)
        };
        for hole in 1..=12 {
            assert!(greatest_n(hole) < 1100.0, "hole {hole}: {} N", greatest_n(hole));
        }
    }
}

/// Dropping what a hole ends with threw Z by 5 µm.
#[test]
fn z_rests_where_a_hole_ends() {
    let rows = rows(AT_R, |plant| plant);
    let mut resting = 0;
    for (before, after) in rows.iter().zip(rows.iter().skip(1)) {
        if before.hole > 0 && before.hole < 12 && before.stage != RowStage::Orient && after.stage == RowStage::Rapid {
            let end = rows.iter().skip(after.k as usize).take(60);
            let off_um = end.map(|row| 1000.0 * (row.truth.unwrap().z_mm - 2.0).abs()).fold(0.0, f64::max);
            assert!(off_um < 2.0, "hole {}: {off_um} µm", before.hole);
            resting += 1;
        }
    }
    assert_eq!(resting, 11);
}

/// e(k) of a drive that says nothing is no worse than that of the plan alone, since nothing is what it is taken for.
#[test]
fn a_silent_drive_is_held_by_what_its_file_says() {
    let rows = rows(AT_R, Silent);
    for hole in 1..=12 {
        let errors = || rows.iter().filter(|row| row.hole == hole).filter_map(|row| row.error_um);
        let swing_um = errors().fold(f64::MIN, f64::max) - errors().fold(f64::MAX, f64::min);
        assert!(swing_um < 12.0, "hole {hole}: {swing_um} µm");
    }
}
