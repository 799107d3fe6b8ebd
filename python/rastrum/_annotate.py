# SPDX-License-Identifier: BSD-3-Clause
"""Words, axes and effects that are drawn over a picture with it."""

from collections.abc import Mapping

from . import _rastrum as _r
from ._arrays import number as _number
from ._errors import ArgumentError, ArgumentTypeError

#: name: its options and their defaults; None: by the scene
_EFFECTS = {"occlusion": {"radius": None, "strength": 1.0}, "edl": {"strength": 1.0}, "silhouettes": {},
            "edges": {"angle": 0.0, "width": 1.0}, "axes": {}, "bounds": {},
            "bar": {"title": "", "unit": "", "nan": False}}
_WORDS = ("title", "captions", "text_scale")


def _bar(options):
    if options is None:
        return None
    title, unit, nan = options["title"], options["unit"], options["nan"]
    if not isinstance(title, str) or not isinstance(unit, str) or not isinstance(nan, bool):
        raise ArgumentTypeError("annotate['bar']: title and unit must be strings, nan must be True or False")
    return title, unit, nan


def annotations(wanted):
    """The C++ form of render's `annotate`; None where it asks for nothing."""
    if isinstance(wanted, str):
        wanted = (wanted,)
    if not isinstance(wanted, Mapping):
        wanted = {name: True for name in wanted}
    effects = {}
    for name, value in wanted.items():
        if name in _WORDS:
            continue
        if name not in _EFFECTS:
            raise ArgumentError(f"annotate: there is no {name!r}; take some of {', '.join([*_EFFECTS, *_WORDS])}")
        if value is None or value is False:
            continue
        options = {} if value is True else {"title": value} if name == "bar" and isinstance(value, str) else value
        if not isinstance(options, Mapping):
            raise ArgumentTypeError(f"annotate[{name!r}]: must be True or a dict of options, not {value!r}")
        for key in options:
            if key not in _EFFECTS[name]:
                have = ", ".join(_EFFECTS[name]) or "none"
                raise ArgumentError(f"annotate[{name!r}]: there is no option {key!r}; there is {have}")
        effects[name] = {**_EFFECTS[name], **options}
    title, captions = wanted.get("title") or "", wanted.get("captions") or ()
    captions = [captions] if isinstance(captions, str) else list(captions)
    if not isinstance(title, str) or not all(isinstance(c, str) for c in captions):
        raise ArgumentTypeError("annotate: title and captions must be strings")
    bar = effects.get("bar", {})
    for text in [title, *captions, *(v for v in bar.values() if isinstance(v, str))]:
        try:
            text.encode()
        except UnicodeEncodeError as e:
            raise ArgumentError(f"annotate: {text!r} has half of a surrogate pair, which is not a letter") from e
    if not effects and not title and not captions:
        return None

    def option(name, key, low, high):
        value = effects[name][key]
        if value is None:
            return None
        value = _number(value, f"annotate[{name!r}][{key!r}]")
        if not low <= value <= high:
            raise ArgumentError(f"annotate[{name!r}][{key!r}]: {value} must lie in {low} to {high}")
        return value

    has = effects.__contains__
    radius = strength = None
    if has("occlusion"):
        # 0 is C++'s word for the scene's own.
        given = option("occlusion", "radius", 1e-37, 1e37)
        radius, strength = given or 0.0, option("occlusion", "strength", 0, 16)
    return _r.annotations(
        radius, strength or 0.0, option("edl", "strength", 0, 100) if has("edl") else None, has("silhouettes"),
        option("edges", "angle", 0, 180) if has("edges") else None,
        option("edges", "width", 1e-3, 64) if has("edges") else 1.0, has("axes"), has("bounds"), _bar(effects.get("bar")),
        title, captions,
        _number(wanted.get("text_scale", 1.0), "annotate['text_scale']"))
