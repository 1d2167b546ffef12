#pragma once
/// How much memory a run may take, and scenes that would take more.
#include <filesystem>
#include <string>

#include "bough/scene/scene.hpp"

namespace bough::app {

/// What this process may still take [bytes]: of the machine's available memory, the control group's and the limit of
/// its address space the least, and nine tenths of that, for estimates are rough and others need some, too.
double available_memory();

/// "512M", "8G", "1.5e9": a size in bytes, above 0. Where it is none, `bytes` stays as it was and false is returned.
bool read_memory_size(const std::string& text, double& bytes);

/// Where a run of the scene would take more than `limit` bytes (0: what is available), says so on standard error and
/// returns true.
bool refuse_for_memory(const std::filesystem::path& file, const scene::Scene& scene, double limit);

}  // namespace bough::app
