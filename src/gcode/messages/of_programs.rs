//! Words about the program as a whole.

use super::kind::DiagnosticKind as K;
use crate::gcode::text::Decimal;

/// Message and hint of a finding in the program as a whole; none of any other finding.
pub(super) fn words(kind: &K) -> Option<(String, String)> {
    let (message, hint): (String, &str) = match *kind {
        K::LabelMissing { number } => {
            (format!("there is no block N{} in this program", Decimal(number)), "GOTO names a block's number")
        }
        K::ProgramMissing { program } => (
            format!("there is no program O{program} in this file, and no file of this number beside it"),
            "put the subprogram behind M30, begun by its O and ended by M99, or in a file O1000.nc of its folder or of --subprograms",
        ),
        K::SubMissing => (
            "there is no subprogram of this name in this file, and no file of this name beside it".into(),
            "define it, o100 sub … o100 endsub, here or in a file of its name in the folder or in --subprograms",
        ),
        K::PlaneNotExact { why } => {
            (format!("{why} is not read under G16 or G68"), "say G15 or G69 before, or write the positions themselves")
        }
        K::AngleNeedsPoint { letter } => (
            format!("{} is an angle without its decimal point", char::from(letter)),
            "some controls count thousandths of a degree: write 30. for 30°",
        ),
        K::CallWithoutProgram { name } => (format!("{name} calls no program"), "P is its number: M98 P1000"),
        K::LoopOpen => (
            "this has no partner".into(),
            "WHILE has its END, while its endwhile, if its endif, sub its endsub, with the same number",
        ),
        K::TooDeep { limit } => {
            return Some((
                format!("more than {limit} calls or loops inside each other"),
                "does the subprogram call itself?".into(),
            ));
        }
        K::TooManySteps { limit } => {
            return Some((
                format!("more than {limit} blocks run again: this loop does not seem to end"),
                "does its condition ever change?".into(),
            ));
        }
        K::EmptyProgram => ("the program is empty: there is no word in it".into(), "is this the right file?"),
        K::NoProgramEnd => (
            "the program does not end: neither M30 nor M02, nor a closing '%'".into(),
            "end it with M30, so that a cut file is noticed",
        ),
        K::TextAfterEnd => {
            ("this stands after the program's end and is not read".into(), "delete it, or move M30 or '%' behind it")
        }
        K::TooManyCommands { limit } => (
            format!("repeats make more than {limit} commands"),
            "are the repeats meant? Split the program where they are",
        ),
        K::TooMany { severity, limit } => (
            format!("more than {limit} {}s: the rest is not shown", severity.name()),
            "mend the first ones and check again",
        ),
        K::ProgramNotCalled { program } => (
            format!("O{program} stands behind the end and is never called: it is not run"),
            "give it as a file of its own if it is another program",
        ),
        K::ProgramAmbiguous { program } => (
            format!("P{program} may be that program, or its last four digits and a count: both are in the file"),
            "rename one of them, or count by L",
        ),
        K::CallCountsTwice => (
            "both P and L say how often the program runs".into(),
            "P of four digits is the program, L the count: M98 P0001 L3",
        ),
        K::CallRepeatsBad { repeats } => (
            format!("a program cannot be run {} times", Decimal(repeats)),
            "L is a whole number from 1 to 9999; leave the block out where it is not to run",
        ),
        K::LooksLike { name } => (
            format!("this looks like a program for another control: {name}"),
            "give its dialect, --dialect or [gcode] dialect in the machine file; heidenhain is not read",
        ),
        _ => return None,
    };
    Some((message, hint.into()))
}
