//! What a machine cannot carry out: every message of the G6xx family with a program, or a command, that shows it.

use std::collections::BTreeSet;

use rigidtap::control::cycle::TapCycle;
use rigidtap::control::machine::{Law, Machine, MachineSpec};
use rigidtap::gcode::program::{Action, Checker, CommandError, Overrides, Planner};
use rigidtap::gcode::{Command, CommandKind, Diagnostics, Dialect, Options, Span, Warning, Warnings, codes, interpret};

fn refused(commands: &[Command], machine: &Machine) -> Vec<CommandError> {
    let mut found = Vec::new();
    let mut checker = Checker::new(machine, Law::TorqueCurve, Overrides::default(), Options::default().start_mm);
    commands.iter().for_each(|command| checker.command(command, &mut |refusal| found.push(refusal)));
    found
}

fn commands(program: &str) -> Vec<Command> {
    let read = interpret(program.as_bytes(), &Dialect::FANUC, Options::default());
    assert!(!read.diagnostics.has_errors(), "{program}: {:?}", read.diagnostics);
    read.commands
}

fn hole(bottom_mm: f64, pitch_mm: f64) -> Vec<Command> {
    let kind = CommandKind::Tap(TapCycle::right_hand(2.0, bottom_mm, pitch_mm, 1000.0));
    vec![Command { kind, line: 3, column: 1, span: Span { start: 0, end: 1 } }]
}

/// One hole after a start at rest.
fn tap(words: &str) -> Vec<Command> {
    commands(&format!("G90 G95 M29\nG0 X0. Y0. Z10.\nG84 R2. {words}\nG80\nM30\n"))
}

/// Each law at a pitch that is too sharp for Z: the hole is planned slower, and Z stays within its acceleration.
#[test]
fn a_law_too_sharp_for_z_is_slowed_and_told() {
    let machine = Machine::reference().with(|spec| spec.z.max_mm_per_s2 = 300.0).expect("a machine");
    for law in Law::ALL {
        let commands = tap("Z-10. F1. S1000");
        let (mut warnings, mut told) = (Warnings::new(&machine, law), Vec::new());
        let mut planner = Planner::new(&machine, law, Overrides::default(), Options::default().start_mm);
        let mut sharpest_mm_per_s2 = 0.0_f64;
        for command in &commands {
            warnings.command(command, &mut |found| told.push(found));
            let mut act = |action| {
                let Action::Tap(plan) = action else { return };
                for step in 0..=2000 {
                    let state = plan.at(plan.duration_s() * f64::from(step) / 2000.0).spindle;
                    sharpest_mm_per_s2 = sharpest_mm_per_s2.max(state.acceleration.abs());
                }
            };
            planner.plan(command, &mut act).unwrap_or_else(|error| panic!("{}: {error}", law.name()));
        }
        let [Warning::LawSlowed { factor, .. }, ..] = told[..] else { panic!("{}: {told:?}", law.name()) };
        assert!(factor < 0.9, "{}: {factor}", law.name());
        // The pitch is 1 mm: a revolution is a millimetre.
        assert!((150.0..300.0).contains(&sharpest_mm_per_s2), "{}: {sharpest_mm_per_s2}", law.name());
    }
}

#[test]
fn a_pitch_too_fast_for_z_names_the_speed_that_fits() {
    let found = refused(&tap("Z-90. F6. S6000"), &Machine::reference());
    let mut diagnostics = Diagnostics::new();
    diagnostics.planning_error(&found[0].command, found[0].error);
    assert_eq!(diagnostics.as_slice()[0].hint(), "S5000 fits: F30000 with it under G94; under G95 F stays");
    // As it says: that one is planned.
    assert!(refused(&tap("Z-90. F6. S5000"), &Machine::reference()).is_empty());
}

#[test]
fn every_refusal_is_told_with_its_numbers() {
    let reference = Machine::reference();
    let with = |change: fn(&mut MachineSpec)| reference.with(change).expect("a machine");
    let slow_z = with(|spec| spec.z.max_mm_per_s2 = 5.0);
    let fast_start = with(|spec| (spec.law.torque_curve.start_rpm, spec.law.torque_curve.end_rpm) = (400.0, 400.0));
    let wide = with(|spec| spec.tolerance.error_um = Some(100.0));
    let m8 = with(|spec| spec.tap.pitch_mm = Some(1.25));
    let cases = [
        ("G601", hole(5.0, 1.0), &reference, "the bottom Z5 is not below the R plane 2"),
        ("G602", hole(-5.0, -1.0), &reference, "-1 is not a positive finite number"),
        ("G603", tap("Z-10. F1. S9000"), &reference, "S9000 is beyond the spindle's 8000 rpm"),
        ("G603", commands("M03 S9000\nM30"), &reference, "S9000 is beyond the spindle's 8000 rpm"),
        ("G603", tap("Z-10. F1. S1000 J8500"), &reference, "S8500 is beyond the spindle's 8000 rpm"),
        ("G604", tap("Z-90. F6. S6000"), &reference, "takes Z 600.0 mm/s, and the machine has 500.0 mm/s"),
        ("G605", tap("Z-10. F1. S1000"), &slow_z, "takes Z 637 mm/s², and the machine has 5 mm/s²"),
        ("G606", tap("Z-10. F1. S300"), &fast_start, "the time law has no stroke"),
        ("G607", tap("Z-10. F1. S1000 Q0.05"), &reference, "the hole takes 240 pecks, and at most 50 are planned"),
        (
            "G608",
            tap("Z-20. F7. S1000"),
            &reference,
            "pitch 7 mm is outside the usual threads, 0.25 to 6.35 mm, so its tolerance",
        ),
        ("G609", tap("Z-20. F7. S1000"), &wide, "pitch 7 mm is outside the usual threads, 0.25 to 6.35 mm, so its tap"),
        (
            "G610",
            commands("G94 G1 X900. F0.1\nM30"),
            &reference,
            "the program takes 150 hours up to here, more than 100",
        ),
        ("G611", tap("Z-20. F1. S1000"), &m8, "the hole's pitch is 1.0000 mm, and the tap has 1.2500 mm"),
        ("G610", commands("G4 X999999.\nM30"), &reference, "the program takes 278 hours up to here, more than 100"),
    ];
    let mut shown = BTreeSet::new();
    for (code, commands, machine, words) in cases {
        let found = refused(&commands, machine);
        assert_eq!(found.len(), 1, "{code}: {found:?}");
        let mut diagnostics = Diagnostics::new();
        diagnostics.planning_error(&found[0].command, found[0].error);
        let told = diagnostics.as_slice()[0];
        assert_eq!((told.code(), told.is_error()), (code, true), "{}", told.message());
        assert!(told.message().contains(words), "{code}: {}", told.message());
        assert!(!told.hint().is_empty());
        assert_eq!((told.line, told.column), (found[0].command.line, 1));
        shown.insert(code);
    }
    assert_eq!(shown, codes().filter(|code| code.starts_with("G6")).collect());
}

/// What a refused program does must not depend on the rest: each hole is judged by itself.
#[test]
fn what_can_be_carried_out_beside_it_is_not_refused() {
    let program = "G90 G95 M29\nG0 X0. Y0. Z10.\nG84 R2. Z-10. F1. S9000\nX5. S1000\nX10. S9000\nG80\nM30\n";
    let lines: Vec<_> = refused(&commands(program), &Machine::reference()).iter().map(|r| r.command.line).collect();
    assert_eq!(lines, [3, 5]);
}
