//! Where the rules are from that decide where, how deep, how fast and in which hand a hole is tapped: each with the text that was found for it, the test that holds it against the
//! control itself, or the diagnostic that tells of it because it is from memory alone.

/// Where a rule is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Manual and page, or another public text, as found.
    Text(&'static str),
    /// The control's own interpreter, or the program that the dialect is for, by this test.
    Test(&'static str),
    /// Nothing was found: this diagnostic tells of it wherever it decides something.
    Memory(&'static str),
}

/// One rule of a dialect's tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Name of the dialect.
    pub dialect: &'static str,
    /// What it says.
    pub says: &'static str,
    /// Where it is from.
    pub source: Source,
}

const fn text(dialect: &'static str, says: &'static str, found: &'static str) -> Rule {
    Rule { dialect, says, source: Source::Text(found) }
}

const fn test(dialect: &'static str, says: &'static str) -> Rule {
    let by = if matches!(dialect.as_bytes(), b"paper") { PAPER } else { RS274 };
    Rule { dialect, says, source: Source::Test(by) }
}

const fn memory(dialect: &'static str, says: &'static str, code: &'static str) -> Rule {
    Rule { dialect, says, source: Source::Memory(code) }
}

const PAPER: &str = "gcode/s3000.ngc, the torque-curve paper's program";
const RS274: &str = "tests/gcode/rs274";
const F_TAP: &str = "FANUC Series 0i/0i Mate-B, Connection Manual (Function) B-63833EN-1/02, p. 540";
const F_CYCLE: &str = "FANUC mill, G81 in a training text (zanotowane.pl/117/8692)";
const F_FORMAT: &str = "FANUC Series 15i/150i-MA, Operator's Manual (Programming) B-63324EN/03, p. 759";
const F_MODAL: &str = "FANUC Series 15i/150i-MA, Operator's Manual (Programming) B-63324EN/03, page 315 of the file";
const F_PECK: &str = "FANUC additional manual A-78549E, peck rigid tapping";
const F_LIST: &str = "FANUC Operator's Manual B-64304EN, list of G codes by group";
const F_MACRO: &str = "FANUC Operator's Manual B-64304EN, custom macro, argument specification I";
const F_POST: &str = "Autodesk's post processors for FANUC mills: M29 S, G84 P in ms, G95 and the pitch";
const F_COUNT: &str = "notes of a CNC course: M98 P52000 calls O2000 five times";
const H_1999: &str = "Haas VF Series manual 96-8000, June 1999, p. 182";
const H_246: &str = "Haas Mill Operator's Manual (NGC) 2017, p. 246, X/Y plane obstacle avoidance";
const H_385: &str = "Haas Mill Operator's Manual (NGC) 2017, p. 385, setting 77";
const H_CALL: &str = "Haas Mill Operator's Manual (NGC) 2017, section 5.10";
const H_LIST: &str = "Haas Mill Operator's Manual (NGC) 2017, lists of G and M codes";
const H_G84: &str = "Haas, G84 Tapping Canned Cycle (haascnc.com, codes and settings)";
const H_FEED: &str = "Haas, G84 Tapping Canned Cycle, AP-602 X1, April 2016, worked examples";
const S_CYCLE: &str =
    "SINUMERIK 840D/840Di/810D, Programming Guide Cycles 11.02, chapter 2 (CYCLE84; p. 2-86 for SDAC)";
const S_POST: &str = "Autodesk's post processor for the SINUMERIK 840D, 2022, CYCLE84 with 24 parameters";
const S_STROKE: &str = "Beckhoff TF5200, Tapping (G331/G332), and ISG kernel documentation";
const B_POST: &str = "Autodesk's post processor for the Brother Speedio, 2019 to 2023";
const M_FEED: &str =
    "Mitsubishi CNC API, header of the modal states: feed of synchronous tapping, parameter 1268 bit 2";
const M_POST: &str = "post processor for a Mori Seiki with a Mitsubishi control, after Autodesk's of 2016";

/// Every rule that was looked for.
pub const RULES: &[Rule] = &[
    test("paper", "G81 taps; pitch is F/S under G94, F under G95"),
    test("paper", "M03 is a right-hand thread, M04 a left-hand one"),
    test("paper", "under G91 R counts from the initial level, Z from R"),
    test("paper", "`//` begins a comment"),
    test("paper", "a block with X, Y or Z makes a hole; repeats step under G91"),
    text("fanuc", "pitch is F/S per minute, F per revolution", F_TAP),
    text("fanuc", "M29 S makes G84 rigid", F_TAP),
    text("fanuc", "units of F: 1 mm/min, 0.0001 mm/rev, 0.01 inch/min", F_TAP),
    text("fanuc", "G84 and G74 are the hands, P is in milliseconds", F_POST),
    text("fanuc", "R counts from the initial level under G91, Z from R", F_CYCLE),
    text("fanuc", "K is the number of repeats, one where it is left out", F_CYCLE),
    text("fanuc", "G98 returns to the initial level, G99 to R", F_CYCLE),
    text("fanuc", "Q is modal in a cycle, and has no sign", F_MODAL),
    text("fanuc", "a tool length said in a cycle is in force at R", F_MODAL),
    text("fanuc", "L counts repeats in the Series 15 format", F_MODAL),
    text("fanuc", "G04 X in seconds, P in milliseconds", F_FORMAT),
    text("fanuc", "G10 L2 writes work offsets, L10 to L13 tool lengths and radii", F_FORMAT),
    text("fanuc", "Q pecks by parameter 5200 bit 5: a chip break or a full retract", F_PECK),
    text("fanuc", "a chip break retracts by parameter 5213", F_PECK),
    text("fanuc", "G80 is of group 09 and G00 of group 01: the motion stays", F_LIST),
    text("fanuc", "look-ahead, cancel codes and stroke checks change no hole", F_LIST),
    text("fanuc", "letters of G65 and their variables", F_MACRO),
    text("fanuc", "G80 and then Z moves by the motion in force", F_POST),
    text("fanuc", "P52000 of M98 is O2000 five times", F_COUNT),
    memory("fanuc", "R alone makes a hole; K0 stores; the code alone stores", "G433"),
    memory("fanuc", "J is the speed of the stroke out", "G433"),
    memory("fanuc", "a rigid G74 after M03 turns by itself", "G424"),
    test("linuxcnc", "a block with X, Y or Z makes a hole; R alone is refused"),
    test("linuxcnc", "the cycle's code alone is refused"),
    test("linuxcnc", "L0 is refused"),
    test("linuxcnc", "R and Z are asked for anew by another cycle; P is kept"),
    test("linuxcnc", "levels follow G90 and G91, and the work offset, the initial level, too"),
    test("linuxcnc", "F is read before G20 and G21"),
    test("linuxcnc", "G80 ends the motion"),
    test("linuxcnc", "M6 and M19 stop the spindle"),
    test("linuxcnc", "G33.1 needs K and a turning spindle; I is of its block"),
    test("linuxcnc", "G84 and M04 contradict each other"),
    test("linuxcnc", "G10 L2 and L20, G52, G92, G92.1"),
    test("linuxcnc", "O words, names, expressions"),
    test("linuxcnc", "G43.1 Z; `$0`; M64 to M66"),
    test("linuxcnc", "at power on cycles return to R"),
    text("haas", "a block with X or Y makes a hole", H_1999),
    text("haas", "G98 returns to where the cycle began, G99 to R", H_1999),
    text("haas", "moves of a cycle in X and Y are rapids", H_1999),
    text("haas", "L0 moves X and Y alone", H_246),
    text("haas", "F10 is F0.0100", H_385),
    text("haas", "P of M98 has five digits, L repeats", H_CALL),
    text("haas", "M97 calls the blocks of a number", H_CALL),
    text("haas", "the cycle starts the spindle itself", H_G84),
    text("haas", "S is said before the cycle", H_G84),
    text("haas", "pitch is F/S", H_FEED),
    text("haas", "G110 to G129 are G154 P1 to P20", H_LIST),
    text("haas", "G174 and G184 tap from where the tool stands", H_LIST),
    text("haas", "G80 is of group 09 and G00 of group 01: the motion stays", H_LIST),
    text("haas", "M00 stops the spindle", H_LIST),
    memory("haas", "a block with Z or R alone makes no hole", "G217"),
    memory("haas", "J is how many times faster the stroke out is; Q pecks", "G433"),
    text("siemens", "RTP, RFP, SDIS, DP, DPR, DTB: levels and dwell", S_CYCLE),
    text("siemens", "SDAC: the spindle behind the cycle", S_CYCLE),
    text("siemens", "MPIT and PIT: size or pitch, its sign the hand", S_CYCLE),
    text("siemens", "POSS, SST, SST1, AXN", S_CYCLE),
    text("siemens", "a modal call makes a hole behind each block that moves", S_CYCLE),
    text("siemens", "HOLES1 and HOLES2", S_CYCLE),
    text("siemens", "PITA, TECHNO, VARI, DAM, VRT", S_POST),
    text("siemens", "GMODE, DMODE, AMODE and its digits", S_POST),
    text("siemens", "G331 Z K with the hand of K's sign", S_STROKE),
    text("siemens", "G332 keeps K and S", S_STROKE),
    memory("siemens", "a chip break with VRT of zero turns back by 1 mm", "G433"),
    text("brother", "G77 taps right-hand threads, G78 left-hand ones", B_POST),
    text("brother", "I is the pitch in mm, J the threads per inch", B_POST),
    text("brother", "S stands in the block of the cycle", B_POST),
    text("brother", "L is the speed of the stroke out", B_POST),
    text("brother", "Q pecks in G77 and G78 alone", B_POST),
    text("brother", "G100 T changes the tool with Z at its top, then X, Y and Z", B_POST),
    text("brother", "G84 and G74 have their pitch by F", B_POST),
    text("brother", "P with its point is in seconds", B_POST),
    text("brother", "M494, M495 and M400 to M403 are coolant", B_POST),
    memory("brother", "P without its point, K, and the rest as on a FANUC", "G428"),
    text("mitsubishi", "F of a synchronous cycle is the pitch under G94, too", M_FEED),
    text("mitsubishi", "an asynchronous cycle follows G94 and G95", M_FEED),
    text("mitsubishi", "G84 and G74 are the hands, P is in milliseconds, Q pecks", M_POST),
    memory("mitsubishi", "`,R1` is synchronous, E threads per inch, `,S` the speed out", "G428"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::Dialect;
    use crate::gcode::messages::explain;

    #[test]
    fn at_most_one_rule_in_ten_is_from_memory_and_none_of_them_silent() {
        let told: Vec<_> = RULES
            .iter()
            .filter_map(|rule| match rule.source {
                Source::Memory(code) => Some((rule, code)),
                Source::Text(_) | Source::Test(_) => None,
            })
            .collect();
        assert!(10 * told.len() <= RULES.len(), "{} of {}", told.len(), RULES.len());
        for (rule, code) in told {
            assert!(explain(code).is_some(), "{}: {}", rule.says, code);
        }
        for dialect in Dialect::ALL {
            assert!(RULES.iter().filter(|rule| rule.dialect == dialect.name).count() >= 4, "{}", dialect.name);
        }
        assert!(RULES.iter().all(|rule| Dialect::by_name(rule.dialect).is_some()));
    }
}
