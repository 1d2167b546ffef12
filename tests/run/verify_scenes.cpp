#include "verify_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "bough/io/read_scene.hpp"
#include "bough/schedule/serial.hpp"
#include "support/source_dir.hpp"

namespace bough::verify {

Outcome run(const scene::Scene& scene, int threads) { return run::run_in_memory(scene, threads); }

scene::Scene gallery(const std::string& name, const std::vector<std::string>& overrides) {
  const auto file = support::source_dir() / "data" / "scenarios" / (name + ".json");
  const io::SceneFile read = io::read_scene(file, overrides);
  if (!read.ok()) throw std::runtime_error(name + ": " + read.problems.front().text());
  return read.scene;
}

std::vector<std::string> gallery_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / "scenarios"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

Direct::Direct(const scene::Scene& scene)
    : plan(plan::make_plan(scene)),
      system(plan, scene.solver, schedule::make_serial_walker()),
      state(step::make_initial_state(plan)),
      options(step::make_step_options(scene.analysis)) {
  const std::string refused = problems_of(scene);
  if (!refused.empty()) throw std::invalid_argument("refused:" + refused);
}

Vec3<double> Direct::position(const std::string& node) const {
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    if (plan.nodes[i].name == node) {
      const motion::PositionPair<double>& x = nodes_in_space(system.plan(), state)[i].x;
      return x.hi + x.lo;
    }
  throw std::out_of_range(node);
}

double observed_order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace bough::verify
