"""Pictures, and films of them."""

from __future__ import annotations

import math
import os
from numbers import Real

from . import _neurotess
from ._packages import needed

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import IO, Any

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._typed import Camera

#: Inches in a meter.
METER = 39.37007874


class Image:
    """A picture: ``np.asarray(picture)`` are its pixels, (height, width, 4) bytes of red, green, blue, alpha.

    It shows itself in a notebook.
    """

    camera: Camera | None
    """Where it was drawn from: ``render(other, camera=picture.camera)`` draws another cell from there."""

    def __init__(
        self,
        pixels: NDArray[np.uint8],
        *,
        transparent: bool = False,
        recipe: str | None = None,
        camera: Camera | None = None,
        scale: tuple[str, list[float], list[list[int]]] | None = None,
    ) -> None:
        self._pixels = pixels
        self._transparent = transparent
        self._recipe = recipe
        self.camera = camera
        self._scale = scale

    @classmethod
    def drawn(cls, drawing: _neurotess.Drawing, number: int) -> Image:
        """One of the pictures of a drawing."""
        eye, target, up, fov, orthographic = drawing.camera(number)
        return cls(
            drawing.draw(number),
            transparent=drawing.transparent,
            recipe=drawing.recipe(number),
            camera={
                "eye": list(eye),
                "target": list(target),
                "up": list(up),
                "fov": math.degrees(fov),
                "orthographic": orthographic,
            },
            scale=drawing.scale(number),
        )

    @property
    def size(self) -> tuple[int, int]:
        """Width and height (pixels)."""
        height, width, _ = self._pixels.shape
        return width, height

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points (µm), (n, 3), are in the picture: (n, 2) pixels from the left and from above. NaN behind the camera.

        >>> import neurotess as nt
        >>> cell = nt.synth("granule")
        >>> picture = nt.render(cell, size=(96, 64))
        >>> bool((picture.project(cell.points) < picture.size).all())
        True
        """
        import numpy as np

        if self.camera is None:
            raise ValueError("the picture does not tell its camera: only one that render or film drew does")
        points = np.atleast_2d(np.asarray(points, dtype=float))
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"points of shape {points.shape}: (n, 3) is needed")
        eye, target, up = (np.array(self.camera[name], dtype=float) for name in ("eye", "target", "up"))
        forward = target - eye
        distance = float(np.linalg.norm(forward))
        forward /= distance
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        offsets = points - eye
        depths = offsets @ forward
        width, height = self.size
        focal = height / 2 / math.tan(math.radians(self.camera["fov"] or 0) / 2)
        if self.camera["orthographic"]:
            scales = np.full(len(points), focal / distance)
        else:
            scales = focal / np.where(depths > 0, depths, np.nan)
        places = [width / 2 + scales * (offsets @ right), height / 2 - scales * (offsets @ np.cross(right, forward))]
        return np.stack(places, axis=1)

    @property
    def mappable(self) -> Any:
        """What ``fig.colorbar`` of matplotlib takes; None where colors tell no numbers. Its label is in ``mappable.label``."""
        if self._scale is None:
            return None
        cm, colors = needed("matplotlib.cm"), needed("matplotlib.colors")
        title, (low, high), listed = self._scale
        colormap = colors.ListedColormap([[part / 255 for part in color] for color in listed])
        mappable = cm.ScalarMappable(colors.Normalize(low, high), colormap)
        mappable.label = title
        return mappable

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        import numpy as np

        if copy:
            return np.array(self._pixels, dtype=dtype)
        return np.asarray(self._pixels, dtype=dtype)

    def to_png(self, *, dpi: float | None = None) -> bytes:
        """The bytes of a PNG file, which tells how the picture was made (see `like` of `render`), and with `dpi` how large it
        is on paper."""
        content = _neurotess.png(self._pixels, self._transparent, self._recipe)
        return content if dpi is None else _with_size(content, dpi)

    def save(
        self, path: str | os.PathLike[str] | IO[bytes], *, dpi: float | None = None, overwrite: bool = True
    ) -> None:
        """Writes a PNG file, or into an open one; other formats need Pillow. `dpi`: pixels of an inch on paper."""
        if not isinstance(path, (str, os.PathLike)):
            path.write(self.to_png(dpi=dpi))
            return
        extension = os.path.splitext(os.fspath(path))[1].lower()
        if not overwrite and os.path.exists(path):
            raise FileExistsError(f"{os.fspath(path)} exists")
        if extension in ("", ".png"):
            with open(path, "wb") as file:
                file.write(self.to_png(dpi=dpi))
        else:
            self.to_pillow().save(path, **({} if dpi is None else {"dpi": (dpi, dpi)}))

    def to_pillow(self) -> Any:
        """A `PIL.Image.Image`."""
        image = needed("PIL.Image").fromarray(self._pixels)
        return image if self._transparent else image.convert("RGB")

    def _repr_png_(self) -> bytes:
        return self.to_png()

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Image: {width} × {height}>"


def _with_size(content: bytes, dpi: float) -> bytes:
    """A PNG file with its pixels in a meter: chunk pHYs, before the pixels."""
    import struct
    import zlib

    if not (isinstance(dpi, Real) and 0 < dpi < 1e6):
        raise ValueError(f"dpi={dpi}: a number above 0 is needed")
    body = b"pHYs" + struct.pack(">IIB", *[round(dpi * METER)] * 2, 1)
    chunk = struct.pack(">I", 9) + body + struct.pack(">I", zlib.crc32(body))
    # Behind the signature and the first chunk, which is of one length.
    at = 8 + 25
    return content[:at] + chunk + content[at:]


class Film:
    """A series of pictures, each of which is drawn when it is asked for: ``for picture in film``."""

    def __init__(self, open: Callable[[], _neurotess.Drawing]) -> None:
        self._open = open
        self._drawing: _neurotess.Drawing | None = None
        self._next = 0

    def _opened(self) -> _neurotess.Drawing:
        if self._drawing is None:
            self._drawing = self._open()
        return self._drawing

    def __len__(self) -> int:
        return self._opened().pictures

    def __iter__(self) -> Iterator[Image]:
        drawing = self._opened()
        return (Image.drawn(drawing, number) for number in range(drawing.pictures))

    def __next__(self) -> Image:
        if self._next >= len(self):
            raise StopIteration
        self._next += 1
        return Image.drawn(self._opened(), self._next - 1)

    def save(self, path: str | os.PathLike[str], *, fps: float = 25, overwrite: bool = True) -> None:
        """Writes a film: ``.gif`` by Pillow; ``.mp4``, ``.webm`` and ``.mov`` by ffmpeg, the program or the package
        ``imageio-ffmpeg``. `fps`: pictures in a second."""
        path = os.fspath(path)
        if not overwrite and os.path.exists(path):
            raise FileExistsError(f"{path} exists")
        if not fps > 0:
            raise ValueError(f"fps={fps}: a number above 0 is needed")
        extension = os.path.splitext(path)[1].lower()
        if extension == ".gif":
            first, *others = (picture.to_pillow().convert("P", palette=1) for picture in self)
            first.save(path, save_all=True, append_images=others, duration=round(1000 / fps), loop=0)
        elif extension in (".mp4", ".webm", ".mov"):
            _encoded(self, path, fps)
        else:
            raise ValueError(f"{path}: a film is .gif, .mp4, .webm or .mov; pictures one by one: for picture in film")

    def __repr__(self) -> str:
        return "<Film>" if self._drawing is None else f"<Film of {len(self)} pictures>"


def _encoded(film: Film, path: str, fps: float) -> None:
    import subprocess
    from shutil import which

    program = which("ffmpeg") or needed("imageio_ffmpeg").get_ffmpeg_exe()
    pictures = iter(film)
    first = next(pictures)
    width, height = first.size
    raw = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{width}x{height}", "-r", str(fps), "-i", "-"]
    # Video has even sides, and players want this form of pixels.
    even = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]
    command = [program, "-y", "-loglevel", "error", *raw, *even, path]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as work:
        assert work.stdin is not None and work.stderr is not None
        try:
            for picture in (first, *pictures):
                work.stdin.write(picture._pixels.tobytes())
            work.stdin.close()
        except BrokenPipeError:
            pass
        told = work.stderr.read().decode(errors="replace").strip()
    if work.returncode:
        raise OSError(f"{path}: ffmpeg failed: {told}")
