#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(alone_drivers, _of_beam4, std::tuple<Beam<4>, LineLoad<4>>)

}  // namespace bough::elements
