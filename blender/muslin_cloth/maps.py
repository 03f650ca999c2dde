"""From the sliders and painted maps of an object to numbers of its material. Needs no Blender."""

from . import fabrics
from .scene_text import Painted

SHRINK = "shrink"  # the one map that is no number of the fabric: rest length over modelled length


class Refused(Exception):
    """Why sliders or maps do not fit the fabric, with a remedy."""


def map_file(body, what):
    return f"{body}.{what}.csv"


def adjusted(body, model, fabric, factors, maps):
    """(numbers of the material, numbers of the body) that differ from those of the fabric.

    `model` is "shell" or "lattice", `fabric` the name of a material. `factors`: {what: factor}, `what` as in
    fabrics.SCALED. `maps`: [(what, low, high)], factors of the fabric's number where the weight of the file
    map_file(body, what) is 0 and 1; of SHRINK they are lengths at rest over modelled lengths. Raises Refused."""
    what_varies = [what for what, _, _ in maps]
    for what in what_varies:
        if what_varies.count(what) > 1:
            raise Refused(f"Two maps vary the {what}: remove one of them")
    numbers, own = {}, {}
    factors = {what: factor for what, factor in factors.items() if factor != 1}
    if factors or any(what != SHRINK for what in what_varies):
        known = fabrics.numbers(fabric, model)
        if known is None:
            raise Refused(f"The numbers of \"{fabric}\" are not known here: set its sliders to 1 and remove its maps, or "
                          "choose a fabric of the list")
        for what, factor in factors.items():
            numbers.update(fabrics.scaled(known, what, factor))
    for what, low, high in maps:
        if what == SHRINK:
            if model != "shell":
                raise Refused("Only cloth shrinks: remove the map, or choose Cloth under Kind")
            own["rest_scale_warp"] = Painted(map_file(body, what), low, high)
            continue
        varied = fabrics.scaled({**known, **numbers}, what, 1)
        if any(isinstance(value, list) for value in varied.values()):
            raise Refused(f"The {what} of \"{fabric}\" is measured curves, which a map cannot vary: remove the map, or "
                          "choose another fabric")
        if not varied:
            raise Refused(f"\"{fabric}\" has no {what} that a map could vary: remove the map")
        numbers.update({key: Painted(map_file(body, what), low * x, high * x) for key, x in varied.items()})
    return numbers, own


def weights_text(weights):
    """The file of a map: a heading, and a weight a line in the order of the vertices."""
    return "weight\n" + "".join(f"{w:.9g}\n" for w in weights)
