// Table-driven lowering of parameters: a type's Param says which member a value goes to.
#pragma once

#include <array>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kernels/dispatch.h"
#include "kernels/scene_view.h"
#include "kernels/schema.h"
#include "lower/double3.h"

namespace accuray {

// A number that a texture gives, times `scale`.
struct TexturedReal {
  uint32_t texture;
  uint32_t channel;
  double scale;
};

// A resolved value: number (also bool and the position of a choice), vector, spectrum, textured number, or BSDF.
using Value = std::variant<double, std::array<double, 3>, SpectrumRef, TexturedReal, Tagged>;
using Values = std::map<std::string, Value, std::less<>>;

// What is wrong with the value of a parameter, and the parameter's name.
class BadParameter : public std::invalid_argument {
 public:
  BadParameter(std::string key, const std::string& problem) : std::invalid_argument(problem), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

inline const Value& value_of(const Values& values, std::string_view name) {
  const auto found = values.find(name);
  if (found == values.end()) throw std::invalid_argument("missing value of parameter '" + std::string(name) + "'");
  return found->second;
}
inline double number_of(const Values& values, std::string_view name) {
  return std::get<double>(value_of(values, name));
}
inline std::array<double, 3> vec_of(const Values& values, std::string_view name) {
  return std::get<std::array<double, 3>>(value_of(values, name));
}
// The direction of a vector; BadParameter at `key` with `problem` if it has none.
inline Double3 unit(const Double3& v, const char* key, const char* problem) {
  const double size = length(v);
  if (!(size > 0.0) || !std::isfinite(size)) throw BadParameter(key, problem);
  return {v[0] / size, v[1] / size, v[2] / size};
}
inline Vec3 to_vec3(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// The struct's member of a real parameter that takes textures.
inline RealRef real_ref(const Param& param, const Value& value) {
  if (const auto* textured = std::get_if<TexturedReal>(&value)) {
    const auto bound = [](double x) { return static_cast<float>(clamp(x, -3e38, 3e38)); };
    return {static_cast<float>(textured->scale), textured->texture, textured->channel, bound(param.low),
            bound(param.high)};
  }
  return {static_cast<float>(std::get<double>(value)), none, 0, 0.0f, 0.0f};
}

// Writes one value into the struct of `size` bytes at `target` as the parameter's kind asks.
inline void write_member(const Param& param, const Value& value, uint8_t* target, size_t size) {
  const auto put = [&](auto x) {
    if (param.member + sizeof(x) > size)
      throw std::logic_error(std::string("parameter '") + param.name + "' does not fit its member");
    std::memcpy(target + param.member, &x, sizeof(x));
  };
  switch (param.kind) {
    case Kind::real:
      if (param.texturable) return put(real_ref(param, value));
      return put(static_cast<float>(std::get<double>(value)));
    case Kind::reference:
      if (const auto* bsdf = std::get_if<Tagged>(&value)) return put(*bsdf);
      return put(static_cast<uint32_t>(std::get<double>(value)));
    case Kind::integer:
      return put(static_cast<int32_t>(std::get<double>(value)));
    case Kind::boolean:
    case Kind::choice:
      return put(static_cast<uint32_t>(std::get<double>(value)));
    case Kind::vec:
      return put(to_vec3(std::get<std::array<double, 3>>(value)));
    case Kind::spectrum:
      return put(std::get<SpectrumRef>(value));
    default:
      throw std::logic_error(std::string("parameter '") + param.name + "' has a member but no kind that fills it");
  }
}

// The description of the parameter of this name; throws if there is none.
template <class T>
Param param_named(std::string_view name) {
  constexpr auto params = T::params();
  for (uint32_t i = 0; i < params.size; ++i) {
    if (name == params.items[i].name) return params.items[i];
  }
  throw std::logic_error("no parameter is called '" + std::string(name) + "'");
}

// A struct of type T with every member that its table names filled in; the others are zero. Spectra of an alternative
// that was not chosen refer to none.
template <class T>
T struct_of(const Values& values) {
  T result{};
  constexpr auto params = T::params();
  for (uint32_t i = 0; i < params.size; ++i) {
    const Param& param = params.items[i];
    if (param.member == no_member) continue;
    const bool left_out = *param.group != '\0' && param.kind == Kind::spectrum && !values.contains(param.name);
    const Value value = left_out ? Value(SpectrumRef{none}) : value_of(values, param.name);
    write_member(param, value, reinterpret_cast<uint8_t*>(&result), sizeof(T));
  }
  return result;
}

// The pool of the types' structs, in 32-bit words; each struct starts at a multiple of 16 bytes.
class ParameterPool {
 public:
  // `table`: numbers that lie right behind the struct.
  template <class T>
  uint32_t add(const T& value, std::span<const float> table = {}) {
    const size_t offset = (words_.size() + 3) / 4 * 4;
    const size_t behind = offset + (sizeof(T) + 3) / 4;
    words_.resize(behind + table.size());
    std::memcpy(words_.data() + offset, &value, sizeof(T));
    if (!table.empty()) std::memcpy(words_.data() + behind, table.data(), table.size_bytes());
    return static_cast<uint32_t>(offset);
  }
  const std::vector<uint32_t>& words() const { return words_; }

 private:
  std::vector<uint32_t> words_;
};

// Position of the type of this name in the list; throws if there is none.
template <class... Ts>
uint32_t tag_named(TypeList<Ts...>, std::string_view name) {
  uint32_t tag = 0;
  const bool found = ((name == Ts::name ? true : (++tag, false)) || ...);
  if (!found) throw std::invalid_argument("no type is called '" + std::string(name) + "'");
  return tag;
}

// Finds the type by name, fills its struct from the values and stores it.
template <class... Ts>
Tagged lower_type(TypeList<Ts...> list, std::string_view name, const Values& values, ParameterPool& pool) {
  const uint32_t tag = tag_named(list, name);
  const uint32_t offset =
      dispatch(list, tag, [&](auto type) { return pool.add(struct_of<typename decltype(type)::type>(values)); });
  return {tag, offset};
}

}  // namespace accuray
