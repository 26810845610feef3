//! How wide a report may be, and the text between its tables.

use textwrap::{Options, WordSeparator, WordSplitter};

use super::columns::Columns;

/// Width where nobody says another: that of a terminal ever since.
pub const USUAL_WIDTH: usize = 80;
/// Narrower than this no table can be.
const LEAST_WIDTH: usize = 40;

/// The room that a report has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    width: usize,
    all_columns: bool,
}

impl Default for Layout {
    fn default() -> Self {
        Self::new(USUAL_WIDTH, false)
    }
}

impl Layout {
    /// Lines of so many characters, 40 at least; tables with all their columns may be wider.
    ///
    /// ```
    /// use rigidtap::report::table::Layout;
    /// assert_eq!(Layout::new(20, false).width(), 40);
    /// ```
    #[must_use]
    pub fn new(width: usize, all_columns: bool) -> Self {
        Self { width: width.max(LEAST_WIDTH), all_columns }
    }

    /// Characters of a line.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Characters of a table's line.
    pub(super) const fn table_width(&self) -> usize {
        if self.all_columns { usize::MAX } else { self.width }
    }
}

/// A report as it grows.
pub(in crate::report) struct Page {
    layout: Layout,
    text: String,
}

impl Page {
    pub(in crate::report) const fn new(layout: Layout) -> Self {
        Self { layout, text: String::new() }
    }

    /// A sentence, in as many lines as it takes; what it says after its first line is set in by two.
    pub(in crate::report) fn say(&mut self, sentence: impl AsRef<str>) -> &mut Self {
        let sentence = sentence.as_ref();
        let blanks = sentence.len() - sentence.trim_start().len();
        let indent = " ".repeat(blanks + 2);
        let options = Options::new(self.layout.width)
            .initial_indent(&indent[..blanks])
            .subsequent_indent(&indent)
            .break_words(false)
            .word_separator(WordSeparator::AsciiSpace)
            .word_splitter(WordSplitter::NoHyphenation);
        self.text += &textwrap::fill(sentence.trim_start(), options);
        self.text.push('\n');
        self
    }

    /// A line that stays one.
    pub(in crate::report) fn verbatim(&mut self, text: &str) -> &mut Self {
        self.text += text;
        self
    }

    pub(in crate::report) fn blank(&mut self) -> &mut Self {
        self.text.push('\n');
        self
    }

    /// A table, with the names of the columns that there is no room for.
    pub(in crate::report) fn table(&mut self, table: &Columns) -> &mut Self {
        let (shown, left_out) = table.fitted(self.layout.table_width());
        self.text += &shown;
        if !left_out.is_empty() {
            self.say(format!("--wide adds: {}", left_out.join(", ")));
        }
        self
    }

    pub(in crate::report) fn finish(&mut self) -> String {
        std::mem::take(&mut self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_wrap_at_words_and_keep_their_indent() {
        let mut page = Page::new(Layout::new(40, false));
        page.say("  worst: run 7, torque-curve-smooth, 12.00 µm, backlash 2.0 µm");
        assert_eq!(page.finish(), "  worst: run 7, torque-curve-smooth,\n    12.00 µm, backlash 2.0 µm\n");
    }
}
