//! Drawing without a window touches no window system.
//!
//! Mesa's Vulkan layer that selects devices asks for a Wayland display as soon as an instance is made
//! with the extensions of surfaces, which wgpu always asks for; where there is none, libwayland says
//! `error: XDG_RUNTIME_DIR is invalid or not set` on standard error, once for each instance. The layer
//! obeys a variable of the environment, which must be there when the program starts: setting it later
//! is unsafe where there are threads. So the program starts itself again with it, in the same process.
//!
//! Who chooses a device by that layer (MESA_VK_DEVICE_SELECT, DRI_PRIME) keeps it.

/// Tells Mesa's layer to stay away.
const OFF: &str = "NODEVICE_SELECT";

/// Starts the program again without the layer, if it would be there.
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
    // It returns only where it failed; then the message stays, and nothing else.
    drop(again.exec());
}

/// Other systems have no such layer.
#[cfg(not(target_os = "linux"))]
pub(crate) fn stay_away_from_windows() {
    let _none = OFF;
}
