//! The adapters of this machine, and which of them draws.

use wgpu::{Adapter, Backend, Backends, DeviceType, DownlevelFlags};

use crate::gpu::error::DeviceError;

/// Environment variable that names the adapter if nothing else does.
pub const ADAPTER_VARIABLE: &str = "NEUROTESS_ADAPTER";

/// Names of backends.
const BACKENDS: [&str; 4] = ["vulkan", "metal", "dx12", "gl"];

/// What an adapter must be able to do, and how users call it.
const NEEDED: [(DownlevelFlags, &str); 3] = [
    (DownlevelFlags::COMPUTE_SHADERS, "compute shaders"),
    (
        DownlevelFlags::VERTEX_STORAGE,
        "storage buffers in vertex shaders",
    ),
    (DownlevelFlags::INDIRECT_EXECUTION, "indirect drawing"),
];

/// Name of an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterName {
    /// Name and driver, as in `llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 22.3.6`.
    pub name: String,
    /// `vulkan`, `metal`, `dx12` or `gl`.
    pub backend: String,
    /// Whether it draws on the CPU.
    pub software: bool,
}

/// Names of all adapters that can draw, the best first.
pub fn adapters() -> Vec<AdapterName> {
    let mut adapters = found(Backends::PRIMARY);
    adapters.extend(found(Backends::SECONDARY));
    adapters
        .iter()
        .filter(|a| lacks(a).is_empty())
        .map(name)
        .collect()
}

/// The best adapter, or the best of those that `wanted` means; without `wanted`, [`ADAPTER_VARIABLE`]
/// decides, if it is set.
pub(crate) fn find_adapter(wanted: Option<&str>) -> Result<Adapter, DeviceError> {
    // OpenGL last and only if needed, since without a display it prints messages when it starts.
    let mut adapters = found(Backends::PRIMARY);
    select_adapter(&adapters, wanted).or_else(|_| {
        adapters.extend(found(Backends::SECONDARY));
        select_adapter(&adapters, wanted)
    })
}

/// The best of these adapters that can do what we need, or the best whose backend is `wanted` or whose
/// name contains it; without `wanted`, [`ADAPTER_VARIABLE`] decides, if it is set.
///
/// # Errors
/// No such adapter, or none that can do what we need.
pub fn select_adapter(adapters: &[Adapter], wanted: Option<&str>) -> Result<Adapter, DeviceError> {
    let variable = std::env::var(ADAPTER_VARIABLE).ok();
    let wanted = wanted.or(variable.as_deref()).filter(|w| !w.is_empty());
    let mut sorted: Vec<&Adapter> = adapters.iter().collect();
    sorted.sort_by_key(|adapter| rank(adapter));
    let candidates: Vec<Candidate> = sorted.iter().map(|a| Candidate::of(a)).collect();
    choose(&candidates, wanted).map(|place| sorted[place].clone())
}

/// The adapters of some backends, the best first.
fn found(backends: Backends) -> Vec<Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.sort_by_key(rank);
    adapters
}

/// Real GPUs first.
fn rank(adapter: &Adapter) -> u8 {
    match adapter.get_info().device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

/// What an adapter would have to be able to do.
pub(crate) fn lacks(adapter: &Adapter) -> Vec<&'static str> {
    let mut able = adapter.get_downlevel_capabilities().flags;
    let info = adapter.get_info();
    if info.backend == Backend::Gl && is_old_opengl(&info.driver_info) {
        able.remove(DownlevelFlags::COMPUTE_SHADERS | DownlevelFlags::VERTEX_STORAGE);
    }
    let missing = NEEDED.iter().filter(|(needed, _)| !able.contains(*needed));
    missing.map(|&(_, called)| called).collect()
}

/// Whether the version that a driver gives, as in `3.3.0 NVIDIA 580.159.04`, has no language for shaders that compute.
/// NVIDIA's is asked for 3.3 by wgpu, gives just that, and yet says that it computes (gfx-rs/wgpu#8676).
fn is_old_opengl(version: &str) -> bool {
    let mut numbers = version
        .split(|c: char| !c.is_ascii_digit())
        .map(str::parse::<u32>);
    match [numbers.next(), numbers.next()] {
        [Some(Ok(major)), Some(Ok(minor))] => (major, minor) < (4, 3),
        // OpenGL ES, whose capabilities are told right.
        _ => false,
    }
}

/// An adapter that may be chosen.
struct Candidate {
    name: AdapterName,
    lacks: Vec<&'static str>,
}

impl Candidate {
    fn of(adapter: &Adapter) -> Self {
        Self {
            name: name(adapter),
            lacks: lacks(adapter),
        }
    }

    /// Why it cannot draw.
    fn unable(&self) -> DeviceError {
        DeviceError::Unable {
            adapter: self.name.to_string(),
            lacks: self.lacks.clone(),
        }
    }
}

/// Index of the first that can draw, or of the first of those that `wanted` means.
fn choose(candidates: &[Candidate], wanted: Option<&str>) -> Result<usize, DeviceError> {
    let meant = |candidate: &Candidate| wanted.is_none_or(|w| candidate.name.answers_to(w));
    let able = |candidate: &Candidate| candidate.lacks.is_empty();
    if let Some(place) = candidates.iter().position(|c| able(c) && meant(c)) {
        return Ok(place);
    }
    // One that is there and cannot draw tells more than a list of the others.
    if let Some(unable) = candidates.iter().find(|c| meant(c)) {
        return Err(unable.unable());
    }
    let there: Vec<String> = candidates
        .iter()
        .filter(|c| able(c))
        .map(|c| c.name.to_string())
        .collect();
    match wanted {
        Some(wanted) if !there.is_empty() => Err(DeviceError::UnknownAdapter {
            wanted: wanted.to_owned(),
            there,
        }),
        _ => Err(DeviceError::NoAdapter),
    }
}

pub(crate) fn name(adapter: &Adapter) -> AdapterName {
    let info = adapter.get_info();
    let driver = [info.driver, info.driver_info].join(" ");
    let name = match driver.trim() {
        "" => info.name,
        driver => format!("{}, {driver}", info.name),
    };
    AdapterName {
        name,
        backend: info.backend.to_str().to_owned(),
        software: info.device_type == DeviceType::Cpu,
    }
}

impl AdapterName {
    /// Whether it is what a backend or a part of a name means. A backend means no names: "gl" is in those of
    /// Google's Vulkan drivers.
    fn answers_to(&self, wanted: &str) -> bool {
        let wanted = wanted.to_lowercase();
        match BACKENDS.contains(&wanted.as_str()) {
            true => self.backend == wanted,
            false => self.to_string().to_lowercase().contains(&wanted),
        }
    }
}

impl std::fmt::Display for AdapterName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} [{}]", self.name, self.backend)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(name: &str, backend: &str, lacks: &[&'static str]) -> Candidate {
        Candidate {
            name: AdapterName {
                name: name.into(),
                backend: backend.into(),
                software: true,
            },
            lacks: lacks.to_vec(),
        }
    }

    #[test]
    fn old_versions_of_opengl_cannot_compute() {
        for old in ["3.3.0 NVIDIA 580.159.04", "4.2 (Core Profile) Mesa 22.3.6"] {
            assert!(is_old_opengl(old), "{old}");
        }
        for new in [
            "4.5 (Core Profile) Mesa 22.3.6",
            "4.6.0 NVIDIA 580.159.04",
            "OpenGL ES 3.1 Mesa 22.3.6",
            "",
        ] {
            assert!(!is_old_opengl(new), "{new}");
        }
    }

    #[test]
    fn adapters_answer_to_their_backend_and_to_parts_of_their_name() {
        let lavapipe = candidate("llvmpipe (LLVM 15), Mesa", "vulkan", &[]).name;
        for yes in ["LLVMpipe", "vulkan", "mesa", "[vulkan]"] {
            assert!(lavapipe.answers_to(yes), "{yes}");
        }
        assert!(!lavapipe.answers_to("metal"));
        let google = candidate("SwiftShader Device (Subzero), Google", "vulkan", &[]).name;
        assert!(google.answers_to("google") && google.answers_to("Vulkan"));
        assert!(!google.answers_to("gl"), "it is no OpenGL");
    }

    #[test]
    fn the_first_that_can_draw_and_is_meant_is_chosen() {
        let all = [
            candidate("old", "gl", &["compute shaders"]),
            candidate("one", "vulkan", &[]),
            candidate("two", "gl", &[]),
        ];
        assert_eq!(choose(&all, None), Ok(1));
        assert_eq!(choose(&all, Some("gl")), Ok(2));
        let unable = choose(&all, Some("old"))
            .expect_err("it cannot draw")
            .to_string();
        assert!(
            unable.contains("old [gl]") && unable.contains("no compute shaders"),
            "{unable}"
        );
        assert_eq!(
            choose(&all, Some("three")),
            Err(DeviceError::UnknownAdapter {
                wanted: "three".into(),
                there: vec!["one [vulkan]".into(), "two [gl]".into()],
            })
        );
        assert!(matches!(
            choose(&all[..1], None),
            Err(DeviceError::Unable { .. })
        ));
        for wanted in [None, Some("one")] {
            assert_eq!(choose(&[], wanted), Err(DeviceError::NoAdapter));
        }
        assert_eq!(choose(&all[..1], Some("one")), Err(DeviceError::NoAdapter));
    }
}
