// Corners as they are resident, in the coordinates of their part.
//
// Called by plan.wgsl, where nobody has made corners beforehand.

alias Source = Base;

fn base_of(source: Source) -> Base {
    return source;
}

fn corner_of(source: Source, vertex: u32) -> Corner {
    return corner(source, vertex);
}
