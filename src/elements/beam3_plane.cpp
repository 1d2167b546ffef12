#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(both_drivers, _of_beam3, std::tuple<BeamOn<motion::Se2, 3>, LineLoadOn<motion::Se2, 3>>)

}  // namespace bough::elements
