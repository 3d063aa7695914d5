"""An animation without a scene file: a sun that rises over a ball, frame by frame, with restarts.

    .venv/bin/python examples/03_frames.py

Run it twice: the second time all frames are found finished.
"""

import accuray


def keys(*values):
    """Values at 0 s, 1 s, 2 s, ..., with soft starts and stops."""
    return {"keys": [{"time": t, "value": value} for t, value in enumerate(values)], "interpolation": "smooth"}


scene = accuray.Scene.from_dict(
    {
        "film": {"width": 160, "height": 90},
        "animation": {"fps": 4},
        "camera": {
            "type": "perspective",
            "position": keys([-1, 1.2, 6], [1, 0.8, 5]),
            "look_at": [0, 0.8, 0],
            "fov": 30,
        },
        "materials": {
            "floor": {"type": "diffuse", "reflectance": 0.4},
            "ball": {"type": "conductor", "metal": "Cu", "roughness": keys(0.6, 0.1)},
        },
        "shapes": {
            "floor": {"type": "disk", "material": "floor", "normal": [0, 1, 0], "radius": 20},
            "ball": {"type": "sphere", "material": "ball", "center": [0, 0.8, 0], "radius": 0.8},
        },
        "lights": {"sky": {"type": "sky", "elevation": keys(3, 20), "azimuth": keys(60, 80), "scale": 0.02}},
    }
)

# Any frame is a scene of its own, between whole ones too.
for number in (0, 2, 2.5):
    at = scene.at(number)
    print(f"frame {number} is at {at.clock.time} s: roughness {at.materials['ball']['roughness']:.3f}")

# What has not changed from one frame to the next is not built again; what was finished before is not rendered again.
for frame in accuray.render_frames(scene, "0-4", output="sunrise.##.exr", spp=16):
    state = "was finished" if frame.skipped else "is rendered"
    print(f"{frame.path} {state}: relative error {frame.image.relative_error:.1%}")

print("ffmpeg -framerate 4 -i sunrise.%02d.png -pix_fmt yuv420p sunrise.mp4 makes the video")
