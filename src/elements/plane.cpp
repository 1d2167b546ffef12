#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(both_drivers, _in_plane,
           std::tuple<RigidBodyOn<motion::Se2>, PointLoadOn<motion::Se2>, JointOn<motion::Se2>>)

}  // namespace bough::elements
