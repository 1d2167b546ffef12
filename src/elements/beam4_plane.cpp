#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(both_drivers, _of_beam4, std::tuple<BeamOn<motion::Se2, 4>, LineLoadOn<motion::Se2, 4>>)

}  // namespace bough::elements
