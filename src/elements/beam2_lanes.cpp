#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(lane_drivers, _of_beam2, std::tuple<Beam<2>, LineLoad<2>>)

}  // namespace bough::elements
