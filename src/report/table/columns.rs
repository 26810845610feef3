//! A table with ruled headings.

use comfy_table::{Cell, CellAlignment, LineStyle, Table, TableStyle};

/// A rule under the headings and nothing else: rows stay one line, so output can be searched and compared by line.
const RULED: TableStyle = TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// A table whose columns stand under their headings, numbers to the right.
pub(in crate::report) struct Columns {
    table: Table,
    text_columns: usize,
}

impl Columns {
    /// The first `text_columns` headings stand over text.
    pub(in crate::report) fn new(headings: &[&str], text_columns: usize) -> Self {
        let mut table = Table::new();
        table.load_style(RULED).set_header(
            headings
                .iter()
                .enumerate()
                .map(|(column, heading)| Cell::new(heading).set_alignment(alignment(column, text_columns))),
        );
        Self { table, text_columns }
    }

    pub(in crate::report) fn row(&mut self, cells: Vec<String>) {
        let text_columns = self.text_columns;
        self.table.add_row(
            cells
                .into_iter()
                .enumerate()
                .map(|(column, cell)| Cell::new(cell).set_alignment(alignment(column, text_columns))),
        );
    }
}

impl std::fmt::Display for Columns {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Without a terminal's width the table does not wrap; blanks at line ends would only show in diffs.
        self.table.lines().try_for_each(|line| writeln!(formatter, "{}", line.trim_end()))
    }
}

fn alignment(column: usize, text_columns: usize) -> CellAlignment {
    if column < text_columns { CellAlignment::Left } else { CellAlignment::Right }
}
