// The parameter tables of every type of every list, as Python sees them.
#include "bindings/bindings.h"
#include "kernels/bsdf/composition.h"
#include "kernels/bsdf/list.h"
#include "kernels/bsdf/openpbr.h"
#include "kernels/camera/list.h"
#include "kernels/film/filter.h"
#include "kernels/film/params.h"
#include "kernels/geometry/shapes.h"
#include "kernels/integrator/list.h"
#include "kernels/light/list.h"
#include "kernels/texture/list.h"

namespace accuray::bindings {

namespace {

// Changes whenever a change of the code changes what a sample computes; part of a scene's identity.
constexpr int kSamplingVersion = 4;

const char* kind_name(Kind kind) {
  constexpr const char* names[] = {"bool", "int",       "float", "vec",       "enum",     "text",
                                   "file", "transform", "array", "reference", "spectrum", "words"};
  return names[static_cast<uint32_t>(kind)];
}

nb::list words(const std::string& text) {
  nb::list result;
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find('|', begin), text.size());
    result.append(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

nb::dict describe(const Param& param) {
  nb::dict d;
  const auto bound = [](double x) { return abs(x) >= unbounded ? nb::object(nb::none()) : nb::cast(x); };
  d["name"] = param.name;
  d["kind"] = kind_name(param.kind);
  d["default"] =
      *param.preset == '\0' ? nb::object(nb::none()) : nb::module_::import_("json").attr("loads")(param.preset);
  d["required"] = param.required;
  d["min"] = bound(param.low);
  d["max"] = bound(param.high);
  d["unit"] = param.unit;
  d["choices"] = words(param.choices);
  d["role"] = param.role;
  d["group"] = param.group;
  d["texturable"] = param.texturable;
  d["untextured"] = param.untextured;
  d["takes_flux"] = param.takes_flux;
  d["animatable"] = param.animatable;
  d["doc"] = param.doc;
  return d;
}

template <class T>
nb::list params_of() {
  nb::list result;
  constexpr auto params = T::params();
  for (uint32_t i = 0; i < params.size; ++i) result.append(describe(params.items[i]));
  return result;
}

template <class T>
nb::list laws_of() {
  nb::list result;
  if constexpr (requires { T::keeps; }) {
    if (T::keeps.exact_pdf) result.append("exact_pdf");
    if (T::keeps.reciprocal) result.append("reciprocal");
    if (T::keeps.energy_conserving) result.append("energy_conserving");
    if (T::keeps.stochastic) result.append("stochastic");
  }
  return result;
}

template <class... Ts>
nb::dict family(TypeList<Ts...>, nb::list common) {
  nb::list types;
  [[maybe_unused]] const auto add = [&]<class T>(Type<T>) {
    nb::dict d;
    d["name"] = T::name;
    d["doc"] = T::doc;
    d["params"] = params_of<T>();
    d["keeps"] = laws_of<T>();
    if constexpr (requires { T::reads_uv; }) d["reads_uv"] = T::reads_uv;
    if constexpr (requires { T::reads_colors; }) d["reads_colors"] = T::reads_colors;
    if constexpr (requires { T::rigid; }) d["rigid"] = T::rigid;
    types.append(d);
  };
  (add(Type<Ts>{}), ...);
  nb::dict result;
  result["common"] = common;
  result["types"] = types;
  return result;
}

nb::dict tables() {
  nb::dict families;
  families["bsdf"] = family(Bsdfs{}, nb::list());
  families["composition"] = family(Compositions{}, nb::list());
  families["model"] = family(MaterialModels{}, nb::list());
  families["texture"] = family(Textures{}, nb::list());
  families["light"] = family(NamedLights{}, nb::list());
  families["shape"] = family(Shapes{}, params_of<ShapeCommon>());
  families["camera"] = family(NamedCameras{}, params_of<CameraCommon>());
  families["filter"] = family(Filters{}, nb::list());
  families["integrator"] = family(NamedIntegrators{}, nb::list());
  families["material"] = family(TypeList<>{}, params_of<MaterialCommon>());
  families["film"] = family(TypeList<>{}, params_of<FilmCommon>());
  families["render"] = family(TypeList<>{}, params_of<RenderCommon>());
  families["animation"] = family(TypeList<>{}, params_of<AnimationCommon>());
  nb::dict result;
  result["sampling_version"] = kSamplingVersion;
  result["families"] = families;
  return result;
}

}  // namespace

void bind_schema(nb::module_& module) {
  nb::module_ schema = module.def_submodule("schema", "Parameter tables of all types.");
  schema.def("tables", &tables, "Parameter tables of every family, as nested dicts and lists.");
}

}  // namespace accuray::bindings
