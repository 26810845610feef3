//! Diagnostics for people: the line, a caret under the word, what is wrong and what to do.

use std::collections::BTreeMap;
use std::io::{Read, Seek};
use std::ops::Range;

use ariadne::{Config, IndexType, Label, Report, ReportKind, Source};

use super::printable::{is_command, printable};
use crate::config::ConfigDiagnostic;
use crate::gcode::{Diagnostic, Severity, Text};

/// Longest line shown, in bytes: longer ones would fill the terminal.
const LONGEST_LINE: usize = 400;

/// Last line drawn: ariadne keeps 32 bytes for each line before.
const LAST_LINE: u32 = 200_000;

/// Each diagnostic with its place as `file:line:column`, and its line with a caret. Of lines that are very long only
/// the place; those that are very far down stand there without a caret. Bytes that are no printable text show as `?`.
///
/// ```
/// use rigidtap::gcode::{Dialect, Options, Text, interpret};
/// use rigidtap::report::diagnostics::render;
/// let source = b"G0 X1 Q5\nM30\n";
/// let program = interpret(source, &Dialect::PAPER, Options::default());
/// let text = render("part.ngc", &mut Text::of(source), program.diagnostics.as_slice(), false);
/// assert!(text.contains("part.ngc:1:7") && text.contains("G0 X1 Q5"));
/// ```
#[must_use]
pub fn render<R: Read + Seek>(file_name: &str, text: &mut Text<R>, diagnostics: &[Diagnostic], color: bool) -> String {
    let findings = diagnostics.iter().map(|found| Finding {
        severity: found.severity(),
        code: Some(found.code()),
        line: found.line,
        column: found.column,
        span: found.span.range(),
        message: found.message(),
        hint: found.hint(),
    });
    render_findings(file_name, text, &findings.collect::<Vec<_>>(), color)
}

/// The same for a machine file.
#[must_use]
pub fn render_machine_file(file_name: &str, source: &[u8], diagnostics: &[ConfigDiagnostic], color: bool) -> String {
    let findings = diagnostics.iter().map(|found| Finding {
        severity: found.severity(),
        code: None,
        line: u32::try_from(found.line).unwrap_or(u32::MAX),
        column: u32::try_from(found.column).unwrap_or(u32::MAX),
        span: found.span.clone(),
        message: found.message(),
        hint: found.hint().unwrap_or_else(|| "here".into()),
    });
    // Their spans count in the text as it was read.
    let text = String::from_utf8_lossy(source);
    render_findings(file_name, &mut Text::of(text.as_bytes()), &findings.collect::<Vec<_>>(), color)
}

/// A diagnostic of either kind of file.
struct Finding {
    severity: Severity,
    code: Option<&'static str>,
    line: u32,
    column: u32,
    span: Range<usize>,
    message: String,
    hint: String,
}

fn render_findings<R: Read + Seek>(file_name: &str, text: &mut Text<R>, findings: &[Finding], color: bool) -> String {
    let file_name = &*printable(file_name);
    let excerpt = Excerpt::new(text, findings);
    let text = Source::from(excerpt.text.as_str());
    let mut rendered = Vec::new();
    for (index, finding) in findings.iter().enumerate() {
        if index > 0 {
            rendered.push(b'\n');
        }
        let shown = excerpt.place(finding);
        let kind = match finding.severity {
            Severity::Error => ReportKind::Error,
            Severity::Warning => ReportKind::Warning,
        };
        let config = Config::new().with_color(color).with_index_type(IndexType::Byte);
        let span = (file_name, shown.clone().unwrap_or_default());
        let mut report =
            Report::build(kind, span.clone()).with_config(config).with_message(printable(&finding.message));
        if let Some(code) = finding.code {
            report = report.with_code(code);
        }
        if shown.is_some() {
            report = report.with_label(Label::new(span).with_message(printable(&finding.hint)));
        }
        // Writing to memory does not fail.
        let _ = report.finish().write((file_name, &text), &mut rendered);
        if shown.is_none() {
            let place = format!("   {file_name}:{}:{}: {}\n", finding.line, finding.column, printable(&finding.hint));
            rendered.extend_from_slice(place.as_bytes());
            if let Some(line) = excerpt.late.get(&finding.line) {
                rendered.extend_from_slice(format!("   {line}\n").as_bytes());
            }
        }
    }
    String::from_utf8_lossy(&rendered).into_owned()
}

/// The source with every line that no diagnostic concerns left blank, so that line numbers hold and size does not.
struct Excerpt {
    text: String,
    /// By line number: offset in the source, offset here, length in bytes.
    lines: BTreeMap<u32, (usize, usize, usize)>,
    /// Lines too far down to be in the text.
    late: BTreeMap<u32, String>,
}

impl Excerpt {
    fn new<R: Read + Seek>(source: &mut Text<R>, findings: &[Finding]) -> Self {
        let mut wanted: Vec<_> = findings.iter().map(|finding| finding.line).collect();
        wanted.sort_unstable_by(|left, right| right.cmp(left));
        wanted.dedup();
        let mut excerpt = Self { text: String::new(), lines: BTreeMap::new(), late: BTreeMap::new() };
        source.for_each(|line| {
            let shown = wanted.pop_if(|number| *number == line.number).is_some() && line.text.len() <= LONGEST_LINE;
            if line.number > LAST_LINE {
                if shown {
                    push_printable(excerpt.late.entry(line.number).or_default(), line.text);
                }
                return !wanted.is_empty();
            }
            if shown {
                excerpt.lines.insert(line.number, (line.offset, excerpt.text.len(), line.text.len()));
                push_printable(&mut excerpt.text, line.text);
            }
            excerpt.text.push('\n');
            !wanted.is_empty()
        });
        excerpt
    }

    /// Where the diagnostic's bytes are in the excerpt; none if its line is not shown. Never outside: ariadne drops
    /// such a label silently.
    fn place(&self, finding: &Finding) -> Option<Range<usize>> {
        let &(offset, shown, length) = self.lines.get(&finding.line)?;
        let [start, end] =
            [finding.span.start, finding.span.end].map(|at| shown + at.saturating_sub(offset).min(length));
        Some(start..end.max(start))
    }
}

/// Appends text without control characters and line ends, byte for byte as long and character for character.
fn push_printable(text: &mut String, line: &[u8]) {
    for chunk in line.utf8_chunks() {
        text.extend(chunk.valid().chars().map(|c| match c {
            '\t' => c,
            // ariadne would begin a new line at some of these.
            c if c.is_control() && c.len_utf8() == 1 => '?',
            c if c.is_control() => '·',
            c if is_command(c) => '\u{FFFD}',
            c => c,
        }));
        text.extend(chunk.invalid().iter().map(|_| '?'));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::{Dialect, Options, interpret};

    fn rendered(source: &[u8]) -> String {
        let program = interpret(source, &Dialect::PAPER, Options::default());
        render("part.ngc", &mut Text::of(source), program.diagnostics.as_slice(), false)
    }

    #[test]
    fn line_caret_and_hint() {
        let source = b"M03\n\nG0X0Y0Z10\nG91G81X0Z-25R5 (L\xE4nge) F1e3\nM30";
        let expected = "\
[G307] Warning: M03 turns nothing yet: there is no S
   ╭─[ part.ngc:1:1 ]
   │
 1 │ M03
   │ ─┬─
   │  ╰─── say S in the same block: M03 S3000
───╯

[G105] Error: the number after F has an exponent
   ╭─[ part.ngc:4:24 ]
   │
 4 │ G91G81X0Z-25R5 (L?nge) F1e3
   │                        ──┬─
   │                          ╰─── G-code has no exponents: write all digits, 1500 for 1.5e3
───╯
";
        let found: String = rendered(source).lines().map(|line| line.trim_end().to_owned() + "\n").collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn odd_bytes_keep_their_place() {
        for source in
            [&b"\xFF\x85\xB0 Q1"[..], "\u{2028}\u{85}\u{7f} Q1".as_bytes(), b"\x0B\x0C Q1", b"\xEF\xBB\xBFG0 Q1"]
        {
            let program = interpret(source, &Dialect::PAPER, Options::default());
            let text = rendered(source);
            for d in program.diagnostics.as_slice() {
                assert!(text.contains(&format!("part.ngc:{}:{} ", d.line, d.column)), "{text}");
            }
        }
    }

    #[test]
    fn long_lines_show_their_place_only() {
        let text = rendered(&b"G0 ".repeat(1000));
        assert!(text.len() < 40_000 && text.contains("part.ngc:1:4: "));
        assert!(rendered(b"").contains("part.ngc:1:1"));
    }

    #[test]
    fn late_lines_show_without_a_caret() {
        let mut source = b"\n".repeat(1_000_001);
        source.extend_from_slice(b"G0 Q1\nM30");
        let text = rendered(&source);
        assert!(text.contains("part.ngc:1000002:4: ") && text.ends_with("\n   G0 Q1\n"), "{text}");
    }

    proptest::proptest! {
        #[test]
        fn any_bytes_are_shown_without_panic(source: Vec<u8>) {
            rendered(&source);
        }
    }
}
