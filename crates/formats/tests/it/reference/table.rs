//! The tables of reference values.

use std::path::Path;

/// A table with a header, as rows of fields by column.
pub(crate) struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).expect("the table is readable");
        let split = |line: &str| line.split('\t').map(str::to_owned).collect();
        let mut lines = text.lines().map(split);
        Self {
            columns: lines.next().expect("a header"),
            rows: lines.collect(),
        }
    }

    /// Rows whose first column satisfies the test, each as a function of the column's name.
    pub(crate) fn rows<'a>(
        &'a self,
        test: impl Fn(&str) -> bool + 'a,
    ) -> impl Iterator<Item = impl Fn(&str) -> &'a str> {
        self.rows
            .iter()
            .filter(move |row| test(&row[0]))
            .map(move |row| {
                move |column: &str| {
                    let index = self
                        .columns
                        .iter()
                        .position(|c| c == column)
                        .expect("the column");
                    row.get(index).map_or("", String::as_str)
                }
            })
    }
}
