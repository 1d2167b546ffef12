#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(alone_drivers, _of_joints, std::tuple<Joint>)

}  // namespace bough::elements
