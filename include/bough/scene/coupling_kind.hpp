#pragma once
/// What a scene, its reader and its checks have to know of a kind of couplings: names, numbers and texts. An element
/// declares it once (elements/coupling.hpp); nothing else lists the kinds.
#include <cstdint>
#include <span>

#include "bough/motion/se3.hpp"

namespace bough::scene {

struct Coupling;

enum class CouplingFieldType : std::uint8_t {
  number,
  direction,  ///< three numbers, of any length but 0, in the ground at the start; the first end carries it
  axis,       ///< the same, of rotations: mirrors turn it round
};

/// A number or a direction of a coupling.
struct CouplingField {
  const char* name;  ///< its key
  CouplingFieldType type;
  const char* unit;
  const char* about;     ///< a sentence, without the unit
  double low;            ///< of numbers: the smallest value
  bool is_low_open;      ///< the smallest value itself is not allowed
  const char* standard;  ///< JSON text of the value where none is given; empty: it has to be given

  constexpr int count() const { return type == CouplingFieldType::number ? 1 : 3; }
};

/// A kind of parts that act between two frames without constraints.
struct CouplingKind {
  const char* list;            ///< the scene's list of such parts, and their name in messages, as "contacts"
  const char* name;            ///< of one of them
  const char* about;           ///< what it does, in sentences
  const char *first, *second;  ///< what its ends are, a sentence each
  std::span<const CouplingField> fields;
  bool pulls_at_point;  ///< it acts on its second end by forces at the origin of that end alone
  /// Stiffness of the second end against the first in its own axes, of ends at these poses at the start.
  motion::Mat6<double> (*stiffness)(const Coupling&, const motion::Frame<double>& first,
                                    const motion::Frame<double>& second);
};

}  // namespace bough::scene
