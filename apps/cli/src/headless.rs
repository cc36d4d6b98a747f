//! Keeps drawing without a window away from window systems.
//!
//! Mesa's Vulkan layer that selects devices connects to a Wayland display as soon as an instance is
//! made with the extensions for surfaces, which wgpu always enables. Without a display, libwayland
//! prints `error: XDG_RUNTIME_DIR is invalid or not set` on standard error, once for each instance.
//! An environment variable turns the layer off. It must be set when the program starts, since
//! setting it later is unsafe with threads. So the program starts itself again with it, in the same
//! process.
//!
//! If the user selects a device by that layer (MESA_VK_DEVICE_SELECT, DRI_PRIME), it stays on.

/// Environment variable that turns Mesa's layer off.
const OFF: &str = "NODEVICE_SELECT";

/// Starts the program again without the layer, if it would be used.
#[cfg(target_os = "linux")]
pub(crate) fn stay_away_from_windows() {
    use std::os::unix::process::CommandExt;
    let set = |name: &str| std::env::var_os(name).is_some();
    if [OFF, "MESA_VK_DEVICE_SELECT", "DRI_PRIME"]
        .into_iter()
        .any(set)
    {
        return;
    }
    let mut arguments = std::env::args_os();
    let name = arguments.next().unwrap_or_default();
    let Ok(program) = std::env::current_exe() else {
        return;
    };
    let mut again = std::process::Command::new(program);
    again.arg0(name).args(arguments).env(OFF, "1");
    // It returns only if it failed; then libwayland's message appears, which is harmless.
    drop(again.exec());
}

/// Other systems have no such layer.
#[cfg(not(target_os = "linux"))]
pub(crate) fn stay_away_from_windows() {
    let _none = OFF;
}
