//! Error scopes: how errors are kept on a device whose handlers are another program's.

use wgpu::{Device, Error, ErrorFilter, ErrorScopeGuard};

/// Scopes for errors of all kinds, of this thread.
pub(crate) struct Scopes([ErrorScopeGuard; 3]);

impl Scopes {
    pub(crate) fn open(device: &Device) -> Self {
        let kinds = [
            ErrorFilter::Validation,
            ErrorFilter::OutOfMemory,
            ErrorFilter::Internal,
        ];
        Self(kinds.map(|kind| device.push_error_scope(kind)))
    }

    /// What went wrong meanwhile, the first of each kind.
    pub(crate) fn close(self) -> impl Iterator<Item = Error> {
        // The one opened last is closed first. Errors are there at once: they arise in wgpu, before the driver works.
        let Self([validation, memory, internal]) = self;
        let internal = pollster::block_on(internal.pop());
        let memory = pollster::block_on(memory.pop());
        let validation = pollster::block_on(validation.pop());
        [memory, validation, internal].into_iter().flatten()
    }
}
