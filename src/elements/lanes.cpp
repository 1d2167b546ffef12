#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_LANES(RigidBody)
BOUGH_INSTANTIATE_LANES(PointLoad)
BOUGH_INSTANTIATE_LANES(Joint)

}  // namespace bough::elements
