"""A page in a notebook: a frame that holds it."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os
    from pathlib import Path


def framed(page: str, size: tuple[int, int], key: str | None = None) -> str:
    """A page in a frame of this size (pixels). What it holds means nothing in HTML but for two signs. `key`: by which
    widget.js finds it."""
    text = page.replace("&", "&amp;").replace('"', "&quot;")
    width, height = size
    style = f"width:{width}px;max-width:100%;height:{height}px;border:0"
    known = "" if key is None else f' data-view="{key}"'
    return f'<iframe title="Cells in three dimensions"{known} style="{style}" srcdoc="{text}"></iframe>'


def saved(page: str, path: str | os.PathLike[str]) -> Path:
    """Writes a page to a file, which must not exist."""
    from pathlib import Path

    with open(path, "x", encoding="utf-8", newline="\n") as file:
        file.write(page)
    return Path(path)
