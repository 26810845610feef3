//! `--report`: one page with nothing beside it, whose numbers are the answer's.

use serde_json::Value;

use super::*;

/// Each subcommand that writes a page, with words that keep it short.
const PAGES: [&[&str]; 4] = [
    &["simulate", "-"],
    &["compare", "-", "--laws", "linear,torque-curve"],
    &["sweep", "-", "--runs", "5"],
    &["advise", "-", "--runs", "4", "--laws", "linear", "--control", "mitsubishi", "--compensation", "full"],
];

fn page(words: &[&str], path: &Path) -> (String, Value) {
    let output = with_stdin(&[words, &["--report", text(path), "--format", "json", "-q"]].concat(), ONE_HOLE);
    (std::fs::read_to_string(path).unwrap(), json(&output))
}

/// What stands between two marks.
fn between<'t>(page: &'t str, start: &str, end: &str) -> &'t str {
    page.split_once(start).and_then(|(_, rest)| rest.split_once(end)).map_or("", |(found, _)| found)
}

#[test]
fn the_page_holds_the_answer_and_needs_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    for words in PAGES {
        let (page, answer) = page(words, &folder.path().join("out.html"));
        let embedded: Value = serde_json::from_str(between(&page, "id=\"answer\">", "</script>")).unwrap();
        assert_eq!(embedded, answer, "{words:?}");
        let foreign: Vec<_> =
            ["src=", "href=", "@import", "fetch("].into_iter().filter(|word| page.contains(word)).collect();
        assert!(foreign.is_empty(), "{words:?}: {foreign:?}");
        assert!(page.contains("seed 1") && page.contains(&format!("rigidtap {}", words[0])), "{words:?}");
    }
}

#[test]
fn the_tables_numbers_are_those_of_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    let (page, answer) = page(PAGES[0], &folder.path().join("out.html"));
    let hole = &answer["programs"][0]["holes"][0];
    let cells: Vec<_> =
        between(&page, "<tbody><tr>", "</tr>").split("</td>").map(|cell| cell.trim_start_matches("<td>")).collect();
    let um = |value: &Value| format!("{:.1}", value.as_f64().unwrap());
    assert_eq!(cells[1], hole["verdict"]);
    assert_eq!(cells[4], um(&hole["error_um"]["peak_to_peak"]));
    assert_eq!(cells[5], um(&hole["true_error_um"]["peak_to_peak"]));
    assert_eq!(cells[6], um(&hole["tolerance_um"]));
    assert_eq!(cells[7], um(&hole["bottom_overshoot_um"]));
    let charts: Value = serde_json::from_str(between(&page, "id=\"charts\">", "</script>")).unwrap();
    let measured = &charts[0][0]["charts"][0]["series"][0]["y"];
    let values: Vec<f64> = measured.as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    let width = values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min);
    assert!(
        (width - hole["error_um"]["peak_to_peak"].as_f64().unwrap()).abs() < 1e-3,
        "every period is drawn: {width}"
    );
}

#[test]
fn a_page_has_its_own_ending_and_is_whole_or_not_there() {
    let output = with_stdin(&["simulate", "-", "--report", "page.pdf"], ONE_HOLE);
    assert_eq!(code(&output), 2);
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "old.html", b"old");
    assert_eq!(code(&with_stdin(&["simulate", "-", "--report", text(&path)], b"G0 Q1\nM30\n")), 1);
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
}

/// A recording of the simulated machine, judged with a page.
fn monitor_page(folder: &tempfile::TempDir) -> (String, Value) {
    let (trace, path) = (folder.path().join("trace.csv"), folder.path().join("monitor.html"));
    assert_eq!(code(&with_stdin(&["simulate", "-", "--trace", text(&trace)], ONE_HOLE)), 0);
    let output = with_stdin(&["monitor", text(&trace), "--report", text(&path), "--format", "json", "-q"], b"");
    (std::fs::read_to_string(path).unwrap(), json(&output))
}

#[test]
fn the_page_of_a_recording_holds_its_answer_and_draws_each_reading() {
    let folder = tempfile::tempdir().unwrap();
    let (page, answer) = monitor_page(&folder);
    let embedded: Value = serde_json::from_str(between(&page, "id=\"answer\">", "</script>")).unwrap();
    assert_eq!(embedded, answer);
    assert!(page.contains("rigidtap monitor") && page.contains("1 hole of pitch 1 mm"), "{answer}");
    let hole = &answer["holes"][0];
    assert_eq!(between(&page, "id=\"verdict\">", "</span>"), hole["verdict"]);
    let charts: Value = serde_json::from_str(between(&page, "id=\"charts\">", "</script>")).unwrap();
    let titles: Vec<_> =
        charts[0][0]["charts"].as_array().unwrap().iter().map(|chart| chart["title"].as_str().unwrap()).collect();
    assert!(titles[0].contains("tolerance") && titles[1].starts_with("Spindle") && titles[2].starts_with('Z'));
    let drawn = charts[0][0]["charts"][0]["series"][0]["y"].as_array().unwrap();
    let values: Vec<f64> = drawn.iter().filter_map(Value::as_f64).collect();
    let width = values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min);
    assert!((width - hole["error_um"]["peak_to_peak"].as_f64().unwrap()).abs() < 1e-3, "{width}");
    // The mean speed over 10 ms comes near the peak of the strokes.
    let speeds = charts[0][0]["charts"][1]["series"][0]["y"].as_array().unwrap();
    let peak = speeds.iter().filter_map(Value::as_f64).fold(0.0, f64::max);
    let told = hole["strokes"].as_array().unwrap().iter().map(|stroke| stroke["peak_rpm"].as_f64().unwrap());
    let told = told.fold(0.0, f64::max);
    assert!((0.97..1.01).contains(&(peak / told)), "{peak} of {told}");
}

/// In a real browser, named by `RIGIDTAP_BROWSER`: the script draws every figure and reports no error. `.ci/browser` sets it.
#[test]
fn a_browser_draws_the_figures() {
    let Some(browser) = std::env::var_os("RIGIDTAP_BROWSER") else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut pages: Vec<_> = PAGES
        .iter()
        .zip(1..)
        .map(|(words, number)| {
            let path = folder.path().join(format!("{number}.html"));
            (words[0], page(words, &path).0, path)
        })
        .collect();
    pages.push(("monitor", monitor_page(&folder).0, folder.path().join("monitor.html")));
    for (name, page, path) in pages {
        let arguments = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--virtual-time-budget=4000",
            "--enable-logging=stderr",
            "--dump-dom",
        ];
        let shown = std::process::Command::new(&browser)
            .args(arguments)
            .arg(format!("file://{}", text(&path)))
            .output()
            .unwrap();
        let (dom, log) = (String::from_utf8_lossy(&shown.stdout), String::from_utf8_lossy(&shown.stderr));
        assert!(!log.contains("CONSOLE"), "{name}: {log}");
        let charts: Value = serde_json::from_str(between(&page, "id=\"charts\">", "</script>")).unwrap();
        let drawn: usize =
            charts.as_array().unwrap().iter().map(|sets| sets[0]["charts"].as_array().unwrap().len()).sum();
        assert_eq!(dom.matches("<svg").count(), drawn, "{name}");
        assert!(dom.contains("class=\"data\"") || dom.contains("fill=\"var(--s0)\""), "{name}");
    }
}
