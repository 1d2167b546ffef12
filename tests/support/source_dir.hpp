#pragma once
/// Where the source tree of this build lies, for tests that read data/. Its path stands in one compiled file only, so
/// that two checkouts compile everything else from the same command line and share a compiler cache.
#include <filesystem>

namespace bough::support {

std::filesystem::path source_dir();

}  // namespace bough::support
