#pragma once
#include "arguments.hpp"

namespace bough::app {

/// bough batch --collect DIR...: the tables of a batch whose cases ran in shards.
int collect(const BatchArguments& arguments);

}  // namespace bough::app
