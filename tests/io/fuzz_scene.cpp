// libFuzzer target of the scene reader: clang++ -fsanitize=fuzzer,address,undefined. Any text may be refused; none
// may crash or hang.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/read_scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // What follows a form feed is an override: both ways in are searched.
  const std::size_t cut = text.find('\f');
  std::vector<std::string> overrides;
  if (cut != std::string_view::npos) overrides.emplace_back(text.substr(cut + 1));
  const bough::io::SceneFile file = bough::io::read_scene_text(text.substr(0, cut), "fuzz", overrides);
  for (const bough::io::Problem& p : file.problems)
    if (p.text().empty()) __builtin_trap();
  return 0;
}
