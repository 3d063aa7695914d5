#include "lower/builder.h"

#include <algorithm>
#include <stdexcept>

#include "kernels/bsdf/composition.h"
#include "kernels/bsdf/list.h"
#include "kernels/texture/opacity.h"
#include "lower/emission.h"
#include "lower/solids.h"

namespace accuray {

namespace {

Vec3 moved_point(const Matrix& m, Vec3 p) { return to_vec3(transform_point(m, {p.x, p.y, p.z})); }
Vec3 moved_vector(const Matrix& m, Vec3 v) { return to_vec3(transform_vector(m, {v.x, v.y, v.z})); }

Sphere moved(const Matrix& m, Sphere s) {
  return {moved_point(m, s.center), static_cast<float>(s.radius * scale_of(m))};
}
Disk moved(const Matrix& m, Disk d) {
  if (!(length(d.normal) > 0.0f))
    throw std::invalid_argument("normal has no direction: allowed is any length but zero");
  return {moved_point(m, d.center), normalize(moved_vector(m, d.normal)), static_cast<float>(d.radius * scale_of(m))};
}

SphereLight light_of(const Sphere& s) { return {s.center, s.radius}; }
DiskLight light_of(const Disk& d) { return {d.center, d.normal, d.radius}; }

}  // namespace

SceneBuilder::SceneBuilder(ColourData colour)
    : spectra_(std::move(colour)),
      textures_(pool_, spectra_, bulk_),
      environments_(textures_, bulk_),
      lights_(pool_, spectra_, motions_) {
  root_.version = block_version;
  root_.camera_motion = none;
  root_.film_step = 0x1p-24f;
}

bool SceneBuilder::is_textured(const Value& value) const {
  const auto* spectrum = std::get_if<SpectrumRef>(&value);
  return std::holds_alternative<TexturedReal>(value) || (spectrum != nullptr && spectra_.is_textured(*spectrum));
}

bool SceneBuilder::any_textured(const Values& values) const {
  return std::any_of(values.begin(), values.end(), [&](const auto& named) { return is_textured(named.second); });
}

MaterialRecord SceneBuilder::material_with(const Values& header, std::optional<SpectrumRef> emission) {
  MaterialRecord material{};
  material.interior = none;
  material.normal_map = none;
  material.bump_map = none;
  material.emission = {emission && !spectra_.is_zero(*emission) ? emission->index : none};
  material.emits_both_sides = number_of(header, "emission_sides") != 0.0 ? 1u : 0u;
  material.opacity = real_ref(param_named<MaterialCommon>("opacity"), value_of(header, "opacity"));
  if (!is_always_opaque(material)) root_.any_opacity = 1;
  return material;
}

bool SceneBuilder::bounds_body(uint32_t material) const {
  const MaterialRecord& record = materials_.at(material);
  if (record.composed == 0) return record.interior != none;
  const uint32_t* parameters = pool_.words().data() + record.bsdf.offset;
  return dispatch(Compositions{}, record.bsdf.tag, [&](auto listed) {
    const auto parts = reinterpret_cast<const typename decltype(listed)::type*>(parameters)->parts();
    return bounds_body(parts.first) || bounds_body(parts.second);
  });
}

uint32_t SceneBuilder::add_composition(std::string_view type, Values values, const Values& header,
                                       std::optional<SpectrumRef> emission) {
  if (type == TwoSided::name && !values.contains("back")) values.emplace("back", value_of(values, "front"));
  MaterialRecord material = material_with(header, emission);
  material.composed = 1;
  if (type == Fuzz::name) {
    const MaterialRecord& fibres = materials_.at(static_cast<uint32_t>(number_of(values, "fibres")));
    if (fibres.composed != 0 || fibres.bsdf.tag != tag_of<Sheen>(Bsdfs{})) {
      throw BadParameter("fibres", "are no fibres: allowed is a material of the type sheen");
    }
    material.reads_texture_point = fibres.reads_texture_point;
  }
  material.bsdf = lower_type(Compositions{}, type, values, pool_);
  if (any_textured(values) || any_textured(header)) material.reads_texture_point = 1;
  for (const char* side : {"front", "back"}) {
    if (values.contains(side) && bounds_body(static_cast<uint32_t>(number_of(values, side)))) {
      throw BadParameter(side, "is the surface of a body: allowed are materials that let nothing in");
    }
  }
  materials_.push_back(material);
  return static_cast<uint32_t>(materials_.size() - 1);
}

uint32_t SceneBuilder::add_material(std::string_view type, Values values, const Values& header,
                                    std::optional<SpectrumRef> emission) {
  MaterialRecord material = material_with(header, emission);
  MaterialRecord under{};
  if (const auto base = values.find("base"); base != values.end()) {
    under = materials_.at(static_cast<uint32_t>(std::get<double>(base->second)));
    base->second = under.bsdf;
    material.interior = under.interior;
  } else {
    material.interior = add_interior(values);
  }
  material.bsdf = lower_type(Bsdfs{}, type, values, pool_);
  if (header.contains("normal_map")) {
    const auto& map = std::get<TexturedReal>(value_of(header, "normal_map"));
    material.normal_map = map.texture;
    material.normal_strength = static_cast<float>(map.scale);
    material.normal_map_down = number_of(header, "normal_map_convention") != 0.0 ? 1u : 0u;
  }
  if (header.contains("bump_map")) {
    const auto& map = std::get<TexturedReal>(value_of(header, "bump_map"));
    material.bump_map = map.texture;
    material.bump_height = static_cast<float>(map.scale * number_of(header, "bump_height"));
  }
  const bool oriented = dispatch(Bsdfs{}, material.bsdf.tag, [&](auto listed) {
    using Bsdf = typename decltype(listed)::type;
    if constexpr (requires(const Bsdf& b) { b.oriented(); }) {
      return reinterpret_cast<const Bsdf*>(pool_.words().data() + material.bsdf.offset)->oriented();
    } else {
      return false;
    }
  });
  material.oriented = oriented ? 1u : under.oriented;
  const bool transmits =
      dispatch(Bsdfs{}, material.bsdf.tag, [](auto listed) { return requires { decltype(listed)::type::transmits; }; });
  material.transmits = transmits ? 1u : under.transmits;
  const bool reads = material.oriented != 0 || any_textured(values) || any_textured(header);
  material.reads_texture_point = reads ? 1u : under.reads_texture_point;
  materials_.push_back(material);
  return static_cast<uint32_t>(materials_.size() - 1);
}

uint32_t SceneBuilder::add_interior(const Values& values) {
  if (!values.contains("priority")) return none;
  const bool coloured = values.contains("transmission_color");
  const bool deep = values.contains("transmission_depth");
  if (deep && !coloured) {
    throw BadParameter("transmission_depth", "is of no use without the colour that is left: add transmission_color");
  }
  InteriorRecord interior{std::get<SpectrumRef>(value_of(values, "ior")), {none}, 0.0f, 0};
  interior.priority = static_cast<uint32_t>(number_of(values, "priority"));
  if (interior.priority != 0 && spectra_.is_textured(interior.ior)) {
    throw BadParameter("ior",
                       "is a texture, which gives an index on the surface and none inside: allowed is a texture only "
                       "with priority = 0, where the index is relative to whatever is around");
  }
  if (coloured) {
    interior.color = std::get<SpectrumRef>(value_of(values, "transmission_color"));
    interior.per_depth = deep ? static_cast<float>(1.0 / number_of(values, "transmission_depth")) : 0.0f;
  }
  interiors_.push_back(interior);
  return static_cast<uint32_t>(interiors_.size() - 1);
}

float SceneBuilder::scene_radius() const {
  return scene_bounds_.empty() ? 1.0f : std::max(0.5f * length(scene_bounds_.high - scene_bounds_.low), 1e-6f);
}

uint32_t SceneBuilder::add_geometry(Tagged shape, uint32_t material, uint32_t lights, const Bounds& bounds,
                                    bool prototype) {
  const auto number = static_cast<uint32_t>(geometries_.size());
  if (!prototype) {
    if (root_.top_geometries != number) throw std::logic_error("prototypes must be added after all other shapes");
    ++root_.top_geometries;
    scene_bounds_.grow(bounds);
  }
  geometries_.push_back({shape, material, lights});
  bounds_.push_back(bounds);
  return number;
}

uint32_t SceneBuilder::add_mesh_lights(std::span<const float> positions, std::span<const uint32_t> indices,
                                       const MaterialRecord& material, LightPlace place, uint32_t motion) {
  if (material.emission.index == none) return none;
  const auto first = static_cast<uint32_t>(light_of_primitive_.size());
  const auto lights =
      lights_.add_mesh(positions, indices, material.emission, material.emits_both_sides != 0, place, motion);
  light_of_primitive_.insert(light_of_primitive_.end(), lights.begin(), lights.end());
  return first;
}

template <class L>
uint32_t SceneBuilder::add_surface_light(const L& light, const MaterialRecord& material, LightPlace place,
                                         uint32_t motion) {
  if (material.emission.index == none) return none;
  light_of_primitive_.push_back(
      lights_.add(light, material.emission, material.emits_both_sides != 0, place, {}, motion));
  return static_cast<uint32_t>(light_of_primitive_.size() - 1);
}

template <class T>
Slice<T> SceneBuilder::store(const Section& section) {
  if (section.size == 0) return {};
  bulk_.push_back(section);
  return {0, static_cast<uint32_t>(bulk_.size()), static_cast<uint32_t>(section.size / sizeof(T))};
}

uint32_t SceneBuilder::add_mesh(const PlacedMesh& placed, uint32_t material, bool prototype) {
  const LightPlace place = {static_cast<uint32_t>(geometries_.size()), none, 0};
  const MaterialRecord& shown = materials_.at(material);
  uint32_t lights = none;
  if (!prototype && shown.emission.index != none) {
    lights = add_mesh_lights(positions_of(placed.layout, placed.vertices.data), placed.index_values(), shown, place);
  }
  Mesh mesh = placed.layout;
  mesh.vertices = store<float>(placed.vertices);
  mesh.indices = store<uint32_t>(placed.indices);
  mesh.colors = store<float>(placed.colors);
  return add_geometry({tag_of<Mesh>(Shapes{}), pool_.add(mesh)}, material, lights, placed.bounds, prototype);
}

template <class Shape>
uint32_t SceneBuilder::add_analytic(const Shape& shape, uint32_t material, bool prototype) {
  const Vec3 radius = {shape.radius, shape.radius, shape.radius};
  const LightPlace place = {static_cast<uint32_t>(geometries_.size()), none, 0};
  const uint32_t lights = prototype ? none : add_surface_light(light_of(shape), materials_.at(material), place);
  const Bounds bounds = {shape.center - radius, shape.center + radius};
  return add_geometry({tag_of<Shape>(Shapes{}), pool_.add(shape)}, material, lights, bounds, prototype);
}

uint32_t SceneBuilder::add_shape(std::string_view type, const Values& values, const std::optional<Matrix>& transform,
                                 uint32_t material, bool prototype) {
  const Matrix matrix = transform.value_or(identity_matrix);
  if (type == Sphere::name) return add_analytic(moved(matrix, struct_of<Sphere>(values)), material, prototype);
  if (type == Disk::name) return add_analytic(moved(matrix, struct_of<Disk>(values)), material, prototype);
  if (type == Rectangle::name) {
    mesh::MeshData mesh = rectangle_mesh(values);
    MeshArrays arrays{std::move(mesh.positions), std::move(mesh.indices), {}, std::move(mesh.uvs), {}};
    return add_mesh(place_mesh(std::move(arrays), transform), material, prototype);
  }
  throw std::invalid_argument("'" + std::string(type) + "' is no shape of this kind");
}

void SceneBuilder::add_instance(uint32_t first, uint32_t count, const std::optional<Matrix>& transform,
                                std::optional<uint32_t> material) {
  const Matrix matrix = transform.value_or(identity_matrix);
  const Matrix back = inverse(matrix);
  for (size_t i = 0; i < matrix.size(); ++i) {
    // Rays are carried into the instance's own space, where Embree's limit of 1.8e18 holds too.
    if (!(std::fabs(matrix[i]) < 1e15 && std::fabs(back[i]) < 1e15)) {
      throw std::invalid_argument("transform moves or scales by more than 1e15 or less than 1e-15");
    }
  }
  if (instances_.size() >= none - size_t{root_.top_geometries}) throw std::invalid_argument("are too many instances");
  InstanceRecord instance{to_transform(matrix), first, count, none, material.value_or(none), none};
  instance.lights = instance_lights(matrix, instance);
  instances_.push_back(instance);
}

void SceneBuilder::add_moving_instance(uint32_t first, uint32_t count, std::span<const Matrix> keys,
                                       std::optional<uint32_t> material) {
  InstanceRecord instance{to_transform(keys.front()), first, count, none, material.value_or(none), motions_.add(keys)};
  instance.lights = instance_lights(identity_matrix, instance);
  instances_.push_back(instance);
}

void SceneBuilder::add_instances(uint32_t first, uint32_t count, std::span<const Matrix> transforms,
                                 std::optional<uint32_t> material) {
  for (const Matrix& transform : transforms) add_instance(first, count, transform, material);
}

uint32_t SceneBuilder::repeat_geometry(uint32_t geometry) {
  const GeometryRecord record = geometries_.at(geometry);
  const Bounds bounds = bounds_.at(geometry);
  return add_geometry(record.shape, record.material, none, bounds, true);
}

uint64_t SceneBuilder::most_lights(uint32_t first, uint32_t count, std::optional<uint32_t> material) const {
  uint64_t sum = 0;
  for (uint32_t g = first; g < first + count; ++g) {
    const GeometryRecord& geometry = geometries_.at(g);
    if (materials_.at(material.value_or(geometry.material)).emission.index == none) continue;
    const bool is_mesh = geometry.shape.tag == tag_of<Mesh>(Shapes{});
    const auto* mesh = reinterpret_cast<const Mesh*>(pool_.words().data() + geometry.shape.offset);
    sum += is_mesh ? mesh->indices.count / 3 : 1;
  }
  return sum;
}

uint32_t SceneBuilder::instance_lights(const Matrix& matrix, const InstanceRecord& instance) {
  const auto first = static_cast<uint32_t>(lights_of_instance_.size());
  bool any = false;
  for (uint32_t g = instance.first; g < instance.first + instance.count; ++g) {
    const GeometryRecord& geometry = geometries_.at(g);
    const bool moves = instance.motion != none;
    scene_bounds_.grow(moves ? motions_.swept(instance.motion, bounds_.at(g)) : bounds_.at(g).moved(matrix));
    const uint32_t material = instance.material == none ? geometry.material : instance.material;
    const LightPlace place = {g, static_cast<uint32_t>(instances_.size()), 0};
    const uint32_t lights = copied_lights(matrix, materials_.at(material), place, instance.motion);
    any = any || lights != none;
    lights_of_instance_.push_back(lights);
  }
  if (any) return first;
  lights_of_instance_.resize(first);
  return none;
}

uint32_t SceneBuilder::copied_lights(const Matrix& matrix, const MaterialRecord& material, LightPlace place,
                                     uint32_t motion) {
  if (material.emission.index == none) return none;
  const GeometryRecord& geometry = geometries_.at(place.geometry);
  const uint32_t* parameters = pool_.words().data() + geometry.shape.offset;
  if (geometry.shape.tag == tag_of<Sphere>(Shapes{})) {
    return add_surface_light(light_of(moved(matrix, *reinterpret_cast<const Sphere*>(parameters))), material, place,
                             motion);
  }
  if (geometry.shape.tag == tag_of<Disk>(Shapes{})) {
    return add_surface_light(light_of(moved(matrix, *reinterpret_cast<const Disk*>(parameters))), material, place,
                             motion);
  }
  const Mesh& mesh = *reinterpret_cast<const Mesh*>(parameters);
  const auto* indices = reinterpret_cast<const uint32_t*>(bulk_.at(mesh.indices.section - 1).data);
  MeshArrays world;
  world.positions = positions_of(mesh, bulk_.at(mesh.vertices.section - 1).data);
  world.indices.assign(indices, indices + mesh.indices.count);
  move_mesh(matrix, world);
  return add_mesh_lights(world.positions, world.indices, material, place, motion);
}

void SceneBuilder::add_light(std::string_view type, const Values& values, SpectrumRef emission,
                             const Photometry& photometry) {
  if (type == ConstantLight::name) return add_constant(values, emission);
  const uint32_t tag = tag_named(NamedLights{}, type);
  dispatch(NamedLights{}, tag, [&](auto named) {
    const auto lamp = lamp_of(named, values, photometry);
    return lights_.add(lamp.light, emission, false, {none, none, 0}, lamp.table);
  });
}

void SceneBuilder::set_camera(std::string_view type, const Values& values, const FilmSize& film) {
  root_.camera = lower_camera(type, values, film, pool_);
}

void SceneBuilder::set_camera_motion(std::span<const Matrix> keys) { root_.camera_motion = motions_.add(keys); }

void SceneBuilder::set_shutter(std::span<const double> times, std::span<const double> transmissions) {
  if (times.size() < 2 || times.size() != transmissions.size()) {
    throw std::invalid_argument("a shutter has two nodes or more, each with a time and a transmission");
  }
  std::vector<double> sums{0.0};
  for (size_t i = 1; i < times.size(); ++i) {
    sums.push_back(sums.back() + 0.5 * (times[i] - times[i - 1]) * (transmissions[i] + transmissions[i - 1]));
  }
  shutter_.clear();
  for (const double time : times) shutter_.push_back(static_cast<float>(time));
  for (const double sum : sums) shutter_.push_back(static_cast<float>(sum / sums.back()));
  for (const double open : transmissions) shutter_.push_back(static_cast<float>(open / sums.back()));
}

void SceneBuilder::set_filter(std::string_view type, const Values& values) {
  const uint32_t tag = tag_named(Filters{}, type);
  const uint32_t offset = dispatch(Filters{}, tag, [&](auto listed) {
    auto filter = struct_of<typename decltype(listed)::type>(values);
    if constexpr (requires { filter.quantiles; }) tabulate(filter);
    return pool_.add(filter);
  });
  root_.filter = {tag, offset};
}

void SceneBuilder::set_integrator(std::string_view type, const Values& values) {
  if (type == DirectLighting::name) {
    root_.integrator = {tag_of<PathTracing>(Integrators{}), pool_.add(struct_of<DirectLighting>(values).as_path())};
  } else {
    root_.integrator = lower_type(Integrators{}, type, values, pool_);
  }
}

void SceneBuilder::set_film(double step, bool hide_environment) {
  root_.film_step = static_cast<float>(step);
  hide_infinite_ = hide_environment;
}

std::vector<const uint8_t*> SceneBuilder::section_bases() const {
  std::vector<const uint8_t*> bases{nullptr};
  for (const Section& section : bulk_) bases.push_back(section.data);
  return bases;
}

SceneView SceneBuilder::draft(const std::vector<const uint8_t*>& sections) const {
  SceneView view{};
  view.sections = sections.data();
  view.geometries = geometries_.data();
  view.instances = instances_.data();
  view.motions = motions_.records().data();
  view.motion_keys = motions_.keys().data();
  view.lights = lights_.records().data();
  view.light_places = lights_.places().data();
  view.spectra = spectra_.records().data();
  view.tables = spectra_.tables().data();
  view.textures = textures_.records().data();
  view.parameters = pool_.words().data();
  return view;
}

std::vector<float> SceneBuilder::texture_values(uint32_t texture, std::span<const float> uvs,
                                                std::span<const float> points) const {
  if (texture >= textures_.records().size()) throw std::invalid_argument("there is no such texture");
  const std::vector<const uint8_t*> sections = section_bases();
  const SceneView view = draft(sections);
  std::vector<float> values;
  values.reserve(points.size());
  for (size_t i = 0; i + 2 < points.size(); i += 3) {
    TexturePoint at{};
    if (!uvs.empty()) at.uv = {uvs[2 * (i / 3)], uvs[2 * (i / 3) + 1]};
    at.point = {points[i], points[i + 1], points[i + 2]};
    const TextureValue value = texture_value(view, texture, at);
    values.insert(values.end(), {value[0], value[1], value[2]});
  }
  return values;
}

Block SceneBuilder::finish() {
  if (lights_.any_textured()) {
    const std::vector<const uint8_t*> sections = section_bases();
    lights_.set_shares(texture_shares(draft(sections), static_cast<uint32_t>(lights_.records().size())));
  }
  const std::vector<float> lambda_cdf = lights_.lambda_cdf(scene_radius());
  std::vector<float> response(size_t{4} * lambda_nodes);
  const std::vector<double>& cmf = spectra_.colour().cmf;
  double y_sum = 0.0;
  for (uint32_t i = 0; i < lambda_nodes; ++i) y_sum += cmf[3 * i + 1];
  for (uint32_t i = 0; i < lambda_nodes; ++i) {
    for (uint32_t c = 0; c < 3; ++c) response[4 * i + c] = static_cast<float>(cmf[3 * i + c] / y_sum);
  }
  if (spectra_.any_textured()) {
    root_.rgb_nodes = store<float>(section_of(spectra_.rgb_nodes()));
    root_.rgb_coefficients = store<float>(section_of(spectra_.rgb_table()));
  }
  root_.any_mipmap = textures_.any_mipmap() ? 1u : 0u;
  root_.instances = store<InstanceRecord>(section_of(std::move(instances_)));
  RootWriter writer;
  root_.materials = writer.append(materials_);
  root_.interiors = writer.append(interiors_);
  root_.geometries = writer.append(geometries_);
  root_.motions = writer.append(motions_.records());
  root_.motion_keys = writer.append(motions_.keys());
  root_.shutter = writer.append(shutter_);
  root_.lights = writer.append(lights_.records());
  if (lights_.any_textured()) root_.light_places = writer.append(lights_.places());
  for (InfiniteRecord& infinite : infinite_) infinite.hidden |= hide_infinite_ ? 1u : 0u;
  root_.infinite_lights = writer.append(infinite_);
  const LightTree tree = lights_.tree(scene_radius());
  root_.light_nodes = writer.append(tree.nodes);
  root_.light_trails = writer.append(tree.trails);
  root_.distant_lights = writer.append(tree.distant);
  root_.light_of_primitive = writer.append(light_of_primitive_);
  root_.lights_of_instance = writer.append(lights_of_instance_);
  root_.spectra = writer.append(spectra_.records());
  root_.textures = writer.append(textures_.records());
  root_.tables = writer.append(spectra_.tables());
  root_.response = writer.append(response);
  root_.lambda_cdf = writer.append(lambda_cdf);
  root_.lambda_guide = writer.append(lambda_guide(lambda_cdf));
  root_.parameters = writer.append(pool_.words());
  std::vector<Section> sections{writer.finish(root_)};
  sections.insert(sections.end(), bulk_.begin(), bulk_.end());
  return Block(std::move(sections));
}

}  // namespace accuray
