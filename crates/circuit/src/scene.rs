//! Our own scenes: a few cells from files, placed by hand. `NAME.scene.toml` or `NAME.scene.json`.
//!
//! ```toml
//! [groups.left]
//! color = "#0072b2"
//!
//! [[cells]]
//! file = "pyramidal.swc"            # relative to the scene
//! position = [0, 100, 0]            # µm; where the soma's center goes, if recenter
//! rotation_degrees = [0, 90, 0]     # about x, y and z: R = Rx Ry Rz
//! group = "left"
//! ```
//!
//! Every key of a cell but `file`: `id` (0, 1, … by default), `name`, `group`, `color`, `position`,
//! one of `rotation_degrees`, `quaternion` (w, x, y, z) and `matrix` (16 numbers, row by row, which is
//! position, too), `scale`, `recenter` (false by default).

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DQuat, DVec3};
use neurotess_formats::read_regular;
use serde::Deserialize;

use crate::json::place_and_reason;
use crate::listed::{self, Cell};
use crate::sonata::{folder_of, orientation};
use crate::{Circuit, CircuitError, Fault, transform};

/// A scene as it is written.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Scene {
    #[serde(default)]
    groups: BTreeMap<String, Group>,
    cells: Vec<Entry>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Group {
    color: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: String,
    id: Option<u64>,
    name: Option<String>,
    group: Option<String>,
    color: Option<String>,
    position: Option<[f64; 3]>,
    rotation_degrees: Option<[f64; 3]>,
    quaternion: Option<[f64; 4]>,
    matrix: Option<[f64; 16]>,
    scale: Option<f64>,
    #[serde(default)]
    recenter: bool,
}

/// Whether a file is named like a scene.
pub(crate) fn is_named_so(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_ascii_lowercase();
    name.ends_with(".scene.toml") || name.ends_with(".scene.json")
}

/// Opens a scene. What is wrong with one cell does not keep the others from showing.
pub(crate) fn open(path: &Path) -> Result<Circuit, CircuitError> {
    let text = read_regular(path)
        .and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other))
        .map_err(|e| CircuitError::io(path, e))?;
    read(path, &text)
}

pub(crate) fn read(path: &Path, text: &str) -> Result<Circuit, CircuitError> {
    let file = path.display().to_string();
    let text = text.trim_start_matches('\u{feff}');
    let json = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let scene: Scene = if json {
        serde_json::from_str(text).map_err(|e| {
            let (line, reason) = place_and_reason(&e);
            CircuitError::at_line(&file, line, "", Fault::Scene { reason })
        })?
    } else {
        toml::from_str(text).map_err(|e| {
            let reason = e.message().replace('\n', " ");
            let line = e.span().map(|span| 1 + newlines(text, span.start));
            CircuitError {
                file: file.clone(),
                line: line.and_then(|line| u32::try_from(line).ok()),
                key: None,
                fault: Fault::Scene { reason },
            }
        })?
    };
    let mut failures = Vec::new();
    for (name, group) in &scene.groups {
        if group.color.as_deref().is_some_and(|c| color(c).is_none()) {
            let text = group.color.clone().unwrap_or_default();
            let key = format!("groups.{name}.color");
            failures.push(no_color(&file, key, text));
        }
    }
    let mut cells = Vec::new();
    for (index, entry) in scene.cells.iter().enumerate() {
        match entry.cell(index, &scene, &file, folder_of(path)) {
            Ok(cell) => cells.push(cell),
            Err(e) => failures.push(e),
        }
    }
    if cells.is_empty() {
        let none = || CircuitError::new(&file, "cells", Fault::Missing);
        return Err(if failures.is_empty() {
            none()
        } else {
            failures.swap_remove(0)
        });
    }
    Ok(listed::circuit(path, "scene", &cells, vec![], failures))
}

fn newlines(text: &str, to: usize) -> usize {
    memchr::memchr_iter(b'\n', &text.as_bytes()[..to.min(text.len())]).count()
}

fn no_color(file: &str, key: String, text: String) -> CircuitError {
    let expected = "a color like #0072b2";
    CircuitError::new(file, key, Fault::NotANumber { expected, text })
}

impl Entry {
    fn cell(
        &self,
        index: usize,
        scene: &Scene,
        file: &str,
        folder: &Path,
    ) -> Result<Cell, CircuitError> {
        let key = |name: &str| format!("cells[{index}].{name}");
        let fault = |name, fault| CircuitError::new(file, key(name), fault);
        let mut rotation = DQuat::IDENTITY;
        let mut scale = 1.0;
        let mut position = DVec3::ZERO;
        if let Some(matrix) = self.matrix {
            let placement = transform::rigid(matrix);
            (position, rotation, scale) =
                placement.ok_or_else(|| fault("matrix", Fault::Transform))?;
        }
        if let Some(angles) = self.rotation_degrees {
            let turned = orientation::from_angles(angles.map(f64::to_radians));
            rotation = turned.ok_or_else(|| fault("rotation_degrees", Fault::Transform))?;
        }
        if let Some(components) = self.quaternion {
            let turned = orientation::from_components(components);
            rotation = turned.ok_or_else(|| fault("quaternion", Fault::Transform))?;
        }
        if let Some(place) = self.position {
            position = DVec3::from_array(place);
        }
        scale = self.scale.unwrap_or(scale);
        if !position.is_finite() {
            return Err(fault("position", Fault::Transform));
        }
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(fault("scale", Fault::Transform));
        }
        let group = self.group.as_ref().and_then(|name| scene.groups.get(name));
        let of_group = group.and_then(|group| group.color.as_ref());
        if let Some(text) = self.color.as_ref().filter(|text| color(text).is_none()) {
            return Err(no_color(file, key("color"), text.clone()));
        }
        let texts = [
            ("name", self.name.as_ref()),
            ("group", self.group.as_ref()),
            ("color", self.color.as_ref().or(of_group)),
        ];
        let texts = texts.into_iter();
        Ok(Cell {
            id: self.id.unwrap_or(index as u64),
            placement: (position, rotation, scale),
            recentered: self.recenter,
            file: Some(folder.join(&self.file)),
            attributes: texts
                .filter_map(|(name, text)| Some((name.to_owned(), text?.clone())))
                .collect(),
        })
    }
}

/// Red, green and blue of a color like `#0072b2`.
pub fn color(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#')?;
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let number = u32::from_str_radix(digits, 16).ok()?;
    let [_, r, g, b] = number.to_be_bytes();
    Some([r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "
[groups.left]
color = \"#0072b2\"

[[cells]]
file = \"a.swc\"
group = \"left\"
position = [1, 2.5, 3]
rotation_degrees = [0, 90, 0]

[[cells]]
file = \"a.swc\"
id = 9
color = \"#ff0000\"
scale = 2
";

    fn message(text: &str) -> String {
        let error = read(Path::new("s.scene.toml"), text).expect_err("an error");
        error.to_string()
    }

    #[test]
    fn cells_have_places_groups_and_colors() {
        let circuit = read(Path::new("s.scene.toml"), SCENE).expect("a scene");
        let cells = &circuit.populations[0];
        assert_eq!(
            (&cells.ids[..], &cells.scales[..]),
            (&[0, 9][..], &[1.0, 2.0][..])
        );
        assert_eq!(cells.positions[0], DVec3::new(1.0, 2.5, 3.0));
        assert!((cells.rotations[0] * DVec3::Z).distance(DVec3::X) < 1e-12);
        let colors = [0, 1].map(|row| cells.attributes["color"].text(row).and_then(color));
        assert_eq!(colors, [Some([0, 0x72, 0xb2]), Some([255, 0, 0])]);
    }

    #[test]
    fn json_says_the_same() {
        let json = r#"{"cells": [{"file": "a.swc", "quaternion": [2, 0, 0, 0]}]}"#;
        let circuit = read(Path::new("s.scene.json"), json).expect("a scene");
        assert_eq!(circuit.populations[0].rotations[0], DQuat::IDENTITY);
    }

    #[test]
    fn faults_name_key_or_line() {
        assert!(message("[[cells]]\nfiel = \"a\"").contains(".toml:2: not a scene"));
        assert!(message("cells = []").contains("'cells': is missing"));
        let zero = message("[[cells]]\nfile = \"a\"\nquaternion = [0, 0, 0, 0]");
        assert!(
            zero.starts_with("s.scene.toml: 'cells[0].quaternion':"),
            "{zero}"
        );
        let scale = message("[[cells]]\nfile = \"a\"\nscale = nan");
        assert!(scale.contains("'cells[0].scale'"), "{scale}");
        let tint = message("[[cells]]\nfile = \"a\"\ncolor = \"red\"");
        assert!(tint.contains("'cells[0].color': is not a color"), "{tint}");
    }

    #[test]
    fn one_bad_cell_leaves_the_others() {
        let text = format!("{SCENE}\n[[cells]]\nfile = \"b\"\nposition = [nan, 0, 0]\n");
        let circuit = read(Path::new("s.scene.toml"), &text).expect("a scene");
        assert_eq!(
            (circuit.populations[0].len(), circuit.failures.len()),
            (2, 1)
        );
    }
}
