//! Tests that the bindings of every entry point equal the layouts of its pipeline.

use neurotess_refine::testing::{self, naga};
use neurotess_refine::wgsl::{Shader, WgslFile};
use wgpu::{BindGroupLayoutEntry, BindingType, BufferBindingType, ShaderStages};

use crate::gpu::shader::{FILES, file};
use crate::output::composite::{self, composite_shader};
use crate::output::ids::ids_shader;
use crate::output::static_picture::collect::{self, collect_shader};
use crate::output::static_picture::recolor::{self, recolor_shader};
use crate::scene::templates;
use crate::shading::finish::{self, FINDING, Last, finish_shader};
use crate::shading::keyed::keyed_shader;
use crate::shading::present::{gather_entries, mask_shader, present_shader, show_entries};
use crate::shading::shade::{self, PipelineKey, shade_shader};
use crate::sources::adaptive::expand::{self, expand_shader};
use crate::sources::adaptive::layouts::{clusters_entries, drawing_entries, written_entries};
use crate::sources::adaptive::passes::{ENTRIES, modules};
use crate::sources::adaptive::refiner::Refiner;
use crate::sources::budgeted;
use crate::sources::markers;
use crate::sources::meshes;
use crate::sources::prerefined;

type Groups = Vec<Vec<BindGroupLayoutEntry>>;

/// Compares what an entry point uses with the layouts of its pipeline.
fn assert_bindings(shader: &Shader, entry: &str, groups: &Groups) {
    let (module, info) = testing::check(shader);
    let entries = module.entry_points.iter();
    let place = entries.clone().position(|e| e.name == entry);
    let place = place.unwrap_or_else(|| panic!("{}: no entry point {entry}", shader.name));
    let stage = match module.entry_points[place].stage {
        naga::ShaderStage::Vertex => ShaderStages::VERTEX,
        naga::ShaderStage::Fragment => ShaderStages::FRAGMENT,
        _ => ShaderStages::COMPUTE,
    };
    let used = info.get_entry_point(place);
    for (handle, variable) in module.global_variables.iter() {
        let Some(naga::ResourceBinding { group, binding }) = variable.binding else {
            continue;
        };
        if used[handle].is_empty() {
            continue;
        }
        let name = variable.name.as_deref().unwrap_or_default();
        let what = format!("{}, {entry}: {name} at {group}, {binding}", shader.name);
        let ours = groups.get(group as usize).into_iter().flatten();
        let ours = ours.clone().find(|e| e.binding == binding);
        let ours = ours.unwrap_or_else(|| panic!("{what}: Rust binds nothing there"));
        assert!(ours.visibility.contains(stage), "{what}: not seen");
        let theirs = &module.types[variable.ty].inner;
        assert_eq!(
            kind_of(&ours.ty),
            kind_in_shader(variable.space, theirs),
            "{what}"
        );
    }
}

/// The type of a binding as text, to be compared with that of a shader's variable.
fn kind_of(ty: &BindingType) -> String {
    match ty {
        BindingType::Buffer { ty, .. } => match ty {
            BufferBindingType::Uniform => "uniform".into(),
            BufferBindingType::Storage { read_only } => format!("storage, read only: {read_only}"),
        },
        BindingType::Texture {
            sample_type,
            multisampled,
            ..
        } => {
            let whole = matches!(sample_type, wgpu::TextureSampleType::Uint);
            format!("texture, whole: {whole}, multisampled: {multisampled}")
        }
        other => format!("{other:?}"),
    }
}

fn kind_in_shader(space: naga::AddressSpace, inner: &naga::TypeInner) -> String {
    match (space, inner) {
        (naga::AddressSpace::Uniform, _) => "uniform".into(),
        (naga::AddressSpace::Storage { access }, _) => {
            let written = access.contains(naga::StorageAccess::STORE);
            format!("storage, read only: {}", !written)
        }
        (_, naga::TypeInner::Image { class, .. }) => match class {
            naga::ImageClass::Sampled { kind, multi } => {
                let whole = *kind == naga::ScalarKind::Uint;
                format!("texture, whole: {whole}, multisampled: {multi}")
            }
            other => format!("{other:?}"),
        },
        other => format!("{other:?}"),
    }
}

#[test]
fn passes_of_adaptive_refinement_bind_what_their_shaders_have() {
    let modules = modules();
    for (module, entry, written) in ENTRIES {
        let groups = vec![
            templates::entries(),
            clusters_entries(),
            written_entries(written),
        ];
        assert_bindings(&modules[module], entry, &groups);
    }
    let groups = vec![drawing_entries(), expand::entries()];
    assert_bindings(&expand_shader(), "expand", &groups);
}

#[test]
fn passes_of_exploration_bind_what_their_shaders_have() {
    let shader = budgeted::passes::select_shader();
    for step in &budgeted::passes::STEPS {
        assert_bindings(&shader, step.entry, &vec![step.entries()]);
    }
}

#[test]
fn pictures_bind_what_their_shaders_have() {
    let adaptive = (0..Refiner::SHADERS).map(|shader| {
        let more = Some(["surface_id.wgsl", "vertex_keys.wgsl"]);
        (Refiner::vertex_shader(shader), drawing_entries(), more)
    });
    let budgeted = (
        budgeted::passes::vertex_shader(),
        budgeted::passes::drawing_entries(),
        Some(["visible_chunks_id.wgsl", "visible_chunk_keys.wgsl"]),
    );
    let prerefined = (prerefined::vertex_shader(true), prerefined::entries(), None);
    let markers = (
        markers::vertex_shader(),
        markers::entries(),
        Some(["marker_id.wgsl", "marker_keys.wgsl"]),
    );
    let meshes = (
        meshes::vertex_shader(),
        meshes::entries(),
        Some(["mesh_id.wgsl", "mesh_keys.wgsl"]),
    );
    for (source, entries, more) in adaptive.chain([budgeted, prerefined, markers, meshes]) {
        let groups = vec![entries, shade::entries()];
        for samples in [1, 4] {
            let key = PipelineKey {
                samples,
                valued: true,
                ..PipelineKey::default()
            };
            let shader = shade_shader(&source, key);
            assert_bindings(&shader, "vertex", &groups);
            assert_bindings(&shader, "fragment", &groups);
        }
        let Some([id, keys]) = more else {
            continue;
        };
        let shader = ids_shader(&source, file(id));
        assert_bindings(&shader, "vertex_id", &groups);
        assert_bindings(&shader, "fragment_id", &groups);
        for samples in [1, 4] {
            let key = PipelineKey {
                samples,
                ..PipelineKey::default()
            };
            let shader = keyed_shader(&source, file(keys), key);
            assert_bindings(&shader, "vertex_keyed", &groups);
            assert_bindings(&shader, "fragment_keyed", &groups);
        }
    }
    for samples in [1, 4] {
        for (last, entry) in [(Last::Gather, "gather"), (Last::Accumulate, "accumulate")] {
            let shader = finish_shader(samples, last);
            let mut groups = vec![finish::entries(samples > 1, last)];
            for entry in ["copy_depths", "occlude", "blur_rows", "blur_columns", entry] {
                assert_bindings(&shader, entry, &groups);
            }
            groups.push(finish::dispatch_entries());
            for entry in FINDING {
                assert_bindings(&shader, entry, &groups);
            }
        }
        let groups = vec![
            finish::entries(samples > 1, Last::Gather),
            collect::entries(samples > 1),
        ];
        assert_bindings(&collect_shader(samples), "collect", &groups);
        let groups = vec![gather_entries(samples)];
        assert_bindings(&mask_shader(samples), "gather", &groups);
    }
    assert_bindings(&present_shader(), "show", &vec![show_entries()]);
    for (samples, per_sample) in [(1, false), (4, false), (4, true)] {
        let groups = vec![composite::entries(samples, per_sample)];
        let shader = composite_shader(samples, per_sample);
        assert_bindings(&shader, "compose", &groups);
    }
    let groups = vec![recolor::entries()];
    assert_bindings(&recolor_shader(), "recolor_pixels", &groups);
}

#[test]
fn a_binding_that_differs_is_found() {
    let mut groups = vec![show_entries()];
    groups[0][1] = crate::gpu::buffers::storage(1, ShaderStages::FRAGMENT, false);
    let compared = std::panic::catch_unwind(|| assert_bindings(&present_shader(), "show", &groups));
    assert!(compared.is_err());
}

#[test]
fn every_file_is_used_and_begins_with_what_it_is() {
    let imports = |name: &str| {
        FILES
            .iter()
            .any(|f| f.text.contains(&format!("#import {name}\n")))
    };
    let composed = [
        "classify",
        "cull",
        "note",
        "coarse",
        "scan",
        "flatten",
        "list",
        "expand",
        "vertices",
        "surface_id",
        "surface_key",
        "vertex_keys",
        "prerefined",
        "marker_id",
        "marker_keys",
        "sheets",
        "mesh_id",
        "mesh_keys",
        "select",
        "visible_chunks",
        "visible_chunks_id",
        "visible_chunk_keys",
        "shade",
        "occlusion",
        "gather",
        "accumulate",
        "mask",
        "present",
        "ids",
        "composite",
        "keyed",
        "collect",
        "recolor",
    ];
    for file in &FILES {
        let WgslFile { name, text } = file;
        assert!(text.starts_with("// "), "{name} does not say what it is");
        let stem = name.trim_end_matches(".wgsl");
        assert!(
            imports(name) || composed.contains(&stem),
            "{name} is not used"
        );
    }
}
