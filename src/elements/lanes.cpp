#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(lane_drivers, _of_points, std::tuple<RigidBody, PointLoad, Joint>)

}  // namespace bough::elements
