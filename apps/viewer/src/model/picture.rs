//! What the window shows as a picture of the library, and back: saved pictures tell it, and options and pictures of others
//! are taken from it.

use neurotess::options::Picture;
use neurotess::options::groups::{CameraOptions, ColorOptions, MarkerOptions, ShapeOptions};
use neurotess::options::words::{
    Color, ColorWhat, DrawnAs, Fit, LightFrom, MeshBeside, NotNegative, PaletteName, Point,
    Positive, RadiusFactor, Ring, SideOfSynapse, Size, Soma, Time, Within,
};
use neurotess::render::{MarkerShape, Side};

use crate::model::document::{
    self, ColorBy, Document, Lighting, Look, MeshEntry, Method, SomaEdit, SourceId, VisibleParts,
};
use crate::model::save::PictureFile;
use crate::model::view::View;

/// Options that the window does not take, and why.
pub const NOT_TAKEN: [(&str, &str); 19] = [
    ("samples", SAVED),
    ("transparent", SAVED),
    ("saved_view", "views are saved in sessions: open one"),
    ("turntable", FILMS),
    ("frames", FILMS),
    ("picture_times", FILMS),
    ("lod", LEVELS),
    ("level", LEVELS),
    ("pixels", LEVELS),
    ("budget", LEVELS),
    ("radius", EDITED),
    ("min_radius", EDITED),
    ("types", EDITED),
    ("nodes", SELECTED),
    ("node_set", SELECTED),
    ("population", SELECTED),
    ("sample", SELECTED),
    ("sample_seed", SELECTED),
    ("region", SELECTED),
];
const SAVED: &str = "it is chosen where pictures are saved";
const FILMS: &str = "films are saved along views";
const LEVELS: &str = "the window chooses levels by itself";
const EDITED: &str = "edit the tracing before, by neurotess convert";
const SELECTED: &str = "the window opens whole circuits: select and hide there";

/// A picture that tells what the window shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ToldPicture {
    /// All of it that options can tell, but for the camera and the time.
    pub(crate) picture: Picture,
    /// What of it they cannot.
    pub(crate) left_out: Vec<&'static str>,
    /// The side from which everything is seen, and the view that this is.
    pub(crate) fitted: Option<(Side, View)>,
}

impl ToldPicture {
    /// What the window shows.
    pub(crate) fn of(document: &Document) -> Self {
        let mut told = Self::default();
        let (look, picture) = (&document.look, &mut told.picture);
        picture.look.no_legend = !look.legend;
        picture.look.scale_bar = look.scale_bar.then_some(Fit::Auto);
        picture.look.axes = look.axes;
        picture.look.wireframe = look.wireframe;
        picture.look.trim_colormap = look.trim_map;
        picture.look.light = LightFrom(look.light.light());
        picture.look.ao = (!look.occlusion).then_some(Fit::Length(0.0));
        let width = look.least_width.map(|_| look.least_width_of(0));
        picture.look.least_width = width.map(|width| NotNegative(f64::from(width)));
        picture.colors = colors(look, document);
        told.picture.shape = told.shape(document);
        told.picture.markers = told.markers(document);
        let meshes = document.meshes.iter().filter(|mesh| !mesh.hidden);
        told.picture.meshes.mesh = meshes.map(beside).collect();
        let selected = !document.neurons.selected().is_empty();
        let values = look.color_by == ColorBy::Value;
        for (what, is) in [
            ("hidden neurons", !document.neurons.hidden().is_empty()),
            ("a cut", look.cut.is_some()),
            ("somata only", look.parts == VisibleParts::Soma),
            ("neurites only", look.parts == VisibleParts::Neurites),
            (
                "a selection",
                selected && (look.highlight_selected || look.ghost_others),
            ),
            (
                "a decay of its own",
                values && look.decay != Look::default().decay,
            ),
            ("cells side by side", document.grid),
            ("dimensions", !document.dimensions.is_empty()),
        ] {
            if is {
                told.left_out.push(what);
            }
        }
        told
    }

    /// The same as a file of this picture tells it, from where it was drawn, at its time (ms) of the recording.
    pub(crate) fn file(&self, file: &PictureFile, view: &View, time: Option<f64>) -> Picture {
        let mut picture = self.picture.clone();
        picture.look.size = Size(file.size);
        picture.look.samples = Within(file.samples);
        picture.look.transparent = file.transparent;
        if file.transparent {
            picture.colors.background = None;
        }
        let camera = &mut picture.camera;
        camera.fov = view.fov;
        camera.orthographic = view.orthographic.then_some(Fit::Auto);
        match self.fitted {
            Some((side, fitted)) if fitted == *view => camera.view = side.into(),
            _ => {
                camera.eye = Some(Point(view.eye.into()));
                camera.target = Some(Point(view.target.into()));
                camera.up = Point(view.up.into());
            }
        }
        camera.time = time
            .filter(|_| picture.colors.report.is_some())
            .map(Time::At);
        picture
    }

    fn shape(&mut self, document: &Document) -> ShapeOptions {
        let mut shape = ShapeOptions::default();
        let factor = document.look.radius_factor();
        shape.radius_factor = (factor != 1.0).then_some(RadiusFactor(factor));
        let mut sources: Vec<SourceId> = document.neurons.iter().map(|n| n.source).collect();
        sources.sort();
        sources.dedup();
        let edits: Vec<SomaEdit> = sources.iter().map(|&id| document.soma(id)).collect();
        let Some(first) = edits.first() else {
            return shape;
        };
        if edits.iter().all(|edit| edit.method == first.method) {
            shape.soma = first.method.into();
        }
        if edits.len() == 1 {
            let rings = first.rings.iter();
            shape.rings.ring = rings
                .map(|(&neurite, &position)| Ring { neurite, position })
                .collect();
        }
        let options = |edit: &SomaEdit| {
            SomaEdit {
                method: shape.soma.into(),
                rings: shape.rings.positions(),
                ..SomaEdit::default()
            } == *edit
        };
        if !edits.iter().all(options) {
            self.left_out.push("edits of somata");
        }
        shape
    }

    fn markers(&mut self, document: &Document) -> MarkerOptions {
        let shown = &document.markers;
        let mut markers = MarkerOptions::default();
        if !shown.any() {
            return markers;
        }
        if shown.synapses {
            let all = || vec!["all".to_owned()];
            let edges = Some(shown.edges.clone()).filter(|edges| !edges.is_empty());
            markers.synapses = Some(edges.unwrap_or_else(all));
            markers.synapse_side = match shown.side {
                neurotess::circuit::SynapseSide::Afferent => SideOfSynapse::Afferent,
                neurotess::circuit::SynapseSide::Efferent => SideOfSynapse::Efferent,
            };
            markers.marker_color_by = shown.property.clone();
            if shown.points.is_some() {
                self.left_out.push("points");
            }
        } else {
            markers.points = shown.points.clone();
            markers.marker_color_by = shown.column.clone();
        }
        markers.marker_shape = Some(match shown.shape {
            MarkerShape::Point => DrawnAs::Point,
            MarkerShape::Contact if shown.synapses => DrawnAs::Contact,
            MarkerShape::Sphere | MarkerShape::Contact => DrawnAs::Sphere,
        });
        markers.marker_size = Some(Positive(f64::from(shown.size)));
        markers
    }
}

fn colors(look: &Look, document: &Document) -> ColorOptions {
    let mut palette = PaletteName::of(look.palette);
    palette.colors.own_colors = look.own_colors.clone();
    palette.colors.background = Some(look.background);
    let colors = ColorOptions {
        color_by: what(look.color_by),
        color_by_attribute: None,
        report: None,
        range: look
            .range
            .filter(|[low, high]| look.color_by.has_range() && low < high),
        palette,
        colormap: look.color_map,
        ..ColorOptions::default()
    };
    let mut colors = colors.without_file();
    match look.color_by {
        ColorBy::Attribute => colors.color_by_attribute = Some(look.attribute.clone()),
        ColorBy::Value => colors.report = document.report.clone(),
        _ => {}
    }
    colors
}

fn what(by: ColorBy) -> Option<ColorWhat> {
    Some(match by {
        ColorBy::Type => ColorWhat::Type,
        ColorBy::Neuron => ColorWhat::Neuron,
        ColorBy::Neurite => ColorWhat::Neurite,
        ColorBy::Section => ColorWhat::Section,
        ColorBy::BranchOrder => ColorWhat::Order,
        ColorBy::Radius => ColorWhat::Radius,
        ColorBy::PathDistance => ColorWhat::Depth,
        ColorBy::Attribute | ColorBy::Value => return None,
    })
}

fn by(what: ColorWhat) -> ColorBy {
    match what {
        ColorWhat::Type => ColorBy::Type,
        ColorWhat::Neuron => ColorBy::Neuron,
        ColorWhat::Neurite => ColorBy::Neurite,
        ColorWhat::Section => ColorBy::Section,
        ColorWhat::Order => ColorBy::BranchOrder,
        ColorWhat::Radius => ColorBy::Radius,
        ColorWhat::Depth => ColorBy::PathDistance,
        ColorWhat::Value => ColorBy::Value,
    }
}

fn beside(mesh: &MeshEntry) -> MeshBeside {
    MeshBeside {
        color: Some(Color(mesh.color)),
        opacity: f64::from(mesh.opacity),
        edges: mesh.edges,
        scale: mesh.um(),
        // There the camera fits all that one cannot see through.
        ..MeshBeside::new(&mesh.file)
    }
}

/// A mesh of the window. `index`: how many there are already, which decides its color.
fn entry(mesh: &MeshBeside, index: usize) -> MeshEntry {
    let usual = MeshEntry::new(mesh.file.clone(), index);
    MeshEntry {
        color: mesh.color.map_or(usual.color, |color| color.0),
        opacity: mesh.opacity as f32,
        edges: mesh.edges,
        scale: mesh.scale as f32,
        ..usual
    }
}

impl From<Method> for Soma {
    fn from(method: Method) -> Self {
        match method {
            Method::Elastic => Self::Fem,
            Method::Sphere => Self::Sphere,
            Method::Profile => Self::Profile,
            Method::None => Self::None,
        }
    }
}

impl From<Soma> for Method {
    fn from(soma: Soma) -> Self {
        match soma {
            Soma::Fem => Self::Elastic,
            Soma::Sphere => Self::Sphere,
            Soma::Profile => Self::Profile,
            Soma::None => Self::None,
        }
    }
}

/// How somata of a picture are made.
pub(crate) fn soma(shape: &ShapeOptions) -> SomaEdit {
    SomaEdit {
        method: shape.soma.into(),
        rings: shape.rings.positions(),
        ..SomaEdit::default()
    }
}

/// Where a picture looks from, if it says so.
pub(crate) enum Looked {
    /// At everything from a side.
    From(Side),
    /// From a point.
    At(View),
}

/// Where a picture looks from, and how.
pub(crate) fn looked(camera: &CameraOptions) -> Looked {
    match (camera.eye, camera.target) {
        (Some(eye), Some(target)) => Looked::At(View {
            eye: eye.0.to_array(),
            target: target.0.to_array(),
            up: camera.up.0.to_array(),
            fov: camera.fov,
            orthographic: camera.orthographic.is_some(),
        }),
        _ => Looked::From(camera.view.into()),
    }
}

impl Document {
    /// Shows what a picture shows, as far as the window can: its colors, look, markers and meshes. What the picture has as
    /// the window shows it already stays, with all that options cannot tell.
    pub(crate) fn take(&mut self, picture: &Picture) {
        let now = ToldPicture::of(self).picture;
        self.take_look(picture, &now);
        if picture.colors != now.colors {
            self.take_colors(&picture.colors);
        }
        if picture.markers != now.markers {
            self.markers = markers(&picture.markers);
        }
        if picture.meshes != now.meshes {
            let meshes = picture.meshes.mesh.iter().enumerate();
            *self.meshes = meshes.map(|(index, mesh)| entry(mesh, index)).collect();
        }
    }

    fn take_look(&mut self, picture: &Picture, now: &Picture) {
        let (look, from) = (&mut self.look, &picture.look);
        look.legend = !from.no_legend;
        look.scale_bar = from.scale_bar.is_some();
        look.axes = from.axes;
        look.wireframe = from.wireframe;
        look.trim_map = from.trim_colormap;
        if from.light != now.look.light {
            look.light = Lighting::of(from.light.0);
        }
        look.occlusion = from.ao != Some(Fit::Length(0.0));
        look.least_width = from.least_width.map(|width| width.0 as f32);
        look.radius_factor = picture.shape.factor();
    }

    fn take_colors(&mut self, colors: &ColorOptions) {
        let look = &mut self.look;
        look.palette = colors.base_palette();
        look.own_colors = colors.own_colors();
        look.background = colors.behind().unwrap_or(look.background);
        look.color_map = colors.colormap;
        look.range = colors.range;
        let attribute = colors.color_by_attribute.clone();
        look.color_by = match (&attribute, colors.color_by) {
            (Some(_), _) => ColorBy::Attribute,
            (None, Some(what)) => by(what),
            (None, None) => ColorBy::Type,
        };
        look.attribute = attribute.unwrap_or_default();
        if colors.report.is_some() {
            self.set_report(colors.report.clone());
        }
    }
}

fn markers(from: &MarkerOptions) -> document::MarkerOptions {
    let usual = document::MarkerOptions::default();
    let by = from.marker_color_by.clone();
    document::MarkerOptions {
        synapses: from.synapses.is_some(),
        edges: from.populations(),
        side: from.synapse_side.into(),
        property: by.clone().filter(|_| from.synapses.is_some()),
        column: by.filter(|_| from.points.is_some()),
        points: from.points.clone(),
        shape: from.shape(),
        size: from.marker_size.map_or(usual.size, |size| size.0 as f32),
        ..usual
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Options of all groups that the window takes, not as they usually are.
    fn options() -> Picture {
        let mut picture = Picture::default();
        for (name, value) in [
            ("no_legend", json!(true)),
            ("scale_bar", json!(true)),
            ("axes", json!(true)),
            ("wireframe", json!(true)),
            ("trim_colormap", json!(true)),
            ("light", json!("flat")),
            ("ao", json!(0)),
            ("least_width", json!(2.5)),
            ("radius_factor", json!(2)),
            ("color_by", json!("depth")),
            ("range", json!([0, 300])),
            ("palette", json!("okabe-ito")),
            ("set_color", json!({ "axon": "#ff8800", "L5": "#010203" })),
            ("colormap", json!("magma")),
            ("background", json!("black")),
            ("points", json!("spines.csv")),
            ("marker_color_by", json!("weight")),
            ("marker_size", json!(3)),
            ("mesh", json!("region.obj,opacity=0.25,scale=0.001")),
        ] {
            picture.set(name, &value).expect(name);
        }
        picture
    }

    #[test]
    fn what_is_taken_is_told() {
        let mut document = Document::default();
        document.take(&options());
        let told = ToldPicture::of(&document);
        assert_eq!(told.left_out, Vec::<&str>::new());
        let mut asked = options();
        // The window says what a picture leaves to what is usual.
        asked.markers.marker_shape = Some(DrawnAs::Sphere);
        asked.meshes.mesh[0].color = Some(Color(MeshEntry::new("".into(), 0).color));
        assert_eq!(told.picture.to_json(), asked.to_json());
        // Nothing of it changes what shows already, nor what options cannot tell.
        document.look.cut = Some(document::Cut {
            axis: 1,
            place: 0.5,
            flipped: true,
        });
        document.look.light = Lighting::From {
            right: 20.0,
            up: 30.0,
        };
        let before = document.clone();
        let told = ToldPicture::of(&document);
        assert_eq!(told.left_out, ["a cut"]);
        document.take(&told.picture);
        assert_eq!(document, before);
        let Lighting::From { right, up } = Lighting::of(told.picture.look.light.0) else {
            panic!("a direction");
        };
        assert!((right - 20.0).abs() < 1e-3 && (up - 30.0).abs() < 1e-3);
    }
}
