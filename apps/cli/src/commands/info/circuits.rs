//! `neurotess info` of circuits.

use std::path::PathBuf;

use neurotess::circuit::{Circuit, Elements, RecordingFile, ReportKind, TimeAxis, Warning};
use serde::Serialize;

use crate::io::circuits;
use crate::report::{Entry, Failed, Failure, Reporter, count};

/// One object of the JSON list.
#[derive(Serialize)]
pub(crate) struct Description {
    file: String,
    format: &'static str,
    /// Number of nodes.
    n_neurons: usize,
    /// Number of nodes that have a position and a morphology file that exists.
    n_shown: usize,
    /// Number of distinct morphology files that exist.
    n_morphologies: usize,
    populations: Vec<PopulationInfo>,
    /// Bounding box of the somata.
    bbox: Option<Bounds>,
    edges: Vec<EdgesInfo>,
    node_sets: Vec<String>,
    reports: Vec<ReportInfo>,
    warnings: Vec<CircuitWarning>,
    /// Parts that could not be opened.
    errors: Vec<String>,
}

#[derive(Serialize)]
struct PopulationInfo {
    name: String,
    #[serde(rename = "type")]
    kind: String,
    n_neurons: usize,
    n_shown: usize,
    attributes: Vec<String>,
}

#[derive(Serialize)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

#[derive(Serialize)]
struct EdgesInfo {
    name: String,
    source: String,
    target: String,
    n_edges: u64,
}

/// A report of one population; times in ms.
#[derive(Serialize)]
struct ReportInfo {
    name: String,
    file: String,
    #[serde(rename = "type")]
    kind: &'static str,
    population: String,
    time: Option<Time>,
    units: Option<String>,
    n_nodes: Option<usize>,
    n_elements: Option<u64>,
    n_spikes: Option<usize>,
}

#[derive(Serialize)]
struct Time {
    start: f64,
    end: f64,
    step: Option<f64>,
    frames: Option<u64>,
}

#[derive(Serialize)]
struct CircuitWarning {
    file: String,
    key: String,
    code: &'static str,
    message: String,
    count: u64,
}

/// Describes circuits one after the other, and prints each description at once.
pub(crate) fn describe_all(
    circuits: &[PathBuf],
    reporter: &Reporter,
) -> anyhow::Result<Vec<Entry<Description>>> {
    let mut entries = Vec::new();
    for path in circuits {
        entries.push(match circuits::open(path, reporter) {
            Ok(circuit) => {
                let description = describe(&circuit, reporter);
                reporter.answer(&table(&description));
                Entry::Done(description)
            }
            Err(failure) => {
                reporter.failure(&failure);
                Entry::Failed(Failed {
                    file: path.display().to_string(),
                    error: failure.0,
                })
            }
        });
    }
    Ok(entries)
}

fn describe(circuit: &Circuit, reporter: &Reporter) -> Description {
    let mut errors: Vec<String> = circuit.failures.iter().map(ToString::to_string).collect();
    let mut reports = Vec::new();
    let warning = |warning: &Warning| CircuitWarning {
        file: warning.file.clone(),
        key: warning.key.clone(),
        code: warning.code,
        message: warning.message.clone(),
        count: warning.count,
    };
    let mut warnings: Vec<CircuitWarning> = circuit.warnings.iter().map(warning).collect();
    for (name, path) in &circuit.reports {
        match RecordingFile::open(path) {
            Ok(recording) => {
                let declared = circuit.declared_report(path);
                let elements = declared.map_or(Elements::Sections, |report| report.elements);
                warnings.extend(recording.warnings().iter().map(warning));
                for warning in recording.warnings() {
                    reporter.warning(&warning.to_string());
                }
                reports.extend(report_infos(name, path, elements, &recording));
            }
            Err(e) => {
                reporter.failure(&Failure(e.to_string()));
                errors.push(e.to_string());
            }
        }
    }
    let populations = circuit.populations.iter().map(|population| PopulationInfo {
        name: population.name.clone(),
        kind: population.kind.clone(),
        n_neurons: population.len(),
        n_shown: population.templates.iter().flatten().count(),
        attributes: population.attributes.keys().cloned().collect(),
    });
    let edges = circuit.edges.iter().map(|edges| EdgesInfo {
        name: edges.name.clone(),
        source: edges.source.clone(),
        target: edges.target.clone(),
        n_edges: edges.count,
    });
    Description {
        file: circuit.file.clone(),
        format: circuit.format,
        n_neurons: circuit.n_neurons(),
        n_shown: circuit.n_shown(),
        n_morphologies: circuit.templates.len(),
        populations: populations.collect(),
        bbox: circuit.bounds().map(|(min, max)| Bounds {
            min: min.to_array(),
            max: max.to_array(),
        }),
        edges: edges.collect(),
        node_sets: circuit.node_sets.names().map(str::to_owned).collect(),
        reports,
        warnings,
        errors,
    }
}

fn report_infos(
    name: &str,
    path: &std::path::Path,
    elements: Elements,
    recording: &RecordingFile,
) -> Vec<ReportInfo> {
    let file = path.display().to_string();
    match recording {
        RecordingFile::Report(report) => {
            let values = report.populations.iter();
            let info = values.map(|values| {
                let TimeAxis {
                    start,
                    end,
                    step,
                    frames,
                } = values.time;
                ReportInfo {
                    name: name.into(),
                    file: file.clone(),
                    kind: match (elements, values.kind()) {
                        (Elements::Sections, ReportKind::Soma) => "soma",
                        (Elements::Sections, ReportKind::Compartment) => "compartment",
                        (others, _) => others.name(),
                    },
                    population: values.name.clone(),
                    time: Some(Time {
                        start,
                        end,
                        step: Some(step),
                        frames: Some(frames),
                    }),
                    units: Some(values.units.clone()),
                    n_nodes: Some(values.nodes.len()),
                    n_elements: Some(values.compartment_count()),
                    n_spikes: None,
                }
            });
            info.collect()
        }
        RecordingFile::Spikes(spikes) => {
            let populations = spikes.populations.iter();
            let info = populations.map(|spikes| ReportInfo {
                name: name.into(),
                file: file.clone(),
                kind: "spikes",
                population: spikes.name.clone(),
                time: spikes
                    .times
                    .first()
                    .zip(spikes.times.last())
                    .map(|(&start, &end)| Time {
                        start,
                        end,
                        step: None,
                        frames: None,
                    }),
                units: None,
                n_nodes: None,
                n_elements: None,
                n_spikes: Some(spikes.times.len()),
            });
            info.collect()
        }
    }
}

/// The description of a circuit as text.
fn table(info: &Description) -> String {
    let mut lines = vec![format!("{} ({})", info.file, info.format)];
    let mut line = |name: &str, value: String| lines.push(format!("  {name:<12} {value}"));
    line(
        "neurons",
        format!(
            "{}, {} shown, of {} morphology files",
            info.n_neurons, info.n_shown, info.n_morphologies
        ),
    );
    for (index, p) in info.populations.iter().enumerate() {
        let name = if index == 0 { "populations" } else { "" };
        let kind = if p.kind.is_empty() { "" } else { ", " };
        line(
            name,
            format!("{}: {}{kind}{}", p.name, count(p.n_neurons, "node"), p.kind),
        );
    }
    if let Some(Bounds { min, max }) = &info.bbox {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| max[axis] - min[axis]);
        line(
            "extent",
            format!("{x:.1} × {y:.1} × {z:.1} µm between somata"),
        );
    }
    for edges in &info.edges {
        line("edges", format!("{}: {}", edges.name, edges.n_edges));
    }
    if !info.node_sets.is_empty() {
        line("node sets", info.node_sets.join(", "));
    }
    for report in &info.reports {
        let time = report.time.as_ref().map_or(String::new(), |time| {
            format!(", {} to {} ms", time.start, time.end)
        });
        let size = match (report.n_spikes, report.n_elements, report.n_nodes) {
            (Some(spikes), ..) => count(spikes, "spike"),
            (None, Some(elements), Some(nodes)) => {
                format!(
                    "{} of {}",
                    count(elements as usize, "element"),
                    count(nodes, "node")
                )
            }
            _ => String::new(),
        };
        line(
            "report",
            format!("{} ({}): {size}{time}", report.name, report.kind),
        );
    }
    line("warnings", info.warnings.len().to_string());
    lines.join("\n")
}
