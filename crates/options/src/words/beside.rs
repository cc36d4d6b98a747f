//! Meshes beside the cells of a picture.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use super::Color;
use crate::given::by_text;

/// A mesh beside the cells: a file and how it looks, as in region.obj,opacity=0.2,fit.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshBeside {
    /// The file, or what a mesh in memory is called.
    pub file: PathBuf,
    /// Its color, if not one that is told apart from those of the others.
    pub color: Option<Color>,
    /// From 0 to 1.
    pub opacity: f64,
    /// Whether only the edges of its faces are drawn.
    pub edges: bool,
    /// The µm of a unit of the file.
    pub scale: f64,
    /// Whether the camera fits it even if one can see through it.
    pub fit: bool,
}

impl MeshBeside {
    /// A mesh as it usually looks.
    pub fn new(file: impl Into<PathBuf>) -> Self {
        Self {
            file: file.into(),
            color: None,
            opacity: 1.0,
            edges: false,
            scale: 1.0,
            fit: false,
        }
    }

    /// Sets an option. False if it is none.
    fn set(&mut self, option: &str) -> Result<bool, String> {
        let (name, value) = match option.split_once('=') {
            Some((name, value)) => (name, Some(value)),
            None => (option, None),
        };
        match (name.trim(), value) {
            ("edges", None) => self.edges = true,
            ("fit", None) => self.fit = true,
            ("color", Some(color)) => self.color = Some(color.parse()?),
            ("opacity", Some(share)) => {
                let share = share.trim().parse().ok();
                let share = share.filter(|share| (0.0..=1.0).contains(share));
                self.opacity = share.ok_or("opacity is a number from 0 to 1, as in opacity=0.2")?;
            }
            ("scale", Some(um)) => {
                let um = um.trim().parse().ok();
                let um = um.filter(|um: &f64| *um > 0.0 && um.is_finite());
                self.scale = um.ok_or("scale is a number above 0, as in scale=0.001 for nm")?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

impl FromStr for MeshBeside {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').collect();
        // A file's name may have commas: what comes after its extension are options.
        let is_mesh = |part: &&str| neurotess_mesh::Format::from_extension(part.as_ref()).is_ok();
        let file = parts.iter().position(is_mesh).unwrap_or(0) + 1;
        let (name, options) = parts.split_at(file);
        let mut mesh = Self::new(name.join(","));
        for option in options {
            if !mesh.set(option)? {
                return Err(format!(
                    "'{option}' is no option of a mesh: use color=C, opacity=O, edges, scale=S or fit"
                ));
            }
        }
        Ok(mesh)
    }
}

impl fmt::Display for MeshBeside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let usual = Self::new("");
        self.file.display().fmt(f)?;
        if let Some(color) = self.color {
            write!(f, ",color={color}")?;
        }
        if self.opacity != usual.opacity {
            write!(f, ",opacity={}", self.opacity)?;
        }
        if self.scale != usual.scale {
            write!(f, ",scale={}", self.scale)?;
        }
        for (set, word) in [(self.edges, "edges"), (self.fit, "fit")] {
            if set {
                write!(f, ",{word}")?;
            }
        }
        Ok(())
    }
}

by_text!(MeshBeside);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_follow_the_file() {
        let plain: MeshBeside = "a.obj".parse().expect("a mesh");
        assert_eq!(plain, MeshBeside::new("a.obj"));
        let text = "a,b=c.v2.STL,opacity=0.25,edges,color=#102030,scale=1e-3,fit";
        let all: MeshBeside = text.parse().expect("a mesh");
        let expected = MeshBeside {
            color: Some(Color([16, 32, 48])),
            opacity: 0.25,
            edges: true,
            scale: 1e-3,
            fit: true,
            ..MeshBeside::new("a,b=c.v2.STL")
        };
        assert_eq!(all, expected);
        assert_eq!(all.to_string().parse(), Ok(expected));
        for (text, said) in [
            ("a.obj,opacity=2", "from 0 to 1"),
            ("a.obj,scale=0", "above 0"),
            ("a.obj,colour=red", "'colour=red' is no option"),
            ("a.obj,color=reddish", "RRGGBB"),
        ] {
            let error = text.parse::<MeshBeside>().expect_err(text);
            assert!(error.contains(said), "{error}");
        }
    }
}
