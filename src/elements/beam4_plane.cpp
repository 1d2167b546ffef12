#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_BOTH(BeamOn<motion::Se2, 4>)
BOUGH_INSTANTIATE_BOTH(LineLoadOn<motion::Se2, 4>)

}  // namespace bough::elements
