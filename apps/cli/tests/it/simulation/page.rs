//! The commands of `docs/simulation.md`, run as they stand in a folder of their own.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use neurotess::mesh::{check, read};
use neurotess_testing::python_with;

use crate::work::root;

/// The need of what runs in Python.
fn simulators() -> Result<(), String> {
    if !cfg!(unix) {
        return Err("the page's commands are for a Unix shell".into());
    }
    ["meshio", "skfem", "gmsh", "tetgen"]
        .iter()
        .try_for_each(|module| python_with(module).map(drop))
}

/// The need of dolfinx, and of what it compiles equations with.
fn dolfinx() -> Result<(), String> {
    simulators()?;
    // Its wheel takes the MPI that mpi4py has loaded.
    let python = python_with("mpi4py.MPI, dolfinx")
        .map_err(|missing| format!("{missing}: its wheel is for Python 3.12 or newer on Linux"))?;
    let header = "import os, sysconfig; os.stat(sysconfig.get_path('include') + '/Python.h')";
    let found = Command::new(python).args(["-c", header]).output();
    found
        .is_ok_and(|found| found.status.success())
        .then_some(())
        .ok_or_else(|| "no Python.h: Debian and Ubuntu have it in python3-dev".to_owned())
}

/// The need of TetGen's own program.
fn tetgen_program() -> Result<(), String> {
    let found = Command::new("tetgen").arg("-h").output();
    let missing = |_| "no program tetgen: Debian and Ubuntu have a package of that name".to_owned();
    found.map(drop).map_err(missing)
}

/// The blocks of the page with this info string.
fn blocks(info: &str) -> Vec<String> {
    let page = fs::read_to_string(root().join("docs/simulation.md")).expect("the page");
    let fence = format!("```{info}\n");
    let blocks = page.split(&fence).skip(1);
    blocks
        .map(|rest| rest.split("```").next().unwrap_or_default().to_owned())
        .collect()
}

/// Runs commands in a folder that looks like the repository's; what they print.
fn run(folder: &Path, script: &str) -> String {
    for shared in ["docs", "samples"] {
        let (there, here) = (root().join(shared), folder.join(shared));
        #[cfg(unix)]
        std::os::unix::fs::symlink(there, here).expect("a link");
        #[cfg(not(unix))]
        drop((there, here));
    }
    shell(folder, script)
}

/// Runs commands in a folder; what they print.
fn shell(folder: &Path, script: &str) -> String {
    let beside = |program: &Path| program.parent().map(Path::to_path_buf).expect("a folder");
    let mut path = vec![beside(Path::new(env!("CARGO_BIN_EXE_neurotess")))];
    path.extend(python_with("sys").ok().as_deref().map(beside));
    let before = std::env::var_os("PATH").unwrap_or_default();
    path.extend(std::env::split_paths(&before));
    let output = Command::new("sh")
        .args(["-e", "-c", script])
        .current_dir(folder)
        .env("PATH", std::env::join_paths(path).expect("plain folders"))
        .output()
        .expect("a shell");
    let (out, err) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{script}\n{out}\n{err}");
    out.into_owned()
}

/// The calcium of each section.
fn sections(path: &Path) -> BTreeMap<i32, f64> {
    let text = fs::read_to_string(path).expect("a table");
    let row = |line: &str| {
        let mut words = line.split(',');
        let section = words.next().and_then(|word| word.parse().ok());
        let calcium = words.next_back().and_then(|word| word.trim().parse().ok());
        (section.expect("a section"), calcium.expect("a number"))
    };
    text.lines().skip(1).map(row).collect()
}

#[neurotess_testing::test(needs(neurotess_testing::full, simulators))]
fn the_page_runs_from_tracing_to_calcium() {
    let folder = tempfile::tempdir().expect("a folder");
    let commands = blocks("sh");
    assert_eq!(commands.len(), 6, "the commands of the page");
    let printed = run(folder.path(), &commands.concat());
    assert!(
        printed.contains("self-intersecting pairs of faces: 0"),
        "{printed}"
    );

    let out = folder.path().join("out");
    let [by_tetgen, by_gmsh] =
        ["sections.csv", "sections2.csv"].map(|file| sections(&out.join(file)));
    assert!(by_tetgen.keys().eq(by_gmsh.keys()));
    // Calcium starts in the soma and has arrived in the dendrites, but not at the axon's far end.
    let highest = by_tetgen.values().copied().fold(0.0, f64::max);
    assert!(by_tetgen[&0] > 0.5 * highest && by_tetgen[&1] > 0.5 * by_tetgen[&0]);
    let farthest = by_tetgen.values().copied().fold(f64::INFINITY, f64::min);
    assert!(farthest < 0.1 * highest, "{farthest} and {highest}");
    // Two fills of one cell: the sources differ by the nodes that lie in the sphere.
    for (section, found) in &by_tetgen {
        let other = by_gmsh[section];
        assert!(
            (found - other).abs() < 0.1 * highest,
            "{section}: {found} and {other}"
        );
    }

    // The surface of the filled volume is the surface that was filled.
    let surface = check(&read(&out.join("cell.msh")).expect("our file"));
    let filled = check(&read(&out.join("gmsh.msh")).expect("Gmsh's file"));
    assert_eq!(filled.triangles, surface.triangles);
    assert!(filled.closed && filled.oriented && filled.vertices == surface.vertices);
    tetrahedra_are_in_meters(&out.join("steps.msh"), surface.volume * 1e-18);

    // Soma and neurites are all that is inside.
    let regions = printed.lines().filter(|line| line.starts_with("region "));
    let volume = |line: &str| -> f64 {
        let words: Vec<&str> = line.split(' ').collect();
        words[words.len() - 2].parse().expect(line)
    };
    let volumes: Vec<f64> = regions.map(volume).collect();
    assert_eq!(volumes.len(), 6, "the soma and five neurites: {printed}");
    let all = volumes.iter().sum::<f64>();
    assert!((all / surface.volume - 1.0).abs() < 1e-3, "{all}");
}

/// The amount (µM µm³) that two steps of the same experiment begin with.
fn amounts(printed: &str) -> Vec<f64> {
    let lines = printed
        .lines()
        .filter_map(|line| line.strip_prefix("amount "));
    lines
        .map(|line| {
            let word = line.split(' ').next().expect("a number");
            word.parse().expect("a number")
        })
        .collect()
}

#[neurotess_testing::test(needs(neurotess_testing::full, simulators))]
fn the_page_runs_again_and_with_the_other_options() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = blocks("sh").concat();
    let named = blocks("");
    let other = named.iter().find(|block| block.contains("OPTIONS="));
    let other = other.expect("the page names other options").trim();
    let first = page.lines().find(|line| line.starts_with("OPTIONS="));
    let with_other = page.replace(first.expect("options"), other);
    let printed = run(folder.path(), &format!("{page}{page}{with_other}"));
    let mesh = "neurotess mesh samples/granule.swc -o out/other.ply --json";
    let report: serde_json::Value =
        serde_json::from_str(&shell(folder.path(), mesh)).expect("JSON");
    let soma = report[0]["soma_volume"].as_f64().expect("a volume");
    // By TetGen and by Gmsh, three times. Nodes stand for what is nearest to them.
    let amounts = amounts(&printed);
    assert_eq!(amounts.len(), 6, "{printed}");
    for amount in amounts {
        assert!((amount / soma - 1.0).abs() < 0.03, "{amount} of {soma}");
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, dolfinx))]
fn dolfinx_gives_the_same_calcium() {
    let folder = tempfile::tempdir().expect("a folder");
    let [surface, _, _, by_gmsh, _, by_skfem] =
        <[String; 6]>::try_from(blocks("sh")).expect("the commands of the page");
    let by_dolfinx = blocks("sh dolfinx");
    assert_eq!(by_dolfinx.len(), 1);
    // What dolfinx compiles stays in this folder.
    let cache = "export XDG_CACHE_HOME=\"$PWD/cache\"\n".to_owned();
    let commands = [cache, surface, by_gmsh, by_skfem, by_dolfinx.concat()];
    run(folder.path(), &commands.concat());

    let out = folder.path().join("out");
    let [expected, found] =
        ["sections2.csv", "sections3.csv"].map(|file| sections(&out.join(file)));
    assert!(found.keys().eq(expected.keys()));
    // One mesh and one scheme: only the two factorizations round differently, by 4e-9 when it was measured.
    for (section, calcium) in &expected {
        let ratio = found[section] / calcium;
        assert!((ratio - 1.0).abs() < 1e-6, "{section}: {ratio}");
    }
}

/// meshio and Gmsh read a file in meters: the group of the tetrahedra, and their volume in m³.
fn tetrahedra_are_in_meters(file: &Path, volume: f64) {
    let script = "
import sys, meshio, numpy, gmsh
mesh = meshio.read(sys.argv[1])
code, dimension = mesh.field_data['intracellular']
tetrahedra = numpy.concatenate([b.data for b, g in zip(mesh.cells, mesh.cell_data['gmsh:physical'])
                                if b.type == 'tetra' and (g == code).all()])
a, b, c, d = (mesh.points[tetrahedra[:, n]] for n in range(4))
volume = abs(numpy.einsum('ij,ij->i', b - a, numpy.cross(c - a, d - a))).sum() / 6
gmsh.initialize()
gmsh.option.setNumber('General.Verbosity', 2)
gmsh.open(sys.argv[1])
groups = gmsh.model.getPhysicalGroups()
assert len({number for _, number in groups}) == len(groups), groups
names = [gmsh.model.getPhysicalName(*group) for group in groups]
print(volume, *names)
";
    let python = python_with("gmsh").expect("the test needs it");
    let output = Command::new(python)
        .args(["-c", script])
        .arg(file)
        .output()
        .expect("Python runs");
    let printed = String::from_utf8_lossy(&output.stdout);
    let mut words = printed.lines().last().unwrap_or_default().split(' ');
    let found: f64 = words
        .next()
        .and_then(|word| word.parse().ok())
        .expect(&printed);
    assert!((found / volume - 1.0).abs() < 1e-6, "{found} and {volume}");
    let mut names: Vec<&str> = words.collect();
    names.sort_unstable();
    assert_eq!(names, ["axon", "basal_dendrite", "intracellular", "soma"]);
}

#[neurotess_testing::test(needs(neurotess_testing::full, simulators))]
fn surfaces_in_meters_are_filled() {
    let folder = tempfile::tempdir().expect("a folder");
    let printed = run(
        folder.path(),
        "neurotess mesh samples/granule.swc --level 1 --unit m -o out/cell.msh\n\
         neurotess mesh samples/granule.swc --level 1 -o out/um.msh\n\
         python docs/simulation/fill_tetgen.py out/cell.msh out/tetgen.vtu\n\
         python docs/simulation/fill_gmsh.py out/cell.msh out/gmsh.msh\n",
    );
    assert!(
        printed.contains("TetGen: ") && printed.contains("Gmsh: "),
        "{printed}"
    );
    let out = folder.path().join("out");
    let um = check(&read(&out.join("um.msh")).expect("our file")).volume;
    let filled = check(&read(&out.join("gmsh.msh")).expect("Gmsh's file"));
    assert!(filled.closed && (filled.volume / (um * 1e-18) - 1.0).abs() < 1e-6);
    tetrahedra_are_in_meters(&out.join("gmsh.msh"), um * 1e-18);
}

#[neurotess_testing::test(needs(neurotess_testing::full, tetgen_program))]
fn the_program_tetgen_keeps_types() {
    let folder = tempfile::tempdir().expect("a folder");
    let surface = blocks("sh").into_iter().next().expect("the first block");
    let commands = blocks("sh tetgen");
    assert_eq!(commands.len(), 1);
    run(folder.path(), &format!("{surface}{}", commands[0]));
    let out = folder.path().join("out");
    let count = |text: &str, column: usize| -> BTreeMap<String, usize> {
        let mut counts = BTreeMap::new();
        for line in text.lines().skip(1).filter(|line| !line.starts_with('#')) {
            let word = line.split([' ', ',']).filter(|w| !w.is_empty()).nth(column);
            *counts
                .entry(word.expect("a column").to_owned())
                .or_default() += 1;
        }
        counts
    };
    let faces = fs::read_to_string(out.join("cell.1.face")).expect("TetGen's faces");
    let table = fs::read_to_string(out.join("cell.csv")).expect("the table");
    assert_eq!(count(&faces, 4), count(&table, 4));
}
