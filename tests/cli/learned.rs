use super::*;

fn simulate(folder: &std::path::Path, more: &[&str]) -> std::process::Output {
    let file = folder.join("learned.bin");
    let words = ["simulate", "gcode/s7000.ngc", "--format", "json", "--learned", file.to_str().unwrap()];
    rigidtap(&[&words[..], more].concat())
}

fn worst_um(output: &std::process::Output, hole: usize) -> f64 {
    let error = &json(output)["programs"][0]["holes"][hole - 1]["error_um"]["peak_to_peak"];
    error.as_f64().unwrap()
}

#[test]
fn a_restart_goes_on_from_what_the_last_run_kept() {
    let folder = tempfile::tempdir().unwrap();
    let first = simulate(folder.path(), &[]);
    let again = simulate(folder.path(), &[]);
    assert_eq!((code(&first), code(&again)), (0, 0), "{}", stderr(&again));
    // Twenty-one holes in all: the twentieth has learned, and after the restart the first one has it, too.
    assert!(worst_um(&first, 20) < 0.8 * worst_um(&first, 1), "it learns: {}", worst_um(&first, 20));
    assert!(worst_um(&again, 1) < 0.9 * worst_um(&first, 1), "{} {}", worst_um(&again, 1), worst_um(&first, 1));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no litter");
    let file = folder.path().join("learned.bin");
    let kept = std::fs::read(&file).unwrap();
    let words = ["compare", "gcode/s7000.ngc", "--format", "json", "--laws", "torque-curve", "--learned"];
    let compared = rigidtap(&[&words[..], &[file.to_str().unwrap()]].concat());
    assert_eq!(code(&compared), 0, "{}", stderr(&compared));
    assert_eq!(std::fs::read(&file).unwrap(), kept, "compare leaves it as it is");
}

#[test]
fn what_is_no_record_of_this_machine_is_refused_and_stays() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("learned.bin");
    assert_eq!(code(&simulate(folder.path(), &[])), 0);
    let good = std::fs::read(&file).unwrap();
    let mut damaged = good.clone();
    damaged[300] ^= 4;
    for (bytes, machine, expected) in [
        (&good[..], Some("gcode/machines/forty-taper.toml"), "a machine whose axes or drives have other data"),
        (&damaged[..], None, "it is damaged"),
        (&good[..200], None, "it is damaged"),
        (&b"N10 G0"[..], None, "no record of what was learned"),
        (&b""[..], None, "no record of what was learned"),
    ] {
        std::fs::write(&file, bytes).unwrap();
        let machine = machine.map_or(vec![], |machine| vec!["--machine", machine]);
        let output = simulate(folder.path(), &machine);
        let said = stderr(&output);
        assert_eq!(code(&output), 1, "{said}");
        assert!(said.contains("learned.bin") && said.contains(expected) && said.contains("help: "), "{said}");
        assert_eq!(std::fs::read(&file).unwrap(), bytes, "{expected}: it stays as it was");
    }
    let stdin = rigidtap(&["simulate", "gcode/s7000.ngc", "--learned", "-"]);
    assert_eq!(code(&stdin), 2, "{}", stderr(&stdin));
}
