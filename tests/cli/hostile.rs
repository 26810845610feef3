//! What others wrote: names and words that command a terminal, files that are far too large, readings that cannot be.

use super::*;

/// A name that turns a terminal red, rings, goes back, begins a line, and turns the direction of writing.
#[cfg(unix)]
const NAME: &str = "a\u{1b}[31m\u{7}\u{8}\r\nerror: b\u{9b}2J\u{7f}\u{202e}c";

#[cfg(unix)]
fn assert_printable(output: &Output, arguments: &[&str]) {
    for stream in [&output.stdout, &output.stderr] {
        let shown = String::from_utf8(stream.clone()).unwrap();
        let wrong = shown.chars().find(|c| (c.is_control() && !matches!(c, '\n' | '\t')) || *c == '\u{202e}');
        assert_eq!(wrong, None, "{arguments:?}\n{}", shown.escape_debug());
        assert!(!shown.lines().any(|line| line.starts_with("error: b")), "{arguments:?}\n{shown}");
    }
}

#[cfg(unix)]
#[test]
fn no_name_and_no_word_reaches_the_terminal_raw() {
    let folder = tempfile::tempdir().unwrap();
    let program = file(&folder, &format!("{NAME}.ngc"), ONE_HOLE);
    let (program, trace) = (text(&program), folder.path().join(format!("{NAME}.csv")));
    let (plot, trace) = (folder.path().join(format!("{NAME}.svg")), text(&trace));
    let plot = text(&plot);
    let bad = file(&folder, &format!("bad{NAME}.ngc"), format!("G90 (a\u{1b}[31m)\nG77 {NAME}\n").as_bytes());
    let toml = file(&folder, "m.toml", "[spindle]\n\"max\\u001b[31m\\nrpm\" = 1\n'\u{9b}' = 2\n".as_bytes());
    let table = file(&folder, &format!("t{NAME}.txt"), format!("0.1 0.2\n0.1 {NAME}\n").as_bytes());
    let absent = format!("{NAME}.absent");
    let into_nothing = format!("none{NAME}/t.csv");
    let map = format!("spindle={NAME}[rev],z=b[mm]");
    let runs: &[(&[&str], i32)] = &[
        (&["check", program], 0),
        (&["check", program, "--canon"], 0),
        (&["check", program, "--format", "json"], 0),
        (&["check", text(&bad)], 1),
        (&["check", text(&bad), "--format", "json"], 1),
        (&["check", &absent], 1),
        (&["check", "--explain", NAME], 2),
        (&["check", program, "--machine", text(&toml)], 1),
        (&["check", program, "--dialect", NAME], 2),
        (&["plan", program], 0),
        (&["plan", program, "--plot", plot], 0),
        (&["simulate", program, "--trace", trace, "--plot", plot], 0),
        (&["simulate", program, "--format", "json"], 0),
        (&["simulate", program, "--trace", &into_nothing], 1),
        (&["simulate", program, "--trace", program], 2),
        (&["simulate", program, "--tap", NAME], 2),
        (&["simulate", program, "--fault", NAME], 2),
        (&["simulate", program, &format!("--{NAME}")], 2),
        (&[NAME], 2),
        (&["compare", program, "--laws", "linear", "--plot", plot], 0),
        (&["compare", program, "--laws", "linear", "--format", "json"], 0),
        (&["compare", program, "--laws", NAME], 2),
        (&["sweep", program, "--runs", "1", "--plot", plot], 0),
        (&["tune", "--identify", trace], 0),
        (&["tune", "--identify", text(&table)], 1),
        (&["tune", "--run-up", text(&table)], 1),
        (&["monitor", trace, "--plot", plot], 0),
        (&["monitor", trace, "--format", "json"], 0),
        (&["monitor", text(&table)], 1),
        (&["monitor", trace, "--map", &map], 1),
        (&["monitor", "--serial", &absent, "--pitch", "1"], 1),
        (&["schema", NAME], 2),
        (&["man", NAME], 2),
    ];
    for (arguments, due) in runs {
        let output = rigidtap(arguments);
        assert_eq!(code(&output), *due, "{arguments:?}\n{}", stderr(&output).escape_debug());
        assert_printable(&output, arguments);
        if arguments.contains(&"json") {
            serde_json::from_str::<serde_json::Value>(&stdout(&output)).unwrap();
        }
        if arguments.contains(&"--plot") {
            let drawn = std::fs::read_to_string(plot).unwrap();
            assert!(!drawn.chars().any(|c| c.is_control() && !matches!(c, '\n' | '\t')), "{arguments:?}");
        }
    }
    // Colours of the program's own stay.
    let coloured = stderr(&rigidtap(&["check", text(&bad), "--color", "always"]));
    assert!(coloured.contains('\u{1b}') && !coloured.contains("\u{1b}[31m\u{7}") && !coloured.contains('\u{9b}'));
}

/// In so much address space the program itself runs, and nothing that is kept of the file.
#[cfg(target_os = "linux")]
fn in_little_memory(arguments: &[&str]) -> Output {
    const KIB: u32 = 60_000;
    std::process::Command::new("sh")
        .args(["-c", &format!("ulimit -v {KIB}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_rigidtap")])
        .args(arguments)
        .output()
        .unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_recording_of_any_length_and_width_is_read_in_little_memory() {
    use std::io::Write;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.txt");
    let write = |write: &dyn Fn(&mut dyn Write)| {
        let mut file = std::io::BufWriter::new(std::fs::File::create(&path).unwrap());
        write(&mut file);
        file.flush().unwrap();
    };
    // One line of 80 MB: a single field, and 20 million of them.
    write(&|file| (0..80_000).for_each(|_| file.write_all(&[b'1'; 1000]).unwrap()));
    let output = in_little_memory(&["monitor", text(&path)]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).contains("long.txt:1:1: neither a trace"), "{}", stderr(&output));
    write(&|file| (0..80_000).for_each(|_| file.write_all("0.1 ".repeat(250).as_bytes()).unwrap()));
    let output = in_little_memory(&["monitor", text(&path), "--pitch", "1"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).contains("no hole found"), "{}", stdout(&output));
    // Two million rows at rest.
    write(&|file| {
        for k in 0..2_000_000 {
            writeln!(file, "{k} 0.100000 5.000000 17 18 19").unwrap();
        }
    });
    let output = in_little_memory(&["monitor", text(&path), "--pitch", "1"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).contains("2000000 readings every 1.000 ms"), "{}", stdout(&output));
    // The same from a pipe that cannot be read twice.
    let piped = std::process::Command::new("sh")
        .args(["-c", "ulimit -v 60000; cat \"$1\" | \"$0\" monitor - --pitch 1"])
        .args([env!("CARGO_BIN_EXE_rigidtap"), text(&path)])
        .output()
        .unwrap();
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(words(&stdout(&piped).replace("<stdin>", text(&path))), words(&stdout(&output)));
}

#[test]
fn a_corrupt_reading_is_told_and_ends_with_code_3() {
    let folder = tempfile::tempdir().unwrap();
    let trace = folder.path().join("t.csv");
    let written = with_stdin(&["simulate", "-", "--trace", text(&trace)], ONE_HOLE);
    assert_eq!((code(&written), code(&rigidtap(&["monitor", text(&trace)]))), (0, 0));
    let good = std::fs::read_to_string(&trace).unwrap();
    let column = good.lines().next().unwrap().split(',').position(|name| name == "z_encoder_counts").unwrap();
    let line = good.lines().position(|line| line.split(',').nth(4) == Some("in")).unwrap() + 40;
    let mut lines: Vec<String> = good.lines().map(str::to_owned).collect();
    let mut fields: Vec<&str> = lines[line].split(',').collect();
    fields[column] = "-2147483648";
    lines[line] = fields.join(",");
    std::fs::write(&trace, lines.join("\n")).unwrap();
    let (plot, again) = (folder.path().join("e.svg"), folder.path().join("again.csv"));
    let output = rigidtap(&["monitor", text(&trace), "--plot", text(&plot), "--trace", text(&again)]);
    assert_eq!(code(&output), 3, "{}", stdout(&output));
    let shown = stdout(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    let place = format!("t.csv:{}, column {}: z_encoder_counts is -2147483648, ", line + 1, column + 1);
    assert!(shown.contains("CORRUPT: 1 readings cannot be, and no hole passes"), "{shown}");
    assert!(shown.contains(&place) && shown.contains("z.max_mm_per_s, z.force_limit_n"), "{place} in {shown}");
    assert!(std::fs::read_to_string(&plot).unwrap().contains("no hole passes"));
    let output = rigidtap(&["monitor", text(&trace), "--format", "json"]);
    let found = json(&output);
    assert_eq!((code(&output), &found["holes"][0]["verdict"]), (3, &"corrupt".into()));
    let told = &found["link"]["first_corrupt"][0];
    assert_eq!(
        (&found["link"]["corrupt"], &told["line"], &told["value"]),
        (&1.into(), &(line + 1).into(), &"-2147483648".into())
    );
}
