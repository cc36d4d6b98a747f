//! macOS links extension modules only if it is told that the interpreter has what they lack.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
