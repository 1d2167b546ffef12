#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_EMIT(alone_drivers, _of_beam2, std::tuple<Beam<2>, LineLoad<2>>)

}  // namespace bough::elements
