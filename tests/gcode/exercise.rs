//! What holds for any bytes at all. The first byte picks the dialect, the rest is the program.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

use rigidtap::control::machine::{Law, Machine};
use rigidtap::gcode::program::{Checker, Overrides};
use rigidtap::gcode::{CommandKind, Commands, Diagnostics, Dialect, Options, Text, Warnings, canonical, interpret};

/// Interprets and plans, and panics where a promise is broken.
pub(crate) fn exercise(bytes: &[u8]) {
    let Some((&pick, source)) = bytes.split_first() else { return };
    let dialect = &Dialect::ALL[usize::from(pick) % Dialect::ALL.len()];
    let options = Options { block_delete: pick >= 128, ..Options::default() };
    let program = interpret(source, dialect, options);
    let found = program.diagnostics.as_slice();
    assert!(found.len() <= 2 * (Diagnostics::LIMIT + 1));
    for found in found {
        assert!(found.span.start <= found.span.end && found.span.end <= source.len(), "{found:?}");
        assert!(found.line >= 1 && found.column >= 1);
        assert!(!found.message().is_empty() && !found.hint().is_empty());
    }
    the_same_in_pieces(source, dialect, options, &program.commands, found.len());
    if program.diagnostics.has_errors() {
        return;
    }
    let ends = program.commands.iter().filter(|command| command.kind == CommandKind::End).count();
    assert_eq!(ends, 1);
    for command in program.commands.iter().take(100) {
        assert!(!canonical(command).contains("NaN"), "{}", canonical(command));
    }
    let machine = Machine::reference();
    let mut checker = Checker::new(&machine, Law::TorqueCurve, Overrides::default(), options.start_mm);
    let mut concerns = Warnings::new(&machine, Law::TorqueCurve);
    // What repeats make is planned alike.
    for command in program.commands.iter().take(2000) {
        checker.command(command, &mut |refusal| assert!(!refusal.error.to_string().is_empty()));
        concerns.command(command, &mut |_| ());
    }
}

/// A reader that hands out a few bytes at a time.
struct Pieces<'a>(Cursor<&'a [u8]>);

impl Read for Pieces<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let length = into.len().min(7);
        self.0.read(&mut into[..length])
    }
}

impl Seek for Pieces<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

fn the_same_in_pieces(
    source: &[u8],
    dialect: &Dialect,
    options: Options,
    expected: &[rigidtap::gcode::Command],
    findings: usize,
) {
    let mut text = Text::new(Pieces(Cursor::new(source)));
    let mut commands = Commands::new(&mut text, dialect, options);
    assert!(commands.by_ref().eq(expected.iter().copied()));
    assert_eq!(commands.diagnostics().as_slice().len(), findings);
}
