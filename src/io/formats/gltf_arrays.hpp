#pragma once
/// The binary part of a glTF file, and what is said of it in JSON.
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "bough/io/json_text.hpp"

namespace bough::io {

inline void begin_list(JsonText& json, const char* name) {
  json.key(name);
  json.begin_array();
}
inline void begin_member(JsonText& json, const char* name) {
  json.key(name);
  json.begin_object();
}
template <class Numbers>
void write_numbers(JsonText& json, const char* name, const Numbers& numbers) {
  begin_list(json, name);
  for (const double v : numbers) json.value(v);
  json.end_array();
}
inline void write_numbers(JsonText& json, const char* name, std::initializer_list<double> numbers) {
  write_numbers<std::initializer_list<double>>(json, name, numbers);
}
/// first, first + 1, ..., as many as `count`.
inline void write_range(JsonText& json, const char* name, long long first, long long count) {
  begin_list(json, name);
  for (long long k = 0; k < count; ++k) json.value(first + k);
  json.end_array();
}

/// The binary part of the file, and what its arrays are.
class GltfArrays {
 public:
  static constexpr int float32 = 5126, uint32 = 5125, uint16 = 5123;

  /// components: 1, 3, 4, or 16 of a matrix. has_bounds: least and largest of each component are stated. Returns its
  /// number.
  template <class T>
  long long add(const std::vector<T>& values, int type, std::size_t components, bool has_bounds, int target = 0) {
    Array a{bytes.size(), values.size() * sizeof(T), values.size() / components, components, type, target, {}, {}};
    for (std::size_t c = 0; has_bounds && c < components; ++c) {
      auto least = static_cast<double>(values[c]), most = least;
      for (std::size_t k = c; k < values.size(); k += components) {
        least = std::min(least, static_cast<double>(values[k]));
        most = std::max(most, static_cast<double>(values[k]));
      }
      a.least.push_back(least);
      a.most.push_back(most);
    }
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    arrays_.push_back(std::move(a));
    return static_cast<long long>(arrays_.size()) - 1;
  }

  void write(JsonText& json) const {
    begin_list(json, "buffers");
    json.begin_object();
    json.member("byteLength", static_cast<long long>(bytes.size()));
    json.end_object();
    json.end_array();
    begin_list(json, "bufferViews");
    for (const Array& a : arrays_) {
      json.begin_object();
      json.member("buffer", 0LL);
      json.member("byteOffset", static_cast<long long>(a.begin));
      json.member("byteLength", static_cast<long long>(a.length));
      if (a.target != 0) json.member("target", static_cast<long long>(a.target));
      json.end_object();
    }
    json.end_array();
    begin_list(json, "accessors");
    for (std::size_t k = 0; k < arrays_.size(); ++k) {
      const Array& a = arrays_[k];
      json.begin_object();
      json.member("bufferView", static_cast<long long>(k));
      json.member("componentType", static_cast<long long>(a.type));
      json.member("count", static_cast<long long>(a.count));
      json.member("type", a.components == 1   ? "SCALAR"
                          : a.components == 3 ? "VEC3"
                          : a.components == 4 ? "VEC4"
                                              : "MAT4");
      if (!a.least.empty()) write_numbers(json, "min", a.least);
      if (!a.most.empty()) write_numbers(json, "max", a.most);
      json.end_object();
    }
    json.end_array();
  }

  std::string bytes;

 private:
  struct Array {
    std::size_t begin, length, count, components;
    int type, target;
    std::vector<double> least, most;
  };
  std::vector<Array> arrays_;
};

}  // namespace bough::io
