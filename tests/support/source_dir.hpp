#pragma once
/// Path of the source tree of this build, for tests that read data/. The path is compiled into one file only, so that
/// two checkouts compile all other files with the same command line and share a compiler cache.
#include <filesystem>

namespace bough::support {

std::filesystem::path source_dir();

}  // namespace bough::support
