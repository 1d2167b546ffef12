#include "support/source_dir.hpp"

namespace bough::support {

std::filesystem::path source_dir() { return BOUGH_SOURCE_DIR; }

}  // namespace bough::support
