// From a resolved scene description to the block that engines render.
//
// Usage: add pictures, textures, spectra, materials, shapes (first those of the scene itself, then prototypes),
// instances and lights, set camera, filter, integrator and film, and call finish() once.
#pragma once

#include <optional>
#include <string_view>

#include "kernels/film/filter.h"
#include "kernels/geometry/shapes.h"
#include "kernels/integrator/list.h"
#include "lower/block.h"
#include "lower/bounds.h"
#include "lower/cameras.h"
#include "lower/environments.h"
#include "lower/lamps.h"
#include "lower/lights.h"
#include "lower/motion.h"
#include "lower/parameters.h"
#include "lower/placed_mesh.h"
#include "lower/sky_model.h"
#include "lower/spectra.h"
#include "lower/textures.h"
#include "lower/transform.h"

namespace accuray {

class SceneBuilder {
 public:
  explicit SceneBuilder(ColourData colour);

  SpectrumPool& spectra() { return spectra_; }
  TexturePool& textures() { return textures_; }

  // `header`: the parameters of MaterialCommon but for the emission.
  uint32_t add_material(std::string_view type, Values values, const Values& header,
                        std::optional<SpectrumRef> emission);
  // The parts must have been added; of `header` only the opacity counts.
  uint32_t add_composition(std::string_view type, Values values, const Values& header,
                           std::optional<SpectrumRef> emission);
  // Each returns the geometry's number. `prototype`: rendered through instances only; these come after all others.
  uint32_t add_mesh(const PlacedMesh& placed, uint32_t material, bool prototype);
  uint32_t add_shape(std::string_view type, const Values& values, const std::optional<Matrix>& transform,
                     uint32_t material, bool prototype);
  // A prototype that shows what a geometry before it is: its number. The arrays are shared.
  uint32_t repeat_geometry(uint32_t geometry);
  void add_instance(uint32_t first, uint32_t count, const std::optional<Matrix>& transform,
                    std::optional<uint32_t> material);
  // `keys`: its transforms at equal steps of time from the shutter's opening to its closing.
  void add_moving_instance(uint32_t first, uint32_t count, std::span<const Matrix> keys,
                           std::optional<uint32_t> material);
  // One instance for each transform; `reserve_instances` before, with the sum of all, saves memory and time.
  void add_instances(uint32_t first, uint32_t count, std::span<const Matrix> transforms,
                     std::optional<uint32_t> material);
  void reserve_instances(size_t count) { instances_.reserve(count + 1); }
  // Most lights that one instance of these geometries takes.
  uint64_t most_lights(uint32_t first, uint32_t count, std::optional<uint32_t> material) const;
  void add_light(std::string_view type, const Values& values, SpectrumRef emission, const Photometry& photometry);
  // `emission`: the disc's radiance, or its irradiance on a plane that faces it.
  void add_sun(const Values& values, SpectrumRef emission, bool is_irradiance);
  void add_environment(const Values& values, const std::optional<Matrix>& transform, const PictureUse& use);
  // A sky, and its sun as a light of its own.
  void add_sky(const Values& values, SpectrumRef albedo, const SkyData& data);

  void set_camera(std::string_view type, const Values& values, const FilmSize& film);
  // What carries the camera as it was set, as for an instance.
  void set_camera_motion(std::span<const Matrix> keys);
  // Nodes of what the shutter lets through: times from 0 to 1, rising, and transmissions, not all zero.
  void set_shutter(std::span<const double> times, std::span<const double> transmissions);
  void set_filter(std::string_view type, const Values& values);
  void set_integrator(std::string_view type, const Values& values);
  void set_film(double step, bool hide_environment);
  void set_compact(bool compact) { root_.compact = compact ? 1u : 0u; }

  // What a texture says at points (3 each) with texture coordinates (2 each, or none): red, green and blue.
  std::vector<float> texture_values(uint32_t texture, std::span<const float> uvs, std::span<const float> points) const;

  Block finish();

 private:
  bool is_textured(const Value& value) const;
  bool any_textured(const Values& values) const;
  bool bounds_body(uint32_t material) const;
  MaterialRecord material_with(const Values& header, std::optional<SpectrumRef> emission);
  uint32_t add_geometry(Tagged shape, uint32_t material, uint32_t lights, const Bounds& bounds, bool prototype);
  // The lights of an instance's copy of a geometry, or none; those of a moving one stay in its prototype's space.
  uint32_t copied_lights(const Matrix& matrix, const MaterialRecord& material, LightPlace place, uint32_t motion);
  // What fills a body of a material with these values; none if it is no dielectric.
  uint32_t add_interior(const Values& values);
  // A bulk array in a section of its own; an empty one stays nowhere.
  template <class T>
  Slice<T> store(const Section& section);
  // First entry in light_of_primitive for a surface of this material, or none if it does not emit.
  uint32_t add_mesh_lights(std::span<const float> positions, std::span<const uint32_t> indices,
                           const MaterialRecord& material, LightPlace place, uint32_t motion = none);
  template <class Shape>
  uint32_t add_analytic(const Shape& shape, uint32_t material, bool prototype);
  template <class L>
  uint32_t add_surface_light(const L& light, const MaterialRecord& material, LightPlace place, uint32_t motion = none);
  uint32_t instance_lights(const Matrix& matrix, const InstanceRecord& instance);
  void add_constant(const Values& values, SpectrumRef emission);
  template <class L>
  void add_infinite(const L& light, SpectrumRef emission, const Values& values);
  float scene_radius() const;
  // The scene as far as textures read it; good until something is added.
  SceneView draft(const std::vector<const uint8_t*>& sections) const;
  std::vector<const uint8_t*> section_bases() const;

  SpectrumPool spectra_;
  ParameterPool pool_;
  std::vector<Section> bulk_;  // sections 1, 2, ...
  TexturePool textures_;
  EnvironmentPool environments_;
  MotionPool motions_;
  LightTable lights_;
  Root root_{};
  std::vector<MaterialRecord> materials_;
  std::vector<InteriorRecord> interiors_;
  std::vector<GeometryRecord> geometries_;
  std::vector<InstanceRecord> instances_;
  std::vector<InfiniteRecord> infinite_;
  std::vector<float> shutter_;
  bool hide_infinite_ = false;
  std::vector<uint32_t> light_of_primitive_;
  std::vector<uint32_t> lights_of_instance_;
  std::vector<Bounds> bounds_;  // of each geometry, in its own space
  Bounds scene_bounds_;
};

}  // namespace accuray
