#include "../lanes_impl.hpp"
#include "bough/elements/planar/evaluate.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_PLANAR(planar::RigidBody)
BOUGH_INSTANTIATE_PLANAR(planar::PointLoad)
BOUGH_INSTANTIATE_PLANAR(planar::Spring)
BOUGH_INSTANTIATE_PLANAR(planar::Bushing)
BOUGH_INSTANTIATE_PLANAR(planar::Joint)

}  // namespace bough::elements
