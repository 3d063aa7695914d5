#include "lower/cameras.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "kernels/math/functions.h"
#include "lower/double3.h"

namespace accuray {

namespace {

std::string metres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g m", value);
  return text.data();
}

// The camera's axes; `distance` is that of look_at.
struct Axes {
  Double3 position, right, up, backward;
  double distance;

  Pose pose() const { return {to_vec3(position), to_vec3(right), to_vec3(up), to_vec3(backward)}; }
};

Axes axes_of(const Values& values) {
  const auto position = vec_of(values, "position");
  const auto away = difference(position, vec_of(values, "look_at"));
  const auto backward = unit(away, "look_at", "is where the camera stands: allowed is any point but its position");
  constexpr const char* no_up = "is no direction across the view: allowed is any that is not along it, and not 0";
  const auto right = unit(cross(unit(vec_of(values, "up"), "up", no_up), backward), "up", no_up);
  return {position, right, cross(backward, right), backward, length(away)};
}

double tangent(double angle) {
  const SinCosDouble at = sincos(angle);
  return at.sin / at.cos;
}

// The lens of a perspective camera: its radius, 0 for a pinhole, and the distance of the plane in focus.
struct Lens {
  double radius;
  double focus;
  bool focused;  // the scene says where; otherwise it is at look_at
};

double focus_of(const Values& values, const Axes& axes) {
  if (values.contains("focus_distance")) return number_of(values, "focus_distance");
  if (!values.contains("focus_point")) return axes.distance;
  const double ahead = dot(difference(axes.position, vec_of(values, "focus_point")), axes.backward);
  if (!(ahead > 0.0)) throw BadParameter("focus_point", "lies behind the camera: allowed is any point before it");
  return ahead;
}

Lens lens_of(const Values& values, const Axes& axes) {
  Lens lens{};
  lens.focused = values.contains("focus_distance") || values.contains("focus_point");
  lens.focus = focus_of(values, axes);
  if (values.contains("f_number")) {
    if (!values.contains("focal_length")) {
      throw BadParameter("f_number", "needs the focal length: allowed with focal_length and film_size in place of fov");
    }
    lens.radius = 0.5 * number_of(values, "focal_length") / number_of(values, "f_number");
  } else {
    lens.radius = number_of(values, "aperture_radius");
  }
  return lens;
}

// Half the picture on fov_axis at distance 1. As in a real camera the film stands where the plane in focus is sharp, at
// 1 / (1/f - 1/focus) behind the lens; a pinhole without a focus has it at f, as if focused at infinity.
double half_picture(const Values& values, const Lens& lens) {
  if (!values.contains("focal_length")) return tangent(0.5 * number_of(values, "fov"));
  const double f = number_of(values, "focal_length");
  const double half_film = 0.5 * number_of(values, "film_size");
  if (lens.radius == 0.0 && !lens.focused) return half_film / f;
  if (!(lens.focus > f)) {
    throw BadParameter(values.contains("focus_point") ? "focus_point" : "focus_distance",
                       metres(lens.focus) + " is not beyond the focal length: allowed more than " + metres(f));
  }
  return half_film * (1.0 / f - 1.0 / lens.focus);
}

Tagged camera_of(Type<Perspective>, const Values& values, const FilmSize& film, ParameterPool& pool) {
  const Axes axes = axes_of(values);
  const Lens lens = lens_of(values, axes);
  const double half = half_picture(values, lens);
  const bool vertical = number_of(values, "fov_axis") == 0.0;
  const double half_height = vertical ? half : half / film.aspect();
  const double half_width = vertical ? half * film.aspect() : half;
  Perspective pinhole{axes.pose(), static_cast<float>(half_width), static_cast<float>(half_height),
                      static_cast<float>(2.0 * half_width * number_of(values, "shift_x")),
                      static_cast<float>(2.0 * half_height * number_of(values, "shift_y"))};
  const double blades = number_of(values, "blades");
  if (blades == 1.0 || blades == 2.0) throw BadParameter("blades", "make no opening: allowed 0, or 3 to 64");
  if (lens.radius == 0.0) return {tag_of<Perspective>(Cameras{}), pool.add(pinhole)};
  const double rotation = std::fmod(number_of(values, "blade_rotation"), 2.0 * M_PI);
  const Aperture aperture{static_cast<float>(lens.radius), static_cast<uint32_t>(blades), static_cast<float>(rotation)};
  const ThinLens camera{pinhole, aperture, static_cast<float>(1.0 / lens.focus)};
  return {tag_of<ThinLens>(Cameras{}), pool.add(camera)};
}

void complete(Orthographic& camera, const Values& values, const FilmSize& film) {
  const double half = 0.5 * number_of(values, "height");
  camera.half_height = static_cast<float>(half);
  camera.half_width = static_cast<float>(half * film.aspect());
}

void complete(Panorama&, const Values&, const FilmSize&) {}

void complete(Fisheye& camera, const Values& values, const FilmSize& film) {
  const double fov = number_of(values, "fov");
  const SinCosDouble quarter = sincos(0.25 * fov);
  const auto at_most = [&](double degrees) {
    // The limit is given in degrees and compared as such, so that it is itself allowed.
    if (fov * (180.0 / M_PI) <= degrees * (1.0 + 1e-12)) return;
    throw BadParameter("fov", "is too wide for this mapping: allowed up to " + std::to_string(int(degrees)) + " deg");
  };
  switch (camera.mapping) {
    case FisheyeMapping::equidistant:
      camera.scale = static_cast<float>(0.5 * fov);
      break;
    case FisheyeMapping::equisolid:
      camera.scale = static_cast<float>(quarter.sin);
      break;
    case FisheyeMapping::stereographic:
      at_most(359.0);
      camera.scale = static_cast<float>(quarter.sin / quarter.cos);
      break;
    case FisheyeMapping::orthographic:
      at_most(180.0);
      camera.scale = static_cast<float>(sincos(0.5 * fov).sin);
      break;
  }
  const double axis = number_of(values, "fov_axis");
  const double diagonal = std::sqrt(film.width * film.width + film.height * film.height);
  const double diameter = axis == 0.0 ? film.height : (axis == 1.0 ? film.width : diagonal);
  camera.extent_x = static_cast<float>(film.width / diameter);
  camera.extent_y = static_cast<float>(film.height / diameter);
}

double number_or(const Values& values, std::string_view name, double otherwise) {
  return values.contains(name) ? number_of(values, name) : otherwise;
}

// Squared radius up to which a radial distortion keeps the order of points, looked for up to 89.5 degrees off the axis;
// 0 where nothing is distorted.
float distortion_limit(const Distortion& d) {
  if (d.k1 == 0 && d.k2 == 0 && d.k3 == 0 && d.k4 == 0 && d.k5 == 0 && d.k6 == 0 && d.p1 == 0 && d.p2 == 0) return 0.0f;
  const auto appears = [&d](double r) {
    const double s = r * r;
    const double below = 1.0 + s * (d.k4 + s * (d.k5 + s * d.k6));
    return below > 0.0 ? r * (1.0 + s * (d.k1 + s * (d.k2 + s * d.k3))) / below : -1.0;
  };
  double r = 1e-4;
  while (r < 115.0 && appears(1.002 * r) > appears(r)) r *= 1.002;
  return static_cast<float>(r * r);
}

void complete(PinholeIntrinsics& camera, const Values& values, const FilmSize& film) {
  const double width = number_or(values, "image_width", film.width);
  const double height = number_or(values, "image_height", film.height);
  const double fx = number_of(values, "fx");
  const double fy = number_or(values, "fy", fx);
  // The middle of the first pixel is 0, half a pixel from the picture's edge.
  camera.scale = {static_cast<float>(width / fx), static_cast<float>(height / fy)};
  camera.offset = {static_cast<float>(-(number_or(values, "cx", 0.5 * (width - 1.0)) + 0.5) / fx),
                   static_cast<float>(-(number_or(values, "cy", 0.5 * (height - 1.0)) + 0.5) / fy)};
  camera.distortion.limit = distortion_limit(camera.distortion);
}

// A camera whose table fills its struct, but for the pose and what complete() computes.
template <class Camera>
Tagged camera_of(Type<Camera>, const Values& values, const FilmSize& film, ParameterPool& pool) {
  auto camera = struct_of<Camera>(values);
  camera.pose = axes_of(values).pose();
  complete(camera, values, film);
  return {tag_of<Camera>(Cameras{}), pool.add(camera)};
}

}  // namespace

Tagged lower_camera(std::string_view type, const Values& values, const FilmSize& film, ParameterPool& pool) {
  return dispatch(NamedCameras{}, tag_named(NamedCameras{}, type),
                  [&](auto named) { return camera_of(named, values, film, pool); });
}

std::optional<Block> with_camera(const Block& block, std::string_view type, const Values& values,
                                 const FilmSize& film) {
  ParameterPool pool;
  const Tagged camera = lower_camera(type, values, film, pool);
  const Root& root = *block.view().root;
  if (root.camera.tag != camera.tag || root.camera_motion != none) return std::nullopt;
  std::vector<Section> sections = block.sections();
  std::vector<uint8_t> bytes(sections[0].data, sections[0].data + sections[0].size);
  const size_t words = pool.words().size() - camera.offset;
  std::memcpy(bytes.data() + root.parameters.offset + root.camera.offset * sizeof(uint32_t),
              pool.words().data() + camera.offset, words * sizeof(uint32_t));
  sections[0] = section_of(std::move(bytes));
  return Block(std::move(sections));
}

}  // namespace accuray
