// The scene builder and the RGB table.
#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>

#include "bindings/bindings.h"
#include "lower/builder.h"
#include "lower/camera_view.h"
#include "lower/rgb_table.h"
#include "lower/solids.h"

namespace accuray::bindings {

namespace {

Value to_value(nb::handle object) {
  if (nb::isinstance<SpectrumRef>(object)) return nb::cast<SpectrumRef>(object);
  if (nb::isinstance<TexturedReal>(object)) return nb::cast<TexturedReal>(object);
  if (nb::isinstance<nb::bool_>(object)) return nb::cast<bool>(object) ? 1.0 : 0.0;
  if (nb::isinstance<nb::float_>(object) || nb::isinstance<nb::int_>(object)) return nb::cast<double>(object);
  return nb::cast<std::array<double, 3>>(object);
}

Values to_values(const nb::dict& dict) {
  Values values;
  for (const auto& [key, value] : dict) values.emplace(nb::cast<std::string>(key), to_value(value));
  return values;
}

std::span<const double> span_of(const Column<double>& array) { return {array.data(), array.size()}; }

using OptionalMatrix = std::optional<Matrix>;

MeshArrays to_arrays(const Rows<float, 3>& positions, const Rows<uint32_t, 3>& indices,
                     const std::optional<Rows<float, 3>>& normals, const std::optional<Rows<float, 2>>& uvs,
                     const std::optional<Rows<float, 4>>& colors, uint32_t segments) {
  const size_t rows = positions.shape(0);
  const size_t vertices = rows / (size_t{segments} + 1);
  if (vertices * (size_t{segments} + 1) != rows || (normals && normals->shape(0) != rows) ||
      (uvs && uvs->shape(0) != vertices) || (colors && colors->shape(0) != vertices)) {
    throw std::invalid_argument("normals, uvs and colors need one row for each position");
  }
  MeshArrays arrays{to_vector(positions), to_vector(indices), {}, {}, {}, segments};
  for (const uint32_t index : arrays.indices) {
    if (index >= vertices)
      throw std::invalid_argument("a face names vertex " + std::to_string(index) + " of " + std::to_string(vertices));
  }
  if (normals) arrays.normals = to_vector(*normals);
  if (uvs) arrays.uvs = to_vector(*uvs);
  if (colors) arrays.colors = to_vector(*colors);
  return arrays;
}

std::vector<Matrix> to_matrices(const Rows<double, 12>& rows) {
  std::vector<Matrix> matrices(rows.shape(0));
  for (size_t i = 0; i < matrices.size(); ++i) std::copy_n(rows.data() + 12 * i, 12, matrices[i].begin());
  return matrices;
}

void bind_spectra(nb::class_<SceneBuilder>& builder) {
  builder
      .def(
          "set_rgb_table",
          [](SceneBuilder& b, const Column<float>& nodes, const Column<float>& coefficients) {
            b.spectra().set_rgb_table(to_vector(nodes), to_vector(coefficients));
          },
          "nodes"_a, "coefficients"_a)
      .def(
          "spectrum_constant", [](SceneBuilder& b, double value) { return b.spectra().constant(value); }, "value"_a)
      .def(
          "spectrum_table",
          [](SceneBuilder& b, const Column<double>& wavelengths, const Column<double>& values, bool hold,
             double scale) { return b.spectra().table(span_of(wavelengths), span_of(values), hold, scale); },
          "wavelengths"_a, "values"_a, "hold"_a, "scale"_a)
      .def(
          "spectrum_rgb_reflectance",
          [](SceneBuilder& b, double r, double g, double bl, double scale) {
            return b.spectra().rgb_reflectance(r, g, bl, scale);
          },
          "r"_a, "g"_a, "b"_a, "scale"_a)
      .def(
          "spectrum_rgb_emission",
          [](SceneBuilder& b, double r, double g, double bl, double scale) {
            return b.spectra().rgb_emission(r, g, bl, scale);
          },
          "r"_a, "g"_a, "b"_a, "scale"_a)
      .def(
          "spectrum_blackbody",
          [](SceneBuilder& b, double kelvin, double scale) { return b.spectra().blackbody(kelvin, scale); }, "kelvin"_a,
          "scale"_a)
      .def(
          "spectrum_sellmeier",
          [](SceneBuilder& b, double a0, const std::vector<double>& bs, const std::vector<double>& cs, double scale) {
            if (bs.size() != cs.size()) throw std::invalid_argument("Sellmeier coefficients B and C differ in number");
            return b.spectra().sellmeier(a0, bs, cs, scale);
          },
          "a0"_a, "b"_a, "c"_a, "scale"_a)
      .def(
          "spectrum_cauchy",
          [](SceneBuilder& b, double a, double c, double scale) { return b.spectra().cauchy(a, c, scale); }, "a"_a,
          "b"_a, "scale"_a)
      .def(
          "spectrum_value",
          [](SceneBuilder& b, SpectrumRef ref, double lambda) { return b.spectra().value(ref, lambda); }, "spectrum"_a,
          "wavelength"_a, "Value of a spectrum at a wavelength in nm, as kernels evaluate it.");
}

using Pixels = nb::ndarray<nb::ro, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

TexelFormat format_of(const Pixels& pixels) {
  const nb::dlpack::dtype type = pixels.dtype();
  if (type == nb::dtype<uint8_t>()) return TexelFormat::u8;
  if (type == nb::dtype<uint16_t>()) return TexelFormat::u16;
  if (type == nb::dtype<float>()) return TexelFormat::single;
  if (type.code == static_cast<uint8_t>(nb::dlpack::dtype_code::Float) && type.bits == 16) return TexelFormat::half;
  throw std::invalid_argument("texels are 8 or 16 bit integers, half or single precision floats");
}

// The picture reads the array where it is and keeps it alive; any thread may be the last to let go of it.
Picture to_picture(const Pixels& pixels) {
  std::shared_ptr<const void> owner(new Pixels(pixels), [](const void* held) {
    const nb::gil_scoped_acquire acquire;
    delete static_cast<const Pixels*>(held);
  });
  const auto size = [&](size_t axis) { return static_cast<uint32_t>(pixels.shape(axis)); };
  return {{std::move(owner), static_cast<const uint8_t*>(pixels.data()), pixels.nbytes()},
          size(1),
          size(0),
          size(2),
          format_of(pixels)};
}

void bind_textures(nb::class_<SceneBuilder>& builder) {
  builder
      .def(
          "add_picture",
          [](SceneBuilder& b, std::shared_ptr<SharedPicture> picture) {
            return b.textures().add_picture(std::move(picture));
          },
          "picture"_a)
      .def(
          "add_texture",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values, std::optional<uint32_t> picture,
             bool srgb) {
            std::optional<PictureUse> use;
            if (picture) use = PictureUse{*picture, srgb};
            return b.textures().add(type, to_values(values), use);
          },
          "type"_a, "values"_a, "picture"_a.none(), "srgb"_a)
      .def(
          "textured_reflectance",
          [](SceneBuilder& b, uint32_t texture, double scale) {
            return b.spectra().textured_reflectance(texture, scale);
          },
          "texture"_a, "scale"_a)
      .def(
          "textured_index",
          [](SceneBuilder& b, uint32_t texture, uint32_t channel, double scale, double low, double high) {
            return b.spectra().textured_index(texture, channel, scale, low, high);
          },
          "texture"_a, "channel"_a, "scale"_a, "low"_a, "high"_a)
      .def(
          "textured_emission",
          [](SceneBuilder& b, uint32_t texture, double scale) { return b.spectra().textured_emission(texture, scale); },
          "texture"_a, "scale"_a)
      .def(
          "texture_values",
          [](const SceneBuilder& b, uint32_t texture, const std::optional<Rows<float, 2>>& uvs,
             const Rows<float, 3>& points) {
            if (uvs && uvs->shape(0) != points.shape(0))
              throw std::invalid_argument("uvs and points must have as many rows as each other");
            const std::span<const float> at = uvs ? std::span(uvs->data(), uvs->size()) : std::span<const float>();
            return to_numpy(b.texture_values(texture, at, {points.data(), points.size()}), 3);
          },
          "texture"_a, "uvs"_a.none(), "points"_a, "Red, green and blue (N, 3) at points of a shape's own space.");
}

// Vertical angles (V,), horizontal angles (H,), candelas (H * V,).
using PhotometryArrays = std::tuple<Column<double>, Column<double>, Column<double>>;

Photometry to_photometry(const std::optional<PhotometryArrays>& arrays) {
  if (!arrays) return {};
  const auto& [vertical, horizontal, candela] = *arrays;
  Photometry photometry{to_vector(vertical), to_vector(horizontal), to_vector(candela)};
  const size_t rows = photometry.horizontal.size();
  if (photometry.vertical.size() < 2 || rows == 0 || photometry.candela.size() != rows * photometry.vertical.size())
    throw std::invalid_argument("a photometry has one candela for each pair of angles");
  return photometry;
}

void bind_surfaces(nb::class_<SceneBuilder>& builder) {
  builder
      .def(
          "add_material",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values, const nb::dict& header,
             std::optional<SpectrumRef> emission) {
            return b.add_material(type, to_values(values), to_values(header), emission);
          },
          "type"_a, "values"_a, "header"_a, "emission"_a.none())
      .def(
          "add_composition",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values, const nb::dict& header,
             std::optional<SpectrumRef> emission) {
            return b.add_composition(type, to_values(values), to_values(header), emission);
          },
          "type"_a, "values"_a, "header"_a, "emission"_a.none())
      .def(
          "add_mesh",
          [](SceneBuilder& b, const PlacedMesh& mesh, uint32_t material, bool prototype) {
            return b.add_mesh(mesh, material, prototype);
          },
          "mesh"_a, "material"_a, "prototype"_a)
      .def(
          "add_shape",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values, const OptionalMatrix& transform,
             uint32_t material,
             bool prototype) { return b.add_shape(type, to_values(values), transform, material, prototype); },
          "type"_a, "values"_a, "transform"_a.none(), "material"_a, "prototype"_a)
      .def("add_instance", &SceneBuilder::add_instance, "first"_a, "count"_a, "transform"_a.none(), "material"_a.none())
      .def(
          "add_moving_instance",
          [](SceneBuilder& b, uint32_t first, uint32_t count, const Rows<double, 12>& keys,
             std::optional<uint32_t> material) { b.add_moving_instance(first, count, to_matrices(keys), material); },
          "first"_a, "count"_a, "keys"_a, "material"_a.none(),
          "keys (K, 12): transforms at equal steps of time, the upper three rows, row by row.")
      .def("repeat_geometry", &SceneBuilder::repeat_geometry, "geometry"_a)
      .def("reserve_instances", &SceneBuilder::reserve_instances, "count"_a)
      .def(
          "add_instances",
          [](SceneBuilder& b, uint32_t first, uint32_t count, const Rows<double, 12>& transforms,
             std::optional<uint32_t> material) {
            const auto* matrices = reinterpret_cast<const Matrix*>(transforms.data());
            const nb::gil_scoped_release release;
            b.add_instances(first, count, {matrices, transforms.shape(0)}, material);
          },
          "first"_a, "count"_a, "transforms"_a, "material"_a.none(), "transforms: (N, 12), three rows of four.")
      .def("most_lights", &SceneBuilder::most_lights, "first"_a, "count"_a, "material"_a.none());
}

void bind_lights(nb::class_<SceneBuilder>& builder) {
  builder
      .def(
          "add_light",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values, SpectrumRef emission,
             const std::optional<PhotometryArrays>& photometry) {
            b.add_light(type, to_values(values), emission, to_photometry(photometry));
          },
          "type"_a, "values"_a, "emission"_a, "photometry"_a.none())
      .def(
          "add_sun",
          [](SceneBuilder& b, const nb::dict& values, SpectrumRef emission, bool is_irradiance) {
            b.add_sun(to_values(values), emission, is_irradiance);
          },
          "values"_a, "emission"_a, "is_irradiance"_a)
      .def(
          "add_environment",
          [](SceneBuilder& b, const nb::dict& values, const OptionalMatrix& transform, uint32_t picture, bool srgb) {
            b.add_environment(to_values(values), transform, {picture, srgb});
          },
          "values"_a, "transform"_a.none(), "picture"_a, "srgb"_a)
      .def(
          "add_sky",
          [](SceneBuilder& b, const nb::dict& values, SpectrumRef albedo, const Column<double>& sky,
             const Column<double>& radiance, const Column<double>& sun, const Column<double>& limb) {
            b.add_sky(to_values(values), albedo,
                      {to_vector(sky), to_vector(radiance), to_vector(sun), to_vector(limb)});
          },
          "values"_a, "albedo"_a, "sky"_a, "radiance"_a, "sun"_a, "limb"_a,
          "The coefficients of accuray.data.sky(), flat.");
}

void bind_view(nb::class_<SceneBuilder>& builder) {
  builder
      .def(
          "set_camera",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values, double width, double height) {
            b.set_camera(type, to_values(values), {width, height});
          },
          "type"_a, "values"_a, "width"_a, "height"_a)
      .def(
          "set_camera_motion",
          [](SceneBuilder& b, const Rows<double, 12>& keys) { b.set_camera_motion(to_matrices(keys)); }, "keys"_a)
      .def(
          "set_shutter",
          [](SceneBuilder& b, const Column<double>& times, const Column<double>& transmissions) {
            b.set_shutter(span_of(times), span_of(transmissions));
          },
          "times"_a, "transmissions"_a)
      .def(
          "set_filter",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values) {
            b.set_filter(type, to_values(values));
          },
          "type"_a, "values"_a)
      .def(
          "set_integrator",
          [](SceneBuilder& b, const std::string& type, const nb::dict& values) {
            b.set_integrator(type, to_values(values));
          },
          "type"_a, "values"_a)
      .def("set_film", &SceneBuilder::set_film, "step"_a, "hide_environment"_a)
      .def("set_compact", &SceneBuilder::set_compact, "compact"_a)
      .def("finish", &SceneBuilder::finish, "The lowered scene; the builder must not be used afterwards.");
}

template <class... Ts>
nb::tuple names_of(TypeList<Ts...>) {
  return nb::make_tuple(Ts::name...);
}

// Arrays as add_mesh takes them.
nb::tuple tessellated(const std::string& type, const nb::dict& values, const std::optional<Rows<double, 3>>& newell) {
  const Values resolved = to_values(values);
  mesh::MeshData mesh;
  {
    const nb::gil_scoped_release release;
    mesh = tessellate(type, resolved, newell ? std::span(newell->data(), newell->size()) : std::span<const double>());
  }
  nb::object normals = nb::none();
  if (!mesh.normals.empty()) normals = to_numpy(std::move(mesh.normals), 3);
  return nb::make_tuple(to_numpy(std::move(mesh.positions), 3), to_numpy(std::move(mesh.indices), 3), normals,
                        to_numpy(std::move(mesh.uvs), 2));
}

void bind_shared(nb::module_& lower) {
  nb::class_<SharedPicture>(lower, "Picture", "A picture with what was made of it, which many scenes may show.")
      .def(
          "__init__",
          [](SharedPicture* self, const Pixels& pixels) { new (self) SharedPicture{to_picture(pixels), {}, {}}; },
          "pixels"_a, "(height, width, channels) of uint8, uint16, float16 or float32; it must not change.");
  nb::class_<PlacedMesh>(lower, "PlacedMesh", "A mesh where it stands, which many scenes may show.")
      .def_prop_ro(
          "box",
          [](const PlacedMesh& mesh) {
            const Vec3 low = mesh.bounds.empty() ? Vec3{0, 0, 0} : mesh.bounds.low;
            const Vec3 high = mesh.bounds.empty() ? Vec3{0, 0, 0} : mesh.bounds.high;
            return std::array<std::array<float, 3>, 2>{{{low.x, low.y, low.z}, {high.x, high.y, high.z}}};
          },
          "Low and high corner around it, whatever form it takes.");
  lower.def(
      "place_mesh",
      [](const Rows<float, 3>& positions, const Rows<uint32_t, 3>& indices,
         const std::optional<Rows<float, 3>>& normals, const std::optional<Rows<float, 2>>& uvs,
         const std::optional<Rows<float, 4>>& colors, const OptionalMatrix& transform, uint32_t segments) {
        return place_mesh(to_arrays(positions, indices, normals, uvs, colors, segments), transform);
      },
      "positions"_a, "indices"_a, "normals"_a.none(), "uvs"_a.none(), "colors"_a.none(), "transform"_a.none(),
      "segments"_a = 0);
}

void bind_lamps(nb::module_& lower) {
  lower.def(
      "lamp_power",
      [](const std::string& type, const nb::dict& values, const std::optional<PhotometryArrays>& photometry) {
        return lamp_power(type, to_values(values), to_photometry(photometry));
      },
      "type"_a, "values"_a, "photometry"_a.none(), "Flux of a named light that is not infinite per unit of emission.");
}

void bind_cameras(nb::module_& lower) {
  lower.def(
      "with_camera",
      [](const Block& block, const std::string& type, const nb::dict& values, double width, double height) {
        return with_camera(block, type, to_values(values), {width, height});
      },
      "block"_a, "type"_a, "values"_a, "width"_a, "height"_a,
      "The block seen through another camera, of the kind that it has; None if the camera is of another kind.");
  lower.def(
      "camera_view",
      [](const std::string& type, const nb::dict& values, double width, double height) {
        return camera_view(type, to_values(values), {width, height});
      },
      "type"_a, "values"_a, "width"_a, "height"_a, "How long things are in a camera's picture (mesh.View).");
}

}  // namespace

void bind_lower(nb::module_& module) {
  // ValueError(problem, key), so that Python can tell where the value was written.
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const BadParameter& error) {
      PyErr_SetObject(PyExc_ValueError, nb::make_tuple(error.what(), error.key()).ptr());
    }
  });
  nb::module_ lower = module.def_submodule("lower", "From resolved descriptions to the lowered scene.");
  nb::class_<SpectrumRef>(lower, "SpectrumRef");
  nb::class_<TexturedReal>(lower, "TexturedReal")
      .def(nb::init<uint32_t, uint32_t, double>(), "texture"_a, "channel"_a, "scale"_a);
  nb::class_<Block>(lower, "Block")
      .def_prop_ro("bytes", &Block::bytes)
      .def(
          "section",
          [](const Block& block, size_t i) {
            const Section& section = block.sections().at(i);
            return nb::bytes(section.data, section.size);
          },
          "index"_a)
      .def_prop_ro("sections", [](const Block& block) { return block.sections().size(); });
  nb::class_<SceneBuilder> builder(lower, "SceneBuilder");
  builder.def(
      "__init__",
      [](SceneBuilder* self, const Rows<double, 3>& cmf, const Column<double>& d65) {
        new (self) SceneBuilder(ColourData{to_vector(cmf), to_vector(d65)});
      },
      "cmf"_a, "d65"_a,
      "cmf: (471, 3) colour matching functions; d65: (471,) scaled to Y = 1; both at 360, 361, ... 830 nm.");
  bind_spectra(builder);
  bind_textures(builder);
  bind_surfaces(builder);
  bind_lights(builder);
  bind_view(builder);

  bind_lamps(lower);
  bind_shared(lower);
  bind_cameras(lower);
  lower.attr("SOLIDS") = names_of(Solids{});
  lower.def("tessellate", &tessellated, "type"_a, "values"_a, "newell"_a.none(),
            "A shape of SOLIDS or a rectangle as (positions, indices, normals or None, uvs); a teapot from (512, 3) "
            "control points.");

  lower.attr("RGB_TABLE_NODES") = kRgbTableNodes;
  lower.def("rgb_table_nodes", [](int n) { return to_numpy(rgb_table_scale_nodes(n), 0); }, "n"_a);
  lower.def(
      "build_rgb_table",
      [](int n, const Rows<double, 3>& cmf, const Column<double>& illuminant, int threads) {
        const auto matching = to_vector(cmf);
        const auto white = to_vector(illuminant);
        std::vector<float> table;
        {
          const nb::gil_scoped_release release;
          table = build_rgb_table(n, matching, white, threads);
        }
        return to_numpy(std::move(table), 0);
      },
      "n"_a, "cmf"_a, "illuminant"_a, "threads"_a);
}

}  // namespace accuray::bindings
