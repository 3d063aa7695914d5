"""Bugs that somebody could have made, each as the few words of the source that would have been different.

A replacement table stands in for patch files: `Change.old` must be found in its file exactly once, so a change never
lands in the wrong place and one that the source has outgrown is noticed at once, whatever happened to the lines around
it. `cases` are those of `accuray verify` (or of extra_cases.py) of which at least one must fail with the bug.
"""

from __future__ import annotations

from dataclasses import dataclass

KERNELS = "src/kernels"


@dataclass(frozen=True)
class Change:
    """One replacement of text in a file."""

    file: str
    old: str
    new: str


@dataclass(frozen=True)
class Bug:
    """A planted bug: its changes, and the ids of cases that see it."""

    name: str
    changes: tuple[Change, ...]
    cases: tuple[str, ...]


def bug(name: str, file: str, old: str, new: str, *cases: str) -> Bug:
    """A bug of one change in the kernels."""
    return Bug(name, (Change(f"{KERNELS}/{file}", old, new),), cases)


PLACE_MESH = """PlacedMesh place_mesh(MeshArrays arrays, const std::optional<Matrix>& transform) {
  if (transform) move_mesh(*transform, arrays);"""
ADD_MESH = "uint32_t SceneBuilder::add_mesh("
UNSCALED_LAMP = """MeshArrays unscaled;
PlacedMesh place_mesh(MeshArrays arrays, const std::optional<Matrix>& transform) {
  unscaled = arrays;
  if (transform) {
    Matrix rigid = *transform;
    for (size_t i = 0; i < rigid.size(); ++i) rigid[i] /= i % 4 == 3 ? 1.0 : scale_of(*transform);
    move_mesh(rigid, unscaled);
    move_mesh(*transform, arrays);
  }"""

BUGS = (
    bug(
        "cosine-forgotten",
        "bsdf/diffuse.h",
        "rough(wo, wi)) * (abs(wi.z) * inv_pi)",
        "rough(wo, wi)) * inv_pi",
        "C1.disk-off-axis/light",
    ),
    bug(
        "film-crossed-once",
        "bsdf/thin_film.h",
        "2.0f * min(metres * 1e9f, thickest)",
        "min(metres * 1e9f, thickest)",
        "C4.film-oxide-0",
    ),
    bug(
        "bsdf-pdf-doubled",
        "bsdf/diffuse.h",
        "? cosine_hemisphere_pdf(abs(wi.z)) : 0.0f",
        "? 2.0f * cosine_hemisphere_pdf(abs(wi.z)) : 0.0f",
        "C1.rectangle-near/mis",
    ),
    bug(
        "radiance-not-scaled-by-eta-squared",
        "bsdf/dielectric.h",
        "/ ((1.0f - chance) * eta * eta)",
        "/ (1.0f - chance)",
        "C4.into-glass-0",
        "C4.out-of-glass-0",
    ),
    bug(
        "mis-weights-do-not-sum-to-one",
        "integrator/weights.h",
        "a / (a + other * other)",
        "a / (a + 2.0f * other * other)",
        "C1.disk-on-axis/mis",
    ),
    bug(
        "roulette-not-compensated",
        "integrator/steps.h",
        "path.throughput *= 1.0f / chance;",
        "",
        "C2.box-0.8/early-roulette",
    ),
    Bug(
        "lamp-area-without-the-scale",
        (
            Change("src/lower/placed_mesh.cpp", PLACE_MESH, UNSCALED_LAMP),
            Change("src/lower/builder.cpp", ADD_MESH, f"extern MeshArrays unscaled;\n{ADD_MESH}"),
            Change(
                "src/lower/builder.cpp",
                "positions_of(placed.layout, placed.vertices.data), placed.index_values()",
                "unscaled.positions, unscaled.indices",
            ),
        ),
        ("C1.rectangle-scaled/light",),
    ),
    bug(
        "light-choice-not-paid-back",
        "integrator/steps.h",
        "light.pdf * choice.probability",
        "light.pdf",
        "C1.two-points/mis",
    ),
    bug(
        "light-tree-forgets-a-level",
        "light/tree.h",
        "    probability *= shares.probability(k);\n",
        "",
        "C1.two-points/mis",
    ),
    bug(
        "back-of-lamps-shines",
        "light/select.h",
        "if (faces_away && record.both_sides == 0) s.scale = 0.0f;",
        "",
        "C1.disk-behind/light",
    ),
    bug(
        "point-light-falls-with-distance",
        "light/aim.h",
        "1.0f / (s.distance * s.distance)",
        "1.0f / s.distance",
        "C1.point/mis",
    ),
    bug(
        "no-shadows",
        "integrator/steps.h",
        "return accel.transmittance(ray);",
        "return 1.0f;",
        "C1.penumbra/light",
    ),
    bug(
        "fresnel-of-one-polarisation",
        "bsdf/fresnel.h",
        "f32x4 r = (s * s + p * p) * 0.5f;",
        "f32x4 r = s * s;",
        "C4.reflect-56",
    ),
    bug(
        "metal-of-one-polarisation",
        "bsdf/fresnel.h",
        "s * (p_plus - p_cross) / (p_plus + p_cross)",
        "s",
        "C4.metal-Au-60",
    ),
    bug(
        "hero-not-weighted",
        "spectrum/wavelengths.h",
        "lanes(4.0f * throughput[0],",
        "lanes(throughput[0],",
        "C3.dispersive-sphere",
        "C8.dispersion",
    ),
    bug(
        "all-wavelengths-follow-the-hero",
        "integrator/steps.h",
        "path.throughput = keep_hero(path.throughput);",
        "",
        "X.dispersed-fan",
    ),
    bug(
        "wavelength-density-forgotten",
        "spectrum/sensor.h",
        "weight[k] = 0.25f / pdf;",
        "weight[k] = 0.25f * static_cast<float>(lambda_cells);",
        "C8.xy-A",
    ),
    bug(
        "light-met-counts-twice",
        "integrator/steps.h",
        "return mis_weight(from.pdf, pdf);",
        "return pdf < 0.0f ? 0.0f : 1.0f;",
        "C1.disk-on-axis/mis",
    ),
    bug(
        "cone-of-a-sphere-light",
        "light/sphere.h",
        "return sin2 / (1.0f + sqrt(max(0.0f, 1.0f - sin2)));",
        "return sqrt(max(0.0f, 1.0f - sin2));",
        "C1.sphere-0/light",
    ),
    bug(
        "environment-pdf-of-a-half-space",
        "sampling/warp.h",
        "uniform_sphere_pdf = 0.25f * inv_pi",
        "uniform_sphere_pdf = 0.5f * inv_pi",
        "C1.environment/light",
    ),
    bug(
        "map-density-without-the-sine",
        "light/directions.h",
        "/ (2.0f * pi * pi * around)",
        "/ (2.0f * pi * pi)",
        "C9.texel/light",
    ),
    bug(
        "limb-of-the-sun-as-bright-as-its-middle",
        "light/sun.h",
        "1.0f - chord * (1.0f - 0.25f * chord) / sine_squared()",
        "1.0f - 0.0f * chord",
        "C9.ground-560nm-sun/mis",
    ),
    bug(
        "one-bounce-too-many",
        "integrator/path.h",
        "path.depth < static_cast<uint32_t>(max_depth)",
        "path.depth <= static_cast<uint32_t>(max_depth)",
        "C2.box-depth-1/mis",
    ),
    bug(
        "diffuse-bounce-costs-five",
        "integrator/steps.h",
        "if ((lobe & lobe_diffuse) != 0) return 4",
        "if ((lobe & lobe_diffuse) != 0) return 5",
        "C2.box-depth-budget",
    ),
    Bug(
        "field-of-view-a-little-small",
        (
            Change(
                "src/lower/cameras.cpp",
                'tangent(0.5 * number_of(values, "fov"))',
                'tangent(0.49 * number_of(values, "fov"))',
            ),
        ),
        ("C3.image-area",),
    ),
    Bug(
        "film-left-at-the-focal-length",
        (Change("src/lower/cameras.cpp", "half_film * (1.0 / f - 1.0 / lens.focus)", "half_film / f"),),
        ("C7.blur-far",),
    ),
    bug(
        "panorama-compresses-latitude",
        "camera/panorama.h",
        "sincos((0.5f - film.y) * pi)",
        "sincos((0.5f - film.y) * half_pi)",
        "C7.panorama-side",
    ),
    bug(
        "motion-in-steps",
        "geometry/motion.h",
        "return {before, before + 1, step.share};",
        "return {before, before + 1, 0.5f};",
        "C7.picture-camera",
    ),
    bug(
        "light-stays-at-its-first-key",
        "light/moving.h",
        "const Moment moment = moment_of(scene, record.motion, time);",
        "const Moment moment = moment_of(scene, record.motion, 0.0f * time);",
        "C7.flying-lamp/light",
    ),
    bug(
        "shutter-opens-too-soon",
        "film/shutter.h",
        "open[k] + sqrt(",
        "open[k + 1] + sqrt(",
        "C7.shutter-triangle-middle",
    ),
)
