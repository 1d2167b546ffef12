#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_BOTH(RigidBodyOn<motion::Se2>)
BOUGH_INSTANTIATE_BOTH(PointLoadOn<motion::Se2>)
BOUGH_INSTANTIATE_BOTH(JointOn<motion::Se2>)

}  // namespace bough::elements
