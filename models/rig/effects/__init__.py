"""Effects that can be hidden in a campaign, each in forms of its own.

The forms are written from the physics and differ from the formulas that the discovery side tries:
truth and model share no code. An effect whose physics leaves no choice (a mass, a linear film or
spring, an offset, a delay) has one form.
"""

from collections.abc import Mapping

from models.checks import InputError, one_of
from models.rig.effects import behind, damping, dry, elastic, outside, sensors
from models.rig.effects.effect import Effect

FORMS: dict[str, dict[str, Effect]] = {}
"""Every effect's forms, by id and name of the form; the first is the default."""

for _module in (elastic, damping, dry, behind, sensors, outside):
    for _effect in _module.EFFECTS:
        FORMS.setdefault(_effect.id, {})[_effect.form] = _effect

OUTSIDE: tuple[str, ...] = tuple(key for key in FORMS if key.startswith("outside:"))
"""Ids of the effects that the catalogue doesn't have."""

CATALOGUE: tuple[str, ...] = tuple(key for key in FORMS if key not in OUTSIDE)
"""Ids of the effects that it has."""


def find_effect(name: str, *, where: str = "hidden effect") -> Effect:
    """Return the effect called "id" (its default form) or "id:form".

    Parameters
    ----------
    name : str
        Id, or id and form.
    where : str
        What an error names as the place.

    Returns
    -------
    Effect

    Raises
    ------
    InputError
        Where there is no such effect or form; it lists those that there are.

    Examples
    --------
    >>> find_effect("stribeck-friction").form, find_effect("stribeck-friction:hess-soom").form
    ('tustin', 'hess-soom')
    """
    identifier, form = name, ""
    if name not in FORMS and ":" in name:
        identifier, _, form = name.rpartition(":")
    one_of("effect", identifier, FORMS, where=where)
    forms = FORMS[identifier]
    return (
        forms[one_of(f"form of {identifier}", form, forms, where=where)]
        if form
        else next(iter(forms.values()))
    )


Sizes = Mapping[str, float] | Mapping[Effect, float] | Mapping[str | Effect, float]
"""Effects by name, or as they are where the rig has no name for them, with their sizes."""


def parse_sizes(hidden: Sizes) -> dict[Effect, float]:
    """Return effects with their sizes from a mapping of names, or effects, to sizes.

    Raises
    ------
    InputError
        For an unknown name or a size that isn't above 0 and at most 10.
    """
    result: dict[Effect, float] = {}
    for key, size in hidden.items():
        effect = key if isinstance(key, Effect) else find_effect(key)
        name = f"{effect.id}:{effect.form}" if isinstance(key, Effect) else key
        if effect in result:
            raise InputError("hidden effect", expected="named once", found=f"{name} twice")
        if not 0.0 < float(size) <= 10.0:
            raise InputError(f"size of {name}", expected="above 0 and at most 10", found=f"{size}")
        result[effect] = float(size)
    return result


__all__ = ["CATALOGUE", "FORMS", "OUTSIDE", "Effect", "Sizes", "find_effect", "parse_sizes"]
