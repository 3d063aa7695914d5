"""Every choice that decides a benchmark's figure, in one place, the same for all renderers.

They were fixed before any renderer was tuned. Fair play: box filter one pixel wide, no depth limit, Russian roulette
from the same bounce, no clamping, no denoising, no adaptive sampling, no guiding, the same number of threads.
"""

from dataclasses import dataclass

THREADS = 2
ROULETTE_START = 5
"""Bounces before Russian roulette: each renderer's own parameter of that meaning gets this number."""

FINITE_DEPTH = 1024
"""Stands for "unlimited" in renderers that demand a number; roulette ends every path of these scenes far earlier."""

REPEATS = 5
"""Timed renders of each configuration; the median counts."""

SIZE = 512
"""Width and height of the images that measure samples per second."""

SPP = {"mitsuba": 32, "accuray": 32, "cycles": 16, "luxcore": 8}
"""Samples per pixel of those images: several seconds for each renderer on two cores."""

EFFICIENCY_SIZE = 256
EFFICIENCY_SPP = 64
REFERENCE_FACTOR = 64
"""A reference has at least so many times the samples of the image that it judges."""

MEASURED_SEED = 1
REFERENCE_SEED = 100_001
"""Repeat ``k`` uses ``MEASURED_SEED + k``; chunk ``k`` of a reference uses ``REFERENCE_SEED + k``."""

REFERENCE_CHUNK = 256
"""Samples per pixel of one chunk of a reference; the chunks' mean, in float64, is the reference."""

REFERENCE_MEAN_RGB = (0.24, 0.14, 0.06)
"""Before relMSE an image and its reference are multiplied by one number, which gives the reference the luminance of
this colour. One number per renderer, not one per channel, so that no renderer's colours are altered."""

RELATIVE_MSE_OFFSET = 0.01

MILLION_SEGMENTS = 1000
MILLION_RINGS = 500
"""The sphere of the second scene has 2 * segments * rings triangles: 1 000 000."""

SEGMENTS = 360
RINGS = 180
"""The spheres of rough metal and of rough glass have 129 600 triangles."""

MATERIALS_SIZE = 128
"""Width and height of the images of those two scenes: references of rough glass take long."""

WORLDS_SIZE = 128
"""Width and height of the images of the scenes with a sky, a room, many lamps and many copies."""

SKY_HEIGHT = 512
"""Rows of the environment map; it is twice as wide."""

COPIES = 4000
"""Instances of two meshes of some 25 000 triangles each."""

STARTUP_SIZE = 256
STARTUP_RUNS = 15
STARTUP_VARIANT = "llvm_ad_spectral"

REPLAY_SIZE = 256
REPLAY_SPP = 8
"""Recorded rays take some hundred bytes each in their various layouts: 3 million rays in all."""

MEMORY_SIZE = 64
MEMORY_SPP = 256

THREAD_ROUNDS = 3
"""One thread and two are timed in turn, so often, in fresh processes."""

MITSUBA_SAMPLERS = ("independent", "multijitter", "stratified", "orthogonal", "ldsampler")
"""All are tried for efficiency and the best counts; plain speed is measured with the first."""

REQUIREMENTS = {
    "mitsuba": ("mitsuba==3.9.1", "numpy"),
    "cycles": ("bpy==5.0.1", "numpy<2"),
    "luxcore": ("pyluxcore==2.11.2", "numpy"),
}
"""What each peer's virtual environment holds. bpy 5.0 exists for Python 3.11 only."""

PEER_PYTHON = "3.11"


@dataclass(frozen=True)
class Contender:
    """One renderer in one configuration. ``variant`` and ``sampler`` mean something to Mitsuba only."""

    peer: str
    variant: str = ""
    sampler: str = ""

    @property
    def name(self) -> str:
        """Label in tables and file names, such as ``mitsuba:llvm_ad_rgb:stratified``."""
        return ":".join(part for part in (self.peer, self.variant, self.sampler) if part)


SPEED_CONTENDERS = (
    Contender("accuray"),
    Contender("mitsuba", "llvm_ad_spectral", "independent"),
    Contender("mitsuba", "llvm_ad_rgb", "independent"),
    Contender("mitsuba", "scalar_spectral", "independent"),
    Contender("cycles"),
    Contender("luxcore"),
)

EFFICIENCY_CONTENDERS = (
    Contender("accuray"),
    *(Contender("mitsuba", "llvm_ad_spectral", sampler) for sampler in MITSUBA_SAMPLERS),
    *(Contender("mitsuba", "llvm_ad_rgb", sampler) for sampler in MITSUBA_SAMPLERS),
    Contender("cycles"),
    Contender("luxcore"),
)

MATERIALS_CONTENDERS = (
    Contender("accuray"),
    Contender("mitsuba", "llvm_ad_spectral", "multijitter"),
    Contender("mitsuba", "llvm_ad_rgb", "multijitter"),
    Contender("cycles"),
)
"""For time to equal error in all other scenes; Mitsuba with its best sampler of the Cornell box."""

INSTANCES_CONTENDERS = (
    Contender("accuray"),
    Contender("mitsuba", "scalar_spectral", "multijitter"),
    Contender("mitsuba", "scalar_rgb", "multijitter"),
    Contender("cycles"),
)
"""Mitsuba's compiled variants trace a program for each instance anew: 21 s before the first ray for 200 instances, and
600 were not ready after 100 s."""
