//! The README's table: `G84.2` beside G33.1, on the same simulated machine in the same run.

use std::fmt::Write;

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rigidtap::config::MachineFile;

use super::record::{Hole, Row, chased, mean, tapped, worst};
use super::session::{Drives, Session};

const CYCLES: u32 = 20;
pub(crate) const R_MM: f64 = 2.0;
pub(crate) const BOTTOM_MM: f64 = -23.0;
/// In which the spindle is surely up to its speed.
const WAIT_MS: u32 = 450;

/// Compensation and what the drives take, as the table has them.
const WAYS: [(&str, &str, Drives); 5] = [
    ("none", "0", Drives::Torque),
    ("paper", "1", Drives::Torque),
    ("full", "2", Drives::Torque),
    ("full", "2", Drives::Velocity),
    ("full", "2", Drives::Position),
];

/// Time of a function in each period with spindle and Z, in clocks.
#[derive(Default)]
struct Clocks {
    tap: Vec<i32>,
    motion: Vec<i32>,
}

#[allow(clippy::print_stdout, reason = "a table to look at")]
pub(crate) fn print(session: &Session) {
    // Fewer holes, one way or speed: to look at the table without its half hour.
    let set = |name: &str| std::env::var(name).unwrap_or_default();
    let cycles = set("CYCLES").parse().unwrap_or(CYCLES);
    let (way, only, takes) = (set("WAY"), set("SPEED"), set("TAKES"));
    let mut out = String::from(
        "| S | compensation | drives take | error µm | too deep µm | cycle s | G33.1 error µm | too deep µm | cycle s |\n\
         |--:|---|---|--:|--:|--:|--:|--:|--:|\n",
    );
    let mut clocks = Clocks::default();
    for speed in [1000, 3000, 5000, 7000].into_iter().filter(|speed| only.is_empty() || only == speed.to_string()) {
        for (name, compensation, drives) in WAYS
            .into_iter()
            .filter(|row| (way.is_empty() || way == row.0) && (takes.is_empty() || takes == row.2.name()))
        {
            session.set("COMPENSATION", compensation).connect(drives);
            // LinuxCNC's own beside the drives that are told all; it does not know what others take.
            let own_cycles = if (compensation, drives) == ("2", Drives::Torque) { cycles } else { 0 };
            let (program, lines) = program(speed, cycles, own_cycles);
            session.write("program.ngc", &program);
            let (done, said, rows) =
                session.simulate(&[("RIGIDTAP_PROGRAM", "program.ngc"), ("RIGIDTAP_SECONDS", "800")]);
            let ours = tapped(&rows, R_MM, BOTTOM_MM, 1.0, 1.0);
            let own = chased(&rows, &lines, R_MM, BOTTOM_MM, 1.0);
            if !done || ours.len() != cycles as usize || own.len() != own_cycles as usize {
                println!("S{speed} {name}: {} holes, {} of G33.1\n{said}", ours.len(), own.len());
            }
            if compensation == "2" && drives == Drives::Torque {
                gather(&rows, &mut clocks);
            }
            let ([error, deep, cycle], [own_error, own_deep, own_cycle]) = (figures(&ours), figures(&own));
            let row = format!(
                "| {speed} | {name} | {} | {error} | {deep} | {cycle} | {own_error} | {own_deep} | {own_cycle} |",
                drives.name()
            );
            println!("{row}");
            writeln!(out, "{row}").expect("a String");
        }
    }
    println!("\nWorst true error and depth of {cycles} holes, mean cycle.\n\n{out}");
    let per_ns = clocks_per_ns();
    for (name, mut times) in [("rigidtap", clocks.tap), ("motion-controller", clocks.motion)] {
        times.sort_unstable();
        let ns = |share: f64| times.get((share * times.len() as f64) as usize).map_or(0.0, |t| f64::from(*t) / per_ns);
        println!("{name}, periods of a hole under full: median {:.0} ns, 99.9 % {:.0} ns", ns(0.5), ns(0.999));
    }
}

/// Machines of the standard and the hard spread, which the control takes for the reference machine: twenty holes each.
#[allow(clippy::print_stdout, reason = "a table to look at")]
pub(crate) fn print_hard(session: &Session) {
    let cycles = std::env::var("CYCLES").ok().and_then(|text| text.parse().ok()).unwrap_or(CYCLES);
    println!("| machine | first hole µm | worst µm | last µm | too deep µm | alarms |\n|--:|--:|--:|--:|--:|---|");
    for seed in 1..=10 {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut file = MachineFile::reference();
        file.actual = file.hard.draw_onto(&file.spread.draw(&mut random), &mut random);
        let text = (0..cycles).fold("G21 G90 G94 G17 G99\nS7000 M3\nG0 Z10\n".to_owned(), |text, _| {
            text + &format!("M3 S7000\nG4 P0.45\nG84.2 R{R_MM} Z{BOTTOM_MM} F7000\nG0 Z10\n")
        });
        session.set("SEED", &seed.to_string()).machine(&file).write("program.ngc", &(text + "M5\nM2\n"));
        let (_, said, rows) = session.simulate(&[("RIGIDTAP_PROGRAM", "program.ngc"), ("RIGIDTAP_SECONDS", "800")]);
        let holes = tapped(&rows, R_MM, BOTTOM_MM, 1.0, 1.0);
        let mut alarms: Vec<i32> = rows.iter().map(|row| row.alarm).filter(|alarm| *alarm != 0).collect();
        alarms.dedup();
        let [first, last] = [holes.first(), holes.last()].map(|hole| hole.map_or(f64::NAN, |hole| hole.error_um));
        let (error, deep) = (worst(&holes, |hole| hole.error_um), worst(&holes, |hole| hole.overshoot_um));
        println!("| {seed} | {first:.1} | {error:.1} | {last:.1} | {deep:.1} | {alarms:?} |");
        if holes.len() != cycles as usize {
            println!("{} holes\n{said}", holes.len());
        }
    }
}

fn figures(holes: &[Hole]) -> [String; 3] {
    if holes.is_empty() {
        return [""; 3].map(str::to_owned);
    }
    if holes.iter().any(|hole| !hole.is_whole) {
        return ["fails"; 3].map(str::to_owned);
    }
    let (error_um, deep_um) = (worst(holes, |hole| hole.error_um), worst(holes, |hole| hole.overshoot_um));
    [format!("{error_um:.2}"), format!("{deep_um:.1}"), format!("{:.3}", mean(holes, |hole| hole.cycle_s))]
}

/// Holes of `G84.2` and, as many as there are, of G33.1 by turns, and the lines of the latter.
pub(crate) fn program(speed: u32, cycles: u32, own_cycles: u32) -> (String, Vec<i32>) {
    let mut text = format!("G21 G90 G94 G17 G99\nS{speed} M3\nG0 Z10\n");
    let mut lines = Vec::new();
    for cycle in 0..cycles {
        // The index comes at any time of G33.1's wait for it; the spindle is up to its speed again before each.
        let turn_ms = WAIT_MS + 17 * cycle % 60;
        // G33.1 may have left the spindle turning backwards.
        write!(text, "M3 S{speed}\nG4 P{}\nG84.2 R{R_MM} Z{BOTTOM_MM} F{speed}\nG0 Z10\n", f64::from(WAIT_MS) / 1000.0)
            .expect("a String");
        if cycle >= own_cycles {
            continue;
        }
        write!(text, "G4 P{}\nG0 Z{R_MM}\nG33.1 Z{BOTTOM_MM} K1\nG0 Z10\n", f64::from(turn_ms) / 1000.0)
            .expect("a String");
        lines.push(text.lines().count() as i32 - 1);
    }
    text += "M5\nM2\n";
    (text, lines)
}

fn gather(rows: &[Row], clocks: &mut Clocks) {
    for row in rows.iter().filter(|row| row.state == super::TAPPING) {
        clocks.tap.push(row.tap_clocks);
        clocks.motion.push(row.motion_clocks);
    }
}

/// HAL counts the processor's time stamp, whose rate Linux tells as twice the BogoMIPS.
fn clocks_per_ns() -> f64 {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = info.lines().find(|line| line.starts_with("bogomips")).and_then(|line| line.split(':').nth(1));
    line.and_then(|text| text.trim().parse::<f64>().ok()).map_or(1.0, |mips| mips / 2000.0)
}
