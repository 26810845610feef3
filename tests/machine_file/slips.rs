//! Slips that people make in a machine file: each is warned of, or refused, with what was probably meant.

use rigidtap::config::MachineFile;
use rigidtap::gcode::Severity::{self, Error, Warning};

/// What is written, whether it is refused, and what the message says of what was meant.
#[rustfmt::skip]
const SLIPS: &[(&str, Severity, &str)] = &[
    ("[spindle]\ninertia_kg_m2 = 40", Warning, "40 kg·cm² would be 0.004 kg·m²"),
    ("[spindle]\ninertia_kg_m2 = 0.4", Warning, "look at the decimal point"),
    ("[spindle]\ntool_inertia_kg_m2 = 0.005", Error, "30 % of it, as the reference machine has, would be 0.0012"),
    ("[spindle]\ntorque_curve = [[0, 2000], [3000, 2000], [8000, 750]]", Warning, "2000 N·cm would be 20 N·m"),
    ("[spindle]\ntorque_curve = [[0, 20], [314, 20], [838, 7.5]]", Error, "838 rad/s are 8002 rpm"),
    ("[spindle]\ntorque_curve = [[0, 20], [50, 20], [133.3, 7.5]]", Error, "133.3 rev/s are 7998 rpm"),
    ("[spindle]\nmax_rpm = 838\ntorque_curve = [[0, 20], [314, 20], [838, 7.5]]", Warning, "838 rad/s would be 8002 rpm"),
    ("[spindle]\ntorque_curve = [[0, 6.3], [3000, 6.3], [8000, 6.3]]", Warning, "6.3 kW at 8000 rpm are 7.52 N·m"),
    ("[spindle]\ntorque_curve = [[0, 3], [1500, 3], [3000, 6.3], [8000, 6.3]]", Warning, "6.3 kW at 8000 rpm are 7.52 N·m"),
    ("[spindle]\nplate_kw = 3.7\ntorque_curve = [[0, 20], [3000, 20], [8000, 7.5]]", Warning, "the torque of some seconds"),
    ("[spindle]\nresonance_hz = 2513", Warning, "2513 rad/s would be 400 Hz"),
    ("[spindle]\ndamping_ratio = 3", Error, "3 % would be 0.03"),
    ("[spindle]\ntorque_lag_s = 0.65", Error, "0.65 ms would be 0.00065 s"),
    ("[spindle]\nmax_rpm = 133", Warning, "133 rev/s would be 7980 rpm"),
    ("[spindle]\nencoder_counts_per_rev = 4096", Warning, "4096 lines would be 16384 counts"),
    ("[spindle]\nencoder_counts_per_rev = 4096\nencoder_lines_per_rev = 2500", Warning, "four counts a line would be 10000"),
    ("[spindle]\nencoder_counts_per_rev = 1024.5", Warning, "is no whole number"),
    ("[spindle]\nencoder_counts_per_rev = 16834", Warning, "encoders have a power of two, or a multiple of ten"),
    ("[spindle]\nviscous_nm_per_rpm = 0.000358", Warning, "0.000358 N·m·s/rad would be 0.00003749 N·m/rpm"),
    ("[spindle]\ncoulomb_nm = 30", Warning, "30 N·cm would be 0.3 N·m"),
    ("[z]\nmass_kg = 60000", Warning, "60000 g would be 60 kg"),
    ("[z]\nmass_kg = 600000", Warning, "600000 g would be 600 kg"),
    ("[z]\nmass_kg = 6", Warning, "this force moves 43.58 to 852.9 kg so fast"),
    ("[z]\nforce_limit_n = 8.8", Warning, "8.8 kN would be 8800 N"),
    ("[z]\ncoulomb_n = 0.3", Warning, "0.3 kN would be 300 N"),
    ("[z]\nresonance_hz = 628", Warning, "628 rad/s would be 99.95 Hz"),
    ("[z]\nbacklash_um = 0.002", Warning, "0.002 mm would be 2 µm"),
    ("[z]\npresliding_um = 0.005", Error, "0.005 mm would be 5 µm"),
    ("[z]\nmax_mm_per_s = 30", Warning, "30 m/min would be 500 mm/s"),
    ("[z]\nmax_mm_per_s = 30000", Warning, "30000 mm/min would be 500 mm/s"),
    ("[z]\nmax_mm_per_s2 = 10", Warning, "10 m/s² would be 10000 mm/s²"),
    ("[z]\nmax_mm_per_s2 = 1", Warning, "1 g would be 9807 mm/s²"),
    ("[z]\nmax_mm_per_s3 = 500", Warning, "500 m/s³ would be 500000 mm/s³"),
    ("[z]\nencoder_counts_per_mm = 0.1", Error, "0.1 µm a count would be 10000 counts/mm"),
    ("[drive]\nz_position_gain_per_s = 2.4", Warning, "2.4 m/min/mm would be 40 1/s"),
    ("[drive]\nspindle_position_gain_per_s = 2.4", Warning, "2.4 m/min/mm would be 40 1/s"),
    ("[drive]\nz_velocity_gain_per_s = 5000", Warning, "that loop rings"),
    ("[drive]\nz_position_gain_per_s = 400", Warning, "the loop outside is the slower one"),
    ("[drive]\nvelocity_filter_s = 0.25", Error, "0.25 ms would be 0.00025 s"),
    ("[drive]\nencoder_latency_s = 50", Error, "50 µs would be 0.00005 s"),
    ("[control]\nperiod_s = 1", Error, "1 ms would be 0.001 s"),
    ("[law.torque_curve]\nbands = [{ to_rpm = 3000, accel_s = 78.5, decel_s = 78.5 }, { to_rpm = 8000, accel_s = 285, decel_s = 285 }]", Warning, "78.5 ms would be 0.0785 s"),
    ("[tap]\nmajor_mm = 6\nhole_mm = 2.5", Warning, "was the radius written? The tap drill's diameter would be 5"),
    ("[tap]\nmajor_mm = 6\nhole_mm = 6", Error, "the usual tap drill of 6 mm is 5 mm"),
    ("[tolerance]\nerror_um = 0.053", Warning, "0.053 mm would be 53 µm"),
];

#[test]
fn every_slip_is_told_with_what_was_meant() {
    for &(text, severity, meant) in SLIPS {
        let (found, refused) = match MachineFile::read(text.as_bytes()) {
            Ok(file) => (file.warnings, false),
            Err(faults) => (faults, true),
        };
        assert_eq!(refused, severity == Error, "{text}\n{found:?}");
        let told: Vec<_> = found.iter().map(|found| found.in_file("m").to_string()).collect();
        let named = told.iter().filter(|told| told.contains(meant)).count();
        assert_eq!(named, 1, "{meant} of\n{text}\nfound\n{}", told.join("\n"));
    }
}

/// One slip, one warning: what follows from it is not told as well.
#[test]
fn a_slip_is_told_once() {
    for &(text, severity, _) in SLIPS.iter().filter(|(_, severity, _)| *severity == Warning) {
        let found = MachineFile::read(text.as_bytes()).unwrap().warnings;
        let slips: Vec<_> = found.iter().map(|found| found.in_file("m").to_string()).collect();
        assert!(severity == Warning && slips.len() <= 1, "{text}\n{}", slips.join("\n"));
    }
}
