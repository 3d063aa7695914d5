// The lowered scene as kernels see it: flat tables, no owner.
//
// The bytes are relocatable: a Root and its tables in section 0, bulk data (meshes) in sections of their own, and
// Slices (section, offset, count) in place of pointers. A SceneView is made anew on each device from the root and the
// addresses at which the sections lie there.
#pragma once

#include "kernels/geometry/ray.h"
#include "kernels/math/transform.h"
#include "kernels/spectrum/rgb.h"
#include "kernels/spectrum/spectrum.h"

namespace accuray {

constexpr uint32_t block_version = 6;
constexpr uint32_t lambda_guide_size = 512;

template <class T>
struct Slice {
  uint64_t offset;  // bytes from the section's start
  uint32_t section;
  uint32_t count;
};

// A value of one of a family's types: position in the family's list, and its parameters in SceneView::parameters.
struct Tagged {
  uint32_t tag;
  uint32_t offset;
};

// What fills a closed body of a dielectric.
struct InteriorRecord {
  SpectrumRef ior;
  SpectrumRef color;  // share of the light that is left after 1 / per_depth, or after each crossing of the surface
  float per_depth;    // 1/m; 0: clear inside
  uint32_t priority;  // where bodies overlap the higher fills; 0: ior is relative to whatever is around
};

// A number that may come from a texture; read by ShadingPoint::real().
struct RealRef {
  float value;       // the number itself, or the factor of the texture's
  uint32_t texture;  // index in SceneView::textures; none: the number stands alone
  uint32_t channel;  // of the texture: red, green, blue or alpha
  float low, high;   // what the parameter allows, for textures
};

struct MaterialRecord {
  Tagged bsdf;
  uint32_t composed;     // `bsdf` is one of Compositions, whose parts are the materials to shade with
  uint32_t interior;     // none: not the surface of a dielectric body
  uint32_t transmits;    // it gathers light from both sides
  SpectrumRef emission;  // none: does not emit
  uint32_t emits_both_sides;
  uint32_t reads_texture_point;  // it is textured, or its BSDF is oriented
  uint32_t oriented;             // its BSDF's local x axis follows dpdu
  RealRef opacity;               // share of the rays that the surface stops
  uint32_t normal_map;           // texture; none: the shape's own normals
  uint32_t normal_map_down;      // its green points down (DirectX)
  float normal_strength;         // factor of its slopes
  uint32_t bump_map;             // texture; none: smooth
  float bump_height;             // of its value 1
};

struct GeometryRecord {
  Tagged shape;  // Mesh, Sphere or Disk; see geometry/list.h
  uint32_t material;
  uint32_t lights;  // first entry in light_of_primitive; none: does not emit
};

// A copy of the geometries [first, first + count) under a transform.
struct InstanceRecord {
  Transform to_world;
  uint32_t first, count;
  uint32_t lights;    // first entry in lights_of_instance, one per geometry; none: nothing emits
  uint32_t material;  // overrides the prototypes' material; none: does not
  uint32_t motion;    // index in SceneView::motions, and the transforms are those of its first key; none: it is still
};
static_assert(sizeof(InstanceRecord) == 68);  // there may be millions

// Keys [first, first + count) of SceneView::motion_keys; see geometry/motion.h.
struct MotionRecord {
  uint32_t first;
  uint32_t count;  // 2 or more
};

struct LightRecord {
  Tagged light;
  SpectrumRef emission;
  uint32_t both_sides;
  uint32_t motion;  // of its instance, in whose prototype's space the light is; none: it is still, in the world
};

// A light beyond everything that a ray which leaves the scene meets.
struct InfiniteRecord {
  uint32_t light;
  uint32_t hidden;       // from the camera
  uint32_t directional;  // its radiance differs from direction to direction
  uint32_t partial;      // there are directions in which it is not
};

// Which surface a light is: where on it a sampled point lies decides what a textured one emits.
struct LightPlace {
  uint32_t geometry;
  uint32_t instance;   // none: not instanced
  uint32_t primitive;  // a rectangle's is its first triangle, and the next one its second
};

// Four children of a group of lights, lane by lane; see light/tree.h.
struct LightNode {
  float x[4], y[4], z[4];  // middle of the lights
  float variance[4];       // mean square of the distance from it
  float intensity[4];      // flux over pi, relative to the scene's; 0: no child
  uint32_t axis[4];        // mean of the normals, 10 bits for each coordinate; highest bit: both sides emit
  uint32_t bound[4];       // radius of a sphere around the lights (16 bits), and cosine of their emission (8 bits)
  uint32_t child[4];       // a node, or a light and tree::is_light
};

// A light that is infinitely far away: chosen beside the tree.
struct DistantLight {
  uint32_t light;
  float irradiance;  // that it gives from all directions, in the unit of LightNode::intensity per m^2
};

struct Root {
  uint32_t version;
  uint32_t any_opacity;     // some material lets rays through
  uint32_t top_geometries;  // geometries [0, top_geometries) are in the scene itself, the others only instanced
  float film_step;
  uint32_t compact;        // the acceleration structure is to be small rather than fast
  uint32_t any_mipmap;     // some texture asks how much of it a ray stands for
  uint32_t camera_motion;  // index in SceneView::motions; none: the camera is still
  Tagged camera, filter, integrator;
  Slice<MaterialRecord> materials;
  Slice<InteriorRecord> interiors;
  Slice<GeometryRecord> geometries;
  Slice<InstanceRecord> instances;
  Slice<MotionRecord> motions;
  Slice<Transform> motion_keys;
  Slice<float> shutter;  // see film/shutter.h
  Slice<LightRecord> lights;
  Slice<LightPlace> light_places;  // of every light; empty if no emission is textured
  Slice<InfiniteRecord> infinite_lights;
  Slice<LightNode> light_nodes;  // the root first; empty if no light is near
  Slice<uint32_t> light_trails;  // of every light its way from the root; none: emits nothing
  Slice<DistantLight> distant_lights;
  Slice<uint32_t> light_of_primitive;
  Slice<uint32_t> lights_of_instance;
  Slice<SpectrumRecord> spectra;
  Slice<float> tables;
  Slice<Tagged> textures;
  Slice<float> rgb_nodes;  // the table of rgb.h in a section of its own; empty if no spectrum is textured
  Slice<float> rgb_coefficients;
  Slice<float> response;         // sensor at 360 .. 830 nm, four channels per node
  Slice<float> lambda_cdf;       // wavelength sampling: running sums, 471 entries
  Slice<uint32_t> lambda_guide;  // first cell of lambda_cdf that each of lambda_guide_size parts of [0, 1) meets
  Slice<uint32_t> parameters;    // the types' structs, in 32-bit words
};

struct SceneView {
  const Root* root;
  const uint8_t* const* sections;
  const MaterialRecord* materials;
  const InteriorRecord* interiors;
  const GeometryRecord* geometries;
  const InstanceRecord* instances;
  const MotionRecord* motions;
  const Transform* motion_keys;
  const float* shutter;
  const LightRecord* lights;
  const LightPlace* light_places;
  const InfiniteRecord* infinite_lights;
  const LightNode* light_nodes;
  const uint32_t* light_trails;
  const DistantLight* distant_lights;
  const uint32_t* light_of_primitive;
  const uint32_t* lights_of_instance;
  const SpectrumRecord* spectra;
  const float* tables;
  const Tagged* textures;
  RgbTable rgb;
  const float* response;
  const float* lambda_cdf;
  const uint32_t* lambda_guide;
  const uint32_t* parameters;

  template <class T>
  const T* at(const Slice<T>& slice) const {
    return reinterpret_cast<const T*>(sections[slice.section] + slice.offset);
  }
  template <class T>
  const T& as(Tagged value) const {
    return *reinterpret_cast<const T*>(parameters + value.offset);
  }
  Spectrum spectrum(SpectrumRef ref, const Wavelengths& wl) const { return evaluate(spectra[ref.index], tables, wl); }

  // `section_bases` must stay where it is for the life of the view.
  static SceneView of(const uint8_t* const* section_bases) {
    SceneView view{};
    view.root = reinterpret_cast<const Root*>(section_bases[0]);
    view.sections = section_bases;
    const Root& root = *view.root;
    view.materials = view.at(root.materials);
    view.interiors = view.at(root.interiors);
    view.geometries = view.at(root.geometries);
    view.instances = view.at(root.instances);
    view.motions = view.at(root.motions);
    view.motion_keys = view.at(root.motion_keys);
    view.shutter = view.at(root.shutter);
    view.lights = view.at(root.lights);
    view.light_places = view.at(root.light_places);
    view.infinite_lights = view.at(root.infinite_lights);
    view.light_nodes = view.at(root.light_nodes);
    view.light_trails = view.at(root.light_trails);
    view.distant_lights = view.at(root.distant_lights);
    view.light_of_primitive = view.at(root.light_of_primitive);
    view.lights_of_instance = view.at(root.lights_of_instance);
    view.spectra = view.at(root.spectra);
    view.tables = view.at(root.tables);
    view.textures = view.at(root.textures);
    view.rgb = {view.at(root.rgb_nodes), view.at(root.rgb_coefficients), static_cast<int32_t>(root.rgb_nodes.count)};
    view.response = view.at(root.response);
    view.lambda_cdf = view.at(root.lambda_cdf);
    view.lambda_guide = view.at(root.lambda_guide);
    view.parameters = view.at(root.parameters);
    return view;
  }
};

}  // namespace accuray
