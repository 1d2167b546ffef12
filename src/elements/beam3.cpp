#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(alone_drivers, _of_beam3, std::tuple<Beam<3>, LineLoad<3>>)

}  // namespace bough::elements
