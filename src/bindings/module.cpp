// The compiled module accuray._core and its submodules.
#include "bindings/bindings.h"

NB_MODULE(_core, module) {
  module.doc() =
      "Compiled core of AccuRay: schema, mesh readers, lowering and rendering. Use the package accuray instead.";
  accuray::bindings::bind_schema(module);
  accuray::bindings::bind_mesh(module);
  accuray::bindings::bind_lower(module);
  accuray::bindings::bind_engine(module);
  accuray::bindings::bind_probe(module);
}
