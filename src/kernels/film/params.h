// Parameters of the film and of a rendering as a whole.
#pragma once

#include "kernels/schema.h"

namespace accuray {

struct FilmCommon {
  static constexpr auto params() {
    return param_list(
        Param{.name = "width",
              .kind = Kind::integer,
              .doc = "Pixels across.",
              .preset = "512",
              .low = 1,
              .high = 65536,
              .unit = "px"},
        Param{.name = "height",
              .kind = Kind::integer,
              .doc = "Pixels down.",
              .preset = "512",
              .low = 1,
              .high = 65536,
              .unit = "px"},
        Param{.name = "exposure",
              .kind = Kind::real,
              .doc = "Exposure of the PNG in stops; the film's default unit follows it.",
              .preset = "0",
              .low = -60,
              .high = 60,
              .unit = "EV",
              .group = "exposure:EV",
              .animatable = true},
        Param{.name = "iso",
              .kind = Kind::real,
              .doc = "Speed of the sensor (ISO 12232); with the camera's f_number it takes the place of exposure.",
              .low = 1e-3,
              .high = 1e9,
              .group = "exposure:camera",
              .animatable = true},
        Param{.name = "shutter",
              .kind = Kind::real,
              .doc = "Exposure time; scales the PNG and blurs nothing.",
              .low = 1e-9,
              .high = 1e9,
              .unit = "s",
              .group = "exposure:camera",
              .animatable = true},
        Param{.name = "white_balance",
              .kind = Kind::spectrum,
              .doc = "Light that shall look white: Bradford adaptation of the colours from it to D65.",
              .low = 0,
              .role = "emission",
              .animatable = true},
        Param{
            .name = "hide_environment",
            .kind = Kind::boolean,
            .doc = "Camera rays that leave the scene show black with alpha 0; the environment still lights the scene.",
            .preset = "false"},
        Param{.name = "unit",
              .kind = Kind::real,
              .doc = "Step of the film's fixed-point sums, rounded to a power of two; by default 2^-24 of the exposed "
                     "white.",
              .low = 1e-30,
              .high = 1});
  }
};

struct RenderCommon {
  static constexpr auto params() {
    return param_list(
        Param{.name = "spp",
              .kind = Kind::integer,
              .doc = "Samples per pixel.",
              .preset = "64",
              .low = 1,
              .high = 4294967295.0},
        Param{.name = "seed",
              .kind = Kind::integer,
              .doc = "Seed of all random decisions.",
              .preset = "0",
              .low = 0,
              .high = 4294967295.0},
        Param{.name = "replicates",
              .kind = Kind::integer,
              .doc = "Independently scrambled parts of a pixel's samples; the error bars come from their spread.",
              .preset = "4",
              .low = 1,
              .high = 16},
        Param{.name = "layers",
              .kind = Kind::words,
              .doc = "What the image holds besides its colours. indirect: the light that was scattered more than once "
                     "on its way to the camera.",
              .preset = "[]",
              .choices = "indirect"},
        Param{.name = "compact",
              .kind = Kind::boolean,
              .doc = "Keeps the acceleration structure small, at some loss of speed.",
              .preset = "false"});
  }
};

struct AnimationCommon {
  static constexpr auto params() {
    return param_list(Param{.name = "fps",
                            .kind = Kind::real,
                            .doc = "Frames per second: frame n lies at the time n / fps.",
                            .preset = "24",
                            .low = 1e-6,
                            .high = 1e9},
                      Param{.name = "frame",
                            .kind = Kind::real,
                            .doc = "Frame that is rendered.",
                            .preset = "0",
                            .low = -1e9,
                            .high = 1e9},
                      Param{.name = "shutter_open",
                            .kind = Kind::real,
                            .doc = "When the shutter opens, from the frame's time on; a quarter of a frame before it.",
                            .low = -1e9,
                            .high = 1e9,
                            .unit = "s"},
                      Param{.name = "shutter_close",
                            .kind = Kind::real,
                            .doc = "When the shutter closes, from the frame's time on; a quarter of a frame after it.",
                            .low = -1e9,
                            .high = 1e9,
                            .unit = "s"},
                      Param{.name = "shutter_shape",
                            .kind = Kind::choice,
                            .doc = "What the shutter lets through: box all of the light all the time, triangle most of "
                                   "it in the middle, trapezoid all of it but for a ramp at both ends.",
                            .preset = "\"box\"",
                            .choices = "box|triangle|trapezoid",
                            .group = "shutter:shape"},
                      Param{.name = "shutter_ramp",
                            .kind = Kind::real,
                            .doc = "Share of the interval that each ramp of a trapezoid takes.",
                            .preset = "0.25",
                            .low = 0,
                            .high = 0.5,
                            .group = "shutter:shape"},
                      Param{.name = "shutter_curve",
                            .kind = Kind::array,
                            .doc = "Transmission of the shutter by lines between points, each a share of the interval "
                                   "and what is let through there; the first is at 0, the last at 1.",
                            .low = 0,
                            .role = "Nx2",
                            .group = "shutter:curve"});
  }
};

}  // namespace accuray
