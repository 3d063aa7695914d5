// The kernels' parts one by one, over arrays: what the tests of the lists call, and anyone who studies a BSDF.
#include <nanobind/stl/array.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "bindings/bindings.h"
#include "bindings/loaded_scene.h"
#include "kernels/accel/exhaustive.h"
#include "kernels/integrator/sample.h"

namespace accuray::bindings {

namespace {

using Vectors = Rows<float, 3>;

Vec3 row(const Vectors& array, size_t i) {
  return {array.data()[3 * i], array.data()[3 * i + 1], array.data()[3 * i + 2]};
}
void put(std::vector<float>& target, Vec3 v) { target.insert(target.end(), {v.x, v.y, v.z}); }
void put(std::vector<float>& target, Spectrum s) { target.insert(target.end(), {s[0], s[1], s[2], s[3]}); }

Wavelengths carried(const std::vector<float>& wavelengths) {
  if (wavelengths.size() != 4) throw std::invalid_argument("a path carries four wavelengths");
  return Wavelengths::at(lanes(wavelengths[0], wavelengths[1], wavelengths[2], wavelengths[3]), lanes(1.0f));
}

// A place on no shape: what a BSDF alone is asked at.
constexpr TexturePoint middle = {{0.5f, 0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};

// Calls fn with what gives the values of the material's BSDF at the wavelengths for a direction of view, by the seed of
// its streams.
template <class Fn>
void with_bsdf(const LoadedScene& scene, uint32_t material, const std::vector<float>& wavelengths, Fn&& fn) {
  const SceneView& view = scene.view;
  if (material >= view.root->materials.count) throw std::invalid_argument("there is no such material");
  const Tagged bsdf = view.materials[material].bsdf;
  dispatch(Bsdfs{}, bsdf.tag, [&](auto type) {
    const Wavelengths wl = carried(wavelengths);
    fn([&](Vec3 wo, uint32_t seed) {
      return view.as<typename decltype(type)::type>(bsdf).at({view, wl, middle, lanes(1.0f), seed, wo.z < 0.0f});
    });
    return true;
  });
}

// Whether light is gathered from both sides of the material's surfaces.
bool transmits(const LoadedScene& scene, uint32_t material) {
  const SceneView& view = scene.view;
  if (material >= view.root->materials.count) throw std::invalid_argument("there is no such material");
  return view.materials[material].transmits != 0;
}

uint32_t seed_of(uint32_t seed, Vec3 a, Vec3 b) {
  seed = hash(seed, bits_of(a.x), bits_of(a.y), bits_of(a.z));
  return hash(seed, bits_of(b.x), bits_of(b.y), bits_of(b.z));
}

void require_rows(size_t a, size_t b) {
  if (a != b) throw std::invalid_argument("the arrays must have as many rows as each other");
}

nb::dict bsdf_sample(const LoadedScene& scene, uint32_t material, const std::vector<float>& wavelengths,
                     const Vectors& wo, const Vectors& u, uint32_t seed) {
  require_rows(wo.shape(0), u.shape(0));
  std::vector<float> wi, weight, pdf, eta_scale;
  std::vector<uint32_t> lobe;
  with_bsdf(scene, material, wavelengths, [&](const auto& bsdf_by) {
    for (size_t i = 0; i < wo.shape(0); ++i) {
      const Vec3 numbers = row(u, i);
      const auto bsdf = bsdf_by(row(wo, i), seed_of(seed, row(wo, i), numbers));
      const BsdfSample s = bsdf.sample(row(wo, i), numbers.z, {numbers.x, numbers.y});
      put(wi, s.wi);
      put(weight, s.weight);
      pdf.push_back(s.pdf);
      eta_scale.push_back(s.eta_scale);
      lobe.push_back(s.lobe);
    }
  });
  nb::dict result;
  result["wi"] = to_numpy(std::move(wi), 3);
  result["weight"] = to_numpy(std::move(weight), 4);
  result["pdf"] = to_numpy(std::move(pdf), 0);
  result["eta_scale"] = to_numpy(std::move(eta_scale), 0);
  result["lobe"] = to_numpy(std::move(lobe), 0);
  return result;
}

nb::tuple bsdf_eval(const LoadedScene& scene, uint32_t material, const std::vector<float>& wavelengths,
                    const Vectors& wo, const Vectors& wi, uint32_t seed) {
  require_rows(wo.shape(0), wi.shape(0));
  std::vector<float> value, pdf;
  with_bsdf(scene, material, wavelengths, [&](const auto& bsdf_by) {
    for (size_t i = 0; i < wo.shape(0); ++i) {
      const auto bsdf = bsdf_by(row(wo, i), hash(seed, static_cast<uint32_t>(i)));
      put(value, bsdf.eval(row(wo, i), row(wi, i)));
      pdf.push_back(bsdf.pdf(row(wo, i), row(wi, i)));
    }
  });
  return nb::make_tuple(to_numpy(std::move(value), 4), to_numpy(std::move(pdf), 0));
}

// Values of a texture (N, 4) at points: texture coordinates (N, 2), and positions (N, 3) in the shape's own space. Each
// stands for a surface of diameter `footprint`, where the coordinates are lengths.
nb::object texture_values(const LoadedScene& scene, uint32_t texture, const Rows<float, 2>& uv, const Vectors& points,
                          float footprint) {
  require_rows(uv.shape(0), points.shape(0));
  const SceneView& view = scene.view;
  if (texture >= view.root->textures.count) throw std::invalid_argument("there is no such texture");
  std::vector<float> values;
  for (size_t i = 0; i < uv.shape(0); ++i) {
    TexturePoint at = middle;
    at.uv = {uv.data()[2 * i], uv.data()[2 * i + 1]};
    at.point = row(points, i);
    at.footprint = footprint;
    put(values, texture_value(view, texture, at));
  }
  return to_numpy(std::move(values), 4);
}

// Diameters of what the first sample of each pixel (x, y) stands for on the surface that it meets, m; 0 where it meets
// none.
nb::object footprints(const LoadedScene& scene, uint32_t width, uint32_t height, const Rows<uint32_t, 2>& pixels) {
  const SceneView& view = scene.view;
  const EmbreeAccel accel(scene.accel);
  const Request request{{}, 0, 1, width, height};
  std::vector<float> diameters;
  for (size_t i = 0; i < pixels.shape(0); ++i) {
    const uint32_t x = pixels.data()[2 * i];
    const uint32_t y = pixels.data()[2 * i + 1];
    const Sampler sampler = sampler_for(request, pixel_key(request, x, y, 0), 0);
    Path path = generate(view, request, x, y, sampler, carried({500, 550, 600, 650}), sampler.draw(camera_set));
    intersect(view, accel, path);
    const bool met = path.hit.geometry != none;
    diameters.push_back(met ? footprint_on(surface_at(view, path.ray, path.hit), path) : 0.0f);
  }
  return to_numpy(std::move(diameters), 0);
}

nb::dict light_sample(const LoadedScene& scene, uint32_t light, std::array<float, 3> reference, const Rows<float, 2>& u,
                      float time) {
  const SceneView& view = scene.view;
  if (light >= view.root->lights.count) throw std::invalid_argument("there is no such light");
  std::vector<float> wi, point, distance, pdf, scale;
  for (size_t i = 0; i < u.shape(0); ++i) {
    const LightSample s = sample_light(view, light, {reference[0], reference[1], reference[2]}, time,
                                       {u.data()[2 * i], u.data()[2 * i + 1]});
    put(wi, s.wi);
    put(point, s.point);
    distance.push_back(s.distance);
    pdf.push_back(s.pdf);
    scale.push_back(s.scale);
  }
  nb::dict result;
  result["wi"] = to_numpy(std::move(wi), 3);
  result["point"] = to_numpy(std::move(point), 3);
  result["distance"] = to_numpy(std::move(distance), 0);
  result["pdf"] = to_numpy(std::move(pdf), 0);
  result["scale"] = to_numpy(std::move(scale), 0);
  return result;
}

// Density with which light_sample() chooses each direction; 0 where the ray does not meet the light.
nb::object light_pdf_of(const LoadedScene& scene, uint32_t light, std::array<float, 3> reference, const Vectors& wi,
                        float time) {
  const SceneView& view = scene.view;
  if (light >= view.root->lights.count) throw std::invalid_argument("there is no such light");
  const EmbreeAccel accel(scene.accel);
  const Vec3 from = {reference[0], reference[1], reference[2]};
  std::vector<float> pdf;
  for (size_t i = 0; i < wi.shape(0); ++i) {
    const Ray ray{from, row(wi, i), infinity, time};
    const Hit hit = accel.closest(ray);
    if (hit.geometry == none) {
      const bool infinite = is_infinite_light(view.lights[light].light.tag);
      pdf.push_back(infinite ? light_pdf(view, light, from, time, ray.direction, Surface{}) : 0.0f);
      continue;
    }
    const Surface surface = surface_at(view, ray, hit);
    pdf.push_back(surface.light == light ? light_pdf(view, light, from, time, ray.direction, surface) : 0.0f);
  }
  return to_numpy(std::move(pdf), 0);
}

// Flux of a light per unit of its emission; `scene_radius` counts for infinite ones.
double light_power(const LoadedScene& scene, uint32_t light, float scene_radius) {
  const SceneView& view = scene.view;
  if (light >= view.root->lights.count) throw std::invalid_argument("there is no such light");
  const Tagged record = view.lights[light].light;
  return dispatch(Lights{}, record.tag, [&](auto type) {
    return static_cast<double>(view.as<typename decltype(type)::type>(record).power_per_radiance(scene_radius));
  });
}

// Radiance (N, 4) of an infinite light at four wavelengths in each direction.
nb::object light_radiance(const LoadedScene& scene, uint32_t light, const std::vector<float>& wavelengths,
                          const Vectors& wi) {
  const SceneView& view = scene.view;
  if (light >= view.root->lights.count) throw std::invalid_argument("there is no such light");
  std::vector<float> radiance;
  for (size_t i = 0; i < wi.shape(0); ++i) put(radiance, radiance_from(view, light, row(wi, i), carried(wavelengths)));
  return to_numpy(std::move(radiance), 4);
}

// The light that each number u chooses at a point with a normal (zero: none), and with which probability.
nb::tuple choose_lights(const LoadedScene& scene, const Vectors& points, const Vectors& normals,
                        const Column<float>& u) {
  require_rows(points.shape(0), normals.shape(0));
  require_rows(points.shape(0), u.size());
  const SceneView& view = scene.view;
  std::vector<uint32_t> light;
  std::vector<float> probability;
  for (size_t i = 0; i < points.shape(0); ++i) {
    const LightChoice choice = choose_light(view, row(points, i), row(normals, i), 0.0f, u.data()[i]);
    light.push_back(choice.light);
    probability.push_back(choice.probability);
  }
  return nb::make_tuple(to_numpy(std::move(light), 0), to_numpy(std::move(probability), 0));
}

// The probability (N, lights) of each light at each point with its normal.
nb::object choice_probabilities(const LoadedScene& scene, const Vectors& points, const Vectors& normals) {
  require_rows(points.shape(0), normals.shape(0));
  const SceneView& view = scene.view;
  const uint32_t lights = view.root->lights.count;
  std::vector<float> probability;
  for (size_t i = 0; i < points.shape(0); ++i) {
    for (uint32_t light = 0; light < lights; ++light) {
      probability.push_back(choice_probability(view, row(points, i), row(normals, i), 0.0f, light));
    }
  }
  return to_numpy(std::move(probability), lights);
}

nb::list light_names(const LoadedScene& scene) {
  constexpr const char* names[] = {"point", "constant",    "triangle", "quad",        "sphere", "disk",
                                   "spot",  "directional", "ies",      "environment", "sun",    "sky"};
  static_assert(Lights::size == std::size(names));
  nb::list result;
  const SceneView& view = scene.view;
  for (uint32_t i = 0; i < view.root->lights.count; ++i) result.append(names[view.lights[i].light.tag]);
  return result;
}

nb::dict closest(const LoadedScene& scene, const Vectors& origins, const Vectors& directions, bool exhaustive,
                 float time) {
  require_rows(origins.shape(0), directions.shape(0));
  const SceneView& view = scene.view;
  const EmbreeAccel embree(scene.accel);
  const Exhaustive every{&view};
  std::vector<float> t, point, error, normal, shading;
  std::vector<uint32_t> geometry, primitive, instance;
  for (size_t i = 0; i < origins.shape(0); ++i) {
    const Ray ray{row(origins, i), row(directions, i), infinity, time};
    const Hit hit = exhaustive ? every.closest(ray) : embree.closest(ray);
    const Surface s = hit.geometry == none ? Surface{} : surface_at(view, ray, hit);
    t.push_back(hit.geometry == none ? infinity : hit.t);
    geometry.push_back(hit.geometry);
    primitive.push_back(hit.primitive);
    instance.push_back(hit.instance);
    put(point, s.point);
    put(error, s.error);
    put(normal, s.normal);
    put(shading, s.shading);
  }
  nb::dict result;
  result["t"] = to_numpy(std::move(t), 0);
  result["geometry"] = to_numpy(std::move(geometry), 0);
  result["primitive"] = to_numpy(std::move(primitive), 0);
  result["instance"] = to_numpy(std::move(instance), 0);
  result["point"] = to_numpy(std::move(point), 3);
  result["error"] = to_numpy(std::move(error), 3);
  result["normal"] = to_numpy(std::move(normal), 3);
  result["shading"] = to_numpy(std::move(shading), 3);
  return result;
}

// From surface points (as closest() gives them), whether a ray off them to each direction leaves the scene.
nb::object escapes(const LoadedScene& scene, const Vectors& points, const Vectors& errors, const Vectors& normals,
                   const Vectors& directions, float time) {
  require_rows(points.shape(0), directions.shape(0));
  const EmbreeAccel accel(scene.accel);
  std::vector<uint8_t> result;
  for (size_t i = 0; i < points.shape(0); ++i) {
    const Vec3 d = row(directions, i);
    const Vec3 from = offset_origin(row(points, i), row(errors, i), row(normals, i), d);
    result.push_back(accel.transmittance({from, d, infinity, time}) > 0.0f ? 1 : 0);
  }
  return to_numpy(std::move(result), 0);
}

// Offsets from the pixel's centre for numbers u, on one axis.
nb::object filter_sample(const LoadedScene& scene, const Column<float>& u) {
  const SceneView& view = scene.view;
  std::vector<float> offsets;
  dispatch(Filters{}, view.root->filter.tag, [&](auto type) {
    const auto& filter = view.as<typename decltype(type)::type>(view.root->filter);
    for (size_t i = 0; i < u.size(); ++i) offsets.push_back(filter.sample(u.data()[i]));
    return true;
  });
  return to_numpy(std::move(offsets), 0);
}

// Rays of the scene's camera: for points of the film, (0, 0) to (1, 1), and of the lens's unit square.
nb::dict camera_ray(const LoadedScene& scene, const Rows<float, 2>& film, const Rows<float, 2>& lens, float time) {
  require_rows(film.shape(0), lens.shape(0));
  const SceneView& view = scene.view;
  std::vector<float> origins, directions;
  std::vector<uint8_t> seen;
  dispatch(Cameras{}, view.root->camera.tag, [&](auto type) {
    const auto& camera = view.as<typename decltype(type)::type>(view.root->camera);
    for (size_t i = 0; i < film.shape(0); ++i) {
      const float* f = film.data() + 2 * i;
      const float* l = lens.data() + 2 * i;
      const CameraRay r = camera.ray({f[0], f[1]}, {l[0], l[1]}, time);
      const uint32_t motion = view.root->camera_motion;
      const Ray ray = motion == none ? r.ray : carried_by(view, motion, r.ray);
      put(origins, ray.origin);
      put(directions, ray.direction);
      seen.push_back(r.seen ? 1 : 0);
    }
    return true;
  });
  nb::dict result;
  result["origin"] = to_numpy(std::move(origins), 3);
  result["direction"] = to_numpy(std::move(directions), 3);
  result["seen"] = to_numpy(std::move(seen), 0);
  return result;
}

// Points of the sampler: set `set` of samples first ... first + count - 1 under a key.
nb::object sampler_points(uint32_t key, uint32_t set, uint32_t first, uint32_t count) {
  std::vector<float> points;
  for (uint32_t i = first; i < first + count; ++i) put(points, Sampler::at(key, i).draw(set));
  return to_numpy(std::move(points), 4);
}

// Sums over samples 0 ... count-1 of constant channel values, rounded as the film rounds them: (4,) sums of steps.
nb::object quantized_sums(const std::vector<float>& value, double step, uint32_t key, uint64_t count) {
  if (value.size() != 4) throw std::invalid_argument("a sample has four channels");
  std::vector<int64_t> sums(film_channels, 0);
  const f32x4 channels = lanes(value[0], value[1], value[2], value[3]);
  for (uint64_t i = 0; i < count; ++i) {
    const Quantized q = quantize(channels, static_cast<float>(1.0 / step), dither_key(key, static_cast<uint32_t>(i)));
    if (!q.finite) throw std::invalid_argument("the value does not fit");
    for (uint32_t c = 0; c < film_channels; ++c) {
      if (!add_checked(sums[c], q.value[c])) throw std::overflow_error("the sum leaves 64 bits");
    }
  }
  return to_numpy(std::move(sums), 0);
}

using Function = double (*)(double);

// The kernels' own functions by name; those of float arguments round theirs first.
constexpr std::pair<std::string_view, Function> kFunctions[] = {
    {"sin", [](double x) { return static_cast<double>(sincos(static_cast<float>(x)).sin); }},
    {"cos", [](double x) { return static_cast<double>(sincos(static_cast<float>(x)).cos); }},
    {"atan", [](double x) { return static_cast<double>(accuray::atan(static_cast<float>(x))); }},
    {"asin", [](double x) { return static_cast<double>(accuray::asin(static_cast<float>(x))); }},
    {"acos", [](double x) { return static_cast<double>(accuray::acos(static_cast<float>(x))); }},
    {"exp", [](double x) { return accuray::exp(x); }},
    {"exp32", [](double x) { return static_cast<double>(accuray::exp(static_cast<float>(x))); }},
    {"log", [](double x) { return accuray::log(x); }},
    {"sin64", [](double x) { return sincos(x).sin; }},
    {"cos64", [](double x) { return sincos(x).cos; }},
};

nb::object functions(const std::string& name, const Column<double>& x) {
  for (const auto& [known, f] : kFunctions) {
    if (known != name) continue;
    std::vector<double> y(x.size());
    std::transform(x.data(), x.data() + x.size(), y.begin(), f);
    return to_numpy(std::move(y), 0);
  }
  throw std::invalid_argument("there is no function called '" + name + "'");
}

}  // namespace

void bind_probe(nb::module_& module) {
  nb::module_ probe = module.def_submodule("probe", "Parts of the kernels over arrays, for tests and study.");
  probe.def("bsdf_sample", &bsdf_sample, "scene"_a, "material"_a, "wavelengths"_a, "wo"_a, "u"_a, "seed"_a = 0);
  probe.def("bsdf_eval", &bsdf_eval, "scene"_a, "material"_a, "wavelengths"_a, "wo"_a, "wi"_a, "seed"_a = 0);
  probe.def("transmits", &transmits, "scene"_a, "material"_a);
  probe.def("sheen_albedo", &sheen_albedo, "cosine"_a, "roughness"_a);
  probe.def("texture_values", &texture_values, "scene"_a, "texture"_a, "uv"_a, "points"_a, "footprint"_a = 0.0f);
  probe.def("footprints", &footprints, "scene"_a, "width"_a, "height"_a, "pixels"_a);
  probe.def("light_sample", &light_sample, "scene"_a, "light"_a, "reference"_a, "u"_a, "time"_a = 0.0f);
  probe.def("light_pdf", &light_pdf_of, "scene"_a, "light"_a, "reference"_a, "wi"_a, "time"_a = 0.0f);
  probe.def("light_power", &light_power, "scene"_a, "light"_a, "scene_radius"_a);
  probe.def("light_radiance", &light_radiance, "scene"_a, "light"_a, "wavelengths"_a, "wi"_a);
  probe.def("choose_lights", &choose_lights, "scene"_a, "points"_a, "normals"_a, "u"_a);
  probe.def("choice_probabilities", &choice_probabilities, "scene"_a, "points"_a, "normals"_a);
  probe.def("light_names", &light_names, "scene"_a);
  probe.def("closest", &closest, "scene"_a, "origins"_a, "directions"_a, "exhaustive"_a = false, "time"_a = 0.0f);
  probe.def("escapes", &escapes, "scene"_a, "points"_a, "errors"_a, "normals"_a, "directions"_a, "time"_a = 0.0f);
  probe.def("filter_sample", &filter_sample, "scene"_a, "u"_a);
  probe.def("camera_ray", &camera_ray, "scene"_a, "film"_a, "lens"_a, "time"_a = 0.0f);
  probe.def("sampler_points", &sampler_points, "key"_a, "set"_a, "first"_a, "count"_a);
  probe.def("quantized_sums", &quantized_sums, "value"_a, "step"_a, "key"_a, "count"_a);
  probe.def("function", &functions, "name"_a, "x"_a, "An elementary function of kernels/math at each x.");
}

}  // namespace accuray::bindings
