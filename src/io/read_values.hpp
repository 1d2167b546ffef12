#pragma once
/// Converts checked JSON values to vectors, rotations, placements and laws.
#include <string>
#include <vector>

#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/scene/nearest_name.hpp"
#include "bough/scene/scene.hpp"

namespace bough::io {

/// A fault or a doubt at a place of the document.
struct PlacedFault {
  std::string pointer, value, rule, hint;  ///< value: empty = the text at the pointer
};

/// Shorter vectors are taken to have no direction, since the square of their length is close to underflow.
inline constexpr double least_axis = 1e-150;
/// Larger angles [rad] are refused: their round-off is too large for a direction.
inline constexpr double largest_angle = 1e12;

/// Stores the first hundreds of faults and counts all of them.
class PlacedFaults {
 public:
  void push_back(PlacedFault fault) {
    constexpr std::size_t most = 2 * max_problems;
    if (size_++ < most) kept_.push_back(std::move(fault));
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const std::vector<PlacedFault>& kept() const { return kept_; }

 private:
  std::vector<PlacedFault> kept_;
  std::size_t size_ = 0;
};

/// All members take values without faults in the form of the schema. Faults that only show here are added to `faults`
/// and `warnings`.
class ValueConverter {
 public:
  PlacedFaults faults, warnings;

 protected:
  using Value = JsonValue;

  scene::Vec3 vector(const Value& v) const;
  scene::Vec3 vector_or(const Value& object, const char* key, const scene::Vec3& otherwise = scene::Vec3::zero()) const;
  double number_or(const Value& object, const char* key, double otherwise) const;
  std::string text_or(const Value& object, const char* key) const;
  scene::Mat3 matrix3(const Value& v) const;
  scene::Mat6 matrix6(const Value& v) const;
  scene::Mat3 rotation(const Value& v, const std::string& at);
  scene::Mat3 rotation_from_axes(const Value& axes, const std::string& at);
  scene::Placement placement(const Value& v, const std::string& at);
  laws::Law law(const Value& v, const std::string& at);
  void warn_of_degrees(const Value& angle, const std::string& at);

  void fault(const std::string& at, std::string rule, std::string hint = {}, std::string value = {}) {
    faults.push_back({at, std::move(value), std::move(rule), std::move(hint)});
  }
  /// A hint with the nearest of some names; empty where none is near.
  std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
    const std::string near = search_.nearest(word, known);
    return near.empty() ? "" : "did you mean \"" + near + "\"?";
  }

  scene::NameSearch search_;
};

}  // namespace bough::io
