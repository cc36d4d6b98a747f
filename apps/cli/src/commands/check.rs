//! `neurotess check`: measures of a mesh, and what is wrong with it.

use std::path::PathBuf;

use clap::Args;
use neurotess::batch::standard::standard_input;
use neurotess::batch::{Input, InputError, Inputs};
use neurotess::mesh::{self, Format, Report};
use neurotess::precomputed;
use serde::Serialize;

use crate::io::batch::each;
use crate::io::output::is_standard;
use crate::report::{Entry, Failure, Reporter};

/// `neurotess check`
#[derive(Args, Debug)]
#[command(
    after_help = "Vertices are those of the file. STL repeats them for every face: use --merge.
A mesh that is not closed is a verdict, not a failure: the exit code is 0 if all could be read."
)]
pub(crate) struct CheckArgs {
    /// Mesh files (ply, obj, stl, glb, off, vtu, msh, poly, smesh), folders (searched recursively)
    /// or globs; - for standard input, with --format
    #[arg(required = true, value_name = "MESH")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Format, whatever the names say: ply, obj, stl, glb, off, vtu, msh (4.1 and 2.2), poly, smesh
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<Format>,
    /// Merge vertices of identical position first
    #[arg(long)]
    pub(crate) merge: bool,
}

/// One object of the JSON list.
#[derive(Serialize)]
struct Verdict {
    file: String,
    #[serde(flatten)]
    report: Report,
}

/// Runs the command.
pub(crate) fn run(args: &CheckArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let mut extensions = Format::ALL.map(Format::name).to_vec();
    extensions.push("gltf");
    let inputs = Inputs::find(&args.inputs, &extensions);
    let verdicts = each(&inputs, reporter, |input| judge(input, args))?;
    for entry in &verdicts {
        if let Entry::Done(verdict) = entry {
            reporter.answer(&text(verdict));
        }
    }
    reporter.document(&verdicts)
}

fn judge(input: &Input, args: &CheckArgs) -> Result<Verdict, Failure> {
    let file = input.path.display().to_string();
    let read = match (is_standard(&input.path), args.format) {
        (true, None) => {
            let what = "standard input has no extension: say --format ply, obj, stl, glb, off, vtu, msh, \
                 msh2, poly or smesh";
            return Err(Failure(format!("{file}: {what}")));
        }
        (true, Some(format)) => {
            let nothing = |head: &[u8]| head.len() > 1 << 15 && head.iter().all(|&byte| byte == 0);
            mesh::read_bytes(&standard_input(nothing).map_err(InputError::from)?, format)
        }
        (false, Some(format)) => mesh::read_as(&input.path, format),
        (false, None) => mesh::read(&input.path),
    };
    let mut surface = match precomputed::read_mesh(&input.path) {
        Some(read) => read.map_err(|e| Failure(format!("{file}: {e}")))?,
        None => read.map_err(|e| Failure(e.in_file(&file)))?,
    };
    if args.merge {
        mesh::merge_identical(&mut surface);
    }
    Ok(Verdict {
        file,
        report: mesh::check(&surface),
    })
}

/// The verdict on a mesh as text.
fn text(verdict: &Verdict) -> String {
    let r = &verdict.report;
    let yes = |is: bool| if is { "yes" } else { "NO" };
    let genus = r.genus.map_or("none".into(), |genus| genus.to_string());
    format!(
        "{}\n  {} vertices, {} triangles, {} quads, {} degenerate\n  \
         closed {} · manifold at edges {}, at vertices {} · oriented {}\n  \
         components {} · Euler characteristic {} · genus {genus}\n  \
         volume {:.3} µm³ · area {:.3} µm²\n  \
         self-intersecting pairs of faces: {}{}\n  \
         {}",
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
        if r.self_intersections_complete {
            ""
        } else {
            "at least "
        },
        r.self_intersections,
        shapes(r),
    )
}

/// What solvers ask of the triangles, for people.
fn shapes(r: &Report) -> String {
    let q = &r.quality;
    let with_handles = r.handles.iter().filter(|&&handles| handles > 0).count();
    let most = r.handles.iter().max().copied().unwrap_or_default();
    let handles = if with_handles > 1 {
        format!("handles in {with_handles} components, {most} in one of them\n  ")
    } else {
        String::new()
    };
    let edges = q.edge_over_radius_median.zip(q.edge_over_radius_max);
    let edges = edges.map_or(String::new(), |(median, most)| {
        format!(" · edges over radius: median {median:.2}, largest {most:.2}")
    });
    let gap = q.least_gap.map_or(String::new(), |gap| {
        format!(", the least of {gap:.3} of its sides")
    });
    format!(
        "{handles}smallest angles: least {:.2}°, 1 % below {:.2}°, median {:.2}°\n  \
         aspect: median {:.2}, largest {:.1}{edges}\n  \
         faces with a gap narrower than their sides: {:.2} %{gap}",
        q.min_angle,
        q.min_angle_p1,
        q.min_angle_median,
        q.aspect_median,
        q.aspect_max,
        100.0 * q.thin_gaps,
    )
}
