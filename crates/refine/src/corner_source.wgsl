// Corners as they are resident, in the coordinates of their part.
//
// Called by plan.wgsl, where nobody has made corners beforehand.

#import template.wgsl

alias CornerSource = Base;

fn base_of(source: CornerSource) -> Base {
    return source;
}

fn corner_of(source: CornerSource, vertex: u32) -> Corner {
    return corner(source, vertex);
}
