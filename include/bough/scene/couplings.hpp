#pragma once
/// What the fields of a coupling's kind say of its numbers.
#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Calls f(field, values, factor) for every field: its numbers, and of a law the factor, else null. Fields without
/// their numbers, which a check tells, are left out.
template <class F>
void for_each_field(const Coupling& coupling, F&& f) {
  std::size_t value = 0, factor = 0;
  if (coupling.kind == nullptr) return;
  for (const CouplingField& field : coupling.kind->fields) {
    const bool is_law = field.type == CouplingFieldType::law;
    if (value + field.count() > coupling.values.size() || (is_law && factor == coupling.factors.size())) return;
    f(field, std::span(coupling.values).subspan(value, field.count()), is_law ? &coupling.factors[factor++] : nullptr);
    value += field.count();
  }
}

/// The tension k (l - l0) + c l' along the line of length l between two ends.
struct LineForce {
  double stiffness = 0.0;    ///< k [N/m]
  double rest_length = 0.0;  ///< l0 [m]
  double damping = 0.0;      ///< c [N s/m]
};
/// That of a coupling; nothing if it acts otherwise.
inline std::optional<LineForce> line_force_of(const Coupling& c) {
  if (c.kind == nullptr || !c.kind->acts_along_line || c.values.size() < 3) return std::nullopt;
  return LineForce{c.values[0], c.values[1], c.values[2]};
}

}  // namespace bough::scene
