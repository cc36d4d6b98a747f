//! Tables of Markdown, and numbers in them.

/// A table: columns of numbers are aligned on the right.
pub(crate) fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let head: Vec<String> = head.iter().map(|name| (*name).to_owned()).collect();
    let is_number = |cell: &String| {
        cell.is_empty() || cell.starts_with(|c: char| c.is_ascii_digit() || c == '–')
    };
    let sides: Vec<String> = (0..head.len())
        .map(
            |column| match rows.iter().all(|row| is_number(&row[column])) {
                true => "---:".into(),
                false => "---".into(),
            },
        )
        .collect();
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(&head) + &line(&sides) + &rows + "\n"
}

/// Three digits that mean something; `–` for nothing.
pub(crate) fn number(value: Option<f64>) -> String {
    match value {
        None => "–".into(),
        Some(value) if value.abs() >= 1000.0 => whole(Some(value.round() as u64)),
        Some(value) if value.abs() >= 100.0 => format!("{value:.0}"),
        Some(value) if value.abs() >= 10.0 => format!("{value:.1}"),
        Some(value) if value.abs() >= 0.01 || value == 0.0 => format!("{value:.2}"),
        Some(value) => format!("{value:.4}"),
    }
}

/// A count, with commas between thousands.
pub(crate) fn whole(value: Option<u64>) -> String {
    let Some(value) = value else {
        return "–".into();
    };
    let digits = value.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Bytes as MiB.
pub(crate) fn mib(bytes: Option<u64>) -> String {
    number(bytes.map(|bytes| bytes as f64 / f64::from(1 << 20)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_and_counts_commas() {
        let written = [0.0, 0.001, 0.5, 12.34, 123.4, 12345.6].map(|n| number(Some(n)));
        assert_eq!(written, ["0.00", "0.0010", "0.50", "12.3", "123", "12,346"]);
        assert_eq!(number(None), "–");
        assert_eq!(
            [5, 1000, 1_234_567].map(|n| whole(Some(n))),
            ["5", "1,000", "1,234,567"]
        );
        assert_eq!(mib(Some(3 << 19)), "1.50");
    }

    #[test]
    fn tables_are_markdown() {
        let table = table(&["a", "b"], &[vec!["x".into(), "1".into()]]);
        assert_eq!(table, "| a | b |\n| --- | ---: |\n| x | 1 |\n\n");
    }
}
