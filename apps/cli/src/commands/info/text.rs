//! Descriptions of cells as text.

use super::Info;

/// The description of a single cell.
pub(super) fn table(info: &Info) -> String {
    let mut lines = vec![format!("{} ({})", info.file, info.format)];
    let mut line = |name: &str, value: &str| lines.push(format!("  {name:<10} {value}"));
    for (name, value) in info.measures.rows() {
        line(name, &value);
    }
    if let Some(sholl) = &info.sholl {
        let crossings: Vec<String> = sholl.crossings.iter().map(u64::to_string).collect();
        let spheres = format!("every {} µm: {}", sholl.step, crossings.join(" "));
        line("crossings", &spheres);
    }
    line("warnings", &info.warnings.len().to_string());
    lines.extend(between(info));
    lines.join("\n")
}

/// What lies between the samples that were asked for.
fn between(info: &Info) -> impl Iterator<Item = String> {
    info.between.iter().flat_map(|between| {
        let lines = between.lines().into_iter().enumerate();
        lines.map(|(i, line)| {
            let name = if i == 0 { "between" } else { "" };
            format!("  {name:<10} {line}")
        })
    })
}

pub(super) fn header() -> String {
    format!(
        "{:>9} {:>8} {:>8} {:>6} {:>6} {:>11} {:>11}  {:<11} {:>8}  file",
        "points",
        "sections",
        "neurites",
        "forks",
        "ends",
        "length/µm",
        "volume/µm³",
        "soma",
        "warnings"
    )
}

/// A line for one of several cells, and below it what lies between its samples.
pub(super) fn row(info: &Info) -> String {
    let m = &info.measures;
    let row = format!(
        "{:>9} {:>8} {:>8} {:>6} {:>6} {:>11.1} {:>11.1}  {:<11} {:>8}  {}",
        m.n_points,
        m.n_sections,
        m.n_neurites,
        m.n_bifurcations + m.n_multifurcations,
        m.n_ends,
        m.length,
        m.volume,
        m.soma.kind,
        info.warnings.len(),
        info.file
    );
    std::iter::once(row)
        .chain(between(info))
        .collect::<Vec<_>>()
        .join("\n")
}
