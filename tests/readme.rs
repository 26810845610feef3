//! What the README and the guide show is what the program prints and draws. `BLESS=1 cargo test --test readme` rewrites both.

use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Pages whose tables are what the program prints.
const PAGES: [&str; 2] = ["README.md", "src/guide/results.md"];

/// What a command line of a page prints.
fn printed(command: &str) -> String {
    let arguments = command.strip_prefix("rigidtap ").expect("a command of ours").split_whitespace();
    let output =
        assert_cmd::Command::cargo_bin("rigidtap").unwrap().current_dir(root()).args(arguments).output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{command}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// A page with the output of every `$ rigidtap` command as it is now. A command may go on in the next line after a \.
fn as_it_should_be(page: &str) -> String {
    let mut fresh = String::new();
    let mut rest = page;
    while let Some((before, block)) = rest.split_once("```console\n$ ") {
        let (body, after) = block.split_once("```\n").expect("the block ends");
        let mut lines = 1;
        while body.lines().nth(lines - 1).expect("a command").ends_with('\\') {
            lines += 1;
        }
        let command: Vec<_> = body.lines().take(lines).collect();
        let answer = printed(&command.join("\n").replace("\\\n", " "));
        fresh += &format!("{before}```console\n$ {}\n{answer}```\n", command.join("\n"));
        rest = after;
    }
    fresh + rest
}

fn held(path: PathBuf, fresh: &str) {
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, fresh).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == fresh, "{} is not what the program says now", path.display());
}

#[test]
fn the_tables() {
    for page in PAGES {
        let path = root().join(page);
        let kept = std::fs::read_to_string(&path).unwrap();
        assert!(kept.contains("```console\n$ "), "{page} has a table");
        held(path, &as_it_should_be(&kept));
    }
}

/// What fits the first screens of a browser and of a terminal.
#[test]
fn the_readme_is_short() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    assert!(readme.lines().count() <= 150);
    let wide: Vec<_> = readme.lines().filter(|line| line.chars().count() > 100).collect();
    assert!(wide.is_empty(), "wider than 100 columns: {wide:#?}");
}

/// Every file that the README links is there.
#[test]
fn the_readmes_links_lead_somewhere() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    let targets: Vec<_> = readme.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(targets.len() > 10);
    for target in targets.iter().filter(|target| !target.starts_with('#') && !target.contains("://")) {
        assert!(root().join(target).exists(), "{target}");
    }
}

#[test]
fn the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = folder.path().join("error.svg");
    let programs = "gcode/s3000.ngc gcode/s5000.ngc gcode/s7000.ngc";
    let laws = "--laws s-curve,torque-curve --compensations none";
    printed(&format!("rigidtap compare {programs} {laws} --plot {}", drawn.display()));
    held(root().join("tests/readme/error.svg"), &std::fs::read_to_string(drawn).unwrap());
}

/// What the motor's share costs and gains: e(k) over it, with the stroke's time over minimum.
#[test]
fn the_trade_off() {
    let shares = "0.6,0.65,0.7,0.75,0.8,0.85,0.9,0.95";
    let laws = format!("--laws torque-curve-smooth --shares {shares}");
    let answer = printed(&format!("rigidtap compare gcode/s7000.ngc {laws} --compensations none,full --format json"));
    let answer: serde_json::Value = serde_json::from_str(&answer).unwrap();
    let entries = answer["programs"][0]["laws"].as_array().unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let line = |compensation: &str, value: &dyn Fn(&serde_json::Value) -> f64| -> Vec<(f64, f64)> {
        let of = entries.iter().filter(|entry| entry["compensation"] == compensation);
        of.map(|entry| (number(&entry["share"]), value(entry))).collect()
    };
    let error_um = |entry: &serde_json::Value| {
        number(&entry["error_um"]["peak_to_peak"]).max(number(&entry["true_error_um"]["peak_to_peak"]))
    };
    let over_bound = |entry: &serde_json::Value| number(&entry["stroke_over_bound"]);
    let [none, full] = ["none", "full"].map(|compensation| line(compensation, &error_um));
    let time = line("full", &over_bound);
    held(root().join("tests/readme/share.svg"), &trade_off(&none, &full, &time));
}

fn trade_off(none: &[(f64, f64)], full: &[(f64, f64)], time: &[(f64, f64)]) -> String {
    use plotters::prelude::*;
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (900, 420)).into_drawing_area();
        area.fill(&WHITE).unwrap();
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(54)
            .right_y_label_area_size(54)
            .build_cartesian_2d(0.58..0.97, 0.0..40.0)
            .unwrap()
            .set_secondary_coord(0.58..0.97, 1.0..1.4);
        chart.configure_mesh().x_desc("torque utilisation").y_desc("e(k), peak to peak, µm").draw().unwrap();
        chart.configure_secondary_axes().y_desc("stroke time over minimum").draw().unwrap();
        let (grey, blue, red) = (RGBColor(120, 120, 120), RGBColor(0, 90, 181), RGBColor(200, 60, 20));
        for (points, colour, name) in [(none, grey, "uncompensated"), (full, blue, "model-based compensation (full)")] {
            let line = PathElement::new(points.to_vec(), colour.stroke_width(2));
            let label = chart.draw_series([line]).unwrap().label(name);
            label.legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(2)));
        }
        let line = PathElement::new(time.to_vec(), red.stroke_width(2));
        let label = chart.draw_secondary_series([line]).unwrap().label("stroke time over minimum (right)");
        label.legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], red.stroke_width(2)));
        chart
            .configure_series_labels()
            .border_style(grey)
            .background_style(WHITE)
            .position(SeriesLabelPosition::MiddleRight)
            .draw()
            .unwrap();
        area.present().unwrap();
    }
    svg
}

/// The README's first screen names the test command that CI calls.
#[test]
fn ci_calls_the_readmes_test_command() {
    let [readme, ci] = ["README.md", ".ci/run"].map(|name| std::fs::read_to_string(root().join(name)).unwrap());
    assert!(readme.contains("\ncargo test\n") && ci.contains("step cargo test\n"));
}
