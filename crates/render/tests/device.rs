//! The device itself.
mod adapter;

use adapter::{device, gpu};

#[neurotess_testing::test(needs(gpu))]
fn complaints_are_kept_until_asked_for() {
    let gpu = device();
    let _ = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: !3,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    assert!(gpu.check().is_err());
    assert_eq!(gpu.check(), Ok(()));
}

neurotess_testing::main!();
