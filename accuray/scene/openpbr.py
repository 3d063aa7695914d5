"""OpenPBR Surface as a tree of the renderer's own materials.

The specification (OpenPBR 1.1, Academy Software Foundation 2024) describes slabs that are mixed by weights and layered
upon each other. Here a mixture is a `mix`, the glossy coat of a matte base and the coat over all are `coated`, metals
`conductor`, clear bodies `dielectric`, thin walls `thin_dielectric`, fibres a `sheen` over the rest. Where light
between layers has no closed form in the specification, it is simulated.

Trees are nested tables: a parameter that would name a material holds the table of that material instead, and holds
only what differs from the defaults.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from accuray import data
from accuray.scene.errors import Where
from accuray.scene.spectrum import Spectrum
from accuray.scene.textures import TextureUse

Table = dict[str, Any]
Weight = float | TextureUse

NAME = "openpbr"
BLACK: Table = {"type": "diffuse", "reflectance": Spectrum("constant", "reflectance", value=0.0)}
FRAUNHOFER_FDC = (0.4861327, 0.5875618, 0.6562725)
"""Wavelengths of Abbe's number, micrometres: the lines F, d and C."""


def settle(materials: dict[str, Table], where: Where) -> None:
    """Checks what the tables cannot say, and puts the emission in its place. Raises SceneError."""
    for name, m in materials.items():
        if m["type"] != NAME:
            continue
        at = where.child(name)
        if m["emission_luminance"] > 0.0:
            if m["emission"] is not None:
                raise at.child("emission_luminance").error("cannot go with `emission`", allowed="one of them")
            white = data.LUMINOUS_EFFICACY * math.fsum(data.observer().y)
            m["emission"] = _times(m["emission_color"], m["emission_luminance"] / white)
        if m["base_metalness"] != 1.0 and m["specular_weight"] != 0.0 and not _is_one(m["specular_color"]):
            raise at.child("specular_color").error(
                "tints the reflection of a dielectric, which reflects all colours alike",
                allowed="1, or base_metalness = 1: the colour of metal towards its edge",
            )
        if m["coat_darkening"] != 1.0 and isinstance(m["base_color"], TextureUse):
            raise at.child("coat_darkening").error(
                "needs a base colour that is known before the hit", allowed="1, or a base_color that is no texture"
            )


def tree(m: Table) -> Table:
    """The material as a nested table, without emission, opacity and maps.

    Args:
        m: all parameters of an openpbr material, as a Scene holds them.
    """
    bare = _base(m, _matte(m))
    coated = _everywhere(bare, lambda leaf: _under_coat(m, leaf))
    if m["coat_darkening"] != 1.0:
        undarkened = _base(m, _undarkened(m, _matte(m)))
        undarkened = _everywhere(undarkened, lambda leaf: _under_coat(m, leaf))
        coated = _mixed(undarkened, coated, m["coat_darkening"])
    return _fuzzy(m, _mixed(bare, coated, m["coat_weight"]))


def _base(m: Table, matte: Table) -> Table:
    """All below coat and fuzz, from its matte part."""
    clear = _wall(m) if m["geometry_thin_walled"] else _body(m)
    dielectric = _mixed(_plastic(m, matte), clear, m["transmission_weight"])
    return _mixed(dielectric, _metal(m), m["base_metalness"])


def _metal(m: Table) -> Table:
    metal = {"type": "conductor", "edge_tint": m["specular_color"], **_facets(m, "specular"), **_film(m)}
    return _filmed(m, _coloured(m, metal))


def _matte(m: Table) -> Table:
    return _coloured(m, {"type": "diffuse", "roughness": m["base_diffuse_roughness"]})


def _undarkened(m: Table, matte: Table) -> Table:
    """The matte part, so much brighter that it looks under the coat as it does without.

    Of the light that gets to a surface of reflectance r, (1 - k) r / (1 - k r) comes out if what is above sends the
    share k of diffuse light back.
    """
    weight = m["specular_weight"]
    gloss = m["specular_ior"] if isinstance(weight, TextureUse) else weighted_ior(m["specular_ior"], weight)
    bare, under = kept_inside(1.0, gloss), kept_inside(m["coat_ior"], gloss)

    def brighter(reflectance: float) -> float:
        out = (1.0 - bare) * reflectance / (1.0 - bare * reflectance)
        return out / (1.0 - under + under * out)

    return _everywhere(matte, lambda leaf: {**leaf, "reflectance": _mapped(leaf["reflectance"], brighter)})


def _coloured(m: Table, base: Table) -> Table:
    """A base of the base's colour times its weight, which as a texture has no product with another."""
    if isinstance(m["base_weight"], TextureUse):
        return _mixed(BLACK, {**base, "reflectance": m["base_color"]}, m["base_weight"])
    return {**base, "reflectance": _times(m["base_color"], m["base_weight"])}


def _plastic(m: Table, matte: Table) -> Table:
    """A matte base under a surface that reflects; without the latter where the specular weight is 0."""

    def glossy(ior: float) -> Callable[[Table], Table]:
        return lambda base: {"type": "coated", "base": base, "ior": ior, **_facets(m, "specular"), **_film(m)}

    weight = m["specular_weight"]
    if isinstance(weight, TextureUse):
        return _mixed(matte, _filmed(m, _everywhere(matte, glossy(m["specular_ior"]))), weight)
    ior = weighted_ior(m["specular_ior"], weight)
    return matte if ior == 1.0 else _filmed(m, _everywhere(matte, glossy(ior)))


def _body(m: Table) -> Table:
    """A clear body; its specular weight, if that is a texture, has no index to change."""
    weight = m["specular_weight"]
    ior = m["specular_ior"] if isinstance(weight, TextureUse) else weighted_ior(m["specular_ior"], weight)
    index = dispersed(ior, m["transmission_dispersion_scale"], m["transmission_dispersion_abbe_number"])
    body = {"type": "dielectric", "ior": index, **_facets(m, "specular"), **_film(m)}
    if m["transmission_depth"] > 0.0:
        body |= {key: m[key] for key in ("transmission_color", "transmission_depth")}
    elif not _is_one(m["transmission_color"]):
        body["transmission_color"] = m["transmission_color"]
    return _filmed(m, body)


def _wall(m: Table) -> Table:
    """A pane. One that is rough or coloured or has a film is a layer before the pane's far side, of one index."""
    pane = {"type": "thin_dielectric", "ior": Spectrum("constant", "index", value=m["specular_ior"])}
    if m["specular_roughness"] == 0.0 and _is_one(m["transmission_color"]) and not _film(m):
        return pane
    layer = {"type": "coated", "base": pane, "ior": m["specular_ior"], "transmission_color": m["transmission_color"]}
    return _filmed(m, {**layer, **_facets(m, "specular"), **_film(m)})


def _under_coat(m: Table, leaf: Table) -> Table:
    """A plain material under the coat. Gloss on what is matte stays; a wall's front becomes the coat's."""
    wall = leaf["type"] == "coated" and leaf["base"]["type"] == "thin_dielectric"
    share = _root(m["coat_color"])
    coat = {"type": "coated", "base": leaf["base"] if wall else leaf, "ior": m["coat_ior"], "transmission_color": share}
    return {**coat, **_facets(m, "coat")}


def _fuzzy(m: Table, below: Table) -> Table:
    if m["fuzz_weight"] == 0.0:
        return below
    fibres = {"type": "sheen", "color": m["fuzz_color"], "roughness": m["fuzz_roughness"]}
    return {"type": "fuzz", "base": below, "fibres": fibres, "weight": m["fuzz_weight"]}


def _film(m: Table) -> Table:
    if m["thin_film_weight"] == 0.0:
        return {}
    index = Spectrum("constant", "index", value=m["thin_film_ior"])
    return {"film_thickness": m["thin_film_thickness"], "film_ior": index}


def _filmed(m: Table, whole: Table) -> Table:
    """The material with its film on the share of the film's weight only."""
    if m["thin_film_weight"] in (0.0, 1.0):
        return whole
    bare = _everywhere(whole, lambda leaf: {key: leaf[key] for key in leaf if not key.startswith("film_")})
    return _mixed(bare, whole, m["thin_film_weight"])


def _facets(m: Table, layer: str) -> Table:
    """Roughness and anisotropy. OpenPBR keeps the mean square of the two roughnesses, we the greater of them."""
    roughness, anisotropy = m[f"{layer}_roughness"], m[f"{layer}_roughness_anisotropy"]
    if not isinstance(anisotropy, TextureUse) and anisotropy > 0.0:
        stretch = (2.0 / (1.0 + (1.0 - anisotropy) ** 2)) ** 0.25
        roughness = _times(roughness, stretch) if isinstance(roughness, TextureUse) else min(1.0, roughness * stretch)
    return {"roughness": roughness, "anisotropy": anisotropy}


def weighted_ior(ior: float, weight: float) -> float:
    """The index whose reflectance along the normal is ``weight`` times that of ``ior`` (OpenPBR 1.1)."""
    if weight == 1.0:
        return ior
    amplitude = math.sqrt(weight) * (ior - 1.0) / (ior + 1.0)
    return (1.0 + amplitude) / (1.0 - amplitude)


def kept_inside(coat: float, below: float) -> float:
    """Share of diffuse light below two smooth interfaces that they send back, of indices 1, ``coat``, ``below``.

    The mean over the square of the sine, by the midpoint rule, of what Fresnel's equations give for the pair with all
    reflections between them.
    """
    if below == 1.0:
        return kept_inside(1.0, coat) if coat > 1.0 else 0.0
    count = 512
    passed = 0.0
    for step in range(count):
        outside = (step + 0.5) / count
        first = _fresnel(math.sqrt(1.0 - outside), coat)
        second = _fresnel(math.sqrt(1.0 - outside / coat**2), below / coat)
        passed += (1.0 - first) * (1.0 - second) / (1.0 - first * second)
    return 1.0 - passed / count / below**2


def _fresnel(cosine: float, ior: float) -> float:
    """Reflectance of an interface for unpolarised light that comes at ``cosine`` (Born and Wolf 1999)."""
    sine2 = (1.0 - cosine * cosine) / (ior * ior)
    if sine2 >= 1.0:
        return 1.0
    beyond = math.sqrt(1.0 - sine2)
    s = (cosine - ior * beyond) / (cosine + ior * beyond)
    p = (ior * cosine - beyond) / (ior * cosine + beyond)
    return 0.5 * (s * s + p * p)


def dispersed(ior: float, scale: float, abbe_number: float) -> Spectrum:
    """Cauchy's equation through ``ior`` at the line d with the Abbe number ``abbe_number / scale``."""
    if scale == 0.0 or ior == 1.0:
        return Spectrum("constant", "index", value=ior)
    f, d, c = FRAUNHOFER_FDC
    slope = (ior - 1.0) * scale / abbe_number / (f**-2 - c**-2)
    return Spectrum("cauchy", "index", A0=ior - slope * d**-2, B=(slope,))


def _mixed(first: Table, second: Table, weight: Weight) -> Table:
    if weight == 0.0 or weight == 1.0:
        return second if weight else first
    return {"type": "mix", "first": first, "second": second, "weight": weight}


def _everywhere(node: Table, change: Callable[[Table], Table]) -> Table:
    """The tree with its plain materials changed, those under a layer with their layer as one."""
    if node["type"] != "mix":
        return change(node)
    return {**node, **{key: _everywhere(node[key], change) for key in ("first", "second")}}


def _times(value: Any, factor: float) -> Any:
    if factor == 1.0:
        return value
    return replace(value, scale=value.scale * factor) if isinstance(value, TextureUse) else value.times(factor)


def _root(colour: Spectrum) -> Spectrum:
    """What is left after one way if the colour is left after two of them."""
    return _mapped(colour, math.sqrt)


def _mapped(colour: Spectrum, change: Callable[[float], float]) -> Spectrum:
    """The colour with its numbers changed: those of a constant, an RGB triple or a table."""
    if colour.form == "constant":
        return replace(colour, value=change(colour.value * colour.scale), scale=1.0)
    if colour.form == "rgb":
        return replace(colour, rgb=tuple(change(c * colour.scale) for c in colour.rgb), scale=1.0)
    return replace(colour, values=tuple(change(v * colour.scale) for v in colour.values), scale=1.0)


def _is_one(colour: Any) -> bool:
    return not isinstance(colour, TextureUse) and colour.bounds() == (1.0, 1.0)
