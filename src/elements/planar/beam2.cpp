#include "../lanes_impl.hpp"
#include "bough/elements/planar/evaluate.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_PLANAR(planar::Beam<2>)
BOUGH_INSTANTIATE_PLANAR(planar::LineLoad<2>)

}  // namespace bough::elements
