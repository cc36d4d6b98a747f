// Corners read from the packed mesh, in the coordinates of their part.
//
// Used by plan.wgsl in shaders that do not compute corners beforehand.

#import template.wgsl

alias CornerSource = Base;

fn base_of(source: CornerSource) -> Base {
    return source;
}

fn corner_of(source: CornerSource, vertex: u32) -> Corner {
    return corner(source, vertex);
}
