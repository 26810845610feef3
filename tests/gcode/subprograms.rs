//! Subprograms in files of their own.

use rigidtap::gcode::{Commands, Dialect, Options, Subprograms, Text, canonical};

/// Files by their names.
#[derive(Debug)]
struct Files(&'static [(&'static str, &'static str)]);

impl Files {
    fn get(&self, name: &str) -> Option<(String, Vec<u8>)> {
        let (name, text) = self.0.iter().find(|(known, _)| *known == name)?;
        Some(((*name).to_owned(), text.as_bytes().to_vec()))
    }
}

impl Subprograms for Files {
    fn numbered(&mut self, number: u32) -> Option<(String, Vec<u8>)> {
        self.get(&number.to_string())
    }

    fn named(&mut self, name: &str) -> Option<(String, Vec<u8>)> {
        self.get(name)
    }
}

/// Canonical text, and each diagnostic with its file and its line there. Two readings are the same.
fn run(dialect: &Dialect, program: &str, files: &'static [(&'static str, &'static str)]) -> (Vec<String>, Vec<String>) {
    let mut text = Text::of(program.as_bytes()).with_subprograms(Box::new(Files(files)));
    let mut read = || {
        let mut commands = Commands::new(&mut text, dialect, Options::default());
        let texts: Vec<_> = commands.by_ref().map(|command| canonical(&command)).collect();
        let found = commands.diagnostics().clone();
        (texts, found)
    };
    let (texts, found) = read();
    assert_eq!(read().0, texts);
    let place = |offset| text.subprogram(offset).map_or("", |(name, ..)| name).to_owned();
    let found = found.as_slice().iter();
    (texts, found.map(|d| format!("{}:{} {}", place(d.span.start), d.line, d.code())).collect())
}

const HEAD: &str = "G90 G94 G21\nM29 S1000\nG0 X0. Y0. Z10.\n";

#[test]
fn a_program_of_another_file_runs_as_if_it_stood_behind_this_one() {
    let program = format!("{HEAD}G99 G84 X0. Z-9. R2. F1000.\nM98 P7 L2\nM98 P8\nG80\nM30\n");
    let (texts, found) = run(
        &Dialect::HAAS,
        &program,
        &[("7", "%\nO00007 (ROW)\nG91 X5. L2\nG90\nM99\n%\n"), ("8", "N1 X50.\nM98 P7\nM99")],
    );
    let at: Vec<_> = texts.iter().filter_map(|text| text.split_once(" r=").map(|(start, _)| start)).collect();
    assert_eq!(
        at,
        [
            "4 tap x=0 y=0",
            "3 tap x=5 y=0",
            "3 tap x=10 y=0",
            "3 tap x=15 y=0",
            "3 tap x=20 y=0",
            "1 tap x=50 y=0",
            "3 tap x=55 y=0",
            "3 tap x=60 y=0"
        ]
    );
    assert_eq!(found, [":2 G201", ":2 G517"], "M29 is no Haas's");
}

#[test]
fn what_is_wrong_in_another_file_is_told_there() {
    let program = format!("{HEAD}G84 X0. Z-9. R2. F1000.\nM98 P0007\nG80\nM98 P9\nM30\n");
    let (_, found) = run(&Dialect::FANUC, &program, &[("7", "O0007\n\nX5. Q\nM99\n")]);
    assert_eq!(found, [":4 G412", "7:3 G102", ":7 G506"]);
}

#[test]
fn a_count_before_the_number_finds_the_file_of_its_last_four_digits() {
    let program = format!("{HEAD}G84 X0. Z-9. R2. F1000.\nM98 P30007\nG80\nM30\n");
    let (texts, _) = run(&Dialect::FANUC, &program, &[("7", "O0007\nG91 X5.\nG90\nM99\n")]);
    assert_eq!(texts.iter().filter(|text| text.contains("tap")).count(), 4);
    let (_, found) = run(&Dialect::FANUC, &program, &[("7", "O7\nM99\n"), ("30007", "O30007\nM99\n")]);
    assert!(found.contains(&":5 G514".to_owned()), "{found:?}");
}

#[test]
fn linuxcnc_finds_a_subprogram_by_its_name() {
    let program = "G90 G21\nS500 M3\no<row> call [10] [3]\no100 call\nM2\n";
    const ROW: &str = "o<row> sub\nG0 X#1 Y0 Z5\no101 repeat [#2]\nG33.1 Z-5 K1\nG91 G0 X#1\nG90\no101 endrepeat\no<row> endsub\nM2\n";
    let (texts, found) = run(&Dialect::LINUXCNC, program, &[("row", ROW), ("100", "o100 sub\nG0 X0\no100 endsub\n")]);
    assert_eq!(texts.iter().filter(|text| text.contains("tap")).count(), 3, "{texts:?}");
    assert_eq!(found, Vec::<String>::new());
}

/// MCALL makes a hole behind every block of the subprograms, too; RET, M17 and M30 return, and P counts.
#[test]
fn a_sinumerik_finds_a_subprogram_by_its_name() {
    let program = "G71 G90 G54 G17\nG0 X0 Y0 Z20\nMCALL CYCLE84(20,0,2,-15,,0,5,,1.25,0,500,500)\nL10 P2\nTAPROW\nL010\n\
                   taprow P2\nMCALL\nX99\nM30\n";
    let files = &[
        ("L10", "G91 X10\nG90\nM17\nX999\n"),
        ("L010", "X1\nM30\n"),
        ("TAPROW", "%_N_TAPROW_SPF\nPROC TAPROW\nX50 Y5 ; the first\nL10\nRET\n"),
    ];
    let (texts, found) = run(&Dialect::SIEMENS, program, files);
    let at: Vec<_> = texts.iter().filter_map(|text| text.split_once(" r=").map(|(start, _)| start)).collect();
    let row = ["3 tap x=50 y=5", "1 tap x=60 y=5"];
    let expected = [&["1 tap x=10 y=0", "1 tap x=20 y=0"], &row, &["1 tap x=1 y=5"][..], &row, &row].concat();
    assert_eq!(at, expected);
    assert_eq!(texts.last().map(String::as_str), Some("10 end"));
    assert_eq!(found, Vec::<String>::new());
}

/// What is wrong in a subprogram is told there; one that calls itself ends in an error.
#[test]
fn a_sinumeriks_subprograms_have_their_faults_told() {
    let program = "G71 G90 G54\nG0 X0 Y0 Z20\nL1\nL2\nL3\nM30\n";
    let files = &[("L1", "X1\nX\nM17\n"), ("L2", "L2\nM17\n")];
    let (_, found) = run(&Dialect::SIEMENS, program, files);
    assert_eq!(found, ["L1:2 G102", "L2:1 G510", ":5 G212"]);
}

#[test]
fn files_that_call_each_other_for_ever_end_in_an_error() {
    let program = format!("{HEAD}M98 P7\nM30\n");
    let (_, found) = run(&Dialect::FANUC, &program, &[("7", "O7\nM98 P8\nM99\n"), ("8", "O8\nM98 P7\nM99\n")]);
    assert!(found.iter().any(|found| found.ends_with("G510")), "{found:?}");
}

/// GOTO looks in its own file alone.
#[test]
fn numbers_of_blocks_are_of_their_own_file() {
    let program = format!("{HEAD}M98 P7\nN5 G0 X1.\nM30\n");
    let (texts, found) = run(&Dialect::FANUC, &program, &[("7", "O7\nGOTO 5\nG0 X99.\nN5 G0 X7.\nM99\n")]);
    assert!(texts.iter().any(|text| text.contains("x=7 ")) && !texts.iter().any(|text| text.contains("x=99")));
    assert_eq!(found, Vec::<String>::new());
}
