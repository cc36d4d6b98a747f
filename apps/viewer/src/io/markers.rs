//! Reads synapses of circuits, and tables of points.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use neurotess::circuit::{Circuit, Edges, PointTable};
use neurotess::coloring::EdgeSynapses;

use crate::io::task::Progress;
use crate::model::ids::CircuitId;
use crate::model::markers::{CircuitSynapses, MarkerContent, MarkerSource, SynapseKey};

/// Reads what is to be shown. `circuits`: those that synapses are read of.
///
/// # Errors
/// A message that says what is wrong and what to do.
pub(crate) fn read(
    source: &MarkerSource,
    circuits: &[(CircuitId, Arc<Circuit>)],
    progress: &Progress,
) -> Result<MarkerContent, String> {
    match source {
        MarkerSource::Synapses(key) => synapses(key, circuits, progress),
        MarkerSource::Points(file) => {
            let table = PointTable::read(file).map_err(|e| without(file, &e.to_string()))?;
            Ok(MarkerContent::Points(table))
        }
    }
}

/// A reason without the file's name, which the window shows beside it.
fn without(file: &std::path::Path, text: &str) -> String {
    let rest = text.strip_prefix(&*file.to_string_lossy()).unwrap_or(text);
    let lined = rest.strip_prefix(':').and_then(|rest| rest.split_once(':'));
    match lined {
        Some((line, why)) if line.parse::<u64>().is_ok() => format!("line {line}:{why}"),
        _ => rest.trim_start_matches([':', ' ']).to_owned(),
    }
}

fn synapses(
    key: &SynapseKey,
    circuits: &[(CircuitId, Arc<Circuit>)],
    progress: &Progress,
) -> Result<MarkerContent, String> {
    let all = || {
        let of = |(id, circuit): &'_ (CircuitId, Arc<Circuit>)| {
            let (id, circuit) = (*id, Arc::clone(circuit));
            (0..circuit.edges.len()).map(move |at| (id, Arc::clone(&circuit), at))
        };
        circuits.iter().flat_map(of)
    };
    if all().next().is_none() {
        let why = "synapses are those of a SONATA circuit that names edges: open one";
        return Err(why.into());
    }
    let named = |edges: &Edges| key.edges.is_empty() || key.edges.contains(&edges.name);
    let chosen: Vec<_> = all().filter(|(_, c, at)| named(&c.edges[*at])).collect();
    if chosen.is_empty() {
        let there: Vec<String> = all().map(|(_, c, at)| c.edges[at].name.clone()).collect();
        let asked = key.edges.join(", ");
        return Err(format!(
            "no edges '{asked}': there are {}",
            there.join(", ")
        ));
    }
    progress.all.store(chosen.len(), Ordering::Relaxed);
    let mut read = Vec::new();
    for (circuit, of, at) in chosen {
        if progress.is_canceled() {
            return Err("stopped".into());
        }
        let edges = &of.edges[at];
        let synapses = EdgeSynapses::read(edges, key.side, key.property.as_deref());
        read.push(CircuitSynapses {
            circuit,
            edges: synapses.map_err(|e| e.to_string())?,
            properties: edges.properties().map_err(|e| e.to_string())?,
        });
        progress.done.fetch_add(1, Ordering::Relaxed);
    }
    Ok(MarkerContent::Synapses(read))
}
