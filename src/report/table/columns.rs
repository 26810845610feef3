//! A table with ruled headings, which leaves out columns where there is no room for all.

use comfy_table::{Cell, CellAlignment, LineStyle, Table, TableStyle};
use textwrap::core::display_width;

/// A rule under the headings and nothing else: rows stay one line, so output can be searched and compared by line.
const RULED: TableStyle = TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));
/// Blanks between two columns.
const GAP: usize = 2;
/// No text is cut shorter than this.
const LEAST_TEXT: usize = 8;

/// One column: its heading, which side its cells keep to, and how well the table does without it.
#[derive(Clone, Copy, Debug)]
pub(in crate::report) struct Column {
    heading: &'static str,
    alignment: CellAlignment,
    rank: u8,
}

/// A column of text, to the left. Rank 0 is always there; the greatest goes first, all its columns at once.
pub(in crate::report) const fn text(heading: &'static str, rank: u8) -> Column {
    Column { heading, alignment: CellAlignment::Left, rank }
}

/// A column of numbers, to the right.
pub(in crate::report) const fn number(heading: &'static str, rank: u8) -> Column {
    Column { heading, alignment: CellAlignment::Right, rank }
}

/// A table whose columns stand under their headings.
pub(in crate::report) struct Columns {
    columns: Vec<Column>,
    rows: Vec<Vec<String>>,
}

impl Columns {
    pub(in crate::report) fn new(columns: &[Column]) -> Self {
        Self { columns: columns.to_vec(), rows: Vec::new() }
    }

    /// Adds a row with one cell for each column.
    pub(in crate::report) fn row(&mut self, cells: Vec<String>) {
        debug_assert_eq!(cells.len(), self.columns.len(), "one cell for each column");
        self.rows.push(cells);
    }

    /// The table in lines of at most so many characters, and the headings that it goes without. Where the columns that
    /// are always there are still too wide, the longest text is cut at its beginning, so that a path shows its end.
    pub(super) fn fitted(&self, width: usize) -> (String, Vec<&'static str>) {
        let mut widths: Vec<usize> = self.columns.iter().map(|column| display_width(column.heading)).collect();
        for row in &self.rows {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = (*width).max(display_width(cell));
            }
        }
        let mut kept: Vec<usize> = (0..self.columns.len()).collect();
        let total = |kept: &[usize], widths: &[usize]| {
            kept.iter().map(|index| widths[*index]).sum::<usize>() + GAP * kept.len().saturating_sub(1)
        };
        while total(&kept, &widths) > width {
            let least_needed = kept.iter().map(|index| self.columns[*index].rank).max().unwrap_or(0);
            if least_needed == 0 {
                break;
            }
            kept.retain(|index| self.columns[*index].rank < least_needed);
        }
        let excess = total(&kept, &widths).saturating_sub(width);
        let texts = kept.iter().copied().filter(|index| self.columns[*index].alignment == CellAlignment::Left);
        let longest = texts.max_by_key(|index| widths[*index]).filter(|_| excess > 0);
        let cut = longest.map(|index| (index, widths[index].saturating_sub(excess).max(LEAST_TEXT)));
        let left_out = (0..self.columns.len()).filter(|index| !kept.contains(index));
        (self.drawn(&kept, cut), left_out.map(|index| self.columns[index].heading).collect())
    }

    fn drawn(&self, kept: &[usize], cut: Option<(usize, usize)>) -> String {
        let mut table = Table::new();
        let aligned = |index: usize, content: &str| Cell::new(content).set_alignment(self.columns[index].alignment);
        table.load_style(RULED).set_header(kept.iter().map(|index| aligned(*index, self.columns[*index].heading)));
        for row in &self.rows {
            table.add_row(kept.iter().map(|index| match cut {
                Some((long, width)) if long == *index => aligned(*index, &end_of(&row[*index], width)),
                _ => aligned(*index, &row[*index]),
            }));
        }
        for column in table.column_iter_mut() {
            // A separator's blank comes beside it.
            column.set_padding((0, GAP as u16 - 1));
        }
        // Blanks at line ends would only show in diffs, and the rule is as long as the row it is under.
        let mut text = String::new();
        for line in table.lines() {
            let ruled = line.starts_with('─');
            let line = if ruled { line.trim_end().strip_suffix('─').unwrap_or(&line) } else { line.trim_end() };
            text += line;
            text.push('\n');
        }
        text
    }
}

/// The end of a text in so many characters, an ellipsis before it where it is cut.
fn end_of(text: &str, width: usize) -> String {
    if display_width(text) <= width {
        return text.to_owned();
    }
    let starts = text.char_indices().map(|(at, _)| &text[at..]);
    starts.into_iter().find(|rest| display_width(rest) < width).map_or_else(String::new, |rest| format!("…{rest}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Columns {
        let mut table = Columns::new(&[text("program", 0), number("p-p µm", 1), number("rms", 2)]);
        table.row(vec!["a/long/path/to/part.ngc".into(), "1.5".into(), "0.5".into()]);
        table.row(vec!["b.ngc".into(), "12.5".into(), "3.5".into()]);
        table
    }

    #[test]
    fn the_highest_ranks_go_first_and_are_named() {
        let widest = |width: usize| {
            let (shown, left_out) = table().fitted(width);
            (shown.lines().map(display_width).max().unwrap(), left_out)
        };
        assert_eq!(widest(usize::MAX), (36, vec![]));
        assert_eq!(widest(36), (36, vec![]));
        assert_eq!(widest(35), (31, vec!["rms"]));
        assert_eq!(widest(30), (23, vec!["p-p µm", "rms"]));
        assert_eq!(widest(12), (12, vec!["p-p µm", "rms"]));
    }

    #[test]
    fn a_path_that_is_cut_shows_its_end() {
        let (shown, _) = table().fitted(12);
        assert_eq!(shown, "program\n────────────\n…to/part.ngc\nb.ngc\n");
    }
}
