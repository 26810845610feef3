//! The README's table: ours beside G33.1, on the same simulated spindle and Z in the same run.

use std::fmt::Write;

use super::record::{Hole, Row, chased, mean, tapped, worst};
use super::session::Session;

const CYCLES: u32 = 20;
const R_MM: f64 = 2.0;
const BOTTOM_MM: f64 = -28.0;

/// The spindle: its name, acceleration, rated speed, the share planned with, the share that it has, and the time in which
/// it is surely up to its speed.
const SPINDLES: [(&str, &str, &str, &str, &str, u32); 3] = [
    ("50 000 rpm/s", "50000", "8000", "0.97", "1", 200),
    ("10 000 rpm/s", "10000", "8000", "0.97", "1", 1500),
    ("torque curve, 0.80", "47746.483", "3000", "0.80", "0.80", 400),
];

#[allow(clippy::print_stdout, reason = "a table to look at")]
pub(crate) fn print(session: &Session) {
    // Fewer holes, one spindle: to look at the table without its half hour.
    let cycles = std::env::var("CYCLES").ok().and_then(|text| text.parse().ok()).unwrap_or(CYCLES);
    let mut out = String::from(
        "| spindle | S | error µm | G33.1 | overshoot µm | G33.1 | cycle s | G33.1 |\n|---|---|---|---|---|---|---|---|\n",
    );
    let mut clocks: [Vec<i32>; 2] = Default::default();
    let only = std::env::var("SPINDLE").unwrap_or_default();
    for (name, accel, rated, share, simulated, wait_ms) in SPINDLES.into_iter().filter(|row| row.0.contains(&only)) {
        session.set("ACCEL_RPM_PER_S", accel).set("RATED_RPM", rated);
        session.set("SHARE", share).set("SIMULATED_SHARE", simulated);
        for speed in [1000, 3000, 5000, 7000] {
            let (program, lines) = program(speed, cycles, wait_ms);
            session.write("program.ngc", &program);
            let (done, said, rows) =
                session.simulate(&[("RIGIDTAP_PROGRAM", "program.ngc"), ("RIGIDTAP_SECONDS", "800")]);
            let ours = tapped(&rows, R_MM, BOTTOM_MM, 1.0, 1.0);
            let own = chased(&rows, &lines, R_MM, BOTTOM_MM, 1.0);
            if !done || ours.len() != cycles as usize || own.len() != cycles as usize {
                println!("{name} S{speed}: {} holes, {} of G33.1\n{said}", ours.len(), own.len());
            }
            gather(&rows, &mut clocks);
            let text = |holes: &[Hole]| {
                if holes.iter().any(|hole| !hole.is_whole) {
                    return ["fails"; 3].map(str::to_owned);
                }
                let (error_um, overshoot_um) =
                    (worst(holes, |hole| hole.error_um), worst(holes, |hole| hole.overshoot_um));
                [
                    format!("{error_um:.2}"),
                    format!("{overshoot_um:.1}"),
                    format!("{:.3}", mean(holes, |hole| hole.cycle_s)),
                ]
            };
            let ([error, over, cycle], [own_error, own_over, own_cycle]) = (text(&ours), text(&own));
            writeln!(out, "| {name} | {speed} | {error} | {own_error} | {over} | {own_over} | {cycle} | {own_cycle} |")
                .expect("a String");
            println!("{}", out.lines().last().unwrap_or_default());
        }
    }
    println!("\nWorst error and overshoot of {cycles} holes, mean cycle.\n\n{out}");
    let [tap, motion] = clocks.map(|mut clocks| {
        clocks.sort_unstable();
        f64::from(clocks[clocks.len() / 2]) / clocks_per_ns()
    });
    println!("Median time of a period while tapping: rigidtap {tap:.0} ns, motion-controller {motion:.0} ns");
}

fn program(speed: u32, cycles: u32, wait_ms: u32) -> (String, Vec<i32>) {
    let mut text = format!("G21 G90 G94 G17 G99\nS{speed} M3\nG0 Z10\n");
    let mut lines = Vec::new();
    for cycle in 0..cycles {
        // The index comes at any time of G33.1's wait for it; the spindle is up to its speed again before each.
        let turn_ms = wait_ms + 17 * cycle % 60;
        // G33.1 may have left the spindle turning backwards.
        write!(text, "M3 S{speed}\nG4 P{}\nG84.2 R{R_MM} Z{BOTTOM_MM} F{speed}\nG0 Z10\n", f64::from(wait_ms) / 1000.0)
            .expect("a String");
        write!(text, "G4 P{}\nG0 Z{R_MM}\nG33.1 Z{BOTTOM_MM} K1\nG0 Z10\n", f64::from(turn_ms) / 1000.0)
            .expect("a String");
        lines.push(text.lines().count() as i32 - 1);
    }
    text += "M5\nM2\n";
    (text, lines)
}

fn gather(rows: &[Row], clocks: &mut [Vec<i32>; 2]) {
    for row in rows.iter().filter(|row| row.state == super::TAPPING) {
        clocks[0].push(row.tap_clocks);
        clocks[1].push(row.motion_clocks);
    }
}

/// HAL counts the processor's time stamp, whose rate Linux tells as twice the BogoMIPS.
fn clocks_per_ns() -> f64 {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = info.lines().find(|line| line.starts_with("bogomips")).and_then(|line| line.split(':').nth(1));
    line.and_then(|text| text.trim().parse::<f64>().ok()).map_or(1.0, |mips| mips / 2000.0)
}
