//! The component in LinuxCNC itself: in HAL alone, and in the whole simulated mill beside LinuxCNC's own G33.1.
//!
//! Without LinuxCNC, or without the right to install the components, each test says that it was not run.

mod commission;
mod record;
mod session;
mod table;

use std::fmt::Write;
use std::process::Command;

use record::{FINISHED, HOLDING, TAPPING, chased, tapped, worst};
use session::{Drives, Session, built, run};

/// HAL alone: the component, a simulated spindle, and a Z that goes where it is told, so that nothing is left to its loops. Holes are planned beside the servo
/// thread.
fn hal(period_ns: u32, pins: &[(&str, f64)]) -> String {
    let period_s = f64::from(period_ns) * 1e-9;
    let mut text = format!(
        "loadrt threads name1=servo period1={period_ns} name2=slow period2=5000000\n\
         loadrt rigidtap\nloadrt simulated_spindle\n\
         setp rigidtap.0.enable 1\nsetp rigidtap.0.in-position 1\nsetp rigidtap.0.nominal-time 1\n\
         setp rigidtap.0.spindle.coulomb-nm 0\nsetp rigidtap.0.spindle.viscous-nm-per-rpm 0\n\
         setp rigidtap.0.control.period-s {period_s}\n\
         net z rigidtap.0.z-command-out => rigidtap.0.z-feedback-in\n\
         net unused-velocity rigidtap.0.z-velocity-offset\nnet unused-force rigidtap.0.z-force-offset\n\
         net rev simulated-spindle.position => rigidtap.0.spindle-position\n\
         net rpm simulated-spindle.speed => rigidtap.0.spindle-speed\n\
         net spindle rigidtap.0.spindle-command-out => simulated-spindle.command\n\
         addf rigidtap.0.plan slow\naddf rigidtap.0.update servo\naddf simulated-spindle.update servo\n"
    );
    for (pin, value) in pins {
        writeln!(text, "setp rigidtap.0.{pin} {value}").expect("a String");
    }
    text + "start\nloadusr -w sleep 0.3\n"
}

/// A pin's value in what `show pin` printed; the last time it was shown.
fn pin(shown: &str, name: &str) -> f64 {
    let fields = shown.lines().rev().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let found = fields.into_iter().find(|fields| fields.get(4) == Some(&format!("rigidtap.0.{name}").as_str()));
    let value = found.unwrap_or_else(|| panic!("no pin {name} in\n{shown}"))[3].to_owned();
    match value.as_str() {
        "TRUE" => 1.0,
        "FALSE" => 0.0,
        number => number.parse().unwrap_or_else(|_| panic!("{name} is {number}")),
    }
}

#[test]
fn taps_in_hal_at_1_ms_and_at_250_us() {
    let Some(session) = Session::new("hal") else { return };
    for period_ns in [1_000_000, 250_000] {
        for (speed, hand) in [(1000.0, 0.0), (5000.0, 1.0)] {
            let hole = [("pitch", 1.0), ("depth", 12.0), ("speed", speed), ("left-hand", hand), ("peck", 5.0)];
            let pins = [&hole[..], &[("spindle-command-in", speed), ("start", 1.0)]].concat();
            let shown = session.halrun(&(hal(period_ns, &pins) + "loadusr -w sleep 7\nshow pin rigidtap.0\n"));
            assert_eq!((pin(&shown, "finished"), pin(&shown, "alarm")), (1.0, 0.0), "{shown}");
            assert!(pin(&shown, "error-peak-um") <= 10.0, "{shown}");
            assert!((pin(&shown, "depth-reached") - 12.0).abs() <= 0.005, "{shown}");
            assert_eq!(pin(&shown, "z-command-out"), 0.0);
        }
    }
}

#[test]
fn an_aborted_tap_is_held_and_comes_back_by_one_command() {
    let Some(session) = Session::new("abort") else { return };
    for delay_s in [0.05, 0.3, 0.45, 0.6, 0.75, 0.95, 1.1] {
        let pins = [("pitch", 1.0), ("depth", 25.0), ("speed", 5000.0), ("spindle-command-in", 5000.0)];
        let shown = session.halrun(
            &(hal(1_000_000, &pins)
                + &format!(
                    "setp rigidtap.0.start 1\nloadusr -w sleep {delay_s}\nsetp rigidtap.0.abort 1\n\
                     loadusr -w sleep 0.6\nshow pin rigidtap.0\nsetp rigidtap.0.retract 1\n\
                     loadusr -w sleep 2\nshow pin rigidtap.0\n"
                )),
        );
        let half = shown.len() / 2;
        let (held, back) = shown.split_at(half);
        let state = pin(held, "state");
        assert!(state == f64::from(HOLDING) || state == f64::from(FINISHED), "{delay_s}: {held}");
        // Spindle and Z agree on where the tap is.
        assert!(pin(held, "error-peak-um") <= 50.0, "{delay_s}: {held}");
        assert_eq!((pin(back, "state"), pin(back, "z-true")), (f64::from(FINISHED), 0.0), "{delay_s}: {back}");
        assert!(pin(back, "error-peak-um") <= 50.0, "{delay_s}: {back}");
        if state == f64::from(HOLDING) {
            assert_eq!((pin(back, "alarm"), pin(back, "spindle-command-out")), (201.0, 0.0));
            assert_eq!(pin(held, "z-true"), pin(held, "z-command-out"));
        }
    }
}

/// The power goes while the tap is held in the thread; the record's pins lead it out, or refuse where the spindle was turned since.
#[test]
fn after_a_power_cut_the_tap_is_led_out_by_its_record() {
    let Some(session) = Session::new("power") else { return };
    let words = (0..16).fold(String::new(), |text, n| {
        text + &format!("net record-{n:02} rigidtap.0.record-{n:02} => rigidtap.0.saved-{n:02}\n")
    });
    for turned_rpm in [0.0, 40.0] {
        let pins = [("pitch", 1.0), ("depth", 25.0), ("speed", 3000.0), ("saved-valid", 1.0)];
        let script = hal(1_000_000, &pins).replace("start\n", &format!("{words}start\n"))
            + &format!(
                "setp rigidtap.0.start 1\nloadusr -w sleep 0.35\nsetp rigidtap.0.abort 1\nloadusr -w sleep 0.6\n\
                 show pin rigidtap.0\nloadusr -w echo ====\nsetp rigidtap.0.enable 0\nsetp rigidtap.0.start 0\n\
                 loadusr -w sleep 0.1\nsetp rigidtap.0.abort 0\nsetp rigidtap.0.acknowledge 1\nloadusr -w sleep 0.1\n\
                 setp rigidtap.0.acknowledge 0\nsetp rigidtap.0.spindle-command-in {turned_rpm}\nloadusr -w sleep 0.2\n\
                 setp rigidtap.0.spindle-command-in 0\nloadusr -w sleep 0.2\nsetp rigidtap.0.restore 1\n\
                 loadusr -w sleep 0.3\nshow pin rigidtap.0\nloadusr -w echo ====\nsetp rigidtap.0.retract 1\n\
                 loadusr -w sleep 2\nshow pin rigidtap.0\n"
            );
        let shown = session.halrun(&script);
        let [held, restored, out] =
            <[&str; 3]>::try_from(shown.split("====").collect::<Vec<_>>()).expect("three parts");
        assert_eq!((pin(held, "state"), pin(held, "record-valid")), (f64::from(HOLDING), 1.0), "{held}");
        assert!(pin(held, "z-true") < -2.0, "{held}");
        if turned_rpm == 0.0 {
            let found = (pin(restored, "state"), pin(restored, "alarm"), pin(restored, "drives-enable"));
            assert_eq!(found, (f64::from(HOLDING), 0.0, 1.0), "{restored}");
            assert!((pin(restored, "z-true") - pin(held, "z-true")).abs() < 0.02, "{restored}");
            let found = (pin(out, "state"), pin(out, "alarm"), pin(out, "record-valid"), pin(out, "drives-enable"));
            assert_eq!(found, (f64::from(FINISHED), 0.0, 0.0, 0.0), "{out}");
            assert!(pin(out, "z-true").abs() < 0.02 && pin(out, "error-peak-um") < 50.0, "{out}");
        } else {
            assert_eq!((pin(restored, "alarm"), pin(restored, "fault-limit").round()), (55.0, 53.0), "{restored}");
            assert!(pin(restored, "fault-found").abs() > pin(restored, "fault-limit"), "{restored}");
            assert_eq!(pin(out, "z-true"), pin(held, "z-true"), "{out}");
        }
    }
}

/// What a fault in the thread leads to: shown while it is held, once acknowledged and retracted, and once the end is
/// acknowledged, too. M3 asks for 3000 rpm all the time.
fn faulted(session: &Session, fault: &str, repair: &str) -> [String; 3] {
    let pins = [("pitch", 1.0), ("depth", 25.0), ("speed", 3000.0), ("spindle-command-in", 3000.0)];
    let script = hal(1_000_000, &pins)
        + &format!(
            "setp rigidtap.0.start 1\nloadusr -w sleep 0.35\n{fault}\nloadusr -w sleep 1.2\nshow pin rigidtap.0\n\
             loadusr -w echo ====\n{repair}\nsetp rigidtap.0.acknowledge 1\nloadusr -w sleep 0.1\n\
             setp rigidtap.0.acknowledge 0\nsetp rigidtap.0.retract 1\nloadusr -w sleep 2\nshow pin rigidtap.0\n\
             loadusr -w echo ====\nsetp rigidtap.0.start 0\nsetp rigidtap.0.acknowledge 1\n\
             loadusr -w sleep 0.1\nshow pin rigidtap.0\n"
        );
    let shown = session.halrun(&script);
    let parts: Vec<String> = shown.split("====").map(str::to_owned).collect();
    <[String; 3]>::try_from(parts).unwrap_or_else(|parts| panic!("{parts:?}"))
}

#[test]
fn a_spindle_that_obeys_no_more_in_the_thread_is_held_where_the_clearance_ends() {
    let Some(session) = Session::new("stalled") else { return };
    let [held, back, after] = faulted(
        &session,
        "setp simulated-spindle.accel-rpm-per-s 0",
        "setp simulated-spindle.accel-rpm-per-s 47746.483",
    );
    // It can neither brake nor speed up: Z goes with it, or is stopped by its limits.
    assert!([105.0, 107.0, 108.0].contains(&pin(&held, "alarm")), "{held}");
    assert_eq!((pin(&held, "alarmed"), pin(&held, "finished")), (1.0, 0.0), "the spindle still coasts: {held}");
    assert!(pin(&held, "z-command-out") >= -25.51 && pin(&held, "spindle-command-out").abs() <= 3001.0, "{held}");
    // An alarm of axes that move stays.
    assert_eq!(pin(&back, "alarm"), pin(&held, "alarm"), "{back}");
    assert_eq!(pin(&back, "spindle-command-out"), 0.0, "{back}");
    // It coasted further than the bottom clearance lets Z follow. At rest the alarm is acknowledged, the tap is held, and
    // nothing moves before a new order.
    assert_eq!((pin(&after, "alarm"), pin(&after, "state")), (0.0, f64::from(HOLDING)), "{after}");
    let moved_mm = pin(&after, "z-command-out") - pin(&held, "z-command-out");
    assert!(moved_mm.abs() <= 0.001, "{moved_mm}: {after}");
}

#[test]
fn an_encoder_unplugged_in_the_thread_stops_on_the_model() {
    let Some(session) = Session::new("unplugged") else { return };
    let [held, back, after] = faulted(&session, "unlinkp rigidtap.0.spindle-position", "");
    assert_eq!((pin(&held, "alarm"), pin(&held, "state")), (103.0, f64::from(HOLDING)), "{held}");
    assert_eq!((pin(&held, "finished"), pin(&held, "alarmed"), pin(&held, "busy")), (1.0, 1.0, 1.0), "{held}");
    assert_eq!(pin(&held, "spindle-command-out"), 0.0, "{held}");
    assert!((-25.0..-0.5).contains(&pin(&held, "z-command-out")), "{held}");
    // It is still unplugged: acknowledged, the retract finds it so again, and nothing leaps.
    assert!(pin(&back, "spindle-command-out").abs() <= 3001.0, "{back}");
    assert!(pin(&after, "z-command-out") <= 0.0, "{after}");
}

#[test]
fn a_drive_that_trips_and_a_machine_switched_off_leave_the_spindle_at_rest_until_acknowledged() {
    let Some(session) = Session::new("tripped") else { return };
    let [held, back, after] =
        faulted(&session, "setp rigidtap.0.spindle-drive-ready 0", "setp rigidtap.0.spindle-drive-ready 1");
    assert_eq!((pin(&held, "alarm"), pin(&held, "state")), (105.0, f64::from(HOLDING)), "{held}");
    assert_eq!(pin(&held, "spindle-command-out"), 0.0, "{held}");
    assert_eq!((pin(&back, "state"), pin(&back, "z-true")), (f64::from(FINISHED), 0.0), "{back}");
    assert_eq!((pin(&back, "alarm"), pin(&back, "spindle-command-out")), (105.0, 0.0), "{back}");
    assert_eq!((pin(&after, "alarm"), pin(&after, "spindle-command-out")), (0.0, 3000.0), "{after}");

    let [held, _, after] = faulted(&session, "setp rigidtap.0.enable 0", "");
    assert_eq!((pin(&held, "alarm"), pin(&held, "state")), (202.0, f64::from(FINISHED)), "{held}");
    assert_eq!(pin(&held, "spindle-command-out"), 0.0, "{held}");
    assert!(pin(&held, "z-command-out") < -0.5, "{held}");
    assert_eq!(pin(&after, "alarm"), 0.0, "{after}");
}

#[test]
fn a_held_tap_goes_on_when_it_is_let() {
    let Some(session) = Session::new("hold") else { return };
    let pins = [("pitch", 1.0), ("depth", 25.0), ("speed", 3000.0), ("start", 1.0)];
    let shown = session.halrun(
        &(hal(1_000_000, &pins)
            + "setp rigidtap.0.hold 1\nloadusr -w sleep 1\nshow pin rigidtap.0\nsetp rigidtap.0.hold 0\n\
               loadusr -w sleep 2.5\nshow pin rigidtap.0\n"),
    );
    let (held, after) = shown.split_at(shown.len() / 2);
    assert_eq!(pin(held, "state"), f64::from(HOLDING), "{held}");
    assert!(pin(held, "z-true") < -1.0);
    assert_eq!((pin(after, "finished"), pin(after, "alarm"), pin(after, "z-true")), (1.0, 0.0, 0.0), "{after}");
    assert!((pin(after, "depth-reached") - 25.0).abs() <= 0.005 && pin(after, "error-peak-um") <= 10.0, "{after}");
}

#[test]
fn what_cannot_be_tapped_is_refused_before_anything_moves() {
    let Some(session) = Session::new("refused") else { return };
    // Too fast a spindle; too fast a Z; no depth: the header's numbers.
    for (speed, pitch, depth, alarm, found) in
        [(9000.0, 1.0, 10.0, 23.0, 9000.0), (6000.0, 6.0, 10.0, 24.0, 600.0), (1000.0, 1.0, 0.0, 21.0, 0.0)]
    {
        let pins = [("pitch", pitch), ("depth", depth), ("speed", speed), ("start", 1.0)];
        let shown = session.halrun(&(hal(1_000_000, &pins) + "show pin rigidtap.0\n"));
        assert_eq!((pin(&shown, "finished"), pin(&shown, "alarm"), pin(&shown, "fault-found")), (1.0, alarm, found));
        assert_eq!(pin(&shown, "z-command-out"), 0.0);
    }
    // The machine's data are of another period than the thread's.
    let pins = [("pitch", 1.0), ("depth", 10.0), ("speed", 1000.0), ("control.period-s", 0.002), ("start", 1.0)];
    let shown = session.halrun(&(hal(1_000_000, &pins) + "show pin rigidtap.0\n"));
    let refused = ["finished", "alarm", "fault-found", "fault-limit"].map(|name| pin(&shown, name));
    assert_eq!(refused, [1.0, 204.0, 0.002, 0.001], "{shown}");
}

#[test]
fn the_component_imports_no_allocator_and_no_unwinder() {
    let Some(_session) = Session::new("imports") else { return };
    let component = run(Command::new("nm").arg("--undefined-only").arg(built("rigidtap.so")));
    let imports =
        component.lines().filter_map(|line| line.split_whitespace().last()).map(|name| name.split('@').next());
    for name in imports.flatten() {
        let known = ["hal_", "rtapi_"].iter().any(|start| name.starts_with(start))
            || ["memcpy", "memmove", "memset", "memcmp", "bcmp"].contains(&name)
            // What any shared object has.
            || ["__cxa_finalize", "__gmon_start__"].contains(&name)
            || name.starts_with("_ITM_");
        assert!(known, "the component imports {name}");
    }
    let inside = run(Command::new("nm").arg("--demangle").arg(built("rigidtap_core.o")));
    for word in ["panic", "unwind", "alloc", "eh_personality"] {
        assert!(!inside.contains(word), "{word} is in the component");
    }
}

/// The table at smoke size: the whole machine, its drives as well as they can be told, and what LinuxCNC itself makes of it.
#[test]
fn full_holds_the_thread_in_the_simulated_mill_where_g33_1_does_not() {
    let Some(session) = Session::new("mill") else { return };
    let (program, lines) = table::program(7000, 3, 3);
    session.machine(&rigidtap::config::MachineFile::reference()).write("program.ngc", &program);
    let (done, said, rows) = session.simulate(&[("RIGIDTAP_PROGRAM", "program.ngc")]);
    assert!(done, "{said}");
    let holes = tapped(&rows, table::R_MM, table::BOTTOM_MM, 1.0, 1.0);
    assert_eq!(holes.len(), 3, "{said}");
    for hole in &holes {
        assert!(hole.is_whole && hole.error_um <= 5.0 && hole.overshoot_um <= 2.0, "{holes:?}");
    }
    // The line of each hole in the program's output.
    assert_eq!(said.matches("rigidtap: ok, error").count(), 3, "{said}");
    // The measurement is one that sees what G33.1 does on the same spindle and Z.
    let own = chased(&rows, &lines, table::R_MM, table::BOTTOM_MM, 1.0);
    assert!(own.len() == 3 && own.iter().all(|hole| hole.error_um > 50.0), "{own:?}");
    assert!(rows.iter().any(|row| row.state == TAPPING) && rows.iter().all(|row| row.alarm == 0));
}

/// Drives that take no force are sent what their own loops make it of.
#[test]
fn full_holds_the_thread_whatever_the_drives_take() {
    let Some(session) = Session::new("takes") else { return };
    let program = "G21 G90 G94 G17 G98\nS3000 M3\nG0 Z10\nG84.2 X0 R2 Z-18 F3000\n\
                   G91 G95 G84.2 X5 R-8 Z-20 K2 Q7 P0.1 F1\nG90 G94 G0 Z10\nM5\nM2\n";
    session.write("program.ngc", program);
    for drives in [Drives::Velocity, Drives::Position] {
        let (done, said, rows) = session.connect(drives).simulate(&[("RIGIDTAP_PROGRAM", "program.ngc")]);
        assert!(done, "{drives:?}: {said}");
        let holes = tapped(&rows, 2.0, -18.0, 1.0, 1.0);
        assert_eq!(holes.len(), 3, "{drives:?}: {said}");
        // Pecks turn round six times in a hole that nothing was learned of yet: 3.6 to 6.7 µm were measured with velocities.
        for (hole, limit_um) in holes.iter().zip([6.0, 8.0, 8.0]) {
            assert!(hole.error_um <= limit_um && hole.peak_rpm < 3100.0, "{drives:?}: {holes:?}");
        }
    }
}

/// Name by name: what `rigidtap machine --hal` sets is what the component has.
#[test]
fn the_component_has_a_parameter_for_each_line_of_the_machines_hal_file() {
    let pins = include_str!("../../src/capi/linuxcnc/rigidtap_pins.c");
    let keys = pins.lines().filter(|line| line.trim_start().starts_with("KEY(") || line.contains("PARAM("));
    let named = keys.filter_map(|line| line.split('"').nth(1));
    let choices = ["spindle.torque-curve.points", "torque-curve.bands", "z.encoder-at-motor"];
    let known: std::collections::BTreeSet<&str> = named.chain(choices).collect();
    let hal = rigidtap::config::MachineFile::reference().to_hal();
    let set = hal.lines().filter_map(|line| line.strip_prefix("setp rigidtap.0.")?.split(' ').next());
    let mut count = 0;
    for name in set {
        let numbered = name.split('.').any(|part| part.len() == 2 && part.bytes().all(|byte| byte.is_ascii_digit()));
        assert!(numbered || known.contains(name), "{name}");
        count += usize::from(!numbered);
    }
    // All but what is set apart from the machine.
    let apart = ["compensation", "identify", "learn", "nominal-time"];
    assert_eq!(count, known.iter().filter(|name| !apart.contains(name) && !name.contains('%')).count(), "{known:?}");
}

#[test]
fn the_sample_program_and_an_mdi_line_run() {
    let Some(session) = Session::new("sample") else { return };
    let (done, said, rows) = session.simulate(&[("RIGIDTAP_PROGRAM", "three_holes.ngc")]);
    assert!(done, "{said}");
    // One stroke, left-hand, pecked.
    let [right, left] = [1.0, -1.0].map(|hand| tapped(&rows, 2.0, -18.0, 1.0, hand));
    assert_eq!(right.len(), 3, "{said}");
    for hole in [right[0], left[1], right[2]] {
        assert!(hole.error_um <= 10.0 && hole.overshoot_um.abs() <= 5.0, "{hole:?}");
    }
    assert!(right[1].error_um > 1000.0, "the second is left-hand: {:?}", right[1]);
    let (done, said, rows) =
        session.simulate(&[("RIGIDTAP_MDI", "G20 G94 M3 S2000; G0 Z0.5; G84.2 R0.1 Z-0.4 F100; G21 M5")]);
    assert!(done, "{said}");
    // A twentieth of an inch a turn.
    let holes = tapped(&rows, 2.54, -10.16, 1.27, 1.0);
    assert_eq!(holes.len(), 1, "{said}");
    assert!(holes[0].error_um <= 10.0 && holes[0].overshoot_um.abs() <= 5.0, "{holes:?}");
}

#[test]
fn a_block_that_makes_no_hole_is_an_error_with_its_reason() {
    let Some(session) = Session::new("blocks") else { return };
    for (lines, reason) in [
        ("S0; G84.2 R2 Z-18 F1", "no spindle speed"),
        ("G95 S1000 M3; G84.2 R2 Z-18 F0", "no pitch"),
        ("S1000 M3 G94; G84.2 R2 Z3 F1000", "not below the R plane"),
        ("S1000 M3 G94; G84.2 R2 Z-3 F1000 K0", "K is below 1"),
        ("S9000 M3 G94; G84.2 R2 Z-3 F9000", "alarm"),
    ] {
        let (done, said, rows) = session.simulate(&[("RIGIDTAP_MDI", lines)]);
        assert!(!done && said.contains(reason), "{lines}\n{said}");
        assert!(rows.iter().all(|row| row.z_mm > -0.01), "{lines}");
    }
}

#[test]
fn a_program_aborted_in_the_thread_leaves_a_tap_that_comes_back() {
    let Some(session) = Session::new("abort-in-mill") else { return };
    // In place of the sample's display.
    session.write("headless.py", include_str!("abort.py"));
    let (_, said, rows) = session.simulate(&[]);
    assert!(said.contains("abort: held at depth") && said.contains("abort: back at R"), "{said}");
    assert!(said.contains("abort: Z is known"), "{said}");
    assert!(said.contains("abort: record is kept"), "held, back at R, switched off in the thread: {said}");
    // The third was never finished: without power nothing is synchronous.
    let holes = tapped(&rows, 2.0, -28.0, 1.0, 1.0);
    assert_eq!(holes.len(), 3, "{said}");
    let holes = &holes[..2];
    assert!(worst(holes, |hole| hole.error_um) <= 50.0 && worst(holes, |hole| hole.overshoot_um) <= 5.0, "{holes:?}");
}

/// HAL alone, in one command.
#[test]
fn the_demo_prints_four_good_holes() {
    let Some(session) = Session::new("demo") else { return };
    let said = session.run("timeout 60 ./demo");
    let holes: Vec<Vec<&str>> = said
        .lines()
        .map(|line| line.split_whitespace().collect())
        .filter(|words: &Vec<_>| words.get(1) == Some(&"ok"))
        .collect();
    assert_eq!(holes.len(), 4, "{said}");
    for words in holes {
        let [true_um, too_deep_um] = [3, 4].map(|n: usize| words[n].parse::<f64>().expect("a number"));
        assert!(true_um <= 5.0 && too_deep_um <= 2.0, "{said}");
    }
}

/// A machine from its data sheet to twenty holes, as the guide's page on commissioning has it:
/// `cargo test --test linuxcnc commissioned -- --ignored --nocapture`.
#[test]
#[ignore = "two minutes of real time"]
#[allow(clippy::print_stdout, reason = "figures to look at")]
fn a_machine_commissioned_from_its_data_sheet_holds_the_thread() {
    let Some(session) = Session::new("commission") else { return };
    let (error_um, monitored) = commission::commissioned(&session);
    println!("worst true error from the third hole on {error_um:.2} µm\n{monitored}");
    assert!(error_um <= 6.0, "{error_um} µm\n{monitored}");
}

/// Ten machines of the hard spread: `cargo test --test linuxcnc hard_machines -- --ignored --nocapture`.
#[test]
#[ignore = "ten minutes of real time"]
fn hard_machines() {
    let Some(session) = Session::new("hard") else { return };
    table::print_hard(&session);
}

/// The table of `src/guide/results.md`: `cargo test --test linuxcnc table_of_figures -- --ignored --nocapture`.
#[test]
#[ignore = "half an hour of real time"]
fn table_of_figures() {
    let Some(session) = Session::new("table") else { return };
    table::print(&session);
}
