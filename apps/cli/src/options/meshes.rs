//! Meshes beside the cells of a picture.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use neurotess::picture::color::Rgb;

/// Which meshes, and how they look.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Meshes")]
pub(crate) struct MeshArgs {
    /// Show another mesh in the scene, such as a brain region, a segment of electron microscopy or a pipette:
    /// PLY, OBJ, STL, GLB or another format of neurotess check, in the coordinates of the scene (µm). Behind
    /// the file, in any order: color=COLOR; opacity=SHARE, 0 to 1; edges, to draw only the edges of its faces;
    /// scale=UM, the µm of a unit of the file (0.001: nm); fit, so that the camera fits it even if one can see
    /// through it. Repeatable
    #[arg(long, value_name = "FILE[,OPTION…]")]
    pub(crate) mesh: Vec<MeshArg>,
}

/// `--mesh`
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshArg {
    pub(crate) file: PathBuf,
    pub(crate) color: Option<Rgb>,
    pub(crate) opacity: f64,
    pub(crate) edges: bool,
    pub(crate) scale: f64,
    pub(crate) fit: bool,
}

impl MeshArg {
    fn new(file: &str) -> Self {
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
            ("color", Some(color)) => self.color = Some(neurotess::coloring::rgb(color)?),
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

impl FromStr for MeshArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').collect();
        // A file's name may have commas: what comes after its extension are options.
        let is_mesh = |part: &&str| {
            let format = neurotess::mesh::Format::from_extension(part.as_ref());
            format.is_ok()
        };
        let file = parts.iter().position(is_mesh).unwrap_or(0) + 1;
        let (name, options) = parts.split_at(file);
        let mut arg = Self::new(&name.join(","));
        for option in options {
            if !arg.set(option)? {
                return Err(format!(
                    "'{option}' is no option of a mesh: use color=C, opacity=O, edges, scale=S or fit"
                ));
            }
        }
        Ok(arg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_follow_the_file() {
        let plain: MeshArg = "a.obj".parse().expect("a mesh");
        assert_eq!(plain, MeshArg::new("a.obj"));
        let text = "a,b=c.v2.STL,opacity=0.25,edges,color=#102030,scale=1e-3,fit";
        let all: MeshArg = text.parse().expect("a mesh");
        let expected = MeshArg {
            color: Some([16, 32, 48]),
            opacity: 0.25,
            edges: true,
            scale: 1e-3,
            fit: true,
            ..MeshArg::new("a,b=c.v2.STL")
        };
        assert_eq!(all, expected);
        for (text, said) in [
            ("a.obj,opacity=2", "from 0 to 1"),
            ("a.obj,scale=0", "above 0"),
            ("a.obj,colour=red", "'colour=red' is no option"),
            ("a.obj,color=reddish", "RRGGBB"),
        ] {
            let error = text.parse::<MeshArg>().expect_err(text);
            assert!(error.contains(said), "{error}");
        }
    }
}
