#pragma once
/// What a scene, its reader and its checks have to know of a kind of couplings: names, numbers and texts. An element
/// declares it once (elements/coupling.hpp); nothing else lists the kinds.
#include <cstddef>
#include <cstdint>
#include <span>

#include "bough/motion/se3.hpp"

namespace bough::scene {

struct Coupling;

enum class CouplingFieldType : std::uint8_t {
  number,
  direction,  ///< three numbers, of any length but 0, in the ground at the start; the first end carries it
  axis,       ///< the same, of rotations: mirrors turn it round
  matrix,     ///< 6x6, symmetric, positive semidefinite, of motions (linear; angular) of the second frame as seen from
              ///< the first; zero where none is given
  law,        ///< a factor of a matrix over time (statics: over the load factor), or a signal; 1 where none is given
};

/// What a scene gives of a coupling.
struct CouplingField {
  const char* name;  ///< its key
  CouplingFieldType type = CouplingFieldType::number;
  const char* unit;
  const char* about;                ///< a sentence, without the unit
  double low = 0.0;                 ///< of numbers: the smallest value
  bool is_low_open = false;         ///< the smallest value itself is not allowed
  const char* standard = "";        ///< JSON text of the value where none is given; empty: it has to be given, unless
                                    ///< another default follows from its type or from the next line
  bool starts_as_distance = false;  ///< where none is given it is the distance of the two ends at the start
  bool is_strength = false;         ///< a coupling whose strengths are all zero does nothing
  const char* multiplied = "";      ///< of laws: the key of the matrix

  /// How many of Coupling::values it takes.
  constexpr std::size_t count() const {
    using enum CouplingFieldType;
    return type == number ? 1 : type == matrix ? 36 : type == law ? 0 : 3;
  }
};

/// What of its two frames is made equal at the start, where they may be drawn differently.
enum class CouplingStart : std::uint8_t {
  apart,  ///< nothing
  axes,   ///< the second gets the axes of the first
  frame,  ///< the first takes the place of the second too, which a scene may give as that of a joint
};

/// A kind of parts that act between two frames without constraints.
struct CouplingKind {
  const char* list;            ///< the scene's list of such parts, and their name in messages, as "contacts"
  const char* name;            ///< of one of them
  const char* about;           ///< what it does, in sentences
  const char *first, *second;  ///< what its ends are, a sentence each
  std::span<const CouplingField> fields;
  bool pulls_at_point;   ///< it acts on its second end by forces at the origin of that end alone
  bool acts_along_line;  ///< it has a LineForce (couplings.hpp) alone, whose numbers are its first fields
  CouplingStart start;
  /// Stiffness of the second end against the first, in the axes of the first and at the place of the second, of ends
  /// at these poses at the start.
  motion::Mat6<double> (*stiffness)(const Coupling&, const motion::Frame<double>& first,
                                    const motion::Frame<double>& second);
};

}  // namespace bough::scene
