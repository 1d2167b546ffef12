#include "random_cases.hpp"

namespace bough::test {

int num_cases() { return BOUGH_NUM_CASES; }

}  // namespace bough::test
