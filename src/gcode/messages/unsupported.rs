//! What well-known codes and words mean elsewhere, and what to write here in their place.

use crate::gcode::dialect::CodeName;

/// How each dialect taps.
const RIGID: &str = "the rigid tap is G81 after M03 or M04 (paper), G84 and G74 (fanuc, haas, linuxcnc), G33.1 (linuxcnc), \
                     G331 with G332 (siemens)";

/// Letter, first and last of the codes in tenths, what to do.
const CODES: &[(u8, u16, u16, &str)] = &[
    (b'G', 20, 39, "arcs are not read: tapping programs move straight, by G0 and G1"),
    (b'G', 40, 40, "a dwell at the bottom of the hole is P in the G81 block, in milliseconds; leave G4 out"),
    (b'G', 100, 100, "offsets cannot be written from the program: move the coordinates instead"),
    (b'G', 180, 190, "holes are tapped along Z: G17 is the only plane"),
    (b'G', 280, 300, "reference points are not known here: move by G0 to the position itself"),
    (b'G', 330, 339, RIGID),
    (b'G', 410, 420, "cutter radius compensation has no use in tapping: take it out, G40 may stay"),
    (b'G', 430, 439, "tool length is taken as zero: take G43 and its H out, Z is the tap's tip"),
    (b'G', 440, 449, "tool length is taken as zero: take G44 and its H out, Z is the tap's tip"),
    (b'G', 530, 530, "there is one coordinate system: move by G0"),
    (b'G', 541, 549, "work offsets are G54 to G59; in linuxcnc up to G59.3"),
    (b'G', 591, 593, "work offsets are G54 to G59; in linuxcnc up to G59.3"),
    (b'G', 630, 630, "G63 taps in a floating holder: write G331 with G332, or CYCLE84"),
    (b'G', 610, 640, "path modes have no meaning here: leave it out"),
    (b'G', 650, 670, "macro calls are read in fanuc, haas, brother and mitsubishi: G65 P n with its arguments"),
    (b'G', 740, 740, RIGID),
    (b'G', 840, 849, RIGID),
    (b'G', 730, 890, "holes are tapped, or drilled by G81: no other canned cycle is read"),
    (b'G', 160, 160, "polar coordinates are not read: write X and Y"),
    (b'G', 680, 689, "turned coordinates are not read: write the turned positions"),
    (b'G', 510, 511, "scaled and mirrored coordinates are not read: write the positions themselves"),
    (b'G', 660, 661, "modal macro calls are not read: call each by G65"),
    (b'G', 960, 960, "constant surface speed is a lathe's: S is in rpm, G97"),
    (b'G', 920, 929, "coordinates cannot be shifted: write positions in one system"),
    (b'G', 930, 930, "F is a speed by G94 or a pitch by G95"),
    (b'G', 960, 970, "spindle speed is S in rpm: leave it out"),
    (b'G', 3310, 3320, RIGID),
    (b'M', 0, 10, "stops for the operator have no meaning in a simulation: leave it out"),
    (b'M', 60, 60, "one program is one tap: leave tool changes out"),
    (b'M', 70, 90, "coolant changes nothing here: leave it out"),
    (b'M', 190, 190, "the cycle orients and stops the spindle itself: leave it out"),
    (b'M', 290, 290, "the tapping cycle is always rigid here: leave M29 out"),
    (b'M', 480, 520, "overrides are not set from the program: leave it out"),
    (b'M', 970, 970, "M97 is a Haas's: take --dialect haas, or make the blocks a program and call it by M98"),
    (b'M', 980, 990, "subprograms by number are read in fanuc, haas, brother and mitsubishi; O words in linuxcnc"),
    (b'M', 130, 140, "builders use it for the spindle with coolant: write M03 or M04, and M08"),
];

/// Words that other controls read.
const WORDS: &[(u8, &str)] = &[
    (b'A', "there are three axes: X, Y and Z"),
    (b'B', "there are three axes: X, Y and Z"),
    (b'C', "there are three axes: X, Y and Z"),
    (b'D', "compensation has no use in tapping: leave D out"),
    (b'E', "threads per inch is a Mitsubishi's E; here the pitch is F by G95, or F = pitch × S by G94"),
    (b'H', "tool length is taken as zero: leave H out"),
    (b'I', "arcs are not read: leave it out"),
    (b'J', "the stroke out has the speed of the stroke in: leave J out"),
    (b'O', "program numbers and O words are not read: delete it or put it in a comment, (O1000)"),
    (b'Q', "the hole is tapped in one stroke, without pecks: leave Q out"),
    (b'T', "one program is one tap: leave tool numbers out"),
    (b'U', "there are three axes: X, Y and Z; incremental is G91"),
    (b'V', "there are three axes: X, Y and Z; incremental is G91"),
    (b'W', "there are three axes: X, Y and Z; incremental is G91"),
];

/// What to write in place of a code that the dialect does not have; none for codes nobody knows.
pub(crate) fn code_hint(name: CodeName) -> Option<&'static str> {
    let fits = |&&(letter, first, last, _): &&(u8, u16, u16, &str)| {
        letter == name.letter && (first..=last).contains(&name.tenths)
    };
    CODES.iter().find(fits).map(|&(.., hint)| hint)
}

/// What to write in place of a word that the dialect does not have.
pub(crate) fn word_hint(letter: u8) -> Option<&'static str> {
    WORDS.iter().find(|&&(known, _)| known == letter).map(|&(_, hint)| hint)
}
