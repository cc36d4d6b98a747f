//! `neurotess check`: what a mesh is and what is wrong with it.

use neurotess::mesh::{self, Format, Place, ReadError, Report};
use serde::Serialize;

use crate::args::CheckArgs;
use crate::info::{Entry, each};
use crate::inputs::{Input, Inputs};
use crate::report::{Failure, Reporter};

/// One object of the JSON list.
#[derive(Serialize)]
struct Verdict {
    file: String,
    #[serde(flatten)]
    report: Report,
}

/// Runs the command.
pub(crate) fn run(args: &CheckArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let mut extensions = Format::ALL.map(Format::extension).to_vec();
    extensions.push("gltf");
    let inputs = Inputs::find(&args.inputs, &extensions);
    let verdicts = each(&inputs, reporter, |input| judge(input, args.merge))?;
    for entry in &verdicts {
        if let Entry::Done(verdict) = entry {
            reporter.result(&text(verdict));
        }
    }
    reporter.document(&verdicts)
}

fn judge(input: &Input, merge: bool) -> Result<Verdict, Failure> {
    let file = input.path.display().to_string();
    let mut surface = mesh::read(&input.path).map_err(|e| Failure(named(&file, &e)))?;
    if merge {
        mesh::merge_identical(&mut surface);
    }
    Ok(Verdict {
        file,
        report: mesh::check(&surface),
    })
}

/// `FILE:LINE: what: what to do`
fn named(file: &str, error: &ReadError) -> String {
    match error.place() {
        Place::Line(line) => {
            let text = error.to_string();
            let what = text
                .strip_prefix(&format!("line {line}: "))
                .unwrap_or(&text);
            format!("{file}:{line}: {what}")
        }
        Place::Byte(_) | Place::File => match error {
            ReadError::Io(e) => {
                format!("{file}: cannot be read ({e}): check the path and its permissions")
            }
            other => format!("{file}: {other}"),
        },
    }
}

/// One mesh for people.
fn text(verdict: &Verdict) -> String {
    let r = &verdict.report;
    let yes = |is: bool| if is { "yes" } else { "NO" };
    let genus = r.genus.map_or("none".into(), |genus| genus.to_string());
    format!(
        "{}\n  {} vertices, {} triangles, {} quads, {} degenerate\n  \
         closed {} · manifold at edges {}, at vertices {} · oriented {}\n  \
         components {} · Euler characteristic {} · genus {genus}\n  \
         volume {:.3} µm³ · area {:.3} µm²\n  \
         self-intersecting pairs of faces: {}",
        verdict.file,
        r.vertices,
        r.triangles,
        r.quads,
        r.degenerate_faces,
        yes(r.closed),
        yes(r.edge_manifold),
        yes(r.vertex_manifold),
        yes(r.oriented),
        r.components,
        r.euler,
        r.volume,
        r.area,
        r.self_intersections,
    )
}
