//! Nothing that a block says vanishes: every letter and every code of every dialect, added to a block that taps, changes
//! the commands, is an error, or is reported.

use crate::gcode::{CodeName, Dialect, Interpretation, Options, canonical, interpret};

/// A program that taps one hole, in two parts: what is tried is added between them.
fn tapping(dialect: &Dialect) -> [&'static str; 2] {
    match dialect.name {
        "paper" => ["G21 G90 S500 M3 F500.\nG0 X0. Y0. Z20.\nG81 X1. Y2. Z-10. R2. ", "\nG80 G0 Z30.\nM30\n"],
        "linuxcnc" => ["G21 G90 S500 M3 F500.\nG0 X0. Y0. Z20.\nG84 X1. Y2. Z-10. R2. ", "\nG0 Z30.\nM2\n"],
        "brother" => ["G21 G90 G54\nG0 X0. Y0. Z20.\nG77 X1. Y2. Z-10. R2. S500 F500. ", "\nG80\nG0 Z30.\nM30\n"],
        "mitsubishi" => ["G21 G90 G54\nG0 X0. Y0. Z20.\nG84 X1. Y2. Z-10. R2. S500 F1. ,R1 ", "\nG80\nG0 Z30.\nM30\n"],
        "siemens" => ["G71 G90 S500 M3 F99\nG0 X0 Y0 Z2\nG331 Z-10 K1 S500 ", "\nG332 Z2\nG1 Z30\nM30\n"],
        _ => ["G21 G90 G54\nG0 X0. Y0. Z20.\nM29 S500\nG84 X1. Y2. Z-10. R2. F500. ", "\nG80\nG0 Z30.\nM30\n"],
    }
}

fn run(dialect: &Dialect, added: &str) -> Interpretation {
    let [before, after] = tapping(dialect);
    let before = if dialect.name == "haas" { before.replace("M29 ", "") } else { before.to_owned() };
    interpret(format!("{before}{added}{after}").as_bytes(), dialect, Options::default())
}

/// A letter with a number; four of them stand behind a comma.
fn word(letter: u8) -> String {
    match letter {
        b'[' => ",R3.5".to_owned(),
        b'\\' => ",S3.5".to_owned(),
        b']' => ",I3.5".to_owned(),
        b'^' => ",J3.5".to_owned(),
        letter => format!("{}3.5", char::from(letter)),
    }
}

/// Whether nothing at all came of it.
fn vanishes(dialect: &Dialect, added: &str) -> bool {
    let (plain, with) = (run(dialect, ""), run(dialect, added));
    assert!(!plain.diagnostics.has_errors(), "{}: {:?}", dialect.name, plain.diagnostics);
    let text = |run: &Interpretation| run.commands.iter().map(canonical).collect::<Vec<_>>();
    text(&plain) == text(&with) && plain.diagnostics.as_slice().len() == with.diagnostics.as_slice().len()
}

#[test]
fn no_word_of_a_tapping_block_vanishes() {
    for dialect in Dialect::ALL {
        let gone: Vec<_> = (b'A'..=b'^')
            .filter(|letter| !b"GMN".contains(letter))
            .filter(|&letter| vanishes(dialect, &word(letter)))
            .map(char::from)
            .collect();
        assert!(gone.is_empty(), "{}: {gone:?} vanish", dialect.name);
    }
}

/// What only says again what is in force, or what holds always, changes nothing and need not be reported: the plane, the
/// unit, the modes in force, no radius and no length compensation, corners, and the end of the block's own cycle.
const SAYS_WHAT_HOLDS: &[&str] = &[
    "G9", "G17", "G21", "G40", "G43", "G49", "G54", "G60", "G61", "G61.1", "G62", "G63", "G64", "G71", "G90", "G94",
    "G97", "G98", "G99", "G331", "G450", "G451", "G601", "G602", "G603", "G641", "G642", "G643", "G644", "G645",
    "G710", "G15", "G69", "M29", "M03",
];

#[test]
fn no_code_in_a_tapping_block_vanishes() {
    for dialect in Dialect::ALL {
        let g = dialect.g_codes.iter().chain(dialect.more_g_codes).map(|(tenths, _)| (b'G', *tenths));
        let m = dialect.m_codes.iter().map(|(tenths, _)| (b'M', *tenths));
        let gone: Vec<_> = g
            .chain(m)
            .map(|(letter, tenths)| CodeName { letter, tenths }.to_string())
            .filter(|name| !SAYS_WHAT_HOLDS.contains(&name.as_str()))
            // F is the pitch under G94 and G95 alike.
            .filter(|name| !(dialect.cycle.feed_is_pitch && name == "G95"))
            .filter(|name| vanishes(dialect, name))
            .collect();
        assert!(gone.is_empty(), "{}: {gone:?} vanish", dialect.name);
    }
}

/// Each parameter of CYCLE84, given another value: the hole is another, or it is refused or reported.
#[test]
fn no_parameter_of_cycle84_vanishes() {
    let hole = |parameters: &[&str]| {
        let source = format!("G90 G0 X0 Y0 Z20 S500 M3\nCYCLE84({})\nG1 F100 Z30\nM30\n", parameters.join(","));
        let program = interpret(source.as_bytes(), &Dialect::SIEMENS, Options::default());
        let text: Vec<_> = program.commands.iter().map(canonical).collect();
        (text, program.diagnostics.as_slice().len())
    };
    let plain = [
        "20", "0", "2", "-15", "", "0", "3", "", "1", "0", "500", "500", "0", "1", "0", "0", "0", "0", "", "", "", "0",
        "0", "2",
    ];
    assert_eq!(hole(&plain).1, 0, "{:?}", hole(&plain));
    for index in 0..plain.len() {
        // Three texts of the screen: what the control itself does not read.
        if (18..21).contains(&index) {
            continue;
        }
        let mut other = plain;
        other[index] = "4";
        assert_ne!(hole(&other), hole(&plain), "parameter {}", index + 1);
    }
}
