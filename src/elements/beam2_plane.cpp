#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(both_drivers, _of_beam2, std::tuple<BeamOn<motion::Se2, 2>, LineLoadOn<motion::Se2, 2>>)

}  // namespace bough::elements
