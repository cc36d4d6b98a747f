//! Descriptions of cells as text.

use super::Info;
use crate::report::count;

/// The description of a single cell.
pub(super) fn table(info: &Info) -> String {
    let m = &info.measures;
    let mut lines = vec![format!("{} ({})", info.file, info.format)];
    let mut line = |name: &str, value: String| lines.push(format!("  {name:<10} {value}"));
    line(
        "points",
        format!(
            "{} in {} of {}",
            m.n_points,
            count(m.n_sections, "section"),
            count(m.n_neurites, "neurite")
        ),
    );
    line(
        "forks",
        format!(
            "{} with 2 children, {} with more; {}; branch order up to {}",
            m.n_bifurcations,
            m.n_multifurcations,
            count(m.n_ends, "end"),
            m.max_branch_order
        ),
    );
    line("length", format!("{:.1} µm", m.length));
    let by_type = [
        ("axon", m.length_by_type.axon),
        ("basal", m.length_by_type.basal_dendrite),
        ("apical", m.length_by_type.apical_dendrite),
        ("other", m.length_by_type.other),
    ];
    for (kind, length) in by_type.into_iter().filter(|&(_, length)| length > 0.0) {
        line("", format!("{kind:<7} {length:.1} µm"));
    }
    line("area", format!("{:.1} µm²", m.area));
    line("volume", format!("{:.1} µm³", m.volume));
    line(
        "soma",
        match m.soma.kind {
            "none" => "none".into(),
            kind => format!(
                "{kind}, radius {:.2} µm, area {:.1} µm², volume {:.1} µm³",
                m.soma.radius, m.soma.area, m.soma.volume
            ),
        },
    );
    if let Some(bounds) = &m.bbox {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| bounds.max[axis] - bounds.min[axis]);
        line("extent", format!("{x:.1} × {y:.1} × {z:.1} µm"));
    }
    if let Some(sholl) = &info.sholl {
        let crossings: Vec<String> = sholl.crossings.iter().map(u64::to_string).collect();
        let spheres = format!("every {} µm: {}", sholl.step, crossings.join(" "));
        line("crossings", spheres);
    }
    line("warnings", info.warnings.len().to_string());
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
