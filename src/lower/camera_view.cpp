#include "lower/camera_view.h"

#include <algorithm>

namespace accuray {

namespace {

using mesh::View;

View seen_from(const Pose& pose) {
  View view;
  const Vec3 axes[3] = {pose.right, pose.up, pose.backward};
  for (size_t i = 0; i < 3; ++i) {
    const double row[3] = {axes[i].x, axes[i].y, axes[i].z};
    const double from[3] = {pose.position.x, pose.position.y, pose.position.z};
    for (size_t k = 0; k < 3; ++k) view.to_camera[4 * i + k] = row[k];
    view.to_camera[4 * i + 3] = -(row[0] * from[0] + row[1] * from[1] + row[2] * from[2]);
  }
  return view;
}

View view_of(const Perspective& camera, const FilmSize& film) {
  View view = seen_from(camera.pose);
  const double x = camera.middle_x;
  const double y = camera.middle_y;
  view.scale = film.width / (2.0 * camera.half_width);
  view.window = {x - camera.half_width, x + camera.half_width, y - camera.half_height, y + camera.half_height};
  return view;
}

View view_of(const ThinLens& camera, const FilmSize& film) { return view_of(camera.pinhole, film); }

View view_of(const Orthographic& camera, const FilmSize& film) {
  View view = seen_from(camera.pose);
  view.projection = View::Projection::orthographic;
  view.scale = film.height / (2.0 * camera.half_height);
  view.window = {-camera.half_width, camera.half_width, -camera.half_height, camera.half_height};
  return view;
}

View view_of(const PinholeIntrinsics& camera, const FilmSize& film) {
  View view = seen_from(camera.pose);
  view.scale = std::max(film.width / camera.scale.x, film.height / camera.scale.y);
  view.window = {camera.offset.x, camera.offset.x + camera.scale.x, -(camera.offset.y + camera.scale.y),
                 -camera.offset.y};
  return view;
}

View view_of(const Panorama& camera, const FilmSize& film) {
  View view = seen_from(camera.pose);
  view.projection = View::Projection::angular;
  view.scale = std::max(film.width / (2.0 * M_PI), film.height / M_PI);
  return view;
}

View view_of(const Fisheye& camera, const FilmSize& film) {
  View view = seen_from(camera.pose);
  view.projection = View::Projection::angular;
  // Radii of the image circle per radian on the axis.
  const double slope = camera.mapping == FisheyeMapping::equidistant || camera.mapping == FisheyeMapping::orthographic
                           ? 1.0 / camera.scale
                           : 0.5 / camera.scale;
  view.scale = slope * film.width / (2.0 * camera.extent_x);
  return view;
}

}  // namespace

mesh::View camera_view(std::string_view type, const Values& values, const FilmSize& film) {
  ParameterPool pool;
  const Tagged camera = lower_camera(type, values, film, pool);
  return dispatch(Cameras{}, camera.tag, [&](auto listed) {
    return view_of(*reinterpret_cast<const typename decltype(listed)::type*>(pool.words().data() + camera.offset),
                   film);
  });
}

}  // namespace accuray
