//! A state of neuroglancer that shows the cells: `view.json`, and the same as a link.

use glam::DVec3;
use neurotess_mesh::palette::{Palette, Rgb};
use serde_json::{Map, Value, json};

use crate::synapses::FOLDER;

/// The public client; the state follows.
const CLIENT: &str = "https://neuroglancer-demo.appspot.com/#!";

/// What is shown first.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Where browsers find the folder, as `https://…`, `gs://…` or `s3://…`.
    pub url: String,
    /// Segments that are shown, each perhaps in a color.
    pub segments: Vec<(u64, Option<Rgb>)>,
    /// Whether there are annotations of synapses.
    pub synapses: bool,
    /// Box (nm) around what is shown.
    pub bounds: (DVec3, DVec3),
}

impl View {
    /// The state, as `view.json` has it.
    pub fn state(&self) -> Value {
        let source =
            |folder: &str| format!("precomputed://{}/{folder}", self.url.trim_end_matches('/'));
        let ids: Vec<String> = self.segments.iter().map(|(id, _)| id.to_string()).collect();
        let color = |&(id, color): &(u64, Option<Rgb>)| {
            let [r, g, b] = color?;
            Some((id.to_string(), json!(format!("#{r:02x}{g:02x}{b:02x}"))))
        };
        let colors: Map<String, Value> = self.segments.iter().filter_map(color).collect();
        let mut layers = vec![
            json!({
                "type": "segmentation",
                "name": "cells",
                "source": [source("mesh"), source("properties")],
                "segments": ids,
                "segmentColors": colors,
                "tab": "segments",
            }),
            // Within the membranes, and seen where these are thinner than a pixel.
            json!({
                "type": "segmentation",
                "name": "skeletons",
                "source": source("skeletons"),
                "linkedSegmentationGroup": "cells",
                "linkedSegmentationColorGroup": false,
                "skeletonRendering": {"shader": by_type(), "mode3d": "lines", "lineWidth3d": 2},
            }),
        ];
        if self.synapses {
            layers.push(json!({
                "type": "annotation",
                "name": "synapses",
                "source": source(FOLDER),
                "linkedSegmentationLayer": {"pre": "cells", "post": "cells"},
                "filterBySegmentation": ["post"],
            }));
        }
        let (min, max) = self.bounds;
        json!({
            "dimensions": {"x": [1e-9, "m"], "y": [1e-9, "m"], "z": [1e-9, "m"]},
            "position": ((min + max) / 2.0).to_array(),
            // Nanometers along the height of the view, with some room.
            "projectionScale": (1.2 * (max - min).max_element()).max(1.0),
            // Neuroglancer's y runs down, ours up: half a turn around x.
            "projectionOrientation": [1, 0, 0, 0],
            "layers": layers,
            "selectedLayer": {"layer": "cells", "visible": true},
            "showAxisLines": false,
            "showSlices": false,
            "layout": "3d",
        })
    }
}

/// A link that opens a state in the public client.
pub fn link_to(state: &Value) -> String {
    let mut link = CLIENT.to_owned();
    for byte in state.to_string().bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' => {
                link.push(char::from(byte));
            }
            other => link.push_str(&format!("%{other:02X}")),
        }
    }
    link
}

/// A shader of skeletons with the colors of types.
fn by_type() -> String {
    let branch = |kind: i32| {
        let [r, g, b] = Palette::default()
            .of_type(kind)
            .map(|byte| f32::from(byte) / 255.0);
        format!("  if (vertex_types == {kind}.0) color = vec3({r:.3}, {g:.3}, {b:.3});\n")
    };
    let branches: String = (1..=4).map(branch).collect();
    let [r, g, b] = Palette::default()
        .of_type(0)
        .map(|byte| f32::from(byte) / 255.0);
    format!(
        "void main() {{\n  vec3 color = vec3({r:.3}, {g:.3}, {b:.3});\n{branches}  emitRGB(color);\n}}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> View {
        View {
            url: "https://example.org/cells/".into(),
            segments: vec![(720_575_940_623_456_789, Some([1, 2, 255])), (2, None)],
            synapses: true,
            bounds: (DVec3::new(-10.0, 0.0, 4.0), DVec3::new(30.0, 10.0, 4.0)),
        }
    }

    #[test]
    fn the_state_names_sources_and_shows_all() {
        let state = view().state();
        let cells = &state["layers"][0];
        assert_eq!(
            cells["source"][0],
            "precomputed://https://example.org/cells/mesh"
        );
        assert_eq!(cells["segments"], json!(["720575940623456789", "2"]));
        assert_eq!(
            cells["segmentColors"],
            json!({"720575940623456789": "#0102ff"})
        );
        assert_eq!(
            state["layers"][2]["linkedSegmentationLayer"]["post"],
            "cells"
        );
        assert_eq!(state["position"], json!([10.0, 5.0, 4.0]));
        assert_eq!(state["projectionScale"], json!(48.0));
    }

    #[test]
    fn the_link_holds_the_state() {
        let link = link_to(&view().state());
        let text = link.strip_prefix(CLIENT).expect("the client");
        assert!(
            text.bytes()
                .all(|b| b.is_ascii_alphanumeric() || b"-_.~%".contains(&b))
        );
        assert!(text.starts_with("%7B%22"));
    }
}
