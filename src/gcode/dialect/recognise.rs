//! Which control a line was written for, by what no other of them writes.

/// What stands in a line, in upper case and without blanks, and the dialect that reads it.
const MARKS: &[(&[u8], &str)] = &[
    (b"CYCLE8", "siemens"),
    (b"MCALL", "siemens"),
    (b"SUPA", "siemens"),
    (b"=IC(", "siemens"),
    (b"=AC(", "siemens"),
    (b"G331", "siemens"),
    (b"_MPF", "siemens"),
    (b"G33.1", "linuxcnc"),
    (b"#<", "linuxcnc"),
    (b",R1", "mitsubishi"),
    (b"G77", "brother"),
    (b"G187", "haas"),
    (b"G154", "haas"),
    (b"M97", "haas"),
    (b"M29", "fanuc"),
    (b"G54.1", "fanuc"),
    (b"G84.2", "fanuc"),
    (b"BEGINPGM", "heidenhain"),
    (b"CYCLDEF", "heidenhain"),
    (b"TOOLCALL", "heidenhain"),
];

/// The dialect that a line looks like, and what shows it.
///
/// ```
/// use rigidtap::gcode::looks_like;
/// assert_eq!(looks_like(b"MCALL CYCLE84(20,0,2,-15)"), Some(("siemens", "CYCLE8")));
/// assert_eq!(looks_like(b"G84 X1. Z-10. R2."), None);
/// ```
#[must_use]
pub fn looks_like(line: &[u8]) -> Option<(&'static str, &'static str)> {
    let mut text: Vec<u8> =
        line.iter().take(200).filter(|b| !b.is_ascii_whitespace()).map(u8::to_ascii_uppercase).collect();
    // What stands in a comment says nothing.
    if let Some(start) = text.iter().position(|&b| b == b';') {
        text.truncate(start);
    }
    let found = MARKS.iter().find(|(mark, _)| text.windows(mark.len()).any(|window| window == *mark));
    found.map(|&(mark, name)| (name, std::str::from_utf8(mark).unwrap_or_default()))
}
