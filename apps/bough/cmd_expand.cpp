/// bough expand SCENE: the scene with numbers for its parameters and formulas, and all copies.
#include <iostream>

#include "arguments.hpp"
#include "bough/io/read_scene.hpp"
#include "terminal.hpp"

namespace bough::app {

int expand(const ExpandArguments& arguments) {
  const io::ExpandedScene expanded = io::expanded_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, expanded.problems, expanded.warnings);
  if (!expanded.ok()) return exit_bad_input;
  std::cout << expanded.text << std::flush;
  return std::cout.good() ? exit_done : exit_failed;
}

}  // namespace bough::app
