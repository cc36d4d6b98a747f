//! Measures as people read them.

use super::Measures;

impl Measures {
    /// Names and values, as `neurotess info` prints them. A row without a name belongs to the one above.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![
            (
                "points",
                format!(
                    "{} in {} of {}",
                    self.n_points,
                    count(self.n_sections, "section"),
                    count(self.n_neurites, "neurite")
                ),
            ),
            (
                "forks",
                format!(
                    "{} with 2 children, {} with more; {}; branch order up to {}",
                    self.n_bifurcations,
                    self.n_multifurcations,
                    count(self.n_ends, "end"),
                    self.max_branch_order
                ),
            ),
            ("length", format!("{:.1} µm", self.length)),
        ];
        let by_type = [
            ("axon", self.length_by_type.axon),
            ("basal", self.length_by_type.basal_dendrite),
            ("apical", self.length_by_type.apical_dendrite),
            ("other", self.length_by_type.other),
        ];
        let present = by_type.into_iter().filter(|&(_, length)| length > 0.0);
        rows.extend(present.map(|(kind, length)| ("", format!("{kind:<7} {length:.1} µm"))));
        rows.push(("area", format!("{:.1} µm²", self.area)));
        rows.push(("volume", format!("{:.1} µm³", self.volume)));
        let soma = match self.soma.kind {
            "none" => "none".into(),
            kind => format!(
                "{kind}, radius {:.2} µm, area {:.1} µm², volume {:.1} µm³",
                self.soma.radius, self.soma.area, self.soma.volume
            ),
        };
        rows.push(("soma", soma));
        rows.extend(self.bbox.map(|bounds| {
            let [x, y, z] = [0, 1, 2].map(|axis: usize| bounds.max[axis] - bounds.min[axis]);
            ("extent", format!("{x:.1} × {y:.1} × {z:.1} µm"))
        }));
        rows
    }
}

fn count(number: usize, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}
