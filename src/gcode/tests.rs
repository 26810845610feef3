//! The interpreter as a whole, where a golden program cannot show it.

mod nothing_vanishes;

use super::*;

fn holes(source: &str) -> Vec<crate::control::cycle::TapCycle> {
    let program = interpret(source.as_bytes(), &Dialect::PAPER, Options::default());
    assert!(!program.diagnostics.has_errors(), "{:?}", program.diagnostics);
    let tap = |command: &Command| match command.kind {
        CommandKind::Tap(hole) => Some(hole),
        _ => None,
    };
    program.commands.iter().filter_map(tap).collect()
}

#[test]
fn the_papers_program_taps_its_21_holes() {
    let holes = holes(include_str!("../../gcode/s3000.ngc"));
    assert_eq!(holes.len(), 21);
    for (index, hole) in holes.iter().enumerate() {
        assert_eq!((hole.x_mm, hole.y_mm), (7.0 * index as f64, 0.0));
        assert_eq!((hole.r_plane_mm, hole.bottom_mm, hole.return_mm), (15.0, -10.0, 15.0));
        assert_eq!((hole.pitch_mm, hole.speed_rpm, hole.out_speed_rpm), (1.0, 3000.0, 3000.0));
    }
}

#[test]
fn repeats_do_not_drift() {
    let holes = holes("M3S1000F1000 G0Z10\nG91G81X.1Y-.7Z-5R-8L9999\nM2");
    let last = holes.last().expect("holes");
    assert!((last.x_mm - 999.9).abs() < 1e-9);
    assert!((last.y_mm + 6999.3).abs() < 1e-9);
}

#[test]
fn a_line_of_100_mb_is_one_error() {
    let source = vec![b'X'; 100_000_000];
    let program = interpret(&source, &Dialect::PAPER, Options::default());
    let codes: Vec<_> = program.diagnostics.as_slice().iter().map(Diagnostic::code).collect();
    assert_eq!(codes, ["G112", "G502"]);
}

#[test]
fn a_hundred_errors_are_enough() {
    let program = interpret(&b"Q1\n".repeat(5000), &Dialect::PAPER, Options::default());
    let shown = program.diagnostics.as_slice();
    assert_eq!(shown.len(), Diagnostics::LIMIT + 2);
    assert_eq!(shown.get(Diagnostics::LIMIT).map(|d| (d.code(), d.line)), Some(("G504", 101)));
    assert_eq!(program.diagnostics.error_count(), 5000);
}

#[test]
fn columns_count_characters_and_spans_bytes() {
    let program = interpret("G0 (Länge) Q1\nM30".as_bytes(), &Dialect::PAPER, Options::default());
    let found = program.diagnostics.as_slice()[0];
    assert_eq!((found.line, found.column, found.span), (1, 12, Span { start: 12, end: 14 }));
}

#[test]
fn options_of_the_dialect() {
    let drill = Dialect { g81: G81::Drill, ..Dialect::PAPER };
    let source = b"G0X0Y0Z10\nG91G81X5Z-7R-8F60K2\nM30";
    let text: Vec<_> = interpret(source, &drill, Options::default()).commands.iter().map(canonical).collect();
    let expected = [
        "1 rapid x=0 y=0 z=10",
        "2 rapid x=5 y=0 z=10",
        "2 rapid x=5 y=0 z=2",
        "2 feed x=5 y=0 z=-5 f=60",
        "2 rapid x=5 y=0 z=10",
        "2 rapid x=10 y=0 z=10",
        "2 rapid x=10 y=0 z=2",
        "2 feed x=10 y=0 z=-5 f=60",
        "2 rapid x=10 y=0 z=10",
        "3 end",
    ];
    assert_eq!(text, expected);

    let fanuc = Dialect { decimal_point: DecimalPoint::Fanuc, ..Dialect::PAPER };
    let program = interpret(b"G0 X10 Y10. Z0\nG20 Z10\nG95 F1\nM30", &fanuc, Options::default());
    let text: Vec<_> = program.commands.iter().map(canonical).collect();
    assert_eq!(text, ["1 rapid x=0.01 y=10 z=0", "2 rapid x=0.01 y=10 z=0.0254", "4 end"]);
    let codes: Vec<_> = program.diagnostics.as_slice().iter().map(Diagnostic::code).collect();
    assert_eq!(codes, ["G308", "G308", "G304"]);
}

#[test]
fn block_delete_is_a_switch() {
    let source = b"/G0X1\nG0X2\nM30";
    let count = |block_delete| {
        interpret(source, &Dialect::PAPER, Options { block_delete, ..Options::default() }).commands.len()
    };
    assert_eq!((count(false), count(true)), (3, 2));
}

#[test]
fn nothing_follows_a_binary_file() {
    let program = interpret(b"\x7fELF\x02\x01\x01\0\0\0G0\0\nQ1\nQ2\0", &Dialect::PAPER, Options::default());
    assert_eq!(program.diagnostics.as_slice().last().map(Diagnostic::code), Some("G113"));
}

#[test]
fn a_jump_is_an_error_where_lines_come_one_by_one() {
    let mut interpreter = Interpreter::new(&Dialect::FANUC, Options::default());
    let mut diagnostics = Diagnostics::new();
    for line in lines(b"#1=2\nIF [#1 EQ 2] THEN #2=3\nG0 X#2\nGOTO 1\nM30") {
        interpreter.block(line, &mut |_| (), &mut diagnostics);
    }
    let found: Vec<_> = diagnostics.as_slice().iter().map(|d| (d.code(), d.line)).collect();
    assert_eq!(found, [("G115", 4)]);
}

#[test]
fn every_dialect_reads_any_statements_without_panic() {
    use proptest::prelude::*;
    const PIECES: &[&str] = &[
        "o1",
        "O2",
        " sub",
        " endsub",
        " call",
        " if",
        " else",
        " elseif",
        " endif",
        " while",
        " endwhile",
        " do",
        " repeat",
        " endrepeat",
        " break",
        " continue",
        "[",
        "]",
        "#1",
        "#<a>",
        "=",
        "1",
        "2",
        " EQ ",
        "**",
        "/",
        "-",
        "ATAN",
        "IF",
        "WHILE",
        "GOTO",
        "DO1",
        "END1",
        "N1",
        "M98P2",
        "M99",
        "G84",
        "Z-5",
        "R2",
        "X",
        "Q1",
        "F100",
        "S100",
        "M3",
        "G331",
        "G332",
        "K1",
        "CYCLE84",
        "(",
        ")",
        ",",
        "MCALL",
        "\n",
        "\n",
        "\n",
        "G10",
        "L2",
        "P1",
    ];
    let pieces = prop::collection::vec(prop::sample::select(PIECES), 0..60);
    proptest!(ProptestConfig::with_cases(400), |(pieces in pieces)| {
        let source = pieces.concat();
        for dialect in Dialect::ALL {
            let program = interpret(source.as_bytes(), dialect, Options::default());
            for found in program.diagnostics.as_slice() {
                prop_assert!(found.span.start <= found.span.end && found.span.end <= source.len(), "{found:?}");
                prop_assert!(!found.message().is_empty() && !found.hint().is_empty());
            }
        }
    });
}

/// Bytes that programs are made of, so that chance reaches the deep states.
fn likely_bytes() -> impl proptest::strategy::Strategy<Value = Vec<u8>> {
    use proptest::prelude::*;
    const WORDS: &[&str] =
        &["G0", "G81", "G91", "G95", "G20", "M3", "M5", "S100", "F2", "X1", "Y-.5", "Z-9", "R2", "K3", "P5", "\n"];
    const ODD: &[&str] =
        &["%", "/", "//", "(", ")", ";", "M30", "X1e9", "NaN", "#1", "G", "\u{e4}", "\r", "[", "N1", "X99999999999"];
    let piece = prop_oneof![4 => prop::sample::select(WORDS), 1 => prop::sample::select(ODD)];
    prop::collection::vec(piece.prop_map(str::as_bytes), 0..60).prop_map(|pieces| pieces.concat())
}

/// Holds for every input: places lie in the source, and an end there is.
fn check_any(source: &[u8]) {
    let program = interpret(source, &Dialect::PAPER, Options::default());
    for found in program.diagnostics.as_slice() {
        assert!(found.span.start <= found.span.end && found.span.end <= source.len(), "{found:?}");
        assert!(found.line >= 1 && found.column >= 1);
        assert!(!found.message().is_empty() && !found.hint().is_empty());
    }
    let ends = program.commands.iter().filter(|command| command.kind == CommandKind::End).count();
    assert!(ends == 1 || program.diagnostics.has_errors());
}

proptest::proptest! {
    #[test]
    fn any_bytes_are_read_without_panic(source: Vec<u8>) {
        check_any(&source);
    }

    #[test]
    fn any_words_are_read_without_panic(source in likely_bytes()) {
        check_any(&source);
    }
}

/// T selects a tool, M06 puts it in; without any M06 T alone does.
#[test]
fn holes_have_the_tool_that_is_in_the_spindle() {
    let tools = |text: &str| {
        let program = interpret(text.as_bytes(), &Dialect::FANUC, Options::default());
        assert!(!program.diagnostics.has_errors(), "{:?}", program.diagnostics);
        let tool = |command: &Command| match command.kind {
            CommandKind::Tap(hole) => Some(hole.tool),
            _ => None,
        };
        program.commands.iter().filter_map(tool).collect::<Vec<_>>()
    };
    let hole = "M29 S1000\nG84 X0 Y0 R2. Z-10. F1000\nG80\n";
    let changed = format!("G90 G54\nT3 M06\nM03 S1000\nT7\n{hole}M06\nM03 S1000\n{hole}M30\n");
    assert_eq!(tools(&changed), [3, 7]);
    assert_eq!(tools(&format!("G90 G54\nM03 S1000\nT5\n{hole}M30\n")), [5]);
    assert_eq!(tools(&format!("G90 G54\nM03 S1000\n{hole}M30\n")), [0]);
}
