"""Options of pictures in groups: ``camera={"view": "iso"}`` is ``view="iso"``."""

from __future__ import annotations

from collections.abc import Mapping

from ._errors import OptionError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

#: By group the name of an option in it, and outside.
GROUPS = {
    "camera": {name: name for name in ("view", "eye", "target", "up", "fov", "orthographic")},
    "scene": {
        name: name
        for name in ("background", "transparent", "light", "ao", "meshes", "legend", "scale_bar", "axes")
    },
    "markers": {
        "synapses": "synapses",
        "side": "synapse_side",
        "points": "points",
        "color_by": "marker_color_by",
        "shape": "marker_shape",
        "size": "marker_size",
    },
}
#: What options are if nothing is said, but for None and False.
USUAL = {"legend": True}


def ungrouped(options: Mapping[str, Any]) -> dict[str, Any]:
    """All options without groups. What is said twice is an error."""
    flat = {name: value for name, value in options.items() if name not in GROUPS}
    for group, names in GROUPS.items():
        if not isinstance(options.get(group) or {}, Mapping):
            needed = f"a dictionary is needed, as in {{{next(iter(names))!r}: …}}"
            raise OptionError(f"{group}={options[group]!r}: {needed}", group, needed)
        for name, value in (options.get(group) or {}).items():
            if name not in names:
                from difflib import get_close_matches

                near = get_close_matches(str(name), names, 1)
                hint = f"did you mean {near[0]!r}?" if near else f"it has {', '.join(map(repr, names))}"
                raise ValueError(f"{group}= has no {name!r}: {hint}")
            other = names[name]
            if flat.get(other, None) not in (None, False, USUAL.get(other)):
                raise ValueError(f"{other}= is said twice: leave it out, or {name!r} of {group}=")
            flat[other] = value
    return flat
