#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_BOTH(BeamOn<motion::Se2, 3>)
BOUGH_INSTANTIATE_BOTH(LineLoadOn<motion::Se2, 3>)

}  // namespace bough::elements
