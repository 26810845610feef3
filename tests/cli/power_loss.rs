use super::*;

#[test]
fn on_the_dc_link_the_tap_is_retracted_after_the_restart() {
    let output = rigidtap(&["simulate", "gcode/s3000.ngc", "--power-loss", "1.2", "--format", "json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let found = &json(&output)["programs"][0];
    let loss = &found["power_loss"];
    assert_eq!((&loss["end"], &loss["lost"], &loss["hole"]), (&"retracted".into(), &"mains".into(), &1.into()));
    assert!(loss["offset_um"].as_f64().unwrap().abs() < 20.0 && loss["depth_mm"].as_f64().unwrap() > 1.0, "{loss}");
    assert_eq!(found["holes"].as_array().unwrap().len(), 1, "the program ends there");
    assert!(found["holes"][0]["true_error_um"]["max"].as_f64().unwrap() < 20.0);
}

#[test]
fn all_dead_is_refused_with_the_offset() {
    let output = rigidtap(&["simulate", "gcode/s3000.ngc", "--power-loss", "1.2,dead", "--format", "json"]);
    assert_eq!(code(&output), 3, "{}", stderr(&output));
    let loss = &json(&output)["programs"][0]["power_loss"];
    assert_eq!((&loss["end"], &loss["lost"]), (&"refused".into(), &"dead".into()));
    let offset_um = loss["offset_um"].as_f64().unwrap();
    assert!(offset_um.abs() > 52.5, "{loss}");
    assert!(loss["message"].as_str().unwrap().contains(&format!("{offset_um:.1} µm off the hole's helix")), "{loss}");
}

#[test]
fn a_cut_out_of_any_hole_leaves_nothing() {
    let output = rigidtap(&["simulate", "gcode/s3000.ngc", "--power-loss", "0.1", "--format", "json"]);
    assert_eq!(code(&output), 0);
    assert_eq!(json(&output)["programs"][0]["power_loss"]["end"], "no-hole");
    let output = rigidtap(&["simulate", "gcode/s3000.ngc", "--power-loss", "999"]);
    assert!(stderr(&output).contains("ended before the power cut"), "{}", stderr(&output));
    assert_eq!(code(&rigidtap(&["simulate", "gcode/s3000.ngc", "--power-loss", "1,soon"])), 2);
}
