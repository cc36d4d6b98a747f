"""What is wrong with an option, in the words of who called a function: its name, what was given, what is possible."""

from __future__ import annotations

#: Options that have another name here.
NAMES = {"mesh": "meshes", "set_color": "palette", "no_legend": "legend", "no_cache": "cache"}

#: What is needed, where the command line's form of it is another.
NEEDED = {
    "ao": "True or a radius (µm) is needed",
    "background": "'white', 'black', 'gray' or a color is needed, as in '#102030'",
    "eye": "three numbers (µm) are needed, as in (0, 20, 80)",
    "light": "'soft', 'flat' or a direction is needed, as in (-1, 1, 1)",
    "mirror": "'x', 'y' or 'z' is needed, or several of them",
    "orthographic": "True, False or the height of the picture (µm) is needed",
    "range": "two numbers are needed, the lower first, as in (-80, 30)",
    "ring": "neurites from 1 on with positions from 0 to 2 are needed, as in {2: 0.5}",
    "rotate": "an axis and degrees are needed, as in {'z': 90}",
    "scale_bar": "True, False or a length (µm) is needed",
    "size": "a width and a height of 1 to 32768 pixels are needed, as in (1280, 960)",
    "target": "three numbers (µm) are needed, as in (0, 20, 80)",
    "units": "'um', 'nm' or the sides of a voxel (µm) are needed, as in (0.1, 0.1, 0.5)",
    "up": "three numbers are needed, as in (0, 0, 1)",
}

#: What parsers say, in plain words.
PLAIN = [
    (r"invalid digit found in string|cannot parse integer from empty string", "a whole number is needed"),
    (r"invalid float literal|cannot parse float from empty string", "a number is needed"),
    (r"number too (large|small) to fit in target type", r"that is too \1"),
    (r"\S+ is not in (\d+)\.\.=?(\d+)", r"a whole number from \1 to \2 is needed"),
    (r" ?\(os error \d+\)", ""),
]


def told(message: str) -> tuple[str | None, str | None, str]:
    """The option that a message is about, what was given, and what is needed; or no option and the whole message."""
    import re

    # The command line calls it ``--max-error <E>``.
    flag = r"--([a-z][a-z-]*)(?:\[=<[^>]*>\]| \[<[^>]*>\]| <[^>]*>)?"
    message = re.sub(flag, lambda name: name[1].replace("-", "_"), message)
    for said, plain in PLAIN:
        message = re.sub(said, plain, message)
    if found := re.fullmatch(r"unexpected value '(.*)' for '(\w+)' found;.*", message, re.DOTALL):
        return _named(found[2]), found[1], "True or False is needed"
    if found := re.fullmatch(r"invalid value '(.*)' for '(\w+)'(.*)", message, re.DOTALL):
        name, rest = _named(found[2]), found[3].strip()
        if possible := re.fullmatch(r"\[possible values: (.*)\]", rest):
            *others, last = (repr(value.strip()) for value in possible[1].split(","))
            return name, found[1], f"use {', '.join(others)} or {last}" if others else f"use {last}"
        return name, found[1], NEEDED.get(name, rest.removeprefix(":").strip() or "another value is needed")
    if found := re.fullmatch(r"the following required arguments were not provided:\s*(\w+)", message):
        return None, None, f"{found[1]}= is needed with these options"
    return None, None, message


def named(option: str, needed: str) -> tuple[str, str]:
    """An option of pictures and what it needs, as Python has them."""
    import re

    option = _named(option)
    if choices := re.fullmatch(r"use ((?:\S+, )*\S+) or (\S+)", needed):
        *others, last = (repr(name) for name in [*choices[1].split(", "), choices[2]])
        needed = f"use {', '.join(others)} or {last}"
    needed = re.sub(r"^true or false is needed$", "True or False is needed", needed)
    return option, NEEDED.get(option, needed)


def spoken(message: str) -> str:
    """What there is to say about a picture, with options as keywords: ``size=`` for ``--size``."""
    import re

    message = message.replace("--no-legend", "legend=False").replace("--palette okabe-ito", "palette='okabe-ito'")
    return re.sub(r"--([a-z][a-z-]*)", lambda flag: _named(flag[1].replace("-", "_")) + "=", message)


def _named(option: str) -> str:
    return NAMES.get(option, option)
