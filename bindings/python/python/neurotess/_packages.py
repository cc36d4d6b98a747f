"""Other packages, which are imported when they are needed."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


#: Names by which pip knows packages that are imported by another.
INSTALLED_AS = {"PIL": "pillow"}


def needed(package: str, extra: str | None = None) -> Any:
    """Imports a package, or says how to install it."""
    import importlib

    try:
        return importlib.import_module(package)
    except ImportError as error:
        name = package.partition(".")[0]
        wanted = f"'neurotess[{extra}]'" if extra else INSTALLED_AS.get(name, name)
        raise ImportError(f"this needs {name}: pip install {wanted}", name=name) from error
