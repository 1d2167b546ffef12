#include "../lanes_impl.hpp"
#include "bough/elements/planar/evaluate.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_PLANAR(planar::Beam<3>)
BOUGH_INSTANTIATE_PLANAR(planar::LineLoad<3>)

}  // namespace bough::elements
