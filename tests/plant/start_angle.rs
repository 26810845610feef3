//! The same thread again: with a start angle a hole has one helix, whatever its speed, depth and law.

use rigidtap::control::machine::{Law, Machine};
use rigidtap::gcode::{Dialect, Options, interpret};
use rigidtap::run::{Listener, ProgramSettings, Row, RowStage, run_program};
use rigidtap::sim::{Plant, PlantOptions};

const PITCH_MM: f64 = 1.0;
const START_ANGLE_DEG: f64 = 30.0;
/// Below it the tap is in the thread: the work piece begins 2 mm under R.
const SURFACE_MM: f64 = -2.0;
/// Depths of the helix that are compared, one each tenth of a millimetre.
const PLACES: usize = 200;

/// Where the thread is by the true tool: µm beside the helix through the start angle at R, least and greatest at each place on
/// the way in and out.
type Helix = [Option<[f64; 2]>; PLACES];

struct Recorder(Helix);

impl Listener for Recorder {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        let (RowStage::Stroke(_), Some(truth)) = (row.stage, row.truth) else { return };
        if truth.z_mm > SURFACE_MM {
            return;
        }
        let place = ((SURFACE_MM - truth.z_mm) * 10.0) as usize;
        let turns = -truth.z_mm / PITCH_MM - (truth.spindle_rev - START_ANGLE_DEG / 360.0);
        let beside_um = 1000.0 * PITCH_MM * (turns - turns.round());
        if let Some(slot) = self.0.get_mut(place) {
            let [low_um, high_um] = slot.unwrap_or([beside_um; 2]);
            *slot = Some([low_um.min(beside_um), high_um.max(beside_um)]);
        }
    }
}

/// Taps one hole of a program on a fresh machine: a tap that is set up again.
fn helix(start_angle_deg: Option<f64>, law: Law, speed_rpm: u32, bottom_mm: f64) -> Helix {
    let dialect = Dialect { start_angle_deg, ..Dialect::FANUC };
    let text = format!("G21 G90 G95\nM29 S{speed_rpm}\nG84 X7. Y0 Z{bottom_mm:.1} R0 F1.0\nG80\nM30\n");
    // The run-up before it leaves the spindle wherever it comes to rest.
    let text = format!("M03 S{}\nG04 P{}\n{text}", speed_rpm / 2, speed_rpm / 7);
    let read = interpret(text.as_bytes(), &dialect, Options::default());
    assert!(!read.diagnostics.has_errors(), "{:?}", read.diagnostics);
    let machine = Machine::reference();
    let settings = ProgramSettings { law, ..ProgramSettings::default() };
    let [_, _, z_start_mm] = settings.run.start_mm;
    let mut plant = Plant::new(&machine, &PlantOptions { z_start_mm, ..PlantOptions::default() });
    let mut recorder = Recorder([None; PLACES]);
    let outcome = run_program(&read.commands, &machine, &settings, &mut plant, &mut recorder).expect("feasible");
    assert_eq!((outcome.holes.len(), outcome.fault), (1, None));
    recorder.0
}

/// Greatest distance in µm of helices at the same depth, and at how many depths they were compared.
fn apart_um(helices: &[Helix]) -> (f64, usize) {
    let (mut greatest_um, mut compared) = (0.0_f64, 0);
    for place in 0..PLACES {
        let here: Vec<_> = helices.iter().filter_map(|helix| helix[place]).collect();
        let low_um = here.iter().map(|[low_um, _]| *low_um).fold(f64::INFINITY, f64::min);
        let high_um = here.iter().map(|[_, high_um]| *high_um).fold(f64::NEG_INFINITY, f64::max);
        compared += usize::from(here.len() > 1);
        greatest_um = greatest_um.max(high_um - low_um);
    }
    (greatest_um, compared)
}

/// Greatest distance in µm from the helix that the angle asks for.
fn off_um(helices: &[Helix]) -> f64 {
    helices.iter().flatten().flatten().flatten().map(|beside_um| beside_um.abs()).fold(0.0, f64::max)
}

#[test]
fn the_same_hole_has_the_same_helix_at_every_speed() {
    let helices = [1000, 3000, 7000].map(|rpm| helix(Some(START_ANGLE_DEG), Law::TorqueCurve, rpm, -20.0));
    let (apart_um, compared) = apart_um(&helices);
    assert!(apart_um < 5.0 && compared > 150, "{apart_um:.2} µm at {compared} depths");
    assert!(off_um(&helices) < 5.0, "{:.2} µm", off_um(&helices));
}

#[test]
fn depth_and_law_do_not_matter_either() {
    let helices = [
        helix(Some(START_ANGLE_DEG), Law::TorqueCurve, 3000, -20.0),
        helix(Some(START_ANGLE_DEG), Law::SCurve, 3000, -12.5),
        helix(Some(START_ANGLE_DEG), Law::TorqueCurveSmooth, 5000, -17.3),
    ];
    let (apart_um, compared) = apart_um(&helices);
    assert!(apart_um < 5.0 && compared > 150, "{apart_um:.2} µm at {compared} depths");
    assert!(off_um(&helices) < 5.0, "{:.2} µm", off_um(&helices));
}

/// What the angle is for: without one each hole begins where the spindle happens to rest.
#[test]
fn without_a_start_angle_the_helices_differ() {
    let helices = [1000, 3000, 7000].map(|rpm| helix(None, Law::TorqueCurve, rpm, -20.0));
    let (apart_um, _) = apart_um(&helices);
    assert!(apart_um > 50.0, "{apart_um:.2} µm");
}
