#pragma once
/// The quantities that the rows of joints measure: lengths, or angles and cosines.
#include "bough/elements/joint.hpp"

namespace bough::elements {

/// Whether a row is a length [m]; else it is an angle or a cosine.
inline bool is_length(RowKind kind) { return motion::traits_of(kind).is_length; }

}  // namespace bough::elements
